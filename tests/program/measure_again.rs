//! `measure_again` of a manifest, and `pantin track --measure-again`: a person who is not made as the given body is measured on the way.

use std::fs;
use std::path::Path;

use pantin::body::{Body, PoseTable, Proportions};
use pantin::files::Overwrite;

use super::drawn;
use super::support::{pantin, refused, stderr, stdout, succeeded};

/// How far the upper arms reach over the shoulders' joints, mm.
const OVER_SHOULDER: f64 = 30.0;

/// Pictures of somebody whose trunk lies before the spine, whose calves lie behind the knees and whose arms reach over the shoulders' joints, as
/// those of real people do, and whose arms are of other lengths; the manifest names an adult of the usual measures, and says that he was measured in one posture.
fn write_sequence(folder: &Path) -> [Body; 2] {
    let adult = Body::adult(1700.0).unwrap();
    let factors = [("upper arm".to_string(), 0.85), ("forearm".to_string(), 1.12)];
    let mut person = Proportions::named(&factors.into_iter().collect()).unwrap().apply(&adult);
    for part in &mut person.parts {
        let [near, far] = match part.name.trim_start_matches("left_").trim_start_matches("right_") {
            "belly" | "chest" | "neck" => [45.0, 45.0],
            "thigh" => [30.0, 0.0],
            "calf" => [-30.0, 0.0],
            _ => [0.0; 2],
        };
        part.a.x += near;
        part.b.x += far;
        if part.name.ends_with("upper_arm") {
            part.a.z += OVER_SHOULDER;
        }
    }
    for bone in &mut person.bones {
        if bone.name.ends_with("shoulder") || bone.name == "head" {
            bone.offset.x += 45.0;
        }
    }
    let names = person.dof_names();
    let pose = |frame: usize| -> Vec<f64> {
        let mut pose = person.standing_pose();
        let phase = frame as f64 * 0.25;
        for (name, middle, swing, shift) in [
            ("left_shoulder.rx", 55.0, 30.0, 0.0),
            ("right_shoulder.rx", -55.0, 30.0, 1.0),
            ("left_elbow.ry", -60.0, 40.0, 2.0),
            ("right_elbow.ry", -60.0, 40.0, 3.0),
            ("left_hip.ry", -25.0, 20.0, 4.0),
            ("left_knee.ry", 45.0, 30.0, 5.0),
            ("pelvis.rz", 0.0, 30.0, 6.0),
        ] {
            let degrees: f64 = middle + swing * (phase + shift).sin();
            pose[names.iter().position(|dof| dof == name).unwrap()] = degrees.to_radians();
        }
        person.clamp_to_limits(&mut pose);
        pose
    };
    let cameras =
        drawn::Ring { radius: 3500.0, height: 1300.0, target: 900.0, size: [256, 192], focal: 260.0 }.cameras();
    let table = PoseTable { frames: (0..24).collect(), poses: (0..24).map(pose).collect() };
    drawn::write(folder, "waving", &person, &cameras, &table);
    adult.save(&folder.join("body.toml"), Overwrite::Replace).unwrap();
    let manifest = folder.join("sequence.toml");
    let text = fs::read_to_string(&manifest).unwrap();
    fs::write(&manifest, format!("measure_again = true\n{text}")).unwrap();
    [adult, person]
}

/// Mean error that a run told, mm.
fn error(told: &str) -> f64 {
    let line = told.lines().find(|line| line.starts_with("error ")).unwrap();
    line.split(' ').nth(1).unwrap().parse().unwrap()
}

#[test]
fn a_person_made_otherwise_is_measured_on_the_way() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene");
    fs::create_dir(&scene).unwrap();
    let bodies = write_sequence(&scene);
    let track = |name: &str, more: &[&str]| {
        let (sequence, output) = (scene.join("sequence.toml"), folder.path().join(name));
        let mut arguments = vec!["track", sequence.to_str().unwrap(), "-o", output.to_str().unwrap()];
        arguments.extend(["--backend", "cpu", "--particles", "60", "--iterations", "10", "--overlay-every", "0"]);
        arguments.extend(more);
        pantin(&arguments)
    };
    let given = track("given", &["--measure-again=no"]);
    succeeded(&given);
    assert!(!folder.path().join("given/refined_body.toml").exists());
    let again = track("again", &[]);
    succeeded(&again);
    let told = format!("{}{}", stdout(&again), stderr(&again));
    assert!(told.contains("the results are of refined_body.toml beside them"), "{told}");
    let refined = Body::load(&folder.path().join("again/refined_body.toml")).unwrap();
    let chest = |body: &Body| body.parts.iter().find(|part| part.name == "chest").unwrap().a.x;
    let over_shoulder = |body: &Body| body.parts.iter().find(|part| part.name == "left_upper_arm").unwrap().a.z;
    let upper_arm = |body: &Body| body.bones[body.bone_index("left_elbow").unwrap()].offset.length();
    let [adult, person] = bodies.each_ref();
    let [before, after] = [&given, &again].map(|output| error(&stdout(output)));
    println!(
        "chest {:.0} mm before the spine, {:.0} true; {:.0} mm over the shoulder, {OVER_SHOULDER} true; upper arm {:.0} mm, {:.0} given, {:.0} true; error {before:.1} -> {after:.1} mm",
        chest(&refined),
        chest(person),
        over_shoulder(&refined),
        upper_arm(&refined),
        upper_arm(adult),
        upper_arm(person)
    );
    assert!(chest(&refined) > 0.5 * (chest(adult) + chest(person)) && upper_arm(&refined) < upper_arm(adult));
    assert!(over_shoulder(&refined) > 0.5 * OVER_SHOULDER);
    assert!(after < 0.8 * before, "{before} -> {after} mm");
    // The poses are the refined body's: with it the joints are where joints.csv has them.
    let poses = PoseTable::read(&folder.path().join("again/poses.csv"), &refined).unwrap();
    let joints = fs::read_to_string(folder.path().join("again/joints.csv")).unwrap();
    let row =
        |line: usize| -> Vec<String> { joints.lines().nth(line).unwrap().split(',').map(str::to_string).collect() };
    let place = |name: &str| row(0).iter().position(|column| column == name).unwrap();
    let wrist = refined.joint_positions(&refined.world_from_bones(&poses.poses[0]).unwrap())
        [refined.joint_index("left_wrist").unwrap()];
    for (value, name) in wrist.to_array().iter().zip(["left_wrist.x", "left_wrist.y", "left_wrist.z"]) {
        let written: f64 = row(1)[place(name)].parse().unwrap();
        assert!((value - written).abs() < 0.1, "{name}: {value} of {written}");
    }
    // A run that ends is gone on with as it was, the body of its results too.
    let poses = fs::read(folder.path().join("again/poses.csv")).unwrap();
    succeeded(&track("again", &["--resume"]));
    assert!(fs::read(folder.path().join("again/poses.csv")).unwrap() == poses, "a run that went on differs");

    let nothing = track("nothing", &["--frames", "0..8"]);
    succeeded(&nothing);
    let told = format!("{}{}", stdout(&nothing), stderr(&nothing));
    assert!(told.contains("tells of the body in 6 of its frames, expected 12 or more"), "{told}");
    // A manifest that asks for it may be gone over once; a command that asks for both is refused.
    succeeded(&track("forward", &["--passes", "forward", "--frames", "0..2"]));
    refused(
        &track("once", &["--measure-again", "--passes", "forward"]),
        &["goes over its frames once", "--measure-again"],
    );

    // A body that is right is kept.
    person.save(&scene.join("body.toml"), Overwrite::Replace).unwrap();
    let right = track("right", &[]);
    succeeded(&right);
    let told = format!("{}{}", stdout(&right), stderr(&right));
    assert!(told.contains("the body stays as it was given"), "{told}");
    assert!(!folder.path().join("right/refined_body.toml").exists());
}
