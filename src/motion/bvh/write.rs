//! The writer.

use std::io::Write;

use anyhow::Result;

use super::{BvhMotion, BvhStatement};

/// Writes a motion as BVH: lengths and degrees with six digits. The joints go out depth first, as the format wants it,
/// and each frame's values with them, whatever the order of `motion.joints`. What the motion says of itself is the last line.
///
/// # Errors
/// When the motion breaks [`BvhMotion::check`] or writing fails.
pub fn write_bvh(out: &mut dyn Write, motion: &BvhMotion) -> Result<()> {
    motion.check()?;
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); motion.joints.len()];
    let mut starts = Vec::with_capacity(motion.joints.len());
    let mut next_start = 0;
    for (index, joint) in motion.joints.iter().enumerate() {
        if let Some(parent) = joint.parent {
            children[parent].push(index);
        }
        starts.push(next_start);
        next_start += joint.channels.len();
    }

    writeln!(out, "HIERARCHY")?;
    let roots = motion.joints.iter().enumerate().filter(|(_, joint)| joint.parent.is_none()).map(|(index, _)| index);
    // What is still to be written, the last first: a joint to open, or the brace that closes one at this depth.
    let mut pending: Vec<Step> = roots.map(|joint| Step::Open { joint, depth: 0 }).collect();
    pending.reverse();
    let mut order = Vec::with_capacity(motion.joints.len());
    while let Some(step) = pending.pop() {
        match step {
            Step::Close { depth } => writeln!(out, "{}}}", indent(depth))?,
            Step::Open { joint, depth } => {
                order.push(joint);
                open_joint(out, motion, joint, depth)?;
                pending.push(Step::Close { depth });
                pending.extend(children[joint].iter().rev().map(|&joint| Step::Open { joint, depth: depth + 1 }));
            }
        }
    }
    writeln!(out, "MOTION\nFrames: {}\nFrame Time: {:.9}", motion.frames.len(), motion.frame_time)?;
    for row in &motion.frames {
        let values =
            order.iter().flat_map(|&joint| &row[starts[joint]..starts[joint] + motion.joints[joint].channels.len()]);
        for (column, value) in values.enumerate() {
            write!(out, "{}{value:.6}", if column == 0 { "" } else { " " })?;
        }
        writeln!(out)?;
    }
    if let Some(line) = motion.statement.and_then(BvhStatement::line) {
        writeln!(out, "{line}")?;
    }
    Ok(())
}

enum Step {
    Open { joint: usize, depth: usize },
    Close { depth: usize },
}

/// Indents for the eye, but not without end: a chain of n joints would otherwise take n squared tabs.
fn indent(depth: usize) -> String {
    "\t".repeat(depth.min(32))
}

fn open_joint(out: &mut dyn Write, motion: &BvhMotion, joint: usize, depth: usize) -> Result<()> {
    let joint = &motion.joints[joint];
    let indent = indent(depth);
    let kind = if joint.parent.is_none() { "ROOT" } else { "JOINT" };
    writeln!(out, "{indent}{kind} {}\n{indent}{{", joint.name)?;
    writeln!(out, "{indent}\tOFFSET {:.6} {:.6} {:.6}", joint.offset.x, joint.offset.y, joint.offset.z)?;
    write!(out, "{indent}\tCHANNELS {}", joint.channels.len())?;
    for channel in &joint.channels {
        write!(out, " {}", channel.word())?;
    }
    writeln!(out)?;
    for end in &joint.end_sites {
        writeln!(out, "{indent}\tEnd Site\n{indent}\t{{")?;
        writeln!(out, "{indent}\t\tOFFSET {:.6} {:.6} {:.6}\n{indent}\t}}", end.x, end.y, end.z)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::{parse_bvh, tests::arm};
    use super::*;

    #[test]
    fn joints_in_any_order_are_written_depth_first_with_their_values() {
        // hip, leg, arm, hand: a valid order (parents first) that is not depth first once leg has a child.
        let mut motion = arm();
        motion.joints.swap(2, 3);
        motion.joints[3].parent = Some(1);
        let expected = motion.to_points().unwrap();
        let mut bytes = Vec::new();
        write_bvh(&mut bytes, &motion).unwrap();
        let again = parse_bvh(std::str::from_utf8(&bytes).unwrap(), "a.bvh").unwrap();
        let names: Vec<&str> = again.joints.iter().map(|j| j.name.as_str()).collect();
        assert_eq!(names, ["hip", "arm", "hand", "leg"]);
        let points = again.to_points().unwrap();
        for (row, expected_row) in points.frames.iter().zip(&expected.frames) {
            for (name, point) in points.names.iter().zip(row) {
                let same = expected_row[expected.column(name).unwrap()].unwrap();
                assert!((point.unwrap() - same).length() < 1e-5, "{name}");
            }
        }
    }

    #[test]
    fn a_motion_that_cannot_be_is_not_written() {
        let mut motion = arm();
        motion.frames.clear();
        assert!(write_bvh(&mut Vec::new(), &motion).unwrap_err().to_string().contains("no frames"));
    }
}
