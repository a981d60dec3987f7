//! Reference cells, Lagrange bases and quadrature, shared by the compiler and by running simulators.
//!
//! All coordinates are those of the reference cell (see [`Cell`]) and carry no unit. A new element is one file here
//! and one line in [`Element::ALL`]; the tests run over all of them.

mod cell;
mod element;
mod p1;
mod p2;
mod quadrature;

pub use cell::Cell;
pub use element::Element;
pub use quadrature::{Quadrature, quadrature};
