//! A body made from a skinned file: its lengths, and parts fitted to its skin.
//!
//! The tree, the degrees of freedom and their limits are a template's, since a file tells nothing of them. Limbs take the
//! lengths between the file's joints; where limbs, collar bones and head begin is where the file has them. The skin, bound to
//! that body, then shows in the rest pose how thick each part is.

use std::collections::BTreeMap;
use std::path::{Path, absolute};

use anyhow::{Context, Result, bail, ensure};
use glam::{DAffine3, DVec3};

use super::binding::{bind, followers, height_at_rest, is_of_trunk, lay_over};
use super::frusta::rest_origins;
use super::gltf_file::{self, SkinnedFile};
use super::joint_names::JointMap;
use super::{Mesh, MeshSource, Skinning};
use crate::body::{Body, Part, parse_body};
use crate::files::{expected, shortened};

/// No person is smaller or taller, mm.
const HEIGHTS: std::ops::RangeInclusive<f64> = 500.0..=2500.0;
/// Fewer vertices do not tell a part's thickness.
const FEWEST: usize = 12;
/// No part of a person is thinner, mm.
const THINNEST: f64 = 8.0;
/// Where a part ends that nothing follows: all but so many of its vertices lie within.
const BEYOND: f64 = 0.03;

impl Body {
    /// The body of a skinned person (.glb or .gltf): the template's bones with the file's lengths, its parts fitted to the
    /// file's skin, and the file as its mesh. Lengths in mm; `height` is the person's, without one the file's in metres.
    /// `joints` names joints of the file by bones and free ends, where the names themselves do not tell.
    ///
    /// # Errors
    /// When the file cannot be read or is no skinned person, its height is none of a person, or its joints do not make the
    /// template's bones; one sentence with the file.
    pub fn from_gltf(
        path: &Path,
        template: &Self,
        height: Option<f64>,
        joints: &BTreeMap<String, String>,
    ) -> Result<Self> {
        let file = gltf_file::read(path)?;
        let mut body = imported(&file, template, height, joints).with_context(|| path.display().to_string())?;
        if let Some(stem) = path.file_stem() {
            body.name = stem.to_string_lossy().into_owned();
        }
        let file = absolute(path).with_context(|| path.display().to_string())?;
        body.mesh = Some(MeshSource::Skinned { file, skinning: Skinning::default(), joints: joints.clone() });
        Ok(body)
    }
}

fn imported(
    file: &SkinnedFile,
    template: &Body,
    height: Option<f64>,
    joints: &BTreeMap<String, String>,
) -> Result<Body> {
    let known = template.joint_names();
    if let Some(name) = joints.keys().find(|name| !known.contains(name)) {
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        bail!("a joint is named for `{}`, which is no bone, {}", shortened(name), expected(name, &known));
    }
    let levels = file.vertices.iter().map(|vertex| vertex.at.y);
    let extent = levels.clone().fold(f64::NEG_INFINITY, f64::max) - levels.fold(f64::INFINITY, f64::min);
    let height = height.unwrap_or(extent * 1000.0);
    ensure!(
        HEIGHTS.contains(&height),
        "its person is {height:.0} mm tall, expected {} to {}: give the height if the file is not in metres",
        HEIGHTS.start(),
        HEIGHTS.end()
    );
    let sized = template.scaled(height / height_at_rest(template, &rest_origins(template)))?;
    let mut body = with_lengths(file.clone(), sized, joints)?;
    stand_as_tall(&mut body, height);
    let mesh = bind(file.clone(), &body, Skinning::default(), joints)?;
    fit_parts(&mut body, &mesh)?;
    stand_as_tall(&mut body, height);
    // A file may hold anything: what is made of it has to load again.
    parse_body(&body.rounded().to_toml(), "the body made from it").context("its skin is no person's")?;
    Ok(body.rounded())
}

/// The body with its joints where the file has them.
fn with_lengths(mut file: SkinnedFile, mut body: Body, joints: &BTreeMap<String, String>) -> Result<Body> {
    let mut map = JointMap::of_limbs(&body, &file.joints, joints.iter())?;
    let before = rest_origins(&body);
    lay_over(&mut file, &body, &map, &before)?;
    let places: Vec<DVec3> = file.joints.iter().map(|joint| joint.at).collect();
    map.add_trunk(&body, &file.joints, &places, &before)?;
    // The root stands midway between the roots of the legs, as in the template.
    let hips = (0..body.bones.len()).filter(|&bone| body.bones[bone].name.ends_with("hip"));
    let shifts: Vec<DVec3> = hips.filter_map(|bone| Some(places[map.of_bone[bone]?] - before[bone])).collect();
    let shift = shifts.iter().sum::<DVec3>() / shifts.len().max(1) as f64;

    let mut origins = before.clone();
    let mut in_limb = vec![false; body.bones.len()];
    for bone in body.update_order.clone() {
        let Some(parent) = body.bones[bone].parent else { continue };
        let offset = body.bones[bone].offset;
        let following = followers(&body, &map, &before, bone);
        in_limb[bone] = in_limb[parent] || (following.len() == 1 && !is_of_trunk(&body.bones[bone].name));
        let joint = map.of_bone[bone];
        let offset = match (joint, map.of_bone[parent]) {
            (Some(joint), Some(above)) if in_limb[parent] => {
                offset.normalize_or_zero() * places[joint].distance(places[above])
            }
            // Where a trunk bends is where the template says.
            (Some(joint), _) if !in_limb[parent] && !body.bones[bone].name.contains("thorax") => {
                places[joint] - shift - origins[parent]
            }
            _ => offset,
        };
        body.bones[bone].offset = offset;
        origins[bone] = origins[parent] + offset;
    }
    for (bone, _) in in_limb.iter().enumerate().filter(|(_, is_in)| **is_in) {
        let (Some(joint), [follower]) = (map.of_bone[bone], &followers(&body, &map, &before, bone)[..]) else {
            continue;
        };
        let (length, found) = (follower.offset.length(), places[follower.joint].distance(places[joint]));
        if length > 0.0 {
            stretch(&mut body, bone, follower.offset, found / length);
        }
    }
    Ok(body)
}

/// Stretches what hangs on a bone along a direction of its frame.
fn stretch(body: &mut Body, bone: usize, along: DVec3, factor: f64) {
    let direction = along.normalize_or_zero();
    let stretched = |at: DVec3| at + direction * (at.dot(direction) * (factor - 1.0));
    for part in body.parts.iter_mut().filter(|part| part.bone == bone) {
        (part.a, part.b) = (stretched(part.a), stretched(part.b));
    }
    for marker in body.markers.iter_mut().filter(|marker| marker.bone == bone) {
        marker.at = stretched(marker.at);
    }
}

/// Makes every part as thick as the skin round it and lays it along its middle, except where it ends in a free end; those that
/// nothing follows end where the skin ends.
fn fit_parts(body: &mut Body, mesh: &Mesh) -> Result<()> {
    let origins = rest_origins(body);
    let at_rest: Vec<DAffine3> = origins.iter().map(|origin| DAffine3::from_translation(*origin)).collect();
    let skin = mesh.posed(&at_rest)?;
    let ends: Vec<usize> = body.free_ends().iter().map(|end| end.bone).collect();
    for index in 0..body.parts.len() {
        let Part { bone, label, a, b, .. } = body.parts[index];
        let (axis, is_trunk) = (b - a, is_of_trunk(&body.bones[bone].name));
        let along = |at: &DVec3| (*at - a).dot(axis) / axis.length_squared();
        let (mut own, mut near) = (Vec::new(), Vec::new());
        for (vertex, at) in mesh.vertices.iter().zip(&skin) {
            let (other, at) = (usize::from(vertex.bones[0]), at.as_dvec3() - origins[bone]);
            if vertex.label == label {
                own.push(at);
            } else if is_trunk && other != bone && hugs_trunk(body, other) && (0.0..=1.0).contains(&along(&at)) {
                near.push(at);
            }
        }
        if own.len() < FEWEST {
            continue;
        }
        // Feet, hands and the head end where their skin ends; the first part of a bone with a free end, at its joint.
        let before = || body.parts[..index].iter().filter(|other| other.bone == bone);
        let is_free = a != DVec3::ZERO && before().all(|other| other.b != a);
        let is_last = if ends.contains(&bone) {
            is_trunk || before().next().is_some()
        } else {
            body.bones.iter().all(|other| other.parent != Some(bone))
        };
        let ends_in_joint = ends.contains(&bone) && !is_last;
        let mut range = 0.0..1.0;
        if is_last {
            let mut levels: Vec<f64> = own.iter().map(along).collect();
            levels.sort_by(f64::total_cmp);
            let at_share = |share: f64| levels[((levels.len() - 1) as f64 * share) as usize];
            range.end = at_share(1.0 - BEYOND).max(0.2);
            if is_free && !is_trunk {
                range.start = at_share(BEYOND).min(0.1);
            }
        }
        let skin = [own, near].concat();
        let Some([from, to]) = cone(&skin, a, axis, &range) else { continue };
        let part = &mut body.parts[index];
        part.a = a + axis * range.start + from.beside;
        part.b = if ends_in_joint { b } else { a + axis * range.end + to.beside };
        (part.radius_a, part.radius_b) = (from.radius.max(THINNEST), to.radius.max(THINNEST));
    }
    let floor = skin.iter().map(|at| f64::from(at.z)).fold(f64::INFINITY, f64::min);
    lift_onto(body, floor, &origins);
    Ok(())
}

/// Lifts ends of parts that reach below the floor at rest: feet are broader than high.
fn lift_onto(body: &mut Body, floor: f64, origins: &[DVec3]) {
    for part in &mut body.parts {
        let upright = (part.b - part.a).normalize_or_zero().z;
        let reach = (1.0 - upright * upright).max(0.0).sqrt();
        for (end, radius) in [(&mut part.a, part.radius_a), (&mut part.b, part.radius_b)] {
            end.z += (floor - (origins[part.bone].z + end.z - radius * reach)).max(0.0);
        }
    }
}

/// Whether a bone's skin lies round the trunk: the trunk's own, collar bones, and hips; arms only hang beside it.
fn hugs_trunk(body: &Body, bone: usize) -> bool {
    let name = &body.bones[bone].name;
    is_of_trunk(name) || name.ends_with("hip")
}

/// Moves the highest end of a part so that the parts stand as tall as the person: the skin is scaled by that height.
fn stand_as_tall(body: &mut Body, height: f64) {
    let origins = rest_origins(body);
    let lacking = height - height_at_rest(body, &origins);
    let ends = body.parts.iter_mut().flat_map(|part| {
        let base = origins[part.bone].z;
        [&mut part.a, &mut part.b].map(|end| (base + end.z, end))
    });
    if let Some((_, end)) = ends.max_by(|l, r| l.0.total_cmp(&r.0)) {
        end.z += lacking;
    }
}

/// An end of a fitted cone.
struct ConeEnd {
    /// Where its centre lies, seen from the axis.
    beside: DVec3,
    radius: f64,
}

/// The cone that looks as broad as a skin does from all sides of an axis, by its slices over a range of the axis: medians of
/// lines through them, so that a slice which ends in a shoulder or a thumb does not count.
fn cone(skin: &[DVec3], a: DVec3, axis: DVec3, range: &std::ops::Range<f64>) -> Option<[ConeEnd; 2]> {
    const SLICES: usize = 8;
    const SIDES: usize = 12;
    let across = axis.normalize().any_orthonormal_pair();
    let sides: [DVec3; SIDES] = std::array::from_fn(|side| {
        let (sin, cos) = (side as f64 * std::f64::consts::PI / SIDES as f64).sin_cos();
        across.0 * cos + across.1 * sin
    });
    // The lowest and the highest place of each slice along each side's direction.
    let mut extents = [[[f64::INFINITY, f64::NEG_INFINITY]; SIDES]; SLICES];
    for at in skin {
        let along = (*at - a).dot(axis) / axis.length_squared();
        let slice = (along - range.start) / (range.end - range.start) * SLICES as f64;
        if !(0.0..SLICES as f64).contains(&slice) {
            continue;
        }
        for (extent, side) in extents[slice as usize].iter_mut().zip(&sides) {
            let place = (*at - a).dot(*side);
            *extent = [extent[0].min(place), extent[1].max(place)];
        }
    }
    let seen = extents.iter().enumerate().filter(|(_, extent)| extent.iter().all(|[low, high]| low < high));
    // Of each slice: its place along the cone, its centre beside the axis in both directions across, its radius.
    let slices: Vec<(f64, [f64; 3])> = seen
        .map(|(index, extent)| {
            let (mut centre, mut radius) = (DVec3::ZERO, 0.0);
            for ([low, high], side) in extent.iter().zip(&sides) {
                centre += *side * (low + high) / SIDES as f64;
                radius += 0.5 * (high - low) / SIDES as f64;
            }
            ((index as f64 + 0.5) / SLICES as f64, [centre.dot(across.0), centre.dot(across.1), radius])
        })
        .collect();
    if slices.is_empty() {
        return None;
    }
    let lines: [[f64; 2]; 3] = std::array::from_fn(|value| {
        let points: Vec<(f64, f64)> = slices.iter().map(|(at, values)| (*at, values[value])).collect();
        median_line(&points)
    });
    Some(
        [0, 1]
            .map(|end| ConeEnd { beside: across.0 * lines[0][end] + across.1 * lines[1][end], radius: lines[2][end] }),
    )
}

/// The line of the median slope and the median height through points, by its values at 0 and 1 (Theil and Sen).
fn median_line(points: &[(f64, f64)]) -> [f64; 2] {
    let median = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        let middle = values.len() / 2;
        match values.len() {
            0 => 0.0,
            count if count % 2 == 1 => values[middle],
            _ => 0.5 * (values[middle - 1] + values[middle]),
        }
    };
    let pairs = points.iter().enumerate().flat_map(|(index, p)| points[..index].iter().map(move |q| (p, q)));
    let slope = median(pairs.map(|(p, q)| (p.1 - q.1) / (p.0 - q.0)).collect());
    let start = median(points.iter().map(|(x, y)| y - slope * x).collect());
    [start, start + slope]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_is_found_whatever_its_vertices() {
        // A cone of 60 to 40 mm over 300 mm beside the axis, sampled densely at its thick end, with a thumb at the other.
        let axis = DVec3::new(0.0, 0.0, -300.0);
        let levels = (0..40).map(|step| (f64::from(step) / 40.0).powi(3));
        let mut skin: Vec<DVec3> = levels
            .flat_map(|t| {
                (0..24).map(move |side| {
                    let angle = f64::from(side) * std::f64::consts::TAU / 24.0;
                    let radius = 60.0 - 20.0 * t;
                    DVec3::new(5.0 + radius * angle.cos(), radius * angle.sin(), -300.0 * t)
                })
            })
            .collect();
        skin.push(DVec3::new(150.0, 0.0, -280.0));
        let [a, b] = cone(&skin, DVec3::ZERO, axis, &(0.0..1.0)).unwrap();
        assert!((a.radius - 60.0).abs() < 2.0 && (b.radius - 40.0).abs() < 2.0, "{} {}", a.radius, b.radius);
        assert!(a.beside.distance(DVec3::X * 5.0) < 1.0 && b.beside.distance(DVec3::X * 5.0) < 1.0);
        assert!(cone(&[], DVec3::ZERO, axis, &(0.0..1.0)).is_none());
        assert!(cone(&[DVec3::NAN], DVec3::ZERO, axis, &(0.0..1.0)).is_none());
    }
}
