//! `pantin devices` and `pantin bench` from outside: what other programs read, and machines without Vulkan.

use std::process::Output;

use serde_json::Value;

use super::support::{NO_DRIVER, program, stderr, stdout};

fn pantin(arguments: &[&str], variables: &[(&str, &str)]) -> Output {
    program().args(arguments).envs(variables.iter().copied()).output().unwrap()
}

fn object(output: &Output) -> Value {
    assert!(output.status.success(), "{}", stderr(output));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn keys(value: &Value) -> Vec<&str> {
    let mut keys: Vec<&str> = value.as_object().unwrap().keys().map(String::as_str).collect();
    keys.sort_unstable();
    keys
}

#[test]
fn devices_are_listed_as_the_contract_says() {
    let found = object(&pantin(&["devices", "--json"], &[]));
    assert_eq!(keys(&found), ["auto", "devices"]);
    assert_eq!(keys(&found["auto"]), ["backend", "reason"]);
    let list = found["devices"].as_array().unwrap();
    if list.is_empty() {
        assert!(std::env::var_os("PANTIN_NEEDS_VULKAN").is_none(), "{found}");
        println!("SKIPPED devices_are_listed_as_the_contract_says: there is no Vulkan device");
        return;
    }
    for (index, device) in list.iter().enumerate() {
        let expected = [
            "driver",
            "index",
            "max_image",
            "memory_mb",
            "name",
            "reasons",
            "subgroup_size",
            "type",
            "usable",
            "vulkan",
        ];
        assert_eq!(keys(device), expected);
        assert_eq!(device["index"], index);
        assert!(["discrete", "integrated", "virtual", "cpu", "other"].contains(&device["type"].as_str().unwrap()));
        assert!(device["reasons"].as_array().unwrap().iter().all(Value::is_string) && device["usable"].is_boolean());
        assert_eq!(device["vulkan"].as_str().unwrap().split('.').count(), 3);
        for key in ["subgroup_size", "max_image", "memory_mb"] {
            assert!(device[key].as_u64().unwrap() > 0, "{key} of {device}");
        }
    }
    // Whoever has no other device than the processor is told so, without a measurement.
    let reason = found["auto"]["reason"].as_str().unwrap();
    if list.iter().all(|device| device["type"] == "cpu") {
        assert_eq!(found["auto"]["backend"], "cpu");
        assert!(
            reason.starts_with("auto chose cpu, with ") && reason.contains("computed by the processor"),
            "{reason}"
        );
    } else {
        assert!(reason.contains("measured on"), "{reason}");
    }
    let beyond = object(&pantin(&["devices", "--json"], &[("PANTIN_DEVICE", "99")]));
    let reason = beyond["auto"]["reason"].as_str().unwrap();
    assert!(reason.contains("PANTIN_DEVICE is 99") && reason.contains("counted from 0"), "{reason}");
    let table = stdout(&pantin(&["devices"], &[]));
    assert!(table.contains(list[0]["name"].as_str().unwrap()) && table.contains("with --backend auto: "), "{table}");
}

#[test]
fn a_machine_without_a_driver_is_told_so() {
    let found = object(&pantin(&["devices", "--json"], &NO_DRIVER));
    assert_eq!(found["devices"], Value::Array(Vec::new()));
    assert_eq!(found["auto"]["backend"], "cpu");
    let table = pantin(&["devices"], &NO_DRIVER);
    assert!(table.status.success());
    let text = stdout(&table);
    let first = text.lines().next().unwrap();
    // Either is right: without a loader, too, there is no driver.
    let is_either = first.starts_with("Vulkan finds no driver on this machine: install one");
    assert!(is_either || first.starts_with("there is no Vulkan on this machine"), "{text}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_machine_without_a_loader_is_told_so() {
    // A file of that name that is no library stands in the loader's way.
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("libvulkan.so.1"), "").unwrap();
    std::fs::write(folder.path().join("libvulkan.so"), "").unwrap();
    let hidden = [("LD_LIBRARY_PATH", folder.path().to_str().unwrap())];
    let found = object(&pantin(&["devices", "--json"], &hidden));
    assert_eq!(found["devices"], Value::Array(Vec::new()));
    assert_eq!(found["auto"]["backend"], "cpu");
    assert!(found["auto"]["reason"].as_str().unwrap().contains("there is no Vulkan on this machine"), "{found}");
    let text = stdout(&pantin(&["devices"], &hidden));
    assert!(text.starts_with("there is no Vulkan on this machine ("), "{text}");
    assert!(text.contains("install a driver with its loader"), "{text}");
}

#[test]
fn the_benchmark_prints_the_rows_of_the_contract() {
    let found = object(&pantin(&["bench", "--preset", "quick", "--json"], &NO_DRIVER));
    assert_eq!(keys(&found), ["device", "machine", "preset", "rows", "unavailable"]);
    assert!(found["device"].is_null() && found["machine"].as_str().unwrap().contains("threads"), "{found}");
    let rows = found["rows"].as_array().unwrap();
    let expected = [
        "backend",
        "bytes_per_pixel",
        "height",
        "images_per_s",
        "model",
        "ms",
        "ms_max",
        "ms_min",
        "particles",
        "pixels_per_s",
        "poses_per_s",
        "stages",
        "tile",
        "variant",
        "views",
        "width",
    ];
    for row in rows {
        assert_eq!(keys(row), expected);
        let number = |key: &str| row[key].as_f64().unwrap();
        assert!(
            number("ms_min") <= number("ms") && number("ms") <= number("ms_max") && number("ms_min") > 0.0,
            "{row}"
        );
        assert!(row["stages"].as_object().unwrap().values().all(Value::is_number), "{row}");
        assert_eq!(row["tile"].as_array().unwrap().len(), 2);
        let images = number("particles") * number("views") / number("ms") * 1e3;
        assert!((number("images_per_s") / images - 1.0).abs() < 1e-9, "{row}");
        let pixels = images * number("width") * number("height");
        assert!((number("pixels_per_s") / pixels - 1.0).abs() < 1e-9, "{row}");
    }
    let has = |backend: &str, variant: &str| {
        rows.iter().any(|row| row["backend"] == backend && row["variant"] == variant && row["model"] == "flat")
    };
    assert!(has("reference", "exact") && has("cpu", "portable") && has("cpu", "zbuffer") && has("cpu", "rowspan"));
    assert!(has("cpu", "columns"));
    let unavailable = found["unavailable"].as_array().unwrap();
    assert!(unavailable.iter().any(|missing| missing["backend"] == "compute" && missing["variant"] == "subgroup"));
    for missing in unavailable {
        assert_eq!(keys(missing), ["backend", "model", "reason", "variant"]);
        assert!(missing["reason"].as_str().unwrap().len() > 10, "{missing}");
    }
}

#[test]
fn an_unknown_preset_is_named() {
    let failed = pantin(&["bench", "--preset", "slow"], &[]);
    assert_eq!(failed.status.code(), Some(2));
    let text = stderr(&failed);
    assert!(text.contains("unknown preset `slow`, the nearest is `quick` (known: quick, thesis)"), "{text}");
}

#[test]
fn a_profile_needs_a_device_and_says_so() {
    let failed = pantin(&["bench", "--profile"], &NO_DRIVER);
    assert_eq!(failed.status.code(), Some(1));
    assert!(stderr(&failed).contains("Vulkan"), "{}", stderr(&failed));
}

#[test]
fn a_profile_is_compared_with_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let other = folder.path().join("other.json");
    std::fs::write(&other, "{\"preset\": \"quick\"}").unwrap();
    let other = other.to_str().unwrap();
    // Before anything is measured, and with no device at all.
    let failed = pantin(&["bench", "--profile", "--compare", other], &NO_DRIVER);
    let text = stderr(&failed);
    assert!(text.contains("other.json: expected a profile of pantin bench --profile --json"), "{text}");
    let failed = pantin(&["bench", "--profile", "--trace", other], &NO_DRIVER);
    assert!(stderr(&failed).contains("other.json exists already"), "{}", stderr(&failed));
    let failed = pantin(&["bench", "--compare", other], &NO_DRIVER);
    assert_eq!(failed.status.code(), Some(2));
    assert!(stderr(&failed).contains("--profile"), "{}", stderr(&failed));
}

#[test]
fn a_sweep_s_numbers_are_kept_and_drawn_without_a_device() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    let (kept, csv, plot) = (file("sweep.json"), file("sweep.csv"), file("sweep.svg"));
    let row = |workgroup: u32, ms: f64| {
        format!(
            r#"{{ "stage": "raster", "way": "3 words", "workgroup": {workgroup}, "usual": {}, "ms": {ms}, "ms_min": 1.0, "ms_max": 9.0 }}"#,
            workgroup == 32
        )
    };
    let head = r#""machine": "m", "device": "d", "particles": 512, "views": 4, "width": 640, "height": 480"#;
    let text = format!(r#"{{ {head}, "rows": [{}, {}], "unavailable": [] }}"#, row(32, 4.0), row(64, 2.0));
    std::fs::write(&kept, text).unwrap();
    let read = ["bench", "--sweep", "--read", &kept];
    let table = stdout(&pantin(&[&read[..], &["--csv", &csv, "--plot", &plot]].concat(), &NO_DRIVER));
    assert!(table.contains("32*") && table.contains("2.00"), "{table}");
    let lines = std::fs::read_to_string(&csv).unwrap();
    assert_eq!(lines.lines().last(), Some("raster,3 words,64,false,2,1,9"));
    assert!(std::fs::read_to_string(&plot).unwrap().contains("invocations of a workgroup"));
    let found = object(&pantin(&[&read[..], &["--json"]].concat(), &NO_DRIVER));
    assert_eq!(keys(&found), ["device", "height", "machine", "particles", "rows", "unavailable", "views", "width"]);
    // Nothing is written over, and nothing else is taken for a sweep.
    let failed = pantin(&[&read[..], &["--csv", &csv]].concat(), &NO_DRIVER);
    assert!(stderr(&failed).contains("sweep.csv exists already"), "{}", stderr(&failed));
    let failed = pantin(&["bench", "--sweep", "--read", &csv], &NO_DRIVER);
    assert!(stderr(&failed).contains("sweep.csv: expected the JSON of pantin bench --sweep"), "{}", stderr(&failed));
    let failed = pantin(&["bench", "--sweep"], &NO_DRIVER);
    assert_eq!(failed.status.code(), Some(1));
    assert!(stderr(&failed).contains("Vulkan"), "{}", stderr(&failed));
    let failed = pantin(&["bench", "--plot", &plot], &NO_DRIVER);
    assert_eq!(failed.status.code(), Some(2));
}
