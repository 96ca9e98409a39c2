//! The fast evaluator gives the reference's integers, on every instruction set and for any number of threads, on ordinary
//! and on wild poses; and the comparison that says so can fail.
#![allow(clippy::unwrap_used)]

use glam::{DAffine3, DMat3, DVec2, DVec3};
use pantin::body::Body;
use pantin::evaluate::cpu::{Cpu, InstructionSet};
use pantin::evaluate::{Components, Evaluator, Objective, ObjectiveKind, Reference};
use pantin::features::Observation;
use pantin::geometry::{BrownConrady, Camera, Lens, Tsai};

/// A small generator for test data.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as u32
    }

    fn uniform(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * (self.next() as f32 / (1_u32 << 31) as f32)
    }
}

fn camera(name: &str, size: [u32; 2], eye: DVec3, target: DVec3, lens: Lens) -> Camera {
    let forward = (target - eye).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let down = forward.cross(right);
    let rotation = DMat3::from_cols(right, down, forward).transpose();
    let camera_from_world = DAffine3::from_mat3_translation(rotation, -(rotation * eye));
    Camera { name: name.into(), size, camera_from_world, lens }
}

fn brown(focal: f64, size: [u32; 2], radial: [f64; 3], tangential: [f64; 2]) -> Lens {
    let centre = DVec2::new(f64::from(size[0]), f64::from(size[1])) / 2.0;
    Lens::BrownConrady(BrownConrady { focal: DVec2::splat(focal), centre, radial, tangential })
}

/// Four cameras of different sizes and lenses, one of them in the middle of the action.
fn cameras() -> Vec<Camera> {
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

fn observations(cameras: &[Camera], random: &mut Random) -> Vec<Observation> {
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

/// Poses from calm to wild: within the limits near the origin, anywhere within the limits, any angle anywhere (behind
/// cameras, inside them, off screen).
fn poses(body: &Body, count: usize, random: &mut Random) -> Vec<f32> {
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

/// The first candidate and view whose components differ.
fn first_difference(views: usize, expected: &[Components], found: &[Components]) -> Option<String> {
    assert_eq!(expected.len(), found.len());
    let index = expected.iter().zip(found).position(|(expected, found)| expected != found)?;
    let (pose, view) = (index / views, index % views);
    Some(format!("pose {pose}, view {view}: expected {:?}, found {:?}", expected[index], found[index]))
}

fn evaluate(evaluator: &mut dyn Evaluator, observations: &[Observation], poses: &[f32]) -> Vec<Components> {
    evaluator.observe(observations).unwrap();
    let count = poses.len() / evaluator.dof_count();
    let mut components = vec![Components::default(); count * evaluator.view_count()];
    evaluator.components(poses, &mut components).unwrap();
    components
}

fn reference_in_parallel(body: &Body, cameras: &[Camera], seen: &[Observation], poses: &[f32]) -> Vec<Components> {
    let half = poses.len() / body.dof_count() / 2 * body.dof_count();
    std::thread::scope(|scope| {
        let run = |poses| move || evaluate(&mut Reference::new(body, cameras), seen, poses);
        let first = scope.spawn(run(&poses[..half]));
        let second = run(&poses[half..])();
        [first.join().unwrap(), second].concat()
    })
}

#[test]
fn ten_thousand_poses_give_identical_integers() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mut random = Random(7);
    let seen = observations(&cameras, &mut random);
    let poses = poses(&body, 10_000, &mut random);
    let expected = reference_in_parallel(&body, &cameras, &seen, &poses);
    let drawn = expected.iter().filter(|sums| sums.area_model > 0).count();
    assert!(drawn > 10_000, "only {drawn} of {} images show anything", expected.len());
    for set in InstructionSet::ALL {
        if !set.is_available() {
            println!("SKIPPED {}: this processor does not have it", set.name());
            continue;
        }
        for workers in [1, 2, 3] {
            let mut cpu = Cpu::with(&body, &cameras, set, workers).unwrap();
            let found = evaluate(&mut cpu, &seen, &poses);
            let difference = first_difference(cameras.len(), &expected, &found);
            assert_eq!(difference, None, "{} with {workers} workers", set.name());
        }
    }
}

#[test]
fn a_changed_pixel_or_vertex_is_caught() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mut random = Random(8);
    let seen = observations(&cameras, &mut random);
    let poses = poses(&body, 40, &mut random);
    let expected = evaluate(&mut Reference::new(&body, &cameras), &seen, &poses);
    let mut cpu = Cpu::new(&body, &cameras).unwrap();
    assert_eq!(first_difference(4, &expected, &evaluate(&mut cpu, &seen, &poses)), None);

    // One observed pixel that some candidate covers.
    let mut sabotaged = seen.clone();
    let picture = Reference::new(&body, &cameras).draw(&poses[..body.dof_count()], 0);
    let covered = picture.bytes.iter().position(|&byte| byte != 0).unwrap();
    sabotaged[0].bytes[covered] ^= Observation::SILHOUETTE;
    assert!(
        first_difference(4, &expected, &evaluate(&mut cpu, &sabotaged, &poses)).is_some(),
        "a flipped pixel passed"
    );

    // One end of one part, moved by a few millimetres.
    let mut bent = body.clone();
    bent.parts[3].b.x += 15.0;
    let mut cpu = Cpu::new(&bent, &cameras).unwrap();
    assert!(first_difference(4, &expected, &evaluate(&mut cpu, &seen, &poses)).is_some(), "a moved vertex passed");
}

/// Pictures far larger than a cell, in which a limb is hundreds of pixels long: too long for single precision, and of more
/// rows than the first bits hold.
#[test]
fn large_pictures_agree() {
    let body = Body::adult(1750.0).unwrap();
    let (size, target) = ([2051, 1211], DVec3::new(0.0, 0.0, 900.0));
    let cameras = [(1400.0, 900.0), (5000.0, 2500.0)].map(|(distance, focal)| {
        let lens = brown(focal, size, [-0.05, 0.01, 0.0], [1e-4, -1e-4]);
        camera("large", size, DVec3::new(distance, 500.0, 1300.0), target, lens)
    });
    let mut random = Random(12);
    let seen = observations(&cameras, &mut random);
    let mut poses = poses(&body, 12, &mut random);
    poses.extend(body.standing_pose().iter().map(|value| *value as f32));
    let expected = evaluate(&mut Reference::new(&body, &cameras), &seen, &poses);
    let standing = &expected[expected.len() - 2..];
    assert!(standing.iter().all(|sums| sums.area_model > 100_000), "{standing:?}");
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        let found = evaluate(&mut Cpu::with(&body, &cameras, set, 2).unwrap(), &seen, &poses);
        assert_eq!(first_difference(2, &expected, &found), None, "{}", set.name());
    }
}

/// A limb straight along the optical axis, parts of equal depth, and a body of more parts than fit one register.
#[test]
fn degenerate_cones_equal_depths_and_many_parts_agree() {
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
    let mut random = Random(9);
    let poses = poses(&body, 300, &mut random);
    // Cameras that look along limbs: right above a hanging arm.
    let bones = body.world_from_bones(&vec![0.0; body.dof_count()]).unwrap();
    let elbow = bones[body.parts[arm].bone];
    let (a, b) = (elbow.transform_point3(body.parts[arm].a), elbow.transform_point3(body.parts[arm].b));
    let eye = a + (a - b).normalize() * 2000.0;
    let mut cameras = cameras();
    cameras.push(Camera {
        camera_from_world: {
            let rotation = DMat3::from_cols(DVec3::X, -DVec3::Y, -DVec3::Z).transpose();
            DAffine3::from_mat3_translation(rotation, -(rotation * eye))
        },
        ..cameras[1].clone()
    });
    let seen = observations(&cameras, &mut random);
    let mut rest = vec![0.0; body.dof_count()];
    rest.extend_from_slice(&poses);
    let expected = evaluate(&mut Reference::new(&body, &cameras), &seen, &rest);
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        let found = evaluate(&mut Cpu::with(&body, &cameras, set, 2).unwrap(), &seen, &rest);
        assert_eq!(first_difference(5, &expected, &found), None, "{}", set.name());
    }
}

#[test]
fn fitness_is_the_objective_of_the_components() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mut random = Random(10);
    let seen = observations(&cameras, &mut random);
    let poses = poses(&body, 37, &mut random);
    let components = evaluate(&mut Reference::new(&body, &cameras), &seen, &poses);
    let mut cpu = Cpu::new(&body, &cameras).unwrap();
    cpu.observe(&seen).unwrap();
    for kind in ObjectiveKind::ALL {
        let objective = Objective { kind, beta: 0.4, w1: 0.7, w2: 0.3 };
        let mut fitness = vec![-1.0; 37];
        cpu.fitness(&poses, &objective, &mut fitness).unwrap();
        for (value, row) in fitness.iter().zip(components.chunks_exact(4)) {
            assert_eq!(*value, objective.fitness(row), "{}", kind.name());
        }
    }
}

#[test]
fn poses_that_are_no_numbers_do_no_harm() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mut random = Random(11);
    let seen = observations(&cameras, &mut random);
    let mut poses = Vec::new();
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30, f32::MAX, f32::MIN_POSITIVE] {
        poses.extend(vec![value; body.dof_count()]);
    }
    let expected = evaluate(&mut Reference::new(&body, &cameras), &seen, &poses);
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        let found = evaluate(&mut Cpu::with(&body, &cameras, set, 1).unwrap(), &seen, &poses);
        assert_eq!(first_difference(4, &expected, &found), None, "{}", set.name());
    }
}

#[test]
fn misfits_are_named() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mut cpu = Cpu::new(&body, &cameras).unwrap();
    let error = cpu.observe(&[Observation::empty(131, 97)]).unwrap_err().to_string();
    assert!(error.contains("1 observations for 4 views"), "{error}");
    let mut wrong: Vec<_> = cameras.iter().map(|c| Observation::empty(c.size[0], c.size[1])).collect();
    wrong[2] = Observation::empty(10, 10);
    let error = cpu.observe(&wrong).unwrap_err().to_string();
    assert!(error.contains("view 2 is 10x10") && error.contains("141x105"), "{error}");
    let error = cpu.fitness(&[0.0; 30], &Objective::default(), &mut [0.0]).unwrap_err().to_string();
    assert!(error.contains("30 values") && error.contains("31"), "{error}");
}
