#![allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]

use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::Result;

use super::*;
use crate::files::OutputFolder;
use crate::search::SearchSettings;
use crate::track::TrackSettings;

const SMALL: &str = r#"
name = "small"
seeds = [1, 2]
particles = [12, 24]
iterations = [2]
backends = ["cpu"]
spread = 0.5
[[sequence]]
preset = "demo"
length = 3
[[table]]
name = "errors"
value = "error"
rows = ["particles"]
columns = ["sequence"]
[[plot]]
name = "errors"
value = "error"
x = "particles"
[[shares]]
name = "stages"
bars = ["particles"]
"#;

/// Stops when so many runs are done.
struct StopAfter {
    runs: usize,
    done: AtomicUsize,
}

impl StopAfter {
    fn new(runs: usize) -> Self {
        Self { runs, done: AtomicUsize::new(0) }
    }
}

impl Progress for StopAfter {
    fn ran(&self, _run: &Run, _outcome: Result<&Outcome, &anyhow::Error>) {
        self.done.fetch_add(1, Ordering::SeqCst);
    }

    fn should_stop(&self) -> bool {
        self.done.load(Ordering::SeqCst) >= self.runs
    }
}

fn results(rows: &[Row]) -> Vec<(Run, usize, Option<f64>, f64)> {
    rows.iter().map(|row| (row.run.clone(), row.outcome.points, row.outcome.error, row.outcome.fitness)).collect()
}

#[test]
fn a_stopped_study_goes_on_to_the_same_rows() {
    let study = Study::parse(SMALL, "small.toml").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let whole = OutputFolder::open(&folder.path().join("whole")).unwrap();
    let all = run(&study, &whole, &StopAfter::new(usize::MAX)).unwrap();
    assert_eq!((all.rows.len(), all.left, all.failures.len()), (4, 0, 0));
    assert!(all.rows.iter().all(|row| row.outcome.frames == 3 && row.outcome.error.is_some()));
    // Seeds and particles make a difference.
    assert_ne!(all.rows[0].outcome.error, all.rows[2].outcome.error);

    let parts = OutputFolder::open(&folder.path().join("parts")).unwrap();
    let first = run(&study, &parts, &StopAfter::new(1)).unwrap();
    assert_eq!((first.rows.len(), first.left), (1, 3));
    let watch = StopAfter::new(usize::MAX);
    let rest = run(&study, &parts, &watch).unwrap();
    assert_eq!(watch.done.load(Ordering::SeqCst), 3, "runs that were done are not made again");
    assert_eq!(results(&rest.rows), results(&all.rows));

    let table = std::fs::read_to_string(parts.path().join("runs.csv")).unwrap();
    assert_eq!(table.lines().count(), 5, "{table}");
    assert!(table.starts_with(
        "sequence,backend,model,objective,search,particles,iterations,evaluations,seed,frames,points,error_mm,"
    ));
    let table = std::fs::read_to_string(parts.path().join("table-errors.csv")).unwrap();
    let cells: Vec<&str> = table.lines().nth(1).unwrap().split(',').collect();
    let errors: Vec<f64> = [0, 2].map(|seed| all.rows[seed].outcome.error.unwrap()).to_vec();
    let mean = (errors[0] + errors[1]) / 2.0;
    assert_eq!(cells[..3], ["12", "demo", "2"]);
    assert!((cells[3].parse::<f64>().unwrap() - mean).abs() < 1e-4, "{table}: {mean}");
    for name in ["plot-errors.svg", "plot-stages.svg", "tables.md", "stages.csv"] {
        assert!(std::fs::metadata(parts.path().join(name)).unwrap().len() > 50, "{name}");
    }

    // The same names with another spread are another study.
    let other = Study { spread: 0.7, ..study };
    let error = run(&other, &parts, &StopAfter::new(0)).unwrap_err().to_string();
    assert!(error.contains("row.json") && error.contains("spread 0.5") && error.contains("0.7"), "{error}");
}

/// A run in real time stands beside the one without a clock, with what it passed over, in rows that are read as they were written.
#[test]
fn real_time_is_a_pace_of_a_study() {
    let text = SMALL.replace("[1, 2]", "[1]").replace("[12, 24]", "[12]");
    let text = text.replace("spread = 0.5\n", "spread = 0.5\npaces = [\"offline\", \"realtime\"]\n");
    let study = Study::parse(&text, "s").unwrap();
    let runs = study.runs().unwrap();
    assert_eq!(runs.len(), 2);
    assert!(runs[1].folder().contains("12x2_realtime_seed1") && !runs[0].folder().contains("offline"));
    let folder = tempfile::tempdir().unwrap();
    let output = OutputFolder::open(folder.path()).unwrap();
    let summary = run(&study, &output, &StopAfter::new(usize::MAX)).unwrap();
    let skipped: Vec<Option<f64>> = summary.rows.iter().map(|row| row.outcome.skipped).collect();
    assert!(skipped[0].is_none() && skipped[1].is_some_and(|share| (0.0..1.0).contains(&share)), "{skipped:?}");
    let read = runs_csv::read_rows(folder.path()).unwrap();
    for (read, row) in read.iter().zip(&summary.rows) {
        assert_eq!((Axis::Pace.of(&read.run), read.run.seed), (Axis::Pace.of(&row.run), row.run.seed));
        assert!((read.outcome.error.unwrap() - row.outcome.error.unwrap()).abs() < 1e-4);
        assert_eq!(read.outcome.stages.len(), row.outcome.stages.len());
    }
    // What is stopped midway is no run of the study, though it ends well with the poses that it has.
    let stopped = OutputFolder::open(&folder.path().join("stopped")).unwrap();
    assert!(run_one(&study, &stopped, 1, &StopAfter::new(0)).unwrap().is_none());
    let row = run_one(&study, &stopped, 1, &StopAfter::new(usize::MAX)).unwrap().unwrap();
    assert!(row.outcome.skipped.is_some());
    let error = Study::parse(&text.replace("spread", "passes = \"both\"\nspread"), "s").unwrap_err();
    assert!(format!("{error:#}").contains("paces holds realtime"), "{error:#}");
}

#[test]
fn a_failing_run_does_not_end_the_study() {
    let text = SMALL.replace("[1, 2]", "[1]").replace("[12, 24]", "[12]");
    let text = text.replace("backends = [\"cpu\"]", "models = [\"elliptic-18\"]\nbackends = [\"cpu\"]");
    let late = "[[sequence]]\npreset = \"demo\"\nname = \"late\"\nlength = 3\nframes = \"2..9\"\n";
    let study = Study::parse(&text.replace("[[table]]", &format!("{late}[[table]]")), "s").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let summary = run(&study, &OutputFolder::open(folder.path()).unwrap(), &StopAfter::new(9)).unwrap();
    // The preset has fewer frames.
    assert_eq!((summary.rows.len(), summary.failures.len()), (1, 1));
    let (failed, error) = &summary.failures[0];
    assert_eq!(failed.model.to_string(), "elliptic-18");
    assert!(format!("{error:#}").contains("reach past the end"), "{error:#}");
    let body = std::fs::read_to_string(folder.path().join("bodies/demo_elliptic-18.toml")).unwrap();
    assert!(body.contains("vertices = 18"), "{body}");
}

#[test]
fn statistics_are_those_of_a_sample() {
    assert_eq!(Statistic::of([]), None);
    assert_eq!(Statistic::of([3.0]), Some(Statistic { count: 1, mean: 3.0, std: 0.0 }));
    assert_eq!(Statistic::of([1.0, 3.0]), Some(Statistic { count: 2, mean: 2.0, std: 2.0_f64.sqrt() }));
}

#[test]
fn a_study_that_names_no_setting_tracks_as_track_does() {
    let text = "name = \"s\"\nseeds = [1]\n[[sequence]]\npreset = \"demo\"\n";
    let runs = Study::parse(text, "s").unwrap().runs().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let settings = runner::settings(&runs[0], folder.path()).unwrap();
    let search = SearchSettings { seed: 1, ..SearchSettings::default() };
    assert_eq!(settings, TrackSettings { search, overlay_every: 0, ..TrackSettings::default() });
    assert!(runs[0].folder().contains("_usual_"), "{}", runs[0].folder());
}

#[test]
fn every_setting_is_combined_with_every_other() {
    let text = SMALL.replace("[12, 24]", "[12, 24, 36]").replace("backends", "objectives = [\"ws\", \"sp\"]\nbackends");
    let runs = Study::parse(&text, "s").unwrap().runs().unwrap();
    assert_eq!(runs.len(), 12);
    let folders: std::collections::HashSet<String> = runs.iter().map(Run::folder).collect();
    assert_eq!(folders.len(), 12);
    assert!(runs[..6].iter().all(|run| run.seed == 1), "a whole seed comes first");
}

#[test]
fn ways_of_graphics_to_draw_are_backends_of_a_study() {
    let text = SMALL.replace("[\"cpu\"]", "[\"graphics\", \"graphics-depth-readback\"]");
    let runs = Study::parse(&text, "s").unwrap().runs().unwrap();
    let ways = |name: &str| runs.iter().filter(|run| run.folder().contains(&format!("_{name}_flat_"))).count();
    assert_eq!((ways("graphics"), ways("graphics-depth-readback")), (runs.len() / 2, runs.len() / 2));
    let run = runs.iter().find(|run| Axis::Backend.of(run) == "graphics-depth-readback").unwrap();
    let again: Run = serde_json::from_str(&serde_json::to_string(run).unwrap()).unwrap();
    assert_eq!(again, *run);
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(runner::settings(run, folder.path()).unwrap().drawing.graphics.name(), "depth-readback");
}

#[test]
fn what_makes_no_sense_is_named() {
    for (from, to, sentences) in [
        ("name = \"small\"", "nam = \"small\"", &["line 2", "`nam`", "`name`"][..]),
        ("[1, 2]", "[]", &["seeds is empty"]),
        ("[1, 2]", "[2, 2]", &["seeds holds 2 twice"]),
        ("[1, 2]", "3", &["line 3", "integer `3`"]),
        ("[12, 24]", "[12, -1]", &["line 4"]),
        ("[\"cpu\"]", "[\"gpu\"]", &["line 6", "unknown backend `gpu`", "auto, reference, cpu, compute, graphics"]),
        ("spread = 0.5", "objectives = [\"best\"]", &["unknown objective `best`", "ws, sp, aows, aosp, posp"]),
        ("spread = 0.5", "searches = [\"best\"]", &["unknown search `best`", "pso, pf, apf, hpso, cmaes, maes"]),
        ("spread = 0.5", "models = [\"elliptic-19\"]", &["unknown model `elliptic-19`", "nearest is `elliptic-18`"]),
        ("preset = \"demo\"", "", &["neither `path` nor `preset`"]),
        ("preset = \"demo\"", "preset = \"demo\"\npath = \"walk\"", &["both `path` and `preset`"]),
        ("preset = \"demo\"\nlength", "path = \"walk\"\nlength", &["\"walk\"", "`length` stands beside `path`"]),
        ("length = 3", "length = 0", &["length is 0"]),
        ("length = 3", "frames = \"3-4\"", &["frames", "`3-4` is no range"]),
        ("length = 3", "name = \"a/b\"", &["\"a/b\" cannot be part of a file's name"]),
        ("length = 3", "[[sequence]]\npreset = \"demo\"", &["two sequences are named \"demo\""]),
        ("rows = [\"particles\"]", "rows = []", &["[[table]] \"errors\"", "rows is empty"]),
        ("rows = [\"particles\"]", "rows = [\"sequence\"]", &["`sequence` stands twice"]),
        (
            "x = \"particles\"",
            "x = \"search\"",
            &["[[plot]] \"errors\"", "expected `particles`, `iterations` or `evaluations`"],
        ),
        ("value = \"error\"\nrows", "value = \"eror\"\nrows", &["`eror`", "`error`"]),
        ("spread = 0.5", "spread = inf", &["spread is inf, expected 0.01 to 100"]),
        ("length = 3", "length = 3\nspread = 0.0", &["\"demo\"", "spread is 0, expected 0.01 to 100"]),
        ("[12, 24]", "[12, 0]", &["particles"]),
        ("spread = 0.5", "paces = [\"late\"]", &["unknown pace `late`", "offline, realtime"]),
        ("x = \"particles\"", "x = \"particles\"\nsequence = \"dem\"", &["there is no sequence `dem`", "demo"]),
        (
            "[[plot]]",
            "[[shares]]\nname = \"Errors\"\nbars = [\"model\"]\n[[plot]]",
            &["two [[plot]] or [[shares]] are named \"Errors\""],
        ),
        (
            "[[plot]]",
            "[[table]]\nname = \"errors\"\nvalue = \"error\"\nrows = [\"search\"]\ncolumns = []\n[[plot]]",
            &["two [[table]] are named \"errors\""],
        ),
    ] {
        assert!(SMALL.contains(from), "{from}");
        let error = format!("{:#}", Study::parse(&SMALL.replacen(from, to, 1), "small.toml").unwrap_err());
        assert!(error.starts_with("small.toml"), "{error}");
        for sentence in sentences {
            assert!(error.contains(sentence), "`{error}` lacks `{sentence}`");
        }
    }
}

#[test]
fn the_ready_studies_are_studies() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/studies");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|end| end == "toml") {
            let study = Study::load(&path).unwrap();
            assert!(!study.runs().unwrap().is_empty());
            count += 1;
        }
    }
    assert!(count >= 6, "{count} studies");
}
