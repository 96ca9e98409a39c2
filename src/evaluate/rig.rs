//! The body and the cameras in single precision: what every backend computes candidate poses with.
//!
//! The functions here are written once, for one candidate and one part, without fused multiply-add and without a
//! library's sine: every operation is rounded on its own, in the stated order. The reference calls them one by one; the
//! fast evaluator loops them over sixteen lanes and the compiler vectorises the loop, which changes no rounding. So both
//! start from identical snapped corners.

use glam::{DAffine3, DMat3};

use crate::body::Body;
use crate::geometry::{Camera, Lens};

pub(crate) use super::shaders::FARTHEST_PIXEL;

/// A 3x4 matrix, row by row: `[r00 r01 r02 tx, r10 …]`.
pub(crate) type Affine = [f32; 12];

/// A body in single precision.
#[derive(Clone, Debug)]
pub(crate) struct Rig {
    /// Bones, every parent before its children.
    pub(crate) bones: Vec<RigBone>,
    /// Parts in the body's order.
    pub(crate) parts: Vec<RigPart>,
    /// Length of a pose.
    pub(crate) dof_count: usize,
}

/// A bone of a [`Rig`].
#[derive(Clone, Debug)]
pub(crate) struct RigBone {
    /// Index into [`Rig::bones`] of the parent.
    pub(crate) parent: Option<usize>,
    /// Origin in the parent's frame, mm.
    pub(crate) offset: [f32; 3],
    /// Axes of the Euler product, leftmost first.
    pub(crate) axes: [usize; 3],
    /// +1 for a cyclic order of axes, -1 for the others.
    pub(crate) parity: f32,
    /// Where in the pose the values of tx ty tz rx ry rz stand.
    pub(crate) slots: [Option<usize>; 6],
}

/// A truncated cone of a [`Rig`].
#[derive(Clone, Debug)]
pub(crate) struct RigPart {
    /// Index into [`Rig::bones`].
    pub(crate) bone: usize,
    /// One end in the bone's frame, mm.
    pub(crate) a: [f32; 3],
    /// The other end in the bone's frame, mm.
    pub(crate) b: [f32; 3],
    /// Radius at `a`, mm.
    pub(crate) radius_a: f32,
    /// Radius at `b`, mm.
    pub(crate) radius_b: f32,
}

impl Rig {
    pub(crate) fn new(body: &Body) -> Self {
        let mut first_dof = Vec::with_capacity(body.bones.len());
        let mut dof_count = 0;
        for bone in &body.bones {
            first_dof.push(dof_count);
            dof_count += bone.dofs.len();
        }
        let mut place_in_rig = vec![0; body.bones.len()];
        let mut bones = Vec::with_capacity(body.bones.len());
        for (place, &index) in body.update_order.iter().enumerate() {
            place_in_rig[index] = place;
            let bone = &body.bones[index];
            let mut slots = [None; 6];
            for (nth, dof) in bone.dofs.iter().enumerate() {
                slots[dof.axis.slot()] = Some(first_dof[index] + nth);
            }
            let axes = bone.order.axes();
            bones.push(RigBone {
                parent: bone.parent.map(|parent| place_in_rig[parent]),
                offset: bone.offset.as_vec3().to_array(),
                axes,
                parity: if (axes[0] + 1) % 3 == axes[1] { 1.0 } else { -1.0 },
                slots,
            });
        }
        let parts = body
            .parts
            .iter()
            .map(|part| RigPart {
                bone: place_in_rig[part.bone],
                a: part.a.as_vec3().to_array(),
                b: part.b.as_vec3().to_array(),
                radius_a: part.radius_a as f32,
                radius_b: part.radius_b as f32,
            })
            .collect();
        Self { bones, parts, dof_count }
    }
}

/// Sine and cosine in single precision: reduction by multiples of pi/2 in three pieces, then minimax polynomials on
/// [-pi/4, pi/4] (the classic Cephes coefficients). Error under 2 ulp for |x| up to about 8000.
#[inline(always)]
pub(crate) fn sin_cos(x: f32) -> (f32, f32) {
    // Adding and subtracting 1.5 * 2^23 rounds to the nearest integer whatever the instruction set.
    const ROUND: f32 = 12_582_912.0;
    let shifted = x * std::f32::consts::FRAC_2_PI + ROUND;
    let quadrant = shifted.to_bits();
    let n = shifted - ROUND;
    let r = ((x - n * 1.570_312_5) - n * 4.837_513e-4) - n * 7.549_79e-8;
    let z = r * r;
    let sin = r + r * z * (-1.666_665_5e-1 + z * (8.332_161e-3 + z * -1.951_529_6e-4));
    let cos = (1.0 - 0.5 * z) + z * z * (4.166_664_6e-2 + z * (-1.388_731_6e-3 + z * 2.443_315_7e-5));
    let swap = quadrant & 1 != 0;
    let (s, c) = if swap { (cos, sin) } else { (sin, cos) };
    let s = f32::from_bits(s.to_bits() ^ ((quadrant & 2) << 30));
    let c = f32::from_bits(c.to_bits() ^ ((quadrant.wrapping_add(1) & 2) << 30));
    (s, c)
}

/// The local matrix of a bone from its translation and the sines and cosines of its angles about x, y, z (METHOD A3):
/// L = T(offset + t) R, R the Euler product in closed form. For axes (i, j, k) of odd parity the sines change sign.
#[inline(always)]
pub(crate) fn local_matrix(bone: &RigBone, translation: [f32; 3], sin: [f32; 3], cos: [f32; 3]) -> Affine {
    let [i, j, k] = bone.axes;
    let (si, sj, sk) = (bone.parity * sin[i], bone.parity * sin[j], bone.parity * sin[k]);
    let (ci, cj, ck) = (cos[i], cos[j], cos[k]);
    let mut m = [0.0; 12];
    m[4 * i + i] = cj * ck;
    m[4 * i + j] = -(cj * sk);
    m[4 * i + k] = sj;
    m[4 * j + i] = ci * sk + si * sj * ck;
    m[4 * j + j] = ci * ck - si * sj * sk;
    m[4 * j + k] = -(si * cj);
    m[4 * k + i] = si * sk - ci * sj * ck;
    m[4 * k + j] = si * ck + ci * sj * sk;
    m[4 * k + k] = ci * cj;
    for axis in 0..3 {
        m[4 * axis + 3] = bone.offset[axis] + translation[axis];
    }
    m
}

/// The product of two 3x4 matrices.
#[inline(always)]
pub(crate) fn compose(parent: &Affine, local: &Affine) -> Affine {
    let mut product = [0.0; 12];
    for row in 0..3 {
        let p = &parent[4 * row..4 * row + 4];
        for column in 0..4 {
            let sum = (p[0] * local[column] + p[1] * local[4 + column]) + p[2] * local[8 + column];
            product[4 * row + column] = if column == 3 { sum + p[3] } else { sum };
        }
    }
    product
}

/// A matrix applied to a point.
#[inline(always)]
pub(crate) fn transform(m: &Affine, p: [f32; 3]) -> [f32; 3] {
    [
        ((m[0] * p[0] + m[1] * p[1]) + m[2] * p[2]) + m[3],
        ((m[4] * p[0] + m[5] * p[1]) + m[6] * p[2]) + m[7],
        ((m[8] * p[0] + m[9] * p[1]) + m[10] * p[2]) + m[11],
    ]
}

/// A camera in single precision.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RigCamera {
    /// Camera from world.
    pub(crate) camera_from_world: Affine,
    /// The camera's centre in the world, mm.
    pub(crate) centre: [f32; 3],
    /// The lens.
    pub(crate) lens: RigLens,
    /// Picture width and height, pixels.
    pub(crate) size: [u32; 2],
}

/// A lens in single precision.
#[derive(Clone, Copy, Debug)]
pub(crate) enum RigLens {
    /// Tsai: focal length, kappa f^2, the factors from the image plane to pixels, the centre.
    Tsai {
        /// kappa times f squared: the cubic in units of the focal length.
        kappa: f32,
        /// Pixels per unit of x/z and y/z.
        focal: [f32; 2],
        /// Image centre.
        centre: [f32; 2],
    },
    /// Brown-Conrady.
    BrownConrady {
        /// Focal lengths.
        focal: [f32; 2],
        /// Principal point.
        centre: [f32; 2],
        /// k1 k2 k3.
        radial: [f32; 3],
        /// p1 p2.
        tangential: [f32; 2],
        /// Squared radius where the radial map stops being monotone.
        max_radius_squared: f32,
    },
}

impl RigCamera {
    pub(crate) fn new(camera: &Camera) -> Self {
        let lens = match camera.lens {
            Lens::Tsai(tsai) => RigLens::Tsai {
                kappa: (tsai.kappa * tsai.f * tsai.f) as f32,
                focal: [(tsai.f * tsai.sx / tsai.pitch.x) as f32, (tsai.f / tsai.pitch.y) as f32],
                centre: tsai.centre.as_vec2().to_array(),
            },
            Lens::BrownConrady(lens) => RigLens::BrownConrady {
                focal: lens.focal.as_vec2().to_array(),
                centre: lens.centre.as_vec2().to_array(),
                radial: lens.radial.map(|k| k as f32),
                tangential: lens.tangential.map(|p| p as f32),
                max_radius_squared: lens.max_radius_squared() as f32,
            },
        };
        Self {
            camera_from_world: affine(&camera.camera_from_world),
            centre: camera.centre_in_world().as_vec3().to_array(),
            lens,
            size: camera.size,
        }
    }

    /// A point of the world to pixels, and whether it has an image: in front of the camera, inside the distortion's
    /// branch, at most [`FARTHEST_PIXEL`] from the origin in x and in y.
    #[inline(always)]
    pub(crate) fn project(&self, point: [f32; 3]) -> ([f32; 2], bool) {
        let [x, y, z] = transform(&self.camera_from_world, point);
        let inverse = 1.0 / z;
        let (x, y) = (x * inverse, y * inverse);
        let r2 = x * x + y * y;
        let (pixel, on_branch) = match self.lens {
            RigLens::Tsai { kappa, focal, centre } => {
                // With s = r_d / r_u the cubic reads s + q s^3 = 1, q = kappa r_u^2. Its branch ends at q = -4/27.
                let q = kappa * r2;
                let mut s = 1.0_f32;
                for _ in 0..6 {
                    // Halley: three times the digits a step, and no overshoot on this branch.
                    let value = s + q * s * s * s - 1.0;
                    let slope = 1.0 + 3.0 * q * s * s;
                    let bend = 3.0 * q * s;
                    s -= value * slope / (slope * slope - value * bend);
                }
                ([focal[0] * (x * s) + centre[0], focal[1] * (y * s) + centre[1]], q >= -4.0 / 27.0)
            }
            RigLens::BrownConrady { focal, centre, radial: [k1, k2, k3], tangential: [p1, p2], max_radius_squared } => {
                let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
                let xy2 = 2.0 * (x * y);
                let distorted_x = x * radial + (p1 * xy2 + p2 * (r2 + 2.0 * (x * x)));
                let distorted_y = y * radial + (p1 * (r2 + 2.0 * (y * y)) + p2 * xy2);
                ([focal[0] * distorted_x + centre[0], focal[1] * distorted_y + centre[1]], r2 <= max_radius_squared)
            }
        };
        // Written so that a NaN fails every test.
        let has_image = (z > 0.0) & on_branch & (pixel[0].abs() <= FARTHEST_PIXEL) & (pixel[1].abs() <= FARTHEST_PIXEL);
        (pixel, has_image)
    }
}

pub(crate) fn affine(transform: &DAffine3) -> Affine {
    let rows: DMat3 = transform.matrix3.transpose();
    let mut m = [0.0; 12];
    for (row, axis) in [rows.x_axis, rows.y_axis, rows.z_axis].into_iter().enumerate() {
        for column in 0..3 {
            m[4 * row + column] = axis[column] as f32;
        }
        m[4 * row + 3] = transform.translation[row] as f32;
    }
    m
}

/// The four corners of a truncated cone as seen from `centre` (METHOD A4): v1 v2 v3 v4 in the world, and whether the view
/// is not along the limb. When it is, the corners are meaningless and [`end_on_corners`] gives them.
#[inline(always)]
pub(crate) fn side_corners(
    a: [f32; 3],
    b: [f32; 3],
    radius_a: f32,
    radius_b: f32,
    centre: [f32; 3],
) -> ([[f32; 3]; 4], bool) {
    let u = sub(a, b);
    let n = sub(centre, b);
    let c = cross(u, n);
    let cc = dot(c, c);
    let inverse = 1.0 / cc.sqrt();
    // Sine of the angle under 0.001, squared.
    let from_the_side = cc >= 1e-6 * (dot(u, u) * dot(n, n)) && cc > 0.0;
    let r = [c[0] * inverse, c[1] * inverse, c[2] * inverse];
    let (ra, rb) = (scale(r, radius_a), scale(r, radius_b));
    ([add(a, ra), add(b, rb), sub(b, rb), sub(a, ra)], from_the_side)
}

/// The corners when looking along a limb: the square around the larger disc (`a`'s where both are equal), facing the
/// camera, with sides along the world axis least parallel to the view.
pub(crate) fn end_on_corners(
    a: [f32; 3],
    b: [f32; 3],
    radius_a: f32,
    radius_b: f32,
    centre: [f32; 3],
) -> [[f32; 3]; 4] {
    let (disc, radius) = if radius_a >= radius_b { (a, radius_a) } else { (b, radius_b) };
    let view = sub(centre, disc);
    let view = scale(view, 1.0 / dot(view, view).sqrt());
    let mut least = 0;
    for axis in 1..3 {
        if view[axis].abs() < view[least].abs() {
            least = axis;
        }
    }
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let side = sub(axis, scale(view, view[least]));
    let side = scale(side, radius / dot(side, side).sqrt());
    let up = cross(view, side);
    [add(add(disc, side), up), add(sub(disc, side), up), sub(sub(disc, side), up), sub(add(disc, side), up)]
}

/// The squared distance of a cone's mid-point from the camera: its one depth in that camera. Squared, because the order
/// is the same and a root could merge two different values.
#[inline(always)]
pub(crate) fn depth_squared(a: [f32; 3], b: [f32; 3], centre: [f32; 3]) -> f32 {
    let middle = scale(add(a, b), 0.5);
    let d = sub(middle, centre);
    dot(d, d)
}

/// A pixel coordinate to 1/256 pixel: nearest, halves towards +infinity. Any value beyond [`FARTHEST_PIXEL`].
#[inline(always)]
pub(crate) fn snap(coordinate: f32) -> i32 {
    // Adding 1.5 * 2^23 leaves the nearest integer in the low bits, on every instruction set; one less where that is
    // above the value makes it the floor. Up to 2^22 every step is exact.
    const ROUND: f32 = 12_582_912.0;
    let scaled = coordinate * 256.0 + 0.5;
    let shifted = scaled + ROUND;
    let nearest = (shifted.to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32);
    nearest.wrapping_sub(i32::from(shifted - ROUND > scaled))
}

#[inline(always)]
fn add(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn sub(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn scale(a: [f32; 3], s: f32) -> [f32; 3] {
    [a[0] * s, a[1] * s, a[2] * s]
}

#[inline(always)]
fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

#[inline(always)]
fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
