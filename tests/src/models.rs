//! Models made for tests.

ansatz::include_model!("../models/patch_plane.ansatz");
ansatz::include_model!("../models/patch_axi.ansatz");
ansatz::include_model!("../models/crushed.ansatz");
ansatz::include_model!("../models/coupled.ansatz");

use ansatz::generated::Program;

/// All of them.
pub static PROGRAMS: [&Program; 4] =
    [&patch_plane::PROGRAM, &patch_axi::PROGRAM, &crushed::PROGRAM, &coupled::PROGRAM];
