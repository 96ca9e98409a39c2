//! What a backend says of poses, held to what the reference says.

use pantin::body::Body;
use pantin::evaluate::{
    Components, EdgeTerm, Evaluator, EvidenceSum, Objective, ObjectiveKind, Reference, SegmentSums,
};
use pantin::features::Observation;
use pantin::geometry::Camera;

use crate::scene;

/// Everything that is summed over the pictures of some poses.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Found {
    pub(crate) components: Vec<Components>,
    /// Empty where silhouettes are whole.
    pub(crate) segments: Vec<SegmentSums>,
    /// Empty where the observations carry no evidence.
    pub(crate) evidence: Vec<i32>,
}

impl Found {
    /// What is left of it for the first `count` of `all` poses.
    pub(crate) fn first(&self, count: usize, all: usize) -> Self {
        let part = |length: usize| length / all * count;
        Self {
            components: self.components[..part(self.components.len())].to_vec(),
            segments: self.segments[..part(self.segments.len())].to_vec(),
            evidence: self.evidence[..part(self.evidence.len())].to_vec(),
        }
    }

    /// What differs, in a sentence.
    pub(crate) fn difference(&self, found: &Self) -> Option<String> {
        let at = self.components.iter().zip(&found.components).position(|(expected, found)| expected != found);
        if let Some(at) = at {
            return Some(format!("image {at}: {:?}, expected {:?}", found.components[at], self.components[at]));
        }
        let at = self.segments.iter().zip(&found.segments).position(|(expected, found)| expected != found);
        if let Some(at) = at {
            return Some(format!("segment {at}: {:?}, expected {:?}", found.segments[at], self.segments[at]));
        }
        let at = self.evidence.iter().zip(&found.evidence).position(|(expected, found)| expected != found);
        if let Some(at) = at {
            return Some(format!("image {at}: a sum of {}, expected {}", found.evidence[at], self.evidence[at]));
        }
        (self != found).then(|| "other numbers of sums".to_owned())
    }
}

/// What an evaluator finds.
pub(crate) fn found(evaluator: &mut dyn Evaluator, seen: &[Observation], poses: &[f32]) -> Found {
    evaluator.observe(seen).unwrap();
    let images = poses.len() / evaluator.dof_count() * evaluator.view_count();
    let of_an_image = evaluator.segments().map_or(0, |segments| segments.as_slice().len());
    let mut found = Found {
        components: vec![Components::default(); images],
        segments: vec![SegmentSums::default(); images * of_an_image],
        evidence: vec![i32::MIN; if evaluator.best_evidence().is_some() { images } else { 0 }],
    };
    evaluator.components(poses, &mut found.components).unwrap();
    if of_an_image > 0 {
        evaluator.segment_sums(poses, &mut found.segments).unwrap();
    }
    if !found.evidence.is_empty() {
        evaluator.evidence_sums(poses, &mut found.evidence).unwrap();
    }
    found
}

/// What the reference finds, with two threads.
pub(crate) fn expected(body: &Body, cameras: &[Camera], seen: &[Observation], poses: &[f32]) -> Found {
    let half = poses.len() / body.dof_count() / 2 * body.dof_count();
    std::thread::scope(|scope| {
        let run = |poses| move || found(&mut Reference::new(body, cameras), seen, poses);
        let first = scope.spawn(run(&poses[..half]));
        let second = run(&poses[half..])();
        let first = first.join().unwrap();
        Found {
            components: [first.components, second.components].concat(),
            segments: [first.segments, second.segments].concat(),
            evidence: [first.evidence, second.evidence].concat(),
        }
    })
}

/// The objectives that what is seen can be scored by, with different weights.
pub(crate) fn objectives(seen: &[Observation]) -> Vec<Objective> {
    let evidence = Objective::of(ObjectiveKind::Evidence);
    if seen[0].evidence.is_some() {
        return vec![evidence, Objective { w1: 0.875, w2: 1.0, ..evidence }];
    }
    let uneven = scene::of_silhouettes().map(|kind| Objective { beta: 0.4, w1: 0.7, w2: 0.3, ..Objective::of(kind) });
    if seen[0].segmentation.is_some() {
        let by_segments = |objective| Objective { edges: EdgeTerm::Segments, ..objective };
        return uneven.flat_map(|objective| [objective, by_segments(objective)]).collect();
    }
    uneven.chain(scene::of_silhouettes().map(|kind| Objective { kind, ..Objective::default() })).collect()
}

/// The fitness of every pose by the objective's own formulas.
pub(crate) fn fitness_of(found: &Found, views: usize, seen: &[Observation], objective: &Objective) -> Vec<f32> {
    let rows = found.components.chunks_exact(views);
    if objective.weighs_evidence() {
        let best: Vec<u32> = seen.iter().map(|view| view.evidence.as_ref().unwrap().best()).collect();
        let rows = rows.zip(found.evidence.chunks_exact(views));
        let sums = |row: &[i32]| -> Vec<EvidenceSum> {
            row.iter().zip(&best).map(|(&sum, &best)| EvidenceSum { sum, best }).collect()
        };
        return rows.map(|(components, row)| objective.evidence_fitness(components, &sums(row))).collect();
    }
    let Some(segmentation) = &seen[0].segmentation else { return rows.map(|row| objective.fitness(row)).collect() };
    let segments = segmentation.segments();
    let sums = found.segments.chunks_exact(views * segments.as_slice().len());
    rows.zip(sums).map(|(components, sums)| objective.segmented_fitness(components, segments, sums)).collect()
}

/// Holds an evaluator's fitness to that of what is expected; it has observed what is `seen`. A processor's, and any sum of evidence, is
/// the same to the bit; powers are rounded as a device rounds them.
pub(crate) fn assert_fitness(
    evaluator: &mut dyn Evaluator,
    expected: &Found,
    seen: &[Observation],
    poses: &[f32],
    what: &str,
) {
    let views = evaluator.view_count();
    for objective in objectives(seen) {
        let mut fitness = vec![-1.0; poses.len() / evaluator.dof_count()];
        evaluator.fitness(poses, &objective, &mut fitness).unwrap();
        let is_exact = evaluator.on_device().is_none() || objective.weighs_evidence();
        for (at, (found, expected)) in fitness.iter().zip(fitness_of(expected, views, seen, &objective)).enumerate() {
            let close = if is_exact { *found == expected } else { (found - expected).abs() <= 1e-5 };
            assert!(close, "{what}, {objective:?}, pose {at}: {found} is not {expected}");
        }
    }
}
