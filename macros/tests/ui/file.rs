// A model that is not there.
ansatz_macros::include_model!("no_such_model.ansatz");

fn main() {}
