//! First poses from nothing but hulls.

use std::f64::consts::{PI, TAU};

use anyhow::{Context, Result};

use super::super::super::hull::Hull;
use super::{Fitter, ROUNDS, SETTLING, SPREADS};
use crate::body::Body;
use crate::search::SearchSettings;
use crate::track::worth::Facing;

/// Headings a first pose is searched from, evenly round the circle.
const HEADINGS: usize = 8;
/// Angles the arms are lifted sideways to at first, degrees: hanging, half way, a T.
const ARMS: [f64; 3] = [10.0, 45.0, 88.0];
/// First poses that are followed further.
const SURVIVORS: usize = 3;
/// Times they are searched round once more.
const ENCORES: usize = 3;
/// Share of the body's height that a hull has at least unless the person crouches or half of it is not seen: what walks and dances before walls like
/// its clothes has 0.64 of it and more in nearly all frames, and is found by the feet.
const SHORT: f64 = 0.6;
/// What it is worth in fitness to face along the way one goes: whoever walks does so forwards but for one in fifty or fewer. By the pictures alone
/// the right way was worth 0.02 to 0.15 more than the other before the poses of either were settled and searched round their neighbours' (METHOD
/// A3); it is compared after that.
const FORWARDS: f32 = 0.02;

impl Fitter<'_> {
    /// Works out how many searches there will be, for who waits: in `frames` frames, with poses to start from or
    /// one heading of all, with frames that are followed, and with a body that is measured or kept.
    pub(in super::super) fn expect(
        &mut self,
        frames: usize,
        has_start: bool,
        has_heading: bool,
        follows: bool,
        is_measured: bool,
    ) {
        let weighs_evidence = self.objective.weighs_evidence();
        let followed = if follows { 2 * frames.saturating_sub(1) * SPREADS.len() } else { 0 };
        let settled = |times: usize| frames * SETTLING.len() * if weighs_evidence { times } else { 1 };
        let from = |headings: usize| {
            let each = headings * (ARMS.len() + SPREADS.len()) + SURVIVORS.min(headings) * ENCORES * SPREADS.len();
            frames * each + followed + settled(3)
        };
        let first = match (has_start, has_heading) {
            (true, _) => settled(2),
            (false, true) => from(1),
            (false, false) => from(HEADINGS) + from(1),
        };
        let stretched = if is_measured { ROUNDS as usize * (1 + frames) } else { 0 };
        self.expected = first + stretched;
    }

    /// The poses of all frames from nothing but their hulls, of one heading (degrees) where that is given. Of hulls that are shorter than the
    /// body either the person bends, or feet or crown are not seen: whoever stands on a hull that has no legs is folded into what there is.
    pub(in super::super) fn found(
        &mut self,
        body: &Body,
        hulls: &[Hull],
        heading: Option<f64>,
        follow: bool,
    ) -> Result<Vec<Vec<f32>>> {
        self.look_untaught(body)?;
        let standing = self.found_in(body, hulls, heading, follow, Hold::Feet)?;
        let tall = crown(body)?;
        let short = hulls.iter().filter(|hull| hull.span[1] - hull.span[0] < SHORT * tall).count();
        if 2 * short < hulls.len().max(1) {
            return Ok(standing);
        }
        self.expected += self.begun;
        self.better(body, standing, |fitter| fitter.found_in(body, hulls, heading, follow, Hold::Crown))
    }

    /// The same, of first poses held so in their hulls.
    fn found_in(
        &mut self,
        body: &Body,
        hulls: &[Hull],
        heading: Option<f64>,
        follow: bool,
        hold: Hold,
    ) -> Result<Vec<Vec<f32>>> {
        let each = hulls.iter().enumerate();
        let first = each.map(|(frame, hull)| self.first_pose(body, frame, hull, heading, hold));
        let own = first.collect::<Result<Vec<_>>>()?;
        if heading.is_some() {
            self.found_on(body, own, follow)
        } else {
            self.found_both_ways(body, hulls, &own, follow, hold)
        }
    }

    /// Poses of all frames from the first ones of each by itself. Front and back of a person look nearly alike, and a swarm that has arms and
    /// legs in their places the wrong way round does not turn any more: so all frames are tried both ways, that of most of them and its
    /// opposite, and what is worth more in all of them together stays.
    fn found_both_ways(
        &mut self,
        body: &Body,
        hulls: &[Hull],
        own: &[Vec<f32>],
        follow: bool,
        hold: Hold,
    ) -> Result<Vec<Vec<f32>>> {
        let dof = index_of(body, "pelvis.rz")?;
        let headings: Vec<f64> = own.iter().map(|pose| f64::from(pose[dof])).collect();
        let is_along = |heading: f64, way: f64| (heading - way).cos() > 0.0;
        let alike = |way: f64| headings.iter().filter(|heading| is_along(**heading, way)).count();
        let Some(way) = headings.iter().rev().copied().max_by_key(|way| alike(*way)) else { return Ok(Vec::new()) };
        let on = |fitter: &mut Self, way: f64| -> Result<Vec<Vec<f32>>> {
            let mut poses = own.to_vec();
            for (frame, pose) in poses.iter_mut().enumerate() {
                if !is_along(headings[frame], way) {
                    *pose = fitter.first_pose(body, frame, &hulls[frame], Some(way.to_degrees()), hold)?;
                }
            }
            fitter.found_on(body, poses, follow)
        };
        let ahead = on(self, way)?;
        self.better(body, ahead, |fitter| on(fitter, way.rem_euclid(TAU) - PI))
    }

    /// What poses of all frames are worth: their mean fitness, and that they face along the way they go.
    fn worth(&self, body: &Body, poses: &[Vec<f32>]) -> Result<f32> {
        let fitness = self.scorer.mean_fitness(poses)?;
        let along = Facing::of(body).map_or(0.0, |facing| facing.along(poses));
        Ok(fitness + FORWARDS * along as f32)
    }

    /// Of these poses of all frames and those that another search finds without having been taught, the ones that are worth more, each by the
    /// colours they taught; where these stay, it is as if nothing had been tried.
    fn better(
        &mut self,
        body: &Body,
        poses: Vec<Vec<f32>>,
        search: impl FnOnce(&mut Self) -> Result<Vec<Vec<f32>>>,
    ) -> Result<Vec<Vec<f32>>> {
        let worth = self.worth(body, &poses)?;
        let (taught, searches) = (self.taught.clone(), self.searches);
        self.look_untaught(body)?;
        let others = search(self)?;
        if self.worth(body, &others)? > worth {
            return Ok(others);
        }
        self.searches = searches;
        if self.objective.weighs_evidence() {
            self.relook(body, &taught)?;
        }
        Ok(poses)
    }

    /// The pose of a frame from nothing but the hull.
    fn first_pose(
        &mut self,
        body: &Body,
        frame: usize,
        hull: &Hull,
        heading: Option<f64>,
        hold: Hold,
    ) -> Result<Vec<f32>> {
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
                let centre = rest_pose(body, hull, hold, heading, arms)?;
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
}

/// The place of a degree of freedom in a pose.
fn index_of(body: &Body, name: &str) -> Result<usize> {
    body.dof_index(name).with_context(|| format!("the body has no {name}, expected the joints of the default body"))
}

/// What of a standing pose is where the hull ends.
#[derive(Clone, Copy, Debug)]
enum Hold {
    Feet,
    Crown,
}

/// How high the highest joint of a body that stands on the floor is, mm.
fn crown(body: &Body) -> Result<f64> {
    let joints = body.joint_positions(&body.world_from_bones(&body.standing_pose())?);
    Ok(joints.iter().map(|joint| joint.z).fold(0.0, f64::max))
}

/// Standing in the hull, facing `heading` (degrees), arms lifted by `arms` degrees.
fn rest_pose(body: &Body, hull: &Hull, hold: Hold, heading: f64, arms: f64) -> Result<Vec<f32>> {
    let mut pose = body.standing_pose();
    for (name, value) in [
        ("pelvis.tx", hull.centre.x),
        ("pelvis.ty", hull.centre.y),
        ("pelvis.rz", heading.to_radians()),
        ("left_shoulder.rx", arms.to_radians()),
        ("right_shoulder.rx", -arms.to_radians()),
    ] {
        pose[index_of(body, name)?] = value;
    }
    if let Some(lift) = body.dof_index("pelvis.tz") {
        pose[lift] += match hold {
            Hold::Feet => hull.span[0],
            Hold::Crown => hull.span[1] - crown(body)?,
        };
    }
    body.clamp_to_limits(&mut pose);
    Ok(pose.into_iter().map(|value| value as f32).collect())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;

    use super::*;
    use crate::evaluate::{Objective, ObjectiveKind};
    use crate::features::{BitImage, SeenView};
    use crate::track::fit::seen::Seen;
    use crate::track::fit_tests::{cameras_around, seen};

    fn search() -> SearchSettings {
        SearchSettings { particles: 100, iterations: 20, ..SearchSettings::default() }
    }

    /// For what was seen without edges.
    fn by_silhouettes() -> Objective {
        Objective { w1: 1.0, w2: 0.0, ..Objective::of(ObjectiveKind::Ws) }
    }

    fn held(body: &Body, degrees: &[(&str, f64)]) -> Vec<f64> {
        let mut pose = body.standing_pose();
        for (name, degrees) in degrees {
            pose[index_of(body, name).unwrap()] = degrees.to_radians();
        }
        body.clamp_to_limits(&mut pose);
        pose
    }

    /// Whoever can be taken for one who faces the other way is tried both ways.
    #[test]
    fn nobody_stays_the_wrong_way_round() {
        let body = Body::adult(1750.0).unwrap();
        let walking = held(
            &body,
            &[
                ("pelvis.rz", 40.0),
                ("left_hip.ry", -25.0),
                ("left_knee.ry", 20.0),
                ("right_knee.ry", 35.0),
                ("left_shoulder.ry", 20.0),
                ("right_shoulder.ry", -20.0),
                ("left_elbow.ry", -30.0),
                ("right_elbow.ry", -50.0),
            ],
        );
        let cameras = cameras_around();
        let observations = seen(&body, &cameras, &walking);
        let hulls = [Hull::carve(&cameras, &SeenView::all(&observations)).unwrap()];
        let mut progress = |_: &str, _, _| {};
        let seen = Seen::of(vec![observations]);
        let mut fitter = Fitter::new(&body, &cameras, seen, search(), by_silhouettes(), &mut progress).unwrap();
        let heading = index_of(&body, "pelvis.rz").unwrap();
        let right: Vec<f32> = walking.iter().map(|value| *value as f32).collect();
        let mut wrong = right.clone();
        wrong[heading] -= PI as f32;
        let fitness = |fitter: &Fitter<'_>, poses: &[Vec<f32>]| fitter.scorer.mean_fitness(poses).unwrap();
        let wrong = [wrong];
        let found = fitter.found_both_ways(&body, &hulls, &wrong, false, Hold::Feet).unwrap();
        let off = f64::from(found[0][heading] - right[heading]);
        let [after, before] = [fitness(&fitter, &found), fitness(&fitter, &wrong)];
        println!("{:.1} degrees off, {after} over {before}", off.to_degrees());
        assert!(off.cos() > 0.0 && after > before);
        // Whoever was right stays, as if nothing else had been tried.
        let (before, right) = (fitter.searches, [right]);
        let alone = fitter.found_on(&body, right.to_vec(), false).unwrap();
        let after = std::mem::replace(&mut fitter.searches, before);
        assert_eq!(fitter.found_both_ways(&body, &hulls, &right, false, Hold::Feet).unwrap(), alone);
        assert_eq!(fitter.searches, after);
    }

    /// Arms that hang in all first poses are found in every frame where they are lifted, by as much as there; what is right stays.
    #[test]
    fn limbs_are_looked_for_in_every_frame() {
        let body = Body::adult(1750.0).unwrap();
        let lifted = [0.0, 50.0, 75.0, 100.0];
        let poses = lifted.map(|degrees| held(&body, &[("left_shoulder.rx", degrees), ("left_elbow.ry", -20.0)]));
        let cameras = cameras_around();
        let seen = Seen::of(poses.iter().map(|pose| seen(&body, &cameras, pose)).collect());
        let mut progress = |_: &str, _, _| {};
        let mut fitter = Fitter::new(&body, &cameras, seen, search(), by_silhouettes(), &mut progress).unwrap();
        let shoulder = index_of(&body, "left_shoulder.rx").unwrap();
        let right = poses.map(|pose| pose.into_iter().map(|value| value as f32).collect::<Vec<f32>>());
        let mut hanging = right.to_vec();
        for pose in &mut hanging {
            pose[shoulder] = right[0][shoulder];
        }
        let found = fitter.look_for_limbs(&body, &hanging).unwrap();
        let wrists = |pose: &[f32]| {
            let pose: Vec<f64> = pose.iter().map(|value| f64::from(*value)).collect();
            let bones = body.world_from_bones(&pose).unwrap();
            ["left_hand", "right_hand"].map(|name| {
                let hand = body.parts.iter().find(|part| part.name == name).unwrap();
                bones[hand.bone].transform_point3(hand.a)
            })
        };
        for (frame, (found, right)) in found.iter().zip(&right).enumerate() {
            let off = [0, 1].map(|side| wrists(found)[side].distance(wrists(right)[side]));
            let before = wrists(&hanging[frame])[0].distance(wrists(right)[0]);
            println!("frame {frame}: wrists {off:.0?} mm off, {before:.0} before");
            assert!(off[0].max(off[1]) < 80.0 && (frame == 0 || before > 300.0));
        }
    }

    /// Behind a table and with hanging arms, front and back look alike: who walks there walks forwards, whichever way that is.
    #[test]
    fn who_looks_alike_both_ways_walks_forwards() {
        let body = Body::adult(1750.0).unwrap();
        let [x, heading] = ["pelvis.tx", "pelvis.rz"].map(|name| index_of(&body, name).unwrap());
        let cameras = cameras_around();
        let places = [-300.0, 300.0].map(|at| {
            let mut pose = held(&body, &[]);
            pose[x] = at;
            let mut observations = seen(&body, &cameras, &pose);
            for (camera, seen) in cameras.iter().zip(&mut observations) {
                let edge = camera.project(DVec3::new(at, 0.0, 900.0)).unwrap().y;
                let table = BitImage::from_fn(seen.width, seen.height, |_, y| f64::from(y) > edge);
                seen.ignore(&Arc::new(table)).unwrap();
            }
            (pose, observations)
        });
        for order in [[0, 1], [1, 0]] {
            let frames = order.map(|at| places[at].1.clone());
            let hulls = frames.each_ref().map(|seen| Hull::carve(&cameras, &SeenView::all(seen)).unwrap());
            let mut progress = |_: &str, _, _| {};
            let seen = Seen::of(frames.to_vec());
            let mut fitter = Fitter::new(&body, &cameras, seen, search(), by_silhouettes(), &mut progress).unwrap();
            let own = order.map(|at| places[at].0.iter().map(|value| *value as f32).collect::<Vec<f32>>());
            let still = [own[0].clone(), own[0].clone()];
            assert_eq!(fitter.worth(&body, &still).unwrap(), fitter.scorer.mean_fitness(&still).unwrap());
            let found = fitter.found_both_ways(&body, &hulls, &own, false, Hold::Crown).unwrap();
            let [ahead, fitness] =
                [fitter.worth(&body, &found), fitter.scorer.mean_fitness(&found)].map(Result::unwrap);
            let forwards = f32::cos(found[0][heading]) * if order[0] == 0 { 1.0 } else { -1.0 };
            println!("from {}: cosine {forwards:.2}, worth {ahead} of fitness {fitness}", order[0]);
            assert!(forwards > 0.7 && ahead > fitness + 0.7 * FORWARDS);
        }
    }

    /// Of a person behind a table no camera sees the legs, and the hull begins at the hips.
    #[test]
    fn who_has_no_legs_in_the_hull_is_held_by_the_crown() {
        let body = Body::adult(1750.0).unwrap();
        let standing = held(
            &body,
            &[("pelvis.rz", 40.0), ("left_shoulder.rx", 40.0), ("right_shoulder.rx", -60.0), ("left_elbow.ry", -30.0)],
        );
        let cameras = cameras_around();
        let mut observations = seen(&body, &cameras, &standing);
        for (camera, seen) in cameras.iter().zip(&mut observations) {
            let edge = camera.project(DVec3::new(0.0, 0.0, 900.0)).unwrap().y;
            let table = BitImage::from_fn(seen.width, seen.height, |_, y| f64::from(y) > edge);
            seen.ignore(&Arc::new(table)).unwrap();
        }
        let hulls = [Hull::carve(&cameras, &SeenView::all(&observations)).unwrap()];
        let height = index_of(&body, "pelvis.tz").unwrap();
        let mut found = |hold: Option<Hold>| {
            let mut progress = |_: &str, _, _| {};
            let seen = Seen::of(vec![observations.clone()]);
            let mut fitter = Fitter::new(&body, &cameras, seen, search(), by_silhouettes(), &mut progress).unwrap();
            let heading = Some(40.0);
            let poses = match hold {
                Some(hold) => fitter.found_in(&body, &hulls, heading, false, hold).unwrap(),
                None => fitter.found(&body, &hulls, heading, false).unwrap(),
            };
            let off = f64::from(poses[0][height]) - standing[height];
            (off, fitter.scorer.mean_fitness(&poses).unwrap())
        };
        let [by_feet, both] = [Some(Hold::Feet), None].map(&mut found);
        println!("hull {:?} mm, pelvis too high by {by_feet:?}, {both:?} mm", hulls[0].span);
        assert!(both.0.abs() < 60.0 && both.1 > by_feet.1 + 0.05);
    }
}
