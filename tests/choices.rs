//! The tables of choices in the documents: what stands between `<!-- choices: X -->` and `<!-- end of choices -->` is the list of X
//! as the sources declare it. `PANTIN_WRITE_DOCS=1 cargo test --test choices` writes the tables anew.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test or benchmark stops at the first surprise, and prints")]

use std::fs;
use std::path::{Path, PathBuf};

use pantin::bench::{Preset, YardstickKind};
use pantin::body::{Model, Skinning};
use pantin::calibrate::{BoardKind, Held, Layout, LensModel};
use pantin::evaluate::cpu::InstructionSet;
use pantin::evaluate::device::{
    Channels, Coverage, Gathering, HostComparison, Packing, Primitives, Projection, Tiling,
};
use pantin::evaluate::{EdgeTerm, ObjectiveKind};
use pantin::features::{Adaptation, Cue, ForegroundKind, Magnitude, Metric, Normalisation, Operator, Shape};
use pantin::files::Choice;
use pantin::geometry::LengthUnit;
use pantin::live::Scheme;
use pantin::matrix::{Arrangement, Multiplier, UnitKind};
use pantin::motion::{Convention, MotionFormat, PointFormat, UpAxis};
use pantin::search::SearchKind;
use pantin::sequence::{CalibrationFormat, Orientation, Stamps};
use pantin::study::{Axis, Pace, Value};
use pantin::synth::{Gait, Garment, LensKind, MotionUnit, PictureForm, RigKind, ScenePreset};
use pantin::texture::materials::MaterialKind;
use pantin::texture::noise::{NoiseWay, Sum};
use pantin::track::{Backend, FeaturesOn, Passes, Prediction, Width};

/// What a document calls a list, and its table.
type List = (&'static str, String);

fn list<T: Choice>() -> List {
    let row = |(_, name, help): &(T, &str, &str)| format!("| `{name}` | {} |\n", help.trim().replace('|', "\\|"));
    (T::WHAT, format!("| name | what it is |\n|---|---|\n{}", T::CHOICES.iter().map(row).collect::<String>()))
}

fn lists() -> Vec<List> {
    vec![
        list::<Backend>(),
        list::<FeaturesOn>(),
        list::<Model>(),
        list::<ObjectiveKind>(),
        list::<EdgeTerm>(),
        list::<SearchKind>(),
        list::<Prediction>(),
        list::<Width>(),
        list::<Passes>(),
        list::<Operator>(),
        list::<Magnitude>(),
        list::<Metric>(),
        list::<Normalisation>(),
        list::<Adaptation>(),
        list::<ForegroundKind>(),
        list::<Shape>(),
        list::<Cue>(),
        list::<PointFormat>(),
        list::<Convention>(),
        list::<MotionFormat>(),
        list::<CalibrationFormat>(),
        list::<Stamps>(),
        list::<Orientation>(),
        list::<ScenePreset>(),
        list::<Gait>(),
        list::<RigKind>(),
        list::<LensKind>(),
        list::<PictureForm>(),
        list::<MotionUnit>(),
        list::<UpAxis>(),
        list::<Garment>(),
        list::<BoardKind>(),
        list::<LensModel>(),
        list::<Held>(),
        list::<Layout>(),
        list::<LengthUnit>(),
        list::<Skinning>(),
        list::<MaterialKind>(),
        list::<Sum>(),
        list::<NoiseWay>(),
        list::<Arrangement>(),
        list::<UnitKind>(),
        list::<Multiplier>(),
        list::<Axis>(),
        list::<Pace>(),
        list::<Value>(),
        list::<Preset>(),
        list::<InstructionSet>(),
        list::<Packing>(),
        list::<Coverage>(),
        list::<Gathering>(),
        list::<HostComparison>(),
        list::<Tiling>(),
        list::<Projection>(),
        list::<Primitives>(),
        list::<Channels>(),
        list::<YardstickKind>(),
        list::<Scheme>(),
    ]
}

const END: &str = "<!-- end of choices -->";

/// The text with its tables as the lists have them, and the lists it has tables of.
fn written(text: &str, lists: &[List]) -> (String, Vec<&'static str>) {
    let mut found = Vec::new();
    let mut pieces = text.split("<!-- choices: ");
    let mut result = pieces.next().unwrap().to_string();
    for piece in pieces {
        let (what, rest) = piece.split_once(" -->\n").unwrap();
        let (_, after) = rest.split_once(END).unwrap_or_else(|| panic!("the table of {what} has no end"));
        let (what, table) = lists.iter().find(|(known, _)| *known == what).unwrap_or_else(|| panic!("no list {what}"));
        found.push(*what);
        result += &format!("<!-- choices: {what} -->\n\n{table}\n{END}{after}");
    }
    (result, found)
}

fn documents() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = fs::read_dir(root.join("docs")).unwrap().map(|entry| entry.unwrap().path());
    docs.chain([root.join("README.md")]).filter(|path| path.extension().is_some_and(|end| end == "md")).collect()
}

#[test]
fn documents_list_every_choice() {
    let lists = lists();
    let mut listed = Vec::new();
    for path in documents() {
        let text = fs::read_to_string(&path).unwrap();
        let (expected, found) = written(&text, &lists);
        if std::env::var_os("PANTIN_WRITE_DOCS").is_some() && text != expected {
            fs::write(&path, &expected).unwrap();
        } else {
            assert_eq!(
                text,
                expected,
                "{}: PANTIN_WRITE_DOCS=1 cargo test --test choices writes it anew",
                path.display()
            );
        }
        listed.extend(found);
    }
    for (what, _) in lists {
        assert!(listed.contains(&what), "no document has a table of {what}: docs/CHOICES.md should");
    }
}

#[test]
fn a_table_that_lacks_a_choice_is_written_anew() {
    let lists = [("colour", "| red |\n".to_string())];
    let text = format!("a\n<!-- choices: colour -->\n| blue |\n{END}\nb\n");
    let (expected, found) = written(&text, &lists);
    assert_eq!(expected, format!("a\n<!-- choices: colour -->\n\n| red |\n\n{END}\nb\n"));
    assert_eq!(found, ["colour"]);
    assert_eq!(written(&expected, &lists).0, expected);
}
