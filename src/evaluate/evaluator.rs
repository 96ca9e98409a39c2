//! What every backend does: poses in, components and fitness out.

use std::sync::Arc;

use anyhow::{Result, bail};

use super::batch::check_batch;
use super::components::Components;
use super::device_evaluator::DeviceEvaluator;
use super::evidence::no_evidence;
use super::mesh_projection::bound_to_its_body;
use super::objective::{AreaSums, Objective};
use super::raster::CandidateImage;
use super::segments::{SegmentSums, no_segments};
use super::view_counts::ViewCounts;
use crate::body::Body;
use crate::features::{HeldFrame, Observation, PartClasses, SeenFrame, Segments};
use crate::gpu::{Device, DevicePass};

/// Scores candidate poses against the observations of one frame.
///
/// A pose is a row of [`crate::body::Body::dof_count`] single-precision values (mm, radians) in state-vector order; a
/// batch is such rows one after the other.
pub trait Evaluator: Send {
    /// Its name as `--backend` takes it.
    fn name(&self) -> &'static str;

    /// How it does it on this machine: `avx512`, `avx2`, `portable`, …
    fn variant(&self) -> &'static str;

    /// The number of views.
    fn view_count(&self) -> usize;

    /// The length of a pose.
    fn dof_count(&self) -> usize;

    /// Exchanges the body for another one of as many bones, parts and degrees of freedom; what was observed stays.
    ///
    /// # Errors
    /// When their numbers differ, or what is drawn belongs to its body: a mesh is bound to it.
    fn set_body(&mut self, _body: &Body) -> Result<()> {
        Err(bound_to_its_body())
    }

    /// Takes the observations of a frame, one a view, in the order of the cameras.
    ///
    /// # Errors
    /// When there are not as many as views, or one's size is not its camera's; when some tell body parts apart or
    /// carry evidence and others do not.
    fn observe(&mut self, observations: &[Observation]) -> Result<()>;

    /// The device that it takes observations from where they were made and lie ([`Self::observe_held`]); none where they must come from
    /// the host.
    fn holder(&self) -> Option<&Device> {
        None
    }

    /// Takes the observations of a frame that its device made and holds. The frame is to be kept until something was scored.
    ///
    /// # Errors
    /// When it takes none, there are not as many as views, one's size is not its camera's, or the device fails.
    fn observe_held(&mut self, _frame: &HeldFrame) -> Result<()> {
        bail!("the backend {} takes observations from the host, and was given what a device holds", self.name())
    }

    /// Takes a frame's observations, wherever they are.
    ///
    /// # Errors
    /// As [`Self::observe`] or [`Self::observe_held`].
    fn observe_seen(&mut self, seen: SeenFrame<'_>) -> Result<()> {
        match seen {
            SeenFrame::Whole(observations) => self.observe(observations),
            SeenFrame::Held(frame) => self.observe_held(frame),
        }
    }

    /// The components of every candidate in every view: `components[candidate * views + view]`.
    ///
    /// # Errors
    /// When the slices' lengths do not fit each other, or the device fails.
    fn components(&mut self, poses: &[f32], components: &mut [Components]) -> Result<()>;

    /// The segments that silhouettes are compared by, those of the newest observations; none where silhouettes are whole.
    fn segments(&self) -> Option<&Arc<Segments>> {
        None
    }

    /// The sums of every candidate in every view and segment: `sums[(candidate * views + view) * segments + segment]`.
    ///
    /// # Errors
    /// As [`Self::components`]; also when there are no segments.
    fn segment_sums(&mut self, _poses: &[f32], _sums: &mut [SegmentSums]) -> Result<()> {
        Err(no_segments())
    }

    /// The most evidence that anything drawn could have in each view of the newest observations; none where they carry none.
    fn best_evidence(&self) -> Option<&[u32]> {
        None
    }

    /// The evidence of every candidate in every view (METHOD A6): `sums[candidate * views + view]`.
    ///
    /// # Errors
    /// As [`Self::components`]; also when the observations carry none.
    fn evidence_sums(&mut self, _poses: &[f32], _sums: &mut [i32]) -> Result<()> {
        Err(no_evidence())
    }

    /// The codes of single pixels of evidence that its device made of what it holds, a word each; a pixel is a view and its place in the
    /// picture's rows. Something of the frame was scored before.
    ///
    /// # Errors
    /// When there is none, a pixel is in no picture, or the device fails.
    fn evidence_at(&mut self, _pixels: &[[usize; 2]]) -> Result<Vec<u32>> {
        Err(no_evidence())
    }

    /// The classes of that.
    fn evidence_classes(&self) -> Option<&PartClasses> {
        None
    }

    /// What an objective is told of one pose, one a view.
    ///
    /// # Errors
    /// As [`Self::components`]; also when the objective weighs evidence and the observations carry none.
    fn view_counts(&mut self, pose: &[f32], objective: &Objective) -> Result<Vec<ViewCounts>> {
        let mut components = vec![Components::default(); self.view_count()];
        self.components(pose, &mut components)?;
        if !objective.weighs_evidence() {
            return Ok(ViewCounts::all(components, None));
        }
        let mut sums = vec![0; components.len()];
        self.evidence_sums(pose, &mut sums)?;
        let best = self.best_evidence().ok_or_else(no_evidence)?;
        Ok(ViewCounts::all(components, Some((sums, best))))
    }

    /// One pose in one view as this evaluator itself draws it; none where it keeps no picture.
    ///
    /// # Errors
    /// When the pose has another length, there is no such view, or the device fails.
    fn drawn(&mut self, _pose: &[f32], _view: usize) -> Result<Option<CandidateImage>> {
        Ok(None)
    }

    /// The fitness of every candidate, in [0, 1].
    ///
    /// # Errors
    /// As [`Self::components`]; also when the objective weighs evidence and the observations carry none.
    fn fitness(&mut self, poses: &[f32], objective: &Objective, fitness: &mut [f32]) -> Result<()> {
        let views = self.view_count();
        let mut components = vec![Components::default(); fitness.len() * views];
        self.components(poses, &mut components)?;
        if objective.weighs_evidence() {
            let mut sums = vec![0; components.len()];
            self.evidence_sums(poses, &mut sums)?;
            let best = self.best_evidence().ok_or_else(no_evidence)?;
            objective.score(views, &components, AreaSums::Evidence(best, &sums), fitness);
            return Ok(());
        }
        let Some(segments) = self.segments().cloned() else {
            objective.score(views, &components, AreaSums::Whole, fitness);
            return Ok(());
        };
        let mut sums = vec![SegmentSums::default(); components.len() * segments.as_slice().len()];
        self.segment_sums(poses, &mut sums)?;
        objective.score(views, &components, AreaSums::Segments(&segments, &sums), fitness);
        Ok(())
    }

    /// The evaluator as a search on its device records it, where it works on one.
    fn on_device(&mut self) -> Option<&mut dyn DeviceEvaluator> {
        None
    }

    /// From now on measures, or no longer, the passes it runs on a device, which takes time of its own.
    ///
    /// # Errors
    /// When the device fails.
    fn measure_passes(&mut self, _measured: bool) -> Result<()> {
        Ok(())
    }

    /// The passes that ran on a device since the last call, in order; none where nothing is measured or nothing ran there.
    fn device_passes(&mut self) -> Vec<DevicePass> {
        Vec::new()
    }

    /// How a candidate's picture is kept in memory; none where that is not told.
    fn footprint(&self) -> Option<Footprint> {
        None
    }
}

/// How the picture of a candidate in a view is kept in memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Width and height of the piece that is worked on at once, pixels.
    pub tile: [u32; 2],
    /// Memory written for a pixel of it, bytes.
    pub bytes_per_pixel: f64,
}

/// Holds `poses` to `results` sums of segments: how many a pose has.
pub(crate) fn check_segment_batch(evaluator: &dyn Evaluator, poses: &[f32], results: usize) -> Result<usize> {
    let segments = evaluator.segments().ok_or_else(no_segments)?;
    let a_pose = evaluator.view_count() * segments.as_slice().len();
    check_batch(poses, evaluator.dof_count(), results, a_pose)?;
    Ok(a_pose)
}

/// Holds `poses` to `results` sums of evidence, and the best of each view.
pub(crate) fn check_evidence_batch<'a>(
    evaluator: &'a dyn Evaluator,
    poses: &[f32],
    results: usize,
) -> Result<&'a [u32]> {
    let best = evaluator.best_evidence().ok_or_else(no_evidence)?;
    check_batch(poses, evaluator.dof_count(), results, evaluator.view_count())?;
    Ok(best)
}
