//! Which pictures of live views belong together, told by when they arrived.

use std::time::{Duration, Instant};

/// Pictures that arrived within this much of a frame of each other always belong together.
const CLOSE: f64 = 0.5;
/// Pictures that lie further apart than this are of different frames.
const FURTHEST: f64 = 0.97;
/// Where cameras offer nothing closer, sets may lie apart by the least that they offer and so much of a frame more, for times that shake;
const MARGIN: f64 = 0.25;
/// that least is forgotten by this much of what passes, for clocks that drift.
const FORGOTTEN: f64 = 0.2;
/// Before the first set of cameras that offer nothing close, what they offer is watched for so many frames and so long.
const WATCHED_FRAMES: f64 = 3.0;
const WATCHED: Duration = Duration::from_millis(500);

/// Puts pictures together. Cameras without a common trigger deliver at any phase of a frame: of all ways to cut the stream of their pictures
/// into sets, the one is kept whose pictures lie closest together.
#[derive(Debug)]
pub(super) struct Matching {
    /// Of a frame, s.
    frame: f64,
    /// When views were looked at first.
    since: Option<Instant>,
    /// What the newest pictures lay apart at least, s; of how many views, and when that was looked at.
    least: Option<(f64, usize, Instant)>,
    /// Sets, and what their pictures lay apart in sum, s.
    sets: (u64, f64),
}

impl Matching {
    /// At so many frames a second.
    pub(super) fn new(fps: f64) -> Self {
        Self { frame: fps.recip(), since: None, least: None, sets: (0, 0.0) }
    }

    /// Takes note of when the newest picture of every view came; to be told with each new one. Whether these are a set: their times, first and
    /// last.
    pub(super) fn of_one_frame(&mut self, newest: &[Instant]) -> Option<[Instant; 2]> {
        let (&first, &last) = (newest.iter().min()?, newest.iter().max()?);
        let apart = (last - first).as_secs_f64();
        let least = match self.least {
            Some((least, views, at)) if views == newest.len() => {
                apart.min(least + FORGOTTEN * last.saturating_duration_since(at).as_secs_f64())
            }
            _ => apart,
        };
        self.least = Some((least, newest.len(), last));
        let watched = (last - *self.since.get_or_insert(last)).as_secs_f64();
        let has_watched = watched >= WATCHED.as_secs_f64().max(WATCHED_FRAMES * self.frame);
        let offered = if has_watched { (least + MARGIN * self.frame).min(FURTHEST * self.frame) } else { 0.0 };
        (apart <= offered.max(CLOSE * self.frame)).then_some([first, last])
    }

    /// A set was made of pictures that came between these moments.
    pub(super) fn took(&mut self, [first, last]: [Instant; 2]) {
        self.sets.0 += 1;
        self.sets.1 += (last - first).as_secs_f64();
    }

    /// What the pictures of a set lay apart on average, s; of no set nothing.
    pub(super) fn apart(&self) -> Option<f64> {
        let (sets, sum) = self.sets;
        (sets > 0).then(|| sum / sets as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FPS: f64 = 30.0;

    /// What the pictures of each set lie apart, in frames, of cameras at these phases of a frame that deliver for so many frames, up to `shake`
    /// of a frame later than they should; `delivers` says which pictures come.
    fn sets(phases: &[f64], frames: usize, shake: f64, delivers: impl Fn(usize, usize) -> bool) -> Vec<f64> {
        let (mut state, begin) = (1_u32, Instant::now());
        let mut late = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            shake * f64::from(state >> 8) / f64::from(1 << 24)
        };
        let pictures =
            (0..frames).flat_map(|at| phases.iter().enumerate().map(move |(view, phase)| (at, view, *phase)));
        let pictures = pictures.filter(|(at, view, _)| delivers(*at, *view));
        let mut pictures: Vec<(f64, usize)> =
            pictures.map(|(at, view, phase)| (at as f64 + phase + late(), view)).collect();
        pictures.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut matching, mut newest, mut waits) =
            (Matching::new(FPS), vec![None; phases.len()], vec![false; phases.len()]);
        let (mut found, mut sum) = (Vec::new(), 0.0);
        for (time, view) in pictures {
            newest[view] = Some(begin + Duration::from_secs_f64(time / FPS));
            waits[view] = true;
            let Some(times) = newest.iter().copied().collect::<Option<Vec<_>>>() else { continue };
            if let Some(times) = matching.of_one_frame(&times)
                && waits.iter().all(|waits| *waits)
            {
                matching.took(times);
                waits.fill(false);
                found.push((times[1] - times[0]).as_secs_f64() * FPS);
                sum += (times[1] - times[0]).as_secs_f64();
            }
        }
        assert_eq!(matching.apart(), (!found.is_empty()).then(|| sum / found.len() as f64));
        found
    }

    /// What is left of a frame beside the widest gap between phases: no cut into sets can have less in each of them.
    fn closest(phases: &[f64]) -> f64 {
        let mut sorted = phases.to_vec();
        sorted.sort_by(f64::total_cmp);
        let gaps = (0..sorted.len()).map(|at| {
            let next = if at + 1 < sorted.len() { sorted[at + 1] } else { sorted[0] + 1.0 };
            next - sorted[at]
        });
        1.0 - gaps.fold(0.0, f64::max)
    }

    #[test]
    fn cameras_triggered_together_are_one_set_a_frame() {
        let found = sets(&[0.0, 0.02, 0.01, 0.0], 300, 0.1, |_, _| true);
        assert!(found.len() == 300 && found.iter().all(|apart| *apart < 0.13), "{} {found:?}", found.len());
        // A picture that never came takes its frame with it, and no other.
        let found = sets(&[0.0, 0.02, 0.01, 0.0], 300, 0.1, |at, view| (at, view) != (100, 2));
        assert!(found.len() == 299 && found.iter().all(|apart| *apart < 0.13), "{} {found:?}", found.len());
    }

    #[test]
    fn cameras_of_any_phases_are_put_together_as_close_as_they_can_be() {
        let mut apart = 0;
        for phases in [
            vec![0.0, 0.25, 0.5, 0.75],
            vec![0.0, 0.3, 0.45, 0.8],
            vec![0.9, 0.1, 0.2, 0.0],
            vec![0.0, 0.5],
            vec![0.1, 0.45, 0.8],
            vec![0.0, 0.2, 0.4, 0.6, 0.8, 0.95],
            vec![0.3, 0.31, 0.9, 0.92],
        ] {
            let closest = closest(&phases);
            apart += usize::from(closest > CLOSE);
            let found = sets(&phases, 300, 0.08, |_, _| true);
            // Fifteen frames are watched before the first set.
            assert!(found.len() >= 280, "{phases:?}: {} sets", found.len());
            let mean = found[20..].iter().sum::<f64>() / (found.len() - 20) as f64;
            assert!(mean < closest + 0.1, "{phases:?}: {mean} apart, {closest} would do");
            assert!(found.iter().all(|apart| *apart <= FURTHEST), "{phases:?}: {found:?}");
        }
        assert!(apart >= 3, "most of these have no half of a frame with all of them");
    }

    #[test]
    fn one_that_falls_out_of_step_is_followed() {
        // The last one's clock is 3 % slow: in 300 frames it goes round nine times.
        let drifting = |at: usize| 0.03 * at as f64;
        let (begin, mut matching) = (Instant::now(), Matching::new(FPS));
        let mut pictures: Vec<(f64, usize)> =
            (0..300).flat_map(|at| [(at as f64, 0), (at as f64 + 0.3, 1), (at as f64 + drifting(at), 2)]).collect();
        pictures.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut newest, mut waits, mut count) = ([begin; 3], [false; 3], 0);
        for (time, view) in pictures {
            newest[view] = begin + Duration::from_secs_f64(time / FPS);
            waits[view] = true;
            if matching.of_one_frame(&newest).is_some() && waits == [true; 3] {
                waits = [false; 3];
                count += 1;
            }
        }
        // It delivers 291 pictures while the others deliver 300.
        assert!(count > 260, "{count} sets");
    }
}
