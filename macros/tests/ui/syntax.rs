// An equation where a value is given, and a semicolon that is missing.
ansatz_macros::model! {
    model wrong_syntax;
    use std::solid::{F, neo_hooke};
    coordinates plane_strain(x, y);
    geometry {
        path edge   = from (0, 0) m line to (1, 0) m line to (1, 1) m line to (0, 0) m;
        region body = loop(edge);
    }
    field u: Vector[Length] in P2 on body = 0;
    physics elasticity {
        energy neo_hooke(F(u), 1 MPa, 0.3) on body
        hold u == 0 on edge;
    }
}

fn main() {}
