//! Qualisys Track Manager's exported calibration, `.qca.txt` (XML).

use std::str::FromStr;

use anyhow::{Context, Result, anyhow, ensure};
use glam::{DAffine3, DMat3, DVec3};
use roxmltree::Node;

use super::checks::{brown_conrady, names, picture_size, rotation_matrix, translation};
use super::units::{Units, to_mm};
use super::xml::parse_xml;
use crate::geometry::Camera;

/// Intrinsic lengths are written in 1/64 pixel; distortions are plain numbers.
const STEPS_PER_PIXEL: f64 = 64.0;

/// Reads the text of a `.qca.txt`; `name` stands for the file in messages. Cameras are called by their serial number;
/// those marked inactive are left out. The picture is the video's field of view.
///
/// # Errors
/// As [`super::read_cameras`].
pub fn parse_qualisys(text: &str, name: &str) -> Result<Vec<Camera>> {
    let document = parse_xml(text, name)?;
    let root = document.root_element();
    ensure!(
        root.has_tag_name("calibration"),
        "{name} has the root element `{}`, expected `calibration`, as Qualisys writes it",
        root.tag_name().name()
    );
    let mut cameras = root
        .descendants()
        .filter(|node| node.has_tag_name("camera") && node.attribute("active") != Some("0"))
        .map(|node| {
            let line = document.text_pos_at(node.range().start).row;
            let serial = node.attribute("serial").ok_or_else(|| anyhow!("serial is missing from `camera`"));
            let serial = serial.with_context(|| format!("{name}, line {line}"))?;
            camera(serial, node).with_context(|| format!("{name}, line {line}: camera `{serial}`"))
        })
        .collect::<Result<Vec<_>>>()?;
    names(&cameras).with_context(|| name.to_string())?;
    to_mm(&mut cameras, Some(Units::Millimetres), "{}").with_context(|| name.to_string())?;
    Ok(cameras)
}

fn camera(serial: &str, node: Node) -> Result<Camera> {
    let turned: f64 = if node.has_attribute("viewrotation") { attribute(node, "viewrotation")? } else { 0.0 };
    ensure!(turned == 0.0, "viewrotation is {turned}, expected 0: export the calibration of the unturned view");
    let view = child(node, "fov_video")?;
    let [left, top, right, bottom] = numbers(view, ["left", "top", "right", "bottom"])?;
    let size = picture_size([right - left + 1.0, bottom - top + 1.0])?;

    let inner = child(node, "intrinsic")?;
    let [fx, fy, cx, cy] = numbers(inner, ["focalLengthU", "focalLengthV", "centerPointU", "centerPointV"])?
        .map(|value| value / STEPS_PER_PIXEL);
    let skew = if inner.has_attribute("skew") { attribute(inner, "skew")? } else { 0.0 };
    // The spelling is Qualisys's own.
    let distortions = ["radialDistortion1", "radialDistortion2", "tangentalDistortion1", "tangentalDistortion2"];
    let [k1, k2, p1, p2] = numbers(inner, distortions)?;
    let k3 = attribute(inner, "radialDistortion3")?;
    // The principal point counts from the sensor's corner, pixels from the view's.
    let matrix = [[fx, skew, cx - left], [0.0, fy, cy - top], [0.0, 0.0, 1.0]];
    let lens = brown_conrady(matrix, &[k1, k2, p1, p2, k3])?;

    let outer = child(node, "transform")?;
    let rows = [["r11", "r12", "r13"], ["r21", "r22", "r23"], ["r31", "r32", "r33"]];
    let [first, second, third] = rows.map(|row| numbers(outer, row));
    let rotation = rotation_matrix([first?, second?, third?])?;
    let centre = translation(numbers(outer, ["x", "y", "z"])?)?;
    // Qualisys's camera looks along -z with y up, and its place is given, not the translation.
    let rotation = DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0)) * rotation;
    let camera_from_world = DAffine3::from_mat3_translation(rotation, -(rotation * centre));
    Ok(Camera { name: serial.to_string(), size, camera_from_world, lens })
}

fn child<'a, 'input>(node: Node<'a, 'input>, tag: &str) -> Result<Node<'a, 'input>> {
    node.children().find(|child| child.has_tag_name(tag)).ok_or_else(|| anyhow!("the element `{tag}` is missing"))
}

fn numbers<const N: usize>(node: Node, keys: [&str; N]) -> Result<[f64; N]> {
    let mut values = [0.0; N];
    for (value, key) in values.iter_mut().zip(keys) {
        *value = attribute(node, key)?;
    }
    Ok(values)
}

fn attribute(node: Node, key: &str) -> Result<f64> {
    let tag = node.tag_name().name();
    let text = node.attribute(key).ok_or_else(|| anyhow!("{key} is missing from `{tag}`"))?;
    let value = f64::from_str(text.trim()).ok().filter(|value| value.is_finite());
    value.ok_or_else(|| anyhow!("{key} of `{tag}` is {text:?}, expected a finite number"))
}
