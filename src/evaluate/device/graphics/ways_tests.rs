//! Ways to draw that are there to be compared: primitives of a geometry stage, which are those of vertices alone, and all channels at
//! once, which is wrong.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test stops at the first surprise, and prints")]

use super::Graphics;
use super::draw_mesh::with_neighbours;
use super::mesh_tests::{Scene, cameras, differences, ladder, person};
use super::settings::{Channels, Coverage, GraphicsSettings, Packing, Primitives};
use crate::body::{Body, Mesh};
use crate::evaluate::device::tests::{cameras as flat_cameras, device, poses};
use crate::evaluate::{CandidateImage, MeshProjector};
use crate::gpu::DeviceSettings;

#[test]
fn a_geometry_stage_finds_the_edges_that_a_compute_stage_lists() {
    let test = "a_geometry_stage_finds_the_edges_that_a_compute_stage_lists";
    let Some((device, log)) = device(test, DeviceSettings::default()) else { return };
    if !device.capabilities().geometry_shader {
        println!("SKIPPED {test}: this device has no geometry stage");
        return;
    }
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let poses = poses(&body, 30);
    let by_geometry = GraphicsSettings { primitives: Primitives::Geometry, ..GraphicsSettings::default() };
    for (name, mesh) in ladder(&body).into_iter().take(4).chain(person(test, &body)) {
        let projector = MeshProjector::new(&body, mesh.clone(), &cameras).unwrap();
        let scene = Scene::new(&device, &cameras, &body, &poses);
        let (listed, ..) = scene.pictures(&projector);
        let (found, ..) = scene.pictures_by(&projector, &by_geometry);
        let (mut edges, mut labels) = (0, 0);
        for (image, (found, listed)) in found.iter().zip(&listed).enumerate() {
            // Edges of two parts at one depth are drawn in no order where they are listed: labels are left open there, up to 170 of
            // 19,927 of a person whose parts meet.
            let [fill, edge, label] = differences(found, listed);
            assert_eq!([fill, edge], [0, 0], "{name}, image {image}");
            labels += label;
            edges += listed.bytes.iter().filter(|byte| **byte & 0x80 != 0).count();
        }
        println!("{name}: {labels} labels of {edges} edge pixels differ");
        assert!(edges > 1000 && labels * 50 <= edges, "{name}: {labels} of {edges}");
    }
    // One that is not there is missed.
    let mut mesh = Mesh::of_body(&body).unwrap();
    let (seen, _) = (mesh.edges.len(), mesh.edges.pop());
    let error = with_neighbours(&mesh).unwrap_err().to_string();
    assert!(seen > 100 && error.contains("has no neighbour"), "{error}");
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn all_channels_at_once_are_wrong_where_parts_and_candidates_overlap() {
    let name = "all_channels_at_once_are_wrong_where_parts_and_candidates_overlap";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), flat_cameras());
    let usual = GraphicsSettings { packing: Packing::Depth, coverage: Coverage::Hardware, ..Default::default() };
    let drawn = |body: &Body, settings: GraphicsSettings, poses: &[f32]| {
        let graphics = Graphics::on(&device, body, &cameras, settings).unwrap();
        assert_eq!(graphics.settings(), settings);
        graphics.pictures(poses).unwrap()
    };
    let at_once = GraphicsSettings { channels: Channels::AtOnce, ..usual };
    let pose: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
    let count = |found: &[CandidateImage], expected: &[CandidateImage]| {
        let pairs = || found.iter().zip(expected).flat_map(|(f, e)| f.bytes.iter().zip(&e.bytes));
        let silhouette = pairs().filter(|(f, e)| (**f == 0) != (**e == 0)).count();
        let hidden = pairs().filter(|(f, e)| **f & 0x80 == 0 && **e & 0x80 != 0).count();
        let labels = pairs().filter(|(f, e)| **f & 0x7f != **e & 0x7f).count();
        [silhouette, hidden, labels]
    };
    // A candidate alone: the largest label is shown where parts overlap, not the nearest, where a farther part comes before with it.
    let one = count(&drawn(&body, at_once, &pose), &drawn(&body, usual, &pose));
    assert_eq!(one, [0; 3], "labels grow in the order of drawing");
    let mut falling = body.clone();
    let labels: Vec<u8> = falling.parts.iter().rev().map(|part| part.label).collect();
    falling.parts.iter_mut().zip(labels).for_each(|(part, label)| part.label = label);
    let [silhouette, _, labels] = count(&drawn(&falling, at_once, &pose), &drawn(&falling, usual, &pose));
    assert!(silhouette == 0 && labels > 20, "{silhouette} {labels}");
    // Four of them in one place: the fills of the last hide the edges of all before it.
    let four = pose.repeat(4);
    let (found, expected) = (drawn(&body, at_once, &four), drawn(&body, usual, &four));
    let views = cameras.len();
    for candidate in 0..4 {
        let own = candidate * views..(candidate + 1) * views;
        let [silhouette, hidden, labels] = count(&found[own.clone()], &expected[own.clone()]);
        let edges = expected[own].iter().flat_map(|image| &image.bytes).filter(|byte| **byte & 0x80 != 0).count();
        println!("candidate {candidate}: silhouette {silhouette}, edges hidden {hidden} of {edges}, labels {labels}");
        assert_eq!(hidden * 4 > edges, candidate < 3, "candidate {candidate}: {hidden} of {edges} edge pixels hidden");
    }
    // What was not asked for to be wrong is right.
    let [silhouette, hidden, labels] = count(&drawn(&body, usual, &four), &expected);
    assert_eq!([silhouette, hidden, labels], [0; 3]);
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}
