//! Models made for tests.

ansatz::include_model!("../models/patch_plane.ansatz");
ansatz::include_model!("../models/patch_axi.ansatz");
ansatz::include_model!("../models/crushed.ansatz");
ansatz::include_model!("../models/coupled.ansatz");
ansatz::include_model!("../models/named_axis.ansatz");

use ansatz::generated::Program;

/// All of them.
pub static PROGRAMS: [&Program; 5] = [
    &patch_plane::PROGRAM,
    &patch_axi::PROGRAM,
    &crushed::PROGRAM,
    &coupled::PROGRAM,
    &named_axis::PROGRAM,
];
