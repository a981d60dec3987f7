//! ansatz-dsl
