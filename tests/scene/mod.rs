//! Cameras, observations and poses that evaluators are compared on.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use pantin::body::Body;
use pantin::evaluate::device::{Comparison, GraphicsSettings, HostComparison, Packing, Primitives, Projection, Tiling};
use pantin::evaluate::{Components, Evaluator, Objective, ObjectiveKind};
use pantin::features::{BitImage, Observation};
use pantin::geometry::{BrownConrady, Camera, Lens, Tsai};

/// A small generator for test data.
pub(crate) struct Random(pub u64);

impl Random {
    pub(crate) fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as u32
    }

    pub(crate) fn uniform(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * (self.next() as f32 / (1_u32 << 31) as f32)
    }
}

pub(crate) fn camera(name: &str, size: [u32; 2], eye: DVec3, target: DVec3, lens: Lens) -> Camera {
    let forward = (target - eye).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let down = forward.cross(right);
    let rotation = DMat3::from_cols(right, down, forward).transpose();
    let camera_from_world = DAffine3::from_mat3_translation(rotation, -(rotation * eye));
    Camera { name: name.into(), size, camera_from_world, lens }
}

pub(crate) fn brown(focal: f64, size: [u32; 2], radial: [f64; 3], tangential: [f64; 2]) -> Lens {
    let centre = DVec2::new(f64::from(size[0]), f64::from(size[1])) / 2.0;
    Lens::BrownConrady(BrownConrady { focal: DVec2::splat(focal), centre, radial, tangential })
}

/// Four cameras of different sizes and lenses, one of them in the middle of the action.
pub(crate) fn cameras() -> Vec<Camera> {
    let target = DVec3::new(0.0, 0.0, 900.0);
    let tsai = Tsai { f: 8.0, kappa: -4e-4, centre: DVec2::new(70.0, 52.0), sx: 1.01, pitch: DVec2::new(0.05, 0.05) };
    vec![
        camera(
            "a",
            [131, 97],
            DVec3::new(4000.0, 0.0, 1500.0),
            target,
            brown(150.0, [131, 97], [-0.1, 0.05, 0.0], [1e-3, -5e-4]),
        ),
        camera("b", [64, 48], DVec3::new(0.0, 3500.0, 1000.0), target, brown(60.0, [64, 48], [0.0; 3], [0.0; 2])),
        camera("c", [141, 105], DVec3::new(-3000.0, -2500.0, 2000.0), target, Lens::Tsai(tsai)),
        camera(
            "d",
            [97, 130],
            DVec3::new(300.0, -200.0, 1000.0),
            target,
            brown(80.0, [97, 130], [-0.3, 0.02, 0.0], [0.0; 2]),
        ),
    ]
}

pub(crate) fn observations(cameras: &[Camera], random: &mut Random) -> Vec<Observation> {
    cameras
        .iter()
        .map(|camera| {
            let mut observation = Observation::empty(camera.size[0], camera.size[1]);
            for byte in &mut observation.bytes {
                *byte = random.next() as u8;
            }
            observation
        })
        .collect()
}

/// The same with pixels that do not count in the first and third view: a block over its lower left half, and specks all over it.
pub(crate) fn ignoring(seen: &[Observation], random: &mut Random) -> Vec<Observation> {
    let mut seen = seen.to_vec();
    for view in [0, 2] {
        let (width, height) = (seen[view].width, seen[view].height);
        let ignored = BitImage::from_fn(width, height, |x, y| {
            (x < width / 2 + 3 && y > height / 2) || random.next().is_multiple_of(13)
        });
        seen[view].ignore(&Arc::new(ignored)).unwrap();
    }
    seen
}

/// Poses from calm to wild: within the limits near the origin, anywhere within the limits, any angle anywhere (behind
/// cameras, inside them, off screen).
pub(crate) fn poses(body: &Body, count: usize, random: &mut Random) -> Vec<f32> {
    let mut poses = Vec::new();
    for index in 0..count {
        for (_, dof) in body.dofs() {
            let [low, high] = dof.limits.map(|limit| limit as f32);
            let rotation = dof.axis.is_rotation();
            poses.push(match (index % 4, rotation) {
                (0 | 1, true) => random.uniform(low, high),
                (0, false) => random.uniform(-300.0, 300.0),
                (1 | 2, false) => random.uniform(-3000.0, 3000.0),
                (_, true) => random.uniform(-7.0, 7.0),
                (_, false) => random.uniform(-9000.0, 9000.0),
            });
        }
    }
    poses
}

/// The objectives that need no evidence.
pub(crate) fn of_silhouettes() -> impl Iterator<Item = ObjectiveKind> {
    ObjectiveKind::ALL.into_iter().filter(|kind| !Objective::of(*kind).weighs_evidence())
}

/// The first candidate and view whose components differ.
pub(crate) fn first_difference(views: usize, expected: &[Components], found: &[Components]) -> Option<String> {
    assert_eq!(expected.len(), found.len());
    let index = expected.iter().zip(found).position(|(expected, found)| expected != found)?;
    let (pose, view) = (index / views, index % views);
    Some(format!("pose {pose}, view {view}: expected {:?}, found {:?}", expected[index], found[index]))
}

pub(crate) fn evaluate(evaluator: &mut dyn Evaluator, observations: &[Observation], poses: &[f32]) -> Vec<Components> {
    evaluator.observe(observations).unwrap();
    let count = poses.len() / evaluator.dof_count();
    let mut components = vec![Components::default(); count * evaluator.view_count()];
    evaluator.components(poses, &mut components).unwrap();
    components
}

/// The graphics backend with every packing, projection and tiling, and every way to compare, on the device and on the host.
pub(crate) fn graphics_settings() -> impl Iterator<Item = GraphicsSettings> {
    let usual = GraphicsSettings::default();
    let scalar = Comparison::Host(HostComparison::Scalar);
    let comparisons = Comparison::all().map(move |comparison| {
        let packing = if comparison == scalar { Packing::Depth } else { usual.packing };
        GraphicsSettings { comparison, packing, ..usual }
    });
    comparisons.chain([
        GraphicsSettings { packing: Packing::Depth, projection: Projection::Feedback, ..usual },
        GraphicsSettings { tiling: Tiling::Pictures, ..usual },
        GraphicsSettings { primitives: Primitives::Geometry, ..usual },
        GraphicsSettings { packing: Packing::Depth, primitives: Primitives::Geometry, ..usual },
    ])
}
