//! ansatz-tests
