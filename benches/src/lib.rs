//! ansatz-benches
