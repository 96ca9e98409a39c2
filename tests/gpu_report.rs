//! The section of docs/PERFORMANCE.md that results of `make gpu-report` fill: `make gpu-report FROM=results`.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde_json::Value;

const BEGIN: &str = "<!-- gpu-report: written by make gpu-report FROM=... -->\n";
const END: &str = "<!-- end of gpu-report -->\n";

/// What a folder of results says, as Markdown.
fn section(folder: &Path) -> String {
    let read = |name: &str| {
        let path = folder.join(name);
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("cannot read {}: {error}", path.display()))
    };
    let json = |name: &str| -> Value { serde_json::from_str(&read(name)).unwrap_or(Value::Null) };
    let mut text = String::new();
    let (devices, bench) = (json("devices.json"), json("bench.json"));
    let word = |value: &Value| value.as_str().unwrap_or("unknown").to_string();
    let version = read("version.txt").split_whitespace().collect::<Vec<_>>().join(" ");
    let device = if bench.is_null() { word(&devices["devices"][0]["name"]) } else { word(&bench["device"]) };
    writeln!(text, "Measured with {version} on {device}; processor: {}.\n", word(&bench["machine"])).unwrap();
    writeln!(text, "| line of the report | verdict | s |\n|---|---|---|").unwrap();
    for line in read("lines.tsv").lines() {
        writeln!(text, "| {} |", line.split('\t').collect::<Vec<_>>().join(" | ")).unwrap();
    }
    if let Some(rows) = bench["rows"].as_array() {
        writeln!(text, "\n| backend | variant | model | candidates | pictures | ms | min | images/s | stages, ms |")
            .unwrap();
        writeln!(text, "|---|---|---|---|---|---|---|---|---|").unwrap();
        for row in rows {
            let number = |key: &str| row[key].as_f64().unwrap_or(f64::NAN);
            let stages: Vec<String> = row["stages"].as_object().map_or_else(Vec::new, |stages| {
                let each = stages.iter().map(|(name, ms)| (name, ms.as_f64().unwrap_or(0.0)));
                each.filter(|(_, ms)| *ms >= 5e-4).map(|(name, ms)| format!("{name} {ms:.3}")).collect()
            });
            writeln!(
                text,
                "| {} | {} | {} | {} | {}x{} | {:.3} | {:.3} | {:.0} | {} |",
                word(&row["backend"]),
                word(&row["variant"]),
                word(&row["model"]),
                number("particles"),
                number("width"),
                number("height"),
                number("ms"),
                number("ms_min"),
                number("images_per_s"),
                stages.join(", ")
            )
            .unwrap();
        }
    }
    writeln!(text, "\n| track, start to end | frames | ms | ms a frame |\n|---|---|---|---|").unwrap();
    for line in read("track.txt").lines() {
        let columns: Vec<&str> = line.split('\t').collect();
        let [backend, frames, ms] = columns[..] else {
            panic!("track.txt has the line {line:?}, expected three columns")
        };
        let each = ms.parse::<f64>().unwrap() / frames.parse::<f64>().unwrap();
        writeln!(text, "| {backend} | {frames} | {ms} | {each:.1} |").unwrap();
    }
    text
}

/// `docs` with another section.
fn with_section(docs: &str, section: &str) -> String {
    let (before, rest) = docs.split_once(BEGIN).unwrap_or_else(|| panic!("docs/PERFORMANCE.md lacks {BEGIN}"));
    let (_, after) = rest.split_once(END).unwrap_or_else(|| panic!("docs/PERFORMANCE.md lacks {END}"));
    format!("{before}{BEGIN}{section}{END}{after}")
}

#[test]
fn results_fill_the_section() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/PERFORMANCE.md");
    let docs = fs::read_to_string(&path).unwrap();
    if let Some(folder) = std::env::var_os("PANTIN_GPU_REPORT") {
        fs::write(&path, with_section(&docs, &section(Path::new(&folder)))).unwrap();
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("devices.json", r#"{ "devices": [{ "name": "Card" }] }"#);
    write("version.txt", "pantin 0.1.0\nabc1234\n");
    write("lines.tsv", "devices\tpassed\t1\nagreement of gpu::\tout of time\t60\n");
    write("track.txt", "compute\t10\t250\n");
    write("bench.json", "");
    let found = section(folder.path());
    assert!(found.starts_with("Measured with pantin 0.1.0 abc1234 on Card; processor: unknown.\n"), "{found}");
    assert!(found.contains("| agreement of gpu:: | out of time | 60 |\n"), "{found}");
    assert!(found.contains("| compute | 10 | 250 | 25.0 |\n"), "{found}");
    assert!(!found.contains("| backend |"), "no benchmark ran: {found}");
    let row = r#"{ "backend": "compute", "variant": "subgroup", "model": "flat", "particles": 512, "width": 480, "height": 270,
        "ms": 0.1234, "ms_min": 0.1, "images_per_s": 1e6, "stages": { "pose": 0.01, "idle": 0.0 } }"#;
    write("bench.json", &format!(r#"{{ "machine": "CPU", "device": "Card, driver 1", "rows": [{row}] }}"#));
    let found = section(folder.path());
    assert!(found.starts_with("Measured with pantin 0.1.0 abc1234 on Card, driver 1; processor: CPU.\n"), "{found}");
    let expected = "| compute | subgroup | flat | 512 | 480x270 | 0.123 | 0.100 | 1000000 | pose 0.010 |\n";
    assert!(found.contains(expected), "{found}");
    // Written twice it is the same.
    let filled = with_section(&docs, &found);
    assert_eq!(with_section(&filled, &found), filled);
    assert!(filled.contains(expected) && filled.len() > docs.len() / 2);
}
