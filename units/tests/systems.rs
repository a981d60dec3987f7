//! Models compute in the system of their declared units, and values enter and leave it unspoilt.

use ansatz_units::{Dimension, Quantity, Unit, UnitExpr, UnitSystem, UnitSystemError, convert};

fn named(name: &str) -> Dimension {
    Dimension::named(name).expect("a name of the language")
}

fn micro() -> UnitSystem {
    UnitSystem::new(&["um", "s", "nN"]).expect("independent units")
}

/// The measure of a quantity in a system.
fn measure(system: &UnitSystem, text: &str) -> f64 {
    let quantity = Quantity::parse(text).expect("a quantity");
    convert(quantity.value, quantity.unit.scale, system.exact_scale(quantity.dimension()))
}

#[test]
fn literals_enter_a_system_without_rounding_noise() {
    let cases = [
        ("3 um", 3.0),
        ("1 kPa", 1.0),
        ("130 nm", 0.13),
        ("0.1 [kg/s]", 100.0),
        ("200 [kPa/um]", 200.0),
        ("0.01 [nN*s/um^4]", 0.01),
        ("5000 [1/um^2]", 5000.0),
        ("1.381e-23 [J/K]", 1.381e-8),
        ("310 K", 310.0),
        ("100 Pa", 0.1),
        ("6 [um/min]", 0.1),
        ("180 deg", std::f64::consts::PI),
        ("1.2 hour", 4320.0),
    ];
    for (text, expected) in cases {
        assert_eq!(measure(&micro(), text), expected, "{text}");
    }
}

#[test]
fn values_pass_through_si_unspoilt() {
    let system = micro();
    for nanometres in 1..3000 {
        let text = format!("{nanometres} nm");
        let si = Quantity::parse(&text).unwrap().to_si();
        let internal = system.to_internal(si, Dimension::LENGTH);
        assert_eq!(internal, f64::from(nanometres) / 1000.0);
        assert_eq!(system.from_internal(internal, Dimension::LENGTH), si);
    }
}

#[test]
fn base_units_follow_from_the_declared_ones() {
    let system = micro();
    assert_eq!(system.scale(Dimension::LENGTH), 1e-6);
    assert_eq!(system.scale(Dimension::MASS), 1e-3);
    assert_eq!(system.scale(Dimension::TIME), 1.0);
    assert_eq!(system.scale(Dimension::TEMPERATURE), 1.0);
    let reordered = UnitSystem::new(&["nN", "s", "um"]).unwrap();
    let by_pressure = UnitSystem::new(&["nN", "kPa", "s"]).unwrap();
    for unit in Unit::ALL {
        let scale = system.exact_scale(unit.dimension);
        assert_eq!(reordered.exact_scale(unit.dimension), scale, "{}", unit.symbol);
        assert_eq!(by_pressure.exact_scale(unit.dimension), scale, "{}", unit.symbol);
    }
}

#[test]
fn units_are_shown_in_the_declared_ones() {
    let system = micro();
    let cases = [
        ("Force", "nN"),
        ("Velocity", "um/s"),
        ("Number", "1"),
        ("Pressure", "nN/um^2"),
        ("Energy", "nN*um"),
        ("Viscosity", "nN*s/um^2"),
        ("Mass", "nN*s^2/um"),
        ("Temperature", "K"),
        ("Concentration", "mol/um^3"),
        ("Acceleration", "um/s^2"),
    ];
    for (name, unit) in cases {
        assert_eq!(system.unit_of(named(name)), unit);
    }
    assert_eq!(system.unit_of(named("Number") / named("Area")), "1/um^2");
    assert_eq!(system.unit_of(named("Area") / named("Viscosity")), "um^4/(nN*s)");
    assert_eq!(UnitSystem::default().unit_of(named("Voltage")), "m^2*kg/(s^3*A)");
}

#[test]
fn the_unit_shown_is_the_unit_computed_in() {
    let declared: [&[&str]; 6] = [
        &["um", "s", "nN"],
        &[],
        &["mm", "min", "g"],
        &["Pa", "m", "hour"],
        &["cm", "mM"],
        &["V", "A", "ms", "um"],
    ];
    for symbols in declared {
        let system = UnitSystem::new(symbols).unwrap();
        for name in Dimension::names() {
            let shown = UnitExpr::parse(&system.unit_of(named(name))).unwrap();
            assert_eq!(shown, UnitExpr { dimension: named(name), scale: system.exact_scale(named(name)) });
        }
    }
}

#[test]
fn without_declared_units_the_system_is_si() {
    assert_eq!(UnitSystem::new(&[]), Ok(UnitSystem::default()));
    assert_eq!(UnitSystem::new(&["m", "kg", "s", "K", "mol", "A"]), Ok(UnitSystem::default()));
    assert!(Dimension::names().all(|name| UnitSystem::default().scale(named(name)) == 1.0));
}

#[test]
fn units_that_make_no_system_are_refused() {
    let refused = |symbols: &[&str]| UnitSystem::new(symbols).unwrap_err();
    assert_eq!(refused(&["um", "parsec"]), UnitSystemError::Unknown { index: 1, symbol: "parsec".into() });
    assert_eq!(refused(&["deg"]), UnitSystemError::Number { index: 0, symbol: "deg" });
    assert_eq!(refused(&["um", "s", "nN", "kPa"]), UnitSystemError::Redundant { index: 3, symbol: "kPa" });
    assert_eq!(
        refused(&["um", "s", "nN", "Pa"]),
        UnitSystemError::Contradiction { index: 3, symbol: "Pa", instead: "nN/um^2".into() }
    );
    assert_eq!(
        refused(&["um", "mm"]),
        UnitSystemError::Contradiction { index: 1, symbol: "mm", instead: "um".into() }
    );
    assert_eq!(refused(&["mm", "N"]), UnitSystemError::Insufficient { missing: vec!["Mass", "Time"] });
    assert_eq!(refused(&["mm", "N"]).to_string(), "these units do not fix the unit of Mass, Time");
}
