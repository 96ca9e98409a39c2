//! The fast evaluator. It gives the reference's integers.
//!
//! Of the flat model no picture is ever drawn. Rows of a candidate lie in lanes, columns in bits; the comparison is bit operations and bit
//! counts. Up to sixteen candidates are posed at a time, their sixteen parts projected at a time, each image drawn and counted in a few hundred
//! bytes of bit columns. A mesh is drawn into keys of depth and label (`mesh/`). The work is shared by threads that stay; nothing is
//! allocated in an iteration.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod cell;
mod flat;
mod front;
mod group;
mod instruction_set;
mod kernel;
mod mesh;
mod outline;
mod planes;
mod portable;
mod processors;
mod simd;
mod workers;

use std::sync::{Arc, Mutex, PoisonError};

use anyhow::{Result, bail, ensure};

use crate::body::{Body, Mesh};
use crate::features::{Observation, PartClasses, Segments};
use crate::geometry::Camera;

use super::batch::{check_batch, check_observations, check_pictures};
use super::besides::Besides;
use super::components::Components;
use super::evaluator::{Evaluator, Footprint, check_evidence_batch, check_segment_batch};
use super::evidence::{best_sums, evidence_of, no_evidence};
use super::mesh_projection::bound_to_its_body;
use super::objective::{AreaSums, Objective};
use super::projection::Projector;
use super::raster::CandidateImage;
use super::segments::{SegmentSums, segments_of};

use flat::FlatModel;
use front::LANES;
use group::Sums;
use instruction_set::Code;
pub use instruction_set::InstructionSet;
use mesh::MeshModel;
use workers::Workers;

/// The fast evaluator on the processor, of the flat or of the mesh model.
#[derive(Debug)]
pub struct Cpu {
    model: Model,
    set: InstructionSet,
    code: Code,
    workers: Workers,
    /// One a worker; the locks are never contended.
    sums: Vec<Mutex<Sums>>,
    /// Those of the newest observations.
    segments: Option<Arc<Segments>>,
    classes: Option<Arc<PartClasses>>,
    /// The best evidence, one a view.
    best_evidence: Option<Arc<[u32]>>,
}

#[derive(Debug)]
enum Model {
    Flat(FlatModel),
    Mesh(Box<MeshModel>),
}

impl Cpu {
    /// For a body and its cameras at working size, with the best instruction set and as many workers as rayon has: one a processor,
    /// where nobody asked for another number.
    ///
    /// # Errors
    /// As [`Self::with`].
    pub fn new(body: &Body, cameras: &[Camera]) -> Result<Self> {
        Self::with(body, cameras, InstructionSet::best(), rayon::current_num_threads())
    }

    /// With a chosen instruction set and number of workers; the results do not depend on either.
    ///
    /// # Errors
    /// When the processor lacks the instruction set, a picture has no pixel, or a thread cannot be started.
    pub fn with(body: &Body, cameras: &[Camera], set: InstructionSet, workers: usize) -> Result<Self> {
        Self::of(|| Ok(Model::Flat(FlatModel::new(body, cameras, workers))), cameras, set, workers)
    }

    /// The mesh model of a body, with the best instruction set and as many workers as [`Self::new`]; `mesh` is bound to this body.
    ///
    /// # Errors
    /// As [`Self::of_mesh_with`].
    pub fn of_mesh(body: &Body, mesh: Mesh, cameras: &[Camera]) -> Result<Self> {
        Self::of_mesh_with(body, mesh, cameras, InstructionSet::best(), rayon::current_num_threads())
    }

    /// The same with a chosen instruction set and number of workers.
    ///
    /// # Errors
    /// As [`Self::with`]; also when the mesh is bound to another number of bones.
    pub fn of_mesh_with(
        body: &Body,
        mesh: Mesh,
        cameras: &[Camera],
        set: InstructionSet,
        workers: usize,
    ) -> Result<Self> {
        Self::of(|| Ok(Model::Mesh(Box::new(MeshModel::new(body, mesh, cameras, workers)?))), cameras, set, workers)
    }

    fn of(
        model: impl FnOnce() -> Result<Model>,
        cameras: &[Camera],
        set: InstructionSet,
        count: usize,
    ) -> Result<Self> {
        let Some(code) = Code::of(set) else {
            bail!("this processor has no {}: choose another instruction set", set.name());
        };
        ensure!(count > 0, "0 worker threads were asked for, expected at least 1");
        check_pictures(cameras)?;
        let model = model()?;
        let sums = || {
            Mutex::new(Sums {
                components: vec![Components::default(); LANES * cameras.len()],
                segments: Vec::new(),
                evidence: vec![0; LANES * cameras.len()],
            })
        };
        let sums = std::iter::repeat_with(sums).take(count).collect();
        let workers = Workers::new(count)?;
        Ok(Self { model, set, code, workers, sums, segments: None, classes: None, best_evidence: None })
    }

    fn projector(&self) -> &Projector {
        match &self.model {
            Model::Flat(flat) => &flat.projector,
            Model::Mesh(mesh) => mesh.projector(),
        }
    }

    /// Compares by these segments from now on; none for whole silhouettes.
    fn set_segments(&mut self, segments: Option<Arc<Segments>>) {
        if segments == self.segments {
            return;
        }
        let sums = LANES * self.view_count() * segments.as_ref().map_or(0, |segments| segments.as_slice().len());
        for room in &mut self.sums {
            room.get_mut().unwrap_or_else(PoisonError::into_inner).segments = vec![SegmentSums::default(); sums];
        }
        match &mut self.model {
            Model::Flat(flat) => flat.set_segments(segments.as_ref()),
            Model::Mesh(mesh) => mesh.set_segments(segments.as_ref()),
        }
        self.segments = segments;
    }

    /// Weighs evidence by these classes from now on.
    fn set_classes(&mut self, classes: Option<Arc<PartClasses>>) {
        if classes == self.classes {
            return;
        }
        match &mut self.model {
            Model::Flat(flat) => flat.set_classes(classes.as_ref()),
            Model::Mesh(mesh) => mesh.set_classes(classes.as_ref()),
        }
        self.classes = classes;
    }

    /// Evaluates `poses` in groups and hands what is summed of each to `finish` with its share of `results`.
    fn run<T: Send>(
        &mut self,
        (poses, besides): (&[f32], Besides),
        results: &mut [T],
        per_pose: usize,
        finish: impl Fn(&Group<'_>, &mut [T]) + Sync,
    ) -> Result<()> {
        let (dof_count, views) = (self.dof_count(), self.view_count());
        let segments = self.segments.as_ref().map_or(0, |segments| segments.as_slice().len());
        let (model, code, sums) = (&self.model, self.code, &self.sums);
        let count = poses.len() / dof_count;
        let size = group_size(count, sums.len());
        let groups = poses.chunks(size * dof_count).zip(results.chunks_mut(size * per_pose));
        let completed = self.workers.each(groups, |worker, (poses, results)| {
            let mut sums = sums[worker].lock().unwrap_or_else(PoisonError::into_inner);
            match model {
                Model::Flat(flat) => flat.evaluate(code, worker, poses, besides, &mut sums),
                Model::Mesh(mesh) => mesh.evaluate(code, worker, poses, besides, &mut sums),
            }
            let images = poses.len() / dof_count * views;
            let group = Group {
                components: &sums.components[..images],
                segments: &sums.segments[..images * segments],
                evidence: &sums.evidence[..images],
            };
            finish(&group, results);
        });
        check_completed(completed)
    }
}

fn check_completed(is_completed: bool) -> Result<()> {
    ensure!(is_completed, "a worker thread of the cpu evaluator failed; its message stands above");
    Ok(())
}

/// Poses that whoever helps with fewer is not called for: waking takes as long as scoring them.
const FEWEST: usize = 4;

/// How many of so many poses to evaluate at a time, at least 1 and at most as many as there are lanes, so that all workers have nearly
/// the same to do: the generations of most searches are a few groups only.
fn group_size(poses: usize, workers: usize) -> usize {
    let groups = poses.div_ceil(LANES).next_multiple_of(workers).min(poses.div_ceil(FEWEST));
    poses.div_ceil(groups.max(1)).clamp(1, LANES)
}

/// What is summed of up to sixteen candidates.
struct Group<'a> {
    /// `[candidate][view]`.
    components: &'a [Components],
    /// `[candidate][view][segment]`, of this group where [`Besides`] asked for it.
    segments: &'a [SegmentSums],
    /// `[candidate][view]`, likewise.
    evidence: &'a [i32],
}

impl Evaluator for Cpu {
    fn name(&self) -> &'static str {
        "cpu"
    }

    fn variant(&self) -> &'static str {
        self.set.name()
    }

    fn view_count(&self) -> usize {
        self.projector().view_count()
    }

    fn dof_count(&self) -> usize {
        self.projector().dof_count()
    }

    fn set_body(&mut self, body: &Body) -> Result<()> {
        match &mut self.model {
            Model::Flat(flat) => flat.set_body(body)?,
            Model::Mesh(_) => return Err(bound_to_its_body()),
        }
        let (segments, classes) = (self.segments.take(), self.classes.take());
        self.set_segments(segments);
        self.set_classes(classes);
        Ok(())
    }

    fn observe(&mut self, observations: &[Observation]) -> Result<()> {
        check_observations(observations, self.projector().cameras.iter().map(|camera| camera.size))?;
        let (segments, classes) = (segments_of(observations)?, evidence_of(observations)?);
        self.set_segments(segments);
        self.set_classes(classes);
        self.best_evidence = best_sums(observations);
        check_completed(match &mut self.model {
            Model::Flat(flat) => flat.observe(observations, &mut self.workers),
            Model::Mesh(mesh) => mesh.observe(observations, &mut self.workers),
        })
    }

    fn components(&mut self, poses: &[f32], components: &mut [Components]) -> Result<()> {
        let views = self.view_count();
        check_batch(poses, self.dof_count(), components.len(), views)?;
        let what = (poses, Besides::Nothing);
        self.run(what, components, views, |found, results| results.copy_from_slice(found.components))
    }

    fn fitness(&mut self, poses: &[f32], objective: &Objective, fitness: &mut [f32]) -> Result<()> {
        let views = self.view_count();
        check_batch(poses, self.dof_count(), fitness.len(), 1)?;
        ensure!(views > 0, "there are no views, expected at least one camera");
        if objective.weighs_evidence() {
            let best = self.best_evidence.clone().ok_or_else(no_evidence)?;
            return self.run((poses, Besides::Evidence), fitness, 1, |found, results| {
                objective.score(views, found.components, AreaSums::Evidence(&best, found.evidence), results);
            });
        }
        let Some(segments) = self.segments.clone() else {
            return self.run((poses, Besides::Nothing), fitness, 1, |found, results| {
                objective.score(views, found.components, AreaSums::Whole, results);
            });
        };
        self.run((poses, Besides::of(objective)), fitness, 1, |found, results| {
            objective.score(views, found.components, AreaSums::Segments(&segments, found.segments), results);
        })
    }

    fn segments(&self) -> Option<&Arc<Segments>> {
        self.segments.as_ref()
    }

    fn segment_sums(&mut self, poses: &[f32], sums: &mut [SegmentSums]) -> Result<()> {
        let a_pose = check_segment_batch(self, poses, sums.len())?;
        let what = (poses, Besides::SegmentEdges);
        self.run(what, sums, a_pose, |found, results| results.copy_from_slice(found.segments))
    }

    fn best_evidence(&self) -> Option<&[u32]> {
        self.best_evidence.as_deref()
    }

    fn evidence_sums(&mut self, poses: &[f32], sums: &mut [i32]) -> Result<()> {
        check_evidence_batch(self, poses, sums.len())?;
        let (what, views) = ((poses, Besides::Evidence), self.view_count());
        self.run(what, sums, views, |found, results| results.copy_from_slice(found.evidence))
    }

    fn drawn(&mut self, pose: &[f32], view: usize) -> Result<Option<CandidateImage>> {
        check_batch(pose, self.dof_count(), 1, 1)?;
        ensure!(view < self.view_count(), "there are {} views, and view {view} was asked for", self.view_count());
        Ok(match &self.model {
            Model::Flat(_) => None,
            Model::Mesh(mesh) => Some(mesh.drawn(self.code, pose, view)),
        })
    }

    fn footprint(&self) -> Option<Footprint> {
        match self.model {
            // A bit for what is covered and one for what is an edge.
            Model::Flat(_) => {
                Some(Footprint { tile: [planes::CELL_COLUMNS, planes::CELL_ROWS], bytes_per_pixel: 0.25 })
            }
            // What is drawn in is as large as the candidate.
            Model::Mesh(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn workers_have_nearly_the_same_to_do() {
        for (poses, workers, size) in [
            (50, 1, 13),
            (50, 2, 13),
            (50, 3, 9),
            (50, 16, 4),
            (512, 2, 16),
            (300, 4, 15),
            (16, 2, 8),
            (5, 2, 3),
            (3, 8, 3),
            (1, 2, 1),
            (0, 2, 1),
        ] {
            assert_eq!(group_size(poses, workers), size, "{poses} poses, {workers} workers");
        }
        for poses in 0..200 {
            for workers in 1..20 {
                let size = group_size(poses, workers);
                let rounds = poses.div_ceil(size).div_ceil(workers);
                assert!((1..=LANES).contains(&size) && rounds <= poses.div_ceil(LANES).div_ceil(workers).max(1));
            }
        }
    }
}
