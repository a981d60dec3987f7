//! ansatz-examples
