//! Shadows and reflections: a surface in shadow is darker and one that reflects a lamp brighter, both of the same colour.

use serde::Deserialize;

/// What still counts as the background, only lit differently.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ShadowSettings {
    /// Whether shadows are suppressed at all.
    pub suppress: bool,
    /// The darkest shadow, as a fraction of the background's brightness; anything darker is foreground.
    pub darkest: f32,
    /// The brightest reflection, likewise; 1 for none.
    pub brightest: f32,
    /// How far the colour may be from the darkened or brightened background's, grey levels.
    pub chroma: f32,
}

impl Default for ShadowSettings {
    fn default() -> Self {
        Self { suppress: true, darkest: 0.55, brightest: 1.6, chroma: 10.0 }
    }
}

impl ShadowSettings {
    /// Whether `seen` is `background` in another light: the multiple of the background nearest to it is within the
    /// allowed brightness, and what is left between them is within the chroma tolerance (all in grey levels).
    #[inline(always)]
    pub(super) fn covers(&self, seen: [f32; 3], background: [f32; 3]) -> bool {
        let product = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (along, length) = (product(seen, background), product(background, background));
        let brightness = along / (length + 1e-3);
        let off_colour = product(seen, seen) - brightness * along;
        // Bitwise, so that the loops over pixels have no branch.
        self.suppress
            & (brightness >= self.darkest)
            & (brightness <= self.brightest)
            & (off_colour <= self.chroma * self.chroma)
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
        assert!(shadow.covers(wall.map(|v| v * 1.2), wall), "a reflection");
        assert!(!shadow.covers(wall.map(|v| v * 1.7), wall), "too bright");
        assert!(!ShadowSettings { brightest: 1.0, ..shadow }.covers(wall.map(|v| v * 1.2), wall));
        assert!(!shadow.covers([160.0, 110.0, 90.0], wall), "redder");
        assert!(!ShadowSettings { suppress: false, ..shadow }.covers(wall.map(|v| v * 0.7), wall));
        // Nothing is darker than black, and black has no colour to keep.
        assert!(!shadow.covers([0.0; 3], [0.0; 3]));
    }
}
