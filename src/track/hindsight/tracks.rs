//! A track through a window, forwards or backwards: as a run's first pass, but with more starts at hand, and limbs looked for anew where
//! the pictures say that something is wrong.

use std::ops::Range;

use anyhow::Result;

use super::hypotheses::Limbs;
use super::scorer::{Candidate, Effort, Pull, Scorer, apart, most_under, most_worth};
use super::section::{Section, order};
use super::window::Seen;
use crate::features::SeenView;

/// Generations of a frame's search, and of one round a limb found anew or a poor frame.
const TRACKED: usize = 12;
const ANEW: usize = 20;
/// By how much a limb found anywhere must be worth more than the one that was tracked.
const CONVINCING: f64 = 8.0;
/// By how much a pose with a straight trunk must be worth more for all of it to be searched round.
const PROMISES: f64 = 3.0;
/// By how much less than the best frame of a window one is worth in which all limbs are looked for.
const POOR: f64 = 12.0;
/// What tells the random numbers of a track that is traced again from the others'.
const RETRACED: u64 = 1000;
/// The same of searches with a straight trunk.
const STRAIGHTENED: u64 = 500;
/// The same of one that goes on into the next section.
const WENT_ON: u64 = 2000;
/// The same of searches from where a track leads, beside those from a better start.
const LED: u64 = 4000;
/// The same of searches of bodies that face the other way.
const TURNED: u64 = 6000;
/// Frames of a section in which a body is tried facing the other way, in half of which at most its limbs are looked for; by how much less it is
/// worth before that where they are not.
const TRIED: usize = 4;
const HOPELESS: f64 = 60.0;
/// What facing along one's way is worth in a frame, and facing against it costs: of a fitness of 2/3, what it is to a first pose (METHOD A3).
const FORWARDS: f64 = 9.0;
/// Times that the limbs of a frame are looked for, and how many of those found are tried with all else moving along.
const RESCUES: u64 = 3;
const PROMISING: usize = 2;
/// Where a track expects joints: deviation at rest, mm, and as a share of the way in a frame.
const EXPECTED: [f64; 2] = [30.0, 0.5];
/// Share of a change that goes on in the next frame.
const GOES_ON: f32 = 0.7;
/// Share of these deviations for a track that is to be smooth.
const CALM: f64 = 0.5;
/// Distance of a joint from which poses are different, mm.
const DIFFERENT: f64 = 30.0;

/// What a search along a track is of the second pass's work on a frame, in parts of it.
pub(super) const SHARE: usize = 3;

/// The last two poses of a track, the last one last.
pub(super) type Ended = [Option<Candidate>; 2];

/// What a track found in a frame.
struct Found {
    /// What is worth most beside where the track leads.
    best: Candidate,
    /// What was found from another start, far from that one's.
    other: Option<Candidate>,
}

/// Where the frames before lead a track.
pub(super) struct Lead {
    /// Which of the starts are there; the others are of single limbs of the track there is. None in a track's first frame.
    pub(super) led: Range<usize>,
    /// Where joints are expected.
    pub(super) pull: Option<Pull>,
}

/// How to track.
pub(super) struct Track<'a> {
    pub(super) limbs: &'a Limbs,
    /// The track there is.
    pub(super) given: &'a [Vec<f32>],
    /// Width of the searches, and of those where something is wrong.
    pub(super) spread: &'a [f32],
    pub(super) steps: &'a [f32],
    pub(super) is_back: bool,
}

impl<'a> Track<'a> {
    /// Through a section of a window, of which `given` were found.
    pub(super) fn through(
        limbs: &'a Limbs,
        steps: &'a [f32],
        given: &'a [Vec<f32>],
        Section { frames, spread }: &'a Section,
        is_back: bool,
    ) -> Self {
        Self { limbs, given: &given[frames.clone()], spread, steps, is_back }
    }

    /// Tracks the frames in this order. What is found is added to the candidates of each, which are starts too; `most` is what the best frame is
    /// worth that is known. Where it ended.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(super) fn follow(
        &self,
        scorer: &mut Scorer<'_>,
        seen: &[&Seen],
        order: &[usize],
        most: &mut f64,
        candidates: &mut [Vec<Candidate>],
    ) -> Result<Ended> {
        let mut last: Ended = [None, None];
        for &t in order {
            let Found { best: mut chosen, other } =
                self.searched(scorer, seen[t], t, &last, &poses(&candidates[t]), (0, 1.0))?;
            // Where the track the other way ended nearly in this pose, having looked for its limbs, another look finds no more.
            let is = |what: fn(&Candidate) -> bool| {
                candidates[t].iter().any(|known| what(known) && !apart(&known.points, &chosen.points))
            };
            let [is_looked_at, is_looked_into] = [is(|known| known.is_looked_at), is(|known| known.is_looked_into)];
            chosen.is_looked_at = is_looked_at;
            let mut others =
                if is_looked_into { Vec::new() } else { self.mended(scorer, seen[t], &mut chosen, *most)? };
            if !is_looked_at && !is_looked_into {
                others.extend(self.tried_straight(scorer, seen[t], &mut chosen)?);
            }
            others.extend(other);
            *most = most.max(chosen.worth);
            if !self.is_back {
                let twins = self.limbs.twins.iter();
                let poses: Vec<_> =
                    twins.map(|twins| self.limbs.exchanged(*twins, &chosen.pose, scorer.space)).collect();
                let mut exchanged = scorer.candidates(&poses)?;
                if !exchanged.is_empty() {
                    others.push(exchanged.swap_remove(most_under(&exchanged, None)));
                }
            }
            others.retain(|other| is_different(other, &chosen));
            others.insert(0, chosen.clone());
            for other in others {
                if candidates[t].iter().all(|known| is_different(known, &other)) || other.pose == chosen.pose {
                    candidates[t].push(other);
                }
            }
            last = [last[1].take(), Some(chosen)];
            scorer.has_worked(SHARE)?;
        }
        Ok(last)
    }

    /// Goes on into these frames from the `last` two of others, up to where it comes to something that is known already. What is found is added to
    /// the candidates.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(super) fn go_on(
        &self,
        scorer: &mut Scorer<'_>,
        seen: &[&Seen],
        order: &[usize],
        mut last: Ended,
        candidates: &mut [Vec<Candidate>],
    ) -> Result<()> {
        for &t in order {
            let found = self.searched(scorer, seen[t], t, &last, &poses(&candidates[t]), (WENT_ON, 1.0))?;
            let is_known = candidates[t].iter().any(|known| !apart(&known.points, &found.best.points));
            add(found, &mut last, &mut candidates[t]);
            if is_known {
                break;
            }
        }
        Ok(())
    }

    /// Tracks the frames in this order on from the `last` two, closer to where these lead: limbs that were found in every frame by itself
    /// shake, and a joint that shakes is taken for one that is elsewhere. What is found is added to the candidates.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(super) fn retrace(
        &self,
        scorer: &mut Scorer<'_>,
        seen: &[&Seen],
        order: &[usize],
        mut last: Ended,
        candidates: &mut [Vec<Candidate>],
    ) -> Result<()> {
        for &t in order {
            let found = self.searched(scorer, seen[t], t, &last, &poses(&candidates[t]), (RETRACED, CALM))?;
            add(found, &mut last, &mut candidates[t]);
        }
        Ok(())
    }

    /// Tries the body facing the other way in some frames of a section: front and back look nearly alike, and a track that has arms and legs in
    /// their places the wrong way round does not turn any more. Where that is worth nearly as much once its limbs are looked for, a track goes on
    /// from there both ways, since what was searched all along looks better than what was not. What is found is added to the candidates.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(super) fn turn_round(
        &self,
        scorer: &mut Scorer<'_>,
        seen: &[&Seen],
        candidates: &mut [Vec<Candidate>],
    ) -> Result<()> {
        // Who walks does so forwards: what turning is worth by itself.
        let along = self.limbs.facing.map_or(0.0, |facing| facing.along(self.given));
        let forwards = -2.0 * FORWARDS * along;
        let Some((t, turned)) = self.turned(scorer, seen, candidates, forwards)? else { return Ok(()) };
        let most = most_worth(candidates.iter().flatten());
        for order in [order(t, true), (t + 1..seen.len()).collect()] {
            let mut last = [None, Some(turned.clone())];
            for t in order {
                let starts = self.limbs.turned_round(&self.given[t], scorer.space);
                let mut known = poses(&candidates[t]);
                known.extend(starts.iter().flatten().map(|start| &start[..]));
                let Found { mut best, other } = self.searched(scorer, seen[t], t, &last, &known, (TURNED, 1.0))?;
                let others = self.mended(scorer, seen[t], &mut best, most)?;
                let found = [best.clone()].into_iter().chain(other).chain(others);
                candidates[t].extend(found.map(|found| Candidate { worth: found.worth + forwards, ..found }));
                last = [last[1].take(), Some(best)];
            }
        }
        candidates[t].push(Candidate { worth: turned.worth + forwards, ..turned });
        Ok(())
    }

    /// The frame of a section, and its pose, in which the body facing the other way is worth most beside what was found, where that is nearly
    /// as much; `forwards` is what turning is worth besides.
    fn turned(
        &self,
        scorer: &mut Scorer<'_>,
        seen: &[&Seen],
        candidates: &[Vec<Candidate>],
        forwards: f64,
    ) -> Result<Option<(usize, Candidate)>> {
        let limbs: Vec<usize> = (0..self.limbs.count()).collect();
        let mut tried = Vec::new();
        for t in (0..TRIED).map(|nth| (2 * nth + 1) * seen.len() / (2 * TRIED)) {
            scorer.observe(&seen[t].observations)?;
            let facing = &candidates[t][most_under(&candidates[t], None)];
            let worth = facing.worth;
            let Some(poses) = self.limbs.turned_round(&facing.pose, scorer.space) else { return Ok(None) };
            let starts = scorer.candidates(&poses)?;
            let start = &starts[most_under(&starts, None)].pose;
            let turned = self.settled(scorer, seen[t].index, start, TURNED)?;
            tried.push((worth, t, turned));
        }
        let gain = |(worth, _, turned): &(f64, usize, Candidate)| turned.worth + forwards - worth;
        tried.sort_by(|a, b| gain(b).total_cmp(&gain(a)));
        tried.truncate(TRIED / 2);
        tried.retain(|tried| gain(tried) > -HOPELESS);
        for (_, t, turned) in &mut tried {
            scorer.observe(&seen[*t].observations)?;
            self.rescued(scorer, seen[*t], turned, &limbs)?;
        }
        tried.sort_by(|a, b| gain(b).total_cmp(&gain(a)));
        Ok(tried.into_iter().find(|tried| gain(tried) > -POOR).map(|(_, t, turned)| (t, turned)))
    }

    /// What a search of frame `t` finds from the best of its `known` poses and of where the `last` two lead, with a number that tells its random
    /// numbers apart, and a share of the deviations from there. A candidate was searched before, where the track leads was not, and what is
    /// searched looks better than it is: where the two are far apart, both are searched before one is chosen. Else a track that comes to a
    /// stretch in which another has legs exchanged would go over to that.
    ///
    /// # Errors
    /// When the evaluator fails.
    fn searched(
        &self,
        scorer: &mut Scorer<'_>,
        seen: &Seen,
        t: usize,
        last: &Ended,
        known: &[&[f32]],
        (number, share): (u64, f64),
    ) -> Result<Found> {
        scorer.observe(&seen.observations)?;
        let mut starts: Vec<Vec<f32>> = known.iter().map(|pose| pose.to_vec()).collect();
        let Lead { led, mut pull } = self.lead(scorer, t, last, &mut starts);
        pull.iter_mut().flat_map(|pull| &mut pull.scales).for_each(|scale| *scale *= share);
        let pull = pull.as_ref();
        let scored = scorer.candidates(&starts)?;
        let generations = scorer.generations(TRACKED);
        let mut search = |start: usize, number: u64| {
            let effort = Effort { spread: self.spread, generations, turn: self.turn(number) };
            scorer.search_all(seen.index, &starts[start], effort, pull)
        };
        let start = most_under(&scored, pull);
        let best = search(start, number)?;
        let own = (!led.is_empty()).then(|| led.start + most_under(&scored[led], pull));
        let Some(own) = own.filter(|&own| apart(&scored[own].points, &scored[start].points)) else {
            return Ok(Found { best, other: None });
        };
        let mut both = vec![best, search(own, LED + number)?];
        let best = both.swap_remove(most_under(&both, pull));
        Ok(Found { best, other: both.pop() })
    }

    /// What tells the random numbers of this track's searches apart.
    fn turn(&self, number: u64) -> u64 {
        2 * number + u64::from(self.is_back)
    }

    /// Where the frames before lead: starts, and where joints are expected.
    pub(super) fn lead(
        &self,
        scorer: &Scorer<'_>,
        t: usize,
        [earlier, last]: &Ended,
        starts: &mut Vec<Vec<f32>>,
    ) -> Lead {
        let first = starts.len();
        let Some(last) = last else { return Lead { led: first..first, pull: None } };
        let mut ahead = last.pose.clone();
        let mut speeds = vec![0.0; last.points.len()];
        if let Some(earlier) = earlier {
            let changes = ahead.iter_mut().zip(&earlier.pose);
            changes.for_each(|(value, earlier)| *value += GOES_ON * (*value - earlier));
            scorer.space.clamp(&mut ahead);
            speeds = last.points.iter().zip(&earlier.points).map(|(a, b)| a.distance(*b)).collect();
        }
        starts.extend([last.pose.clone(), ahead.clone()]);
        let led = first..starts.len();
        for limb in 0..self.limbs.count() {
            starts.push(self.limbs.with(limb, &ahead, &self.given[t]));
            starts.push(self.limbs.with(limb, &self.given[t], &ahead));
        }
        let scales = speeds.iter().map(|speed| EXPECTED[0] + EXPECTED[1] * speed).collect();
        Lead { led, pull: Some(Pull { targets: scorer.shape.points(&ahead), scales }) }
    }

    /// Looks for limbs anew: those of which the pictures say more elsewhere, all where the frame is worth less than the `most` of others,
    /// and else another one every frame. What was found and not `chosen`.
    fn mended(
        &self,
        scorer: &mut Scorer<'_>,
        seen: &Seen,
        chosen: &mut Candidate,
        most: f64,
    ) -> Result<Vec<Candidate>> {
        let suspicious = if chosen.worth < most - POOR {
            (0..self.limbs.count()).collect()
        } else if chosen.is_looked_at {
            Vec::new()
        } else {
            self.limbs.suspicious(scorer, seen, &chosen.pose)?
        };
        if !suspicious.is_empty() {
            return self.rescued(scorer, seen, chosen, &suspicious);
        }
        chosen.is_looked_at = true;
        let index = seen.index;
        let mut others = Vec::new();
        let Some(limb) = index.checked_rem(self.limbs.count()) else { return Ok(others) };
        let mut elsewhere = self.limbs.anywhere(scorer, index, limb, &chosen.pose, self.turn(10 + limb as u64))?;
        let is_convincing = elsewhere.worth > chosen.worth + CONVINCING;
        if is_convincing {
            std::mem::swap(chosen, &mut elsewhere);
        }
        others.push(elsewhere);
        if is_convincing {
            self.settle(scorer, index, chosen, &mut others)?;
        }
        Ok(others)
    }

    /// Looks for the limbs of a trunk that is turned far once more, with the trunk straight: where an arm was lost, the other one is reached with
    /// a trunk turned the wrong way, which looks much the same by itself. What was found and not `chosen`.
    fn tried_straight(
        &self,
        scorer: &mut Scorer<'_>,
        seen: &Seen,
        chosen: &mut Candidate,
    ) -> Result<Option<Candidate>> {
        let Some((pose, limbs)) = self.limbs.straightened(&chosen.pose, scorer.space) else { return Ok(None) };
        let views = SeenView::all(&seen.observations);
        let mut other = scorer.candidate(pose)?;
        for &limb in limbs {
            let turn = self.turn(STRAIGHTENED + 1 + limb as u64);
            other = self.limbs.ends_inward(scorer, &views, seen.index, limb, &other.pose, turn)?;
        }
        if other.worth > chosen.worth + PROMISES {
            other = self.settled(scorer, seen.index, &other.pose, STRAIGHTENED)?;
        }
        if other.worth > chosen.worth + CONVINCING {
            std::mem::swap(chosen, &mut other);
        }
        Ok(Some(other))
    }

    /// Looks for `limbs`, again and again as long as one is found. The most promising of them are tried with all else moving along, whatever they
    /// are worth by themselves, unless they are where they were: an arm that is found explains little while the trunk still stands as it did without it.
    fn rescued(
        &self,
        scorer: &mut Scorer<'_>,
        seen: &Seen,
        chosen: &mut Candidate,
        limbs: &[usize],
    ) -> Result<Vec<Candidate>> {
        let index = seen.index;
        let mut others = Vec::new();
        self.settle(scorer, index, chosen, &mut others)?;
        for attempt in 1..=RESCUES {
            let turn = |limb: usize| self.turn(100 * attempt + 10 + limb as u64);
            let views = SeenView::all(&seen.observations);
            let mut found = limbs
                .iter()
                .map(|&limb| self.limbs.ends_inward(scorer, &views, index, limb, &chosen.pose, turn(limb)))
                .collect::<Result<Vec<_>>>()?;
            found.sort_by(|a, b| b.worth.total_cmp(&a.worth));
            // Round what was found where it was before all was searched just now.
            let promising = found.iter().take(PROMISING).enumerate().filter(|(_, found)| is_different(found, chosen));
            for (rank, promising) in promising {
                others.push(self.settled(scorer, index, &promising.pose, 100 * attempt + 1 + rank as u64)?);
            }
            others.extend(found);
            let best = most_under(&others, None);
            if others[best].worth <= chosen.worth + CONVINCING {
                break;
            }
            std::mem::swap(chosen, &mut others[best]);
        }
        chosen.is_looked_into = true;
        Ok(others)
    }

    /// Searches round what is chosen; where that is worth more, what was chosen is one of the others.
    fn settle(
        &self,
        scorer: &mut Scorer<'_>,
        index: usize,
        chosen: &mut Candidate,
        others: &mut Vec<Candidate>,
    ) -> Result<()> {
        let settled = self.settled(scorer, index, &chosen.pose, 1)?;
        if settled.worth > chosen.worth {
            others.push(std::mem::replace(chosen, settled));
        }
        Ok(())
    }

    /// A pose with all of it searched round with the body's steps.
    fn settled(&self, scorer: &mut Scorer<'_>, index: usize, pose: &[f32], number: u64) -> Result<Candidate> {
        let effort = Effort { spread: self.steps, generations: scorer.generations(ANEW), turn: self.turn(number) };
        scorer.search_all(index, pose, effort, None)
    }
}

fn poses(candidates: &[Candidate]) -> Vec<&[f32]> {
    candidates.iter().map(|candidate| &candidate.pose[..]).collect()
}

/// Adds what a track found to the candidates of its frame.
fn add(found: Found, last: &mut Ended, candidates: &mut Vec<Candidate>) {
    candidates.push(found.best.clone());
    candidates.extend(found.other);
    *last = [last[1].take(), Some(found.best)];
}

fn is_different(one: &Candidate, other: &Candidate) -> bool {
    one.points.iter().zip(&other.points).any(|(a, b)| a.distance_squared(*b) > DIFFERENT * DIFFERENT)
}
