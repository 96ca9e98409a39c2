//! The distance of every pixel from the nearest edge (METHOD A5.3).

mod euclidean;
mod metric;
mod steps;

use image::GrayImage;

pub use metric::Metric;

use self::euclidean::Envelope;
use super::BitImage;

/// Distances, exact up to a limit and equal to it from there on: nothing that reads the map tells farther pixels
/// apart, and so most of a picture need not be visited. They are kept as the whole numbers of [`Metric::code`].
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct DistanceMap {
    width: u32,
    height: u32,
    limit: u8,
    metric: Metric,
    /// Of the metrics whose codes are the distances themselves.
    bytes: Vec<u8>,
    /// Of the others.
    codes: Vec<u32>,
    envelope: Envelope,
}

/// A row or all of a map's codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Codes<'a> {
    /// Chessboard and city-block distances, pixels.
    Bytes(&'a [u8]),
    /// Squared Euclidean distances, or quasi-Euclidean ones in 408ths.
    Words(&'a [u32]),
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

    /// The metric it was measured by.
    pub fn metric(&self) -> Metric {
        self.metric
    }

    /// Row-major codes.
    pub fn codes(&self) -> Codes<'_> {
        match self.metric {
            Metric::Chessboard | Metric::CityBlock => Codes::Bytes(&self.bytes),
            Metric::Euclidean | Metric::QuasiEuclidean => Codes::Words(&self.codes),
        }
    }

    /// The codes of one row.
    pub(super) fn row(&self, y: usize) -> Codes<'_> {
        let width = self.width as usize;
        match self.codes() {
            Codes::Bytes(bytes) => Codes::Bytes(&bytes[y * width..][..width]),
            Codes::Words(codes) => Codes::Words(&codes[y * width..][..width]),
        }
    }

    /// The code of each pixel.
    fn each_code(&self) -> impl Iterator<Item = u32> {
        let (bytes, words): (&[u8], &[u32]) = match self.codes() {
            Codes::Bytes(bytes) => (bytes, &[]),
            Codes::Words(words) => (&[], words),
        };
        bytes.iter().map(|&byte| u32::from(byte)).chain(words.iter().copied())
    }

    /// Row-major distances, pixels.
    pub fn distances(&self) -> Vec<f32> {
        self.each_code().map(|code| self.metric.distance(code)).collect()
    }

    /// White on the edges, black at the limit.
    pub fn to_gray(&self) -> GrayImage {
        let limit = f32::from(self.limit.max(1));
        let mut image = GrayImage::new(self.width, self.height);
        for (pixel, code) in image.iter_mut().zip(self.each_code()) {
            *pixel = 255 - (self.metric.distance(code).min(limit) * 255.0 / limit) as u8;
        }
        image
    }

    /// Takes a map that was measured elsewhere: a code for each of `width * height` pixels.
    pub(super) fn take_codes(&mut self, [width, height]: [u32; 2], metric: Metric, limit: u8, codes: &[u32]) {
        (self.width, self.height, self.limit, self.metric) = (width, height, limit, metric);
        match metric {
            Metric::Chessboard | Metric::CityBlock => {
                self.bytes.clear();
                self.bytes.extend(codes.iter().map(|&code| code as u8));
            }
            Metric::Euclidean | Metric::QuasiEuclidean => {
                self.codes.clear();
                self.codes.extend_from_slice(codes);
            }
        }
    }

    /// Measures `min(distance to the nearest pixel of edges, limit)` for every pixel; everywhere `limit` when there is
    /// no edge. The time is linear in the pixels nearer than the limit to the edges' bounding box.
    pub fn measure(&mut self, edges: &BitImage, metric: Metric, limit: u8) {
        let width = edges.width() as usize;
        let pixels = width * edges.height() as usize;
        (self.width, self.height, self.limit, self.metric) = (edges.width(), edges.height(), limit, metric);
        match metric {
            Metric::Chessboard | Metric::CityBlock => refill(&mut self.bytes, pixels, limit),
            Metric::Euclidean | Metric::QuasiEuclidean => refill(&mut self.codes, pixels, metric.code(limit)),
        }
        let Some(bounds) = edges.bounds() else { return };
        let window = bounds.enlarged(u32::from(limit), edges.width(), edges.height());
        let (columns, rows) = ([window.x0 as usize, window.x1 as usize], [window.y0 as usize, window.y1 as usize]);
        match metric {
            Metric::Chessboard | Metric::CityBlock => mark(&mut self.bytes, edges),
            Metric::Euclidean | Metric::QuasiEuclidean => mark(&mut self.codes, edges),
        }
        match metric {
            Metric::Chessboard => steps::two_passes::<steps::Unit<true>>(&mut self.bytes, width, columns, rows),
            Metric::CityBlock => steps::two_passes::<steps::Unit<false>>(&mut self.bytes, width, columns, rows),
            Metric::Euclidean => self.envelope.squared(&mut self.codes, width, columns, rows, u32::from(limit)),
            Metric::QuasiEuclidean => steps::two_passes::<steps::QuasiEuclidean>(&mut self.codes, width, columns, rows),
        }
    }
}

/// Makes `values` `pixels` times `value`.
fn refill<T: Copy>(values: &mut Vec<T>, pixels: usize, value: T) {
    values.clear();
    values.resize(pixels, value);
}

/// Writes zero on every edge.
fn mark<T: Copy + Default>(values: &mut [T], edges: &BitImage) {
    let width = edges.width() as usize;
    edges.for_each_run(|y, columns| values[y * width..][columns].fill(T::default()));
}

#[cfg(test)]
mod tests {
    use super::super::bit_image::any_bit_image;
    use super::*;
    use proptest::prelude::*;

    /// The definition: the smallest distance over all edge pixels, in whole numbers that are compared as it is.
    fn brute_force(edges: &BitImage, metric: Metric, limit: u8) -> Vec<u32> {
        let all = || (0..edges.height()).flat_map(|y| (0..edges.width()).map(move |x| (x, y)));
        let set: Vec<(u32, u32)> = all().filter(|&(x, y)| edges.get(x, y)).collect();
        let code = |dx: u32, dy: u32| match metric {
            Metric::Chessboard => dx.max(dy),
            Metric::CityBlock => dx + dy,
            Metric::Euclidean => dx * dx + dy * dy,
            Metric::QuasiEuclidean => 408 * (dx.max(dy) - dx.min(dy)) + 577 * dx.min(dy),
        };
        all()
            .map(|(x, y)| {
                let nearest = set.iter().map(|&(ex, ey)| code(ex.abs_diff(x), ey.abs_diff(y))).min();
                nearest.unwrap_or(u32::MAX).min(metric.code(limit))
            })
            .collect()
    }

    fn codes(map: &DistanceMap) -> Vec<u32> {
        map.each_code().collect()
    }

    proptest! {
        // Every pixel against every edge, four times a case.
        #![proptest_config(ProptestConfig::with_cases(96))]

        #[test]
        fn every_metric_matches_brute_force(edges in any_bit_image(), limit in prop_oneof![1_u8..12, Just(255)]) {
            let mut map = DistanceMap::default();
            for metric in Metric::ALL {
                map.measure(&edges, metric, limit);
                prop_assert_eq!(codes(&map), brute_force(&edges, metric, limit), "{:?}", metric);
            }
        }

        #[test]
        fn quasi_euclidean_distances_are_the_formula_s(edges in any_bit_image()) {
            let mut map = DistanceMap::default();
            map.measure(&edges, Metric::QuasiEuclidean, 255);
            let all = || (0..edges.height()).flat_map(|y| (0..edges.width()).map(move |x| (x, y)));
            let set: Vec<(u32, u32)> = all().filter(|&(x, y)| edges.get(x, y)).collect();
            for ((x, y), found) in all().zip(map.distances()) {
                let each = set.iter().map(|&(ex, ey)| {
                    let (dx, dy) = (f64::from(ex.abs_diff(x)), f64::from(ey.abs_diff(y)));
                    (std::f64::consts::SQRT_2 - 1.0) * dx.min(dy) + dx.max(dy)
                });
                let expected = each.fold(255.0, f64::min);
                prop_assert!((f64::from(found) - expected).abs() < 1e-4, "({}, {}): {} and {}", x, y, found, expected);
            }
        }
    }

    #[test]
    fn sparse_edges_match_and_a_changed_pixel_shows() {
        let mut edges = BitImage::from_fn(150, 60, |x, y| (x, y) == (30, 12) || (x, y) == (149, 59));
        let mut map = DistanceMap::default();
        for metric in Metric::ALL {
            for limit in [1, 2, 40, 255] {
                map.measure(&edges, metric, limit);
                assert_eq!(codes(&map), brute_force(&edges, metric, limit), "{metric:?}, limit {limit}");
            }
        }
        map.measure(&edges, Metric::Euclidean, 255);
        edges.set(80, 20, true);
        assert_ne!(codes(&map), brute_force(&edges, Metric::Euclidean, 255));
    }

    #[test]
    fn no_edge_is_far_everywhere() {
        let mut map = DistanceMap::default();
        for metric in Metric::ALL {
            map.measure(&BitImage::new(7, 3), metric, 16);
            assert_eq!(map.distances(), [16.0; 21]);
            assert!(map.to_gray().iter().all(|&value| value == 0));
        }
    }
}
