//! What people do wrong on the command line of a simulator, and what it answers; what a run leaves when it fails.

use ansatz::output::results::Results;
use ansatz_tests::models::filled_block;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const CRUSHED: &str = env!("CARGO_BIN_EXE_crushed");
const DRY: &str = env!("CARGO_BIN_EXE_dry");

/// A fresh folder for the results of one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    folder
}

struct Answer {
    code: Option<i32>,
    output: String,
    errors: String,
}

fn call(simulator: &str, arguments: &[&str], out: &Path) -> Answer {
    let done = Command::new(simulator).args(arguments).arg("--out").arg(out).output().expect("it starts");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
    Answer { code: done.status.code(), output: text(done.stdout), errors: text(done.stderr) }
}

/// The simulator refuses these arguments, naming every word, and writes nothing.
#[track_caller]
fn refused(simulator: &str, arguments: &[&str], words: &[&str], code: i32) {
    let out = folder("refused");
    let answer = call(simulator, arguments, &out);
    assert_eq!(answer.code, Some(code), "{}", answer.errors);
    for word in words {
        assert!(answer.errors.contains(word), "`{word}` is missing in: {}", answer.errors);
    }
    assert!(!out.exists(), "results were written");
}

#[test]
fn wrong_parameters_are_refused_by_name() {
    refused(CRUSHED, &["--set", "sped=1 mm/s"], &["no parameter `sped`", "did you mean `speed`?"], 2);
    refused(CRUSHED, &["--set", "w=3 s"], &["`w` is", "Length", "mm", "`3 s` is", "Time"], 2);
    refused(CRUSHED, &["--set", "w=3"], &["`w` is", "needs a unit such as mm"], 2);
    refused(CRUSHED, &["--set", "w=wide"], &["`w=wide` is no quantity"], 2);
    refused(CRUSHED, &["--set", "w=20 mm"], &["`w` = 20 mm is out of its range 1 mm .. 10 mm"], 2);
    refused(CRUSHED, &["--set", "w=0.002 cm"], &["`w` = 0.02 mm is out of its range"], 2);
    refused(CRUSHED, &["--set", "fine=3"], &["`fine` = 3 is not one of 1, 2, 4"], 2);
    refused(CRUSHED, &["--set", "w"], &["write NAME=VALUE"], 2);
    refused(CRUSHED, &["--until", "3"], &["`3` is no time", "write it with a unit"], 2);
    for threads in ["0", "-1", "two", "1.5", "1000", ""] {
        let words = [&*format!("`{threads}` is no number of threads"), "from 1 to 256", "--threads 2"];
        refused(CRUSHED, &["--threads", threads], &words, 2);
    }
    refused(CRUSHED, &["--until", "-1 s"], &["cannot end at -1 s", "its time is 0 s .. "], 2);
    refused(CRUSHED, &["--until", "3600 s"], &["cannot end at 3600 s", "its time is 0 s .. "], 2);
}

#[test]
fn a_geometry_that_does_not_exist_with_these_parameters_names_its_curve() {
    // The polar cap of a sphere of 3 um cannot have more than its surface, 113 um^2.
    refused(DRY, &["--set", "A_n=200 um^2"], &["the geometry is not valid", "nucleus"], 1);
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let file = folder("occupied");
    fs::write(&file, "a file, no folder").unwrap();
    let answer = call(CRUSHED, &[], &file.join("results"));
    assert_eq!(answer.code, Some(1));
    assert!(
        answer.errors.contains("cannot write") && answer.errors.contains("occupied"),
        "{}",
        answer.errors
    );
    assert!(answer.errors.contains("--out"), "what to do: {}", answer.errors);
}

/// Times in the first column of the table.
fn times(out: &Path) -> Vec<f64> {
    let table = fs::read_to_string(out.join("history.csv")).expect("the table is there");
    let number = |line: &str| line.split(',').next().and_then(|t| t.parse().ok()).expect("a number");
    table.lines().skip(1).map(number).collect()
}

fn run_json(out: &Path) -> String {
    fs::read_to_string(out.join("run.json")).expect("the summary is there")
}

#[test]
fn a_run_that_fails_keeps_what_it_has_and_says_why() {
    let out = folder("crushed");
    let answer = call(CRUSHED, &["--quiet"], &out);
    assert_eq!(answer.code, Some(1));
    for word in ["at t = 1.", "u.y at (", "squeezing", "relative residual"] {
        assert!(answer.errors.contains(word), "`{word}` is missing in: {}", answer.errors);
    }
    let times = times(&out);
    assert!(times.len() > 10 && times.iter().all(|t| (0.0..2.0).contains(t)), "{times:?}");
    let summary = run_json(&out);
    assert!(summary.contains("\"outcome\": \"diverged\"") && summary.contains("u.y at ("), "{summary}");
    let list = fs::read_to_string(out.join("fields.pvd")).unwrap();
    for frame in ["fields_00000.vtu", "fields_00003.vtu"] {
        assert!(list.contains(frame) && out.join(frame).exists(), "{frame}");
    }
    assert!(list.trim_end().ends_with("</VTKFile>"), "the list is complete");
}

/// Numbers of the pictures of that name in a folder.
fn pictures(out: &Path, name: &str) -> Vec<String> {
    let files = fs::read_dir(out).expect("the folder is there").flatten();
    let names = files.map(|file| file.file_name().to_string_lossy().into_owned());
    let number = |file: String| {
        let rest = file.strip_prefix(name)?.strip_prefix('_')?.strip_suffix(".png")?;
        rest.bytes().all(|b| b.is_ascii_digit()).then(|| rest.to_owned())
    };
    let mut numbers: Vec<String> = names.filter_map(number).collect();
    numbers.sort();
    numbers
}

#[test]
fn every_scalar_has_its_pictures_and_regions_are_drawn_together_where_their_times_meet() {
    let out = folder("pictures");
    let program = &filled_block::PROGRAM;
    let values = ansatz::settings::resolve(program, &[]).expect("valid parameters");
    let mut simulation = ansatz::Simulation::new(program, &values).expect("a simulation");
    let mut results = Results::create(&out, program).expect("a folder");
    simulation.run(&mut results, None).expect("it runs");
    drop(results);
    assert_eq!(pictures(&out, "p"), ["00000", "00001", "00002"], "the liquid, every second");
    assert_eq!(
        pictures(&out, "fields0_speed").len(),
        3,
        "a column of the liquid and the rubber: here the former"
    );
    assert_eq!(pictures(&out, "fields1_speed").len(), 5, "the rubber, every half second");
    assert!(pictures(&out, "speed").is_empty(), "neither hides the other");
    assert_eq!(pictures(&out, "fields"), ["00000", "00001", "00002"], "both, at the times that they share");
}

#[test]
fn a_run_can_end_early_and_write_tables_only() {
    let out = folder("early");
    let answer =
        call(CRUSHED, &["--until", "300 ms", "--no-frames", "--set", "speed=0.2 mm/s", "--quiet"], &out);
    assert_eq!(answer.code, Some(0), "{}", answer.errors);
    assert_eq!(times(&out).last(), Some(&0.3));
    assert!(!out.join("fields.pvd").exists());
    assert!(run_json(&out).contains("\"threads\": 1"));
}

#[test]
fn an_event_is_told_once_and_counted() {
    let out = folder("beats");
    let answer = call(CRUSHED, &["--until", "300 ms", "--no-frames"], &out);
    assert_eq!(answer.code, Some(0), "{}", answer.errors);
    let lines: Vec<&str> = answer.errors.lines().filter(|line| line.starts_with("beat ")).collect();
    assert_eq!(lines, ["beat at t = 0.10 s", "beat fired 3 times, last at t = 0.30 s"], "{}", answer.errors);
    assert!(!answer.errors.contains(" 1 iterations"), "{}", answer.errors);
    let summary = run_json(&out);
    assert!(summary.contains("\"time\": 0.1") && summary.contains("\"count\": 3"), "{summary}");
}

#[test]
fn the_number_of_threads_is_noted() {
    let out = folder("threads");
    let answer = call(CRUSHED, &["--threads", "2", "--until", "100 ms", "--no-frames", "--quiet"], &out);
    assert_eq!(answer.code, Some(0), "{}", answer.errors);
    assert!(run_json(&out).contains("\"threads\": 2"));
}

#[test]
fn help_lists_the_parameters() {
    let answer = call(CRUSHED, &["--help"], &folder("help"));
    assert_eq!(answer.code, Some(0));
    let line = answer.output.lines().find(|line| line.trim_start().starts_with("w ")).expect("parameter w");
    for word in ["4 mm", "1 .. 10 mm", "width"] {
        assert!(line.contains(word), "{line}");
    }
    assert!(answer.output.contains("--threads <N>"), "{}", answer.output);
    let usage = call(DRY, &["--help"], &folder("help")).output;
    assert!(usage.contains("Usage: dry_contact "), "the name of the model, not of the program: {usage}");
}
