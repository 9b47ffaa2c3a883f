//! The harness itself, on small scenes: every library finds the right pairs, is timed, and
//! appears in the table and the plots.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Scenes of ties as well as easy ones, so that a library that takes touching boxes for apart
/// is found out.
const SCENES: [&str; 6] = ["uniform", "grid", "points", "mixed", "tower", "box-pruning"];
const EVERYWHERE: &[&str] = &[
    "sweep-and-prune",
    "sweep-and-prune, 2 threads",
    "sweep-and-prune, two at once",
    "sweep-and-prune, fresh",
    "one-axis sweep, vectorized",
    "plain sweep",
    "brute force",
    #[cfg(feature = "light")]
    "obvhs",
    #[cfg(feature = "light")]
    "packed_spatial_index",
    #[cfg(feature = "light")]
    "parry",
    #[cfg(feature = "light")]
    "rstar",
];
const ONLY_IN_2D: &[&str] = if cfg!(feature = "light") { &["broccoli", "geo-index"] } else { &[] };

fn bench(arguments: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sweep-and-prune-bench"));
    let output = command.args(arguments).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?} failed: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name).join("results");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Measures finding all pairs.
fn measure(file: &Path, arguments: &[&str]) -> (String, Value) {
    measure_part("--pairs", file, arguments)
}

/// Measures without a limit of time, if none is given: a busy machine is no fault.
fn measure_part(part: &str, file: &Path, arguments: &[&str]) -> (String, Value) {
    let shared =
        ["measure", part, "--rounds", "2", "--seeds", "4", "--output", file.to_str().unwrap()];
    let unlimited: &[&str] = if arguments.contains(&"--limit") { &[] } else { &["--limit", "1e5"] };
    let said = bench(&[&shared, unlimited, arguments].concat());
    (said, serde_json::from_slice(&fs::read(file).unwrap()).unwrap())
}

fn cases(record: &Value) -> &Vec<Value> {
    record["cases"].as_array().unwrap()
}

#[test]
fn every_library_is_right_and_timed_and_reported() {
    let folder = folder("all");
    let file = folder.join("here.json");
    let (_, record) = measure(&file, &["--sizes", "300", "--scenes", &SCENES.join(",")]);
    // Every scene in two dimensions and in three, but for the one that is only in 3D.
    assert_eq!(cases(&record).len(), 2 * SCENES.len() - 1);
    for case in cases(&record) {
        let results = case["results"].as_array().unwrap();
        let two = case["dimensions"] == 2;
        let expected = EVERYWHERE.iter().chain(ONLY_IN_2D.iter().filter(|_| two));
        for name in expected.clone() {
            let entry = results.iter().find(|entry| entry["name"] == **name);
            let entry = entry.unwrap_or_else(|| panic!("{name} is missing in {case}"));
            let times = &entry["outcome"]["Timed"];
            assert!(times["median_ns"].as_f64().is_some_and(|ns| ns > 0.0), "{entry} in {case}");
            assert_eq!(times["rounds_ns"].as_array().unwrap().len(), 2);
            assert!(times["ratio"].as_f64().is_some_and(|ratio| ratio > 0.0));
        }
        assert!(results.len() >= expected.count());
        assert_eq!(case["reference"], "brute force");
    }
    for name in EVERYWHERE.iter().chain(ONLY_IN_2D) {
        assert_ne!(record["versions"][name], "unknown");
    }

    bench(&["report", "--results", folder.to_str().unwrap()]);
    let report = fs::read_to_string(folder.with_file_name("RESULTS.md")).unwrap();
    for scene in SCENES {
        assert!(report.contains(&format!("#### {scene} 3D")), "{scene} is missing");
        let plot = fs::read_to_string(folder.join(format!("here/{scene}-3d.svg"))).unwrap();
        assert!(plot.contains("<svg") && plot.contains("plain sweep"), "{scene} has no plot");
    }
    for name in EVERYWHERE.iter().chain(ONLY_IN_2D) {
        assert!(report.contains(&format!("| {name} |")), "{name} is missing");
    }
}

#[cfg(feature = "light")]
#[test]
fn beyond_the_oracle_two_libraries_have_to_agree() {
    let folder = folder("witnesses");
    let arguments = ["--sizes", "11000", "--scenes", "slab", "--dimensions", "2"];
    let libraries = ["--libraries", "plain,broccoli"];
    let (_, record) =
        measure(&folder.join("here.json"), &[&arguments[..], &libraries[..]].concat());
    assert_eq!(cases(&record)[0]["reference"], "plain sweep and broccoli agree");
}

#[test]
fn what_takes_too_long_is_stopped_and_recorded() {
    let folder = folder("slow");
    // The limit is about seventy times what a plain sweep takes, for a busy machine.
    let arguments = ["--sizes", "200000", "--scenes", "tower", "--dimensions", "2"];
    let few = ["--libraries", "plain,brute", "--limit", "10"];
    let (_, record) = measure(&folder.join("here.json"), &[&arguments[..], &few[..]].concat());
    let results = cases(&record)[0]["results"].as_array().unwrap();
    let slow = results.iter().find(|entry| entry["name"] == "brute force").unwrap();
    assert_eq!(slow["outcome"]["Untimed"]["why"], "over 10 s");
    let fast = results.iter().find(|entry| entry["name"] == "plain sweep").unwrap();
    assert!(fast["outcome"]["Timed"].is_object(), "{fast}");
}

#[test]
fn too_many_pairs_are_left_out_and_new_cases_join_the_old() {
    let folder = folder("joined");
    let file = folder.join("here.json");
    let few = ["--libraries", "plain", "--dimensions", "2"];
    let (_, record) =
        measure(&file, &[&few[..], &["--scenes", "uniform", "--sizes", "100"]].concat());
    assert_eq!(cases(&record).len(), 1);
    let (said, record) =
        measure(&file, &[&few[..], &["--scenes", "nested", "--sizes", "100,100000"]].concat());
    assert_eq!(cases(&record).len(), 2);
    assert!(said.contains("nested 2D 100000: left out"), "{said}");
    let (_, record) =
        measure(&file, &[&few[..], &["--scenes", "nested", "--sizes", "100"]].concat());
    assert_eq!(cases(&record).len(), 2);
}

#[test]
fn boxes_in_motion_are_checked_frame_by_frame_and_small_inputs_against_brute_force() {
    let folder = folder("motion");
    let file = folder.join("here.json");
    let scenes =
        ["--scenes", "teleport,uniform", "--dimensions", "3", "--libraries", "plain,brute"];
    let (_, record) = measure(&file, &[&scenes[..], &["--sizes", "0,1,20,300"]].concat());
    assert_eq!(cases(&record).len(), 8);
    for entry in cases(&record).iter().flat_map(|case| case["results"].as_array().unwrap()) {
        assert!(entry["outcome"]["Timed"].is_object(), "{entry}");
    }
    bench(&["report", "--results", folder.to_str().unwrap()]);
    let report = fs::read_to_string(folder.with_file_name("RESULTS.md")).unwrap();
    assert!(report.contains("### Small inputs"), "{report}");
}

#[test]
fn no_part_measures_again_what_another_has_with_more_libraries() {
    let file = folder("parts").join("here.json");
    let boxes = ["--sizes", "100", "--scenes", "uniform", "--dimensions", "2"];
    let (_, record) = measure(&file, &[&["--small", "--flat", "--worlds"][..], &boxes].concat());
    assert_eq!((cases(&record).len(), record["worlds"].as_array().unwrap().len()), (1, 0));
    let results = cases(&record)[0]["results"].as_array().unwrap();
    assert!(
        results.iter().any(|entry| entry["name"] == "one-axis sweep, vectorized"),
        "{results:?}"
    );

    let output = file.to_str().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_sweep-and-prune-bench"));
    command.args([&["measure", "--worlds", "--output", output][..], &boxes].concat());
    let done = command.output().unwrap();
    assert!(!done.status.success());
    assert!(String::from_utf8_lossy(&done.stderr).contains("nothing to measure"), "{done:?}");
}

#[test]
fn worlds_are_checked_event_by_event_and_reported() {
    let folder = folder("worlds");
    let file = folder.join("here.json");
    let (_, record) = measure_part("--worlds", &file, &["--sizes", "300"]);
    let worlds = record["worlds"].as_array().unwrap();
    // Four motions in two dimensions and in three.
    assert_eq!((worlds.len(), cases(&record).len()), (8, 0));
    let mut names = vec!["sweep-and-prune", "sweep-and-prune, from scratch"];
    if cfg!(feature = "light") {
        names.extend(["packed_spatial_index, from scratch", "rapier"]);
    }
    for world in worlds {
        assert_eq!(world["reference"], "brute force");
        for &name in &names {
            let results = world["results"].as_array().unwrap();
            let entry = results.iter().find(|entry| entry["name"] == name).unwrap();
            let times = &entry["outcome"]["Timed"];
            assert!(times["median_ns"].as_f64().is_some_and(|ns| ns > 0.0), "{entry} in {world}");
            // Only rapier's boxes are larger than those it is given.
            assert_eq!(times["exact_ns"].is_number(), name == "rapier", "{entry} in {world}");
        }
    }
    bench(&["report", "--results", folder.to_str().unwrap()]);
    let report = fs::read_to_string(folder.with_file_name("RESULTS.md")).unwrap();
    assert!(report.contains("## Worlds") && report.contains("#### mostly-still 3D"), "{report}");
    let plot = fs::read_to_string(folder.join("here/world-fast-2d.svg")).unwrap();
    assert!(names.iter().all(|name| plot.contains(name)));
}

#[test]
fn static_boxes_are_never_paired_with_each_other_and_the_time_to_insert_is_kept() {
    let folder = folder("statics");
    let file = folder.join("here.json");
    let (_, record) = measure_part("--statics", &file, &["--sizes", "3000"]);
    let levels = record["statics"].as_array().unwrap();
    assert_eq!(levels.len(), 2);
    let mut names = vec!["sweep-and-prune", "sweep-and-prune, resting"];
    if cfg!(feature = "light") {
        names.push("rapier");
    }
    if cfg!(feature = "cpp") {
        names.push("Bullet tree");
    }
    for level in levels {
        assert_eq!(level["reference"], "brute force");
        assert!(level["pairs"].as_u64().is_some_and(|pairs| pairs > 500), "{level}");
        for name in &names {
            let results = level["results"].as_array().unwrap();
            let entry = results.iter().find(|entry| entry["name"] == **name).unwrap();
            let times = &entry["outcome"]["Timed"];
            for field in ["median_ns", "start_ns"] {
                assert!(times[field].as_f64().is_some_and(|ns| ns > 0.0), "{entry} in {level}");
            }
        }
    }
    bench(&["report", "--results", folder.to_str().unwrap()]);
    let report = fs::read_to_string(folder.with_file_name("RESULTS.md")).unwrap();
    assert!(report.contains("## Many static boxes"), "{report}");
}

#[test]
fn intervals_are_checked_against_brute_force_and_both_questions_are_asked() {
    let folder = folder("intervals");
    let file = folder.join("here.json");
    let (_, record) = measure_part("--intervals", &file, &["--sizes", "500"]);
    let cases = record["intervals"].as_array().unwrap();
    // Five draws, in two orders, with two questions.
    assert_eq!(cases.len(), 20);
    let names: &[&str] = if cfg!(feature = "intervals") {
        &["sweep-and-prune", "coitrees", "superintervals"]
    } else {
        &["sweep-and-prune"]
    };
    for case in cases {
        assert_eq!(case["reference"], "brute force");
        for name in names {
            let results = case["results"].as_array().unwrap();
            let entry = results.iter().find(|entry| entry["name"] == **name).unwrap();
            assert!(entry["outcome"]["Timed"].is_object(), "{entry} in {case}");
        }
    }
    bench(&["report", "--results", folder.to_str().unwrap()]);
    let report = fs::read_to_string(folder.with_file_name("RESULTS.md")).unwrap();
    assert!(report.contains("| two-sets-long sorted counts | 500 |"), "{report}");
}

#[test]
fn a_run_that_was_stopped_goes_on_where_it_was() {
    let folder = folder("resumed");
    let file = folder.join("here.json");
    let few = ["--scenes", "uniform", "--dimensions", "2"];
    let (_, before) = measure_part("--small", &file, &few);
    assert_eq!(cases(&before).len(), 8);
    let all = [&few[..], &["--resume", "--sizes", "5,6"]].concat();
    let (said, after) = measure_part("--small", &file, &all);
    assert!(said.contains("uniform 2D 6:") && !said.contains("uniform 2D 5:"), "{said}");
    assert_eq!(cases(&after).len(), 9);
    assert_eq!(cases(&before)[..], cases(&after)[..8]);
}

#[test]
fn a_file_of_raw_boxes_is_a_scene() {
    let folder = folder("file");
    let boxes = folder.join("boxes.f32");
    let rows = [[0.0f32, 0.0, 1.0, 1.0], [1.0, 1.0, 2.0, 2.0], [1.5, 0.0, 2.0, 0.5]];
    let bytes: Vec<u8> = rows.iter().flatten().flat_map(|at| at.to_le_bytes()).collect();
    fs::write(&boxes, bytes).unwrap();
    let arguments = ["--scenes", boxes.to_str().unwrap(), "--sizes", "3", "--dimensions", "2"];
    let (_, record) = measure(&folder.join("here.json"), &arguments);
    assert_eq!(cases(&record)[0]["pairs"], 1);
}
