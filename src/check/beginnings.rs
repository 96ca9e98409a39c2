//! Were the cameras started at different moments? What their files make likely, lengths and clocks, is a guess to the second at best: so
//! about each guess the cameras are put together one after the other, and the guess with which all silhouettes agree is believed.

use std::ops::Range;

use anyhow::Result;
use rayon::prelude::*;

use super::agreement::{CAP, FEWER_RAYS, Moment, disagreements, percent_explained, rays, rays_of};
use super::partners::fewer;
use super::silhouettes::Silhouettes;
use super::timing::FAR_RAYS;
use crate::geometry::Camera;
use crate::observe::Advance;
use crate::sequence::Sequence;

/// Where every view's border is explained by this part, %, the cameras are together.
const TOGETHER: f64 = 60.0;
/// What a guess must explain more of the borders, on average, than the pictures as they are, %.
const MORE: f64 = 15.0;
/// Guesses that are tried at most.
const MOST_GUESSES: usize = 4;
/// Frames a second that are looked through one by one; at higher rates steps are as long in time, and go on by single frames about the best.
const EACH: f64 = 30.0;
/// Times that each camera is looked for again, beside all others.
const ROUNDS: usize = 1;
/// Places as good as the best one, but for this part of its disagreement: the nearest to the guess of them is meant.
const AS_GOOD: f64 = 0.03;
/// Part of the samples that a place must have.
const SAMPLES: f64 = 0.4;

/// Cameras that were started at different moments, put together.
pub(super) struct Beginnings {
    /// The sequence with them together.
    pub(super) sequence: Sequence,
    pub(super) silhouettes: Silhouettes,
    /// Frames by which each view's pictures come too late; 0 for as many as can be.
    pub(super) delays: Vec<isize>,
    /// The part of the views' borders that is explained by the others, %, as the pictures are and together.
    pub(super) explained: [f64; 2],
}

/// Looks for the delays of a sequence whose files make some likely and whose silhouettes, those of `frames`, do not agree as they are; none
/// where nothing is likely, all is well, or no delays better it by much.
///
/// # Errors
/// When a picture cannot be read.
pub(super) fn beginnings(
    sequence: &Sequence,
    silhouettes: &Silhouettes,
    frames: &Range<usize>,
    samples: usize,
    reach: usize,
    progress: &mut Advance<'_>,
) -> Result<Option<Beginnings>> {
    let guesses = sequence.likely_delays();
    let as_they_are = explained(&sequence.cameras, &silhouettes.moments());
    if guesses.is_empty() || least(&as_they_are) >= TOGETHER {
        return Ok(None);
    }
    let mut best: Option<(f64, Vec<f64>)> = None;
    for guess in guesses.into_iter().take(MOST_GUESSES) {
        let Ok(guessed) = sequence.delayed(&guess) else { continue };
        let frames = frames.start..frames.end.min(guessed.frame_count);
        if frames.is_empty() {
            continue;
        }
        let mut wide = Silhouettes::read(&guessed, frames, samples, progress)?;
        let all: Vec<usize> = (0..guessed.views.len()).collect();
        let mut shifts = vec![0; all.len()];
        if !agree(&guessed.cameras, &wide) {
            wide = wide.widened(&guessed, &all, reach, progress)?;
            let first = guess.iter().position(|delay| *delay == 0.0).unwrap_or(0);
            shifts = put_together(&guessed.cameras, &wide, first, (sequence.fps / EACH).round().max(1.0) as usize);
        }
        let moments = moved(&wide, &shifts);
        let found = explained(&guessed.cameras, &moments);
        let is_enough = moments.len() as f64 >= SAMPLES * wide.samples.len() as f64;
        if is_enough && least(&found) >= TOGETHER && best.as_ref().is_none_or(|(before, _)| mean(&found) > *before) {
            let delays = guess.iter().zip(&shifts).map(|(guess, shift)| guess + *shift as f64).collect();
            best = Some((mean(&found), delays));
        }
    }
    let Some((after, delays)) = best.filter(|(after, _)| *after >= mean(&as_they_are) + MORE) else { return Ok(None) };
    let delays = fewest(&delays);
    let sequence = sequence.delayed(&delays.iter().map(|delay| *delay as f64).collect::<Vec<f64>>())?;
    let frames = frames.start..frames.end.min(sequence.frame_count);
    let silhouettes = Silhouettes::read(&sequence, frames, samples, progress)?;
    Ok(Some(Beginnings { sequence, silhouettes, delays, explained: [mean(&as_they_are), after] }))
}

/// Whether the views agree as they are.
pub(super) fn agree(cameras: &[Camera], silhouettes: &Silhouettes) -> bool {
    least(&explained(cameras, &silhouettes.moments())) >= TOGETHER
}

/// The same delays with as many as can be 0, of as many the latest: only differences count.
fn fewest(delays: &[f64]) -> Vec<isize> {
    let whole: Vec<isize> = delays.iter().map(|delay| delay.round() as isize).collect();
    let alike = |delay: isize| whole.iter().filter(|other| **other == delay).count();
    let usual = whole.iter().copied().max_by_key(|delay| (alike(*delay), *delay)).unwrap_or(0);
    whole.iter().map(|delay| delay - usual).collect()
}

/// How many frames to move each view by, beside `first`: the one that agrees best with those that are placed is placed next; then each is
/// placed once more, beside all others.
fn put_together(cameras: &[Camera], wide: &Silhouettes, first: usize, step: usize) -> Vec<isize> {
    let views = cameras.len();
    let mut shifts = vec![0; views];
    let mut placed = vec![first];
    while placed.len() < views {
        let others: Vec<usize> = (0..views).filter(|view| !placed.contains(view)).collect();
        let places = others.par_iter().map(|&view| place(cameras, wide, &shifts, &placed, view, step));
        let places: Vec<Option<(isize, f64)>> = places.collect();
        let found = others.iter().zip(places).filter_map(|(view, place)| place.map(|place| (*view, place)));
        let Some((view, (shift, _))) = found.min_by(|a, b| a.1.1.total_cmp(&b.1.1)) else { return shifts };
        shifts[view] = shift;
        placed.push(view);
    }
    for view in (0..ROUNDS).flat_map(|_| placed[1..].to_vec()) {
        let others: Vec<usize> = placed.iter().copied().filter(|other| *other != view).collect();
        if let Some((shift, _)) = place(cameras, wide, &shifts, &others, view, step) {
            shifts[view] = shift;
        }
    }
    shifts
}

/// Where one view agrees best with `others`, each moved by its own shift: its shift, and the disagreement there, pixels.
fn place(
    cameras: &[Camera],
    wide: &Silhouettes,
    shifts: &[isize],
    others: &[usize],
    view: usize,
    step: usize,
) -> Option<(isize, f64)> {
    let mut group = others.to_vec();
    group.push(view);
    group.sort_unstable();
    let own: Vec<Camera> = group.iter().map(|&view| cameras[view].clone()).collect();
    let count = fewer(FAR_RAYS, own.len());
    let fewest = (SAMPLES * wide.samples.len() as f64).ceil().max(1.0) as usize;
    let disagreement = |shift: isize| -> Option<(isize, f64)> {
        let moment = |&sample: &usize| {
            let moment = wide.moment(sample, |other| if other == view { shift } else { shifts[other] })?;
            let own: Moment = group.iter().map(|&view| moment[view]).collect();
            own.iter().all(Option::is_some).then_some(own)
        };
        let moments: Vec<Moment> = wide.samples.iter().filter_map(moment).collect();
        let found: Vec<f64> = disagreements(&rays_of(&own, &moments, count, |_| true), moments.len(), CAP)
            .into_iter()
            .flatten()
            .collect();
        (found.len() >= fewest).then(|| (shift, mean(&found)))
    };
    let (reach, beside) = (wide.reach as isize, step as isize - 1);
    let best = |places: &mut dyn Iterator<Item = isize>| {
        let found: Vec<(isize, f64)> = places.filter_map(disagreement).collect();
        let least = found.iter().map(|(_, value)| *value).fold(f64::INFINITY, f64::min);
        let good = found.into_iter().filter(|(_, value)| *value <= least * (1.0 + AS_GOOD));
        good.min_by_key(|(shift, _)| shift.unsigned_abs())
    };
    let (about, _) = best(&mut (-reach..=reach).step_by(step))?;
    best(&mut (about - beside..=about + beside))
}

fn moved<'a>(wide: &'a Silhouettes, shifts: &[isize]) -> Vec<Moment<'a>> {
    wide.samples.iter().filter_map(|&sample| wide.moment(sample, |view| shifts[view])).collect()
}

/// The part of each view's border that the others explain, %.
fn explained(cameras: &[Camera], moments: &[Moment]) -> Vec<f64> {
    let rays = rays(cameras, moments, FEWER_RAYS);
    (0..cameras.len()).map(|view| percent_explained(rays.iter().filter(|ray| ray.view == view))).collect()
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_few_delays_as_can_be_are_named() {
        assert_eq!(fewest(&[0.0, -60.0, -60.0, -61.0]), [60, 0, 0, -1]);
        assert_eq!(fewest(&[0.0, -60.0]), [0, -60]);
        assert_eq!(fewest(&[0.0, -7.0, 0.0, -9.0]), [0, -7, 0, -9]);
    }
}
