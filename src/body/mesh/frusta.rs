//! Meshes generated from the truncated cones of a body: the ladder of the benchmark (METHOD A4).

use std::collections::BTreeMap;
use std::f64::consts::PI;

use anyhow::{Result, ensure};
use glam::{DAffine3, DVec3};

use super::source::{FrustumBase, Skinning, check_flattening};
use super::{Mesh, MeshVertex};
use crate::body::{Body, Part};

impl Mesh {
    /// A closed frustum a part, rigid on the part's bone and labelled as the part; in the body's rest pose, whose parts come
    /// in the body's order.
    ///
    /// The base is a regular polygon whose perimeter is the circle's: the mean width of a convex figure over all
    /// directions is its perimeter over pi, so that on average a frustum looks as wide as the cone it stands for, whatever
    /// the number of its sides. `flattening` gives parts (by name) the ratio of their depth along the body's x to their
    /// width; the others are round.
    ///
    /// # Errors
    /// When the number of vertices is not on the ladder, a flattening names no part or is not in 0.1 to 10, or the body is
    /// too large for 16-bit bone indices.
    pub fn frusta(body: &Body, base: FrustumBase, flattening: &BTreeMap<String, f64>) -> Result<Self> {
        if let FrustumBase::Elliptic { vertices } = base {
            ensure!(
                FrustumBase::LADDER.contains(&vertices),
                "elliptic frusta of {vertices} vertices were asked for, expected one of {:?}",
                FrustumBase::LADDER
            );
        }
        let parts: Vec<&str> = body.parts.iter().map(|part| part.name.as_str()).collect();
        check_flattening(flattening, &parts)?;
        let origins = rest_origins(body);
        let mut vertices = Vec::new();
        let mut triangles = Vec::new();
        for part in &body.parts {
            let bone = u16::try_from(part.bone)?;
            let first = u32::try_from(vertices.len())?;
            let depth = flattening.get(&part.name).copied().unwrap_or(1.0);
            for point in frustum_points(part, base, depth) {
                vertices.push(MeshVertex {
                    position: (origins[part.bone] + point).as_vec3(),
                    bones: [bone; 4],
                    weights: [1.0, 0.0, 0.0, 0.0],
                    label: part.label,
                });
            }
            triangles.extend(frustum_triangles(base).into_iter().map(|triangle| triangle.map(|vertex| first + vertex)));
        }
        let inverse_bind = origins.into_iter().map(|origin| DAffine3::from_translation(-origin)).collect();
        Self::new(vertices, triangles, Skinning::Rigid, inverse_bind)
    }
}

/// The origins of the bones, in file order, when no degree of freedom is moved: all axes are parallel then. mm from the
/// root's parent frame.
pub(super) fn rest_origins(body: &Body) -> Vec<DVec3> {
    let mut origins = vec![DVec3::ZERO; body.bones.len()];
    for &index in &body.update_order {
        let bone = &body.bones[index];
        origins[index] = bone.offset + bone.parent.map_or(DVec3::ZERO, |parent| origins[parent]);
    }
    origins
}

/// The vertices of a part's frustum in its bone's frame: the ring at `a`, the ring at `b`, then the two centres of caps
/// with an elliptic base.
fn frustum_points(part: &Part, base: FrustumBase, depth: f64) -> Vec<DVec3> {
    let sides = sides(base);
    let axis = (part.b - part.a).normalize();
    // Depth runs along the body's x, or z for a part that lies along x; axis, depth and width are right-handed.
    let forward = if axis.x.abs() < 0.9 { DVec3::X } else { DVec3::Z };
    let along_depth = (forward - axis * axis.dot(forward)).normalize();
    let along_width = axis.cross(along_depth);
    let step = 2.0 * PI / f64::from(sides);
    // Half a step off the axes, so that a square shows a side to the front and to the left.
    let circumradius = (step / 2.0) / (step / 2.0).sin();
    let mut points = Vec::with_capacity(base.vertices() as usize);
    for (end, radius) in [(part.a, part.radius_a), (part.b, part.radius_b)] {
        for side in 0..sides {
            let (sin, cos) = ((f64::from(side) + 0.5) * step).sin_cos();
            points.push(end + (along_depth * (cos * depth) + along_width * sin) * (radius * circumradius));
        }
    }
    if matches!(base, FrustumBase::Elliptic { .. }) {
        points.extend([part.a, part.b]);
    }
    points
}

/// The sides of the polygon.
fn sides(base: FrustumBase) -> u32 {
    match base {
        FrustumBase::Square => 4,
        FrustumBase::Elliptic { vertices } => (vertices - 2) / 2,
    }
}

/// The triangles of one frustum, counter-clockwise from outside; vertices as [`frustum_points`] orders them. Seen along
/// the axis from `a` to `b` the rings turn clockwise.
fn frustum_triangles(base: FrustumBase) -> Vec<[u32; 3]> {
    let sides = sides(base);
    let mut triangles = Vec::with_capacity(4 * sides as usize);
    for side in 0..sides {
        let next = (side + 1) % sides;
        triangles.push([side, next, sides + side]);
        triangles.push([next, sides + next, sides + side]);
        match base {
            FrustumBase::Elliptic { .. } => {
                triangles.push([2 * sides, next, side]);
                triangles.push([2 * sides + 1, sides + side, sides + next]);
            }
            FrustumBase::Square => {
                // A fan from the first corner of either cap.
                if side != 0 && next != 0 {
                    triangles.push([0, next, side]);
                    triangles.push([sides, sides + side, sides + next]);
                }
            }
        }
    }
    triangles
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::body::parse_body;

    fn bases() -> Vec<FrustumBase> {
        let mut bases = vec![FrustumBase::Square];
        bases.extend(FrustumBase::LADDER.map(|vertices| FrustumBase::Elliptic { vertices }));
        bases
    }

    /// Six times the volume that triangles enclose, positive when they are counter-clockwise from outside.
    fn signed_volume(mesh: &Mesh, triangles: &[[u32; 3]]) -> f64 {
        let at = |vertex: u32| mesh.vertices[vertex as usize].position.as_dvec3();
        triangles.iter().map(|&[a, b, c]| at(a).dot(at(b).cross(at(c)))).sum::<f64>()
    }

    #[test]
    fn every_rung_has_its_vertices_and_every_part_is_a_closed_sphere() {
        let body = Body::adult(1750.0).unwrap();
        for base in bases() {
            let mesh = Mesh::frusta(&body, base, &BTreeMap::new()).unwrap();
            let each = base.vertices() as usize;
            assert_eq!(mesh.vertices.len(), each * body.parts.len(), "{base:?}");
            let triangles_each = mesh.triangles.len() / body.parts.len();
            let edges_each = mesh.edges.len() / body.parts.len();
            assert_eq!(edges_each * 2, triangles_each * 3, "{base:?}: every edge has two triangles");
            for (index, part) in body.parts.iter().enumerate() {
                let own = index * each..(index + 1) * each;
                assert!(mesh.vertices[own.clone()].iter().all(|vertex| {
                    vertex.label == part.label && vertex.bones == [part.bone as u16; 4] && vertex.weights[0] == 1.0
                }));
                let triangles = &mesh.triangles[index * triangles_each..(index + 1) * triangles_each];
                let used: HashSet<u32> = triangles.iter().flatten().copied().collect();
                assert!(used.len() == each && used.iter().all(|vertex| own.contains(&(*vertex as usize))));
                let edges = mesh.edges.iter().filter(|edge| own.contains(&(edge.ends[0] as usize))).count();
                assert_eq!(each + triangles_each - edges, 2, "{base:?}: Euler's characteristic of {}", part.name);
                let cone = PI * part.a.distance(part.b) / 3.0
                    * (part.radius_a.powi(2) + part.radius_a * part.radius_b + part.radius_b.powi(2));
                let ratio = signed_volume(&mesh, triangles) / 6.0 / cone;
                // A polygon of the circle's perimeter has less area than the circle.
                let step = PI / f64::from(sides(base));
                assert!((ratio - step / step.tan()).abs() < 1e-4, "{base:?} {}: {ratio} of the cone", part.name);
            }
        }
    }

    #[test]
    fn a_posed_frustum_stands_where_the_hand_computes_it() {
        let text = "name = \"post\"\n[[bone]]\nname = \"foot\"\nparent = \"\"\noffset = [0, 0, 10]\ndof = [\"tx\"]\n\
                    [[bone]]\nname = \"top\"\nparent = \"foot\"\noffset = [0, 0, 100]\ndof = [\"rx\"]\n\
                    [[part]]\nname = \"pole\"\nbone = \"top\"\na = [0, 0, 0]\nb = [0, 0, 200]\nradius_a = 40\n\
                    radius_b = 20\nlabel = 7\n";
        let body = parse_body(text, "post.toml").unwrap();
        let mesh = Mesh::frusta(&body, FrustumBase::Square, &BTreeMap::from([("pole".to_string(), 0.5)])).unwrap();
        // A quarter turn about x lays the pole along -y, and its width upright; then 1000 along x.
        let bones = body.world_from_bones(&[1000.0, PI / 2.0]).unwrap();
        let posed = mesh.posed(&bones).unwrap();
        // Half a side of the square with a circle's perimeter.
        let half = PI / 4.0;
        let expected: Vec<[f64; 3]> = [(0.0, 40.0), (-200.0, 20.0)]
            .into_iter()
            .flat_map(|(y, r)| {
                [(0.5, 1.0), (-0.5, 1.0), (-0.5, -1.0), (0.5, -1.0)]
                    .map(|(x, z): (f64, f64)| [1000.0 + x * half * r, y, 110.0 + z * half * r])
            })
            .collect();
        for (found, expected) in posed.iter().zip(expected) {
            let distance = found.as_dvec3().distance(DVec3::from_array(expected));
            assert!(distance < 1e-3, "{found} is not {expected:?}");
        }
        assert!(mesh.posed(&bones[..1]).unwrap_err().to_string().contains("1 bone matrices, the mesh is bound to 2"));
    }

    #[test]
    fn what_is_not_on_the_ladder_is_named() {
        let body = Body::adult(1750.0).unwrap();
        let sixty = FrustumBase::Elliptic { vertices: 60 };
        let error = Mesh::frusta(&body, sixty, &BTreeMap::new()).unwrap_err().to_string();
        assert!(error.contains("60 vertices") && error.contains("18, 34, 66, 130, 258, 514"), "{error}");
        for (name, ratio, sentence) in
            [("ches", 0.7, "`ches`, which is no part, the nearest known one is `chest`"), ("chest", 0.0, "chest")]
        {
            let flattening = BTreeMap::from([(name.to_string(), ratio)]);
            let error = Mesh::frusta(&body, FrustumBase::Square, &flattening).unwrap_err().to_string();
            assert!(error.contains(sentence), "{error}");
        }
    }
}
