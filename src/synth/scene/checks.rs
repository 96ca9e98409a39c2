//! What can be asked of a scene: every setting is held to its range before anything is drawn.

use anyhow::{Context, Result, bail, ensure};

use super::{
    ActorSettings, CameraSettings, Garment, MotionSettings, RigKind, RigSettings, RoomSettings, Scene, SensorSettings,
    StationSettings,
};
use crate::body::Proportions;
use crate::features::FeatureSettings;

/// Holds a number to its range; NaN is in none.
fn within(what: &str, value: f64, low: f64, high: f64, unit: &str) -> Result<()> {
    ensure!((low..=high).contains(&value), "{what} is {value}, expected {low} to {high} {unit}");
    Ok(())
}

impl Scene {
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
        let lamp = self.light.position.iter().map(|at| ("position", at));
        for (key, [x, y, z]) in lamp.chain(self.light.lamps.iter().map(|at| ("lamps", at))) {
            ensure!(
                [x, y, z].iter().all(|value| value.abs() <= 1e9) && *z > 2000.0,
                "[light] {key} is [{x}, {y}, {z}], expected a place at least 2000 mm above the floor"
            );
        }
        ensure!(
            self.light.position.is_none() || self.light.lamps.is_empty(),
            "[light] has both `position` and `lamps`, expected one of them"
        );
        ensure!(
            self.light.lamps.len() <= 8,
            "[light] lamps has {} of them, expected at most 8",
            self.light.lamps.len()
        );
        ensure!(
            (1..=50).contains(&self.light.softness),
            "[light] softness is {}, expected 1 to 50",
            self.light.softness
        );
        self.rig.check().context("[rig]")?;
        self.sensor.check(self.fps).context("[sensor]")?;
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
        if let Some(table) = &self.features {
            FeatureSettings::from_table(table, "the scene")?;
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
        ensure!((1..=64).contains(&self.count), "count is {}, expected 1 to 64 cameras", self.count);
        ensure!(
            self.preset == RigKind::Ring || self.count == 4,
            "count is {} beside the preset `{}`, expected the preset `ring` for another number than 4",
            self.count,
            self.preset
        );
        ensure!(
            self.cameras.is_none() || self.station.is_empty(),
            "it has both `cameras` and `station`, expected one of them"
        );
        ensure!(self.station.len() <= 64, "there are {} stations, expected at most 64", self.station.len());
        for station in &self.station {
            station.check()?;
        }
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

impl StationSettings {
    fn check(&self) -> Result<()> {
        within("the focal length of a station", self.focal, 10.0, 1e5, "pixels")?;
        within("the roll of a station", self.roll, -180.0, 180.0, "degrees")?;
        let places = self.at.iter().chain(&self.towards).chain(&self.centre);
        for value in places {
            within("a place of a station", *value, -60_000.0, 60_000.0, "mm")?;
        }
        for value in self.radial.iter().chain(&self.tangential) {
            within("a distortion of a station", *value, -2.0, 2.0, "")?;
        }
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
        ensure!(
            !self.own_bones || self.mesh.is_some(),
            "`own_bones` stands without `mesh`, expected it beside a skinned person"
        );
        Proportions::named(&self.proportions).context("proportions")?;
        for name in self.clothes.keys() {
            Garment::from_name(name)?;
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
        within("speed", self.speed.unwrap_or(1.0), 0.1, 10.0, "times the file's")?;
        within("heading", self.heading.unwrap_or(0.0), -3600.0, 3600.0, "degrees")?;
        for value in self.at {
            within("at", value, -30_000.0, 30_000.0, "mm")?;
        }
        ensure!(self.gait.is_none() || self.file.is_none(), "it has both `gait` and `file`, expected one of them");
        if self.file.is_none() {
            let of_files = [
                ("skeleton", self.skeleton.is_some()),
                ("rate", self.rate.is_some()),
                ("unit", self.unit.is_some()),
                ("up", self.up.is_some()),
                ("until", self.until.is_some()),
                ("repeats", self.repeats),
                ("mirrored", self.mirrored),
                ("speed", self.speed.is_some()),
                ("joints", !self.joints.is_empty()),
            ];
            if let Some((key, _)) = of_files.into_iter().find(|(_, is_there)| *is_there) {
                bail!("`{key}` stands without `file`, expected it beside a motion file");
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FinishSettings, MotionUnit};
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
            (
                |s| s.features = Some(toml::Table::from_iter([("blobz".to_string(), 1.into())])),
                "the scene, table [features]: unknown key `blobz`",
            ),
            (|s| s.sensor.exposure = 50.0, "[sensor]: exposure is 50, expected 0 to 40 ms"),
            (|s| s.output.crf = 60, "crf is 60"),
            (|s| s.light.position = Some([0.0, 0.0, -1.0]), "[light] position"),
            (|s| s.actor[0].motion.unit = Some(MotionUnit::Centimetre), "`unit` stands without `file`"),
            (
                |s| drop(s.actor[0].clothes.insert("hat".into(), FinishSettings::default())),
                "unknown part of clothes `hat`, the nearest is `hair` (known: skin, hair, shirt, trousers, shoes)",
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
        for (text, expected) in [
            ("[rig]\nlens = 'fisheye'", "unknown rig lens `fisheye`"),
            ("[rig]\npreset = 'rign'", "unknown rig `rign`, the nearest is `ring`"),
            ("[output]\npictures = 'jpg'", "the nearest is `jpeg`"),
            ("[[actor]]\nmotion.gait = 'strait'", "unknown gait `strait`, the nearest is `straight`"),
            ("[[actor]]\nmotion.unit = 'foot'", "unknown motion unit `foot`"),
            ("[[actor]]\nmotion.up = 'x'", "unknown axis that is up `x`"),
        ] {
            let message = crate::files::parse_toml::<Scene>(text, "scene.toml").unwrap_err().to_string();
            assert!(message.contains("scene.toml, line 2") && message.contains(expected), "{message}");
        }
    }
}
