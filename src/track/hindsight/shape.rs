//! Where a pose puts the body: its joints in space, and how far its parts would stand in each other (METHOD A14).

use glam::{DAffine3, DVec3};

use crate::body::{Body, Part};
use crate::track::worth::Posture;

/// Share of the thinner part's radius by which parts may overlap: radii are measured roughly, and flesh gives way.
const GIVES: f64 = 0.5;
/// Cost of a millimetre by which parts stand in each other.
const INTRUSION: f64 = 0.1;
/// More than arithmetic is off by, mm.
const ROUNDING: f64 = 1e-3;

/// A body, for what of its poses time can judge.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    pub(super) body: Body,
    /// Bones and places on them of the ends that no bone begins at.
    ends: Vec<(usize, DVec3)>,
    /// Pairs of parts that could stand in each other, and how deep they may.
    pairs: Vec<(usize, usize, f64)>,
    /// How far each part reaches from its axis's middle, mm.
    reaches: Vec<f64>,
    posture: Posture,
}

/// Memory that posing uses again.
#[derive(Clone, Debug, Default)]
pub(super) struct Posed {
    pose: Vec<f64>,
    bones: Vec<DAffine3>,
    /// The axes of the parts, mm.
    axes: Vec<[DVec3; 2]>,
    /// The joints, mm, in the order of [`Body::joint_names`].
    pub(super) points: Vec<DVec3>,
}

impl Shape {
    pub(super) fn new(body: &Body) -> Self {
        let ends = body.free_ends().iter().map(|end| (end.bone, end.at)).collect();
        let reach = |part: &Part| 0.5 * part.a.distance(part.b) + part.radius_a.max(part.radius_b) + ROUNDING;
        let reaches = body.parts.iter().map(reach).collect();
        let mut shape = Self { body: body.clone(), ends, pairs: Vec::new(), reaches, posture: Posture::of(body) };
        let mut posed = Posed::default();
        let rest: Vec<f32> = body.standing_pose().into_iter().map(|value| value as f32).collect();
        shape.pose(&rest, &mut posed);
        // Neighbours share a joint, and what overlaps at rest is made so.
        let near = |one: usize, other: usize| {
            let bones = [one, other].map(|part| body.parts[part].bone);
            let parents = bones.map(|bone| body.bones[bone].parent);
            bones[0] == bones[1] || parents[0] == Some(bones[1]) || parents[1] == Some(bones[0])
        };
        for one in 0..body.parts.len() {
            for other in one + 1..body.parts.len() {
                let [a, b] = [&body.parts[one], &body.parts[other]];
                let gives = GIVES * a.radius_a.min(a.radius_b).min(b.radius_a).min(b.radius_b);
                if !near(one, other) && shape.depth(&posed, one, other) <= gives {
                    shape.pairs.push((one, other, gives));
                }
            }
        }
        shape
    }

    /// Poses the body. A pose of another length leaves what was there.
    pub(super) fn pose(&self, pose: &[f32], posed: &mut Posed) {
        posed.pose.clear();
        posed.pose.extend(pose.iter().map(|value| f64::from(*value)));
        if self.body.world_from_bones_into(&posed.pose, &mut posed.bones).is_err() {
            return;
        }
        posed.axes.clear();
        let axis = |part: &Part| [part.a, part.b].map(|end| posed.bones[part.bone].transform_point3(end));
        posed.axes.extend(self.body.parts.iter().map(axis));
        posed.points.clear();
        posed.points.extend(posed.bones.iter().map(|matrix| matrix.translation));
        posed.points.extend(self.ends.iter().map(|(bone, at)| posed.bones[*bone].transform_point3(*at)));
    }

    /// The joints of a pose.
    pub(super) fn points(&self, pose: &[f32]) -> Vec<DVec3> {
        let mut posed = Posed::default();
        self.pose(pose, &mut posed);
        posed.points
    }

    /// What a pose costs in itself: parts that stand in each other, and how it is held.
    pub(super) fn cost(&self, posed: &Posed) -> f64 {
        if posed.bones.is_empty() {
            return 0.0;
        }
        INTRUSION * self.intrusion(posed) + self.posture.cost(&posed.bones)
    }

    /// By how much parts stand in each other in a pose, mm, beyond what they may: the sum over pairs.
    pub(super) fn intrusion(&self, posed: &Posed) -> f64 {
        let near = self.pairs.iter().filter(|&&(one, other, _)| self.may_meet(posed, one, other));
        near.map(|&(one, other, gives)| (self.depth(posed, one, other) - gives).max(0.0)).sum()
    }

    /// Whether the balls around two parts meet: most pairs are far apart.
    fn may_meet(&self, posed: &Posed, one: usize, other: usize) -> bool {
        let [[a, b], [c, d]] = [one, other].map(|part| posed.axes[part]);
        (a + b).distance_squared(c + d) < (2.0 * (self.reaches[one] + self.reaches[other])).powi(2)
    }

    /// How deep two parts stand in each other, mm; not above 0 where they do not.
    fn depth(&self, posed: &Posed, one: usize, other: usize) -> f64 {
        let parts = [one, other].map(|part| &self.body.parts[part]);
        let axes = [one, other].map(|part| posed.axes[part]);
        let places = nearest(axes);
        let [p, q] = [0, 1].map(|at| axes[at][0].lerp(axes[at][1], places[at]));
        let radius = |at: usize| parts[at].radius_a + places[at] * (parts[at].radius_b - parts[at].radius_a);
        radius(0) + radius(1) - p.distance(q)
    }
}

/// Where two segments are nearest to each other, as shares of their lengths.
fn nearest([[p0, p1], [q0, q1]]: [[DVec3; 2]; 2]) -> [f64; 2] {
    let (u, v, w) = (p1 - p0, q1 - q0, p0 - q0);
    let (a, b, c, d, e) = (u.length_squared(), u.dot(v), v.length_squared(), u.dot(w), v.dot(w));
    let det = a * c - b * b;
    let mut s = if det > 1e-9 * a * c { ((b * e - c * d) / det).clamp(0.0, 1.0) } else { 0.0 };
    let mut t = if c > 0.0 { (b * s + e) / c } else { 0.0 };
    if !(0.0..=1.0).contains(&t) {
        t = t.clamp(0.0, 1.0);
        s = if a > 0.0 { ((b * t - d) / a).clamp(0.0, 1.0) } else { 0.0 };
    }
    [s, t]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::SearchSpace;
    use crate::track::glance::Lattice;

    /// Parts whose balls do not meet do not stand in each other, so that leaving them out changes nothing.
    #[test]
    fn what_is_far_apart_does_not_intrude() {
        let body = Body::adult(1750.0).unwrap();
        let (shape, space) = (Shape::new(&body), SearchSpace::of(&body).unwrap());
        let all: Vec<usize> = (0..space.dof_count()).collect();
        let rest: Vec<f32> = body.standing_pose().into_iter().map(|value| value as f32).collect();
        let mut posed = Posed::default();
        let (mut far, mut deep) = (0, 0);
        for row in Lattice::new(&space, &all).rows(&rest, 0..500) {
            shape.pose(&row, &mut posed);
            let of = |&(one, other, gives): &(usize, usize, f64)| (shape.depth(&posed, one, other) - gives).max(0.0);
            assert_eq!(shape.intrusion(&posed), shape.pairs.iter().map(of).sum::<f64>());
            far += shape.pairs.iter().filter(|(one, other, _)| !shape.may_meet(&posed, *one, *other)).count();
            deep += shape.pairs.iter().filter(|pair| of(pair) > 0.0).count();
        }
        assert!(far > 500 * shape.pairs.len() / 2 && deep > 100, "{far} far apart, {deep} intrude");
    }
}
