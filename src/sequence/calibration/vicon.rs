//! Vicon's calibration, `.xcp` (XML).

use std::str::FromStr;

use anyhow::{Context, Result, anyhow, bail, ensure};
use glam::{DAffine3, DMat3, DQuat, DVec2};
use nalgebra::{DMatrix, DVector};
use roxmltree::Node;

use super::checks::{brown_conrady, names, picture_size, translation};
use super::units::{Units, to_mm};
use super::xml::parse_xml;
use crate::geometry::{BrownConrady, Camera, Lens};

/// Pixels by which the lens may be missed that stands for Vicon's: a tenth of what a calibration is good to.
const FARTHEST_OFF: f64 = 0.05;

/// Places of the picture, a side, at which the lenses are compared.
const GRID: u32 = 24;

/// Reads the text of an `.xcp`; `name` stands for the file in messages. Cameras are called by their device's number
/// (`DEVICEID`). Where there are video cameras, those alone are taken; cameras that were not calibrated are left out.
///
/// Vicon's lens undistorts: a pixel at the distance r from the centre of distortion belongs where 1 + k1 r² + k2 r⁴ + k3 r⁶ times
/// that distance is. The Brown-Conrady lens distorts, so it is fitted to the inverse, over the whole picture.
///
/// # Errors
/// As [`super::read_cameras`], and where no Brown-Conrady lens comes within 0.05 pixels of the file's, with how far it is off.
pub fn parse_vicon(text: &str, name: &str) -> Result<Vec<Camera>> {
    let document = parse_xml(text, name)?;
    let root = document.root_element();
    ensure!(
        root.has_tag_name("Cameras"),
        "{name} has the root element `{}`, expected `Cameras`, as Vicon writes it",
        root.tag_name().name()
    );
    let all: Vec<Node> = root.children().filter(|node| node.has_tag_name("Camera")).collect();
    let has_video = all.iter().any(|node| is_video(*node));
    let taken = all.iter().filter(|node| is_video(**node) == has_video);
    let mut cameras = Vec::new();
    for node in taken {
        let line = document.text_pos_at(node.range().start).row;
        let id = node.attribute("DEVICEID").ok_or_else(|| anyhow!("DEVICEID is missing from `Camera`"));
        let id = id.with_context(|| format!("{name}, line {line}"))?;
        let camera = camera(id, *node).with_context(|| format!("{name}, line {line}: camera `{id}`"))?;
        cameras.extend(camera);
    }
    ensure!(
        all.is_empty() || !cameras.is_empty(),
        "{name}: none of its {} cameras is calibrated, expected a `KeyFrame` in each",
        if has_video { "video" } else { "marker" }
    );
    names(&cameras).with_context(|| name.to_string())?;
    to_mm(&mut cameras, Some(Units::Millimetres), "{}").with_context(|| name.to_string())?;
    Ok(cameras)
}

/// Whether a camera films: marker cameras stand in the same file.
fn is_video(node: Node) -> bool {
    let says = |key: &str, word: &str| node.attribute(key).is_some_and(|text| text.to_lowercase().contains(word));
    says("TYPE", "video") || says("DISPLAY_TYPE", "video") || says("DISPLAY_TYPE", "vue")
}

fn camera(id: &str, node: Node) -> Result<Option<Camera>> {
    let frames = node.children().filter(|child| child.has_tag_name("KeyFrames"));
    let frames: Vec<Node> = frames.flat_map(|list| list.children()).filter(|n| n.has_tag_name("KeyFrame")).collect();
    let &[frame] = &frames[..] else {
        ensure!(frames.is_empty(), "{} key frames, expected one: moving cameras are not supported", frames.len());
        return Ok(None);
    };
    let size = picture_size(numbers(node, "SENSOR_SIZE")?)?;
    let [aspect] = if node.has_attribute("PIXEL_ASPECT_RATIO") { numbers(node, "PIXEL_ASPECT_RATIO")? } else { [1.0] };
    let [skew] = if node.has_attribute("SKEW") { numbers(node, "SKEW")? } else { [0.0] };
    ensure!((0.1..10.0).contains(&aspect), "PIXEL_ASPECT_RATIO is {aspect}, expected a number near 1");
    let [focal] = numbers(frame, "FOCAL_LENGTH")?;
    let [cx, cy] = numbers(frame, "PRINCIPAL_POINT")?;
    let pinhole = brown_conrady([[focal, skew, cx], [0.0, focal / aspect, cy], [0.0, 0.0, 1.0]], &[0.0; 5])?;
    let Lens::BrownConrady(pinhole) = pinhole else { bail!("the lens is none of Brown-Conrady's, expected that") };
    let lens = Lens::BrownConrady(Undistortion::of(frame, pinhole.centre, aspect)?.as_brown_conrady(pinhole, size)?);

    let [x, y, z, w] = numbers(frame, "ORIENTATION")?;
    let turn = DQuat::from_xyzw(x, y, z, w);
    ensure!(
        (turn.length() - 1.0).abs() < 1e-3,
        "ORIENTATION is [{x}, {y}, {z}, {w}], expected a quaternion of length 1, its real part last"
    );
    let rotation = DMat3::from_quat(turn.normalize());
    // Vicon states where the camera stands.
    let centre = translation(numbers(frame, "POSITION")?)?;
    let camera_from_world = DAffine3::from_mat3_translation(rotation, -(rotation * centre));
    Ok(Some(Camera { name: id.to_string(), size, camera_from_world, lens }))
}

/// Where a distorted pixel belongs.
#[derive(Clone, Copy, Debug)]
struct Undistortion {
    /// Of the distortion, pixels.
    centre: DVec2,
    /// What a pixel's height is in widths.
    aspect: f64,
    /// k1, k2, k3 in 1/pixel², 1/pixel⁴, 1/pixel⁶.
    terms: [f64; 3],
}

impl Undistortion {
    /// `VICON_RADIAL2`, a word, the centre and three terms; or `VICON_RADIAL`, two terms about the principal point.
    fn of(frame: Node, principal: DVec2, aspect: f64) -> Result<Self> {
        if let Some(text) = frame.attribute("VICON_RADIAL2") {
            let numbers: Option<Vec<f64>> = text.split_whitespace().skip(1).map(finite).collect();
            let Some(&[x, y, k1, k2, k3]) = numbers.as_deref() else {
                bail!("VICON_RADIAL2 is {text:?}, expected `ViconRadial2` and five finite numbers: x, y, k1, k2, k3");
            };
            return Ok(Self { centre: DVec2::new(x, y), aspect, terms: [k1, k2, k3] });
        }
        let [k1, k2] = if frame.has_attribute("VICON_RADIAL") { numbers(frame, "VICON_RADIAL")? } else { [0.0; 2] };
        Ok(Self { centre: principal, aspect, terms: [k1, k2, 0.0] })
    }

    fn undistorted(&self, pixel: DVec2) -> DVec2 {
        let away = pixel - self.centre;
        let square = away.x * away.x + (away.y * self.aspect).powi(2);
        let [k1, k2, k3] = self.terms;
        self.centre + away * (1.0 + square * (k1 + square * (k2 + square * k3)))
    }

    /// The same lens with `pinhole`'s focal length and centre, its terms found by least squares over the picture, in which
    /// they are linear.
    fn as_brown_conrady(&self, pinhole: BrownConrady, size: [u32; 2]) -> Result<BrownConrady> {
        if self.terms == [0.0; 3] {
            return Ok(pinhole);
        }
        let [width, height] = size.map(f64::from);
        let place = |step: u32, length: f64| f64::from(step) / f64::from(GRID - 1) * (length - 1.0);
        let pixels = (0..GRID).flat_map(|y| (0..GRID).map(move |x| DVec2::new(place(x, width), place(y, height))));
        let pairs: Vec<(DVec2, DVec2)> =
            pixels.map(|pixel| ((self.undistorted(pixel) - pinhole.centre) / pinhole.focal, pixel)).collect();
        let mut terms = DMatrix::zeros(2 * pairs.len(), 5);
        let mut wanted = DVector::zeros(2 * pairs.len());
        for (index, (at, pixel)) in pairs.iter().enumerate() {
            let (square, seen) = (at.length_squared(), (*pixel - pinhole.centre) / pinhole.focal);
            let cross = 2.0 * at.x * at.y;
            let tangential = [[cross, square + 2.0 * at.x * at.x], [square + 2.0 * at.y * at.y, cross]];
            for axis in 0..2 {
                let row = 2 * index + axis;
                for power in 0..3 {
                    terms[(row, power)] = at[axis] * square.powi(power as i32 + 1);
                }
                for term in 0..2 {
                    terms[(row, 3 + term)] = tangential[axis][term];
                }
                wanted[row] = seen[axis] - at[axis];
            }
        }
        let solved = terms.svd(true, true).solve(&wanted, 1e-14).map_err(|error| anyhow!("the lens: {error}"))?;
        let radial = [solved[0], solved[1], solved[2]];
        let lens = BrownConrady { radial, tangential: [solved[3], solved[4]], ..pinhole };
        let off = |(at, pixel): &(DVec2, DVec2)| {
            lens.distort(*at).map_or(f64::INFINITY, |seen| (lens.to_pixel(seen) - *pixel).length())
        };
        let farthest = pairs.iter().map(off).fold(0.0, f64::max);
        ensure!(
            farthest <= FARTHEST_OFF,
            "its distortion {:?} about [{}, {}] is beyond k1, k2, k3, p1, p2 by {farthest:.2} pixels, expected at most \
             {FARTHEST_OFF}",
            self.terms,
            self.centre.x,
            self.centre.y
        );
        Ok(lens)
    }
}

fn finite(text: &str) -> Option<f64> {
    f64::from_str(text).ok().filter(|value| value.is_finite())
}

fn numbers<const N: usize>(node: Node, key: &str) -> Result<[f64; N]> {
    let tag = node.tag_name().name();
    let text = node.attribute(key).ok_or_else(|| anyhow!("{key} is missing from `{tag}`"))?;
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(finite).collect();
    let numbers = numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
    numbers.ok_or_else(|| anyhow!("{key} of `{tag}` is {text:?}, expected {N} finite numbers"))
}
