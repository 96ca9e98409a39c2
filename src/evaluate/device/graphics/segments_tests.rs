//! Segments compared in a framebuffer: the stage alone against the host, the backend against the reference; and the comparison
//! that says so caught lying.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use std::sync::Arc;

use super::Graphics;
use super::compare::Comparing;
use super::drawn::Drawn;
use super::framebuffer::Framebuffer;
use super::mesh_tests;
use super::mesh_tests::Tolerance;
use super::passes::place;
use super::readback::FramebufferCopy;
use super::segments::GraphicsSegments;
use super::settings::{Comparison, Gathering, GraphicsSettings, HostComparison, Packing, Tiling};
use super::tests::{exact_settings, lowered, pictures};
use crate::body::{Body, Mesh};
use crate::evaluate::cpu::Cpu;
use crate::evaluate::device::host_buffers::HostCounts;
use crate::evaluate::device::raster_tests::{Random, body_of, observations, odd_cameras};
use crate::evaluate::device::segments::DeviceSegments;
use crate::evaluate::device::tests::{cameras, device, fetch, poses, recorded_fitness, set_up_with};
use crate::evaluate::device_evaluator::DeviceEvaluator;
use crate::evaluate::shaders::layout;
use crate::evaluate::{Components, EdgeTerm, Evaluator, Objective, ObjectiveKind, Reference, SegmentSums};
use crate::features::{Observation, Segment, Segmentation, Segments};
use crate::gpu::{DeviceSettings, Memory, Timing};

/// Labels 2 and on dealt out to a number of segments of different weights.
fn segments(labels: u8, count: usize) -> Arc<Segments> {
    let total = (count * (count + 1) / 2) as f32;
    let segment = |at: usize| Segment {
        name: format!("segment {at}"),
        labels: (2..=labels).filter(|label| usize::from(*label) % count == at).collect(),
        weight: (at + 1) as f32 / total,
    };
    Arc::new(Segments::new((0..count).map(segment).collect()).unwrap())
}

/// An observation whose silhouette is of any segments.
fn numbered(observation: Observation, segments: &Arc<Segments>, random: &mut Random) -> Observation {
    let most = segments.as_slice().len() as i32 + 1;
    let number = |byte: &u8| if byte & Observation::SILHOUETTE == 0 { 0 } else { random.below(most) as u8 };
    let numbers = observation.bytes.iter().map(number).collect();
    let (width, height) = (observation.width, observation.height);
    let segmentation = Segmentation::new(Arc::clone(segments), width, height, numbers).unwrap();
    observation.with_segmentation(segmentation).unwrap()
}

#[test]
fn segments_of_any_bytes_agree_and_a_changed_pixel_is_caught() {
    let name = "segments_of_any_bytes_agree_and_a_changed_pixel_is_caught";
    // Codes and numbers of few and of more bits.
    for (parts, count) in [(16, 3), (31, 8), (40, 5)] {
        let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
        let body = body_of(parts);
        let candidates = 11_u32;
        let poses = vec![0.0; candidates as usize * body.dof_count()];
        let (_, mut model, workspace, share) = set_up_with(&device, &body, &odd_cameras(), &poses);
        let mut random = Random(13);
        let segments = segments(parts as u8, count);
        let seen: Vec<Observation> =
            observations(&mut random, &model).into_iter().map(|o| numbered(o, &segments, &mut random)).collect();
        model.observe(&seen).unwrap();
        let images = candidates as usize * model.sizes.len();
        let bounds: Vec<layout::Bounds> = (0..images)
            .map(|image| {
                let [width, height] = model.sizes[image % model.sizes.len()].map(|side| side as i32);
                let low = [random.below(width), random.below(height)];
                layout::Bounds { low, high: [width - random.below(width - low[0]), height] }
            })
            .collect();
        // Labels in any order; nothing else of a part is compared.
        let quads: Vec<layout::Quad> = (0..images * parts)
            .map(|_| layout::Quad { label: random.below(parts as i32) as u32 + 1, ..bytemuck::Zeroable::zeroed() })
            .collect();
        let bounds_in = device.buffer::<layout::Bounds>("bounds staging", images, Memory::Upload).unwrap();
        bounds_in.write(0, &bounds).unwrap();
        let quads_in = device.buffer::<layout::Quad>("quads staging", quads.len(), Memory::Upload).unwrap();
        quads_in.write(0, &quads).unwrap();
        for packing in [Packing::Max, Packing::Depth] {
            let tiles = pictures(&model.sizes, candidates);
            let scene = (&model, &workspace);
            let framebuffer = Framebuffer::new(&device, tiles, packing, false).unwrap();
            let [width, height] = framebuffer.layout.size;
            let copy = FramebufferCopy::new(&device, &framebuffer).unwrap();
            let settings = GraphicsSettings { packing, ..GraphicsSettings::default() };
            let drawn = Drawn::flat(&model, &settings).unwrap();
            let mut recorder = device.recorder(Timing::Off).unwrap();
            model.record_upload(&mut recorder).unwrap();
            recorder.copy("bounds", (&bounds_in, 0), (&workspace.bounds, 0), bounds_in.size()).unwrap();
            recorder.copy("quads", (&quads_in, 0), (&workspace.quads, 0), quads_in.size()).unwrap();
            place(&mut recorder, scene, &framebuffer, model.counts.parts, share).unwrap();
            recorder.finish().unwrap().run().unwrap();
            // Any parts and edges inside of the regions, nothing elsewhere, as drawing leaves it.
            let placements: Vec<layout::Placement> = fetch(&device, &framebuffer.placements, images);
            let mut texels = vec![0_u32; width as usize * height as usize];
            let mut last = 0;
            for (image, placement) in placements.iter().enumerate() {
                let shift = 8 * (image / model.sizes.len() % 4);
                for y in placement.low >> 16..placement.high >> 16 {
                    for x in placement.low & 0xffff..placement.high & 0xffff {
                        let code = (random.below(parts as i32 + 1) * random.below(2)) as u32;
                        let edge = if code == 0 { 0 } else { random.below(2) as u32 };
                        let byte = if packing == Packing::Max { code << 1 | edge } else { code | edge << 7 };
                        let at = (y * width + x) as usize;
                        texels[at] |= byte << shift;
                        if byte != 0 {
                            last = at;
                        }
                    }
                }
            }
            let staging = device.buffer::<u32>("texels staging", texels.len(), Memory::Upload).unwrap();
            for gathering in [Gathering::Texels, Gathering::Subgroup, Gathering::Shared] {
                for bands in [1, 3] {
                    let comparing = Comparing { packing, gathering, bands, group: if bands == 1 { 64 } else { 128 } };
                    let mut compared = GraphicsSegments::new(scene, &drawn, &segments, (comparing, true)).unwrap();
                    let mut scored = DeviceSegments::new(&model, &segments, candidates).unwrap();
                    scored.observe(&model, &seen).unwrap();
                    compared.observe(&model, &seen).unwrap();
                    let sums = |texels: &[u32]| {
                        staging.write(0, texels).unwrap();
                        let mut recorder = device.recorder(Timing::Off).unwrap();
                        scored.record_upload(&mut recorder).unwrap();
                        compared.record_upload(&mut recorder).unwrap();
                        place(&mut recorder, scene, &framebuffer, model.counts.parts, share).unwrap();
                        let area = [0, 0, width, height];
                        recorder.write_image("texels", &framebuffer.colour, area, (&staging, 0)).unwrap();
                        recorder.fill("clear segments", &scored.sums, 0).unwrap();
                        let observed = Some(compared.observed(&scored, true));
                        comparing.record(&mut recorder, scene, &framebuffer, observed, share).unwrap();
                        compared.orders.record(&mut recorder, scene, share).unwrap();
                        scored.record_readback(&mut recorder).unwrap();
                        copy.record(&mut recorder, &framebuffer).unwrap();
                        recorder.finish().unwrap().run().unwrap();
                        let drawn = copy.read(&framebuffer, candidates).unwrap();
                        let whole: Vec<layout::Sums> = drawn
                            .compare(&seen, packing.edge_bit(), HostComparison::Scalar)
                            .into_iter()
                            .map(|sums| sums.unwrap_or(bytemuck::Zeroable::zeroed()))
                            .collect();
                        let expected = [HostComparison::Scalar, HostComparison::Simd]
                            .map(|how| compared.count((&segments, true), parts, &drawn, &seen, how).unwrap());
                        assert_eq!(expected[0], expected[1]);
                        let mut found = vec![SegmentSums::default(); images * count];
                        scored.read(&HostCounts::default(), &mut found).unwrap();
                        found.iter_mut().for_each(|sums| sums.area_obs = 0);
                        let [expected, _] = expected;
                        let whole_found: Vec<layout::Sums> = fetch(&device, &workspace.sums, images);
                        assert_eq!(whole_found, whole);
                        (expected, found)
                    };
                    let (expected, found) = sums(&texels);
                    let what = format!("{parts} parts, {packing:?}, {gathering:?}, {bands} bands");
                    assert_eq!(found, expected, "{what}");
                    let met = expected.iter().filter(|sums| sums.overlap > 0).count();
                    assert!(met * 3 > expected.len(), "{what}: only {met} of {} are met", expected.len());
                    // Nothing is drawn there.
                    let mut changed = texels.clone();
                    changed[last] = 0;
                    assert_ne!(sums(&changed).1, expected, "{what}: a changed pixel was not seen");
                }
            }
        }
        drop((workspace, model, place, bounds_in, quads_in, device));
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

/// Noise with a silhouette, in which every other pixel has the segment of a drawn candidate and the others any.
fn noise(body: &Body, segments: &Arc<Segments>) -> Vec<Observation> {
    let cameras = cameras();
    let reference = Reference::new(body, &cameras);
    let pose = poses(body, 1);
    let mut random = Random(17);
    let view = |(view, camera): (usize, &crate::geometry::Camera)| {
        let drawn = reference.draw(&pose, view);
        let mut observation = Observation::empty(camera.size[0], camera.size[1]);
        for (byte, drawn) in observation.bytes.iter_mut().zip(&drawn.bytes) {
            *byte = random.below(256) as u8 | u8::from(*drawn != 0) << 7;
        }
        let mut observation = numbered(observation, segments, &mut random);
        let mut numbers = observation.segmentation.take().unwrap().numbers().to_vec();
        for (number, drawn) in numbers.iter_mut().zip(&drawn.bytes).filter(|(_, drawn)| **drawn != 0) {
            if random.below(2) == 0 {
                *number = segments.number(drawn & 0x7f);
            }
        }
        let [width, height] = camera.size;
        let segmentation = Segmentation::new(Arc::clone(segments), width, height, numbers).unwrap();
        observation.with_segmentation(segmentation).unwrap()
    };
    cameras.iter().enumerate().map(view).collect()
}

struct Found {
    components: Vec<Components>,
    sums: Vec<SegmentSums>,
    /// By [`AOSP`], then by [`WHOLE_EDGES`].
    fitness: Vec<f32>,
}

/// By segments in both terms, and in the silhouette's alone.
const AOSP: Objective = Objective { kind: ObjectiveKind::Aosp, beta: 0.4, w1: 0.7, w2: 0.3, edges: EdgeTerm::Segments };
const WHOLE_EDGES: Objective = Objective { edges: EdgeTerm::Whole, ..AOSP };

fn found(evaluator: &mut dyn Evaluator, poses: &[f32]) -> Found {
    let count = poses.len() / evaluator.dof_count();
    let images = count * evaluator.view_count();
    let segments = evaluator.segments().unwrap().as_slice().len();
    let mut found = Found {
        components: vec![Components::default(); images],
        sums: vec![SegmentSums::default(); images * segments],
        fitness: vec![-1.0; 2 * count],
    };
    evaluator.components(poses, &mut found.components).unwrap();
    evaluator.segment_sums(poses, &mut found.sums).unwrap();
    let (by_segments, whole) = found.fitness.split_at_mut(count);
    evaluator.fitness(poses, &AOSP, by_segments).unwrap();
    evaluator.fitness(poses, &WHOLE_EDGES, whole).unwrap();
    found
}

fn same(found: &Found, expected: &Found, what: &str) {
    let first = expected.sums.iter().zip(&found.sums).position(|(expected, found)| expected != found);
    let first = first.map(|at| (at, expected.sums[at], found.sums[at]));
    assert_eq!(first, None, "{what}");
    assert!(found.components == expected.components, "{what}: components");
    for (found, expected) in found.fitness.iter().zip(&expected.fitness) {
        // Powers are rounded as the device rounds them.
        assert!((found - expected).abs() < 1e-5, "{what}: {found} is not {expected}");
    }
}

/// What `settings` count on a device, which must be the reference's, with the tiles guessed, fitted and far too small.
fn check_backend(name: &str, settings: DeviceSettings, all: &[GraphicsSettings], (body, count): (&Body, usize)) {
    let Some((device, log)) = device(name, settings) else { return };
    let cameras = cameras();
    let poses = poses(body, count);
    let segments = segments(body.parts.len() as u8, 3);
    let seen = noise(body, &segments);
    let mut reference = Reference::new(body, &cameras);
    reference.observe(&seen).unwrap();
    let expected = found(&mut reference, &poses);
    let met = expected.sums.iter().filter(|sums| sums.overlap > 0).count();
    assert!(met * 3 > expected.sums.len(), "only {met} of {} segments are met", expected.sums.len());
    for &settings in all {
        let mut graphics = Graphics::on(&device, body, &cameras, settings).unwrap();
        graphics.observe(&seen).unwrap();
        for round in ["guessed", "fitted"] {
            let what = format!("{} with {round} tiles: {:?}", settings.name(), graphics.tiles());
            same(&found(&mut graphics, &poses), &expected, &what);
        }
        if settings.tiling == Tiling::Regions {
            // Nobody fits, so that all is scored without a framebuffer: at first, before tiles grow.
            graphics.set_tiles(vec![[8, 8]; cameras.len()]).unwrap();
            let mut sums = expected.sums.clone();
            sums.fill(SegmentSums::default());
            graphics.segment_sums(&poses, &mut sums).unwrap();
            assert!(sums == expected.sums, "{} with tiny tiles", settings.name());
        }
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn every_variant_gives_the_reference_s_segments() {
    let name = "every_variant_gives_the_reference_s_segments";
    let body = Body::adult(1750.0).unwrap();
    check_backend(name, DeviceSettings::default(), &exact_settings(), (&body, 151));
    // More parts than a word has bits.
    let long = body_of(40);
    let [max, depth] = [Packing::Max, Packing::Depth].map(|packing| GraphicsSettings { packing, ..Default::default() });
    check_backend(name, DeviceSettings::default(), &[max, depth], (&long, 60));
}

#[test]
fn segments_work_in_batches_on_small_devices() {
    let settings = lowered(|capabilities| {
        capabilities.max_image = 300;
        capabilities.max_storage = 1 << 18;
        capabilities.memory = 3 << 20;
        capabilities.subgroup_shuffle = false;
        capabilities.subgroup_arithmetic = false;
        capabilities.transform_feedback = false;
    });
    let body = Body::adult(1750.0).unwrap();
    check_backend("segments_work_in_batches_on_small_devices", settings, &exact_settings(), (&body, 101));
}

#[test]
fn segments_come_and_go_and_a_changed_one_is_caught() {
    let name = "segments_come_and_go_and_a_changed_one_is_caught";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let poses = poses(&body, 30);
    let segments = segments(16, 3);
    let seen = noise(&body, &segments);
    let whole: Vec<Observation> = seen.iter().map(|o| Observation { segmentation: None, ..o.clone() }).collect();
    let mut reference = Reference::new(&body, &cameras);
    reference.observe(&seen).unwrap();
    let expected = found(&mut reference, &poses);
    for comparison in [Comparison::Device(Gathering::Texels), Comparison::Host(HostComparison::Simd)] {
        let settings = GraphicsSettings { comparison, ..GraphicsSettings::default() };
        let mut graphics = Graphics::on(&device, &body, &cameras, settings).unwrap();
        for _ in 0..2 {
            graphics.observe(&whole).unwrap();
            assert!(graphics.segments().is_none());
            let mut components = vec![Components::default(); expected.components.len()];
            graphics.components(&poses, &mut components).unwrap();
            assert!(components == expected.components);
            let mut fitness = vec![0.0; 30];
            Evaluator::fitness(&mut graphics, &poses, &AOSP, &mut fitness).unwrap();
            for (row, fitness) in components.chunks_exact(2).zip(&fitness) {
                assert!((AOSP.fitness(row) - fitness).abs() < 1e-5);
            }
            let error = graphics.segment_sums(&poses, &mut []).unwrap_err().to_string();
            assert_eq!(error, "the observations do not tell body parts apart: there are no sums of segments");
            graphics.observe(&seen).unwrap();
            same(&found(&mut graphics, &poses), &expected, settings.name());
        }
        // One observed pixel of another segment, and parts dealt out otherwise.
        let candidate = reference.draw(&poses[..body.dof_count()], 0);
        let mut numbers = seen[0].segmentation.as_ref().unwrap().numbers().to_vec();
        let is_met = |at: &usize| numbers[*at] == 1 && segments.number(candidate.bytes[*at] & 0x7f) == 1;
        let at = (0..numbers.len()).find(is_met).unwrap();
        numbers[at] = 2;
        let mut sabotaged = seen.clone();
        let [width, height] = cameras[0].size;
        sabotaged[0].segmentation = Some(Segmentation::new(Arc::clone(&segments), width, height, numbers).unwrap());
        graphics.observe(&sabotaged).unwrap();
        let (was, is) = (expected.sums[0], found(&mut graphics, &poses).sums[0]);
        assert_eq!((was.area_obs - 1, was.overlap - 1, was.area_model), (is.area_obs, is.overlap, is.area_model));
        let turned = Arc::new(Segments::new(segments.as_slice().iter().rev().cloned().collect()).unwrap());
        for observation in &mut sabotaged {
            let numbers = observation.segmentation.take().unwrap().numbers().to_vec();
            let (width, height) = (observation.width, observation.height);
            observation.segmentation = Some(Segmentation::new(Arc::clone(&turned), width, height, numbers).unwrap());
        }
        graphics.observe(&sabotaged).unwrap();
        assert!(found(&mut graphics, &poses).sums != expected.sums, "other labels passed");
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn a_search_can_record_segments_into_its_own_submission() {
    let name = "a_search_can_record_segments_into_its_own_submission";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let poses = poses(&body, 60);
    let seen = noise(&body, &segments(16, 3));
    let mut reference = Reference::new(&body, &cameras);
    reference.observe(&seen).unwrap();
    let expected = found(&mut reference, &poses);
    let mut graphics = Graphics::on(&device, &body, &cameras, GraphicsSettings::default()).unwrap();
    // Recorded for whole silhouettes at first, which segments outdate.
    graphics.reserve(60).unwrap();
    graphics.observe(&seen).unwrap();
    assert!(graphics.has_outgrown_its_recording());
    graphics.reserve(60).unwrap();
    for (objective, expected) in [AOSP, WHOLE_EDGES].iter().zip(expected.fitness.chunks_exact(60)) {
        let found = recorded_fitness(&graphics, objective, &poses, 60);
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-5, "{found} is not {expected}");
        }
    }
    drop((graphics, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// The mesh model's labels move where surfaces pass through each other, and its borders where the device's rasteriser rounds
/// otherwise: by less than 0.5 % of an image's pixels.
#[test]
fn segments_of_a_mesh_stay_near_the_reference() {
    let name = "segments_of_a_mesh_stay_near_the_reference";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), mesh_tests::cameras());
    let tolerance = Tolerance::of(&device);
    let segments = segments(16, 3);
    let close: Vec<f32> =
        (0..13_i8).flat_map(|i| mesh_tests::standing(&body, f32::from(i) * 9.0 - 60.0, 25.0)).collect();
    let poses: Vec<f32> = close.into_iter().chain(poses(&body, 12)).collect();
    let mut meshes = vec![("frusta".to_string(), Mesh::of_body(&body).unwrap())];
    meshes.extend(mesh_tests::person(name, &body));
    let mut random = Random(19);
    for (mesh_name, mesh) in meshes {
        let reference = Reference::of_mesh(&body, mesh.clone(), &cameras).unwrap();
        let seen: Vec<Observation> = (0..2)
            .map(|view| {
                let drawn = reference.draw(&mesh_tests::standing(&body, 20.0, 10.0), view);
                // One in ten observed pixels is of any segment.
                let mut number = |label: u8| {
                    let any = random.below(10) == 0;
                    if any { random.below(4) as u8 } else { segments.number(label & 0x7f) }
                };
                let numbers = drawn.bytes.iter().map(|&byte| if byte == 0 { 0 } else { number(byte) }).collect();
                let segmentation =
                    Segmentation::new(Arc::clone(&segments), drawn.width, drawn.height, numbers).unwrap();
                mesh_tests::observed(&drawn).with_segmentation(segmentation).unwrap()
            })
            .collect();
        // The processor has the reference's integers: tests/agreement/meshes.rs holds it to that, segments too.
        let mut processor = Cpu::of_mesh(&body, mesh.clone(), &cameras).unwrap();
        processor.observe(&seen).unwrap();
        let expected = found(&mut processor, &poses);
        for comparison in [
            Comparison::Device(Gathering::Texels),
            Comparison::Device(Gathering::Subgroup),
            Comparison::Device(Gathering::Shared),
            Comparison::Host(HostComparison::Scalar),
            Comparison::Host(HostComparison::Simd),
        ] {
            let settings = GraphicsSettings { comparison, ..GraphicsSettings::default() };
            let mut graphics = Graphics::of_mesh(&device, &body, mesh.clone(), &cameras, settings).unwrap();
            graphics.observe(&seen).unwrap();
            let found = found(&mut graphics, &poses);
            let what = format!("{mesh_name}, {}", graphics.variant());
            let (mut worst, mut most, mut others) = ([0.0_f64; 2], 0, 0);
            for (at, (f, e)) in found.sums.iter().zip(&expected.sums).enumerate() {
                let whole = expected.components[at / segments.as_slice().len()];
                let drawn = whole.area_model;
                assert_eq!(f.area_obs, e.area_obs, "{what}");
                let edges = f.edges.abs_diff(e.edges);
                let is_near = edges <= tolerance.pixels || f64::from(edges) <= 0.03 * f64::from(whole.edges);
                assert!(is_near, "{what}: {f:?} is not {e:?} in edges");
                let pairs = [(f.area_model, e.area_model), (f.overlap, e.overlap)];
                others += u32::from(f != e);
                for (worst, (found, expected)) in worst.iter_mut().zip(pairs) {
                    let off = mesh_tests::off(found, expected);
                    let pixels = found.abs_diff(expected);
                    let is_near = pixels <= tolerance.pixels || f64::from(pixels) <= 0.005 * f64::from(drawn);
                    assert!(is_near, "{what}: {f:?} is not {e:?}");
                    most = most.max(pixels);
                    if expected > 400 {
                        *worst = worst.max(off);
                    }
                }
            }
            let mut fitness = 0.0_f32;
            for (found, expected) in found.fitness.iter().zip(&expected.fitness) {
                fitness = fitness.max((found - expected).abs());
            }
            println!(
                "{what}: {others} of {} sums differ, by {most} pixels at most; area and overlap off by {worst:.5?}, fitness by \
                 {fitness:.1e} at worst",
                found.sums.len()
            );
            assert!(fitness <= tolerance.fitness, "{what}: fitness off by {fitness}");
        }
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}
