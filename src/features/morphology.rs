//! Morphology on bit-packed pictures: dilation, erosion, opening, closing with square or disc elements.
//!
//! Outside the picture counts as clear for a dilation and as set for an erosion, so neither border eats into a shape.

use super::BitImage;
use crate::files::choices;

choices! {
    /// The shape of a structuring element.
    "element" pub enum Shape {
        /// All of a `size` × `size` square.
        "square" Square,
        /// The pixels of it no farther from its centre than `size / 2`.
        "disc" Disc,
    }
}

/// A structuring element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Element {
    /// Its shape.
    pub shape: Shape,
    /// Pixels from its centre to its rim; 0 leaves every picture as it is.
    pub radius: u32,
}

impl Element {
    /// Half the width of the element's row `dy` rows from its centre (`|dy| <= radius`).
    fn half_width(self, dy: u32) -> u32 {
        match self.shape {
            Shape::Square => self.radius,
            Shape::Disc => (self.radius * self.radius - dy * dy).isqrt(),
        }
    }
}

/// Scratch pictures of the operations, kept between frames.
#[derive(Clone, Debug, Default)]
pub struct Morphology {
    widened: BitImage,
    result: BitImage,
}

impl Morphology {
    /// Replaces every set pixel by the element.
    pub fn dilate(&mut self, image: &mut BitImage, element: Element) {
        if element.radius == 0 {
            return;
        }
        self.result.resize(image.width(), image.height());
        self.widened.copy_from(image);
        let mut half_width = 0;
        // From the element's narrow top row to its wide middle, the picture is widened step by step and joined into
        // the result at both of the row's offsets.
        for dy in (0..=element.radius).rev() {
            let wanted = element.half_width(dy);
            widen(&mut self.widened, wanted - half_width);
            half_width = wanted;
            // Rows follow each other, so many of them are joined as one.
            let moved = dy as usize * image.stride();
            let (into, from) = (self.result.words_mut(), self.widened.words());
            if moved < from.len() {
                let (first, last) = (&from[..from.len() - moved], &from[moved..]);
                or_words(&mut into[..last.len()], last);
                or_words(&mut into[moved..], first);
            }
        }
        std::mem::swap(image, &mut self.result);
    }

    /// Keeps the pixels around which the whole element is set.
    pub fn erode(&mut self, image: &mut BitImage, element: Element) {
        image.invert();
        self.dilate(image, element);
        image.invert();
    }

    /// Erosion, then dilation: removes what the element does not fit into.
    pub fn open(&mut self, image: &mut BitImage, element: Element) {
        self.erode(image, element);
        self.dilate(image, element);
    }

    /// Dilation, then erosion: closes gaps the element does not fit into.
    pub fn close(&mut self, image: &mut BitImage, element: Element) {
        self.dilate(image, element);
        self.erode(image, element);
    }
}

#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn or_words(into: &mut [u64], from: &[u64]) {
    into.iter_mut().zip(from).for_each(|(a, b)| *a |= b);
}

/// Extends every run by `by` pixels to both sides.
fn widen(image: &mut BitImage, by: u32) {
    let (stride, last) = (image.stride(), image.last_word());
    if by == 0 || stride == 0 {
        return;
    }
    for row in image.words_mut().chunks_exact_mut(stride) {
        let mut reached = 0;
        while reached < by {
            // What is already widened by `reached` may be moved by one more than that without leaving a gap: the reach
            // doubles each time. A shift stays within neighbouring words.
            let step = (reached + 1).min(by - reached).min(63);
            let mut below = 0;
            for at in 0..stride {
                let word = row[at];
                let above = row.get(at + 1).copied().unwrap_or(0);
                row[at] = word | word << step | below >> (64 - step) | word >> step | above << (64 - step);
                below = word;
            }
            row[stride - 1] &= last;
            reached += step;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::bit_image::any_bit_image;
    use super::*;
    use proptest::prelude::*;

    /// The definition of dilation, pixel by pixel: some set pixel lies under the (symmetric) element.
    fn dilated(image: &BitImage, element: Element) -> BitImage {
        let r = i64::from(element.radius);
        BitImage::from_fn(image.width(), image.height(), |x, y| {
            (-r..=r).any(|dy| {
                (-r..=r).any(|dx| {
                    let inside = element.shape == Shape::Square || dx * dx + dy * dy <= r * r;
                    let (px, py) = (i64::from(x) + dx, i64::from(y) + dy);
                    inside && px >= 0 && py >= 0 && image.get(px as u32, py as u32)
                })
            })
        })
    }

    /// The definition of erosion: no pixel of the picture under the element is clear.
    fn eroded(image: &BitImage, element: Element) -> BitImage {
        let r = i64::from(element.radius);
        BitImage::from_fn(image.width(), image.height(), |x, y| {
            (-r..=r).all(|dy| {
                (-r..=r).all(|dx| {
                    let inside = element.shape == Shape::Square || dx * dx + dy * dy <= r * r;
                    let (px, py) = (i64::from(x) + dx, i64::from(y) + dy);
                    let outside = px < 0 || py < 0 || px >= i64::from(image.width()) || py >= i64::from(image.height());
                    !inside || outside || image.get(px as u32, py as u32)
                })
            })
        })
    }

    fn any_element() -> impl Strategy<Value = Element> {
        (prop_oneof![Just(Shape::Square), Just(Shape::Disc)], 0_u32..9)
            .prop_map(|(shape, radius)| Element { shape, radius })
    }

    proptest! {
        #[test]
        fn all_four_match_their_definitions(image in any_bit_image(), element in any_element()) {
            let mut morphology = Morphology::default();
            let run = |operation: fn(&mut Morphology, &mut BitImage, Element), m: &mut Morphology| {
                let mut result = image.clone();
                operation(m, &mut result, element);
                result
            };
            let (dilation, erosion) = (dilated(&image, element), eroded(&image, element));
            prop_assert_eq!(run(Morphology::open, &mut morphology), dilated(&erosion, element));
            prop_assert_eq!(run(Morphology::close, &mut morphology), eroded(&dilation, element));
            prop_assert_eq!(run(Morphology::dilate, &mut morphology), dilation);
            prop_assert_eq!(run(Morphology::erode, &mut morphology), erosion);
        }
    }

    #[test]
    fn a_wide_element_crosses_several_words() {
        let image = BitImage::from_fn(400, 3, |x, y| x == 200 && y == 1);
        let element = Element { shape: Shape::Square, radius: 150 };
        let mut result = image.clone();
        Morphology::default().dilate(&mut result, element);
        assert_eq!(result, BitImage::from_fn(400, 3, |x, _| (50..=350).contains(&x)));
    }

    #[test]
    fn one_changed_pixel_is_noticed() {
        let image = BitImage::from_fn(90, 20, |x, y| (20..70).contains(&x) && (5..15).contains(&y));
        let element = Element { shape: Shape::Disc, radius: 3 };
        let mut result = image.clone();
        Morphology::default().dilate(&mut result, element);
        let expected = dilated(&image, element);
        assert_eq!(result, expected);
        result.set(67, 2, !result.get(67, 2));
        assert_ne!(result, expected);
    }
}
