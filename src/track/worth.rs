//! What a pose is worth beside its match with the pictures: by how people hold themselves, and which way they go (METHOD A3, A14).

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};

use crate::body::{Body, DofAxis};

/// Worth of the fitness: of its natural logarithm.
pub(super) const MATCH: f64 = 300.0;
/// By how much heads lean, radians, the scale of a Cauchy distribution: people who walk keep theirs within 6 to 15 degrees of upright, whatever
/// their trunks do, and who looks at his feet or dances leans his by 40 to 80, which must cost little more.
const LEANS: f64 = 10.0 * PI / 180.0;

/// Way from the first to the last of some frames, mm, from which on a person walks.
const WALKED: f64 = 400.0;

/// How people hold themselves where pictures leave it open: a head is nearly round, and the flat one that is drawn fits it leaning almost as
/// well as upright (METHOD A14).
#[derive(Clone, Copy, Debug)]
pub(super) struct Posture {
    /// The head's bone, and the one with the crown on it and where; none of a body without.
    head: Option<(usize, usize, DVec3)>,
}

impl Posture {
    pub(super) fn of(body: &Body) -> Self {
        let crown = body.free_ends().into_iter().find(|end| end.name == "head_top");
        Self { head: body.bone_index("head").zip(crown).map(|(head, crown)| (head, crown.bone, crown.at)) }
    }

    /// What it costs to have the bones there, mm.
    pub(super) fn cost(&self, world_from_bones: &[DAffine3]) -> f64 {
        let Some((head, bone, at)) = self.head else { return 0.0 };
        let axis = world_from_bones[bone].transform_point3(at) - world_from_bones[head].translation;
        let lean_squared = 2.0 * (1.0 - axis.normalize_or_zero().z);
        (lean_squared / (LEANS * LEANS)).ln_1p()
    }

    /// A fitness less that cost, as much smaller as its worth is.
    pub(super) fn weighed(&self, fitness: f32, world_from_bones: &[DAffine3]) -> f32 {
        (f64::from(fitness) * (-self.cost(world_from_bones) / MATCH).exp()) as f32
    }
}

/// Which way a body faces: the degrees of freedom by which all of it goes along x and y, and turns about its own axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facing {
    x: usize,
    y: usize,
    pub(super) heading: usize,
}

impl Facing {
    /// None of a body that does not go or turn.
    pub(super) fn of(body: &Body) -> Option<Self> {
        let [x, y, heading] = [DofAxis::Tx, DofAxis::Ty, DofAxis::Rz].map(|axis| body.root_dof(axis));
        Some(Self { x: x?, y: y?, heading: heading? })
    }

    /// The mean cosine between where a body faces and the way it goes from the first of these poses to the last; 0 where it goes nowhere.
    pub(super) fn along(&self, poses: &[Vec<f32>]) -> f64 {
        let (Some(first), Some(last)) = (poses.first(), poses.last()) else { return 0.0 };
        let way = [self.x, self.y].map(|d| f64::from(last[d]) - f64::from(first[d]));
        let length = way[0].hypot(way[1]);
        if length < WALKED {
            return 0.0;
        }
        let along = poses.iter().map(|pose| {
            let (sin, cos) = f64::from(pose[self.heading]).sin_cos();
            (way[0] * cos + way[1] * sin) / length
        });
        along.sum::<f64>() / poses.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Who goes sideways faces neither along nor against the way, and who goes less far than a walk says nothing.
    #[test]
    fn a_body_faces_along_its_way_or_not() {
        let body = Body::adult(1750.0).unwrap();
        let facing = Facing::of(&body).unwrap();
        let way = |far: f32, heading: f32| -> Vec<Vec<f32>> {
            let pose = |t: u8| {
                let mut pose: Vec<f32> = body.standing_pose().into_iter().map(|value| value as f32).collect();
                (pose[facing.y], pose[facing.heading]) = (far * f32::from(t) / 4.0, heading.to_radians());
                pose
            };
            (0..5).map(pose).collect()
        };
        for (heading, expected) in [(90.0, 1.0), (-90.0, -1.0), (0.0, 0.0), (150.0, 0.5)] {
            let along = facing.along(&way(500.0, heading));
            assert!((along - expected).abs() < 1e-6, "{heading}: {along}");
        }
        assert_eq!(facing.along(&way(350.0, 90.0)), 0.0);
        assert_eq!(facing.along(&[]), 0.0);
    }

    /// What leans costs more the more it does, at first by the square and then ever less; turning costs nothing, nor does a body without a head.
    #[test]
    fn a_head_that_leans_costs() {
        let body = Body::adult(1750.0).unwrap();
        let posture = Posture::of(&body);
        let bones = |turned: &[(&str, f64)]| {
            let mut pose = body.standing_pose();
            turned.iter().for_each(|(name, degrees)| pose[body.dof_index(name).unwrap()] = degrees.to_radians());
            body.world_from_bones(&pose).unwrap()
        };
        let cost = |turned: &[(&str, f64)]| posture.cost(&bones(turned));
        // The crown is a little before the joint at rest.
        let [head, top] = ["head", "head_top"].map(|name| body.joint_index(name).unwrap());
        let joints = body.joint_positions(&bones(&[]));
        let axis = joints[top] - joints[head];
        let before = axis.x.atan2(axis.z).to_degrees();
        let nodding = |degrees: f64| cost(&[("head.ry", degrees - before)]);
        assert!(nodding(0.0) < 1e-9, "{}", nodding(0.0));
        assert!((cost(&[("head.rz", 60.0)]) - cost(&[])).abs() < 1e-9);
        let [little, more, far] = [2.0, 10.0, 40.0].map(nodding);
        assert!((little - 0.04).abs() < 2e-3 && (more - 2.0_f64.ln()).abs() < 5e-3, "{little} {more}");
        assert!((far - 17.0_f64.ln()).abs() < 0.05, "{far}");
        assert!((nodding(-10.0) - more).abs() < 1e-9);
        let on_a_trunk = cost(&[("thorax.ry", 25.0), ("head.ry", -25.0 - before)]);
        assert!(on_a_trunk < 1e-9, "a head that is upright on a trunk that leans costs {on_a_trunk}");
        // What it is worth is less by the cost.
        let leaning = bones(&[("head.ry", 40.0 - before)]);
        let lost = MATCH * (0.8 / f64::from(posture.weighed(0.8, &leaning))).ln();
        assert!((lost - far).abs() < 1e-3, "{lost} of {far}");

        let mut headless = body.clone();
        headless.bones.iter_mut().filter(|bone| bone.name == "head").for_each(|bone| bone.name = "mast".to_string());
        assert_eq!(Posture::of(&headless).cost(&leaning), 0.0);
    }
}
