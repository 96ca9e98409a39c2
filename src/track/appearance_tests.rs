//! Evidence that a device makes of what it holds, and what frames held there teach, beside the processor's.

use std::sync::Arc;
use std::time::Instant;

use image::{GrayImage, Luma, Rgb, RgbImage};

use super::appearance::RunAppearance;
use super::fit_tests::cameras_around;
use super::glance::{Glances, Seer, are_elsewhere};
use super::prepared::Prepared;
use super::timings::Span;
use crate::body::Body;
use crate::evaluate::device::{Compute, Graphics, GraphicsSettings};
use crate::evaluate::{Components, Evaluator, Objective, ObjectiveKind, Reference};
use crate::features::{BitImage, Evidence, Extractor, FeatureSettings, HeldFrame, ViewSource};
use crate::geometry::Camera;
use crate::gpu::test_device::device;
use crate::gpu::{Device, DeviceSettings};
use crate::observe::{take_likelihoods, take_observations};
use crate::search::SearchSpace;

fn room(size: [u32; 2]) -> RgbImage {
    RgbImage::from_fn(size[0], size[1], |x, y| Rgb([90 + (x % 31) as u8, 120 + (y % 17) as u8, 100]))
}

/// A person whose parts have a few colours, before the room.
fn pictures(reference: &Reference, cameras: &[Camera], pose: &[f32]) -> Vec<RgbImage> {
    let of_view = |(view, camera): (usize, &Camera)| {
        let mut picture = room(camera.size);
        let drawn = reference.draw(pose, view).bytes;
        for ((x, y, pixel), byte) in picture.enumerate_pixels_mut().zip(drawn) {
            let shade = (x * 7 + y * 13) % 9;
            if byte != 0 {
                let label = u32::from(byte & 0x7f);
                *pixel =
                    Rgb([40 + label % 4 * 60, 30 + label % 3 * 90, 200 - label % 5 * 40].map(|v| (v + shade) as u8));
            } else if (x / 8 + y / 8) % 5 == 0 {
                // In shadow here and there.
                *pixel = Rgb(pixel.0.map(|value| (f32::from(value) * 0.8) as u8));
            }
        }
        picture
    };
    cameras.iter().enumerate().map(of_view).collect()
}

fn prepared(index: usize, pictures: Vec<RgbImage>) -> Prepared {
    let span = || Span::since(Instant::now());
    Prepared {
        index,
        pictures,
        observations: Vec::new(),
        held: None,
        likelihoods: Vec::new(),
        features_kept: Vec::new(),
        silent: Vec::new(),
        read: span(),
        features: span(),
        captured: None,
    }
}

/// What is asked of a frame: components, evidence, its best, fitness.
type Told = (Vec<Components>, Vec<i32>, Vec<u32>, Vec<u32>);

fn told(evaluator: &mut dyn Evaluator, poses: &[f32]) -> Told {
    let count = poses.len() / evaluator.dof_count();
    let mut components = vec![Components::default(); count * evaluator.view_count()];
    let (mut sums, mut fitness) = (vec![0; components.len()], vec![0.0; count]);
    // The objective first, so that the device has to know the best before the host does.
    evaluator.fitness(poses, &Objective::of(ObjectiveKind::Evidence), &mut fitness).unwrap();
    evaluator.components(poses, &mut components).unwrap();
    evaluator.evidence_sums(poses, &mut sums).unwrap();
    let best = evaluator.best_evidence().unwrap().to_vec();
    (components, sums, best, fitness.into_iter().map(f32::to_bits).collect())
}

/// The codes of a view's pixels, of so many classes; 0 of what is ignored.
fn codes(prepared: &Prepared, view: usize) -> Vec<u32> {
    let observation = &prepared.observations[view];
    let made = observation.evidence.as_ref().unwrap();
    let all = (0..made.classes().count()).fold(0, |word, class| word | 15 << (Evidence::BITS * class));
    let words = made.words().iter().enumerate();
    words.map(|(at, word)| if observation.ignores(at) { 0 } else { word & all }).collect()
}

/// Compares a run's frames as the processor makes them with those that `evaluator`'s device makes and holds.
fn frames_are_the_processor_s(device: &Device, mut evaluator: Box<dyn Evaluator>, first: usize) {
    let (body, cameras) = (Body::adult(1700.0).unwrap(), cameras_around());
    let reference = Reference::new(&body, &cameras);
    let settings = FeatureSettings { likelihoods: true, ..FeatureSettings::default() };
    let extractor = || {
        let plate = |(at, camera): (usize, &Camera)| ViewSource {
            width: camera.size[0],
            height: camera.size[1],
            plate: (at != 1).then(|| room(camera.size)),
        };
        Extractor::new(settings.clone(), cameras.iter().enumerate().map(plate).collect()).unwrap()
    };
    let (mut host, mut held) = (extractor(), extractor());
    held.hold_on(device).unwrap();
    let [mut by_host, mut by_device] = [(); 2].map(|()| RunAppearance::new(&body, &cameras));
    let mut classes = Vec::new();
    let mut before: Option<Told> = None;
    let glances = Glances::new(&body, &cameras, &SearchSpace::of(&body).unwrap());
    let mut sights = Vec::new();
    for frame in 0..5 {
        let mut pose: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
        pose[0] += 40.0 * frame as f32;
        let pictures = pictures(&reference, &cameras, &pose);
        let is_person = |view: usize| reference.draw(&pose, view).bytes;
        let masks: Vec<Option<GrayImage>> = (0..3)
            .map(|view| {
                let drawn = (view == 1).then(|| is_person(view))?;
                let [width, height] = cameras[view].size;
                let value = |x: u32, y: u32| if drawn[(y * width + x) as usize] != 0 { 255 } else { 0 };
                Some(GrayImage::from_fn(width, height, |x, y| Luma([value(x, y)])))
            })
            .collect();
        let ignored: Vec<Option<Arc<BitImage>>> = (0..3)
            .map(|view| {
                let [width, height] = cameras[view].size;
                let inside = |x: u32, y: u32| (width / 2..width / 2 + 20).contains(&x) && y > height / 2;
                (view == 2 && frame >= first).then(|| Arc::new(BitImage::from_fn(width, height, inside)))
            })
            .collect();
        let mut own = prepared(frame, pictures.clone());
        let mut features = host.extract(&pictures, &masks).unwrap();
        host.ignore(&mut features, &ignored).unwrap();
        own.likelihoods = take_likelihoods(&mut features);
        own.observations = take_observations(&mut features);
        let mut there = prepared(frame, pictures.clone());
        held.begin(&pictures, &masks, &ignored).unwrap();
        there.held = Some(held.finish().unwrap());
        by_host.observe(&mut own).unwrap();
        by_device.observe(&mut there).unwrap();
        classes.push(there.held.as_ref().and_then(HeldFrame::colours).unwrap().classes().count());

        let mut poses = pose.clone();
        poses.extend(pose.iter().map(|value| value + 0.03));
        evaluator.observe_seen(own.seen()).unwrap();
        let expected = told(evaluator.as_mut(), &poses);
        assert!(expected.2.iter().all(|best| *best > 1000), "{:?}", expected.2);
        evaluator.observe_seen(there.seen()).unwrap();
        assert!(evaluator.best_evidence().is_none(), "what is not made yet is not known");
        assert_eq!(told(evaluator.as_mut(), &poses), expected, "frame {frame}");
        let objective = Objective::of(ObjectiveKind::Evidence);
        let (known, asked) = (own.seen().views(), there.seen().views());
        let mut lifted = pose.clone();
        for (name, value) in body.dof_names().iter().zip(&mut lifted) {
            *value += if name.ends_with("shoulder.rx") { 0.3 * (frame + 1) as f32 } else { 0.0 };
        }
        // All limbs at once, and each by itself.
        let together = [&known, &asked].map(|views| {
            let limbs = 0..glances.limbs().len();
            let limbs: Vec<_> = limbs.map(|limb| glances.at(limb, &lifted, views).unwrap()).collect();
            let seer = Seer { evaluator: evaluator.as_mut(), objective: &objective };
            are_elsewhere(seer, views, &limbs, 40, 0.2).unwrap()
        });
        for limb in 0..glances.limbs().len() {
            let [expected, found] = [&known, &asked].map(|views| {
                let glance = glances.at(limb, &lifted, views).unwrap();
                let evaluator = evaluator.as_mut();
                let seer = Seer { evaluator: &mut *evaluator, objective: &objective };
                let support = glance.support(seer, &glance.lattice(40)).unwrap();
                let seer = Seer { evaluator: &mut *evaluator, objective: &objective };
                let is_elsewhere = are_elsewhere(seer, views, std::slice::from_ref(&glance), 40, 0.2).unwrap();
                let best = glance.best(Seer { evaluator, objective: &objective }, 40, 5).unwrap();
                (best, support.into_iter().map(f32::to_bits).collect::<Vec<_>>(), is_elsewhere)
            });
            assert_eq!(found, expected, "frame {frame}, limb {limb}");
            assert_eq!(together.each_ref().map(|are| are[limb]), [expected.2[0]; 2], "frame {frame}, limb {limb}");
            sights.push(expected);
        }
        for (view, camera) in cameras.iter().enumerate() {
            let pixels = camera.size[0] as usize * camera.size[1] as usize;
            let asked: Vec<[usize; 2]> = (0..pixels).map(|at| [view, at]).collect();
            let found = evaluator.evidence_at(&asked).unwrap();
            let differs = found.iter().zip(codes(&own, view)).position(|(found, expected)| *found != expected);
            assert_eq!(differs, None, "frame {frame}, view {view}");
        }
        assert!(evaluator.evidence_at(&[[0, usize::MAX >> 40]]).is_err() && evaluator.evidence_at(&[[3, 0]]).is_err());
        assert!(evaluator.evidence_at(&[]).unwrap().is_empty());
        // A comparison that could not fail would be worth nothing.
        assert_ne!(before.replace(expected.clone()), Some(expected));

        by_host.learn(frame, &own, &pose).unwrap();
        by_device.learn(frame, &there, &pose).unwrap();
        assert_eq!(by_device.tables(), by_host.tables(), "frame {frame}");
    }
    assert!(classes[0] == 1 && classes[4] > 2, "{classes:?}");
    assert!(sights.iter().any(|sight| sight.1 != sights[0].1), "limbs are seen elsewhere by as much in every frame");
}

#[test]
fn evidence_that_a_device_makes_is_the_processor_s() {
    let Some((device, log)) = device("evidence_that_a_device_makes", DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1700.0).unwrap(), cameras_around());
    let compute = Compute::on(&device, &body, &cameras).unwrap();
    frames_are_the_processor_s(&device, Box::new(compute), 3);
    let graphics = Graphics::on(&device, &body, &cameras, GraphicsSettings::default()).unwrap();
    frames_are_the_processor_s(&device, Box::new(graphics), 2);
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}
