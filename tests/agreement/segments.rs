//! Silhouettes compared segment by segment: what segments are, and how they come and go.

use std::sync::Arc;

use pantin::evaluate::cpu::Cpu;
use pantin::evaluate::device::{Compute, Graphics, GraphicsSettings};
use pantin::evaluate::{Components, EdgeTerm, Evaluator, Objective, Reference, SegmentSums};
use pantin::features::{Observation, Segment, Segmentation, Segments};
use pantin::gpu::DeviceSettings;

use crate::cases::{Kind, Stage, USUAL, case};
use crate::device::device;
use crate::found::found;
use crate::scene::{self, Random, poses};

/// The adult's parts but for one, dealt out to three segments of different weights.
pub(crate) fn three() -> Arc<Segments> {
    let segment = |name: &str, labels: Vec<u8>, weight| Segment { name: name.into(), labels, weight };
    let dealt = |rest: u8| (2..=16).filter(|label| label % 3 == rest).collect::<Vec<u8>>();
    let list = vec![segment("one", dealt(0), 0.5), segment("two", dealt(1), 0.2), segment("three", dealt(2), 0.3)];
    Arc::new(Segments::new(list).unwrap())
}

/// Noise with a silhouette, in which every third pixel has the segment of a drawn candidate and the others any.
pub(crate) fn seen(Stage { body, cameras }: &Stage, segments: &Arc<Segments>, random: &mut Random) -> Vec<Observation> {
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

#[test]
fn segments_are_met_and_one_part_has_none() {
    let case = case("segments");
    let expected = case.expected(case.poses(Kind::Processor));
    let shown = expected.segments.iter().filter(|sums| sums.overlap > 0).count();
    assert!(shown > 3000, "only {shown} of {} segments are met", expected.segments.len());
    let drawn = |image: usize| expected.segments[3 * image..][..3].iter().map(|sums| sums.area_model).sum::<u32>();
    let whole = expected.components.iter().map(|sums| sums.area_model).enumerate();
    assert!(whole.clone().all(|(image, whole)| whole >= drawn(image)));
    assert!(whole.into_iter().any(|(image, whole)| whole > drawn(image)), "one part has none");
}

#[test]
fn a_changed_segment_is_caught_and_segments_come_and_go() {
    let (Stage { body, cameras }, segments) = (&*USUAL, three());
    let mut random = Random(32);
    let seen = seen(&USUAL, &segments, &mut random);
    let poses = poses(body, 20, &mut random);
    let expected = found(&mut Reference::new(body, cameras), &seen, &poses);
    let mut cpu = Cpu::new(body, cameras).unwrap();
    assert!(found(&mut cpu, &seen, &poses).segments == expected.segments);

    // One observed pixel of another segment, under a candidate that shows the first one there.
    let candidate = Reference::new(body, cameras).draw(&poses[..body.dof_count()], 0);
    let mut sabotaged = seen.clone();
    let numbers = seen[0].segmentation.as_ref().unwrap().numbers();
    let at =
        (0..numbers.len()).find(|&at| numbers[at] == 1 && segments.number(candidate.bytes[at] & 0x7f) == 1).unwrap();
    let mut changed = numbers.to_vec();
    changed[at] = 2;
    let [width, height] = cameras[0].size;
    sabotaged[0].segmentation = Some(Segmentation::new(Arc::clone(&segments), width, height, changed).unwrap());
    let other = found(&mut cpu, &sabotaged, &poses);
    let [was, is] = [expected.segments[0], other.segments[0]];
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
    assert!(found(&mut cpu, &renamed, &poses).segments != expected.segments, "other labels passed");
    assert!(found(&mut cpu, &seen, &poses).segments == expected.segments, "and back");

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
    let Stage { body, cameras } = &*USUAL;
    let segments =
        Arc::new(Segments::new(vec![Segment { name: "all".into(), labels: (1..=16).collect(), weight: 1.0 }]).unwrap());
    let mut random = Random(33);
    let mut seen = seen(&USUAL, &segments, &mut random);
    for observation in &mut seen {
        let numbers = observation.bytes.iter().map(|byte| byte >> 7).collect();
        observation.segmentation =
            Some(Segmentation::new(Arc::clone(&segments), observation.width, observation.height, numbers).unwrap());
    }
    let poses = poses(body, 50, &mut random);
    let mut cpu = Cpu::new(body, cameras).unwrap();
    let found = found(&mut cpu, &seen, &poses);
    for (whole, segment) in found.components.iter().zip(&found.segments) {
        let Components { area_obs, area_model, overlap, edges, proximity } = *whole;
        assert_eq!(*segment, SegmentSums { area_obs, area_model, overlap, edges, proximity });
    }
    for (kind, edges) in scene::of_silhouettes().flat_map(|kind| EdgeTerm::ALL.map(|edges| (kind, edges))) {
        let objective = Objective { kind, beta: 0.4, w1: 0.7, w2: 0.3, edges };
        let mut fitness = vec![-1.0; 50];
        cpu.fitness(&poses, &objective, &mut fitness).unwrap();
        for (value, row) in fitness.iter().zip(found.components.chunks_exact(4)) {
            assert_eq!(*value, objective.fitness(row), "{}, {edges}", kind.name());
        }
    }
}

#[test]
fn edges_of_a_segment_are_its_own_and_a_changed_one_is_caught() {
    let (Stage { body, cameras }, segments) = (&*USUAL, three());
    let mut random = Random(35);
    let seen = seen(&USUAL, &segments, &mut random);
    let poses = poses(body, 20, &mut random);
    let mut cpu = Cpu::new(body, cameras).unwrap();
    let expected = found(&mut Reference::new(body, cameras), &seen, &poses);
    assert!(found(&mut cpu, &seen, &poses).segments == expected.segments);
    let met = expected.segments.iter().filter(|sums| sums.edges > 0 && sums.proximity > 0).count();
    assert!(met * 3 > expected.segments.len(), "only {met} of {} segments have edges", expected.segments.len());
    // What the one part in no segment shows is in none of them.
    let of_segments = |image: usize| expected.segments[3 * image..][..3].iter().map(|sums| sums.edges).sum::<u32>();
    let mut whole = expected.components.iter().map(|sums| sums.edges).enumerate();
    assert!(whole.clone().all(|(image, whole)| whole >= of_segments(image)));
    assert!(whole.any(|(image, whole)| whole > of_segments(image)), "one part has none");

    // One bit of the proximity under an edge of the first pose that its second segment shows.
    let candidate = Reference::new(body, cameras).draw(&poses[..body.dof_count()], 0);
    let is_second_edge = |byte: &u8| byte & 0x80 != 0 && segments.number(byte & 0x7f) == 2;
    let at = candidate.bytes.iter().position(is_second_edge).unwrap();
    let mut sabotaged = seen.clone();
    sabotaged[0].bytes[at] ^= 1;
    let other = found(&mut cpu, &sabotaged, &poses);
    let [was, is] = [expected.segments[1], other.segments[1]];
    assert_eq!((was.proximity.abs_diff(is.proximity), SegmentSums { proximity: was.proximity, ..is }), (1, was));
    assert_eq!((expected.segments[0], expected.segments[2]), (other.segments[0], other.segments[2]));

    // The edge term of the segments is another one than that of all edges.
    cpu.observe(&seen).unwrap();
    let mut by = |edges| {
        let mut fitness = vec![-1.0; 20];
        cpu.fitness(&poses, &Objective { edges, ..Objective::default() }, &mut fitness).unwrap();
        fitness
    };
    let apart = by(EdgeTerm::Whole).iter().zip(by(EdgeTerm::Segments)).filter(|(a, b)| (*a - b).abs() > 1e-4).count();
    assert!(apart > 5, "of 20 poses only {apart} are worth something else");
}

#[test]
fn mixed_observations_say_so() {
    let (Stage { body, cameras }, segments) = (&*USUAL, three());
    let mut seen = seen(&USUAL, &segments, &mut Random(34));
    seen[2].segmentation = None;
    let mut evaluators: Vec<Box<dyn Evaluator>> =
        vec![Box::new(Reference::new(body, cameras)), Box::new(Cpu::new(body, cameras).unwrap())];
    if let Some((device, _)) = device("mixed_observations_say_so", DeviceSettings::default()) {
        evaluators.push(Box::new(Compute::on(&device, body, cameras).unwrap()));
        evaluators.push(Box::new(Graphics::on(&device, body, cameras, GraphicsSettings::default()).unwrap()));
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
