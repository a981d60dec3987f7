//! The Ansatz compiler: from model text to checked models and native code.

pub mod check;
pub mod compile;
pub mod derive;
pub mod diagnostic;
pub mod emit;
pub mod eval;
pub mod form;
pub mod kernel;
pub mod library;
pub mod lower;
pub mod model;
pub mod resolve;
pub mod scalar;
pub mod source;
pub mod syntax;
