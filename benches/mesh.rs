//! Throughput of the mesh model, poses in to fitness out, on every rung of the ladder and of a glTF person: the reference, the processor
//! with every instruction set, on one thread and on all, and compute and the graphics pipeline with the time of each stage.
//!
//! Run by `cargo test` it evaluates a few candidates on the lowest rungs. Either way it checks them against the reference.
//! Without Vulkan it says so and goes without them.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark ends where something fails, and prints")]

mod table;

use std::collections::BTreeMap;
use std::path::Path;

use pantin::bench::{Contestant, Scene, pass_times, swarm};
use pantin::body::{Body, Mesh, Model, Skinning};
use pantin::evaluate::cpu::{Cpu, InstructionSet};
use pantin::evaluate::device::{GraphicsSettings, Packing, open_device};
use pantin::evaluate::{Components, Evaluator, Objective};
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
        println!("SKIPPED compute and graphics: {error}");
    }
    let candidates = if is_measuring() { 304 } else { 4 };
    let scene = Scene::new([640, 480], 280.0).unwrap();
    let poses = &swarm(&scene.body, &scene.pose, candidates);
    let images = candidates * scene.cameras.len();
    let objective = Objective::default();
    let mut table = Table::new(format!("{candidates} candidates x 4 cameras of 640x480, person 280 px"), "image");
    for (name, mesh) in meshes(&scene.body).into_iter().filter(|(name, _)| is_wanted(name)) {
        println!("{name}: {} vertices, {} triangles", mesh.vertices.len(), mesh.triangles.len());
        let build = |contestant: Contestant| contestant.build(&scene, Some(&mesh), &device).unwrap();
        let mut expected = vec![Components::default(); scene.cameras.len()];
        let mut reference = build(Contestant::Reference);
        reference.components(&scene.pose, &mut expected).unwrap();
        let mut rows = vec![(format!("{name}, reference"), reference)];
        for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            let mut cpu = Cpu::of_mesh_with(&scene.body, mesh.clone(), &scene.cameras, set, 1).unwrap();
            cpu.observe(&scene.observations).unwrap();
            rows.push((format!("{name}, {}, one thread", set.name()), Box::new(cpu)));
            rows.push((format!("{name}, {}", set.name()), build(Contestant::Cpu(set))));
        }
        for (name, evaluator) in &mut rows[1..] {
            let mut found = vec![Components::default(); scene.cameras.len()];
            evaluator.components(&scene.pose, &mut found).unwrap();
            assert_eq!(found, expected, "{name}");
        }
        if device.is_ok() {
            let mut compute = build(Contestant::Compute { subgroup: false });
            let mut found = vec![Components::default(); scene.cameras.len()];
            compute.components(&scene.pose, &mut found).unwrap();
            assert_eq!(found, expected, "{name}, compute");
            let passes = pass_times(compute.as_mut(), poses, &objective, &mut vec![0.0; candidates]).unwrap();
            println!("{name}, compute: stages, ms: {}", in_a_line(&passes));
            rows.push((format!("{name}, compute"), compute));
            let usual = GraphicsSettings { packing: Packing::Depth, ..GraphicsSettings::default() };
            let mut drawn: Option<Vec<Components>> = None;
            for contestant in Contestant::of_meshes() {
                let Contestant::Graphics(settings) = contestant else { continue };
                let way =
                    if settings == usual { "graphics".to_string() } else { format!("graphics {}", settings.name()) };
                let mut graphics = match contestant.build(&scene, Some(&mesh), &device) {
                    Ok(graphics) => graphics,
                    Err(error) => {
                        println!("SKIPPED {name}, {way}: {error:#}");
                        continue;
                    }
                };
                let mut found = vec![Components::default(); images];
                graphics.components(poses, &mut found).unwrap();
                for (found, expected) in found.iter().zip(&expected) {
                    let off = found.area_model.abs_diff(expected.area_model);
                    assert!(off * 200 <= expected.area_model, "{name}, {way}: {found:?} is not {expected:?}");
                }
                // All ways of graphics draw the same pixels.
                assert!(*drawn.get_or_insert_with(|| found.clone()) == found, "{name}, {way} draws others");
                let passes = pass_times(graphics.as_mut(), poses, &objective, &mut vec![0.0; candidates]).unwrap();
                let [width, height] = graphics.footprint().unwrap().tile;
                println!("{name}, {way}: tiles of {width}x{height}; stages, ms: {}", in_a_line(&passes));
                rows.push((format!("{name}, {way}"), graphics));
            }
        }
        for (name, mut evaluator) in rows {
            let mut fitness = vec![0.0; candidates];
            table.row(name, images, move || evaluator.fitness(poses, &objective, &mut fitness).unwrap());
        }
    }
    table.run();
}
