//! The mesh model drawn by its definition in docs/RASTER.md, pixel by pixel, in exact integers: triangles and silhouette edges, each
//! with a depth a pixel.

use crate::body::{Mesh, MeshEdge};

use super::mesh_projection::{ProjectedVertex, depth_number};
use super::raster::{CandidateImage, for_each_line_pixel};

/// Draws a mesh whose vertices one camera sees as `vertices`.
pub fn draw_mesh(vertices: &[ProjectedVertex], mesh: &Mesh, width: u32, height: u32) -> CandidateImage {
    let mut image = CandidateImage { width, height, bytes: vec![0; width as usize * height as usize] };
    let mut depths = vec![NOWHERE; image.bytes.len()];
    // The nearest is shown; of what is at equal depth the larger byte: edges before triangles, then the larger label.
    let mut show = |pixel: usize, depth: i64, byte: u8| {
        if depth < depths[pixel] || (depth == depths[pixel] && byte > image.bytes[pixel]) {
            depths[pixel] = depth;
            image.bytes[pixel] = byte;
        }
    };
    for triangle in &mesh.triangles {
        let corners = triangle.map(|vertex| vertices[vertex as usize]);
        let label = mesh.vertices[triangle[0] as usize].label;
        if corners.iter().all(|corner| corner.has_image) && faces_camera(&corners) {
            for_each_triangle_pixel(&corners, width, height, |pixel, depth| show(pixel, depth, label));
        }
    }
    for edge in mesh.edges.iter().filter(|edge| is_silhouette(edge, vertices)) {
        let [p, q] = edge.ends.map(|vertex| vertices[vertex as usize]);
        let label = mesh.vertices[edge.ends[0] as usize].label;
        let [first, last] = [p, q].map(|end| i64::from(depth_number(end.edge_depth)));
        for_each_line_pixel([p.at, q.at], width, height, |pixel, [step, steps]| {
            let depth = if steps == 0 {
                first
            } else {
                nearest(i128::from(first * (steps - step) + last * step), i128::from(steps))
            };
            show(pixel, depth, label | 0x80);
        });
    }
    image
}

/// Farther than any depth.
const NOWHERE: i64 = 1 << 24;

/// `numerator / denominator` to the nearest integer, a tie upwards; the denominator is positive.
fn nearest(numerator: i128, denominator: i128) -> i64 {
    (2 * numerator + denominator).div_euclid(2 * denominator) as i64
}

/// Whether all of an edge's surroundings have an image and exactly one of its triangles faces the camera.
fn is_silhouette(edge: &MeshEdge, vertices: &[ProjectedVertex]) -> bool {
    let [p, q] = edge.ends.map(|vertex| vertices[vertex as usize]);
    let [left, right] = edge.opposite.map(|vertex| vertices[vertex as usize]);
    [p, q, left, right].iter().all(|corner| corner.has_image)
        && faces_camera(&[p, q, left]) != faces_camera(&[q, p, right])
}

/// Whether a triangle that is counter-clockwise from outside shows its outside: y points down in a picture, so its area
/// there is negative. One without an area does not.
fn faces_camera(corners: &[ProjectedVertex; 3]) -> bool {
    let [a, b, c] = corners.map(|corner| corner.at.map(i64::from));
    area(a, b, c) < 0
}

/// Twice the signed area of a triangle in 1/256 pixel, positive when it is clockwise to the eye.
fn area(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Calls `paint` with the index and the depth of every pixel whose centre lies in a triangle that faces the camera: inside, or
/// on a left edge or a horizontal top edge.
fn for_each_triangle_pixel(corners: &[ProjectedVertex; 3], width: u32, height: u32, mut paint: impl FnMut(usize, i64)) {
    // Clockwise to the eye, so that the inside is where all three areas are positive.
    let [a, c, b] = corners.map(|corner| corner.at.map(i64::from));
    let depths = [corners[0], corners[2], corners[1]].map(|corner| i128::from(depth_number(corner.depth)));
    let whole = i128::from(area(a, b, c));
    // On an edge that runs to the right along the top, or upwards on the left.
    let takes = |from: [i64; 2], to: [i64; 2]| to[1] < from[1] || (to[1] == from[1] && to[0] > from[0]);
    let sides = [(b, c), (c, a), (a, b)];
    let least = sides.map(|(from, to)| i64::from(!takes(from, to)));
    let pixels = |axis: usize, size: u32| {
        let (low, high) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
        // The first centre at or after the low end, and the last at or before the high one.
        (low + 255).div_euclid(256).max(0)..high.div_euclid(256).saturating_add(1).min(i64::from(size))
    };
    for y in pixels(1, height) {
        for x in pixels(0, width) {
            let centre = [256 * x, 256 * y];
            let areas = sides.map(|(from, to)| area(from, to, centre));
            if areas.iter().zip(&least).all(|(area, least)| area >= least) {
                // Each corner's depth by the share of the triangle opposite to it.
                let sum = areas.iter().zip(&depths).map(|(area, depth)| i128::from(*area) * depth).sum();
                paint((y * i64::from(width) + x) as usize, nearest(sum, whole));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, Vec3};

    use super::*;
    use crate::body::{MeshVertex, Skinning};

    /// The eight corners of a cube and its twelve triangles, counter-clockwise from outside; corner bits are x, y, z.
    fn cube() -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let corners =
            (0..8_u8).map(|bits| Vec3::new(f32::from(bits & 1), f32::from(bits >> 1 & 1), f32::from(bits >> 2)));
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        (corners.collect(), faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
    }

    /// A mesh of points that nothing moves, all of one label.
    fn still(points: &[Vec3], triangles: Vec<[u32; 3]>, label: u8) -> Mesh {
        let vertex =
            |position: &Vec3| MeshVertex { position: *position, bones: [0; 4], weights: [1.0, 0.0, 0.0, 0.0], label };
        let vertices = points.iter().map(vertex).collect();
        Mesh::new(vertices, triangles, Skinning::Rigid, vec![DAffine3::IDENTITY]).unwrap()
    }

    /// Points seen by a camera that looks along +z with y down, from 1 m per unit of depth; x and y are pixels already.
    fn seen(points: &[Vec3]) -> Vec<ProjectedVertex> {
        let depth = |z: f32| 1.0 - 100.0 / z;
        points
            .iter()
            .map(|at| ProjectedVertex {
                at: [at.x, at.y].map(|v| (v * 256.0).round() as i32),
                depth: depth(at.z),
                edge_depth: depth(at.z - super::super::EDGE_BIAS),
                has_image: true,
            })
            .collect()
    }

    /// A turn that shows a corner of the cube, then 40 pixels a unit.
    fn corner_on(points: &[Vec3]) -> Vec<Vec3> {
        let turn = glam::Quat::from_rotation_x(0.6) * glam::Quat::from_rotation_y(0.8);
        points.iter().map(|at| turn * (*at - Vec3::splat(0.5)) * 40.0 + Vec3::new(50.0, 50.0, 3000.0)).collect()
    }

    #[test]
    fn a_cube_seen_on_a_corner_has_six_silhouette_edges_and_face_on_four() {
        let (points, triangles) = cube();
        let mesh = still(&points, triangles, 9);
        let count = |points: &[Vec3]| {
            let vertices = seen(points);
            mesh.edges.iter().filter(|edge| is_silhouette(edge, &vertices)).count()
        };
        assert_eq!(mesh.edges.len(), 18);
        assert_eq!(count(&corner_on(&points)), 6);
        let face_on: Vec<Vec3> = points.iter().map(|at| *at * 40.0 + Vec3::new(10.0, 10.0, 3000.0)).collect();
        assert_eq!(count(&face_on), 4, "triangles without an area show no side");
    }

    #[test]
    fn a_box_covers_its_area_and_the_border_lies_round_it() {
        let (points, triangles) = cube();
        let mesh = still(&points, triangles, 9);
        let face_on: Vec<Vec3> =
            points.iter().map(|at| Vec3::new(at.x * 5.0 + 1.0, at.y * 3.0 + 1.0, at.z * 40.0 + 3000.0)).collect();
        let image = draw_mesh(&seen(&face_on), &mesh, 8, 6);
        let rows: Vec<String> = image
            .bytes
            .chunks(8)
            .map(|row| {
                row.iter()
                    .map(|byte| {
                        if byte & 0x80 != 0 {
                            '#'
                        } else if *byte == 9 {
                            'o'
                        } else {
                            '.'
                        }
                    })
                    .collect()
            })
            .collect();
        assert_eq!(rows, ["........", ".######.", ".#oooo#.", ".#oooo#.", ".######.", "........"]);
        let mut filled = Vec::new();
        let vertices = seen(&face_on);
        for triangle in &mesh.triangles {
            let corners = triangle.map(|vertex| vertices[vertex as usize]);
            if faces_camera(&corners) {
                for_each_triangle_pixel(&corners, 8, 6, |pixel, _| filled.push(pixel));
            }
        }
        filled.sort_unstable();
        let expected: Vec<usize> = (1..4).flat_map(|y| (1..6).map(move |x| y * 8 + x)).collect();
        assert_eq!(filled, expected, "left and top included, right and bottom excluded, the diagonal drawn once");
    }

    /// A globe of rings, closed by two poles.
    fn globe(rings: u32, sides: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let mut points = vec![Vec3::Z, Vec3::NEG_Z];
        let mut triangles = Vec::new();
        for ring in 0..rings {
            let (down, out) = ((ring as f32 + 1.0) / (rings as f32 + 1.0) * std::f32::consts::PI).sin_cos();
            for side in 0..sides {
                let (sin, cos) = (side as f32 / sides as f32 * std::f32::consts::TAU).sin_cos();
                points.push(Vec3::new(down * cos, down * sin, out));
                let (here, next) = (2 + ring * sides + side, 2 + ring * sides + (side + 1) % sides);
                match ring {
                    0 => triangles.push([0, here, next]),
                    _ => triangles.extend([[here - sides, here, next], [here - sides, next, next - sides]]),
                }
                if ring + 1 == rings {
                    triangles.push([1, next, here]);
                }
            }
        }
        (points, triangles)
    }

    #[test]
    fn a_globe_covers_the_area_of_its_circle_and_nearly_all_of_its_border_is_seen() {
        let (points, triangles) = globe(40, 80);
        let mesh = still(&points, triangles, 5);
        let turn = glam::Quat::from_rotation_x(0.9);
        let placed: Vec<Vec3> = points
            .iter()
            .map(|at| {
                let at = turn * *at;
                // 50 pixels of radius, 100 mm of depth.
                Vec3::new(at.x * 50.0 + 64.3, at.y * 50.0 + 64.6, at.z * 100.0 + 4000.0)
            })
            .collect();
        let image = draw_mesh(&seen(&placed), &mesh, 128, 128);
        let mut filled = vec![false; 128 * 128];
        let vertices = seen(&placed);
        for triangle in &mesh.triangles {
            let corners = triangle.map(|vertex| vertices[vertex as usize]);
            if faces_camera(&corners) {
                for_each_triangle_pixel(&corners, 128, 128, |pixel, _| {
                    assert!(!filled[pixel], "a convex surface shows every pixel once");
                    filled[pixel] = true;
                });
            }
        }
        // The backs, turned round to be drawn, cover the same pixels: leaving them out changes nothing.
        let mut behind = vec![false; 128 * 128];
        for &[a, b, c] in &mesh.triangles {
            let corners = [a, c, b].map(|vertex| vertices[vertex as usize]);
            if faces_camera(&corners) {
                for_each_triangle_pixel(&corners, 128, 128, |pixel, _| behind[pixel] = true);
            }
        }
        assert_eq!(behind, filled);
        let area = filled.iter().filter(|pixel| **pixel).count() as f32;
        let circle = std::f32::consts::PI * 2500.0;
        assert!((area / circle - 1.0).abs() < 0.005, "{area} of {circle}");
        let border = image.bytes.iter().filter(|byte| **byte & 0x80 != 0).count() as f32;
        // A circle's pixels without corners are 4 sqrt(2) radii.
        assert!((border / (4.0 * 2_f32.sqrt() * 50.0) - 1.0).abs() < 0.1, "{border} border pixels");
    }

    #[test]
    fn the_nearer_hides_the_farther_and_its_border_in_any_order() {
        let (points, triangles) = cube();
        let near: Vec<Vec3> = points.iter().map(|at| *at * 20.0 + Vec3::new(10.0, 10.0, 2000.0)).collect();
        let far: Vec<Vec3> = points.iter().map(|at| *at * 20.0 + Vec3::new(20.0, 15.0, 2500.0)).collect();
        let mut both = triangles.clone();
        both.extend(triangles.iter().map(|triangle| triangle.map(|vertex| vertex + 8)));
        let drawn = |first: &[Vec3], second: &[Vec3], labels: [u8; 2]| {
            let all: Vec<Vec3> = first.iter().chain(second).copied().collect();
            let mut mesh = still(&all, both.clone(), labels[0]);
            mesh.vertices[8..].iter_mut().for_each(|vertex| vertex.label = labels[1]);
            draw_mesh(&seen(&all), &mesh, 48, 48)
        };
        let image = drawn(&near, &far, [1, 2]);
        assert_eq!(image, drawn(&far, &near, [2, 1]));
        let at = |x: usize, y: usize| image.bytes[y * 48 + x];
        assert_eq!([at(25, 20), at(35, 20), at(15, 12), at(5, 5)], [1, 2, 1, 0]);
        assert_eq!([at(20, 20), at(30, 20), at(40, 20)], [1, 0x81, 0x82], "the far one's left border is hidden");
    }

    #[test]
    fn a_vertex_without_an_image_takes_its_triangles_along() {
        let (points, triangles) = cube();
        let mesh = still(&points, triangles, 9);
        let mut vertices = seen(&corner_on(&points));
        let whole = draw_mesh(&vertices, &mesh, 100, 100);
        let drawn = |image: &CandidateImage| image.bytes.iter().filter(|byte| **byte != 0).count();
        for vertex in 0..8 {
            vertices[vertex].has_image = false;
            vertices[vertex].at = [i32::MIN, i32::MAX];
            assert!(drawn(&draw_mesh(&vertices, &mesh, 100, 100)) < drawn(&whole));
            vertices[vertex] = seen(&corner_on(&points))[vertex];
        }
        // Moving one vertex by a pixel is seen.
        vertices[0].at[0] += 256;
        assert_ne!(draw_mesh(&vertices, &mesh, 100, 100), whole);
    }
}
