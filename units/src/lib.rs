//! ansatz-units
