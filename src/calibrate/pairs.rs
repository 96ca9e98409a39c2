//! Pairs of a point in the world and its place in a picture, as `camera,x,y,z,u,v` (and perhaps `point`).

use anyhow::{Result, bail, ensure};
use glam::{DVec2, DVec3};

use super::table::{Row, each_row};
use crate::files::shortened;
use crate::motion::LARGEST_COORDINATE;

/// No picture reaches this far: a coordinate beyond it is damage.
const LARGEST_PIXEL: f64 = 1e6;

/// A point in the world and where a camera saw it.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// What messages call it: its name in the file, or the line it stands in.
    pub name: String,
    /// World, mm.
    pub point: DVec3,
    /// Pixels, origin in the centre of the top-left one.
    pub pixel: DVec2,
}

/// The pairs of one camera.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPairs {
    /// The camera's name.
    pub camera: String,
    /// Its pairs, in the file's order.
    pub pairs: Vec<Pair>,
}

/// Reads the text of a table of pairs; `name` stands for the file in messages, `unit` is the length of the table's unit
/// in mm. A row with neither `u` nor `v` is a point that this camera did not see. Cameras come in the order of their
/// first rows.
///
/// # Errors
/// One sentence with the file, the line, what was found and what was expected.
pub fn parse_pairs(text: &str, name: &str, unit: f64) -> Result<Vec<CameraPairs>> {
    let mut cameras = Vec::new();
    each_row(text, name, &["camera", "x", "y", "z", "u", "v"], &["point"], |row| {
        let point = DVec3::new(row.number(1, "x")?, row.number(2, "y")?, row.number(3, "z")?) * unit;
        ensure!(
            point.abs().max_element() <= LARGEST_COORDINATE,
            "{}: found ({}, {}, {}) mm, expected coordinates below {LARGEST_COORDINATE:e} mm",
            row.place,
            point.x,
            point.y,
            point.z
        );
        let camera = camera_name(row, 0)?;
        let Some(pixel) = pixel(row, [4, 5])? else { return Ok(()) };
        let line = row.place.rsplit(", ").next().unwrap_or_default();
        let named = if row.text(6).is_empty() { line.to_string() } else { shortened(row.text(6)) };
        add(&mut cameras, camera, Pair { name: named, point, pixel });
        Ok(())
    })?;
    if cameras.is_empty() {
        bail!("{name} holds no pair, expected a row for every point that a camera sees");
    }
    Ok(cameras)
}

/// Puts a pair to those of its camera.
pub(super) fn add(cameras: &mut Vec<CameraPairs>, camera: &str, pair: Pair) {
    match cameras.iter_mut().find(|known| known.camera == camera) {
        Some(known) => known.pairs.push(pair),
        None => cameras.push(CameraPairs { camera: camera.to_string(), pairs: vec![pair] }),
    }
}

/// A camera's name, which ends up in a file of cameras.
pub(super) fn camera_name<'a>(row: &'a Row, column: usize) -> Result<&'a str> {
    let camera = row.text(column);
    let is_name = !camera.is_empty()
        && !matches!(camera, "." | ".." | "metadata")
        && !camera.chars().any(|c| c.is_control() || "/\\".contains(c));
    ensure!(
        is_name,
        "{}: column camera: found `{}`, expected a name that can be part of a file's",
        row.place,
        shortened(camera)
    );
    Ok(camera)
}

/// A place in a picture; None where both cells are empty.
pub(super) fn pixel(row: &Row, [u, v]: [usize; 2]) -> Result<Option<DVec2>> {
    if row.text(u).is_empty() && row.text(v).is_empty() {
        return Ok(None);
    }
    let pixel = DVec2::new(row.number(u, "u")?, row.number(v, "v")?);
    ensure!(
        pixel.abs().max_element() <= LARGEST_PIXEL,
        "{}: found ({}, {}) as the pixel, expected one near the picture",
        row.place,
        pixel.x,
        pixel.y
    );
    Ok(Some(pixel))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: &str = "camera,x,y,z,u,v,point\na,1,2,3,10,20,top\nb,1,2,3,11,21,\na,4,5,6,,,left\na,7,8,9,12,22,\n";

    #[test]
    fn columns_in_any_order_and_units() {
        let cameras = parse_pairs(SMALL, "p.csv", 1000.0).unwrap();
        assert_eq!(
            cameras.iter().map(|c| (c.camera.as_str(), c.pairs.len())).collect::<Vec<_>>(),
            [("a", 2), ("b", 1)]
        );
        assert_eq!(cameras[0].pairs[0].point, DVec3::new(1000.0, 2000.0, 3000.0));
        assert_eq!(cameras[0].pairs[1].pixel, DVec2::new(12.0, 22.0));
        let names: Vec<&str> = cameras.iter().flat_map(|c| &c.pairs).map(|pair| pair.name.as_str()).collect();
        assert_eq!(names, ["top", "line 5", "line 3"]);
        let turned = parse_pairs("v,u,Z,y,x,camera\n20,10,3,2,1,a\n", "p.csv", 1.0).unwrap();
        assert_eq!(
            (turned[0].pairs[0].point, turned[0].pairs[0].pixel),
            (DVec3::new(1.0, 2.0, 3.0), DVec2::new(10.0, 20.0))
        );
    }

    #[test]
    fn each_fault_is_one_sentence() {
        let cases = [
            (String::new(), "is empty, expected a table with the columns camera, x, y, z, u, v"),
            ("camera,x,y,z,u\n".into(), "line 1: there is no column `v`"),
            ("camera,x,y,z,u,v,u\n".into(), "line 1: there are two columns `u`"),
            ("camera,x,y,z,u,v,weight\n".into(), "found the column `weight`, expected"),
            ("camera,x,y,z,u,v\n".into(), "holds no pair"),
            ("camera,x,y,z,u,v\na,1,2,3,,\n".into(), "holds no pair"),
            (SMALL.replace("11,21", "11"), "line 3: found 6 cells, expected 7"),
            (SMALL.replace("11,21", "11,"), "line 3: column v: found ``, expected a number"),
            (SMALL.replace("11,21", "nan,21"), "line 3: column u: found `nan`, expected a finite number"),
            (SMALL.replace("11,21", "1e9,21"), "expected one near the picture"),
            (SMALL.replace("b,1,", "b,1e30,"), "below 1e9 mm"),
            (SMALL.replace("b,1,", ",1,"), "line 3: column camera: found ``"),
            (SMALL.replace("b,1,", "../b,1,"), "column camera: found `../b`"),
        ];
        for (text, expected) in cases {
            let message = format!("{:#}", parse_pairs(&text, "p.csv", 1.0).unwrap_err());
            assert!(message.contains(expected) && message.starts_with("p.csv"), "{message}\nshould say: {expected}");
        }
    }
}
