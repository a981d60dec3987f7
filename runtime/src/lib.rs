//! ansatz
pub mod lane;
pub mod mesh;
pub mod solve;
