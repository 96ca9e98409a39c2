//! Observations that a device made and holds are compared with as those that the host brings, and change places with them.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use image::{Rgb, RgbImage};

use super::backend::DeviceBackend;
use super::graphics::{Graphics, GraphicsSettings};
use super::rasteriser::Rasteriser;
use super::tests::{cameras, device, fetch, poses};
use super::{Comparison, Compute, HostComparison};
use crate::body::Body;
use crate::evaluate::{Components, Evaluator, Objective};
use crate::features::{Extractor, FeatureSettings, HeldFrame, Observation, ViewSource};
use crate::gpu::{Device, DeviceSettings};

/// A person of sorts before an empty room, somewhere else in each frame.
fn pictures(frame: u32) -> Vec<RgbImage> {
    let of_camera = |[width, height]: [u32; 2]| {
        let inside = |x: u32, y: u32| {
            (width / 3 + 7 * frame..width / 2 + 9 * frame).contains(&x) && (height / 5..height - 9).contains(&y)
        };
        let colour = |x, y| if inside(x, y) { Rgb([220, (40 + x % 90) as u8, 90]) } else { Rgb([60, 70, 80]) };
        RgbImage::from_fn(width, height, colour)
    };
    cameras().iter().map(|camera| of_camera(camera.size)).collect()
}

/// One that makes observations on the host, and one that leaves them on the device.
fn extractors(device: &Device) -> [Extractor; 2] {
    let source = |[width, height]: [u32; 2]| ViewSource {
        width,
        height,
        plate: Some(RgbImage::from_pixel(width, height, Rgb([60, 70, 80]))),
    };
    let made = || {
        let sources = cameras().iter().map(|camera| source(camera.size)).collect();
        Extractor::new(FeatureSettings::default(), sources).unwrap()
    };
    let mut held = made();
    held.hold_on(device).unwrap();
    [made(), held]
}

fn frame(extractors: &mut [Extractor; 2], number: u32) -> (Vec<Observation>, HeldFrame) {
    let [host, held] = extractors;
    let (pictures, masks) = (pictures(number), [None, None]);
    let found = host.extract(&pictures, &masks).unwrap();
    held.begin(&pictures, &masks, &[None, None]).unwrap();
    (found.into_iter().map(|view| view.observation).collect(), held.finish().unwrap())
}

fn compared(evaluator: &mut dyn Evaluator, poses: &[f32]) -> (Vec<Components>, Vec<f32>) {
    let count = poses.len() / evaluator.dof_count();
    let mut components = vec![Components::default(); count * evaluator.view_count()];
    evaluator.components(poses, &mut components).unwrap();
    let mut fitness = vec![0.0; count];
    evaluator.fitness(poses, &Objective::default(), &mut fitness).unwrap();
    (components, fitness)
}

fn is_handed_what_it_would_be_given<R: Rasteriser>(mut evaluator: DeviceBackend<R>, device: &Device) {
    let body = Body::adult(1750.0).unwrap();
    let poses = poses(&body, 30);
    let mut extractors = extractors(device);
    let mut before = None;
    for number in 0..5 {
        let (observations, held) = frame(&mut extractors, number);
        assert!(observations.iter().all(|view| view.area() > 100));
        evaluator.observe(&observations).unwrap();
        let expected = compared(&mut evaluator, &poses);
        let scene = &evaluator.resources.scene;
        let words = |buffer: &crate::gpu::Buffer| fetch::<u32>(device, buffer, (buffer.size() / 4) as usize);
        let given = [words(&scene.planes.buffer), words(&scene.pixels.buffer)];
        // The others are there when the next ones are handed over, so that these are no leftovers.
        let (_, other) = frame(&mut extractors, number + 7);
        evaluator.observe_held(&other).unwrap();
        let of_other = compared(&mut evaluator, &poses);
        assert_ne!(of_other, expected, "another frame shows");
        evaluator.observe_held(&held).unwrap();
        assert_eq!(compared(&mut evaluator, &poses), expected, "frame {number}");
        let scene = &evaluator.resources.scene;
        assert!([words(&scene.planes.buffer), words(&scene.pixels.buffer)] == given, "frame {number}");
        assert_ne!(before.replace(expected.clone()), Some(expected));
    }
}

#[test]
fn what_is_held_is_what_is_given() {
    let Some((device, log)) = device("what_is_held_is_what_is_given", DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    is_handed_what_it_would_be_given(Compute::on(&device, &body, &cameras).unwrap(), &device);
    let graphics = Graphics::on(&device, &body, &cameras, GraphicsSettings::default()).unwrap();
    is_handed_what_it_would_be_given(graphics, &device);
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn who_cannot_take_what_is_held_says_so() {
    let Some((device, _)) = device("who_cannot_take_what_is_held", DeviceSettings::default()) else { return };
    let (body, mut cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let (_, held) = frame(&mut extractors(&device), 1);
    let comparison = Comparison::Host(HostComparison::Simd);
    let settings = GraphicsSettings { comparison, ..GraphicsSettings::default() };
    let mut on_host = Graphics::on(&device, &body, &cameras, settings).unwrap();
    assert!(on_host.holder().is_none());
    let error = on_host.observe_held(&held).unwrap_err().to_string();
    assert!(error.contains("the backend graphics compares on the host"), "{error}");
    let mut reference = crate::evaluate::Reference::new(&body, &cameras);
    let error = reference.observe_held(&held).unwrap_err().to_string();
    assert!(error.contains("the backend reference takes observations from the host"), "{error}");
    cameras.truncate(1);
    let mut fewer = Compute::on(&device, &body, &cameras).unwrap();
    let error = fewer.observe_held(&held).unwrap_err().to_string();
    assert_eq!(error, "a device made observations of 2 views, and there are 1 cameras");
}
