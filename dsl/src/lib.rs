//! The Ansatz compiler: from model text to checked models and native code.

pub mod diagnostic;
pub mod source;
pub mod syntax;
pub mod scalar;
pub mod derive;
pub mod library;
pub mod model;
pub mod lower;
pub mod eval;
pub mod form;
pub mod kernel;
pub mod check;
pub mod resolve;
pub mod emit;
pub mod compile;
