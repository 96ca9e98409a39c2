//! The compute backend on every subgroup size, within whatever limits a device has, and when the device is lost.

use std::process::Command;

use pantin::body::Body;
use pantin::evaluate::device::Compute;
use pantin::evaluate::{Components, Evaluator, Objective, Reference};
use pantin::gpu::{DeviceLost, DeviceSettings, Timing, ValidationLog, by_name};

use crate::backends::LOWERED;
use crate::cases::{Stage, USUAL, case, of_equal_depths};
use crate::device::{self, device};
use crate::found::{assert_fitness, found};
use crate::scene::{Random, cameras, evaluate, first_difference, ignoring, observations, poses};

fn assert_silent(log: &ValidationLog) {
    assert_eq!(log.messages(), Vec::<String>::new());
}

fn body() -> Body {
    Body::adult(1750.0).unwrap()
}

/// In a process whose driver has another subgroup size, started by [`every_subgroup_size_agrees`].
#[test]
#[ignore = "run by every_subgroup_size_agrees"]
fn four_hundred_poses_agree() {
    let Some((device, log)) = device("four_hundred_poses_agree", DeviceSettings::default()) else { return };
    println!("{}: subgroups of {}", device.facts().name, device.capabilities().subgroup_size);
    let Stage { body, cameras } = &*USUAL;
    let mut compute = Compute::on(&device, body, cameras).unwrap();
    let mut random = Random(12);
    let seen = observations(cameras, &mut random);
    let poses = poses(body, 400, &mut random);
    let few = &poses[..100 * body.dof_count()];
    let expected = crate::found::expected(body, cameras, &seen, &poses);
    assert_eq!(expected.difference(&found(&mut compute, &seen, &poses)), None);
    assert_fitness(&mut compute, &expected, &seen, &poses, "whole");
    let in_part = ignoring(&seen, &mut random);
    let expected = crate::found::expected(body, cameras, &in_part, few);
    assert_eq!(expected.difference(&found(&mut compute, &in_part, few)), None, "in part");
    drop((compute, device));
    assert_silent(&log);
}

/// lavapipe takes its vector width, so its subgroup size, from the environment of the process that loads it.
#[test]
fn every_subgroup_size_agrees() {
    let Some((device, _)) = device("every_subgroup_size_agrees", DeviceSettings::default()) else {
        return;
    };
    if !device.facts().name.contains("llvmpipe") {
        println!("SKIPPED every_subgroup_size_agrees: {} has one", device.facts().name);
        return;
    }
    for (bits, size) in [("128", 4), ("256", 8), ("512", 16)] {
        let run = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "compute::four_hundred_poses_agree", "--ignored", "--nocapture"])
            .env("LP_NATIVE_VECTOR_WIDTH", bits)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&run.stdout) + String::from_utf8_lossy(&run.stderr);
        assert!(run.status.success(), "{bits} bits: {text}");
        assert!(text.contains(&format!("subgroups of {size}")) && text.contains("1 passed"), "{bits} bits: {text}");
    }
}

#[test]
fn lowered_limits_split_the_work_and_passes_are_timed() {
    const NAME: &str = "lowered_limits_split_the_work_and_passes_are_timed";
    let case = case("silhouettes");
    let Stage { body, cameras } = case.stage;
    for (name, kind, lower) in LOWERED {
        let Some((device, log)) = device(NAME, DeviceSettings { lower: Some(lower), ..DeviceSettings::default() })
        else {
            return;
        };
        let poses = case.poses(kind);
        let expected = case.expected(poses).components;
        let is_counted = device.capabilities().timestamps;
        let mut compute = Compute::on(&device, body, cameras).unwrap();
        compute.time_stages(Timing::Stamps);
        assert_eq!(first_difference(4, &expected, &evaluate(&mut compute, &case.seen, poses)), None, "{name}");
        let stages = by_name(&compute.timings().unwrap());
        let batches = stages.iter().find(|(name, ..)| name == "raster").map_or(0, |(_, _, count)| *count);
        let is_whole = name == "no subgroups";
        assert!(!is_counted || (batches == 1) == is_whole, "{name}: {batches} batches");
        assert_eq!(compute.variant() == "shared", is_whole, "{name}: {}", compute.variant());
        drop((compute, device));
        assert_silent(&log);
    }
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
fn a_changed_vertex_is_caught() {
    let Some((device, log)) = device("a_changed_vertex_is_caught", DeviceSettings::default()) else { return };
    let (body, cameras) = (body(), cameras());
    let mut random = Random(8);
    let seen = observations(&cameras, &mut random);
    let poses = poses(&body, 40, &mut random);
    let expected = evaluate(&mut Reference::new(&body, &cameras), &seen, &poses);
    let mut compute = Compute::on(&device, &body, &cameras).unwrap();
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
    let (body, _) = of_equal_depths();
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
