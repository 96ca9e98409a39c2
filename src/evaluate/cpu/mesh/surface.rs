//! The surface of a mesh as it is drawn, and where a view has its vertices.

use crate::body::Mesh;

/// The vertices in one view.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen {
    /// Positions in 1/256 pixel; 0 without an image.
    pub(super) places: Vec<[i32; 2]>,
    /// The numbers of their depths, as corners of triangles and as ends of silhouette edges; [`Seen::NO_IMAGE`] without an image.
    pub(super) depths: Vec<[i32; 2]>,
    /// Whether every one has an image.
    pub(super) is_whole: bool,
}

impl Seen {
    pub(super) const NO_IMAGE: i32 = -1;
}

/// The surface of a mesh as it is drawn.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub(super) triangles: Vec<Triangle>,
    pub(super) edges: Vec<Edge>,
}

/// A triangle of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub(super) corners: [u32; 3],
    /// The last byte of its keys.
    pub(super) low: u32,
}

/// A side of two triangles, a silhouette edge where one of them alone faces the camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// Its triangles.
    pub(super) sides: [u32; 2],
    pub(super) ends: [u32; 2],
    pub(super) low: u32,
}

/// The last byte of a key: the smaller, the sooner at equal depth.
fn low(byte: u8) -> u32 {
    u32::from(!byte)
}

impl Surface {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let label = |vertex: u32| mesh.vertices[vertex as usize].label;
        let mut of_side = std::collections::HashMap::new();
        let mut triangles = Vec::with_capacity(mesh.triangles.len());
        for (number, &corners) in (0..).zip(&mesh.triangles) {
            let [a, b, c] = corners;
            of_side.extend([([a, b], number), ([b, c], number), ([c, a], number)]);
            triangles.push(Triangle { corners, low: low(label(a)) });
        }
        let edge = |ends: [u32; 2]| {
            let [p, q] = ends;
            // A mesh is closed: both are there.
            Some(Edge { sides: [*of_side.get(&[p, q])?, *of_side.get(&[q, p])?], ends, low: low(label(p) | 0x80) })
        };
        let edges = mesh.edges.iter().filter_map(|found| edge(found.ends)).collect();
        Self { triangles, edges }
    }
}
