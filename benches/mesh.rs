//! Throughput of the mesh model on the graphics pipeline, poses in to fitness out, on every rung of the ladder and of a glTF
//! person, with the time of each stage.
//!
//! Run by `cargo test` it evaluates a few candidates on the lowest rungs. Either way it checks them against the reference.
//! Without Vulkan it says so and ends.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark ends where something fails, and prints")]

mod table;

use std::collections::BTreeMap;
use std::path::Path;

use pantin::bench::{Contestant, Scene, pass_times, swarm};
use pantin::body::{Body, Mesh, Model, Skinning};
use pantin::evaluate::device::{GraphicsSettings, open_device};
use pantin::evaluate::{Components, Objective};
use table::{Table, in_a_line, is_measuring, is_wanted};

fn meshes(body: &Body) -> Vec<(String, Mesh)> {
    let frusta = Model::ladder().skip(1).map(|model| (model.to_string(), model.mesh(body).unwrap().unwrap()));
    let mut all: Vec<(String, Mesh)> = frusta.take(if is_measuring() { usize::MAX } else { 2 }).collect();
    let person = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/mesh/human_male.glb"));
    if !person.exists() {
        println!("SKIPPED the glTF person: ../shared/data is absent");
    } else if is_measuring() {
        let mesh = Mesh::read(person, body, Skinning::Smooth, &BTreeMap::new()).unwrap();
        all.push(("glTF smooth".to_string(), mesh));
    }
    all
}

fn main() {
    let device = open_device().map_err(|error| format!("{error:#}"));
    if let Err(error) = &device {
        return println!("SKIPPED mesh: {error}");
    }
    let candidates = if is_measuring() { 304 } else { 4 };
    let scene = Scene::new([640, 480], 280.0).unwrap();
    let poses = swarm(&scene.body, &scene.pose, candidates);
    let images = candidates * scene.cameras.len();
    let objective = Objective::default();
    let mut table = Table::new(format!("{candidates} candidates x 4 cameras of 640x480, person 280 px"), "image");
    for (name, mesh) in meshes(&scene.body).into_iter().filter(|(name, _)| is_wanted(name)) {
        let build = |contestant: Contestant| contestant.build(&scene, Some(&mesh), &device).unwrap();
        let mut graphics = build(Contestant::Graphics(GraphicsSettings::default()));
        let mut found = vec![Components::default(); images];
        graphics.components(&poses, &mut found).unwrap();
        let mut expected = vec![Components::default(); scene.cameras.len()];
        build(Contestant::Reference).components(&scene.pose, &mut expected).unwrap();
        for (found, expected) in found.iter().zip(&expected) {
            let off = found.area_model.abs_diff(expected.area_model);
            assert!(off * 200 <= expected.area_model, "{name}: {found:?} is not {expected:?}");
        }
        let mut fitness = vec![0.0; candidates];
        let passes = pass_times(graphics.as_mut(), &poses, &objective, &mut fitness).unwrap();
        let [width, height] = graphics.footprint().unwrap().tile;
        println!(
            "{name}: {} vertices, {} triangles, tiles of {width}x{height}; stages, ms: {}",
            mesh.vertices.len(),
            mesh.triangles.len(),
            in_a_line(&passes)
        );
        let poses = &poses;
        table.row(name, images, move || graphics.fitness(poses, &objective, &mut fitness).unwrap());
    }
    table.run();
}
