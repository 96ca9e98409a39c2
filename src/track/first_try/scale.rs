//! The size that pictures are worked on at: by how tall the person will be in them.

use crate::geometry::Camera;
use crate::sequence::nearest_to_axes;

/// Scales that are chosen from.
const SCALES: [f64; 9] = [1.0, 0.75, 0.5, 0.4, 0.3, 0.25, 0.2, 0.15, 0.1];
/// The person's height in the pictures that suits best, pixels.
const BEST: f64 = 220.0;

/// A scale, and how tall the person will be in each picture at it, pixels; `None` in pictures that do not show that place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ChosenScale {
    pub(super) scale: f64,
    pub(super) heights: Vec<Option<f64>>,
}

impl ChosenScale {
    /// The same at another scale.
    pub(super) fn at(self, scale: f64) -> Self {
        let by = scale / self.scale;
        Self { scale, heights: self.heights.iter().map(|tall| tall.map(|tall| tall * by)).collect() }
    }
}

/// The scale at which somebody of `height` mm where the cameras look is some 220 pixels tall in the middle one of the pictures.
pub(super) fn choose_scale(cameras: &[Camera], height: f64) -> ChosenScale {
    let full = heights(cameras, height);
    let mut known: Vec<f64> = full.iter().flatten().copied().collect();
    known.sort_by(f64::total_cmp);
    let middle = known.get(known.len() / 2).copied().unwrap_or(BEST);
    let off = |scale: f64| (scale * middle / BEST).ln().abs();
    let scale = SCALES.into_iter().min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(1.0);
    ChosenScale { scale, heights: full.iter().map(|tall| tall.map(|tall| tall * scale)).collect() }
}

/// How tall somebody is in each picture, pixels.
fn heights(cameras: &[Camera], height: f64) -> Vec<Option<f64>> {
    let Some(place) = nearest_to_axes(cameras) else { return vec![None; cameras.len()] };
    let [feet, head] = [0.0, height].map(|z| place.truncate().extend(z));
    cameras.iter().map(|camera| Some(camera.project(feet)?.distance(camera.project(head)?))).collect()
}

#[cfg(test)]
mod tests {
    use super::super::super::fit_tests::cameras_around;
    use super::*;

    #[test]
    fn a_person_becomes_some_two_hundred_pixels_tall() {
        // 4.5 m away with a focal length of 260 pixels somebody of 1.7 m is about 98 pixels tall: as large as it gets.
        let cameras = cameras_around();
        let small = choose_scale(&cameras, 1700.0);
        assert_eq!(small.scale, 1.0);
        assert!(small.heights.iter().all(|tall| (90.0..108.0).contains(&tall.unwrap())), "{small:?}");
        let large: Vec<Camera> = cameras.iter().map(|camera| camera.scaled(camera.size.map(|side| 8 * side))).collect();
        let chosen = choose_scale(&large, 1700.0);
        assert_eq!(chosen.scale, 0.3);
        assert!(chosen.heights.iter().all(|tall| (150.0..300.0).contains(&tall.unwrap())), "{chosen:?}");
    }
}
