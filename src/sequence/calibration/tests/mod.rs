mod opencv;
mod pose2sim;
mod qualisys;
mod vicon;

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::*;

/// A reader of one format: text and name to cameras.
type Parse = fn(&str, &str) -> Result<Vec<Camera>>;

/// The sentence a user would read.
fn sentence(result: Result<Vec<Camera>>) -> String {
    format!("{:#}", result.expect_err("this input must be refused"))
}

/// Asserts that the text with `from` replaced is refused with all of `expected` in one line.
fn refused(parse: Parse, text: &str, from: &str, to: &str, expected: &[&str]) {
    assert!(text.contains(from), "the test's text holds {from:?}");
    let message = sentence(parse(&text.replacen(from, to, 1), "calib.file"));
    assert!(!message.contains('\n'), "{message:?}");
    for part in ["calib.file"].iter().chain(expected) {
        assert!(message.contains(part), "{to:?} gave {message:?}, expected {part:?} in it");
    }
}

/// A file of the shared recordings, None (and a visible line) where they are not there.
fn beam(file: &str, test: &str) -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/beam")).join(file);
    if path.exists() {
        return Some(path);
    }
    println!("SKIPPED {test}: ../shared/data is absent");
    None
}

#[test]
fn files_that_are_none_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    assert!(sentence(read_cameras(&path("absent.toml"))).contains("cannot read"), "absent");
    let message = sentence(read_cameras(&path("cameras.csv")));
    assert!(
        message.contains("cameras.csv: unknown calibration format `csv`") && message.contains("qca.txt"),
        "{message}"
    );
    for name in ["c.toml", "c.qca.txt", "c.yml", "c.yaml", "c.xml", "c.xcp"] {
        fs::write(path(name), [0x41, 0xff, 0xfe]).unwrap();
        let message = sentence(read_cameras(&path(name)));
        assert!(message.contains(name) && message.contains("byte 1 is not UTF-8"), "{message}");
        fs::write(path(name), "").unwrap();
        let message = sentence(read_cameras(&path(name)));
        assert!(message.contains(name) && (message.contains("no camera") || message.contains("not XML")), "{message}");
        // A folder of that name.
        fs::remove_file(path(name)).unwrap();
        fs::create_dir(path(name)).unwrap();
        assert!(sentence(read_cameras(&path(name))).contains(name));
    }
    let large = fs::File::create(path("large.toml")).unwrap();
    large.set_len(CALIBRATION.most + 1).unwrap();
    assert!(sentence(read_cameras(&path("large.toml"))).contains("expected a calibration file of at most"));
}

#[test]
fn no_damage_panics() {
    // Every prefix of a file, and every file with one byte made another, gives cameras or a sentence.
    let texts: [(&str, Parse); 4] = [
        (pose2sim::TWO, parse_cameras_toml),
        (qualisys::ONE, parse_qualisys),
        (opencv::YAML, parse_opencv_yaml),
        (opencv::XML, parse_opencv_xml),
    ];
    for (text, parse) in texts {
        for end in 0..text.len() {
            let _ = parse(&text[..end], "cut");
            for with in ["-", "[", "\"", "9e99", "\n", "&", ":", "nan"] {
                let damaged = format!("{}{with}{}", &text[..end], &text[end + 1..]);
                if let Ok(cameras) = parse(&damaged, "damaged") {
                    assert!(!cameras.is_empty());
                    for camera in cameras {
                        assert!(camera.camera_from_world.is_finite() && camera.size.iter().all(|&side| side > 0));
                        let _ = camera.project(DVec3::new(10.0, 20.0, 30.0));
                    }
                }
            }
        }
    }
}

#[test]
fn deep_nesting_is_refused_not_followed() {
    let deep = 200_000;
    let yaml = format!("K: {}{}", "[".repeat(deep), "]".repeat(deep));
    sentence(parse_opencv_yaml(&yaml, "deep.yml"));
    let xml = format!("<opencv_storage>{}{}</opencv_storage>", "<K>".repeat(deep), "</K>".repeat(deep));
    sentence(parse_opencv_xml(&xml, "deep.xml"));
    let toml = format!("a = {}{}", "[".repeat(deep), "]".repeat(deep));
    sentence(parse_cameras_toml(&toml, "deep.toml"));
    let bomb = "a: &a [1, 1]\nb: &b [*a, *a]\nK: [*b, *b]\n";
    assert!(sentence(parse_opencv_yaml(bomb, "bomb.yml")).contains("alias"));
    let bomb = "<!DOCTYPE x [<!ENTITY a \"aaaa\">]><opencv_storage><K>&a;</K></opencv_storage>";
    assert!(sentence(parse_opencv_xml(bomb, "bomb.xml")).contains("not XML"));
}
