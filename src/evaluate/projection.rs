//! One pose into one or all cameras, the simple way: a candidate at a time, a part at a time. The reference draws from
//! this, overlays too, and the batched front ends are held to it bit for bit.

use anyhow::{Result, ensure};

use crate::body::Body;
use crate::geometry::Camera;

use super::rig::{
    Affine, Rig, RigCamera, compose, depth_squared, end_on_corners, local_matrix, side_corners, sin_cos, snap,
    transform,
};

/// A part of the flat model as one camera sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PartQuad {
    /// Corners v1 v2 v3 v4 (METHOD A4) in 1/256 pixel; meaningless when not drawn.
    pub corners: [[i32; 2]; 4],
    /// Squared distance of the cone's mid-point from the camera, mm^2.
    pub depth_squared: f32,
    /// Whether every corner has an image.
    pub drawn: bool,
}

/// Projects poses of a body into cameras.
#[derive(Clone, Debug)]
pub struct Projector {
    pub(crate) rig: Rig,
    pub(crate) cameras: Vec<RigCamera>,
}

impl Projector {
    /// For a body and its cameras at working size.
    pub fn new(body: &Body, cameras: &[Camera]) -> Self {
        Self { rig: Rig::new(body), cameras: cameras.iter().map(RigCamera::new).collect() }
    }

    /// Exchanges the body for another one of as many degrees of freedom and parts.
    ///
    /// # Errors
    /// When their numbers differ.
    pub(crate) fn set_body(&mut self, body: &Body) -> Result<()> {
        let (old, new) = (&self.rig, Rig::new(body));
        ensure!(
            (new.dof_count, new.parts.len()) == (old.dof_count, old.parts.len()),
            "a body of {} degrees of freedom and {} parts cannot take the place of one of {} and {}",
            new.dof_count,
            new.parts.len(),
            old.dof_count,
            old.parts.len()
        );
        self.rig = new;
        Ok(())
    }

    /// The number of cameras.
    pub fn view_count(&self) -> usize {
        self.cameras.len()
    }

    /// The length of a pose.
    pub fn dof_count(&self) -> usize {
        self.rig.dof_count
    }

    /// The parts of a pose (mm, radians, in state-vector order) in view `view`, in the body's order. A pose shorter than
    /// the body's degrees of freedom reads as zero there.
    pub fn quads(&self, pose: &[f32], view: usize) -> Vec<PartQuad> {
        let mut world = Vec::new();
        self.bone_matrices(pose, &mut world);
        let camera = &self.cameras[view];
        self.rig
            .parts
            .iter()
            .map(|part| {
                let bone = &world[part.bone];
                let (a, b) = (transform(bone, part.a), transform(bone, part.b));
                let (mut corners, from_the_side) = side_corners(a, b, part.radius_a, part.radius_b, camera.centre);
                if !from_the_side {
                    corners = end_on_corners(a, b, part.radius_a, part.radius_b, camera.centre);
                }
                let mut quad =
                    PartQuad { depth_squared: depth_squared(a, b, camera.centre), drawn: true, ..PartQuad::default() };
                for (corner, point) in quad.corners.iter_mut().zip(corners) {
                    let (pixel, has_image) = camera.project(point);
                    quad.drawn &= has_image;
                    *corner = pixel.map(snap);
                }
                quad
            })
            .collect()
    }

    /// Global matrices of the rig's bones, in place of what is in `world`.
    pub(crate) fn bone_matrices(&self, pose: &[f32], world: &mut Vec<Affine>) {
        world.clear();
        for bone in &self.rig.bones {
            let value = |slot: usize| bone.slots[slot].and_then(|index| pose.get(index).copied());
            let translation = [0, 1, 2].map(|axis| value(axis).unwrap_or(0.0));
            let turned = [3, 4, 5].map(|slot| value(slot).map_or((0.0, 1.0), sin_cos));
            let local = local_matrix(bone, translation, turned.map(|t| t.0), turned.map(|t| t.1));
            world.push(bone.parent.map_or(local, |parent| compose(&world[parent], &local)));
        }
    }
}
