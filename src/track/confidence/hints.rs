//! What a frame by itself says of each joint of its pose: seen on silhouettes, held by the fitness, supported by the pictures (METHOD A13).

use anyhow::Result;
use glam::DVec3;

use super::levers::Levers;
use crate::body::{Body, Part};
use crate::evaluate::{Evaluator, Objective};
use crate::features::SeenView;
use crate::geometry::Camera;
use crate::track::sight::{Place, along, pixel, said_of};

/// What a frame by itself says of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointHints {
    /// Share of the views that have it in their picture in which it lies on the silhouette.
    pub seen: f32,
    /// How far it could lie elsewhere before the fitness told, mm: each degree of freedom turned by itself.
    pub looseness: f32,
    /// What the pictures say of the limbs that meet in it, from -1 (surely background) to 1 (surely those limbs): the mean along the axes
    /// of the worse of the two.
    pub support: f32,
    /// How far it lies from here in other poses of the frame that a second pass found, by what they are worth, mm; none without such a pass.
    pub ambiguity: Option<f32>,
}

/// How far a degree of freedom moves the joint that it moves most, to see what the fitness makes of it, mm.
const REACH: f64 = 30.0;
/// The largest turn for that, radians: a twist of a straight limb moves no joint far.
const LARGEST_TURN: f64 = 0.5;
/// A side on which a limit is nearer than this is not asked, mm.
const NEAREST: f64 = 1.0;
/// The loss of fitness, relative to it, that tells; and the least that is believed: noise of single pixels.
const TELLING: f64 = 0.01;
const NOISE: f64 = 0.0005;
/// Places along a limb's axis that are asked for support.
const PLACES: usize = 6;

/// Asks a frame about the joints of a pose.
#[derive(Clone, Debug)]
pub(in crate::track) struct JointProbe {
    body: Body,
    cameras: Vec<Camera>,
    /// The bones whose parts meet in a joint.
    bones: Vec<Vec<usize>>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    /// Whether a degree of freedom is a rotation.
    is_turn: Vec<bool>,
}

impl JointProbe {
    pub(in crate::track) fn new(body: &Body, cameras: &[Camera]) -> Self {
        let has_parts = |bone: &usize| body.parts.iter().any(|part| part.bone == *bone);
        let of_bone =
            |bone: usize| [Some(bone), body.bones[bone].parent].into_iter().flatten().filter(has_parts).collect();
        let ends = body.free_ends().into_iter().map(|end| vec![end.bone]);
        Self {
            bones: (0..body.bones.len()).map(of_bone).chain(ends).collect(),
            lower: body.dofs().map(|(_, dof)| dof.limits[0]).collect(),
            upper: body.dofs().map(|(_, dof)| dof.limits[1]).collect(),
            is_turn: body.dofs().map(|(_, dof)| dof.axis.is_rotation()).collect(),
            body: body.clone(),
            cameras: cameras.to_vec(),
        }
    }

    /// One a joint, in the order of [`Body::joint_names`]. The evaluator holds what was seen in these views.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(in crate::track) fn ask(
        &self,
        evaluator: &mut dyn Evaluator,
        objective: &Objective,
        views: &[SeenView<'_>],
        pose: &[f32],
    ) -> Result<Vec<JointHints>> {
        let Some(levers) = Levers::of(&self.body, pose) else {
            return Ok(vec![JointHints::default(); self.bones.len()]);
        };
        let looseness = self.looseness(evaluator, objective, pose, &levers)?;
        let support = self.support(evaluator, objective, views, &levers.bones)?;
        let hints = levers.joints.iter().zip(looseness).zip(support);
        let hints = hints.map(|((&joint, looseness), support)| JointHints {
            seen: self.seen(views, joint),
            looseness,
            support,
            ambiguity: None,
        });
        Ok(hints.collect())
    }

    /// How far each joint could lie elsewhere before the fitness told, mm.
    fn looseness(
        &self,
        evaluator: &mut dyn Evaluator,
        objective: &Objective,
        pose: &[f32],
        levers: &Levers,
    ) -> Result<Vec<f32>> {
        // The pose itself, then each degree of freedom to both sides, as far as its limits let it.
        let mut rows = pose.to_vec();
        let mut tries = Vec::new();
        let longest: Vec<f64> =
            levers.of_dofs.iter().map(|levers| levers.iter().copied().fold(0.0, f64::max)).collect();
        for (dof, (&start, &longest)) in pose.iter().zip(&longest).enumerate() {
            let value = f64::from(start);
            let largest = if self.is_turn[dof] { LARGEST_TURN } else { f64::INFINITY };
            for side in [-1.0, 1.0] {
                let moved =
                    (value + side * (REACH / longest.max(1e-6)).min(largest)).clamp(self.lower[dof], self.upper[dof]);
                let way = longest * (moved - value).abs();
                if way >= NEAREST {
                    let begin = rows.len();
                    rows.extend(pose);
                    rows[begin + dof] = moved as f32;
                    tries.push((dof, way));
                }
            }
        }
        let mut fitness = vec![0.0; rows.len() / pose.len()];
        evaluator.fitness(&rows, objective, &mut fitness)?;
        let best = f64::from(fitness[0]);
        let mut ways = vec![0.0_f64; pose.len()];
        for (&(dof, way), there) in tries.iter().zip(&fitness[1..]) {
            let loss = (best - f64::from(*there)) / best.max(1e-6);
            ways[dof] = ways[dof].max(way * (TELLING / loss.max(NOISE)).sqrt());
        }
        let mut variances = vec![0.0; levers.joints.len()];
        for ((levers, longest), way) in levers.of_dofs.iter().zip(longest).zip(ways) {
            let share = |lever: &f64| lever / longest.max(1e-6);
            variances.iter_mut().zip(levers).for_each(|(variance, lever)| *variance += (share(lever) * way).powi(2));
        }
        Ok(variances.into_iter().map(|variance| variance.sqrt() as f32).collect())
    }

    /// What the pictures say of the limbs that meet in each joint.
    fn support(
        &self,
        evaluator: &mut dyn Evaluator,
        objective: &Objective,
        views: &[SeenView<'_>],
        bones: &[glam::DAffine3],
    ) -> Result<Vec<f32>> {
        let mut sums = vec![[0.0, 0.0]; self.body.bones.len()];
        let (of_bones, places): (Vec<usize>, Vec<Place>) = self.places(views, bones).unzip();
        for (bone, said) in of_bones.into_iter().zip(said_of(evaluator, objective, views, &places)?) {
            let sum = &mut sums[bone];
            *sum = [sum[0] + said, sum[1] + 1.0];
        }
        let of_bone = |bone: &usize| if sums[*bone][1] > 0.0 { sums[*bone][0] / sums[*bone][1] } else { 0.0 };
        let worse = |bones: &Vec<usize>| bones.iter().map(of_bone).reduce(f32::min).unwrap_or(0.0);
        Ok(self.bones.iter().map(worse).collect())
    }

    /// Where the views show the axes of the body's parts, and the bones of these.
    fn places<'a>(
        &'a self,
        views: &'a [SeenView<'a>],
        bones: &'a [glam::DAffine3],
    ) -> impl Iterator<Item = (usize, Place)> + 'a {
        let of_part = |part: &'a Part| {
            let axis = [part.a, part.b].map(|end| bones[part.bone].transform_point3(end));
            along(&self.cameras, views, axis, part.label, PLACES).map(|place| (part.bone, place))
        };
        self.body.parts.iter().flat_map(of_part)
    }

    fn seen(&self, views: &[SeenView<'_>], joint: DVec3) -> f32 {
        let (mut inside, mut seen) = (0, 0);
        for (camera, view) in self.cameras.iter().zip(views) {
            if let Some((_, at)) = pixel(camera, *view, joint) {
                inside += 1;
                seen += u32::from(view.is_person(at));
            }
        }
        if inside > 0 { seen as f32 / inside as f32 } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::fit_tests::{cameras_around, seen};
    use super::*;
    use crate::evaluate::{ObjectiveKind, Reference};
    use crate::features::Observation;

    #[test]
    fn what_is_seen_holds_a_joint_and_what_is_hidden_leaves_it_loose() {
        let (body, cameras) = (Body::adult(1700.0).unwrap(), cameras_around());
        let pose = body.standing_pose();
        let mut observations = seen(&body, &cameras, &pose);
        let single: Vec<f32> = pose.iter().map(|value| *value as f32).collect();
        let probe = JointProbe::new(&body, &cameras);
        let mut evaluator = Reference::new(&body, &cameras);
        let objective = Objective::of(ObjectiveKind::Ws);
        let mut ask = |observations: &[Observation], pose: &[f32]| {
            evaluator.observe(observations).unwrap();
            probe.ask(&mut evaluator, &objective, &SeenView::all(observations), pose).unwrap()
        };
        let all = ask(&observations, &single);
        assert_eq!(all.len(), body.joint_names().len());
        assert!(all.iter().filter(|hints| hints.seen == 1.0).count() * 4 > all.len() * 3, "{all:?}");
        let joint = |name: &str| body.joint_index(name).unwrap();
        let [wrist, ankle] = ["left_wrist", "left_ankle"].map(joint);
        assert!(all[ankle].support > 0.9 && all[ankle].looseness < 60.0, "{:?}", all[ankle]);
        // An arm that is not where it is thought is not supported.
        let mut lifted = single.clone();
        lifted[body.dof_index("left_shoulder.rx").unwrap()] = 1.5;
        let wrong = ask(&observations, &lifted);
        assert!(wrong[wrist].support < 0.0 && wrong[ankle].support > 0.9, "{:?}", wrong[wrist]);
        // Fewer views see less, and hold less.
        observations[1].bytes.fill(0);
        observations[2].bytes.fill(0);
        let fewer = ask(&observations, &single);
        assert!(fewer.iter().all(|hints| hints.seen < 0.7), "{fewer:?}");
    }
}
