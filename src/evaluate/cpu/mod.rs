//! The fast evaluator: no picture is ever drawn. Rows of a candidate lie in lanes, columns in bits; the comparison is bit
//! operations and bit counts. It gives the reference's integers.
//!
//! Sixteen candidates are posed at a time, their sixteen parts projected at a time, each image drawn and counted in a
//! few hundred bytes of bit columns. The work is shared by threads that stay; nothing is allocated in an iteration.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod front;
mod group;
mod instruction_set;
mod kernel;
mod outline;
mod planes;
mod portable;
mod processors;
mod simd;
mod workers;

use std::sync::{Arc, Mutex, PoisonError};

use anyhow::{Result, bail, ensure};

use crate::body::Body;
use crate::features::{Observation, PartClasses, Segments};
use crate::geometry::Camera;

use super::batch::{check_batch, check_observations, check_pictures};
use super::besides::Besides;
use super::components::Components;
use super::evaluator::{Evaluator, Footprint, check_evidence_batch, check_segment_batch};
use super::evidence::{best_sums, evidence_of, no_evidence};
use super::objective::{AreaSums, Objective};
use super::projection::Projector;
use super::rig::Rig;
use super::segments::{SegmentSums, segments_of};

use front::{Front, LANES, QuadChunk};
use group::Scratch;
use instruction_set::Code;
pub use instruction_set::InstructionSet;
use kernel::Canvas;
use planes::Planes;
use workers::Workers;

/// The fast evaluator on the processor.
#[derive(Debug)]
pub struct Cpu {
    projector: Projector,
    planes: Vec<Planes>,
    set: InstructionSet,
    code: Code,
    workers: Workers,
    /// One a worker; the locks are never contended.
    scratch: Vec<Mutex<Scratch>>,
    /// Labels of the parts in the body's order.
    labels: Vec<u8>,
    /// Those of the newest observations.
    segments: Option<Arc<Segments>>,
    classes: Option<Arc<PartClasses>>,
    /// The best evidence, one a view.
    best_evidence: Option<Arc<[u32]>>,
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
        let Some(code) = Code::of(set) else {
            bail!("this processor has no {}: choose another instruction set", set.name());
        };
        ensure!(workers > 0, "0 worker threads were asked for, expected at least 1");
        check_pictures(cameras)?;
        let projector = Projector::new(body, cameras);
        let planes: Vec<Planes> = cameras.iter().map(|camera| Planes::new(camera.size[0], camera.size[1])).collect();
        let most_cells = planes.iter().map(Planes::canvas_cells).max().unwrap_or(0);
        let scratch = (0..workers)
            .map(|_| {
                let front = Front::new(&projector.rig);
                let chunks = front.chunk_count();
                Mutex::new(Scratch {
                    front,
                    quads: vec![QuadChunk::default(); chunks],
                    canvas: Canvas::new(chunks, most_cells, Vec::new()),
                    components: vec![Components::default(); LANES * cameras.len()],
                    segmented: None,
                    segment_sums: Vec::new(),
                    evidence: vec![0; LANES * cameras.len()],
                })
            })
            .collect();
        let labels = body.parts.iter().map(|part| part.label).collect();
        let workers = Workers::new(workers)?;
        Ok(Self {
            projector,
            planes,
            set,
            code,
            workers,
            scratch,
            labels,
            segments: None,
            classes: None,
            best_evidence: None,
        })
    }

    /// Exchanges the body for another one of as many degrees of freedom and parts; what was observed stays.
    ///
    /// # Errors
    /// When their numbers differ.
    pub fn set_body(&mut self, body: &Body) -> Result<()> {
        let rig = Rig::new(body);
        let (old, new) = (&self.projector.rig, &rig);
        ensure!(
            (new.dof_count, new.parts.len()) == (old.dof_count, old.parts.len()),
            "a body of {} degrees of freedom and {} parts cannot take the place of one of {} and {}",
            new.dof_count,
            new.parts.len(),
            old.dof_count,
            old.parts.len()
        );
        for scratch in &mut self.scratch {
            scratch.get_mut().unwrap_or_else(PoisonError::into_inner).front = Front::new(&rig);
        }
        self.projector.rig = rig;
        self.labels = body.parts.iter().map(|part| part.label).collect();
        let (segments, classes) = (self.segments.take(), self.classes.take());
        self.set_segments(segments);
        self.set_classes(classes);
        Ok(())
    }

    /// Compares by these segments from now on; none for whole silhouettes.
    fn set_segments(&mut self, segments: Option<Arc<Segments>>) {
        if segments == self.segments {
            return;
        }
        let numbers: Option<Vec<u8>> =
            segments.as_ref().map(|segments| self.labels.iter().map(|&label| segments.number(label)).collect());
        let count = segments.as_ref().map_or(0, |segments| segments.as_slice().len());
        let cells = self.planes.iter().map(Planes::canvas_cells).max().unwrap_or(0);
        let views = self.planes.len();
        for scratch in &mut self.scratch {
            let scratch = scratch.get_mut().unwrap_or_else(PoisonError::into_inner);
            let chunks = scratch.quads.len();
            scratch.segmented = numbers.clone().map(|numbers| Canvas::new(chunks, cells, numbers));
            scratch.segment_sums = vec![SegmentSums::default(); LANES * views * count];
        }
        self.segments = segments;
    }

    /// Weighs evidence by these classes from now on.
    fn set_classes(&mut self, classes: Option<Arc<PartClasses>>) {
        if classes == self.classes {
            return;
        }
        let of_part = |classes: &Arc<PartClasses>| self.labels.iter().map(|&label| classes.of_label(label)).collect();
        let numbers: Vec<u8> = classes.as_ref().map(of_part).unwrap_or_default();
        for scratch in &mut self.scratch {
            let scratch = scratch.get_mut().unwrap_or_else(PoisonError::into_inner);
            scratch.canvas.set_classes(numbers.clone());
        }
        self.classes = classes;
    }

    /// Evaluates `poses` sixteen at a time and hands what is summed of each group to `finish` with its share of `results`.
    fn run<T: Send>(
        &mut self,
        (poses, besides): (&[f32], Besides),
        results: &mut [T],
        per_pose: usize,
        finish: impl Fn(&Group<'_>, &mut [T]) + Sync,
    ) -> Result<()> {
        let (dof_count, views) = (self.projector.dof_count(), self.planes.len());
        let segments = self.segments.as_ref().map_or(0, |segments| segments.as_slice().len());
        let groups = Mutex::new(poses.chunks(LANES * dof_count).zip(results.chunks_mut(LANES * per_pose)));
        let (projector, planes, code, scratch) = (&self.projector, &self.planes, self.code, &self.scratch);
        let completed = self.workers.run(&|worker| {
            let mut scratch = scratch[worker].lock().unwrap_or_else(PoisonError::into_inner);
            loop {
                let Some((poses, results)) = groups.lock().unwrap_or_else(PoisonError::into_inner).next() else {
                    break;
                };
                code.evaluate_group(projector, planes, poses, besides, &mut scratch);
                let images = poses.len() / dof_count * views;
                let group = Group {
                    components: &scratch.components[..images],
                    segments: &scratch.segment_sums[..images * segments],
                    evidence: &scratch.evidence[..images],
                };
                finish(&group, results);
            }
        });
        ensure!(completed, "a worker thread of the cpu evaluator failed; its message stands above");
        Ok(())
    }
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
        self.planes.len()
    }

    fn dof_count(&self) -> usize {
        self.projector.dof_count()
    }

    fn observe(&mut self, observations: &[Observation]) -> Result<()> {
        check_observations(observations, self.planes.iter().map(|planes| [planes.width, planes.height]))?;
        let (segments, classes) = (segments_of(observations)?, evidence_of(observations)?);
        self.set_segments(segments);
        self.set_classes(classes);
        self.best_evidence = best_sums(observations);
        for (planes, observation) in self.planes.iter_mut().zip(observations) {
            planes.fill(observation);
        }
        Ok(())
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
        self.run((poses, Besides::Segments), fitness, 1, |found, results| {
            objective.score(views, found.components, AreaSums::Segments(&segments, found.segments), results);
        })
    }

    fn segments(&self) -> Option<&Arc<Segments>> {
        self.segments.as_ref()
    }

    fn segment_sums(&mut self, poses: &[f32], sums: &mut [SegmentSums]) -> Result<()> {
        let a_pose = check_segment_batch(self, poses, sums.len())?;
        let what = (poses, Besides::Segments);
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

    fn footprint(&self) -> Option<Footprint> {
        // A bit for what is covered and one for what is an edge.
        Some(Footprint { tile: [planes::CELL_COLUMNS, planes::CELL_ROWS], bytes_per_pixel: 0.25 })
    }
}
