//! What a synthetic sequence shows: the settings, as scene.toml has them.

mod checks;
mod choices;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

pub use self::choices::{Gait, Garment, LensKind, MotionUnit, PictureForm, RigKind, ScenePreset};
use super::finish::{FinishParameters, FinishSettings};
use crate::files::{parse_toml, read_toml};
use crate::motion::UpAxis;

/// Settings of a synthetic sequence. Everything in it follows from these and the files they name, bit for bit.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Scene {
    /// Name of the sequence.
    pub name: String,
    /// Number of frames.
    pub frames: usize,
    /// Frames a second.
    pub fps: f64,
    /// Seed of noise and of what is dropped at random.
    pub seed: u64,
    /// Number of virtual markers on the tracked body: 39 (Plug-in Gait) or 15 of them.
    pub markers: usize,
    /// The room.
    pub room: RoomSettings,
    /// The light.
    pub light: LightSettings,
    /// How the cameras stand.
    pub rig: RigSettings,
    /// What all cameras' sensors do.
    pub sensor: SensorSettings,
    /// What is written.
    pub output: OutputSettings,
    /// The people, the tracked one first. A file says who.
    #[serde(default = "Vec::new")]
    pub actor: Vec<ActorSettings>,
    /// What single cameras do otherwise.
    pub camera: Vec<CameraSettings>,
    /// `[features]` of the sequence.toml that is written: how its pictures are told from the plates.
    pub features: Option<toml::Table>,
}

/// `[room]`: it lies round the origin, its floor at z = 0.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct RoomSettings {
    /// Extent along x and y, mm.
    pub size: [f64; 2],
    /// Height of the ceiling, mm.
    pub height: f64,
    /// Radius of the round rug in the middle, mm; 0 for none.
    pub rug: f64,
    /// The floor, instead of stone tiles.
    pub floor: Option<FinishSettings>,
    /// The walls, instead of panels and paper; door, window and pictures stay.
    pub walls: Option<FinishSettings>,
}

/// `[light]`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct LightSettings {
    /// Where the lamp hangs, mm; without one light falls from far away.
    pub position: Option<[f64; 3]>,
    /// Several lamps of equal strength instead, mm.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lamps: Vec<[f64; 3]>,
    /// How wide lamps are: times that the shadow on the floor is blurred.
    #[serde(skip_serializing_if = "is_usual_softness")]
    pub softness: u32,
    /// By which fraction all light grows and shrinks.
    pub swing: f64,
    /// How long that takes, s.
    pub period: f64,
}

/// `[rig]`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct RigSettings {
    /// How they stand.
    pub preset: RigKind,
    /// Number of cameras of a ring.
    pub count: usize,
    /// A calibration instead of a preset.
    pub cameras: Option<PathBuf>,
    /// Size of the pictures of a preset, pixels.
    pub size: [u32; 2],
    /// Lens of a preset.
    pub lens: LensKind,
    /// Factor on the focal length of a preset.
    pub zoom: f64,
    /// The cameras one by one instead of a preset, named cam1 and so on.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub station: Vec<StationSettings>,
}

/// `[[rig.station]]`: one camera.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct StationSettings {
    /// Where it stands, mm.
    pub at: [f64; 3],
    /// What it looks at, mm.
    pub towards: [f64; 3],
    /// By how much it is turned about its axis, degrees.
    #[serde(default)]
    pub roll: f64,
    /// Focal length, pixels.
    pub focal: f64,
    /// By how much the principal point is off the picture's middle, pixels.
    #[serde(default)]
    pub centre: [f64; 2],
    /// k1 k2
    #[serde(default)]
    pub radial: [f64; 2],
    /// p1 p2
    #[serde(default)]
    pub tangential: [f64; 2],
}

/// `[sensor]`, for all cameras.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct SensorSettings {
    /// Grey pictures.
    pub grey: bool,
    /// Standard deviation of the noise in bright places, grey levels of 255.
    pub noise: f64,
    /// Factor on the light; above 1 bright places saturate.
    pub gain: f64,
    /// How long the shutter is open around a frame's time, ms.
    pub exposure: f64,
    /// Pictures that are averaged while it is.
    pub sub_frames: usize,
}

/// `[[camera]]`: what one camera does otherwise.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct CameraSettings {
    /// Its name.
    pub name: String,
    /// Instead of the sensor's.
    pub noise: Option<f64>,
    /// Instead of the sensor's.
    pub gain: Option<f64>,
    /// Instead of the sensor's.
    pub exposure: Option<f64>,
    /// Frames it drops: the picture before is recorded once more.
    #[serde(default)]
    pub dropped: Vec<usize>,
    /// Share of frames it drops at random.
    pub drop_rate: Option<f64>,
    /// Frames by which it is late against the others (it shows what they show so many frames later; fractions count).
    pub shift: Option<f64>,
}

/// `[output]`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct OutputSettings {
    /// How pictures are kept.
    pub pictures: PictureForm,
    /// Quality of JPEG pictures, 1 to 100.
    pub quality: u8,
    /// Constant rate factor of videos: 0 loses nothing, 51 most.
    pub crf: u8,
    /// Write the tracked person's silhouettes too.
    pub masks: bool,
    /// Colour has half the resolution of brightness, as in videos.
    #[serde(skip_serializing_if = "is_off")]
    pub half_chroma: bool,
}

/// `[[actor]]`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ActorSettings {
    /// Height, mm.
    pub height: f64,
    /// A skinned glTF person instead of ellipsoids and capsules.
    pub mesh: Option<PathBuf>,
    /// Bones as the mesh has them, instead of the default body's.
    #[serde(skip_serializing_if = "is_off")]
    pub own_bones: bool,
    /// Sleeves reach the wrists.
    #[serde(skip_serializing_if = "is_off")]
    pub long_sleeves: bool,
    /// Trousers end at the knees.
    #[serde(skip_serializing_if = "is_off")]
    pub shorts: bool,
    /// What the actor does.
    pub motion: MotionSettings,
    /// Factors on the bones' lengths and the girths round them, by the names of [`crate::body::Proportions`].
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub proportions: BTreeMap<String, f64>,
    /// Clothes by part: skin, hair, shirt, trousers, shoes.
    pub clothes: BTreeMap<String, FinishSettings>,
}

/// `[actor.motion]`: a built-in gait or a file.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct MotionSettings {
    /// How the actor moves, without a file.
    pub gait: Option<Gait>,
    /// Radius of the circle, mm.
    pub radius: f64,
    /// Seconds for a stride, that is two steps; a run takes 0.6 of it. Seconds from jump to jump are twice that.
    pub stride_time: f64,
    /// Height of a jump, mm.
    pub jump_height: f64,
    /// Where the middle of the way is, mm.
    pub at: [f64; 2],
    /// Where a line leads or a person faces, degrees to the left of +x.
    pub heading: Option<f64>,
    /// Seconds into the motion at the first frame.
    pub start: f64,
    /// A recorded motion: .bvh, .amc or a DeepMimic clip.
    pub file: Option<PathBuf>,
    /// The .asf of an .amc, or the character file of a DeepMimic clip.
    pub skeleton: Option<PathBuf>,
    /// Frames a second of an .amc, which does not say it.
    pub rate: Option<f64>,
    /// Unit of the file, where it cannot be found out.
    pub unit: Option<MotionUnit>,
    /// Which way is up in the file, where it cannot be found out.
    pub up: Option<UpAxis>,
    /// Second at which to stop.
    pub until: Option<f64>,
    /// Begin again where the motion ends, from the place it has reached.
    pub repeats: bool,
    /// Left and right of the file change places.
    #[serde(skip_serializing_if = "is_off")]
    pub mirrored: bool,
    /// How many times as fast as the file it is played.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// Names of the file's joints by bones of the body, where the names themselves do not tell.
    pub joints: BTreeMap<String, String>,
}

/// Times that the shadow on the floor is blurred where a scene does not say.
pub(in crate::synth) const USUAL_SOFTNESS: u32 = 3;

// Settings that say nothing are left out of the record, so that folders begun before there were any go on.
fn is_usual_softness(softness: &u32) -> bool {
    *softness == USUAL_SOFTNESS
}

fn is_off(switch: &bool) -> bool {
    !switch
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            name: "scene".to_string(),
            frames: 100,
            fps: 25.0,
            seed: 1,
            markers: 39,
            room: RoomSettings::default(),
            light: LightSettings::default(),
            rig: RigSettings::default(),
            sensor: SensorSettings::default(),
            output: OutputSettings::default(),
            actor: vec![ActorSettings::default()],
            camera: Vec::new(),
            features: None,
        }
    }
}

impl Default for RoomSettings {
    fn default() -> Self {
        Self { size: [7200.0, 6200.0], height: 2800.0, rug: 1500.0, floor: None, walls: None }
    }
}

impl Default for LightSettings {
    fn default() -> Self {
        Self { position: None, lamps: Vec::new(), softness: USUAL_SOFTNESS, swing: 0.0, period: 4.0 }
    }
}

impl Default for RigSettings {
    fn default() -> Self {
        Self {
            preset: RigKind::default(),
            count: 4,
            cameras: None,
            size: [480, 270],
            lens: LensKind::default(),
            zoom: 1.0,
            station: Vec::new(),
        }
    }
}

impl Default for SensorSettings {
    fn default() -> Self {
        Self { grey: false, noise: 2.5, gain: 1.0, exposure: 0.0, sub_frames: 5 }
    }
}

impl Default for OutputSettings {
    fn default() -> Self {
        Self { pictures: PictureForm::default(), quality: 90, crf: 18, masks: false, half_chroma: false }
    }
}

impl Default for ActorSettings {
    fn default() -> Self {
        Self {
            height: 1750.0,
            mesh: None,
            own_bones: false,
            long_sleeves: false,
            shorts: false,
            motion: MotionSettings::default(),
            proportions: BTreeMap::new(),
            clothes: BTreeMap::new(),
        }
    }
}

impl Default for MotionSettings {
    fn default() -> Self {
        Self {
            gait: None,
            radius: 950.0,
            stride_time: 1.2,
            jump_height: 320.0,
            at: [0.0, 0.0],
            heading: None,
            start: 0.0,
            file: None,
            skeleton: None,
            rate: None,
            unit: None,
            up: None,
            until: None,
            repeats: false,
            mirrored: false,
            speed: None,
            joints: BTreeMap::new(),
        }
    }
}

impl Scene {
    /// Reads scene.toml; files it names are seen from its folder.
    ///
    /// # Errors
    /// One sentence with the file, the line or key, what was found and what was expected.
    pub fn load(path: &Path) -> Result<Self> {
        let mut scene: Self = read_toml(path)?;
        scene.see_files_from(path.parent().unwrap_or(Path::new("")));
        scene.check().with_context(|| path.display().to_string())?;
        Ok(scene)
    }

    /// A built-in scene.
    ///
    /// # Errors
    /// When there is none of that name; the nearest is named.
    pub fn preset(name: &str) -> Result<Self> {
        let scene: Self = parse_toml(ScenePreset::from_name(name)?.text(), name)?;
        scene.check()?;
        Ok(scene)
    }

    fn see_files_from(&mut self, folder: &Path) {
        let seen = |path: &mut Option<PathBuf>| {
            if let Some(path) = path {
                *path = folder.join(&*path);
            }
        };
        seen(&mut self.rig.cameras);
        for actor in &mut self.actor {
            seen(&mut actor.mesh);
            seen(&mut actor.motion.file);
            seen(&mut actor.motion.skeleton);
        }
        let worn = self.actor.iter_mut().flat_map(|actor| actor.clothes.values_mut());
        for finish in worn.chain(&mut self.room.floor).chain(&mut self.room.walls) {
            if let Some(FinishParameters::File(path)) = &mut finish.parameters {
                *path = folder.join(&*path);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_file_sets_some_and_keeps_the_rest() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, "frames = 7\n[rig]\nsize = [320, 240]\n[[actor]]\nmotion = { file = \"walk.bvh\" }\n")
            .unwrap();
        let scene = Scene::load(&path).unwrap();
        assert_eq!((scene.frames, scene.rig.size, scene.fps), (7, [320, 240], 25.0));
        assert_eq!(scene.actor[0].motion.file, Some(folder.path().join("walk.bvh")));
        std::fs::write(&path, "frames = 7\n").unwrap();
        let error = format!("{:#}", Scene::load(&path).unwrap_err());
        assert!(error.ends_with("scene.toml: there is no [[actor]], expected one to track"), "{error}");
        std::fs::write(&path, "[[actor]]\nhieght = 1800.0\n").unwrap();
        let error = format!("{:#}", Scene::load(&path).unwrap_err());
        assert!(error.contains("line 2") && error.contains("nearest known key is `height`"), "{error}");
    }

    #[test]
    fn presets_are_scenes_and_come_back_from_their_text() {
        for name in ScenePreset::ALL.map(ScenePreset::name) {
            let scene = Scene::preset(name).unwrap();
            let text = toml::to_string(&scene).unwrap();
            assert_eq!(parse_toml::<Scene>(&text, name).unwrap(), scene, "{text}");
        }
        assert!(
            Scene::preset("leewalks")
                .unwrap_err()
                .to_string()
                .contains("unknown scene `leewalks`, the nearest is `leewalk` (known: demo, leewalk")
        );
    }
}
