//! A frame searched in one submission over a backend of the device is the frame that the host drives over the same backend, to
//! the bit: what differs between devices, their evaluation, is the same device's here.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

mod device;
#[allow(dead_code, reason = "poses are the search's own here")]
mod scene;

use std::sync::Arc;
use std::time::Instant;

use device::{device, device_under};
use pantin::body::{Body, Mesh};
use pantin::evaluate::device::{Comparison, Compute, Gathering, Graphics, GraphicsSettings, Packing};
use pantin::evaluate::{Components, EdgeTerm, Evaluator, Objective, ObjectiveKind};
use pantin::features::{Observation, Segment, Segmentation, Segments};
use pantin::geometry::Camera;
use pantin::gpu::{Capabilities, Device, DeviceSettings, Timing, Validation, by_name};
use pantin::search::{DeviceFound, DeviceSearch, Estimate, Search, SearchKind, SearchSettings, SearchSpace};
use scene::{Random, cameras, observations};

fn standing(body: &Body) -> Vec<f32> {
    body.standing_pose().into_iter().map(|value| value as f32).collect()
}

/// Has what comes behind the drawing done as on a card.
const AS_A_CARD: fn(&mut Capabilities) = |it| it.wide = true;

/// One frame driven by the host.
fn driven(
    search: &mut dyn Search,
    evaluator: &mut dyn Evaluator,
    objective: &Objective,
    frame: u32,
    centre: &[f32],
    spread: &[f32],
) -> (Estimate, Vec<Components>) {
    let estimate = search
        .search_frame(frame, centre, spread, &mut |poses, fitness| evaluator.fitness(poses, objective, fitness))
        .unwrap();
    let mut components = vec![Components::default(); evaluator.view_count()];
    evaluator.components(&estimate.pose, &mut components).unwrap();
    (estimate, components)
}

fn same(found: &DeviceFound, (estimate, components): &(Estimate, Vec<Components>)) {
    assert_eq!(found.estimate, *estimate);
    for (found, expected) in found.sums.iter().zip(components) {
        assert_eq!(*found, [expected.area_model, expected.overlap, expected.edges, expected.proximity]);
    }
}

/// The searches that run whole on a device.
fn on_devices() -> impl Iterator<Item = SearchKind> {
    SearchKind::ALL.into_iter().filter(|kind| kind.has_device_form())
}

#[test]
fn one_submission_finds_what_the_host_finds_batch_by_batch() {
    let small: fn(&mut Capabilities) = |it| it.max_storage = 1 << 16;
    let buffers: fn(&mut Capabilities) = |it| it.stage_buffers = 11;
    for (name, lower) in [
        ("as it is", None),
        ("as a card", Some(AS_A_CARD)),
        ("little storage", Some(small)),
        ("few buffers a stage", Some(buffers)),
    ] {
        let settings = DeviceSettings { lower, ..DeviceSettings::default() };
        let Some((device, _)) = device("one_submission_finds_what_the_host_finds", settings) else {
            return;
        };
        let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
        let space = SearchSpace::of(&body).unwrap();
        let spread = space.spread(0.04).unwrap();
        let mut random = Random(5);
        let frames: Vec<Vec<Observation>> = (0..3).map(|_| observations(&cameras, &mut random)).collect();
        for kind in on_devices() {
            let objective = Objective { beta: 0.4, w1: 0.7, w2: 0.3, ..Objective::of(ObjectiveKind::Sp) };
            let settings = SearchSettings { kind, particles: 37, iterations: 4, seed: 3, ..SearchSettings::default() };
            let mut compute = Compute::on(&device, &body, &cameras).unwrap();
            let evaluator = compute.on_device().unwrap();
            let mut there = DeviceSearch::new(evaluator, &objective, &settings, &space, Timing::Off).unwrap();
            let mut here = settings.build(&space).unwrap();
            let mut centre = standing(&body);
            for (frame, seen) in frames.iter().enumerate() {
                compute.observe(seen).unwrap();
                let found = there.search_frame(frame as u32, &centre, &spread).unwrap();
                // The host's way comes second with the same observations, and leaves the device's buffers as it likes.
                let expected = driven(here.as_mut(), &mut compute, &objective, frame as u32, &centre, &spread);
                same(&found, &expected);
                centre = expected.0.pose;
            }
            println!("{name}, {kind:?}: the same poses");
        }
        assert_eq!(device.validation_log().messages(), Vec::<String>::new());
    }
}

/// Observations whose silhouettes are of any of three segments.
fn in_segments(seen: Vec<Observation>, random: &mut Random) -> Vec<Observation> {
    let segment = |name: &str, labels: Vec<u8>, weight| Segment { name: name.into(), labels, weight };
    let list = vec![
        segment("one", (2..6).collect(), 0.5),
        segment("two", (6..11).collect(), 0.2),
        segment("three", (11..17).collect(), 0.3),
    ];
    let segments = Arc::new(Segments::new(list).unwrap());
    seen.into_iter()
        .map(|observation| {
            let number = |byte: &u8| if byte & Observation::SILHOUETTE == 0 { 0 } else { (random.next() % 4) as u8 };
            let numbers = observation.bytes.iter().map(number).collect();
            let (width, height) = (observation.width, observation.height);
            let segmentation = Segmentation::new(Arc::clone(&segments), width, height, numbers).unwrap();
            observation.with_segmentation(segmentation).unwrap()
        })
        .collect()
}

#[test]
fn a_search_by_segments_runs_on_the_device_over_every_backend() {
    let name = "a_search_by_segments_runs_on_the_device_over_every_backend";
    for lower in [None, Some(AS_A_CARD)] {
        let Some((device, _)) = device(name, DeviceSettings { lower, ..DeviceSettings::default() }) else { return };
        search_by_segments(&device);
    }
}

fn search_by_segments(device: &Device) {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let space = SearchSpace::of(&body).unwrap();
    let spread = space.spread(0.04).unwrap();
    let mut random = Random(6);
    let frames: Vec<Vec<Observation>> = (0..2)
        .map(|_| {
            let seen = observations(&cameras, &mut random);
            in_segments(seen, &mut random)
        })
        .collect();
    let usual_edges = Objective { beta: 0.4, w1: 0.7, w2: 0.3, ..Objective::of(ObjectiveKind::Sp) };
    let mesh = Mesh::of_body(&body).unwrap();
    let usual = GraphicsSettings::default();
    let depth = GraphicsSettings { packing: Packing::Depth, ..usual };
    let subgroup = GraphicsSettings { comparison: Comparison::Device(Gathering::Subgroup), ..usual };
    let graphics = |settings| Box::new(Graphics::on(device, &body, &cameras, settings).unwrap());
    let evaluators: Vec<(&str, Box<dyn Evaluator>)> = vec![
        ("compute", Box::new(Compute::on(device, &body, &cameras).unwrap())),
        ("graphics", graphics(usual)),
        ("graphics, depth", graphics(depth)),
        ("graphics, subgroup", graphics(subgroup)),
        ("mesh", Box::new(Graphics::of_mesh(device, &body, mesh, &cameras, usual).unwrap())),
    ];
    let mut by_segments = None;
    for (name, mut evaluator) in evaluators {
        let is_by_segments = ["compute", "graphics, subgroup", "mesh"].contains(&name);
        let edges = if is_by_segments { EdgeTerm::Segments } else { EdgeTerm::Whole };
        let objective = Objective { edges, ..usual_edges };
        for kind in on_devices() {
            let settings = SearchSettings { kind, particles: 23, iterations: 3, seed: 3, ..SearchSettings::default() };
            // As the tracker does: recorded when the first observations are there.
            evaluator.observe(&frames[0]).unwrap();
            let on_device = evaluator.on_device().unwrap();
            let mut there = DeviceSearch::new(on_device, &objective, &settings, &space, Timing::Off).unwrap();
            let mut here = settings.build(&space).unwrap();
            let mut centre = standing(&body);
            for (frame, seen) in frames.iter().enumerate() {
                evaluator.observe(seen).unwrap();
                let found = there.search_frame(frame as u32, &centre, &spread).unwrap();
                let expected = driven(here.as_mut(), &mut *evaluator, &objective, frame as u32, &centre, &spread);
                same(&found, &expected);
                centre = expected.0.pose;
            }
            println!("{name}, {kind:?}: the same poses");
            if name == "graphics" && kind == SearchKind::Pso {
                by_segments = Some(centre);
            }
        }
        if name == "graphics" {
            // Whole silhouettes have another best pose: the segments did count.
            let settings = SearchSettings {
                kind: SearchKind::Pso,
                particles: 23,
                iterations: 3,
                seed: 3,
                ..SearchSettings::default()
            };
            let mut here = settings.build(&space).unwrap();
            let mut centre = standing(&body);
            for (frame, seen) in frames.iter().enumerate() {
                let whole: Vec<Observation> =
                    seen.iter().map(|o| Observation { segmentation: None, ..o.clone() }).collect();
                evaluator.observe(&whole).unwrap();
                centre = driven(here.as_mut(), &mut *evaluator, &objective, frame as u32, &centre, &spread).0.pose;
            }
            assert!(by_segments.as_ref().is_some_and(|segmented| *segmented != centre), "segments made no difference");
        }
    }
    assert_eq!(device.validation_log().messages(), Vec::<String>::new());
}

/// Four cameras of 640x480 in the places of the small ones.
fn large_cameras() -> Vec<Camera> {
    let mut cameras = cameras();
    cameras.extend(cameras.clone());
    cameras.truncate(4);
    for camera in &mut cameras {
        camera.size = [640, 480];
    }
    cameras
}

/// Run by hand: `cargo test --release --test device_search of_what_comes_behind -- --ignored --nocapture`. What comes behind the drawing
/// in one pass, in one workgroup and in as many as on a card, beside a pass each, in turns.
#[test]
#[ignore = "measures"]
fn time_of_what_comes_behind_the_drawing() {
    let one: fn(&mut Capabilities) = |it| it.wide = false;
    let each: fn(&mut Capabilities) = |it| it.stage_buffers = 11;
    let body = Body::adult(1750.0).unwrap();
    let space = SearchSpace::of(&body).unwrap();
    let (spread, centre) = (space.spread(0.04).unwrap(), standing(&body));
    let mut large = large_cameras();
    large.truncate(2);
    for (name, cameras, kind, particles) in [
        ("640x480 twice", &large, SearchKind::Pso, 300),
        ("640x480 twice", &large, SearchKind::MaEs, 300),
        ("130x100 twice", &cameras()[..2].to_vec(), SearchKind::Pso, 100),
        ("130x100 twice", &cameras()[..2].to_vec(), SearchKind::MaEs, 100),
    ] {
        let seen = observations(cameras, &mut Random(5));
        let objective = Objective::of(ObjectiveKind::Sp);
        let mut made = Vec::new();
        for lower in [each, one, AS_A_CARD] {
            let settings = DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
            let Some((device, _)) = device_under(Validation::Off, "time_of_what_comes_behind", settings) else {
                return;
            };
            let mut compute = Compute::on(&device, &body, cameras).unwrap();
            compute.observe(&seen).unwrap();
            let settings = SearchSettings { kind, particles, iterations: 4, ..SearchSettings::default() };
            let [untimed, timed] = [Timing::Off, Timing::Stamps].map(|timing| {
                let evaluator = compute.on_device().unwrap();
                DeviceSearch::new(evaluator, &objective, &settings, &space, timing).unwrap()
            });
            made.push((compute, untimed, timed, Vec::new()));
        }
        for frame in 0..12 {
            for (_, untimed, _, times) in &mut made {
                let begin = Instant::now();
                untimed.search_frame(frame, &centre, &spread).unwrap();
                times.push(begin.elapsed().as_secs_f64() * 1e3);
            }
        }
        for (form, (_, _, timed, times)) in ["a pass each", "one workgroup", "as a card"].iter().zip(&mut made) {
            times.sort_by(f64::total_cmp);
            let (least, median) = (times[0], times[times.len() / 2]);
            println!("{name}, {kind:?}, {particles}, {form}: a frame {least:.2} ms, median {median:.2}");
            timed.search_frame(0, &centre, &spread).unwrap();
            for (pass, ms, count) in by_name(&timed.timings().unwrap()) {
                println!("    {pass:18} {count:3} x, {ms:.3} ms");
            }
        }
    }
}

/// Run by hand: `cargo test --release --test device_search -- --ignored --nocapture`.
#[test]
#[ignore = "measures"]
fn time_of_a_frame() {
    let Some((device, _)) = device_under(Validation::Off, "time_of_a_frame", DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), large_cameras());
    let space = SearchSpace::of(&body).unwrap();
    let (spread, centre) = (space.spread(0.04).unwrap(), standing(&body));
    let seen = observations(&cameras, &mut Random(5));
    let objective = Objective::default();
    for kind in on_devices() {
        let settings = SearchSettings { kind, particles: 512, iterations: 15, ..SearchSettings::default() };
        let mut compute = Compute::on(&device, &body, &cameras).unwrap();
        let evaluator = compute.on_device().unwrap();
        let mut timed = DeviceSearch::new(evaluator, &objective, &settings, &space, Timing::Stamps).unwrap();
        let evaluator = compute.on_device().unwrap();
        let mut there = DeviceSearch::new(evaluator, &objective, &settings, &space, Timing::Off).unwrap();
        let mut here = settings.build(&space).unwrap();
        let mut times = [const { Vec::new() }; 2];
        for frame in 0..3 {
            compute.observe(&seen).unwrap();
            let begin = Instant::now();
            there.search_frame(frame, &centre, &spread).unwrap();
            times[0].push(begin.elapsed().as_secs_f64() * 1e3);
            compute.observe(&seen).unwrap();
            let begin = Instant::now();
            driven(here.as_mut(), &mut compute, &objective, frame, &centre, &spread);
            times[1].push(begin.elapsed().as_secs_f64() * 1e3);
        }
        timed.search_frame(0, &centre, &spread).unwrap();
        let [one, many] = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            (times[0], times[times.len() / 2])
        });
        println!("{kind:?}: one submission {one:.2?} ms, driven by the host {many:.2?} ms (least, median)");
        for (name, ms, count) in by_name(&timed.timings().unwrap()) {
            println!("    {name:12} {count:3} x, {ms:.3} ms");
        }
    }
}
