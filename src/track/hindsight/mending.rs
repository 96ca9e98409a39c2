//! The frames of a window together: tracks through them, the path that is worth most, every frame searched again beside its neighbours.

use anyhow::Result;
use glam::DVec3;

use super::ambiguity::ambiguities;
use super::hypotheses::Limbs;
use super::path::{Costs, Ways};
use super::refining::{self, Settled};
use super::scorer::{Candidate, most_worth, robust};
use super::section::{SECTION, Section, order, pieces};
use super::team::Team;
use super::tracks::{Ended, Track};
use super::window::Seen;
use crate::body::Body;
use crate::geometry::Camera;
use crate::search::SearchSpace;

/// Frames on either side of a section that tell how widely to search it.
const AROUND: usize = 24;

/// Width of the searches, as a share of the track's changes, and of the body's steps at least and at most.
const WIDTH: f32 = 0.5;
const WIDTHS: [f32; 2] = [0.25, 2.0];
/// What a joint may jerk along a path: deviation at rest, mm, and as a share of the way in a frame. Small, since that way is long too where a
/// path leaps from one candidate to another.
const JERK: [f64; 2] = [10.0, 0.05];
/// How many times as far joints may jerk along the bolder path.
pub(super) const BOLDER: f64 = 10.0;
/// How far a joint may go from the first frame to the second, mm.
const FIRST: f64 = 100.0;

/// The second pass over windows of a run.
pub(super) struct Mending<'a> {
    pub(super) team: Team<'a>,
    pub(super) limbs: Limbs,
    /// The body's, from a frame to the next.
    pub(super) steps: Vec<f32>,
    /// How many frames on either side tell of a frame.
    pub(super) reach: usize,
    /// How many frames a section has at least.
    pub(super) section: usize,
}

impl<'a> Mending<'a> {
    pub(super) fn new(team: Team<'a>, space: &SearchSpace, body: &Body, cameras: &[Camera], fps: f64) -> Result<Self> {
        let steps = space.spread(1.0 / fps)?;
        let limbs = Limbs::new(body, cameras, space);
        Ok(Self { limbs, team, steps, reach: refining::reach(fps), section: SECTION })
    }

    /// The poses of a window's frames, of which `given` were found, after those of `before`, and how ambiguous each joint of each is, mm.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(super) fn mend(
        &mut self,
        seen: &[&Seen],
        given: &[Vec<f32>],
        before: &[Settled],
    ) -> Result<(Vec<Settled>, Vec<Vec<f32>>)> {
        let sections = self.sections(given);
        let mut candidates = self.tracked(seen, given, &sections)?;
        self.retrace(seen, given, &sections, before, &mut candidates)?;
        let path = |chosen: Vec<usize>| -> Vec<Settled> {
            let of = |((seen, candidates), chosen): ((&&Seen, &Vec<Candidate>), usize)| {
                let Candidate { pose, points, .. } = &candidates[chosen];
                Settled { frame: seen.index, pose: pose.clone(), points: points.clone() }
            };
            before.iter().cloned().chain(seen.iter().zip(&candidates).zip(chosen).map(of)).collect()
        };
        let (chosen, losses) = over_paths(&candidates, before, 1.0, |ways| (ways.best(), ways.losses()));
        let mut poses = path(chosen);
        let bolder = path(choose(&candidates, before, BOLDER));
        let all: Vec<usize> = (0..seen.len()).collect();
        refining::refine(&mut self.team, seen, &all, &sections, &mut poses, [self.reach, refining::ROUNDS])?;
        self.weigh_bolder(seen, &sections, &bolder, &mut poses)?;
        poses.drain(..before.len());
        let ambiguities = ambiguities(&poses, &candidates, &losses, self.reach);
        Ok((poses, ambiguities))
    }

    /// The sections of a window.
    pub(super) fn sections(&self, given: &[Vec<f32>]) -> Vec<Section> {
        let count = pieces(given.len(), self.section);
        let section = |nth: usize| {
            let [start, end] = [nth, nth + 1].map(|nth| nth * given.len() / count);
            let around = start.saturating_sub(AROUND)..(end + AROUND).min(given.len());
            Section { frames: start..end, spread: widths(&self.steps, &given[around]) }
        };
        (0..count).map(section).collect()
    }

    /// What tracks find through each section, both ways, and where they go on into the next.
    fn tracked(&mut self, seen: &[&Seen], given: &[Vec<f32>], sections: &[Section]) -> Result<Vec<Vec<Candidate>>> {
        let Self { team, limbs, steps, .. } = self;
        // What was given stays a candidate.
        let first = team.share(seen.iter().zip(given), |scorer, (seen, pose)| {
            scorer.observe(&seen.observations)?;
            scorer.candidates(std::slice::from_ref(pose))
        })?;
        let most = most_worth(first.iter().flatten());
        let found = team.share(sections.iter(), |scorer, section| {
            let seen = &seen[section.frames.clone()];
            let mut candidates = first[section.frames.clone()].to_vec();
            let mut most = most;
            let mut follow = |is_back: bool| {
                let track = Track::through(limbs, steps, given, section, is_back);
                track.follow(scorer, seen, &order(seen.len(), is_back), &mut most, &mut candidates)
            };
            let ends = [follow(true)?, follow(false)?];
            Track::through(limbs, steps, given, section, false).turn_round(scorer, seen, &mut candidates)?;
            Ok((candidates, ends))
        })?;
        let (candidates, ends): (Vec<_>, Vec<[Ended; 2]>) = found.into_iter().unzip();
        let met =
            team.share(sections.iter().zip(candidates).enumerate(), |scorer, (at, (section, mut candidates))| {
                let seen = &seen[section.frames.clone()];
                let came = [ends.get(at + 1).map(|[back, _]| back), at.checked_sub(1).map(|before| &ends[before][1])];
                for (came, is_back) in came.into_iter().zip([true, false]) {
                    if let Some(last) = came {
                        let track = Track::through(limbs, steps, given, section, is_back);
                        track.go_on(scorer, seen, &order(seen.len(), is_back), last.clone(), &mut candidates)?;
                    }
                }
                Ok(candidates)
            })?;
        Ok(met.into_iter().flatten().collect())
    }
}

/// What it costs joints to be at `a`, `b` and `c` one after the other, where they may jerk `bolder` times as far as usual.
pub(super) fn jerk(a: &[DVec3], b: &[DVec3], c: &[DVec3], bolder: f64) -> f64 {
    let joints = a.iter().zip(b).zip(c).map(|((a, b), c)| {
        let scale = bolder * (JERK[0] + JERK[1] * 0.5 * a.distance(*c));
        robust((*a + *c - 2.0 * *b).length_squared() / (scale * scale))
    });
    joints.sum()
}

/// How wide to search around a track: by how much its degrees of freedom change, and by the body's steps.
pub(super) fn widths(steps: &[f32], track: &[Vec<f32>]) -> Vec<f32> {
    let width = |(d, step): (usize, &f32)| {
        let squares = track.windows(2).map(|pair| (pair[1][d] - pair[0][d]).powi(2));
        let change = (squares.sum::<f32>() / track.len().max(2) as f32).sqrt();
        (WIDTH * change).clamp(WIDTHS[0] * step, WIDTHS[1] * step)
    };
    steps.iter().enumerate().map(width).collect()
}

/// The path through the candidates, going on from the frames before, along which joints may jerk `bolder` times as far as usual.
pub(super) fn choose(candidates: &[Vec<Candidate>], before: &[Settled], bolder: f64) -> Vec<usize> {
    over_paths(candidates, before, bolder, |ways| ways.best())
}

/// What `work` says of all these paths.
fn over_paths<T>(
    candidates: &[Vec<Candidate>],
    before: &[Settled],
    bolder: f64,
    work: impl FnOnce(&Ways<'_>) -> T,
) -> T {
    let settled = &before[before.len().saturating_sub(2)..];
    let mut worth: Vec<Vec<f64>> = settled.iter().map(|_| vec![0.0]).collect();
    worth.extend(candidates.iter().map(|found| found.iter().map(|candidate| candidate.worth).collect()));
    let points = |t: usize, k: usize| -> &[DVec3] {
        if t < settled.len() { &settled[t].points } else { &candidates[t - settled.len()][k].points }
    };
    let first = |j: usize, k: usize| {
        let pairs = points(0, j).iter().zip(points(1, k));
        pairs.map(|(a, b)| robust(a.distance_squared(*b) / (FIRST * FIRST))).sum::<f64>()
    };
    let then = |t, i, j, k| jerk(points(t - 2, i), points(t - 1, j), points(t, k), bolder);
    work(&Ways::new(worth, settled.len(), Costs { first: &first, then: &then }))
}
