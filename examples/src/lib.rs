//! Small models in teaching order, each in a folder with its own text and explanation, compiled into modules.
//!
//! | folder | module | what it shows |
//! |---|---|---|
//! | `01_block` | [`pressed_block`] | a field, an energy, a load, what is held |
//! | `02_cook` | [`cooks_membrane`] | a law of one's own, a geometry, finer meshes |
//! | `03_relaxation` | [`relaxation`] | states, an equation in time, coupling with a field |
//! | `04_indentation` | [`indentation`] | contact of two bodies |
//! | `05_pipe` | [`pipe_flow`] | weak forms of a velocity and a pressure |
//! | `06_cylinder_flow` | [`cylinder_flow`] | profiles that are held, forces on a body |
//! | `07_cavity` | [`lid_driven_cavity`] | a pressure without a level |
//! | `08_squeeze_film` | [`squeeze_film`] | a fluid between bodies that move |
//! | `09_sphere_near_wall` | [`sphere_near_wall`] | two regions of one fluid, cells of very different size |
//! | `10_flag` | [`flag_in_flow`] | a body in a stream that bends it, an event that ends a run at rest |

use ansatz::generated::Program;

ansatz::include_model!("../01_block/model.ansatz");
ansatz::include_model!("../02_cook/model.ansatz");
ansatz::include_model!("../03_relaxation/model.ansatz");
ansatz::include_model!("../04_indentation/model.ansatz");
ansatz::include_model!("../05_pipe/model.ansatz");
ansatz::include_model!("../06_cylinder_flow/model.ansatz");
ansatz::include_model!("../07_cavity/model.ansatz");
ansatz::include_model!("../08_squeeze_film/model.ansatz");
ansatz::include_model!("../09_sphere_near_wall/model.ansatz");
ansatz::include_model!("../10_flag/model.ansatz");

/// All examples, in order.
pub static PROGRAMS: [&Program; 10] = [
    &pressed_block::PROGRAM,
    &cooks_membrane::PROGRAM,
    &relaxation::PROGRAM,
    &indentation::PROGRAM,
    &pipe_flow::PROGRAM,
    &cylinder_flow::PROGRAM,
    &lid_driven_cavity::PROGRAM,
    &squeeze_film::PROGRAM,
    &sphere_near_wall::PROGRAM,
    &flag_in_flow::PROGRAM,
];
