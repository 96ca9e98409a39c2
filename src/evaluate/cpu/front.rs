//! Poses to snapped corners for sixteen candidates at a time: kinematics with candidates in lanes, projection with parts
//! in lanes. Every loop over lanes calls the function of [`crate::evaluate::rig`] that the reference calls, so the corners
//! are the same to the bit; the loops are written for the compiler to vectorise.

#![allow(clippy::needless_range_loop, reason = "loops over lanes say so, and several rows share the index")]

use crate::evaluate::rig::{
    Rig, RigBone, RigCamera, RigLens, compose, depth_squared, end_on_corners, local_matrix, side_corners, sin_cos,
    snap, transform,
};

/// Lanes of the front end.
pub(super) const LANES: usize = 16;

type Row = [f32; LANES];

/// Sixteen parts of one candidate in one view; a body of more parts takes several.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct QuadChunk {
    /// Corner coordinates in 1/256 pixel: `x[corner][part]`.
    pub(super) x: [[i32; LANES]; 4],
    pub(super) y: [[i32; LANES]; 4],
    /// Squared distance of the part.
    pub(super) depth_squared: Row,
    /// 1 where every corner has an image, else 0.
    pub(super) drawn: [u32; LANES],
}

impl Default for QuadChunk {
    fn default() -> Self {
        Self { x: [[0; LANES]; 4], y: [[0; LANES]; 4], depth_squared: [0.0; LANES], drawn: [0; LANES] }
    }
}

/// World positions of the ends of sixteen parts of one candidate: `a` and `b`, x y z.
#[derive(Clone, Debug)]
#[repr(align(64))]
struct EndChunk {
    a: [Row; 3],
    b: [Row; 3],
}

/// Radii of sixteen parts; lanes past the last part hold zero and are never drawn.
#[derive(Clone, Debug)]
struct RadiusChunk {
    a: Row,
    b: Row,
    count: usize,
}

/// Working memory of one worker.
#[derive(Clone, Debug)]
pub(super) struct Front {
    /// Global bone matrices: `world[bone][element][candidate]`.
    world: Vec<[Row; 12]>,
    /// Part ends: `ends[candidate * chunks + chunk]`.
    ends: Vec<EndChunk>,
    radii: Vec<RadiusChunk>,
    /// Projected corners before snapping, kept here so that the loops over lanes have fixed homes.
    corners: Box<[[Row; 3]; 4]>,
}

impl Front {
    pub(super) fn new(rig: &Rig) -> Self {
        let radii: Vec<RadiusChunk> = rig
            .parts
            .chunks(LANES)
            .map(|parts| {
                let mut chunk = RadiusChunk { a: [0.0; LANES], b: [0.0; LANES], count: parts.len() };
                for (lane, part) in parts.iter().enumerate() {
                    chunk.a[lane] = part.radius_a;
                    chunk.b[lane] = part.radius_b;
                }
                chunk
            })
            .collect();
        Self {
            world: vec![[[0.0; LANES]; 12]; rig.bones.len()],
            ends: vec![EndChunk { a: [[0.0; LANES]; 3], b: [[0.0; LANES]; 3] }; LANES * radii.len()],
            radii,
            corners: Box::new([[[0.0; LANES]; 3]; 4]),
        }
    }

    /// The number of chunks of sixteen parts.
    pub(super) fn chunk_count(&self) -> usize {
        self.radii.len()
    }

    /// Poses up to sixteen candidates (rows of `rig.dof_count`), leaving the ends of all their parts.
    #[inline(always)]
    pub(super) fn pose(&mut self, rig: &Rig, poses: &[f32]) {
        let count = poses.len() / rig.dof_count;
        for (index, bone) in rig.bones.iter().enumerate() {
            let mut translation = [[0.0; LANES]; 3];
            let mut sin = [[0.0; LANES]; 3];
            let mut cos = [[1.0; LANES]; 3];
            for slot in 0..6 {
                let Some(dof) = bone.slots[slot] else { continue };
                let mut values = [0.0; LANES];
                for (lane, value) in values.iter_mut().enumerate().take(count) {
                    *value = poses[lane * rig.dof_count + dof];
                }
                if slot < 3 {
                    translation[slot] = values;
                } else {
                    for lane in 0..LANES {
                        (sin[slot - 3][lane], cos[slot - 3][lane]) = sin_cos(values[lane]);
                    }
                }
            }
            let (parents, own) = self.world.split_at_mut(index);
            let own = &mut own[0];
            let parent = bone.parent.map(|parent| &parents[parent]);
            if bone.axes == [0, 1, 2] {
                // The usual order as constants, so that the loop over lanes has fixed places for the elements.
                place_bone(
                    &RigBone { axes: [0, 1, 2], parity: 1.0, ..bone.clone() },
                    parent,
                    &translation,
                    &sin,
                    &cos,
                    own,
                );
            } else {
                place_bone(bone, parent, &translation, &sin, &cos, own);
            }
        }
        let chunks = self.radii.len();
        for (index, part) in rig.parts.iter().enumerate() {
            let (chunk, part_lane) = (index / LANES, index % LANES);
            let world = &self.world[part.bone];
            let mut a = [[0.0; LANES]; 3];
            let mut b = [[0.0; LANES]; 3];
            for lane in 0..LANES {
                let bone = gather(world, lane);
                let (end_a, end_b) = (transform(&bone, part.a), transform(&bone, part.b));
                for axis in 0..3 {
                    a[axis][lane] = end_a[axis];
                    b[axis][lane] = end_b[axis];
                }
            }
            for candidate in 0..count {
                let ends = &mut self.ends[candidate * chunks + chunk];
                for axis in 0..3 {
                    ends.a[axis][part_lane] = a[axis][candidate];
                    ends.b[axis][part_lane] = b[axis][candidate];
                }
            }
        }
    }

    /// Projects the parts of one posed candidate into a camera: one quad chunk for every sixteen parts.
    #[inline(always)]
    pub(super) fn project(&mut self, camera: &RigCamera, candidate: usize, quads: &mut [QuadChunk]) {
        // Each kind of lens as a constant, so that the loops over lanes do not choose between them.
        match camera.lens {
            RigLens::Tsai { kappa, focal, centre } => {
                let lens = RigLens::Tsai { kappa, focal, centre };
                self.project_through(&RigCamera { lens, ..*camera }, candidate, quads);
            }
            RigLens::BrownConrady { focal, centre, radial, tangential, max_radius_squared } => {
                let lens = RigLens::BrownConrady { focal, centre, radial, tangential, max_radius_squared };
                self.project_through(&RigCamera { lens, ..*camera }, candidate, quads);
            }
        }
    }

    #[inline(always)]
    fn project_through(&mut self, camera: &RigCamera, candidate: usize, quads: &mut [QuadChunk]) {
        let chunks = self.radii.len();
        for chunk in 0..chunks {
            let (ends, radii) = (&self.ends[candidate * chunks + chunk], &self.radii[chunk]);
            let quad = &mut quads[chunk];
            let mut end_on = [0_u32; LANES];
            for lane in 0..LANES {
                let (a, b) = (point(&ends.a, lane), point(&ends.b, lane));
                let (corners, side) = side_corners(a, b, radii.a[lane], radii.b[lane], camera.centre);
                quad.depth_squared[lane] = depth_squared(a, b, camera.centre);
                end_on[lane] = u32::from(!side & (lane < radii.count));
                for corner in 0..4 {
                    for axis in 0..3 {
                        self.corners[corner][axis][lane] = corners[corner][axis];
                    }
                }
            }
            if end_on.iter().fold(0, |any, lane| any | lane) != 0 {
                turn_end_on(camera.centre, ends, radii, &end_on, &mut self.corners);
            }
            for lane in 0..LANES {
                quad.drawn[lane] = u32::from(lane < radii.count);
            }
            project_corners(camera, &self.corners, quad);
        }
    }
}

/// Replaces the corners of limbs that are seen along their length, where `end_on` is 1. Rare.
#[cold]
fn turn_end_on(
    centre: [f32; 3],
    ends: &EndChunk,
    radii: &RadiusChunk,
    end_on: &[u32; LANES],
    corners: &mut [[Row; 3]; 4],
) {
    for lane in (0..LANES).filter(|&lane| end_on[lane] != 0) {
        let (a, b) = (point(&ends.a, lane), point(&ends.b, lane));
        let turned = end_on_corners(a, b, radii.a[lane], radii.b[lane], centre);
        for corner in 0..4 {
            for axis in 0..3 {
                corners[corner][axis][lane] = turned[corner][axis];
            }
        }
    }
}

/// Global matrices of one bone for sixteen candidates.
#[inline(always)]
fn place_bone(
    bone: &RigBone,
    parent: Option<&[Row; 12]>,
    translation: &[Row; 3],
    sin: &[Row; 3],
    cos: &[Row; 3],
    global: &mut [Row; 12],
) {
    for lane in 0..LANES {
        let local = local_matrix(bone, point(translation, lane), point(sin, lane), point(cos, lane));
        let placed = match parent {
            None => local,
            Some(parent) => compose(&gather(parent, lane), &local),
        };
        for element in 0..12 {
            global[element][lane] = placed[element];
        }
    }
}

#[inline(always)]
fn project_corners(camera: &RigCamera, corners: &[[Row; 3]; 4], quad: &mut QuadChunk) {
    for corner in 0..4 {
        project_corner(camera, &corners[corner], &mut quad.x[corner], &mut quad.y[corner], &mut quad.drawn);
    }
    // A corner without an image may hold any number; zero cannot overflow in what follows.
    keep_where(&quad.drawn, &mut quad.x);
    keep_where(&quad.drawn, &mut quad.y);
}

/// Projects one corner of every part; `drawn` stays 1 where it has an image.
#[inline(always)]
fn project_corner(
    camera: &RigCamera,
    corner: &[Row; 3],
    x: &mut [i32; LANES],
    y: &mut [i32; LANES],
    drawn: &mut [u32; LANES],
) {
    for lane in 0..LANES {
        let (pixel, has_image) = camera.project(point(corner, lane));
        x[lane] = snap(pixel[0]);
        y[lane] = snap(pixel[1]);
        drawn[lane] &= u32::from(has_image);
    }
}

/// Sets to zero the coordinates in lanes where `keep` is 0. Corner by corner by name: a loop over corners would be
/// vectorised across them instead of across the lanes.
#[inline(always)]
fn keep_where(keep: &[u32; LANES], [a, b, c, d]: &mut [[i32; LANES]; 4]) {
    for lane in 0..LANES {
        let keep = (keep[lane] as i32).wrapping_neg();
        a[lane] &= keep;
        b[lane] &= keep;
        c[lane] &= keep;
        d[lane] &= keep;
    }
}

#[inline(always)]
fn point(rows: &[Row; 3], lane: usize) -> [f32; 3] {
    [rows[0][lane], rows[1][lane], rows[2][lane]]
}

#[inline(always)]
fn gather(matrix: &[Row; 12], lane: usize) -> [f32; 12] {
    std::array::from_fn(|element| matrix[element][lane])
}
