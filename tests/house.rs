//! The house as docs/ARCHITECTURE.md draws it: imports run down the floors, unsafe code stays in its places, names say
//! something, links lead somewhere.
#![allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]

#[path = "house/circles.rs"]
mod circles;
#[path = "house/links.rs"]
mod links;

use std::fs;
use std::path::{Path, PathBuf};

use circles::Modules;

/// Rooms by floor. A room may import rooms of lower floors, and itself.
const FLOORS: &[(&str, u32)] = &[
    ("main", 8),
    ("command", 7),
    ("study", 6),
    ("track", 5),
    ("search", 4),
    ("bench", 4),
    ("check", 4),
    ("live", 4),
    ("evaluate", 3),
    ("synth", 3),
    ("report", 3),
    ("observe", 3),
    ("features", 2),
    ("body", 2),
    ("sequence", 2),
    ("texture", 2),
    ("matrix", 2),
    ("calibrate", 2),
    ("gpu", 1),
    ("motion", 1),
    ("geometry", 1),
    ("files", 0),
    ("arithmetic", 0),
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
fn no_imports_run_in_a_circle() {
    let modules = Modules::of(&sources());
    assert!(modules.count() > 200, "only {} modules were found", modules.count());
    let wrong = modules.circles();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_circle_is_caught_however_it_is_closed() {
    let circles = |sources: &[(&str, &str)]| {
        let sources: Vec<(String, String)> =
            sources.iter().map(|(file, source)| ((*file).to_string(), (*source).to_string())).collect();
        Modules::of(&sources).circles()
    };
    let room = ("lib.rs", "pub mod room;");
    let passes_on = ("room/mod.rs", "mod a;\nmod b;\npub use a::A;\npub use b::{B, C as D};");
    // Straight, and through what the room passes on.
    for b in ["use super::a::A;", "use super::{A};", "use crate::room::{\n    A,\n};", "fn f() -> super::A {}"] {
        let found = circles(&[room, passes_on, ("room/a.rs", "use super::D;"), ("room/b.rs", b)]);
        assert_eq!(found, [["room::a", "room::b"]], "{b}");
    }
    for b in ["", "use super::Unknown;", "// use super::A;", "#[cfg(test)]\nmod tests {\n    use super::super::A;\n}"] {
        let found = circles(&[room, passes_on, ("room/a.rs", "use super::D;"), ("room/b.rs", b)]);
        assert!(found.is_empty(), "{b}: {found:?}");
    }
    // A module and one inside it, of which each needs the other.
    let owns = ("room/mod.rs", "mod a;\npub struct Own;\nfn f() {\n    a::g();\n}");
    assert_eq!(circles(&[room, owns, ("room/a.rs", "use super::Own;")]), [["room", "room::a"]]);
    assert!(circles(&[room, owns, ("room/a.rs", "pub fn g() {}")]).is_empty());
    // Over three, one of them in a folder.
    let folder = ("room/b/mod.rs", "mod deep;\npub use deep::B;");
    let found = circles(&[
        room,
        ("room/mod.rs", "mod a;\nmod b;\nmod c;"),
        ("room/a.rs", "use super::c;"),
        folder,
        ("room/b/deep.rs", "use super::super::a;"),
        ("room/c.rs", "use super::b::B;"),
    ]);
    assert_eq!(found, [["room::a", "room::b::deep", "room::c"]]);
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

#[test]
fn links_of_the_documentation_lead_somewhere() {
    assert_eq!(links::broken(Path::new(env!("CARGO_MANIFEST_DIR"))), Vec::<String>::new());
}

#[test]
fn a_broken_link_is_caught() {
    let root = tempfile::tempdir().unwrap();
    fs::create_dir(root.path().join("docs")).unwrap();
    fs::create_dir(root.path().join("tests")).unwrap();
    fs::write(root.path().join("README.md"), "[a](docs/A.md) [b](docs/B.md) [c](docs/A.md#two-words) [d](#none)\n")
        .unwrap();
    fs::write(root.path().join("docs/A.md"), "# A\n## Two words\n[r](../README.md) [w](https://example.org/x)\n")
        .unwrap();
    let broken = links::broken(root.path());
    assert_eq!(broken.len(), 2, "{broken:?}");
    assert!(broken[0].contains("docs/B.md") && broken[1].contains("no heading none"), "{broken:?}");
}
