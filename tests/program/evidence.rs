//! `pantin track --objective evidence` from outside: followed by soft evidence, the same bytes whoever scores and however often it stopped.

use std::fs;
use std::path::Path;

use super::support::{pantin, sequence, succeeded};

fn tracked(output: &Path, more: &[&str]) {
    let mut arguments = vec!["track", sequence().to_str().unwrap(), "-o", output.to_str().unwrap()];
    if !more.contains(&"--objective") {
        arguments.extend(["--objective", "evidence"]);
    }
    arguments.extend(["--particles", "40", "--iterations", "6", "--overlay-every", "0", "--frames", "0..4"]);
    arguments.extend(more);
    succeeded(&pantin(&arguments));
}

fn files(output: &Path) -> [Vec<u8>; 2] {
    ["poses.csv", "journal.txt"].map(|name| fs::read(output.join(name)).unwrap())
}

#[test]
fn evidence_tracks_the_same_on_every_backend_and_after_a_stop() {
    let folder = tempfile::tempdir().unwrap();
    let [cpu, reference, silhouettes] = ["cpu", "reference", "silhouettes"].map(|name| folder.path().join(name));
    tracked(&cpu, &["--backend", "cpu"]);
    tracked(&reference, &["--backend", "reference"]);
    assert!(files(&cpu) == files(&reference), "the processor and the reference differ");
    // The person's colours are learnt again from the frames that are done, else the frames after them would differ.
    let whole = files(&cpu);
    let journal = fs::read_to_string(cpu.join("journal.txt")).unwrap();
    let lines: Vec<&str> = journal.split_inclusive('\n').collect();
    fs::write(cpu.join("journal.txt"), lines[..lines.len() - 2].concat()).unwrap();
    tracked(&cpu, &["--backend", "cpu", "--resume"]);
    assert!(files(&cpu) == whole, "a run that went on differs");
    // It is another objective: the poses are others.
    tracked(&silhouettes, &["--objective", "sp"]);
    assert!(files(&silhouettes)[0] != whole[0]);
}
