//! Every stage alone against the reference, on whatever Vulkan device there is, under the validation layer.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::passes;
use super::scene::{DeviceScene, Share};
use super::workspace::Workspace;
use crate::body::Body;
use crate::evaluate::device_evaluator::DeviceEvaluator;
use crate::evaluate::shaders::layout;
use crate::evaluate::{Objective, Projector};
use crate::geometry::{BrownConrady, Camera, Lens, Tsai};
pub(super) use crate::gpu::test_device::device;
use crate::gpu::{Buffer, Device, DeviceSettings, Memory, Timing};

/// Two small cameras, one of each lens.
pub(super) fn cameras() -> Vec<Camera> {
    let camera = |name: &str, size, eye: DVec3, lens| {
        let forward = (DVec3::new(0.0, 0.0, 900.0) - eye).normalize();
        let right = forward.cross(DVec3::Z).normalize();
        let rotation = DMat3::from_cols(right, forward.cross(right), forward).transpose();
        Camera {
            name: name.into(),
            size,
            camera_from_world: DAffine3::from_mat3_translation(rotation, -(rotation * eye)),
            lens,
        }
    };
    let tsai = Tsai { f: 8.0, kappa: -4e-4, centre: DVec2::new(70.0, 52.0), sx: 1.01, pitch: DVec2::new(0.05, 0.05) };
    let brown = BrownConrady {
        focal: DVec2::splat(150.0),
        centre: DVec2::new(65.0, 48.0),
        radial: [-0.1, 0.05, 0.0],
        tangential: [1e-3, -5e-4],
    };
    vec![
        camera("a", [131, 97], DVec3::new(4000.0, 0.0, 1500.0), Lens::BrownConrady(brown)),
        camera("b", [141, 105], DVec3::new(-3000.0, -2500.0, 2000.0), Lens::Tsai(tsai)),
    ]
}

/// Poses from calm to wild.
pub(super) fn poses(body: &Body, count: usize) -> Vec<f32> {
    let mut state = 7_u64;
    let mut uniform = move |low: f32, high: f32| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((state >> 40) as f32 / (1_u64 << 24) as f32)
    };
    let mut poses = Vec::new();
    for index in 0..count {
        for (_, dof) in body.dofs() {
            let [low, high] = dof.limits.map(|limit| limit as f32);
            poses.push(match (index % 3, dof.axis.is_rotation()) {
                (0 | 1, true) => uniform(low, high),
                (0, false) => uniform(-300.0, 300.0),
                (1, false) => uniform(-3000.0, 3000.0),
                (_, true) => uniform(-7.0, 7.0),
                (_, false) => uniform(-9000.0, 9000.0),
            });
        }
    }
    poses
}

/// What a buffer of the device holds.
pub(super) fn fetch<T: bytemuck::Pod>(device: &Device, buffer: &Buffer, len: usize) -> Vec<T> {
    let bytes = (len * size_of::<T>()) as u64;
    let seen = device.buffer::<T>("seen", len, Memory::Readback).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    recorder.copy("fetch", (buffer, 0), (&seen, 0), bytes).unwrap();
    recorder.finish().unwrap().run().unwrap();
    let mut values = vec![T::zeroed(); len];
    seen.read(0, &mut values).unwrap();
    values
}

/// Fitness of poses by what an evaluator records into a search's submission, three iterations one after another: what one counted does
/// not stay for the next. There must be room for them.
pub(super) fn recorded_fitness(
    evaluator: &dyn DeviceEvaluator,
    objective: &Objective,
    poses: &[f32],
    candidates: u32,
) -> Vec<f32> {
    let device = evaluator.device();
    let staging = device.buffer::<f32>("poses staging", poses.len(), Memory::Upload).unwrap();
    staging.write(0, poses).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    evaluator.record_upload(&mut recorder).unwrap();
    recorder.copy("poses", (&staging, 0), (evaluator.poses(), 0), staging.size()).unwrap();
    for _ in 0..3 {
        evaluator.record(&mut recorder, objective, candidates).unwrap();
    }
    recorder.finish().unwrap().run().unwrap();
    fetch(device, evaluator.fitness(), candidates as usize)
}

/// A scene and a workspace with its poses on the device.
pub(super) fn set_up(device: &Device, body: &Body, poses: &[f32]) -> (Projector, DeviceScene, Workspace, Share) {
    set_up_with(device, body, &cameras(), poses)
}

/// The same with other cameras.
pub(super) fn set_up_with(
    device: &Device,
    body: &Body,
    cameras: &[Camera],
    poses: &[f32],
) -> (Projector, DeviceScene, Workspace, Share) {
    let projector = Projector::new(body, cameras);
    let scene = DeviceScene::new(device, body, cameras).unwrap();
    let candidates = (poses.len() / body.dof_count()) as u32;
    let workspace = Workspace::new(device, scene.counts, candidates).unwrap();
    let staging = device.buffer::<f32>("poses staging", poses.len(), Memory::Upload).unwrap();
    staging.write(0, poses).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    scene.record_upload(&mut recorder).unwrap();
    recorder.copy("poses", (&staging, 0), (&workspace.poses, 0), staging.size()).unwrap();
    recorder.finish().unwrap().run().unwrap();
    (projector, scene, workspace, Share { first: 0, candidates })
}

/// [`set_up`], and the poses projected.
pub(super) fn projected(device: &Device, body: &Body, poses: &[f32]) -> (Projector, DeviceScene, Workspace, Share) {
    let (projector, scene, workspace, share) = set_up(device, body, poses);
    let mut recorder = device.recorder(Timing::Off).unwrap();
    passes::pose(&mut recorder, &scene, &workspace, share).unwrap();
    passes::project(&mut recorder, &scene, &workspace, share).unwrap();
    recorder.finish().unwrap().run().unwrap();
    (projector, scene, workspace, share)
}

#[test]
fn pose_and_project_give_the_reference_s_corners() {
    let Some((device, log)) = device("pose_and_project_give_the_reference_s_corners", DeviceSettings::default()) else {
        return;
    };
    let body = Body::adult(1750.0).unwrap();
    let poses = poses(&body, 300);
    let (projector, scene, workspace, share) = projected(&device, &body, &poses);

    let (views, parts) = (projector.view_count(), body.parts.len());
    let images = share.candidates as usize * views;
    let quads: Vec<layout::Quad> = fetch(&device, &workspace.quads, images * parts);
    let bounds: Vec<layout::Bounds> = fetch(&device, &workspace.bounds, images);
    for image in 0..images {
        let (candidate, view) = (image / views, image % views);
        let expected = projector.quads(&poses[candidate * body.dof_count()..][..body.dof_count()], view);
        let found = &quads[image * parts..][..parts];
        for quad in found {
            let part = quad.part as usize;
            let reference = expected[part];
            assert_eq!(quad.label, u32::from(body.parts[part].label));
            assert_eq!(quad.drawn == 1, reference.drawn, "image {image}, part {part}");
            if !reference.drawn {
                continue;
            }
            for corner in 0..4 {
                let found = [quad.x[corner], quad.y[corner]];
                assert_eq!(found, reference.corners[corner], "image {image}, part {part}, corner {corner}");
            }
        }
        assert!(found.windows(2).all(|pair| pair[0].depth_squared <= pair[1].depth_squared), "order of image {image}");
        let mut seen: Vec<u32> = found.iter().map(|quad| quad.part).collect();
        seen.sort_unstable();
        assert!(seen.iter().enumerate().all(|(place, &part)| part == place as u32));
        let size = scene.sizes[view].map(|side| side as i32);
        let Bounds { low, high } = bounds_of(&expected, size);
        assert_eq!((bounds[image].low, bounds[image].high), (low, high), "image {image}");
    }
    drop((workspace, scene, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// Posed and projected in one pass is one after the other, also from within a run, to the bit; there is none where shared memory is short.
#[test]
fn posing_and_projecting_together_is_one_after_the_other() {
    let little: fn(&mut crate::gpu::Capabilities) = |capabilities| capabilities.shared_memory = 3000;
    for lower in [None, Some(little)] {
        let opened = DeviceSettings { lower, ..DeviceSettings::default() };
        let Some((device, log)) = device("posing_and_projecting_together", opened) else { return };
        let body = Body::adult(1750.0).unwrap();
        let (poses, all) = (poses(&body, 37), cameras());
        for views in 1..=3 {
            let seen: Vec<Camera> = all.iter().cycle().take(views).cloned().collect();
            let (_, scene, workspace, share) = set_up_with(&device, &body, &seen, &poses);
            let words = |buffer: &Buffer| fetch::<u32>(&device, buffer, (buffer.size() / 4) as usize);
            let run = |record: &dyn Fn(&mut crate::gpu::Recorder)| {
                let mut recorder = device.recorder(Timing::Off).unwrap();
                for buffer in [&workspace.world, &workspace.quads, &workspace.bounds] {
                    recorder.fill("clear", buffer, 7).unwrap();
                }
                record(&mut recorder);
                let names = recorder.finish().map(|mut done| done.run().map(|()| done.passes().to_vec()));
                (names.unwrap().unwrap(), words(&workspace.quads), words(&workspace.bounds))
            };
            let (_, quads, bounds) = run(&|recorder| {
                passes::pose(recorder, &scene, &workspace, share).unwrap();
                passes::project(recorder, &scene, &workspace, share).unwrap();
            });
            let room = passes::room_for_bones(&scene);
            assert_eq!(room.is_none(), lower.is_some());
            let posed = |recorder: &mut crate::gpu::Recorder, share| match room {
                Some(room) => passes::pose_project(recorder, (&scene, &workspace), room, share).unwrap(),
                None => passes::pose_and_project(recorder, &scene, &workspace, share).unwrap(),
            };
            let (names, found, extents) = run(&|recorder| posed(recorder, share));
            assert_eq!(names.iter().any(|name| name == "pose_project"), room.is_some(), "{names:?}");
            assert!((&found, &extents) == (&quads, &bounds), "{views} views");
            // Candidates 5 to 15 alone begin the buffers.
            let part = Share { first: 5, candidates: 11 };
            let (_, found, extents) = run(&|recorder| posed(recorder, part));
            let (a_pose, an_extent) = (quads.len() / 37, bounds.len() / 37);
            assert!(found[..11 * a_pose] == quads[5 * a_pose..16 * a_pose], "{views} views, a share");
            assert!(extents[..11 * an_extent] == bounds[5 * an_extent..16 * an_extent], "{views} views, a share");
            assert!(found[11 * a_pose..].iter().all(|word| *word == 7), "and nothing else is written");
        }
        drop(device);
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

pub(super) struct Bounds {
    pub(super) low: [i32; 2],
    pub(super) high: [i32; 2],
}

/// The rounded corners of the drawn parts that meet the picture, clipped to it.
pub(super) fn bounds_of(quads: &[crate::evaluate::PartQuad], size: [i32; 2]) -> Bounds {
    let mut bounds = Bounds { low: size, high: [0, 0] };
    for quad in quads.iter().filter(|quad| quad.drawn) {
        let side = |axis: usize| {
            let places = quad.corners.map(|corner| (corner[axis] + 128) >> 8);
            let low = places.into_iter().min().unwrap().clamp(0, size[axis]);
            (low, (places.into_iter().max().unwrap() + 1).clamp(0, size[axis]))
        };
        let ((left, right), (top, bottom)) = (side(0), side(1));
        if left < right && top < bottom {
            bounds.low = [bounds.low[0].min(left), bounds.low[1].min(top)];
            bounds.high = [bounds.high[0].max(right), bounds.high[1].max(bottom)];
        }
    }
    bounds
}
