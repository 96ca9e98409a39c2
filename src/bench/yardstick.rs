//! Evaluators as one writes them first, kept to measure the fast one against: a byte depth buffer over the whole
//! picture, byte row spans inside the bounding box with a comparison the compiler vectorises, and what the thesis's CUDA stage did,
//! column by column. Edges are followed from row to row by additions. All give the reference's integers.

use std::ops::Range;

use anyhow::{Result, ensure};

use crate::body::Body;
use crate::evaluate::{Components, Evaluator, Footprint, PartQuad, Projector};
use crate::features::Observation;
use crate::files::choices;
use crate::geometry::Camera;

choices! {
    /// What one writes first.
    "yardstick" pub enum YardstickKind => draw: Draw {
        /// Byte depth buffer over the whole picture.
        "zbuffer" ZBuffer => zbuffer,
        /// Byte row spans inside the bounding box.
        "rowspan" RowSpan => row_span,
        /// A column after the other, parts from the nearest on, counted while they are painted (METHOD A9).
        "columns" Columns => columns,
    }
}

/// Draws a candidate's parts in a view of a size, over the picture, and compares it.
type Draw = fn(&[PartQuad], [usize; 2], &Observation, &mut [u8]) -> Components;

/// One of them, on threads that it starts anew each time.
#[derive(Debug)]
pub(super) struct Yardstick {
    projector: Projector,
    sizes: Vec<[usize; 2]>,
    kind: YardstickKind,
    threads: usize,
    observations: Vec<Observation>,
}

impl Yardstick {
    /// For a body and its cameras at working size.
    pub(super) fn new(body: &Body, cameras: &[Camera], kind: YardstickKind, threads: usize) -> Self {
        let sizes = cameras.iter().map(|camera| camera.size.map(|side| side as usize)).collect();
        let projector = Projector::new(body, cameras);
        Self { projector, sizes, kind, threads: threads.max(1), observations: Vec::new() }
    }
}

impl Evaluator for Yardstick {
    fn name(&self) -> &'static str {
        "cpu"
    }

    fn variant(&self) -> &'static str {
        self.kind.name()
    }

    fn view_count(&self) -> usize {
        self.sizes.len()
    }

    fn dof_count(&self) -> usize {
        self.projector.dof_count()
    }

    fn observe(&mut self, observations: &[Observation]) -> Result<()> {
        let sizes = observations.iter().map(|seen| [seen.width as usize, seen.height as usize]);
        ensure!(sizes.eq(self.sizes.iter().copied()), "the observations are not of the cameras' sizes");
        self.observations = observations.to_vec();
        Ok(())
    }

    fn components(&mut self, poses: &[f32], components: &mut [Components]) -> Result<()> {
        let (dofs, views) = (self.dof_count(), self.view_count());
        ensure!(
            poses.len().is_multiple_of(dofs) && poses.len() / dofs * views == components.len(),
            "{} components were asked for {} values of poses",
            components.len(),
            poses.len()
        );
        ensure!(self.observations.len() == views, "nothing was observed yet");
        let share = (poses.len() / dofs).div_ceil(self.threads).max(1);
        let this = &*self;
        std::thread::scope(|scope| {
            for (poses, out) in poses.chunks(share * dofs).zip(components.chunks_mut(share * views)) {
                scope.spawn(move || this.run(poses, out));
            }
        });
        Ok(())
    }

    fn footprint(&self) -> Option<Footprint> {
        let [width, height] = self.sizes.first()?.map(|side| side as u32);
        Some(Footprint { tile: [width, height], bytes_per_pixel: 1.0 })
    }
}

impl Yardstick {
    /// A thread's share of the candidates.
    fn run(&self, poses: &[f32], out: &mut [Components]) {
        let most = self.sizes.iter().map(|[w, h]| w * h).max().unwrap_or(0);
        let mut picture = vec![0_u8; most];
        for (pose, out) in poses.chunks_exact(self.dof_count()).zip(out.chunks_exact_mut(self.sizes.len())) {
            for (view, sums) in out.iter_mut().enumerate() {
                let quads = self.projector.quads(pose, view);
                *sums = self.kind.draw()(&quads, self.sizes[view], &self.observations[view], &mut picture);
            }
        }
    }
}

/// Parts numbered from 1 = farthest, by their distance.
fn ranks(quads: &[PartQuad]) -> Vec<(usize, u8)> {
    let mut order: Vec<usize> = (0..quads.len()).filter(|&p| quads[p].drawn).collect();
    order.sort_by(|&l, &r| quads[r].depth_squared.total_cmp(&quads[l].depth_squared));
    order.into_iter().enumerate().map(|(rank, part)| (part, rank as u8 + 1)).collect()
}

/// One byte a pixel: 2 x rank + edge, the larger wins. The whole picture is cleared and compared.
fn zbuffer(
    quads: &[PartQuad],
    [width, height]: [usize; 2],
    observation: &Observation,
    picture: &mut [u8],
) -> Components {
    let picture = &mut picture[..width * height];
    picture.fill(0);
    for (part, rank) in ranks(quads) {
        rows(&quads[part], width, height, |y, from, to| {
            for pixel in &mut picture[y * width + from..y * width + to] {
                *pixel = (*pixel).max(2 * rank);
            }
        });
        border(&quads[part], width, height, |x, y| {
            let pixel = &mut picture[y * width + x];
            *pixel = (*pixel).max(2 * rank + 1);
        });
    }
    let mut sums = Components::default();
    for (&drawn, &seen) in picture.iter().zip(&observation.bytes) {
        if seen & 0x80 != 0 {
            sums.area_obs += 1;
        }
        if drawn != 0 {
            sums.area_model += 1;
            if seen & 0x80 != 0 {
                sums.overlap += 1;
            }
        }
        if drawn & 1 != 0 {
            sums.edges += 1;
            sums.proximity += u32::from(seen & 0x7f);
        }
    }
    sums
}

/// Far to near, spans filled whole; only the bounding box is cleared and compared, row by row without branches.
fn row_span(
    quads: &[PartQuad],
    [width, height]: [usize; 2],
    observation: &Observation,
    picture: &mut [u8],
) -> Components {
    let mut sums = Components { area_obs: observation.area(), ..Components::default() };
    let (mut left, mut right, mut top, mut bottom) = (width as i32, 0, height as i32, 0);
    for corner in quads.iter().filter(|q| q.drawn).flat_map(|q| q.corners) {
        let [x, y] = corner.map(|c| (c + 128) >> 8);
        (left, right) = (left.min(x), right.max(x + 1));
        (top, bottom) = (top.min(y), bottom.max(y + 1));
    }
    let (left, right) = (left.max(0) as usize, right.clamp(0, width as i32) as usize);
    let (top, bottom) = (top.max(0) as usize, bottom.clamp(0, height as i32) as usize);
    if left >= right || top >= bottom {
        return sums;
    }
    for y in top..bottom {
        picture[y * width + left..y * width + right].fill(0);
    }
    for (part, _) in ranks(quads) {
        rows(&quads[part], width, height, |y, from, to| picture[y * width + from..y * width + to].fill(1));
        border(&quads[part], width, height, |x, y| picture[y * width + x] = 3);
    }
    for y in top..bottom {
        let (drawn, seen) = (&picture[y * width + left..y * width + right], &observation.bytes[y * width + left..]);
        let (mut area, mut overlap, mut edges, mut proximity) = (0_u32, 0_u32, 0_u32, 0_u32);
        for (&drawn, &seen) in drawn.iter().zip(seen) {
            let (filled, edge) = (drawn & 1, drawn >> 1);
            area += u32::from(filled);
            overlap += u32::from(filled & (seen >> 7));
            edges += u32::from(edge);
            proximity += u32::from(edge.wrapping_neg() & seen & 0x7f);
        }
        sums.area_model += area;
        sums.overlap += overlap;
        sums.edges += edges;
        sums.proximity += proximity;
    }
    sums
}

/// A part as its columns are painted.
struct Upright {
    /// The columns that it fills any pixel of.
    across: Range<usize>,
    /// Its first row, and the pixels of this one and those below, from and to before.
    top: usize,
    spans: Vec<[usize; 2]>,
    /// Its border, column and row, by columns.
    border: Vec<[usize; 2]>,
    /// Those of the columns so far.
    passed: usize,
}

impl Upright {
    fn new(quad: &PartQuad, width: usize, height: usize) -> Self {
        let (mut top, mut spans, mut edge) = (height, Vec::new(), Vec::new());
        let mut across = width..0;
        rows(quad, width, height, |y, from, to| {
            top = top.min(y);
            across = across.start.min(from)..across.end.max(to);
            // Where a quad is no pixel wide it has no span.
            spans.resize(y - top, [0; 2]);
            spans.push([from, to]);
        });
        border(quad, width, height, |x, y| edge.push([x, y]));
        edge.sort_unstable();
        edge.dedup();
        Self { across, top, spans, border: edge, passed: 0 }
    }

    /// Its border in a column, each after the one before.
    fn border_of(&mut self, x: usize) -> &[[usize; 2]] {
        let first = self.passed;
        self.passed += self.border[first..].iter().take_while(|pixel| pixel[0] == x).count();
        &self.border[first..self.passed]
    }
}

/// Column by column, near to far: a pixel is painted once, and counted then.
fn columns(
    quads: &[PartQuad],
    [width, height]: [usize; 2],
    observation: &Observation,
    picture: &mut [u8],
) -> Components {
    let mut sums = Components { area_obs: observation.area(), ..Components::default() };
    let nearest_first = ranks(quads).into_iter().rev();
    let mut parts: Vec<Upright> = nearest_first.map(|(part, _)| Upright::new(&quads[part], width, height)).collect();
    let column = &mut picture[..height];
    for x in 0..width {
        column.fill(0);
        for part in &mut parts {
            for &[_, y] in part.border_of(x) {
                if column[y] == 0 {
                    column[y] = 1;
                    let seen = observation.bytes[y * width + x];
                    sums.area_model += 1;
                    sums.overlap += u32::from(seen >> 7);
                    sums.edges += 1;
                    sums.proximity += u32::from(seen & 0x7f);
                }
            }
            let spans: &[_] = if part.across.contains(&x) { &part.spans } else { &[] };
            for (y, _) in (part.top..).zip(spans).filter(|(_, span)| (span[0]..span[1]).contains(&x)) {
                if column[y] == 0 {
                    column[y] = 1;
                    sums.area_model += 1;
                    sums.overlap += u32::from(observation.bytes[y * width + x] >> 7);
                }
            }
        }
    }
    sums
}

/// floor((numerator + n change) / divisor) for n = 0, 1 and so on, by additions once the first is divided.
struct Quotients {
    value: i64,
    rest: i64,
    step: i64,
    rest_step: i64,
    divisor: i64,
}

impl Quotients {
    /// For a divisor above 0.
    fn new(numerator: i64, change: i64, divisor: i64) -> Self {
        Self {
            value: numerator.div_euclid(divisor),
            rest: numerator.rem_euclid(divisor),
            step: change.div_euclid(divisor),
            rest_step: change.rem_euclid(divisor),
            divisor,
        }
    }
}

impl Iterator for Quotients {
    type Item = i64;

    fn next(&mut self) -> Option<i64> {
        let value = self.value;
        let carries = self.rest + self.rest_step >= self.divisor;
        self.rest += self.rest_step - if carries { self.divisor } else { 0 };
        self.value += self.step + i64::from(carries);
        Some(value)
    }
}

/// The filled pixels of a quad, a row at a time.
fn rows(quad: &PartQuad, width: usize, height: usize, mut row: impl FnMut(usize, usize, usize)) {
    // The first row whose middle is not above a corner.
    let row_of = |y: i64| ((y + 255) >> 8).clamp(0, height as i64);
    let ys = quad.corners.map(|c| row_of(i64::from(c[1])));
    let (top, bottom) = (ys.into_iter().min().unwrap_or(0), ys.into_iter().max().unwrap_or(0));
    let mut edges: [_; 4] = std::array::from_fn(|corner| {
        let (p, q) = (quad.corners[corner].map(i64::from), quad.corners[(corner + 1) % 4].map(i64::from));
        let (p, q) = if p[1] <= q[1] { (p, q) } else { (q, p) };
        let (first, dx, dy) = (row_of(p[1]), q[0] - p[0], q[1] - p[1]);
        let divisor = 256 * dy.max(1);
        (first..row_of(q[1]), Quotients::new(p[0] * dy + dx * (256 * first - p[1]) + divisor - 1, 256 * dx, divisor))
    });
    for y in top..bottom {
        let (mut from, mut to) = (i64::MAX, i64::MIN);
        for (rows, bounds) in &mut edges {
            if rows.contains(&y)
                && let Some(x) = bounds.next()
            {
                (from, to) = (from.min(x), to.max(x));
            }
        }
        let (from, to) = (from.max(0), to.min(width as i64));
        if from < to {
            row(y as usize, from as usize, to as usize);
        }
    }
}

/// The border pixels of a quad.
fn border(quad: &PartQuad, width: usize, height: usize, mut paint: impl FnMut(usize, usize)) {
    let corners = quad.corners.map(|c| c.map(|v| i64::from((v + 128) >> 8)));
    let (w, h) = (width as i64, height as i64);
    for corner in 0..4 {
        let (p, q) = (corners[corner], corners[(corner + 1) % 4]);
        let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
        if dx.abs() >= dy.abs() {
            let (p, dx, dy) = if dx < 0 { (q, -dx, -dy) } else { (p, dx, dy) };
            let first = p[0].max(0);
            let across = Quotients::new(2 * dy * (first - p[0]) + dx, 2 * dy, (2 * dx).max(1));
            for (x, moved) in (first..=(p[0] + dx).min(w - 1)).zip(across) {
                let y = p[1] + moved;
                if (0..h).contains(&y) {
                    paint(x as usize, y as usize);
                }
            }
        } else {
            let (p, dx, dy) = if dy < 0 { (q, -dx, -dy) } else { (p, dx, dy) };
            let first = p[1].max(0);
            let across = Quotients::new(2 * dx * (first - p[1]) + dy, 2 * dx, 2 * dy);
            for (y, moved) in (first..=(p[1] + dy).min(h - 1)).zip(across) {
                let x = p[0] + moved;
                if (0..w).contains(&x) {
                    paint(x as usize, y as usize);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

    use super::super::{Scene, swarm};
    use super::*;
    use crate::evaluate::Reference;

    #[test]
    fn quotients_are_those_of_division() {
        for (numerator, change, divisor) in
            [(0_i64, 0_i64, 1_i64), (-7, 3, 5), (7, -3, 5), (1 << 40, -(1 << 33) - 1, 511), (4, 12, 4)]
        {
            let expected = (0..50).map(|n| (numerator + n * change).div_euclid(divisor));
            assert!(Quotients::new(numerator, change, divisor).take(50).eq(expected), "{numerator} {change} {divisor}");
        }
    }

    #[test]
    fn yardsticks_count_as_the_reference_does() {
        for size in [[480, 270], [97, 300], [1, 40], [640, 33]] {
            let Scene { body, cameras, pose, observations } = Scene::new(size, 0.6 * f64::from(size[1])).unwrap();
            // Calm, and so wild that parts lie across the borders and beyond.
            let mut poses = swarm(&body, &pose, 20);
            for (row, pose) in poses.chunks_exact_mut(body.dof_count()).enumerate().skip(8) {
                pose.iter_mut().for_each(|value| *value *= 1.0 + row as f32);
            }
            let mut expected = vec![Components::default(); 20 * cameras.len()];
            let mut reference = Reference::new(&body, &cameras);
            reference.observe(&observations).unwrap();
            reference.components(&poses, &mut expected).unwrap();
            assert!(expected.iter().filter(|sums| sums.area_model > 0).count() > cameras.len());
            for kind in YardstickKind::ALL {
                let mut yardstick = Yardstick::new(&body, &cameras, kind, 2);
                yardstick.observe(&observations).unwrap();
                let mut found = vec![Components::default(); expected.len()];
                yardstick.components(&poses, &mut found).unwrap();
                assert_eq!(found, expected, "{kind:?} {size:?}");
            }
        }
    }
}
