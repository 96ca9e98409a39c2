//! The reference: the simplest code that is obviously right. It draws each candidate pixel by pixel from the definitions
//! in `docs/RASTER.md`, in exact integers, and counts. Every other backend is held to its numbers.

use std::sync::Arc;

use anyhow::{Result, ensure};

use crate::body::{Body, Mesh};
use crate::features::evidence::code;
use crate::features::{Evidence, Observation, Segmentation, Segments};
use crate::geometry::Camera;

use super::batch::{check_batch, check_observations};
use super::components::Components;
use super::evaluator::{Evaluator, check_evidence_batch, check_segment_batch};
use super::evidence::{best_sums, evidence_of};
use super::mesh_projection::{MeshProjector, bound_to_its_body};
use super::mesh_raster::draw_mesh;
use super::projection::Projector;
use super::raster::{CandidateImage, draw_quads};
use super::segments::{SegmentSums, segments_of};

/// The simplest evaluator, of the flat or of the mesh model.
#[derive(Clone, Debug)]
pub struct Reference {
    model: DrawnModel,
    observations: Vec<Observation>,
    /// One a view; none without evidence.
    best_evidence: Option<Arc<[u32]>>,
}

#[derive(Clone, Debug)]
enum DrawnModel {
    Flat { projector: Projector, labels: Vec<u8> },
    Mesh(MeshProjector),
}

impl Reference {
    /// The flat model of a body, for its cameras at working size.
    pub fn new(body: &Body, cameras: &[Camera]) -> Self {
        let projector = Projector::new(body, cameras);
        let labels = body.parts.iter().map(|part| part.label).collect();
        Self::of(DrawnModel::Flat { projector, labels }, cameras)
    }

    /// The mesh model of a body, for its cameras at working size; `mesh` is bound to this body.
    ///
    /// # Errors
    /// When the mesh is bound to another number of bones.
    pub fn of_mesh(body: &Body, mesh: Mesh, cameras: &[Camera]) -> Result<Self> {
        Ok(Self::of(DrawnModel::Mesh(MeshProjector::new(body, mesh, cameras)?), cameras))
    }

    fn of(model: DrawnModel, cameras: &[Camera]) -> Self {
        let observations = cameras.iter().map(|camera| Observation::empty(camera.size[0], camera.size[1])).collect();
        Self { model, observations, best_evidence: None }
    }

    fn projector(&self) -> &Projector {
        match &self.model {
            DrawnModel::Flat { projector, .. } => projector,
            DrawnModel::Mesh(mesh) => &mesh.projector,
        }
    }

    /// Draws one pose into one view.
    pub fn draw(&self, pose: &[f32], view: usize) -> CandidateImage {
        let [width, height] = self.projector().cameras[view].size;
        match &self.model {
            DrawnModel::Flat { projector, labels } => draw_quads(&projector.quads(pose, view), labels, width, height),
            DrawnModel::Mesh(mesh) => draw_mesh(&mesh.vertices(pose, view), mesh.mesh(), width, height),
        }
    }
}

/// Compares a drawn candidate with an observation of the same size; what it ignores does not count.
pub fn compare(image: &CandidateImage, observation: &Observation) -> Components {
    let mut sums = Components::default();
    for (at, (&drawn, &seen)) in image.bytes.iter().zip(&observation.bytes).enumerate() {
        if observation.ignores(at) {
            continue;
        }
        let is_seen = seen & Observation::SILHOUETTE != 0;
        sums.area_obs += u32::from(is_seen);
        sums.area_model += u32::from(drawn != 0);
        sums.overlap += u32::from(is_seen && drawn != 0);
        if drawn & 0x80 != 0 {
            sums.edges += 1;
            sums.proximity += u32::from(seen & Observation::PROXIMITY);
        }
    }
    sums
}

impl Evaluator for Reference {
    fn name(&self) -> &'static str {
        "reference"
    }

    fn variant(&self) -> &'static str {
        "exact"
    }

    fn view_count(&self) -> usize {
        self.projector().view_count()
    }

    fn dof_count(&self) -> usize {
        self.projector().dof_count()
    }

    fn set_body(&mut self, body: &Body) -> Result<()> {
        let DrawnModel::Flat { projector, labels } = &mut self.model else { return Err(bound_to_its_body()) };
        projector.set_body(body)?;
        *labels = body.parts.iter().map(|part| part.label).collect();
        Ok(())
    }

    fn observe(&mut self, observations: &[Observation]) -> Result<()> {
        check_observations(observations, self.projector().cameras.iter().map(|camera| camera.size))?;
        segments_of(observations)?;
        evidence_of(observations)?;
        self.best_evidence = best_sums(observations);
        self.observations = observations.to_vec();
        Ok(())
    }

    fn components(&mut self, poses: &[f32], components: &mut [Components]) -> Result<()> {
        let views = self.view_count();
        check_batch(poses, self.dof_count(), components.len(), views)?;
        for (pose, row) in poses.chunks_exact(self.dof_count()).zip(components.chunks_exact_mut(views)) {
            for (view, sums) in row.iter_mut().enumerate() {
                *sums = compare(&self.draw(pose, view), &self.observations[view]);
            }
        }
        Ok(())
    }

    fn segments(&self) -> Option<&Arc<Segments>> {
        Some(self.observations.first()?.segmentation.as_ref()?.segments())
    }

    fn segment_sums(&mut self, poses: &[f32], sums: &mut [SegmentSums]) -> Result<()> {
        let a_pose = check_segment_batch(self, poses, sums.len())?;
        let views = self.view_count();
        for (pose, row) in poses.chunks_exact(self.dof_count()).zip(sums.chunks_exact_mut(a_pose)) {
            for (view, sums) in row.chunks_exact_mut(a_pose / views).enumerate() {
                let observation = &self.observations[view];
                if let Some(segmentation) = &observation.segmentation {
                    let image = counted(self.draw(pose, view), observation);
                    compare_segments(&image, &observation.bytes, segmentation, sums);
                }
            }
        }
        Ok(())
    }

    fn best_evidence(&self) -> Option<&[u32]> {
        self.best_evidence.as_deref()
    }

    fn evidence_sums(&mut self, poses: &[f32], sums: &mut [i32]) -> Result<()> {
        check_evidence_batch(self, poses, sums.len())?;
        let rows = sums.chunks_exact_mut(self.view_count());
        for (pose, row) in poses.chunks_exact(self.dof_count()).zip(rows) {
            for (view, sum) in row.iter_mut().enumerate() {
                let observation = &self.observations[view];
                if let Some(evidence) = &observation.evidence {
                    *sum = evidence_under(&counted(self.draw(pose, view), observation), evidence);
                }
            }
        }
        Ok(())
    }

    fn drawn(&mut self, pose: &[f32], view: usize) -> Result<Option<CandidateImage>> {
        check_batch(pose, self.dof_count(), 1, 1)?;
        ensure!(view < self.view_count(), "there are {} views, and view {view} was asked for", self.view_count());
        Ok(Some(self.draw(pose, view)))
    }
}

/// What is drawn where an observation does not ignore it.
fn counted(mut image: CandidateImage, observation: &Observation) -> CandidateImage {
    for (at, byte) in image.bytes.iter_mut().enumerate() {
        if observation.ignores(at) {
            *byte = 0;
        }
    }
    image
}

/// Counts a drawn candidate segment by segment, beside the packed bytes and the segments of an observation: a pixel is of the segment
/// that its label belongs to.
fn compare_segments(image: &CandidateImage, packed: &[u8], seen: &Segmentation, sums: &mut [SegmentSums]) {
    sums.fill(SegmentSums::default());
    for ((byte, &observed), packed) in image.bytes.iter().zip(seen.numbers()).zip(packed) {
        let drawn = seen.segments().number(byte & 0x7f);
        for (number, sums) in (1..).zip(&mut *sums) {
            sums.area_obs += u32::from(observed == number);
            sums.area_model += u32::from(drawn == number);
            sums.overlap += u32::from(observed == number && drawn == number);
            if drawn == number && byte & 0x80 != 0 {
                sums.edges += 1;
                sums.proximity += u32::from(packed & Observation::PROXIMITY);
            }
        }
    }
}

/// Sums the evidence of the pixels of a drawn candidate: of each that of the class of the part that shows there.
fn evidence_under(image: &CandidateImage, seen: &Evidence) -> i32 {
    let drawn = image.bytes.iter().zip(seen.words()).filter(|(byte, _)| **byte != 0);
    let value = |(byte, &word): (&u8, &u32)| {
        let class = seen.classes().of_label(byte & 0x7f);
        code(word, usize::from(class)) as i32 - Evidence::NEUTRAL as i32
    };
    drawn.map(value).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::PartQuad;
    use crate::features::{PartClasses, Segment};

    /// A part with the given corners in pixels, at a depth.
    fn part(corners: [[f64; 2]; 4], depth_squared: f32) -> PartQuad {
        PartQuad { corners: corners.map(|c| c.map(|v| (v * 256.0).round() as i32)), depth_squared, drawn: true }
    }

    #[test]
    fn a_pixel_is_of_the_segment_of_the_part_that_shows_there() {
        let segment = |name: &str, label, weight| Segment { name: name.into(), labels: vec![label], weight };
        let segments = Arc::new(Segments::new(vec![segment("near", 2, 0.5), segment("far", 1, 0.5)]).unwrap());
        // A bar behind another one, as above: the near one's border is the near one's, over the far one's fill too.
        let far = part([[0.0, 2.0], [7.0, 2.0], [7.0, 4.0], [0.0, 4.0]], 9.0);
        let near = part([[2.0, 0.0], [5.0, 0.0], [5.0, 5.0], [2.0, 5.0]], 1.0);
        let image = draw_quads(&[far, near], &[1, 2], 8, 6);
        let numbers = [[0, 0, 1, 1, 1, 1, 0, 0], [2, 2, 1, 1, 1, 2, 2, 2]];
        let numbers = (0..6).flat_map(|y| numbers[usize::from((2..5).contains(&y))]).collect();
        let mut sums = [SegmentSums::default(); 2];
        // Proximity is the column, whatever the silhouette. The near one's border: columns 2 and 5 of six rows, 3 and 4 of two. The far
        // one's: columns 0, 1, 6 and 7 of two rows, 0 and 7 of the one between.
        let packed: Vec<u8> = (0..48).map(|at| (at % 8) | ((at % 2) << 7)).collect();
        let segmentation = Segmentation::new(segments, 8, 6, numbers).unwrap();
        compare_segments(&image, &packed, &segmentation, &mut sums);
        let near = SegmentSums { area_obs: 21, area_model: 24, overlap: 21, edges: 16, proximity: 6 * 7 + 2 * 7 };
        let far = SegmentSums { area_obs: 15, area_model: 12, overlap: 12, edges: 10, proximity: 2 * (1 + 6 + 7) + 7 };
        assert_eq!(sums, [near, far]);
        // Together they are the candidate's own.
        let mut observation = Observation::empty(8, 6);
        observation.bytes = packed;
        let Components { edges, proximity, .. } = compare(&image, &observation);
        assert_eq!((edges, proximity), (sums[0].edges + sums[1].edges, sums[0].proximity + sums[1].proximity));
    }

    #[test]
    fn a_pixel_s_evidence_is_that_of_the_part_that_shows_there() {
        let classes = Arc::new(PartClasses::new([(1, 0), (2, 1)]).unwrap());
        // The bars above: the near one has 24 pixels and the far one 12 beside it. Where nothing is drawn anything may be.
        let far = part([[0.0, 2.0], [7.0, 2.0], [7.0, 4.0], [0.0, 4.0]], 9.0);
        let near = part([[2.0, 0.0], [5.0, 0.0], [5.0, 5.0], [2.0, 5.0]], 1.0);
        let image = draw_quads(&[far, near], &[1, 2], 8, 6);
        let word = |byte: &u8| match byte & 0x7f {
            0 => 0x0e,
            1 => 0x09,
            _ => 0x3e,
        };
        let mut words: Vec<u32> = image.bytes.iter().map(word).collect();
        let evidence = |words: &[u32]| Evidence::new(Arc::clone(&classes), 8, 6, words.to_vec()).unwrap();
        assert_eq!(evidence_under(&image, &evidence(&words)), 12 * (9 - 7) + 24 * (3 - 7));
        words[3] += 0x20;
        assert_eq!(evidence_under(&image, &evidence(&words)), 12 * (9 - 7) + 24 * (3 - 7) + 2);
    }
}
