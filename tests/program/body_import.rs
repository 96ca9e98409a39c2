//! A person imported from a skinned glTF file: `pantin convert person.glb body.toml` and `Body::from_gltf`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use pantin::body::{ADULT_HEIGHT, Body, Mesh};
use pantin::evaluate::{CandidateImage, Reference};
use pantin::synth::rig::four_cameras;

use super::support::{pantin_in as pantin, shared};

/// The person's height in the file, mm.
const HEIGHT: f64 = 1780.0;

/// The skinned person, or a line that says why the test is skipped.
fn person(test: &str) -> Option<PathBuf> {
    shared(test, "mesh/human_male.glb")
}

fn imported(path: &Path) -> Body {
    Body::from_gltf(path, &Body::adult(ADULT_HEIGHT).unwrap(), None, &BTreeMap::new()).unwrap()
}

/// Where the joints are at rest, by name.
fn at_rest(body: &Body) -> BTreeMap<String, DVec3> {
    let bones = body.world_from_bones(&body.standing_pose()).unwrap();
    body.joint_names().into_iter().zip(body.joint_positions(&bones)).collect()
}

/// The file with a text replaced by another of the same length, so that its chunks stay as long as they say.
fn edited(path: &Path, from: &str, to: &str) -> Vec<u8> {
    assert_eq!(from.len(), to.len());
    let mut bytes = fs::read(path).unwrap();
    let windows = bytes.windows(from.len()).enumerate();
    let places: Vec<usize> = windows.filter(|(_, text)| *text == from.as_bytes()).map(|(at, _)| at).collect();
    assert!(!places.is_empty(), "the file says {from}");
    for at in places {
        bytes[at..at + to.len()].copy_from_slice(to.as_bytes());
    }
    bytes
}

/// Lengths are those between the joints of the file, as its own table has them; the same left and right; and a person's, as Winter
/// tabulates them after Drillis and Contini (fractions of stature), but for the upper arms: this person's shoulders turn lower.
#[test]
fn lengths_are_the_files_and_those_of_a_person() {
    let Some(path) = person("lengths_are_the_files_and_those_of_a_person") else { return };
    let joints = at_rest(&imported(&path));
    let rig: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(path.with_file_name("human_male_rig.json")).unwrap()).unwrap();
    let in_file = |name: &str| {
        let bone = rig["bones"].as_array().unwrap().iter().find(|bone| bone["name"] == name).unwrap();
        DVec3::from_array([0, 1, 2].map(|axis| bone["head"][axis].as_f64().unwrap()))
    };
    for (ends, in_rig, fraction, tolerance) in [
        (["hip", "knee"], ["UpLeg", "Leg"], 0.245, 0.1),
        (["knee", "ankle"], ["Leg", "Foot"], 0.246, 0.1),
        (["shoulder", "elbow"], ["Arm", "ForeArm"], 0.186, 0.25),
        (["elbow", "wrist"], ["ForeArm", "Hand"], 0.146, 0.1),
    ] {
        let lengths = ["left", "right"].map(|side| {
            let [a, b] = ends.map(|end| joints[&format!("{side}_{end}")]);
            a.distance(b)
        });
        let [a, b] = in_rig.map(|name| in_file(&format!("Left{name}")));
        let expected = a.distance(b);
        assert!(lengths.iter().all(|length| (length - expected).abs() < 1.0), "{ends:?}: {lengths:?}, not {expected}");
        assert!(
            (lengths[0] / HEIGHT / fraction - 1.0).abs() < tolerance,
            "{ends:?}: {} of the height",
            lengths[0] / HEIGHT
        );
    }
    for (joint, fraction) in [("left_ankle", 0.039), ("left_hip", 0.53), ("right_shoulder", 0.80), ("head_top", 1.0)] {
        let found = joints[joint].z / HEIGHT;
        assert!((found - fraction).abs() < 0.015, "{joint} stands at {found} of the height");
    }
    for (name, at) in joints.iter().filter(|(name, _)| name.starts_with("left_") && *name != "left_axis") {
        let twin = joints[&name.replace("left_", "right_")];
        assert!(at.y > 0.0 && at.distance(twin * DVec3::new(1.0, -1.0, 1.0)) < 0.5, "{name} {at}, its twin {twin}");
    }
}

fn silhouettes(body: &Body, mesh: Option<Mesh>, poses: &[Vec<f32>]) -> Vec<CandidateImage> {
    let cameras = four_cameras(DVec2::splat(2600.0), [400, 300]);
    let reference = match mesh {
        Some(mesh) => Reference::of_mesh(body, mesh, &cameras).unwrap(),
        None => Reference::new(body, &cameras),
    };
    poses
        .iter()
        .flat_map(|pose| (0..cameras.len()).map(|view| reference.draw(pose, view)).collect::<Vec<_>>())
        .collect()
}

/// The flat body beside the skin it was fitted to: overlaps of 0.87 to 0.93 where the default body of that height has 0.72 to 0.83.
#[test]
fn flat_silhouettes_are_those_of_the_skin() {
    let Some(path) = person("flat_silhouettes_are_those_of_the_skin") else { return };
    let body = imported(&path);
    let poses: Vec<Vec<f32>> = POSES.iter().map(|changes| pose(&body, changes)).collect();
    let skin = silhouettes(&body, Some(Mesh::of_body(&body).unwrap()), &poses);
    let overlaps = |body: &Body| -> Vec<f64> {
        skin.iter().zip(&silhouettes(body, None, &poses)).map(|(skin, flat)| overlap(skin, flat)).collect()
    };
    let (fitted, default) = (overlaps(&body), overlaps(&Body::adult(HEIGHT).unwrap()));
    assert_eq!(fitted.len(), 16);
    for (fitted, default) in fitted.iter().zip(&default) {
        assert!(*fitted > 0.85 && *fitted > default + 0.03, "{fitted} beside {default}");
    }
    let mean = fitted.iter().sum::<f64>() / fitted.len() as f64;
    assert!(mean > 0.885, "{mean}: {fitted:.3?}");
}

#[test]
fn the_command_writes_a_body_that_loads_and_moves() {
    let Some(path) = person("the_command_writes_a_body_that_loads_and_moves") else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path().join("here");
    fs::create_dir(&at).unwrap();
    fs::copy(&path, at.join("person.glb")).unwrap();
    let (status, out, error) = pantin(&at, &["convert", "person.glb", "body.toml"]);
    assert_eq!((status, out.as_str()), (0, "body.toml: 15 bones, 16 parts\n"), "{error}");
    let body = Body::load(&at.join("body.toml")).unwrap();
    assert_eq!(body, imported(&at.join("person.glb")));
    assert_eq!((body.name.as_str(), body.markers.len()), ("person", 39));
    let (status, _, error) = pantin(&at, &["convert", "person.glb", "body.toml"]);
    assert!(status == 1 && error.contains("body.toml exists already"), "{error}");

    // The mesh is named from the body's folder, which may move.
    let moved = folder.path().join("there");
    fs::rename(&at, &moved).unwrap();
    let body = Body::load(&moved.join("body.toml")).unwrap();
    assert_eq!(Mesh::of_body(&body).unwrap().inverse_bind.len(), 15);

    // A name that tells nothing has to be given; then all is as before.
    fs::write(moved.join("odd.glb"), edited(&path, "LeftLeg", "Bone.17")).unwrap();
    let (status, _, error) = pantin(&moved, &["convert", "odd.glb", "odd.toml"]);
    assert!(status == 1 && error.contains("odd.glb: no joint of it is known to be `left_knee`"), "{error}");
    let named = ["convert", "odd.glb", "odd.toml", "--bone", "left_knee=Bone.17"];
    assert_eq!(pantin(&moved, &named).0, 0);
    let odd = Body::load(&moved.join("odd.toml")).unwrap();
    assert_eq!((&odd.bones, &odd.parts), (&body.bones, &body.parts));

    let thigh = |height: &str| {
        let name = format!("{height}.toml");
        let (status, _, error) = pantin(&moved, &["convert", "person.glb", &name, "--height", height]);
        assert_eq!(status, 0, "{error}");
        let body = Body::load(&moved.join(name)).unwrap();
        body.bones[body.bone_index("left_knee").unwrap()].offset.z
    };
    assert!((thigh("1980") / thigh("1800") - 1.1).abs() < 5e-4);
}

#[test]
fn what_is_no_person_is_refused_in_one_sentence() {
    let Some(path) = person("what_is_no_person_is_refused_in_one_sentence") else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::copy(&path, at.join("person.glb")).unwrap();
    fs::write(at.join("statue.glb"), edited(&path, "\"skin\":", "\"skim\":")).unwrap();
    fs::write(at.join("text.glb"), "o person\nv 0 0 0\n").unwrap();
    fs::write(at.join("cut.glb"), &fs::read(&path).unwrap()[..5000]).unwrap();
    fs::write(at.join("still.csv"), "frame,a.x,a.y,a.z\n0,1,2,3\n").unwrap();
    for (arguments, sentence) in [
        (&["nobody.glb", "body.toml"][..], "cannot read nobody.glb"),
        (&["statue.glb", "body.toml"], "statue.glb: it has no mesh with a skin, expected a skinned person"),
        (&["text.glb", "body.toml"], "text.glb: it is no glTF file"),
        (&["cut.glb", "body.toml"], "cut.glb: it is 5000 bytes long, its header says"),
        (&["person.glb", "body.csv"], "body.csv is no body file, expected a name that ends in .toml"),
        (&["person.glb", "body.toml", "--height", "1.78"], "its person is 2 mm tall, expected 500 to 2500"),
        (&["person.glb", "body.toml", "--height", "nan"], "its person is NaN mm tall"),
        (&["person.glb", "body.toml", "--scale", "10"], "--scale, --rate, --smooth and --y-up are for recordings"),
        (
            &["person.glb", "body.toml", "--bone", "left_hip=Thigh"],
            "`left_hip` is given the joint `Thigh`, which is none",
        ),
        (
            &["person.glb", "body.toml", "--bone", "left_hop=LeftArm"],
            "`left_hop`, which is no bone, the nearest known one is `left_hip`",
        ),
        (&["person.glb", "body.toml", "--bone", "left_hip=LeftLeg"], "no joint of it is known to be `left_knee`"),
        (&["still.csv", "still.trc", "--rate", "5", "--height", "1780"], "--height and --bone are for .glb and .gltf"),
    ] {
        let (status, _, error) = pantin(at, &[&["convert"], arguments].concat());
        assert!(status == 1 && error.trim_end().lines().count() == 1, "{arguments:?}: {error}");
        assert!(error.contains(sentence), "{arguments:?}: `{error}` lacks `{sentence}`");
    }
    assert!(!at.join("body.toml").exists() && !at.join("still.trc").exists());
}

const POSES: [&[(&str, f64)]; 4] = [
    &[],
    &[("left_shoulder.rx", 85.0), ("right_shoulder.rx", -85.0)],
    &[
        ("pelvis.rz", 30.0),
        ("left_hip.ry", -30.0),
        ("left_knee.ry", 15.0),
        ("right_hip.ry", 20.0),
        ("right_knee.ry", 30.0),
        ("left_shoulder.ry", 25.0),
        ("right_shoulder.ry", -30.0),
        ("right_elbow.ry", -60.0),
    ],
    &[
        ("pelvis.rz", -70.0),
        ("left_hip.ry", -80.0),
        ("left_knee.ry", 85.0),
        ("right_hip.ry", -70.0),
        ("right_knee.ry", 95.0),
        ("thorax.ry", 20.0),
        ("left_shoulder.rx", 60.0),
        ("left_elbow.ry", -40.0),
    ],
];

fn pose(body: &Body, changes: &[(&str, f64)]) -> Vec<f32> {
    let names = body.dof_names();
    let mut pose = body.standing_pose();
    for (name, degrees) in changes {
        pose[names.iter().position(|known| known == name).unwrap()] = degrees.to_radians();
    }
    body.check_limits(&pose).unwrap();
    pose.iter().map(|value| *value as f32).collect()
}

/// Pixels in both over pixels in either.
fn overlap(a: &CandidateImage, b: &CandidateImage) -> f64 {
    let count = |is: fn(bool, bool) -> bool| {
        a.bytes.iter().zip(&b.bytes).filter(|(a, b)| is(**a != 0, **b != 0)).count() as f64
    };
    count(|a, b| a && b) / count(|a, b| a || b)
}
