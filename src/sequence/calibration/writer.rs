//! Cameras written as `cameras.toml`.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result};

use super::checks::names;
use super::parse_cameras_toml;
use crate::files::{Overwrite, write_atomically};
use crate::geometry::{Camera, Lens, TsaiConstants, rodrigues_vector};

/// The text of a `cameras.toml` in mm. Reading it gives the cameras back: every number exactly but the rotation, which
/// passes through three numbers (Rodrigues, or Euler for Tsai) and returns within a few 1e-16 an entry.
pub fn cameras_toml(cameras: &[Camera]) -> String {
    let mut text = String::new();
    // Writing into a String cannot fail.
    let _ = write_text(&mut text, cameras);
    text
}

/// Writes `cameras.toml` (mm), atomically.
///
/// # Errors
/// When [`super::read_cameras`] would refuse the file (no camera, two of one name, what is not a number, …), when it
/// exists and may not be replaced, or cannot be written.
pub fn write_cameras_toml(path: &Path, cameras: &[Camera], overwrite: Overwrite) -> Result<()> {
    let text = cameras_toml(cameras);
    // A file that cannot be read again is better not written.
    let readable = names(cameras).and_then(|()| parse_cameras_toml(&text, "the calibration"));
    readable.with_context(|| format!("cannot write {}", path.display()))?;
    write_atomically(path, overwrite, |writer| Ok(writer.write_all(text.as_bytes())?))
}

fn write_text(text: &mut String, cameras: &[Camera]) -> std::fmt::Result {
    for camera in cameras {
        let quoted = quoted(&camera.name);
        // The table `[metadata]` is the units': whoever reads the file back is to hear of the name, not of two tables.
        let is_taken = camera.name == "metadata";
        let table = if is_taken { "\"camera metadata\"".to_string() } else { key(&camera.name, &quoted) };
        let [width, height] = camera.size;
        writeln!(text, "[{table}]\nname = {quoted}\nsize = [{width}, {height}]")?;
        match camera.lens {
            Lens::BrownConrady(lens) => {
                let ([fx, fy], [cx, cy]) = (lens.focal.to_array(), lens.centre.to_array());
                let ([k1, k2, k3], [p1, p2]) = (lens.radial, lens.tangential);
                writeln!(text, "matrix = [[{fx:?}, 0.0, {cx:?}], [0.0, {fy:?}, {cy:?}], [0.0, 0.0, 1.0]]")?;
                // Four numbers where four say it all: that is what other programs expect.
                let fifth = if k3 == 0.0 { String::new() } else { format!(", {k3:?}") };
                writeln!(text, "distortions = [{k1:?}, {k2:?}, {p1:?}, {p2:?}{fifth}]")?;
                let rotation = rodrigues_vector(camera.camera_from_world.matrix3).to_array();
                writeln!(text, "rotation = {rotation:?}")?;
                writeln!(text, "translation = {:?}\n", camera.camera_from_world.translation.to_array())?;
            }
            Lens::Tsai(_) => {
                writeln!(text, "model = \"tsai\"")?;
                if let Some(raw) = TsaiConstants::of(camera) {
                    writeln!(text, "tsai = {{ {} }}\n", constants(&raw))?;
                }
            }
        }
    }
    writeln!(text, "[metadata]\nunits = \"mm\"")
}

fn constants(raw: &TsaiConstants) -> String {
    let TsaiConstants { f, kappa, cx, cy, sx, ncx, nfx, dx, dy, rx, ry, rz, tx, ty, tz } = raw;
    format!(
        "f = {f:?}, kappa = {kappa:?}, cx = {cx:?}, cy = {cy:?}, sx = {sx:?}, ncx = {ncx:?}, nfx = {nfx:?}, \
         dx = {dx:?}, dy = {dy:?}, rx = {rx:?}, ry = {ry:?}, rz = {rz:?}, tx = {tx:?}, ty = {ty:?}, tz = {tz:?}"
    )
}

/// A name as a table's key: bare where TOML allows it.
fn key(name: &str, quoted: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if name.chars().all(is_bare) { name.to_string() } else { quoted.to_string() }
}

/// A basic string: keys may not be of TOML's many-line kind, which its own writer prefers for some.
fn quoted(name: &str) -> String {
    let escaped: String = name
        .chars()
        .map(|c| match c {
            '"' | '\\' => format!("\\{c}"),
            c if c.is_control() => format!("\\u{:04X}", u32::from(c)),
            c => c.to_string(),
        })
        .collect();
    format!("\"{escaped}\"")
}
