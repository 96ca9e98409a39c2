//! How well poses, and bodies with their poses, explain all frames used.

use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result};
use rayon::prelude::*;

use super::following::Following;
use super::shape::{Shape, oddness, proportions};
use crate::body::{Body, Proportions};
use crate::evaluate::cpu::{Cpu, InstructionSet};
use crate::evaluate::{Components, Evaluator, Objective};
use crate::features::Observation;
use crate::geometry::Camera;
use crate::track::worth::Posture;

/// What a proportion one standard deviation off the tables costs in fitness: enough to settle what the silhouettes leave
/// open (where a straight leg has its knee), too little to work against them.
const PRIOR: f64 = 2e-4;
/// Deviation of a stated height, or of a hull's, as a fraction of it: shoes, hair, voxels. It costs as a proportion's does, and keeps legs that
/// are white before a white floor from ending where they were last seen.
const STATURE: f64 = 0.01;

/// How well the drawn and the seen silhouettes of a view cover each other, over all frames used; not a number where there is none to cover.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coverage {
    /// Share of the seen silhouette that the model covers.
    pub seen: f64,
    /// Share of the drawn model that lies on the seen silhouette.
    pub drawn: f64,
}

impl Coverage {
    /// Whether nobody is seen in the view, and nobody drawn.
    pub fn is_of_nobody(&self) -> bool {
        self.seen.is_nan() && self.drawn.is_nan()
    }

    /// Whether either share is less than `least`.
    pub fn falls_short_of(&self, least: f64) -> bool {
        self.seen < least || self.drawn < least
    }
}

/// Scores poses, and bodies with their poses, against all frames used.
pub(super) struct Scorer {
    objective: Objective,
    /// Whose poses are scored.
    body: Body,
    posture: Posture,
    /// An evaluator of one thread for every frame, `[thread][frame]`: bodies differ from row to row.
    threads: Vec<Mutex<Vec<Cpu>>>,
}

impl Scorer {
    pub(super) fn new(
        body: &Body,
        cameras: &[Camera],
        frames: &[Vec<Observation>],
        objective: Objective,
    ) -> Result<Self> {
        let count = rayon::current_num_threads();
        let thread = |_| -> Result<Mutex<Vec<Cpu>>> {
            let evaluators = frames.iter().map(|observations| {
                let mut cpu = Cpu::with(body, cameras, InstructionSet::best(), 1)?;
                cpu.observe(observations)?;
                Ok(cpu)
            });
            Ok(Mutex::new(evaluators.collect::<Result<_>>()?))
        };
        let threads = (0..count).map(thread).collect::<Result<_>>()?;
        Ok(Self { objective, body: body.clone(), posture: Posture::of(body), threads })
    }

    /// Takes what was seen anew, and what a good pose is.
    pub(super) fn look_anew(&mut self, frames: &[Vec<Observation>], objective: Objective) -> Result<()> {
        self.objective = objective;
        for thread in &mut self.threads {
            let cpus = thread.get_mut().unwrap_or_else(PoisonError::into_inner);
            cpus.iter_mut().zip(frames).try_for_each(|(cpu, observations)| cpu.observe(observations))?;
        }
        Ok(())
    }

    /// Shares rows of `width` values and their results among the threads.
    fn share(
        &self,
        rows: &[f32],
        width: usize,
        results: &mut [f32],
        score: impl Fn(&mut [Cpu], &[f32], &mut [f32]) -> Result<()> + Sync,
    ) -> Result<()> {
        let each = results.len().div_ceil(self.threads.len()).max(1);
        let shares = rows.par_chunks(each * width).zip(results.par_chunks_mut(each)).zip(&self.threads);
        shares.try_for_each(|((rows, results), thread)| {
            score(&mut thread.lock().unwrap_or_else(PoisonError::into_inner), rows, results)
        })
    }

    /// Fitness of poses in one frame, less what it costs to be held so.
    pub(super) fn poses(&self, frame: usize, dofs: usize, rows: &[f32], results: &mut [f32]) -> Result<()> {
        self.share(rows, dofs, results, |cpus, rows, results| {
            cpus[frame].fitness(rows, &self.objective, results)?;
            let mut poses = rows.chunks_exact(dofs).zip(results);
            poses.try_for_each(|(pose, fitness)| {
                *fitness = weighed(&self.body, self.posture, *fitness, pose)?;
                Ok(())
            })
        })
    }

    /// Mean fitness over the frames of rows of proportions and poses, less what unusual proportions cost.
    pub(super) fn people(&self, body: &Body, dofs: usize, rows: &[f32], results: &mut [f32]) -> Result<()> {
        let (frames, tall) = (self.frame_count(), stature(body)?);
        self.share(rows, Proportions::COUNT + frames * dofs, results, |cpus, rows, results| {
            for (row, result) in rows.chunks_exact(Proportions::COUNT + frames * dofs).zip(results) {
                let (factors, poses) = row.split_at(Proportions::COUNT);
                let proportions = proportions(factors);
                let poses = poses.chunks_exact(dofs).map(Ok);
                *result = self.person(cpus, &proportions.apply(body), poses, oddness(&proportions), tall)?;
            }
            Ok(())
        })
    }

    /// Mean fitness over the frames of rows of shapes, less what unusual ones cost; the poses follow.
    pub(super) fn shapes(&self, body: &Body, poses: &[Following], rows: &[f32], results: &mut [f32]) -> Result<()> {
        let tall = stature(body)?;
        self.share(rows, Shape::COUNT, results, |cpus, rows, results| {
            for (row, result) in rows.chunks_exact(Shape::COUNT).zip(results) {
                let shape = Shape::from_row(row);
                let stretched = shape.apply(body);
                let poses = poses.iter().map(|pose| pose.with(&stretched));
                *result = self.person(cpus, &stretched, poses, shape.oddness(), tall)?;
            }
            Ok(())
        })
    }

    /// Mean fitness over the frames of a body with a pose in each, less what it costs to be held so, to be so odd and of another stature than
    /// `tall`, mm.
    fn person<P: AsRef<[f32]>>(
        &self,
        cpus: &mut [Cpu],
        body: &Body,
        poses: impl Iterator<Item = Result<P>>,
        oddness: f64,
        tall: f64,
    ) -> Result<f32> {
        let (frames, posture) = (cpus.len() as f64, Posture::of(body));
        let mut sum = 0.0;
        for (cpu, pose) in cpus.iter_mut().zip(poses) {
            let (mut fitness, pose) = ([0.0], pose?);
            cpu.set_body(body)?;
            cpu.fitness(pose.as_ref(), &self.objective, &mut fitness)?;
            sum += f64::from(weighed(body, posture, fitness[0], pose.as_ref())?);
        }
        let stature = (stature(body)? / tall - 1.0) / STATURE;
        Ok((sum / frames - PRIOR * oddness - PRIOR * stature * stature) as f32)
    }

    /// What `work` makes of every frame with its evaluator; frames are shared among the threads.
    pub(super) fn each_frame<T: Send>(&self, work: impl Fn(usize, &mut Cpu) -> Result<T> + Sync) -> Result<Vec<T>> {
        let count = self.frame_count();
        // A thread's evaluators are locked once for all its frames: whoever helps while it waits takes those of another.
        let shares = self.threads.par_iter().enumerate().map(|(first, thread)| {
            let mut cpus = thread.lock().unwrap_or_else(PoisonError::into_inner);
            let frames = (first..count).step_by(self.threads.len());
            frames.map(|frame| Ok((frame, work(frame, &mut cpus[frame])?))).collect::<Result<Vec<_>>>()
        });
        let mut done: Vec<(usize, T)> = shares.collect::<Result<Vec<_>>>()?.into_iter().flatten().collect();
        done.sort_by_key(|(frame, _)| *frame);
        Ok(done.into_iter().map(|(_, made)| made).collect())
    }

    fn frame_count(&self) -> usize {
        self.with_first(|cpus| cpus.len())
    }

    pub(super) fn set_body(&mut self, body: &Body) -> Result<()> {
        (self.body, self.posture) = (body.clone(), Posture::of(body));
        for thread in &mut self.threads {
            let cpus = thread.get_mut().unwrap_or_else(PoisonError::into_inner);
            cpus.iter_mut().try_for_each(|cpu| cpu.set_body(body))?;
        }
        Ok(())
    }

    fn with_first<T>(&self, look: impl FnOnce(&mut Vec<Cpu>) -> T) -> T {
        look(&mut self.threads[0].lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Coverage of each view by one pose a frame.
    pub(super) fn coverage(&self, poses: &[Vec<f32>]) -> Result<Vec<Coverage>> {
        self.with_first(|cpus| {
            let views = cpus.first().map_or(0, Evaluator::view_count);
            let mut sums = vec![[0.0; 3]; views];
            for (cpu, pose) in cpus.iter_mut().zip(poses) {
                let mut components = vec![Components::default(); views];
                cpu.components(pose, &mut components)?;
                for (sum, view) in sums.iter_mut().zip(components) {
                    for (sum, count) in sum.iter_mut().zip([view.overlap, view.area_obs, view.area_model]) {
                        *sum += f64::from(count);
                    }
                }
            }
            Ok(sums.into_iter().map(|[o, s, d]| Coverage { seen: o / s, drawn: o / d }).collect())
        })
    }

    pub(super) fn mean_fitness(&self, poses: &[Vec<f32>]) -> Result<f32> {
        self.with_first(|cpus| {
            let mut sum = 0.0;
            for (cpu, pose) in cpus.iter_mut().zip(poses) {
                let mut fitness = [0.0];
                cpu.fitness(pose, &self.objective, &mut fitness)?;
                sum += fitness[0];
            }
            Ok(sum / poses.len().max(1) as f32)
        })
    }
}

/// A fitness less what it costs a body to be held so.
fn weighed(body: &Body, posture: Posture, fitness: f32, pose: &[f32]) -> Result<f32> {
    let pose: Vec<f64> = pose.iter().map(|value| f64::from(*value)).collect();
    Ok(posture.weighed(fitness, &body.world_from_bones(&pose)?))
}

/// How high the crown is above the ankles of a person who stands upright, mm.
pub(super) fn stature(body: &Body) -> Result<f64> {
    let joints = body.joint_positions(&body.world_from_bones(&vec![0.0; body.dof_count()])?);
    let level = |name: &str| -> Result<f64> {
        let at = body.joint_index(name);
        Ok(joints[at.with_context(|| format!("the body has no {name}, expected the joints of the default body"))?].z)
    };
    Ok(level("head_top")? - level("left_ankle")?)
}
