//! The distance of every pixel from the nearest edge (SPEC A5.3).

use image::GrayImage;

use super::BitImage;

/// Chessboard distances (pixels), exact up to a limit and equal to it from there on: nothing that reads the map
/// tells farther pixels apart, and so most of a picture need not be visited.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct DistanceMap {
    width: u32,
    height: u32,
    limit: u8,
    values: Vec<u8>,
}

impl DistanceMap {
    /// Width, pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height, pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Row-major distances, pixels.
    pub fn values(&self) -> &[u8] {
        &self.values
    }

    /// The distances of one row.
    pub(super) fn row(&self, y: usize) -> &[u8] {
        &self.values[y * self.width as usize..][..self.width as usize]
    }

    /// White on the edges, black at the limit.
    pub fn to_gray(&self) -> GrayImage {
        let limit = u32::from(self.limit.max(1));
        let mut image = GrayImage::new(self.width, self.height);
        for (pixel, &value) in image.iter_mut().zip(&self.values) {
            *pixel = (255 - u32::from(value).min(limit) * 255 / limit) as u8;
        }
        image
    }

    /// Measures `min(distance to the nearest pixel of edges, limit)` for every pixel; everywhere `limit` when there is
    /// no edge.
    pub fn measure(&mut self, edges: &BitImage, limit: u8) {
        let width = edges.width() as usize;
        (self.width, self.height, self.limit) = (edges.width(), edges.height(), limit);
        self.values.clear();
        self.values.resize(width * edges.height() as usize, limit);
        let Some(bounds) = edges.bounds() else { return };
        let window = bounds.enlarged(u32::from(limit), edges.width(), edges.height());
        let (x0, x1) = (window.x0 as usize, window.x1 as usize);
        edges.for_each_run(|y, columns| self.values[y * width..][columns].fill(0));
        // Down, then up. A chessboard step reaches all eight neighbours, so the row before gives its minimum over
        // three columns (vector code), and what is left to carry runs along the row.
        for y in window.y0 as usize..window.y1 as usize {
            if y > window.y0 as usize {
                let (before, from_here) = self.values.split_at_mut(y * width);
                take_row(&mut from_here[x0..x1], &before[(y - 1) * width..][x0..x1]);
            }
            carry_right(&mut self.values[y * width..][x0..x1]);
        }
        for y in (window.y0 as usize..window.y1 as usize).rev() {
            if y + 1 < window.y1 as usize {
                let (to_here, after) = self.values.split_at_mut((y + 1) * width);
                take_row(&mut to_here[y * width..][x0..x1], &after[x0..x1]);
            }
            carry_left(&mut self.values[y * width..][x0..x1]);
        }
    }
}

/// One step from the neighbouring row: `here = min(here, 1 + minimum of the three pixels beside it)`.
fn take_row(here: &mut [u8], beside: &[u8]) {
    let step = |value: &mut u8, a: u8, b: u8, c: u8| *value = (*value).min(a.min(b).min(c).saturating_add(1));
    let width = here.len();
    if width < 2 {
        if let (Some(value), Some(&b)) = (here.first_mut(), beside.first()) {
            step(value, b, b, b);
        }
        return;
    }
    step(&mut here[0], beside[0], beside[0], beside[1]);
    step(&mut here[width - 1], beside[width - 2], beside[width - 1], beside[width - 1]);
    for (value, window) in here[1..width - 1].iter_mut().zip(beside.windows(3)) {
        step(value, window[0], window[1], window[2]);
    }
}

fn carry_right(row: &mut [u8]) {
    let mut nearest = u8::MAX;
    for value in row {
        nearest = nearest.saturating_add(1).min(*value);
        *value = nearest;
    }
}

fn carry_left(row: &mut [u8]) {
    let mut nearest = u8::MAX;
    for value in row.iter_mut().rev() {
        nearest = nearest.saturating_add(1).min(*value);
        *value = nearest;
    }
}

#[cfg(test)]
mod tests {
    use super::super::bit_image::any_bit_image;
    use super::*;
    use proptest::prelude::*;

    /// The definition: the smallest max(|dx|, |dy|) over all edge pixels.
    fn brute_force(edges: &BitImage, limit: u8) -> Vec<u8> {
        let all = || (0..edges.height()).flat_map(|y| (0..edges.width()).map(move |x| (x, y)));
        let set: Vec<(u32, u32)> = all().filter(|&(x, y)| edges.get(x, y)).collect();
        all()
            .map(|(x, y)| {
                let nearest = set.iter().map(|&(ex, ey)| ex.abs_diff(x).max(ey.abs_diff(y))).min();
                nearest.unwrap_or(u32::MAX).min(u32::from(limit)) as u8
            })
            .collect()
    }

    proptest! {
        #[test]
        fn matches_brute_force(edges in any_bit_image(), limit in prop_oneof![1_u8..12, Just(255)]) {
            let mut map = DistanceMap::default();
            map.measure(&edges, limit);
            prop_assert_eq!(map.values(), &brute_force(&edges, limit)[..]);
        }
    }

    #[test]
    fn sparse_edges_match_and_a_changed_pixel_shows() {
        let mut edges = BitImage::from_fn(150, 60, |x, y| (x, y) == (30, 12) || (x, y) == (149, 59));
        let mut map = DistanceMap::default();
        for limit in [1, 2, 40, 255] {
            map.measure(&edges, limit);
            assert_eq!(map.values(), brute_force(&edges, limit), "limit {limit}");
        }
        edges.set(80, 20, true);
        assert_ne!(map.values(), brute_force(&edges, 255));
    }

    #[test]
    fn no_edge_is_far_everywhere() {
        let mut map = DistanceMap::default();
        map.measure(&BitImage::new(7, 3), 16);
        assert!(map.values().iter().all(|&value| value == 16));
        assert!(map.to_gray().iter().all(|&value| value == 0));
    }
}
