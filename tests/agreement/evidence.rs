//! Soft evidence summed over what is drawn: every evaluator gives the reference's integers and fitness; and the comparison that says
//! so can fail.
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
use pantin::body::{Body, Mesh};
use pantin::evaluate::cpu::{Cpu, InstructionSet};
use pantin::evaluate::device::{
    Comparison, Compute, Gathering, Graphics, GraphicsSettings, HostComparison, Packing, Projection, Tiling,
};
use pantin::evaluate::{Components, Evaluator, EvidenceSum, Objective, ObjectiveKind, Reference, SegmentSums};
use pantin::features::{Evidence, Observation, PartClasses, Segment, Segmentation, Segments};
use pantin::geometry::Camera;
use pantin::gpu::{Capabilities, DeviceSettings, Timing};
use pantin::search::{DeviceSearch, SearchKind, SearchSettings, SearchSpace};
use scene::{Random, cameras, ignoring, poses};

/// The adult's sixteen parts in `count` classes.
fn classes(count: u8) -> Arc<PartClasses> {
    Arc::new(PartClasses::new((1..=16).map(|label| (label, label * 5 % count))).unwrap())
}

/// Noise with evidence in every pixel and class, more of which speaks for a person than against.
fn seen(cameras: &[Camera], classes: &Arc<PartClasses>, random: &mut Random) -> Vec<Observation> {
    let view = |mut observation: Observation| {
        let code = |random: &mut Random| (random.next() % 15).max(random.next() % 12);
        let word = |random: &mut Random| (0..classes.count()).fold(0, |word, class| word | code(random) << (4 * class));
        let words = observation.bytes.iter().map(|_| word(random)).collect();
        let (width, height) = (observation.width, observation.height);
        observation.evidence = Some(Evidence::new(Arc::clone(classes), width, height, words).unwrap());
        observation
    };
    scene::observations(cameras, &mut Random(5)).into_iter().map(view).collect()
}

#[derive(Debug, PartialEq)]
struct Found {
    components: Vec<Components>,
    sums: Vec<i32>,
    fitness: Vec<f32>,
    unequal: Vec<f32>,
}

fn found(evaluator: &mut dyn Evaluator, seen: &[Observation], poses: &[f32]) -> Found {
    evaluator.observe(seen).unwrap();
    let count = poses.len() / evaluator.dof_count();
    let mut found = Found {
        components: vec![Components::default(); count * evaluator.view_count()],
        sums: vec![i32::MIN; count * evaluator.view_count()],
        fitness: vec![-1.0; count],
        unequal: vec![-1.0; count],
    };
    let objective = Objective::of(ObjectiveKind::Evidence);
    evaluator.components(poses, &mut found.components).unwrap();
    evaluator.evidence_sums(poses, &mut found.sums).unwrap();
    evaluator.fitness(poses, &objective, &mut found.fitness).unwrap();
    let unequal = Objective { w1: 0.875, w2: 1.0, ..objective };
    evaluator.fitness(poses, &unequal, &mut found.unequal).unwrap();
    found
}

/// What differs, in a sentence.
fn difference(expected: &Found, found: &Found) -> Option<String> {
    let at = expected.sums.iter().zip(&found.sums).position(|(expected, found)| expected != found);
    if let Some(at) = at {
        return Some(format!("image {at}: the sum is {}, expected {}", found.sums[at], expected.sums[at]));
    }
    let same = [
        ("components", expected.components == found.components),
        ("fitness", expected.fitness == found.fitness),
        ("fitness of other weights", expected.unequal == found.unequal),
    ];
    same.into_iter().find(|(_, same)| !same).map(|(what, _)| what.to_owned())
}

/// One code of one pixel changed, under a drawn candidate: one sum of that candidate is one more or less.
fn sabotaged(body: &Body, cameras: &[Camera], seen: &[Observation], poses: &[f32]) -> Vec<Observation> {
    let drawn = Reference::new(body, cameras).draw(&poses[..body.dof_count()], 2);
    let mut changed = seen.to_vec();
    let evidence = seen[2].evidence.as_ref().unwrap();
    let at = drawn.bytes.iter().position(|byte| *byte != 0).unwrap();
    let shift = 4 * u32::from(evidence.classes().of_label(drawn.bytes[at] & 0x7f));
    let mut words = evidence.words().to_vec();
    words[at] = if words[at] >> shift & 15 == 14 { words[at] - (1 << shift) } else { words[at] + (1 << shift) };
    let (width, height) = evidence.dimensions();
    changed[2].evidence = Some(Evidence::new(Arc::clone(evidence.classes()), width, height, words).unwrap());
    changed
}

/// Every backend.
fn one_of_each(test: &str, body: &Body, cameras: &[Camera]) -> Vec<Box<dyn Evaluator>> {
    let mut all: Vec<Box<dyn Evaluator>> =
        vec![Box::new(Reference::new(body, cameras)), Box::new(Cpu::new(body, cameras).unwrap())];
    if let Some((device, _)) = device(test, DeviceSettings::default()) {
        all.push(Box::new(Compute::on(&device, body, cameras).unwrap()));
        all.push(Box::new(Graphics::on(&device, body, cameras, GraphicsSettings::default()).unwrap()));
    }
    all
}

/// Body, cameras, observations in so many classes, poses from calm to wild.
fn case(class_count: u8, pose_count: usize, seed: u64) -> (Body, Vec<Camera>, Vec<Observation>, Vec<f32>) {
    let (body, cameras, mut random) = (Body::adult(1750.0).unwrap(), cameras(), Random(seed));
    let seen = seen(&cameras, &classes(class_count), &mut random);
    let poses = poses(&body, pose_count, &mut random);
    (body, cameras, seen, poses)
}

#[test]
fn the_fitness_is_that_of_the_sums() {
    let (body, cameras, seen, poses) = case(5, 60, 41);
    let found = found(&mut Reference::new(&body, &cameras), &seen, &poses);
    let objective = Objective::of(ObjectiveKind::Evidence);
    let best: Vec<u32> = seen.iter().map(|view| view.evidence.as_ref().unwrap().best()).collect();
    let rows = found.components.chunks_exact(4).zip(found.sums.chunks_exact(4));
    for ((components, sums), fitness) in rows.zip(&found.fitness) {
        let evidence: Vec<EvidenceSum> =
            sums.iter().zip(&best).map(|(&sum, &best)| EvidenceSum { sum, best }).collect();
        assert_eq!(objective.evidence_fitness(components, &evidence), *fitness);
        for (sum, view) in evidence.iter().zip(components) {
            assert!(i64::from(sum.sum) <= i64::from(sum.best) && sum.sum.unsigned_abs() <= 7 * view.area_model);
        }
    }
    assert!(found.sums.iter().any(|sum| *sum > 100) && found.fitness.iter().any(|fitness| *fitness > 1e-3));
}

#[test]
fn every_instruction_set_gives_the_reference_s_evidence() {
    for (class_count, pose_count) in [(1, 100), (5, 400), (8, 100)] {
        let (body, cameras, seen, poses) = case(class_count, pose_count, 42);
        let expected = found(&mut Reference::new(&body, &cameras), &seen, &poses);
        let in_part = ignoring(&seen, &mut Random(3));
        let expected_in_part = found(&mut Reference::new(&body, &cameras), &in_part, &poses);
        assert!(expected_in_part.sums != expected.sums);
        let changed = sabotaged(&body, &cameras, &seen, &poses);
        for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            for workers in [1, 2] {
                let mut cpu = Cpu::with(&body, &cameras, set, workers).unwrap();
                let what = format!("{class_count} classes, {}, {workers} workers", set.name());
                assert_eq!(difference(&expected, &found(&mut cpu, &seen, &poses)), None, "{what}");
                let found_in_part = found(&mut cpu, &in_part, &poses);
                assert_eq!(difference(&expected_in_part, &found_in_part), None, "{what}, in part");
                let other = found(&mut cpu, &changed, &poses);
                let by_one = expected.sums.iter().zip(&other.sums).filter(|(a, b)| a.abs_diff(**b) == 1).count();
                assert!(by_one > 0 && other.sums[2] != expected.sums[2], "{what}: a changed code passed");
                assert!(other.components == expected.components, "{what}: silhouettes are what they were");
            }
        }
    }
}

/// In one batch and in many: on lavapipe fitness too is the processor's to the bit.
#[test]
fn compute_gives_the_reference_s_evidence() {
    let lowered = |lower| DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
    let few: fn(&mut Capabilities) = |capabilities| capabilities.max_groups = 100;
    for (class_count, settings) in [(5, DeviceSettings::default()), (8, lowered(few))] {
        let (body, cameras, seen, poses) = case(class_count, 200, 47);
        let expected = found(&mut Reference::new(&body, &cameras), &seen, &poses);
        let Some((device, log)) = device("compute_gives_the_reference_s_evidence", settings) else { return };
        let mut compute = Compute::on(&device, &body, &cameras).unwrap();
        let in_part = ignoring(&seen, &mut Random(3));
        let expected_in_part = found(&mut Reference::new(&body, &cameras), &in_part, &poses);
        for round in 0..2 {
            assert_eq!(difference(&expected, &found(&mut compute, &seen, &poses)), None, "round {round}");
            let found_in_part = found(&mut compute, &in_part, &poses);
            assert_eq!(difference(&expected_in_part, &found_in_part), None, "round {round}, in part");
        }
        let changed = sabotaged(&body, &cameras, &seen, &poses);
        assert!(found(&mut compute, &changed, &poses).sums[2] != expected.sums[2], "a changed code passed");
        drop((compute, device));
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

/// With every packing, and every way to compare, on the device and on the host.
#[test]
fn graphics_gives_the_reference_s_evidence() {
    const NAME: &str = "graphics_gives_the_reference_s_evidence";
    let Some((device, log)) = device(NAME, DeviceSettings::default()) else { return };
    let (body, cameras, seen, poses) = case(5, 100, 48);
    let expected = found(&mut Reference::new(&body, &cameras), &seen, &poses);
    let changed = sabotaged(&body, &cameras, &seen, &poses);
    let in_part = ignoring(&seen, &mut Random(3));
    let expected_in_part = found(&mut Reference::new(&body, &cameras), &in_part, &poses);
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
            assert_eq!(difference(&expected, &found), None, "{settings:?}, {tiles} tiles");
        }
        let found_in_part = found(&mut graphics, &in_part, &poses);
        assert_eq!(difference(&expected_in_part, &found_in_part), None, "{settings:?}, in part");
        assert!(
            found(&mut graphics, &changed, &poses).sums[2] != expected.sums[2],
            "{settings:?}: a changed code passed"
        );
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// A mesh has a depth at every pixel, and its pixels are the device's own: what it draws is what it sums over.
#[test]
fn a_mesh_s_evidence_is_that_of_the_pictures_it_draws() {
    const NAME: &str = "a_mesh_s_evidence_is_that_of_the_pictures_it_draws";
    let Some((device, log)) = device(NAME, DeviceSettings::default()) else { return };
    let (body, cameras, seen, poses) = case(5, 6, 49);
    let mesh = Mesh::of_body(&body).unwrap();
    for comparison in [Comparison::Device(Gathering::Texels), Comparison::Host(HostComparison::Scalar)] {
        let settings = GraphicsSettings { comparison, tiling: Tiling::Pictures, ..GraphicsSettings::default() };
        let mut graphics = Graphics::of_mesh(&device, &body, mesh.clone(), &cameras, settings).unwrap();
        let found = found(&mut graphics, &seen, &poses);
        let mut met = 0;
        for (image, sum) in found.sums.iter().enumerate() {
            let pose = &poses[image / 4 * body.dof_count()..][..body.dof_count()];
            let drawn = graphics.drawn(pose, image % 4).unwrap().unwrap();
            let evidence = seen[image % 4].evidence.as_ref().unwrap();
            let expected: i32 = (drawn.bytes.iter().zip(evidence.words()))
                .filter(|(byte, _)| **byte != 0)
                .map(|(byte, word)| (word >> (4 * u32::from(evidence.classes().of_label(*byte))) & 15) as i32 - 7)
                .sum();
            assert_eq!(*sum, expected, "{comparison:?}, image {image}");
            met += usize::from(expected != 0);
        }
        assert!(met > 6, "only {met} images show anything");
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// A frame in one submission, however candidates are drawn, finds what the host finds over the processor: pose and fitness to the
/// bit.
#[test]
fn a_search_on_the_device_finds_what_the_host_finds() {
    const NAME: &str = "a_search_on_the_device_finds_what_the_host_finds";
    let Some((device, log)) = device(NAME, DeviceSettings::default()) else { return };
    let (body, cameras, seen, _) = case(5, 1, 50);
    let next = self::seen(&cameras, &classes(5), &mut Random(51));
    let frames = [seen, ignoring(&next, &mut Random(52))];
    let space = SearchSpace::of(&body).unwrap();
    let spread = space.spread(0.04).unwrap();
    let standing: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
    let objective = Objective::of(ObjectiveKind::Evidence);
    let settings =
        SearchSettings { kind: SearchKind::Pso, particles: 23, iterations: 3, seed: 3, ..SearchSettings::default() };
    let mut cpu = Cpu::new(&body, &cameras).unwrap();
    let mut search = settings.build(&space).unwrap();
    let mut centre = standing.clone();
    let mut expected = Vec::new();
    for (frame, seen) in (0..).zip(&frames) {
        cpu.observe(seen).unwrap();
        let fitness = &mut |poses: &[f32], fitness: &mut [f32]| cpu.fitness(poses, &objective, fitness);
        let estimate = search.search_frame(frame, &centre, &spread, fitness).unwrap();
        let views = cpu.view_counts(&estimate.pose, &objective).unwrap();
        assert!(estimate.fitness > 0.0 && views.iter().all(|view| view.evidence.is_some()));
        centre.clone_from(&estimate.pose);
        expected.push((estimate, views));
    }
    let usual = GraphicsSettings::default();
    let graphics = |settings| Box::new(Graphics::on(&device, &body, &cameras, settings).unwrap());
    let evaluators: [(&str, Box<dyn Evaluator>); 3] = [
        ("compute", Box::new(Compute::on(&device, &body, &cameras).unwrap())),
        ("graphics", graphics(usual)),
        ("graphics, depth", graphics(GraphicsSettings { packing: Packing::Depth, ..usual })),
    ];
    for (name, mut evaluator) in evaluators {
        // As the tracker does: recorded when the first observations are there.
        evaluator.observe(&frames[0]).unwrap();
        let on_device = evaluator.on_device().unwrap();
        let mut search = DeviceSearch::new(on_device, &objective, &settings, &space, Timing::Off).unwrap();
        let mut centre = &standing;
        for (frame, (seen, (estimate, views))) in (0..).zip(frames.iter().zip(&expected)) {
            evaluator.observe(seen).unwrap();
            // What is ignored for the first time is recorded anew.
            let on_device = evaluator.on_device().unwrap();
            assert_eq!(on_device.has_outgrown_its_recording(), frame == 1, "{name}");
            if frame == 1 {
                search = DeviceSearch::new(on_device, &objective, &settings, &space, Timing::Off).unwrap();
            }
            let found = search.search_frame(frame, centre, &spread).unwrap();
            assert_eq!(found.estimate, *estimate, "{name}, frame {frame}");
            assert_eq!(evaluator.view_counts(&found.estimate.pose, &objective).unwrap(), *views, "{name}");
            centre = &estimate.pose;
        }
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// Evidence comes, changes its classes, stands beside segments, and goes again.
#[test]
fn evidence_and_segments_do_not_disturb_each_other() {
    let (body, cameras, seen, poses) = case(5, 40, 43);
    let expected = found(&mut Reference::new(&body, &cameras), &seen, &poses);
    let segment = |name: &str, labels: Vec<u8>| Segment { name: name.into(), labels, weight: 0.5 };
    let list = vec![segment("one", (1..9).collect()), segment("two", (9..=16).collect())];
    let segments = Arc::new(Segments::new(list).unwrap());
    let with_segments = |view: &Observation| {
        let numbers = view.bytes.iter().map(|byte| (byte >> 7) * (1 + byte % 2)).collect();
        let segmentation = Segmentation::new(Arc::clone(&segments), view.width, view.height, numbers).unwrap();
        view.clone().with_segmentation(segmentation).unwrap()
    };
    let both: Vec<Observation> = seen.iter().map(with_segments).collect();
    let segments_alone: Vec<Observation> =
        both.iter().map(|view| Observation { evidence: None, ..view.clone() }).collect();
    let segment_sums = |evaluator: &mut dyn Evaluator, seen: &[Observation]| {
        evaluator.observe(seen).unwrap();
        let mut sums = vec![SegmentSums::default(); 40 * 4 * 2];
        evaluator.segment_sums(&poses, &mut sums).unwrap();
        let mut fitness = vec![-1.0; 40];
        evaluator.fitness(&poses, &Objective::default(), &mut fitness).unwrap();
        (sums, fitness)
    };
    let in_segments = segment_sums(&mut Reference::new(&body, &cameras), &segments_alone);
    let other = self::seen(&cameras, &classes(3), &mut Random(44));
    let of_other = found(&mut Reference::new(&body, &cameras), &other, &poses);
    assert_ne!(of_other.sums, expected.sums);
    for mut evaluator in one_of_each("evidence_and_segments_do_not_disturb_each_other", &body, &cameras) {
        let evaluator = evaluator.as_mut();
        for round in 0..2 {
            let what = format!("{}, round {round}", evaluator.name());
            assert_eq!(difference(&expected, &found(evaluator, &seen, &poses)), None, "{what}");
            assert_eq!(difference(&expected, &found(evaluator, &both, &poses)), None, "{what}, in segments");
            for seen in [&both, &segments_alone] {
                let (sums, fitness) = segment_sums(evaluator, seen);
                assert!(sums == in_segments.0, "{what}: sums of segments");
                // Weights of segments add up in any order on a device.
                let close = |(a, b): (&f32, &f32)| (a - b).abs() < 1e-5;
                assert!(fitness.iter().zip(&in_segments.1).all(close), "{what}: fitness in segments");
            }
            let error = evaluator.evidence_sums(&poses, &mut [0; 160]).unwrap_err().to_string();
            assert_eq!(error, "the observations carry no evidence: there is nothing to sum over what is drawn");
            let objective = Objective::of(ObjectiveKind::Evidence);
            assert_eq!(evaluator.fitness(&poses, &objective, &mut [0.0; 40]).unwrap_err().to_string(), error);
            assert!(evaluator.best_evidence().is_none());
            assert_eq!(difference(&of_other, &found(evaluator, &other, &poses)), None, "{what}, other classes");
        }
    }
}

#[test]
fn a_body_that_changes_keeps_its_classes() {
    let (body, cameras, seen, poses) = case(5, 40, 45);
    let taller = Body::adult(1950.0).unwrap();
    let expected = found(&mut Reference::new(&taller, &cameras), &seen, &poses);
    let mut cpu = Cpu::new(&body, &cameras).unwrap();
    assert_ne!(found(&mut cpu, &seen, &poses).sums, expected.sums);
    cpu.set_body(&taller).unwrap();
    let mut sums = vec![0; 160];
    cpu.evidence_sums(&poses, &mut sums).unwrap();
    assert_eq!(sums, expected.sums);
}

#[test]
fn wrong_evidence_says_so() {
    let (body, cameras, seen, poses) = case(5, 3, 46);
    for mut evaluator in one_of_each("wrong_evidence_says_so", &body, &cameras) {
        let mut mixed = seen.clone();
        mixed[2].evidence = None;
        let error = evaluator.observe(&mixed).unwrap_err().to_string();
        assert!(error.contains("view 0 and view 2 have different evidence"), "{}: {error}", evaluator.name());
        mixed[2].evidence = self::seen(&cameras, &classes(4), &mut Random(1)).remove(2).evidence;
        let error = evaluator.observe(&mixed).unwrap_err().to_string();
        assert!(error.contains("the same classes of parts"), "{}: {error}", evaluator.name());
        mixed[2].evidence = seen[1].evidence.clone();
        let error = evaluator.observe(&mixed).unwrap_err().to_string();
        assert_eq!(error, "the evidence of view 2 is 64x48, its observation is 141x105", "{}", evaluator.name());
        evaluator.observe(&seen).unwrap();
        assert!(evaluator.evidence_sums(&poses, &mut [0; 11]).is_err(), "{}", evaluator.name());
    }
}
