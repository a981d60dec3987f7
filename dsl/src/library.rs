//! The standard library: plain model text, embedded. Nothing in it is known to the compiler otherwise.

/// One file of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Module {
    /// The name after `std::`.
    pub name: &'static str,
    /// Its text: `fn` items and `use` of other modules.
    pub text: &'static str,
}

/// Every module, by name.
pub const MODULES: [Module; 4] = [
    Module { name: "check", text: include_str!("../std/check.ansatz") },
    Module { name: "fluid", text: include_str!("../std/fluid.ansatz") },
    Module { name: "shell", text: include_str!("../std/shell.ansatz") },
    Module { name: "solid", text: include_str!("../std/solid.ansatz") },
];

/// The module `std::name`.
#[must_use]
pub fn find(name: &str) -> Option<Module> {
    MODULES.into_iter().find(|module| module.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modules_are_sorted_and_found_by_name() {
        assert!(MODULES.is_sorted_by_key(|module| module.name));
        assert_eq!(find("solid").map(|module| module.name), Some("solid"));
        assert_eq!(find("solids"), None);
    }
}
