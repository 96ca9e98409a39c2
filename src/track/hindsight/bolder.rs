//! A second opinion on the path through the candidates (METHOD A14). They were found in every frame by itself, so they shake, and a limb that is
//! right but shakes loses to one that lies still at the wrong place; which of the two is worth more shows when both are settled.

use std::ops::Range;

use anyhow::Result;

use super::mending::{BOLDER, Mending, choose, jerk};
use super::refining::{self, Settled};
use super::scorer::{Candidate, apart};
use super::section::{Section, order};
use super::tracks::Track;
use super::window::Seen;

/// Times that the bolder path is searched again, before it is weighed.
const ROUNDS: usize = 4;

impl Mending<'_> {
    /// Adds candidates where the two paths are apart: tracks go on from the frames before and after, and from the frame that is worth most
    /// both ways, closer to where they lead than when limbs were looked for.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(super) fn retrace(
        &mut self,
        seen: &[&Seen],
        given: &[Vec<f32>],
        sections: &[Section],
        before: &[Settled],
        candidates: &mut [Vec<Candidate>],
    ) -> Result<()> {
        let Self { team, limbs, steps, .. } = self;
        let [calm, bold] = [1.0, BOLDER].map(|bolder| choose(candidates, before, bolder));
        let of_path = |path: &[usize]| -> Vec<Candidate> {
            candidates.iter().zip(path).map(|(candidates, &chosen)| candidates[chosen].clone()).collect()
        };
        let [calm, bold] = [of_path(&calm), of_path(&bold)];
        let are_apart: Vec<bool> = calm.iter().zip(&bold).map(|(a, b)| apart(&a.points, &b.points)).collect();
        let stretches = stretches(&are_apart, 0);
        let known = |t: Option<usize>| t.and_then(|t| calm.get(t)).cloned();
        let found = team.share(stretches.iter().cloned(), |scorer, stretch| {
            let mut candidates = candidates[stretch.clone()].to_vec();
            let [start, end, count] = [stretch.start, stretch.end, stretch.len()];
            let Some(best) = stretch.clone().max_by(|a, b| bold[*a].worth.total_cmp(&bold[*b].worth)) else {
                return Ok(candidates);
            };
            let sure = || [None, Some(bold[best].clone())];
            let ways = [
                ([2, 1].map(|back| known(start.checked_sub(back))), order(count, false), false),
                ([1, 0].map(|on| known(Some(end + on))), order(count, true), true),
                (sure(), (best + 1 - start..count).collect(), false),
                (sure(), order(best - start, true), true),
            ];
            let Some(Section { spread, .. }) = sections.iter().find(|section| section.frames.contains(&best)) else {
                return Ok(candidates);
            };
            for (last, order, is_back) in ways {
                let track = Track { limbs, given: &given[stretch.clone()], spread, steps, is_back };
                if last[1].is_some() {
                    track.retrace(scorer, &seen[stretch.clone()], &order, last, &mut candidates)?;
                }
            }
            Ok(candidates)
        })?;
        for (stretch, found) in stretches.into_iter().zip(found) {
            candidates[stretch].clone_from_slice(&found);
        }
        Ok(())
    }

    /// Takes the stretches of the bolder path that are worth more, once they are settled, than those of `poses`, which are.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(super) fn weigh_bolder(
        &mut self,
        seen: &[&Seen],
        sections: &[Section],
        bolder: &[Settled],
        poses: &mut [Settled],
    ) -> Result<()> {
        let Self { team, reach, .. } = self;
        let first = poses.len() - seen.len();
        let pairs = poses[first..].iter().zip(&bolder[first..]);
        let are_apart: Vec<bool> = pairs.map(|(a, b)| apart(&a.points, &b.points)).collect();
        let stretches = stretches(&are_apart, *reach);
        let searched: Vec<usize> = stretches.iter().cloned().flatten().collect();
        let mut tried = poses.to_vec();
        for &t in &searched {
            tried[first + t] = bolder[first + t].clone();
        }
        refining::refine(team, seen, &searched, sections, &mut tried, [*reach, ROUNDS])?;
        let are_better = team.share(stretches.iter().cloned(), |scorer, stretch| {
            // What lies around the stretch is the same in both.
            let around = (first + stretch.start).saturating_sub(2)..(first + stretch.end + 2).min(poses.len());
            let mut worth = [0.0; 2];
            for t in stretch {
                scorer.observe(&seen[t].observations)?;
                for (sum, path) in worth.iter_mut().zip([&*poses, &tried]) {
                    *sum += scorer.candidate(path[first + t].pose.clone())?.worth;
                }
            }
            for (sum, path) in worth.iter_mut().zip([&*poses, &tried]) {
                let triples = path[around.clone()].windows(3);
                let jerks = triples.map(|frames| jerk(&frames[0].points, &frames[1].points, &frames[2].points, BOLDER));
                *sum -= jerks.sum::<f64>();
            }
            Ok(worth[1] > worth[0])
        })?;
        for (stretch, _) in stretches.into_iter().zip(are_better).filter(|(_, is_better)| *is_better) {
            let within = first + stretch.start..first + stretch.end;
            poses[within.clone()].clone_from_slice(&tried[within]);
        }
        Ok(())
    }
}

/// The frames in a row that are marked, with `reach` of them on either side.
fn stretches(is_marked: &[bool], reach: usize) -> Vec<Range<usize>> {
    let mut stretches: Vec<Range<usize>> = Vec::new();
    for t in (0..is_marked.len()).filter(|&t| is_marked[t]) {
        let [start, end] = [t.saturating_sub(reach), (t + reach + 1).min(is_marked.len())];
        match stretches.last_mut() {
            Some(last) if last.end >= start => last.end = end,
            _ => stretches.push(start..end),
        }
    }
    stretches
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_are_what_is_marked_and_around_it() {
        let of = |text: &str, reach: usize| -> Vec<Range<usize>> {
            stretches(&text.chars().map(|letter| letter == 'x').collect::<Vec<_>>(), reach)
        };
        assert!(of("....", 2).is_empty());
        assert_eq!(of(".xx..x.", 0), [1..3, 5..6]);
        assert_eq!(of("x......x", 2), [0..3, 5..8]);
        assert_eq!(of("..x..x......x", 1), [1..7, 11..13]);
    }
}
