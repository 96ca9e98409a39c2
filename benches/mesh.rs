//! Throughput of the mesh model on the graphics pipeline, poses in to fitness out, on every rung of the ladder and of a glTF
//! person, with the time of each stage.
//!
//! `cargo bench --bench mesh` prints the table of docs/PERFORMANCE.md; run by `cargo test` it evaluates a few candidates on the
//! lowest rungs and checks them against the reference. Without Vulkan it says so and ends.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use pantin::body::{Body, Mesh, Model, Skinning};
use pantin::evaluate::device::{Graphics, GraphicsSettings, open_device};
use pantin::evaluate::{Components, Evaluator as _, Objective, Reference};
use pantin::features::Observation;
use pantin::geometry::{BrownConrady, Camera, Lens};
use pantin::gpu::{Timing, by_name};

/// Four cameras of 640x480 around a person who is 280 pixels tall.
fn cameras() -> Vec<Camera> {
    let distance = 4000.0;
    (0..4)
        .map(|index| {
            let angle = f64::from(index) * std::f64::consts::FRAC_PI_2 + 0.6;
            let eye = DVec3::new(distance * angle.cos(), distance * angle.sin(), 1200.0);
            let forward = (DVec3::new(0.0, 0.0, 900.0) - eye).normalize();
            let right = forward.cross(DVec3::Z).normalize();
            let rotation = DMat3::from_cols(right, forward.cross(right), forward).transpose();
            Camera {
                name: format!("cam{index}"),
                size: [640, 480],
                camera_from_world: DAffine3::from_mat3_translation(rotation, -(rotation * eye)),
                lens: Lens::BrownConrady(BrownConrady {
                    focal: DVec2::splat(280.0 * distance / 1750.0),
                    centre: DVec2::new(320.0, 240.0),
                    radial: [-0.05, 0.01, 0.0],
                    tangential: [1e-4, -1e-4],
                }),
            }
        })
        .collect()
}

/// The standing pose and `count - 1` others within a step of it.
fn swarm(body: &Body, count: usize) -> Vec<f32> {
    let mut state = 1_u64;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1_u64 << 24) as f64
    };
    let standing = body.standing_pose();
    let mut poses = Vec::new();
    for candidate in 0..count {
        for ((_, dof), start) in body.dofs().zip(&standing) {
            let spread = if candidate == 0 { 0.0 } else { 2.0 * uniform() - 1.0 };
            poses.push((start + dof.step * spread) as f32);
        }
    }
    poses
}

fn meshes(body: &Body) -> Vec<(String, Mesh)> {
    let frusta = Model::ladder().skip(1);
    let mut all: Vec<(String, Mesh)> =
        frusta.map(|model| (model.to_string(), model.mesh(body).unwrap().unwrap())).collect();
    let person = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/mesh/human_male.glb"));
    if person.exists() {
        let mesh = Mesh::read(person, body, Skinning::Smooth, &BTreeMap::new()).unwrap();
        all.push(("glTF smooth".to_string(), mesh));
    } else {
        println!("SKIPPED the glTF person: ../shared/data is absent");
    }
    all
}

fn main() {
    let measuring = std::env::args().any(|argument| argument == "--bench");
    let device = match open_device() {
        Ok(device) => device,
        Err(error) => {
            println!("SKIPPED mesh: {error:#}");
            return;
        }
    };
    let (candidates, rounds) = if measuring { (304, 7) } else { (4, 1) };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let poses = swarm(&body, candidates);
    let images = candidates * cameras.len();
    println!("{candidates} candidates x {} cameras of 640x480 on {}", cameras.len(), device.facts().name);
    println!(
        "| mesh | vertices | triangles | ms | poses/s | images/s | tile | batch | stages, ms |\n|---|---|---|---|---|---|---|---|---|"
    );
    for (name, mesh) in meshes(&body).into_iter().take(if measuring { usize::MAX } else { 2 }) {
        let counts = (mesh.vertices.len(), mesh.triangles.len());
        let mut reference = Reference::of_mesh(&body, mesh.clone(), &cameras).unwrap();
        let seen: Vec<Observation> = (0..cameras.len())
            .map(|view| {
                let image = reference.draw(&poses[..body.dof_count()], view);
                let bytes = image.bytes.iter().map(|&drawn| if drawn == 0 { 0 } else { 0x80 | drawn }).collect();
                Observation { width: image.width, height: image.height, bytes, segmentation: None }
            })
            .collect();
        let mut graphics = Graphics::of_mesh(&device, &body, mesh, &cameras, GraphicsSettings::default()).unwrap();
        graphics.observe(&seen).unwrap();
        reference.observe(&seen).unwrap();
        let (mut fitness, objective) = (vec![0.0; candidates], Objective::default());
        // Tiles are fitted, memory touched and everything recorded before the clock runs.
        for _ in 0..2 {
            graphics.fitness(&poses, &objective, &mut fitness).unwrap();
        }
        let mut ms: Vec<f64> = (0..rounds)
            .map(|_| {
                let start = Instant::now();
                graphics.fitness(&poses, &objective, &mut fitness).unwrap();
                start.elapsed().as_secs_f64() * 1e3
            })
            .collect();
        ms.sort_by(f64::total_cmp);
        let median = ms[rounds / 2];
        graphics.time_stages(Timing::Stamps);
        graphics.fitness(&poses, &objective, &mut fitness).unwrap();
        let stages: Vec<String> =
            by_name(&graphics.timings().unwrap()).iter().map(|(name, ms, _)| format!("{name} {ms:.2}")).collect();
        let (tiles, batch) = graphics.tiles();
        println!(
            "| {name} | {} | {} | {median:.1} | {:.0} | {:.0} | {}x{} | {batch} | {} |",
            counts.0,
            counts.1,
            candidates as f64 / median * 1e3,
            images as f64 / median * 1e3,
            tiles[0][0],
            tiles[0][1],
            stages.join(", ")
        );
        // That it is the picture that was meant: the first candidate's.
        let mut found = vec![Components::default(); images];
        graphics.components(&poses, &mut found).unwrap();
        let mut expected = vec![Components::default(); cameras.len()];
        reference.components(&poses[..body.dof_count()], &mut expected).unwrap();
        for (found, expected) in found.iter().zip(&expected) {
            let off = found.area_model.abs_diff(expected.area_model);
            assert!(off * 200 <= expected.area_model, "{name}: {found:?} is not {expected:?}");
        }
    }
}
