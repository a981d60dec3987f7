//! The models that ship with Ansatz, each compiled into a module of its own: `Parameters`, `PROGRAM`, `simulation`.
//!
//! `wet_printed`, whose force ends in a jump, has no tangent at every point and is left out; the command `ansatz` runs it like the others.

ansatz::include_model!("../dry/model.ansatz");
ansatz::include_model!("../dry_axis_points/model.ansatz");
ansatz::include_model!("../dry_printed/model.ansatz");
ansatz::include_model!("../dry_wide_roof/model.ansatz");
ansatz::include_model!("../wet/model.ansatz");
ansatz::include_model!("../wet_bed/model.ansatz");
ansatz::include_model!("../wet_cortex/model.ansatz");
ansatz::include_model!("../wet_fine/model.ansatz");
ansatz::include_model!("../wet_solids/model.ansatz");
ansatz::include_model!("../wet_stiff/model.ansatz");

use ansatz::generated::Program;

/// All of them.
pub static PROGRAMS: [&Program; 10] = [
    &dry_contact::PROGRAM,
    &dry_axis_points::PROGRAM,
    &dry_printed::PROGRAM,
    &dry_wide_roof::PROGRAM,
    &wet_contact::PROGRAM,
    &wet_bed::PROGRAM,
    &wet_cortex::PROGRAM,
    &wet_fine::PROGRAM,
    &wet_solids::PROGRAM,
    &wet_stiff::PROGRAM,
];
