//! Recordings of several frame rates put in step by their time stamps, without a manifest.

use std::sync::Arc;

use anyhow::Result;

use super::footage::Footage;
use super::synchrony::SAME_RATE;
use super::timestamps::Timestamps;

/// Recordings whose frames of one number are of one moment.
#[derive(Debug)]
pub struct InStep {
    /// The recordings.
    pub footage: Vec<Footage>,
    /// Frames a second that pictures were picked at; none where all have one constant rate, or one of them does not tell its own.
    pub picked_at: Option<f64>,
}

/// Picks, of recordings that began at one moment and have several rates or lack pictures, each one's picture nearest in time to every frame at
/// the lowest of their rates, up to the end of the shortest. Recordings of one constant rate stay as they are, and so do all where
/// one has no time stamps.
///
/// # Errors
/// When time stamps make no sense.
pub fn in_step(footage: Vec<Footage>) -> Result<InStep> {
    let times: Option<Vec<&Timestamps>> = footage.iter().map(|one| one.times.as_ref()).collect();
    let Some(times) = times.filter(|times| !times.is_empty()) else { return Ok(InStep { footage, picked_at: None }) };
    let lowest = times.iter().map(|times| times.usual_rate()).fold(f64::INFINITY, f64::min);
    if times.iter().all(|times| times.is_regular() && (times.usual_rate() / lowest - 1.0).abs() <= SAME_RATE) {
        return Ok(InStep { footage, picked_at: None });
    }
    let picks = times.iter().map(|times| times.nearest(lowest, 0.0)).collect::<Result<Vec<_>>>()?;
    let frame_count = picks.iter().map(Vec::len).min().unwrap_or(0);
    let pick = |(one, picks): (Footage, Vec<u32>)| Footage {
        frame_count,
        picks: Some(Arc::from(&picks[..frame_count])),
        ..one
    };
    Ok(InStep { footage: footage.into_iter().zip(picks).map(pick).collect(), picked_at: Some(lowest) })
}

#[cfg(test)]
mod tests {
    use image::RgbImage;

    use super::super::video::tests::{ffmpeg_is_here, make_video};
    use super::*;

    /// A video of half the rate shows, frame by frame, what the whole one shows at those moments.
    #[test]
    fn videos_of_several_rates_are_put_in_step() {
        if !ffmpeg_is_here("videos_of_several_rates_are_put_in_step") {
            return;
        }
        let folder = tempfile::tempdir().unwrap();
        let open = |name: &str, arguments: &[&str]| {
            let path = folder.path().join(name);
            make_video(&path, "64x48", 20, &[&["-q:v", "2"], arguments].concat());
            Footage::open(&path).unwrap()
        };
        let whole = || open("whole.mp4", &[]);
        // Every second picture, at its own time.
        let half = open("half.mp4", &["-vf", "select=not(mod(n\\,2))", "-fps_mode", "vfr"]);
        let alone = in_step(vec![whole(), whole()]).unwrap();
        assert!(alone.picked_at.is_none() && alone.footage.iter().all(|one| one.picks.is_none()));
        let InStep { footage, picked_at } = in_step(vec![whole(), half]).unwrap();
        assert_eq!(picked_at.map(f64::round), Some(13.0));
        assert_eq!(footage.iter().map(|one| one.frame_count).collect::<Vec<_>>(), [11, 11]);
        // The last frame lies half a step behind the last picture.
        assert_eq!(footage[0].picks.as_deref(), Some(&[0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 19][..]));
        let shown =
            |one: &Footage| -> Vec<RgbImage> { one.spread(5, [64, 48]).unwrap().collect::<Result<_>>().unwrap() };
        let (first, second) = (shown(&footage[0]), shown(&footage[1]));
        let apart = |a: &RgbImage, b: &RgbImage| {
            let pairs = a.as_raw().iter().zip(b.as_raw());
            pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / a.as_raw().len() as f64
        };
        assert_eq!(first.len(), 5);
        for (at, one) in first.iter().enumerate() {
            let nearest = (0..5).min_by(|a, b| apart(one, &second[*a]).total_cmp(&apart(one, &second[*b])));
            assert_eq!(nearest, Some(at));
        }
        let numberless = Footage { times: None, ..whole() };
        assert!(in_step(vec![whole(), numberless]).unwrap().picked_at.is_none());
    }
}
