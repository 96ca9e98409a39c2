//! What the actor takes away from the light: shadows on himself and a soft one on the floor.

use glam::{DVec2, DVec3, Vec2};

use super::shaders::{SHADOW_CELL, SHADOW_SIDE};
use super::solid::{BoundingBall, Ray};
use super::triangle::Primitive;

/// Width of a bin in the plane across the light, mm: for solids, and for a mesh of many small triangles.
const BIN: f64 = 45.0;
const MESH_BIN: f64 = 12.0;

/// Solids and triangles sorted by where they stand in the light, to ask quickly whether a point is in their shadow.
pub(super) struct LightBins<'a> {
    primitives: &'a [Primitive],
    /// Towards the light, unit length.
    to_light: DVec3,
    pub(super) across: [DVec3; 2],
    pub(super) origin: DVec2,
    /// mm
    pub(super) width: f64,
    pub(super) size: [usize; 2],
    pub(super) bins: Vec<Vec<u32>>,
    /// Of every entry of the bins, what must be known before it is worth a ray.
    boxes: Vec<Vec<ShadowBox>>,
}

/// Where a primitive may shade anything: across the light, and how far up towards it, mm.
#[derive(Clone, Copy)]
struct ShadowBox {
    low: Vec2,
    high: Vec2,
    top: f32,
}

/// More than single precision loses in a room, mm.
const SLACK: f32 = 0.05;

impl ShadowBox {
    fn holds(&self, flat: Vec2, height: f32) -> bool {
        self.low.x <= flat.x
            && flat.x <= self.high.x
            && self.low.y <= flat.y
            && flat.y <= self.high.y
            && height <= self.top
    }
}

impl<'a> LightBins<'a> {
    /// Sorts them for parallel light from the direction `to_light`.
    pub(super) fn new(primitives: &'a [Primitive], to_light: DVec3) -> Self {
        let across = to_light.any_orthonormal_pair();
        let across = [across.0, across.1];
        let flat = |p: DVec3| DVec2::new(p.dot(across[0]), p.dot(across[1]));
        let bounds = |primitive: &Primitive| {
            let [(a, radius_a), (b, radius_b)] = primitive.bounding_balls();
            let top = (a.dot(to_light) + radius_a).max(b.dot(to_light) + radius_b);
            let (a, b) = (flat(a), flat(b));
            ((a - radius_a).min(b - radius_b), (a + radius_a).max(b + radius_b), top)
        };
        let boxes: Vec<(DVec2, DVec2, f64)> = primitives.iter().map(bounds).collect();
        let origin = boxes.iter().map(|b| b.0).reduce(DVec2::min).unwrap_or_default();
        let end = boxes.iter().map(|b| b.1).reduce(DVec2::max).unwrap_or_default();
        let width = if matches!(primitives.first(), Some(Primitive::Triangle(_))) { MESH_BIN } else { BIN };
        let size = ((end - origin) / width).to_array().map(|extent| extent as usize + 1);
        let mut bins = vec![Vec::new(); size[0] * size[1]];
        let mut sorted = vec![Vec::new(); bins.len()];
        for (index, (low, high, top)) in boxes.iter().enumerate() {
            let shades =
                ShadowBox { low: low.as_vec2() - SLACK, high: high.as_vec2() + SLACK, top: *top as f32 + SLACK };
            let (first, last) = ((*low - origin) / width, (*high - origin) / width);
            for y in first.y as usize..=(last.y as usize).min(size[1] - 1) {
                for x in first.x as usize..=(last.x as usize).min(size[0] - 1) {
                    bins[y * size[0] + x].push(index as u32);
                    sorted[y * size[0] + x].push(shades);
                }
            }
        }
        Self { primitives, to_light, across, origin, width, size, bins, boxes: sorted }
    }

    /// Whether something stands between the point and the light.
    pub(super) fn in_shadow(&self, point: DVec3) -> bool {
        let flat = DVec2::new(point.dot(self.across[0]), point.dot(self.across[1]));
        let at = (flat - self.origin) / self.width;
        if at.x < 0.0 || at.y < 0.0 || at.x >= self.size[0] as f64 || at.y >= self.size[1] as f64 {
            return false;
        }
        let ray = Ray { origin: point, direction: self.to_light };
        let place = at.y as usize * self.size[0] + at.x as usize;
        let (flat, height) = (flat.as_vec2(), point.dot(self.to_light) as f32);
        let mut worth =
            self.bins[place].iter().zip(&self.boxes[place]).filter(|(_, shades)| shades.holds(flat, height));
        worth.any(|(&index, _)| self.primitives[index as usize].first_hit(&ray).is_some())
    }
}

/// How much of the light reaches the floor round the actor: a grid of factors, 1 in the open.
pub(super) struct FloorShadow {
    origin: DVec2,
    side: usize,
    /// (key light, light from all around) as fractions of the unshaded, row-major.
    cells: Vec<[f32; 2]>,
}

/// Width of a cell on the floor, mm, and cells a side.
const CELL: f64 = SHADOW_CELL as f64;
const SIDE: usize = SHADOW_SIDE as usize;

impl FloorShadow {
    /// The shadow of what is in `bins`, in a square of the floor round `middle`; `balls` are pairs whose hulls stand for it
    /// where light comes from all around. A lamp's width is `softness` blurs.
    pub(super) fn new(bins: &LightBins, balls: &[[BoundingBall; 2]], middle: DVec2, softness: u32) -> Self {
        let origin = middle - 0.5 * CELL * SIDE as f64;
        let at = |index: usize| origin + DVec2::new((index % SIDE) as f64 + 0.5, (index / SIDE) as f64 + 0.5) * CELL;
        let mut key: Vec<f32> =
            (0..SIDE * SIDE).map(|i| if bins.in_shadow(at(i).extend(0.0)) { 0.0 } else { 1.0 }).collect();
        // A lamp of some width: three box blurs are nearly a bell.
        for _ in 0..softness {
            key = blurred(&blurred(&key, 1, SIDE), SIDE, 1);
        }
        let cells = key
            .iter()
            .enumerate()
            .map(|(index, &key)| {
                let point = at(index).extend(0.0);
                let hidden: f64 = balls.iter().map(|pair| hidden_sky(*pair, point)).sum();
                // The grid ends softly, so that its border cannot be seen.
                let rim = (at(index) - middle).abs().max_element() / (0.5 * CELL * SIDE as f64);
                let fade = ((1.0 - rim) * 6.0).clamp(0.0, 1.0);
                [1.0 - (1.0 - key) * fade as f32, (1.0 - (hidden * fade).min(0.75)) as f32]
            })
            .collect();
        Self { origin, side: SIDE, cells }
    }

    /// Fractions of (key light, light from all around) at a point of the floor.
    pub(super) fn at(&self, x: f64, y: f64) -> [f32; 2] {
        let p = (DVec2::new(x, y) - self.origin) / CELL - 0.5;
        let limit = (self.side - 1) as f64;
        if !(p.x >= 0.0 && p.y >= 0.0 && p.x < limit && p.y < limit) {
            return [1.0, 1.0];
        }
        let (i, j) = (p.x as usize, p.y as usize);
        let (fx, fy) = ((p.x - i as f64) as f32, (p.y - j as f64) as f32);
        let row = |j: usize, k: usize| {
            let (a, b) = (self.cells[j * self.side + i][k], self.cells[j * self.side + i + 1][k]);
            a + (b - a) * fx
        };
        [0, 1].map(|k| row(j, k) + (row(j + 1, k) - row(j, k)) * fy)
    }
}

/// The fraction of the sky that a solid hides from a point of the floor, taking its two balls for it.
fn hidden_sky([first, second]: [BoundingBall; 2], point: DVec3) -> f64 {
    // A ball of radius r at distance d hides (r/d)^2 of the sky, weighted by the sine of its height.
    let ball = |(centre, radius): (DVec3, f64)| {
        let offset = centre - point;
        let distance = offset.length().max(radius);
        (radius / distance).powi(2) * (offset.z / distance).max(0.0)
    };
    // Solids overlap; counting each at a part of its weight keeps the sum right on the whole.
    if first == second { 0.3 * ball(first) } else { 0.3 * (ball(first) + ball(second)) }
}

/// One pass of a box of 3 along a row (`step` 1, `across` side) or a column of a square grid; ends repeat.
fn blurred(values: &[f32], step: usize, across: usize) -> Vec<f32> {
    let side = SIDE;
    let mut out = vec![0.0; values.len()];
    for line in 0..side {
        for i in 0..side {
            let at = |k: usize| values[line * across + k.min(side - 1) * step];
            out[line * across + i * step] = (at(i.saturating_sub(1)) + at(i) + at(i + 1)) / 3.0;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use crate::synth::solid::{PlacedSolid, Solid};

    fn ball(at: DVec3, radius: f64) -> Primitive {
        let map = DAffine3::from_scale_rotation_translation(DVec3::splat(radius), glam::DQuat::IDENTITY, at);
        Primitive::Solid(PlacedSolid::new(Solid::Ball, map))
    }

    #[test]
    fn bins_answer_as_all_solids_do() {
        let solids: Vec<Primitive> = (0..30)
            .map(|i| {
                let i = f64::from(i);
                ball(DVec3::new((i * 1.7).sin(), (i * 2.3).cos(), 1.2 + i.sin()) * 500.0, 60.0 + 4.0 * i)
            })
            .collect();
        let to_light = DVec3::new(0.3, -0.4, 1.0).normalize();
        let bins = LightBins::new(&solids, to_light);
        let mut shaded = 0;
        for i in 0..4000 {
            let i = f64::from(i);
            let point = DVec3::new((i * 0.71).sin() * 1500.0, (i * 0.37).cos() * 1500.0, 0.0);
            let all = solids.iter().any(|s| s.first_hit(&Ray { origin: point, direction: to_light }).is_some());
            assert_eq!(bins.in_shadow(point), all, "{point}");
            shaded += usize::from(all);
        }
        assert!(shaded > 200 && shaded < 3800, "{shaded}");
    }

    #[test]
    fn the_floor_is_darkest_under_the_ball_and_open_far_away() {
        let solids = [ball(DVec3::new(100.0, 50.0, 150.0), 140.0)];
        let bins = LightBins::new(&solids, DVec3::Z);
        let shadow = FloorShadow::new(&bins, &[solids[0].bounding_balls()], DVec2::new(100.0, 50.0), 3);
        assert!(shadow.at(100.0, 50.0)[0] < 0.01 && shadow.at(100.0, 50.0)[1] < 0.85);
        assert!(shadow.at(400.0, 50.0)[0] > 0.99);
        assert_eq!(shadow.at(9000.0, 0.0), [1.0, 1.0]);
        assert_eq!(shadow.at(f64::NAN, 0.0), [1.0, 1.0]);
    }
}
