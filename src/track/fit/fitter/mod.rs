//! The searches of one fit.

mod first;

use anyhow::Result;

use super::super::hindsight::{LimbSearch, SearchedFrame};
use super::following::Following;
use super::scorer::Scorer;
use super::seen::Seen;
use super::shape::{Shape, proportions};
use crate::body::{Body, Proportions};
use crate::evaluate::Objective;
use crate::features::SeenView;
use crate::geometry::Camera;
use crate::observe::Advance;
use crate::search::{SearchKind, SearchSettings, SearchSpace};

/// The rate that the body's steps are taken for: frames that are fitted may lie any time apart.
const FPS: f64 = 25.0;
/// Spreads, in steps of the body, that a promising first pose is searched with one after the other: an arm on the wrong
/// side of the trunk needs a wide one to come round.
const SPREADS: [f32; 4] = [4.0, 3.0, 2.0, 1.0];
/// Spreads of a pose that is settled.
const SETTLING: [f32; 2] = [2.0, 1.0];
/// Rounds that proportions and poses are searched together in, each narrower than the one before by [`NARROWING`].
const ROUNDS: i32 = 10;
const NARROWING: f64 = 0.75;
/// Where shape and poses are nearly right, as many times fewer are scored at once: what learns the shape of the hill wants no crowd.
const CLOSE: usize = 6;
/// As many times longer than that a first pose is searched round.
const LONGER: usize = 2;
/// Rounds before which the person's colours are learnt anew.
const RELOOKS: [i32; 2] = [2, 5];

/// The searches of one fit.
pub(super) struct Fitter<'a> {
    space: SearchSpace,
    search: SearchSettings,
    pub(super) scorer: Scorer,
    cameras: &'a [Camera],
    seen: Seen,
    /// What a good pose is in the end.
    objective: Objective,
    /// The poses whose colours the evidence is of.
    taught: Vec<Vec<f32>>,
    /// Searches done: each draws random numbers of its own.
    searches: u32,
    /// The same of all, those that came to nothing too.
    begun: usize,
    /// Hears of the searches, of which there will be about as many as expected.
    progress: &'a mut Advance<'a>,
    expected: usize,
}

impl<'a> Fitter<'a> {
    /// Where `objective` weighs evidence, nothing can be compared before [`Self::relook`].
    ///
    /// # Errors
    /// When what was seen does not fit the cameras.
    pub(super) fn new(
        body: &Body,
        cameras: &'a [Camera],
        seen: Seen,
        search: SearchSettings,
        objective: Objective,
        progress: &'a mut Advance<'a>,
    ) -> Result<Self> {
        let scorer = Scorer::new(body, cameras, &seen.observations, objective)?;
        Ok(Self {
            space: SearchSpace::of(body)?,
            search,
            scorer,
            cameras,
            seen,
            objective,
            taught: Vec::new(),
            searches: 0,
            begun: 0,
            progress,
            expected: 0,
        })
    }

    /// Counts a search that begins.
    fn begin(&mut self) {
        (self.progress)("fitting", self.begun.min(self.expected), self.expected);
        self.searches += 1;
        self.begun += 1;
    }

    /// From here on poses are searched by evidence, of the colours that a person with this body has in `poses`.
    ///
    /// # Errors
    /// As [`Seen::weigh`].
    pub(super) fn relook(&mut self, body: &Body, poses: &[Vec<f32>]) -> Result<()> {
        self.seen.weigh(body, self.cameras, poses)?;
        self.taught = poses.to_vec();
        self.scorer.look_anew(&self.seen.observations, self.objective)
    }

    /// [`Self::relook`] by what is no background, where evidence is weighed: silhouettes lose limbs that are nearly of its colour.
    fn look_untaught(&mut self, body: &Body) -> Result<()> {
        if self.objective.weighs_evidence() { self.relook(body, &[]) } else { Ok(()) }
    }

    /// What searches close to something that is nearly right.
    fn close(&self) -> SearchSettings {
        SearchSettings { kind: SearchKind::MaEs, particles: self.search.particles.div_ceil(CLOSE), ..self.search }
    }

    /// The fitness of all frames, each searched round its pose.
    pub(super) fn settled_fitness(&mut self, poses: &[Vec<f32>]) -> Result<Vec<f32>> {
        let search = |(frame, pose): (usize, &Vec<f32>)| Ok(self.pose(self.close(), frame, pose, 1.0)?.1);
        poses.iter().enumerate().map(search).collect()
    }

    /// The best pose of one frame round `centre`, and its fitness; `spread` is in steps of the body.
    fn pose(&mut self, settings: SearchSettings, frame: usize, centre: &[f32], spread: f32) -> Result<(Vec<f32>, f32)> {
        let mut search = settings.build(&self.space)?;
        let steps = self.space.spread(1.0 / FPS)?;
        let spread: Vec<f32> = steps.into_iter().map(|step| step * spread).collect();
        self.begin();
        let dofs = self.space.dof_count();
        let scorer = &self.scorer;
        let found = search.search_frame(self.searches, centre, &spread, &mut |rows, results| {
            scorer.poses(frame, dofs, rows, results)
        })?;
        Ok((found.pose, found.fitness))
    }

    /// First poses searched on, and then from frame to frame where they follow each other. Where evidence is weighed, which is of what is no
    /// background so far, limbs are looked for before the person's colours are learnt, since an arm that is wrong by then is taught to be right,
    /// and once more by the colours.
    fn found_on(&mut self, body: &Body, poses: Vec<Vec<f32>>, follow: bool) -> Result<Vec<Vec<f32>>> {
        let mut poses = self.settle(poses)?;
        if self.objective.weighs_evidence() {
            for _ in 0..2 {
                poses = self.look_for_limbs(body, &poses)?;
                self.relook(body, &poses)?;
                poses = self.settle(poses)?;
            }
        }
        if follow { self.follow(poses) } else { Ok(poses) }
    }

    /// The poses of all frames from given ones, where evidence is weighed then once more by the colours of the person there: silhouettes alone may
    /// fit better the wrong way round.
    pub(super) fn found_round(&mut self, body: &Body, poses: Vec<Vec<f32>>) -> Result<Vec<Vec<f32>>> {
        self.look_untaught(body)?;
        let poses = self.settle(poses)?;
        if !self.objective.weighs_evidence() {
            return Ok(poses);
        }
        self.relook(body, &poses)?;
        self.settle(poses)
    }

    /// Poses with every limb of each looked for all over: swarms that begin with arms that hang end where the arm was, not where it is.
    fn look_for_limbs(&mut self, body: &Body, poses: &[Vec<f32>]) -> Result<Vec<Vec<f32>>> {
        let limbs = LimbSearch::new(body, self.cameras, &self.space, FPS)?;
        self.begin();
        let Self { space, search, scorer, seen, objective, searches, .. } = &*self;
        scorer.each_frame(|frame, cpu| {
            let searched = SearchedFrame {
                evaluator: cpu,
                objective,
                settings: search,
                space,
                views: &SeenView::all(&seen.observations[frame]),
                index: *searches as usize + frame,
                time: None,
            };
            limbs.look_everywhere(searched, poses[frame].clone())
        })
    }

    /// Poses, each also searched round its neighbours', there and back: what fits better stays.
    fn follow(&mut self, poses: Vec<Vec<f32>>) -> Result<Vec<Vec<f32>>> {
        let mut found = Vec::with_capacity(poses.len());
        for (frame, pose) in poses.into_iter().enumerate() {
            let mut fitness = [0.0];
            self.scorer.poses(frame, self.space.dof_count(), &pose, &mut fitness)?;
            found.push((pose, fitness[0]));
        }
        let last = found.len().saturating_sub(1);
        let there = (0..last).map(|at| (at, at + 1));
        let back = (0..last).rev().map(|at| (at + 1, at));
        for (from, to) in there.chain(back) {
            let round = (found[from].0.clone(), f32::NEG_INFINITY);
            let searched = self.narrowed(to, round)?;
            if searched.1 > found[to].1 {
                found[to] = searched;
            }
        }
        Ok(found.into_iter().map(|(pose, _)| pose).collect())
    }

    /// A pose searched round with one spread after the other. The centre is among what is scored, so nothing gets worse.
    fn narrowed(&mut self, frame: usize, mut pose: (Vec<f32>, f32)) -> Result<(Vec<f32>, f32)> {
        let search = SearchSettings { iterations: LONGER * self.search.iterations, ..self.close() };
        for spread in SPREADS {
            pose = self.pose(search, frame, &pose.0, spread)?;
        }
        Ok(pose)
    }

    /// Poses of all frames improved from given ones, and by each other's.
    fn settle(&mut self, poses: Vec<Vec<f32>>) -> Result<Vec<Vec<f32>>> {
        let mut settled = Vec::new();
        for (frame, mut pose) in poses.into_iter().enumerate() {
            self.space.clamp(&mut pose);
            settled.push(self.settled(frame, pose)?);
        }
        self.lend(&mut settled)?;
        Ok(settled)
    }

    fn settled(&mut self, frame: usize, mut pose: Vec<f32>) -> Result<Vec<f32>> {
        for spread in SETTLING {
            pose = self.pose(self.close(), frame, &pose, spread)?.0;
        }
        Ok(pose)
    }

    /// Where another frame's pose explains a frame better than its own, the own is searched anew round that one: a limb that is lost in one
    /// frame is found by the next, as in a pose that is held.
    fn lend(&mut self, poses: &mut [Vec<f32>]) -> Result<()> {
        let mut fitness = vec![0.0_f32; poses.len()];
        for frame in 0..poses.len() {
            self.scorer.poses(frame, self.space.dof_count(), &poses.concat(), &mut fitness)?;
            let best = (0..poses.len()).max_by(|a, b| fitness[*a].total_cmp(&fitness[*b])).unwrap_or(frame);
            if fitness[best] > fitness[frame] {
                poses[frame] = self.settled(frame, poses[best].clone())?;
            }
        }
        Ok(())
    }

    /// The proportions of the body, with the poses moving along; evidence is looked at anew now and then.
    pub(super) fn stretch(&mut self, body: &Body, poses: &mut Vec<Vec<f32>>) -> Result<Proportions> {
        let (dofs, frames) = (self.space.dof_count(), poses.len());
        let known = Proportions::ALL;
        let joined = |shape: &dyn Fn(usize) -> f32, pose: &[f32]| -> Vec<f32> {
            (0..known.len()).map(shape).chain(pose.repeat(frames)).collect()
        };
        let lower = joined(&|i| known[i].limits[0] as f32, self.space.lower());
        let upper = joined(&|i| known[i].limits[1] as f32, self.space.upper());
        let steps = joined(&|i| known[i].deviation as f32, &self.space.spread(1.0 / FPS)?);
        let space = SearchSpace::new(lower, upper, steps.clone())?;
        let apart = |row: &[f32]| -> (Proportions, Vec<Vec<f32>>) {
            let (factors, poses) = row.split_at(known.len());
            (proportions(factors), poses.chunks_exact(dofs).map(<[f32]>::to_vec).collect())
        };
        let mut centre: Vec<f32> = vec![1.0; known.len()];
        centre.extend(poses.concat());
        for round in 0..ROUNDS {
            if self.objective.weighs_evidence() && RELOOKS.contains(&round) {
                let (factors, settled) = apart(&centre);
                self.relook(&factors.apply(body), &settled)?;
            }
            let narrow = NARROWING.powi(round) as f32;
            let spread: Vec<f32> = steps.iter().map(|step| step * narrow).collect();
            let mut search = self.search.build(&space)?;
            self.begin();
            let scorer = &self.scorer;
            let found = search.search_frame(self.searches, &centre, &spread, &mut |rows, results| {
                scorer.people(body, dofs, rows, results)
            })?;
            centre = found.pose;
            // The poses alone settle faster than with the proportions in tow.
            self.scorer.set_body(&proportions(&centre[..known.len()]).apply(body))?;
            for frame in 0..frames {
                let row = known.len() + frame * dofs..known.len() + (frame + 1) * dofs;
                let (pose, _) = self.pose(self.close(), frame, &centre[row.clone()], narrow)?;
                centre[row].copy_from_slice(&pose);
            }
        }
        let (factors, settled) = apart(&centre);
        *poses = settled;
        Ok(factors)
    }

    /// The body in its best shape, searched by itself with the poses following: of many frames, whose poses are nearly right, a swarm over
    /// shape and all poses together finds nothing.
    pub(super) fn reshape(&mut self, body: &Body, poses: &mut [Vec<f32>]) -> Result<Body> {
        let [lower, upper, deviations] = Shape::ranges();
        let space = SearchSpace::new(lower, upper, deviations.clone())?;
        let steps = self.space.spread(1.0 / FPS)?;
        let mut shape = Shape::default();
        let mut stretched = shape.apply(body);
        for round in 0..ROUNDS {
            if self.objective.weighs_evidence() && RELOOKS.contains(&round) {
                self.relook(&stretched, poses)?;
            }
            let narrow = NARROWING.powi(round) as f32;
            let following: Vec<Following> =
                poses.iter().map(|pose| Following::new(&stretched, pose, &steps)).collect::<Result<_>>()?;
            let spread: Vec<f32> = deviations.iter().map(|step| step * narrow).collect();
            let mut search = self.close().build(&space)?;
            self.begin();
            let scorer = &self.scorer;
            let found = search.search_frame(self.searches, &shape.row(), &spread, &mut |rows, results| {
                scorer.shapes(body, &following, rows, results)
            })?;
            shape = Shape::from_row(&found.pose);
            stretched = shape.apply(body);
            self.scorer.set_body(&stretched)?;
            for (frame, (pose, following)) in poses.iter_mut().zip(&following).enumerate() {
                let moved = following.with(&stretched)?;
                *pose = self.pose(self.close(), frame, &moved, narrow)?.0;
            }
        }
        Ok(stretched)
    }
}
