//! The table of diagnostic codes: one line each, in the order of their ids.
//!
//! An id never changes its meaning and is never used again. The letter says which stage speaks: P parsing, N names,
//! U units, S shapes, E equations, G geometry and mesh, T tests and laws, X everything else.

macro_rules! codes {
    ($($name:ident = $id:literal, $meaning:literal;)*) => {
        /// What a diagnostic is about, with an id that stays the same for ever.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code {
            $(#[doc = concat!("`", $id, "`: ", $meaning, ".")] $name,)*
        }

        impl Code {
            /// Every code, in the order of the table.
            pub const ALL: &'static [Code] = &[$(Code::$name),*];

            /// The id that users see, such as `P001`.
            pub fn id(self) -> &'static str {
                match self { $(Code::$name => $id),* }
            }

            /// One line on what the code stands for.
            pub fn meaning(self) -> &'static str {
                match self { $(Code::$name => $meaning),* }
            }
        }
    };
}

codes! {
    MissingSemicolon = "P001", "an item or statement without a block ends with `;`";
    Expected = "P002", "something else was expected at this place";
    UnknownKeyword = "P003", "no item or statement starts with this word";
    ReservedName = "P004", "a word of the language cannot be declared as a name";
    Misplaced = "P005", "the item or statement is known but does not belong here";
    UnbalancedBracket = "P006", "a bracket is opened and not closed, or closed and not opened";
    ChainedComparison = "P007", "comparisons do not chain";
    ValueForEquation = "P008", "`=` gives a value; an equation is written `==`";
    EquationForValue = "P009", "`==` is an equation; a value is given with `=`";
    DocComment = "P010", "`///` stands alone on its line before an item";
    MalformedNumber = "P011", "a number is digits, an optional fraction and exponent, then white space";
    UnitNeedsBrackets = "P012", "a unit of more than one name is written in brackets";
    TooDeep = "P013", "the text nests deeper than the compiler follows";
    UnknownUnit = "P014", "units after a number come from a closed list";
    UnitNotHere = "P015", "a unit stands only after a number, a tuple or a set";
    ForeignCharacter = "P016", "the character is no token of the language";
    NumberRange = "P017", "the number does not fit a double or the exponent an integer";

    UnknownName = "N001", "the name is not declared";
    DuplicateName = "N002", "the name is declared twice";
    WrongKind = "N003", "the name stands for another kind of thing";
    Cycle = "N004", "definitions refer to each other in a circle";
    UnknownArgument = "N005", "the function has no argument of this name";
    MissingArgument = "N006", "an argument without default is not given";
    TooManyArguments = "N007", "more arguments than the function takes";
    UnknownMember = "N008", "the value has no member of this name";
    NotCallable = "N009", "only functions can be called";
    UnknownFile = "N010", "the file cannot be read";
    PrivateName = "N011", "the name is private to its block";
    NothingToReplace = "N012", "`replace` and `drop` need something of that name in the base";
    NotConstant = "N013", "the value must be known before the run";
    NeedsRun = "N014", "the value belongs to a run or to one time of it";
    BadSetting = "N015", "the setting cannot have this value";
    Repeated = "N016", "another statement says this already, or says otherwise";

    DimensionMismatch = "U101", "both sides need the same dimension";
    NotANumber = "U102", "the function takes a pure number";
    DeclaredDimension = "U103", "the value has another dimension than declared";
    LoadDimension = "U104", "the load times its quantity is neither an energy nor, as the rest of its balance, a power";
    EnergyDimension = "U105", "the integral of an energy term is not an energy";
    ExponentNotConstant = "U106", "a quantity with a unit needs a constant rational exponent";
    UnitDimension = "U107", "the value cannot be shown in this unit";

    ShapeMismatch = "S101", "both sides need the same shape";
    DeclaredShape = "S102", "the value has another shape than declared";
    ScalarNeeded = "S103", "a scalar is needed here";
    NotOnDomain = "S104", "the value does not exist on this domain";
    VariesInSpace = "S105", "the value varies in space where one number is needed";
    MixedDomain = "S106", "cells, edges and contact pairs make no common domain";
    IncompleteMatch = "S107", "the arms of a `match` leave a gap, repeat or do not ascend";
    OutOfPlane = "S108", "components out of the plane of the model are always 0";

    TooFewEquations = "E201", "fewer equations than unknowns";
    TooManyEquations = "E202", "more equations than unknowns";
    Unmatched = "E203", "no assignment of equations to unknowns exists";
    HighIndex = "E204", "the system has an index that the integrators do not solve";
    NoConsistentStart = "E205", "no consistent start exists or can be found";
    Unbalanced = "E206", "an unknown has no equation and occurs in no energy";
    NotLinear = "E207", "a residual is linear in its test functions";
    Untied = "E208", "nothing ties the flow in a moving region to how its boundary moves";

    OpenLoop = "G301", "the paths of a region do not close";
    Overlap = "G302", "regions or paths overlap";
    EmptyPatch = "G303", "a path or region has no extent";
    BadRange = "G304", "the parameter range changes the topology";
    BadPair = "G305", "a contact pair joins two separate surfaces";
    LooseEnd = "G306", "a path meets another one without a shared point";

    Failed = "T401", "an expectation does not hold";
    Discontinuous = "T402", "the pieces of a `match` do not meet";
    JumpAtSearch = "T403", "a force between surfaces does not vanish at the search distance";

    Unsupported = "X901", "the construct is valid but not supported";
    Internal = "X902", "the compiler met a state that it should never meet";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_unique_and_in_order_within_their_letter() {
        for pair in Code::ALL.windows(2) {
            let (a, b) = (pair[0].id(), pair[1].id());
            assert!(a[..1] != b[..1] || a < b, "{a} before {b}");
        }
        let mut ids: Vec<_> = Code::ALL.iter().map(|code| code.id()).collect();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), Code::ALL.len());
    }
}
