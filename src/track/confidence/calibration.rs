//! What is known of a joint and a frame as numbers that mean something: an expected error in mm, and the probability that the pose is
//! wrong (METHOD A13). Fitted on development scenes drawn by lot with the bodies measured in them, held out scene by scene;
//! docs/CONFIDENCE.md shows how they hold.

use super::hints::JointHints;
use crate::body::without_side;

/// Of each kind of joint, left and right together: the constant in the logarithm of what a frame leaves open of it; and what it is off by in
/// every frame alike because the body was measured and is a model, mm, which no frame shows.
const JOINTS: [(&str, f64, f64); 12] = [
    ("pelvis", 1.256, 7.1),
    ("hip", 1.360, 14.2),
    ("knee", 0.648, 7.6),
    ("ankle", 0.148, 0.8),
    ("axis", 1.256, 7.1),
    ("thorax", 1.361, 14.9),
    ("clavicle", 1.171, 13.2),
    ("shoulder", 1.104, 36.2),
    ("elbow", 0.469, 20.9),
    ("wrist", 0.176, 13.8),
    ("head", 0.946, 20.8),
    ("head_top", 0.301, 15.7),
];
/// The same of a joint of another name.
const OTHER_JOINT: (f64, f64) = (0.850, 11.0);
/// Factors of what is known, in the same logarithm.
const LOOSENESS: f64 = 0.483;
const SUPPORT: f64 = 0.870;
const FITNESS: f64 = 1.199;
const SEEN: f64 = 0.063;
const SPREAD: f64 = 0.144;
/// The same of a frame that was gone over once, whose ambiguity is not known; and the factor of an ambiguity that is, which is added in squares.
const ONCE: f64 = 0.376;
const AMBIGUITY: f64 = 1.123;
/// Added to looseness, mm; and the sum up to which support tells nothing: what the fitness holds is where it is, whatever its colours.
const LOOSENESS_MORE: f64 = 5.0;
const HELD: f64 = 30.0;
/// Expected errors are held within these, mm.
const LIMITS: [f64; 2] = [3.0, 1000.0];

/// An error, root mean square over the joints, from which on a pose is wrong, mm: what `wrong` is the probability of.
pub const WRONG: f64 = 150.0;
/// The logit of a wrong pose over the logarithm of the joints' expected error: root mean square.
const WRONG_AT: [f64; 2] = [-14.353, 2.804];
/// An agreement of the views at which it is as likely as not that nobody stands there, and how quickly that changes.
const NOBODY_AT: f64 = 0.8;
const NOBODY_WIDTH: f64 = 0.04;

/// The expected error of a joint, mm: 68 % of joints are within theirs. `spread` is the standard deviation of the candidates, mm.
pub(super) fn expected_error(joint: &str, hints: &JointHints, spread: f64, fitness: f64) -> f64 {
    let kind = without_side(joint);
    let known = JOINTS.iter().find(|(name, ..)| *name == kind);
    let (constant, body) = known.map_or(OTHER_JOINT, |(_, constant, body)| (*constant, *body));
    let ambiguity = AMBIGUITY * f64::from(hints.ambiguity.unwrap_or(0.0));
    let error = (constant.exp() * left_open(hints, spread, fitness)).hypot(body).hypot(ambiguity);
    if error.is_nan() { LIMITS[1] } else { error.clamp(LIMITS[0], LIMITS[1]) }
}

/// What a frame leaves open of a joint, but for the constant of its kind.
fn left_open(hints: &JointHints, spread: f64, fitness: f64) -> f64 {
    let [seen, looseness, support] = [hints.seen, hints.looseness, hints.support].map(f64::from);
    let loose = looseness.max(0.0) + LOOSENESS_MORE;
    let logarithm = LOOSENESS * loose.ln()
        + SUPPORT * (1.0 - support) * (loose / HELD).max(1.0).ln()
        + FITNESS * (1.0 - fitness)
        + SEEN * (1.0 - seen)
        + SPREAD * (spread.max(0.0) + 1.0).ln()
        + if hints.ambiguity.is_none() { ONCE } else { 0.0 };
    logarithm.exp()
}

/// The probability that the joints are off by more than [`WRONG`], root mean square, or that nobody stands there.
pub(super) fn wrong_probability(expected: impl Iterator<Item = f64>, agreement: f64) -> f64 {
    let (sum, count) = expected.fold((0.0, 0.0), |(sum, count), error| (sum + error * error, count + 1.0));
    let [offset, slope] = WRONG_AT;
    let logistic = |logit: f64| 1.0 / (1.0 + (-logit).exp());
    let is_off = if count > 0.0 { logistic(offset + slope * 0.5 * (sum / count).ln()) } else { 1.0 };
    let is_nobody = logistic((NOBODY_AT - agreement) / NOBODY_WIDTH);
    1.0 - (1.0 - is_off) * (1.0 - is_nobody)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SURE: JointHints = JointHints { seen: 1.0, looseness: 20.0, support: 1.0, ambiguity: Some(0.0) };

    #[test]
    fn what_is_loose_unsupported_or_badly_explained_is_left_open() {
        let sure = left_open(&SURE, 1.0, 0.9);
        let loose = left_open(&JointHints { looseness: 150.0, ..SURE }, 1.0, 0.9);
        assert!(loose > 2.0 * sure, "{loose} {sure}");
        let unsupported = left_open(&JointHints { looseness: 150.0, support: -0.5, ..SURE }, 1.0, 0.9);
        assert!(unsupported > 3.0 * loose, "{unsupported} {loose}");
        assert_eq!(sure, left_open(&JointHints { support: -0.5, ..SURE }, 1.0, 0.9), "held");
        assert!(sure <= left_open(&JointHints { seen: 0.0, ..SURE }, 1.0, 0.9));
        let once = left_open(&JointHints { ambiguity: None, ..SURE }, 1.0, 0.9);
        assert!(once > 1.2 * sure && once < 2.0 * sure, "{once} {sure}");
        for worse in [left_open(&SURE, 60.0, 0.9), left_open(&SURE, 1.0, 0.6)] {
            assert!(worse > 1.05 * sure, "{worse} {sure}");
        }
    }

    #[test]
    fn what_is_left_open_the_body_and_the_other_poses_are_expected_together() {
        for (kind, constant, body) in JOINTS {
            let sure = expected_error(kind, &SURE, 1.0, 0.9);
            let open = constant.exp() * left_open(&SURE, 1.0, 0.9);
            assert!((sure - open.hypot(body)).abs() < 1e-9 && (5.0..45.0).contains(&sure), "{kind}: {sure}");
        }
        let sure = expected_error("left_elbow", &SURE, 1.0, 0.9);
        assert_eq!(sure, expected_error("right_elbow", &SURE, 1.0, 0.9));
        let unsupported = JointHints { looseness: 100.0, support: -0.5, ..SURE };
        let unsupported = expected_error("left_elbow", &unsupported, 1.0, 0.9);
        assert!(unsupported > 2.0 * sure, "{unsupported} {sure}");
        let ambiguous = expected_error("left_elbow", &JointHints { ambiguity: Some(100.0), ..SURE }, 1.0, 0.9);
        assert!((ambiguous - sure.hypot(100.0 * AMBIGUITY)).abs() < 1e-9, "{ambiguous}");
        let once = expected_error("left_elbow", &JointHints { ambiguity: None, ..SURE }, 1.0, 0.9);
        assert!(once > sure, "{once} {sure}");
        assert_eq!(sure, expected_error("left_elbow", &JointHints { support: -0.5, ..SURE }, 1.0, 0.9), "held");
        assert!(sure <= expected_error("left_elbow", &JointHints { seen: 0.0, ..SURE }, 1.0, 0.9));
        for worse in [expected_error("left_elbow", &SURE, 60.0, 0.9), expected_error("left_elbow", &SURE, 1.0, 0.6)] {
            assert!(worse > 1.05 * sure, "{worse} {sure}");
        }
        let unknown = expected_error("tail", &SURE, 1.0, 0.9);
        assert!((5.0..100.0).contains(&unknown), "{unknown}");
        let nothing =
            JointHints { seen: f32::NAN, looseness: f32::INFINITY, support: f32::NAN, ambiguity: Some(f32::NAN) };
        assert_eq!(expected_error("head", &nothing, f64::INFINITY, 0.0), LIMITS[1]);
    }

    #[test]
    fn a_pose_is_wrong_where_joints_are_far_off_or_views_disagree() {
        let wrong = |error: f64, agreement: f64| wrong_probability([error; 15].into_iter(), agreement);
        assert!(wrong(25.0, 1.0) < 0.03 && wrong(60.0, 1.0) < 0.2, "{} {}", wrong(25.0, 1.0), wrong(60.0, 1.0));
        assert!(wrong(200.0, 1.0) > 0.5, "{}", wrong(200.0, 1.0));
        assert!(wrong(25.0, 0.6) > 0.9 && wrong(25.0, NOBODY_AT) > 0.49);
        assert_eq!(wrong_probability(std::iter::empty(), 1.0), 1.0, "nothing known is no pose");
        let all: Vec<f64> = (0..20).map(|step| wrong(20.0 * 1.2_f64.powi(step), 1.0)).collect();
        assert!(all.is_sorted() && all.iter().all(|wrong| (0.0..=1.0).contains(wrong)), "{all:?}");
    }
}
