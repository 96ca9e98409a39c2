//! The vertices of the mesh model in one view: posed, projected and given a depth, in the single precision of the
//! flat model (`rig.rs`). What a graphics device computes in its vertex stages is held to this.

use anyhow::{Result, anyhow, ensure};

use crate::body::{Body, Mesh, Skinning};
use crate::geometry::Camera;

use super::projection::Projector;
use super::rig::{Affine, affine, compose, snap, transform};
use super::shaders;

/// The depth of a point at camera-space z is `1 - NEAR / z`, mm.
pub const NEAR: f32 = shaders::MESH_NEAR;

/// By how much silhouette edges are drawn nearer than they are, mm: at a silhouette the surface turns away, so that half a pixel
/// inside it is already nearer to the camera than its edge.
pub const EDGE_BIAS: f32 = shaders::MESH_EDGE_BIAS;

/// Vertices nearer than this along the camera's axis have no image, mm: depths stay between 0 and 1 with the bias, too.
pub const NEAREST: f32 = shaders::MESH_NEAREST;

/// A depth, 0.4 to 1, as the whole number that pixels are told apart by: the nearest of 2^24 times it, a tie upwards, at most
/// 2^24 - 1.
#[inline(always)]
pub(crate) fn depth_number(depth: f32) -> u32 {
    const MOST: f32 = 16_777_215.0;
    // From 1/2 on the product is whole, below it a whole number or half of one.
    let scaled = depth * 16_777_216.0;
    let scaled = if scaled < MOST { scaled } else { MOST };
    let scaled = if scaled > 0.0 { scaled } else { 0.0 };
    let whole = scaled as i32;
    (whole + i32::from(scaled - whole as f32 >= 0.5)) as u32
}

/// Why another body cannot take the place of a mesh's own.
pub(crate) fn bound_to_its_body() -> anyhow::Error {
    anyhow!("a mesh is bound to the body it was made with: another body needs an evaluator of its own")
}

/// A vertex of the mesh model as one camera sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProjectedVertex {
    /// Position in 1/256 pixel; meaningless without an image.
    pub at: [i32; 2],
    /// Its depth, 0 to 1, larger is farther: `1 - NEAR / z`.
    pub depth: f32,
    /// Its depth as the end of a silhouette edge: `1 - NEAR / (z - EDGE_BIAS)`.
    pub edge_depth: f32,
    /// Whether it has an image.
    pub has_image: bool,
}

/// Projects poses of a mesh into cameras.
#[derive(Clone, Debug)]
pub struct MeshProjector {
    pub(crate) projector: Projector,
    mesh: Mesh,
    /// B_i^-1, one a bone of the rig.
    pub(crate) inverse_bind: Vec<Affine>,
    /// The place in the rig of each bone of the body.
    pub(crate) place_in_rig: Vec<usize>,
}

impl MeshProjector {
    /// For a body, a mesh bound to it, and its cameras at working size.
    ///
    /// # Errors
    /// When the mesh is bound to another number of bones.
    pub fn new(body: &Body, mesh: Mesh, cameras: &[Camera]) -> Result<Self> {
        ensure!(
            mesh.inverse_bind.len() == body.bones.len(),
            "the mesh is bound to {} bones, the body `{}` has {}",
            mesh.inverse_bind.len(),
            body.name,
            body.bones.len()
        );
        let mut place_in_rig = vec![0; body.bones.len()];
        for (place, &bone) in body.update_order.iter().enumerate() {
            place_in_rig[bone] = place;
        }
        let inverse_bind = body.update_order.iter().map(|&bone| affine(&mesh.inverse_bind[bone])).collect();
        Ok(Self { projector: Projector::new(body, cameras), mesh, inverse_bind, place_in_rig })
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The vertices of a pose (mm, radians, in state-vector order) in the world, mm.
    pub fn posed(&self, pose: &[f32]) -> Vec<[f32; 3]> {
        let mut world = Vec::new();
        self.projector.bone_matrices(pose, &mut world);
        let skin: Vec<Affine> =
            world.iter().zip(&self.inverse_bind).map(|(world, inverse)| compose(world, inverse)).collect();
        let of_bone = |bone: u16| &skin[self.place_in_rig[usize::from(bone)]];
        let posed = self.mesh.vertices.iter().map(|vertex| {
            let at = vertex.position.to_array();
            let [a, b, c, d] = vertex.bones.map(|bone| transform(of_bone(bone), at));
            if self.mesh.skinning == Skinning::Rigid {
                return a;
            }
            let w = vertex.weights;
            [0, 1, 2].map(|axis| ((w[0] * a[axis] + w[1] * b[axis]) + w[2] * c[axis]) + w[3] * d[axis])
        });
        posed.collect()
    }

    /// The vertices of a pose in view `view`. A pose shorter than the body's degrees of freedom reads as zero there.
    pub fn vertices(&self, pose: &[f32], view: usize) -> Vec<ProjectedVertex> {
        let camera = &self.projector.cameras[view];
        let project = |point: [f32; 3]| {
            let (pixel, has_image) = camera.project(point);
            let z = transform(&camera.camera_from_world, point)[2];
            ProjectedVertex {
                at: pixel.map(snap),
                depth: 1.0 - NEAR / z,
                edge_depth: 1.0 - NEAR / (z - EDGE_BIAS),
                has_image: has_image && z >= NEAREST,
            }
        };
        self.posed(pose).into_iter().map(project).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DMat3, DVec2, DVec3};

    use super::*;
    use crate::geometry::{BrownConrady, Lens};

    #[test]
    fn single_precision_follows_double_and_depth_is_that_of_z() {
        let mut body = Body::adult(1750.0).unwrap();
        // A child before its parent in the file: the rig's order is another one.
        body.bones.swap(2, 7);
        for bone in &mut body.bones {
            bone.parent = bone.parent.map(|parent| [0, 1, 7, 3, 4, 5, 6, 2, 8, 9, 10, 11, 12, 13, 14][parent]);
        }
        for part in &mut body.parts {
            part.bone = [0, 1, 7, 3, 4, 5, 6, 2, 8, 9, 10, 11, 12, 13, 14][part.bone];
        }
        body.update_order = vec![0, 1, 7, 3, 4, 5, 6, 2, 8, 9, 10, 11, 12, 13, 14];
        let mut mesh = Mesh::of_body(&body).unwrap();
        // Two bones a vertex, to take the smooth way.
        mesh.skinning = Skinning::Smooth;
        for (index, vertex) in mesh.vertices.iter_mut().enumerate() {
            vertex.bones[1] = (index % 15) as u16;
            vertex.weights = [0.75, 0.25, 0.0, 0.0];
        }
        let looking_along_x = DMat3::from_cols(DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y);
        let camera = Camera {
            name: "c".into(),
            size: [640, 480],
            camera_from_world: DAffine3::from_mat3_translation(looking_along_x, DVec3::new(0.0, 900.0, 4000.0)),
            lens: Lens::BrownConrady(BrownConrady {
                focal: DVec2::splat(800.0),
                centre: DVec2::new(320.0, 240.0),
                radial: [-0.1, 0.02, 0.0],
                tangential: [1e-3, 0.0],
            }),
        };
        let pose: Vec<f64> = (0..body.dof_count()).map(|dof| (dof as f64 * 0.7).sin() * 0.6).collect();
        let expected = mesh.posed(&body.world_from_bones(&pose).unwrap()).unwrap();
        let projector = MeshProjector::new(&body, mesh, std::slice::from_ref(&camera)).unwrap();
        let single: Vec<f32> = pose.iter().map(|value| *value as f32).collect();
        let posed = projector.posed(&single);
        let vertices = projector.vertices(&single, 0);
        for ((expected, posed), vertex) in expected.iter().zip(&posed).zip(&vertices) {
            assert!(expected.distance((*posed).into()) < 0.01, "{posed:?} is not {expected}");
            let pixel = camera.project(expected.as_dvec3()).unwrap();
            let found = DVec2::new(f64::from(vertex.at[0]), f64::from(vertex.at[1])) / 256.0;
            assert!(vertex.has_image && found.distance(pixel) < 0.01, "{found} is not {pixel}");
            let z = camera.camera_from_world.transform_point3(expected.as_dvec3()).z;
            assert!((f64::from(vertex.depth) - (1.0 - 100.0 / z)).abs() < 1e-6);
            assert!((f64::from(vertex.edge_depth) - (1.0 - 100.0 / (z - 30.0))).abs() < 1e-6);
        }
    }
}
