//! How far each degree of freedom moves each joint of a pose.

use glam::{DAffine3, DVec3};

use crate::body::Body;

/// Step of a degree of freedom for its effect on the joints: mm, radians.
const STEP: f64 = 1e-3;

/// The joints of a pose as `bones` place them, and what each degree of freedom makes of them.
#[derive(Clone, Debug)]
pub(super) struct Levers {
    /// Where the bones are.
    pub(super) bones: Vec<DAffine3>,
    /// Where the joints are, mm, in the order of [`Body::joint_names`].
    pub(super) joints: Vec<DVec3>,
    /// `[degree of freedom][joint]`: by how many mm it goes, a mm or radian.
    pub(super) of_dofs: Vec<Vec<f64>>,
}

impl Levers {
    /// Of a pose; none where it does not fit the body.
    pub(super) fn of(body: &Body, pose: &[f32]) -> Option<Self> {
        let mut pose: Vec<f64> = pose.iter().map(|value| f64::from(*value)).collect();
        let bones = body.world_from_bones(&pose).ok()?;
        let joints = body.joint_positions(&bones);
        let mut moved = Vec::new();
        let mut of_dofs = Vec::with_capacity(pose.len());
        for dof in 0..pose.len() {
            let value = pose[dof];
            pose[dof] = value + STEP;
            body.world_from_bones_into(&pose, &mut moved).ok()?;
            let ways = body.joint_positions(&moved).into_iter().zip(&joints);
            of_dofs.push(ways.map(|(moved, still)| moved.distance(*still) / STEP).collect());
            pose[dof] = value;
        }
        Some(Self { bones, joints, of_dofs })
    }

    /// Standard deviation of every joint's position, mm, from those of the degrees of freedom, taken as independent.
    pub(super) fn joint_spreads(&self, spread: &[f32]) -> Vec<f64> {
        let mut variances = vec![0.0; self.joints.len()];
        for (levers, &spread) in self.of_dofs.iter().zip(spread).filter(|(_, spread)| **spread > 0.0) {
            let spread = f64::from(spread);
            variances.iter_mut().zip(levers).for_each(|(variance, lever)| *variance += (lever * spread).powi(2));
        }
        variances.into_iter().map(f64::sqrt).collect()
    }
}
