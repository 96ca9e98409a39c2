//! The mesh model drawn in compute against the reference, to the last integer.

#![allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]

use std::collections::BTreeMap;

use super::Compute;
use super::tests::{cameras, device, poses, recorded_fitness};
use crate::body::{Body, FrustumBase, Mesh, Skinning};
use crate::evaluate::device_evaluator::DeviceEvaluator;
use crate::evaluate::{Components, Evaluator, Objective, Reference};
use crate::features::Observation;
use crate::geometry::Camera;
use crate::gpu::{Capabilities, DeviceSettings};

/// Silhouettes and proximities without any order.
fn noise(cameras: &[Camera]) -> Vec<Observation> {
    let mut state = 5_u32;
    let mut byte = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    let seen = cameras.iter().map(|camera| {
        let [width, height] = camera.size;
        let bytes = (0..width * height).map(|_| byte()).collect();
        Observation { bytes, ..Observation::empty(width, height) }
    });
    seen.collect()
}

/// Frusta of few and of many corners, and some whose vertices hang on two bones each.
fn meshes(body: &Body) -> Vec<(&'static str, Mesh)> {
    let frusta = |base| Mesh::frusta(body, base, &BTreeMap::new()).unwrap();
    let mut bent = Mesh::of_body(body).unwrap();
    bent.skinning = Skinning::Smooth;
    for (index, vertex) in bent.vertices.iter_mut().enumerate() {
        vertex.bones[1] = (index % body.bones.len()) as u16;
        vertex.weights = [0.75, 0.25, 0.0, 0.0];
    }
    vec![
        ("square", frusta(FrustumBase::Square)),
        ("elliptic 34", frusta(FrustumBase::Elliptic { vertices: 34 })),
        ("bent", bent),
    ]
}

fn components<E: Evaluator>(evaluator: &mut E, poses: &[f32]) -> Vec<Components> {
    let images = poses.len() / evaluator.dof_count() * evaluator.view_count();
    let mut found = vec![Components::default(); images];
    evaluator.components(poses, &mut found).unwrap();
    found
}

#[test]
fn meshes_are_drawn_in_the_reference_s_integers_whatever_the_limits() {
    let whole: fn(&mut Capabilities) = |_| ();
    let small: fn(&mut Capabilities) = |capabilities| {
        capabilities.max_storage = 200_000;
        capabilities.subgroup_arithmetic = false;
    };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let seen = noise(&cameras);
    // Every third stands anywhere, in cameras and behind them too: triangles larger than the picture.
    let poses = poses(&body, 60);
    for lower in [whole, small] {
        let settings = DeviceSettings { lower: Some(lower), ..DeviceSettings::default() };
        let test = "meshes_are_drawn_in_the_reference_s_integers_whatever_the_limits";
        let Some((device, log)) = device(test, settings) else { return };
        for (name, mesh) in meshes(&body) {
            let mut reference = Reference::of_mesh(&body, mesh.clone(), &cameras).unwrap();
            let mut compute = Compute::of_mesh(&device, &body, mesh, &cameras).unwrap();
            reference.observe(&seen).unwrap();
            compute.observe(&seen).unwrap();
            let expected = components(&mut reference, &poses);
            assert_eq!(components(&mut compute, &poses), expected, "{name}");
            let mut moved = poses.clone();
            moved[0] += 25.0;
            assert_ne!(components(&mut compute, &moved), expected, "{name}: a moved pose passed");
            let mut fitness = vec![0.0; 60];
            reference.fitness(&poses, &Objective::default(), &mut fitness).unwrap();
            compute.reserve(60).unwrap();
            let found = recorded_fitness(&compute, &Objective::default(), &poses, 60);
            assert!(found.iter().zip(&fitness).all(|(found, expected)| (found - expected).abs() <= 1e-5), "{name}");
            let error = compute.set_body(&body).unwrap_err().to_string();
            assert!(error.contains("bound to the body it was made with"), "{error}");
        }
        drop(device);
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}
