//! `pantin batch` from outside, and how many threads work.

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use super::support::{pantin, program, refused, stderr, stdout, succeeded};

const QUICK: [&str; 8] = ["--backend", "cpu", "--particles", "24", "--iterations", "3", "--overlay-every", "0"];

/// A folder of trials: three short walks, one of them two folders down.
fn trials(folder: &Path) -> String {
    let walk = folder.join("walk");
    succeeded(&pantin(&["synth", "--preset", "demo", "--frames", "4", "-o", walk.to_str().unwrap()]));
    for name in ["anna/jump 1", "anna/jump 2", "bert"] {
        let copy = folder.join("trials").join(name);
        copied(&walk, &copy);
    }
    folder.join("trials").to_str().unwrap().to_string()
}

fn copied(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let place = to.join(entry.file_name());
        if entry.path().is_dir() {
            copied(&entry.path(), &place);
        } else {
            fs::copy(entry.path(), place).unwrap();
        }
    }
}

fn batch(arguments: &[&str]) -> Vec<String> {
    let all = [&["batch"], arguments, &QUICK].concat();
    all.iter().map(ToString::to_string).collect()
}

/// Two processes at once, one of them killed and begun again, leave what `track` leaves.
#[test]
fn a_folder_of_trials_is_shared_out_and_gone_on_with() {
    let folder = tempfile::tempdir().unwrap();
    let trials = trials(folder.path());
    let results = folder.path().join("results");
    let output = results.to_str().unwrap();
    let plan = program().args(batch(&[&trials, "-o", output, "--plan"])).output().unwrap();
    let plan: Vec<serde_json::Value> = stdout(&plan).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let names: Vec<&str> = plan.iter().map(|trial| trial["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["anna/jump 1", "anna/jump 2", "bert"]);
    assert!(!results.exists(), "a plan writes nothing");

    let begin = || {
        let mut command = program();
        command.args(batch(&[&trials, "-o", output, "--threads", "1"])).stdout(Stdio::null()).stderr(Stdio::null());
        command.spawn().unwrap()
    };
    let (mut first, mut second) = (begin(), begin());
    std::thread::sleep(Duration::from_millis(150));
    first.kill().unwrap();
    first.wait().unwrap();
    first = begin();
    assert!(first.wait().unwrap().success() && second.wait().unwrap().success());

    let alone = folder.path().join("alone");
    let bert = format!("{trials}/bert");
    let track = [&["track", bert.as_str(), "-o", alone.to_str().unwrap()], &QUICK[..]].concat();
    succeeded(&pantin(&track));
    for name in &names {
        for file in ["poses.csv", "joints.csv", "confidence.csv"] {
            let read = |folder: &Path| fs::read(folder.join(file)).unwrap();
            assert!(read(&results.join(name)) == read(&alone), "{name}/{file}");
        }
    }
    let summary = fs::read_to_string(results.join("summary.csv")).unwrap();
    let rows: Vec<&str> = summary.lines().collect();
    assert_eq!(rows.len(), 4, "{summary}");
    assert!(rows[0].starts_with("trial,person,frames,lost,") && rows[1].starts_with("anna/jump 1,,4,0,"), "{summary}");

    let again = program().args(batch(&[&trials, "-o", output])).output().unwrap();
    succeeded(&again);
    assert!(stderr(&again).contains("3 trials, 3 of them done") && stdout(&again).lines().count() == 1, "{again:?}");
    let other = program().args(batch(&[&trials, "-o", output, "--seed", "7"])).output().unwrap();
    refused(&other, &["3 of 3 trials failed", "was tracked with other settings"]);
}

#[test]
fn a_trial_that_fails_does_not_end_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let trials = trials(folder.path());
    fs::write(format!("{trials}/anna/jump 2/sequence.toml"), "fsp = 3\n").unwrap();
    let results = format!("{trials}/results");
    let done = program().args(batch(&[&trials, "-o", &results])).output().unwrap();
    refused(&done, &["1 of 3 trials failed, the first was anna/jump 2: ", "`fsp`"]);
    assert!(stdout(&done).contains("anna/jump 1: 4 frames") && stdout(&done).contains("bert: 4 frames"), "{done:?}");
    let collected = program().args(batch(&[&trials, "-o", &results, "--collect"])).output().unwrap();
    assert!(stdout(&collected).starts_with("2 rows in "), "{collected:?}");
    let refuse = |arguments: &[&str], part: &str| refused(&program().args(batch(arguments)).output().unwrap(), &[part]);
    refuse(&[&trials, "-o", &results, "--run", "3"], "there is no trial 3 of 3, expected 0 to 2");
    refuse(&[&trials, "-o", &results, "--threads", "0"], "--threads is 0, expected 1 to 4096");
    refuse(&[&trials, "-o", &results, "--realtime"], "--realtime is for one sequence");
    let empty = tempfile::tempdir().unwrap();
    refuse(&[empty.path().to_str().unwrap(), "-o", &results], "holds no sequence.toml anywhere");
    refuse(&[&format!("{trials}/nowhere"), "-o", &results], "cannot read the folder");
}

/// As many helpers as asked for, whatever the machine has.
#[cfg(target_os = "linux")]
#[test]
fn threads_are_as_many_as_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let walk = folder.path().join("walk");
    succeeded(&pantin(&["synth", "--preset", "demo", "--frames", "3", "-o", walk.to_str().unwrap()]));
    let workers = |threads: &str| {
        let output = folder.path().join(threads);
        let mut command = program();
        command.arg("track").arg(&walk).arg("-o").arg(&output).args(["--backend", "cpu", "--threads", threads]);
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let mut most = 0;
        while child.try_wait().unwrap().is_none() {
            let tasks = fs::read_dir(format!("/proc/{}/task", child.id())).into_iter().flatten().flatten();
            let names = tasks.filter_map(|task| fs::read_to_string(task.path().join("comm")).ok());
            most = most.max(names.filter(|name| name.starts_with("pantin-cpu-")).count());
            std::thread::sleep(Duration::from_millis(2));
        }
        assert!(child.wait().unwrap().success());
        (most, fs::read(output.join("poses.csv")).unwrap())
    };
    let (one, poses) = workers("1");
    assert_eq!(one, 0, "the caller is the only worker");
    let (three, same) = workers("3");
    assert_eq!(three, 2);
    assert!(poses == same, "the results do not depend on it");
}
