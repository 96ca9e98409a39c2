//! The house as docs/ARCHITECTURE.md draws it: imports run down the floors, unsafe code stays in its places, files stay
//! one concept long.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

/// Rooms by floor. A room may import rooms of lower floors, and itself.
const FLOORS: &[(&str, u32)] = &[
    ("main", 8),
    ("command", 7),
    ("study", 6),
    ("track", 5),
    ("search", 4),
    ("bench", 4),
    ("check", 4),
    ("evaluate", 3),
    ("synth", 3),
    ("report", 3),
    ("features", 2),
    ("body", 2),
    ("sequence", 2),
    ("texture", 2),
    ("calibrate", 2),
    ("gpu", 1),
    ("motion", 1),
    ("geometry", 1),
    ("files", 0),
];

/// Places that may hold `unsafe`, as path prefixes under src/.
const UNSAFE_PLACES: &[&str] = &["evaluate/cpu/", "gpu/"];

/// Names that say nothing of what is inside.
const EMPTY_NAMES: &[&str] = &["utils", "util", "common", "types", "context", "manager", "helpers", "misc"];

fn sources() -> Vec<(String, String)> {
    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path);
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    walk(&root, &mut files);
    files
        .into_iter()
        .map(|path| {
            let name = path.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/");
            (name, fs::read_to_string(&path).unwrap())
        })
        .collect()
}

fn floor(room: &str) -> Option<u32> {
    FLOORS.iter().find(|(name, _)| *name == room).map(|(_, floor)| *floor)
}

/// Rooms that a source names through `crate::` or `pantin::`, in code and not in comments.
fn imported_rooms(source: &str) -> Vec<String> {
    let mut rooms = Vec::new();
    for line in source.lines().map(|line| line.split("//").next().unwrap()) {
        for prefix in ["crate::", "pantin::"] {
            for rest in line.split(prefix).skip(1) {
                let names = match rest.strip_prefix('{') {
                    // use crate::{a::X, b::Y};
                    Some(list) => list.split(',').map(|item| item.trim().to_string()).collect(),
                    None => vec![rest.to_string()],
                };
                for name in names {
                    rooms.push(name.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect());
                }
            }
        }
    }
    rooms
}

/// Every import of `file` that does not run down.
fn wrong_imports(file: &str, source: &str) -> Vec<String> {
    let room = file.split('/').next().unwrap().trim_end_matches(".rs");
    let Some(own) = floor(room) else { return Vec::new() };
    imported_rooms(source)
        .into_iter()
        .filter(|imported| imported != room)
        .filter_map(|imported| floor(&imported).map(|floor| (imported, floor)))
        .filter(|(_, floor)| *floor >= own)
        .map(|(imported, _)| format!("{file} imports {imported}"))
        .collect()
}

#[test]
fn imports_run_down() {
    let sources = sources();
    assert!(sources.len() > 30, "only {} sources were found", sources.len());
    let wrong: Vec<String> = sources.iter().flat_map(|(file, source)| wrong_imports(file, source)).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let rooms: Vec<&str> = sources.iter().filter_map(|(file, _)| file.split_once('/')).map(|(room, _)| room).collect();
    for room in rooms {
        assert!(floor(room).is_some(), "the room {room} stands on no floor: add it here and to docs/ARCHITECTURE.md");
    }
}

#[test]
fn an_import_upwards_or_sideways_is_caught() {
    assert_eq!(wrong_imports("geometry/camera.rs", "use crate::body::Body;"), ["geometry/camera.rs imports body"]);
    assert_eq!(wrong_imports("body/mod.rs", "use crate::{files::X, features::Y};"), ["body/mod.rs imports features"]);
    assert_eq!(wrong_imports("track/mod.rs", "let x = crate::command::run();"), ["track/mod.rs imports command"]);
    assert!(wrong_imports("track/mod.rs", "use crate::body::Body; // crate::command").is_empty());
}

#[test]
fn unsafe_code_stays_in_its_places() {
    for (file, source) in sources() {
        let holds = source.lines().any(|line| {
            let code = line.split("//").next().unwrap();
            code.contains("unsafe {") || code.contains("unsafe fn") || code.contains("unsafe impl")
        });
        let allowed = UNSAFE_PLACES.iter().any(|place| file.starts_with(place));
        assert!(!holds || allowed, "{file} holds unsafe code, which belongs into {UNSAFE_PLACES:?}");
    }
}

#[test]
fn names_say_what_is_inside() {
    for (file, _) in sources() {
        for name in file.trim_end_matches(".rs").split('/') {
            assert!(!EMPTY_NAMES.contains(&name), "{file}: the name {name} says nothing");
        }
    }
}
