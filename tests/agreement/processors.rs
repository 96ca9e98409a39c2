//! The fast evaluator gives the reference's integers, on every instruction set and for any number of threads, on ordinary
//! and on wild poses; and the comparison that says so can fail.
#![allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]

mod scene;

use glam::{DAffine3, DMat3, DVec3};
use pantin::body::Body;
use pantin::evaluate::cpu::{Cpu, InstructionSet};
use pantin::evaluate::{Components, Evaluator as _, Objective, Reference};
use pantin::features::Observation;
use pantin::geometry::Camera;
use scene::{
    Random, brown, camera, cameras, evaluate, first_difference, ignoring, observations, poses, reference_in_parallel,
};

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

/// By the definition, on every instruction set, and back to pictures that count everywhere; one pixel more that counts shows.
#[test]
fn what_is_ignored_counts_neither_for_nor_against() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mut random = Random(13);
    let all = observations(&cameras, &mut random);
    let mut seen = ignoring(&all, &mut random);
    let poses = poses(&body, 300, &mut random);
    let mut reference = Reference::new(&body, &cameras);
    let expected = evaluate(&mut reference, &seen, &poses);
    let everywhere = evaluate(&mut reference, &all, &poses);
    let mut fewer = 0;
    for (image, sums) in expected.iter().enumerate() {
        let (pose, view) = (&poses[image / 4 * body.dof_count()..][..body.dof_count()], image % 4);
        let width = cameras[view].size[0];
        let counts = |at: usize| {
            let (x, y) = (at as u32 % width, at as u32 / width);
            seen[view].ignored.as_ref().is_none_or(|ignored| !ignored.get(x, y))
        };
        let mut defined = Components::default();
        let drawn = reference.draw(pose, view);
        for at in (0..drawn.bytes.len()).filter(|&at| counts(at)) {
            let (drawn, seen) = (drawn.bytes[at], all[view].bytes[at]);
            defined.area_obs += u32::from(seen >> 7);
            defined.area_model += u32::from(drawn != 0);
            defined.overlap += u32::from(seen >> 7) * u32::from(drawn != 0);
            defined.edges += u32::from(drawn >> 7);
            defined.proximity += u32::from(drawn >> 7) * u32::from(seen & 0x7f);
        }
        assert_eq!(*sums, defined, "image {image}");
        fewer += usize::from(sums.area_model < everywhere[image].area_model);
    }
    assert!(fewer > 100, "only {fewer} images reach what is ignored");
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        let mut cpu = Cpu::with(&body, &cameras, set, 2).unwrap();
        for _ in 0..2 {
            let difference = first_difference(4, &expected, &evaluate(&mut cpu, &seen, &poses));
            assert_eq!(difference, None, "{}", set.name());
            assert_eq!(first_difference(4, &everywhere, &evaluate(&mut cpu, &all, &poses)), None, "{}", set.name());
        }
    }
    let drawn = (0..300).map(|pose| reference.draw(&poses[pose * body.dof_count()..][..body.dof_count()], 0));
    let mut ignored = seen[0].ignored.take().unwrap();
    let at = drawn
        .flat_map(|image| image.bytes.into_iter().enumerate().collect::<Vec<_>>())
        .filter(|(_, byte)| *byte != 0)
        .map(|(at, _)| [at as u32 % cameras[0].size[0], at as u32 / cameras[0].size[0]])
        .find(|&[x, y]| ignored.get(x, y));
    let [x, y] = at.unwrap();
    std::sync::Arc::make_mut(&mut ignored).set(x, y, false);
    seen[0].ignored = Some(ignored);
    let found = evaluate(&mut Cpu::new(&body, &cameras).unwrap(), &seen, &poses);
    assert!(first_difference(4, &expected, &found).is_some(), "a pixel that counts again passed");
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
    for kind in scene::of_silhouettes() {
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
    wrong[1].ignored = Some(std::sync::Arc::new(pantin::features::BitImage::new(48, 64)));
    let error = cpu.observe(&wrong).unwrap_err().to_string();
    assert_eq!(error, "the ignored pixels of view 1 are 48x64, its observation is 64x48");
    wrong[1].ignored = None;
    wrong[2] = Observation::empty(10, 10);
    let error = cpu.observe(&wrong).unwrap_err().to_string();
    assert!(error.contains("view 2 is 10x10") && error.contains("141x105"), "{error}");
    let error = cpu.fitness(&[0.0; 30], &Objective::default(), &mut [0.0]).unwrap_err().to_string();
    assert!(error.contains("30 values") && error.contains("31"), "{error}");
}
