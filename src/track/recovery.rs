//! Finding a person again who was lost: a wider search around the last sure pose, then one over place and heading in the
//! visual hull of the silhouettes.

use anyhow::Result;
use glam::DVec3;

use super::hull::Hull;
use super::searcher::Searched;
use crate::body::{Body, DofAxis};
use crate::evaluate::{Evaluator, Objective};
use crate::features::SeenView;
use crate::geometry::Camera;
use crate::search::{Estimate, SearchKind, SearchSettings, SearchSpace};

/// Factor on a frame's spread around the last sure pose.
const WIDE: f32 = 4.0;
/// Headings that a person in the hull may have, evenly round the circle.
const HEADINGS: usize = 8;
/// Angles the arms are lifted sideways to, degrees.
const ARMS: [f64; 3] = [10.0, 45.0, 88.0];
/// A start in the hull has this share of a frame's iterations, as its inverse.
const GLIMPSE: usize = 8;
/// Headings whose best start is followed further, and the spreads that is followed with, in steps of the body. Headings
/// and not starts: a person turned by half fits nearly as well at first, and only when settled worse.
const SURVIVORS: usize = 4;
const NARROWING: [f32; 3] = [3.0, 2.0, 1.0];
/// How far from where somebody of her size is the hull may hold her, mm: whoever is farther off is somebody else, however well he fits.
const NEAR: f32 = 500.0;
/// While the person stays lost, the hull is searched at a distance of 1, 2, 4, … frames, at most this.
const LONGEST_WAIT: usize = 16;

/// The search for a lost person.
///
/// Its budget, in evaluations of an ordinary frame: 1 around the last sure pose; in the hull, when it is searched, 32 starts
/// (8 headings, each with three arm positions of the standing pose and with the last sure pose turned) of an eighth each, and
/// 4 survivors of 3 each: 17 in all, and somewhat more where the iterations do not divide by eight.
pub(super) struct Recovery {
    settings: SearchSettings,
    space: SearchSpace,
    body: Body,
    cameras: Vec<Camera>,
    /// Places of the root's tx, ty, tz and rz in a pose.
    root: [Option<usize>; 4],
    sure: Option<Vec<f32>>,
    lost_frames: usize,
}

/// A frame in which the person is lost.
pub(super) struct LostFrame<'a> {
    pub(super) evaluator: &'a mut dyn Evaluator,
    pub(super) objective: &'a Objective,
    /// What was seen of her, one a view.
    pub(super) views: &'a [SeenView<'a>],
    /// The frame, as the random numbers count it.
    pub(super) number: u32,
    /// Standard deviation of an ordinary frame's search.
    pub(super) spread: &'a [f32],
}

impl Recovery {
    pub(super) fn new(body: &Body, cameras: &[Camera], settings: &SearchSettings, space: &SearchSpace) -> Self {
        Self {
            settings: SearchSettings { kind: SearchKind::Pso, refine: 0, ..*settings },
            space: space.clone(),
            body: body.clone(),
            cameras: cameras.to_vec(),
            root: [DofAxis::Tx, DofAxis::Ty, DofAxis::Tz, DofAxis::Rz].map(|axis| body.root_dof(axis)),
            sure: None,
            lost_frames: 0,
        }
    }

    /// Takes note of a frame that is done.
    pub(super) fn note(&mut self, pose: &[f32], is_lost: bool) {
        if is_lost {
            self.lost_frames += 1;
        } else {
            self.lost_frames = 0;
            self.sure = Some(pose.to_vec());
        }
    }

    /// Whether the frame before was lost.
    pub(super) fn is_lost(&self) -> bool {
        self.lost_frames > 0
    }

    /// Searches wider; replaces `found` by what fits better, if anything does. `is_sure` says whether what was found would
    /// count as a find: that is always compared with what else the hull holds, since a person turned by half agrees nearly
    /// as well. `is_there` says whether somebody of her size is where she was found: then the hull is searched for how she is held, not for
    /// others.
    ///
    /// # Errors
    /// When the evaluator or `is_sure` fails.
    pub(super) fn search(
        &self,
        mut frame: LostFrame<'_>,
        found: &mut Searched,
        is_sure: &dyn Fn(&mut dyn Evaluator, &Searched) -> Result<bool>,
        is_there: &dyn Fn(&Searched) -> bool,
    ) -> Result<()> {
        let mut searches = 0;
        if let Some(sure) = &self.sure {
            let spread: Vec<f32> = frame.spread.iter().map(|spread| spread * WIDE).collect();
            let wide = self.around(&mut frame, sure, &spread, self.settings.iterations, &mut searches)?;
            self.keep_better(&mut frame, found, wide)?;
        }
        let is_turn = self.lost_frames == 0
            || self.lost_frames.is_power_of_two()
            || self.lost_frames.is_multiple_of(LONGEST_WAIT)
            || is_sure(&mut *frame.evaluator, found)?;
        // Without a hull there is nobody to be found.
        let Some(hull) = is_turn.then(|| Hull::carve_coarsely(&self.cameras, frame.views).ok()).flatten() else {
            return Ok(());
        };
        let place = is_there(found).then(|| found.estimate.pose.clone());
        let steps = self.space.spread(1.0 / 25.0)?;
        let scaled = |factor: f32| -> Vec<f32> { steps.iter().map(|step| step * factor).collect() };
        let mut starts = Vec::with_capacity(HEADINGS);
        for turn in 0..HEADINGS {
            let mut best: Option<Estimate> = None;
            for centre in self.starts(&hull, turn) {
                let iterations = self.settings.iterations.div_ceil(GLIMPSE);
                let start = self.around(&mut frame, &centre, &scaled(NARROWING[0]), iterations, &mut searches)?;
                best = Some(match best {
                    Some(best) if best.fitness >= start.fitness => best,
                    _ => start,
                });
            }
            starts.extend(best);
        }
        starts.sort_by(|a, b| b.fitness.total_cmp(&a.fitness));
        for mut start in starts.into_iter().take(SURVIVORS) {
            for factor in NARROWING {
                let centre = start.pose.clone();
                let (iterations, spread) = (self.settings.iterations, scaled(factor));
                let next = self.around(&mut frame, &centre, &spread, iterations, &mut searches)?;
                start = Estimate { evaluations: start.evaluations + next.evaluations, ..next };
            }
            if place.as_ref().is_some_and(|place| self.distance(place, &start.pose) >= NEAR) {
                found.estimate.evaluations += start.evaluations;
                continue;
            }
            self.keep_better(&mut frame, found, start)?;
        }
        Ok(())
    }

    /// How far apart two poses stand, mm.
    fn distance(&self, one: &[f32], other: &[f32]) -> f32 {
        let [x, y] = [0, 1].map(|axis| self.root[axis].map_or(0.0, |place| one[place] - other[place]));
        x.hypot(y)
    }

    /// A swarm around a pose. Each search of a frame has random numbers of its own.
    fn around(
        &self,
        frame: &mut LostFrame<'_>,
        centre: &[f32],
        spread: &[f32],
        iterations: usize,
        searches: &mut u64,
    ) -> Result<Estimate> {
        *searches += 1;
        let mut search = SearchSettings { iterations, ..self.settings }.reseeded(*searches).build(&self.space)?;
        let LostFrame { evaluator, objective, number, .. } = frame;
        search.search_frame(*number, centre, spread, &mut |poses, fitness| evaluator.fitness(poses, objective, fitness))
    }

    fn keep_better(&self, frame: &mut LostFrame<'_>, found: &mut Searched, estimate: Estimate) -> Result<()> {
        let evaluations = found.estimate.evaluations + estimate.evaluations;
        if estimate.fitness > found.estimate.fitness {
            found.estimate = estimate;
            found.views = frame.evaluator.view_counts(&found.estimate.pose, frame.objective)?;
        }
        found.estimate.evaluations = evaluations;
        Ok(())
    }

    /// Poses in the middle of the hull, turned by so many of [`HEADINGS`].
    fn starts(&self, hull: &Hull, turn: usize) -> Vec<Vec<f32>> {
        let mut rests: Vec<Vec<f64>> = ARMS
            .iter()
            .map(|arms| {
                let mut pose = self.body.standing_pose();
                for (name, sign) in [("left_shoulder.rx", 1.0), ("right_shoulder.rx", -1.0)] {
                    if let Some(place) = self.body.dof_index(name) {
                        pose[place] = sign * arms.to_radians();
                    }
                }
                if let Some(lift) = self.root[2] {
                    pose[lift] += hull.span[0];
                }
                pose
            })
            .collect();
        rests.extend(self.sure.iter().map(|sure| sure.iter().map(|value| f64::from(*value)).collect()));
        let angle = std::f64::consts::TAU * turn as f64 / HEADINGS as f64;
        rests.iter().map(|rest| self.placed(rest, hull.centre, angle)).collect()
    }

    /// A pose turned by `angle` and moved over `at`, within the limits.
    fn placed(&self, pose: &[f64], at: DVec3, angle: f64) -> Vec<f32> {
        let mut pose = pose.to_vec();
        if let Some(heading) = self.root[3] {
            let [low, high] = [self.space.lower()[heading], self.space.upper()[heading]].map(f64::from);
            pose[heading] += angle;
            // The same heading within the limits, where there is one.
            if pose[heading] > high && pose[heading] - std::f64::consts::TAU >= low {
                pose[heading] -= std::f64::consts::TAU;
            }
        }
        for (place, at) in self.root.into_iter().zip([at.x, at.y]) {
            if let Some(place) = place {
                pose[place] = at;
            }
        }
        let mut pose: Vec<f32> = pose.into_iter().map(|value| value as f32).collect();
        self.space.clamp(&mut pose);
        pose
    }
}
