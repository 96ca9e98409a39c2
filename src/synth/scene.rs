//! What a synthetic sequence shows: the settings, as scene.toml has them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};

use super::finish::FinishSettings;
use crate::files::{parse_toml, read_toml};

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
    /// The people, the tracked one first.
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
    /// By which fraction all light grows and shrinks.
    pub swing: f64,
    /// How long that takes, s.
    pub period: f64,
}

/// `[rig]`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct RigSettings {
    /// `corners`: four cameras; `ring`: any number round the room.
    pub preset: String,
    /// Number of cameras of a ring.
    pub count: usize,
    /// A calibration instead of a preset.
    pub cameras: Option<PathBuf>,
    /// Size of the pictures of a preset, pixels.
    pub size: [u32; 2],
    /// Lens of a preset: `brown-conrady`, `tsai` or `pinhole`.
    pub lens: String,
    /// Factor on the focal length of a preset.
    pub zoom: f64,
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
    /// `png`, `jpeg` or `video` (H.264 through ffmpeg).
    pub pictures: String,
    /// Quality of JPEG pictures, 1 to 100.
    pub quality: u8,
    /// Constant rate factor of videos: 0 loses nothing, 51 most.
    pub crf: u8,
    /// Write the tracked person's silhouettes too.
    pub masks: bool,
}

/// `[[actor]]`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ActorSettings {
    /// Height, mm.
    pub height: f64,
    /// A skinned glTF person instead of ellipsoids and capsules.
    pub mesh: Option<PathBuf>,
    /// What the actor does.
    pub motion: MotionSettings,
    /// Clothes by part: skin, hair, shirt, trousers, shoes.
    pub clothes: BTreeMap<String, FinishSettings>,
}

/// `[actor.motion]`: a built-in gait or a file.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct MotionSettings {
    /// `circle`, `straight`, `diagonal`, `run`, `jump` or `stand`.
    pub gait: Option<String>,
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
    /// Unit of the file: `mm`, `cm`, `m`, `inch`, where it cannot be found out.
    pub unit: Option<String>,
    /// `y` or `z`, where it cannot be found out.
    pub up: Option<String>,
    /// Second at which to stop.
    pub until: Option<f64>,
    /// Begin again where the motion ends, from the place it has reached.
    pub repeats: bool,
    /// Names of the file's joints by bones of the body, where the names themselves do not tell.
    pub joints: BTreeMap<String, String>,
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
        Self { position: None, swing: 0.0, period: 4.0 }
    }
}

impl Default for RigSettings {
    fn default() -> Self {
        Self {
            preset: "corners".to_string(),
            count: 4,
            cameras: None,
            size: [480, 270],
            lens: "brown-conrady".to_string(),
            zoom: 1.0,
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
        Self { pictures: "png".to_string(), quality: 90, crf: 18, masks: false }
    }
}

impl Default for ActorSettings {
    fn default() -> Self {
        Self { height: 1750.0, mesh: None, motion: MotionSettings::default(), clothes: BTreeMap::new() }
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
            joints: BTreeMap::new(),
        }
    }
}

/// The built-in scenes: the demo, and five after the sequences that the method was first measured on (SPEC A10).
const PRESETS: [(&str, &str); 6] = [
    ("demo", include_str!("presets/demo.toml")),
    ("leewalk", include_str!("presets/leewalk.toml")),
    ("p1s", include_str!("presets/p1s.toml")),
    ("p2s", include_str!("presets/p2s.toml")),
    ("p1d", include_str!("presets/p1d.toml")),
    ("p2d", include_str!("presets/p2d.toml")),
];

/// Gaits by name.
pub(super) const GAITS: [&str; 6] = ["circle", "straight", "diagonal", "run", "jump", "stand"];
/// Parts of clothing by name.
pub(super) const GARMENTS: [&str; 5] = ["skin", "hair", "shirt", "trousers", "shoes"];
const RIGS: [&str; 2] = ["corners", "ring"];
const LENSES: [&str; 3] = ["brown-conrady", "tsai", "pinhole"];
const PICTURES: [&str; 3] = ["png", "jpeg", "video"];
const UNITS: [(&str, f64); 4] = [("mm", 1.0), ("cm", 10.0), ("inch", 25.4), ("m", 1000.0)];

/// Holds a name to those that are known.
fn one_of(what: &str, found: &str, known: &[&str]) -> Result<()> {
    if known.contains(&found) {
        return Ok(());
    }
    let found = crate::files::shortened(found);
    let nearest =
        known.iter().min_by_key(|name| strsim::damerau_levenshtein(&found, name)).copied().unwrap_or_default();
    bail!("{what} is `{found}`, the nearest known one is `{nearest}` (known: {})", known.join(", "))
}

/// Holds a number to its range; NaN is in none.
fn within(what: &str, value: f64, low: f64, high: f64, unit: &str) -> Result<()> {
    ensure!((low..=high).contains(&value), "{what} is {value}, expected {low} to {high} {unit}");
    Ok(())
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

    /// A built-in scene: demo, leewalk, p1s, p2s, p1d or p2d.
    ///
    /// # Errors
    /// When there is none of that name; the nearest is named.
    pub fn preset(name: &str) -> Result<Self> {
        one_of("the preset", name, &PRESETS.map(|(name, _)| name))?;
        let text = PRESETS.iter().find(|(preset, _)| *preset == name).map_or("", |(_, text)| text);
        let scene: Self = parse_toml(text, name)?;
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
            actor.clothes.values_mut().for_each(|finish| seen(&mut finish.parameters));
        }
        for finish in [&mut self.room.floor, &mut self.room.walls].into_iter().flatten() {
            seen(&mut finish.parameters);
        }
    }

    /// Refuses what cannot be drawn.
    ///
    /// # Errors
    /// One sentence that names the setting, its value and what was expected.
    pub fn check(&self) -> Result<()> {
        ensure!(
            !self.name.is_empty() && !self.name.chars().any(char::is_control),
            "name is {:?}, expected at least one letter and no control characters",
            self.name
        );
        ensure!((1..=1_000_000).contains(&self.frames), "frames is {}, expected 1 to 1000000", self.frames);
        within("fps", self.fps, 1.0, 1000.0, "frames a second")?;
        ensure!([15, 39].contains(&self.markers), "markers is {}, expected 15 or 39", self.markers);
        self.room.check().context("[room]")?;
        within("[light] swing", self.light.swing, 0.0, 0.95, "of the light")?;
        within("[light] period", self.light.period, 0.01, 1e6, "s")?;
        if let Some([x, y, z]) = self.light.position {
            ensure!(
                [x, y, z].iter().all(|value| value.abs() <= 1e9) && z > 2000.0,
                "[light] position is [{x}, {y}, {z}], expected a place at least 2000 mm above the floor"
            );
        }
        self.rig.check().context("[rig]")?;
        self.sensor.check(self.fps).context("[sensor]")?;
        one_of("[output] pictures", &self.output.pictures, &PICTURES)?;
        ensure!(
            (1..=100).contains(&self.output.quality),
            "[output] quality is {}, expected 1 to 100",
            self.output.quality
        );
        ensure!(self.output.crf <= 51, "[output] crf is {}, expected 0 to 51", self.output.crf);
        ensure!(!self.actor.is_empty(), "there is no [[actor]], expected one to track");
        ensure!(self.actor.len() <= 8, "there are {} [[actor]], expected at most 8", self.actor.len());
        for (index, actor) in self.actor.iter().enumerate() {
            actor.check().with_context(|| format!("actor {}", index + 1))?;
        }
        for camera in &self.camera {
            camera.check(self.frames).with_context(|| format!("camera `{}`", camera.name))?;
        }
        Ok(())
    }
}

impl RoomSettings {
    fn check(&self) -> Result<()> {
        for (side, extent) in ["size along x", "size along y"].into_iter().zip(self.size) {
            within(side, extent, 1500.0, 60_000.0, "mm")?;
        }
        within("height", self.height, 1500.0, 20_000.0, "mm")?;
        within("rug", self.rug, 0.0, 20_000.0, "mm")
    }
}

impl RigSettings {
    fn check(&self) -> Result<()> {
        one_of("preset", &self.preset, &RIGS)?;
        one_of("lens", &self.lens, &LENSES)?;
        ensure!((1..=64).contains(&self.count), "count is {}, expected 1 to 64 cameras", self.count);
        ensure!(
            self.preset == "ring" || self.count == 4,
            "count is {} beside the preset `{}`, expected the preset `ring` for another number than 4",
            self.count,
            self.preset
        );
        within("zoom", self.zoom, 0.3, 5.0, "")?;
        ensure!(
            self.size.iter().all(|side| (32..=8192).contains(side)),
            "size is {} x {}, expected 32 to 8192 pixels a side",
            self.size[0],
            self.size[1]
        );
        Ok(())
    }
}

impl SensorSettings {
    fn check(&self, fps: f64) -> Result<()> {
        within("noise", self.noise, 0.0, 100.0, "grey levels")?;
        within("gain", self.gain, 0.01, 100.0, "")?;
        within("exposure", self.exposure, 0.0, 1000.0 / fps, "ms, the time from frame to frame")?;
        ensure!((1..=64).contains(&self.sub_frames), "sub_frames is {}, expected 1 to 64", self.sub_frames);
        Ok(())
    }
}

impl CameraSettings {
    fn check(&self, frames: usize) -> Result<()> {
        within("noise", self.noise.unwrap_or(0.0), 0.0, 100.0, "grey levels")?;
        within("gain", self.gain.unwrap_or(1.0), 0.01, 100.0, "")?;
        within("exposure", self.exposure.unwrap_or(0.0), 0.0, 1000.0, "ms")?;
        within("drop_rate", self.drop_rate.unwrap_or(0.0), 0.0, 0.9, "of the frames")?;
        within("shift", self.shift.unwrap_or(0.0), -100.0, 100.0, "frames")?;
        if let Some(frame) = self.dropped.iter().find(|frame| **frame == 0 || **frame >= frames) {
            bail!("dropped names frame {frame}, expected 1 to {}: the first is always there", frames - 1);
        }
        Ok(())
    }
}

impl ActorSettings {
    fn check(&self) -> Result<()> {
        within("height", self.height, 500.0, 2500.0, "mm")?;
        for name in self.clothes.keys() {
            one_of("a part of clothes", name, &GARMENTS)?;
        }
        self.motion.check().context("motion")
    }
}

impl MotionSettings {
    fn check(&self) -> Result<()> {
        within("radius", self.radius, 300.0, 20_000.0, "mm")?;
        within("stride_time", self.stride_time, 0.4, 10.0, "seconds")?;
        within("jump_height", self.jump_height, 10.0, 1000.0, "mm")?;
        within("start", self.start, 0.0, 1e5, "seconds")?;
        within("heading", self.heading.unwrap_or(0.0), -3600.0, 3600.0, "degrees")?;
        for value in self.at {
            within("at", value, -30_000.0, 30_000.0, "mm")?;
        }
        match (&self.gait, &self.file) {
            (Some(gait), None) => one_of("gait", gait, &GAITS)?,
            (Some(_), Some(_)) => bail!("it has both `gait` and `file`, expected one of them"),
            _ => {}
        }
        if self.file.is_none() {
            let of_files = [
                ("skeleton", self.skeleton.is_some()),
                ("rate", self.rate.is_some()),
                ("unit", self.unit.is_some()),
                ("up", self.up.is_some()),
                ("until", self.until.is_some()),
                ("repeats", self.repeats),
                ("joints", !self.joints.is_empty()),
            ];
            if let Some((key, _)) = of_files.into_iter().find(|(_, is_there)| *is_there) {
                bail!("`{key}` stands without `file`, expected it beside a motion file");
            }
        }
        if let Some(unit) = &self.unit {
            one_of("unit", unit, &UNITS.map(|(name, _)| name))?;
        }
        if let Some(up) = &self.up {
            one_of("up", up, &["y", "z"])?;
        }
        Ok(())
    }

    /// Length of the file's unit, mm, where it is named.
    pub(super) fn unit_mm(&self) -> Option<f64> {
        let unit = self.unit.as_deref()?;
        UNITS.iter().find(|(name, _)| *name == unit).map(|(_, length)| *length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_settings_are_named() {
        Scene::default().check().unwrap();
        let wrong = |change: fn(&mut Scene)| {
            let mut scene = Scene::default();
            change(&mut scene);
            format!("{:#}", scene.check().unwrap_err())
        };
        for (change, expected) in [
            ((|s| s.actor[0].height = f64::NAN) as fn(&mut Scene), "actor 1: height is NaN, expected 500"),
            (|s| s.fps = 0.0, "fps is 0"),
            (|s| s.actor[0].motion.radius = f64::INFINITY, "motion: radius is inf"),
            (|s| s.frames = 0, "frames is 0"),
            (|s| s.rig.size = [480, 1 << 30], "[rig]: size is 480 x 1073741824"),
            (|s| s.name = "a\nb".into(), "no control characters"),
            (|s| s.markers = 40, "markers is 40, expected 15 or 39"),
            (|s| s.actor.clear(), "there is no [[actor]]"),
            (|s| s.rig.count = 5, "expected the preset `ring`"),
            (|s| s.rig.lens = "fisheye".into(), "[rig]: lens is `fisheye`"),
            (|s| s.sensor.exposure = 50.0, "[sensor]: exposure is 50, expected 0 to 40 ms"),
            (|s| s.output.pictures = "jpg".into(), "the nearest known one is `jpeg`"),
            (|s| s.output.crf = 60, "crf is 60"),
            (|s| s.light.position = Some([0.0, 0.0, -1.0]), "[light] position"),
            (|s| s.actor[0].motion.gait = Some("strait".into()), "the nearest known one is `straight`"),
            (|s| s.actor[0].motion.unit = Some("cm".into()), "`unit` stands without `file`"),
            (
                |s| drop(s.actor[0].clothes.insert("hat".into(), FinishSettings::default())),
                "a part of clothes is `hat`",
            ),
            (|s| s.room.size[1] = 100.0, "[room]: size along y is 100"),
            (
                |s| {
                    s.camera.push(CameraSettings { name: "cam1".into(), dropped: vec![0], ..CameraSettings::default() })
                },
                "camera `cam1`: dropped names frame 0",
            ),
        ] {
            let message = wrong(change);
            assert!(message.contains(expected), "{message}");
        }
    }

    #[test]
    fn a_scene_file_sets_some_and_keeps_the_rest() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, "frames = 7\n[rig]\nsize = [320, 240]\n[[actor]]\nmotion = { file = \"walk.bvh\" }\n")
            .unwrap();
        let scene = Scene::load(&path).unwrap();
        assert_eq!((scene.frames, scene.rig.size, scene.fps), (7, [320, 240], 25.0));
        assert_eq!(scene.actor[0].motion.file, Some(folder.path().join("walk.bvh")));
        std::fs::write(&path, "[[actor]]\nhieght = 1800.0\n").unwrap();
        let error = format!("{:#}", Scene::load(&path).unwrap_err());
        assert!(error.contains("line 2") && error.contains("nearest known key is `height`"), "{error}");
    }

    #[test]
    fn presets_are_scenes_and_come_back_from_their_text() {
        for (name, _) in PRESETS {
            let scene = Scene::preset(name).unwrap();
            let text = toml::to_string(&scene).unwrap();
            assert_eq!(parse_toml::<Scene>(&text, name).unwrap(), scene, "{text}");
        }
        assert!(Scene::preset("leewalks").unwrap_err().to_string().contains("nearest known one is `leewalk`"));
    }
}
