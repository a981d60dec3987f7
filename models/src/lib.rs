//! ansatz-models
