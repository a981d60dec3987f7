// A model in a file of its own, with a number that lacks its unit.
ansatz_macros::include_model!("broken.ansatz");

fn main() {}
