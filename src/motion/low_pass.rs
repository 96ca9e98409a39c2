//! Smoothing without delay: a Butterworth low-pass run forwards and backwards.

use std::f64::consts::{PI, SQRT_2};
use std::ops::Range;

use anyhow::{Result, ensure};
use glam::DVec3;

use super::points::PointTrajectory;

/// Smooths a quantity that was sampled at a constant rate: a Butterworth low-pass of the second order, forwards and then backwards, so
/// that nothing is put off and the order is the fourth in all. A motion at the cut-off keeps 1/sqrt(2) of its amplitude after both passes
/// (-3 dB): each pass alone is as much wider as Winter's correction says, 1 / (sqrt(2) - 1)^(1/4) = 1.247 times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowPass {
    cutoff: f64,
    /// Samples that a stretch is lengthened by at either end.
    padding: usize,
    forward: [f64; 3],
    back: [f64; 2],
}

/// Runs of frames that are too short to be smoothed and are left as they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeftAsIs {
    /// How many runs.
    pub runs: usize,
    /// Their frames.
    pub frames: usize,
}

impl LowPass {
    /// What it is, in words.
    pub const FILTER: &str = "Butterworth low-pass without delay, second order forwards and backwards";
    /// Consecutive frames that it takes at least.
    pub const FEWEST: usize = 10;

    /// Of a cut-off and the frames a second, both Hz.
    ///
    /// # Errors
    /// When the rate is unknown, or the cut-off is not between 0 and half of it.
    pub fn new(cutoff: f64, rate: f64) -> Result<Self> {
        ensure!(rate > 0.0 && rate.is_finite(), "the frame rate is not known, expected one to smooth by");
        ensure!(
            cutoff > 0.0 && cutoff < 0.5 * rate,
            "the cut-off is {cutoff} Hz, expected more than 0 and less than half of the {rate} frames a second (people move at 4 to 10 Hz)"
        );
        let winter = (SQRT_2 - 1.0).powf(0.25);
        let k = (PI * cutoff / rate).tan() / winter;
        let norm = 1.0 + SQRT_2 * k + k * k;
        let gain = k * k / norm;
        Ok(Self {
            cutoff,
            padding: ((rate / cutoff).ceil() as usize).max(Self::FEWEST - 1),
            forward: [gain, 2.0 * gain, gain],
            back: [2.0 * (k * k - 1.0) / norm, (1.0 - SQRT_2 * k + k * k) / norm],
        })
    }

    /// What was done, as files and reports say it.
    pub fn told(&self) -> String {
        format!("{} Hz (-3 dB after both passes): {}", self.cutoff, Self::FILTER)
    }

    /// The cut-off, Hz.
    pub fn cutoff(&self) -> f64 {
        self.cutoff
    }

    /// Smooths consecutive samples, [`Self::FEWEST`] or more; fewer stay as they are.
    pub fn smooth(&self, samples: &mut [f64]) {
        let count = samples.len();
        if count < Self::FEWEST {
            return;
        }
        let padding = self.padding.min(count - 1);
        let (first, last) = (samples[0], samples[count - 1]);
        // Turned about its ends: the motion goes on as it began and ended.
        let before = samples[1..=padding].iter().rev().map(|value| 2.0 * first - value);
        let after = samples[count - 1 - padding..count - 1].iter().rev().map(|value| 2.0 * last - value);
        let mut longer: Vec<f64> = before.chain(samples.iter().copied()).chain(after).collect();
        self.pass(longer.iter_mut());
        self.pass(longer.iter_mut().rev());
        samples.copy_from_slice(&longer[padding..padding + count]);
    }

    /// One pass, begun as if the first sample had always been there.
    fn pass<'a>(&self, samples: impl Iterator<Item = &'a mut f64>) {
        let ([b0, b1, b2], [a1, a2]) = (self.forward, self.back);
        let mut state = None;
        for sample in samples {
            let input = *sample;
            let [one, two] = state.unwrap_or([(1.0 - b0) * input, (b2 - a2) * input]);
            let output = b0 * input + one;
            state = Some([b1 * input - a1 * output + two, b2 * input - a2 * output]);
            *sample = output;
        }
    }

    /// Smooths the samples of each run by itself.
    pub fn smooth_runs(&self, samples: &mut [f64], runs: &[Range<usize>]) {
        for run in runs {
            if let Some(samples) = samples.get_mut(run.clone()) {
                self.smooth(samples);
            }
        }
    }

    /// The points smoothed, each between its gaps; and what was too short for it.
    ///
    /// # Errors
    /// When no point has as many consecutive frames as it takes.
    pub fn smooth_points(&self, points: &mut PointTrajectory) -> Result<LeftAsIs> {
        let (mut left, mut any) = (LeftAsIs::default(), false);
        for column in 0..points.names.len() {
            let there: Vec<bool> = points.frames.iter().map(|row| row[column].is_some()).collect();
            let runs = runs_of(&there);
            left.add(&runs);
            any |= runs.iter().any(|run| run.len() >= Self::FEWEST);
            for axis in 0..3 {
                let value = |row: &Vec<Option<DVec3>>| row[column].map_or(0.0, |point| point[axis]);
                let mut samples: Vec<f64> = points.frames.iter().map(value).collect();
                self.smooth_runs(&mut samples, &runs);
                for (row, value) in points.frames.iter_mut().zip(samples) {
                    if let Some(point) = &mut row[column] {
                        point[axis] = value;
                    }
                }
            }
        }
        ensure!(any, "no point is there in {} consecutive frames, which smoothing takes at least", Self::FEWEST);
        points.smoothed = Some(self.cutoff);
        Ok(left)
    }
}

impl LeftAsIs {
    /// Counts those of some runs that are too short.
    pub fn add(&mut self, runs: &[Range<usize>]) {
        for run in runs.iter().filter(|run| run.len() < LowPass::FEWEST) {
            self.runs += 1;
            self.frames += run.len();
        }
    }

    /// A sentence, where there is something to say.
    pub fn told(&self) -> Option<String> {
        (self.runs > 0).then(|| {
            format!(
                "{} stretches between gaps are shorter than {} frames and were not smoothed ({} frames)",
                self.runs,
                LowPass::FEWEST,
                self.frames
            )
        })
    }
}

/// The runs of samples that are there.
pub fn runs_of(there: &[bool]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for at in (0..there.len()).filter(|&at| there[at]) {
        match runs.last_mut() {
            Some(run) if run.end == at => run.end = at + 1,
            _ => runs.push(at..at + 1),
        }
    }
    runs
}

/// Takes whole turns out of a run of angles, radians: each is the nearest to the one before.
pub fn unwrap_angles(angles: &mut [f64]) {
    for at in 1..angles.len() {
        let turns = ((angles[at] - angles[at - 1]) / (2.0 * PI)).round();
        angles[at] -= 2.0 * PI * turns;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(frequency: f64, rate: f64, count: usize, phase: f64) -> Vec<f64> {
        (0..count).map(|at| (2.0 * PI * frequency * at as f64 / rate + phase).sin()).collect()
    }

    /// How much of a sine is left in the middle, and what stands across it (a delay).
    fn kept(cutoff: f64, frequency: f64, rate: f64) -> (f64, f64) {
        let count = (rate * 20.0) as usize;
        let [mut samples, own, across] = [0.0, 0.0, PI / 2.0].map(|phase| sine(frequency, rate, count, phase));
        LowPass::new(cutoff, rate).unwrap().smooth(&mut samples);
        let middle = count / 4..3 * count / 4;
        let along =
            |wave: &[f64]| 2.0 * middle.clone().map(|at| samples[at] * wave[at]).sum::<f64>() / middle.len() as f64;
        (along(&own), along(&across))
    }

    #[test]
    fn the_gain_is_that_of_the_filter_and_nothing_is_put_off() {
        for (cutoff, rate) in [(6.0, 60.0), (6.0, 100.0), (2.0, 25.0), (11.0, 25.0)] {
            for share in [0.25, 0.5, 1.0, 1.12] {
                let frequency = share * cutoff;
                let warp = |hz: f64| (PI * hz / rate).tan();
                let winter = 2.0_f64.sqrt() - 1.0;
                let expected = 1.0 / (1.0 + winter * (warp(frequency) / warp(cutoff)).powi(4));
                let (along, across) = kept(cutoff, frequency, rate);
                assert!(
                    (along - expected).abs() < 5e-3,
                    "{cutoff} Hz of {rate}: {along} at {frequency}, expected {expected}"
                );
                assert!(across.abs() < 5e-3, "{across}");
            }
            assert!((kept(cutoff, cutoff, rate).0 - 0.5_f64.sqrt()).abs() < 5e-3);
        }
    }

    #[test]
    fn what_does_not_change_stays_and_a_steady_motion_too() {
        let filter = LowPass::new(6.0, 50.0).unwrap();
        for slope in [0.0, 3.5] {
            let mut samples: Vec<f64> = (0..40).map(|at| 200.0 + slope * f64::from(at)).collect();
            let before = samples.clone();
            filter.smooth(&mut samples);
            let off = samples.iter().zip(&before).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 0.05 * slope + 1e-9, "{off} at a slope of {slope}");
        }
        let mut short = vec![1.0, -1.0, 1.0];
        filter.smooth(&mut short);
        assert_eq!(short, [1.0, -1.0, 1.0]);
    }

    #[test]
    fn gaps_part_the_points_and_short_stretches_are_said() {
        let noisy = |at: usize| DVec3::new(if at.is_multiple_of(2) { 10.0 } else { -10.0 }, at as f64, 5.0);
        let row = |at: usize| vec![(at != 20 && at != 25).then(|| noisy(at)), Some(noisy(at))];
        let mut points = PointTrajectory {
            names: vec!["a".into(), "b".into()],
            rate: 50.0,
            first_frame: 0,
            frames: (0..60).map(row).collect(),
            smoothed: None,
        };
        let left = LowPass::new(6.0, 50.0).unwrap().smooth_points(&mut points).unwrap();
        assert_eq!(left, LeftAsIs { runs: 1, frames: 4 });
        assert!(left.told().unwrap().contains("1 stretches between gaps are shorter than 10 frames"), "{left:?}");
        assert!(points.frames[20][0].is_none() && points.frames[22][0] == Some(noisy(22)));
        for column in 0..2 {
            let point = points.frames[10][column].unwrap();
            assert!(point.x.abs() < 0.5 && (point.y - 10.0).abs() < 0.2 && (point.z - 5.0).abs() < 1e-9, "{point}");
        }
        points.frames.truncate(9);
        let error = LowPass::new(6.0, 50.0).unwrap().smooth_points(&mut points).unwrap_err().to_string();
        assert!(error.contains("in 10 consecutive frames"), "{error}");
    }

    #[test]
    fn cut_offs_that_no_recording_has_are_sentences() {
        for cutoff in [0.0, -1.0, f64::NAN, 12.5, f64::INFINITY] {
            let error = LowPass::new(cutoff, 25.0).unwrap_err().to_string();
            assert!(error.contains("less than half of the 25 frames a second"), "{error}");
        }
        assert!(LowPass::new(6.0, 0.0).unwrap_err().to_string().contains("the frame rate is not known"));
    }

    #[test]
    fn whole_turns_are_taken_out() {
        let mut angles = [3.0, -3.0, -2.9, 3.1];
        unwrap_angles(&mut angles);
        for (angle, expected) in angles.iter().zip([3.0, 2.0 * PI - 3.0, 2.0 * PI - 2.9, 3.1]) {
            assert!((angle - expected).abs() < 1e-12, "{angles:?}");
        }
    }
}
