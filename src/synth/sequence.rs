//! A whole synthetic sequence: made from a scene, written as a folder that can be tracked and scored.

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use rayon::prelude::*;
use serde::Serialize;

use super::actor::Actor;
use super::gait::Gait;
use super::noise::Sensor;
use super::render::{PlacedActor, View};
use super::rig::four_cameras;
use super::room::Room;
use super::scene::Scene;
use crate::body::{Body, PoseTable};
use crate::files::{OutputFolder, Overwrite};
use crate::geometry::Camera;
use crate::motion::{PointTrajectory, write_points};
use crate::sequence::write_cameras_toml;

/// A scene with its exact truth, ready to be drawn.
#[derive(Clone, Debug)]
pub struct SyntheticSequence {
    scene: Scene,
    body: Body,
    cameras: Vec<Camera>,
    room: Room,
    poses: PoseTable,
}

/// sequence.toml as this room writes it.
#[derive(Serialize)]
struct Manifest<'a> {
    name: &'a str,
    fps: f64,
    cameras: &'a str,
    body: &'a str,
    start: &'a str,
    truth: &'a str,
    view: Vec<ManifestView<'a>>,
}

#[derive(Serialize)]
struct ManifestView<'a> {
    camera: &'a str,
    source: String,
    background: String,
}

impl<'a> ManifestView<'a> {
    fn of(camera: &'a Camera) -> Self {
        let name = &camera.name;
        Self { camera: name, source: format!("frames/{name}_%04d.png"), background: format!("plates/{name}.png") }
    }
}

impl SyntheticSequence {
    /// The default adult of the scene's height walking in a circle before four cameras.
    ///
    /// # Errors
    /// When a setting of the scene is out of range.
    pub fn new(scene: &Scene) -> Result<Self> {
        scene.check()?;
        let body = Body::adult(scene.height)?;
        let room = Room::default();
        let cameras = four_cameras(room.half_size, scene.size);
        let gait = Gait::new(&body, scene.circle_radius, scene.stride_time)?;
        let frames: Vec<usize> = (0..scene.frames).collect();
        let rows = frames.iter().map(|&frame| gait.pose(frame as f64 / scene.fps)).collect();
        Ok(Self { scene: scene.clone(), body, cameras, room, poses: PoseTable { frames, poses: rows } })
    }

    /// The tracker's body: the actor's bones with truncated cones round them.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The cameras, in the order of the views.
    pub fn cameras(&self) -> &[Camera] {
        &self.cameras
    }

    /// The true pose of every frame, mm and radians.
    pub fn poses(&self) -> &PoseTable {
        &self.poses
    }

    /// The true joints, as joints.csv has them.
    ///
    /// # Errors
    /// None is known: the poses fit the body.
    pub fn joints(&self) -> Result<PointTrajectory> {
        self.body.joint_trajectory(&self.poses, self.scene.fps)
    }

    /// Writes the sequence (INTERFACES, sequence.toml) with frames/, plates/ and its truth: truth.trc (joints),
    /// truth_markers.c3d, truth_poses.csv. sequence.toml comes last, so that a folder that has one is complete.
    /// `progress` is called with the number of frames done, from any thread.
    ///
    /// # Errors
    /// When a file cannot be written; the message names it.
    pub fn write(&self, folder: &OutputFolder, progress: &(dyn Fn(usize) + Sync)) -> Result<()> {
        let sensor = Sensor::new(self.scene.noise, self.scene.seed);
        let views: Vec<View> =
            self.cameras.par_iter().map(|camera| View::new(camera, &self.room)).collect::<Result<_>>()?;
        self.write_text_files(folder)?;
        for view in &views {
            let camera = view.camera();
            let path = folder.file(&format!("plates/{}.png", camera.name))?;
            write_png(&path, camera.size, &sensor.expose_clean(view.plate()))?;
        }
        let actor = Actor::new(&self.body, self.scene.height)?;
        let done = AtomicUsize::new(0);
        self.poses.poses.par_iter().enumerate().try_for_each(|(frame, pose)| -> Result<()> {
            let world_from_bones = self.body.world_from_bones(pose)?;
            let solids = actor.place(&world_from_bones);
            let placed = PlacedActor::new(&actor, &solids, &world_from_bones);
            for (index, view) in views.iter().enumerate() {
                let (light, _) = view.picture(&placed);
                let camera = view.camera();
                let path = folder.file(&format!("frames/{}_{frame:04}.png", camera.name))?;
                write_png(&path, camera.size, &sensor.expose(&light, index, frame))?;
            }
            progress(done.fetch_add(1, Ordering::Relaxed) + 1);
            Ok(())
        })?;
        let manifest = toml::to_string(&self.manifest()).context("cannot write sequence.toml")?;
        folder.write("sequence.toml", |writer| Ok(writer.write_all(manifest.as_bytes())?))
    }

    fn write_text_files(&self, folder: &OutputFolder) -> Result<()> {
        write_cameras_toml(&folder.file("cameras.toml")?, &self.cameras, Overwrite::Replace)?;
        self.body.save(&folder.file("body.toml")?, Overwrite::Replace)?;
        let first = PoseTable { frames: vec![0], poses: self.poses.poses[..1].to_vec() };
        first.write(&folder.file("start.csv")?, Overwrite::Replace, &self.body)?;
        self.poses.write(&folder.file("truth_poses.csv")?, Overwrite::Replace, &self.body)?;
        write_points(&folder.file("truth.trc")?, &self.joints()?, Overwrite::Replace)?;
        let markers = self.body.marker_trajectory(&self.poses, self.scene.fps)?;
        write_points(&folder.file("truth_markers.c3d")?, &markers, Overwrite::Replace)
    }

    fn manifest(&self) -> Manifest<'_> {
        Manifest {
            name: &self.scene.name,
            fps: self.scene.fps,
            cameras: "cameras.toml",
            body: "body.toml",
            start: "start.csv",
            truth: "truth.trc",
            view: self.cameras.iter().map(ManifestView::of).collect(),
        }
    }
}

/// Frames are many and can be made again: they are written straight, without the care taken for results.
fn write_png(path: &Path, size: [u32; 2], rgb: &[u8]) -> Result<()> {
    let mut bytes = Vec::with_capacity(rgb.len());
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Fast, FilterType::Sub)
        .write_image(rgb, size[0], size[1], ExtendedColorType::Rgb8)
        .and_then(|()| Ok(fs::write(path, &bytes)?))
        .with_context(|| format!("cannot write {}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn short() -> Scene {
        Scene { frames: 3, size: [240, 136], ..Scene::default() }
    }

    #[test]
    fn every_joint_is_drawn_where_the_cameras_see_it() {
        let sequence = SyntheticSequence::new(&Scene { frames: 40, ..Scene::default() }).unwrap();
        let actor = Actor::new(sequence.body(), 1750.0).unwrap();
        let joints = sequence.joints().unwrap();
        let view = View::new(&sequence.cameras()[1], &sequence.room).unwrap();
        for frame in [0, 13, 39] {
            let bones = sequence.body().world_from_bones(&sequence.poses().poses[frame]).unwrap();
            let solids = actor.place(&bones);
            let (light, coverage) = view.picture(&PlacedActor::new(&actor, &solids, &bones));
            let area = coverage.iter().filter(|&&quarters| quarters > 0).count();
            assert!((1500..12_000).contains(&area), "{area} pixels of a person");
            for (name, joint) in joints.names.iter().zip(&joints.frames[frame]) {
                let pixel = view.camera().project(joint.unwrap()).unwrap().round();
                assert!(pixel.min_element() >= 2.0 && pixel.x < 478.0 && pixel.y < 268.0, "{name} is in the picture");
                // The top of the head and the tips of limbs lie on the surface.
                let near = |&(dx, dy): &(i32, i32)| {
                    coverage[(pixel.y as i32 + dy) as usize * 480 + (pixel.x as i32 + dx) as usize] > 0
                };
                assert!(
                    [(0, 0), (0, 2), (1, 1), (-1, 1), (0, -2)].iter().any(near),
                    "{name} is on the actor, frame {frame}"
                );
            }
            // Away from the actor and his shadow the room is untouched.
            let untouched = light.iter().zip(view.plate()).filter(|(a, b)| a == b).count();
            assert!(untouched > light.len() / 3, "{untouched}");
        }
    }

    #[test]
    fn the_same_scene_gives_the_same_bytes_and_a_complete_folder() {
        let write = |scene: &Scene| {
            let folder = tempfile::tempdir().unwrap();
            let output = OutputFolder::create(folder.path(), Overwrite::Refuse).unwrap();
            SyntheticSequence::new(scene).unwrap().write(&output, &|_| {}).unwrap();
            folder
        };
        let (first, second) = (write(&short()), write(&short()));
        let other = write(&Scene { seed: 2, ..short() });
        for name in [
            "sequence.toml",
            "cameras.toml",
            "body.toml",
            "start.csv",
            "truth.trc",
            "truth_markers.c3d",
            "truth_poses.csv",
            "plates/cam3.png",
            "frames/cam4_0002.png",
        ] {
            let read = |folder: &tempfile::TempDir| fs::read(folder.path().join(name)).unwrap();
            assert_eq!(read(&first), read(&second), "{name}");
            assert_eq!(
                read(&first) == read(&other),
                !name.starts_with("frames"),
                "the seed changes frames alone: {name}"
            );
        }
        assert_eq!(fs::read_dir(first.path().join("frames")).unwrap().count(), 12);
    }

    #[test]
    fn the_folder_opens_as_a_sequence_with_the_same_cameras_and_truth() {
        let folder = tempfile::tempdir().unwrap();
        let output = OutputFolder::create(folder.path(), Overwrite::Refuse).unwrap();
        let synthetic = SyntheticSequence::new(&short()).unwrap();
        synthetic.write(&output, &|_| {}).unwrap();
        let sequence = crate::sequence::Sequence::open(folder.path()).unwrap();
        assert_eq!((sequence.frame_count, sequence.fps, sequence.views.len()), (3, 25.0, 4));
        let body = Body::load(&folder.path().join("body.toml")).unwrap();
        let poses = PoseTable::read(&folder.path().join("truth_poses.csv"), &body).unwrap();
        for (pose, exact) in poses.poses.iter().zip(&synthetic.poses().poses) {
            assert!(pose.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-9 * b.abs().max(1.0)));
        }
        let truth = crate::motion::read_points(&folder.path().join("truth.trc")).unwrap();
        let exact = synthetic.joints().unwrap();
        assert_eq!(truth.names, exact.names);
        for (camera, made) in sequence.cameras.iter().zip(synthetic.cameras()) {
            for (row, exact) in truth.frames.iter().flatten().zip(exact.frames.iter().flatten()) {
                let (read, exact) = (row.unwrap(), exact.unwrap());
                assert!(read.distance(exact) < 1e-3, "{read} {exact}");
                let pixels = (camera.project(read).unwrap(), made.project(exact).unwrap());
                assert!(pixels.0.distance(pixels.1) < 1e-3, "{pixels:?}");
            }
        }
    }
}
