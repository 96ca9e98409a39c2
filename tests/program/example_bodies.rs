//! The example bodies of docs/bodies: read, drawn alike by both evaluators, and tracked in sequences of their own.

use std::fs;
use std::path::Path;

use glam::DVec3;
use pantin::body::{Body, PoseTable, parse_body};
use pantin::evaluate::cpu::Cpu;
use pantin::evaluate::{Components, Evaluator, Reference};
use pantin::features::Observation;

use super::drawn::{self, Ring};
use super::support::{program, succeeded};

const FRAMES: usize = 10;

/// A body and what it does in front of its cameras.
struct Example {
    file: &'static str,
    dofs: usize,
    parts: usize,
    ring: Ring,
    /// The first pose: degrees.
    start: &'static [(&'static str, f64)],
    /// Changes a frame: mm, degrees.
    motion: &'static [(&'static str, f64)],
    /// The mean error of its joints and markers that a track may have, mm.
    error: f64,
}

/// Reaches up with one arm and bends and looks aside.
const UPPER_BODY: Example = Example {
    file: "upper_body.toml",
    dofs: 25,
    parts: 10,
    ring: Ring { radius: 1900.0, height: 1000.0, target: 450.0, size: [200, 160], focal: 210.0 },
    start: &[
        ("left_shoulder.rx", 35.0),
        ("left_elbow.ry", -40.0),
        ("right_shoulder.rx", -30.0),
        ("right_elbow.ry", -70.0),
    ],
    motion: &[
        ("thorax.ry", 1.5),
        ("thorax.tx", 6.0),
        ("head.rz", 3.0),
        ("left_shoulder.rx", 6.0),
        ("left_wrist.rx", -4.0),
        ("right_shoulder.ry", -4.0),
        ("right_elbow.ry", 3.0),
    ],
    error: 18.0,
};

/// Lifts a knee as if to kick, and points the toes.
const LEGS: Example = Example {
    file: "legs.toml",
    dofs: 18,
    parts: 7,
    ring: Ring { radius: 2400.0, height: 900.0, target: 480.0, size: [200, 160], focal: 220.0 },
    start: &[("left_hip.rx", 8.0), ("right_hip.rx", -8.0), ("left_knee.ry", 10.0), ("right_knee.ry", 5.0)],
    motion: &[
        ("pelvis.tx", 10.0),
        ("pelvis.rz", 2.0),
        ("left_hip.ry", -5.0),
        ("left_knee.ry", 6.0),
        ("left_ankle.ry", 3.0),
        ("right_hip.ry", 2.0),
    ],
    error: 15.0,
};

/// Turns, points with the index finger and closes the others.
const HAND: Example = Example {
    file: "hand.toml",
    dofs: 26,
    parts: 19,
    ring: Ring { radius: 430.0, height: 220.0, target: 95.0, size: [200, 160], focal: 270.0 },
    start: &[("index.rx", -8.0), ("ring.rx", 6.0), ("little.rx", 12.0), ("thumb.rx", -10.0)],
    motion: &[
        ("palm.rz", 2.0),
        ("palm.tx", 2.0),
        ("middle.ry", 5.0),
        ("middle_middle.ry", 7.0),
        ("ring.ry", 5.5),
        ("ring_middle.ry", 7.0),
        ("little.ry", 6.0),
        ("little_middle.ry", 7.0),
        ("thumb.ry", 2.0),
    ],
    error: 4.0,
};

impl Example {
    fn body(&self) -> Body {
        Body::load(&Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/bodies")).join(self.file)).unwrap()
    }

    /// The true poses.
    fn poses(&self, body: &Body) -> PoseTable {
        let names = body.dof_names();
        let mut first = body.standing_pose();
        let mut step = vec![0.0; first.len()];
        for (values, changes) in [(&mut first, self.start), (&mut step, self.motion)] {
            for (name, change) in changes {
                let index = names.iter().position(|known| known == name).unwrap();
                values[index] += body.dofs().nth(index).unwrap().1.axis.from_file(*change);
            }
        }
        let pose =
            |frame: usize| -> Vec<f64> { first.iter().zip(&step).map(|(at, step)| at + step * frame as f64).collect() };
        PoseTable { frames: (0..FRAMES).collect(), poses: (0..FRAMES).map(pose).collect() }
    }
}

/// Joints and markers in the world.
fn points(body: &Body, pose: &[f64]) -> Vec<DVec3> {
    let bones = body.world_from_bones(pose).unwrap();
    [body.joint_positions(&bones), body.marker_positions(&bones)].concat()
}

fn mean_distance(body: &Body, a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (points(body, a), points(body, b));
    a.iter().zip(&b).map(|(a, b)| a.distance(*b)).sum::<f64>() / a.len() as f64
}

fn check(example: &Example) {
    let body = example.body();
    assert_eq!((body.dof_count(), body.parts.len()), (example.dofs, example.parts));
    assert_eq!(parse_body(&body.to_toml(), example.file).unwrap(), body, "it is written as it was read");
    let cameras = example.ring.cameras();
    let truth = example.poses(&body);
    for pose in &truth.poses {
        body.check_limits(pose).unwrap();
    }

    // Both evaluators count the same pixels, and every part is in the pictures.
    let rows: Vec<f32> = truth.poses.concat().iter().map(|value| *value as f32).collect();
    let (mut reference, mut cpu) = (Reference::new(&body, &cameras), Cpu::new(&body, &cameras).unwrap());
    let drawn: Vec<_> = (0..cameras.len()).map(|view| reference.draw(&rows[..example.dofs], view)).collect();
    for part in &body.parts {
        let seen = drawn.iter().any(|image| image.bytes.iter().any(|byte| byte & 0x7f == part.label));
        assert!(seen, "{} is in no picture", part.name);
    }
    let observed: Vec<Observation> = drawn
        .iter()
        .map(|image| {
            let mut seen = Observation::empty(image.width, image.height);
            for (byte, drawn) in seen.bytes.iter_mut().zip(&image.bytes) {
                *byte = u8::from(*drawn != 0) << 7 | drawn >> 1 & 0x3f;
            }
            seen
        })
        .collect();
    let [expected, found] = [&mut reference as &mut dyn Evaluator, &mut cpu].map(|evaluator| {
        let mut components = vec![Components::default(); FRAMES * cameras.len()];
        evaluator.observe(&observed).unwrap();
        evaluator.components(&rows, &mut components).unwrap();
        components
    });
    assert_eq!(expected, found);

    let folder = tempfile::tempdir().unwrap();
    drawn::write(folder.path(), &body.name, &body, &cameras, &truth);
    let result = folder.path().join("result");
    let mut command = program();
    command.arg("track").arg(folder.path()).arg("-o").arg(&result).args(["--particles", "150", "--iterations", "20"]);
    let done = command.output().unwrap();
    succeeded(&done);
    let found = PoseTable::read(&result.join("poses.csv"), &body).unwrap();
    assert_eq!(found.frames, truth.frames);
    let errors: Vec<f64> =
        truth.poses.iter().zip(&found.poses).map(|(truth, found)| mean_distance(&body, truth, found)).collect();
    let error = errors.iter().sum::<f64>() / errors.len() as f64;
    let moved = mean_distance(&body, &truth.poses[0], &truth.poses[FRAMES - 1]);
    assert!(error < example.error && errors[FRAMES - 1] < 0.3 * moved, "{errors:.1?} mm, after a way of {moved:.1} mm");
    let markers = fs::metadata(result.join("markers.c3d")).unwrap().len();
    assert!(markers > 512 && result.join("motion.bvh").is_file() && result.join("report.html").is_file());
}

#[test]
fn an_upper_body_is_tracked() {
    check(&UPPER_BODY);
}

#[test]
fn legs_are_tracked() {
    check(&LEGS);
}

#[test]
fn a_hand_is_tracked() {
    check(&HAND);
}

/// Fingers bend towards the palm, which looks forwards; ankles point the toes; wrists bend towards the palm.
#[test]
fn joints_bend_the_way_people_do() {
    let moved = |example: &Example, dof: &str, point: &str, degrees: f64| {
        let body = example.body();
        let names: Vec<String> = body.joint_names().into_iter().chain(body.marker_names()).collect();
        let at = |pose: &[f64]| points(&body, pose)[names.iter().position(|name| name == point).unwrap()];
        let mut pose = vec![0.0; body.dof_count()];
        let rest = at(&pose);
        pose[body.dof_index(dof).unwrap()] = degrees.to_radians();
        body.check_limits(&pose).unwrap();
        at(&pose) - rest
    };
    for finger in ["index", "middle", "ring", "little"] {
        let tip = format!("{finger}_tip");
        for joint in [finger.to_string(), format!("{finger}_middle"), format!("{finger}_end")] {
            let by = moved(&HAND, &format!("{joint}.ry"), &tip, 60.0);
            assert!(by.x > 10.0 && by.z < -5.0, "{joint}: {by}");
        }
        assert!(
            moved(&HAND, &format!("{finger}.rx"), &tip, 10.0).y < -5.0,
            "{finger} goes to the little finger's side"
        );
    }
    assert!(moved(&HAND, "thumb.ry", "thumb_tip", 50.0).x > 40.0, "the thumb comes before the palm");
    assert!(moved(&HAND, "thumb_end.rx", "thumb_tip", 60.0).y < -10.0, "the thumb bends towards the fingers");
    for (toe, side) in [("LTOE", "left"), ("RTOE", "right")] {
        assert!(moved(&LEGS, &format!("{side}_ankle.ry"), toe, 30.0).z < -40.0, "{side} toes point down");
    }
    assert!(moved(&UPPER_BODY, "left_wrist.rx", "LFIN", -40.0).y < -20.0);
    assert!(moved(&UPPER_BODY, "right_wrist.rx", "RFIN", 40.0).y > 20.0);
    assert!(moved(&UPPER_BODY, "left_wrist.ry", "LFIN", 20.0).x < -20.0, "to the little finger's side, backwards");
}
