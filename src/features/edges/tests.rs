//! Every operator against its definition, by direct convolution of whole pictures.

use super::*;
use image::Rgb;
use proptest::prelude::*;

fn convolved(image: &[i32], width: i32, height: i32, kernel: [[i32; 3]; 3]) -> Vec<i32> {
    let at = |x: i32, y: i32| image[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize];
    let mut result = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let mut sum = 0;
            for (dy, row) in (-1..).zip(kernel) {
                for (dx, weight) in (-1..).zip(row) {
                    sum += weight * at(x + dx, y + dy);
                }
            }
            result.push(sum);
        }
    }
    result
}

const SOBEL: [[i32; 3]; 3] = [[-1, 0, 1], [-2, 0, 2], [-1, 0, 1]];
const PREWITT: [[i32; 3]; 3] = [[-1, 0, 1], [-1, 0, 1], [-1, 0, 1]];
const LAPLACE: [[[i32; 3]; 3]; 3] =
    [[[0, 1, 0], [1, -4, 1], [0, 1, 0]], [[1, 1, 1], [1, -8, 1], [1, 1, 1]], [[1, -2, 1], [-2, 4, -2], [1, -2, 1]]];

fn transposed(kernel: [[i32; 3]; 3]) -> [[i32; 3]; 3] {
    [0, 1, 2].map(|row| [0, 1, 2].map(|column: usize| kernel[column][row]))
}

/// The edges by the definitions, over the whole picture with the masks written out.
fn expected(picture: &RgbImage, within: &BitImage, settings: &EdgeSettings) -> BitImage {
    let (width, height) = (picture.width() as i32, picture.height() as i32);
    let mut gray: Vec<i32> =
        picture.pixels().map(|p| (77 * i32::from(p[0]) + 151 * i32::from(p[1]) + 28 * i32::from(p[2])) / 256).collect();
    if settings.smooth {
        let sums = convolved(&gray, width, height, [[1, 2, 1], [2, 4, 2], [1, 2, 1]]);
        gray = sums.iter().map(|sum| (sum + 8) / 16).collect();
    }
    let filtered = |kernel| convolved(&gray, width, height, kernel);
    let (gx, gy) = match settings.operator {
        Operator::Prewitt => (filtered(PREWITT), filtered(transposed(PREWITT))),
        Operator::Roberts => {
            (filtered([[0, 0, 0], [0, 1, 0], [0, 0, -1]]), filtered([[0, 0, 0], [0, 0, 1], [0, -1, 0]]))
        }
        _ => (filtered(SOBEL), filtered(transposed(SOBEL))),
    };
    let strength = |x: i32, y: i32| {
        if x < 0 || y < 0 || x >= width || y >= height {
            return 0.0;
        }
        let at = (y * width + x) as usize;
        let (gx, gy) = (f64::from(gx[at]), f64::from(gy[at]));
        match settings.magnitude {
            Magnitude::Exact => gx.hypot(gy),
            Magnitude::Sum => gx.abs() + gy.abs(),
            Magnitude::Max => gx.abs().max(gy.abs()),
        }
    };
    let threshold = f64::from(settings.threshold);
    let inside = |holds: &dyn Fn(i32, i32) -> bool| {
        BitImage::from_fn(picture.width(), picture.height(), |x, y| within.get(x, y) && holds(x as i32, y as i32))
    };
    match settings.operator {
        Operator::Sobel | Operator::Prewitt | Operator::Roberts => inside(&|x, y| strength(x, y) >= threshold),
        Operator::LaplaceFour => inside(&crossings(&filtered(LAPLACE[0]), width, height, settings.threshold)),
        Operator::LaplaceEight => inside(&crossings(&filtered(LAPLACE[1]), width, height, settings.threshold)),
        Operator::LaplaceProduct => inside(&crossings(&filtered(LAPLACE[2]), width, height, settings.threshold)),
        Operator::Canny => {
            let thin = |x: i32, y: i32| {
                let at = (y * width + x) as usize;
                // Which eighth of the circle the direction is in, by its angle.
                let eighth = (f64::from(gy[at]).atan2(f64::from(gx[at])) / std::f64::consts::FRAC_PI_4).round() as i32;
                let (dx, dy) = [(1, 0), (1, 1), (0, 1), (-1, 1)][eighth.rem_euclid(4) as usize];
                strength(x, y) > strength(x - dx, y - dy) && strength(x, y) >= strength(x + dx, y + dy)
            };
            let strong = inside(&|x, y| thin(x, y) && strength(x, y) >= threshold);
            let mut linked = strong.clone();
            let weak = inside(&|x, y| thin(x, y) && strength(x, y) >= f64::from(settings.low));
            // Grown by one pixel at a time until nothing changes.
            loop {
                let before = linked.clone();
                for y in 0..height {
                    for x in 0..width {
                        let beside = (-1..=1).any(|dy| {
                            (-1..=1).any(|dx| {
                                let (x, y) = (x + dx, y + dy);
                                x >= 0 && y >= 0 && before.get(x as u32, y as u32)
                            })
                        });
                        if beside && weak.get(x as u32, y as u32) {
                            linked.set(x as u32, y as u32, true);
                        }
                    }
                }
                if linked == before {
                    return linked;
                }
            }
        }
    }
}

/// Where responses cross zero: each pair of neighbours marks one of its two, and zeros between two opposites.
fn crossings(responses: &[i32], width: i32, height: i32, threshold: i16) -> impl Fn(i32, i32) -> bool {
    let mut marks = vec![false; responses.len()];
    let threshold = i32::from(threshold);
    let jump = |a: i32, b: i32| a.signum() * b.signum() == -1 && (a - b).abs() >= threshold;
    for y in 0..height {
        for x in 0..width {
            let at = (y * width + x) as usize;
            for (dx, dy) in [(1, 0), (0, 1)] {
                if x + dx >= width || y + dy >= height {
                    continue;
                }
                let next = ((y + dy) * width + x + dx) as usize;
                if jump(responses[at], responses[next]) {
                    marks[if responses[at].abs() <= responses[next].abs() { at } else { next }] = true;
                }
                if x >= dx && y >= dy && responses[at] == 0 {
                    marks[at] |= jump(responses[((y - dy) * width + x - dx) as usize], responses[next]);
                }
            }
        }
    }
    move |x, y| marks[(y * width + x) as usize]
}

fn any_picture() -> impl Strategy<Value = RgbImage> {
    (1_u32..90, 1_u32..12).prop_flat_map(|(width, height)| {
        proptest::collection::vec(any::<u8>(), (width * height * 3) as usize)
            .prop_map(move |bytes| RgbImage::from_raw(width, height, bytes).unwrap())
    })
}

proptest! {
    #[test]
    fn every_operator_matches_its_definition(
        picture in any_picture(),
        corners in (0_u32..90, 0_u32..90, 0_u32..12, 0_u32..12),
        (threshold, low) in (1_i16..600, 1_i16..300),
        (whole, smooth) in any::<(bool, bool)>(),
    ) {
        let (width, height) = picture.dimensions();
        let (columns, rows) = (
            corners.0.min(corners.1)..corners.0.max(corners.1),
            corners.2.min(corners.3)..corners.2.max(corners.3),
        );
        // Not a rectangle: what is kept is up to each pixel.
        let within = BitImage::from_fn(width, height, |x, y| {
            whole || columns.contains(&x) && rows.contains(&y) && (x * 7 + y * 5) % 11 > 1
        });
        let mut detector = EdgeDetector::default();
        let mut edges = BitImage::new(width, height);
        for operator in Operator::ALL {
            for magnitude in Magnitude::ALL {
                let low = low.min(threshold);
                let settings = EdgeSettings { operator, magnitude, threshold, low, smooth, ..Default::default() };
                let expected = expected(&picture, &within, &settings);
                // Twice: what the first left in the buffers must not show.
                for _ in 0..2 {
                    detector.detect(&picture, &within, &settings, &mut edges);
                    prop_assert_eq!(&edges, &expected, "{:?}", settings);
                }
            }
        }
    }
}

/// A step of 40 between columns 19 and 20, the whole picture, and settings with a threshold.
fn step() -> (RgbImage, BitImage) {
    let picture = RgbImage::from_fn(40, 9, |x, _| Rgb(if x < 20 { [20; 3] } else { [60; 3] }));
    (picture, BitImage::from_fn(40, 9, |_, _| true))
}

fn found(picture: &RgbImage, whole: &BitImage, operator: Operator, threshold: i16) -> BitImage {
    let mut edges = BitImage::new(40, 9);
    let settings = EdgeSettings { operator, threshold, ..Default::default() };
    EdgeDetector::default().detect(picture, whole, &settings, &mut edges);
    edges
}

#[test]
fn a_step_is_an_edge_and_a_changed_pixel_shows() {
    let (mut picture, whole) = step();
    let edges = found(&picture, &whole, Operator::Sobel, 120);
    assert_eq!(edges, BitImage::from_fn(40, 9, |x, _| x == 19 || x == 20), "a step of 40 has strength 120");
    assert_eq!(found(&picture, &whole, Operator::Sobel, 121), BitImage::new(40, 9));
    picture.put_pixel(5, 4, Rgb([255; 3]));
    assert_ne!(edges, found(&picture, &whole, Operator::Sobel, 120));
}

#[test]
fn a_step_s_line_is_thin_where_it_should_be() {
    let (picture, whole) = step();
    let line = BitImage::from_fn(40, 9, |x, _| x == 19);
    for operator in [Operator::Canny, Operator::LaplaceFour, Operator::LaplaceEight] {
        assert_eq!(found(&picture, &whole, operator, 20), line, "{operator:?}");
    }
    assert_eq!(found(&picture, &whole, Operator::LaplaceProduct, 1), BitImage::new(40, 9), "blind to straight steps");
}
