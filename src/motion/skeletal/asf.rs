//! ASF: the skeleton that an AMC file moves. Bones hang at the ends of their parents; each has axes of its own, in which
//! its angles are measured.

use std::collections::HashMap;

use anyhow::{Context, Result, anyhow, bail, ensure};
use glam::{DMat3, DQuat, DVec3};

use super::super::number::finite;
use super::super::points::LARGEST_COORDINATE;
use crate::files::shortened;

/// Millimetres of an inch: ASF lengths are inches over the file's `length` factor.
const INCH: f64 = 25.4;

/// What one number of an AMC line moves; an angle's index is 0 for x, 1 for y, 2 for z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AmcChannel {
    Shift(usize),
    Turn(usize),
    /// A bone that grows: `l`.
    Length,
}

/// A bone of an ASF skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct AsfBone {
    /// Its name; `root` for the first.
    pub name: String,
    /// Index of its parent, smaller than its own; `None` for the root.
    pub parent: Option<usize>,
    /// From its origin to its end at rest, in the file's axes and unit.
    pub extent: DVec3,
    /// The axes in which its angles are measured, as a rotation from the file's.
    pub axes: DQuat,
    pub(super) channels: Vec<AmcChannel>,
}

/// The skeleton of an ASF file.
#[derive(Clone, Debug, PartialEq)]
pub struct AsfSkeleton {
    /// The root first, parents before their children.
    pub bones: Vec<AsfBone>,
    /// Length of the file's unit, mm.
    pub unit: f64,
    /// Where the root stands before an AMC file shifts it.
    pub root_position: DVec3,
    /// Whether angles are degrees, for AMC files that do not say.
    pub in_degrees: bool,
}

/// The lines of a section, numbered from 1, without comments and blank ones.
type Lines<'a> = Vec<(usize, Vec<&'a str>)>;

/// Reads the text of an ASF file; `name` stands for the file in messages.
///
/// # Errors
/// One sentence with the file, the line, what was found and what was expected: a bone without a name, a direction that is
/// none, a hierarchy that is a cycle or leaves a bone out.
pub fn parse_asf(text: &str, name: &str) -> Result<AsfSkeleton> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut sections: HashMap<String, Lines> = HashMap::new();
    let mut current: Option<String> = None;
    for (index, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        if let Some(header) = line.strip_prefix(':') {
            let word = header.split_whitespace().next().unwrap_or_default().to_ascii_lowercase();
            let known = sections.insert(word.clone(), Vec::new());
            ensure!(known.is_none(), "{name}, line {}: the section `:{word}` is there twice, expected once", index + 1);
            current = Some(word);
        } else if let Some(lines) = current.as_ref().and_then(|word| sections.get_mut(word)) {
            lines.push((index + 1, line.split_whitespace().collect()));
        } else {
            bail!("{name}, line {}: found `{}`, expected a section such as `:bonedata`", index + 1, shortened(line));
        }
    }
    let section = |word: &str| {
        sections.get(word).ok_or_else(|| anyhow!("{name} has no section `:{word}`, expected an ASF skeleton"))
    };
    let (unit, in_degrees) =
        units(sections.get("units").map_or(&[][..], Vec::as_slice)).with_context(|| name.to_string())?;
    let (root, root_position) = root(section("root")?, in_degrees).with_context(|| name.to_string())?;
    let found = bones(section("bonedata")?, in_degrees).with_context(|| name.to_string())?;
    let bones = ordered(root, found, section("hierarchy")?).with_context(|| name.to_string())?;
    Ok(AsfSkeleton { bones, unit, root_position, in_degrees })
}

fn number(line: usize, words: &[&str], index: usize) -> Result<f64> {
    let key = words.first().copied().unwrap_or_default();
    let word = words.get(index).ok_or_else(|| anyhow!("line {line}: `{}` has no value", shortened(key)))?;
    let value = finite(word).with_context(|| format!("line {line}: {}", shortened(key)))?;
    ensure!(
        value.abs() <= LARGEST_COORDINATE,
        "line {line}: {} is {value}, expected numbers below {LARGEST_COORDINATE:e}",
        shortened(key)
    );
    Ok(value)
}

fn vector(line: usize, words: &[&str]) -> Result<DVec3> {
    Ok(DVec3::new(number(line, words, 1)?, number(line, words, 2)?, number(line, words, 3)?))
}

/// The length of the unit in mm and whether angles are degrees.
fn units(lines: &[(usize, Vec<&str>)]) -> Result<(f64, bool)> {
    let (mut length, mut in_degrees) = (1.0, true);
    for (line, words) in lines {
        match words[0].to_ascii_lowercase().as_str() {
            "length" => {
                length = number(*line, words, 1)?;
                ensure!(
                    (1e-6..=1e6).contains(&length),
                    "line {line}: the unit of length is {length}, expected a positive factor such as 0.45"
                );
            }
            "angle" => {
                in_degrees = match words.get(1).map(|word| word.to_ascii_lowercase()).as_deref() {
                    Some("deg" | "degrees") => true,
                    Some("rad" | "radians") => false,
                    other => {
                        bail!(
                            "line {line}: the unit of angles is `{}`, expected deg or rad",
                            shortened(other.unwrap_or(""))
                        )
                    }
                }
            }
            _ => {}
        }
    }
    Ok((INCH / length, in_degrees))
}

/// The rotation of angles about the axes that `order` names, the first named turned first: XYZ is R_z R_y R_x.
fn rotation(angles: DVec3, order: &str, in_degrees: bool) -> Result<DQuat> {
    let mut letters: Vec<char> = order.to_ascii_uppercase().chars().collect();
    let named = letters.clone();
    letters.sort_unstable();
    ensure!(letters == ['X', 'Y', 'Z'], "found the order `{}`, expected X, Y and Z once each", shortened(order));
    let mut turn = DMat3::IDENTITY;
    for (letter, angle) in named.iter().zip(angles.to_array()) {
        let angle = if in_degrees { angle.to_radians() } else { angle };
        turn = match letter {
            'X' => DMat3::from_rotation_x(angle),
            'Y' => DMat3::from_rotation_y(angle),
            _ => DMat3::from_rotation_z(angle),
        } * turn;
    }
    Ok(DQuat::from_mat3(&turn).normalize())
}

fn channel(line: usize, word: &str) -> Result<AmcChannel> {
    Ok(match word.to_ascii_lowercase().as_str() {
        "tx" => AmcChannel::Shift(0),
        "ty" => AmcChannel::Shift(1),
        "tz" => AmcChannel::Shift(2),
        "rx" => AmcChannel::Turn(0),
        "ry" => AmcChannel::Turn(1),
        "rz" => AmcChannel::Turn(2),
        "l" => AmcChannel::Length,
        other => bail!("line {line}: found `{}`, expected tx, ty, tz, rx, ry, rz or l", shortened(other)),
    })
}

fn channels(line: usize, words: &[&str]) -> Result<Vec<AmcChannel>> {
    let mut found = Vec::new();
    for word in &words[1..] {
        let channel = channel(line, word)?;
        ensure!(!found.contains(&channel), "line {line}: `{}` is there twice, expected once", shortened(word));
        found.push(channel);
    }
    Ok(found)
}

fn root(lines: &[(usize, Vec<&str>)], in_degrees: bool) -> Result<(AsfBone, DVec3)> {
    let (mut order, mut position, mut angles, mut axis) = (None, DVec3::ZERO, DVec3::ZERO, ("XYZ", 0));
    for (line, words) in lines {
        match words[0].to_ascii_lowercase().as_str() {
            "order" => order = Some(channels(*line, words)?),
            "axis" => axis = (words.get(1).copied().unwrap_or_default(), *line),
            "position" => position = vector(*line, words)?,
            "orientation" => angles = vector(*line, words)?,
            other => bail!(
                "line {line}: found `{}` in :root, expected order, axis, position or orientation",
                shortened(other)
            ),
        }
    }
    let channels = order.ok_or_else(|| anyhow!(":root has no `order`, expected one such as TX TY TZ RX RY RZ"))?;
    let axes = rotation(angles, axis.0, in_degrees).with_context(|| format!("line {}: axis", axis.1))?;
    Ok((AsfBone { name: "root".into(), parent: None, extent: DVec3::ZERO, axes, channels }, position))
}

/// A bone between its `begin` and its `end`.
struct OpenBone {
    begin: usize,
    name: Option<String>,
    direction: DVec3,
    length: f64,
    axes: DQuat,
    channels: Vec<AmcChannel>,
}

impl OpenBone {
    fn new(begin: usize) -> Self {
        Self { begin, name: None, direction: DVec3::Y, length: 0.0, axes: DQuat::IDENTITY, channels: Vec::new() }
    }
}

fn bones(lines: &[(usize, Vec<&str>)], in_degrees: bool) -> Result<Vec<AsfBone>> {
    let mut bones: Vec<AsfBone> = Vec::new();
    let mut open: Option<OpenBone> = None;
    for (line, words) in lines {
        let key = words[0].to_ascii_lowercase();
        let Some(bone) = open.as_mut() else {
            ensure!(key == "begin", "line {line}: found `{}`, expected `begin` of a bone", shortened(&key));
            open = Some(OpenBone::new(*line));
            continue;
        };
        match key.as_str() {
            "name" => {
                let found = words.get(1).ok_or_else(|| anyhow!("line {line}: found a bone without a name"))?;
                ensure!(
                    *found != "root" && bones.iter().all(|other| other.name != *found),
                    "line {line}: two bones are named `{}`, expected every name once",
                    shortened(found)
                );
                bone.name = Some((*found).to_string());
            }
            "direction" => bone.direction = vector(*line, words)?,
            "length" => bone.length = number(*line, words, 1)?,
            "axis" => {
                let order = words.get(4).copied().unwrap_or("XYZ");
                bone.axes =
                    rotation(vector(*line, words)?, order, in_degrees).with_context(|| format!("line {line}: axis"))?;
            }
            "dof" => bone.channels = channels(*line, words)?,
            "end" => {
                let Some(OpenBone { begin, name, direction, length, axes, channels }) = open.take() else { continue };
                let Some(found) = name else { bail!("line {begin}: found a bone without a name") };
                let long = direction.length();
                ensure!(
                    length == 0.0 || long > 1e-9,
                    "line {begin}: the direction of bone `{}` is {direction}, expected one that is not 0",
                    shortened(&found)
                );
                let extent = if length == 0.0 { DVec3::ZERO } else { direction / long * length };
                bones.push(AsfBone { name: found, parent: None, extent, axes, channels });
            }
            // id, bodymass, cofmass, limits and their continuation lines say nothing about the motion.
            _ => {}
        }
    }
    if let Some(OpenBone { begin, .. }) = open {
        bail!("line {begin}: the file ends inside a bone, expected `end`");
    }
    ensure!(!bones.is_empty(), ":bonedata holds no bones, expected at least one");
    Ok(bones)
}

/// The bones in an order in which parents come first, from `parent child child ...` lines.
fn ordered(root: AsfBone, mut found: Vec<AsfBone>, lines: &[(usize, Vec<&str>)]) -> Result<Vec<AsfBone>> {
    let mut parents: HashMap<&str, (&str, usize)> = HashMap::new();
    let exists = |bone: &str| bone == "root" || found.iter().any(|other| other.name == bone);
    for (line, words) in lines.iter().filter(|(_, words)| !["begin", "end"].contains(&words[0])) {
        for word in words {
            ensure!(exists(word), "line {line}: the hierarchy names `{}`, which is no bone", shortened(word));
        }
        for child in &words[1..] {
            ensure!(*child != "root", "line {line}: the root hangs on `{}`, expected it on nothing", words[0]);
            if let Some((other, _)) = parents.insert(child, (words[0], *line)) {
                bail!("line {line}: bone `{child}` hangs on `{}` and on `{other}`, expected one parent", words[0]);
            }
        }
    }
    let mut bones = vec![root];
    let mut next = 0;
    while next < bones.len() {
        let parent = bones[next].name.clone();
        let mut rest = Vec::new();
        for mut bone in found {
            if parents.get(bone.name.as_str()).is_some_and(|(above, _)| *above == parent) {
                bone.parent = Some(next);
                bones.push(bone);
            } else {
                rest.push(bone);
            }
        }
        found = rest;
        next += 1;
    }
    let Some(lost) = found.first() else { return Ok(bones) };
    // What is left hangs on nothing, or on a cycle.
    let mut path = vec![lost.name.as_str()];
    while let Some((above, line)) = path.last().and_then(|last| parents.get(last)) {
        if let Some(start) = path.iter().position(|bone| bone == above) {
            let cycle = path[start..].iter().chain([above]).copied().collect::<Vec<_>>().join(" -> ");
            bail!("line {line}: bones {cycle} form a cycle, expected a tree from the root");
        }
        path.push(above);
    }
    bail!("bone `{}` is not in the hierarchy, expected it under the root", path.last().copied().unwrap_or_default())
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(crate) const LEG: &str = ":version 1.10\n:name leg\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n:documentation\n  a leg\n\
        :root\n  order TX TY TZ RX RY RZ\n  axis XYZ\n  position 0 1 0\n  orientation 0 0 0\n:bonedata\n  begin\n    id 1\n    name femur\n\
        \tdirection 0 -2 0\n    length 8\n    axis 0 0 20 XYZ\n    dof rx ry rz\n    limits (-160.0 20.0)\n           (-70.0 70.0)\n\
        \x20          (-60.0 70.0)\n  end\n  begin\n    id 2\n    name tibia # shin\n    direction 0 -1 0\n    length 7\n    axis 0 0 20 XYZ\n    dof rx\n\
        \x20 end\n:hierarchy\n  begin\n    root femur\n    femur tibia\n  end\n";

    #[test]
    fn a_skeleton_with_its_units_and_axes() {
        let skeleton = parse_asf(LEG, "leg.asf").unwrap();
        assert!((skeleton.unit - 25.4 / 0.45).abs() < 1e-12);
        assert_eq!(skeleton.root_position, DVec3::Y);
        let names: Vec<_> = skeleton.bones.iter().map(|bone| (bone.name.as_str(), bone.parent)).collect();
        assert_eq!(names, [("root", None), ("femur", Some(0)), ("tibia", Some(1))]);
        assert_eq!(skeleton.bones[1].extent, DVec3::new(0.0, -8.0, 0.0));
        assert!(
            (skeleton.bones[1].axes * DVec3::X).distance(DQuat::from_rotation_z(20f64.to_radians()) * DVec3::X) < 1e-12
        );
        // XYZ turns about x first.
        let turned = rotation(DVec3::new(90.0, 90.0, 0.0), "XYZ", true).unwrap() * DVec3::Y;
        assert!(turned.distance(DVec3::X) < 1e-12, "{turned}");
    }

    #[test]
    fn each_fault_is_one_sentence() {
        let cases = [
            (String::new(), "has no section `:root`"),
            ("hello".into(), "line 1: found `hello`, expected a section"),
            (LEG.replace("length 0.45", "length 0"), "line 5: the unit of length is 0"),
            (LEG.replace("angle deg", "angle grad"), "line 6: the unit of angles is `grad`"),
            (LEG.replace("TX TY", "TX TX"), "line 10: `TX` is there twice"),
            (LEG.replace("axis XYZ", "axis XXZ"), "found the order `XXZ`"),
            (LEG.replace("name femur", "name"), "found a bone without a name"),
            (LEG.replace("name tibia", "name femur"), "two bones are named `femur`"),
            (LEG.replace("0 -2 0", "0 0 0"), "the direction of bone `femur`"),
            (LEG.replace("0 -2 0", "0 nan 0"), "found `nan`, expected a finite number"),
            (LEG.replace("0 -2 0", "0 -2"), "`direction` has no value"),
            (LEG.replace("femur tibia", "femur shin"), "the hierarchy names `shin`, which is no bone"),
            (LEG.replace("femur tibia", "tibia femur"), "bone `femur` hangs on `tibia` and on `root`"),
            (LEG.replace("root femur", "tibia femur"), "bones femur -> tibia -> femur form a cycle"),
            (LEG.replace("    femur tibia\n", ""), "bone `tibia` is not in the hierarchy"),
            (LEG[..LEG.find("  end\n:hier").unwrap()].to_string() + ":hierarchy\n", "the file ends inside a bone"),
            (LEG.replace("dof rx\n", "dof qx\n"), "found `qx`, expected tx"),
        ];
        for (text, expected) in cases {
            let error = format!("{:#}", parse_asf(&text, "leg.asf").unwrap_err());
            assert!(error.starts_with("leg.asf") && error.contains(expected) && !error.contains('\n'), "{error}");
        }
    }
}
