//! Cameras from OpenCV's file storage: one a file, or several under numbered keys.

use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use glam::{DAffine3, DMat3};

use super::checks::{brown_conrady, names, picture_size, rotation_matrix, rotation_vector, translation};
use super::opencv_storage::{Entry, Storage, Value};
use super::sizes::{Sizes, unsized_pictures};
use super::units::{Units, to_mm};
use crate::geometry::Camera;

const MATRIX_KEYS: [&str; 6] = ["camera_matrix", "cameraMatrix", "CameraMatrix", "Camera_Matrix", "K", "M"];
const DISTORTION_KEYS: [&str; 7] = [
    "distortion_coefficients",
    "distCoeffs",
    "DistCoeffs",
    "Distortion_Coefficients",
    "DistortionCoefficients",
    "dist",
    "D",
];
const ROTATION_KEYS: [&str; 6] = ["R", "Rot", "Rotation", "rvec", "rotation_vector", "rotation_vectors"];
const TRANSLATION_KEYS: [&str; 5] = ["T", "Translation", "tvec", "translation_vector", "translation_vectors"];
const WIDTH_KEYS: [&str; 4] = ["image_width", "image_Width", "width", "W"];
const HEIGHT_KEYS: [&str; 4] = ["image_height", "image_Height", "height", "H"];
const SIZE_KEYS: [&str; 3] = ["image_size", "imageSize", "size"];

/// Reads a YAML file of OpenCV's (`%YAML:1.0` and matrix tags included); `name` stands for the file in messages.
///
/// One camera: `camera_matrix` (`cameraMatrix`, `CameraMatrix`, `K`, `M`), `distortion_coefficients` (`distCoeffs`, `dist`,
/// `D`), `image_width` and `image_height`, `R` (`Rot`, `Rotation`, `rvec`, `rotation_vectors`: a matrix or a Rodrigues vector,
/// camera from world) and `T` (`Translation`, `tvec`, `translation_vectors`); it is called by its `camera_name`, else by the
/// file. Several: the same keys with an ending, `K1` or `K_left`, and the size perhaps without; they are called `cam1` or
/// `left`, and just `1` where the file lists their `names`. Of a stereo pair with one `R` and `T` between its cameras the
/// first is the world's origin. Lengths are metres unless `units: "mm"` is among the keys.
///
/// # Errors
/// As [`super::read_cameras`].
pub fn parse_opencv_yaml(text: &str, name: &str) -> Result<Vec<Camera>> {
    sized_yaml(text, name, &unsized_pictures)
}

/// Reads an XML file of OpenCV's, with the keys of [`parse_opencv_yaml`].
///
/// # Errors
/// As [`super::read_cameras`].
pub fn parse_opencv_xml(text: &str, name: &str) -> Result<Vec<Camera>> {
    sized_xml(text, name, &unsized_pictures)
}

/// The same, with picture sizes known from elsewhere.
pub(super) fn sized_yaml(text: &str, name: &str, sizes: Sizes) -> Result<Vec<Camera>> {
    cameras(&Storage::from_yaml(text, name)?, name, YAML_UNITS, sizes)
}

/// The same, with picture sizes known from elsewhere.
pub(super) fn sized_xml(text: &str, name: &str, sizes: Sizes) -> Result<Vec<Camera>> {
    cameras(&Storage::from_xml(text, name)?, name, "`<units>{}</units>`", sizes)
}

/// Reads the two YAML files that EasyMocap keeps a calibration in, text and name of each: lenses (`K_01`, `dist_01`) and
/// places (`R_01` or `Rot_01`, `T_01`).
pub(super) fn parse_easymocap(lenses: (&str, &str), places: (&str, &str), sizes: Sizes) -> Result<Vec<Camera>> {
    let mut storage = Storage::from_yaml(lenses.0, lenses.1)?;
    storage.add(Storage::from_yaml(places.0, places.1)?);
    cameras(&storage, &format!("{} with {}", lenses.1, places.1), YAML_UNITS, sizes)
}

const YAML_UNITS: &str = "`units: \"{}\"`";

fn cameras(storage: &Storage, file: &str, how_to_state_units: &str, sizes: Sizes) -> Result<Vec<Camera>> {
    refuse_other_models(storage, file)?;
    let endings: Vec<&str> = storage.entries.iter().filter_map(|entry| ending(&entry.key)).collect();
    ensure!(
        !endings.is_empty(),
        "{file} holds no camera, expected a matrix under one of the keys {}",
        MATRIX_KEYS.join(", ")
    );
    // A stereo pair's intrinsics with what lies between the two cameras.
    let own_place = |ending: &str| find(storage, &TRANSLATION_KEYS, ending).is_some();
    let is_pair =
        endings.len() == 2 && !endings.contains(&"") && own_place("") && !endings.iter().any(|e| own_place(e));
    let mut cameras = Vec::with_capacity(endings.len());
    for (index, ending) in endings.into_iter().enumerate() {
        let called = camera_name(storage, ending, file);
        let place = match (is_pair, index) {
            (false, _) => pose(storage, ending),
            (true, 0) => Ok(DAffine3::IDENTITY),
            (true, _) => pose(storage, ""),
        };
        let camera = place.and_then(|place| camera(storage, ending, &called, place, sizes));
        cameras.push(camera.with_context(|| format!("{file}: camera `{called}`"))?);
    }
    names(&cameras).with_context(|| file.to_string())?;
    let units = find(storage, &["units"], "").map(|entry| match &entry.value {
        Value::Text(text) => Units::from_name(text),
        other => Err(anyhow!("units is {other:?}, expected \"m\" or \"mm\"")),
    });
    let units = units.transpose().with_context(|| file.to_string())?;
    to_mm(&mut cameras, units, how_to_state_units).with_context(|| file.to_string())?;
    Ok(cameras)
}

/// The same numbers under a fisheye or rational model mean another lens.
fn refuse_other_models(storage: &Storage, file: &str) -> Result<()> {
    for Entry { key, line, value } in &storage.entries {
        match (key.as_str(), value) {
            ("distortion_model", Value::Text(model)) if model != "plumb_bob" => {
                bail!("{file}, line {line}: distortion_model is {model:?}, expected \"plumb_bob\"")
            }
            ("fisheye_model", Value::Numbers(flag)) if flag.iter().any(|&flag| flag != 0.0) => {
                bail!("{file}, line {line}: fisheye_model is set, expected 0: fisheye lenses are not supported")
            }
            _ => {}
        }
    }
    Ok(())
}

/// What follows the name of a camera matrix: nothing, a number, or an underscore and more.
fn ending(key: &str) -> Option<&str> {
    MATRIX_KEYS.into_iter().filter_map(|known| key.strip_prefix(known)).find(|rest| {
        rest.is_empty() || (rest.len() > 1 && rest.starts_with('_')) || rest.starts_with(|c: char| c.is_ascii_digit())
    })
}

fn find<'a>(storage: &'a Storage, keys: &[&str], ending: &str) -> Option<&'a Entry> {
    keys.iter().find_map(|key| storage.entries.iter().find(|entry| entry.key.strip_prefix(key) == Some(ending)))
}

fn camera_name(storage: &Storage, ending: &str, file: &str) -> String {
    let bare = ending.trim_start_matches('_');
    if let Some(Entry { value: Value::Text(name), .. }) = find(storage, &["camera_name"], ending) {
        name.clone()
    } else if bare.is_empty() {
        Path::new(file).file_stem().map_or_else(|| "camera".to_string(), |stem| stem.to_string_lossy().into_owned())
    } else if bare.starts_with(|c: char| c.is_ascii_digit()) && find(storage, &["names"], "").is_none() {
        format!("cam{bare}")
    } else {
        bare.to_string()
    }
}

fn camera(storage: &Storage, ending: &str, name: &str, camera_from_world: DAffine3, sizes: Sizes) -> Result<Camera> {
    let matrix = square(required(storage, &MATRIX_KEYS, ending)?)?;
    let distortions = vector(required(storage, &DISTORTION_KEYS, ending)?)?;
    let lens = brown_conrady(matrix, distortions)?;
    // One size may serve all cameras.
    let shared = |keys: &[&str]| find(storage, keys, ending).or_else(|| find(storage, keys, ""));
    let sides = match (shared(&WIDTH_KEYS), shared(&HEIGHT_KEYS), shared(&SIZE_KEYS)) {
        (Some(width), Some(height), _) => [vector(width)?, vector(height)?].concat(),
        (.., Some(size)) => vector(size)?.to_vec(),
        _ => match sizes(name)? {
            Some(size) => size.map(f64::from).to_vec(),
            None => bail!("image_width and image_height are missing, expected the picture's size in pixels"),
        },
    };
    let &[width, height] = &sides[..] else { bail!("size holds {} numbers, expected width and height", sides.len()) };
    let size = picture_size([width, height])?;
    Ok(Camera { name: name.to_string(), size, camera_from_world, lens })
}

fn pose(storage: &Storage, ending: &str) -> Result<DAffine3> {
    let entry = required(storage, &ROTATION_KEYS, ending)?;
    let rotation: DMat3 = match vector(entry) {
        Ok(&[x, y, z]) => rotation_vector([x, y, z])?,
        Err(several) if entry.key.ends_with("vectors") => return Err(several),
        _ => rotation_matrix(square(entry)?)?,
    };
    let entry = required(storage, &TRANSLATION_KEYS, ending)?;
    let &[x, y, z] = vector(entry)? else {
        bail!("{} on line {} is no 3-vector, expected x, y, z", entry.key, entry.line)
    };
    Ok(DAffine3::from_mat3_translation(rotation, translation([x, y, z])?))
}

fn required<'a>(storage: &'a Storage, keys: &[&str], ending: &str) -> Result<&'a Entry> {
    find(storage, keys, ending).ok_or_else(|| {
        let expected: Vec<String> = keys.iter().map(|key| format!("{key}{ending}")).collect();
        anyhow!("{} is missing, expected one of the keys {}", expected[0], expected.join(", "))
    })
}

/// A row or a column of numbers.
fn vector(entry: &Entry) -> Result<&[f64]> {
    match &entry.value {
        Value::Numbers(numbers) => Ok(numbers),
        Value::Matrix { rows, columns, data } if *rows == 1 || *columns == 1 => Ok(data),
        Value::Matrix { rows, columns: 3, .. } if *rows != 3 && entry.key.ends_with("vectors") => {
            bail!("{} on line {} holds {rows} vectors, expected one: camera from world", entry.key, entry.line)
        }
        _ => bail!("{} on line {} is no row of numbers, expected one", entry.key, entry.line),
    }
}

fn square(entry: &Entry) -> Result<[[f64; 3]; 3]> {
    let data = match &entry.value {
        Value::Matrix { rows: 3, columns: 3, data } => &data[..],
        Value::Numbers(data) => &data[..],
        _ => &[],
    };
    let &[a, b, c, d, e, f, g, h, i] = data else {
        bail!("{} on line {} is no 3x3 matrix, expected one", entry.key, entry.line)
    };
    Ok([[a, b, c], [d, e, f], [g, h, i]])
}
