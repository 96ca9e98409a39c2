use std::path::{Path, PathBuf};

use proptest::prelude::*;

use super::*;
use crate::motion::{UpAxis, parse_bvh, read_skeletal_motion};

fn adult() -> Body {
    Body::adult(1750.0).unwrap()
}

fn real_data(test: &str) -> Option<PathBuf> {
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/motion"));
    if !path.is_dir() {
        println!("SKIPPED {test}: ../shared/data is absent");
        return None;
    }
    Some(path)
}

/// A person of another program: y up, centimetres, arms stretched out at rest, names of its own, one and a half spines.
const PERSON: &str = "HIERARCHY
ROOT Hips { OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT LeftUpLeg { OFFSET 9 -5 0 CHANNELS 3 Zrotation Yrotation Xrotation
    JOINT LeftLeg { OFFSET 0 -42 0 CHANNELS 3 Zrotation Yrotation Xrotation
      JOINT LeftFoot { OFFSET 0 -40 0 CHANNELS 3 Zrotation Yrotation Xrotation End Site { OFFSET 0 -5 14 } } } }
  JOINT RightUpLeg { OFFSET -9 -5 0 CHANNELS 3 Zrotation Yrotation Xrotation
    JOINT RightLeg { OFFSET 0 -42 0 CHANNELS 3 Zrotation Yrotation Xrotation
      JOINT RightFoot { OFFSET 0 -40 0 CHANNELS 3 Zrotation Yrotation Xrotation End Site { OFFSET 0 -5 14 } } } }
  JOINT Spine { OFFSET 0 12 0 CHANNELS 3 Zrotation Yrotation Xrotation
    JOINT Spine1 { OFFSET 0 15 0 CHANNELS 3 Zrotation Yrotation Xrotation
      JOINT Neck { OFFSET 0 22 0 CHANNELS 3 Zrotation Yrotation Xrotation
        JOINT Head { OFFSET 0 8 0 CHANNELS 3 Zrotation Yrotation Xrotation End Site { OFFSET 0 18 0 } } }
      JOINT LeftShoulder { OFFSET 3 18 0 CHANNELS 3 Zrotation Yrotation Xrotation
        JOINT LeftArm { OFFSET 14 0 0 CHANNELS 3 Zrotation Yrotation Xrotation
          JOINT LeftForeArm { OFFSET 28 0 0 CHANNELS 3 Zrotation Yrotation Xrotation
            JOINT LeftHand { OFFSET 25 0 0 CHANNELS 3 Zrotation Yrotation Xrotation End Site { OFFSET 8 0 0 } } } } }
      JOINT RightShoulder { OFFSET -3 18 0 CHANNELS 3 Zrotation Yrotation Xrotation
        JOINT RightArm { OFFSET -14 0 0 CHANNELS 3 Zrotation Yrotation Xrotation
          JOINT RightForeArm { OFFSET -28 0 0 CHANNELS 3 Zrotation Yrotation Xrotation
            JOINT RightHand { OFFSET -25 0 0 CHANNELS 3 Zrotation Yrotation Xrotation End Site { OFFSET -8 0 0 } } } } } } } }
MOTION
Frames: 1
Frame Time: 0.04
";

/// The person with rotations (degrees, about the file's z, y, x) of some joints, the hips 87 cm high.
fn person(turned: &[(&str, [f64; 3])]) -> SkeletalMotion {
    let zeros = vec!["0"; 60].join(" ");
    let mut motion = parse_bvh(&format!("{PERSON}{zeros}\n"), "person.bvh").unwrap();
    motion.frames[0][1] = 87.0;
    for (name, angles) in turned {
        let joint = motion.joints.iter().position(|joint| joint.name == *name).unwrap();
        let first: usize = motion.joints[..=joint].iter().map(|joint| joint.channels.len()).sum::<usize>() - 3;
        motion.frames[0][first..first + 3].copy_from_slice(angles);
    }
    motion.to_skeletal().unwrap()
}

fn degrees(body: &Body, pose: &[f64], dof: &str) -> f64 {
    pose[body.dof_index(dof).unwrap()].to_degrees()
}

fn one(body: &Body, motion: &SkeletalMotion) -> Vec<f64> {
    body.retarget(motion, &RetargetSettings::default(), 25.0, 1).unwrap().poses.remove(0)
}

#[test]
fn a_person_with_stretched_arms_stretches_the_bodys() {
    let body = adult();
    let pose = one(&body, &person(&[]));
    for (name, value) in body.dof_names().iter().zip(&pose) {
        let expected = match name.as_str() {
            "left_shoulder.rx" => 90.0,
            "right_shoulder.rx" => -90.0,
            "pelvis.tz" => continue,
            _ => 0.0,
        };
        assert!((value.to_degrees() - expected).abs() < 1e-6, "{name} is {}", value.to_degrees());
    }
    // On the floor, as the standing pose, but for the blending of its lowest points.
    let tz = body.dof_index("pelvis.tz").unwrap();
    assert!((pose[tz] - body.standing_pose()[tz]).abs() < 12.0, "{}", pose[tz]);
}

#[test]
fn known_turns_come_out_as_they_are() {
    let body = adult();
    // The file's x is the body's y, its y the body's z, its z the body's x.
    let pose = one(
        &body,
        &person(&[
            ("LeftUpLeg", [0.0, 0.0, -60.0]),
            ("LeftLeg", [0.0, 0.0, 80.0]),
            ("RightUpLeg", [-20.0, 0.0, 0.0]),
            ("Spine", [0.0, 30.0, 0.0]),
            ("Head", [0.0, 40.0, 0.0]),
            // Down from the stretched arm, and the forearm up towards the front.
            ("LeftArm", [-90.0, 0.0, 0.0]),
            ("LeftForeArm", [0.0, -70.0, 0.0]),
        ]),
    );
    for (dof, expected) in [
        ("left_hip.ry", -60.0),
        ("left_hip.rx", 0.0),
        ("left_knee.ry", 80.0),
        ("right_hip.rx", -20.0),
        ("right_knee.ry", 0.0),
        ("thorax.rz", 30.0),
        ("head.rz", 40.0),
        ("left_shoulder.rx", 0.0),
        ("left_elbow.ry", -70.0),
        ("right_shoulder.rx", -90.0),
    ] {
        let found = degrees(&body, &pose, dof);
        assert!((found - expected).abs() < 1e-6, "{dof} is {found}, expected {expected}");
    }
}

#[test]
fn limits_are_kept_and_the_rest_stays_right() {
    let body = adult();
    let pose = one(&body, &person(&[("LeftLeg", [0.0, 0.0, -50.0]), ("RightLeg", [0.0, 0.0, 40.0])]));
    body.check_limits(&pose).unwrap();
    assert_eq!(degrees(&body, &pose, "left_knee.ry"), 0.0, "a knee does not bend forwards");
    assert!((degrees(&body, &pose, "right_knee.ry") - 40.0).abs() < 1e-6);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn a_bodys_own_motion_comes_back(values in prop::collection::vec(0.15..0.85f64, 31), heading in -3.0..3.0f64) {
        let body = adult();
        let mut pose: Vec<f64> = body
            .dofs()
            .zip(&values)
            .map(|((_, dof), share)| {
                // Within a quarter turn, where the angles of a rotation are unique.
                let [low, high] = [dof.limits[0].max(-1.4), dof.limits[1].min(1.4)];
                low + (high - low) * share
            })
            .collect();
        pose[..6].copy_from_slice(&[100.0, 200.0, 950.0, 0.2, 0.1, heading]);
        let motion = body.to_bvh(&PoseTable { frames: vec![0], poses: vec![pose.clone()] }, 25.0).unwrap().to_skeletal().unwrap();
        let found = one(&body, &motion);
        let wanted = body.world_from_bones(&pose).unwrap();
        let got = body.world_from_bones(&found).unwrap();
        for ((bone, a), b) in body.bones.iter().zip(&wanted).zip(&got) {
            prop_assert!(a.matrix3.abs_diff_eq(b.matrix3, 1e-6), "{}: {} {}", bone.name, a.matrix3, b.matrix3);
        }
    }
}

#[test]
fn headings_places_and_repeats() {
    let body = adult();
    let mut motion = person(&[]);
    // A second frame one metre on and a quarter turned to the left: y is up, so about +y.
    let mut second = motion.frames[0].clone();
    second[0].origin.z += 100.0;
    second[0].rotation = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
    motion.frames.push(second);
    motion.times.push(1.0);
    let settings = RetargetSettings {
        heading: Some(0.5),
        at: Some(DVec2::new(300.0, -200.0)),
        repeats: true,
        ..RetargetSettings::default()
    };
    let table = body.retarget(&motion, &settings, 1.0, 5).unwrap();
    let heading = |frame: usize| table.poses[frame][5];
    for frame in 0..5 {
        let turned = 0.5 + frame as f64 * std::f64::consts::FRAC_PI_2;
        // A quarter turn a frame is drawn back a little by the wish to keep calm.
        assert!((heading(frame) - turned).abs() < 2e-3, "frame {frame}: {} {turned}", heading(frame));
    }
    let error = body.retarget(&motion, &RetargetSettings::default(), 25.0, 90).unwrap_err().to_string();
    assert!(error.contains("lasts 1.00 s") && error.contains("90 frames at 25 Hz"), "{error}");
}

#[test]
fn what_does_not_fit_is_named() {
    let body = adult();
    let error = |motion: &SkeletalMotion, settings: &RetargetSettings| {
        format!("{:#}", body.retarget(motion, settings, 25.0, 1).unwrap_err())
    };
    let plain = RetargetSettings::default();
    let renamed = |from: &str, to: &str| {
        let mut motion = person(&[]);
        motion.joints.iter_mut().filter(|j| j.name == from).for_each(|j| j.name = to.to_string());
        motion
    };
    let lost = error(&renamed("LeftForeArm", "bone17"), &plain);
    assert!(lost.contains("known to be `left_elbow`") && lost.contains("bone17"), "{lost}");
    let named = RetargetSettings { joints: [("left_elbow".into(), "bone17".into())].into(), ..plain.clone() };
    body.retarget(&renamed("LeftForeArm", "bone17"), &named, 25.0, 1).unwrap();
    let wrong = RetargetSettings { joints: [("left_elbow".into(), "bone71".into())].into(), ..plain.clone() };
    let wrong = error(&renamed("LeftForeArm", "bone17"), &wrong);
    assert!(wrong.contains("`bone71`") && wrong.contains("nearest known one is `bone17`"), "{wrong}");
    let nothing = RetargetSettings { joints: [("tail".into(), "Hips".into())].into(), ..plain.clone() };
    assert!(error(&person(&[]), &nothing).contains("`tail`, which is no bone"));

    let giant = RetargetSettings { unit: Some(100.0), ..plain.clone() };
    let giant = error(&person(&[]), &giant);
    assert!(giant.contains("16.70 m tall, expected 0.5 to 2.6 m"), "{giant}");
    let mut ant = person(&[]);
    ant.joints.iter_mut().for_each(|joint| joint.offset *= 1e-6);
    assert!(error(&ant, &plain).contains("expected 1 to 2.3 m: name the unit"));
    let lying = RetargetSettings { up: Some(UpAxis::Z), ..plain.clone() };
    assert!(error(&person(&[]), &lying).contains("is the up axis right?"));
    let mut flat = person(&[]);
    flat.joints.iter_mut().filter(|j| j.name.ends_with("UpLeg")).for_each(|j| j.offset.x = 0.0);
    assert!(error(&flat, &plain).contains("side by side"));
    let mut legless = person(&[]);
    for joint in legless.joints.iter_mut().filter(|joint| ["LeftLeg", "LeftFoot"].contains(&joint.name.as_str())) {
        joint.offset = DVec3::ZERO;
    }
    assert!(error(&legless, &plain).contains("a leg is 0 long"));
    assert!(body.retarget(&person(&[]), &plain, f64::NAN, 1).unwrap_err().to_string().contains("frame rate is NaN"));
}

/// Real recordings: limits kept, feet on the floor but for flight, and not sliding, nothing jerks.
#[test]
fn recordings_walk_and_jump_on_the_floor() {
    let Some(folder) = real_data("recordings_walk_and_jump_on_the_floor") else { return };
    let body = adult();
    /// File, skeleton, first second, frames at 60 Hz, most mm above the floor, least way in mm, most mm/s of sliding.
    type Take = (&'static str, Option<&'static str>, f64, usize, f64, f64, f64);
    let takes: [Take; 6] = [
        ("cmu_bvh/02_01.bvh", None, 0.1, 150, 25.0, 2000.0, 60.0),
        ("cmu_bvh/02_03.bvh", None, 0.1, 80, 150.0, 2500.0, 60.0),
        // Feet that turn outwards in a deep crouch cannot both stand still, rigid on their shins.
        ("cmu_bvh/02_04.bvh", None, 0.1, 230, 600.0, 0.0, 160.0),
        ("cmu_asfamc/02_01.amc", Some("cmu_asfamc/02.asf"), 0.0, 150, 25.0, 2000.0, 60.0),
        ("deepmimic/humanoid3d_walk.txt", None, 0.0, 200, 60.0, 1500.0, 100.0),
        ("deepmimic/humanoid3d_kick.txt", None, 0.0, 80, 200.0, 0.0, 250.0),
    ];
    for (file, skeleton, first, frames, flight, way, slide) in takes {
        let skeleton = skeleton.map(|name| folder.join(name));
        let motion = read_skeletal_motion(&folder.join(file), skeleton.as_deref().map(Path::new), None).unwrap();
        let motion = motion.cut(first, 1e9).unwrap();
        let table = body.retarget(&motion, &RetargetSettings::default(), 60.0, frames).unwrap();
        let (mut deepest, mut highest, mut slid, mut standing) = (0.0f64, 0.0f64, 0.0, 0);
        let mut jump = (0.0f64, String::new());
        let mut before: Option<(Vec<DVec3>, Vec<f64>)> = None;
        for (frame, pose) in table.poses.iter().enumerate() {
            body.check_limits(pose).unwrap();
            let bones = body.world_from_bones(pose).unwrap();
            let points = ground::lowest_points(&body, &bones);
            let low = points.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
            (deepest, highest) = (deepest.min(low), highest.max(low));
            if let Some((earlier, last)) = &before {
                for (p, q) in earlier.iter().zip(&points).filter(|(p, q)| p.z < 4.0 && q.z < 4.0) {
                    slid += p.truncate().distance(q.truncate());
                    standing += 1;
                }
                for ((a, b), (name, (_, dof))) in pose.iter().zip(last).zip(body.dof_names().iter().zip(body.dofs())) {
                    if dof.axis.is_rotation() && (a - b).abs() > jump.0 {
                        jump = ((a - b).abs(), format!("{name} at frame {frame}"));
                    }
                }
            }
            before = Some((points, pose.clone()));
        }
        let speed = slid / f64::from(standing.max(1)) * 60.0;
        let ends = [&table.poses[0], &table.poses[frames - 1]].map(|pose| DVec2::new(pose[0], pose[1]));
        println!(
            "{file}: {deepest:.1} to {highest:.1} mm above the floor, feet slide {speed:.0} mm/s, way {:.0} mm, fastest turn {:.1} degrees ({})",
            ends[0].distance(ends[1]),
            jump.0.to_degrees(),
            jump.1
        );
        assert!(deepest > -1.0 && highest < flight, "{file}: {deepest} to {highest} mm above the floor");
        assert!(speed < slide, "{file}: feet slide at {speed} mm/s");
        assert!(ends[0].distance(ends[1]) >= way, "{file}: a way of {}", ends[0].distance(ends[1]));
        assert!(jump.0 < 30f64.to_radians(), "{file}: {} turns by {} degrees", jump.1, jump.0.to_degrees());
    }
}
