//! The mesh model (METHOD A4): a closed triangle mesh bound to the bones of a body, generated from its parts or read from
//! a skinned glTF file.

mod adjacency;
mod binding;
mod frusta;
mod gltf_file;
mod import;
mod joint_names;
mod source;

use anyhow::{Result, ensure};
use glam::{DAffine3, DVec3, Vec3};

use super::Body;
pub use adjacency::MeshEdge;
pub(super) use joint_names::plain as plain_name;
pub use source::{FrustumBase, MeshSource, Skinning};
pub(super) use source::{MeshEntry, build_source};

/// A closed triangle mesh bound to the bones of a body.
///
/// With G_i the matrix `world_from_bone` of bone i in a pose and B_i^-1 its inverse bind matrix, a vertex stands at
/// `p = sum_i w_i G_i B_i^-1 p_bind`. Every edge has exactly two triangles, which run through it in opposite directions, and
/// triangles are counter-clockwise seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The vertices.
    pub vertices: Vec<MeshVertex>,
    /// The triangles: indices of vertices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Every edge once, ordered by its ends.
    pub edges: Vec<MeshEdge>,
    /// How vertices hang on bones.
    pub skinning: Skinning,
    /// B_i^-1, `bone_from_bind`, one a bone of the body in file order; mm. Not always rigid: a limb of a read mesh is
    /// stretched along its bone to the body's length.
    pub inverse_bind: Vec<DAffine3>,
}

/// A vertex of a [`Mesh`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshVertex {
    /// Position in the bind pose, mm; axes of the root at rest (x forward, y left, z up).
    pub position: Vec3,
    /// Indices of up to four bones of the body in file order, the heaviest first; unused ones repeat the first.
    pub bones: [u16; 4],
    /// Their weights, not negative, of sum 1; unused ones are 0.
    pub weights: [f32; 4],
    /// Label in candidate images, 1..=127: that of the body's part the vertex belongs to.
    pub label: u8,
}

/// The mesh that a body without a `[mesh]` is drawn with.
const DEFAULT_BASE: FrustumBase = FrustumBase::Elliptic { vertices: 66 };

impl Mesh {
    /// The mesh of a body: what its `[mesh]` names, else elliptic frusta of 66 vertices a part.
    ///
    /// # Errors
    /// When the file cannot be read, is no skinned person, or does not fit the body; one sentence.
    pub fn of_body(body: &Body) -> Result<Self> {
        match &body.mesh {
            None => Self::frusta(body, DEFAULT_BASE, &Default::default()),
            Some(MeshSource::Skinned { file, skinning, joints }) => Self::read(file, body, *skinning, joints),
            Some(MeshSource::Frusta { base, flattening }) => Self::frusta(body, *base, flattening),
        }
    }

    /// A mesh from its parts; the edges are found.
    ///
    /// # Errors
    /// When it is not closed, not a surface, or not oriented consistently (the edge is named), an index is out of range, or a number
    /// not finite.
    pub fn new(
        vertices: Vec<MeshVertex>,
        triangles: Vec<[u32; 3]>,
        skinning: Skinning,
        inverse_bind: Vec<DAffine3>,
    ) -> Result<Self> {
        ensure!(!triangles.is_empty(), "it has no triangles, expected a closed surface");
        for (index, vertex) in vertices.iter().enumerate() {
            ensure!(
                vertex.position.is_finite(),
                "vertex {index} stands at {:?}, expected finite coordinates",
                vertex.position.to_array()
            );
            if let Some(bone) = vertex.bones.iter().find(|bone| usize::from(**bone) >= inverse_bind.len()) {
                anyhow::bail!("vertex {index} hangs on bone {bone}, the body has {}", inverse_bind.len());
            }
            let sum: f32 = vertex.weights.iter().sum();
            ensure!(
                vertex.weights.iter().all(|weight| *weight >= 0.0) && (sum - 1.0).abs() < 1e-4,
                "vertex {index} has the weights {:?} of sum {sum}, expected a sum of 1",
                vertex.weights
            );
        }
        let edges = adjacency::edges(&triangles, vertices.len())?;
        Ok(Self { vertices, triangles, edges, skinning, inverse_bind })
    }

    /// The vertices in the world, mm, in double precision inside: the yardstick of the evaluators' single precision.
    /// `world_from_bones` has one matrix a bone of the body in file order.
    ///
    /// # Errors
    /// When there are not as many matrices as bones.
    pub fn posed(&self, world_from_bones: &[DAffine3]) -> Result<Vec<Vec3>> {
        ensure!(
            world_from_bones.len() == self.inverse_bind.len(),
            "there are {} bone matrices, the mesh is bound to {} bones",
            world_from_bones.len(),
            self.inverse_bind.len()
        );
        let skin: Vec<DAffine3> =
            world_from_bones.iter().zip(&self.inverse_bind).map(|(world, inverse)| *world * *inverse).collect();
        let posed = |vertex: &MeshVertex| {
            let at = vertex.position.as_dvec3();
            let shares = vertex.bones.iter().zip(vertex.weights).filter(|(_, weight)| *weight > 0.0);
            let sum: DVec3 =
                shares.map(|(bone, weight)| skin[usize::from(*bone)].transform_point3(at) * f64::from(weight)).sum();
            sum.as_vec3()
        };
        Ok(self.vertices.iter().map(posed).collect())
    }
}
