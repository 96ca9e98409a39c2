//! `cameras.toml`: the layout that Pose2Sim, anipose and caliscope write, and Tsai cameras in it (FORMATS).

use std::fmt;

use anyhow::{Context, Result, anyhow, bail, ensure};
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny, MapAccess, Visitor};
use toml::Spanned;

use super::checks::{brown_conrady, names, picture_size, rotation_vector, translation};
use super::units::{Units, to_mm};
use crate::files::{exactly, exactly_if_any, parse_toml};
use crate::geometry::{Camera, TsaiConstants};

/// Reads the text of a `cameras.toml`; `name` stands for the file in messages. Without `[metadata] units` lengths are
/// metres. A table without a `name` is called as the table is.
///
/// # Errors
/// As [`super::read_cameras`].
pub fn parse_cameras_toml(text: &str, name: &str) -> Result<Vec<Camera>> {
    let mut file: CamerasFile = parse_toml(text, name)?;
    // The order of the file, whatever order the tables were handed over in.
    file.cameras.sort_by_key(|(table, _)| table.span().start);
    let mut cameras = file
        .cameras
        .iter()
        .map(|(table, entry)| {
            let called = entry.name.as_deref().unwrap_or(table.get_ref());
            camera(called, entry).with_context(|| format!("{name}: camera `{called}`"))
        })
        .collect::<Result<Vec<_>>>()?;
    names(&cameras).with_context(|| name.to_string())?;
    let units = file.metadata.units.as_deref().map(Units::from_name).transpose();
    let units = units.with_context(|| format!("{name}: [metadata]"))?;
    to_mm(&mut cameras, units, "`[metadata] units = \"{}\"`").with_context(|| name.to_string())?;
    Ok(cameras)
}

struct CamerasFile {
    metadata: Metadata,
    cameras: Vec<(Spanned<String>, CameraEntry)>,
}

/// Every table but `[metadata]` is a camera, under a name of the user's.
impl<'de> Deserialize<'de> for CamerasFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Tables;
        impl<'de> Visitor<'de> for Tables {
            type Value = CamerasFile;

            fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                formatter.write_str("a table for every camera")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<CamerasFile, A::Error> {
                let mut file = CamerasFile { metadata: Metadata::default(), cameras: Vec::new() };
                while let Some(key) = map.next_key::<Spanned<String>>()? {
                    if key.get_ref() == "metadata" {
                        file.metadata = map.next_value()?;
                    } else {
                        file.cameras.push((key, map.next_value()?));
                    }
                }
                Ok(file)
            }
        }
        deserializer.deserialize_map(Tables)
    }
}

/// What the writing programs say about the whole; only the unit matters here.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Metadata {
    units: Option<String>,
    #[serde(rename = "adjusted")]
    _adjusted: Option<IgnoredAny>,
    #[serde(rename = "error")]
    _error: Option<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a camera's table with name, size, matrix, distortions, rotation, translation"
)]
struct CameraEntry {
    name: Option<String>,
    #[serde(deserialize_with = "exactly")]
    size: [f64; 2],
    #[serde(default, deserialize_with = "exactly_if_any")]
    matrix: Option<[[f64; 3]; 3]>,
    distortions: Option<Vec<f64>>,
    #[serde(default, deserialize_with = "exactly_if_any")]
    rotation: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "exactly_if_any")]
    translation: Option<[f64; 3]>,
    #[serde(default)]
    fisheye: bool,
    model: Option<String>,
    tsai: Option<TsaiEntry>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct TsaiEntry {
    f: f64,
    kappa: f64,
    cx: f64,
    cy: f64,
    sx: f64,
    ncx: f64,
    nfx: f64,
    dx: f64,
    dy: f64,
    rx: f64,
    ry: f64,
    rz: f64,
    tx: f64,
    ty: f64,
    tz: f64,
}

fn camera(name: &str, entry: &CameraEntry) -> Result<Camera> {
    let size = picture_size(entry.size)?;
    match entry.model.as_deref() {
        None | Some("brown-conrady") => {}
        Some("tsai") => return tsai_camera(name, size, entry),
        Some(model) => bail!("model is {model:?}, expected \"tsai\" or no such key"),
    }
    ensure!(entry.tsai.is_none(), "tsai is given without model = \"tsai\", expected both or neither");
    ensure!(!entry.fisheye, "fisheye is true, expected false: fisheye lenses are not supported, calibrate without");
    let missing =
        |key: &str| anyhow!("{key} is missing, expected name, size, matrix, distortions, rotation, translation");
    let matrix = entry.matrix.ok_or_else(|| missing("matrix"))?;
    let distortions = entry.distortions.as_deref().ok_or_else(|| missing("distortions"))?;
    let rotation = rotation_vector(entry.rotation.ok_or_else(|| missing("rotation"))?)?;
    let translation = translation(entry.translation.ok_or_else(|| missing("translation"))?)?;
    let lens = brown_conrady(matrix, distortions)?;
    let camera_from_world = glam::DAffine3::from_mat3_translation(rotation, translation);
    Ok(Camera { name: name.to_string(), size, camera_from_world, lens })
}

fn tsai_camera(name: &str, size: [u32; 2], entry: &CameraEntry) -> Result<Camera> {
    let raw = entry.tsai.ok_or_else(|| anyhow!("tsai is missing, expected it with model = \"tsai\""))?;
    for (key, given) in [
        ("matrix", entry.matrix.is_some()),
        ("distortions", entry.distortions.is_some()),
        ("rotation", entry.rotation.is_some()),
        ("translation", entry.translation.is_some()),
        ("fisheye", entry.fisheye),
    ] {
        ensure!(!given, "{key} stands beside model = \"tsai\", expected name, size and tsai alone");
    }
    let TsaiEntry { f, kappa, cx, cy, sx, ncx, nfx, dx, dy, rx, ry, rz, tx, ty, tz } = raw;
    for (key, value) in [("f", f), ("sx", sx), ("ncx", ncx), ("nfx", nfx), ("dx", dx), ("dy", dy)] {
        ensure!(value > 1e-9 && value < 1e9, "tsai.{key} is {value:?}, expected a number more than 0");
    }
    for (key, value) in [("kappa", kappa), ("cx", cx), ("cy", cy)] {
        ensure!(value.abs() < 1e9, "tsai.{key} is {value:?}, expected a finite number");
    }
    for (key, angle) in [("rx", rx), ("ry", ry), ("rz", rz)] {
        ensure!(
            angle.abs() <= std::f64::consts::TAU,
            "tsai.{key} is {angle:?}, expected radians, no more than a full turn (6.283)"
        );
    }
    translation([tx, ty, tz]).context("tsai")?;
    let constants = TsaiConstants { f, kappa, cx, cy, sx, ncx, nfx, dx, dy, rx, ry, rz, tx, ty, tz };
    Ok(constants.camera(name, size))
}
