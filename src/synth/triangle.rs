//! Triangles of a posed mesh, and what a ray may meet: a rounded solid or a triangle.

use glam::DVec3;

use super::solid::{BoundingBall, PlacedSolid, Ray};

/// A triangle of a person's surface in the world.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    pub(super) corner: DVec3,
    pub(super) edges: [DVec3; 2],
    /// Outward normals of the surface at the corners.
    pub(super) normals: [DVec3; 3],
    /// The corners on the person at rest, mm.
    pub(super) rest: [DVec3; 3],
}

impl Triangle {
    /// Between corners in the world, counter-clockwise from outside.
    pub fn new(corners: [DVec3; 3], normals: [DVec3; 3], rest: [DVec3; 3]) -> Self {
        Self { corner: corners[0], edges: [corners[1] - corners[0], corners[2] - corners[0]], normals, rest }
    }

    /// Distance to where the ray passes through it, from either side, and the shares of the second and third corner there.
    fn crossing(&self, ray: &Ray) -> Option<(f64, f64, f64)> {
        let [e, f] = self.edges;
        let p = ray.direction.cross(f);
        let volume = e.dot(p);
        if volume.abs() < 1e-12 {
            return None;
        }
        let from = ray.origin - self.corner;
        // Most rays pass it by, which is seen before the quotients: a share below 0, or surely above 1.
        let passes = |share: f64| share * volume < 0.0 || share.abs() > 1.001 * volume.abs();
        let of_second = from.dot(p);
        if passes(of_second) {
            return None;
        }
        let q = from.cross(e);
        let of_third = ray.direction.dot(q);
        if passes(of_third) {
            return None;
        }
        let (u, v) = (of_second / volume, of_third / volume);
        let t = f.dot(q) / volume;
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some((t, u, v))
    }

    /// The point of the person at rest that is at a point of the triangle.
    pub fn rest_at(&self, point: DVec3) -> DVec3 {
        let [e, f] = self.edges;
        let normal = e.cross(f);
        let area = normal.length_squared().max(1e-12);
        let from = point - self.corner;
        let (u, v) = (from.cross(f).dot(normal) / area, e.cross(from).dot(normal) / area);
        self.rest[0] * (1.0 - u - v) + self.rest[1] * u + self.rest[2] * v
    }

    /// The corners in the world.
    pub fn corners(&self) -> [DVec3; 3] {
        [self.corner, self.corner + self.edges[0], self.corner + self.edges[1]]
    }

    /// Whether its outside is turned to a point.
    pub fn faces(&self, point: DVec3) -> bool {
        self.edges[0].cross(self.edges[1]).dot(point - self.corner) > 0.0
    }

    fn ball(&self) -> BoundingBall {
        let middle = self.corner + (self.edges[0] + self.edges[1]) / 3.0;
        (middle, self.corners().iter().map(|at| at.distance(middle)).fold(0.0, f64::max))
    }
}

/// Anything a ray may meet.
#[derive(Clone, Copy, Debug)]
pub enum Primitive {
    /// An ellipsoid or capsule.
    Solid(PlacedSolid),
    /// A triangle.
    Triangle(Triangle),
}

impl Primitive {
    /// Distance to where the ray first meets it, mm, and the outward unit normal there.
    pub fn first_hit(&self, ray: &Ray) -> Option<(f64, DVec3)> {
        match self {
            Self::Solid(solid) => solid.first_hit(ray),
            Self::Triangle(triangle) => {
                let (t, u, v) = triangle.crossing(ray)?;
                let [a, b, c] = triangle.normals;
                let normal =
                    (a * (1.0 - u - v) + b * u + c * v).normalize_or(triangle.edges[0].cross(triangle.edges[1]));
                // At a silhouette the mixed normal may look away although the triangle does not.
                Some((t, normal))
            }
        }
    }

    /// Two balls whose convex hull holds it.
    pub fn bounding_balls(&self) -> [BoundingBall; 2] {
        match self {
            Self::Solid(solid) => solid.bounding_balls(),
            Self::Triangle(triangle) => [triangle.ball(); 2],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_the_triangle_between_its_corners() {
        let corners = [DVec3::ZERO, DVec3::new(100.0, 0.0, 0.0), DVec3::new(0.0, 100.0, 0.0)];
        let triangle = Triangle::new(corners, [DVec3::Z; 3], corners.map(|at| at * 2.0));
        let down = |x: f64, y: f64| Ray { origin: DVec3::new(x, y, 50.0), direction: DVec3::NEG_Z };
        let primitive = Primitive::Triangle(triangle);
        assert_eq!(primitive.first_hit(&down(20.0, 30.0)), Some((50.0, DVec3::Z)));
        assert!(primitive.first_hit(&down(60.0, 60.0)).is_none());
        assert!(primitive.first_hit(&Ray { origin: DVec3::Z, direction: DVec3::Z }).is_none(), "behind the ray");
        assert!(primitive.first_hit(&Ray { origin: DVec3::Z, direction: DVec3::X }).is_none(), "along the triangle");
        assert!(triangle.rest_at(DVec3::new(20.0, 30.0, 0.0)).distance(DVec3::new(40.0, 60.0, 0.0)) < 1e-9);
        let (middle, reach) = triangle.ball();
        assert!(corners.iter().all(|corner| corner.distance(middle) <= reach + 1e-9));
    }
}
