//! Recordings that go into a device by two ways.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use std::sync::atomic::Ordering;

use super::generated::{double_comp, layout};
use super::lanes::{BESIDE, MAIN};
use super::test_device::device;
use super::*;

const COUNT: usize = 4096;

/// A recording for `device` that doubles `source` into `target`.
fn doubling(device: &Device, source: &Buffer, target: &Buffer) -> Recording {
    let mut recorder = device.recorder(Timing::Off).unwrap();
    let push = layout::DoublePush { count: COUNT as u32, factor: 2.0 };
    let bindings = double_comp::Bindings { source, target };
    recorder.compute("double", &[bindings.dispatch(push, Groups::Over([COUNT as u32, 1, 1]))]).unwrap();
    recorder.finish().unwrap()
}

fn values(device: &Device, name: &str, memory: Memory) -> Buffer {
    device.buffer::<f32>(name, COUNT, memory).unwrap()
}

fn submissions(device: &Device) -> [u64; 2] {
    [MAIN, BESIDE].map(|lane| device.shared.lanes.of(lane).submitted.load(Ordering::Relaxed))
}

/// What one way in makes the other takes, and gives back to be written over, with no wait of the host between: on whatever queues there
/// are, and on a single one.
#[test]
fn two_ways_in_wait_for_each_other_on_the_device() {
    let one: fn(&mut Capabilities) = |capabilities| capabilities.second_queue = false;
    for lower in [None, Some(one)] {
        let name = "two_ways_in_wait_for_each_other_on_the_device";
        let Some((device, log)) = device(name, DeviceSettings { lower, ..DeviceSettings::default() }) else { return };
        let beside = device.beside();
        let input = values(&device, "input", Memory::Upload);
        let made = values(&device, "made", Memory::Device);
        let taken = [0, 1].map(|_| values(&device, "taken", Memory::Readback));
        let mut makes = doubling(&beside, &input, &made);
        let mut takes = taken.each_ref().map(|taken| doubling(&device, &made, taken));
        for round in 0..20 {
            let first = round as f32;
            input.write(0, &(0..COUNT).map(|at| first + at as f32).collect::<Vec<_>>()).unwrap();
            makes.submit().unwrap();
            takes[round % 2].submit().unwrap();
            makes.wait().unwrap();
            // Written over only when it was taken.
            input.write(0, &vec![first; COUNT]).unwrap();
            makes.submit().unwrap();
            takes[round % 2].wait().unwrap();
            let mut found = vec![0.0_f32; COUNT];
            taken[round % 2].read(0, &mut found).unwrap();
            let is_right = found.iter().enumerate().all(|(at, value)| *value == 4.0 * (first + at as f32));
            assert!(is_right, "round {round}: {:?}", &found[..4]);
            makes.wait().unwrap();
        }
        assert_eq!(submissions(&device), [20, 40]);
        // Waited for by the value that its last use has on the other way in.
        assert_eq!([MAIN, BESIDE].map(|lane| made.shared.last_use[lane].load(Ordering::Relaxed)), [20, 40]);
        drop((makes, takes, input, made, taken, beside, device));
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

#[test]
fn what_goes_ahead_is_one_submission_with_what_follows() {
    let Some((device, log)) = device("what_goes_ahead_is_one_submission", DeviceSettings::default()) else { return };
    let input = values(&device, "input", Memory::Upload);
    let between = values(&device, "between", Memory::Device);
    let output = values(&device, "output", Memory::Readback);
    input.write(0, &[1.5_f32; COUNT]).unwrap();
    let mut ahead = doubling(&device, &input, &between);
    let mut last = doubling(&device, &between, &output);
    let [before, _] = submissions(&device);
    last.run_behind(Some(&mut ahead)).unwrap();
    assert_eq!(submissions(&device)[MAIN], before + 1);
    let mut found = vec![0.0_f32; COUNT];
    output.read(0, &mut found).unwrap();
    assert!(found.iter().all(|value| *value == 6.0));
    // By itself it takes what is there.
    input.write(0, &[7.0_f32; COUNT]).unwrap();
    last.run().unwrap();
    output.read(0, &mut found).unwrap();
    assert!(found.iter().all(|value| *value == 6.0));
    let mut elsewhere = doubling(&device.beside(), &input, &between);
    let error = last.run_behind(Some(&mut elsewhere)).unwrap_err().to_string();
    assert_eq!(error, "recordings for different queues cannot be one submission");
    drop((ahead, last, elsewhere, input, between, output, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn images_stay_with_the_first_queue() {
    let Some((device, log)) = device("images_stay_with_the_first_queue", DeviceSettings::default()) else { return };
    let image = device.image("target", Format::Rgba8, [16, 8], ImageUse::Target).unwrap();
    let pixels = device.buffer::<u32>("pixels", 16 * 8, Memory::Readback).unwrap();
    let mut recorder = device.beside().recorder(Timing::Off).unwrap();
    recorder.read_image("read", &image, [0, 0, 16, 8], (&pixels, 0)).unwrap();
    let error = recorder.finish().unwrap_err().to_string();
    assert_eq!(error, "the image target stays with the device's first queue, and a pass is recorded for the second");
    drop((image, pixels, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn whole_buffers_are_gathered_side_by_side() {
    let Some((device, log)) = device("whole_buffers_are_gathered_side_by_side", DeviceSettings::default()) else {
        return;
    };
    let parts = [3_usize, 5].map(|len| device.buffer::<u32>("part", len, Memory::Upload).unwrap());
    parts[0].write(0, &[1_u32, 2, 3]).unwrap();
    parts[1].write(0, &[4_u32, 5, 6, 7, 8]).unwrap();
    let all = device.buffer::<u32>("all", 9, Memory::Readback).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    recorder.fill("clear", &all, 9).unwrap();
    recorder.gather("gather", &[(&parts[0], 0), (&parts[1], 16)], &all).unwrap();
    let error = recorder.gather("gather", &[(&parts[0], 0), (&parts[1], 8)], &all).unwrap_err().to_string();
    assert!(error.contains("copies part of 20 bytes to byte 8 of all, which has 36 and is filled up to 12"), "{error}");
    recorder.finish().unwrap().run().unwrap();
    let mut found = [0_u32; 9];
    all.read(0, &mut found).unwrap();
    assert_eq!(found, [1, 2, 3, 9, 4, 5, 6, 7, 8]);
    drop((parts, all, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}
