//! When the pictures of a video are to be shown, as its packets say, and which of them is nearest to an instant.

use std::sync::Arc;

use anyhow::{Result, ensure};

/// A step within this share of the usual one is regular, and so is a picture that is as far from its place in a regular row.
const REGULAR: f64 = 0.5;
/// Rates that cameras are set to, frames a second.
const NOMINAL: [f64; 13] = [
    24_000.0 / 1001.0,
    24.0,
    25.0,
    30_000.0 / 1001.0,
    30.0,
    50.0,
    60_000.0 / 1001.0,
    60.0,
    100.0,
    120_000.0 / 1001.0,
    120.0,
    200.0,
    240.0,
];
/// A rate so near to one of those, as a share, is meant to be that one.
const NEAR_NOMINAL: f64 = 0.005;
/// Frames that stand for one picture at most, on average: more are a mistake of the file or of the rate.
const MOST_REPEATS: f64 = 64.0;

/// The times of a video's pictures, in the order in which they are decoded and shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Timestamps {
    /// Seconds of the file's own clock, ascending, one a picture, two or more.
    times: Arc<[f64]>,
    /// What the file rounds times to, seconds.
    tick: f64,
}

impl Timestamps {
    /// Of times in any order; none where they tell nothing.
    pub(super) fn of(mut times: Vec<f64>, tick: f64) -> Option<Self> {
        times.sort_by(f64::total_cmp);
        let (first, last) = (times.first()?, times.last()?);
        (first.is_finite() && last.is_finite() && last > first).then(|| Self { times: times.into(), tick })
    }

    fn steps(&self) -> impl Iterator<Item = f64> {
        self.times.windows(2).map(|pair| pair[1] - pair[0])
    }

    /// The time of the first picture, seconds of the file's own clock.
    pub fn first(&self) -> f64 {
        self.times[0]
    }

    /// From the first picture to the last, seconds.
    fn span(&self) -> f64 {
        self.times[self.times.len() - 1] - self.times[0]
    }

    /// How long the recording is, its last picture's own time with it, s.
    pub(super) fn seconds(&self) -> f64 {
        self.span() + self.usual_step()
    }

    /// The median time from a picture to the next, seconds.
    pub fn median_step(&self) -> f64 {
        let mut steps: Vec<f64> = self.steps().collect();
        let middle = steps.len() / 2;
        *steps.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// The mean of the steps that are about as long as the median: without what rounding in the file does to that one.
    fn usual_step(&self) -> f64 {
        let median = self.median_step();
        let (sum, count) = self
            .steps()
            .filter(|step| (step - median).abs() <= REGULAR * median)
            .fold((0.0, 0_usize), |(sum, count), step| (sum + step, count + 1));
        let usual = sum / count.max(1) as f64;
        // Half of the pictures at one time: no step is usual.
        if usual > 0.0 { usual } else { self.span() / (self.times.len() - 1) as f64 }
    }

    /// The longest time from a picture to the next, seconds.
    pub fn longest_step(&self) -> f64 {
        self.steps().fold(0.0, f64::max)
    }

    /// Pictures a second where none is missing; that which the camera was set to, where it is one of the usual ones.
    pub fn usual_rate(&self) -> f64 {
        let rate = 1.0 / self.usual_step();
        let off = |nominal: &f64| (rate / nominal - 1.0).abs();
        let nearest = NOMINAL.into_iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        nearest.filter(|nominal| off(nominal) < NEAR_NOMINAL).unwrap_or(rate)
    }

    /// How many pictures are missing between those that are there, at the usual step.
    pub fn missing(&self) -> usize {
        let usual = self.usual_step();
        self.steps().map(|step| ((step / usual).round() as usize).saturating_sub(1)).sum()
    }

    /// Whether the pictures came at a constant rate: each step is about the mean one, and no picture lies half a step or more from its
    /// place in a regular row.
    pub fn is_regular(&self) -> bool {
        let mean = self.span() / (self.times.len() - 1) as f64;
        let allowed = REGULAR * mean + self.tick;
        let in_step = self.steps().all(|step| (step - mean).abs() < allowed);
        in_step
            && self.times.iter().enumerate().all(|(at, time)| (time - self.times[0] - at as f64 * mean).abs() < allowed)
    }

    /// The picture nearest in time to each frame at `fps` from `later` seconds after the first picture on, to the last picture: of two as
    /// near the earlier.
    ///
    /// # Errors
    /// When a few pictures stand for very many frames.
    pub(super) fn nearest(&self, fps: f64, later: f64) -> Result<Vec<u32>> {
        let span = self.span() - later;
        let frames = (span * fps + 0.5).floor() + 1.0;
        ensure!(
            frames <= MOST_REPEATS * self.times.len() as f64,
            "{} pictures over {span:.1} s would be {frames} frames at {fps} a second, expected timestamps and `fps` that belong together",
            self.times.len()
        );
        let nearest = (0..frames.max(0.0) as usize).map(|frame| {
            let instant = self.times[0] + later + frame as f64 / fps;
            let off = |at: usize| (self.times[at] - instant).abs();
            let after = self.times.partition_point(|time| *time < instant).min(self.times.len() - 1);
            let before = after.saturating_sub(1);
            (if off(before) <= off(after) + self.tick * 1e-3 { before } else { after }) as u32
        });
        Ok(nearest.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stamps(times: &[f64]) -> Timestamps {
        Timestamps::of(times.to_vec(), 1e-3).unwrap()
    }

    #[test]
    fn a_constant_rate_is_known_through_rounding_and_through_jitter() {
        // Matroska's milliseconds; a telephone's jitter; 240 a second in milliseconds.
        let rounded: Vec<f64> = (0..400).map(|frame| (f64::from(frame) * 1000.0 / 29.97).round() / 1000.0).collect();
        let jitter: Vec<f64> =
            (0..400_i32).map(|frame| f64::from(frame) / 30.0 + f64::from(frame * 7 % 5) * 0.002).collect();
        let fast: Vec<f64> = (0..400).map(|frame| (f64::from(frame) * 1000.0 / 240.0).round() / 1000.0).collect();
        for (times, rate) in [(&rounded, 29.97), (&jitter, 30.0), (&fast, 240.0)] {
            let stamps = stamps(times);
            assert!(stamps.is_regular() && stamps.missing() == 0, "{rate}");
            assert!((stamps.usual_rate() - rate).abs() < 1e-3, "{} for {rate}", stamps.usual_rate());
            assert_eq!(stamps.nearest(rate, 0.0).unwrap(), (0..400).collect::<Vec<u32>>(), "{rate}");
        }
    }

    #[test]
    fn missing_pictures_and_a_rate_that_drops_are_known() {
        let missing: Vec<f64> =
            (0..40).filter(|frame| ![7, 8, 20].contains(frame)).map(|frame| f64::from(frame) / 25.0).collect();
        let missing = stamps(&missing);
        assert!(!missing.is_regular());
        assert_eq!((missing.missing(), missing.usual_rate()), (3, 25.0));
        assert!((missing.longest_step() - 0.12).abs() < 1e-9 && (missing.median_step() - 0.04).abs() < 1e-9);
        // A frame that is missing is the nearest before or after, and of two as near the earlier.
        let nearest = missing.nearest(25.0, 0.0).unwrap();
        assert_eq!(nearest[..12], [0, 1, 2, 3, 4, 5, 6, 6, 7, 7, 8, 9]);
        assert_eq!((nearest[20], nearest[21], nearest.len()), (17, 18, 40));
        assert_eq!(missing.nearest(25.0, 0.12).unwrap()[..], nearest[3..]);
        // 30 a second, then 24: every step by itself looks regular.
        let slower: Vec<f64> = (0..60)
            .map(|frame| if frame < 30 { f64::from(frame) / 30.0 } else { 1.0 + f64::from(frame - 30) / 24.0 })
            .collect();
        assert!(!stamps(&slower).is_regular());
        // A duplicate is passed over.
        let double = stamps(&[0.0, 0.04, 0.08, 0.081, 0.12, 0.16]);
        assert!(!double.is_regular());
        assert_eq!(double.nearest(25.0, 0.0).unwrap(), [0, 1, 2, 4, 5]);
    }

    #[test]
    fn times_that_tell_nothing_are_none_and_absurd_ones_a_sentence() {
        assert!(Timestamps::of(vec![], 1e-3).is_none() && Timestamps::of(vec![1.0, 1.0], 1e-3).is_none());
        assert!(Timestamps::of(vec![0.0, f64::NAN], 1e-3).is_none());
        let error = stamps(&[0.0, 0.04, 1e9]).nearest(25.0, 0.0).unwrap_err().to_string();
        assert!(error.contains("3 pictures over 1000000000.0 s"), "{error}");
        assert_eq!(stamps(&[0.0, 0.0, 0.0, 0.0, 1.0]).nearest(2.0, 0.0).unwrap(), [0, 3, 4]);
    }
}
