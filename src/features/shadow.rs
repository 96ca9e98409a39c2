//! Shadows: a surface in shadow is darker, but of the same colour.

use serde::Deserialize;

/// What still counts as the background, only darker.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ShadowSettings {
    /// Whether shadows are suppressed at all.
    pub suppress: bool,
    /// The darkest shadow, as a fraction of the background's brightness; anything darker is foreground.
    pub darkest: f32,
    /// How far a shadow's colour may be from the darkened background's, grey levels.
    pub chroma: f32,
}

impl Default for ShadowSettings {
    fn default() -> Self {
        Self { suppress: true, darkest: 0.55, chroma: 8.0 }
    }
}

impl ShadowSettings {
    /// Whether `seen` is `background` in shadow: the multiple of the background nearest to it is a darkening by no
    /// more than allowed, and what is left between them is within the chroma tolerance (all in grey levels).
    #[inline]
    pub(super) fn covers(&self, seen: [f32; 3], background: [f32; 3]) -> bool {
        let product = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (along, length) = (product(seen, background), product(background, background));
        let brightness = along / (length + 1e-3);
        let off_colour = product(seen, seen) - brightness * along;
        // Bitwise, so that the loops over pixels have no branch.
        self.suppress & (brightness >= self.darkest) & (brightness <= 1.0) & (off_colour <= self.chroma * self.chroma)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn darker_is_shadow_and_another_colour_is_not() {
        let shadow = ShadowSettings::default();
        let wall = [200.0, 180.0, 150.0];
        assert!(shadow.covers(wall.map(|v| v * 0.7), wall));
        assert!(!shadow.covers(wall.map(|v| v * 0.3), wall), "too dark");
        assert!(!shadow.covers(wall.map(|v| v * 1.1), wall), "brighter");
        assert!(!shadow.covers([160.0, 110.0, 90.0], wall), "redder");
        assert!(!ShadowSettings { suppress: false, ..shadow }.covers(wall.map(|v| v * 0.7), wall));
        // Nothing is darker than black, and black has no colour to keep.
        assert!(!shadow.covers([0.0; 3], [0.0; 3]));
    }
}
