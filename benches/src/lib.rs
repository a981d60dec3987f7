//! Benchmark problems with known answers: set up once here, timed by the command of this crate, checked by the tests.
//!
//! | | module | problem |
//! |---|---|---|
//! | P1 | [`assembly`] | residual and tangent of a neo-Hookean solid, plane and axisymmetric |
//! | P2 | `solves::cook` | Cook's membrane |
//! | P3 | [`flow`] | flow past a cylinder, lid-driven cavity |
//! | P4 | `solves::sphere` | a rigid sphere pressed into a cylinder |
//!
//! [`factorisation`] needs no model: it factors matrices that are assembled by hand.
//!
//! Meshes, loads and laws are those of the peers whose figures ours are compared with, node by node.

pub mod assembly;
pub mod clock;
pub mod compiler;
pub mod factorisation;
pub mod flow;
#[path = "../../frontal/tests/common/mod.rs"]
mod matrices;
pub mod report;
pub mod solves;

use ansatz::generated::Program;

ansatz::include_model!("../models/assembly_plane.ansatz");
ansatz::include_model!("../models/assembly_axi.ansatz");
ansatz::include_model!("../models/cook.ansatz");
ansatz::include_model!("../models/sphere.ansatz");
ansatz::include_model!("../models/dfg.ansatz");
ansatz::include_model!("../models/cavity.ansatz");

/// The models of all problems.
pub static PROGRAMS: [&Program; 6] = [
    &assembly_plane::PROGRAM,
    &assembly_axi::PROGRAM,
    &cook::PROGRAM,
    &sphere::PROGRAM,
    &dfg::PROGRAM,
    &cavity::PROGRAM,
];
