//! What a pose is worth beside its match with the pictures: by which way people go (METHOD A3, A14).

use crate::body::{Body, DofAxis};

/// Way from the first to the last of some frames, mm, from which on a person walks.
const WALKED: f64 = 400.0;

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
        let of_root =
            |axis: DofAxis| body.dofs().position(|(bone, dof)| body.bones[bone].parent.is_none() && dof.axis == axis);
        Some(Self { x: of_root(DofAxis::Tx)?, y: of_root(DofAxis::Ty)?, heading: of_root(DofAxis::Rz)? })
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
}
