//! ansatz-elements
