//! AMC: the angles of an ASF skeleton, frame by frame.

use std::collections::HashMap;

use anyhow::{Context, Result, bail, ensure};
use glam::{DMat3, DQuat, DVec3};

use super::super::number::{finite, whole};
use super::super::points::LARGEST_COORDINATE;
use super::asf::{AmcChannel, AsfSkeleton};
use super::{Placement, SkeletalJoint, SkeletalMotion, UpAxis, ensure_size};
use crate::files::shortened;

/// The values of each bone in a frame, as far as the file gives them.
type Row = Vec<Option<Vec<f64>>>;

/// Reads the text of an AMC file that moves `skeleton` at `rate` frames a second (the format does not say it); `name` stands
/// for the file in messages. A joint is where a bone begins and has its name; the free ends are named `<bone>_end`.
///
/// # Errors
/// One sentence with the file, the line, what was found and what was expected: a bone that the skeleton does not have, one
/// missing in a frame, too many or too few numbers, frames out of order.
pub fn parse_amc(text: &str, name: &str, skeleton: &AsfSkeleton, rate: f64) -> Result<SkeletalMotion> {
    ensure!(rate.is_finite() && rate > 0.0, "{name}: the frame rate is {rate}, expected a positive number");
    let index: HashMap<&str, usize> =
        skeleton.bones.iter().enumerate().map(|(index, bone)| (bone.name.as_str(), index)).collect();
    let mut in_degrees = skeleton.in_degrees;
    let mut rows: Vec<(usize, Row)> = Vec::new();
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    for (line, content) in text.lines().enumerate().map(|(index, line)| (index + 1, line)) {
        let words: Vec<&str> = content.split('#').next().unwrap_or_default().split_whitespace().collect();
        let Some(&first) = words.first() else { continue };
        let place = || format!("{name}, line {line}");
        if let Some(header) = first.strip_prefix(':') {
            match header.to_ascii_uppercase().as_str() {
                "DEGREES" => in_degrees = true,
                "RADIANS" => in_degrees = false,
                _ => {}
            }
        } else if words.len() == 1 && first.starts_with(|c: char| c.is_ascii_digit()) {
            let number = whole(first).with_context(place)?;
            if let Some((before, _)) = rows.last() {
                ensure!(
                    number == before + 1,
                    "{}: frame {number} follows frame {before}, expected frame {}",
                    place(),
                    before + 1
                );
            }
            ensure_size(2 * skeleton.bones.len(), rows.len() + 1).with_context(place)?;
            rows.push((number, vec![None; skeleton.bones.len()]));
        } else {
            let Some((_, row)) = rows.last_mut() else {
                bail!("{}: found `{}`, expected the number of the first frame", place(), shortened(first));
            };
            let Some(&bone) = index.get(first) else {
                bail!("{}: bone `{}` is not in the skeleton", place(), shortened(first));
            };
            let expected = skeleton.bones[bone].channels.len();
            ensure!(
                words.len() == expected + 1,
                "{}: `{first}` has {} values, expected {expected} as the skeleton says",
                place(),
                words.len() - 1
            );
            let values: Vec<f64> =
                words[1..].iter().map(|word| finite(word)).collect::<Result<_>>().with_context(place)?;
            ensure!(
                values.iter().all(|value| value.abs() <= LARGEST_COORDINATE),
                "{}: `{first}` holds numbers above {LARGEST_COORDINATE:e}",
                place()
            );
            ensure!(row[bone].replace(values).is_none(), "{}: `{first}` is there twice in a frame", place());
        }
    }
    ensure!(!rows.is_empty(), "{name} holds no frames, expected at least one");
    let (joints, ends) = joints(skeleton);
    let mut frames = Vec::with_capacity(rows.len());
    for (number, row) in rows {
        let placed = placements(skeleton, &row, in_degrees).with_context(|| format!("{name}, frame {number}"))?;
        let ends = ends.iter().map(|end| Placement { rotation: DQuat::IDENTITY, origin: *end });
        frames.push(placed.into_iter().chain(ends).collect());
    }
    let times = (0..frames.len()).map(|frame| frame as f64 / rate).collect();
    let motion = SkeletalMotion { joints, unit: Some(skeleton.unit), up: Some(UpAxis::Y), times, frames, wraps: false };
    motion.check().with_context(|| name.to_string())?;
    Ok(motion)
}

/// The joints at the bones' origins and the free ends behind them, with the ends' offsets.
fn joints(skeleton: &AsfSkeleton) -> (Vec<SkeletalJoint>, Vec<DVec3>) {
    let bones = &skeleton.bones;
    let mut joints: Vec<SkeletalJoint> = bones
        .iter()
        .map(|bone| SkeletalJoint {
            name: bone.name.clone(),
            parent: bone.parent,
            offset: bone.parent.map_or(skeleton.root_position, |parent| bones[parent].extent),
            is_end: false,
        })
        .collect();
    let mut ends = Vec::new();
    for (index, bone) in bones.iter().enumerate() {
        if bones.iter().all(|other| other.parent != Some(index)) && bone.parent.is_some() {
            let mut name = format!("{}_end", bone.name);
            while bones.iter().any(|other| other.name == name) {
                name.push('_');
            }
            joints.push(SkeletalJoint { name, parent: Some(index), offset: bone.extent, is_end: true });
            ends.push(bone.extent);
        }
    }
    (joints, ends)
}

/// Every bone against its parent: with C its axes and M the product of its angles, the first named turned first, it is
/// turned by C M C^-1.
fn placements(skeleton: &AsfSkeleton, row: &[Option<Vec<f64>>], in_degrees: bool) -> Result<Vec<Placement>> {
    // A growing bone shifts what hangs at its end.
    let mut growth = vec![0.0; row.len()];
    let mut placed = Vec::with_capacity(row.len());
    for (index, bone) in skeleton.bones.iter().enumerate() {
        let values = match &row[index] {
            Some(values) => values.as_slice(),
            None if bone.channels.is_empty() => &[],
            None => bail!("bone `{}` is missing, expected every bone that moves in every frame", shortened(&bone.name)),
        };
        let (mut shift, mut turn) = (DVec3::ZERO, DMat3::IDENTITY);
        for (channel, &value) in bone.channels.iter().zip(values) {
            let angle = if in_degrees { value.to_radians() } else { value };
            match channel {
                AmcChannel::Shift(axis) => shift[*axis] = value,
                AmcChannel::Turn(0) => turn = DMat3::from_rotation_x(angle) * turn,
                AmcChannel::Turn(1) => turn = DMat3::from_rotation_y(angle) * turn,
                AmcChannel::Turn(_) => turn = DMat3::from_rotation_z(angle) * turn,
                AmcChannel::Length => growth[index] = value,
            }
        }
        let rotation = (bone.axes * DQuat::from_mat3(&turn) * bone.axes.inverse()).normalize();
        let origin = match bone.parent {
            None => skeleton.root_position + shift,
            Some(parent) => {
                let extent = skeleton.bones[parent].extent;
                extent + extent.normalize_or_zero() * growth[parent] + bone.axes * shift
            }
        };
        placed.push(Placement { rotation, origin });
    }
    Ok(placed)
}

#[cfg(test)]
mod tests {
    use super::super::asf::{parse_asf, tests::LEG};
    use super::*;
    use crate::motion::test_points::real_data;

    const KICK: &str = "#!OML:ASF\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 1 2 3 0 90 0\nfemur 0 0 0\ntibia 90\n2\nroot 1 2 3 0 0 0\n\
        femur 0 0 0\ntibia 0\n";

    #[test]
    fn a_kick_is_where_it_should_be() {
        let skeleton = parse_asf(LEG, "leg.asf").unwrap();
        let motion = parse_amc(KICK, "kick.amc", &skeleton, 120.0).unwrap();
        assert_eq!(
            motion.joints.iter().map(|j| j.name.as_str()).collect::<Vec<_>>(),
            ["root", "femur", "tibia", "tibia_end"]
        );
        assert_eq!((motion.times[1], motion.up), (1.0 / 120.0, Some(UpAxis::Y)));
        let places: Vec<DVec3> = motion.global(&motion.frames[0]).iter().map(|placed| placed.origin).collect();
        // The root turns x to -z; the knee turns a quarter about an axis 20 degrees from the skeleton's x.
        let axis = DQuat::from_rotation_y(90f64.to_radians()) * DQuat::from_rotation_z(20f64.to_radians()) * DVec3::X;
        let shin = DQuat::from_axis_angle(axis, 90f64.to_radians()) * DVec3::new(0.0, -7.0, 0.0);
        let expected = [
            DVec3::new(1.0, 3.0, 3.0),
            DVec3::new(1.0, 3.0, 3.0),
            DVec3::new(1.0, -5.0, 3.0),
            DVec3::new(1.0, -5.0, 3.0) + shin,
        ];
        for (found, expected) in places.iter().zip(expected) {
            assert!(found.distance(expected) < 1e-9, "{found} {expected}");
        }
        let radians = KICK.replace(":DEGREES", ":RADIANS").replace("90", "1.5707963267948966");
        let same = parse_amc(&radians, "kick.amc", &skeleton, 120.0).unwrap();
        assert!(same.frames[0][2].rotation.angle_between(motion.frames[0][2].rotation) < 1e-7);
    }

    #[test]
    fn each_fault_is_one_sentence() {
        let skeleton = parse_asf(LEG, "leg.asf").unwrap();
        let cases = [
            (String::new(), "holds no frames"),
            ("femur 1 2 3".into(), "line 1: found `femur`, expected the number of the first frame"),
            (KICK.replace("femur 0 0 0", "thigh 0 0 0"), "line 6: bone `thigh` is not in the skeleton"),
            (KICK.replace("tibia 90", "tibia 90 1"), "line 7: `tibia` has 2 values, expected 1"),
            (KICK.replace("tibia 90", "tibia inf"), "line 7: found `inf`, expected a finite number"),
            (KICK.replace("tibia 90", "tibia 1e300"), "numbers above"),
            (KICK.replace("tibia 90\n", ""), "frame 1: bone `tibia` is missing"),
            (KICK.replace("tibia 90", "femur 0 0 0"), "`femur` is there twice"),
            (KICK.replace("\n2\n", "\n7\n"), "frame 7 follows frame 1, expected frame 2"),
        ];
        for (text, expected) in cases {
            let error = format!("{:#}", parse_amc(&text, "kick.amc", &skeleton, 120.0).unwrap_err());
            assert!(error.starts_with("kick.amc") && error.contains(expected) && !error.contains('\n'), "{error}");
        }
        assert!(parse_amc(KICK, "kick.amc", &skeleton, 0.0).unwrap_err().to_string().contains("frame rate is 0"));
    }

    #[test]
    fn the_walk_of_cmu_is_the_same_in_both_formats() {
        let Some(folder) = real_data("the_walk_of_cmu_is_the_same_in_both_formats", "motion") else { return };
        let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
        let skeleton = parse_asf(&read("cmu_asfamc/02.asf"), "02.asf").unwrap();
        let motion = parse_amc(&read("cmu_asfamc/02_01.amc"), "02_01.amc", &skeleton, 120.0).unwrap();
        let bvh = crate::motion::parse_bvh(&read("cmu_bvh/02_01.bvh"), "02_01.bvh").unwrap().to_skeletal().unwrap();
        // The BVH begins with a T-pose.
        assert_eq!(motion.frames.len() + 1, bvh.frames.len());
        let knee_angle = |motion: &SkeletalMotion, frame: usize, names: [&str; 3]| {
            let placed = motion.global(&motion.frames[frame]);
            let at = |name: &str| placed[motion.joints.iter().position(|j| j.name == name).unwrap()].origin;
            let [hip, knee, ankle] = names.map(at);
            (hip - knee).angle_between(ankle - knee).to_degrees()
        };
        for frame in (20..340).step_by(20) {
            let asf = knee_angle(&motion, frame, ["lfemur", "ltibia", "lfoot"]);
            let other = knee_angle(&bvh, frame + 1, ["lThigh", "lShin", "lFoot"]);
            // The BVH was made for a skeleton with slightly bent legs.
            assert!((asf - other).abs() < 15.0, "frame {frame}: {asf} {other}");
        }
    }
}
