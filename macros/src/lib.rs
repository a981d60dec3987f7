//! Procedural macros of Ansatz.
