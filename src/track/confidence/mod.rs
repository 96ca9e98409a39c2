//! How far a frame's pose and each of its joints can be trusted, and whether the person is lost.

mod alone;
mod calibration;
mod hints;
mod levers;

use self::calibration::{expected_error, wrong_probability};
use self::levers::Levers;
use super::FrameResult;
use super::journal::is_counted;
use crate::body::Body;

pub(super) use self::alone::terms_alone;
pub use self::calibration::WRONG;
pub use self::hints::JointHints;
pub(super) use self::hints::JointProbe;

/// Spread of a position at which the confidence in it is halved, mm: about a limb's thickness.
const HALF_TRUST: f64 = 100.0;
/// Sure frames that the running reference of a view averages over.
const MEMORY: f64 = 25.0;
/// Views from which on the worst one is left out of the agreement: a camera that drops out is no loss of the person.
const SPARE_VIEWS: usize = 3;

/// When a person counts as lost and as found again. docs/CONFIDENCE.md measures these thresholds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LossRule {
    /// An agreement below this is a loss.
    pub lost_below: f64,
    /// After a loss, an agreement of at least this is a find.
    pub found_from: f64,
    /// A probability of a wrong pose of at least this is a loss too.
    pub wrong_from: f64,
    /// After a loss, it must be below this for a find.
    pub right_below: f64,
}

impl Default for LossRule {
    fn default() -> Self {
        Self { lost_below: 0.8, found_from: 0.9, wrong_from: 0.8, right_below: 0.5 }
    }
}

/// The confidence of one frame after the other.
///
/// A frame's confidence is the product of three factors, each in [0, 1]:
/// - its fitness over the best fitness of the track so far (a track that is being lost scores less than it did);
/// - the square root of the worst view's f1 over the mean f1 of all views (a pose that is wrong in depth fits some views
///   and not others);
/// - 1 / (1 + (s / 100 mm)^2), where s is the standard deviation of the candidates' root position (a swarm that has not
///   settled has not decided).
///
/// A joint's confidence is the first two factors, the third with the joint's own standard deviation, and the share of the
/// views in which the joint lies on the silhouette.
///
/// How far a joint is expected to be off, and with which probability the pose is wrong, is calibrated (METHOD A13): by how far the joint
/// could lie elsewhere before the fitness told, what the pictures say of its limbs, the fitness, and the agreement.
///
/// Loss goes by that probability, and by the agreement: a view's `sqrt(f1 f2)` over its average in the sure frames so far
/// (exponentially, 25 frames), at most 1, and of that the mean over the views that have such a reference, less the worst where three
/// or more do.
#[derive(Clone, Debug)]
pub struct Confidence {
    body: Body,
    joint_names: Vec<String>,
    rule: LossRule,
    best_fitness: f64,
    /// Average of a view's `sqrt(f1 f2)` in the sure frames.
    references: Vec<f64>,
    sure_frames: usize,
    is_lost: bool,
    root: Vec<usize>,
    angles: Vec<usize>,
}

/// The confidence of a frame and the spreads it shows.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameConfidence {
    /// Root mean square over the root's translations of the candidates' standard deviation, mm.
    pub position_spread: f64,
    /// Root mean square over all rotations of the candidates' standard deviation, degrees.
    pub angle_spread: f64,
    /// In [0, 1].
    pub confidence: f64,
    /// What the views say, against what they said before, in [0, 1].
    pub agreement: f64,
    /// The probability that the pose is off by more than [`WRONG`], root mean square over the joints, or that nobody stands there.
    pub wrong: f64,
    /// Whether the person is lost.
    pub is_lost: bool,
    /// One a joint, in the order of [`Body::joint_names`].
    pub joints: Vec<JointConfidence>,
}

/// The confidence of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointConfidence {
    /// Standard deviation of the candidates' positions of it, mm.
    pub spread: f64,
    /// Share of the views that have it in their picture in which it lies on the silhouette.
    pub seen: f64,
    /// In [0, 1].
    pub confidence: f64,
    /// Its expected error, mm: 68 % of joints are within theirs.
    pub sigma: f64,
}

impl Confidence {
    /// For a body; before the first frame.
    pub fn new(body: &Body, rule: LossRule) -> Self {
        let chosen = |choose: &dyn Fn(usize, bool) -> bool| {
            let dofs = body.dofs().enumerate();
            dofs.filter(|(_, (bone, dof))| choose(*bone, dof.axis.is_rotation())).map(|(index, _)| index).collect()
        };
        Self {
            rule,
            best_fitness: 0.0,
            references: Vec::new(),
            sure_frames: 0,
            is_lost: false,
            root: chosen(&|bone, is_rotation| !is_rotation && body.bones[bone].parent.is_none()),
            angles: chosen(&|_, is_rotation| is_rotation),
            joint_names: body.joint_names(),
            body: body.clone(),
        }
    }

    /// The confidence of frames from the first on.
    pub fn of_all(body: &Body, rule: LossRule, results: &[FrameResult]) -> Vec<FrameConfidence> {
        let mut confidence = Self::new(body, rule);
        results.iter().map(|result| confidence.next(result)).collect()
    }

    /// The next frame's.
    pub fn next(&mut self, result: &FrameResult) -> FrameConfidence {
        let fitness = f64::from(result.fitness).clamp(0.0, 1.0);
        self.best_fitness = self.best_fitness.max(fitness);
        let relative = if self.best_fitness > 0.0 { fitness / self.best_fitness } else { 0.0 };
        let mean = result.mean_f1();
        let worst = result.counted_views().map(|(_, terms)| f64::from(terms[0])).fold(f64::INFINITY, f64::min);
        let balance = if mean > 0.0 { (worst / mean).clamp(0.0, 1.0).sqrt() } else { 0.0 };
        let position_spread = root_mean_square(&result.spread, &self.root);
        let agreement = self.agreement(&result.views);
        let spreads = self.spreads(result);
        let (sigmas, wrong) = self.expected(result, &spreads, agreement);
        let joints = spreads.into_iter().zip(&result.joints).zip(sigmas);
        let joints = joints.map(|((spread, hints), sigma)| {
            let seen = f64::from(hints.seen);
            JointConfidence { spread, seen, confidence: relative * balance * settled(spread) * seen, sigma }
        });
        let joints = joints.collect();
        self.judge(result, agreement, wrong);
        FrameConfidence {
            position_spread,
            angle_spread: root_mean_square(&result.spread, &self.angles).to_degrees(),
            confidence: relative * balance * settled(position_spread),
            agreement,
            wrong,
            is_lost: self.is_lost,
            joints,
        }
    }

    /// The expected error of each joint, mm, and the probability that the pose is wrong.
    fn expected(&self, result: &FrameResult, spreads: &[f64], agreement: f64) -> (Vec<f64>, f64) {
        let fitness = f64::from(result.fitness).clamp(0.0, 1.0);
        let joints = self.joint_names.iter().zip(&result.joints).zip(spreads);
        let sigmas: Vec<f64> =
            joints.map(|((name, hints), spread)| expected_error(name, hints, *spread, fitness)).collect();
        let wrong = wrong_probability(sigmas.iter().copied(), agreement);
        (sigmas, wrong)
    }

    /// Standard deviation of the candidates' positions of each joint, mm; none where the pose does not fit the body.
    fn spreads(&self, result: &FrameResult) -> Vec<f64> {
        let levers = Levers::of(&self.body, &result.pose);
        levers.map(|levers| levers.joint_spreads(&result.spread)).unwrap_or_default()
    }

    /// Whether the next frame would be a loss with this result, without taking note of it.
    pub(super) fn is_loss_at(&self, result: &FrameResult) -> bool {
        let agreement = self.agreement(&result.views);
        let (_, wrong) = self.expected(result, &self.spreads(result), agreement);
        self.is_loss(agreement, wrong)
    }

    /// Whether somebody of her size is where the next frame would be with these terms, one pair a view, however she is held.
    pub(super) fn is_there(&self, views: &[[f32; 2]]) -> bool {
        self.agreement(views) >= self.rule.lost_below
    }

    fn is_loss(&self, agreement: f64, wrong: f64) -> bool {
        let LossRule { lost_below, found_from, wrong_from, right_below } = self.rule;
        if self.is_lost {
            agreement < found_from || wrong >= right_below
        } else {
            agreement < lost_below || wrong >= wrong_from
        }
    }

    /// Judges the next frame, and learns from it if it is a sure one.
    fn judge(&mut self, result: &FrameResult, agreement: f64, wrong: f64) {
        self.is_lost = self.is_loss(agreement, wrong);
        if !self.is_lost {
            self.sure_frames += 1;
            let share = 1.0 / (self.sure_frames as f64).min(MEMORY);
            self.references.resize(result.views.len(), 0.0);
            for (view, terms) in result.counted_views() {
                let reference = &mut self.references[view];
                *reference += share * (view_term(terms) - *reference);
            }
        }
    }

    fn agreement(&self, views: &[[f32; 2]]) -> f64 {
        if self.sure_frames == 0 {
            // Nothing to compare with: any match at all is a beginning.
            return if views.iter().any(|view| view_term(view) > 0.0) { 1.0 } else { 0.0 };
        }
        let views = views.iter().zip(&self.references);
        let views = views.filter(|(view, reference)| is_counted(view) && **reference > 0.0);
        let mut ratios: Vec<f64> = views.map(|(view, reference)| (view_term(view) / reference).min(1.0)).collect();
        ratios.sort_by(f64::total_cmp);
        let counted = &ratios[usize::from(ratios.len() >= SPARE_VIEWS)..];
        if counted.is_empty() { 0.0 } else { counted.iter().sum::<f64>() / counted.len() as f64 }
    }
}

/// How well a view is matched, whatever the objective makes of it.
fn view_term(view: &[f32; 2]) -> f64 {
    let product = f64::from(view[0]) * f64::from(view[1]);
    if product > 0.0 { product.sqrt() } else { 0.0 }
}

fn settled(spread: f64) -> f64 {
    1.0 / (1.0 + (spread / HALF_TRUST).powi(2))
}

fn root_mean_square(values: &[f32], chosen: &[usize]) -> f64 {
    if chosen.is_empty() {
        return 0.0;
    }
    let squares = chosen.iter().filter_map(|&index| values.get(index)).map(|value| f64::from(*value).powi(2));
    (squares.sum::<f64>() / chosen.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn result(fitness: f32, views: &[f32], spread: f32) -> FrameResult {
        FrameResult {
            frame: 0,
            pose: vec![0.0; 31],
            fitness,
            spread: vec![spread; 31],
            views: views.iter().map(|f1| [*f1, 0.5]).collect(),
            joints: vec![
                JointHints { seen: 1.0, looseness: 20.0, support: 1.0, ambiguity: None };
                Body::adult(1750.0).unwrap().joint_names().len()
            ],
        }
    }

    fn confidence() -> Confidence {
        Confidence::new(&Body::adult(1750.0).unwrap(), LossRule::default())
    }

    #[test]
    fn each_factor_lowers_it() {
        let mut confidence = confidence();
        assert_eq!(confidence.next(&result(0.8, &[0.9, 0.9], 0.0)).confidence, 1.0);
        assert!((confidence.next(&result(0.4, &[0.9, 0.9], 0.0)).confidence - 0.5).abs() < 1e-6);
        let uneven = confidence.next(&result(0.8, &[0.9, 0.1], 0.0)).confidence;
        assert!((uneven - 0.2_f64.sqrt()).abs() < 1e-6, "{uneven}");
        let unsettled = confidence.next(&result(0.8, &[0.9, 0.9], 100.0));
        assert!((unsettled.confidence - 0.5).abs() < 1e-6 && (unsettled.position_spread - 100.0).abs() < 1e-9);
        assert!((unsettled.angle_spread - 100.0_f64.to_degrees()).abs() < 1e-6);
    }

    #[test]
    fn nothing_seen_is_no_confidence() {
        let mut confidence = confidence();
        for result in [result(0.0, &[0.0, 0.0], 0.0), result(0.0, &[], 0.0), result(f32::NAN, &[0.1], 1.0)] {
            assert_eq!(confidence.next(&result).confidence, 0.0);
        }
    }

    #[test]
    fn far_joints_spread_further_and_hidden_ones_are_doubted() {
        let body = Body::adult(1750.0).unwrap();
        let mut still = result(0.8, &[0.9; 4], 0.0);
        // The left hip alone is unsure.
        let hip = body.dof_index("left_hip.ry").unwrap();
        still.spread[hip] = 0.1;
        let joint = |name: &str| body.joint_index(name).unwrap();
        still.joints[joint("head")].seen = 0.25;
        let joints = confidence().next(&still).joints;
        let [hip, knee, ankle, other] = ["left_hip", "left_knee", "left_ankle", "right_knee"].map(joint);
        assert!(joints[hip].spread < 1e-6 && joints[other].spread == 0.0);
        assert!(joints[knee].spread > 30.0 && joints[ankle].spread > 1.5 * joints[knee].spread);
        assert!(joints[ankle].confidence < joints[knee].confidence && joints[other].confidence == 1.0);
        assert_eq!(joints[joint("head")].confidence, 0.25);
    }

    #[test]
    fn a_loss_is_one_of_the_person_not_of_a_camera() {
        let mut confidence = confidence();
        let mut judged = |views: &[f32]| confidence.next(&result(0.8, views, 0.0)).is_lost;
        for _ in 0..10 {
            assert!(!judged(&[0.9, 0.8, 0.9, 0.8]));
        }
        assert!(!judged(&[0.9, 0.8, 0.9, 0.0]), "one camera dropped out");
        assert!(judged(&[0.9, 0.1, 0.2, 0.0]));
        assert!(judged(&[0.0; 4]), "nobody there");
        assert!(judged(&[0.5, 0.45, 0.5, 0.45]), "not yet sure again");
        assert!(!judged(&[0.9, 0.8, 0.9, 0.8]), "back");
        assert!(confidence.is_there(&[[0.8, 0.5]; 4]) && !confidence.is_there(&[[0.3, 0.5]; 4]));
        // Half the fitness is the normal of another track: only the change counts.
        let mut poor = self::confidence();
        for _ in 0..10 {
            assert!(!poor.next(&result(0.3, &[0.4; 4], 0.0)).is_lost);
        }
    }
}
