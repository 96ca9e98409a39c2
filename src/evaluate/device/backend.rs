//! The evaluator on a Vulkan device, whichever way candidates are drawn: uploads, recorded runs, segments, the objective, and what
//! a search on the device records.

use std::sync::Arc;

use anyhow::{Result, ensure};

use super::evidence::DeviceEvidence;
use super::handover::Handovers;
use super::host_buffers::{HostBuffers, HostCounts};
use super::rasteriser::Rasteriser;
use super::resources::Resources;
use super::runs::{Asked, Runs};
use super::scene::DeviceScene;
use super::segments::DeviceSegments;
use super::summed::Summed;
use super::workspace::Workspace;
use crate::body::Body;
use crate::evaluate::batch::check_batch;
use crate::evaluate::besides::Besides;
use crate::evaluate::components::Components;
use crate::evaluate::device_evaluator::{DeviceEvaluator, Scoring};
use crate::evaluate::evaluator::{Evaluator, Footprint, check_segment_batch};
use crate::evaluate::evidence::{evidence_of, no_evidence};
use crate::evaluate::objective::{AreaSums, Objective};
use crate::evaluate::raster::CandidateImage;
use crate::evaluate::segments::{SegmentSums, segments_of};
use crate::evaluate::view_counts::ViewCounts;
use crate::features::{ColourTables, HeldFrame, Observation, PartClasses, SeenFrame, Segments};
use crate::gpu::{Buffer, Device, DeviceFacts, DevicePass, OutOfMemory, PassTiming, Recorder, Recording, Timing};

/// An evaluator on a Vulkan device that draws by `R`.
#[derive(Debug)]
pub struct DeviceBackend<R> {
    pub(super) resources: Resources,
    pub(super) rasteriser: R,
    runs: Runs,
    /// Brings observations that the device itself made.
    handovers: Handovers,
    /// Whether a search has recorded itself with these segments and this memory, and whether the newest observations have others
    /// or have outgrown it since.
    is_recorded: bool,
    is_outgrown: bool,
}

impl<R> DeviceBackend<R> {
    /// The device it works on.
    pub fn facts(&self) -> &DeviceFacts {
        self.resources.scene.device.facts()
    }

    /// Has every evaluation from now on timed by stage ([`Self::timings`]).
    pub fn time_stages(&mut self, timing: Timing) {
        self.runs.time_stages(timing);
    }

    /// The times of the last evaluation's passes.
    ///
    /// # Errors
    /// When the device fails.
    pub fn timings(&self) -> Result<Vec<PassTiming>> {
        self.runs.timings()
    }
}

#[allow(private_bounds, reason = "the ways to draw are the house's own")]
impl<R: Rasteriser> DeviceBackend<R> {
    /// For a scene, drawn as `rasteriser` makes it.
    pub(super) fn with(scene: DeviceScene, rasteriser: impl FnOnce(&DeviceScene) -> Result<R>) -> Result<Self> {
        let mut rasteriser = rasteriser(&scene)?;
        let resources = Resources::new(scene)?;
        rasteriser.set_workspace(&resources.scene, &resources.workspace)?;
        let upload = record_upload(&resources, &rasteriser)?;
        let handovers = Handovers::default();
        Ok(Self { resources, rasteriser, runs: Runs::new(upload), handovers, is_recorded: false, is_outgrown: false })
    }

    /// Records anew from now on: what is drawn is drawn otherwise.
    pub(super) fn forget_runs(&mut self) {
        self.runs.clear();
        self.is_outgrown |= self.is_recorded;
    }

    /// Host to host: the poses, all stages, fitness or sums. One recording, or with the comparison on the host one a batch.
    fn record_run(&self, asked: Asked, candidates: u32) -> Result<Vec<Recording>> {
        let Resources { scene, workspace, host, .. } = &self.resources;
        let summed = self.resources.summed(asked.besides())?;
        let on_host = self.rasteriser.compares_on_host();
        let mut recorder = scene.device.recorder(self.runs.timing())?;
        host.record_poses(&mut recorder, (scene, workspace), candidates)?;
        let mut recorded = Vec::new();
        for share in self.resources.shares(candidates, self.rasteriser.batch(workspace))? {
            if on_host && share.first > 0 {
                let next = scene.device.recorder(self.runs.timing())?;
                recorded.push(std::mem::replace(&mut recorder, next));
            }
            self.rasteriser.record_host_share(&mut recorder, &self.resources, summed, share)?;
        }
        match asked {
            Asked::Fitness(objective) if !on_host => {
                recorder.run(self.resources.scoring(&objective, candidates)?.dispatch)?;
                host.record_fitness(&mut recorder, candidates)?;
            }
            _ => {
                host.record_sums(&mut recorder, (scene, workspace), candidates)?;
                match summed {
                    Summed::Nothing => (),
                    Summed::Segments(segments, _) => segments.record_readback(&mut recorder)?,
                    Summed::Evidence(evidence) => evidence.record_readback(&mut recorder)?,
                }
            }
        }
        recorded.push(recorder);
        recorded.into_iter().map(Recorder::finish).collect()
    }

    /// Room for runs of so many candidates.
    fn make_room(&mut self, candidates: u32) -> Result<()> {
        let Resources { scene, workspace, host, segments, evidence } = &mut self.resources;
        if candidates > workspace.candidates {
            // Recordings hold the old memory; without them it is free before the new one is taken.
            self.runs.clear();
            *host = HostBuffers::new(scene, candidates)?;
            self.rasteriser.reserve(scene, candidates)?;
            // The workspace last: it takes what is left.
            *workspace = Workspace::new(&scene.device, scene.counts, candidates)?;
            self.rasteriser.set_workspace(scene, workspace)?;
            segments.as_mut().map_or(Ok(()), |segments| segments.reserve(scene, candidates))?;
            evidence.as_mut().map_or(Ok(()), |evidence| evidence.reserve(scene, candidates))?;
        }
        Ok(())
    }

    /// Takes the memory that the rasteriser asks for, if it does; whether it did.
    pub(super) fn refit(&mut self) -> Result<bool> {
        let is_outgrown = self.rasteriser.is_outgrown();
        if is_outgrown {
            self.runs.clear();
            self.rasteriser.refit(&self.resources)?;
        }
        Ok(is_outgrown)
    }

    /// Compares by these segments from now on; by whole silhouettes without.
    fn set_segments(&mut self, segments: Option<&Arc<Segments>>) -> Result<()> {
        if self.segments() == segments {
            return Ok(());
        }
        // Recordings hold the old ones.
        self.runs.clear();
        let Resources { scene, workspace, segments: own, .. } = &mut self.resources;
        *own = segments.map(|segments| DeviceSegments::new(scene, segments, workspace.candidates)).transpose()?;
        self.rasteriser.set_segments(scene, workspace, own.as_ref())?;
        self.runs.set_upload(record_upload(&self.resources, &self.rasteriser)?);
        self.is_outgrown = self.is_recorded;
        Ok(())
    }

    /// Has the evidence of these classes from now on.
    fn set_evidence(&mut self, classes: Option<&PartClasses>) -> Result<()> {
        let count = classes.map(PartClasses::count);
        match (&mut self.resources.evidence, count) {
            (None, None) => return Ok(()),
            (Some(evidence), Some(count)) => {
                if evidence.set_classes(count) {
                    self.handovers.clear();
                }
                return Ok(());
            }
            _ => (),
        }
        // As with segments.
        self.runs.clear();
        let Resources { scene, workspace, evidence, .. } = &mut self.resources;
        *evidence = count.map(|count| DeviceEvidence::new(scene, count, workspace.candidates)).transpose()?;
        self.handovers.clear();
        self.rasteriser.set_evidence(scene, workspace, evidence.as_ref())?;
        self.runs.set_upload(record_upload(&self.resources, &self.rasteriser)?);
        self.is_outgrown = self.is_recorded;
        Ok(())
    }

    /// Passes over what observations ignore from now on.
    fn set_ignoring(&mut self) -> Result<()> {
        if self.resources.scene.reserve_ignored()? {
            // Recordings count everything.
            self.runs.clear();
            self.handovers.clear();
            self.runs.set_upload(record_upload(&self.resources, &self.rasteriser)?);
            self.is_outgrown = self.is_recorded;
        }
        Ok(())
    }

    /// Takes observations from the host from now on, or has them handed over on the device.
    fn set_handed(&mut self, is_handed: bool) -> Result<()> {
        self.handovers.leave();
        if self.resources.scene.set_handed(is_handed) {
            // Recordings upload the others.
            self.runs.clear();
            self.runs.set_upload(record_upload(&self.resources, &self.rasteriser)?);
            self.is_outgrown |= self.is_recorded;
        }
        Ok(())
    }

    /// Runs poses through the device. The results then lie in the host's buffers; what the host itself compared comes back.
    fn run(&mut self, poses: &[f32], asked: Asked) -> Result<HostCounts> {
        let candidates = u32::try_from(poses.len() / self.dof_count())?;
        self.make_room(candidates)?;
        self.resources.host.poses_in.write(0, poses)?;
        let key = (candidates, asked);
        if !self.runs.select(key) {
            let mut recorded = self.record_run(asked, candidates);
            // Other runs may hold the memory that it wants.
            if recorded.as_ref().is_err_and(|error| error.is::<OutOfMemory>()) && self.runs.clear() {
                recorded = self.record_run(asked, candidates);
            }
            self.runs.add(key, recorded?);
        }
        let Self { resources, rasteriser, runs, handovers, .. } = self;
        let shares = resources.shares(candidates, rasteriser.batch(&resources.workspace))?;
        let mut counts = HostCounts::default();
        let summed = resources.summed(asked.besides())?;
        runs.run(&resources.scene, handovers, |batch| rasteriser.count(resources, summed, shares[batch], &mut counts))?;
        let again = rasteriser.learn(&resources.scene, candidates)?;
        self.refit()?;
        if again { self.run(poses, asked) } else { Ok(counts) }
    }

    /// A run for what an objective compares, and the components of all views of its poses.
    fn compare(&mut self, poses: &[f32], objective: &Objective) -> Result<(HostCounts, Vec<Components>)> {
        let counts = self.run(poses, Asked::Sums(Besides::of(objective)))?;
        let mut components = vec![Components::default(); poses.len() / self.dof_count() * self.view_count()];
        self.resources.host.read_components(&self.resources.scene, &counts, &mut components)?;
        Ok((counts, components))
    }

    /// The evidence of a finished run, of so many images, and the best of each view.
    fn weigh(&self, counts: &HostCounts, images: usize) -> Result<(Vec<i32>, &[u32])> {
        let mut sums = vec![0; images];
        self.read_evidence(counts, &mut sums)?;
        Ok((sums, self.best_evidence().ok_or_else(no_evidence)?))
    }

    /// The evidence of a finished run.
    fn read_evidence(&self, counts: &HostCounts, sums: &mut [i32]) -> Result<()> {
        self.resources.evidence.as_ref().ok_or_else(no_evidence)?.read(counts, sums)
    }

    /// The sums of the segments of a finished run.
    fn read_segments(&self, counts: &HostCounts, sums: &mut [SegmentSums]) -> Result<()> {
        self.resources.segments.as_ref().map_or(Ok(()), |segments| segments.read(counts, sums))
    }
}

/// The passes that bring everything to the device.
fn record_upload(resources: &Resources, rasteriser: &impl Rasteriser) -> Result<Recording> {
    let mut recorder = resources.scene.device.recorder(Timing::Off)?;
    resources.record_upload(&mut recorder)?;
    rasteriser.record_upload(&mut recorder, resources.scene.is_handed())?;
    recorder.finish()
}

impl<R: Rasteriser> Evaluator for DeviceBackend<R> {
    fn name(&self) -> &'static str {
        R::NAME
    }

    fn variant(&self) -> &'static str {
        self.rasteriser.variant()
    }

    fn view_count(&self) -> usize {
        self.resources.scene.counts.views as usize
    }

    fn dof_count(&self) -> usize {
        self.resources.scene.counts.dofs as usize
    }

    fn set_body(&mut self, body: &Body) -> Result<()> {
        self.rasteriser.check_exchange()?;
        self.resources.scene.set_body(body)?;
        self.runs.outdate_upload();
        Ok(())
    }

    fn observe(&mut self, observations: &[Observation]) -> Result<()> {
        let (segments, classes) = (segments_of(observations)?, evidence_of(observations)?);
        self.set_handed(false)?;
        if observations.iter().any(|view| view.ignored.is_some()) {
            self.set_ignoring()?;
        }
        self.resources.scene.observe(observations)?;
        self.set_segments(segments.as_ref())?;
        self.set_evidence(classes.as_deref())?;
        let Resources { scene, segments, evidence, .. } = &mut self.resources;
        segments.as_mut().map_or(Ok(()), |segments| segments.observe(scene, observations))?;
        evidence.as_mut().map_or(Ok(()), |evidence| evidence.observe(scene, observations))?;
        self.rasteriser.observe(scene, observations, self.is_recorded)?;
        self.runs.outdate_upload();
        let is_refitted = self.refit()?;
        self.is_outgrown |= is_refitted && self.is_recorded;
        Ok(())
    }

    fn holder(&self) -> Option<&Device> {
        (!self.rasteriser.compares_on_host()).then_some(&self.resources.scene.device)
    }

    fn observe_held(&mut self, frame: &HeldFrame) -> Result<()> {
        let name = self.name();
        ensure!(self.holder().is_some(), "the backend {name} compares on the host, and was given what a device holds");
        let views = SeenFrame::Held(frame).views();
        self.set_handed(true)?;
        if views.iter().any(|view| view.is_partly_ignored()) {
            self.set_ignoring()?;
        }
        self.resources.scene.observe_handed(&views)?;
        self.set_segments(None)?;
        let colours = frame.colours();
        self.set_evidence(colours.map(ColourTables::classes).map(AsRef::as_ref))?;
        let Self { resources: Resources { scene, evidence, .. }, rasteriser, handovers, .. } = self;
        if let (Some(evidence), Some(colours)) = (&mut *evidence, colours) {
            evidence.observe_held(scene, frame, colours)?;
        }
        handovers.take(scene, frame, |recorder, views| {
            let Some(evidence) = evidence else { return Ok(()) };
            evidence.record_held(recorder, scene, views)?;
            rasteriser.record_evidence(recorder, scene, evidence)
        })?;
        self.rasteriser.observe_handed(&views, self.is_recorded);
        self.runs.outdate_upload();
        let is_refitted = self.refit()?;
        self.is_outgrown |= is_refitted && self.is_recorded;
        Ok(())
    }

    fn components(&mut self, poses: &[f32], components: &mut [Components]) -> Result<()> {
        check_batch(poses, self.dof_count(), components.len(), self.view_count())?;
        if components.is_empty() {
            return Ok(());
        }
        let counts = self.run(poses, Asked::Sums(Besides::Segments))?;
        self.resources.host.read_components(&self.resources.scene, &counts, components)
    }

    fn view_counts(&mut self, pose: &[f32], objective: &Objective) -> Result<Vec<ViewCounts>> {
        // One run for both kinds of sums: a card takes longer to answer than to draw a pose.
        let views = self.view_count();
        check_batch(pose, self.dof_count(), views, views)?;
        ensure!(!objective.weighs_evidence() || self.resources.evidence.is_some(), no_evidence());
        let (counts, components) = self.compare(pose, objective)?;
        let evidence = objective.weighs_evidence().then(|| self.weigh(&counts, views)).transpose()?;
        Ok(ViewCounts::all(components, evidence))
    }

    fn segments(&self) -> Option<&Arc<Segments>> {
        self.resources.segments.as_ref().map(DeviceSegments::segments)
    }

    fn segment_sums(&mut self, poses: &[f32], sums: &mut [SegmentSums]) -> Result<()> {
        check_segment_batch(self, poses, sums.len())?;
        if sums.is_empty() {
            return Ok(());
        }
        let counts = self.run(poses, Asked::Sums(Besides::SegmentEdges))?;
        self.read_segments(&counts, sums)
    }

    fn best_evidence(&self) -> Option<&[u32]> {
        // What is still to be handed over is not known yet.
        self.resources.evidence.as_ref().filter(|_| !self.handovers.is_due()).and_then(DeviceEvidence::best)
    }

    fn evidence_at(&mut self, pixels: &[[usize; 2]]) -> Result<Vec<u32>> {
        ensure!(!self.handovers.is_due(), "the evidence of pixels was asked for before anything was scored");
        let Resources { scene, evidence, .. } = &mut self.resources;
        evidence.as_mut().ok_or_else(no_evidence)?.at(scene, pixels)
    }

    fn evidence_classes(&self) -> Option<&PartClasses> {
        self.resources.evidence.as_ref().and_then(DeviceEvidence::held_classes)
    }

    fn evidence_sums(&mut self, poses: &[f32], sums: &mut [i32]) -> Result<()> {
        ensure!(self.resources.evidence.is_some(), no_evidence());
        check_batch(poses, self.dof_count(), sums.len(), self.view_count())?;
        if sums.is_empty() {
            return Ok(());
        }
        let counts = self.run(poses, Asked::Sums(Besides::Evidence))?;
        self.read_evidence(&counts, sums)
    }

    fn fitness(&mut self, poses: &[f32], objective: &Objective, fitness: &mut [f32]) -> Result<()> {
        check_batch(poses, self.dof_count(), fitness.len(), 1)?;
        if fitness.is_empty() {
            return Ok(());
        }
        if !self.rasteriser.compares_on_host() {
            self.run(poses, Asked::Fitness(*objective))?;
            return self.resources.host.fitness_out.read(0, fitness);
        }
        let (counts, components) = self.compare(poses, objective)?;
        let views = self.view_count();
        if objective.weighs_evidence() {
            let (sums, best) = self.weigh(&counts, components.len())?;
            objective.score(views, &components, AreaSums::Evidence(best, &sums), fitness);
            return Ok(());
        }
        let segments = self.segments();
        let count = segments.map_or(0, |segments| segments.as_slice().len());
        let mut sums = vec![SegmentSums::default(); components.len() * count];
        self.read_segments(&counts, &mut sums)?;
        let area = segments.map_or(AreaSums::Whole, |segments| AreaSums::Segments(segments, &sums));
        objective.score(views, &components, area, fitness);
        Ok(())
    }

    fn drawn(&mut self, pose: &[f32], view: usize) -> Result<Option<CandidateImage>> {
        let views = self.view_count();
        check_batch(pose, self.dof_count(), 1, 1)?;
        ensure!(view < views, "there are {views} views, and view {view} was asked for");
        self.rasteriser.draw(&self.resources, pose, view)
    }

    fn on_device(&mut self) -> Option<&mut dyn DeviceEvaluator> {
        if self.rasteriser.compares_on_host() { None } else { Some(self) }
    }

    fn measure_passes(&mut self, measured: bool) -> Result<()> {
        self.runs.measure_passes(measured);
        Ok(())
    }

    fn device_passes(&mut self) -> Vec<DevicePass> {
        self.runs.take_passes()
    }

    fn footprint(&self) -> Option<Footprint> {
        Some(self.rasteriser.footprint())
    }
}

impl<R: Rasteriser> DeviceEvaluator for DeviceBackend<R> {
    fn device(&self) -> &Device {
        &self.resources.scene.device
    }

    fn poses(&self) -> &Buffer {
        &self.resources.workspace.poses
    }

    fn fitness(&self) -> &Buffer {
        &self.resources.host.fitness
    }

    fn views(&self) -> usize {
        self.view_count()
    }

    fn sums(&self) -> &Buffer {
        &self.resources.workspace.sums
    }

    fn has_outgrown_its_recording(&self) -> bool {
        self.is_outgrown
    }

    fn is_handed_observations(&self) -> bool {
        self.resources.scene.is_handed()
    }

    fn handover(&mut self) -> Option<&mut Recording> {
        self.handovers.due()
    }

    fn reserve(&mut self, candidates: u32) -> Result<()> {
        (self.is_recorded, self.is_outgrown) = (true, false);
        self.rasteriser.prepare_search(&self.resources.scene);
        self.refit()?;
        self.make_room(candidates)
    }

    fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.resources.record_upload(recorder)?;
        self.rasteriser.record_upload(recorder, self.is_handed_observations())
    }

    fn record_sums(&self, recorder: &mut Recorder, objective: &Objective, candidates: u32) -> Result<()> {
        let summed = self.resources.summed(Besides::of(objective))?;
        for share in self.resources.shares(candidates, self.rasteriser.batch(&self.resources.workspace))? {
            self.rasteriser.record_share(recorder, &self.resources, summed, share)?;
        }
        Ok(())
    }

    fn scoring(&self, objective: &Objective, candidates: u32) -> Result<Scoring<'_>> {
        self.resources.scoring(objective, candidates)
    }
}
