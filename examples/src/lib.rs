//! Small models in teaching order, each in a folder with its own text and explanation, compiled into modules.
//!
//! | folder | module | what it shows |
//! |---|---|---|
//! | `01_block` | [`pressed_block`] | a field, an energy, a load, what is held |
//! | `02_cook` | [`cooks_membrane`] | a law of one's own, a geometry, finer meshes |
//! | `03_relaxation` | [`relaxation`] | states, an equation in time, coupling with a field |
//! | `04_indentation` | [`indentation`] | contact of two bodies |

use ansatz::generated::Program;

ansatz::include_model!("../01_block/model.ansatz");
ansatz::include_model!("../02_cook/model.ansatz");
ansatz::include_model!("../03_relaxation/model.ansatz");
ansatz::include_model!("../04_indentation/model.ansatz");

/// All examples, in order.
pub static PROGRAMS: [&Program; 4] =
    [&pressed_block::PROGRAM, &cooks_membrane::PROGRAM, &relaxation::PROGRAM, &indentation::PROGRAM];
