//! The surface of a height field as a shaded picture: a block of land, seen from above one of its corners.

use anyhow::Result;

use super::materials::Texel;
use super::painter::Painter;
use super::picture::{Picture, SAMPLES, View, rendered};
use super::solids::{dot, inside, normalised};

/// How high a height of 1 rises; half of the block's longer side is 1.
const RISE: f32 = 0.45;
/// How far the block goes down below a height of 0.
const BASE: f32 = 0.1;
/// Turn of the block about the vertical, degrees.
const TURN: f32 = 28.0;
/// How far the eye looks down, degrees.
const TILT: f32 = 36.0;
/// Distance of the eye from the block's middle.
const DISTANCE: f32 = 6.0;
/// What a picture's shorter side shows at that distance, halved.
const HALF_VIEW: f32 = 1.14;
/// Towards the light, in the block's frame: x to the right, y to the back, z up.
const LIGHT: [f32; 3] = [-0.80, 0.30, 0.52];
/// Light that reaches shadows.
const AMBIENT: f32 = 0.22;
/// Reflectance of the block's cut sides.
const CUT: [f32; 3] = [0.20, 0.16, 0.13];

/// Colours and heights at the middles of a grid's cells, rows from the back to the front.
struct Land {
    size: [usize; 2],
    /// Half lengths along x and y.
    half: [f32; 2],
    colours: Vec<[f32; 3]>,
    heights: Vec<f32>,
    highest: f32,
    to_light: [f32; 3],
}

/// The surface that a material's heights make over a checked view, in its colours, with the shadows it casts.
///
/// # Errors
/// When the device that draws colours and heights fails.
pub fn relief(painter: &Painter<'_>, view: &View) -> Result<Picture> {
    let land = Land::of(painter, view)?;
    let ((turn_sin, turn_cos), (tilt_sin, tilt_cos)) = (TURN.to_radians().sin_cos(), TILT.to_radians().sin_cos());
    // From the eye's frame (right, up, ahead) to the block's.
    let to_block = |[right, up, ahead]: [f32; 3]| {
        let (away, z) = (ahead * tilt_cos + up * tilt_sin, up * tilt_cos - ahead * tilt_sin);
        [right * turn_cos - away * turn_sin, right * turn_sin + away * turn_cos, z]
    };
    let mut eye = to_block([0.0, 0.0, -DISTANCE]);
    eye[2] += 0.3 * RISE;
    Ok(rendered(view.size, SAMPLES, |u, v| {
        let direction = to_block([u * HALF_VIEW / DISTANCE, v * HALF_VIEW / DISTANCE, 1.0]);
        land.light(eye, direction)
    }))
}

impl Land {
    fn of(painter: &Painter<'_>, view: &View) -> Result<Self> {
        let (picture, heights) = (painter.flat(view)?, painter.heights(view)?);
        let size = view.size.map(|side| side as usize);
        let longer = size[0].max(size[1]) as f32;
        let fraction = |word: u16| f32::from(word) / 65535.0;
        let heights: Vec<f32> = heights.pixels().map(|pixel| RISE * fraction(pixel[0])).collect();
        Ok(Self {
            size,
            half: size.map(|side| side as f32 / longer),
            colours: picture.pixels().map(|p| Texel { colour: p.0.map(fraction), height: 0.0 }.linear()).collect(),
            to_light: normalised(LIGHT),
            highest: heights.iter().copied().fold(0.0, f32::max),
            heights,
        })
    }

    /// Length of a cell.
    fn cell(&self) -> f32 {
        2.0 * self.half[0] / self.size[0] as f32
    }

    /// Column and row of a place, in cells from the middle of the first one.
    fn place(&self, x: f32, y: f32) -> [f32; 2] {
        let cell = self.cell();
        [(x + self.half[0]) / cell - 0.5, (self.half[1] - y) / cell - 0.5]
    }

    /// The height of a place, between the four cells about it.
    fn height(&self, x: f32, y: f32) -> f32 {
        let at = self.place(x, y);
        let side = |axis: usize| {
            let at = at[axis].clamp(0.0, self.size[axis] as f32 - 1.0);
            let low = at as usize;
            (low, (low + 1).min(self.size[axis] - 1), at - low as f32)
        };
        let ((left, right, tx), (top, bottom, ty)) = (side(0), side(1));
        let row = |y: usize| {
            let row = &self.heights[y * self.size[0]..][..self.size[0]];
            row[left] + (row[right] - row[left]) * tx
        };
        row(top) + (row(bottom) - row(top)) * ty
    }

    fn colour(&self, x: f32, y: f32) -> [f32; 3] {
        let at = self.place(x, y);
        let cell = |axis: usize| (at[axis] + 0.5).clamp(0.0, self.size[axis] as f32 - 1.0) as usize;
        self.colours[cell(1) * self.size[0] + cell(0)]
    }

    /// The light along a ray; none where it misses the block.
    fn light(&self, origin: [f32; 3], direction: [f32; 3]) -> Option<[f32; 3]> {
        let [x, y] = self.half;
        let (near, far, face) = inside([-x, -y, -BASE], [x, y, self.highest], origin, direction)?;
        let at = |t: f32| [0, 1, 2].map(|axis| origin[axis] + t * direction[axis]);
        let above = |t: f32| {
            let [x, y, z] = at(t);
            z - self.height(x, y)
        };
        if above(near) < 0.0 {
            // A side that was cut, or the ground from below.
            let mut normal = [0.0; 3];
            normal[face] = -direction[face].signum();
            return Some(CUT.map(|c| c * self.lit(at(near), normal)));
        }
        let step = 0.5 * self.cell();
        let mut before = near;
        loop {
            let t = before + step;
            if before >= far {
                return None;
            }
            if above(t.min(far)) < 0.0 {
                // Half of what is left, ten times.
                let (mut outer, mut inner) = (before, t.min(far));
                for _ in 0..10 {
                    let middle = 0.5 * (outer + inner);
                    if above(middle) < 0.0 { inner = middle } else { outer = middle }
                }
                let point = at(outer);
                let light = self.lit(point, self.normal(point));
                return Some(self.colour(point[0], point[1]).map(|c| c * light));
            }
            before = t;
        }
    }

    fn normal(&self, [x, y, _]: [f32; 3]) -> [f32; 3] {
        let step = self.cell();
        let rise = |dx: f32, dy: f32| (self.height(x + dx, y + dy) - self.height(x - dx, y - dy)) / (2.0 * step);
        let (along_x, along_y) = (rise(step, 0.0), rise(0.0, step));
        let length = (along_x * along_x + along_y * along_y + 1.0).sqrt();
        [-along_x / length, -along_y / length, 1.0 / length]
    }

    /// How much light falls on a point of the block.
    fn lit(&self, [x, y, z]: [f32; 3], normal: [f32; 3]) -> f32 {
        let cosine = dot(normal, self.to_light);
        // From a little above, so that a slope does not shade itself by the grid's steps.
        let step = self.cell();
        let mut up = step;
        let mut sun = f32::from(u8::from(cosine > 0.0));
        while sun > 0.0 && z + up * LIGHT[2] < self.highest {
            let (sx, sy) = (x + up * LIGHT[0], y + up * LIGHT[1]);
            if sx.abs() > self.half[0] || sy.abs() > self.half[1] {
                break;
            }
            // Soft: a ray that passes close above land is partly shaded, the less the farther off that is.
            let clear = (z + up * LIGHT[2] - self.height(sx, sy)) / (0.04 * up + 0.25 * step);
            sun = sun.min(1.0 + clear.min(0.0));
            up += step;
        }
        AMBIENT + (1.0 - AMBIENT) * cosine.max(0.0) * sun.max(0.0) * 1.15
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::materials::{Material, Parameters};

    /// Land stands before an empty background, its sides are cut, and what is behind a ridge from the light is darker than with the
    /// same colours laid flat.
    #[test]
    fn a_surface_is_drawn_with_its_sides_and_shadows() {
        let draw = |text: &str| {
            let table = text.parse().unwrap();
            let material = Material::new("fractal", Parameters::Table(&table), 3, None).unwrap();
            let view = View { size: [160, 120], offset: [0.0; 3], scale: 4.0 };
            relief(&Painter::new(&material, None).unwrap(), &view).unwrap()
        };
        let bands = "[map]\nbands = [{ from = 0.0, colour = [0.7, 0.7, 0.7] }]\nshading = 0.0\n";
        let (hills, plain) = (draw(bands), draw(&format!("{bands}sea = 1.0\n")));
        let background = hills.get_pixel(0, 0).0;
        let land = |picture: &Picture| picture.pixels().filter(|pixel| pixel.0 != background).count();
        assert!((5000..15000).contains(&land(&hills)), "{}", land(&hills));
        assert!(land(&plain) > 5000, "{}", land(&plain));
        let shades =
            |picture: &Picture| picture.pixels().map(|pixel| pixel.0).collect::<std::collections::HashSet<_>>().len();
        // A plain under one light has few shades: its top, two sides and their edges.
        assert!(shades(&hills) > 10 * shades(&plain), "{} and {}", shades(&hills), shades(&plain));
        // Shadows: darker than the least that the cosine leaves on a plain's top, and not a cut side, which is brown.
        let top = plain.get_pixel(80, 50).0[0];
        let shaded = hills
            .pixels()
            .filter(|pixel| pixel.0 != background && pixel[0] == pixel[2] && pixel[0] < top / 2 + top / 10);
        assert!(shaded.count() > 100);
    }
}
