//! Tracks through the sections of a window, on a person that is drawn.

use super::hypotheses::Limbs;
use super::scorer::{Candidate, Effort, Scorer, most_under, most_worth};
use super::section::order;
use super::shape::Shape;
use super::tests::{FRAMES, Moving, dof, worst};
use super::tracks::{Lead, Track};
use super::window::Seen;
use crate::features::Observation;
use crate::track::fit_tests::cameras_around;

/// An arm that a track loses in the middle of a section, for long, is found by what comes from the sections around.
#[test]
fn tracks_go_on_into_the_next_section() {
    const SECTION: usize = 2;
    let reach = Moving::new(|t| vec![("left_shoulder.rx", 1.0 + 0.08 * t), ("left_elbow.ry", -0.4)]);
    let seen: Vec<&Seen> = reach.seen.iter().collect();
    let shoulder = dof(&reach.body, "left_shoulder.rx");
    let mut given = reach.truth.clone();
    given[4..6].iter_mut().for_each(|pose| pose[shoulder] = 0.0);
    let steps = reach.space.spread(1.0 / 25.0).unwrap();
    let limbs = Limbs::new(&reach.body, &cameras_around(), &reach.space);
    reach.with_scorer(|mut scorer| {
        let (seen, given) = (&seen[4..][..SECTION], &given[4..][..SECTION]);
        let track = Track { limbs: &limbs, given, spread: &steps, steps: &steps, is_back: true };
        let of = |scorer: &mut Scorer<'_>, t: usize, poses: &[&Vec<f32>]| {
            scorer.observe(&reach.seen[t].observations).unwrap();
            scorer.candidates(&poses.iter().map(|pose| (*pose).clone()).collect::<Vec<_>>()).unwrap()
        };
        let last = [7, 6].map(|t| Some(of(&mut scorer, t, &[&reach.truth[t]]).remove(0)));
        // Where nobody knows the arm it is followed to the end, and where it is known no further.
        for (known, followed) in [([false, false], 2), ([true, true], 1), ([true, false], 2)] {
            let of_frame = |nth: usize| {
                let right = &reach.truth[4 + nth];
                if known[nth] { vec![&given[nth], right] } else { vec![&given[nth]] }
            };
            let mut candidates: Vec<_> = (0..SECTION).map(|nth| of(&mut scorer, 4 + nth, &of_frame(nth))).collect();
            let before: usize = candidates.iter().map(Vec::len).sum();
            track.go_on(&mut scorer, seen, &order(SECTION, true), last.clone(), &mut candidates).unwrap();
            assert_eq!(candidates.iter().map(Vec::len).sum::<usize>(), before + followed, "{known:?}");
            let errors = candidates.iter().enumerate().map(|(nth, of_frame)| {
                let right = Shape::new(&reach.body).points(&reach.truth[4 + nth]);
                let off = of_frame
                    .iter()
                    .map(|found| found.points.iter().zip(&right).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max));
                off.fold(f64::INFINITY, f64::min)
            });
            let errors: Vec<f64> = errors.collect();
            println!("{known:?}: {errors:.1?} mm");
            assert!(errors[1] < 60.0 && errors[0] < 60.0, "{known:?}: {errors:?}");
        }
    });
}

/// Somebody who sets off where another track has legs exchanged: that pose was searched and looks better than any that a track is led to, until
/// these are searched too.
#[test]
fn a_track_stays_with_its_legs() {
    let parting = Moving::new(|t| {
        let (angle, way) = [(0.0, 0.0), (0.15, 0.0), (0.3, 140.0)][(t as usize).min(2)];
        let legs = [("left_hip.ry", -angle), ("right_hip.ry", angle), ("pelvis.tx", way)];
        [&legs[..], &[("left_knee.ry", 0.3), ("right_knee.ry", 0.3), ("left_shoulder.rx", 0.9)]].concat()
    });
    let limbs = Limbs::new(&parting.body, &cameras_around(), &parting.space);
    let hip = dof(&parting.body, "left_hip.ry");
    let exchange = |pose: &[f32]| {
        let poses = limbs.twins.iter().map(|twins| limbs.exchanged(*twins, pose, &parting.space));
        poses.filter(|exchanged| exchanged[hip] != pose[hip]).collect::<Vec<_>>().remove(0)
    };
    let steps = parting.space.spread(1.0 / 25.0).unwrap();
    let at = 2;
    parting.with_scorer(|mut scorer| {
        let last = [0, 1].map(|t| {
            scorer.observe(&parting.seen[t].observations).unwrap();
            Some(scorer.candidate(parting.truth[t].clone()).unwrap())
        });
        scorer.observe(&parting.seen[at].observations).unwrap();
        let effort = Effort { spread: &steps, generations: 40, turn: 9 };
        let known = scorer.search_all(at, &exchange(&parting.truth[at]), effort, None).unwrap();
        let given = [known.pose.clone()];
        let track = Track { limbs: &limbs, given: &given, spread: &steps, steps: &steps, is_back: false };
        let mut starts = given.to_vec();
        let Lead { led, pull } = track.lead(&scorer, 0, &last, &mut starts);
        starts.truncate(led.end);
        let scored = scorer.candidates(&starts).unwrap();
        assert_eq!(most_under(&scored, pull.as_ref()), 0, "where the track is led looks better than what was searched");

        let right = Shape::new(&parting.body).points(&parting.truth[at]);
        let off = |found: &Candidate| found.points.iter().zip(&right).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        let mut candidates = vec![vec![known.clone()]];
        track.go_on(&mut scorer, &[&parting.seen[at]], &[0], last, &mut candidates).unwrap();
        let errors: Vec<f64> = candidates[0].iter().map(off).collect();
        println!("exchanged {:.0} mm off, found {:.0?}", errors[0], &errors[1..]);
        // The search of one frame comes near to the right one, and leaves the rest to the passes after it.
        assert!(errors[0] > 300.0 && errors[1] < 0.3 * errors[0], "{errors:?}");
    });
}

/// A trunk that is turned far is tried straight, with the limbs that hang on it and no others; one that is turned by less is not.
#[test]
fn a_trunk_that_is_turned_far_is_tried_straight() {
    let standing = Moving::new(|_| vec![("left_shoulder.rx", 0.8), ("right_shoulder.rx", -0.4)]);
    let Moving { body, space, truth, .. } = &standing;
    let limbs = Limbs::new(body, &cameras_around(), space);
    let [turn, elbow, knee] = ["thorax.rz", "left_elbow.ry", "left_knee.ry"].map(|name| dof(body, name));
    let turned = |share: f32| {
        let mut pose = truth[0].clone();
        pose[turn] = share * if share > 0.0 { space.upper()[turn] } else { -space.lower()[turn] };
        pose
    };
    for share in [0.0, 0.4, -0.4] {
        assert!(limbs.straightened(&turned(share), space).is_none(), "{share}");
    }
    for share in [0.6, -1.0] {
        let pose = turned(share);
        let (straight, hanging) = limbs.straightened(&pose, space).unwrap();
        assert_eq!(straight, turned(0.0));
        let other = vec![9.0; pose.len()];
        let moved = |d: usize| hanging.iter().any(|&limb| limbs.with(limb, &pose, &other)[d] == 9.0);
        assert!(moved(elbow) && !moved(knee), "{hanging:?}");
    }
    // Where the trunk is straight in the pictures, a track that begins with it turned ends straight in every frame.
    let given: Vec<Vec<f32>> = vec![turned(0.9); FRAMES];
    let (before, after) = (standing.errors(&given), standing.errors(&standing.mended(&given)));
    println!("worst {:.1} to {:.1} mm", worst(&before), worst(&after));
    assert!(worst(&before) > 200.0 && worst(&after) < 60.0, "{} to {}", worst(&before), worst(&after));
}

/// Somebody who faces the other way has the joints of one side where the other's were, and is turned back by the same.
#[test]
fn sides_change_places_where_a_body_faces_the_other_way() {
    let held =
        [("thorax.ry", 0.2), ("thorax.rz", 0.3), ("left_hip.rx", 0.2), ("left_hip.ry", 0.3), ("right_hip.ry", -0.4)];
    let arms = [("left_shoulder.rx", 0.7), ("left_shoulder.ry", -0.3), ("right_shoulder.rx", -0.5), ("pelvis.rz", 0.4)];
    let standing = Moving::new(|_| [&held[..], &arms[..], &[("pelvis.rx", 0.1), ("pelvis.ry", -0.1)]].concat());
    let Moving { body, space, truth, .. } = &standing;
    let limbs = Limbs::new(body, &cameras_around(), space);
    let [turned, bent] = limbs.turned_round(&truth[0], space).unwrap();
    let [[back, _], [from_bent, _]] = [&turned, &bent].map(|pose| limbs.turned_round(pose, space).unwrap());
    let off = |pose: &[f32]| pose.iter().zip(&truth[0]).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(off(&back) < 1e-5 && off(&from_bent) < 1e-5 && off(&turned) > 3.0);
    let shape = Shape::new(body);
    let [before, after] = [&truth[0], &turned].map(|pose| shape.points(pose));
    // Of what ends freely the head's top and the toes lie before the axis, on either side.
    for (name, point) in body.joint_names().iter().zip(&before).take(body.bones.len()) {
        let other = match (name.strip_prefix("left_"), name.strip_prefix("right_")) {
            (Some(rest), _) => format!("right_{rest}"),
            (_, Some(rest)) => format!("left_{rest}"),
            _ => name.to_string(),
        };
        let there = body.joint_index(&other).unwrap();
        assert!(point.distance(after[there]) < 0.1, "{name} at {point}, {other} turned at {}", after[there]);
    }
}

/// Somebody who was tracked the wrong way round from the first frame on walks forwards afterwards; one who walks backwards goes on doing so.
#[test]
fn who_was_tracked_the_wrong_way_round_is_turned() {
    let walking = |way: f32| {
        Moving::new(move |t| {
            let swing = 0.45 * (0.9 * t).sin();
            let legs =
                [("left_hip.ry", swing), ("right_hip.ry", -swing), ("left_knee.ry", 0.3), ("right_knee.ry", 0.3)];
            let arms = [
                ("left_shoulder.ry", -swing),
                ("right_shoulder.ry", swing),
                ("left_elbow.ry", -0.8),
                ("right_elbow.ry", -0.8),
            ];
            [&legs[..], &arms[..], &[("pelvis.tx", way * 60.0 * t)]].concat()
        })
    };
    for (way, is_turned) in [(1.0, true), (-1.0, false)] {
        let walk = walking(way);
        let limbs = Limbs::new(&walk.body, &cameras_around(), &walk.space);
        assert!((limbs.facing.unwrap().along(&walk.truth) - f64::from(way)).abs() < 1e-6);
        let turned = |pose: &Vec<f32>| limbs.turned_round(pose, &walk.space).unwrap()[1].clone();
        let given: Vec<Vec<f32>> = if is_turned { walk.truth.iter().map(turned).collect() } else { walk.truth.clone() };
        let (before, after) = (walk.errors(&given), walk.errors(&walk.mended(&given)));
        let of_frames: Vec<f64> = after.iter().map(|errors| worst(std::slice::from_ref(errors))).collect();
        println!("{way}: worst {:.1} to {of_frames:.0?} mm", worst(&before));
        assert_eq!(worst(&before) > 300.0, is_turned);
        assert!(worst(&after) < 60.0, "{way}: {} to {}", worst(&before), worst(&after));
    }
}

/// A frame that shows something nobody explains has its limbs looked for on the way back, and on the way forwards only where that came to
/// another pose.
#[test]
fn limbs_are_looked_for_once() {
    const POOR: usize = 5;
    let mut standing = Moving::new(|t| vec![("left_shoulder.rx", 0.6), ("pelvis.tx", 10.0 * t)]);
    for observation in &mut standing.seen[POOR].observations {
        let row = observation.width as usize;
        let marked = observation.bytes.chunks_exact_mut(row).take(40).flat_map(|row| &mut row[..40]);
        marked.for_each(|byte| *byte |= Observation::SILHOUETTE);
    }
    let steps = standing.space.spread(1.0 / 25.0).unwrap();
    let seen: Vec<&Seen> = standing.seen.iter().collect();
    let limbs = Limbs::new(&standing.body, &cameras_around(), &standing.space);
    let track = |is_back| Track { limbs: &limbs, given: &standing.truth, spread: &steps, steps: &steps, is_back };
    // Poses scored on the way forwards, where it is known what was looked into and where it is not.
    let [known, forgotten] = [true, false].map(|is_known| {
        standing.with_scorer(|mut scorer| {
            let mut candidates = Vec::new();
            for (seen, pose) in seen.iter().zip(&standing.truth) {
                scorer.observe(&seen.observations).unwrap();
                candidates.push(scorer.candidates(std::slice::from_ref(pose)).unwrap());
            }
            let mut most = most_worth(candidates.iter().flatten());
            let mut follow = |scorer: &mut Scorer<'_>, candidates: &mut [Vec<Candidate>], is_back| {
                track(is_back).follow(scorer, &seen, &order(FRAMES, is_back), &mut most, candidates).unwrap();
            };
            follow(&mut scorer, &mut candidates, true);
            let looked_into: Vec<bool> =
                candidates.iter().map(|of_frame| of_frame.iter().any(|candidate| candidate.is_looked_into)).collect();
            assert_eq!(looked_into, (0..FRAMES).map(|t| t == POOR).collect::<Vec<_>>());
            if !is_known {
                candidates.iter_mut().flatten().for_each(|candidate| candidate.is_looked_into = false);
            }
            let before = scorer.scored;
            follow(&mut scorer, &mut candidates, false);
            scorer.scored - before
        })
    });
    println!("{known} poses scored, {forgotten} where it is forgotten what was looked into");
    // A search round the pose, and one round the best of each limb.
    assert!(known + 2000 < forgotten, "{known} and {forgotten}");
}

/// A pose that was looked at on the way back, and of which nothing suspicious was said, is not looked at forwards; another one is.
#[test]
fn a_pose_is_looked_at_once() {
    let reach = Moving::new(|t| vec![("left_shoulder.rx", 1.0 + 0.08 * t), ("left_elbow.ry", -0.4)]);
    let shoulder = dof(&reach.body, "left_shoulder.rx");
    let mut hidden = reach.truth.clone();
    hidden.iter_mut().for_each(|pose| pose[shoulder] = 0.0);
    let limbs = Limbs::new(&reach.body, &cameras_around(), &reach.space);
    // In this frame another limb has its turn.
    let at = (0..FRAMES).find(|index| {
        let turned = limbs.with(index % limbs.count(), &hidden[0], &reach.truth[0]);
        turned[shoulder] == hidden[0][shoulder]
    });
    let at = at.unwrap()..at.unwrap() + 1;
    let narrow: Vec<f32> = reach.space.spread(1.0 / 25.0).unwrap().iter().map(|step| 0.05 * step).collect();
    let seen: Vec<&Seen> = reach.seen[at.clone()].iter().collect();
    let given = &hidden[at.clone()];
    let track = Track { limbs: &limbs, given, spread: &narrow, steps: &narrow, is_back: false };
    let found = [false, true].map(|is_looked_at| {
        reach.with_scorer(|mut scorer| {
            scorer.observe(&seen[0].observations).unwrap();
            let mut candidates = vec![scorer.candidates(given).unwrap()];
            candidates[0][0].is_looked_at = is_looked_at;
            let mut most = candidates[0][0].worth;
            let [_, last] = track.follow(&mut scorer, &seen, &[0], &mut most, &mut candidates).unwrap();
            last.unwrap().pose[shoulder]
        })
    });
    let right = reach.truth[at.start][shoulder];
    assert!((found[0] - right).abs() < 0.2 && found[1] < 0.2, "{found:?} for {right}");
}
