//! Meshes on the processor and in compute: the reference's integers, and the processor's pictures, with every instruction set, whatever is
//! summed.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use pantin::body::{Body, FrustumBase, Mesh, Skinning};
use pantin::evaluate::cpu::{Cpu, InstructionSet};
use pantin::evaluate::device::Compute;
use pantin::evaluate::{Evaluator, Reference};
use pantin::features::{Observation, Segmentation};
use pantin::geometry::Camera;
use pantin::gpu::{Capabilities, DeviceSettings};

use crate::device::device;
use crate::evidence::{self, classes};
use crate::found::{Found, assert_fitness, found};
use crate::scene::{Random, brown, camera, cameras, ignoring, observations, poses};
use crate::segments::three;

/// Square and elliptic frusta, frusta whose vertices hang on three bones, and the glTF person where there is one.
fn meshes(body: &Body) -> Vec<(String, Mesh)> {
    let frusta = |base| Mesh::frusta(body, base, &BTreeMap::new()).unwrap();
    let mut all = vec![("square".to_owned(), frusta(FrustumBase::Square))];
    for vertices in [18, 258] {
        all.push((format!("elliptic-{vertices}"), frusta(FrustumBase::Elliptic { vertices })));
    }
    let mut smooth = frusta(FrustumBase::Elliptic { vertices: 34 });
    smooth.skinning = Skinning::Smooth;
    let bones = body.bones.len();
    for (index, vertex) in smooth.vertices.iter_mut().enumerate() {
        vertex.bones[1] = (index % bones) as u16;
        vertex.bones[3] = (index / 7 % bones) as u16;
        vertex.weights = [0.75, 0.125, 0.0, 0.125];
    }
    all.push(("smooth".to_owned(), smooth));
    let person = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/mesh/human_male.glb"));
    if !person.exists() {
        println!("SKIPPED the glTF person: ../shared/data is absent");
        return all;
    }
    for skinning in [Skinning::Rigid, Skinning::Smooth] {
        let mesh = Mesh::read(person, body, skinning, &BTreeMap::new()).unwrap();
        all.push((format!("glTF {}", skinning.name()), mesh));
    }
    all
}

/// How many poses of a mesh are held to the reference, more than a worker takes at a time, and on which views: of large meshes with
/// pixels that are ignored in every case but the last.
fn share<'a>(mesh: &Mesh, views: &[(&'a str, Vec<Observation>)]) -> (usize, Vec<(&'a str, Vec<Observation>)>) {
    if mesh.vertices.len() <= 1000 {
        return (25, views.to_vec());
    }
    let kept = views.iter().filter(|(case, _)| case.contains("in part") || *case == "silhouettes");
    (9, kept.cloned().collect())
}

/// Silhouettes, segments and evidence, each with pixels that are ignored and without.
fn views(cameras: &[Camera], random: &mut Random) -> Vec<(&'static str, Vec<Observation>)> {
    let whole = observations(cameras, random);
    let in_segments = |mut observation: Observation| {
        let segments = three();
        observation.bytes.iter_mut().for_each(|byte| *byte |= Observation::SILHOUETTE);
        let numbers = observation.bytes.iter().map(|_| (random.next() % 4) as u8).collect();
        let (width, height) = (observation.width, observation.height);
        let segmentation = Segmentation::new(Arc::clone(&segments), width, height, numbers).unwrap();
        observation.with_segmentation(segmentation).unwrap()
    };
    let segmented: Vec<Observation> = whole.iter().cloned().map(in_segments).collect();
    let evidence = evidence::seen(cameras, &classes(5), &mut Random(42));
    let in_part = |seen: &[Observation]| ignoring(seen, &mut Random(3));
    vec![
        ("silhouettes in part", in_part(&whole)),
        ("segments in part", in_part(&segmented)),
        ("segments", segmented),
        ("evidence in part", in_part(&evidence)),
        ("evidence", evidence),
        ("silhouettes", whole),
    ]
}

fn available() -> impl Iterator<Item = InstructionSet> {
    InstructionSet::ALL.into_iter().filter(|set| {
        if !set.is_available() {
            println!("SKIPPED {}: this processor does not have it", set.name());
        }
        set.is_available()
    })
}

/// Holds the processor to the reference for one mesh; how much of what was asked was drawn.
fn hold(
    (name, mesh): (&str, &Mesh),
    (body, cameras): (&Body, &[Camera]),
    poses: &[f32],
    views: &[(&str, Vec<Observation>)],
) -> Found {
    let mut reference = Reference::of_mesh(body, mesh.clone(), cameras).unwrap();
    let expected: Vec<Found> = views.iter().map(|(_, seen)| found(&mut reference, seen, poses)).collect();
    for set in available() {
        for workers in [1, 3] {
            let mut cpu = Cpu::of_mesh_with(body, mesh.clone(), cameras, set, workers).unwrap();
            assert_eq!((cpu.name(), cpu.variant()), ("cpu", set.name()));
            for ((case, seen), expected) in views.iter().zip(&expected) {
                let what = format!("{name}, {case}, {} with {workers} workers", set.name());
                assert_eq!(expected.difference(&found(&mut cpu, seen, poses)), None, "{what}");
                assert_fitness(&mut cpu, expected, seen, poses, &what);
            }
            let (pose, last) = (&poses[poses.len() - body.dof_count()..], cameras.len() - 1);
            for (pose, view) in [(&poses[..body.dof_count()], 0), (pose, last)] {
                let drawn = cpu.drawn(pose, view).unwrap().unwrap();
                assert!(drawn == reference.draw(pose, view), "{name}, {}: picture of view {view}", set.name());
            }
        }
    }
    expected.last().unwrap().clone()
}

/// Holds compute to the reference for one mesh, with what the device has and with little storage.
fn hold_compute(
    (name, mesh): (&str, &Mesh),
    (body, cameras): (&Body, &[Camera]),
    poses: &[f32],
    views: &[(&str, Vec<Observation>)],
) {
    let mut reference = Reference::of_mesh(body, mesh.clone(), cameras).unwrap();
    let expected: Vec<Found> = views.iter().map(|(_, seen)| found(&mut reference, seen, poses)).collect();
    let little: fn(&mut Capabilities) = |capabilities| capabilities.max_storage = 2_000_000;
    for (limits, lower) in [("as it is", None), ("little storage", Some(little))] {
        let settings = DeviceSettings { lower, ..DeviceSettings::default() };
        let Some((device, log)) = device("hold_compute", settings) else { return };
        let mut compute = Compute::of_mesh(&device, body, mesh.clone(), cameras).unwrap();
        for ((case, seen), expected) in views.iter().zip(&expected) {
            let what = format!("{name}, {case}, compute {limits}");
            assert_eq!(expected.difference(&found(&mut compute, seen, poses)), None, "{what}");
            assert_fitness(&mut compute, expected, seen, poses, &what);
        }
        drop((compute, device));
        assert_eq!(log.messages(), Vec::<String>::new(), "{name}, {limits}");
    }
}

#[test]
fn compute_draws_meshes_as_the_reference_does() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mut random = Random(25);
    let views = views(&cameras, &mut random);
    for (name, mesh) in meshes(&body) {
        let (count, views) = share(&mesh, &views);
        // On a software device triangles take their time.
        let poses = poses(&body, count.min(12) / 2, &mut random);
        hold_compute((&name, &mesh), (&body, &cameras), &poses, &views);
    }
}

#[test]
fn every_instruction_set_draws_meshes_as_the_reference_does() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mut random = Random(21);
    let views = views(&cameras, &mut random);
    for (name, mesh) in meshes(&body) {
        let (count, views) = share(&mesh, &views);
        let poses = poses(&body, count, &mut random);
        let drawn = hold((&name, &mesh), (&body, &cameras), &poses, &views);
        let some = drawn.components.iter().filter(|sums| sums.area_model > 0 && sums.edges > 0).count();
        assert!(some > count, "{name}: only {some} images show anything");
    }
}

/// Pictures that the body outgrows, from so near that triangles are larger than they are, and parts of it have no image.
#[test]
fn giants_are_drawn_as_the_reference_draws_them() {
    let body = Body::adult(1750.0).unwrap();
    let target = DVec3::new(0.0, 0.0, 900.0);
    let eyes = [(900.0, 300.0, 1300.0), (-450.0, 250.0, 1200.0), (5000.0, 500.0, 1300.0)];
    let cameras: Vec<Camera> = eyes
        .into_iter()
        .map(|(x, y, z)| {
            let lens = brown(700.0, [411, 307], [-0.05, 0.01, 0.0], [1e-4, -1e-4]);
            camera("near", [411, 307], DVec3::new(x, y, z), target, lens)
        })
        .collect();
    let mut random = Random(22);
    let mut all = poses(&body, 6, &mut random);
    let standing: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
    all.extend(standing);
    let views = views(&cameras, &mut random);
    for (name, mesh) in meshes(&body).into_iter().take(2) {
        let drawn = hold((&name, &mesh), (&body, &cameras), &all, &views[4..]);
        hold_compute((&name, &mesh), (&body, &cameras), &all, &views[4..]);
        let near = &drawn.components[drawn.components.len() - 3..];
        assert!(near[0].area_model > 20_000, "{name}: {near:?}");
    }
}

#[test]
fn poses_that_are_no_numbers_do_no_harm_to_a_mesh() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let seen = observations(&cameras, &mut Random(23));
    let mut poses = Vec::new();
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30, f32::MAX, f32::MIN_POSITIVE] {
        poses.extend(vec![value; body.dof_count()]);
    }
    let mesh = Mesh::of_body(&body).unwrap();
    let expected = found(&mut Reference::of_mesh(&body, mesh.clone(), &cameras).unwrap(), &seen, &poses);
    for set in available() {
        let mut cpu = Cpu::of_mesh_with(&body, mesh.clone(), &cameras, set, 1).unwrap();
        assert_eq!(expected.difference(&found(&mut cpu, &seen, &poses)), None, "{}", set.name());
    }
}

/// One pixel that is drawn seen otherwise, one vertex moved, and what cannot be asked of a mesh.
#[test]
fn what_differs_is_noticed_and_a_mesh_keeps_its_body() {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mut random = Random(24);
    let (seen, poses) = (observations(&cameras, &mut random), poses(&body, 12, &mut random));
    let mesh = Mesh::of_body(&body).unwrap();
    let mut cpu = Cpu::of_mesh(&body, mesh.clone(), &cameras).unwrap();
    let expected = found(&mut cpu, &seen, &poses);
    let drawn = cpu.drawn(&poses[..body.dof_count()], 0).unwrap().unwrap();
    let at = drawn.bytes.iter().position(|byte| *byte != 0).unwrap();
    let mut changed = seen.clone();
    changed[0].bytes[at] ^= Observation::SILHOUETTE;
    let difference = expected.difference(&found(&mut cpu, &changed, &poses));
    assert!(difference.is_some_and(|text| text.starts_with("image 0: ")), "a changed pixel passed");
    let mut moved = mesh.clone();
    moved.vertices.iter_mut().rev().take(5).for_each(|vertex| vertex.position.x += 60.0);
    let mut sabotaged = Cpu::of_mesh(&body, moved, &cameras).unwrap();
    assert!(expected.difference(&found(&mut sabotaged, &seen, &poses)).is_some(), "a moved vertex passed");

    let error = cpu.set_body(&body).unwrap_err().to_string();
    assert!(error.contains("bound to the body it was made with"), "{error}");
    let error = cpu.drawn(&poses[..body.dof_count()], 4).unwrap_err().to_string();
    assert!(error.contains("there are 4 views, and view 4 was asked for"), "{error}");
    let fewer = Body { bones: body.bones[..1].to_vec(), update_order: vec![0], parts: Vec::new(), ..body };
    let error = Cpu::of_mesh(&fewer, mesh, &cameras).unwrap_err().to_string();
    assert!(error.starts_with("the mesh is bound to 15 bones, the body "), "{error}");
}
