//! ansatz-geometry
