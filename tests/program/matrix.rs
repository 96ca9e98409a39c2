//! `pantin matrix` from the outside.

use std::path::Path;
use std::process::Output;

use serde_json::Value;

use super::support::{program, stderr as message, stdout};

fn matrix(arguments: &[&str], folder: &Path) -> Output {
    program().arg("matrix").args(arguments).current_dir(folder).output().unwrap()
}

fn rows(arguments: &[&str]) -> Vec<Value> {
    let folder = tempfile::tempdir().unwrap();
    let output = matrix(&[arguments, &["--json"]].concat(), folder.path());
    assert!(output.status.success(), "{arguments:?}: {}", message(&output));
    serde_json::from_str::<Value>(&stdout(&output)).unwrap()["rows"].as_array().unwrap().clone()
}

#[test]
fn structures_are_compared_in_json() {
    let all = rows(&["--n", "3", "--bits", "5"]);
    assert_eq!(all.len(), 44);
    let keys = "structure multiplier n bits group cycles partial_products adders registers pins links efficiency exact";
    for row in &all {
        assert!(keys.split(' ').all(|key| !row[key].is_null()), "{row}");
        assert_eq!((&row["exact"], &row["n"], &row["bits"]), (&Value::from(true), &Value::from(3), &Value::from(5)));
    }
    let chosen = rows(&["--n", "4", "--structure", "parallel-serial-local/recursive", "--multiplier", "booth"]);
    assert_eq!(chosen.len(), 1);
    // 8 bits in 4 groups, 4 columns, and 3 cycles until the last unit has what the first one had.
    assert_eq!((&chosen[0]["cycles"], &chosen[0]["group"]), (&Value::from(19), &Value::from(2)));
    assert!(chosen[0]["rate"].is_null());
    let fitted = rows(&["--n", "4", "--structure", "parallel-serial-global/recursive", "--rate", "4,8,1e6,5e6"]);
    assert_eq!(fitted[0]["rate"]["keeps_up"], Value::from(false));
    assert_eq!(fitted[0]["rate"]["clock_needed"], Value::from(8e6));
    assert_eq!(fitted[0]["rate"]["group_needed"], Value::from(2));
}

/// Table and plots of docs/MATRIX.md are what the program says, row by row and byte by byte.
#[test]
fn the_document_shows_what_the_program_says() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let document = std::fs::read_to_string(docs.join("MATRIX.md")).unwrap();
    let documented: Vec<&str> =
        document.lines().filter(|line| line.starts_with("| sequential/") || line.starts_with("| parallel-")).collect();
    let columns = "structure multiplier cycles partial_products adders registers pins link_length gates";
    let found = rows(&[]).into_iter().map(|row| {
        let cells = columns.split(' ').map(|name| match &row[name] {
            Value::String(text) => text.clone(),
            number => number.to_string(),
        });
        let cells = cells.collect::<Vec<_>>().join(" | ");
        format!("| {cells} | {:.2} |", 1e6 * row["efficiency"].as_f64().unwrap())
    });
    assert_eq!(documented, found.collect::<Vec<_>>());

    let folder = tempfile::tempdir().unwrap();
    assert!(matrix(&["-o", "out"], folder.path()).status.success());
    for plot in ["cycles", "efficiency"] {
        for over in ["n", "bits"] {
            let read = |path: &Path| std::fs::read_to_string(path).unwrap();
            let made = read(&folder.path().join(format!("out/{plot}_over_{over}.svg")));
            assert!(made == read(&docs.join(format!("images/matrix-{plot}-{over}.svg"))), "{plot} over {over}");
        }
    }
}

#[test]
fn a_folder_gets_the_table_and_plots() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["--n", "2", "--bits", "4", "--structure", "non-recursive", "--multiplier", "booth", "-o", "out"];
    let output = matrix(&arguments, folder.path());
    assert!(output.status.success(), "{}", message(&output));
    let text = stdout(&output);
    assert!(text.contains("parallel-parallel/non-recursive") && text.contains("wrote matrix.csv"), "{text}");
    let table = std::fs::read_to_string(folder.path().join("out/matrix.csv")).unwrap();
    assert!(table.starts_with("structure,multiplier,n,bits,group,cycles,"), "{table}");
    // Four arrangements at six sizes and six widths, of which one is the run's own.
    assert!(table.lines().count() > 4 * 11, "{table}");
    assert!(!table.contains("false"), "{table}");
    for plot in ["cycles", "partial_products", "adders", "registers", "gates", "links", "efficiency"] {
        for over in ["n", "bits"] {
            let svg = std::fs::read_to_string(folder.path().join(format!("out/{plot}_over_{over}.svg"))).unwrap();
            assert!(svg.starts_with("<svg") && svg.contains("parallel-parallel/non-recursive booth"), "{plot} {over}");
        }
    }
    let again = matrix(&arguments, folder.path());
    assert!(!again.status.success() && message(&again).contains("--force"), "{}", message(&again));
}

#[test]
fn wrong_wishes_are_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let error = |arguments: &[&str]| {
        let output = matrix(arguments, folder.path());
        assert!(!output.status.success(), "{arguments:?}");
        message(&output)
    };
    assert!(error(&["--n", "0"]).contains("--n 0: expected 1 to 32 rows"));
    assert!(error(&["--bits", "40"]).contains("elements of 40 bits, expected 2 to 32"));
    assert!(error(&["--bits", "32"]).contains("expected at most 64: fewer rows or bits"));
    assert!(error(&["--group", "9"]).contains("--group 9: expected 1 to the 8 bits"));
    assert!(error(&["--structure", "systolic"]).contains("unknown structure `systolic`, expected an arrangement"));
    assert!(error(&["--structure", "pair-sums", "--multiplier", "booth"]).contains("no structure has that"));
    assert!(error(&["--multiplier", "boot"]).contains("the nearest is `booth`"));
    assert!(error(&["--rate", "1,2,3"]).contains("expected four numbers"));
    assert!(error(&["--rate", "0,2,3,4"]).contains("the rate's channels are 0"));
    assert!(error(&["--weights", "0,0,0"]).contains("expected numbers from 0 on"));
}
