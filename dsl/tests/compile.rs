//! Claims about the compiler as a whole: what it emits, what it refuses, that it says the same twice.

use ansatz_dsl::compile::{Compilation, Output, compile};
use ansatz_dsl::diagnostic::render;

/// The dry model, as it ships.
const DRY: &str = include_str!("../../models/dry/model.ansatz");

fn compiled(name: &str, text: &str) -> Compilation {
    compile(name, text, &mut |path, _| Err(format!("no file {path}")))
}

fn output(name: &str, text: &str) -> Output {
    let compilation = compiled(name, text);
    let report = render(&compilation.diagnostics, &compilation.sources);
    compilation.output.unwrap_or_else(|| panic!("{report}"))
}

/// Codes of the diagnostics of a model on the unit square with these items.
fn codes(items: &str) -> Vec<&'static str> {
    compiled("test.ansatz", &on_square(items)).diagnostics.iter().map(|d| d.code.id()).collect()
}

fn on_square(items: &str) -> String {
    format!(
        "model square;\ncoordinates plane_strain(x, y);\nunits m, s, kg;\n\
         geometry {{ path rim = from (0, 0) line bottom to (1 m, 0) line right to (1 m, 1 m) line top to (0, 1 m) line left to (0, 0);\n\
         region square = loop(rim); }}\nmesh {{ size = 1 m; }}\nsolve {{ nonlinear = newton(tolerance: 1e-8, iterations: 15); }}\n{items}\n"
    )
}

/// One function of an emitted module.
fn function<'a>(rust: &'a str, name: &str) -> &'a str {
    let start = rust.find(&format!("    fn {name}(")).expect("the function is emitted");
    let end = rust[start..].find("\n    }\n").expect("it ends");
    &rust[start..start + end + 6]
}

#[test]
fn the_same_text_gives_the_same_bytes() {
    let (first, second) = (output("model.ansatz", DRY), output("model.ansatz", DRY));
    for stage in first.stage_names() {
        assert_eq!(first.stage(stage), second.stage(stage), "{stage}");
    }
}

#[test]
fn the_dry_model_compiles_without_a_word_and_its_laws_hold() {
    let compilation = compiled("model.ansatz", DRY);
    assert_eq!(render(&compilation.diagnostics, &compilation.sources), "");
    let laws = compilation.output.unwrap().law_tests;
    assert_eq!(laws.failed, 0, "{}", laws.text);
    assert!(laws.text.contains("301 of 301 hold"), "{}", laws.text);
}

#[test]
fn dry_costs() {
    insta::assert_snapshot!(output("model.ansatz", DRY).stage("cost").unwrap());
}

#[test]
fn dry_tangent_kernel() {
    insta::assert_snapshot!(function(&output("model.ansatz", DRY).rust, "elasticity_energy_tangent"));
}

/// A plate that a thermostat heats with a delay: a field, a state, a functional, every kind of output.
const PLATE: &str = "/// temperature of the plate\n\
    field T: Temperature in P1 on square = 300 K;\n\
    state p: Power = 0 W;\n\
    param k = 2 [W/(m*K)] in 0.1 [W/(m*K)] .. 100 [W/(m*K)];\nparam c = 1000 [J/(m^3*K)];\nparam delay = 10 s;\n\
    let middle = mean(T on square);\n\
    physics heat { residual c*test(T)*dt(T) + k*dot(grad(T), grad(test(T))) on square; residual -test(T)*p/area(rim.left) on rim.left; hold T = 300 K on rim.right; }\n\
    physics thermostat { delay*dt(p) == max(0, 5 [W/K]*(320 K - middle)) - p; }\n\
    event warm when middle > 310 K => stop;\n\
    test \"it gets warm\" { expect outcome == warm; expect max(p on run) ~= 100 W within 10 %; }";

fn plate() -> String {
    on_square(PLATE).replace(
        "solve {",
        "solve { time = 0 s .. 100 s; step = sdirk2(max: 1 s, min: 1e-3 s, tolerance: 1e-4);",
    ) + "output { fields on square every 1 s: T, flux = -k*grad(T); table \"heat.csv\" every step: t, p, middle as [K], hottest = max(T on rim.left), T@(0.5 m, 0.5 m); }\n"
}

#[test]
fn a_small_model_from_its_forms_to_rust() {
    let output = output("plate.ansatz", &plate());
    for stage in ["form", "kernel", "cost", "rust"] {
        insta::assert_snapshot!(format!("plate_{stage}"), output.stage(stage).unwrap());
    }
}

#[test]
fn what_kernels_cannot_do_is_refused_by_name() {
    let field = "field u: Vector[Length] in P2 on square = 0; field h: Length in P1 on square = 0; param q = 1 Pa;\n\
                 physics rest { energy q*(dot(u, u) + h^2)/(1 m^2) on square; }\n";
    let refused = |items: &str| codes(&format!("{field}{items}"));
    assert_eq!(refused("physics p { energy q*(1 m)*grad(h).x on rim; }"), ["X901"], "gradients on edges");
    assert_eq!(
        refused("physics p { energy q*mean(h on square)*h/(1 m^2) on square; }"),
        ["X901"],
        "energies of means"
    );
    assert_eq!(
        refused("state s: Length ~ 0; physics p { s == mean(dt(h) on square)*(1 s); }"),
        ["X901"],
        "rates inside functionals"
    );
    assert_eq!(
        refused("physics p { energy q*div(grad(h))^2*(1 m^2) on square; }"),
        ["X901"],
        "second derivatives"
    );
}

#[test]
fn a_mesh_size_on_a_pair_reads_its_gap_and_needs_a_region_that_moves() {
    let size = |size: &str| {
        codes(&format!(
            "field u: Vector[Length] in P2 on square = 0; param q = 1 Pa;
             physics rest {{ energy q*dot(u, u)/(1 m^2) on square; }}
             let film = pair(rim.left, rim.right, search: 2 m);
             mesh {{ size = {size} on film; }}"
        ))
    };
    assert_eq!(size("max(1 mm, film.gap/2)"), ["P005"], "nothing moves between them");
    assert_eq!(size("film.gap*t/(1 s)"), ["N013"], "time");
    assert_eq!(size("film.gap*q"), ["U103"], "no length");
}

#[test]
fn what_cannot_act_on_a_pair_is_refused_by_name() {
    let model = "field u: Vector[Length] in P2 on square = 0; state s: Number = 0; param q = 1 Pa;
                 let film = pair(rim.left, rim.right, search: 2 m);\n\
                 physics rest { energy q*dot(u, u)/(1 m^2) on square; dt(s)*(1 s) == 1; }\n";
    let refused = |items: &str| codes(&format!("{model}{items}"));
    let decaying = "physics p { load u with -s*q*exp(-film.gap/(1 cm))*film.normal on current(film); }";
    assert_eq!(refused(decaying), Vec::<&str>::new());
    assert_eq!(
        refused("physics p { load u with -q*film.normal*norm(u)/film.gap on film; }"),
        ["X901"],
        "fields"
    );
    assert_eq!(
        refused("physics p { load dot(u, u) with -q/film.gap on film; }"),
        ["X901"],
        "work that reads fields"
    );
    assert_eq!(refused("physics p { load grad(u) with q*(1 m)*I on film; }"), ["X901"], "gradients");
    assert_eq!(refused("physics p { energy q*film.gap on current(film); }"), ["X901"], "energies as moved");
    assert_eq!(
        refused("physics p { energy q*film.gap*film.normal.x on film; }"),
        ["X901"],
        "energies of normals"
    );
    assert_eq!(refused("physics p { energy s*q*film.gap on film; }"), ["X901"], "energies of states");
    assert_eq!(
        refused("physics p { residual q*dot(test(u), film.normal)*film.gap on film; }"),
        ["X901"],
        "residuals"
    );
    assert_eq!(
        refused("state f: Volume ~ 0 m^3; physics p { f == integral(film.gap on current(film)); }"),
        ["X901"],
        "equations"
    );
}

/// What is said of the unit square with these items, which have faults that only numbers show.
fn said(items: &str) -> String {
    let rest = "field T: Temperature in P1 on square = 300 K;\nphysics heat { residual test(T)*dt(T)*1 [J/(m^3*K)] on square; }\n";
    let compilation = compiled("square.ansatz", &on_square(&format!("{rest}{items}")));
    render(&compilation.diagnostics, &compilation.sources)
}

#[test]
fn settings_with_which_no_run_can_start_are_refused() {
    let settings = "param n = 0;\nmesh { size = n*1 m on rim.top;  growth = 0.9;  quality = 2; }\n\
        solve { time = 1 s .. 0 s;  step = euler(max: -1 s, min: 0 s, tolerance: 0);  nonlinear = newton(iterations: 0); }";
    insta::assert_snapshot!("settings_out_of_range", said(settings));
}

#[test]
fn intervals_durations_and_ranges_with_which_no_run_can_start_are_refused() {
    let settings = "param n = 0;\nsolve { time = 0 s .. 1 s;  step = euler(max: 1 ms, min: 1 s); }\n\
        state s: Number = 0 in 2 .. 1;\nphysics rest { dt(s)*(1 s) == 1; }\n\
        event a every n*1 s;\nevent b every -1 s;\nevent c when t > 1 s for -2 s;\n\
        output { fields on square every 0 s: T;  table \"t.csv\" every 0 s: t;  checkpoint every 1 s/n; }\n\
        test \"law\" { for x in 0 .. 1 by n { expect x < 2; }  for x in 1 .. 0 by 0.1 { for y in 0 .. x by 1 { expect y < 2; } } }";
    insta::assert_snapshot!("intervals_out_of_range", said(settings));
    let settings = "event a every 0.1 s;  event b every step;  event c when t > 0.1 s for 0 s;\n\
        solve { time = 0 s .. 1 s;  step = euler(max: 1 s, min: 1 s); }\n\
        output { fields on square every step: T;  table \"t.csv\" every 0.1 s: t; }";
    assert_eq!(said(settings), "");
}

#[test]
fn a_load_in_the_plane_acts_on_one_unit_of_depth() {
    let turned = |moment: &str| {
        said(&format!(
            "field beta: Number in P1 on square = 0; param M = 3 N; param E = 1 Pa;
             physics bending {{ energy E*beta^2 on square; load beta@(1 m, 0 m) with {moment}; }}"
        ))
    };
    let per_depth = turned("M");
    assert!(
        per_depth.contains("U104")
            && per_depth.contains("a plane model is 1 m deep")
            && per_depth.contains("`(1 m)`"),
        "{per_depth}"
    );
    assert_eq!(turned("M*(1 m)"), "");
    assert!(!turned("M/(1 m)").contains("deep"), "no depth is missing");
}

#[test]
fn the_origin_needs_no_unit() {
    let at = |place: &str| {
        codes(&format!(
            "field q: Number in P1 on square = 0; param E = 1 Pa; physics rest {{ energy E*q^2 on square; }}
             output {{ table \"q.csv\" every step: middle = q@{place}; }}"
        ))
    };
    for origin in ["(0, 0)", "(0, 0.5 m)", "(0, 0) m"] {
        assert_eq!(at(origin), Vec::<&str>::new(), "{origin}");
    }
    assert_eq!(at("(0, 1)"), ["N003"], "1 has no unit");
}

#[test]
fn a_mesh_size_on_a_pair_is_positive_at_every_gap() {
    let size = |size: &str| {
        said(&format!(
            "param layers = 0; geometry {{ path lid = from (0, 2 m) line face to (1 m, 2 m) line to (1 m, 3 m) line to (0, 3 m) line to (0, 2 m);
               path left = from (0, 2 m) line to (0, 1 m); path right = from (1 m, 1 m) line to (1 m, 2 m);
               region block = loop(lid); region oil = loop(rim.top, left, lid.face, right); }}
             field u: Vector[Length] in P2 on square + block = 0; param q = 1 Pa; moving oil by u;
             physics body {{ energy q*dot(u, u)/(1 m^2) on square + block; }}
             let film = pair(rim.top, lid.face, search: 2 m);
             mesh {{ size = {size} on film; }}"
        ))
    };
    for (wrong, value) in [
        ("0 m", "0 at a gap of 2"),
        ("film.gap/layers", "infinite at a gap of 2"),
        ("film.gap - 0.1 m", "-0.0375 at a gap of 0.0625"),
    ] {
        let words = size(wrong);
        assert!(
            words.contains("N015") && words.contains(value) && words.contains("1 error"),
            "{wrong}: {words}"
        );
    }
    assert_eq!(size("film.gap/3"), "");
}

#[test]
fn paths_that_miss_what_they_are_to_be_attached_to_are_warned_of() {
    let wires = "geometry {\n\
        path beside   = from (1.005 m, 0.25 m) line to (2 m, 0.25 m);\n\
        path across   = from (0.5 m, 0.5 m) line to (2 m, 0.5 m);\n\
        path attached = from (1 m, 1 m) line to (2 m, 1 m);\n}";
    insta::assert_snapshot!("loose_ends", said(wires));
}

#[test]
fn regions_that_are_open_or_interpenetrate_are_refused() {
    let open = "geometry { path wall = from (0, 0) line left to (0, -1 m) line floor to (1 m, -1 m) line right to (1 m, -0.05 m);\n\
        region cavity = loop(rim.bottom, wall); }";
    insta::assert_snapshot!("open_cavity", said(open));
    let ball = "geometry { path skin = from (0.5 m, 0.9 m) arc about (0.5 m, 1.2 m) ccw to (0.5 m, 1.5 m) arc about (0.5 m, 1.2 m) ccw to (0.5 m, 0.9 m);\n\
        region ball = loop(skin); }";
    insta::assert_snapshot!("interpenetrating", said(ball));
}

#[test]
fn a_force_that_ends_in_a_jump_warns_with_the_numbers() {
    let film = |d_0: &str| {
        let model = format!(
            "field u: Vector[Length] in P2 on square = 0; param d_0 = {d_0}; param P_0 = 100 kPa;\n\
             physics rest {{ energy P_0*dot(u, u)/(1 m^2) on square; }}\n\
             let film = pair(rim.left, rim.right, search: 6 um);\n\
             fn P_rep(d: Length) -> Pressure = P_0/2*(1 + tanh(1 um/d - 1 um/d_0));\n\
             physics p {{ load u with -P_rep(film.gap)*film.normal on current(film); }}"
        );
        let compilation = compiled("film.ansatz", &on_square(&model));
        render(&compilation.diagnostics, &compilation.sources)
    };
    insta::assert_snapshot!("jump_at_search", film("0.588 um"));
    assert_eq!(film("0.17 um"), "");
}

#[test]
fn geometries_are_built_with_the_default_parameters() {
    let text = on_square("")
        .replace("to (0, 1 m)", "to (0.5 m, 1 m)")
        .replace("left to (0, 0)", "left to (0.1 m, 0.2 m)");
    let compilation = compiled("test.ansatz", &text);
    let codes: Vec<_> = compilation.diagnostics.iter().map(|d| d.code.id()).collect();
    assert_eq!(codes, ["G301"], "{}", render(&compilation.diagnostics, &compilation.sources));
}

#[test]
fn defaults_lie_within_their_ranges() {
    assert_eq!(codes("param r = 3 m in 4 m .. 5 m;"), ["G304"]);
    assert_eq!(codes("param r = 3 m in {1, 2} m;"), ["G304"]);
    assert_eq!(codes("param s = 2 m; param r = 3 m in 0 m .. 2*s;"), Vec::<&str>::new());
}

#[test]
fn the_pieces_of_a_match_meet() {
    let law = |second: &str, promise: &str| {
        codes(&format!(
            "fn f(x: Length) -> Length = match x {{ < 1 m => x, < 2 m => {second}, else => 3*x - 4 m }} {promise};\nlet value = f(1 m);"
        ))
    };
    assert_eq!(law("2*x - 1 m", ""), ["T402"], "2 x - 1 is 3 at the bound 2, where 3 x - 4 is 2");
    assert_eq!(law("x", ""), Vec::<&str>::new());
    assert_eq!(law("x", "C1"), ["T402"], "the slope turns from 1 to 3");
    assert_eq!(law("2*x - 1 m", "jumps"), Vec::<&str>::new());
    assert_eq!(
        codes("state s: Number = 0; physics p { dt(s)*(1 s) == match s { < 2 => s, else => 3 }; }"),
        ["T402"],
        "in equations"
    );
}

#[test]
fn a_test_that_fails_warns_with_the_numbers() {
    let compilation = compiled("test.ansatz", &on_square("test \"two\" { expect 1 + 1 ~= 3 within 10 %; }"));
    assert_eq!(compilation.output.unwrap().law_tests.failed, 1);
    assert!(
        compilation.diagnostics[0].message.contains("found 2e0, expected 3e0"),
        "{}",
        compilation.diagnostics[0].message
    );
}

#[test]
fn a_state_without_an_equation_gets_the_balance_of_its_energies() {
    let items = "field h: Length in P1 on square = 0; param q = 1 Pa; param k = 3 [N/m]; state s: Length ~ 0;\n\
                 let middle = mean(h on square);\n\
                 physics rest { energy q*(dot(grad(h), grad(h)) + h^2/(1 m^2)) on square; }\n\
                 physics spring { energy k/2*(s - middle)^2; load s with 2 N; }";
    let text = output("spring.ansatz", &on_square(items)).stage("form").unwrap().to_owned();
    let line = |start: &str| {
        text.lines().map(str::trim).find(|line| line.starts_with(start)).unwrap_or_default().to_owned()
    };
    // The balance k (s - middle) - 2, divided by its size k.
    assert!(line("residual = ").ends_with("*(-2 + k*(s - middle))"), "{text}");
    assert_eq!(line("work on middle"), "work on middle = k*(middle - s)");
}
