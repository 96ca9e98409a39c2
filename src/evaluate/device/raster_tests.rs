//! The compute drawing alone, fed quads that no body would give, against the reference's drawing and comparison of the same.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use super::passes::{Images, raster, raster_stage};
use super::raster_kernel::{RasterKernel, RowWay};
use super::scene::{DeviceScene, Share};
use super::spans;
use super::summed::Summed;
use super::tests::{cameras, device, fetch, set_up_with};
use super::workspace::Workspace;
use crate::body::Body;
use crate::evaluate::shaders::{layout, raster_comp};
use crate::evaluate::{PartQuad, compare, draw_quads};
use crate::features::Observation;
use crate::geometry::Camera;
use crate::gpu::{Device, DeviceSettings, Memory, Timing};

/// A small generator for test data.
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn below(&mut self, end: i32) -> i32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (((self.0 >> 33) * end as u64) >> 31) as i32
    }

    fn around(&mut self, centre: i32, reach: i32) -> i32 {
        centre + self.below(2 * reach + 1) - reach
    }
}

/// Pictures of odd sizes: a column, narrower than a word, wider than two chunks, and just past a word.
pub(super) fn odd_cameras() -> Vec<Camera> {
    let mut cameras = cameras();
    for size in [[1, 300], [300, 1], [31, 64], [257, 70], [33, 33]] {
        cameras.push(Camera { size, ..cameras[0].clone() });
    }
    cameras
}

/// Corners of all kinds, in 1/256 pixel, around a picture of `size`.
fn quad(random: &mut Random, size: [u32; 2]) -> [[i32; 2]; 4] {
    const FARTHEST: i32 = 16384 * 256;
    let [width, height] = size.map(|side| side as i32 * 256);
    let kind = random.below(8);
    let (x, y) = (random.below(width), random.below(height));
    let mut corners = [[0; 2]; 4];
    for corner in &mut corners {
        *corner = match kind {
            // Limbs, large and small.
            0 => [random.around(x, 256 * 40), random.around(y, 256 * 40)],
            1 => [random.around(x, 256 * 4), random.around(y, 256 * 4)],
            // Whole and half pixels: ties everywhere.
            2 => [random.around(x >> 8, 20) * 256, random.around(y >> 8, 20) * 256],
            3 => [random.around(x >> 8, 20) * 128, random.around(y >> 8, 20) * 128],
            // As far as corners go.
            4 => [random.around(0, FARTHEST), random.around(0, FARTHEST)],
            5 => [
                [-FARTHEST, FARTHEST, random.around(x, 3)][random.below(3) as usize],
                [-FARTHEST, FARTHEST, random.around(y, 3)][random.below(3) as usize],
            ],
            // Slivers, and points.
            6 => [random.around(x, 300), random.around(y, 256 * 90)],
            _ => [random.around(x, 1), random.around(y, 1)],
        };
    }
    match random.below(6) {
        // Level, upright, and folded onto a line.
        0 => corners.iter_mut().for_each(|corner| corner[1] = y),
        1 => corners.iter_mut().for_each(|corner| corner[0] = x),
        2 => corners[2] = corners[0],
        _ => {}
    }
    corners
}

/// Quads of one image, in the body's order, with depths that repeat.
pub(super) fn image(random: &mut Random, parts: usize, size: [u32; 2]) -> Vec<PartQuad> {
    (0..parts)
        .map(|_| PartQuad {
            corners: quad(random, size),
            depth_squared: random.below(40) as f32,
            drawn: random.below(8) > 0,
        })
        .collect()
}

/// As the projection writes them: nearest first, the later one at equal depth.
fn rows(quads: &[PartQuad]) -> Vec<layout::Quad> {
    let mut order: Vec<usize> = (0..quads.len()).rev().collect();
    order.sort_by(|&l, &r| quads[l].depth_squared.total_cmp(&quads[r].depth_squared));
    order
        .into_iter()
        .map(|part| {
            let quad = &quads[part];
            let axis = |axis: usize| quad.corners.map(|corner| if quad.drawn { corner[axis] } else { 0 });
            layout::Quad {
                x: axis(0),
                y: axis(1),
                drawn: u32::from(quad.drawn),
                label: part as u32 % 127 + 1,
                part: part as u32,
                depth_squared: quad.depth_squared,
            }
        })
        .collect()
}

pub(super) fn observations(random: &mut Random, scene: &DeviceScene) -> Vec<Observation> {
    scene
        .sizes
        .iter()
        .map(|&[width, height]| {
            let mut observation = Observation::empty(width, height);
            observation.bytes.iter_mut().for_each(|byte| *byte = random.below(256) as u8);
            observation
        })
        .collect()
}

/// Puts quads in the workspace in the place of projected ones.
pub(super) fn put(device: &Device, workspace: &Workspace, scene: &DeviceScene, images: &[Vec<PartQuad>]) {
    let quads: Vec<_> = images.iter().flat_map(|quads| rows(quads)).collect();
    let bounds: Vec<_> = images
        .iter()
        .enumerate()
        .map(|(image, quads)| {
            let size = scene.sizes[image % scene.sizes.len()].map(|side| side as i32);
            let found = super::tests::bounds_of(quads, size);
            layout::Bounds { low: found.low, high: found.high }
        })
        .collect();
    let quad_staging = device.buffer::<layout::Quad>("quad staging", quads.len(), Memory::Upload).unwrap();
    let bound_staging = device.buffer::<layout::Bounds>("bound staging", bounds.len(), Memory::Upload).unwrap();
    quad_staging.write(0, &quads).unwrap();
    bound_staging.write(0, &bounds).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    recorder.copy("put", (&quad_staging, 0), (&workspace.quads, 0), quad_staging.size()).unwrap();
    recorder.copy("put", (&bound_staging, 0), (&workspace.bounds, 0), bound_staging.size()).unwrap();
    scene.record_upload(&mut recorder).unwrap();
    recorder.finish().unwrap().run().unwrap();
}

fn expected(images: &[Vec<PartQuad>], seen: &[Observation]) -> Vec<[u32; 4]> {
    images
        .iter()
        .enumerate()
        .map(|(image, quads)| {
            let seen = &seen[image % seen.len()];
            let labels: Vec<u8> = (0..quads.len()).map(|part| (part % 127 + 1) as u8).collect();
            let sums = compare(&draw_quads(quads, &labels, seen.width, seen.height), seen);
            [sums.area_model, sums.overlap, sums.edges, sums.proximity]
        })
        .collect()
}

fn found(sums: &[layout::Sums]) -> Vec<[u32; 4]> {
    sums.iter().map(|sums| [sums.area_model, sums.overlap, sums.edges, sums.proximity]).collect()
}

/// A body of as many parts as wanted.
pub(super) fn body_of(parts: usize) -> Body {
    let mut body = Body::adult(1750.0).unwrap();
    while body.parts.len() < parts {
        let mut part = body.parts[body.parts.len() % 7].clone();
        part.name = format!("copy_{}", body.parts.len());
        part.label = body.parts.len() as u8 + 1;
        body.parts.push(part);
    }
    body.parts.truncate(parts);
    body
}

/// 2800 images of 16 parts, or 280 of 70 parts, of which not all fit a workgroup at once.
fn check(name: &str, settings: &DeviceSettings, parts: usize, candidates: usize) {
    let Some((device, log)) = device(name, settings.clone()) else { return };
    let body = body_of(parts);
    let poses = vec![0.0; candidates * body.dof_count()];
    let (_, mut scene, workspace, share) = set_up_with(&device, &body, &odd_cameras(), &poses);
    let mut random = Random(parts as u64);
    let images: Vec<_> = (0..candidates * scene.sizes.len())
        .map(|i| image(&mut random, parts, scene.sizes[i % scene.sizes.len()]))
        .collect();
    let seen = observations(&mut random, &scene);
    scene.observe(&seen).unwrap();
    put(&device, &workspace, &scene, &images);
    let shader = raster_stage(&device, raster_comp::Constants::default()).shader;
    assert_eq!(shader.label(), if device.capabilities().subgroup_arithmetic { "raster" } else { "raster_shared" });
    let mut recorder = device.recorder(Timing::Off).unwrap();
    let usual = Images::All(RowWay::USUAL);
    raster(&mut recorder, (&scene, &workspace), Summed::Nothing, usual, share).unwrap();
    recorder.finish().unwrap().run().unwrap();
    let expected = expected(&images, &seen);
    let sums = found(&fetch::<layout::Sums>(&device, &workspace.sums, images.len()));
    let drawn = expected.iter().filter(|sums| sums[0] > 0).count();
    assert!(drawn * 2 > images.len(), "only {drawn} of {} images show anything", images.len());
    for (image, (expected, found)) in expected.iter().zip(&sums).enumerate() {
        let size = scene.sizes[image % scene.sizes.len()];
        assert_eq!(expected, found, "image {image} of {size:?}: {:?}", images[image]);
    }

    let odd =
        [(8, 1, false), (8, 3, true), (16, 3, false), (64, 4, true), (128, 1, true), (128, 4, false), (256, 3, true)]
            .map(|(group, words, keeps_edges)| RasterKernel::Rows(RowWay { group, words, keeps_edges }));
    for kernel in RasterKernel::all(device.capabilities()).into_iter().chain(odd) {
        kernel.check(device.capabilities().max_workgroup).unwrap();
        let mut recorder = device.recorder(Timing::Off).unwrap();
        recorder.fill("spoil", &workspace.sums, 0xffff_ffff).unwrap();
        let scene_and_room = (&scene, &workspace);
        match kernel {
            RasterKernel::Rows(way) => {
                raster(&mut recorder, scene_and_room, Summed::Nothing, Images::All(way), share).unwrap();
            }
            RasterKernel::Spans { .. } => {
                spans::raster(&mut recorder, scene_and_room, Summed::Nothing, kernel, share).unwrap();
            }
        }
        recorder.finish().unwrap().run().unwrap();
        let sums = found(&fetch::<layout::Sums>(&device, &workspace.sums, images.len()));
        for (image, (expected, found)) in expected.iter().zip(&sums).enumerate() {
            let size = scene.sizes[image % scene.sizes.len()];
            assert_eq!(expected, found, "{kernel}: image {image} of {size:?}: {:?}", images[image]);
        }
    }

    // Every third image of a list, in the place of a candidate further on.
    let list: Vec<u32> = (0..images.len() as u32).step_by(3).collect();
    let words: Vec<u32> = [list.len() as u32, 1, 1].into_iter().chain(list.iter().copied()).collect();
    let buffer = device.buffer::<u32>("list", words.len(), Memory::Upload).unwrap();
    buffer.write(0, &words).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    recorder.fill("clear", &workspace.sums, 0xffff_ffff).unwrap();
    let share = Share { first: 0, candidates: 1 };
    raster(&mut recorder, (&scene, &workspace), Summed::Nothing, Images::Listed(&buffer), share).unwrap();
    recorder.finish().unwrap().run().unwrap();
    let sums = found(&fetch::<layout::Sums>(&device, &workspace.sums, images.len()));
    for (image, (expected, found)) in expected.iter().zip(&sums).enumerate() {
        assert_eq!(if image % 3 == 0 { expected } else { &[u32::MAX; 4] }, found, "listed image {image}");
    }
    drop((workspace, scene, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn odd_quads_give_the_reference_s_integers() {
    check("odd_quads_give_the_reference_s_integers", &DeviceSettings::default(), 16, 400);
    check("odd_quads_give_the_reference_s_integers", &DeviceSettings::default(), 70, 40);
}

#[test]
fn odd_quads_agree_without_subgroup_arithmetic() {
    let settings = DeviceSettings { lower: Some(|c| c.subgroup_arithmetic = false), ..DeviceSettings::default() };
    check("odd_quads_agree_without_subgroup_arithmetic", &settings, 16, 200);
}

/// More rows and columns, all covered by all parts, than an invocation of lavapipe may go through by itself.
#[test]
fn a_picture_too_large_for_a_workgroup_is_shared() {
    let name = "a_picture_too_large_for_a_workgroup_is_shared";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let size = [6144, 6144];
    let large = vec![Camera { size, ..cameras()[0].clone() }];
    let body = body_of(16);
    let (_, mut scene, workspace, share) = set_up_with(&device, &body, &large, &vec![0.0; body.dof_count()]);
    assert_eq!(
        spans::drawable(&scene, RasterKernel::Spans { group: 128, workgroups: 3 }).to_string(),
        "spans first (3 x 128 an image)"
    );
    let kernel = spans::drawable(&scene, RasterKernel::ROWS);
    assert!(matches!(kernel, RasterKernel::Spans { .. }), "{kernel}");
    let corner = 6200 * 256;
    let everywhere = PartQuad {
        corners: [[-corner, -corner], [corner, -corner], [corner, corner], [-corner, corner]],
        depth_squared: 1.0,
        drawn: true,
    };
    let images = vec![vec![everywhere; 16]];
    let mut random = Random(8);
    let seen = observations(&mut random, &scene);
    scene.observe(&seen).unwrap();
    put(&device, &workspace, &scene, &images);
    let mut recorder = device.recorder(Timing::Off).unwrap();
    spans::raster(&mut recorder, (&scene, &workspace), Summed::Nothing, kernel, share).unwrap();
    recorder.finish().unwrap().run().unwrap();
    assert_eq!(found(&fetch::<layout::Sums>(&device, &workspace.sums, 1)), expected(&images, &seen));
    drop((workspace, scene, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}
