//! One name of a joint for all that programs call it: `RShoulder` of OpenPose, COCO and Halpe, `right_shoulder`, `R_Shoulder`, `shoulder_r`.

/// Joints and places that both sides have, as each is called without its side.
const OF_A_SIDE: [&[&str]; 12] = [
    &["shoulder"],
    &["elbow"],
    &["wrist"],
    &["hip"],
    &["knee"],
    &["ankle"],
    &["heel"],
    &["bigtoe"],
    &["smalltoe"],
    &["eye"],
    &["ear"],
    &["hand"],
];
/// Those in the middle. Halpe26 marks the crown as its head.
const IN_THE_MIDDLE: [&[&str]; 4] = [&["nose"], &["neck"], &["midhip", "hip", "hips"], &["headtop", "head", "tophead"]];
/// How a side is written.
const SIDES: [&[&str]; 2] = [&["left", "l"], &["right", "r"]];

/// A joint: its row of a list, and its side, where it has one.
pub(super) type Joint = (usize, Option<usize>);

/// The joint that a name means; none where it is no joint's.
pub(super) fn joint(name: &str) -> Option<Joint> {
    let plain: String = name.chars().filter(|sign| !['_', '-', ' ', '.'].contains(sign)).collect();
    let plain = plain.to_lowercase();
    let row = |lists: &[&[&str]], name: &str| lists.iter().position(|names| names.contains(&name));
    if let Some(at) = row(&IN_THE_MIDDLE, &plain) {
        return Some((at, None));
    }
    SIDES.iter().enumerate().find_map(|(side, names)| {
        let rest = names.iter().flat_map(|own| [plain.strip_prefix(own), plain.strip_suffix(own)]);
        rest.flatten().find_map(|rest| row(&OF_A_SIDE, rest)).map(|at| (at, Some(side)))
    })
}

/// Bones of skeletons for animation, where what is called `LeftShoulder` is a collar bone and `Head` the base of the skull.
const OF_ANIMATION: [&str; 4] = ["leftarm", "rightarm", "leftupleg", "rightupleg"];

/// Whether names that sound like joints are meant as joints among all these.
pub(super) fn are_joints(names: &[String]) -> bool {
    !names.iter().any(|name| OF_ANIMATION.contains(&name.to_lowercase().as_str()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_ways_to_write_a_joint_are_one() {
        for names in [
            &["RShoulder", "right_shoulder", "R_Shoulder", "shoulder_r", "Right Shoulder", "rightShoulder"][..],
            &["LAnkle", "left_ankle", "l_ankle", "ankle_l", "LeftAnkle"],
            &["LBigToe", "left_big_toe"],
            &["MidHip", "mid_hip", "Hip"],
            &["Head", "head_top", "HeadTop"],
        ] {
            let first = joint(names[0]);
            assert!(first.is_some(), "{names:?}");
            assert!(names.iter().all(|name| joint(name) == first), "{names:?}");
        }
        assert_ne!(joint("LHip"), joint("RHip"));
        // Markers lie on the skin and are no joints' centres.
        for name in ["LKNE", "RSHO", "LHEE", "RTOE", "pelvis", "left", "l", "r", "", "CLAV", "left_foot_tip"] {
            assert_eq!(joint(name), None, "{name}");
        }
    }
}
