//! The searches of one fit.

use std::f64::consts::{PI, TAU};

use anyhow::{Context, Result};

use super::super::hull::Hull;
use super::following::Following;
use super::scorer::Scorer;
use super::seen::Seen;
use super::shape::{Shape, proportions};
use crate::body::{Body, Proportions};
use crate::evaluate::Objective;
use crate::geometry::Camera;
use crate::observe::Advance;
use crate::search::{SearchKind, SearchSettings, SearchSpace};

/// Headings a first pose is searched from, evenly round the circle.
const HEADINGS: usize = 8;
/// Angles the arms are lifted sideways to at first, degrees: hanging, half way, a T.
const ARMS: [f64; 3] = [10.0, 45.0, 88.0];
/// Spreads, in steps of the body, that a promising first pose is searched with one after the other: an arm on the wrong
/// side of the trunk needs a wide one to come round.
const SPREADS: [f32; 4] = [4.0, 3.0, 2.0, 1.0];
/// Spreads of a pose that is settled.
const SETTLING: [f32; 2] = [2.0, 1.0];
/// First poses that are followed further.
const SURVIVORS: usize = 3;
/// Times they are searched round once more.
const ENCORES: usize = 3;
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

    /// Works out how many searches there will be, for who waits: in `frames` frames, with poses to start from or
    /// one heading of all, with frames that are followed, and with a body that is measured or kept.
    pub(super) fn expect(
        &mut self,
        frames: usize,
        has_start: bool,
        has_heading: bool,
        follows: bool,
        is_measured: bool,
    ) {
        let weighs_evidence = self.objective.weighs_evidence();
        let followed = if follows { 2 * frames.saturating_sub(1) * SPREADS.len() } else { 0 };
        let settled = if weighs_evidence { 2 * frames * SETTLING.len() } else { 0 };
        let from = |headings: usize| {
            let each = headings * (ARMS.len() + SPREADS.len()) + SURVIVORS.min(headings) * ENCORES * SPREADS.len();
            frames * each + followed + settled
        };
        let first = match (has_start, has_heading) {
            (true, _) if weighs_evidence => settled,
            (true, _) => frames * SETTLING.len(),
            (false, true) => from(1),
            (false, false) => from(HEADINGS) + from(1),
        };
        let stretched = if is_measured { ROUNDS as usize * (1 + frames) } else { 0 };
        self.expected = first + stretched;
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
        let steps = self.space.spread(1.0 / 25.0)?;
        let spread: Vec<f32> = steps.into_iter().map(|step| step * spread).collect();
        self.begin();
        let dofs = self.space.dof_count();
        let scorer = &self.scorer;
        let found = search.search_frame(self.searches, centre, &spread, &mut |rows, results| {
            scorer.poses(frame, dofs, rows, results)
        })?;
        Ok((found.pose, found.fitness))
    }

    /// The poses of all frames from nothing but their hulls, of one heading (degrees) where that is given.
    pub(super) fn found(
        &mut self,
        body: &Body,
        hulls: &[Hull],
        heading: Option<f64>,
        follow: bool,
    ) -> Result<Vec<Vec<f32>>> {
        self.look_untaught(body)?;
        let each = hulls.iter().enumerate();
        let own = each.map(|(frame, hull)| self.first_pose(body, frame, hull, heading)).collect::<Result<Vec<_>>>()?;
        if heading.is_some() {
            self.found_on(body, own, follow)
        } else {
            self.found_both_ways(body, hulls, &own, follow)
        }
    }

    /// Poses of all frames from the first ones of each by itself. Front and back of a person look nearly alike, and a swarm that has arms and
    /// legs in their places the wrong way round does not turn any more: so all frames are tried both ways, that of most of them and its
    /// opposite, and what fits better in all of them together stays.
    fn found_both_ways(
        &mut self,
        body: &Body,
        hulls: &[Hull],
        own: &[Vec<f32>],
        follow: bool,
    ) -> Result<Vec<Vec<f32>>> {
        let dof = index_of(&body.dof_names(), "pelvis.rz")?;
        let headings: Vec<f64> = own.iter().map(|pose| f64::from(pose[dof])).collect();
        let is_along = |heading: f64, way: f64| (heading - way).cos() > 0.0;
        let alike = |way: f64| headings.iter().filter(|heading| is_along(**heading, way)).count();
        let Some(way) = headings.iter().rev().copied().max_by_key(|way| alike(*way)) else { return Ok(Vec::new()) };
        let on = |fitter: &mut Self, way: f64| -> Result<(Vec<Vec<f32>>, f32)> {
            let mut poses = own.to_vec();
            for (frame, pose) in poses.iter_mut().enumerate() {
                if !is_along(headings[frame], way) {
                    *pose = fitter.first_pose(body, frame, &hulls[frame], Some(way.to_degrees()))?;
                }
            }
            let poses = fitter.found_on(body, poses, follow)?;
            let fitness = fitter.scorer.mean_fitness(&poses)?;
            Ok((poses, fitness))
        };
        let (ahead, fitness) = on(self, way)?;
        let (taught, searches) = (self.taught.clone(), self.searches);
        self.look_untaught(body)?;
        let (turned, turned_fitness) = on(self, way.rem_euclid(TAU) - PI)?;
        if turned_fitness > fitness {
            return Ok(turned);
        }
        // As if nothing had been tried.
        self.searches = searches;
        if self.objective.weighs_evidence() {
            self.relook(body, &taught)?;
        }
        Ok(ahead)
    }

    /// First poses searched on, and then from frame to frame where they follow each other.
    fn found_on(&mut self, body: &Body, poses: Vec<Vec<f32>>, follow: bool) -> Result<Vec<Vec<f32>>> {
        let poses = if self.objective.weighs_evidence() { self.by_evidence(body, poses)? } else { poses };
        if follow { self.follow(poses) } else { Ok(poses) }
    }

    /// The poses of all frames from given ones.
    pub(super) fn found_round(&mut self, body: &Body, poses: Vec<Vec<f32>>) -> Result<Vec<Vec<f32>>> {
        if self.objective.weighs_evidence() {
            self.look_untaught(body)?;
            self.by_evidence(body, poses)
        } else {
            self.settle(poses)
        }
    }

    /// Poses searched on by evidence as it is, of what is no background, then by the colours of the person there: silhouettes alone may fit
    /// better the wrong way round.
    fn by_evidence(&mut self, body: &Body, mut poses: Vec<Vec<f32>>) -> Result<Vec<Vec<f32>>> {
        for is_taught in [false, true] {
            if is_taught {
                self.relook(body, &poses)?;
            }
            poses = self.settle(poses)?;
            self.lend(&mut poses)?;
        }
        Ok(poses)
    }

    /// The pose of a frame from nothing but the hull.
    fn first_pose(&mut self, body: &Body, frame: usize, hull: &Hull, heading: Option<f64>) -> Result<Vec<f32>> {
        let headings = match heading {
            Some(heading) => vec![heading],
            None => (0..HEADINGS).map(|turn| turn as f64 * 360.0 / HEADINGS as f64 - 180.0).collect(),
        };
        let swarm = SearchSettings { iterations: self.search.iterations.div_ceil(3), ..self.search };
        let by_fitness = |a: &(Vec<f32>, f32), b: &(Vec<f32>, f32)| b.1.total_cmp(&a.1);
        let mut found = Vec::new();
        // Of each heading the best arms go on: the best of all together would be one heading several times.
        for heading in headings {
            let mut tried = Vec::new();
            for arms in ARMS {
                let centre = rest_pose(body, hull, heading, arms)?;
                tried.push(self.pose(swarm, frame, &centre, 2.0)?);
            }
            tried.sort_by(by_fitness);
            if let Some(best) = tried.into_iter().next() {
                found.push(self.narrowed(frame, best)?);
            }
        }
        found.sort_by(by_fitness);
        found.truncate(SURVIVORS);
        for pose in &mut found {
            for _ in 0..ENCORES {
                *pose = self.narrowed(frame, std::mem::take(pose))?;
            }
        }
        found.sort_by(by_fitness);
        Ok(found.into_iter().next().unwrap_or_default().0)
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

    /// Poses of all frames improved from given ones.
    fn settle(&mut self, poses: Vec<Vec<f32>>) -> Result<Vec<Vec<f32>>> {
        let mut settled = Vec::new();
        for (frame, mut pose) in poses.into_iter().enumerate() {
            self.space.clamp(&mut pose);
            settled.push(self.settled(frame, pose)?);
        }
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
        let steps = joined(&|i| known[i].deviation as f32, &self.space.spread(1.0 / 25.0)?);
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
        let steps = self.space.spread(1.0 / 25.0)?;
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

/// The place of a degree of freedom in a pose.
fn index_of(names: &[String], name: &str) -> Result<usize> {
    let index = names.iter().position(|known| known == name);
    index.with_context(|| format!("the body has no {name}, expected the joints of the default body"))
}

/// Standing in the hull, facing `heading` (degrees), arms lifted by `arms` degrees.
fn rest_pose(body: &Body, hull: &Hull, heading: f64, arms: f64) -> Result<Vec<f32>> {
    let names = body.dof_names();
    let mut pose = body.standing_pose();
    for (name, value) in [
        ("pelvis.tx", hull.centre.x),
        ("pelvis.ty", hull.centre.y),
        ("pelvis.rz", heading.to_radians()),
        ("left_shoulder.rx", arms.to_radians()),
        ("right_shoulder.rx", -arms.to_radians()),
    ] {
        pose[index_of(&names, name)?] = value;
    }
    if let Some(lift) = names.iter().position(|name| name == "pelvis.tz") {
        pose[lift] += hull.span[0];
    }
    body.clamp_to_limits(&mut pose);
    Ok(pose.into_iter().map(|value| value as f32).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::ObjectiveKind;
    use crate::features::SeenView;
    use crate::track::fit_tests::{cameras_around, seen};

    /// Whoever can be taken for one who faces the other way is tried both ways.
    #[test]
    fn nobody_stays_the_wrong_way_round() {
        let body = Body::adult(1750.0).unwrap();
        let names = body.dof_names();
        let mut walking = body.standing_pose();
        for (name, degrees) in [
            ("pelvis.rz", 40.0_f64),
            ("left_hip.ry", -25.0),
            ("left_knee.ry", 20.0),
            ("right_knee.ry", 35.0),
            ("left_shoulder.ry", 20.0),
            ("right_shoulder.ry", -20.0),
            ("left_elbow.ry", -30.0),
            ("right_elbow.ry", -50.0),
        ] {
            walking[index_of(&names, name).unwrap()] = degrees.to_radians();
        }
        body.clamp_to_limits(&mut walking);
        let cameras = cameras_around();
        let observations = seen(&body, &cameras, &walking);
        let hulls = [Hull::carve(&cameras, &SeenView::all(&observations)).unwrap()];
        let search = SearchSettings { particles: 100, iterations: 20, ..SearchSettings::default() };
        // What was seen has no edges.
        let objective = Objective { w1: 1.0, w2: 0.0, ..Objective::of(ObjectiveKind::Ws) };
        let mut progress = |_: &str, _, _| {};
        let mut fitter =
            Fitter::new(&body, &cameras, Seen::of(vec![observations]), search, objective, &mut progress).unwrap();
        let heading = index_of(&names, "pelvis.rz").unwrap();
        let right: Vec<f32> = walking.iter().map(|value| *value as f32).collect();
        let mut wrong = right.clone();
        wrong[heading] -= PI as f32;
        let fitness = |fitter: &Fitter<'_>, poses: &[Vec<f32>]| fitter.scorer.mean_fitness(poses).unwrap();
        let wrong = [wrong];
        let found = fitter.found_both_ways(&body, &hulls, &wrong, false).unwrap();
        let off = f64::from(found[0][heading] - right[heading]);
        let [after, before] = [fitness(&fitter, &found), fitness(&fitter, &wrong)];
        println!("{:.1} degrees off, {after} over {before}", off.to_degrees());
        assert!(off.cos() > 0.0 && after > before);
        // Whoever was right stays, as if nothing else had been tried.
        let (searches, right) = (fitter.searches, [right]);
        assert_eq!(fitter.found_both_ways(&body, &hulls, &right, false).unwrap(), right);
        assert_eq!(fitter.searches, searches);
    }
}
