//! Other poses that a frame may have than the one its track gave it (METHOD A14): limbs taken from one track or the other, limbs of the
//! two sides exchanged, limbs looked for everywhere within their limits.

use std::f32::consts::PI;

use anyhow::Result;
use rayon::prelude::*;

use super::scorer::{Candidate, Effort, Scorer, most_under};
use super::window::Seen;
use crate::body::{Body, Dof, DofAxis};
use crate::features::SeenView;
use crate::geometry::Camera;
use crate::search::SearchSpace;
use crate::track::glance::{Glances, Lattice, are_elsewhere};
use crate::track::worth::Facing;

/// Poses of a limb tried all over its limits, and generations that go on from the best of them.
const SCATTERED: usize = 96;
const GENERATIONS: usize = 4;
/// Width of that search, as a share of the limits.
const WIDTH: f32 = 0.12;
/// Poses of a limb that are looked at, and how many of them are tried, those that the pictures say most for.
const LOOKED_AT: usize = 2048;
const SIGHTED: usize = 48;
/// By how much more must be said of a limb elsewhere than of where it is thought, for it to be looked for.
const SUSPICIOUS: f32 = 0.2;
/// Share of its limit from which on a trunk is turned so far that it is tried straight.
const TURNED: f32 = 0.5;

/// The limbs of a body.
#[derive(Clone, Debug)]
pub(super) struct Limbs {
    glances: Glances,
    /// Pairs of limbs with the same joints on either side.
    pub(super) twins: Vec<[usize; 2]>,
    turns: Vec<Turn>,
    /// Of every degree of freedom, whose value it has, and with which sign, where the body faces the other way.
    sides: Vec<(usize, f32)>,
    /// None of a body that does not turn.
    pub(super) facing: Option<Facing>,
}

/// A degree of freedom by which the trunk turns about its own axis, where it is round, and the limbs that turn with it.
#[derive(Clone, Debug)]
struct Turn {
    dof: usize,
    limbs: Vec<usize>,
}

impl Limbs {
    pub(super) fn new(body: &Body, cameras: &[Camera], space: &SearchSpace) -> Self {
        let glances = Glances::new(body, cameras, space);
        let names = body.dof_names();
        let of_dofs: Vec<(usize, &Dof)> = body.dofs().collect();
        let hangs_on = |limb: &[usize], trunk: usize| {
            let first = limb.first().map(|&d| of_dofs[d].0);
            std::iter::successors(first, |&bone| body.bones[bone].parent).any(|bone| bone == trunk)
        };
        let turn = |(d, (bone, dof)): (usize, &(usize, &Dof))| {
            let is_turn = space.groups()[d] == 0 && dof.axis == DofAxis::Rz && body.bones[*bone].parent.is_some();
            let limbs = || (0..glances.limbs().len()).filter(|&limb| hangs_on(glances.limb(limb), *bone)).collect();
            is_turn.then(|| Turn { dof: d, limbs: limbs() })
        };
        let turns = of_dofs.iter().enumerate().filter_map(turn).collect();
        let is_root = |bone: usize| body.bones[bone].parent.is_none();
        let other_side = |name: &str| {
            let sides = [("left_", "right_"), ("right_", "left_")];
            let other = |(one, other): (&str, &str)| name.strip_prefix(one).map(|rest| format!("{other}{rest}"));
            sides.into_iter().find_map(other).and_then(|other| body.dof_index(&other))
        };
        let faced = |(d, (bone, dof)): (usize, &(usize, &Dof))| {
            let is_turned = matches!(dof.axis, DofAxis::Tx | DofAxis::Ty | DofAxis::Rx | DofAxis::Ry);
            let sign = if is_turned && !is_root(*bone) { -1.0 } else { 1.0 };
            (other_side(&names[d]).unwrap_or(d), sign)
        };
        let sides: Vec<(usize, f32)> = of_dofs.iter().enumerate().map(faced).collect();
        let are_twins = |one: &[usize], other: &[usize]| one.iter().map(|&d| sides[d].0).eq(other.iter().copied());
        let limbs: Vec<&[usize]> = glances.limbs().collect();
        let pairs = (0..limbs.len()).flat_map(|one| (one + 1..limbs.len()).map(move |other| [one, other]));
        let twins = pairs.filter(|&[one, other]| are_twins(limbs[one], limbs[other])).collect();
        Self { glances, twins, turns, sides, facing: Facing::of(body) }
    }

    pub(super) fn count(&self) -> usize {
        self.glances.limbs().len()
    }

    /// `pose` with a limb of `other`.
    pub(super) fn with(&self, limb: usize, pose: &[f32], other: &[f32]) -> Vec<f32> {
        let mut mixed = pose.to_vec();
        self.glances.limb(limb).iter().for_each(|&d| mixed[d] = other[d]);
        mixed
    }

    /// `pose` with the limbs of the sides exchanged: each is held as the other was, as far as the limits let it.
    pub(super) fn exchanged(&self, [one, other]: [usize; 2], pose: &[f32], space: &SearchSpace) -> Vec<f32> {
        let mut exchanged = pose.to_vec();
        for (&a, &b) in self.glances.limb(one).iter().zip(self.glances.limb(other)) {
            (exchanged[a], exchanged[b]) = (pose[b], pose[a]);
        }
        space.clamp(&mut exchanged);
        exchanged
    }

    /// `pose` facing the other way: turned by half a turn about the body's axis, with every limb of one side where the other side's was, as far
    /// as the limits let it; where they are behind, with the limbs' ends bent as the other side's were. None of a body that does not turn.
    pub(super) fn turned_round(&self, pose: &[f32], space: &SearchSpace) -> Option<[Vec<f32>; 2]> {
        let heading = self.facing?.heading;
        let mut turned: Vec<f32> = self.sides.iter().map(|&(from, sign)| sign * pose[from]).collect();
        // Back and forth, so that headings do not grow.
        turned[heading] += if pose[heading] > 0.0 { -PI } else { PI };
        let mut bent = turned.clone();
        for d in 0..turned.len() {
            // What only bends one way.
            if space.lower()[d] >= 0.0 || space.upper()[d] <= 0.0 {
                bent[d] = pose[self.sides[d].0];
            }
        }
        [&mut turned, &mut bent].into_iter().for_each(|pose| space.clamp(pose));
        Some([turned, bent])
    }

    /// `pose` with the trunk straight, and the limbs that hang on it, where it is turned far.
    pub(super) fn straightened(&self, pose: &[f32], space: &SearchSpace) -> Option<(Vec<f32>, &[usize])> {
        let far = |turn: &&Turn| {
            let [value, lower, upper] = [pose, space.lower(), space.upper()].map(|values| values[turn.dof]);
            value > TURNED * upper.max(0.0) || value < TURNED * lower.min(0.0)
        };
        let turn = self.turns.iter().find(far)?;
        let mut straight = pose.to_vec();
        straight[turn.dof] = 0.0;
        space.clamp(&mut straight);
        Some((straight, &turn.limbs))
    }

    /// The limbs of which the pictures say much more elsewhere than where a pose has them.
    ///
    /// # Errors
    /// As [`Self::are_suspicious`].
    pub(super) fn suspicious(&self, scorer: &mut Scorer<'_>, seen: &Seen, pose: &[f32]) -> Result<Vec<usize>> {
        let views = SeenView::all(&seen.observations);
        let limbs: Vec<usize> = (0..self.count()).collect();
        let are = self.are_suspicious(scorer, &views, &limbs, pose, LOOKED_AT)?;
        Ok(limbs.into_iter().zip(are).filter_map(|(limb, is)| is.then_some(limb)).collect())
    }

    /// Of each of some limbs, whether the pictures say much more of it in the best of `looks` poses than where a pose has it.
    ///
    /// # Errors
    /// When the pose does not fit the body, or the evaluator fails.
    pub(super) fn are_suspicious(
        &self,
        scorer: &mut Scorer<'_>,
        views: &[SeenView<'_>],
        limbs: &[usize],
        pose: &[f32],
        looks: usize,
    ) -> Result<Vec<bool>> {
        let looks = scorer.generations(looks);
        let glances: Result<Vec<_>> = limbs.par_iter().map(|&limb| self.glances.at(limb, pose, views)).collect();
        are_elsewhere(scorer.seer(), views, &glances?, looks, SUSPICIOUS)
    }

    /// A limb of a frame's pose looked for everywhere within its limits.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(super) fn anywhere(
        &self,
        scorer: &mut Scorer<'_>,
        frame: usize,
        limb: usize,
        pose: &[f32],
        turn: u64,
    ) -> Result<Candidate> {
        self.with_end_anywhere(scorer, frame, [limb, self.glances.limb(limb).len()], &[], pose, turn)
    }

    /// As [`Self::anywhere`], beginning also where the pictures say most of it, and with its end alone looked for, beginning with the last
    /// two degrees of freedom: a lattice over few is dense, where the limb's root is right already. The best of all.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(super) fn ends_inward(
        &self,
        scorer: &mut Scorer<'_>,
        views: &[SeenView<'_>],
        frame: usize,
        limb: usize,
        pose: &[f32],
        turn: u64,
    ) -> Result<Candidate> {
        let whole = self.glances.limb(limb);
        let glance = self.glances.at(limb, pose, views)?;
        let [looks, most] = [LOOKED_AT, SIGHTED].map(|usual| scorer.generations(usual));
        let sighted = glance.best(scorer.seer(), looks, most)?;
        let mut best = self.with_end_anywhere(scorer, frame, [limb, whole.len()], &sighted, pose, turn)?;
        for ends in (2..whole.len()).step_by(2) {
            let found = self.with_end_anywhere(scorer, frame, [limb, ends], &[], pose, turn)?;
            if found.worth > best.worth {
                best = found;
            }
        }
        Ok(best)
    }

    /// A limb with its last `ends` degrees of freedom tried all over their limits, and in other rows too; all of them searched from the
    /// best of these.
    fn with_end_anywhere(
        &self,
        scorer: &mut Scorer<'_>,
        frame: usize,
        [limb, ends]: [usize; 2],
        others: &[Vec<f32>],
        pose: &[f32],
        turn: u64,
    ) -> Result<Candidate> {
        let whole = self.glances.limb(limb);
        let moved = &whole[whole.len() - ends..];
        let count = scorer.generations(SCATTERED);
        // Shifted from frame to frame.
        let mut rows = Lattice::new(scorer.space, moved).rows(pose, frame * count..(frame + 1) * count);
        rows.extend_from_slice(others);
        let scattered = scorer.candidates(&rows)?;
        let best = most_under(&scattered, None);
        let (lower, upper) = (scorer.space.lower(), scorer.space.upper());
        let spread: Vec<f32> = lower.iter().zip(upper).map(|(low, high)| WIDTH * (high - low)).collect();
        let effort = Effort { spread: &spread, generations: scorer.generations(GENERATIONS), turn };
        scorer.search(frame, &scattered[best].pose, whole, effort, None)
    }
}
