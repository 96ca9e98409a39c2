//! What is measured on: a person among four cameras, and a swarm of poses round hers.

use anyhow::Result;
use glam::{DAffine3, DMat3, DVec2, DVec3};

use crate::body::Body;
use crate::evaluate::Reference;
use crate::features::Observation;
use crate::geometry::{BrownConrady, Camera, Lens};

/// A person, the cameras round her and what they see.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The person: an adult.
    pub body: Body,
    /// Four cameras around her.
    pub cameras: Vec<Camera>,
    /// What each of them sees of the first pose.
    pub observations: Vec<Observation>,
    /// The pose that is seen: mm, radians.
    pub pose: Vec<f32>,
}

impl Scene {
    /// With pictures of `size` pixels in which the person is about `person` pixels tall.
    ///
    /// # Errors
    /// When the body cannot be made.
    pub fn new(size: [u32; 2], person: f64) -> Result<Self> {
        let body = Body::adult(1750.0)?;
        let cameras = cameras(size, person);
        let pose: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
        let observations = seen_of(&body, &cameras, &pose);
        Ok(Self { body, cameras, observations, pose })
    }
}

/// Four cameras around a person who is `person` pixels tall in pictures of `size`.
fn cameras(size: [u32; 2], person: f64) -> Vec<Camera> {
    let distance = 4000.0;
    let focal = person * distance / 1750.0;
    (0..4)
        .map(|index| {
            let angle = f64::from(index) * std::f64::consts::FRAC_PI_2 + 0.6;
            let eye = DVec3::new(distance * angle.cos(), distance * angle.sin(), 1200.0);
            let forward = (DVec3::new(0.0, 0.0, 900.0) - eye).normalize();
            let right = forward.cross(DVec3::Z).normalize();
            let rotation = DMat3::from_cols(right, forward.cross(right), forward).transpose();
            Camera {
                name: format!("cam{index}"),
                size,
                camera_from_world: DAffine3::from_mat3_translation(rotation, -(rotation * eye)),
                lens: Lens::BrownConrady(BrownConrady {
                    focal: DVec2::splat(focal),
                    centre: DVec2::new(f64::from(size[0]), f64::from(size[1])) / 2.0,
                    radial: [-0.05, 0.01, 0.0],
                    tangential: [1e-4, -1e-4],
                }),
            }
        })
        .collect()
}

/// A swarm as it stands in mid-frame round a pose: the pose and `count - 1` others within one step of it, candidate after
/// candidate.
pub fn swarm(body: &Body, pose: &[f32], count: usize) -> Vec<f32> {
    let mut state = 1_u64;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1_u64 << 24) as f64
    };
    let mut poses = Vec::with_capacity(count * pose.len());
    for candidate in 0..count {
        for ((_, dof), centre) in body.dofs().zip(pose) {
            let spread = if candidate == 0 { 0.0 } else { 2.0 * uniform() - 1.0 };
            poses.push((f64::from(*centre) + dof.step * spread) as f32);
        }
    }
    poses
}

/// What the cameras would see of a body in a pose: its drawn silhouette, and a proximity in every pixel that no two share.
pub fn seen_of(body: &Body, cameras: &[Camera], pose: &[f32]) -> Vec<Observation> {
    let reference = Reference::new(body, cameras);
    (0..cameras.len())
        .map(|view| {
            let image = reference.draw(pose, view);
            let bytes = image.bytes.iter().enumerate().map(|(index, &drawn)| {
                let silhouette = if drawn != 0 { Observation::SILHOUETTE } else { 0 };
                silhouette | (index as u32).wrapping_mul(2_654_435_761).to_be_bytes()[0] & Observation::PROXIMITY
            });
            Observation { bytes: bytes.collect(), ..Observation::empty(image.width, image.height) }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_person_is_as_tall_as_asked_and_in_every_picture() {
        for (size, person) in [([480, 270], 150.0), ([640, 480], 280.0)] {
            let scene = Scene::new(size, person).unwrap();
            assert_eq!(scene.observations.len(), 4);
            for seen in &scene.observations {
                let width = seen.width as usize;
                let rows: Vec<usize> = (0..seen.height as usize)
                    .filter(|y| seen.bytes[y * width..][..width].iter().any(|byte| byte & Observation::SILHOUETTE != 0))
                    .collect();
                let tall = (rows[rows.len() - 1] - rows[0]) as f64;
                assert!((tall / person - 1.0).abs() < 0.2, "{tall} pixels, {person} asked for");
            }
        }
    }

    #[test]
    fn a_swarm_stands_round_its_pose() {
        let body = Body::adult(1750.0).unwrap();
        let pose: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
        let poses = swarm(&body, &pose, 9);
        assert_eq!(poses.len(), 9 * pose.len());
        assert_eq!(poses[..pose.len()], pose);
        for row in poses.chunks(pose.len()).skip(1) {
            assert_ne!(row, pose);
            for ((value, centre), (_, dof)) in row.iter().zip(&pose).zip(body.dofs()) {
                assert!(f64::from((value - centre).abs()) <= dof.step * 1.001 + 1e-6);
            }
        }
    }
}
