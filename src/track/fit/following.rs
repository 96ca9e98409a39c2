//! How poses follow when the body changes: what is drawn stays where it was as far as the joints allow (METHOD A3).

use anyhow::{Context, Result};
use glam::DVec3;
use nalgebra::{DMatrix, DVector};

use crate::body::{Body, DofAxis};

/// A change of so many mm costs as much as a degree of freedom that moves by one of its steps: what nothing tells apart stays.
const CALM: f64 = 2.0;
/// Steps of the derivatives, mm and radians.
const DELTA: [f64; 2] = [0.1, 1e-4];

/// A pose that follows.
pub(in crate::track) struct Following {
    pose: Vec<f64>,
    /// Ends of the parts in that pose, mm.
    ends: Vec<DVec3>,
    /// Change of the pose for a displacement of all coordinates of the ends, least squares: `[dof][coordinate]`.
    gain: DMatrix<f64>,
}

impl Following {
    /// From a pose of a body; `steps` says how much the degrees of freedom are used to move.
    ///
    /// # Errors
    /// When the pose is none of the body.
    pub(in crate::track) fn new(body: &Body, pose: &[f32], steps: &[f32]) -> Result<Self> {
        let pose: Vec<f64> = pose.iter().map(|value| f64::from(*value)).collect();
        let ends = ends(body, &pose)?;
        let mut slopes = DMatrix::zeros(ends.len() * 3, pose.len());
        for (dof, (_, own)) in body.dofs().enumerate() {
            let delta = DELTA[usize::from(own.axis.slot() >= DofAxis::Rx.slot())];
            let mut moved = pose.clone();
            moved[dof] += delta;
            let coordinates = self::ends(body, &moved)?;
            let changes =
                coordinates.iter().zip(&ends).flat_map(|(after, before)| ((*after - *before) / delta).to_array());
            slopes.column_mut(dof).iter_mut().zip(changes).for_each(|(slope, change)| *slope = change);
        }
        let mut normal = slopes.tr_mul(&slopes);
        for (dof, step) in steps.iter().enumerate() {
            let weight = CALM / f64::from(*step);
            normal[(dof, dof)] += weight * weight;
        }
        let solver = normal.cholesky().context("the least squares of a pose have no solution")?;
        Ok(Self { gain: solver.solve(&slopes.transpose()), pose, ends })
    }

    /// The pose with another body, whose bones and parts are the same.
    ///
    /// # Errors
    /// When its degrees of freedom are others.
    pub(in crate::track) fn with(&self, body: &Body) -> Result<Vec<f32>> {
        let now = ends(body, &self.pose)?;
        let back = DVector::from_iterator(
            now.len() * 3,
            self.ends.iter().zip(&now).flat_map(|(wanted, is)| (*wanted - *is).to_array()),
        );
        let change = &self.gain * back;
        let mut pose: Vec<f64> = self.pose.iter().zip(change.iter()).map(|(value, change)| value + change).collect();
        body.clamp_to_limits(&mut pose);
        Ok(pose.into_iter().map(|value| value as f32).collect())
    }
}

/// Both ends of every part, in the world, mm.
fn ends(body: &Body, pose: &[f64]) -> Result<Vec<DVec3>> {
    let bones = body.world_from_bones(pose)?;
    let place = |bone: usize, at: DVec3| bones[bone].transform_point3(at);
    Ok(body.parts.iter().flat_map(|part| [place(part.bone, part.a), place(part.bone, part.b)]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Proportions;
    use crate::search::SearchSpace;

    /// With longer thighs and shorter upper arms the hands, the feet and the head stay nearer to where they were.
    #[test]
    fn what_is_drawn_stays_where_it_was() {
        let body = Body::adult(1750.0).unwrap();
        let space = SearchSpace::of(&body).unwrap();
        let mut pose = body.standing_pose();
        for (name, degrees) in
            [("left_hip.ry", -40.0_f64), ("left_knee.ry", 60.0), ("left_elbow.ry", -70.0), ("right_shoulder.rx", -60.0)]
        {
            pose[body.dof_index(name).unwrap()] = degrees.to_radians();
        }
        let single: Vec<f32> = pose.iter().map(|value| *value as f32).collect();
        let following = Following::new(&body, &single, &space.spread(1.0 / 25.0).unwrap()).unwrap();
        let same = following.with(&body).unwrap();
        assert!(same.iter().zip(&single).all(|(a, b)| (a - b).abs() < 1e-6));
        let factors = [("thigh".to_string(), 1.05), ("upper arm".to_string(), 0.95)];
        let stretched = Proportions::named(&factors.into_iter().collect()).unwrap().apply(&body);
        let moved: Vec<f64> = following.with(&stretched).unwrap().into_iter().map(f64::from).collect();
        let far = |pose: &[f64]| {
            let off = ends(&stretched, pose).unwrap().into_iter().zip(&following.ends);
            off.map(|(is, was)| is.distance(*was)).fold(0.0, f64::max)
        };
        assert!(far(&moved) < 0.85 * far(&pose), "{} of {}", far(&moved), far(&pose));
    }
}
