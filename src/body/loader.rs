//! `body.toml` read and checked (FORMATS): what a [`Body`] promises is made sure of here, each failure in one sentence
//! with the file and the key.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use glam::DVec3;
use serde::Deserialize;

use super::mesh::{MeshEntry, build_source};
use super::{Body, Bone, Dof, DofAxis, Marker, MeshSource, Part};
use crate::files::{exactly, expected, parse_toml, read_toml, shortened};
use crate::geometry::{EulerOrder, LengthUnit};

/// Longest length inside a body, mm. Larger ones are a mistaken unit, and would not survive single precision.
const LONGEST: f64 = 1e5;
/// Largest limit or step of a translation, mm.
const FARTHEST: f64 = 1e6;
/// Largest limit or step of a rotation, degrees.
const MOST_TURNED: f64 = 36_000.0;

/// Limits and step of a degree of freedom that does not state them: a room (mm), any angle (degrees); the step of an
/// unhurried walk.
const DEFAULT_LIMIT: [f64; 2] = [20_000.0, 180.0];
const DEFAULT_STEP: [f64; 2] = [40.0, 5.0];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BodyFile {
    name: String,
    #[serde(default)]
    units: LengthUnit,
    #[serde(default)]
    bone: Vec<BoneEntry>,
    #[serde(default)]
    part: Vec<PartEntry>,
    #[serde(default)]
    marker: Vec<MarkerEntry>,
    mesh: Option<MeshEntry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BoneEntry {
    name: String,
    parent: String,
    #[serde(deserialize_with = "exactly")]
    offset: [f64; 3],
    #[serde(default)]
    order: Option<String>,
    #[serde(default)]
    dof: Vec<String>,
    #[serde(default)]
    limits: BTreeMap<String, [f64; 2]>,
    #[serde(default)]
    step: BTreeMap<String, f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PartEntry {
    name: String,
    bone: String,
    #[serde(deserialize_with = "exactly")]
    a: [f64; 3],
    #[serde(deserialize_with = "exactly")]
    b: [f64; 3],
    radius_a: f64,
    radius_b: f64,
    label: i64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MarkerEntry {
    name: String,
    bone: String,
    #[serde(deserialize_with = "exactly")]
    at: [f64; 3],
}

impl Body {
    /// Reads and checks a `body.toml`.
    ///
    /// # Errors
    /// One sentence with the file and the line or key: not a readable TOML file, unknown keys, a tree that is none (two
    /// roots, none, unknown parents, a cycle), names or labels used twice, limits reversed, numbers that are not finite
    /// or beyond reason, parts without length or radius, no parts.
    pub fn load(path: &Path) -> Result<Self> {
        let file: BodyFile = read_toml(path)?;
        let mut body = build(file).with_context(|| path.display().to_string())?;
        if let (Some(MeshSource::Skinned { file, .. }), Some(folder)) = (&mut body.mesh, path.parent()) {
            // Absolute, so that a body saved elsewhere still finds it.
            *file = std::path::absolute(folder.join(&*file))
                .with_context(|| format!("{}: mesh file {}", path.display(), file.display()))?;
        }
        Ok(body)
    }
}

/// [`Body::load`] for text already in memory; `name` stands for the file in messages. A mesh's file stays as written.
///
/// # Errors
/// As [`Body::load`].
pub fn parse_body(text: &str, name: &str) -> Result<Body> {
    build(parse_toml(text, name)?).with_context(|| name.to_string())
}

fn build(file: BodyFile) -> Result<Body> {
    let mm = file.units.mm();
    ensure!(!file.bone.is_empty(), "it has no [[bone]], expected at least the root");
    let bone_index = unique_names("bone", file.bone.iter().map(|bone| bone.name.as_str()))?;
    let bones = file
        .bone
        .iter()
        .map(|entry| build_bone(entry, &bone_index, mm).with_context(|| format!("bone `{}`", entry.name)))
        .collect::<Result<Vec<_>>>()?;
    let update_order = parents_first(&bones)?;

    ensure!(!file.part.is_empty(), "it has no [[part]], expected at least one truncated cone to draw");
    unique_names("part", file.part.iter().map(|part| part.name.as_str()))?;
    let parts = file
        .part
        .iter()
        .map(|entry| build_part(entry, &bone_index, mm).with_context(|| format!("part `{}`", entry.name)))
        .collect::<Result<Vec<_>>>()?;
    let mut part_of_label = HashMap::new();
    for part in &parts {
        if let Some(other) = part_of_label.insert(part.label, &part.name) {
            bail!("parts `{other}` and `{}` both have label {}, expected a label of its own", part.name, part.label);
        }
    }

    unique_names("marker", file.marker.iter().map(|marker| marker.name.as_str()))?;
    let markers = file
        .marker
        .iter()
        .map(|entry| {
            let build = || -> Result<Marker> {
                let bone = known_bone("bone", &entry.bone, &bone_index)?;
                Ok(Marker { name: entry.name.clone(), bone, at: point("at", entry.at, mm)? })
            };
            build().with_context(|| format!("marker `{}`", entry.name))
        })
        .collect::<Result<Vec<_>>>()?;
    let mut body = Body { name: file.name, bones, parts, markers, mesh: None, update_order };
    if let Some(entry) = file.mesh {
        let parts: Vec<&str> = body.parts.iter().map(|part| part.name.as_str()).collect();
        let joints = body.joint_names();
        let joints: Vec<&str> = joints.iter().map(String::as_str).collect();
        body.mesh = Some(build_source(entry, &parts, &joints).context("table [mesh]")?);
    }
    Ok(body)
}

fn build_bone(entry: &BoneEntry, bone_index: &HashMap<&str, usize>, mm: f64) -> Result<Bone> {
    let parent = match entry.parent.as_str() {
        "" => None,
        name => Some(known_bone("parent", name, bone_index)?),
    };
    let order = entry.order.as_deref().map_or(Ok(EulerOrder::default()), EulerOrder::from_name)?;
    let axes = entry.dof.iter().map(|name| DofAxis::from_name(name)).collect::<Result<Vec<_>>>()?;
    for (index, axis) in axes.iter().enumerate() {
        let name = axis.name();
        ensure!(!axes[..index].contains(axis), "dof lists `{name}` twice, expected each once");
        ensure!(
            index == 0 || axes[index - 1] < *axis,
            "dof lists `{name}` after `{}`, expected the order tx ty tz rx ry rz",
            axes[index.saturating_sub(1)].name()
        );
    }
    let listed: Vec<&str> = axes.iter().map(|axis| axis.name()).collect();
    for (key, names) in [("limits", entry.limits.keys().collect::<Vec<_>>()), ("step", entry.step.keys().collect())] {
        if let Some(name) = names.iter().find(|name| !listed.contains(&name.as_str())) {
            bail!("{key} names `{}`, which is not in this bone's dof ({})", shortened(name), expected(name, &listed));
        }
    }
    let dofs = axes
        .into_iter()
        .map(|axis| build_dof(axis, entry.limits.get(axis.name()), entry.step.get(axis.name()), mm))
        .collect::<Result<Vec<_>>>()?;
    Ok(Bone { name: entry.name.clone(), parent, offset: point("offset", entry.offset, mm)?, order, dofs })
}

fn build_dof(axis: DofAxis, limits: Option<&[f64; 2]>, step: Option<&f64>, mm: f64) -> Result<Dof> {
    let name = axis.name();
    let kind = usize::from(axis.is_rotation());
    let (unit, largest) = if axis.is_rotation() { (1.0, MOST_TURNED) } else { (mm, FARTHEST) };
    let within = |key: &str, value: f64| {
        ensure!(
            value.is_finite() && (value * unit).abs() <= largest,
            "{key} of `{name}` is {value:?}, expected a number up to {} {}",
            largest,
            axis.file_unit()
        );
        Ok(axis.from_file(value * unit))
    };
    let limits = match limits {
        Some(&[low, high]) => {
            let within = [within("limits", low)?, within("limits", high)?];
            ensure!(low <= high, "limits of `{name}` are [{low}, {high}], expected the smaller first");
            within
        }
        None => [-DEFAULT_LIMIT[kind], DEFAULT_LIMIT[kind]].map(|limit| axis.from_file(limit)),
    };
    let step = match step {
        Some(&step) => {
            let within = within("step", step)?;
            ensure!(step >= 0.0, "step of `{name}` is {step}, expected 0 or more");
            within
        }
        None => axis.from_file(DEFAULT_STEP[kind]),
    };
    Ok(Dof { axis, limits, step })
}

fn build_part(entry: &PartEntry, bone_index: &HashMap<&str, usize>, mm: f64) -> Result<Part> {
    let bone = known_bone("bone", &entry.bone, bone_index)?;
    let (a, b) = (point("a", entry.a, mm)?, point("b", entry.b, mm)?);
    ensure!(a != b, "a and b are the same point, expected a cone with a length");
    for (key, radius) in [("radius_a", entry.radius_a), ("radius_b", entry.radius_b)] {
        ensure!(
            radius > 0.0 && radius * mm <= LONGEST,
            "{key} is {radius}, expected more than 0 and at most {LONGEST} mm"
        );
    }
    let label = u8::try_from(entry.label).ok().filter(|label| (1..=127).contains(label));
    let label = label.ok_or_else(|| anyhow!("label is {}, expected 1 to 127", entry.label))?;
    let (radius_a, radius_b) = (entry.radius_a * mm, entry.radius_b * mm);
    Ok(Part { name: entry.name.clone(), bone, a, b, radius_a, radius_b, label })
}

/// Bytes of a name: files of markers hold no longer ones, and would be refused when a run is done.
const LONGEST_NAME: usize = 100;

/// The index of every name. Names become columns of tables and labels of trajectories, hence what they may hold.
fn unique_names<'a>(kind: &str, names: impl Iterator<Item = &'a str>) -> Result<HashMap<&'a str, usize>> {
    let mut indices = HashMap::new();
    for (index, name) in names.enumerate() {
        ensure!(!name.is_empty(), "{kind} number {} has an empty name", index + 1);
        ensure!(
            name.len() <= LONGEST_NAME,
            "{kind} name `{}` is {} bytes long, expected at most {LONGEST_NAME}",
            shortened(name),
            name.len()
        );
        if let Some(found) = name.chars().find(|c| c.is_whitespace() || c.is_control() || ".,;\"\\".contains(*c)) {
            bail!(
                "{kind} name {name:?} holds {found:?}, expected no blank, point, comma, semicolon, quote or backslash"
            );
        }
        ensure!(indices.insert(name, index).is_none(), "two {kind}s are named `{name}`, expected a name of its own");
    }
    Ok(indices)
}

fn known_bone(key: &str, name: &str, bone_index: &HashMap<&str, usize>) -> Result<usize> {
    bone_index.get(name).copied().ok_or_else(|| {
        let mut known: Vec<&str> = bone_index.keys().copied().collect();
        known.sort_unstable();
        anyhow!("{key} is `{}`, which is no bone, {}", shortened(name), expected(name, &known))
    })
}

fn point(key: &str, at: [f64; 3], mm: f64) -> Result<DVec3> {
    for value in at {
        ensure!(
            value.is_finite() && (value * mm).abs() <= LONGEST,
            "{key} holds {value:?}, expected lengths of at most {LONGEST} mm: are the units right?"
        );
    }
    Ok(DVec3::from_array(at) * mm)
}

/// The order in which every bone follows its parent, breadth first.
fn parents_first(bones: &[Bone]) -> Result<Vec<usize>> {
    let roots: Vec<usize> = (0..bones.len()).filter(|&index| bones[index].parent.is_none()).collect();
    match roots[..] {
        [] => bail!("no bone has parent = \"\", expected one root"),
        [_] => {}
        [first, second, ..] => {
            bail!("bones `{}` and `{}` are both roots, expected one", bones[first].name, bones[second].name)
        }
    }
    let mut children = vec![Vec::new(); bones.len()];
    for (index, bone) in bones.iter().enumerate() {
        if let Some(parent) = bone.parent {
            children[parent].push(index);
        }
    }
    let mut order = roots;
    let mut next = 0;
    while next < order.len() {
        order.extend_from_slice(&children[order[next]]);
        next += 1;
    }
    if order.len() == bones.len() {
        return Ok(order);
    }
    bail!("bones {} form a cycle, expected a tree", cycle(bones, &order));
}

/// A cycle among the bones that were not reached, child before parent, as a message shows it.
fn cycle(bones: &[Bone], reached: &[usize]) -> String {
    let mut seen = vec![false; bones.len()];
    for &index in reached {
        seen[index] = true;
    }
    let mut path = Vec::new();
    let mut at = seen.iter().position(|&seen| !seen);
    while let Some(index) = at {
        if let Some(start) = path.iter().position(|&earlier| earlier == index) {
            path.push(index);
            return path[start..].iter().map(|&i: &usize| bones[i].name.as_str()).collect::<Vec<_>>().join(" -> ");
        }
        path.push(index);
        at = bones[index].parent;
    }
    String::new()
}

#[cfg(test)]
#[path = "loader_tests.rs"]
mod tests;
