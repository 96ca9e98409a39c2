//! What a synthetic sequence shows: the settings.

use anyhow::{Result, bail};
use serde::Deserialize;

/// Settings of a synthetic sequence. Everything in it follows from these, bit for bit.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Scene {
    /// Name of the sequence.
    pub name: String,
    /// Height of the actor, mm.
    pub height: f64,
    /// Number of frames.
    pub frames: usize,
    /// Frames a second.
    pub fps: f64,
    /// Radius of the circle the actor walks on, mm.
    pub circle_radius: f64,
    /// Seconds for a stride, that is two steps.
    pub stride_time: f64,
    /// Standard deviation of the cameras' noise in bright places, grey levels of 255.
    pub noise: f64,
    /// Seed of the noise.
    pub seed: u64,
    /// Size of the pictures, pixels.
    pub size: [u32; 2],
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            name: "demo".to_string(),
            height: 1750.0,
            frames: 100,
            fps: 25.0,
            circle_radius: 950.0,
            stride_time: 1.2,
            noise: 2.5,
            seed: 1,
            size: [480, 270],
        }
    }
}

impl Scene {
    /// Refuses what cannot be drawn.
    ///
    /// # Errors
    /// One sentence that names the setting, its value and what was expected.
    pub fn check(&self) -> Result<()> {
        let numbers = [
            ("height", self.height, 500.0, 2500.0, "mm"),
            ("fps", self.fps, 1.0, 1000.0, "frames a second"),
            ("circle_radius", self.circle_radius, 300.0, 1500.0, "mm, so that the actor stays inside the room"),
            ("stride_time", self.stride_time, 0.4, 10.0, "seconds"),
            ("noise", self.noise, 0.0, 100.0, "grey levels"),
        ];
        for (name, value, low, high, unit) in numbers {
            // Also refuses NaN.
            if !(low..=high).contains(&value) {
                bail!("the scene's {name} is {value}, expected {low} to {high} {unit}");
            }
        }
        if self.frames == 0 || self.frames > 1_000_000 {
            bail!("the scene's frames is {}, expected 1 to 1000000", self.frames);
        }
        if self.size.iter().any(|side| !(32..=8192).contains(side)) {
            bail!("the scene's size is {} x {}, expected 32 to 8192 pixels a side", self.size[0], self.size[1]);
        }
        if self.name.is_empty() || self.name.chars().any(char::is_control) {
            bail!("the scene's name is {:?}, expected at least one letter and no control characters", self.name);
        }
        Ok(())
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
            scene.check().unwrap_err().to_string()
        };
        assert!(wrong(|s| s.height = f64::NAN).contains("height is NaN, expected 500"));
        assert!(wrong(|s| s.fps = 0.0).contains("fps is 0"));
        assert!(wrong(|s| s.circle_radius = f64::INFINITY).contains("circle_radius is inf"));
        assert!(wrong(|s| s.frames = 0).contains("frames is 0"));
        assert!(wrong(|s| s.size = [480, 1 << 30]).contains("1073741824"));
        assert!(wrong(|s| s.name = "a\nb".into()).contains("control"));
    }

    #[test]
    fn a_scene_file_sets_some_and_keeps_the_rest() {
        let scene: Scene = crate::files::parse_toml("frames = 7\nsize = [320, 240]\n", "scene.toml").unwrap();
        assert_eq!((scene.frames, scene.size, scene.fps), (7, [320, 240], 25.0));
        let error = crate::files::parse_toml::<Scene>("hieght = 1800.0\n", "scene.toml").unwrap_err().to_string();
        assert!(error.contains("nearest known key is `height`"), "{error}");
    }
}
