//! The root's way: where the recording goes, on the floor, without sliding feet.

use anyhow::Result;
use glam::{DAffine3, DVec2, DVec3};

use super::source::{Placed, Source};
use crate::body::Body;

/// Joints other than those of feet are this far inside the body, mm.
const FLESH: f64 = 60.0;
/// Within this height the recorded person is taken to stand: joints of feet waver, mm.
const STANDS: f64 = 25.0;
/// Lowest points are blended over this height, so that the root does not jerk, mm.
const BLEND: f64 = 5.0;
/// Points within some such heights of the lowest carry the weight, mm.
const WEIGHT: f64 = 6.0;

pub(super) struct Ground<'a> {
    body: &'a Body,
    /// The body's leg over the recording's.
    scale: f64,
    pelvis: [Option<usize>; 2],
    feet: Vec<usize>,
    others: Vec<usize>,
    /// Of every frame: middle of the hips, heights of the feet's joints, height of the lowest other joint; mm.
    way: Vec<DVec2>,
    feet_heights: Vec<Vec<f64>>,
    other_heights: Vec<f64>,
}

impl<'a> Ground<'a> {
    pub(super) fn new(body: &'a Body, source: &Source, scale: f64) -> Result<Self> {
        let hip = |name: &str| body.bone_index(name).and_then(|bone| source.names.of_bone[bone]);
        let feet = source.names.feet.clone();
        let others = (0..source.motion.joints.len()).filter(|joint| !feet.contains(joint)).collect();
        Ok(Self {
            body,
            scale,
            pelvis: [hip("left_hip"), hip("right_hip")],
            feet,
            others,
            way: Vec::new(),
            feet_heights: Vec::new(),
            other_heights: Vec::new(),
        })
    }

    /// Notes where the recorded person is in the next frame.
    pub(super) fn note(&mut self, placed: &[Placed]) {
        let hips: Vec<DVec3> = self.pelvis.iter().flatten().map(|&joint| placed[joint].origin).collect();
        let middle = hips.iter().sum::<DVec3>() / hips.len().max(1) as f64;
        self.way.push(middle.truncate() * self.scale);
        self.feet_heights.push(self.feet.iter().map(|&joint| placed[joint].origin.z * self.scale).collect());
        let lowest = self.others.iter().map(|&joint| placed[joint].origin.z * self.scale).fold(f64::INFINITY, f64::min);
        self.other_heights.push(lowest - FLESH);
    }

    /// How high the recorded person is above the floor in each frame. Each joint of a foot has a height of its own when it
    /// stands: the one it is rarely below.
    fn clearance(&self) -> Vec<f64> {
        let standing: Vec<f64> = (0..self.feet.len())
            .map(|foot| {
                let mut heights: Vec<f64> = self.feet_heights.iter().map(|row| row[foot]).collect();
                heights.sort_by(f64::total_cmp);
                heights.get(heights.len() / 20).copied().unwrap_or(0.0)
            })
            .collect();
        // The floor of the other joints: a foot's joint stands a little above it.
        let floor = standing.iter().copied().fold(f64::INFINITY, f64::min) - 0.5 * FLESH;
        self.feet_heights
            .iter()
            .zip(&self.other_heights)
            .map(|(row, other)| {
                let feet = row.iter().zip(&standing).map(|(height, stands)| height - stands);
                let lowest = feet.fold(other - floor, f64::min);
                if lowest.is_finite() { (lowest - STANDS).max(0.0) } else { 0.0 }
            })
            .collect()
    }

    /// Gives the poses' root its place in every frame.
    pub(super) fn stand(self, poses: &mut [Vec<f64>], rate: f64) -> Result<()> {
        let Some([tx, ty, tz]) = self.body.root_shift() else { return Ok(()) };
        let clearance = smoothed(&self.clearance(), (0.02 * rate).round() as usize);
        let mut slid = DVec2::ZERO;
        let mut before: Option<Vec<DVec3>> = None;
        for (frame, pose) in poses.iter_mut().enumerate() {
            [pose[tx], pose[ty], pose[tz]] = [0.0; 3];
            let bones = self.body.world_from_bones(pose)?;
            let hips = hip_middle(self.body, &bones);
            let place = self.way[frame] - hips.truncate() - slid;
            [pose[tx], pose[ty]] = place.to_array();
            let points = lowest_points(self.body, &bones);
            let low = soft_minimum(&points);
            pose[tz] = clearance[frame] - low;
            let points: Vec<DVec3> = points.iter().map(|p| *p + place.extend(pose[tz])).collect();
            // What stands keeps its place: the root moves against it.
            if let Some(before) = &before {
                let stands = (1.0 - clearance[frame] / 10.0).clamp(0.0, 1.0);
                let slip = slip(before, &points) * stands;
                slid += slip;
                pose[tx] -= slip.x;
                pose[ty] -= slip.y;
            }
            let moved = DVec2::new(pose[tx], pose[ty]) - place;
            before = Some(points.iter().map(|p| *p + moved.extend(0.0)).collect());
        }
        Ok(())
    }
}

fn hip_middle(body: &Body, bones: &[DAffine3]) -> DVec3 {
    let hips: Vec<DVec3> = ["left_hip", "right_hip"]
        .iter()
        .filter_map(|name| body.bone_index(name))
        .map(|bone| bones[bone].translation)
        .collect();
    hips.iter().sum::<DVec3>() / hips.len().max(1) as f64
}

/// The lowest point at each end of each part.
pub(super) fn lowest_points(body: &Body, bones: &[DAffine3]) -> Vec<DVec3> {
    let mut points = Vec::with_capacity(2 * body.parts.len());
    for part in &body.parts {
        let (a, b) = (bones[part.bone].transform_point3(part.a), bones[part.bone].transform_point3(part.b));
        let axis = (b - a).normalize_or_zero();
        // The disc of a cone's end reaches down by its radius times the sine of the axis with the vertical.
        let down = (1.0 - axis.z * axis.z).max(0.0).sqrt();
        points.extend([a - DVec3::Z * (part.radius_a * down), b - DVec3::Z * (part.radius_b * down)]);
    }
    points
}

fn soft_minimum(points: &[DVec3]) -> f64 {
    let lowest = points.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    if !lowest.is_finite() {
        return 0.0;
    }
    lowest - BLEND * points.iter().map(|p| (-(p.z - lowest) / BLEND).exp()).sum::<f64>().ln()
}

/// How the points that carry the weight have moved over the floor.
fn slip(before: &[DVec3], after: &[DVec3]) -> DVec2 {
    let lowest = before.iter().chain(after).map(|p| p.z).fold(f64::INFINITY, f64::min);
    let (mut sum, mut weights) = (DVec2::ZERO, 0.0);
    for (p, q) in before.iter().zip(after) {
        let weight = (-(p.z.max(q.z) - lowest) / WEIGHT).exp();
        sum += (q.truncate() - p.truncate()) * weight;
        weights += weight;
    }
    if weights > 0.0 { sum / weights } else { DVec2::ZERO }
}

/// A mean over `reach` frames on either side.
fn smoothed(values: &[f64], reach: usize) -> Vec<f64> {
    (0..values.len())
        .map(|at| {
            let window = &values[at.saturating_sub(reach)..(at + reach + 1).min(values.len())];
            window.iter().sum::<f64>() / window.len() as f64
        })
        .collect()
}
