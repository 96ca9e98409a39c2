//! A skinned file bound to a body: its axes, size and joints turned into the body's bones.
//!
//! The file's person is turned upright and forward, scaled to the body's height, and laid over the body at rest by the
//! roots of the limbs. The trunk keeps the shape it has in the bind pose: A- and T-poses differ from the rest pose in
//! the limbs alone, and where a trunk bends is where the body says. A limb's bones are bound at the file's joints, turned by the
//! swing from the body's direction of the bone to the file's (a twist comes down from the bone above), and stretched along
//! that direction to the body's length, so that in any pose the mesh has its joints where the body has them.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::frusta::rest_origins;
use super::gltf_file::{self, BoundVertex, SkinnedFile};
use super::joint_names::JointMap;
use super::{Mesh, MeshVertex, Skinning};
use crate::body::{Body, without_side};

/// By how much a bone may be stretched; more is a joint of another bone.
const STRETCH: std::ops::RangeInclusive<f64> = 0.2..=5.0;

/// Bones of the trunk even where but one bone follows.
const TRUNK: [&str; 4] = ["pelvis", "thorax", "clavicle", "head"];

impl Mesh {
    /// The skinned person of a glTF file (.glb or .gltf) bound to a body; `joints` as [`super::MeshSource::Skinned`] has them.
    ///
    /// # Errors
    /// When the file cannot be read or is no skinned person, its joints do not make the body's bones, or its surface is
    /// not closed; one sentence with the file.
    pub fn read(path: &Path, body: &Body, skinning: Skinning, joints: &BTreeMap<String, String>) -> Result<Self> {
        let file = gltf_file::read(path)?;
        bind(file, body, skinning, joints).with_context(|| path.display().to_string())
    }
}

/// [`Mesh::read`] of a file already read.
pub(super) fn bind(
    mut file: SkinnedFile,
    body: &Body,
    skinning: Skinning,
    asked: &BTreeMap<String, String>,
) -> Result<Mesh> {
    let mut map = JointMap::of_limbs(body, &file.joints, asked.iter())?;
    let origins = rest_origins(body);
    lay_over(&mut file, body, &map, &origins)?;
    let places: Vec<DVec3> = file.joints.iter().map(|joint| joint.at).collect();
    map.add_trunk(body, &file.joints, &places, &origins)?;
    let inverse_bind = inverse_bind(body, &map, &places, &origins)?;
    let root = body.update_order.first().copied().unwrap_or(0);
    let bone_of_joint = map.bone_of_joints(&file.joints, root)?;
    let mut vertices = Vec::with_capacity(file.vertices.len());
    for vertex in &file.vertices {
        vertices.push(bound(vertex, &bone_of_joint, body, &inverse_bind, skinning)?);
    }
    match Mesh::new(vertices.clone(), file.triangles.clone(), skinning, inverse_bind.clone()) {
        Ok(mesh) => Ok(mesh),
        // Files double vertices where their texture has a seam.
        Err(_) => {
            let (vertices, triangles) = welded(&vertices, &file.triangles);
            Mesh::new(vertices, triangles, skinning, inverse_bind)
        }
    }
}

/// Brings joints and vertices from the file's world (metres, y up) over the body at rest (mm, x forward, z up), root at its
/// offset.
pub(super) fn lay_over(file: &mut SkinnedFile, body: &Body, map: &JointMap, origins: &[DVec3]) -> Result<()> {
    let upright = |at: DVec3| DVec3::new(at.z, at.x, at.y) * 1000.0;
    let pairs: Vec<(usize, usize)> =
        map.of_bone.iter().enumerate().filter_map(|(bone, joint)| joint.map(|joint| (bone, joint))).collect();
    // Forward is where every left joint has its right one on its right.
    let mut across = DVec3::ZERO;
    for &(bone, joint) in &pairs {
        if let Some(twin) = body.bones[bone].name.strip_prefix("left_")
            && let Some(twin) = body.bone_index(&format!("right_{twin}"))
            && let Some(twin) = map.of_bone[twin]
        {
            across += upright(file.joints[joint].at - file.joints[twin].at);
        }
    }
    let yaw = if across.truncate().length() > 1.0 {
        DQuat::from_rotation_z(across.x.atan2(across.y))
    } else {
        DQuat::IDENTITY
    };
    let heights = file.vertices.iter().map(|vertex| upright(vertex.at).z);
    let extent = heights.clone().fold(f64::NEG_INFINITY, f64::max) - heights.fold(f64::INFINITY, f64::min);
    let scale = height_at_rest(body, origins) / extent;
    ensure!(scale.is_finite() && scale > 0.0, "its person is {extent} mm tall, the body cannot be scaled to it");
    let turned = |at: DVec3| yaw * upright(at) * scale;

    // The roots of the limbs, whose joints are as sure as any; without limbs, whatever is known.
    let is_limb_root = |bone: usize| {
        let name = &body.bones[bone].name;
        ["hip", "shoulder"].iter().any(|core| name.ends_with(core))
    };
    let roots: Vec<&(usize, usize)> = pairs.iter().filter(|(bone, _)| is_limb_root(*bone)).collect();
    let anchors = if roots.is_empty() { pairs.iter().collect() } else { roots };
    let shifts = anchors.iter().map(|(bone, joint)| origins[*bone] - turned(file.joints[*joint].at));
    let shift = match anchors.len() {
        // Known names come later, so the joint at the top of the tree has to do.
        0 => {
            let top = file.joints.iter().find(|joint| joint.parent.is_none());
            let root = body.update_order.first().map_or(DVec3::ZERO, |&root| origins[root]);
            top.map_or(DVec3::ZERO, |top| root - turned(top.at))
        }
        count => shifts.sum::<DVec3>() / count as f64,
    };
    for at in file.joints.iter_mut().map(|joint| &mut joint.at).chain(file.vertices.iter_mut().map(|v| &mut v.at)) {
        *at = turned(*at) + shift;
    }
    Ok(())
}

/// How tall the parts stand at rest, mm.
pub(super) fn height_at_rest(body: &Body, origins: &[DVec3]) -> f64 {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for part in &body.parts {
        let axis = (part.b - part.a).normalize();
        // The disc of a cone's end reaches up and down by its radius times the sine of the axis with the vertical.
        let reach = (1.0 - axis.z * axis.z).max(0.0).sqrt();
        for (end, radius) in [(part.a, part.radius_a), (part.b, part.radius_b)] {
            let z = origins[part.bone].z + end.z;
            low = low.min(z - radius * reach);
            high = high.max(z + radius * reach);
        }
    }
    high - low
}

/// What follows a bone: a bone or a free end with a joint, by its offset at rest and its joint.
pub(super) struct Follower {
    pub(super) offset: DVec3,
    pub(super) joint: usize,
}

pub(super) fn followers(body: &Body, map: &JointMap, origins: &[DVec3], bone: usize) -> Vec<Follower> {
    let nearest_known_above = |index: usize| {
        let above = std::iter::successors(body.bones[index].parent, |&at| body.bones[at].parent);
        above.into_iter().find(|&at| map.of_bone[at].is_some())
    };
    let bones = (0..body.bones.len())
        .filter(|&index| nearest_known_above(index) == Some(bone))
        .filter_map(|index| map.of_bone[index].map(|joint| Follower { offset: origins[index] - origins[bone], joint }));
    let ends = body.free_ends();
    let ends = ends
        .iter()
        .zip(&map.of_end)
        .filter(|(end, _)| end.bone == bone)
        .filter_map(|(end, joint)| joint.map(|joint| Follower { offset: end.at, joint }));
    bones.chain(ends).collect()
}

/// Whether a bone of that name is of the trunk, on either side.
pub(super) fn is_of_trunk(name: &str) -> bool {
    TRUNK.contains(&without_side(name))
}

/// B_i^-1 of every bone.
fn inverse_bind(body: &Body, map: &JointMap, places: &[DVec3], origins: &[DVec3]) -> Result<Vec<DAffine3>> {
    let mut inverse: Vec<DAffine3> = origins.iter().map(|origin| DAffine3::from_translation(-*origin)).collect();
    // How the bind pose turns each bone, and whether it is a limb's.
    let mut turned = vec![(DQuat::IDENTITY, false); body.bones.len()];
    for &bone in &body.update_order {
        let above = body.bones[bone].parent.map_or((DQuat::IDENTITY, false), |parent| turned[parent]);
        let following = followers(body, map, origins, bone);
        let name = body.bones[bone].name.as_str();
        let begins_limb = following.len() == 1 && body.bones[bone].parent.is_some() && !is_of_trunk(name);
        turned[bone] = (above.0, above.1 || begins_limb);
        let Some(joint) = map.of_bone[bone].filter(|_| turned[bone].1) else { continue };
        let mut stretch = DMat3::IDENTITY;
        if let [Follower { offset, joint: next }] = following[..] {
            let toward = places[next] - places[joint];
            let (length, found) = (offset.length(), toward.length());
            let factor = length / found;
            ensure!(
                STRETCH.contains(&factor),
                "from the joint of bone `{name}` to the next are {found:.0} mm at the body's height, the body has {length:.0} mm"
            );
            let direction = offset / length;
            turned[bone].0 = DQuat::from_rotation_arc(above.0 * direction, toward / found) * above.0;
            let along = DMat3::from_cols(direction * direction.x, direction * direction.y, direction * direction.z);
            stretch = DMat3::IDENTITY + along * (factor - 1.0);
        }
        let turn = DMat3::from_quat(turned[bone].0.inverse());
        inverse[bone] = DAffine3::from_mat3(stretch * turn) * DAffine3::from_translation(-places[joint]);
    }
    Ok(inverse)
}

/// A vertex with its joints folded into the body's bones, and its label.
fn bound(
    vertex: &BoundVertex,
    bone_of_joint: &[usize],
    body: &Body,
    inverse_bind: &[DAffine3],
    skinning: Skinning,
) -> Result<MeshVertex> {
    let mut shares: BTreeMap<usize, f64> = BTreeMap::new();
    for &(joint, share) in &vertex.weights {
        *shares.entry(bone_of_joint[joint]).or_default() += share;
    }
    let mut heaviest: Vec<(usize, f64)> = shares.into_iter().collect();
    // Stable, so that equal weights leave the bone that is first in the body's file first.
    heaviest.sort_by(|l, r| r.1.total_cmp(&l.1));
    heaviest.truncate(if skinning == Skinning::Rigid { 1 } else { 4 });
    let sum: f64 = heaviest.iter().map(|(_, share)| share).sum();
    let mut bones = [u16::try_from(heaviest[0].0).context("the body has too many bones for a mesh")?; 4];
    let mut weights = [0.0; 4];
    for (slot, (bone, share)) in heaviest.iter().enumerate() {
        bones[slot] = u16::try_from(*bone).context("the body has too many bones for a mesh")?;
        weights[slot] = (share / sum) as f32;
    }
    let label = label(body, heaviest[0].0, inverse_bind[heaviest[0].0].transform_point3(vertex.at));
    Ok(MeshVertex { position: vertex.at.as_vec3(), bones, weights, label })
}

/// The label of the part nearest to a point in the frame of a bone: of that bone's, or of the nearest bone above that has
/// any.
fn label(body: &Body, bone: usize, at: DVec3) -> u8 {
    let (mut bone, mut at) = (bone, at);
    loop {
        let distance = |part: &&crate::body::Part| {
            let axis = part.b - part.a;
            let along = ((at - part.a).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
            at.distance_squared(part.a + axis * along)
        };
        let own = body.parts.iter().filter(|part| part.bone == bone);
        if let Some(part) = own.min_by(|l, r| distance(l).total_cmp(&distance(r))) {
            return part.label;
        }
        match body.bones[bone].parent {
            Some(parent) => {
                at += body.bones[bone].offset;
                bone = parent;
            }
            // A root without parts: the body has at least one.
            None => return body.parts.first().map_or(1, |part| part.label),
        }
    }
}

/// The surface with vertices of the same place made one, and without the triangles that this leaves flat.
fn welded(vertices: &[MeshVertex], triangles: &[[u32; 3]]) -> (Vec<MeshVertex>, Vec<[u32; 3]>) {
    let mut kept: Vec<MeshVertex> = Vec::new();
    let mut index_at: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    let mut now = Vec::with_capacity(vertices.len());
    for vertex in vertices {
        // Zero has two signs.
        let key = vertex.position.to_array().map(|coordinate| (coordinate + 0.0).to_bits());
        let next = kept.len() as u32;
        let index = *index_at.entry(key).or_insert(next);
        if index == next {
            kept.push(*vertex);
        }
        now.push(index);
    }
    let triangles = triangles.iter().map(|triangle| triangle.map(|vertex| now[vertex as usize]));
    (kept, triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect())
}

#[cfg(test)]
#[path = "binding_tests.rs"]
mod tests;
