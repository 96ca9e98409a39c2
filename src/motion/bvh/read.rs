//! The reader. The hierarchy is read word by word, the motion line by line.

use anyhow::{Context, Result, bail, ensure};
use glam::DVec3;

use super::super::number::{finite, whole};
use super::super::points::{LARGEST_COORDINATE, PointFile};
use super::super::whole_file::text;
use super::{BvhChannel, BvhJoint, BvhMotion, BvhStatement};
use crate::files::shortened;

/// Files of points.
pub(crate) const POINTS: PointFile = PointFile {
    read: |bytes, name| parse_bvh(text(bytes, name)?, name)?.to_points().with_context(|| name.to_string()),
    write: Err("BVH holds joint angles of a skeleton, which points alone do not give"),
    write_metres: None,
};

/// Reads the text of a BVH file; `name` stands for the file in messages. Lengths are in the file's unit. Words may
/// stand on any lines, in any case; a leaf without an `End Site` and several roots are read as well.
///
/// # Errors
/// One sentence with the file, the line, what was found and what was expected.
pub fn parse_bvh(text: &str, name: &str) -> Result<BvhMotion> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut words = Words { text, at: 0, line: 1 };
    let joints = hierarchy(&mut words).with_context(|| format!("{name}, line {}", words.line))?;
    let channels: usize = joints.iter().map(|joint| joint.channels.len()).sum();

    let first_line = words.line;
    let rest = text.get(words.at..).unwrap_or_default();
    let mut lines = rest.lines().enumerate().map(|(index, line)| (first_line + index, line.trim()));
    let mut lines = lines.by_ref().filter(|(_, line)| !line.is_empty());

    let (line, value) = labelled(&mut lines, "Frames").with_context(|| name.to_string())?;
    let claimed = whole(value).context("Frames").with_context(|| format!("{name}, line {line}"))?;
    let (line, value) = labelled(&mut lines, "Frame Time").with_context(|| name.to_string())?;
    let frame_time = finite(value).context("Frame Time").with_context(|| format!("{name}, line {line}"))?;
    // Outside of this range 1 / frame_time is no rate of any recording, and the smallest would overflow.
    ensure!(
        (1e-7..=1e7).contains(&frame_time),
        "{name}, line {line}: the frame time is {frame_time} s, expected a positive number of seconds"
    );

    let mut frames = Vec::new();
    for (line, row) in lines {
        frames.push(values(row, channels).with_context(|| format!("{name}, line {line}"))?);
    }
    ensure!(
        frames.len() == claimed,
        "{name} holds {} frames, expected {claimed} as its line `Frames:` says",
        frames.len()
    );
    let motion = BvhMotion { joints, frame_time, frames, statement: BvhStatement::find(text) };
    motion.check().with_context(|| name.to_string())?;
    Ok(motion)
}

/// The words of a text with the line of the last one.
struct Words<'a> {
    text: &'a str,
    at: usize,
    line: usize,
}

impl<'a> Words<'a> {
    /// The next word; a brace is a word of its own even without blanks around it.
    fn next(&mut self) -> Option<&'a str> {
        self.skip_blanks();
        let rest = &self.text[self.at..];
        let first = rest.chars().next()?;
        let length = match first {
            '{' | '}' => 1,
            _ => rest.find(|c: char| c.is_whitespace() || c == '{' || c == '}').unwrap_or(rest.len()),
        };
        self.at += length;
        Some(&rest[..length])
    }

    /// The rest of the line up to a brace: names may hold blanks.
    fn rest_of_line(&mut self) -> &'a str {
        let rest = &self.text[self.at..];
        let length = rest.find(['\n', '\r', '{', '}']).unwrap_or(rest.len());
        self.at += length;
        rest[..length].trim()
    }

    fn skip_blanks(&mut self) {
        let rest = &self.text[self.at..];
        let blanks = rest.len() - rest.trim_start().len();
        self.line += rest[..blanks].matches('\n').count();
        self.at += blanks;
    }

    fn expect(&mut self, expected: &str) -> Result<()> {
        match self.next() {
            Some(found) if found.eq_ignore_ascii_case(expected) => Ok(()),
            Some(found) => bail!("found `{}`, expected `{expected}`", shortened(found)),
            None => bail!("the file ends, expected `{expected}`"),
        }
    }

    fn number(&mut self, what: &str) -> Result<f64> {
        let Some(word) = self.next() else { bail!("the file ends, expected a number for {what}") };
        finite(word).with_context(|| what.to_string())
    }

    fn offset(&mut self) -> Result<DVec3> {
        self.expect("OFFSET")?;
        let offset = DVec3::new(self.number("OFFSET")?, self.number("OFFSET")?, self.number("OFFSET")?);
        ensure!(
            offset.abs().max_element() <= LARGEST_COORDINATE,
            "OFFSET is {offset:?}, expected numbers below {LARGEST_COORDINATE:e}"
        );
        Ok(offset)
    }
}

/// Everything from `HIERARCHY` to `MOTION`. The open braces are kept in a list, not on the call stack, which a file of
/// nothing but `JOINT a {` would overflow.
fn hierarchy(words: &mut Words<'_>) -> Result<Vec<BvhJoint>> {
    words.expect("HIERARCHY")?;
    let mut joints: Vec<BvhJoint> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    loop {
        let Some(word) = words.next() else {
            match open.last() {
                Some(&joint) => bail!("the file ends inside joint `{}`, expected `}}`", shortened(&joints[joint].name)),
                None => bail!("the file ends after the hierarchy, expected `MOTION`"),
            }
        };
        match (word.to_ascii_uppercase().as_str(), open.last().copied()) {
            ("ROOT", None) | ("JOINT", Some(_)) => {
                let name = words.rest_of_line().to_string();
                ensure!(!name.is_empty(), "found a {word} without a name");
                words.expect("{")?;
                let offset = words.offset()?;
                let joint = BvhJoint {
                    name,
                    parent: open.last().copied(),
                    offset,
                    channels: Vec::new(),
                    end_sites: Vec::new(),
                };
                open.push(joints.len());
                joints.push(joint);
            }
            ("CHANNELS", Some(joint)) => {
                ensure!(joints[joint].channels.is_empty(), "found CHANNELS twice in one joint");
                joints[joint].channels = channels(words)?;
            }
            ("END", Some(joint)) => {
                words.expect("Site")?;
                words.expect("{")?;
                let end = words.offset()?;
                words.expect("}")?;
                joints[joint].end_sites.push(end);
            }
            ("}", Some(_)) => {
                open.pop();
            }
            ("MOTION", None) => {
                ensure!(!joints.is_empty(), "found MOTION, expected a ROOT before it");
                return Ok(joints);
            }
            ("MOTION", Some(joint)) => {
                bail!("found MOTION inside joint `{}`, expected `}}`", shortened(&joints[joint].name))
            }
            (_, Some(_)) => bail!("found `{}`, expected CHANNELS, JOINT, End Site or `}}`", shortened(word)),
            (_, None) => bail!("found `{}`, expected ROOT or MOTION", shortened(word)),
        }
    }
}

fn channels(words: &mut Words<'_>) -> Result<Vec<BvhChannel>> {
    let Some(count) = words.next() else { bail!("the file ends, expected the number of channels") };
    let count = whole(count).context("CHANNELS")?;
    let mut channels = Vec::new();
    for _ in 0..count {
        let Some(word) = words.next() else { bail!("the file ends, expected a channel") };
        let known = BvhChannel::ALL.iter().find(|(_, name)| name.eq_ignore_ascii_case(word));
        let Some((channel, _)) = known else {
            bail!("found `{}`, expected {count} channels such as Xposition or Zrotation", shortened(word));
        };
        channels.push(*channel);
    }
    Ok(channels)
}

/// The value behind `label:` on the next line.
fn labelled<'a>(lines: &mut impl Iterator<Item = (usize, &'a str)>, label: &str) -> Result<(usize, &'a str)> {
    let Some((line, text)) = lines.next() else { bail!("the file ends, expected `{label}:`") };
    let found = text
        .split_once(':')
        .filter(|(before, _)| before.split_whitespace().collect::<Vec<_>>().join(" ").eq_ignore_ascii_case(label));
    match found {
        Some((_, value)) => Ok((line, value.trim())),
        None => bail!("line {line}: found `{}`, expected `{label}:`", shortened(text)),
    }
}

fn values(row: &str, channels: usize) -> Result<Vec<f64>> {
    let values = row
        .split_whitespace()
        .map(|cell| {
            let value = finite(cell)?;
            ensure!(
                value.abs() <= LARGEST_COORDINATE,
                "found {value:?}, expected numbers below {LARGEST_COORDINATE:e}"
            );
            Ok(value)
        })
        .collect::<Result<Vec<f64>>>()?;
    ensure!(values.len() == channels, "found {} values, expected {channels} as there are channels", values.len());
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: &str = "HIERARCHY\nROOT hip\n{\n  OFFSET 0 0 0\n  CHANNELS 3 Xposition Yrotation Zrotation\n  JOINT left arm\n  {\n\
        \tOFFSET 1 2 3\n\tCHANNELS 1 Xrotation\n\tEnd Site\n\t{\n\t\tOFFSET 0 0 4\n\t}\n  }\n}\nMOTION\nFrames: 2\nFrame Time: 0.04\n\
        1 2 3 4\n5 6 7 8\n";

    #[test]
    fn tabs_line_ends_and_tight_braces() {
        let expected = parse_bvh(SMALL, "s.bvh").unwrap();
        assert_eq!(expected.joints[1].name, "left arm");
        assert_eq!(expected.joints[1].parent, Some(0));
        assert_eq!(expected.frames, [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0]]);
        for text in [
            SMALL.replace('\n', "\r\n"),
            SMALL.replace("hip\n{", "hip{"),
            SMALL.replace("Frames: 2", "frames:\t2").replace("Frame Time: ", "FRAME  TIME:\t"),
            format!("\u{feff}\n{}", SMALL.trim_end()),
            SMALL.replace("Xposition", "XPOSITION"),
        ] {
            assert_eq!(parse_bvh(&text, "s.bvh").unwrap(), expected, "{text}");
        }
        let without_end = SMALL.replace("\tEnd Site\n\t{\n\t\tOFFSET 0 0 4\n\t}\n", "");
        assert!(parse_bvh(&without_end, "s.bvh").unwrap().joints[1].end_sites.is_empty());
    }

    #[test]
    fn each_fault_is_one_sentence() {
        let until = |word: &str| SMALL[..SMALL.find(word).unwrap()].to_string();
        let cases = [
            (String::new(), "line 1: the file ends, expected `HIERARCHY`"),
            ("frame,time".into(), "line 1: found `frame,time`, expected `HIERARCHY`"),
            (until("JOINT"), "ends inside joint `hip`, expected `}`"),
            (until("MOTION"), "ends after the hierarchy, expected `MOTION`"),
            (until("Frames"), "the file ends, expected `Frames:`"),
            (until("Frame Time"), "the file ends, expected `Frame Time:`"),
            (until("5 6"), "holds 1 frames, expected 2"),
            (until(" 8\n"), "line 20: found 3 values, expected 4"),
            (SMALL.replace("7 8", "7 8 9"), "line 20: found 5 values, expected 4"),
            (SMALL.replace("7 8", "7 nan"), "line 20: found `nan`, expected a finite number"),
            (SMALL.replace("7 8", "7 1e12"), "line 20: found 1000000000000.0, expected numbers below 1e9"),
            (SMALL.replace("Frames: 2", "Frames: two"), "line 17: Frames: found `two`"),
            (SMALL.replace("Frames: 2", "Frames: 4000000000"), "holds 2 frames, expected 4000000000"),
            (SMALL.replace("Frames: 2", "Frames 2"), "line 17: found `Frames 2`, expected `Frames:`"),
            (SMALL.replace("0.04", "0"), "line 18: the frame time is 0 s"),
            (SMALL.replace("0.04", "inf"), "line 18: Frame Time: found `inf`"),
            (SMALL.replace("CHANNELS 1 X", "CHANNELS 4000000000 X"), "expected 4000000000 channels"),
            (SMALL.replace("CHANNELS 1 X", "CHANNELS -1 X"), "line 9: CHANNELS: found `-1`"),
            (SMALL.replace("Zrotation", "Wrotation"), "line 5: found `Wrotation`, expected 3 channels"),
            (SMALL.replace("OFFSET 1 2 3", "OFFSET 1 2"), "OFFSET: found `CHANNELS`"),
            (SMALL.replace("OFFSET 1 2 3", "OFFSET 1 2 1e10"), "line 8: OFFSET is"),
            (SMALL.replace("OFFSET 1 2 3", "CHANNELS"), "line 8: found `CHANNELS`, expected `OFFSET`"),
            (SMALL.replace("left arm", "hip"), "two joints are named `hip`"),
            (SMALL.replace("left arm", ""), "line 6: found a JOINT without a name"),
            (SMALL.replace("  }\n}\nMOTION", "  }\nMOTION"), "line 15: found MOTION inside joint `hip`"),
            (SMALL.replace("\tCHANNELS 1 Xrotation\n", "\tSPEED 3\n"), "line 9: found `SPEED`"),
            ("HIERARCHY\nMOTION\nFrames: 0\nFrame Time: 1\n".into(), "line 2: found MOTION, expected a ROOT"),
        ];
        for (text, expected) in cases {
            let message = format!("{:#}", parse_bvh(&text, "s.bvh").unwrap_err());
            assert!(message.contains(expected) && message.starts_with("s.bvh"), "{message}\nshould say: {expected}");
            assert!(!message.contains('\n'), "{message}");
        }
    }

    #[test]
    fn a_chain_too_deep_for_a_call_stack() {
        let deep: String = (0..200_000).map(|i| format!("JOINT j{i}\n{{ OFFSET 0 0 0 ")).collect();
        let text = format!("HIERARCHY ROOT r\n{{ OFFSET 0 0 0 {deep}");
        let message = format!("{:#}", parse_bvh(&text, "deep.bvh").unwrap_err());
        assert!(message.contains("ends inside joint `j199999`"), "{message}");
        let text = format!("{text}{}\nMOTION\nFrames: 1\nFrame Time: 1\n", "}".repeat(200_001));
        let message = format!("{:#}", parse_bvh(&text, "deep.bvh").unwrap_err());
        assert!(message.contains("holds 0 frames, expected 1"), "{message}");
    }
}
