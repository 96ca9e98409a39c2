//! The graphics backend and its stages against the reference, and the comparison that says so caught lying.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use super::Graphics;
use super::compare::Comparing;
use super::draw::FlatDrawing;
use super::framebuffer::Framebuffer;
use super::passes::{feedback_room, place, project_by_feedback};
use super::readback::FramebufferCopy;
use super::settings::{
    Comparison, Coverage, Gathering, GraphicsSettings, HostComparison, Packing, Primitives, Projection, Tiling,
};
use super::tiles::TileLayout;
use crate::body::Body;
use crate::evaluate::device::passes;
use crate::evaluate::device::raster_tests::{Random, image, observations, odd_cameras, put};
use crate::evaluate::device::tests::{cameras, device, fetch, poses, recorded_fitness, set_up, set_up_with};
use crate::evaluate::device_evaluator::DeviceEvaluator;
use crate::evaluate::shaders::{COMPARE_GROUP, MOST_COMPARE_GROUP, layout};
use crate::evaluate::{Components, Evaluator, Objective, ObjectiveKind, Reference, draw_quads};
use crate::features::Observation;
use crate::geometry::Camera;
use crate::gpu::{Capabilities, DeviceSettings, Memory, Timing};

/// Bytes of any value for every pixel.
fn noise(cameras: &[Camera]) -> Vec<Observation> {
    let mut state = 5_u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as u8
    };
    let observe = |camera: &Camera| {
        let mut observation = Observation::empty(camera.size[0], camera.size[1]);
        observation.bytes.iter_mut().for_each(|byte| *byte = random());
        observation
    };
    cameras.iter().map(observe).collect()
}

fn reference(body: &Body, cameras: &[Camera], seen: &[Observation], poses: &[f32]) -> Vec<Components> {
    let mut reference = Reference::new(body, cameras);
    reference.observe(seen).unwrap();
    let mut components = vec![Components::default(); poses.len() / body.dof_count() * cameras.len()];
    reference.components(poses, &mut components).unwrap();
    components
}

/// Every way of the exact rule, and every way to compare.
pub(super) fn exact_settings() -> Vec<GraphicsSettings> {
    let mut all = Vec::new();
    for packing in [Packing::Max, Packing::Depth] {
        for comparison in [
            Comparison::Device(Gathering::Texels),
            Comparison::Device(Gathering::Subgroup),
            Comparison::Device(Gathering::Shared),
            Comparison::Host(HostComparison::Scalar),
            Comparison::Host(HostComparison::Simd),
        ] {
            let tiling = if all.len() == 3 { Tiling::Pictures } else { Tiling::Regions };
            let projection = if all.len() == 1 { Projection::Feedback } else { Projection::Compute };
            // One of each packing, and one that reads back.
            let primitives = if [2, 6, 9].contains(&all.len()) { Primitives::Geometry } else { Primitives::Vertices };
            let usual = GraphicsSettings::default();
            all.push(GraphicsSettings { packing, comparison, tiling, projection, primitives, ..usual });
        }
    }
    all
}

pub(super) fn lowered(lower: fn(&mut Capabilities)) -> DeviceSettings {
    DeviceSettings { lower: Some(lower), ..DeviceSettings::default() }
}

/// Components of `settings` on a device, which must be the reference's, with the tiles first guessed and then fitted.
fn check_backend(name: &str, settings: DeviceSettings, all: &[GraphicsSettings], count: usize) {
    let Some((device, log)) = device(name, settings) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let poses = poses(&body, count);
    let seen = noise(&cameras);
    let expected = reference(&body, &cameras, &seen, &poses);
    let drawn = expected.iter().filter(|sums| sums.area_model > 0).count();
    assert!(drawn * 3 > expected.len(), "only {drawn} of {} images show anything", expected.len());
    for &settings in all {
        let mut graphics = Graphics::on(&device, &body, &cameras, settings).unwrap();
        graphics.observe(&seen).unwrap();
        let mut found = vec![Components::default(); expected.len()];
        for round in ["guessed", "fitted"] {
            graphics.components(&poses, &mut found).unwrap();
            let first = expected.iter().zip(&found).position(|(expected, found)| expected != found);
            let first = first.map(|image| (image, expected[image], found[image]));
            assert_eq!(first, None, "{} with {round} tiles: {:?}", settings.name(), graphics.tiles());
        }
        // Fitness with tiles far too small for anybody, so that all is scored without a framebuffer; and by the host's formula.
        if settings.tiling == Tiling::Regions {
            graphics.set_tiles(vec![[8, 8]; cameras.len()]).unwrap();
        }
        let objective = Objective { kind: ObjectiveKind::Aosp, ..Objective::default() };
        let mut fitness = vec![0.0; count];
        Evaluator::fitness(&mut graphics, &poses, &objective, &mut fitness).unwrap();
        for (row, fitness) in expected.chunks_exact(cameras.len()).zip(&fitness) {
            assert!((objective.fitness(row) - fitness).abs() < 1e-5, "{}", settings.name());
        }
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn every_variant_gives_the_reference_s_integers() {
    let name = "every_variant_gives_the_reference_s_integers";
    check_backend(name, DeviceSettings::default(), &exact_settings(), 303);
}

#[test]
fn small_devices_work_in_batches() {
    let settings = lowered(|capabilities| {
        capabilities.max_image = 300;
        capabilities.max_storage = 1 << 18;
        capabilities.memory = 3 << 20;
        capabilities.subgroup_shuffle = false;
        capabilities.subgroup_arithmetic = false;
        capabilities.transform_feedback = false;
        capabilities.geometry_shader = false;
    });
    check_backend("small_devices_work_in_batches", settings, &exact_settings(), 101);
}

#[test]
fn what_a_device_lacks_is_replaced() {
    let settings = lowered(|capabilities| {
        capabilities.subgroup_shuffle = false;
        capabilities.transform_feedback = false;
        capabilities.geometry_shader = false;
    });
    let Some((device, log)) = device("what_a_device_lacks_is_replaced", settings) else { return };
    let asked = GraphicsSettings {
        comparison: Comparison::Device(Gathering::Subgroup),
        projection: Projection::Feedback,
        primitives: Primitives::Geometry,
        ..GraphicsSettings::default()
    };
    let graphics = Graphics::on(&device, &Body::adult(1750.0).unwrap(), &cameras(), asked).unwrap();
    assert_eq!(graphics.variant(), "max-shared");
    assert_eq!(graphics.settings().projection, Projection::Compute);
    drop((graphics, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// A layout with tiles as large as the pictures.
pub(super) fn pictures(sizes: &[[u32; 2]], candidates: u32) -> TileLayout {
    TileLayout::new(sizes, candidates, 16384, u64::MAX).unwrap()
}

#[test]
fn odd_quads_are_drawn_to_the_pixel() {
    let Some((device, log)) = device("odd_quads_are_drawn_to_the_pixel", DeviceSettings::default()) else { return };
    let body = Body::adult(1750.0).unwrap();
    let (candidates, parts) = (120, body.parts.len());
    let poses = vec![0.0; candidates * body.dof_count()];
    let (_, mut scene, workspace, share) = set_up_with(&device, &body, &odd_cameras(), &poses);
    let mut random = Random(11);
    let views = scene.sizes.len();
    let images: Vec<_> = (0..candidates * views).map(|i| image(&mut random, parts, scene.sizes[i % views])).collect();
    let seen = observations(&mut random, &scene);
    scene.observe(&seen).unwrap();
    put(&device, &workspace, &scene, &images);
    let labels: Vec<u8> = (0..parts).map(|part| part as u8 + 1).collect();
    let usual = GraphicsSettings::default();
    for (packing, primitives) in [
        (Packing::Max, Primitives::Vertices),
        (Packing::Depth, Primitives::Vertices),
        (Packing::Max, Primitives::Geometry),
        (Packing::Depth, Primitives::Geometry),
    ] {
        let settings = GraphicsSettings { packing, primitives, ..usual };
        if settings.on(device.capabilities()) != settings {
            println!("SKIPPED {}: this device cannot", settings.name());
            continue;
        }
        let layout = pictures(&scene.sizes, candidates as u32);
        let framebuffer = Framebuffer::new(&device, layout, packing, false).unwrap();
        let copy = FramebufferCopy::new(&device, &framebuffer).unwrap();
        let draw = FlatDrawing::new(&device, parts as u32, &settings).unwrap();
        let mut recorder = device.recorder(Timing::Off).unwrap();
        place(&mut recorder, (&scene, &workspace), &framebuffer, scene.counts.parts, share).unwrap();
        draw.record(&mut recorder, (&scene, &workspace), &framebuffer, share).unwrap();
        copy.record(&mut recorder, &framebuffer).unwrap();
        recorder.finish().unwrap().run().unwrap();
        let drawn = copy.read(&framebuffer, candidates as u32).unwrap();
        let (mut pixels, mut listed) = (0, 0);
        let placements: Vec<layout::Placement> = fetch(&device, &framebuffer.placements, images.len());
        for (index, quads) in images.iter().enumerate() {
            // A part of thousands of pixels in a wide picture is left to the stage without a framebuffer.
            if placements[index].low == placements[index].high {
                listed += 1;
                continue;
            }
            let (candidate, view) = (index / views, index % views);
            let size = scene.sizes[view];
            let expected = draw_quads(quads, &labels, size[0], size[1]);
            pixels += expected.bytes.iter().filter(|byte| **byte != 0).count();
            let found = drawn.image(candidate as u32, view, size);
            // Ranks of the largest packing grow from the farthest part on.
            let byte = |byte: u8| match packing {
                Packing::Depth => byte,
                Packing::Max if byte == 0 => 0,
                Packing::Max => {
                    let own = usize::from(byte & 0x7f) - 1;
                    let depth = |part: usize| (quads[part].depth_squared, std::cmp::Reverse(part));
                    let rank = (0..parts).filter(|&part| depth(part) >= depth(own)).count();
                    2 * rank as u8 + (byte >> 7)
                }
            };
            let first = (0..found.len()).find(|&pixel| found[pixel] != byte(expected.bytes[pixel]));
            let first = first.map(|pixel| (pixel, expected.bytes[pixel], found[pixel]));
            assert_eq!(first, None, "{}, image {index} of {size:?}: {quads:?}", settings.name());
        }
        println!("{}: {pixels} pixels, {listed} images listed or empty", settings.name());
        assert!(pixels > 500_000, "only {pixels} pixels were drawn");
    }
    drop((workspace, scene, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn one_pose_is_drawn_as_the_reference_draws_it() {
    let Some((device, log)) = device("one_pose_is_drawn_as_the_reference_draws_it", DeviceSettings::default()) else {
        return;
    };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let reference = Reference::new(&body, &cameras);
    let poses = poses(&body, 9);
    for packing in [Packing::Max, Packing::Depth] {
        let settings = GraphicsSettings { packing, ..GraphicsSettings::default() };
        let mut graphics = Graphics::on(&device, &body, &cameras, settings).unwrap();
        for pose in poses.chunks_exact(body.dof_count()) {
            for view in 0..cameras.len() {
                assert!(
                    graphics.drawn(pose, view).unwrap().unwrap() == reference.draw(pose, view),
                    "{packing:?}, view {view}"
                );
            }
        }
        let error = graphics.drawn(&poses[..body.dof_count()], 2).unwrap_err().to_string();
        assert_eq!(error, "there are 2 views, and view 2 was asked for");
        assert!(graphics.drawn(&poses[..3], 0).is_err());
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn comparisons_of_any_bytes_agree_and_a_changed_pixel_is_caught() {
    for lower in [|_: &mut Capabilities| {}, |capabilities: &mut Capabilities| capabilities.subgroup_shuffle = false] {
        let name = "comparisons_of_any_bytes_agree_and_a_changed_pixel_is_caught";
        let Some((device, log)) = device(name, lowered(lower)) else { return };
        let body = Body::adult(1750.0).unwrap();
        let candidates = 11_u32;
        let poses = vec![0.0; candidates as usize * body.dof_count()];
        let (_, mut scene, workspace, share) = set_up_with(&device, &body, &odd_cameras(), &poses);
        let mut random = Random(12);
        let views = scene.sizes.len();
        let seen = observations(&mut random, &scene);
        scene.observe(&seen).unwrap();
        // Regions of the pictures, some of them empty.
        let bounds: Vec<layout::Bounds> = (0..candidates as usize * views)
            .map(|index| {
                let [width, height] = scene.sizes[index % views].map(|side| side as i32);
                let low = [random.below(width), random.below(height)];
                let empty = random.below(9) == 0;
                let side = |axis: usize, most: i32, random: &mut Random| low[axis] + 1 + random.below(most - low[axis]);
                let high = [side(0, width, &mut random), side(1, height, &mut random)];
                layout::Bounds { low, high: if empty { [0, 0] } else { high } }
            })
            .collect();
        let staging = device.buffer::<layout::Bounds>("bounds staging", bounds.len(), Memory::Upload).unwrap();
        staging.write(0, &bounds).unwrap();
        let framebuffer = Framebuffer::new(&device, pictures(&scene.sizes, candidates), Packing::Max, false).unwrap();
        let copy = FramebufferCopy::new(&device, &framebuffer).unwrap();
        let mut recorder = device.recorder(Timing::Off).unwrap();
        scene.record_upload(&mut recorder).unwrap();
        recorder.copy("bounds", (&staging, 0), (&workspace.bounds, 0), staging.size()).unwrap();
        recorder.fill("no quads", &workspace.quads, 0).unwrap();
        place(&mut recorder, (&scene, &workspace), &framebuffer, scene.counts.parts, share).unwrap();
        copy.record(&mut recorder, &framebuffer).unwrap();
        recorder.finish().unwrap().run().unwrap();

        // Any bytes inside of the regions, nothing elsewhere, as drawing leaves it.
        let [width, height] = framebuffer.layout.size;
        let mut texels = vec![0_u32; width as usize * height as usize];
        let placements: Vec<layout::Placement> = fetch(&device, &framebuffer.placements, bounds.len());
        let mut drawn = Vec::new();
        for (index, placement) in placements.iter().enumerate() {
            let channel = index / views % 4;
            for y in placement.low >> 16..placement.high >> 16 {
                for x in placement.low & 0xffff..placement.high & 0xffff {
                    let place = (y * width + x) as usize;
                    texels[place] |= (random.below(256) as u32 & random.below(256) as u32) << (8 * channel);
                    drawn.push((place, 8 * channel));
                }
            }
        }
        assert!(drawn.len() > 10_000, "only {} pixels", drawn.len());
        let staging = device.buffer::<u32>("texels staging", texels.len(), Memory::Upload).unwrap();
        for packing in [Packing::Max, Packing::Depth] {
            let edge_bit = packing.edge_bit();
            for gathering in [Gathering::Texels, Gathering::Subgroup, Gathering::Shared] {
                if !gathering.works_on(device.capabilities()) {
                    continue;
                }
                let groups = [(1, COMPARE_GROUP), (3, COMPARE_GROUP), (1, 64), (2, MOST_COMPARE_GROUP)];
                for (bands, group) in groups.into_iter().filter(|it| it.1 <= device.capabilities().max_workgroup) {
                    let comparing = Comparing { packing, gathering, bands, group };
                    let sums = |texels: &[u32]| {
                        staging.write(0, texels).unwrap();
                        let mut recorder = device.recorder(Timing::Off).unwrap();
                        place(&mut recorder, (&scene, &workspace), &framebuffer, scene.counts.parts, share).unwrap();
                        recorder
                            .write_image("texels", &framebuffer.colour, [0, 0, width, height], (&staging, 0))
                            .unwrap();
                        comparing.record(&mut recorder, (&scene, &workspace), &framebuffer, None, share).unwrap();
                        copy.record(&mut recorder, &framebuffer).unwrap();
                        recorder.finish().unwrap().run().unwrap();
                        let expected: Vec<layout::Sums> = copy
                            .read(&framebuffer, candidates)
                            .unwrap()
                            .compare(&seen, edge_bit, HostComparison::Scalar)
                            .into_iter()
                            .map(|sums| sums.unwrap_or(bytemuck::Zeroable::zeroed()))
                            .collect();
                        let found: Vec<layout::Sums> = fetch(&device, &workspace.sums, bounds.len());
                        (expected, found)
                    };
                    let (expected, found) = sums(&texels);
                    assert_eq!(found, expected, "{gathering:?}, {bands} bands of {group}, edge bit {edge_bit}");
                    let (place, shift) = drawn[random.below(drawn.len() as i32) as usize];
                    let mut changed = texels.clone();
                    changed[place] ^= 1 << (shift as u32 + edge_bit);
                    assert_ne!(sums(&changed).1, expected, "a changed pixel was not seen");
                }
            }
        }
        drop((workspace, scene, framebuffer, copy, staging, device));
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

#[test]
fn transform_feedback_gives_the_same_quads() {
    let name = "transform_feedback_gives_the_same_quads";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    if !device.capabilities().transform_feedback {
        println!("SKIPPED {name}: this device has no transform feedback");
        return;
    }
    let body = Body::adult(1750.0).unwrap();
    let (_, scene, workspace, share) = set_up(&device, &body, &poses(&body, 300));
    let images = share.candidates as usize * scene.sizes.len();
    let captured = feedback_room(&device, scene.counts, share.candidates).unwrap();
    let results = [false, true].map(|by_feedback| {
        let mut recorder = device.recorder(Timing::Off).unwrap();
        recorder.fill("clear", &workspace.quads, 0xdead_beef).unwrap();
        recorder.fill("clear", &workspace.bounds, 0xdead_beef).unwrap();
        passes::pose(&mut recorder, &scene, &workspace, share).unwrap();
        if by_feedback {
            project_by_feedback(&mut recorder, (&scene, &workspace), &captured, share).unwrap();
        } else {
            passes::project(&mut recorder, &scene, &workspace, share).unwrap();
        }
        recorder.finish().unwrap().run().unwrap();
        let quads: Vec<layout::Quad> = fetch(&device, &workspace.quads, images * body.parts.len());
        (quads, fetch::<layout::Bounds>(&device, &workspace.bounds, images))
    });
    assert!(results[0] == results[1]);
    drop((captured, workspace, scene, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn the_device_s_own_rasteriser_stays_near_the_reference() {
    let name = "the_device_s_own_rasteriser_stays_near_the_reference";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let poses = poses(&body, 500);
    let seen = noise(&cameras);
    let expected = reference(&body, &cameras, &seen, &poses);
    let mut first: Option<Vec<Components>> = None;
    let covered = GraphicsSettings { coverage: Coverage::Hardware, ..GraphicsSettings::default() };
    let depth = GraphicsSettings { packing: Packing::Depth, ..covered };
    let by_points = |settings| GraphicsSettings { primitives: Primitives::Geometry, ..settings };
    for settings in [covered, depth, by_points(covered), by_points(depth)] {
        let mut graphics = Graphics::on(&device, &body, &cameras, settings).unwrap();
        if graphics.settings() != settings {
            println!("SKIPPED {}: this device cannot", settings.name());
            continue;
        }
        graphics.observe(&seen).unwrap();
        let mut found = vec![Components::default(); expected.len()];
        graphics.components(&poses, &mut found).unwrap();
        // Of all images together, and of the worst: pixels off in area, overlap, edges.
        let mut all = [0_u64; 6];
        let mut worst = [0.0_f64; 3];
        for (expected, found) in expected.iter().zip(&found) {
            let pairs = [
                (expected.area_model, found.area_model),
                (expected.overlap, found.overlap),
                (expected.edges, found.edges),
            ];
            for (axis, (expected, found)) in pairs.into_iter().enumerate() {
                all[axis] += u64::from(expected.abs_diff(found));
                all[3 + axis] += u64::from(expected);
                // Of the few pixels of a far image one is a large share.
                if expected >= 200 {
                    worst[axis] = worst[axis].max(f64::from(expected.abs_diff(found)) / f64::from(expected));
                }
            }
        }
        let mean = [0, 1, 2].map(|axis| all[axis] as f64 / all[3 + axis] as f64);
        let name = settings.name();
        println!("{name}: area, overlap, edges off by {mean:.5?} in the mean, {worst:.5?} at worst");
        // Lines of the width of a pixel cover more pixels than there are steps along them: these people are 60 pixels tall.
        // Measured: 0.0115, 0.0125 and 0.083 of these 500 poses, which do not vary from run to run; a tenth is left for other
        // rasterisers' choices at pixels' borders.
        assert!(mean[0] < 0.0127 && mean[1] < 0.0138 && mean[2] < 0.0915, "{mean:?}");
        // Both packings draw the same pixels, whatever makes the primitives.
        match &first {
            None => first = Some(found),
            Some(first) => assert!(*first == found, "{name}"),
        }
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn a_search_can_record_it_into_its_own_submission() {
    let name = "a_search_can_record_it_into_its_own_submission";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let poses = poses(&body, 60);
    let seen = noise(&cameras);
    let objective = Objective::default();
    let mut graphics = Graphics::on(&device, &body, &cameras, GraphicsSettings::default()).unwrap();
    graphics.observe(&seen).unwrap();
    graphics.reserve(60).unwrap();
    let found = recorded_fitness(&graphics, &objective, &poses, 60);
    let expected = reference(&body, &cameras, &seen, &poses);
    for (row, found) in expected.chunks_exact(cameras.len()).zip(found) {
        assert!((objective.fitness(row) - found).abs() < 1e-5);
    }
    let mut recorder = device.recorder(Timing::Off).unwrap();
    let error = graphics.record(&mut recorder, &objective, 61).unwrap_err().to_string();
    assert_eq!(error, "there is room for 60 candidates, and 61 were asked for");
    drop((recorder, graphics, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}
