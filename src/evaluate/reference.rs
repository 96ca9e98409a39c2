//! The reference: the simplest code that is obviously right. It draws each candidate pixel by pixel from the definitions
//! in `docs/RASTER.md`, in exact integers, and counts. Every other backend is held to its numbers.

use std::sync::Arc;

use anyhow::{Result, ensure};

use crate::body::{Body, Mesh};
use crate::features::{Observation, Segmentation, Segments};
use crate::geometry::Camera;

use super::batch::{check_batch, check_observations};
use super::segments::{check_segment_batch, segments_of};
use super::{Components, Evaluator, MeshProjector, Objective, PartQuad, Projector, SegmentSums, draw_mesh};

/// The simplest evaluator, of the flat or of the mesh model.
#[derive(Clone, Debug)]
pub struct Reference {
    model: DrawnModel,
    observations: Vec<Observation>,
}

#[derive(Clone, Debug)]
enum DrawnModel {
    Flat { projector: Projector, labels: Vec<u8> },
    Mesh(MeshProjector),
}

/// A drawn candidate in one view: one byte a pixel, bits 0..=6 the label of the visible part (0 = nothing), bit 7 a
/// visible edge (SPEC A6).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CandidateImage {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// Row-major bytes.
    pub bytes: Vec<u8>,
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
        Self { model, observations }
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

/// Draws parts given as snapped corners; `labels` has one label a part.
pub fn draw_quads(quads: &[PartQuad], labels: &[u8], width: u32, height: u32) -> CandidateImage {
    let mut image = CandidateImage { width, height, bytes: vec![0; width as usize * height as usize] };
    let mut farthest_first: Vec<usize> = (0..quads.len()).filter(|&part| quads[part].drawn).collect();
    // A stable sort keeps parts of equal depth in the body's order: the later one is painted over the earlier one.
    farthest_first.sort_by(|&l, &r| quads[r].depth_squared.total_cmp(&quads[l].depth_squared));
    for part in farthest_first {
        // A nearer fill covers what is there, its edges included; then its own border is drawn over everything.
        for_each_fill_pixel(&quads[part].corners, width, height, |pixel| image.bytes[pixel] = labels[part]);
        for_each_border_pixel(&quads[part].corners, width, height, |pixel| {
            image.bytes[pixel] = labels[part] | 0x80;
        });
    }
    image
}

/// Calls `paint` with the index of every pixel whose centre lies in the part: in the pixel's row, at or right of the
/// leftmost crossing of the outline with the line through the row's pixel centres, and left of the rightmost one.
fn for_each_fill_pixel(corners: &[[i32; 2]; 4], width: u32, height: u32, mut paint: impl FnMut(usize)) {
    for y in 0..i64::from(height) {
        let centre_y = 256 * y;
        let crossing_edges: Vec<([i64; 2], [i64; 2])> = (0..4)
            .map(|corner| (corners[corner].map(i64::from), corners[(corner + 1) % 4].map(i64::from)))
            .map(|(p, q)| if p[1] <= q[1] { (p, q) } else { (q, p) })
            .filter(|(top, bottom)| top[1] <= centre_y && centre_y < bottom[1])
            .collect();
        if crossing_edges.is_empty() {
            continue;
        }
        for x in 0..i64::from(width) {
            let centre_x = 256 * x;
            // The crossing is at top.x + dx (centre_y - top.y) / dy; both sides times dy, which is positive.
            let is_at_or_right_of = |&(top, bottom): &([i64; 2], [i64; 2])| {
                (centre_x - top[0]) * (bottom[1] - top[1]) >= (bottom[0] - top[0]) * (centre_y - top[1])
            };
            if crossing_edges.iter().any(is_at_or_right_of) && !crossing_edges.iter().all(is_at_or_right_of) {
                paint((y * i64::from(width) + x) as usize);
            }
        }
    }
}

/// Calls `paint` with the index of every pixel of the part's four border lines.
fn for_each_border_pixel(corners: &[[i32; 2]; 4], width: u32, height: u32, mut paint: impl FnMut(usize)) {
    for corner in 0..4 {
        let ends = [corners[corner], corners[(corner + 1) % 4]];
        for_each_line_pixel(ends, width, height, |pixel, _| paint(pixel));
    }
}

/// Calls `paint` with the index of every pixel of the line between two snapped corners that lies in the picture, and with how
/// far along it is from the first end (0) to the second (1), in steps of the longer side.
pub(super) fn for_each_line_pixel(ends: [[i32; 2]; 2], width: u32, height: u32, mut paint: impl FnMut(usize, f64)) {
    let [p, q] = ends.map(|end| end.map(|c| i64::from(c + 128).div_euclid(256)));
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    let mut paint_inside = |x: i64, y: i64, step: i64, steps: i64| {
        if (0..i64::from(width)).contains(&x) && (0..i64::from(height)).contains(&y) {
            let along = if steps == 0 { 0.0 } else { step as f64 / steps as f64 };
            paint((y * i64::from(width) + x) as usize, along);
        }
    };
    if dx.abs() >= dy.abs() {
        for x in p[0].min(q[0])..=p[0].max(q[0]) {
            paint_inside(x, p[1] + nearest(dy * (x - p[0]), dx), x - p[0], dx);
        }
    } else {
        for y in p[1].min(q[1])..=p[1].max(q[1]) {
            paint_inside(p[0] + nearest(dx * (y - p[1]), dy), y, y - p[1], dy);
        }
    }
}

/// `numerator / denominator` to the nearest integer, a tie to the larger; 0/0 is 0.
fn nearest(numerator: i64, denominator: i64) -> i64 {
    match denominator.signum() {
        0 => 0,
        sign => (2 * numerator * sign + denominator.abs()).div_euclid(2 * denominator.abs()),
    }
}

/// Compares a drawn candidate with an observation of the same size.
pub fn compare(image: &CandidateImage, observation: &Observation) -> Components {
    let mut sums = Components::default();
    for (&drawn, &seen) in image.bytes.iter().zip(&observation.bytes) {
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

    fn observe(&mut self, observations: &[Observation]) -> Result<()> {
        check_observations(observations, self.projector().cameras.iter().map(|camera| camera.size))?;
        segments_of(observations)?;
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
                if let Some(segmentation) = &self.observations[view].segmentation {
                    compare_segments(&self.draw(pose, view), segmentation, sums);
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

    fn fitness(&mut self, poses: &[f32], objective: &Objective, fitness: &mut [f32]) -> Result<()> {
        let views = self.view_count();
        let mut components = vec![Components::default(); fitness.len() * views];
        self.components(poses, &mut components)?;
        let rows = components.chunks_exact(views);
        match self.segments().cloned() {
            None => fitness.iter_mut().zip(rows).for_each(|(value, row)| *value = objective.fitness(row)),
            Some(segments) => {
                let a_pose = views * segments.as_slice().len();
                let mut sums = vec![SegmentSums::default(); fitness.len() * a_pose];
                self.segment_sums(poses, &mut sums)?;
                for ((value, row), sums) in fitness.iter_mut().zip(rows).zip(sums.chunks_exact(a_pose)) {
                    *value = objective.segmented_fitness(row, &segments, sums);
                }
            }
        }
        Ok(())
    }
}

/// Counts a drawn candidate segment by segment: a pixel is of the segment that its label belongs to.
fn compare_segments(image: &CandidateImage, seen: &Segmentation, sums: &mut [SegmentSums]) {
    sums.fill(SegmentSums::default());
    for (byte, &observed) in image.bytes.iter().zip(seen.numbers()) {
        let drawn = seen.segments().number(byte & 0x7f);
        for (number, sums) in (1..).zip(&mut *sums) {
            sums.area_obs += u32::from(observed == number);
            sums.area_model += u32::from(drawn == number);
            sums.overlap += u32::from(observed == number && drawn == number);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::Segment;

    /// A part with the given corners in pixels, at a depth.
    fn part(corners: [[f64; 2]; 4], depth_squared: f32) -> PartQuad {
        PartQuad { corners: corners.map(|c| c.map(|v| (v * 256.0).round() as i32)), depth_squared, drawn: true }
    }

    fn rows(image: &CandidateImage) -> Vec<String> {
        let symbol = |byte: &u8| match byte {
            0 => '.',
            byte if byte & 0x80 != 0 => '#',
            _ => 'o',
        };
        image.bytes.chunks(image.width as usize).map(|row| row.iter().map(symbol).collect()).collect()
    }

    #[test]
    fn a_square_covers_the_pixels_whose_centres_it_holds() {
        let square = part([[1.0, 1.0], [5.0, 1.0], [5.0, 4.0], [1.0, 4.0]], 1.0);
        let image = draw_quads(&[square], &[9], 8, 6);
        assert_eq!(rows(&image), ["........", ".#####..", ".#ooo#..", ".#ooo#..", ".#####..", "........"]);
        // Fill alone: left and top included, right and bottom excluded, centred on the border's outline.
        let mut filled = Vec::new();
        for_each_fill_pixel(&square.corners, 8, 6, |pixel| filled.push(pixel));
        let expected: Vec<usize> = (1..4).flat_map(|y| (1..5).map(move |x| y * 8 + x)).collect();
        assert_eq!(filled, expected);
    }

    #[test]
    fn a_nearer_fill_hides_a_border_and_a_nearer_border_does_not_hide_a_fill() {
        let far = part([[0.0, 2.0], [7.0, 2.0], [7.0, 4.0], [0.0, 4.0]], 9.0);
        let near = part([[2.0, 0.0], [5.0, 0.0], [5.0, 5.0], [2.0, 5.0]], 1.0);
        let expected = ["..####..", "..#oo#..", "###oo###", "#o#oo#o#", "###oo###", "..####.."];
        assert_eq!(rows(&draw_quads(&[far, near], &[1, 2], 8, 6)), expected);
        assert_eq!(rows(&draw_quads(&[near, far], &[2, 1], 8, 6)), expected, "the order of parts plays no role");
        // At equal depth the later one is nearer.
        let level = PartQuad { depth_squared: 1.0, ..far };
        assert_eq!(rows(&draw_quads(&[near, level], &[2, 1], 8, 6))[3], "#oooooo#");
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
        compare_segments(&image, &Segmentation::new(segments, 8, 6, numbers).unwrap(), &mut sums);
        assert_eq!(sums[0], SegmentSums { area_obs: 21, area_model: 24, overlap: 21 });
        assert_eq!(sums[1], SegmentSums { area_obs: 15, area_model: 12, overlap: 12 });
    }

    #[test]
    fn ties_of_a_line_go_to_the_larger_coordinate() {
        // Two columns a row: half-way columns belong to the lower row.
        let mut drawn = Vec::new();
        let line = [[0, 0], [4 * 256, 2 * 256], [4 * 256, 2 * 256], [4 * 256, 2 * 256]];
        for_each_border_pixel(&line, 5, 3, |pixel| drawn.push((pixel % 5, pixel / 5)));
        drawn.sort_unstable();
        drawn.dedup();
        assert_eq!(drawn, [(0, 0), (1, 1), (2, 1), (3, 2), (4, 2)]);
    }
}
