//! Materials on a sphere, a cube or a plane under one diffuse light.

use anyhow::Result;

use super::painter::Painter;
use super::picture::{Picture, SAMPLES, Seen};

/// An object to show a material on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solid {
    /// A ball of radius 1.
    Sphere,
    /// A cube with edges of 1.3, seen from above a corner.
    Cube,
    /// A square leaning back.
    Plane,
}

pub(super) fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn normalised(v: [f32; 3]) -> [f32; 3] {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

/// Towards the one light: from the upper left, before the object.
const LIGHT: [f32; 3] = [-0.45, 0.6, 0.66];
/// Half of what the view of a solid is wide, units of the object: a little more than any of them takes.
const HALF_VIEW: f32 = 1.45;

/// The part of a ray inside of a box of two opposite corners, as multiples of its direction, and the axis of the face it comes in by; none
/// where it misses the box.
pub(super) fn inside(
    low: [f32; 3],
    high: [f32; 3],
    origin: [f32; 3],
    direction: [f32; 3],
) -> Option<(f32, f32, usize)> {
    let (mut near, mut far, mut face) = (0.0, f32::MAX, 0);
    for axis in 0..3 {
        let [a, b] = [low[axis], high[axis]].map(|side| (side - origin[axis]) / direction[axis]);
        if a.min(b) > near {
            (near, face) = (a.min(b), axis);
        }
        far = far.min(a.max(b));
    }
    (near <= far).then_some((near, far, face))
}

/// Where the ray through (u, v) in [-1, 1]^2 along -z meets the object: point and normal in object space, and the normal
/// as the light sees it.
fn hit(solid: Solid, u: f32, v: f32) -> Option<([f32; 3], [f32; 3])> {
    match solid {
        Solid::Sphere => {
            let (x, y) = (u * 1.1, v * 1.1);
            let z2 = 1.0 - x * x - y * y;
            (z2 >= 0.0).then(|| ([x, y, z2.sqrt()], [x, y, z2.sqrt()]))
        }
        Solid::Plane => {
            // Leaning back by 50 degrees, seen in perspective from 4 units away.
            let (sin, cos) = 50.0_f32.to_radians().sin_cos();
            let ray = [u * 1.45, v * 1.45, -4.0];
            let towards = ray[1] * sin + ray[2] * cos;
            let t = -4.0 * cos / towards;
            let (x, y) = (t * ray[0], t * ray[1] * cos - (4.0 + t * ray[2]) * sin);
            (towards < 0.0 && x.abs() <= 1.0 && y.abs() <= 1.0).then_some(([x, y, 0.0], [0.0, sin, cos]))
        }
        Solid::Cube => {
            // Turned by 35 degrees about y, then tipped by 28 degrees towards the eye.
            let ((sa, ca), (sb, cb)) = (35.0_f32.to_radians().sin_cos(), 28.0_f32.to_radians().sin_cos());
            let to_object = |p: [f32; 3]| {
                let (y, z) = (p[1] * cb + p[2] * sb, p[2] * cb - p[1] * sb);
                [p[0] * ca - z * sa, y, p[0] * sa + z * ca]
            };
            let (origin, direction) = (to_object([u * 1.2, v * 1.2, 4.0]), to_object([0.0, 0.0, -1.0]));
            inside([-0.65; 3], [0.65; 3], origin, direction).map(|(near, _, face)| {
                let p = std::array::from_fn(|axis| origin[axis] + near * direction[axis]);
                // The light turns with the object instead of the normal turning back.
                let sign = -direction[face].signum();
                let light = to_object(normalised(LIGHT));
                let mut normal = [0.0; 3];
                normal[face] = sign;
                let lambert = dot(normal, light).max(0.0);
                // A normal of the length that gives this diffuse light.
                (p, normalised(LIGHT).map(|x| x * lambert))
            })
        }
    }
}

/// The material on an object under one diffuse light; `scale` is units of the material a unit of the object.
///
/// # Errors
/// When the device that draws fails.
pub fn lit(painter: &Painter<'_>, solid: Solid, size: [u32; 2], offset: [f32; 3], scale: f32) -> Result<Picture> {
    let light = normalised(LIGHT);
    let pixel = scale * 2.0 * HALF_VIEW / size[0].min(size[1]) as f32;
    painter.shown(size, painter.material().samples(pixel, SAMPLES), |u, v| {
        hit(solid, u, v).map(|(p, normal)| Seen {
            point: std::array::from_fn(|axis| p[axis] * scale + offset[axis]),
            cosine: dot(normal, light),
        })
    })
}
