//! Several devices that share the candidates of a batch.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::thread::Builder;
use std::time::Instant;

use anyhow::{Context as _, Result, ensure};

use crate::body::Body;
use crate::evaluate::batch::check_batch;
use crate::evaluate::evaluator::{check_evidence_batch, check_segment_batch};
use crate::evaluate::{CandidateImage, Components, Evaluator, Footprint, Objective, SegmentSums};
use crate::features::{Observation, Segments};
use crate::gpu::DevicePass;

/// Poses below which a batch's time says more of the call than of the device.
const TELLING: usize = 16;
/// What a new measurement counts beside what was known of a device's rate.
const NEWS: f64 = 0.25;

/// Evaluators of one body and its cameras, each on a device of its own, that share every batch by how fast they were so far. They all
/// give the same integers, so the results are those of one. The host drives the search: no device holds all of a swarm.
pub struct Shared {
    members: Vec<Member>,
}

struct Member {
    evaluator: Box<dyn Evaluator>,
    /// Poses a second, as recent batches told; none before the first.
    rate: Option<f64>,
}

impl Shared {
    /// Of evaluators that differ in their device alone.
    ///
    /// # Errors
    /// When there is none.
    pub fn new(evaluators: Vec<Box<dyn Evaluator>>) -> Result<Self> {
        ensure!(!evaluators.is_empty(), "there is no device to share the candidates, expected at least one");
        Ok(Self { members: evaluators.into_iter().map(|evaluator| Member { evaluator, rate: None }).collect() })
    }

    fn first(&self) -> &dyn Evaluator {
        self.members[0].evaluator.as_ref()
    }

    /// Works on a batch of which every pose has `a_pose` results: each member on its share, side by side.
    fn work<T: Send>(
        &mut self,
        poses: &[f32],
        results: &mut [T],
        a_pose: usize,
        work: impl Fn(&mut dyn Evaluator, &[f32], &mut [T]) -> Result<()> + Sync,
    ) -> Result<()> {
        let dofs = self.first().dof_count();
        let rates: Vec<Option<f64>> = self.members.iter().map(|member| member.rate).collect();
        let counts = shares(poses.len() / dofs, &rates);
        let (mut poses, mut results) = (poses, results);
        let shares = counts.iter().map(|count| {
            let (own, rest) = poses.split_at(count * dofs);
            let (room, others) = std::mem::take(&mut results).split_at_mut(count * a_pose);
            (poses, results) = (rest, others);
            (own, room)
        });
        let mut shares = self.members.iter_mut().zip(shares).zip(&counts).filter(|(_, count)| **count > 0);
        let Some((here, _)) = shares.next() else { return Ok(()) };
        let run =
            |(member, (poses, results)): (&mut Member, (&[f32], &mut [T]))| member.run(poses, results, dofs, &work);
        let run = &run;
        std::thread::scope(|scope| {
            let there = shares.map(|(share, _)| Builder::new().spawn_scoped(scope, move || run(share)));
            let there = there.collect::<std::io::Result<Vec<_>>>().context("cannot start a thread a device")?;
            let mut done = run(here);
            for thread in there {
                done = done.and(thread.join().unwrap_or_else(|panic| resume_unwind(panic)));
            }
            done
        })
    }
}

impl Member {
    fn run<T>(
        &mut self,
        poses: &[f32],
        results: &mut [T],
        dofs: usize,
        work: &impl Fn(&mut dyn Evaluator, &[f32], &mut [T]) -> Result<()>,
    ) -> Result<()> {
        let begin = Instant::now();
        work(self.evaluator.as_mut(), poses, results)?;
        let count = poses.len() / dofs;
        if count >= TELLING {
            let rate = count as f64 / begin.elapsed().as_secs_f64().max(1e-9);
            self.rate = Some(self.rate.map_or(rate, |known| known + NEWS * (rate - known)));
        }
        Ok(())
    }
}

/// How many of `count` poses each gets: as many as its rate asks for, evenly where one has not told yet; enough to tell in any case, so
/// that whoever was slow can show that it no longer is. Of too few for that the first gets all.
fn shares(count: usize, rates: &[Option<f64>]) -> Vec<usize> {
    let known: Option<Vec<f64>> = rates.iter().copied().collect();
    let rates = known.unwrap_or_else(|| vec![1.0; rates.len()]);
    if count < rates.len() * TELLING {
        let mut all = vec![0; rates.len()];
        all[0] = count;
        return all;
    }
    let total: f64 = rates.iter().sum();
    let (mut given, mut sum) = (0, 0.0);
    let mut shares: Vec<usize> = rates
        .iter()
        .map(|rate| {
            sum += rate;
            let until = (count as f64 * sum / total).round() as usize;
            let own = until - given;
            given = until;
            own
        })
        .collect();
    // While one has too few another has more than enough.
    while let Some(low) = shares.iter().position(|share| *share < TELLING) {
        let most = (0..shares.len()).max_by_key(|&at| shares[at]).unwrap_or(low);
        shares[most] -= 1;
        shares[low] += 1;
    }
    shares
}

impl Evaluator for Shared {
    fn name(&self) -> &'static str {
        self.first().name()
    }

    fn variant(&self) -> &'static str {
        self.first().variant()
    }

    fn view_count(&self) -> usize {
        self.first().view_count()
    }

    fn dof_count(&self) -> usize {
        self.first().dof_count()
    }

    fn set_body(&mut self, body: &Body) -> Result<()> {
        self.members.iter_mut().try_for_each(|member| member.evaluator.set_body(body))
    }

    fn observe(&mut self, observations: &[Observation]) -> Result<()> {
        self.members.iter_mut().try_for_each(|member| member.evaluator.observe(observations))
    }

    fn components(&mut self, poses: &[f32], components: &mut [Components]) -> Result<()> {
        let views = self.view_count();
        check_batch(poses, self.dof_count(), components.len(), views)?;
        self.work(poses, components, views, |evaluator, poses, components| evaluator.components(poses, components))
    }

    fn segments(&self) -> Option<&Arc<Segments>> {
        self.first().segments()
    }

    fn segment_sums(&mut self, poses: &[f32], sums: &mut [SegmentSums]) -> Result<()> {
        let a_pose = check_segment_batch(self, poses, sums.len())?;
        self.work(poses, sums, a_pose, |evaluator, poses, sums| evaluator.segment_sums(poses, sums))
    }

    fn best_evidence(&self) -> Option<&[u32]> {
        self.first().best_evidence()
    }

    fn evidence_sums(&mut self, poses: &[f32], sums: &mut [i32]) -> Result<()> {
        check_evidence_batch(self, poses, sums.len())?;
        let views = self.view_count();
        self.work(poses, sums, views, |evaluator, poses, sums| evaluator.evidence_sums(poses, sums))
    }

    fn drawn(&mut self, pose: &[f32], view: usize) -> Result<Option<CandidateImage>> {
        self.members[0].evaluator.drawn(pose, view)
    }

    fn fitness(&mut self, poses: &[f32], objective: &Objective, fitness: &mut [f32]) -> Result<()> {
        check_batch(poses, self.dof_count(), fitness.len(), 1)?;
        self.work(poses, fitness, 1, |evaluator, poses, fitness| evaluator.fitness(poses, objective, fitness))
    }

    fn measure_passes(&mut self, measured: bool) -> Result<()> {
        self.members.iter_mut().try_for_each(|member| member.evaluator.measure_passes(measured))
    }

    fn device_passes(&mut self) -> Vec<DevicePass> {
        let passes = self.members.iter_mut().enumerate().flat_map(|(at, member)| {
            let passes = member.evaluator.device_passes().into_iter();
            passes.map(move |pass| DevicePass { name: format!("{at}: {}", pass.name), ..pass })
        });
        passes.collect()
    }

    fn footprint(&self) -> Option<Footprint> {
        self.first().footprint()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faster_devices_get_more() {
        assert_eq!(shares(100, &[None, Some(3.0)]), [50, 50], "one has not told yet");
        assert_eq!(shares(104, &[Some(30.0), Some(10.0)]), [78, 26]);
        assert_eq!(shares(100, &[Some(1e12), Some(1e-3)]), [84, TELLING], "the slow one goes on telling");
        assert_eq!(shares(31, &[Some(1.0), Some(1.0)]), [31, 0], "not worth two");
        assert_eq!(shares(0, &[Some(1.0)]), [0]);
        for count in [48, 49, 1000, 4097] {
            let found = shares(count, &[Some(0.3), Some(0.1), Some(7.7)]);
            assert_eq!(found.iter().sum::<usize>(), count, "{found:?}");
            assert!(found.iter().all(|share| *share >= TELLING), "{found:?}");
        }
    }

    #[test]
    fn nobody_shares_nothing() {
        assert!(Shared::new(Vec::new()).err().is_some_and(|error| error.to_string().contains("no device to share")));
    }
}
