//! Models made for tests.

ansatz::include_model!("../models/patch_plane.ansatz");
ansatz::include_model!("../models/patch_axi.ansatz");
ansatz::include_model!("../models/crushed.ansatz");
ansatz::include_model!("../models/coupled.ansatz");
ansatz::include_model!("../models/channel.ansatz");
ansatz::include_model!("../models/stretching.ansatz");
ansatz::include_model!("../models/vortices.ansatz");
ansatz::include_model!("../models/leaking_box.ansatz");
ansatz::include_model!("../models/named_axis.ansatz");
ansatz::include_model!("../models/whisker.ansatz");
ansatz::include_model!("../models/film.ansatz");
ansatz::include_model!("../models/plates.ansatz");
ansatz::include_model!("../models/plate.ansatz");
ansatz::include_model!("../models/roll.ansatz");
ansatz::include_model!("../models/roll_by_force.ansatz");
ansatz::include_model!("../models/balloon.ansatz");
ansatz::include_model!("../models/cave_in.ansatz");
ansatz::include_model!("../models/turek_csm1.ansatz");
ansatz::include_model!("../models/filled_block.ansatz");
ansatz::include_model!("../models/refreshed_block.ansatz");
ansatz::include_model!("../models/sheet.ansatz");
ansatz::include_model!("../models/squashed_at_once.ansatz");

use ansatz::generated::Program;

/// All of them.
pub static PROGRAMS: [&Program; 22] = [
    &patch_plane::PROGRAM,
    &patch_axi::PROGRAM,
    &crushed::PROGRAM,
    &coupled::PROGRAM,
    &named_axis::PROGRAM,
    &channel::PROGRAM,
    &stretching::PROGRAM,
    &vortices::PROGRAM,
    &leaking_box::PROGRAM,
    &whisker::PROGRAM,
    &film::PROGRAM,
    &plates::PROGRAM,
    &plate::PROGRAM,
    &roll::PROGRAM,
    &roll_by_force::PROGRAM,
    &balloon::PROGRAM,
    &cave_in::PROGRAM,
    &turek_csm1::PROGRAM,
    &filled_block::PROGRAM,
    &refreshed_block::PROGRAM,
    &sheet::PROGRAM,
    &squashed_at_once::PROGRAM,
];
