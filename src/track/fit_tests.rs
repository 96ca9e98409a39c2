use std::fs;
use std::path::Path;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use image::{GrayImage, Luma, Rgb, RgbImage};

use super::{FitSettings, ObjectiveChoice, fit};
use crate::body::{Body, PoseTable, Proportions};
use crate::evaluate::{ObjectiveKind, Reference};
use crate::features::Observation;
use crate::geometry::{BrownConrady, Camera, Lens};
use crate::sequence::{Sequence, write_cameras_toml};

/// Three cameras round the origin, 4.5 m away and a little above the chest.
pub(super) fn cameras_around() -> Vec<Camera> {
    let lens = Lens::BrownConrady(BrownConrady {
        focal: DVec2::splat(260.0),
        centre: DVec2::new(99.5, 119.5),
        radial: [0.0; 3],
        tangential: [0.0; 2],
    });
    let camera = |(index, degrees): (usize, f64)| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let centre = DVec3::new(4500.0 * cos, 4500.0 * sin, 1500.0);
        let forward = (DVec3::new(0.0, 0.0, 900.0) - centre).normalize();
        let right = forward.cross(DVec3::Z).normalize();
        let rotation = DMat3::from_cols(right, forward.cross(right), forward).transpose();
        let camera_from_world = DAffine3::from_mat3_translation(rotation, -(rotation * centre));
        Camera { name: format!("c{index}"), size: [200, 240], camera_from_world, lens }
    };
    [20.0, 110.0, -95.0].into_iter().enumerate().map(camera).collect()
}

/// What the cameras see of a body: its drawn silhouette.
pub(super) fn seen(body: &Body, cameras: &[Camera], pose: &[f64]) -> Vec<Observation> {
    let reference = Reference::new(body, cameras);
    let pose: Vec<f32> = pose.iter().map(|value| *value as f32).collect();
    let views = 0..cameras.len();
    views
        .map(|view| {
            let image = reference.draw(&pose, view);
            let mut seen = Observation::empty(image.width, image.height);
            for (byte, drawn) in seen.bytes.iter_mut().zip(&image.bytes) {
                *byte = if *drawn != 0 { Observation::SILHOUETTE } else { 0 };
            }
            seen
        })
        .collect()
}

/// Somebody who stands at a place, world x and y, with an arm lifted and a leg forward.
pub(super) fn standing_at(body: &Body, [x, y]: [f64; 2]) -> Vec<f64> {
    let mut pose = body.standing_pose();
    let held = [("pelvis.tx", x), ("pelvis.ty", y), ("left_shoulder.rx", 1.2), ("right_hip.ry", -0.5)];
    for (name, value) in held {
        pose[body.dof_index(name).unwrap()] = value;
    }
    pose
}

/// What is seen of all in one picture.
pub(super) fn together(all: &[Vec<Observation>]) -> Vec<Observation> {
    let mut together = all[0].clone();
    for other in &all[1..] {
        for (view, other) in together.iter_mut().zip(other) {
            view.bytes.iter_mut().zip(&other.bytes).for_each(|(byte, other)| *byte |= other);
        }
    }
    together
}

/// A sequence of one frame of masks and pictures in a folder.
fn write_sequence(folder: &Path, cameras: &[Camera], seen: &[Observation]) {
    let mut manifest = "name = \"drawn\"\nfps = 25.0\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\n".to_string();
    for (camera, seen) in cameras.iter().zip(seen) {
        let name = &camera.name;
        let is_person = |x: u32, y: u32| seen.bytes[(y * seen.width + x) as usize] != 0;
        let mask = GrayImage::from_fn(seen.width, seen.height, |x, y| Luma([if is_person(x, y) { 255 } else { 0 }]));
        let picture =
            RgbImage::from_fn(seen.width, seen.height, |x, y| Rgb([if is_person(x, y) { 220 } else { 30 }; 3]));
        mask.save(folder.join(format!("mask_{name}_00.png"))).unwrap();
        picture.save(folder.join(format!("{name}_00.png"))).unwrap();
        manifest +=
            &format!("[[view]]\ncamera = \"{name}\"\nsource = \"{name}_%02d.png\"\nmask = \"mask_{name}_%02d.png\"\n");
    }
    fs::write(folder.join("sequence.toml"), manifest).unwrap();

    write_cameras_toml(&folder.join("cameras.toml"), cameras, crate::files::Overwrite::Refuse).unwrap();
}

/// A stout short-armed person in a T-pose, drawn; measured from the silhouettes alone.
#[test]
fn a_drawn_person_is_measured() {
    let index = |name: &str| Proportions::ALL.iter().position(|known| known.name == name).unwrap();
    let mut wanted = Proportions::default();
    for (name, factor) in
        [("upper arm", 0.9), ("forearm", 0.9), ("belly girth", 1.25), ("thigh girth", 1.3), ("shoulder width", 1.1)]
    {
        wanted.0[index(name)] = factor;
    }
    let adult = Body::adult(1700.0).unwrap();
    let person = wanted.apply(&adult);
    let mut pose = person.standing_pose();
    for (name, value) in [("pelvis.tx", 150.0), ("pelvis.ty", -90.0)] {
        pose[person.dof_index(name).unwrap()] = value;
    }
    for (name, degrees) in [("pelvis.rz", 35.0_f64), ("left_shoulder.rx", 80.0), ("right_shoulder.rx", -85.0)] {
        pose[person.dof_index(name).unwrap()] = degrees.to_radians();
    }
    let cameras = cameras_around();
    let folder = tempfile::tempdir().unwrap();
    write_sequence(folder.path(), &cameras, &seen(&person, &cameras, &pose));
    let sequence = Sequence::open_unfitted(folder.path()).unwrap();
    let settings = FitSettings {
        height: Some(1700.0),
        particles: 150,
        iterations: 20,
        heading: Some(0.0),
        ..FitSettings::default()
    };
    let found = fit(&sequence, &settings).unwrap();
    let (before, after) = (&found.coverage[0], &found.coverage[1]);
    let mean =
        |views: &[super::Coverage]| views.iter().map(|v| v.seen + v.drawn).sum::<f64>() / 2.0 / views.len() as f64;
    assert!(mean(after) > 0.95 && mean(after) > mean(before) + 0.01, "{before:?} {after:?}");
    let proportions = found.proportions.unwrap();
    for name in ["belly girth", "thigh girth"] {
        assert!(proportions.0[index(name)] > 1.1, "{name}: {proportions:?}");
    }
    // From finger tips to finger tips: where between them the wrists are, silhouettes leave open.
    let reach = |body: &Body, pose: &[f64]| -> f64 {
        let bones = body.world_from_bones(pose).unwrap();
        let tip = |name: &str| {
            let hand = body.parts.iter().find(|part| part.name == name).unwrap();
            bones[hand.bone].transform_point3(hand.b)
        };
        tip("left_hand").distance(tip("right_hand"))
    };
    let (found_reach, expected) = (reach(&found.body, &found.poses.poses[0]), reach(&person, &pose));
    println!("coverage {:.3} to {:.3}, reach {found_reach:.1} of {expected:.1} mm", mean(before), mean(after));
    // Five seeds were off by 6 to 53 mm.
    assert!((found_reach - expected).abs() < 80.0, "reach {found_reach}, expected {expected}");
    // The same again from its own poses, keeping the body: and with the same seed the same result.
    fs::write(folder.path().join("body.toml"), found.body.to_toml()).unwrap();
    let start = folder.path().join("start.csv");
    found.poses.write(&start, crate::files::Overwrite::Refuse, &found.body).unwrap();
    let again = FitSettings { keep_body: true, start: Some(start), ..settings };
    let sequence = Sequence::open(folder.path()).unwrap();
    let [first, second] = [(); 2].map(|()| fit(&sequence, &again).unwrap());
    assert_eq!(first.poses.poses, second.poses.poses);
    assert!(first.fitness >= found.fitness - 1e-3, "{} {}", first.fitness, found.fitness);
    assert!(first.proportions.is_none());
}

/// Lower legs that no view shows, as white ones before a white floor, do not end where the thighs do: the person is as tall as was said.
#[test]
fn a_person_is_as_tall_as_was_said() {
    let adult = Body::adult(1700.0).unwrap();
    let mut shown = adult.clone();
    shown.parts.retain(|part| !["calf", "foot"].iter().any(|hidden| part.name.ends_with(hidden)));
    let mut pose = adult.standing_pose();
    for (name, degrees) in [("left_shoulder.rx", 80.0_f64), ("right_shoulder.rx", -80.0)] {
        pose[adult.dof_index(name).unwrap()] = degrees.to_radians();
    }
    let cameras = cameras_around();
    let folder = tempfile::tempdir().unwrap();
    write_sequence(folder.path(), &cameras, &seen(&shown, &cameras, &pose));
    let start = folder.path().join("start.csv");
    let table = PoseTable { frames: vec![0], poses: vec![pose] };
    table.write(&start, crate::files::Overwrite::Refuse, &adult).unwrap();
    let sequence = Sequence::open_unfitted(folder.path()).unwrap();
    let (height, start) = (Some(1700.0), Some(start));
    let settings = FitSettings { height, start, particles: 150, iterations: 20, ..FitSettings::default() };
    let found = fit(&sequence, &settings).unwrap();
    let stature = |body: &Body| {
        let joints = body.joint_positions(&body.world_from_bones(&vec![0.0; body.dof_count()]).unwrap());
        let z = |name: &str| joints[body.joint_index(name).unwrap()].z;
        z("head_top") - z("right_ankle")
    };
    let share = stature(&found.body) / stature(&adult);
    assert!((0.94..1.02).contains(&share), "{share} of the height: {:?}", found.proportions);
}

#[test]
fn what_cannot_be_measured_is_said() {
    let cameras = cameras_around();
    let folder = tempfile::tempdir().unwrap();
    let body = Body::adult(1700.0).unwrap();
    write_sequence(folder.path(), &cameras, &seen(&body, &cameras, &body.standing_pose()));
    let manifest = folder.path().join("sequence.toml");
    let error = |settings: &FitSettings| {
        let sequence = Sequence::open_unfitted(folder.path()).unwrap();
        format!("{:#}", fit(&sequence, settings).unwrap_err())
    };
    let tall = error(&FitSettings { height: Some(17_000.0), ..FitSettings::default() });
    assert!(tall.contains("the height of the person") && tall.contains("500 to 2500"), "{tall}");
    let none = error(&FitSettings { samples: 0, ..FitSettings::default() });
    assert!(none.contains("0 frames were asked for"), "{none}");
    let late = error(&FitSettings { frames: "3..5".parse().unwrap(), ..FitSettings::default() });
    assert!(late.contains("reach past the end"), "{late}");
    let text = fs::read_to_string(&manifest).unwrap();
    fs::write(&manifest, text.replace("mask = \"mask_c1_%02d.png\"\n", "")).unwrap();
    let bare = error(&FitSettings::default());
    assert!(bare.contains("camera \"c1\" has neither a background picture nor masks"), "{bare}");
}

/// Bare forearms before a wall of nearly their colour: silhouettes end at the elbows, evidence does not.
#[test]
fn forearms_like_the_wall_are_measured_by_evidence() {
    let cameras = cameras_around();
    let person = Body::adult(1700.0).unwrap();
    let mut pose = person.standing_pose();
    for (name, degrees) in [("left_shoulder.rx", 80.0_f64), ("right_shoulder.rx", -80.0)] {
        pose[person.dof_index(name).unwrap()] = degrees.to_radians();
    }
    let folder = tempfile::tempdir().unwrap();
    let mut manifest = "name = \"wall\"\nfps = 25.0\ncameras = \"cameras.toml\"\nheight = 1700\n".to_string();
    let reference = Reference::new(&person, &cameras);
    let drawn_pose: Vec<f32> = pose.iter().map(|value| *value as f32).collect();
    let bare: Vec<u8> = person
        .parts
        .iter()
        .filter(|part| part.name.contains("forearm") || part.name.contains("hand"))
        .map(|part| part.label)
        .collect();
    for (view, camera) in cameras.iter().enumerate() {
        let (name, drawn) = (&camera.name, reference.draw(&drawn_pose, view));
        let wall = Rgb([176, 160, 140]);
        RgbImage::from_pixel(drawn.width, drawn.height, wall).save(folder.path().join(format!("{name}.png"))).unwrap();
        let colour = |x: u32, y: u32| match drawn.bytes[(y * drawn.width + x) as usize] & 0x7f {
            0 => wall,
            label if bare.contains(&label) => Rgb([190, 158, 134]),
            _ => Rgb([40, 60, 120]),
        };
        RgbImage::from_fn(drawn.width, drawn.height, colour)
            .save(folder.path().join(format!("{name}_00.png")))
            .unwrap();
        manifest +=
            &format!("[[view]]\ncamera = \"{name}\"\nsource = \"{name}_%02d.png\"\nbackground = \"{name}.png\"\n");
    }
    fs::write(folder.path().join("sequence.toml"), manifest).unwrap();
    write_cameras_toml(&folder.path().join("cameras.toml"), &cameras, crate::files::Overwrite::Refuse).unwrap();
    let start = folder.path().join("start.csv");
    let table = PoseTable { frames: vec![0], poses: vec![pose.clone()] };
    table.write(&start, crate::files::Overwrite::Refuse, &person).unwrap();

    let sequence = Sequence::open_unfitted(folder.path()).unwrap();
    let wrists = |objective| {
        let objective = ObjectiveChoice { kind: objective, ..ObjectiveChoice::default() };
        let settings = FitSettings {
            height: Some(1700.0),
            start: Some(start.clone()),
            objective,
            particles: 120,
            iterations: 12,
            ..FitSettings::default()
        };
        let found = fit(&sequence, &settings).unwrap();
        let off = |name: &str| {
            let at = |body: &Body, pose: &[f64]| {
                let hand = body.parts.iter().find(|part| part.name == name).unwrap();
                body.world_from_bones(pose).unwrap()[hand.bone].transform_point3(hand.a)
            };
            at(&found.body, &found.poses.poses[0]).distance(at(&person, &pose))
        };
        off("left_hand").max(off("right_hand"))
    };
    let (by_silhouettes, by_evidence) = (wrists(Some(ObjectiveKind::Sp)), wrists(None));
    println!("wrists {by_silhouettes:.1} mm by silhouettes, {by_evidence:.1} mm by evidence");
    // Five seeds gave 26 to 113 mm and 1.2 to 3.7.
    assert!(by_evidence < 6.0 && by_silhouettes > 5.0 * by_evidence, "{by_silhouettes} and {by_evidence} mm");
}

/// Of two people the one is measured who is meant, and the other counts neither for nor against her.
#[test]
fn who_is_meant_is_measured_beside_another() {
    let cameras = cameras_around();
    let body = Body::adult(1700.0).unwrap();
    let places = [[-350.0, 250.0], [500.0, -500.0]];
    let both = together(&places.map(|place| seen(&body, &cameras, &standing_at(&body, place))));
    let folder = tempfile::tempdir().unwrap();
    write_sequence(folder.path(), &cameras, &both);
    body.save(&folder.path().join("body.toml"), crate::files::Overwrite::Refuse).unwrap();
    let sequence = Sequence::open(&folder.path().join("sequence.toml")).unwrap();
    let settings = FitSettings { keep_body: true, particles: 100, iterations: 15, ..FitSettings::default() };
    let measured = |at: Option<[f64; 2]>| fit(&sequence, &FitSettings { at, ..settings.clone() });
    // Nobody is named: who stands nearer to where the cameras look.
    for (at, [x, y]) in [(None, places[0]), (Some(places[0]), places[0]), (Some([300.0, -400.0]), places[1])] {
        let found = measured(at).unwrap();
        let off = DVec2::new(found.poses.poses[0][0] - x, found.poses.poses[0][1] - y).length();
        println!("{at:?}: {off:.0} mm off, fitness {:.3}; {:?}", found.fitness, found.others);
        assert!(off < 60.0 && found.fitness > 0.75);
        assert!(found.others.unwrap().starts_with("2 people are seen in frame 0: the one at "));
    }
    let error = format!("{:#}", measured(Some([2500.0, 0.0])).unwrap_err());
    assert!(error.contains("frame 0: nobody stands within 1000 mm of 2500,0; seen are people at "), "{error}");
}
