//! Triangles and edges of any size, at any place and depth, held to the reference pixel by pixel.

use glam::{DAffine3, Vec3};
use proptest::prelude::*;
use proptest::strategy::ValueTree;

use super::raster::Canvas;
use super::setup::EXACT;
use super::surface::{Seen, Surface};
use crate::body::{Mesh, MeshVertex, Skinning};
use crate::evaluate::cpu::InstructionSet;
use crate::evaluate::cpu::instruction_set::Code;
use crate::evaluate::cpu::simd::{Simd, Task};
use crate::evaluate::mesh_projection::{ProjectedVertex, depth_number};
use crate::evaluate::{CandidateImage, draw_mesh};

/// Tetrahedra, each of a label of its own.
fn tetrahedra(count: u32) -> Mesh {
    let vertex = |index: u32| MeshVertex {
        position: Vec3::ZERO,
        bones: [0; 4],
        weights: [1.0, 0.0, 0.0, 0.0],
        label: (index / 4 % 127 + 1) as u8,
    };
    let triangles = (0..count).flat_map(|solid| {
        [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|triangle: [u32; 3]| triangle.map(|corner| 4 * solid + corner))
    });
    let vertices = (0..4 * count).map(vertex).collect();
    Mesh::new(vertices, triangles.collect(), Skinning::Rigid, vec![DAffine3::IDENTITY]).unwrap()
}

/// Where a vertex is in its solid to the right, downwards and in depth, 0 for one on a pixel's centre, 0 for one without an image.
type Corner = (f64, f64, f32, u8, u8);

/// Where a solid stands in pixels, how large it is, how near and how deep, and its corners.
type Solid = ((f64, f64), f64, f32, f32, [Corner; 4]);

/// The vertices of so many solids from a pixel to some pictures in size.
fn vertices(count: u32) -> impl Strategy<Value = Vec<ProjectedVertex>> {
    let size = prop_oneof![3 => 0.2..4.0_f64, 3 => 4.0..40.0_f64, 2 => 40.0..300.0_f64, 1 => 300.0..33000.0_f64];
    let near = prop_oneof![200.0..260.0_f32, 260.0..1e4_f32, 200.0..1e10_f32];
    let deep = prop_oneof![Just(0.0_f32), 0.0..5.0_f32, 0.0..400.0_f32, 0.0..1e6_f32];
    let corner = (-0.5..0.5_f64, -0.5..0.5_f64, 0.0..1.0_f32, 0..4_u8, 0..60_u8);
    let solid = ((-10.0..90.0_f64, -10.0..70.0_f64), size, near, deep, prop::array::uniform4(corner));
    prop::collection::vec(solid, count as usize).prop_map(|solids| {
        let solid = |(centre, size, near, deep, corners): Solid| {
            corners.map(|(right, down, far, whole, image)| {
                let to = |at: f64| (at.clamp(-16384.0, 16384.0) * if whole == 0 { 1.0 } else { 256.0 }).round() as i32;
                let at = [centre.0 + size * right, centre.1 + size * down]
                    .map(|at| to(at) * if whole == 0 { 256 } else { 1 });
                let z = near + deep * far;
                let depth = |z: f32| 1.0 - 100.0 / z;
                ProjectedVertex { at, depth: depth(z), edge_depth: depth(z - 30.0), has_image: image != 0 }
            })
        };
        solids.into_iter().flat_map(solid).collect()
    })
}

struct Draw<'a>(&'a Surface, &'a Seen, &'a mut Canvas, [[i32; 2]; 2]);

impl Task for Draw<'_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        self.2.draw(simd, self.0, self.1, self.3);
    }
}

fn seen(vertices: &[ProjectedVertex]) -> Seen {
    let mut seen = Seen { is_whole: vertices.iter().all(|vertex| vertex.has_image), ..Seen::default() };
    for vertex in vertices {
        let depths = [vertex.depth, vertex.edge_depth].map(|depth| depth_number(depth) as i32);
        seen.places.push(if vertex.has_image { vertex.at } else { [0; 2] });
        seen.depths.push(if vertex.has_image { depths } else { [Seen::NO_IMAGE; 2] });
    }
    seen
}

/// What an instruction set draws.
fn drawn(set: InstructionSet, mesh: &Mesh, vertices: &[ProjectedVertex], [width, height]: [u32; 2]) -> CandidateImage {
    let surface = Surface::new(mesh);
    let mut canvas = Canvas::new(&surface, width as usize, height as usize);
    let seen = seen(vertices);
    let region = [[0, 0], [width as i32, height as i32]];
    Code::of(set).unwrap().run(Draw(&surface, &seen, &mut canvas, region));
    let mut bytes = Vec::new();
    canvas.region().1.for_each(|row| bytes.extend(row.iter().map(|key| !*key as u8)));
    CandidateImage { width, height, bytes }
}

/// Whether depths of a triangle are exact in double precision, as the setup tells.
fn is_exact(corners: [ProjectedVertex; 3]) -> bool {
    let extent = |axis: usize| {
        let at = corners.map(|corner| f64::from(corner.at[axis]));
        at.iter().copied().fold(f64::MIN, f64::max) - at.iter().copied().fold(f64::MAX, f64::min)
    };
    let depth = corners.map(|corner| f64::from(depth_number(corner.depth)));
    let range = (depth[1] - depth[0]).abs().max((depth[2] - depth[0]).abs());
    extent(0) * extent(1) * range.max(1.0) <= EXACT
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn every_triangle_and_edge_is_the_reference_s(vertices in vertices(12)) {
        let mesh = tetrahedra(12);
        let size = [83, 61];
        let expected = draw_mesh(&vertices, &mesh, size[0], size[1]);
        for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            prop_assert!(drawn(set, &mesh, &vertices, size) == expected, "{}", set.name());
        }
    }
}

/// The triangles above are of both kinds, and some are seen.
#[test]
fn small_and_giant_triangles_are_met() {
    let (mesh, strategy) = (tetrahedra(12), vertices(12));
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let (mut exact, mut wide, mut pixels, mut edges) = (0, 0, 0, 0);
    for _ in 0..100 {
        let vertices = strategy.new_tree(&mut runner).unwrap().current();
        for triangle in &mesh.triangles {
            let corners = triangle.map(|vertex| vertices[vertex as usize]);
            *(if is_exact(corners) { &mut exact } else { &mut wide }) += 1;
        }
        let drawn = draw_mesh(&vertices, &mesh, 83, 61);
        pixels += drawn.bytes.iter().filter(|byte| **byte != 0).count();
        edges += drawn.bytes.iter().filter(|byte| **byte & 0x80 != 0).count();
    }
    assert!(exact > 2000 && wide > 300, "{exact} exact, {wide} wide");
    assert!(pixels > 50_000 && edges > 5000, "{pixels} pixels, {edges} of edges");
}

/// Two giants through each other, far larger than the picture: every depth by the wide way, and one vertex a pixel off shows.
#[test]
fn giants_are_exact_and_a_moved_vertex_is_noticed() {
    let mesh = tetrahedra(2);
    let at = |x: i32, y: i32, z: f32| ProjectedVertex {
        at: [x, y],
        depth: 1.0 - 100.0 / z,
        edge_depth: 1.0 - 100.0 / (z - 30.0),
        has_image: true,
    };
    let mut vertices = vec![
        at(-4_000_001, -3_999_999, 201.0),
        at(4_100_003, -4_100_000, 90_000.0),
        at(17, 4_194_303, 433.0),
        at(311, 4097, 210.0),
        at(-4_100_001, -3_899_999, 90_001.0),
        at(4_000_003, -4_000_001, 203.0),
        at(-4_000_017, 4_194_301, 533.0),
        at(511, 4097, 215.0),
    ];
    let expected = draw_mesh(&vertices, &mesh, 300, 200);
    for label in [1, 2] {
        assert!(expected.bytes.iter().filter(|byte| **byte & 0x7f == label).count() > 1000, "label {label}");
    }
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        assert!(drawn(set, &mesh, &vertices, [300, 200]) == expected, "{}", set.name());
    }
    vertices[6].at[0] += 25_600;
    assert!(draw_mesh(&vertices, &mesh, 300, 200) != expected);
    assert!(drawn(InstructionSet::best(), &mesh, &vertices, [300, 200]) != expected);
}
