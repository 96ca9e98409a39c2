//! Silhouettes compared segment by segment: every evaluator gives the reference's integers and fitness; and the comparison that
//! says so can fail.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

mod device;
#[allow(dead_code, reason = "components are compared elsewhere")]
mod scene;

use std::sync::Arc;

use device::device;
use pantin::body::Body;
use pantin::evaluate::cpu::{Cpu, InstructionSet};
use pantin::evaluate::device::{
    Comparison, Compute, Gathering, Graphics, GraphicsSettings, HostComparison, Packing, Projection, Tiling,
};
use pantin::evaluate::{Components, Evaluator, Objective, Reference, SegmentSums};
use pantin::features::{Observation, Segment, Segmentation, Segments};
use pantin::geometry::Camera;
use pantin::gpu::{Capabilities, DeviceSettings};
use scene::{Random, cameras, ignoring, poses};

/// The adult's parts but for one, dealt out to three segments of different weights.
fn three_segments() -> Arc<Segments> {
    let segment = |name: &str, labels: Vec<u8>, weight| Segment { name: name.into(), labels, weight };
    let dealt = |rest: u8| (2..=16).filter(|label| label % 3 == rest).collect::<Vec<u8>>();
    let list = vec![segment("one", dealt(0), 0.5), segment("two", dealt(1), 0.2), segment("three", dealt(2), 0.3)];
    Arc::new(Segments::new(list).unwrap())
}

/// Noise with a silhouette, in which every third pixel has the segment of a drawn candidate and the others any.
fn seen(body: &Body, cameras: &[Camera], segments: &Arc<Segments>, random: &mut Random) -> Vec<Observation> {
    let reference = Reference::new(body, cameras);
    let pose = poses(body, 1, random);
    let most = segments.as_slice().len() as u32 + 1;
    let view = |(view, mut observation): (usize, Observation)| {
        let drawn = reference.draw(&pose, view);
        let mut numbers = Vec::new();
        for (byte, drawn) in observation.bytes.iter_mut().zip(&drawn.bytes) {
            *byte |= u8::from(*drawn != 0) << 7;
            let any = if random.next().is_multiple_of(3) {
                segments.number(drawn & 0x7f)
            } else {
                (random.next() % most) as u8
            };
            numbers.push(if *byte & Observation::SILHOUETTE == 0 { 0 } else { any });
        }
        let [width, height] = cameras[view].size;
        observation.with_segmentation(Segmentation::new(Arc::clone(segments), width, height, numbers).unwrap()).unwrap()
    };
    scene::observations(cameras, &mut Random(5)).into_iter().enumerate().map(view).collect()
}

struct Found {
    components: Vec<Components>,
    sums: Vec<SegmentSums>,
    fitness: Vec<Vec<f32>>,
}

fn found(evaluator: &mut dyn Evaluator, seen: &[Observation], poses: &[f32]) -> Found {
    evaluator.observe(seen).unwrap();
    let count = poses.len() / evaluator.dof_count();
    let images = count * evaluator.view_count();
    let segments = evaluator.segments().unwrap().as_slice().len();
    let mut components = vec![Components::default(); images];
    evaluator.components(poses, &mut components).unwrap();
    let mut sums = vec![SegmentSums::default(); images * segments];
    evaluator.segment_sums(poses, &mut sums).unwrap();
    let fitness = scene::of_silhouettes().map(|kind| {
        let mut fitness = vec![-1.0; count];
        evaluator.fitness(poses, &Objective { kind, beta: 0.4, w1: 0.7, w2: 0.3 }, &mut fitness).unwrap();
        fitness
    });
    Found { components, sums, fitness: fitness.collect() }
}

/// Integers are the same; powers are rounded as a device rounds them.
fn assert_same(expected: &Found, found: &Found, what: &str) {
    assert!(expected.sums == found.sums, "{what}: sums");
    assert!(expected.components == found.components, "{what}: components");
    for (expected, found) in expected.fitness.iter().flatten().zip(found.fitness.iter().flatten()) {
        assert!((expected - found).abs() <= 1e-5, "{what}: {found} is not {expected}");
    }
}

fn processors() -> impl Iterator<Item = InstructionSet> {
    InstructionSet::ALL.into_iter().filter(|set| set.is_available())
}

#[test]
fn every_instruction_set_gives_the_reference_s_segments() {
    let (body, cameras, segments) = (Body::adult(1750.0).unwrap(), cameras(), three_segments());
    let mut random = Random(31);
    let seen = seen(&body, &cameras, &segments, &mut random);
    let poses = poses(&body, 1500, &mut random);
    let expected = found(&mut Reference::new(&body, &cameras), &seen, &poses);
    let shown = expected.sums.iter().filter(|sums| sums.overlap > 0).count();
    assert!(shown > 3000, "only {shown} of {} segments are met", expected.sums.len());
    let in_segments =
        |image: usize| expected.sums[3 * image..3 * image + 3].iter().map(|sums| sums.area_model).sum::<u32>();
    let images = expected.components.len();
    assert!((0..images).all(|image| expected.components[image].area_model >= in_segments(image)));
    assert!((0..images).any(|image| expected.components[image].area_model > in_segments(image)), "one part has none");
    let in_part = ignoring(&seen, &mut Random(3));
    let expected_in_part = found(&mut Reference::new(&body, &cameras), &in_part, &poses[..200 * body.dof_count()]);
    for set in processors() {
        let mut cpu = Cpu::with(&body, &cameras, set, 1).unwrap();
        assert_same(&expected_in_part, &found(&mut cpu, &in_part, &poses[..200 * body.dof_count()]), set.name());
        for workers in [1, 2] {
            let found = found(&mut Cpu::with(&body, &cameras, set, workers).unwrap(), &seen, &poses);
            let what = format!("{}, {workers} workers", set.name());
            let differs = expected.sums.iter().zip(&found.sums).position(|(expected, found)| expected != found);
            assert_eq!(differs, None, "{what}");
            assert!(expected.components == found.components, "{what}: components");
            assert!(expected.fitness == found.fitness, "{what}: fitness");
        }
    }
}

/// In one batch and in many, before and after whole silhouettes.
#[test]
fn compute_gives_the_reference_s_segments() {
    let (body, cameras, segments) = (Body::adult(1750.0).unwrap(), cameras(), three_segments());
    let mut random = Random(35);
    let seen = seen(&body, &cameras, &segments, &mut random);
    let poses = poses(&body, 300, &mut random);
    let expected = found(&mut Reference::new(&body, &cameras), &seen, &poses);
    let lowered = |lower| DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
    let few: fn(&mut Capabilities) = |capabilities| capabilities.max_groups = 100;
    for settings in [DeviceSettings::default(), lowered(few)] {
        let Some((device, log)) = device("compute_gives_the_reference_s_segments", settings) else { return };
        let mut compute = Compute::on(&device, &body, &cameras).unwrap();
        for round in 0..2 {
            let whole: Vec<Observation> =
                seen.iter().map(|o| Observation { segmentation: None, ..o.clone() }).collect();
            assert!(scene::evaluate(&mut compute, &whole, &poses) == expected.components, "{round}: whole");
            assert!(compute.segments().is_none());
            let found = found(&mut compute, &seen, &poses);
            let differs = expected.sums.iter().zip(&found.sums).position(|(expected, found)| expected != found);
            assert_eq!(differs, None, "round {round}");
            assert!(expected.components == found.components, "round {round}: components");
            for (expected, found) in expected.fitness.iter().flatten().zip(found.fitness.iter().flatten()) {
                // Powers are rounded as the device rounds them.
                assert!((expected - found).abs() <= 1e-5, "{found} is not {expected}");
            }
        }
        let in_part = ignoring(&seen, &mut Random(3));
        let expected_in_part = found(&mut Reference::new(&body, &cameras), &in_part, &poses);
        assert_same(&expected_in_part, &found(&mut compute, &in_part, &poses), "in part");
        let mut sabotaged = seen.clone();
        let mut numbers = seen[1].segmentation.as_ref().unwrap().numbers().to_vec();
        let at = numbers.iter().position(|&number| number == 1).unwrap();
        numbers[at] = 3;
        let [width, height] = cameras[1].size;
        sabotaged[1].segmentation = Some(Segmentation::new(Arc::clone(&segments), width, height, numbers).unwrap());
        assert!(found(&mut compute, &sabotaged, &poses).sums != expected.sums, "a changed segment passed");
        drop((compute, device));
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

/// With every packing, and every way to compare, on the device and on the host.
#[test]
fn graphics_gives_the_reference_s_segments() {
    const NAME: &str = "graphics_gives_the_reference_s_segments";
    let Some((device, log)) = device(NAME, DeviceSettings::default()) else { return };
    let (body, cameras, segments) = (Body::adult(1750.0).unwrap(), cameras(), three_segments());
    let mut random = Random(36);
    let seen = seen(&body, &cameras, &segments, &mut random);
    let poses = poses(&body, 200, &mut random);
    let expected = found(&mut Reference::new(&body, &cameras), &seen, &poses);
    let in_part = ignoring(&seen, &mut Random(3));
    let expected_in_part = found(&mut Reference::new(&body, &cameras), &in_part, &poses);
    assert!(expected_in_part.sums != expected.sums);
    let usual = GraphicsSettings::default();
    for settings in [
        usual,
        GraphicsSettings { comparison: Comparison::Device(Gathering::Subgroup), ..usual },
        GraphicsSettings { comparison: Comparison::Device(Gathering::Shared), ..usual },
        GraphicsSettings { packing: Packing::Depth, projection: Projection::Feedback, ..usual },
        GraphicsSettings { tiling: Tiling::Pictures, ..usual },
        GraphicsSettings { comparison: Comparison::Host(HostComparison::Scalar), packing: Packing::Depth, ..usual },
        GraphicsSettings { comparison: Comparison::Host(HostComparison::Simd), ..usual },
    ] {
        let mut graphics = Graphics::on(&device, &body, &cameras, settings).unwrap();
        for tiles in ["guessed", "fitted"] {
            let found = found(&mut graphics, &seen, &poses);
            let differs = expected.sums.iter().zip(&found.sums).position(|(expected, found)| expected != found);
            assert_eq!(differs, None, "{settings:?}, {tiles} tiles");
            assert!(expected.components == found.components, "{settings:?}, {tiles} tiles: components");
            for (expected, found) in expected.fitness.iter().flatten().zip(found.fitness.iter().flatten()) {
                assert!((expected - found).abs() <= 1e-5, "{settings:?}, {tiles} tiles: {found} is not {expected}");
            }
        }
        let found_in_part = found(&mut graphics, &in_part, &poses);
        assert_same(&expected_in_part, &found_in_part, &format!("{settings:?}, in part"));
        // A moved pose or another segment would show.
        let mut moved = poses.clone();
        moved[0] += 40.0;
        assert!(found(&mut graphics, &seen, &moved).sums != expected.sums, "{settings:?}: a moved pose passed");
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn a_changed_segment_is_caught_and_segments_come_and_go() {
    let (body, cameras, segments) = (Body::adult(1750.0).unwrap(), cameras(), three_segments());
    let mut random = Random(32);
    let seen = seen(&body, &cameras, &segments, &mut random);
    let poses = poses(&body, 20, &mut random);
    let expected = found(&mut Reference::new(&body, &cameras), &seen, &poses);
    let mut cpu = Cpu::new(&body, &cameras).unwrap();
    assert!(found(&mut cpu, &seen, &poses).sums == expected.sums);

    // One observed pixel of another segment, under a candidate that shows the first one there.
    let candidate = Reference::new(&body, &cameras).draw(&poses[..body.dof_count()], 0);
    let mut sabotaged = seen.clone();
    let numbers = seen[0].segmentation.as_ref().unwrap().numbers();
    let at =
        (0..numbers.len()).find(|&at| numbers[at] == 1 && segments.number(candidate.bytes[at] & 0x7f) == 1).unwrap();
    let mut changed = numbers.to_vec();
    changed[at] = 2;
    let [width, height] = cameras[0].size;
    sabotaged[0].segmentation = Some(Segmentation::new(Arc::clone(&segments), width, height, changed).unwrap());
    let other = found(&mut cpu, &sabotaged, &poses);
    let [was, is] = [expected.sums[0], other.sums[0]];
    assert_eq!((was.area_obs - 1, was.overlap - 1, was.area_model), (is.area_obs, is.overlap, is.area_model));
    assert!(other.components == expected.components, "whole silhouettes are what they were");

    // Parts dealt out otherwise.
    let swapped = segments.as_slice().iter().rev().cloned().collect();
    let swapped = Arc::new(Segments::new(swapped).unwrap());
    let mut renamed = seen.clone();
    for observation in &mut renamed {
        let numbers = observation.segmentation.take().unwrap().numbers().to_vec();
        observation.segmentation =
            Some(Segmentation::new(Arc::clone(&swapped), observation.width, observation.height, numbers).unwrap());
    }
    assert!(found(&mut cpu, &renamed, &poses).sums != expected.sums, "other labels passed");
    assert!(found(&mut cpu, &seen, &poses).sums == expected.sums, "and back");

    // Whole silhouettes again: the plain fitness, and no sums of segments.
    let whole: Vec<Observation> = seen.iter().map(|o| Observation { segmentation: None, ..o.clone() }).collect();
    let objective = Objective::default();
    cpu.observe(&whole).unwrap();
    let mut fitness = vec![0.0; 20];
    cpu.fitness(&poses, &objective, &mut fitness).unwrap();
    for (value, row) in fitness.iter().zip(expected.components.chunks_exact(4)) {
        assert_eq!(*value, objective.fitness(row));
    }
    let error = cpu.segment_sums(&poses, &mut []).unwrap_err().to_string();
    assert_eq!(error, "the observations do not tell body parts apart: there are no sums of segments");
}

#[test]
fn one_segment_of_everything_is_the_whole_silhouette() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let segments =
        Arc::new(Segments::new(vec![Segment { name: "all".into(), labels: (1..=16).collect(), weight: 1.0 }]).unwrap());
    let mut random = Random(33);
    let mut seen = seen(&body, &cameras, &segments, &mut random);
    for observation in &mut seen {
        let numbers = observation.bytes.iter().map(|byte| byte >> 7).collect();
        observation.segmentation =
            Some(Segmentation::new(Arc::clone(&segments), observation.width, observation.height, numbers).unwrap());
    }
    let poses = poses(&body, 50, &mut random);
    let found = found(&mut Cpu::new(&body, &cameras).unwrap(), &seen, &poses);
    for (whole, segment) in found.components.iter().zip(&found.sums) {
        let Components { area_obs, area_model, overlap, .. } = *whole;
        assert_eq!(*segment, SegmentSums { area_obs, area_model, overlap });
    }
    for (kind, fitness) in scene::of_silhouettes().zip(&found.fitness) {
        let objective = Objective { kind, beta: 0.4, w1: 0.7, w2: 0.3 };
        for (value, row) in fitness.iter().zip(found.components.chunks_exact(4)) {
            assert_eq!(*value, objective.fitness(row), "{}", kind.name());
        }
    }
}

#[test]
fn mixed_observations_say_so() {
    let (body, cameras, segments) = (Body::adult(1750.0).unwrap(), cameras(), three_segments());
    let mut seen = seen(&body, &cameras, &segments, &mut Random(34));
    seen[2].segmentation = None;
    let mut evaluators: Vec<Box<dyn Evaluator>> =
        vec![Box::new(Reference::new(&body, &cameras)), Box::new(Cpu::new(&body, &cameras).unwrap())];
    if let Some((device, _)) = device("mixed_observations_say_so", DeviceSettings::default()) {
        evaluators.push(Box::new(Compute::on(&device, &body, &cameras).unwrap()));
        evaluators.push(Box::new(Graphics::on(&device, &body, &cameras, GraphicsSettings::default()).unwrap()));
    }
    for evaluator in &mut evaluators {
        let error = evaluator.observe(&seen).unwrap_err().to_string();
        assert!(error.contains("view 0 and view 2 have different segments"), "{}: {error}", evaluator.name());
    }
    seen[2].segmentation = Some(Segmentation::new(segments, 1, 1, vec![0]).unwrap());
    for evaluator in &mut evaluators {
        let error = evaluator.observe(&seen).unwrap_err().to_string();
        assert!(error.contains("segmentation of view 2 is 1x1"), "{}: {error}", evaluator.name());
    }
}
