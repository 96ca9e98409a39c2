//! The mesh model on the device against the reference: vertices alone, pictures pixel by pixel, and the whole backend. With
//! PANTIN_TEST_PICTURES=folder the pictures are written there, the device's beside the reference's beside where they differ.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use std::collections::BTreeMap;
use std::path::Path;

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::Graphics;
use super::drawn::Drawn;
use super::framebuffer::Framebuffer;
use super::passes::skin_by_feedback;
use super::readback::FramebufferCopy;
use super::settings::{
    Comparison, Gathering, GraphicsSettings, HostComparison, Packing, Primitives, Projection, Tiling,
};
use super::tiles::TileLayout;
use crate::body::{Body, FrustumBase, Mesh, Skinning};
use crate::evaluate::device::mesh::{DeviceMesh, MeshWorkspace, skin};
use crate::evaluate::device::passes;
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::tests::{device, fetch, poses, recorded_fitness};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::device_evaluator::DeviceEvaluator;
use crate::evaluate::shaders::layout;
use crate::evaluate::{
    CandidateImage, Components, EDGE_BIAS, Evaluator, MeshProjector, NEAR, NEAREST, Objective, Reference, compare,
};
use crate::features::Observation;
use crate::geometry::{BrownConrady, Camera, Lens, Tsai};
use crate::gpu::rough::{Change, rough};
use crate::gpu::{Capabilities, Device, DeviceSettings, Memory, Timing};

/// Two cameras, one of each lens, that see a person 200 pixels tall.
pub(super) fn cameras() -> Vec<Camera> {
    let tsai = Tsai { f: 8.0, kappa: -4e-4, centre: DVec2::new(140.0, 104.0), sx: 1.01, pitch: DVec2::splat(0.02) };
    let brown = BrownConrady {
        focal: DVec2::splat(450.0),
        centre: DVec2::new(155.0, 118.0),
        radial: [-0.1, 0.05, 0.0],
        tangential: [1e-3, -5e-4],
    };
    let eyes = [DVec3::new(4000.0, 0.0, 1500.0), DVec3::new(-3000.0, -2500.0, 1300.0)];
    [([310, 240], Lens::BrownConrady(brown)), ([287, 229], Lens::Tsai(tsai))]
        .into_iter()
        .zip(eyes)
        .map(|((size, lens), eye)| {
            let forward = (DVec3::new(0.0, 0.0, 900.0) - eye).normalize();
            let right = forward.cross(DVec3::Z).normalize();
            let rotation = DMat3::from_cols(right, forward.cross(right), forward).transpose();
            let camera_from_world = DAffine3::from_mat3_translation(rotation, -(rotation * eye));
            Camera { name: format!("{eye}"), size, camera_from_world, lens }
        })
        .collect()
}

pub(super) fn ladder(body: &Body) -> Vec<(String, Mesh)> {
    let elliptic = FrustumBase::LADDER.map(|vertices| FrustumBase::Elliptic { vertices });
    [FrustumBase::Square]
        .into_iter()
        .chain(elliptic)
        .map(|base| {
            let name = format!("{} {}", base.name(), base.vertices());
            (name, Mesh::frusta(body, base, &BTreeMap::new()).unwrap())
        })
        .collect()
}

/// The glTF person, rigid and smooth; none where the shared data are absent.
pub(super) fn person(test: &str, body: &Body) -> Vec<(String, Mesh)> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/mesh/human_male.glb"));
    if !path.exists() {
        println!("SKIPPED the glTF person of {test}: ../shared/data is absent");
        return Vec::new();
    }
    [Skinning::Rigid, Skinning::Smooth]
        .into_iter()
        .map(|skinning| {
            let mesh = Mesh::read(path, body, skinning, &BTreeMap::new()).unwrap();
            (format!("glTF {}", skinning.name()), mesh)
        })
        .collect()
}

/// Frusta whose vertices hang on two bones each.
fn bent(body: &Body) -> Mesh {
    let mut mesh = Mesh::of_body(body).unwrap();
    mesh.skinning = Skinning::Smooth;
    let bones = body.bones.len();
    for (index, vertex) in mesh.vertices.iter_mut().enumerate() {
        vertex.bones[1] = (index % bones) as u16;
        vertex.bones[3] = (index / 7 % bones) as u16;
        vertex.weights = [0.75, 0.125, 0.0, 0.125];
    }
    mesh
}

/// A device with the poses of a mesh's candidates on it.
pub(super) struct Scene {
    device: Device,
    model: DeviceScene,
    workspace: Workspace,
    share: Share,
}

impl Scene {
    pub(super) fn new(device: &Device, cameras: &[Camera], body: &Body, poses: &[f32]) -> Self {
        let model = DeviceScene::new(device, body, cameras).unwrap();
        let candidates = (poses.len() / body.dof_count()) as u32;
        let workspace = Workspace::new(device, model.counts, candidates).unwrap();
        let staging = device.buffer::<f32>("poses staging", poses.len(), Memory::Upload).unwrap();
        staging.write(0, poses).unwrap();
        let mut recorder = device.recorder(Timing::Off).unwrap();
        model.record_upload(&mut recorder).unwrap();
        recorder.copy("poses", (&staging, 0), (&workspace.poses, 0), staging.size()).unwrap();
        recorder.finish().unwrap().run().unwrap();
        let share = Share { first: 0, candidates };
        Self { device: device.clone(), model, workspace, share }
    }

    /// Every picture, `[candidate][view]`, in tiles as large as the pictures, and the framebuffer itself.
    pub(super) fn pictures(&self, projector: &MeshProjector) -> (Vec<CandidateImage>, Vec<u32>, [u32; 2]) {
        self.pictures_by(projector, &GraphicsSettings::default())
    }

    /// The same in a way of its own.
    pub(super) fn pictures_by(
        &self,
        projector: &MeshProjector,
        settings: &GraphicsSettings,
    ) -> (Vec<CandidateImage>, Vec<u32>, [u32; 2]) {
        let Self { device, model, workspace, share } = self;
        let mut drawn = Drawn::mesh(model, projector, settings).unwrap();
        drawn.reserve(model, share.candidates).unwrap();
        assert!(drawn.most() >= share.candidates);
        let tiles = TileLayout::new(&model.sizes, share.candidates, device.capabilities().max_image, u64::MAX).unwrap();
        assert_eq!(tiles.candidates, share.candidates);
        let framebuffer = Framebuffer::new(device, tiles, Packing::Depth, false).unwrap();
        let copy = FramebufferCopy::new(device, &framebuffer).unwrap();
        let mut recorder = device.recorder(Timing::Off).unwrap();
        drawn.record_upload(&mut recorder).unwrap();
        drawn.record(&mut recorder, (model, workspace), &framebuffer, *share).unwrap();
        copy.record(&mut recorder, &framebuffer).unwrap();
        let [width, height] = framebuffer.layout.size;
        let texels = device.buffer::<u32>("texels", (width * height) as usize, Memory::Readback).unwrap();
        recorder.read_image("texels", &framebuffer.colour, [0, 0, width, height], (&texels, 0)).unwrap();
        recorder.finish().unwrap().run().unwrap();
        let pictures = copy.read(&framebuffer, share.candidates).unwrap();
        let mut images = Vec::new();
        for candidate in 0..share.candidates {
            for (view, &size) in model.sizes.iter().enumerate() {
                let bytes = pictures.image(candidate, view, size);
                images.push(CandidateImage { width: size[0], height: size[1], bytes });
            }
        }
        let mut words = vec![0; (width * height) as usize];
        texels.read(0, &mut words).unwrap();
        (images, words, [width, height])
    }
}

#[test]
fn depths_are_those_of_the_definition() {
    assert_eq!([NEAR, EDGE_BIAS, NEAREST], [100.0, 30.0, 200.0]);
}

#[test]
fn vertices_are_the_reference_s() {
    for code in [None, Some(rough as Change)] {
        let settings = DeviceSettings { code, ..DeviceSettings::default() };
        let Some((device, log)) = device("vertices_are_the_reference_s", settings) else { return };
        check_vertices(&device, Projection::Compute);
        if device.capabilities().transform_feedback {
            check_vertices(&device, Projection::Feedback);
        } else {
            println!("SKIPPED transform feedback: this device has none");
        }
        drop(device);
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

fn check_vertices(device: &Device, projection: Projection) {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let poses = poses(&body, 30);
    let mut meshes = vec![("frusta".to_string(), Mesh::of_body(&body).unwrap()), ("bent".to_string(), bent(&body))];
    meshes.extend(person("vertices_are_the_reference_s", &body));
    for (name, mesh) in meshes {
        let projector = MeshProjector::new(&body, mesh, &cameras).unwrap();
        let scene = Scene::new(device, &cameras, &body, &poses);
        let Scene { model, workspace, share, .. } = &scene;
        let mesh = DeviceMesh::new(device, &projector).unwrap();
        let room = MeshWorkspace::new(device, model.counts, &mesh, (share.candidates, 0)).unwrap();
        let mut recorder = device.recorder(Timing::Off).unwrap();
        mesh.record_upload(&mut recorder).unwrap();
        passes::pose(&mut recorder, model, workspace, *share).unwrap();
        recorder.fill("clear", &room.seen, 0xdead_beef).unwrap();
        recorder.fill("clear", &workspace.bounds, 0xdead_beef).unwrap();
        let record = match projection {
            Projection::Compute => skin,
            Projection::Feedback => skin_by_feedback,
        };
        record(&mut recorder, (model, &mesh), (workspace, &room), *share).unwrap();
        recorder.finish().unwrap().run().unwrap();
        let (views, vertices) = (cameras.len(), mesh.vertex_count as usize);
        let images = share.candidates as usize * views;
        let seen: Vec<layout::Seen> = fetch(device, &room.seen, images * vertices);
        let bounds: Vec<layout::Bounds> = fetch(device, &workspace.bounds, images);
        let (mut all, mut without) = (0, 0);
        for image in 0..images {
            let (candidate, view) = (image / views, image % views);
            let expected = projector.vertices(&poses[candidate * body.dof_count()..][..body.dof_count()], view);
            let size = model.sizes[view].map(|side| side as i32);
            let (mut low, mut high) = (size, [0, 0]);
            for (found, expected) in seen[image * vertices..].iter().zip(&expected) {
                assert_eq!(found.depth != 4.0, expected.has_image, "{name}, image {image}: {found:?}");
                if !expected.has_image {
                    without += 1;
                    continue;
                }
                all += 1;
                assert_eq!(found.at, expected.at, "{name}, image {image}");
                assert_eq!(found.depth.to_bits(), expected.depth.to_bits(), "{name}, image {image}: {found:?}");
                assert_eq!(
                    found.edge_depth.to_bits(),
                    expected.edge_depth.to_bits(),
                    "{name}, image {image}: {found:?}"
                );
                for axis in 0..2 {
                    let rounded = (found.at[axis] + 128) >> 8;
                    low[axis] = low[axis].min(rounded.clamp(0, size[axis]));
                    high[axis] = high[axis].max((rounded + 1).clamp(0, size[axis]));
                }
            }
            assert_eq!((bounds[image].low, bounds[image].high), (low, high), "{name}, image {image}");
        }
        assert!(without > 0 && all > without, "{name}: {all} with an image, {without} without");
    }
}

pub(super) fn off(found: u32, expected: u32) -> f64 {
    f64::from(found.abs_diff(expected)) / f64::from(expected.max(1))
}

/// What is allowed of a device: one that snaps to less than 1/256 pixel moves every border a little. SwiftShader, at 1/16, is off by
/// up to 13 of 361 edge pixels, and by 0.0024 in fitness.
#[derive(Clone, Copy)]
pub(super) struct Tolerance {
    /// Pixels that small pictures may differ by.
    pub(super) pixels: u32,
    pub(super) fitness: f32,
    is_exact: bool,
}

impl Tolerance {
    pub(super) fn of(device: &Device) -> Self {
        if device.capabilities().sub_pixel_bits >= 8 {
            Self { pixels: 2, fitness: 1e-3, is_exact: true }
        } else {
            Self { pixels: 16, fitness: 5e-3, is_exact: false }
        }
    }

    /// Whether area and overlap are within 0.5 % and edges within 3 %; those of small pictures within a few pixels.
    fn allows(self, found: &Components, expected: &Components) -> bool {
        let near = |f: u32, e: u32, share: f64| f.abs_diff(e) <= self.pixels || off(f, e) <= share;
        found.area_obs == expected.area_obs
            && near(found.area_model, expected.area_model, 0.005)
            && near(found.overlap, expected.overlap, 0.005)
            && near(found.edges, expected.edges, 0.03)
    }
}

/// How far pictures are from the reference's, the worst of all.
#[derive(Debug, Default)]
struct Worst {
    images: usize,
    area: f64,
    overlap: f64,
    edges: f64,
    /// Pixels that are drawn in one alone, whose edge differs, whose label differs.
    pixels: [usize; 3],
    drawn: usize,
}

impl Worst {
    /// Takes in a picture; small ones may differ by a few pixels.
    fn meet(&mut self, [found, expected]: [&CandidateImage; 2], seen: &Observation, tolerance: Tolerance, what: &str) {
        let (f, e) = (compare(found, seen), compare(expected, seen));
        assert!(tolerance.allows(&f, &e), "{what}: {f:?} is not {e:?}");
        self.images += 1;
        if e.area_model > 400 {
            self.area = self.area.max(off(f.area_model, e.area_model));
            self.overlap = self.overlap.max(off(f.overlap, e.overlap));
            self.edges = self.edges.max(off(f.edges, e.edges));
        }
        for (f, e) in found.bytes.iter().zip(&expected.bytes) {
            self.drawn += usize::from(*e != 0);
            self.pixels[0] += usize::from((*f == 0) != (*e == 0));
            self.pixels[1] += usize::from(*f & 0x80 != *e & 0x80);
            self.pixels[2] += usize::from(*f & 0x7f != *e & 0x7f);
        }
    }
}

/// What the reference draws of a pose, as an observation with some proximity.
pub(super) fn observed(image: &CandidateImage) -> Observation {
    let bytes = image.bytes.iter().enumerate().map(|(index, &drawn)| {
        let silhouette = if drawn != 0 { Observation::SILHOUETTE } else { 0 };
        silhouette | (index as u32).wrapping_mul(2_654_435_761).to_be_bytes()[0] & Observation::PROXIMITY
    });
    Observation { bytes: bytes.collect(), ..Observation::empty(image.width, image.height) }
}

fn row<'a>(poses: &'a [f32], body: &Body, candidate: usize) -> &'a [f32] {
    &poses[candidate * body.dof_count()..][..body.dof_count()]
}

#[test]
fn pictures_are_the_reference_s_on_every_rung_and_of_a_person() {
    let test = "pictures_are_the_reference_s_on_every_rung_and_of_a_person";
    let Some((device, log)) = device(test, DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let poses = poses(&body, 9);
    let mut all = Worst::default();
    for (name, mesh) in ladder(&body).into_iter().chain(person(test, &body)) {
        let projector = MeshProjector::new(&body, mesh.clone(), &cameras).unwrap();
        let scene = Scene::new(&device, &cameras, &body, &poses);
        let (images, words, size) = scene.pictures(&projector);
        let reference = Reference::of_mesh(&body, mesh, &cameras).unwrap();
        let seen: Vec<Observation> =
            (0..2).map(|view| observed(&reference.draw(row(&poses, &body, 3), view))).collect();
        let mut worst = Worst::default();
        for (image, found) in images.iter().enumerate() {
            let (candidate, view) = (image / 2, image % 2);
            let expected = reference.draw(row(&poses, &body, candidate), view);
            if let Some(folder) = std::env::var_os("PANTIN_TEST_PICTURES") {
                save(Path::new(&folder), &format!("{name} {image}"), found, &expected);
            }
            for worst in [&mut worst, &mut all] {
                let what = format!("{name}, candidate {candidate}, view {view}");
                worst.meet([found, &expected], &seen[view], Tolerance::of(&device), &what);
            }
        }
        if let Some(folder) = std::env::var_os("PANTIN_TEST_PICTURES") {
            // Red, green and blue are the first three candidates of a tile, edges bright.
            let light = |byte: &u8| byte & 0x80 | (byte & 15) << 3;
            let rgb: Vec<u8> =
                words.iter().flat_map(|word| word.to_le_bytes()[..3].iter().map(light).collect::<Vec<_>>()).collect();
            let path = Path::new(&folder).join(format!("framebuffer {name}.png"));
            image::save_buffer(path, &rgb, size[0], size[1], image::ColorType::Rgb8).unwrap();
        }
        println!("{name}: {worst:?}");
    }
    println!("all: {all:?}");
    assert!(all.images >= 100);
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// Writes two pictures and their differences side by side.
fn save(folder: &Path, name: &str, found: &CandidateImage, expected: &CandidateImage) {
    let (width, height) = (found.width as usize, found.height as usize);
    let shade = |byte: u8| {
        if byte & 0x80 != 0 {
            255
        } else if byte == 0 {
            0
        } else {
            60 + byte * 6
        }
    };
    let mut bytes = Vec::new();
    for y in 0..height {
        let at = |x: usize| (found.bytes[y * width + x], expected.bytes[y * width + x]);
        bytes.extend((0..width).map(|x| shade(at(x).0)));
        bytes.extend((0..width).map(|x| shade(at(x).1)));
        bytes.extend((0..width).map(|x| if at(x).0 == at(x).1 { 0 } else { 255 }));
    }
    let path = folder.join(format!("{name}.png"));
    image::save_buffer(path, &bytes, 3 * found.width, found.height, image::ColorType::L8).unwrap();
}

/// Pictures of one candidate in four bytes: how many pixels differ in being drawn, in being an edge, in their label.
pub(super) fn differences(a: &CandidateImage, b: &CandidateImage) -> [usize; 3] {
    let count = |differs: fn(u8, u8) -> bool| a.bytes.iter().zip(&b.bytes).filter(|(a, b)| differs(**a, **b)).count();
    [count(|a, b| (a == 0) != (b == 0)), count(|a, b| (a ^ b) & 0x80 != 0), count(|a, b| (a ^ b) & 0x7f != 0)]
}

/// The standing pose, moved by so many mm along x and y.
pub(super) fn standing(body: &Body, x: f32, y: f32) -> Vec<f32> {
    let mut pose: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
    for (name, by) in [("pelvis.tx", x), ("pelvis.ty", y)] {
        pose[body.dof_index(name).unwrap()] += by;
    }
    pose
}

#[test]
fn channels_do_not_touch_each_other() {
    let Some((device, log)) = device("channels_do_not_touch_each_other", DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let projector = MeshProjector::new(&body, Mesh::of_body(&body).unwrap(), &cameras).unwrap();
    // In view 0, which looks from x = 4 m: the later the channel the nearer and larger, and in reverse.
    let distances = [-1500.0, -500.0, 500.0, 1500.0];
    for order in [[0, 1, 2, 3], [3, 2, 1, 0], [1, 3, 0, 2]] {
        let poses: Vec<f32> = order.iter().flat_map(|&place| standing(&body, distances[place], 0.0)).collect();
        let (together, ..) = Scene::new(&device, &cameras, &body, &poses).pictures(&projector);
        for candidate in 0..4 {
            let (alone, ..) = Scene::new(&device, &cameras, &body, row(&poses, &body, candidate)).pictures(&projector);
            for view in 0..2 {
                let [fill, edge, label] = differences(&together[2 * candidate + view], &alone[view]);
                // A channel's depths are rounded a bit coarser or finer than another's.
                assert!(fill == 0 && edge <= 1 && label <= 4, "{order:?} {candidate} {view}: {fill} {edge} {label}");
            }
        }
        if order == [0, 1, 2, 3] {
            // That it is a trap: fills of the next channel lie on edges of this one, and are nearer.
            for candidate in 0..3 {
                let (near, far) = (&together[2 * candidate + 2], &together[2 * candidate]);
                let lie_on = near.bytes.iter().zip(&far.bytes).filter(|(near, far)| **near != 0 && **far & 0x80 != 0);
                assert!(lie_on.count() > 50);
            }
        }
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn a_moved_vertex_is_noticed() {
    let Some((device, log)) = device("a_moved_vertex_is_noticed", DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mesh = Mesh::of_body(&body).unwrap();
    let reference = Reference::of_mesh(&body, mesh.clone(), &cameras).unwrap();
    let pose = standing(&body, 0.0, 0.0);
    // By so many mm, and whether the tolerance of pictures is left.
    for (by, leaves) in [(0.0, false), (30.0, false), (400.0, true)] {
        let mut moved = mesh.clone();
        moved.vertices[5].position.y += by;
        let projector = MeshProjector::new(&body, moved, &cameras).unwrap();
        let (images, ..) = Scene::new(&device, &cameras, &body, &pose).pictures(&projector);
        let expected = reference.draw(&pose, 0);
        let seen = observed(&expected);
        let tolerance = Tolerance::of(&device);
        assert!(!tolerance.is_exact || (differences(&images[0], &expected) == [0; 3]) == (by == 0.0), "moved by {by}");
        assert_eq!(!tolerance.allows(&compare(&images[0], &seen), &compare(&expected, &seen)), leaves, "moved by {by}");
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// Holds what the backend says of poses to the reference.
fn check_backend(graphics: &mut Graphics, reference: &mut Reference, poses: &[f32], what: &str) {
    let tolerance = Tolerance::of(graphics.device());
    let candidates = poses.len() / graphics.dof_count();
    let mut found = vec![Components::default(); candidates * graphics.view_count()];
    let mut expected = found.clone();
    graphics.components(poses, &mut found).unwrap();
    reference.components(poses, &mut expected).unwrap();
    let same = found.iter().zip(&expected).filter(|(found, expected)| found == expected).count();
    println!("{what}: {same} of {} images the same", found.len());
    for (image, (found, expected)) in found.iter().zip(&expected).enumerate() {
        assert!(tolerance.allows(found, expected), "{what}, image {image}: {found:?} is not {expected:?}");
    }
    let objective = Objective::default();
    let (mut f, mut e) = (vec![0.0; candidates], vec![0.0; candidates]);
    Evaluator::fitness(graphics, poses, &objective, &mut f).unwrap();
    reference.fitness(poses, &objective, &mut e).unwrap();
    for (found, expected) in f.iter().zip(&e) {
        assert!((found - expected).abs() <= tolerance.fitness, "{what}: fitness {found} is not {expected}");
    }
}

#[test]
fn the_backend_follows_the_reference_whatever_the_settings_and_limits() {
    let small: fn(&mut Capabilities) = |capabilities| {
        capabilities.max_storage = 400_000;
        capabilities.max_image = 1024;
        capabilities.geometry_shader = false;
        capabilities.subgroup_shuffle = false;
        capabilities.transform_feedback = false;
    };
    let test = "the_backend_follows_the_reference_whatever_the_settings_and_limits";
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mesh = Mesh::of_body(&body).unwrap();
    let mut reference = Reference::of_mesh(&body, mesh.clone(), &cameras).unwrap();
    let seen: Vec<Observation> =
        (0..2).map(|view| observed(&reference.draw(&standing(&body, 20.0, 10.0), view))).collect();
    reference.observe(&seen).unwrap();
    let close: Vec<f32> = (0..13_i8).flat_map(|i| standing(&body, f32::from(i) * 9.0 - 60.0, 25.0)).collect();
    let wild = poses(&body, 12);
    let (compute, feedback) = (Projection::Compute, Projection::Feedback);
    let (vertices, geometry) = (Primitives::Vertices, Primitives::Geometry);
    for (lower, comparison, tiling, projection, primitives) in [
        (None, Comparison::Device(Gathering::Texels), Tiling::Regions, compute, vertices),
        (None, Comparison::Device(Gathering::Subgroup), Tiling::Pictures, compute, geometry),
        (None, Comparison::Host(HostComparison::Simd), Tiling::Regions, feedback, vertices),
        (None, Comparison::Device(Gathering::Texels), Tiling::Regions, feedback, geometry),
        (Some(small), Comparison::Device(Gathering::Subgroup), Tiling::Regions, feedback, geometry),
    ] {
        let what = format!("{comparison:?}, {tiling:?}, {projection:?}, {primitives:?}, lowered {}", lower.is_some());
        let settings = DeviceSettings { lower, ..DeviceSettings::default() };
        let Some((device, log)) = device(test, settings) else { return };
        let settings = GraphicsSettings { comparison, tiling, projection, primitives, ..GraphicsSettings::default() };
        let mut graphics = Graphics::of_mesh(&device, &body, mesh.clone(), &cameras, settings).unwrap();
        assert_eq!(graphics.settings().packing, Packing::Depth);
        let found = (graphics.settings().projection, graphics.settings().primitives);
        let asked = settings.on(device.capabilities());
        assert_eq!(found, (asked.projection, asked.primitives));
        assert!(lower.is_none() || found == (compute, vertices), "{found:?}");
        graphics.observe(&seen).unwrap();
        // Close ones shrink the tiles, wild ones outgrow them.
        check_backend(&mut graphics, &mut reference, &close, &what);
        let (shrunk, _) = graphics.tiles();
        assert_eq!(shrunk[0][0] < 200, tiling == Tiling::Regions, "{shrunk:?}");
        check_backend(&mut graphics, &mut reference, &wild, &what);
        check_backend(&mut graphics, &mut reference, &close, &what);
        assert_eq!(graphics.tiles().1 < 13, lower.is_some(), "batches of {}", graphics.tiles().1);
        if lower.is_none() {
            let drawn = graphics.drawn(&close[..body.dof_count()], 1).unwrap().unwrap();
            let [fill, edge, _] = differences(&drawn, &reference.draw(&close[..body.dof_count()], 1));
            assert!(!Tolerance::of(&device).is_exact || fill + edge <= 1, "{fill}, {edge}");
        }
        let error = graphics.set_body(&body).unwrap_err().to_string();
        assert!(error.contains("bound to the body it was made with"), "{error}");
        drop((graphics, device));
        assert_eq!(log.messages(), Vec::<String>::new(), "{what}");
    }
}

#[test]
fn a_search_on_the_device_finds_every_image_placed() {
    let test = "a_search_on_the_device_finds_every_image_placed";
    let Some((device, log)) = device(test, DeviceSettings::default()) else { return };
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let mesh = Mesh::of_body(&body).unwrap();
    let mut reference = Reference::of_mesh(&body, mesh.clone(), &cameras).unwrap();
    let mut graphics = Graphics::of_mesh(&device, &body, mesh, &cameras, GraphicsSettings::default()).unwrap();
    let seen: Vec<Observation> =
        (0..2).map(|view| observed(&reference.draw(&standing(&body, 20.0, 10.0), view))).collect();
    reference.observe(&seen).unwrap();
    graphics.observe(&seen).unwrap();
    let close = standing(&body, 0.0, 0.0);
    Evaluator::fitness(&mut graphics, &close, &Objective::default(), &mut [0.0]).unwrap();
    // Recorded while tiles would be small, run with candidates all over the pictures.
    let wild = poses(&body, 9);
    graphics.reserve(9).unwrap();
    let found = recorded_fitness(&graphics, &Objective::default(), &wild, 9);
    let mut expected = vec![0.0; 9];
    reference.fitness(&wild, &Objective::default(), &mut expected).unwrap();
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() <= Tolerance::of(&device).fitness, "{found} is not {expected}");
    }
    drop((graphics, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}
