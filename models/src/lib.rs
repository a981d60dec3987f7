//! The models that ship with Ansatz.
