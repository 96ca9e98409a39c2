//! The cases: what is seen, by which cameras, of which body, and how many poses each kind of backend is held to the reference on.

use std::sync::{Arc, LazyLock, OnceLock};

use glam::{DAffine3, DMat3, DVec3};
use pantin::body::Body;
use pantin::evaluate::{Evaluator, Reference};
use pantin::features::{Evidence, Observation, Segmentation};
use pantin::geometry::Camera;

use crate::found::{Found, assert_fitness, expected};
use crate::scene::{Random, brown, camera, cameras, ignoring, observations, poses};
use crate::{evidence, segments};

/// What a backend is, to how many poses it takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    Processor,
    Compute,
    /// With limits so low that poses go in batches.
    Batched,
    /// With limits too low for more than silhouettes.
    Small,
    Graphics,
}

/// Poses of each [`Kind`] of backend, in their order; 0 where a case is left out: on the software device of most runs large pictures take
/// minutes.
type Counts = [usize; 5];

/// A body before cameras.
pub(crate) struct Stage {
    pub(crate) body: Body,
    pub(crate) cameras: Vec<Camera>,
}

pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) stage: &'static Stage,
    pub(crate) seen: Vec<Observation>,
    /// One pixel of what is seen otherwise, under the first pose.
    pub(crate) changed: Vec<Observation>,
    poses: Vec<f32>,
    counts: Counts,
    expected: OnceLock<Found>,
}

impl Case {
    /// The poses for a kind of backend.
    pub(crate) fn poses(&self, kind: Kind) -> &[f32] {
        let count = self.counts[kind as usize];
        &self.poses[..count * self.stage.body.dof_count()]
    }

    /// What the reference finds for the first poses.
    pub(crate) fn expected(&self, poses: &[f32]) -> Found {
        let Stage { body, cameras } = self.stage;
        let all = self.expected.get_or_init(|| expected(body, cameras, &self.seen, &self.poses));
        all.first(poses.len() / body.dof_count(), self.poses.len() / body.dof_count())
    }

    fn new(name: &'static str, stage: &'static Stage, poses: Vec<f32>, seen: Vec<Observation>, counts: Counts) -> Self {
        let most = counts.into_iter().max().unwrap();
        let poses = poses[..most * stage.body.dof_count()].to_vec();
        let changed = changed(stage, &seen, &poses);
        Self { name, stage, seen, changed, poses, counts, expected: OnceLock::new() }
    }
}

/// One pixel changed that counts and that the first pose covers: its evidence, its segment, or its silhouette.
fn changed(Stage { body, cameras }: &Stage, seen: &[Observation], poses: &[f32]) -> Vec<Observation> {
    let reference = Reference::new(body, cameras);
    let covered = |view: usize| {
        let drawn = reference.draw(&poses[..body.dof_count()], view).bytes;
        (0..drawn.len()).find(|&at| drawn[at] != 0 && !seen[view].ignores(at)).map(|at| (view, at, drawn[at] & 0x7f))
    };
    let (view, at, label) = (0..cameras.len()).rev().find_map(covered).unwrap();
    let mut changed = seen.to_vec();
    let (width, height) = (seen[view].width, seen[view].height);
    if let Some(evidence) = &seen[view].evidence {
        let shift = 4 * u32::from(evidence.classes().of_label(label));
        let mut words = evidence.words().to_vec();
        words[at] = if words[at] >> shift & 15 == 14 { words[at] - (1 << shift) } else { words[at] + (1 << shift) };
        changed[view].evidence = Some(Evidence::new(Arc::clone(evidence.classes()), width, height, words).unwrap());
    } else if let Some(segmentation) = &seen[view].segmentation {
        let mut numbers = segmentation.numbers().to_vec();
        let at = (0..numbers.len()).find(|&at| numbers[at] == 1 && !seen[view].ignores(at)).unwrap();
        numbers[at] = 3;
        let segments = Arc::clone(segmentation.segments());
        changed[view].segmentation = Some(Segmentation::new(segments, width, height, numbers).unwrap());
    } else {
        changed[view].bytes[at] ^= Observation::SILHOUETTE;
    }
    changed
}

/// Four cameras of all kinds round an adult.
pub(crate) static USUAL: LazyLock<Stage> =
    LazyLock::new(|| Stage { body: Body::adult(1750.0).unwrap(), cameras: cameras() });

/// Pictures far larger than a cell, in which a limb is hundreds of pixels long: too long for single precision, and of more rows than the
/// first bits hold.
static LARGE: LazyLock<Stage> = LazyLock::new(|| {
    let (size, target) = ([2051, 1211], DVec3::new(0.0, 0.0, 900.0));
    let cameras = [(1400.0, 900.0), (5000.0, 2500.0)].map(|(distance, focal)| {
        let lens = brown(focal, size, [-0.05, 0.01, 0.0], [1e-4, -1e-4]);
        camera("large", size, DVec3::new(distance, 500.0, 1300.0), target, lens)
    });
    Stage { body: Body::adult(1750.0).unwrap(), cameras: cameras.into() }
});

/// An adult with copies of a forearm, every second of the same depth, and more parts than fit one register; and which part was copied.
pub(crate) fn of_equal_depths() -> (Body, usize) {
    let mut body = Body::adult(1750.0).unwrap();
    let arm = body.parts.iter().position(|part| part.name.contains("forearm")).unwrap();
    for copy in 0..40_u8 {
        let mut part = body.parts[arm].clone();
        part.name = format!("copy_{copy}");
        part.label = 60 + copy;
        // Every second copy has the same mid-point, so the same depth.
        part.a.z += f64::from(copy / 2);
        part.b.z -= f64::from(copy / 2);
        part.radius_a += f64::from(copy);
        body.parts.push(part);
    }
    (body, arm)
}

/// A camera straight above a hanging arm, whose axis it looks along; parts of equal depth, and more parts than fit one register.
static DEGENERATE: LazyLock<Stage> = LazyLock::new(|| {
    let (body, arm) = of_equal_depths();
    let bones = body.world_from_bones(&vec![0.0; body.dof_count()]).unwrap();
    let elbow = bones[body.parts[arm].bone];
    let (a, b) = (elbow.transform_point3(body.parts[arm].a), elbow.transform_point3(body.parts[arm].b));
    let eye = a + (a - b).normalize() * 2000.0;
    let mut cameras = cameras();
    let rotation = DMat3::from_cols(DVec3::X, -DVec3::Y, -DVec3::Z).transpose();
    let camera_from_world = DAffine3::from_mat3_translation(rotation, -(rotation * eye));
    cameras.push(Camera { camera_from_world, ..cameras[1].clone() });
    Stage { body, cameras }
});

/// The first pose of a body.
type FirstPose = fn(&Body) -> Vec<f32>;

/// All cases, those of a stage one after the other.
pub(crate) static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| {
    let usual = &*USUAL;
    let mut random = Random(7);
    let noise = observations(&usual.cameras, &mut random);
    let wild = poses(&usual.body, 10_000, &mut random);
    let in_part = |seen: &[Observation]| ignoring(seen, &mut Random(3));
    let in_segments = segments::seen(usual, &segments::three(), &mut Random(31));
    let case = |name, seen, counts| Case::new(name, usual, wild.clone(), seen, counts);
    let mut cases = vec![
        // First: where poses already take all of a device's memory, nothing can be ignored any more.
        case("silhouettes in part", in_part(&noise), [300, 100, 100, 100, 100]),
        case("silhouettes", noise.clone(), [10_000, 2000, 150, 150, 500]),
        case("segments in part", in_part(&in_segments), [200, 200, 0, 0, 100]),
        case("segments", in_segments, [1500, 300, 100, 0, 200]),
    ];
    for (class_count, name, in_part_name, counts) in [
        (1, "evidence of one class", "evidence of one class in part", [100, 0, 0, 0, 0]),
        (5, "evidence of five classes", "evidence of five classes in part", [400, 200, 0, 0, 100]),
        (8, "evidence of eight classes", "evidence of eight classes in part", [100, 0, 200, 0, 0]),
    ] {
        let seen = evidence::seen(&usual.cameras, &evidence::classes(class_count), &mut Random(42));
        cases.push(case(in_part_name, in_part(&seen), counts));
        cases.push(case(name, seen, counts));
    }
    // And back to what was first.
    cases.push(case("silhouettes again", noise, [100, 100, 100, 100, 100]));
    let stages: [(_, _, FirstPose, usize); 2] = [
        ("large pictures", &*LARGE, |body| body.standing_pose().iter().map(|value| *value as f32).collect(), 12),
        ("degenerate cones", &*DEGENERATE, |body| vec![0.0; body.dof_count()], 300),
    ];
    for (name, stage, first, wild) in stages {
        let mut random = Random(9);
        let seen = observations(&stage.cameras, &mut random);
        let poses = [first(&stage.body), poses(&stage.body, wild, &mut random)].concat();
        cases.push(Case::new(name, stage, poses, seen, [1 + wild, 0, 0, 0, 0]));
    }
    cases
});

/// The case of that name.
pub(crate) fn case(name: &str) -> &'static Case {
    CASES.iter().find(|case| case.name == name).unwrap()
}

/// The cases can tell backends apart: there is something to see, what is ignored is missed, and one pixel counts.
#[test]
fn the_cases_show_something() {
    for case in CASES.iter() {
        let poses = case.poses(Kind::Processor);
        let expected = case.expected(poses);
        let drawn = expected.components.iter().filter(|sums| sums.area_model > 0).count();
        assert!(drawn * 4 > expected.components.len(), "{}: {drawn} images show anything", case.name);
        let Stage { body, cameras } = case.stage;
        let one = &poses[..body.dof_count()];
        let mut reference = Reference::new(body, cameras);
        let changed = crate::found::found(&mut reference, &case.changed, one);
        assert!(case.expected(one).difference(&changed).is_some(), "{}: a changed pixel is not seen", case.name);
        if let Some(whole) = case.name.strip_suffix(" in part") {
            let whole = self::case(whole).expected(poses);
            assert!(whole != expected, "{}: nothing is missed", case.name);
        }
        // The formulas are those that the reference's own fitness goes by.
        let few = &poses[..poses.len().min(20 * body.dof_count())];
        reference.observe(&case.seen).unwrap();
        assert_fitness(&mut reference, &case.expected(few), &case.seen, few, case.name);
    }
    let drawn = |name: &str| case(name).expected(case(name).poses(Kind::Processor)).components;
    let shown = drawn("silhouettes").iter().filter(|sums| sums.area_model > 0).count();
    assert!(shown > 10_000, "only {shown} images of silhouettes show anything");
    let standing = &drawn("large pictures")[..2];
    assert!(standing.iter().all(|sums| sums.area_model > 100_000), "{standing:?}");
}
