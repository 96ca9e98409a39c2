//! The flat model drawn by the definitions of `docs/RASTER.md`, pixel by pixel, in exact integers.

use super::projection::PartQuad;

/// A drawn candidate in one view: one byte a pixel, bits 0..=6 the label of the visible part (0 = nothing), bit 7 a
/// visible edge (METHOD A6).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CandidateImage {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// Row-major bytes.
    pub bytes: Vec<u8>,
}

/// Draws parts given as snapped corners; `labels` has one label a part.
pub fn draw_quads(quads: &[PartQuad], labels: &[u8], width: u32, height: u32) -> CandidateImage {
    let mut image = CandidateImage { width, height, bytes: vec![0; width as usize * height as usize] };
    let mut farthest_first: Vec<usize> = (0..quads.len()).filter(|&part| quads[part].drawn).collect();
    // A stable sort keeps parts of equal depth in the body's order: the later one is painted over the earlier one.
    farthest_first.sort_by(|&l, &r| quads[r].depth_squared.total_cmp(&quads[l].depth_squared));
    for part in farthest_first {
        // A nearer fill covers what is there, its edges included; then its own border is drawn over everything.
        for_each_fill_pixel(&quads[part].corners, width, height, |pixel| image.bytes[pixel] = labels[part]);
        for_each_border_pixel(&quads[part].corners, width, height, |pixel| {
            image.bytes[pixel] = labels[part] | 0x80;
        });
    }
    image
}

/// Calls `paint` with the index of every pixel whose centre lies in the part: in the pixel's row, at or right of the
/// leftmost crossing of the outline with the line through the row's pixel centres, and left of the rightmost one.
fn for_each_fill_pixel(corners: &[[i32; 2]; 4], width: u32, height: u32, mut paint: impl FnMut(usize)) {
    for y in 0..i64::from(height) {
        let centre_y = 256 * y;
        let crossing_edges: Vec<([i64; 2], [i64; 2])> = (0..4)
            .map(|corner| (corners[corner].map(i64::from), corners[(corner + 1) % 4].map(i64::from)))
            .map(|(p, q)| if p[1] <= q[1] { (p, q) } else { (q, p) })
            .filter(|(top, bottom)| top[1] <= centre_y && centre_y < bottom[1])
            .collect();
        if crossing_edges.is_empty() {
            continue;
        }
        for x in 0..i64::from(width) {
            let centre_x = 256 * x;
            // The crossing is at top.x + dx (centre_y - top.y) / dy; both sides times dy, which is positive.
            let is_at_or_right_of = |&(top, bottom): &([i64; 2], [i64; 2])| {
                (centre_x - top[0]) * (bottom[1] - top[1]) >= (bottom[0] - top[0]) * (centre_y - top[1])
            };
            if crossing_edges.iter().any(is_at_or_right_of) && !crossing_edges.iter().all(is_at_or_right_of) {
                paint((y * i64::from(width) + x) as usize);
            }
        }
    }
}

/// Calls `paint` with the index of every pixel of the part's four border lines.
fn for_each_border_pixel(corners: &[[i32; 2]; 4], width: u32, height: u32, mut paint: impl FnMut(usize)) {
    for corner in 0..4 {
        let ends = [corners[corner], corners[(corner + 1) % 4]];
        for_each_line_pixel(ends, width, height, |pixel, _| paint(pixel));
    }
}

/// Calls `paint` with the index of every pixel of the line between two snapped corners that lies in the picture, and with how
/// far along it is from the first end to the second: so many of so many steps of the longer side.
pub(super) fn for_each_line_pixel(
    ends: [[i32; 2]; 2],
    width: u32,
    height: u32,
    mut paint: impl FnMut(usize, [i64; 2]),
) {
    let [p, q] = ends.map(|end| end.map(|c| i64::from(c + 128).div_euclid(256)));
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    let mut paint_inside = |x: i64, y: i64, step: i64, steps: i64| {
        if (0..i64::from(width)).contains(&x) && (0..i64::from(height)).contains(&y) {
            paint((y * i64::from(width) + x) as usize, [step.abs(), steps.abs()]);
        }
    };
    if dx.abs() >= dy.abs() {
        for x in p[0].min(q[0])..=p[0].max(q[0]) {
            paint_inside(x, p[1] + nearest(dy * (x - p[0]), dx), x - p[0], dx);
        }
    } else {
        for y in p[1].min(q[1])..=p[1].max(q[1]) {
            paint_inside(p[0] + nearest(dx * (y - p[1]), dy), y, y - p[1], dy);
        }
    }
}

/// `numerator / denominator` to the nearest integer, a tie to the larger; 0/0 is 0.
fn nearest(numerator: i64, denominator: i64) -> i64 {
    match denominator.signum() {
        0 => 0,
        sign => (2 * numerator * sign + denominator.abs()).div_euclid(2 * denominator.abs()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A part with the given corners in pixels, at a depth.
    fn part(corners: [[f64; 2]; 4], depth_squared: f32) -> PartQuad {
        PartQuad { corners: corners.map(|c| c.map(|v| (v * 256.0).round() as i32)), depth_squared, drawn: true }
    }

    fn rows(image: &CandidateImage) -> Vec<String> {
        let symbol = |byte: &u8| match byte {
            0 => '.',
            byte if byte & 0x80 != 0 => '#',
            _ => 'o',
        };
        image.bytes.chunks(image.width as usize).map(|row| row.iter().map(symbol).collect()).collect()
    }

    #[test]
    fn a_square_covers_the_pixels_whose_centres_it_holds() {
        let square = part([[1.0, 1.0], [5.0, 1.0], [5.0, 4.0], [1.0, 4.0]], 1.0);
        let image = draw_quads(&[square], &[9], 8, 6);
        assert_eq!(rows(&image), ["........", ".#####..", ".#ooo#..", ".#ooo#..", ".#####..", "........"]);
        // Fill alone: left and top included, right and bottom excluded, centred on the border's outline.
        let mut filled = Vec::new();
        for_each_fill_pixel(&square.corners, 8, 6, |pixel| filled.push(pixel));
        let expected: Vec<usize> = (1..4).flat_map(|y| (1..5).map(move |x| y * 8 + x)).collect();
        assert_eq!(filled, expected);
    }

    #[test]
    fn a_nearer_fill_hides_a_border_and_a_nearer_border_does_not_hide_a_fill() {
        let far = part([[0.0, 2.0], [7.0, 2.0], [7.0, 4.0], [0.0, 4.0]], 9.0);
        let near = part([[2.0, 0.0], [5.0, 0.0], [5.0, 5.0], [2.0, 5.0]], 1.0);
        let expected = ["..####..", "..#oo#..", "###oo###", "#o#oo#o#", "###oo###", "..####.."];
        assert_eq!(rows(&draw_quads(&[far, near], &[1, 2], 8, 6)), expected);
        assert_eq!(rows(&draw_quads(&[near, far], &[2, 1], 8, 6)), expected, "the order of parts plays no role");
        // At equal depth the later one is nearer.
        let level = PartQuad { depth_squared: 1.0, ..far };
        assert_eq!(rows(&draw_quads(&[near, level], &[2, 1], 8, 6))[3], "#oooooo#");
    }

    #[test]
    fn ties_of_a_line_go_to_the_larger_coordinate() {
        // Two columns a row: half-way columns belong to the lower row.
        let mut drawn = Vec::new();
        let line = [[0, 0], [4 * 256, 2 * 256], [4 * 256, 2 * 256], [4 * 256, 2 * 256]];
        for_each_border_pixel(&line, 5, 3, |pixel| drawn.push((pixel % 5, pixel / 5)));
        drawn.sort_unstable();
        drawn.dedup();
        assert_eq!(drawn, [(0, 0), (1, 1), (2, 1), (3, 2), (4, 2)]);
    }
}
