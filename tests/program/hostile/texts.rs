//! Every key of every TOML file with odd values, left out, doubled and misspelt; and files whose form is odd.

use toml::{Table, Value};

use super::case::{Case, Spoilt};
use super::ground::{Ground, Sound, TRACK};

/// A step into a file: a key, or a place in a list.
#[derive(Clone, Debug)]
enum Step {
    Key(String),
    Place(usize),
}

impl Step {
    fn key(&self) -> Option<String> {
        match self {
            Self::Key(key) => Some(key.clone()),
            Self::Place(_) => None,
        }
    }
}

/// Cases of each file by odd values of keys.
const OF_EACH: usize = 120;

pub(super) fn cases(ground: &Ground) -> Vec<Case> {
    let check = &["check", "made", "--samples", "1"][..];
    let files: [(&'static str, &str, Sound); 6] = [
        ("key of a manifest", "made/sequence.toml", Sound { arguments: TRACK, output: Some("out") }),
        ("key of a calibration", "made/cameras.toml", Sound { arguments: check, output: None }),
        ("key of a body", "made/body.toml", Sound { arguments: TRACK, output: Some("out") }),
        (
            "key of a scene",
            "scene.toml",
            Sound { arguments: &["synth", "scene.toml", "-o", "out", "--frames", "1"], output: Some("out") },
        ),
        (
            "key of a study",
            "study.toml",
            Sound { arguments: &["study", "study.toml", "-o", "out", "--plan"], output: None },
        ),
        (
            "key of a study",
            "study.toml",
            Sound { arguments: &["study", "study.toml", "-o", "out"], output: Some("out") },
        ),
    ];
    let mut cases = Vec::new();
    for (kind, file, sound) in &files {
        let table: Table = toml::from_str(&ground.text(file)).unwrap();
        let mut places = Vec::new();
        leaves(&Value::Table(table.clone()), &mut Vec::new(), &mut places);
        let changes = odd_values();
        let all = places.len() * changes.len();
        let count = if *kind == "key of a study" { OF_EACH / 2 } else { OF_EACH };
        for index in 0..count.min(all) {
            // Evenly over places and, with another step, over changes.
            let (place, change) = (&places[index * places.len() / count.min(all)], &changes[index * 7 % changes.len()]);
            let mut changed = Value::Table(table.clone());
            let what = format!("{place:?} {}", change.0);
            set(&mut changed, place, &change.1);
            let text = toml::to_string(&changed).unwrap();
            let mut case = Case::of_file(kind, &what, sound, file, Spoilt::Holds(text.into_bytes()));
            // Where a file cannot be found its key is named, or the table.
            case.names = place.iter().filter_map(Step::key).collect();
            cases.push(case);
        }
        for (what, text) in forms(&ground.text(file)) {
            cases.push(Case::of_file("form of a text", what, sound, file, Spoilt::Holds(text)));
        }
    }
    for (what, text) in manifests(&ground.text("made/sequence.toml")) {
        cases.push(Case::of_file(
            "manifest",
            what,
            &files[0].2,
            "made/sequence.toml",
            Spoilt::Holds(text.into_bytes()),
        ));
    }
    cases
}

/// What a value becomes; none: its key is left out.
fn odd_values() -> Vec<(&'static str, Option<Value>)> {
    let of = |name, value: Value| (name, Some(value));
    vec![
        ("left out", None),
        of("nan", Value::Float(f64::NAN)),
        of("inf", Value::Float(f64::INFINITY)),
        of("-inf", Value::Float(f64::NEG_INFINITY)),
        of("1e308", Value::Float(1e308)),
        of("1e-300", Value::Float(1e-300)),
        of("-1", Value::Integer(-1)),
        of("-1.0", Value::Float(-1.0)),
        of("0", Value::Integer(0)),
        of("0.0", Value::Float(0.0)),
        of("the largest whole number", Value::Integer(i64::MAX)),
        of("true", Value::Boolean(true)),
        of("no text", Value::String(String::new())),
        of("a long text", Value::String("x".repeat(5000))),
        of("two lines", Value::String("a\nb\u{1b}[2J".into())),
        of("a path upwards", Value::String("../../../../etc/passwd".into())),
        of("a device", Value::String("/dev/zero".into())),
        of("a slash", Value::String("a/b".into())),
        of("signs", Value::String("a<b>%d*?".into())),
        of("an empty list", Value::Array(Vec::new())),
        of("a long list", Value::Array(vec![Value::Integer(1); 5000])),
        of("an empty table", Value::Table(Table::new())),
    ]
}

/// Every leaf, by the steps to it.
fn leaves(value: &Value, steps: &mut Vec<Step>, found: &mut Vec<Vec<Step>>) {
    match value {
        Value::Table(table) if !table.is_empty() => {
            for (key, inner) in table {
                steps.push(Step::Key(key.clone()));
                leaves(inner, steps, found);
                steps.pop();
            }
        }
        Value::Array(list) if list.iter().any(Value::is_table) => {
            for (place, inner) in list.iter().enumerate() {
                steps.push(Step::Place(place));
                leaves(inner, steps, found);
                steps.pop();
            }
        }
        _ => found.push(steps.clone()),
    }
}

fn set(value: &mut Value, steps: &[Step], to: &Option<Value>) {
    let (Some(step), rest) = (steps.first(), steps.get(1..).unwrap_or_default()) else { return };
    match (value, step) {
        (Value::Table(table), Step::Key(key)) if rest.is_empty() => match to {
            Some(to) => drop(table.insert(key.clone(), to.clone())),
            None => drop(table.remove(key)),
        },
        (Value::Table(table), Step::Key(key)) => set(&mut table[key.as_str()], rest, to),
        (Value::Array(list), Step::Place(place)) => set(&mut list[*place], rest, to),
        _ => {}
    }
}

/// Odd forms of a TOML file.
fn forms(text: &str) -> Vec<(&'static str, Vec<u8>)> {
    let deep = format!("a = {}1{}\n{text}", "[".repeat(50_000), "]".repeat(50_000));
    let dotted = format!("{}a = 1\n{text}", "a.".repeat(20_000));
    vec![
        ("half of it", text.as_bytes()[..text.len() / 2].to_vec()),
        ("twice", text.repeat(2).into_bytes()),
        ("an unknown key", format!("unknwon = 1\n{text}").into_bytes()),
        ("an unknown table", format!("{text}\n[unknwon]\na = 1\n").into_bytes()),
        ("a thousand unknown keys", (0..1000).map(|at| format!("k{at} = 1\n")).collect::<String>().into_bytes()),
        ("lists in lists", deep.into_bytes()),
        ("keys in keys", dotted.into_bytes()),
        ("a byte that is no text", [text.as_bytes(), b"\xff"].concat()),
        ("a zero", [text.as_bytes(), b"\0"].concat()),
        ("two bytes a letter", text.encode_utf16().flat_map(u16::to_le_bytes).collect()),
        ("a mark before it", [b"\xef\xbb\xbf", text.as_bytes()].concat()),
        ("old line ends", text.replace('\n', "\r").into_bytes()),
        ("a key of a million letters", format!("{} = 1\n", "k".repeat(1_000_000)).into_bytes()),
    ]
}

/// Manifests that are no single key away from a sound one.
fn manifests(text: &str) -> Vec<(&'static str, String)> {
    let views: Vec<&str> = text.split("[[view]]").collect();
    let (head, views) = (views[0], &views[1..]);
    let with =
        |views: &[&str]| format!("{head}{}", views.iter().map(|view| format!("[[view]]{view}")).collect::<String>());
    let person = "[[person]]\nname = 'a'\nbody = 'body.toml'\nstart = 'start.csv'\n";
    let plain: String = head
        .lines()
        .filter(|line| !line.starts_with("body") && !line.starts_with("start"))
        .fold(String::new(), |text, line| text + line + "\n");
    vec![
        ("no view", with(&[])),
        ("one view", with(&views[..1])),
        ("one view twice", with(&[views[0], views[0]])),
        ("a thousand views", with(&vec![views[0]; 1000])),
        ("a live view among others", with(&[views[0], "\ncamera = 'cam2'\nsource = 'rtsp://127.0.0.1:1/x'\n"])),
        (
            "a live view with a mask",
            with(&["\ncamera = 'cam2'\nsource = '/dev/video77'\nmask = 'masks/cam2_%04d.png'\n"]),
        ),
        ("a source that is all signs", with(&["\ncamera = 'cam1'\nsource = '%%%d%d%s'\n"])),
        ("a source upwards", with(&["\ncamera = 'cam1'\nsource = '../../../%d'\n"])),
        ("people and a body", format!("{text}{person}")),
        ("two people of one name", format!("{plain}{person}{person}{}", &with(views)[head.len()..])),
        ("a person upwards", format!("{plain}{}{}", person.replace("'a'", "'../a'"), &with(views)[head.len()..])),
        (
            "a person with an odd name",
            format!("{plain}{}{}", person.replace("'a'", "'CON:<>'"), &with(views)[head.len()..]),
        ),
    ]
}
