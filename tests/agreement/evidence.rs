//! Soft evidence summed over what is drawn: what the sums are, of a mesh too, searches that go by them, and how they come and go.

use std::sync::Arc;

use pantin::body::{Body, Mesh};
use pantin::evaluate::cpu::Cpu;
use pantin::evaluate::device::{
    Comparison, Compute, Gathering, Graphics, GraphicsSettings, HostComparison, Packing, RasterKernel, Tiling,
};
use pantin::evaluate::{Evaluator, Objective, ObjectiveKind, Reference, SegmentSums};
use pantin::features::{Evidence, Observation, PartClasses, Segment, Segmentation, Segments};
use pantin::geometry::Camera;
use pantin::gpu::{Capabilities, Device, DeviceSettings, Timing};
use pantin::search::{DeviceSearch, SearchKind, SearchSettings, SearchSpace};

use crate::device::device;
use crate::found::{assert_fitness, found};
use crate::scene::{self, Random, cameras, ignoring, poses};

/// The adult's sixteen parts in `count` classes.
pub(crate) fn classes(count: u8) -> Arc<PartClasses> {
    Arc::new(PartClasses::new((1..=16).map(|label| (label, label * 5 % count))).unwrap())
}

/// Noise with evidence in every pixel and class, more of which speaks for a person than against.
pub(crate) fn seen(cameras: &[Camera], classes: &Arc<PartClasses>, random: &mut Random) -> Vec<Observation> {
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

/// Spans first, by several workgroups an image.
const SPANS: RasterKernel = RasterKernel::Spans { group: 64, workgroups: 2 };

/// Every backend.
fn one_of_each(test: &str, body: &Body, cameras: &[Camera]) -> Vec<Box<dyn Evaluator>> {
    let mut all: Vec<Box<dyn Evaluator>> =
        vec![Box::new(Reference::new(body, cameras)), Box::new(Cpu::new(body, cameras).unwrap())];
    if let Some((device, _)) = device(test, DeviceSettings::default()) {
        all.push(Box::new(Compute::on(&device, body, cameras).unwrap()));
        all.push(Box::new(Compute::with_kernel(&device, body, cameras, SPANS).unwrap()));
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
fn sums_are_within_what_there_is() {
    let (body, cameras, seen, poses) = case(5, 60, 41);
    let found = found(&mut Reference::new(&body, &cameras), &seen, &poses);
    let best: Vec<u32> = seen.iter().map(|view| view.evidence.as_ref().unwrap().best()).collect();
    for (image, (sum, components)) in found.evidence.iter().zip(&found.components).enumerate() {
        assert!(i64::from(*sum) <= i64::from(best[image % 4]) && sum.unsigned_abs() <= 7 * components.area_model);
    }
    let fitness = crate::found::fitness_of(&found, 4, &seen, &Objective::of(ObjectiveKind::Evidence));
    assert!(found.evidence.iter().any(|sum| *sum > 100) && fitness.iter().any(|fitness| *fitness > 1e-3));
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
        for (image, sum) in found.evidence.iter().enumerate() {
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
    // What comes behind the drawing is done in one workgroup, or in many as on a card.
    let forms: [fn(&mut Capabilities); 2] = [|it| it.wide = false, |it| it.wide = true];
    for lower in forms {
        let settings = DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
        let Some((device, log)) = device(NAME, settings) else { return };
        for kind in [SearchKind::Pso, SearchKind::MaEs] {
            search_as_the_host_does(&device, kind);
        }
        drop(device);
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

fn search_as_the_host_does(device: &Device, kind: SearchKind) {
    let (body, cameras, seen, _) = case(5, 1, 50);
    let next = self::seen(&cameras, &classes(5), &mut Random(51));
    let frames = [seen, ignoring(&next, &mut Random(52))];
    let space = SearchSpace::of(&body).unwrap();
    let spread = space.spread(0.04).unwrap();
    let standing: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
    let objective = Objective::of(ObjectiveKind::Evidence);
    let settings = SearchSettings { kind, particles: 23, iterations: 3, seed: 3, ..SearchSettings::default() };
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
    let graphics = |settings| Box::new(Graphics::on(device, &body, &cameras, settings).unwrap());
    let evaluators: [(&str, Box<dyn Evaluator>); 4] = [
        ("compute", Box::new(Compute::on(device, &body, &cameras).unwrap())),
        ("compute, spans first", Box::new(Compute::with_kernel(device, &body, &cameras, SPANS).unwrap())),
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
    assert_ne!(of_other.evidence, expected.evidence);
    for mut evaluator in one_of_each("evidence_and_segments_do_not_disturb_each_other", &body, &cameras) {
        let evaluator = evaluator.as_mut();
        for round in 0..2 {
            let what = format!("{}, round {round}", evaluator.name());
            assert_eq!(expected.difference(&found(evaluator, &seen, &poses)), None, "{what}");
            let in_segments_too = found(evaluator, &both, &poses);
            assert!(expected.evidence == in_segments_too.evidence, "{what}, in segments");
            assert!(expected.components == in_segments_too.components, "{what}, in segments");
            assert_fitness(evaluator, &expected, &both, &poses, &what);
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
            assert_eq!(of_other.difference(&found(evaluator, &other, &poses)), None, "{what}, other classes");
            assert_fitness(evaluator, &of_other, &other, &poses, &what);
        }
    }
}

#[test]
fn a_body_that_changes_keeps_its_classes() {
    let (body, cameras, seen, poses) = case(5, 40, 45);
    let taller = Body::adult(1950.0).unwrap();
    let expected = found(&mut Reference::new(&taller, &cameras), &seen, &poses);
    let mut cpu = Cpu::new(&body, &cameras).unwrap();
    assert_ne!(found(&mut cpu, &seen, &poses).evidence, expected.evidence);
    cpu.set_body(&taller).unwrap();
    let mut sums = vec![0; 160];
    cpu.evidence_sums(&poses, &mut sums).unwrap();
    assert_eq!(sums, expected.evidence);
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
