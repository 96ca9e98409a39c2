//! A material on a person under one diffuse light.

use std::path::Path;

use anyhow::Result;
use glam::{DVec2, DVec3};

use super::figure::{Figure, Wardrobe};
use super::performance::standing;
use super::render::{Candidate, Cast};
use super::solid::Ray;
use crate::body::{Body, MeshSource, Skinning};
use crate::texture::painter::Painter;
use crate::texture::picture::{Picture, SAMPLES, Seen};

/// Height of the person, mm.
const HEIGHT: f64 = 1750.0;

/// Pixels a side of the tiles that primitives are sorted into, as parts of the picture's shorter side.
const CELLS: usize = 48;

/// A person, of ellipsoids and capsules or a skinned glTF one, cut out of a material; `scale` is units of the material a unit of
/// the object, which is half of the person's height. He stands with his face to the right of the eye.
///
/// # Errors
/// When the glTF file cannot be read or does not fit the body, or the device that draws fails.
pub fn portrait(
    painter: &Painter<'_>,
    file: Option<&Path>,
    size: [u32; 2],
    offset: [f32; 3],
    scale: f32,
) -> Result<Picture> {
    let mut body = Body::adult(HEIGHT)?;
    let figure = match file {
        None => Figure::of_solids(&body, HEIGHT, Wardrobe::default())?,
        Some(file) => {
            let (skinning, joints) = (Skinning::default(), Default::default());
            body.mesh = Some(MeshSource::Skinned { file: file.to_path_buf(), skinning, joints });
            Figure::of_mesh(&body, Wardrobe::default())?
        }
    };
    // The eye looks along +y, x to the right and z up.
    let figures = [figure.place(&standing(&body, DVec2::ZERO, -55_f64.to_radians()))?];
    let cast = Cast::new(&figures, None)?;
    let to_light = DVec3::new(-0.45, -0.66, 0.6).normalize();
    let middle = DVec3::new(0.0, 0.0, 0.5 * HEIGHT);
    let unit = 0.5 * HEIGHT;
    // Half of the picture's shorter side shows a little more than half of the person.
    let reach = 1.08 * unit;
    let cells = Cells::new(&cast, middle, reach);
    let pixel = scale * 2.0 * (reach / unit) as f32 / size[0].min(size[1]) as f32;
    painter.shown(size, painter.material().samples(pixel, SAMPLES), |u, v| {
        let at = DVec2::new(f64::from(u), f64::from(v)) * reach;
        let ray = Ray { origin: middle + DVec3::new(at.x, -2.0 * HEIGHT, at.y), direction: DVec3::Y };
        let meeting = cast.first_meeting(&ray, cells.at(at))?;
        let p = (meeting.point - middle) / unit;
        // Materials lie in their x and y: across and up the picture.
        let object = [p.x, p.z, -p.y].map(|x| x as f32);
        Some(Seen {
            point: std::array::from_fn(|axis| object[axis] * scale + offset[axis]),
            cosine: meeting.normal.dot(to_light) as f32,
        })
    })
}

/// The person's primitives by where they are seen.
struct Cells {
    reach: f64,
    lists: Vec<Vec<Candidate>>,
}

impl Cells {
    fn new(cast: &Cast<'_>, middle: DVec3, reach: f64) -> Self {
        let mut cells = Self { reach, lists: vec![Vec::new(); CELLS * CELLS] };
        for (index, primitive) in cast.members[0].figure.primitives.iter().enumerate() {
            let [(a, radius_a), (b, radius_b)] = primitive.bounding_balls();
            let seen = |at: DVec3| DVec2::new(at.x - middle.x, at.z - middle.z);
            let low = (seen(a) - radius_a).min(seen(b) - radius_b);
            let high = (seen(a) + radius_a).max(seen(b) + radius_b);
            let ([left, bottom], [right, top]) = (cells.cell(low), cells.cell(high));
            for y in bottom..=top {
                for x in left..=right {
                    cells.lists[y * CELLS + x].push((0, index as u32));
                }
            }
        }
        cells
    }

    fn cell(&self, at: DVec2) -> [usize; 2] {
        ((at / self.reach + 1.0) * 0.5 * CELLS as f64).to_array().map(|x| (x.max(0.0) as usize).min(CELLS - 1))
    }

    fn at(&self, at: DVec2) -> &[Candidate] {
        let [x, y] = self.cell(at);
        &self.lists[y * CELLS + x]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::materials::{Material, Parameters};

    #[test]
    fn a_person_is_cut_out_of_the_material() {
        let brick = Material::new("brick", Parameters::Defaults, 1, None).unwrap();
        let brick = Painter::new(&brick, None).unwrap();
        let picture = portrait(&brick, None, [120, 90], [0.0; 3], 1.0).unwrap();
        let background = *picture.get_pixel(0, 0);
        let shown: Vec<_> = picture.enumerate_pixels().filter(|(_, _, pixel)| **pixel != background).collect();
        // A slim figure from near the top to near the bottom, of many colours.
        assert!((400..2500).contains(&shown.len()), "{}", shown.len());
        let rows = shown.iter().map(|(_, y, _)| *y);
        assert!(rows.clone().min().unwrap() < 8 && rows.max().unwrap() > 80);
        let colours: std::collections::HashSet<_> = shown.iter().map(|(_, _, pixel)| pixel.0).collect();
        assert!(colours.len() > 100, "{}", colours.len());
        let error = portrait(&brick, Some(Path::new("nobody.glb")), [9, 9], [0.0; 3], 1.0).unwrap_err();
        assert!(format!("{error:#}").contains("nobody.glb"), "{error:#}");
    }
}
