//! The mesh model as a whole: frusta beside the flat model, and that a moved vertex is noticed.
#![allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]

use std::collections::BTreeMap;

use glam::DVec2;
use pantin::body::{Body, FrustumBase, Mesh};
use pantin::evaluate::{CandidateImage, Components, Evaluator, Reference};
use pantin::features::Observation;
use pantin::geometry::Camera;
use pantin::synth::rig::four_cameras;

fn cameras() -> Vec<Camera> {
    four_cameras(DVec2::splat(2600.0), [400, 300])
}

/// A stride: one leg and the other arm forward.
fn stride(body: &Body) -> Vec<f32> {
    let names = body.dof_names();
    let mut pose: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
    for (name, degrees) in [
        ("pelvis.rz", 20.0_f32),
        ("left_hip.ry", -28.0),
        ("left_knee.ry", 10.0),
        ("right_hip.ry", 15.0),
        ("right_knee.ry", 35.0),
        ("left_shoulder.ry", 25.0),
        ("left_shoulder.rx", 10.0),
        ("right_shoulder.ry", -25.0),
        ("right_elbow.ry", -50.0),
    ] {
        pose[names.iter().position(|known| known == name).unwrap()] = degrees.to_radians();
    }
    pose
}

fn area(image: &CandidateImage) -> f64 {
    image.bytes.iter().filter(|byte| **byte != 0).count() as f64
}

#[test]
fn frusta_cover_what_the_flat_model_covers_with_the_same_parts_in_view() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let pose = stride(&body);
    let flat = Reference::new(&body, &cameras);
    let ladder = FrustumBase::LADDER.map(|vertices| FrustumBase::Elliptic { vertices });
    for base in [FrustumBase::Square].into_iter().chain(ladder) {
        let mesh = Mesh::frusta(&body, base, &BTreeMap::new()).unwrap();
        let mesh = Reference::of_mesh(&body, mesh, &cameras).unwrap();
        for view in 0..cameras.len() {
            let (flat, mesh) = (flat.draw(&pose, view), mesh.draw(&pose, view));
            let ratio = area(&mesh) / area(&flat);
            // Round ends are seen beyond a quadrilateral's straight ones; a square is at times seen by its diagonal.
            assert!((0.97..1.08).contains(&ratio), "{base:?} in view {view}: {ratio} of the flat area");
            let both = flat.bytes.iter().zip(&mesh.bytes).filter(|(a, b)| **a != 0 && **b != 0).count() as f64;
            assert!(both / area(&flat) > 0.93, "{base:?} in view {view}: {both}");
            let labels = |image: &CandidateImage| {
                let mut pixels = BTreeMap::new();
                for byte in image.bytes.iter().filter(|byte| **byte != 0) {
                    *pixels.entry(byte & 0x7f).or_insert(0) += 1;
                }
                pixels
            };
            let (flat, mesh) = (labels(&flat), labels(&mesh));
            for (label, pixels) in flat {
                assert!(pixels < 40 || mesh.contains_key(&label), "{base:?} in view {view}: part {label} is lost");
            }
        }
    }
}

#[test]
fn the_evaluator_counts_its_own_drawing_and_a_moved_vertex_is_noticed() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mesh = Mesh::of_body(&body).unwrap();
    let pose = stride(&body);
    let mut reference = Reference::of_mesh(&body, mesh.clone(), &cameras).unwrap();
    let drawn: Vec<CandidateImage> = (0..cameras.len()).map(|view| reference.draw(&pose, view)).collect();
    let seen: Vec<Observation> = drawn
        .iter()
        .map(|image| {
            let bytes =
                image.bytes.iter().map(|b| u8::from(*b != 0) << 7 | if b & 0x80 != 0 { 127 } else { 3 }).collect();
            Observation { bytes, ..Observation::empty(image.width, image.height) }
        })
        .collect();
    reference.observe(&seen).unwrap();
    let mut components = vec![Components::default(); cameras.len()];
    reference.components(&pose, &mut components).unwrap();
    for (found, image) in components.iter().zip(&drawn) {
        let edges = image.bytes.iter().filter(|byte| **byte & 0x80 != 0).count() as u32;
        let all = area(image) as u32;
        let expected = Components { area_obs: all, area_model: all, overlap: all, edges, proximity: 127 * edges };
        assert_eq!(*found, expected);
    }
    let mut moved = mesh;
    let hand = moved.vertices.iter().rposition(|vertex| vertex.label == 14).unwrap();
    moved.vertices[hand].position.x += 60.0;
    let mut sabotaged = Reference::of_mesh(&body, moved, &cameras).unwrap();
    sabotaged.observe(&seen).unwrap();
    let mut wrong = vec![Components::default(); cameras.len()];
    sabotaged.components(&pose, &mut wrong).unwrap();
    assert_ne!(wrong, components);
    let other = Mesh::of_body(&body).unwrap();
    let fewer = pantin::body::parse_body(
        "name = \"one\"\n[[bone]]\nname = \"a\"\nparent = \"\"\noffset = [0, 0, 0]\ndof = [\"tx\"]\n[[part]]\nname = \"p\"\n\
         bone = \"a\"\na = [0, 0, 0]\nb = [0, 0, 9]\nradius_a = 1\nradius_b = 1\nlabel = 1\n",
        "one.toml",
    );
    let error = Reference::of_mesh(&fewer.unwrap(), other, &cameras).unwrap_err().to_string();
    assert_eq!(error, "the mesh is bound to 15 bones, the body `one` has 1");
}
