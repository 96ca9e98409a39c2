//! What docs/PERFORMANCE.md tells of measurements by commands: the section that results of `make gpu-report` fill (`make gpu-report
//! FROM=results`), and the chart of workgroup sizes.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use pantin::bench::sweep::SweepReport;
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
    // In a file of its own in folders of older reports.
    let version = if folder.join("version.txt").exists() { read("version.txt") } else { read("messages.txt") };
    let version: Vec<&str> = version.lines().take(2).collect();
    let version = version.join(" ");
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
            let mut stages: Vec<String> = row["stages"].as_object().map_or_else(Vec::new, |stages| {
                let each = stages.iter().map(|(name, ms)| (name, ms.as_f64().unwrap_or(0.0)));
                each.filter(|(_, ms)| *ms >= 5e-4).map(|(name, ms)| format!("{name} {ms:.3}")).collect()
            });
            if let Some(wrong) = row["wrong"].as_object() {
                let count = |key: &str| wrong.get(key).and_then(Value::as_u64).unwrap_or(0);
                stages.insert(0, format!("WRONG in {} of {} pixels", count("wrong"), count("drawn")));
            }
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
    // Folders of older reports have none.
    let newer = |name: &str| if folder.join(name).exists() { json(name) } else { Value::Null };
    workgroups(&mut text, &newer("sweep.json"));
    passes(&mut text, &newer("profile.json"));
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

/// Of a sweep the fastest workgroups of every way, and those that are taken unasked; nothing where there is none.
fn workgroups(text: &mut String, sweep: &Value) {
    let Some(rows) = sweep["rows"].as_array() else { return };
    let ms = |row: &Value| row["ms"].as_f64().unwrap_or(f64::NAN);
    let is_alike = |a: &Value, b: &Value| a["stage"] == b["stage"] && a["way"] == b["way"];
    writeln!(text, "\n| stage | way | workgroup | ms | taken unasked |\n|---|---|---|---|---|").unwrap();
    for row in rows {
        let is_usual = row["usual"].as_bool() == Some(true);
        let is_fastest = rows.iter().all(|other| !is_alike(row, other) || ms(row) <= ms(other));
        if is_usual || is_fastest {
            let word = |key: &str| row[key].as_str().unwrap_or("unknown");
            let told = if is_usual { "yes" } else { "" };
            let workgroup = row["workgroup"].as_f64().unwrap_or(f64::NAN);
            writeln!(text, "| {} | {} | {workgroup} | {:.4} | {told} |", word("stage"), word("way"), ms(row)).unwrap();
        }
    }
}

/// The passes of a profile; nothing where there is none.
fn passes(text: &mut String, profile: &Value) {
    let Some(profiles) = profile["profiles"].as_array() else { return };
    let peak = |kind: &str| profile["peaks"][kind].as_f64().unwrap_or(f64::NAN) * 1e-9;
    writeln!(
        text,
        "\nPeaks: {:.0} G integer operations/s, {:.0} G in floating point, {:.0} GB/s of memory, {:.0} GB/s of shared memory.\n",
        peak("integer"),
        peak("float"),
        peak("memory"),
        peak("shared")
    )
    .unwrap();
    writeln!(text, "| iteration | pass | ms | share | M int | M float | MB | most of a peak |").unwrap();
    writeln!(text, "|---|---|---|---|---|---|---|---|").unwrap();
    for row in profiles {
        let word = |key: &str| row[key].as_str().unwrap_or("unknown");
        for pass in row["passes"].as_array().into_iter().flatten() {
            let number = |value: &Value, scale: f64| value.as_f64().unwrap_or(0.0) * scale;
            let work = &pass["work"];
            let parts = pass["of_peak"].as_object().into_iter().flatten();
            let most = parts.max_by(|l, r| number(l.1, 1.0).total_cmp(&number(r.1, 1.0)));
            let most =
                most.map_or_else(|| "-".to_string(), |(kind, part)| format!("{kind} {:.0}%", number(part, 100.0)));
            writeln!(
                text,
                "| {} {}, {}, {}x{} | {} | {:.4} | {:.1}% | {:.2} | {:.2} | {:.2} | {most} |",
                word("backend"),
                word("variant"),
                word("model"),
                number(&row["width"], 1.0),
                number(&row["height"], 1.0),
                pass["name"].as_str().unwrap_or("unknown"),
                number(&pass["ms"], 1.0),
                number(&pass["share"], 100.0),
                number(&work["integer"], 1e-6),
                number(&work["float"], 1e-6),
                (number(&work["read"], 1e-6) + number(&work["written"], 1e-6)),
            )
            .unwrap();
        }
    }
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
    write("messages.txt", "pantin 0.1.0\nabc1234\nrunning 3 tests\n");
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
    let wrong = row.replace("\"stages\"", "\"wrong\": { \"wrong\": 12, \"drawn\": 345 }, \"stages\"");
    write("bench.json", &format!(r#"{{ "machine": "CPU", "device": "Card, driver 1", "rows": [{row}, {wrong}] }}"#));
    let found = section(folder.path());
    assert!(found.starts_with("Measured with pantin 0.1.0 abc1234 on Card, driver 1; processor: CPU.\n"), "{found}");
    let expected = "| compute | subgroup | flat | 512 | 480x270 | 0.123 | 0.100 | 1000000 | pose 0.010 |\n";
    assert!(found.contains(expected), "{found}");
    assert_eq!(found.matches("| WRONG in 12 of 345 pixels, pose 0.010 |").count(), 1, "{found}");
    assert!(!found.contains("| pass |"), "no profile: {found}");
    let pass = r#"{ "name": "raster", "ms": 0.05, "share": 0.4, "work": { "integer": 4000000, "float": 500000, "read": 250000,
        "written": 750000 }, "of_peak": { "integer": 0.25, "float": 0.1, "memory": 0.125, "shared": 0.0 } }"#;
    let copy = r#"{ "name": "upload poses", "ms": 0.01, "share": 0.1, "work": null, "of_peak": null }"#;
    let head = r#""backend": "compute", "variant": "subgroup", "model": "flat", "width": 480, "height": 270"#;
    let peaks = r#"{ "integer": 2e12, "float": 3e12, "memory": 4e11, "shared": 5e12 }"#;
    write(
        "profile.json",
        &format!(r#"{{ "peaks": {peaks}, "profiles": [{{ {head}, "passes": [{copy}, {pass}] }}] }}"#),
    );
    let row = |way: &str, workgroup: u32, usual: bool, ms: f64| {
        format!(r#"{{ "stage": "raster", "way": "{way}", "workgroup": {workgroup}, "usual": {usual}, "ms": {ms} }}"#)
    };
    let rows = [row("3 words", 32, true, 0.5), row("3 words", 64, false, 0.25), row("3 words", 128, false, 0.75)];
    write("sweep.json", &format!(r#"{{ "rows": [{}] }}"#, rows.join(", ")));
    let found = section(folder.path());
    let fastest = "| raster | 3 words | 32 | 0.5000 | yes |\n| raster | 3 words | 64 | 0.2500 |  |\n\nPeaks";
    assert!(found.contains(fastest), "{found}");
    assert!(
        found.contains("Peaks: 2000 G integer operations/s, 3000 G in floating point, 400 GB/s of memory"),
        "{found}"
    );
    let line = "| compute subgroup, flat, 480x270 | raster | 0.0500 | 40.0% | 4.00 | 0.50 | 1.00 | integer 25% |\n";
    assert!(
        found.contains(line) && found.contains("| upload poses | 0.0100 | 10.0% | 0.00 | 0.00 | 0.00 | - |"),
        "{found}"
    );
    // Written twice it is the same.
    let filled = with_section(&docs, &found);
    assert_eq!(with_section(&filled, &found), filled);
    assert!(filled.contains(expected) && filled.len() > docs.len() / 2);
}

/// docs/images/workgroups.svg is what `pantin bench --sweep --read docs/studies/results/workgroups.json --plot` draws.
#[test]
fn the_chart_of_workgroups_is_drawn_from_its_numbers() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let sweep = SweepReport::read(&root.join("docs/studies/results/workgroups.json")).unwrap();
    let (chart, path) = (sweep.chart().unwrap(), root.join("docs/images/workgroups.svg"));
    if std::env::var_os("PANTIN_WRITE_DOCS").is_some() {
        fs::write(&path, &chart).unwrap();
    }
    assert!(
        fs::read_to_string(&path).unwrap() == chart,
        "PANTIN_WRITE_DOCS=1 cargo test --test gpu_report draws it anew"
    );
    // Other numbers are another chart.
    let mut other = sweep.clone();
    other.rows.iter_mut().for_each(|row| row.ms *= f64::from(row.workgroup));
    assert!(other.chart().unwrap() != chart);
}
