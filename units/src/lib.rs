//! Dimensions, units and unit systems, shared by the compiler and by running simulators.
//!
//! A [`Dimension`] says what a value measures and a [`Scale`] how large its unit is in SI; both are exact. A
//! [`UnitExpr`] is the two together, written such as `nN*s/um^4`; a [`Quantity`] is a number with one. A
//! [`UnitSystem`] holds the units in which a model computes, and [`convert`] goes between scales without rounding
//! noise: 3 um is exactly 3 in a system of um, and 1 kPa exactly 1 nN/um^2.

mod dimension;
mod expression;
mod product;
mod quantity;
mod rational;
mod scale;
mod suggest;
mod system;
mod unit;

pub use dimension::Dimension;
pub use expression::{UnitError, UnitErrorKind, UnitExpr, parse_unit};
pub use quantity::{Quantity, QuantityError, parse_quantity};
pub use rational::Rational;
pub use scale::{Scale, convert};
pub use suggest::nearest;
pub use system::{UnitSystem, UnitSystemError};
pub use unit::Unit;
