//! The vertices of a mesh, posed and projected sixteen at a time. Every loop over lanes calls the functions of
//! [`crate::evaluate::rig`] that the reference calls, in its order, so places and depths are the same to the bit.

#![allow(clippy::needless_range_loop, reason = "loops over lanes say so, and several rows share the index")]

use crate::body::Skinning;
use crate::evaluate::mesh_projection::{EDGE_BIAS, MeshProjector, NEAR, NEAREST, depth_number};
use crate::evaluate::rig::{Affine, RigCamera, RigLens, compose, snap, transform};

use super::super::front::LANES;
use super::surface::Seen;

type Row = [f32; LANES];

/// Sixteen vertices as they are bound; the last ones of a mesh repeat its last.
#[derive(Clone, Debug)]
#[repr(align(64))]
struct Bound {
    at: [Row; 3],
    /// Places in the rig of the bones.
    bones: [[u16; LANES]; 4],
    weights: [Row; 4],
    /// Whether all of them hang on the same bones.
    is_uniform: bool,
}

/// The vertices of a mesh.
#[derive(Clone, Debug)]
pub(super) struct Vertices {
    chunks: Vec<Bound>,
    skinning: Skinning,
}

/// Room for the vertices of a candidate.
#[derive(Clone, Debug, Default)]
pub(super) struct Posed {
    /// The rig's bones in the world.
    world: Vec<Affine>,
    /// The same from the bind pose.
    skin: Vec<Affine>,
    /// Places in the world, mm: `at[chunk][axis]`.
    at: Vec<[Row; 3]>,
}

impl Posed {
    pub(super) fn new(vertices: &Vertices, bones: usize) -> Self {
        Self {
            world: Vec::with_capacity(bones),
            skin: Vec::with_capacity(bones),
            at: vec![[[0.0; LANES]; 3]; vertices.chunks.len()],
        }
    }
}

impl Vertices {
    pub(super) fn new(projector: &MeshProjector) -> Self {
        let mesh = projector.mesh();
        let chunk = |first: usize| {
            let mut bound =
                Bound { at: [[0.0; LANES]; 3], bones: [[0; LANES]; 4], weights: [[0.0; LANES]; 4], is_uniform: true };
            for lane in 0..LANES {
                let vertex = &mesh.vertices[(first + lane).min(mesh.vertices.len() - 1)];
                for axis in 0..3 {
                    bound.at[axis][lane] = vertex.position[axis];
                }
                for share in 0..4 {
                    let place = projector.place_in_rig[usize::from(vertex.bones[share])];
                    bound.bones[share][lane] = place as u16;
                    bound.weights[share][lane] = vertex.weights[share];
                }
            }
            bound.is_uniform = bound.bones.iter().all(|bones| bones.iter().all(|bone| *bone == bones[0]));
            bound
        };
        let chunks = (0..mesh.vertices.len()).step_by(LANES).map(chunk).collect();
        Self { chunks, skinning: mesh.skinning }
    }

    /// The room that [`Self::project`] needs.
    pub(super) fn seen(&self) -> Seen {
        let all = vec![[0; 2]; self.chunks.len() * LANES];
        Seen { places: all.clone(), depths: all, is_whole: true }
    }

    /// Poses a candidate.
    #[inline(always)]
    pub(super) fn pose(&self, projector: &MeshProjector, pose: &[f32], posed: &mut Posed) {
        projector.projector.bone_matrices(pose, &mut posed.world);
        posed.skin.clear();
        let bones = posed.world.iter().zip(&projector.inverse_bind);
        posed.skin.extend(bones.map(|(world, inverse)| compose(world, inverse)));
        let is_rigid = self.skinning == Skinning::Rigid;
        for (bound, at) in self.chunks.iter().zip(&mut posed.at) {
            let of = |share: usize, lane: usize| posed.skin[usize::from(bound.bones[share][lane])];
            let shared = [0, 1, 2, 3].map(|share| of(share, 0));
            match (bound.is_uniform, is_rigid) {
                (true, true) => bound.place(at, |_| shared[0]),
                (false, true) => bound.place(at, |lane| of(0, lane)),
                (true, false) => bound.blend(at, |share, _| shared[share]),
                (false, false) => bound.blend(at, of),
            }
        }
    }

    /// Projects them into a camera; returns the corners of what surrounds the pixels that anything of them may be drawn in.
    #[inline(always)]
    pub(super) fn project(&self, camera: &RigCamera, posed: &Posed, seen: &mut Seen) -> [[i32; 2]; 2] {
        // Each kind of lens as a constant, so that the loops over lanes do not choose between them.
        match camera.lens {
            RigLens::Tsai { kappa, focal, centre } => {
                let lens = RigLens::Tsai { kappa, focal, centre };
                project_through(&RigCamera { lens, ..*camera }, posed, seen)
            }
            RigLens::BrownConrady { focal, centre, radial, tangential, max_radius_squared } => {
                let lens = RigLens::BrownConrady { focal, centre, radial, tangential, max_radius_squared };
                project_through(&RigCamera { lens, ..*camera }, posed, seen)
            }
        }
    }
}

impl Bound {
    /// Places vertices that each hang on one bone.
    #[inline(always)]
    fn place(&self, at: &mut [Row; 3], bone: impl Fn(usize) -> Affine) {
        for lane in 0..LANES {
            let point = transform(&bone(lane), [0, 1, 2].map(|axis| self.at[axis][lane]));
            for axis in 0..3 {
                at[axis][lane] = point[axis];
            }
        }
    }

    /// Places vertices that each hang on four bones.
    #[inline(always)]
    fn blend(&self, at: &mut [Row; 3], bone: impl Fn(usize, usize) -> Affine) {
        for lane in 0..LANES {
            let point = [0, 1, 2].map(|axis| self.at[axis][lane]);
            let [a, b, c, d] = [0, 1, 2, 3].map(|share| transform(&bone(share, lane), point));
            let w = [0, 1, 2, 3].map(|share| self.weights[share][lane]);
            for axis in 0..3 {
                at[axis][lane] = ((w[0] * a[axis] + w[1] * b[axis]) + w[2] * c[axis]) + w[3] * d[axis];
            }
        }
    }
}

#[inline(always)]
fn project_through(camera: &RigCamera, posed: &Posed, seen: &mut Seen) -> [[i32; 2]; 2] {
    let (mut low, mut high) = ([[i32::MAX; LANES]; 2], [[i32::MIN; LANES]; 2]);
    let mut images = [true; LANES];
    let rooms = seen.places.chunks_exact_mut(LANES).zip(seen.depths.chunks_exact_mut(LANES));
    for (at, (places, depths)) in posed.at.iter().zip(rooms) {
        let (mut x, mut y) = ([0; LANES], [0; LANES]);
        let (mut depth, mut edge_depth) = ([0; LANES], [0; LANES]);
        for lane in 0..LANES {
            let point = [at[0][lane], at[1][lane], at[2][lane]];
            let (pixel, has_image) = camera.project(point);
            let z = transform(&camera.camera_from_world, point)[2];
            let has_image = has_image & (z >= NEAREST);
            images[lane] &= has_image;
            let or_none = |number: u32| if has_image { number as i32 } else { Seen::NO_IMAGE };
            depth[lane] = or_none(depth_number(1.0 - NEAR / z));
            edge_depth[lane] = or_none(depth_number(1.0 - NEAR / (z - EDGE_BIAS)));
            let or_zero = |at: i32| if has_image { at } else { 0 };
            x[lane] = or_zero(snap(pixel[0]));
            y[lane] = or_zero(snap(pixel[1]));
            let meet = |bounds: &mut [i32; LANES], at: i32, farther: i32, is_less: bool| {
                let at = if has_image { at } else { farther };
                bounds[lane] = if is_less { bounds[lane].min(at) } else { bounds[lane].max(at) };
            };
            meet(&mut low[0], x[lane], i32::MAX, true);
            meet(&mut low[1], y[lane], i32::MAX, true);
            meet(&mut high[0], x[lane], i32::MIN, false);
            meet(&mut high[1], y[lane], i32::MIN, false);
        }
        for lane in 0..LANES {
            places[lane] = [x[lane], y[lane]];
            depths[lane] = [depth[lane], edge_depth[lane]];
        }
    }
    seen.is_whole = images.iter().all(|has_image| *has_image);
    let [width, height] = camera.size;
    let clamped = |at: i32, size: u32| (at.saturating_add(128) >> 8).clamp(0, size as i32);
    let least = low.map(|lanes| lanes.into_iter().fold(i32::MAX, i32::min));
    let most = high.map(|lanes| lanes.into_iter().fold(i32::MIN, i32::max).saturating_add(256));
    [[clamped(least[0], width), clamped(least[1], height)], [clamped(most[0], width), clamped(most[1], height)]]
}
