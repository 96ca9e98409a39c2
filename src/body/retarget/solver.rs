//! The angles of a body that bring its bones nearest to wanted orientations: least squares within the limits, by
//! Levenberg-Marquardt steps from the pose before, so that a motion stays smooth.

use anyhow::Result;
use glam::{DMat3, DVec3};

use crate::body::{Body, DofAxis};

/// The orientation a bone should have, `world_from_bone`.
pub(super) type Wanted = DMat3;

/// Weight of a limb's twist beside its direction, and of a clavicle, which few recordings know well.
const TWIST: f64 = 0.08;
const CLAVICLE: f64 = 0.3;
/// Steps at most; a frame takes about ten.
const MOST_STEPS: usize = 60;
/// A start afresh must be better by this much to be preferred to the pose before.
const MUCH_BETTER: f64 = 0.1;
/// Weight of a change from the pose before: nothing beside a direction that is wrong, but it decides where two angles of a
/// bone turn about one axis (a thigh or an arm raised to the front) and only their sum is wanted.
const CALM: f64 = 3e-4;

/// A vector fixed to a bone and its weight.
type Weighted = (DVec3, f64);

pub(super) struct Solver<'a> {
    body: &'a Body,
    /// Of each bone, the vectors that should come to lie as wanted.
    vectors: Vec<Vec<Weighted>>,
    /// Of each bone, the rotations at and above it that may change.
    above: Vec<Vec<usize>>,
    /// Bone, axis (0 to 2) of each degree of freedom that may change; `None` for the others.
    turns: Vec<Option<(usize, usize)>>,
}

impl<'a> Solver<'a> {
    /// `joints` says which bones are wanted anywhere, `directions` how limbs' bones run at rest.
    pub(super) fn new(body: &'a Body, joints: &[Option<usize>], directions: &[Option<DVec3>]) -> Self {
        let vectors = (0..body.bones.len())
            .map(|bone| match (joints[bone], directions[bone]) {
                (None, _) => Vec::new(),
                (Some(_), Some(along)) => {
                    let (one, other) = along.any_orthonormal_pair();
                    vec![(along, 1.0), (one, TWIST), (other, TWIST)]
                }
                (Some(_), None) => {
                    let weight = if body.bones[bone].name.ends_with("clavicle") { CLAVICLE } else { 1.0 };
                    DVec3::AXES.map(|axis| (axis, weight)).to_vec()
                }
            })
            .collect();
        let turns: Vec<Option<(usize, usize)>> = body
            .dofs()
            .map(|(bone, dof)| {
                (dof.axis.is_rotation() && joints[bone].is_some()).then(|| (bone, dof.axis.slot() - DofAxis::Rx.slot()))
            })
            .collect();
        let above = (0..body.bones.len())
            .map(|bone| {
                let line: Vec<usize> = std::iter::successors(Some(bone), |&at| body.bones[at].parent).collect();
                (0..turns.len()).filter(|&dof| turns[dof].is_some_and(|(of, _)| line.contains(&of))).collect()
            })
            .collect();
        Self { body, vectors, above, turns }
    }

    /// The pose nearest to what is wanted, from the pose before where there is one. The root's place is left as it was.
    pub(super) fn solve(&self, wanted: &[Option<Wanted>], before: Option<&[f64]>) -> Result<Vec<f64>> {
        let fresh = self.bone_by_bone(wanted, before);
        match before {
            None => self.improve(wanted, fresh, None).map(|(pose, _)| pose),
            Some(before) => {
                let (pose, cost) = self.improve(wanted, before.to_vec(), Some(before))?;
                if cost < MUCH_BETTER {
                    return Ok(pose);
                }
                let (other, other_cost) = self.improve(wanted, fresh, Some(before))?;
                Ok(if other_cost + MUCH_BETTER < cost { other } else { pose })
            }
        }
    }

    /// Each bone turned as wanted against its parent as it has come out, its angles cut to their limits.
    fn bone_by_bone(&self, wanted: &[Option<Wanted>], before: Option<&[f64]>) -> Vec<f64> {
        let mut pose: Vec<f64> = self.body.dofs().map(|(_, dof)| 0.0f64.clamp(dof.limits[0], dof.limits[1])).collect();
        let mut starts = Vec::with_capacity(self.body.bones.len());
        let mut next = 0;
        for bone in &self.body.bones {
            starts.push(next);
            next += bone.dofs.len();
        }
        let mut world = vec![DMat3::IDENTITY; self.body.bones.len()];
        for &index in &self.body.update_order {
            let bone = &self.body.bones[index];
            let above = bone.parent.map_or(DMat3::IDENTITY, |parent| world[parent]);
            let own = starts[index]..starts[index] + bone.dofs.len();
            if let Some(wanted) = wanted[index] {
                let angles = bone.order.angles(&(above.transpose() * wanted));
                for (dof, place) in bone.dofs.iter().zip(own.clone()) {
                    if dof.axis.is_rotation() {
                        let mut angle = angles[dof.axis.slot() - DofAxis::Rx.slot()];
                        if let Some(before) = before {
                            let turn = std::f64::consts::TAU;
                            angle += turn * ((before[place] - angle) / turn).round();
                        }
                        pose[place] = angle.clamp(dof.limits[0], dof.limits[1]);
                    }
                }
            }
            world[index] = above * bone.parent_from_bone(&pose[own]).matrix3;
        }
        if let Some(before) = before {
            for (place, (_, dof)) in self.body.dofs().enumerate() {
                if !dof.axis.is_rotation() {
                    pose[place] = before[place];
                }
            }
        }
        pose
    }

    fn cost(&self, wanted: &[Option<Wanted>], world: &[DMat3]) -> f64 {
        let mut cost = 0.0;
        for (bone, vectors) in self.vectors.iter().enumerate() {
            if let Some(wanted) = wanted[bone] {
                let off = |(vector, weight): &Weighted| ((world[bone] - wanted) * *vector * *weight).length_squared();
                cost += vectors.iter().map(off).sum::<f64>();
            }
        }
        cost
    }

    fn world(&self, pose: &[f64]) -> Result<Vec<DMat3>> {
        Ok(self.body.world_from_bones(pose)?.into_iter().map(|bone| bone.matrix3).collect())
    }

    /// The world's axis about which each degree of freedom turns.
    fn axes(&self, pose: &[f64], world: &[DMat3]) -> Vec<DVec3> {
        let mut axes = vec![DVec3::ZERO; pose.len()];
        for (dof, turn) in self.turns.iter().enumerate() {
            let Some((index, axis)) = *turn else { continue };
            let bone = &self.body.bones[index];
            let above = bone.parent.map_or(DMat3::IDENTITY, |parent| world[parent]);
            // The rotations to the left of this one in the product turn its axis.
            let mut turned = above;
            for earlier in bone.order.axes().into_iter().take_while(|earlier| *earlier != axis) {
                let angle = self.angle(pose, index, earlier);
                turned *= [DMat3::from_rotation_x, DMat3::from_rotation_y, DMat3::from_rotation_z][earlier](angle);
            }
            axes[dof] = turned.col(axis);
        }
        axes
    }

    fn angle(&self, pose: &[f64], bone: usize, axis: usize) -> f64 {
        let of_bone =
            |(_, (of, dof)): &(usize, (usize, &crate::body::Dof))| *of == bone && dof.axis == DofAxis::ALL[3 + axis];
        self.body.dofs().enumerate().find(of_bone).map_or(0.0, |(place, _)| pose[place])
    }

    /// The least squares from a start, drawn a little to the pose `before`.
    fn improve(
        &self,
        wanted: &[Option<Wanted>],
        mut pose: Vec<f64>,
        before: Option<&[f64]>,
    ) -> Result<(Vec<f64>, f64)> {
        let limits: Vec<[f64; 2]> = self.body.dofs().map(|(_, dof)| dof.limits).collect();
        let count = pose.len();
        let drawn = |pose: &[f64]| -> Vec<f64> {
            match before {
                None => vec![0.0; count],
                Some(before) => {
                    let turns = self.turns.iter().zip(pose.iter().zip(before));
                    turns.map(|(turn, (now, then))| if turn.is_some() { now - then } else { 0.0 }).collect()
                }
            }
        };
        let whole_cost = |world: &[DMat3], pose: &[f64]| {
            self.cost(wanted, world) + CALM * drawn(pose).iter().map(|change| change * change).sum::<f64>()
        };
        let mut world = self.world(&pose)?;
        let mut cost = whole_cost(&world, &pose);
        let mut damping = 1e-4;
        for _ in 0..MOST_STEPS {
            let axes = self.axes(&pose, &world);
            let (mut normal, mut gradient) = (vec![0.0; count * count], vec![0.0; count]);
            if before.is_some() {
                for (dof, change) in drawn(&pose).into_iter().enumerate() {
                    gradient[dof] = CALM * change;
                    normal[dof * count + dof] = CALM;
                }
            }
            for (bone, vectors) in self.vectors.iter().enumerate() {
                let Some(wanted) = wanted[bone] else { continue };
                for (vector, weight) in vectors {
                    let at = world[bone] * *vector;
                    let off = (at - wanted * *vector) * *weight;
                    let slopes: Vec<(usize, DVec3)> =
                        self.above[bone].iter().map(|&dof| (dof, axes[dof].cross(at) * *weight)).collect();
                    for &(i, slope) in &slopes {
                        gradient[i] += slope.dot(off);
                        for &(j, other) in &slopes {
                            normal[i * count + j] += slope.dot(other);
                        }
                    }
                }
            }
            // A value at its limit that would be pushed beyond stays there.
            let is_free = |dof: usize| {
                let [low, high] = limits[dof];
                let is_stuck = (pose[dof] <= low && gradient[dof] > 0.0) || (pose[dof] >= high && gradient[dof] < 0.0);
                self.turns[dof].is_some() && !is_stuck
            };
            let free: Vec<usize> = (0..count).filter(|&dof| is_free(dof)).collect();
            let Some(step) = step(&normal, &gradient, count, &free, damping) else { break };
            let mut next = pose.clone();
            for (&dof, change) in free.iter().zip(&step) {
                next[dof] = (next[dof] + change.clamp(-0.6, 0.6)).clamp(limits[dof][0], limits[dof][1]);
            }
            let next_world = self.world(&next)?;
            let next_cost = whole_cost(&next_world, &next);
            let moved = next.iter().zip(&pose).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            if next_cost <= cost {
                (pose, world, cost) = (next, next_world, next_cost);
                damping = (damping * 0.2).max(1e-9);
            } else {
                damping *= 8.0;
            }
            if moved < 1e-11 || damping > 1e6 {
                break;
            }
        }
        Ok((pose, cost))
    }
}

/// Solves (N + damping) x = -g for the free unknowns by Cholesky's method; None when N is no longer positive.
fn step(normal: &[f64], gradient: &[f64], count: usize, free: &[usize], damping: f64) -> Option<Vec<f64>> {
    let size = free.len();
    let mut lower = vec![0.0; size * size];
    for i in 0..size {
        for j in 0..=i {
            let mut sum = normal[free[i] * count + free[j]] + if i == j { damping } else { 0.0 };
            for k in 0..j {
                sum -= lower[i * size + k] * lower[j * size + k];
            }
            lower[i * size + j] = if i == j {
                if sum.is_nan() || sum <= 0.0 {
                    return None;
                }
                sum.sqrt()
            } else {
                sum / lower[j * size + j]
            };
        }
    }
    let mut x: Vec<f64> = free.iter().map(|&dof| -gradient[dof]).collect();
    for i in 0..size {
        for k in 0..i {
            x[i] -= lower[i * size + k] * x[k];
        }
        x[i] /= lower[i * size + i];
    }
    for i in (0..size).rev() {
        for k in i + 1..size {
            x[i] -= lower[k * size + i] * x[k];
        }
        x[i] /= lower[i * size + i];
    }
    Some(x)
}
