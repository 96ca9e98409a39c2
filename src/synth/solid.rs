//! Rounded solids and where a ray first meets them.

use glam::{DAffine3, DMat3, DVec3};

/// A half line in the world: `origin + t direction`, t > 0. The direction is of unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts, mm.
    pub origin: DVec3,
    /// Where it goes.
    pub direction: DVec3,
}

/// A solid in its own frame; an affine map places (and may flatten) it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solid {
    /// The unit sphere round the origin: an ellipsoid once placed.
    Ball,
    /// The convex hull of a ball round the origin and a ball on the z axis: a capsule where the radii are equal.
    Capsule {
        /// Height of the second ball's centre.
        length: f64,
        /// Radius of the ball round the origin.
        radius_a: f64,
        /// Radius of the other ball.
        radius_b: f64,
    },
}

/// A ball that helps to bound a solid: centre and radius, mm.
pub type BoundingBall = (DVec3, f64);

impl Solid {
    /// The smallest t > 0 at which the ray is on the surface, with the outward direction there (not of unit length).
    /// The ray is in the solid's frame and its direction may have any length.
    fn first_hit(self, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
        match self {
            Self::Ball => ball_hit(origin, direction, DVec3::ZERO, 1.0),
            Self::Capsule { length, radius_a, radius_b } => capsule_hit(origin, direction, length, radius_a, radius_b),
        }
    }

    /// Distance of a point from the surface in the solid's own frame, and the unit direction in which it grows.
    fn near(self, p: DVec3) -> (f64, DVec3) {
        let (centre, radius) = match self {
            Self::Ball => (DVec3::ZERO, 1.0),
            Self::Capsule { length, radius_a, radius_b } => {
                let sine = ((radius_a - radius_b) / length).clamp(-0.999, 0.999);
                // The ball that touches the surface where the point's normal leaves it.
                let height = p.z - p.truncate().length() * sine / (1.0 - sine * sine).sqrt();
                let height = height.clamp(0.0, length);
                (DVec3::Z * height, radius_a - sine * height)
            }
        };
        ((p - centre).length() - radius, (p - centre).normalize_or(DVec3::Z))
    }

    /// Two balls whose convex hull holds the solid placed by `map`.
    fn bounding_balls(self, map: &DAffine3) -> [BoundingBall; 2] {
        let stretch = map.matrix3.x_axis.length().max(map.matrix3.y_axis.length()).max(map.matrix3.z_axis.length());
        match self {
            Self::Ball => [(map.translation, stretch); 2],
            Self::Capsule { length, radius_a, radius_b } => {
                [(map.translation, radius_a * stretch), (map.transform_point3(DVec3::Z * length), radius_b * stretch)]
            }
        }
    }
}

fn ball_hit(origin: DVec3, direction: DVec3, centre: DVec3, radius: f64) -> Option<(f64, DVec3)> {
    let from_centre = origin - centre;
    let t = smaller_root(
        direction.length_squared(),
        from_centre.dot(direction),
        from_centre.length_squared() - radius * radius,
    )?;
    (t > 0.0).then(|| (t, from_centre + direction * t))
}

/// The hull of two balls is convex and each candidate below lies on or inside it, so the nearest candidate is where the
/// ray enters.
fn capsule_hit(o: DVec3, d: DVec3, length: f64, radius_a: f64, radius_b: f64) -> Option<(f64, DVec3)> {
    // Sine and cosine of the angle between the side and the axis.
    let sine = (radius_a - radius_b) / length;
    let nearer = |a: Option<(f64, DVec3)>, b: Option<(f64, DVec3)>| match (a, b) {
        (Some(a), Some(b)) => Some(if a.0 <= b.0 { a } else { b }),
        (a, b) => a.or(b),
    };
    let ends = nearer(ball_hit(o, d, DVec3::ZERO, radius_a), ball_hit(o, d, DVec3::new(0.0, 0.0, length), radius_b));
    if sine.abs() >= 1.0 {
        return ends;
    }
    let cosine = (1.0 - sine * sine).sqrt();
    // The side touches the balls at these heights; its distance from the axis at height z is (radius_a - sine z) / cosine.
    let (low, high) = (radius_a * sine, length + radius_b * sine);
    let (w0, w1) = ((radius_a - sine * o.z) / cosine, -sine * d.z / cosine);
    let a = d.x * d.x + d.y * d.y - w1 * w1;
    let b = o.x * d.x + o.y * d.y - w0 * w1;
    let c = o.x * o.x + o.y * o.y - w0 * w0;
    let side = smaller_root(a, b, c).and_then(|t| {
        let p = o + d * t;
        (t > 0.0 && p.z >= low && p.z <= high).then(|| {
            let normal = DVec3::new(p.x, p.y, 0.0).normalize_or_zero() * cosine + DVec3::Z * sine;
            (t, normal)
        })
    });
    nearer(ends, side)
}

/// The smaller root of a t^2 + 2 b t + c for a > 0. A ray almost along the axis of a cone (a <= 0) meets an end first, so
/// nothing is lost by leaving that case out.
fn smaller_root(a: f64, b: f64, c: f64) -> Option<f64> {
    let discriminant = b * b - a * c;
    (a > 0.0 && discriminant >= 0.0).then(|| (-b - discriminant.sqrt()) / a)
}

/// A solid somewhere in the world.
#[derive(Clone, Copy, Debug)]
pub struct PlacedSolid {
    pub(super) solid: Solid,
    pub(super) local_from_world: DAffine3,
    /// Takes the local outward direction to the world's.
    normal_map: DMat3,
    balls: [BoundingBall; 2],
}

impl PlacedSolid {
    /// Places `solid` by `world_from_local`, which must be invertible.
    pub fn new(solid: Solid, world_from_local: DAffine3) -> Self {
        let local_from_world = world_from_local.inverse();
        Self {
            solid,
            local_from_world,
            normal_map: local_from_world.matrix3.transpose(),
            balls: solid.bounding_balls(&world_from_local),
        }
    }

    /// Distance to where the ray enters, mm, and the outward unit normal there.
    pub fn first_hit(&self, ray: &Ray) -> Option<(f64, DVec3)> {
        // Starting near the solid keeps the subtraction in the discriminant exact for far cameras.
        let approach = ((self.balls[0].0 - ray.origin).dot(ray.direction) - 2.0 * self.reach()).max(0.0);
        let origin = self.local_from_world.transform_point3(ray.origin + ray.direction * approach);
        let (t, outward) = self.solid.first_hit(origin, self.local_from_world.transform_vector3(ray.direction))?;
        Some((approach + t, (self.normal_map * outward).normalize_or_zero()))
    }

    /// How far a point near the surface is outside (inside: negative), mm, to first order, and the unit normal there.
    pub fn near(&self, point: DVec3) -> (f64, DVec3) {
        let p = self.local_from_world.transform_point3(point);
        let (outside, outward) = self.solid.near(p);
        // A flattened solid has its distances stretched by the map; the gradient tells by how much.
        let gradient = self.normal_map * outward;
        let steepness = gradient.length().max(1e-12);
        (outside / steepness, gradient / steepness)
    }

    /// Two balls whose convex hull holds it.
    pub fn bounding_balls(&self) -> [BoundingBall; 2] {
        self.balls
    }

    /// How far it reaches from the middle of its first ball, mm.
    pub(super) fn reach(&self) -> f64 {
        let [(a, radius_a), (b, radius_b)] = self.balls;
        a.distance(b) + radius_a.max(radius_b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Signed distance to a capsule's axis ball, by brute force over the balls between its ends.
    fn outside_capsule(p: DVec3, length: f64, radius_a: f64, radius_b: f64) -> f64 {
        (0..=4000)
            .map(|i| {
                let t = f64::from(i) / 4000.0;
                p.distance(DVec3::Z * (length * t)) - (radius_a + (radius_b - radius_a) * t)
            })
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn an_ellipsoid_is_met_where_it_should_be() {
        let map = DAffine3::from_scale_rotation_translation(
            DVec3::new(100.0, 50.0, 20.0),
            glam::DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
            DVec3::new(5000.0, 0.0, 0.0),
        );
        let solid = PlacedSolid::new(Solid::Ball, map);
        let (t, normal) = solid.first_hit(&Ray { origin: DVec3::ZERO, direction: DVec3::X }).unwrap();
        assert!((t - 4950.0).abs() < 1e-9 && (normal + DVec3::X).length() < 1e-12, "{t} {normal}");
        assert!(solid.first_hit(&Ray { origin: DVec3::Z * 20.1, direction: DVec3::X }).is_none());
        assert!(solid.first_hit(&Ray { origin: DVec3::Z * 19.9, direction: DVec3::X }).is_some());
        assert!(solid.first_hit(&Ray { origin: DVec3::ZERO, direction: -DVec3::X }).is_none(), "behind the ray");
    }

    proptest! {
        #[test]
        fn a_capsule_is_entered_on_its_surface(
            x in -80.0..80.0f64, z in -60.0..260.0f64, ox in -300.0..300.0f64, oz in -300.0..500.0f64,
            radius_a in 20.0..60.0f64, radius_b in 20.0..60.0f64,
        ) {
            let origin = DVec3::new(ox, -400.0, oz);
            let direction = (DVec3::new(x, 0.0, z) - origin).normalize();
            let solid = PlacedSolid::new(Solid::Capsule { length: 200.0, radius_a, radius_b }, DAffine3::IDENTITY);
            let depth = |t: f64| outside_capsule(origin + direction * t, 200.0, radius_a, radius_b);
            match solid.first_hit(&Ray { origin, direction }) {
                Some((t, normal)) => {
                    let (outside, again) = solid.near(origin + direction * t);
                    prop_assert!(outside.abs() < 1e-6 && again.distance(normal) < 1e-6, "{outside} {again} {normal}");
                    prop_assert!(depth(t).abs() < 0.05, "on the surface: {}", depth(t));
                    prop_assert!(normal.dot(direction) < 1e-9, "faces the ray");
                    prop_assert!((0..100).all(|i| depth(t * f64::from(i) / 100.0) > -0.05), "nothing in front of it");
                }
                None => prop_assert!((0..400).all(|i| depth(f64::from(i) * 3.0) > -0.05), "missed though it is hit"),
            }
        }
    }
}
