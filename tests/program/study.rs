//! `pantin study` from outside, by many processes in one folder.

use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::Duration;

use super::support::{pantin, program, refused, stderr, stdout, succeeded};

const STUDY: &str = r#"
name = "shared"
seeds = [1, 2, 3, 4]
particles = [24]
iterations = [3]
backends = ["cpu"]
models = ["flat"]
[[sequence]]
preset = "demo"
length = 4
[[sequence]]
name = "turned"
preset = "demo"
length = 4
[[table]]
name = "errors"
value = "error"
rows = ["sequence"]
columns = []
"#;

fn begun(file: &Path, output: &Path, index: usize) -> Child {
    let mut command = program();
    command.arg("study").arg(file).arg("-o").arg(output).args(["--run", &index.to_string()]);
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

/// Eight processes at once, two of them killed and begun again, leave what one process leaves.
#[test]
fn processes_that_share_a_folder_leave_what_one_leaves() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("study.toml");
    fs::write(&file, STUDY).unwrap();
    let [serial, shared] = ["serial", "shared"].map(|name| folder.path().join(name));
    let study = |output: &Path, more: &[&str]| {
        pantin(&[&["study", file.to_str().unwrap(), "-o", output.to_str().unwrap()], more].concat())
    };
    succeeded(&study(&serial, &[]));

    let plan = study(&shared, &["--plan"]);
    succeeded(&plan);
    assert!(!shared.exists(), "a plan writes nothing");
    let plan = stdout(&plan);
    let runs: Vec<serde_json::Value> = plan.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(runs.len(), 8);
    assert!(runs.iter().enumerate().all(|(index, run)| run["index"] == index), "{plan}");

    let mut children: Vec<Child> = (0..8).map(|index| begun(&file, &shared, index)).collect();
    std::thread::sleep(Duration::from_millis(300));
    for killed in [1, 6] {
        children[killed].kill().unwrap();
        children[killed].wait().unwrap();
        children[killed] = begun(&file, &shared, killed);
    }
    // The same run twice at a time.
    children.push(begun(&file, &shared, 3));
    for child in &mut children {
        assert!(child.wait().unwrap().success());
    }
    succeeded(&study(&shared, &["--collect"]));
    let read = |output: &Path, name: &str| fs::read_to_string(output.join(name)).unwrap();
    assert_eq!(read(&serial, "table-errors.csv"), read(&shared, "table-errors.csv"));
    for run in &runs {
        for name in ["poses.csv", "joints.csv", "confidence.csv"] {
            let name = format!("{}/{name}", run["folder"].as_str().unwrap());
            assert!(read(&serial, &name) == read(&shared, &name), "{name}");
        }
    }
}

#[test]
fn a_part_of_a_study_is_collected_and_wrong_numbers_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("study.toml");
    fs::write(&file, STUDY).unwrap();
    let output = folder.path().join("out");
    let study =
        |more: &[&str]| pantin(&[&["study", file.to_str().unwrap(), "-o", output.to_str().unwrap()], more].concat());
    refused(&study(&["--collect"]), &["there is no folder", "to collect runs from"]);
    refused(&study(&["--run", "8"]), &["there is no run 8 of 8, expected 0 to 7"]);
    let one = study(&["--run", "2"]);
    succeeded(&one);
    assert!(stdout(&one).contains("_seed2: "), "{}", stdout(&one));
    let again = study(&[]);
    refused(&again, &["is not empty: go on with the study in it by --resume"]);
    assert!(!stderr(&again).contains("--force"), "it has none: {}", stderr(&again));
    let part = study(&["--collect"]);
    succeeded(&part);
    assert!(stdout(&part).contains("1 runs in"), "{}", stdout(&part));
    assert!(String::from_utf8_lossy(&part.stderr).contains("7 runs are not there yet"));
    assert_eq!(study(&["--run", "2", "--plan"]).status.code(), Some(2));
}
