//! What would silently do nothing, or something else than it says, is refused: variants of the block of the language pages.

use ansatz_dsl::compile::compile;
use ansatz_dsl::diagnostic::render;
use ansatz_dsl::resolve::Loaded;

/// The model that the language pages start with.
const BLOCK: &str = include_str!("../../docs/language/block.ansatz");

/// What the compiler says of a text, which may extend the block.
fn said(text: &str) -> String {
    let mut load = |path: &str, _: &str| match path {
        "block.ansatz" => Ok(Loaded { name: "block.ansatz".into(), text: BLOCK.into() }),
        _ => Err(String::from("not found")),
    };
    let compilation = compile("q.ansatz", text, &mut load);
    render(&compilation.diagnostics, &compilation.sources)
}

/// What the compiler says of the block with these items on top.
fn said_of_block(items: &str) -> String {
    said(&format!("model q; extend \"block.ansatz\";\n{items}\n"))
}

#[test]
fn loads_and_holds_out_of_the_plane_are_refused() {
    let pressing = |statement: &str| said_of_block(&format!("replace physics pressing {{ {statement} }}"));
    insta::assert_snapshot!("load_across", pressing("load u.z with -p*t/(1 s) on edge.top;"));
    insta::assert_snapshot!("hold_across", pressing("hold u.z = 1 mm on edge.top;"));
    for statement in [
        "load u with (0 MPa, -p, p) on edge.top;",
        "load mean(u.z on edge.top) with 1 N;",
        "hold u = (0, 0, 1) mm on edge.top;",
        "residual -p*test(u).z on edge.top;",
        "energy p*u.z on edge.top;",
    ] {
        let words = pressing(statement);
        assert!(words.contains("error[S108]") && words.contains("1 error"), "{statement}: {words}");
    }
    let start = said_of_block("replace field u: Vector[Length] in P2 on body = (0, 0, 1) mm;");
    assert!(start.contains("S108"), "{start}");
}

#[test]
fn swirl_in_an_axisymmetric_model_is_refused_by_its_name() {
    let round = BLOCK.replace("plane_strain(x, y)", "axisymmetric(r, z)").replace("u.y", "u.z");
    assert_eq!(said(&round), "");
    let turned = round.replace("load u.z with", "load u.theta with");
    insta::assert_snapshot!("load_swirl", said(&turned));
    let held = round.replace("hold u = 0 on", "hold u.theta = 1 mm on");
    assert!(said(&held).contains("S108"), "{}", said(&held));
}

#[test]
fn vectors_that_lie_in_the_plane_by_construction_are_right() {
    let loads = |force: &str, place: &str| {
        said_of_block(&format!("physics more {{ load u with {force} on {place}; }}"))
    };
    for force in ["-p*u/(1 mm)", "p*dt(u)/(1 [mm/s])", "-p*(position/w + u/w)", "(0*p, p, 0*p)"] {
        assert_eq!(loads(force, "edge.top"), "", "{force}");
    }
    for force in ["p*inverse(transpose(F(u)))*position/w^2", "p*F(u)*F(u)*u/w^2", "p*cross((0, 0, 1), u)/w^2"]
    {
        assert_eq!(loads(force, "body"), "", "{force}");
    }
}

#[test]
fn tables_have_plain_file_names() {
    let called = |file: &str| said_of_block(&format!("output {{ table \"{file}\" every 1 s: t; }}"));
    insta::assert_snapshot!("table_elsewhere", called("../zz.csv"));
    for file in ["/abs/path.csv", "a/b.csv", "", ".csv", "run.json", "history"] {
        let words = called(file);
        assert!(words.contains("error[N015]") && words.contains("1 error"), "{file}: {words}");
    }
    assert_eq!(called("the history 2.csv"), "");
}

#[test]
fn iterations_are_whole_numbers() {
    let with = |count: &str| said_of_block(&format!("solve {{ nonlinear = newton(iterations: {count}); }}"));
    insta::assert_snapshot!("iterations", with("2.5"));
    assert_eq!(with("5/2*2"), "");
}

/// A pool below the block, which moves with it, and a flow in it.
const POOL: &str = "geometry {
    path tank = from (0, 0) line to (0, -5 mm) line floor to (20 mm, -5 mm) line to (20 mm, 0);
    region pool = loop(edge.bottom, tank);
}
moving pool by u;
replace physics elasticity { energy neo_hooke(F(u), G, 0.3) on body;  hold u = 0 on edge.top; }
drop physics pressing;
";

#[test]
fn a_flow_that_does_not_feel_how_its_boundary_moves_is_warned_of() {
    let flow = "field v: Vector[Velocity] in P2 on pool = 0;
        physics flow { residual inner(grad(v), grad(test(v)))*1 [kPa*s] on pool;  hold v = 0 on tank; ";
    insta::assert_snapshot!("flow_without_tie", said_of_block(&format!("{POOL}{flow} }}")));
    assert_eq!(said_of_block(&format!("{POOL}{flow} tie v == dt(u) on edge.bottom; }}")), "");
    let heat = "field T: Temperature in P1 on pool = 0;
        physics heat { residual test(T)*dt(T) on pool; }";
    assert_eq!(said_of_block(&format!("{POOL}{heat}")), "", "heat needs no tie");
}

#[test]
fn long_chains_of_definitions_are_told_unless_they_stand_in_order() {
    let chain = |keyword: &str| -> Vec<String> {
        let link = |i| format!("{keyword} q{i} = q{} + 1;\n", i + 1);
        (0..2000).map(link).chain([format!("{keyword} q2000 = 1;\n")]).collect()
    };
    insta::assert_snapshot!("chain_of_lets", said_of_block(&chain("let").concat()));
    let params = said_of_block(&chain("param").concat());
    assert!(params.contains("error[P013]"), "{params}");
    let in_order: String = chain("let").into_iter().rev().collect();
    assert_eq!(said_of_block(&in_order), "");
}

#[test]
fn a_byte_order_mark_is_no_part_of_the_text() {
    assert_eq!(said(&format!("\u{feff}{BLOCK}")), "");
}

#[test]
fn slips_of_the_pen_find_the_word_that_fits_there() {
    for (written, meant) in [
        ("output { fields on body evry 0.1 s: u; }", "every"),
        ("output { table \"b.csv\" evry 0.1 s: t; }", "every"),
        ("geometry { path spur = from (0, 0) mm lin to (1, 1) mm; }", "line"),
        ("replace paramm p = 1 MPa;", "param"),
        ("drop evnt x;", "event"),
        ("param l = 3 MM;", "mm"),
    ] {
        let words = said_of_block(written);
        assert!(words.contains(&format!("did you mean `{meant}`?")), "{written}: {words}");
    }
}

#[test]
fn a_name_is_no_suggestion_for_its_own_definition() {
    for written in ["let c = cb;", "param c = cb;"] {
        let words = said_of_block(written);
        assert!(words.contains("`cb` is not declared") && !words.contains("did you mean"), "{words}");
    }
}

#[test]
fn an_empty_range_is_told_rather_than_the_default() {
    insta::assert_snapshot!("empty_range", said_of_block("param zz = 1 in 2 .. 1;"));
}

#[test]
fn a_stationary_model_is_told_how_its_one_solution_is_tested() {
    let still = |value: &str| {
        said(&format!(
            "model still; state s: Number ~ 1; physics rest {{ s == 2; }} test \"it stands\" {{ expect {value} > 1; }}"
        ))
    };
    insta::assert_snapshot!("start_without_time", still("s@start"));
    for value in ["s@(0 s)", "max(s on run)"] {
        assert_eq!(still(value), "", "{value}");
    }
}
