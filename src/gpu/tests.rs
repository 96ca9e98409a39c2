//! The room by itself, on whatever device this machine has, under the validation layer. Without Vulkan these tests say so and
//! pass, unless PANTIN_NEEDS_VULKAN is set, as it is in CI.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use super::generated::{double_comp, double_in_place_comp, fill_frag, fill_vert, layout, recolour_frag};
use super::hazards::{Hazards, Stages, Use};
use super::pipeline::uses;
use super::recorder::MOST_PASSES;
use super::test_device::{device, device_under};
use super::*;

fn assert_silent(log: &ValidationLog) {
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// Doubles 0..count twice over, through a buffer between: 4 x.
fn quadruple(device: &Device, count: u32, timing: Timing) -> anyhow::Result<(Vec<f32>, Recording)> {
    let input = device.buffer::<f32>("input", count as usize, Memory::Upload)?;
    let middle = device.buffer::<f32>("middle", count as usize, Memory::Device)?;
    let output = device.buffer::<f32>("output", count as usize, Memory::Readback)?;
    input.write(0, &(0..count).map(|i| i as f32).collect::<Vec<_>>())?;
    let push = layout::DoublePush { count, factor: 2.0 };
    let mut recorder = device.recorder(timing)?;
    for (name, source, target) in [("first", &input, &middle), ("second", &middle, &output)] {
        let bindings = double_comp::Bindings { source, target };
        recorder.compute(name, &[bindings.dispatch(push, Groups::Over([count, 1, 1]))])?;
    }
    let mut recording = recorder.finish()?;
    recording.run()?;
    let mut result = vec![0.0; count as usize];
    output.read(0, &mut result)?;
    Ok((result, recording))
}

#[test]
fn dependent_passes_run_in_order_and_again() {
    let Some((device, log)) = device("dependent_passes_run_in_order_and_again", DeviceSettings::default()) else {
        return;
    };
    let (result, mut recording) = quadruple(&device, 1000, Timing::Statistics).unwrap();
    assert!(result.iter().enumerate().all(|(i, &value)| value == 4.0 * i as f32));
    recording.run().unwrap();
    recording.run().unwrap();
    assert_eq!(recording.passes(), ["first", "second"]);
    let timings = recording.timings().unwrap();
    if device.capabilities().timestamps {
        assert_eq!(timings.len(), 2);
        assert!(timings.iter().all(|timing| timing.end_ns >= timing.start_ns));
        assert_eq!(by_name(&timings).len(), 2);
    }
    if device.capabilities().pipeline_statistics {
        assert!(timings[0].statistics.unwrap().compute >= 1000);
    }
    drop(recording);
    drop(device);
    assert_silent(&log);
}

#[test]
fn a_triangle_is_drawn_and_read_back() {
    let Some((device, log)) = device("a_triangle_is_drawn_and_read_back", DeviceSettings::default()) else { return };
    let drawing = Drawing { colour: Some(Format::Rgba8), blend: Blend::Max, channels: 0b0110, ..Drawing::default() };
    let stages = [fill_vert::stage(), fill_frag::stage()];
    let pipeline = device.graphics_pipeline("fill", &stages, &drawing).unwrap();
    let corners = device.buffer::<layout::Corner>("corners", 3, Memory::Upload).unwrap();
    let at = |x: f32, y: f32| layout::Corner { position: [x, y], colour: 0xffff_ffff, _pad0: [0] };
    corners.write(0, &[at(-1.0, -1.0), at(3.0, -1.0), at(-1.0, 3.0)]).unwrap();
    let image = device.image("target", Format::Rgba8, [16, 8], ImageUse::Target).unwrap();
    let pixels = device.buffer::<u32>("pixels", 16 * 8, Memory::Readback).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    let target = Target { colour: (&image, Clear::Value([0.0; 4])), depth: None, area: [0, 0, 16, 8] };
    recorder
        .draw(
            "draw",
            &target,
            &[Draw {
                pipeline: &pipeline,
                bindings: &fill_vert::Bindings { corners: &corners }.bound(),
                push: &[],
                viewport: Viewport { area: [0.0, 0.0, 16.0, 8.0], depth: [0.0, 1.0] },
                scissor: [4, 2, 8, 4],
                vertices: 0..3,
                instances: 0..1,
                indices: None,
                indirect: None,
            }],
        )
        .unwrap();
    recorder.read_image("read", &image, [0, 0, 16, 8], (&pixels, 0)).unwrap();
    let mut recording = recorder.finish().unwrap();
    for _ in 0..2 {
        recording.run().unwrap();
        let mut found = vec![0_u32; 16 * 8];
        pixels.read(0, &mut found).unwrap();
        for (place, pixel) in found.into_iter().enumerate() {
            let (x, y) = (place % 16, place / 16);
            let inside = (4..12).contains(&x) && (2..6).contains(&y);
            assert_eq!(pixel, if inside { 0x00ff_ff00 } else { 0 }, "pixel {x}, {y}");
        }
    }
    drop((recording, image, pixels, corners, pipeline, device));
    assert_silent(&log);
}

#[test]
fn clockwise_triangles_are_left_out_and_counts_can_come_from_a_buffer() {
    let name = "clockwise_triangles_are_left_out_and_counts_can_come_from_a_buffer";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let drawing = Drawing { colour: Some(Format::Rgba8), cull_clockwise: true, ..Drawing::default() };
    let stages = [fill_vert::stage(), fill_frag::stage()];
    let pipeline = device.graphics_pipeline("fill", &stages, &drawing).unwrap();
    let corners = device.buffer::<layout::Corner>("corners", 6, Memory::Upload).unwrap();
    let at = |x: f32, y: f32, colour| layout::Corner { position: [x, y], colour, _pad0: [0] };
    // y points down: over the left half counter-clockwise to the eye, over the right half clockwise.
    let left = [at(-1.0, -1.0, 1), at(-1.0, 1.0, 1), at(0.0, 0.0, 1)];
    let right = [at(1.0, -1.0, 2), at(1.0, 1.0, 2), at(0.0, 0.0, 2)];
    corners.write(0, &[left, right].concat()).unwrap();
    let counts = device.buffer::<u32>("counts", 5, Memory::Upload).unwrap();
    let image = device.image("target", Format::Rgba8, [16, 8], ImageUse::Target).unwrap();
    let pixels = device.buffer::<u32>("pixels", 16 * 8, Memory::Readback).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    let target = Target { colour: (&image, Clear::Value([0.0; 4])), depth: None, area: [0, 0, 16, 8] };
    let bindings = fill_vert::Bindings { corners: &corners }.bound();
    let draw = |indirect| Draw {
        pipeline: &pipeline,
        bindings: &bindings,
        push: &[],
        viewport: Viewport { area: [0.0, 0.0, 16.0, 8.0], depth: [0.0, 1.0] },
        scissor: [0, 0, 16, 8],
        vertices: 0..0,
        instances: 0..0,
        indices: None,
        indirect,
    };
    recorder.draw("draw", &target, &[draw(Some((&counts, 4)))]).unwrap();
    recorder.read_image("read", &image, [0, 0, 16, 8], (&pixels, 0)).unwrap();
    let mut recording = recorder.finish().unwrap();
    for (words, expected) in [([9_u32, 6, 1, 0, 0], [1, 0]), ([9, 3, 1, 3, 0], [0, 0]), ([9, 0, 1, 0, 0], [0, 0])] {
        counts.write(0, &words).unwrap();
        recording.run().unwrap();
        let mut found = vec![0_u32; 16 * 8];
        pixels.read(0, &mut found).unwrap();
        assert_eq!([found[4 * 16 + 1], found[4 * 16 + 14]], expected, "{words:?}");
    }
    let mut recorder = device.recorder(Timing::Off).unwrap();
    let error = recorder.draw("draw", &target, &[draw(Some((&counts, 8)))]).unwrap_err().to_string();
    assert!(error.contains("reads its vertex count at byte 8 of counts, which has 20"), "{error}");
    drop((recorder, recording, image, pixels, corners, counts, pipeline, device));
    assert_silent(&log);
}

#[test]
fn a_recording_dropped_in_flight_is_retired() {
    let Some((device, log)) = device("a_recording_dropped_in_flight_is_retired", DeviceSettings::default()) else {
        return;
    };
    for _ in 0..3 {
        let (_, mut recording) = quadruple(&device, 100_000, Timing::Off).unwrap();
        recording.submit().unwrap();
        drop(recording);
    }
    drop(device);
    assert_silent(&log);
}

#[test]
fn limits_are_errors_with_names_in_them() {
    let lower: fn(&mut Capabilities) = |capabilities| {
        capabilities.max_image = 64;
        capabilities.max_storage = 1 << 16;
        capabilities.memory = 1 << 18;
        capabilities.transform_feedback = false;
    };
    let settings = DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
    let Some((device, log)) = device("limits_are_errors_with_names_in_them", settings) else { return };
    let message = |error: anyhow::Error| format!("{error:#}");
    let error = message(device.image("big", Format::Rgba8, [65, 1], ImageUse::Target).unwrap_err());
    assert_eq!(error, "the image big would be 65x1, and this device allows 1 to 64 pixels a side");
    let error = message(device.buffer::<u32>("long", 16385, Memory::Device).unwrap_err());
    assert_eq!(error, "the buffer long would have 65540 bytes, more than the 65536 that this device binds at once");
    let mut held = Vec::new();
    let error = loop {
        match device.buffer::<u32>("one of many", 4096, Memory::Device) {
            Ok(buffer) => held.push(buffer),
            Err(error) => break error,
        }
        assert!(held.len() <= 16, "the budget was not kept");
    };
    let full = error.downcast_ref::<OutOfMemory>().unwrap();
    assert_eq!((full.resource.as_str(), full.asked), ("one of many", 16384));
    drop(held);
    let again = device.buffer::<u32>("after", 1024, Memory::Device).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    let error = recorder.feedback("capture", &Feedback { buffer: &again, offset: 0, size: 64 }, &[]).unwrap_err();
    assert_eq!(message(error), "the pass capture needs transform feedback, which this device does not have");
    let error = again.write(0, &[1_u32]).unwrap_err();
    assert_eq!(message(error), "the host cannot see the buffer after");
    drop((recorder, again, device));
    assert_silent(&log);
}

#[test]
fn a_lost_device_is_named_with_its_pass_and_stays_lost() {
    let settings = DeviceSettings { lose_after_passes: Some(3), ..DeviceSettings::default() };
    let Some((device, log)) = device("a_lost_device_is_named_with_its_pass_and_stays_lost", settings) else { return };
    let (_, mut recording) = quadruple(&device, 100, Timing::Off).unwrap();
    let error = recording.run().unwrap_err();
    let lost = error.downcast_ref::<DeviceLost>().unwrap();
    assert_eq!(lost.pass.as_deref(), Some("second"));
    assert!(format!("{error}").contains("was lost in pass second"), "{error}");
    assert!(recording.run().unwrap_err().is::<DeviceLost>());
    assert!(device.recorder(Timing::Off).unwrap_err().is::<DeviceLost>());
    drop((recording, device));
    assert_silent(&log);
}

#[test]
fn a_recording_is_split_where_a_driver_would_reset() {
    let lower: fn(&mut Capabilities) = |capabilities| capabilities.longest_submission = Some(Duration::from_millis(1));
    let settings = DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
    let Some((device, log)) = device("a_recording_is_split_where_a_driver_would_reset", settings) else { return };
    let (result, mut recording) = quadruple(&device, 1000, Timing::Statistics).unwrap();
    assert!(result.iter().enumerate().all(|(i, &value)| value == 4.0 * i as f32));
    assert_eq!(recording.parts.as_ref().unwrap().ended.len(), 1, "a pass a submission");
    let before = recording.submitted;
    recording.run().unwrap();
    assert_eq!(recording.submitted, before + 2);
    if device.capabilities().timestamps {
        assert_eq!(recording.timings().unwrap().len(), 2);
    }
    drop((recording, device));
    assert_silent(&log);
    // What passes took says how many make a submission.
    let lower: fn(&mut Capabilities) =
        |capabilities| capabilities.longest_submission = Some(Duration::from_millis(200));
    let settings = DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
    let (device, _) = test_device::device("by their time", settings).unwrap();
    assert_eq!(device.shared.passes_a_submission(), 100);
    device.shared.note_pass_time(Duration::from_millis(500), 10);
    assert_eq!(device.shared.passes_a_submission(), 4);
    device.shared.note_pass_time(Duration::from_millis(1), 10);
    assert_eq!(device.shared.passes_a_submission(), 4, "the slowest counts");
    device.shared.note_pass_time(Duration::from_secs(5), 1);
    assert_eq!(device.shared.passes_a_submission(), 1);
}

#[test]
fn breadcrumbs_are_left_when_asked_for_or_cheap() {
    for breadcrumbs in [Breadcrumbs::WhereCheap, Breadcrumbs::Always] {
        let settings = DeviceSettings { breadcrumbs, ..DeviceSettings::default() };
        let Some((device, log)) = device("breadcrumbs_are_left_when_asked_for_or_cheap", settings) else { return };
        let (_, recording) = quadruple(&device, 1000, Timing::Off).unwrap();
        let expected = device.shared.leaves_breadcrumbs().then_some(1);
        assert!(breadcrumbs == Breadcrumbs::WhereCheap || expected.is_some());
        assert_eq!(recording.last_pass_begun(), expected);
        drop((recording, device));
        assert_silent(&log);
    }
}

#[test]
fn a_device_without_graphics_computes() {
    let lower: fn(&mut Capabilities) = |capabilities| capabilities.graphics = false;
    for settings in [
        DeviceSettings { lower: Some(lower), ..DeviceSettings::default() },
        DeviceSettings { graphics: false, ..DeviceSettings::default() },
    ] {
        let Some((device, log)) = device("a_device_without_graphics_computes", settings) else { return };
        let (result, recording) = quadruple(&device, 100, Timing::Statistics).unwrap();
        assert_eq!(result[99], 396.0);
        let drawing = Drawing { colour: Some(Format::Rgba8), ..Drawing::default() };
        let error = device.graphics_pipeline("fill", &[fill_vert::stage(), fill_frag::stage()], &drawing).unwrap_err();
        assert!(error.to_string().contains("has no queue for graphics, which fill needs"), "{error}");
        drop((recording, device));
        assert_silent(&log);
    }
}

/// As many passes, each of which fills 64 MiB.
fn slow(device: &Device, passes: usize) -> Recording {
    let buffer = device.buffer::<u32>("filled again and again", 1 << 24, Memory::Device).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    for pass in 0..passes {
        recorder.fill(&format!("fill {pass}"), &buffer, pass as u32).unwrap();
    }
    recorder.finish().unwrap()
}

#[test]
fn a_device_that_gets_on_is_waited_for() {
    let name = "a_device_that_gets_on_is_waited_for";
    let mut passes = 64;
    loop {
        let settings = DeviceSettings {
            patience: Duration::from_secs(1),
            breadcrumbs: Breadcrumbs::Always,
            ..DeviceSettings::default()
        };
        let patience = settings.patience;
        let Some((device, log)) = device(name, settings) else { return };
        let mut recording = slow(&device, passes);
        let begin = Instant::now();
        recording.run().unwrap();
        drop((recording, device));
        assert_silent(&log);
        // Only a run of some times the patience proves anything.
        if begin.elapsed() > 3 * patience || passes == MOST_PASSES {
            return;
        }
        passes = (4 * passes).min(MOST_PASSES);
    }
}

#[test]
fn a_device_that_is_given_up_keeps_what_it_uses() {
    let settings = DeviceSettings { patience: Duration::ZERO, ..DeviceSettings::default() };
    let name = "a_device_that_is_given_up_keeps_what_it_uses";
    let Some((device, _)) = device_under(Validation::Off, name, settings) else { return };
    // A card is done with few before anyone asks.
    let mut passes = 256;
    let (mut recording, error) = loop {
        let mut recording = slow(&device, passes);
        if let Err(error) = recording.run() {
            break (recording, error);
        }
        assert!(passes < MOST_PASSES, "{passes} passes are done before anyone asks");
        passes = (4 * passes).min(MOST_PASSES);
    };
    let lost = error.downcast_ref::<DeviceLost>().unwrap();
    assert_eq!(lost.given_up_after, Some(Duration::ZERO));
    assert!(format!("{error}").contains("was given up after 0ns at work"), "{error}");
    assert!(recording.run().unwrap_err().is::<DeviceLost>());
    let kept = recording.parts.as_ref().unwrap().buffers[0].clone();
    let shared = device.shared.clone();
    // SAFETY: the semaphore is a timeline of this device.
    let reached =
        unsafe { shared.raw.get_semaphore_counter_value(shared.lanes.of(recording.device.lane).timeline) }.unwrap();
    let is_at_work = reached < recording.submitted;
    let used = shared.memory_used.load(Ordering::Relaxed);
    drop((kept, recording, device));
    // It works on while everything of it is dropped, and would crash without its memory.
    if is_at_work {
        assert_eq!(shared.memory_used.load(Ordering::Relaxed), used, "memory in use was freed");
        std::thread::sleep(Duration::from_millis(500));
    }
}

#[test]
fn a_missing_device_says_how_many_there_are() {
    let Some((_, log)) = device("a_missing_device_says_how_many_there_are", DeviceSettings::default()) else { return };
    let instance = Instance::open(Validation::Off).unwrap();
    let error = Device::open(&instance, DeviceSettings { index: Some(99), ..DeviceSettings::default() }).unwrap_err();
    assert!(format!("{error}").starts_with("there is no Vulkan device 99: this machine has "), "{error}");
    assert_silent(&log);
}

#[test]
fn the_validation_log_hears_of_a_fault() {
    let Some((device, log)) = device("the_validation_log_hears_of_a_fault", DeviceSettings::default()) else { return };
    // A buffer written by two passes without a barrier between: made by reaching behind the recorder.
    let buffer = device.buffer::<u32>("twice", 1024, Memory::Device).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    recorder.fill("one", &buffer, 1).unwrap();
    recorder.forget_hazards();
    recorder.fill("two", &buffer, 2).unwrap();
    recorder.finish().unwrap().run().unwrap();
    // Layers word it as SYNC-HAZARD-WRITE-AFTER-WRITE or as "hazard detected".
    let heard = log.messages().iter().any(|message| message.to_lowercase().contains("hazard"));
    assert!(heard, "{:?}", log.messages());
}

#[test]
fn a_variant_that_writes_what_its_sibling_reads_gets_its_barrier() {
    let name = "a_variant_that_writes_what_its_sibling_reads_gets_its_barrier";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let [first, second, third] = ["first", "second", "third"].map(|name| {
        let values = if name == "first" { [3.0_f32; 64] } else { [0.0; 64] };
        device.uploaded(name, &values).unwrap()
    });
    let push = layout::DoublePush { count: 64, factor: 2.0 };
    let reading = double_comp::Bindings { source: &first, target: &second };
    // Bound through the struct of its sibling, which says that `first` is read.
    let sibling = double_comp::Bindings { source: &first, target: &third };
    let from_struct = |bindings: &double_comp::Bindings<'_>| -> Vec<Use> {
        let uses = |binding: &Binding<'_>| Use { resource: binding.bound.id(), writes: binding.layout.access.writes() };
        bindings.bound().iter().map(uses).collect()
    };
    let mut by_struct = Hazards::default();
    assert_eq!(by_struct.must_wait(&from_struct(&reading), Stages::COMPUTE), None);
    let found = by_struct.must_wait(&from_struct(&sibling), Stages::COMPUTE);
    assert_eq!(found, None, "the struct alone has no conflict to show");
    for (variant, barriers) in [(&double_comp::SHADER, 0), (&double_in_place_comp::SHADER, 1)] {
        let mut recorder = device.recorder(Timing::Off).unwrap();
        recorder.run(reading.dispatch(push, Groups::Over([64, 1, 1]))).unwrap();
        recorder.run(sibling.dispatch(push, Groups::Over([64, 1, 1])).by(variant)).unwrap();
        assert_eq!(recorder.barriers, barriers, "{}", variant.name);
        let mut recording = recorder.finish().unwrap();
        assert_eq!(recording.passes(), ["double", variant.label()]);
        recording.run().unwrap();
    }
    let values = |buffer: &Buffer| {
        let readback = device.buffer::<f32>("values", 64, Memory::Readback).unwrap();
        let mut recorder = device.recorder(Timing::Off).unwrap();
        recorder.copy("read", (buffer, 0), (&readback, 0), readback.size()).unwrap();
        recorder.finish().unwrap().run().unwrap();
        let mut values = [0.0_f32; 64];
        readback.read(0, &mut values).unwrap();
        values
    };
    assert_eq!([&first, &second, &third].map(values), [[6.0; 64], [6.0; 64], [6.0; 64]]);
    assert_silent(&log);
    // Without that barrier the layer hears of it.
    let mut recorder = device.recorder(Timing::Off).unwrap();
    recorder.run(reading.dispatch(push, Groups::Over([64, 1, 1]))).unwrap();
    recorder.forget_hazards();
    recorder.run(sibling.dispatch(push, Groups::Over([64, 1, 1])).by(&double_in_place_comp::SHADER)).unwrap();
    recorder.finish().unwrap().run().unwrap();
    let heard = log.messages().iter().any(|message| message.to_lowercase().contains("hazard"));
    assert!(heard, "{:?}", log.messages());
}

#[test]
fn what_any_stage_of_a_drawing_writes_counts_as_written() {
    let name = "what_any_stage_of_a_drawing_writes_counts_as_written";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    if !device.capabilities().fragment_stores {
        return;
    }
    let corners = device.buffer::<layout::Corner>("corners", 3, Memory::Device).unwrap();
    // Named by the vertex stage, which reads them.
    let bindings = fill_vert::Bindings { corners: &corners }.bound();
    let drawing = Drawing { colour: Some(Format::Rgba8), ..Drawing::default() };
    for (fragment, writes) in [(fill_frag::stage(), false), (recolour_frag::stage(), true)] {
        let pipeline = device.graphics_pipeline("fill", &[fill_vert::stage(), fragment], &drawing).unwrap();
        let resources = pipeline.resources("draw", &bindings).unwrap();
        let found: Vec<Use> = uses(&resources).collect();
        assert_eq!(found, [Use { resource: corners.id(), writes }]);
    }
    drop((corners, device));
    assert_silent(&log);
}

#[test]
fn a_pipeline_is_compiled_once() {
    let Some((device, log)) = device("a_pipeline_is_compiled_once", DeviceSettings::default()) else { return };
    device.compile(&[double_comp::stage(), double_in_place_comp::stage()]).unwrap();
    let [first, second, other] = [double_comp::stage(), double_comp::stage(), double_in_place_comp::stage()]
        .map(|stage| device.compute_pipeline(&stage).unwrap().shared.handle);
    assert!(first == second && first != other);
    drop(device);
    assert_silent(&log);
}

#[test]
fn workgroups_cover_what_was_asked_for() {
    assert_eq!(Groups::Over([65, 7, 3]).count([64, 8, 1]), Some([2, 1, 3]));
    assert_eq!(Groups::Flat(64 * 65535).count([64, 1, 1]), Some([65535, 1, 1]));
    assert_eq!(Groups::Flat(64 * 65535 + 1).count([64, 1, 1]), Some([65535, 2, 1]));
    assert_eq!(Groups::Count([1, 2, 3]).count([64, 1, 1]), Some([1, 2, 3]));
}

#[test]
fn stages_count_their_work() {
    let settings = DeviceSettings { inspect: Inspect::Work, ..DeviceSettings::default() };
    let Some((device, log)) = device("stages_count_their_work", settings) else { return };
    let (result, mut recording) = quadruple(&device, 1000, Timing::Stamps).unwrap();
    assert!(result.iter().enumerate().all(|(i, &value)| value == 4.0 * i as f32), "counting changes no result");
    // Every run begins at nothing.
    recording.run().unwrap();
    let timings = recording.timings().unwrap();
    if device.capabilities().timestamps {
        // Whole workgroups compare; a thousand of their invocations go on to a product.
        let group = u64::from(double_comp::SHADER.workgroup_size[0]);
        let integer = 1000_u64.next_multiple_of(group);
        let expected = Work { integer, float: 1000, read: 4000, written: 4000, ..Work::default() };
        assert_eq!(timings.iter().map(|timing| timing.work).collect::<Vec<_>>(), [Some(expected); 2]);
    }
    drop(recording);
    drop(device);
    assert_silent(&log);
}

#[test]
fn fragments_count_where_they_are_drawn() {
    for (lower, is_counted) in [
        (None, true),
        (
            Some((|capabilities: &mut Capabilities| capabilities.fragment_stores = false) as fn(&mut Capabilities)),
            false,
        ),
    ] {
        let settings = DeviceSettings { inspect: Inspect::Work, lower, ..DeviceSettings::default() };
        let Some((device, log)) = device("fragments_count_where_they_are_drawn", settings) else { return };
        let drawing = Drawing { colour: Some(Format::Rgba8), ..Drawing::default() };
        let pipeline = device.graphics_pipeline("fill", &[fill_vert::stage(), fill_frag::stage()], &drawing).unwrap();
        let corners = device.buffer::<layout::Corner>("corners", 3, Memory::Upload).unwrap();
        let at = |x: f32, y: f32| layout::Corner { position: [x, y], colour: 0xffff_ffff, _pad0: [0] };
        corners.write(0, &[at(-1.0, -1.0), at(3.0, -1.0), at(-1.0, 3.0)]).unwrap();
        let image = device.image("target", Format::Rgba8, [16, 8], ImageUse::Target).unwrap();
        let mut recorder = device.recorder(Timing::Stamps).unwrap();
        let target = Target { colour: (&image, Clear::Value([0.0; 4])), depth: None, area: [0, 0, 16, 8] };
        let bindings = fill_vert::Bindings { corners: &corners };
        let draw = Draw {
            pipeline: &pipeline,
            bindings: &bindings.bound(),
            push: &[],
            viewport: Viewport { area: [0.0, 0.0, 16.0, 8.0], depth: [0.0, 1.0] },
            scissor: [0, 0, 16, 8],
            vertices: 0..3,
            instances: 0..1,
            indices: None,
            indirect: None,
        };
        recorder.draw("fill", &target, &[draw]).unwrap();
        let mut recording = recorder.finish().unwrap();
        recording.run().unwrap();
        if device.capabilities().timestamps {
            let work = recording.timings().unwrap()[0].work;
            assert_eq!(work.is_some(), is_counted && device.capabilities().vertex_stores, "{work:?}");
            if let Some(work) = work {
                assert!(work.read >= 3 * 8, "three corners are read: {work:?}");
            }
        }
        drop(recording);
        drop((corners, image, pipeline, device));
        assert_silent(&log);
    }
}
