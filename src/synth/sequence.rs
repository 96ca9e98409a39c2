//! A whole synthetic sequence: made from a scene, written as a folder that can be tracked and scored.

use anyhow::{Context, Result, bail};
use rayon::prelude::*;

use super::build::{Build, body_of};
use super::device::DevicePainter;
use super::figure::{Figure, Wardrobe};
use super::manifest::{FileNames, Manifest};
use super::packing::PackedFinishes;
use super::performance::Performance;
use super::recording::{Advance, Shutter, Studio, shutters, write_picture};
use super::render::View;
use super::rig;
use super::room::Room;
use super::scene::{Scene, USUAL_SOFTNESS};
use crate::body::{Body, MeshSource, PoseTable, Skinning};
use crate::files::{Limit, OutputFolder, Overwrite};
use crate::geometry::Camera;
use crate::gpu::Device;
use crate::motion::{PointTrajectory, write_points};
use crate::sequence::write_cameras_toml;

/// The settings a folder was made with, in the folder.
const RECORD: &str = "scene.toml";
const SETTINGS: Limit = Limit { what: "a scene", most: 16 << 20 };

/// A skinned person, copied.
const PERSON: Limit = Limit { what: "a glTF file", most: 1 << 30 };

/// The markers of the smaller set, of the 39 of the Plug-in Gait set.
const FIFTEEN: [&str; 15] = [
    "LFHD", "C7", "STRN", "LSHO", "RSHO", "LELB", "RELB", "LWRA", "RWRA", "LASI", "RASI", "LKNE", "RKNE", "LANK",
    "RANK",
];

/// A scene with its exact truth, ready to be drawn.
#[derive(Debug)]
pub struct SyntheticSequence {
    scene: Scene,
    body: Body,
    cameras: Vec<Camera>,
    room: Room,
    figures: Vec<Figure>,
    performances: Vec<Performance>,
    shutters: Vec<Shutter>,
    poses: PoseTable,
}

impl SyntheticSequence {
    /// The default adult of each actor's height, doing what the scene asks for before its cameras.
    ///
    /// # Errors
    /// When a setting of the scene is out of range, a file it names cannot be read or does not fit, or an actor leaves the
    /// room.
    pub fn new(scene: &Scene) -> Result<Self> {
        scene.check()?;
        let room = Room::new(&scene.room)?;
        let cameras = rig::cameras(&scene.rig, &room)?;
        let shutters = shutters(scene, &cameras)?;
        let (mut figures, mut performances, mut tracked) = (Vec::new(), Vec::new(), None);
        for (index, actor) in scene.actor.iter().enumerate() {
            let number = || format!("actor {}", index + 1);
            let mut body = body_of(actor).with_context(number)?;
            let build = Build::of(actor).with_context(number)?;
            let wardrobe = Wardrobe::new(&actor.clothes).with_context(number)?;
            let figure = match &actor.mesh {
                None => Figure::of_solids(&body, actor.height, wardrobe),
                Some(file) => {
                    let (skinning, joints) = (Skinning::default(), Default::default());
                    body.mesh = Some(MeshSource::Skinned { file: file.clone(), skinning, joints });
                    Figure::of_mesh(&body, wardrobe)
                }
            };
            figures.push(figure.with_context(number)?.built(&build));
            if actor.own_bones || !actor.proportions.is_empty() {
                // Cones tell of the build, the file does not.
                body.mesh = None;
            }
            let performance = Performance::new(&body, &actor.motion, scene, &room).with_context(number)?;
            let poses = performance.poses(&body, scene, &room).with_context(number)?;
            performances.push(performance);
            tracked.get_or_insert((body, poses));
        }
        let Some((mut body, poses)) = tracked else { bail!("there is no [[actor]], expected one to track") };
        if scene.markers == FIFTEEN.len() {
            body.markers.retain(|marker| FIFTEEN.contains(&marker.name.as_str()));
        }
        let poses = PoseTable { frames: (0..scene.frames).collect(), poses };
        Ok(Self { scene: scene.clone(), body, cameras, room, figures, performances, shutters, poses })
    }

    /// The tracker's body: the first actor's bones with truncated cones round them.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The cameras, in the order of the views.
    pub fn cameras(&self) -> &[Camera] {
        &self.cameras
    }

    /// Whether a device can draw it.
    ///
    /// # Errors
    /// When someone wears a material that is drawn on the processor alone; one sentence that names both.
    pub fn check_for_device(&self) -> Result<()> {
        let light = &self.scene.light;
        if light.lamps.len() > 1 || light.softness != USUAL_SOFTNESS {
            bail!("[light]: several lamps, and shadows of another softness, are drawn on the processor alone");
        }
        PackedFinishes::new(&self.figures).map(|_| ())
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

    /// Writes the sequence (FORMATS, sequence.toml) with its pictures, plates/ and its truth: truth.trc (joints), truth.c3d
    /// (markers), truth_poses.csv; dropped.csv where cameras drop frames; scene.toml, which makes it again. sequence.toml
    /// comes last, so that a folder that has one is complete. With `resume` the pictures that are there are kept.
    /// A `device` draws the pictures instead of the
    /// processor, nearly the same ones; plates and truth are the processor's all the same.
    ///
    /// # Errors
    /// When a file cannot be written (the message names it), `progress` says so, the folder to resume was made with other settings, or the device
    /// fails or cannot draw what someone wears ([`Self::check_for_device`]).
    pub fn write(
        &self,
        folder: &OutputFolder,
        resume: bool,
        device: Option<&Device>,
        progress: &Advance<'_>,
    ) -> Result<()> {
        self.write_as(&FileNames::default(), folder, resume, device, progress)
    }

    /// Whether a folder that nothing was ever replaced in holds all of it: the manifest is written last.
    ///
    /// # Errors
    /// When the settings that the folder was made with cannot be read.
    pub fn is_written(&self, folder: &OutputFolder) -> Result<bool> {
        if !folder.path().join(FileNames::default().manifest).is_file() {
            return Ok(false);
        }
        let record = toml::to_string(&self.scene).context("cannot write the scene's settings")?;
        Ok(SETTINGS.read_text(&folder.path().join(RECORD))? == record)
    }

    /// [`Self::write`] with other names of the files that belong to the truth.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub(crate) fn write_as(
        &self,
        names: &FileNames<'_>,
        folder: &OutputFolder,
        resume: bool,
        device: Option<&Device>,
        progress: &Advance<'_>,
    ) -> Result<()> {
        let record = toml::to_string(&self.scene).context("cannot write the scene's settings")?;
        if resume {
            let path = folder.path().join(RECORD);
            let before = SETTINGS.read_text(&path).with_context(|| {
                format!("cannot read {}, expected a folder that was begun to be made", path.display())
            })?;
            if before != record {
                bail!("{} has other settings than this scene, expected the same to go on with", path.display());
            }
        }
        folder.write(RECORD, |writer| Ok(writer.write_all(record.as_bytes())?))?;
        let views: Vec<View> =
            self.cameras.par_iter().map(|camera| View::new(camera, &self.room)).collect::<Result<_>>()?;
        self.write_text_files(names, folder)?;
        let studio = Studio {
            scene: &self.scene,
            figures: &self.figures,
            performances: &self.performances,
            views: &views,
            shutters: &self.shutters,
            painter: device.map(|device| DevicePainter::new(device, &views, &self.figures)).transpose()?,
        };
        for (index, camera) in self.cameras.iter().enumerate() {
            let path = folder.file(&format!("plates/{}.png", camera.name))?;
            write_picture(&path, camera.size, &studio.plate(index), self.scene.output.quality)?;
        }
        studio.record(folder, resume, progress)?;
        self.write_manifest(names, folder)
    }

    /// Writes a manifest that names a body and a start pose.
    ///
    /// # Errors
    /// When it cannot be written.
    pub(crate) fn write_manifest(&self, names: &FileNames<'_>, folder: &OutputFolder) -> Result<()> {
        let manifest =
            toml::to_string(&Manifest::new(&self.scene, &self.cameras, names)).context("cannot write the manifest")?;
        folder.write(names.manifest, |writer| Ok(writer.write_all(manifest.as_bytes())?))
    }

    fn write_text_files(&self, names: &FileNames<'_>, folder: &OutputFolder) -> Result<()> {
        write_cameras_toml(&folder.file("cameras.toml")?, &self.cameras, Overwrite::Replace)?;
        let mut body = self.body.clone();
        if let Some(MeshSource::Skinned { file, .. }) = &mut body.mesh {
            // The folder is complete by itself.
            let bytes = PERSON.read(file)?;
            folder.write("person.glb", |writer| Ok(writer.write_all(&bytes)?))?;
            *file = "person.glb".into();
        }
        body.save(&folder.file(names.body)?, Overwrite::Replace)?;
        let first = PoseTable { frames: vec![0], poses: self.poses.poses[..1].to_vec() };
        first.write(&folder.file(names.start)?, Overwrite::Replace, &self.body)?;
        self.poses.write(&folder.file("truth_poses.csv")?, Overwrite::Replace, &self.body)?;
        write_points(&folder.file("truth.trc")?, &self.joints()?, Overwrite::Replace)?;
        let markers = self.body.marker_trajectory(&self.poses, self.scene.fps)?;
        write_points(&folder.file("truth.c3d")?, &markers, Overwrite::Replace)?;
        if self.shutters.iter().any(|shutter| shutter.dropped().next().is_some()) {
            folder.write("dropped.csv", |writer| {
                writeln!(writer, "camera,frame")?;
                for (camera, shutter) in self.cameras.iter().zip(&self.shutters) {
                    for frame in shutter.dropped() {
                        writeln!(writer, "{},{frame}", camera.name)?;
                    }
                }
                Ok(())
            })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    use super::super::render::Cast;
    use super::super::scene::{ActorSettings, CameraSettings, Gait, MotionSettings, PictureForm};

    fn short() -> Scene {
        let mut scene = Scene { frames: 3, ..Scene::default() };
        scene.rig.size = [240, 136];
        scene
    }

    fn write(scene: &Scene) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let output = OutputFolder::create(folder.path(), Overwrite::Refuse).unwrap();
        SyntheticSequence::new(scene).unwrap().write(&output, false, None, &|_| Ok(())).unwrap();
        folder
    }

    /// Whether joints and markers are drawn where the cameras see them. Markers lie on the skin of cones, which is near
    /// that of ellipsoids: within a few pixels.
    fn check_truth(scene: &Scene, frames: &[usize]) {
        let sequence = SyntheticSequence::new(scene).unwrap();
        let joints = sequence.joints().unwrap();
        let markers = sequence.body.marker_trajectory(&sequence.poses, scene.fps).unwrap();
        let view = View::new(&sequence.cameras()[1], &sequence.room).unwrap();
        let [width, height] = view.camera().size.map(|side| side as i32);
        for &frame in frames {
            let pose = &sequence.poses().poses[frame];
            let figures = [sequence.figures[0].place(pose).unwrap()];
            let cast = Cast::new(&figures, scene.light.position.map(glam::DVec3::from)).unwrap();
            let (light, coverage) = view.picture(&cast);
            let area = coverage.iter().filter(|&&quarters| quarters > 0).count();
            assert!((1500..22_000).contains(&area), "{area} pixels of a person");
            let on_actor = |at: glam::DVec3, reach: i32| {
                let pixel = view.camera().project(at).unwrap().round();
                let (x, y) = (pixel.x as i32, pixel.y as i32);
                (-reach..=reach).any(|dy| {
                    (-reach..=reach).any(|dx| {
                        let (x, y) = (x + dx, y + dy);
                        x >= 0 && y >= 0 && x < width && y < height && coverage[(y * width + x) as usize] > 0
                    })
                })
            };
            for (points, reach) in [(&joints, 2), (&markers, 4)] {
                for (name, point) in points.names.iter().zip(&points.frames[frame]) {
                    assert!(on_actor(point.unwrap(), reach), "{name} is on the actor, frame {frame}");
                }
            }
            assert!(!on_actor(glam::DVec3::new(pose[0] + 900.0, pose[1], 1000.0), 1), "and nothing is beside him");
            // Away from the actor and his shadow the room is untouched.
            let untouched = light.iter().zip(view.plate()).filter(|(a, b)| a == b).count();
            assert!(untouched > light.len() / 3, "{untouched}");
        }
    }

    #[test]
    fn every_joint_and_marker_is_drawn_where_the_cameras_see_it() {
        check_truth(&Scene { frames: 40, ..Scene::default() }, &[0, 13, 39]);
    }

    #[test]
    fn a_skinned_person_is_drawn_where_the_cameras_see_him() {
        let file = std::path::PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/mesh/human_male.glb"));
        if !file.is_file() {
            println!("SKIPPED a_skinned_person_is_drawn_where_the_cameras_see_him: ../shared/data is absent");
            return;
        }
        let actor = ActorSettings { mesh: Some(file), ..ActorSettings::default() };
        check_truth(&Scene { frames: 20, actor: vec![actor], ..Scene::default() }, &[7]);
        let nobody = ActorSettings { mesh: Some("nobody.glb".into()), ..ActorSettings::default() };
        let error = SyntheticSequence::new(&Scene { actor: vec![nobody], ..Scene::default() }).unwrap_err();
        assert!(format!("{error:#}").contains("nobody.glb"), "{error:#}");
    }

    #[test]
    fn the_same_scene_gives_the_same_bytes_and_a_complete_folder() {
        let (first, second) = (write(&short()), write(&short()));
        let other = write(&Scene { seed: 2, ..short() });
        // One thread does as many do.
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(|| write(&short()));
        for name in [
            "sequence.toml",
            "cameras.toml",
            "body.toml",
            "start.csv",
            "truth.trc",
            "truth.c3d",
            "truth_poses.csv",
            "plates/cam3.png",
            "frames/cam4_0002.png",
        ] {
            let read = |folder: &tempfile::TempDir| fs::read(folder.path().join(name)).unwrap();
            assert_eq!(read(&first), read(&second), "{name}");
            assert_eq!(read(&first), read(&alone), "{name}");
            assert_eq!(
                read(&first) == read(&other),
                !name.starts_with("frames"),
                "the seed changes frames alone: {name}"
            );
        }
        assert_eq!(fs::read_dir(first.path().join("frames")).unwrap().count(), 12);
        assert!(!first.path().join("dropped.csv").exists());
    }

    #[test]
    fn the_folder_opens_as_a_sequence_with_the_same_cameras_and_truth() {
        let folder = write(&short());
        let synthetic = SyntheticSequence::new(&short()).unwrap();
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

    #[test]
    fn dropped_frames_repeat_and_late_cameras_show_what_comes() {
        let camera = |name: &str| CameraSettings { name: name.into(), ..CameraSettings::default() };
        let mut scene = short();
        scene.frames = 5;
        scene.sensor.noise = 0.0;
        scene.camera = vec![
            CameraSettings { dropped: vec![2, 3], ..camera("cam2") },
            CameraSettings { shift: Some(1.0), ..camera("cam3") },
        ];
        let folder = write(&scene);
        let plain = write(&Scene { camera: Vec::new(), ..scene.clone() });
        let read = |folder: &tempfile::TempDir, name: &str| fs::read(folder.path().join("frames").join(name)).unwrap();
        assert_eq!(read(&folder, "cam2_0002.png"), read(&plain, "cam2_0001.png"));
        assert_eq!(read(&folder, "cam2_0003.png"), read(&plain, "cam2_0001.png"));
        assert_eq!(read(&folder, "cam2_0004.png"), read(&plain, "cam2_0004.png"));
        assert_eq!(read(&folder, "cam3_0001.png"), read(&plain, "cam3_0002.png"));
        assert_eq!(read(&folder, "cam1_0003.png"), read(&plain, "cam1_0003.png"));
        assert_eq!(fs::read_to_string(folder.path().join("dropped.csv")).unwrap(), "camera,frame\ncam2,2\ncam2,3\n");
        let many =
            Scene { frames: 400, camera: vec![CameraSettings { drop_rate: Some(0.25), ..camera("cam1") }], ..short() };
        let count = shutters(&many, SyntheticSequence::new(&short()).unwrap().cameras()).unwrap()[0].dropped().count();
        assert!((70..130).contains(&count), "{count} of 400 dropped");
        let unknown = Scene { camera: vec![camera("cam9")], ..short() };
        let error = SyntheticSequence::new(&unknown).unwrap_err().to_string();
        assert!(error.contains("`cam9`, expected one of cam1, cam2"), "{error}");
        let twice = Scene { camera: vec![camera("cam1"), camera("cam1")], ..short() };
        assert!(SyntheticSequence::new(&twice).unwrap_err().to_string().contains("is there twice"));
    }

    #[test]
    fn blur_gain_grey_jpeg_masks_and_a_bystander() {
        let mut scene = short();
        scene.frames = 2;
        scene.sensor.grey = true;
        scene.sensor.exposure = 30.0;
        scene.light.swing = 0.4;
        scene.output.pictures = PictureForm::Jpeg;
        scene.output.masks = true;
        let stand = MotionSettings { gait: Some(Gait::Stand), at: [-900.0, 900.0], ..MotionSettings::default() };
        scene.actor.push(ActorSettings { motion: stand, ..ActorSettings::default() });
        let folder = write(&scene);
        let sequence = crate::sequence::Sequence::open(folder.path()).unwrap();
        assert!(sequence.views.iter().all(|view| view.mask.is_some() && view.background.is_some()));
        let open = |name: &str| image::open(folder.path().join(name)).unwrap();
        assert_eq!(open("frames/cam1_0001.jpg").color(), image::ColorType::L8);
        let mask = open("masks/cam1_0001.png").to_luma8();
        let area = mask.pixels().filter(|pixel| pixel.0[0] == 255).count();
        assert!(mask.pixels().all(|pixel| [0, 255].contains(&pixel.0[0])) && (300..4000).contains(&area), "{area}");
        // The bystander is in the picture, not in the mask.
        scene.actor.pop();
        let alone = write(&scene);
        assert_ne!(
            fs::read(folder.path().join("frames/cam1_0001.jpg")).unwrap(),
            fs::read(alone.path().join("frames/cam1_0001.jpg")).unwrap()
        );
        let other = image::open(alone.path().join("masks/cam1_0001.png")).unwrap().to_luma8();
        assert!(other.pixels().filter(|pixel| pixel.0[0] == 255).count() >= area);
        // A sharp picture differs from a blurred one.
        scene.sensor.exposure = 0.0;
        let sharp = write(&scene);
        assert_ne!(
            fs::read(sharp.path().join("frames/cam1_0001.jpg")).unwrap(),
            fs::read(alone.path().join("frames/cam1_0001.jpg")).unwrap()
        );
    }

    #[test]
    fn a_killed_run_goes_on_and_other_settings_do_not() {
        let folder = write(&short());
        let output = OutputFolder::open(folder.path()).unwrap();
        let frame = folder.path().join("frames/cam2_0001.png");
        let (whole, kept) = (fs::read(&frame).unwrap(), folder.path().join("frames/cam1_0001.png"));
        fs::remove_file(&frame).unwrap();
        fs::write(&kept, b"kept").unwrap();
        SyntheticSequence::new(&short()).unwrap().write(&output, true, None, &|_| Ok(())).unwrap();
        assert_eq!(fs::read(&frame).unwrap(), whole);
        assert_eq!(fs::read(&kept).unwrap(), b"kept", "what is there is not made again");
        let other = SyntheticSequence::new(&Scene { seed: 7, ..short() }).unwrap();
        let again = SyntheticSequence::new(&short()).unwrap();
        assert!(again.is_written(&output).unwrap() && !other.is_written(&output).unwrap());
        let error = other.write(&output, true, None, &|_| Ok(())).unwrap_err().to_string();
        assert!(error.contains("scene.toml has other settings"), "{error}");
        let empty = tempfile::tempdir().unwrap();
        assert!(!other.is_written(&OutputFolder::open(empty.path()).unwrap()).unwrap());
        let error = other.write(&OutputFolder::open(empty.path()).unwrap(), true, None, &|_| Ok(())).unwrap_err();
        assert!(format!("{error:#}").contains("expected a folder that was begun"), "{error:#}");
    }

    #[test]
    fn presets_are_made_at_two_frames() {
        for (name, markers, size, views) in [
            ("leewalk", 15, [640, 480], 4),
            ("p1s", 39, [480, 270], 4),
            ("p2s", 39, [480, 270], 4),
            ("p1d", 39, [480, 270], 4),
            ("p2d", 39, [480, 270], 4),
            ("two_straight", 39, [480, 270], 4),
            ("two_diagonal", 39, [480, 270], 4),
        ] {
            let scene = Scene { frames: 2, ..Scene::preset(name).unwrap() };
            let folder = write(&scene);
            let sequence = crate::sequence::Sequence::open(folder.path()).unwrap();
            assert_eq!((sequence.frame_count, sequence.views.len(), sequence.sizes[0]), (2, views, size), "{name}");
            let truth = crate::motion::read_points(&folder.path().join("truth.c3d")).unwrap();
            assert_eq!((truth.names.len(), truth.frames.len(), truth.rate), (markers, 2, scene.fps), "{name}");
            let picture = image::open(folder.path().join("frames/cam1_0001.png")).unwrap();
            assert_eq!(picture.color().has_color(), name != "leewalk", "{name}");
            assert_eq!(sequence.features, scene.features, "{name}");
            // The whole length stays in the room.
            SyntheticSequence::new(&Scene::preset(name).unwrap()).unwrap();
        }
    }
}
