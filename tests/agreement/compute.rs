//! The compute backend gives the reference's integers and fitness: on ordinary and wild poses, on every subgroup size, within
//! whatever limits a device has; and when the device is lost, an error says so.
//!
//! Runs on whatever Vulkan device there is, under the validation layer, which must stay silent.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

mod device;
mod scene;

use std::process::Command;

use device::device;
use pantin::body::Body;
use pantin::evaluate::device::Compute;
use pantin::evaluate::{Components, Evaluator, Objective, Reference};
use pantin::gpu::{Capabilities, DeviceLost, DeviceSettings, Timing, ValidationLog, by_name};
use scene::{Random, cameras, evaluate, first_difference, ignoring, observations, poses, reference_in_parallel};

fn assert_silent(log: &ValidationLog) {
    assert_eq!(log.messages(), Vec::<String>::new());
}

fn body() -> Body {
    Body::adult(1750.0).unwrap()
}

/// Holds the backend on a device with these settings to the reference, on `count` poses. Gives the backend's variant and how many
/// batches it took.
fn check(name: &str, settings: DeviceSettings, count: usize) -> Option<(&'static str, usize)> {
    let (device, log) = device(name, settings)?;
    let (body, cameras) = (body(), cameras());
    let mut random = Random(12);
    let seen = observations(&cameras, &mut random);
    let poses = poses(&body, count, &mut random);
    let expected = reference_in_parallel(&body, &cameras, &seen, &poses);
    let mut compute = Compute::on(&device, &body, &cameras).unwrap();
    let in_part = ignoring(&seen, &mut random);
    let few = &poses[..poses.len().min(100 * body.dof_count())];
    let expected_in_part = evaluate(&mut Reference::new(&body, &cameras), &in_part, few);
    let found_in_part = evaluate(&mut compute, &in_part, few);
    assert_eq!(first_difference(cameras.len(), &expected_in_part, &found_in_part), None, "in part");
    assert!(expected_in_part != expected[..expected_in_part.len()]);
    println!("{}: subgroups of {}", device.facts().name, device.capabilities().subgroup_size);
    let found = evaluate(&mut compute, &seen, &poses);
    assert_eq!(first_difference(cameras.len(), &expected, &found), None);
    for kind in scene::of_silhouettes() {
        for objective in [Objective { kind, beta: 0.4, w1: 0.7, w2: 0.3 }, Objective { kind, ..Objective::default() }] {
            // Again and again: what was recorded first gives the same the second time.
            for _ in 0..2 {
                let mut fitness = vec![-1.0; count];
                compute.fitness(&poses, &objective, &mut fitness).unwrap();
                for (value, row) in fitness.iter().zip(expected.chunks_exact(cameras.len())) {
                    let expected = objective.fitness(row);
                    assert!((value - expected).abs() < 1e-5, "{}: {value} against {expected}", kind.name());
                }
            }
        }
    }
    compute.time_stages(Timing::Stamps);
    assert_eq!(first_difference(cameras.len(), &expected, &evaluate(&mut compute, &seen, &poses)), None);
    let stages = by_name(&compute.timings().unwrap());
    let batches = stages.iter().find(|(name, ..)| name == "raster").map_or(0, |(_, _, count)| *count);
    let variant = compute.variant();
    drop((compute, device));
    assert_silent(&log);
    Some((variant, batches))
}

#[test]
fn two_thousand_poses_give_identical_integers() {
    check("two_thousand_poses_give_identical_integers", DeviceSettings::default(), 2000);
}

#[test]
fn four_hundred_poses_give_identical_integers() {
    check("four_hundred_poses_give_identical_integers", DeviceSettings::default(), 400);
}

/// lavapipe takes its vector width, so its subgroup size, from the environment of the process that loads it.
#[test]
fn every_subgroup_size_gives_identical_integers() {
    let Some((device, _)) = device("every_subgroup_size_gives_identical_integers", DeviceSettings::default()) else {
        return;
    };
    if !device.facts().name.contains("llvmpipe") {
        println!("SKIPPED every_subgroup_size_gives_identical_integers: {} has one", device.facts().name);
        return;
    }
    for (bits, size) in [("128", 4), ("256", 8), ("512", 16)] {
        let run = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "four_hundred_poses_give_identical_integers", "--nocapture"])
            .env("LP_NATIVE_VECTOR_WIDTH", bits)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&run.stdout) + String::from_utf8_lossy(&run.stderr);
        assert!(run.status.success(), "{bits} bits: {text}");
        assert!(text.contains(&format!("subgroups of {size}")) && text.contains("1 passed"), "{bits} bits: {text}");
    }
}

#[test]
fn lowered_limits_split_the_work_and_change_nothing() {
    let name = "lowered_limits_split_the_work_and_change_nothing";
    let settings = |lower| DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
    let Some((device, _)) = device(name, DeviceSettings::default()) else { return };
    let is_counted = device.capabilities().timestamps;
    let split: [fn(&mut Capabilities); 3] =
        [|c| c.max_storage = 200_000, |c| c.max_groups = 64, |c| c.memory = 900_000];
    for lower in split {
        let (_, batches) = check(name, settings(lower), 150).unwrap();
        assert!(batches > 1 || !is_counted, "{batches} batches");
    }
    let (variant, batches) =
        check(name, settings(|c| (c.subgroup_arithmetic, c.subgroup_shuffle) = (false, false)), 150).unwrap();
    assert!(variant == "shared" && (batches == 1 || !is_counted), "{variant}, {batches} batches");
}

#[test]
fn limits_too_low_for_one_candidate_are_a_sentence() {
    let name = "limits_too_low_for_one_candidate_are_a_sentence";
    let settings = |lower| DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
    let Some((device, _)) = device(name, settings(|c| c.max_groups = 3)) else { return };
    let error = Compute::on(&device, &body(), &cameras()).unwrap_err().to_string();
    assert!(error.contains("not even one candidate"), "{error}");
    let Some((device, _)) = device::device(name, settings(|c| c.memory = 20_000)) else { return };
    let error = Compute::on(&device, &body(), &cameras()).unwrap_err().to_string();
    assert!(error.contains("of device memory"), "{error}");
}

#[test]
fn a_changed_pixel_or_vertex_is_caught() {
    let Some((device, log)) = device("a_changed_pixel_or_vertex_is_caught", DeviceSettings::default()) else { return };
    let (body, cameras) = (body(), cameras());
    let mut random = Random(8);
    let seen = observations(&cameras, &mut random);
    let poses = poses(&body, 40, &mut random);
    let expected = evaluate(&mut Reference::new(&body, &cameras), &seen, &poses);
    let mut compute = Compute::on(&device, &body, &cameras).unwrap();
    assert_eq!(first_difference(4, &expected, &evaluate(&mut compute, &seen, &poses)), None);

    // One observed pixel that some candidate covers.
    let mut sabotaged = seen.clone();
    let picture = Reference::new(&body, &cameras).draw(&poses[..body.dof_count()], 0);
    let covered = picture.bytes.iter().position(|&byte| byte != 0).unwrap();
    sabotaged[0].bytes[covered] ^= pantin::features::Observation::SILHOUETTE;
    let found = evaluate(&mut compute, &sabotaged, &poses);
    assert!(first_difference(4, &expected, &found).is_some(), "a flipped pixel passed");

    // One end of one part, moved by a few millimetres; and back.
    let mut bent = body.clone();
    bent.parts[3].b.x += 15.0;
    compute.set_body(&bent).unwrap();
    let found = evaluate(&mut compute, &seen, &poses);
    assert!(first_difference(4, &expected, &found).is_some(), "a moved vertex passed");
    let expected_bent = evaluate(&mut Reference::new(&bent, &cameras), &seen, &poses);
    assert_eq!(first_difference(4, &expected_bent, &found), None);
    compute.set_body(&body).unwrap();
    assert_eq!(first_difference(4, &expected, &evaluate(&mut compute, &seen, &poses)), None);
    drop((compute, device));
    assert_silent(&log);
}

#[test]
fn equal_depths_and_many_parts_agree() {
    let Some((device, log)) = device("equal_depths_and_many_parts_agree", DeviceSettings::default()) else { return };
    let mut body = body();
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
    let (cameras, mut random) = (cameras(), Random(9));
    let (seen, poses) = (observations(&cameras, &mut random), poses(&body, 200, &mut random));
    let expected = evaluate(&mut Reference::new(&body, &cameras), &seen, &poses);
    let mut compute = Compute::on(&device, &body, &cameras).unwrap();
    assert_eq!(first_difference(4, &expected, &evaluate(&mut compute, &seen, &poses)), None);
    drop((compute, device));
    assert_silent(&log);
}

#[test]
fn poses_that_are_no_numbers_do_no_harm() {
    let Some((device, log)) = device("poses_that_are_no_numbers_do_no_harm", DeviceSettings::default()) else { return };
    let (body, cameras) = (body(), cameras());
    let seen = observations(&cameras, &mut Random(11));
    let mut poses = vec![0.0; body.dof_count()];
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30, f32::MAX] {
        poses.extend(vec![value; body.dof_count()]);
    }
    let mut compute = Compute::on(&device, &body, &cameras).unwrap();
    let found = evaluate(&mut compute, &seen, &poses);
    let expected = evaluate(&mut Reference::new(&body, &cameras), &seen, &poses[..body.dof_count()]);
    assert_eq!(first_difference(4, &expected, &found[..4]), None, "the pose beside them");
    let mut fitness = vec![f32::NAN; 7];
    compute.fitness(&poses, &Objective::default(), &mut fitness).unwrap();
    assert!(fitness.iter().all(|value| (0.0..=1.0).contains(value)), "{fitness:?}");
    drop((compute, device));
    assert_silent(&log);
}

#[test]
fn a_lost_device_is_an_error_at_every_pass_and_ever_after() {
    let (body, cameras) = (body(), cameras());
    let seen = observations(&cameras, &mut Random(3));
    let poses = poses(&body, 5, &mut Random(4));
    // Five copies of the upload, then pose upload, pose, project, raster, objective, readback.
    for passes in [0, 3, 5, 6, 8, 10, 11, 15] {
        let settings = DeviceSettings { lose_after_passes: Some(passes), ..DeviceSettings::default() };
        let Some((device, log)) = device("a_lost_device_is_an_error", settings) else { return };
        let mut compute = Compute::on(&device, &body, &cameras).unwrap();
        compute.observe(&seen).unwrap();
        let mut fitness = [0.0; 5];
        let mut results = (0..3).map(|_| compute.fitness(&poses, &Objective::default(), &mut fitness));
        let error = results.find_map(Result::err).unwrap();
        assert!(error.is::<DeviceLost>(), "after {passes} passes: {error:#}");
        assert!(error.to_string().contains("was lost"), "{error}");
        let error = compute.components(&poses, &mut [Components::default(); 20]).unwrap_err();
        assert!(error.is::<DeviceLost>(), "{error:#}");
        drop((compute, device));
        assert_silent(&log);
    }
}

#[test]
fn misfits_are_named() {
    let Some((device, _)) = device("misfits_are_named", DeviceSettings::default()) else { return };
    let (body, cameras) = (body(), cameras());
    let mut compute = Compute::on(&device, &body, &cameras).unwrap();
    let error = compute.observe(&observations(&cameras[..1], &mut Random(1))).unwrap_err().to_string();
    assert!(error.contains("1 observations for 4 views"), "{error}");
    let error = compute.fitness(&[0.0; 30], &Objective::default(), &mut [0.0]).unwrap_err().to_string();
    assert!(error.contains("30 values") && error.contains("31"), "{error}");
    compute.fitness(&[], &Objective::default(), &mut []).unwrap();
    compute.components(&[], &mut []).unwrap();
    let mut other = body.clone();
    other.parts.pop();
    let error = compute.set_body(&other).unwrap_err().to_string();
    assert!(error.contains("cannot take the place"), "{error}");
    let error = Compute::on(&device, &body, &[]).unwrap_err().to_string();
    assert!(error.contains("no cameras"), "{error}");
    let mut huge = cameras;
    huge[1].size = [20_000, 10];
    let error = Compute::on(&device, &body, &huge).unwrap_err().to_string();
    assert!(error.contains("camera b has pictures of 20000x10"), "{error}");
}
