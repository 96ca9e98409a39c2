//! Body parts told apart in what a camera saw: a segment number a pixel, in a second plane beside the packed bytes
//! (METHOD A5.5), and which parts of the body each segment stands for (METHOD A7).

use std::sync::Arc;

use anyhow::{Result, bail, ensure};

use crate::files::shortened;

/// One segment: some parts of the body that look alike, and how much they count.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// What it is called in settings and messages.
    pub name: String,
    /// The labels (1..=127) of the body's parts that belong to it.
    pub labels: Vec<u8>,
    /// Its weight in the segmented objective.
    pub weight: f32,
}

/// The segments of a body. Segment number `s` of a picture is `segments.get(s - 1)`; number 0 is no segment.
#[derive(Clone, Debug, PartialEq)]
pub struct Segments {
    segments: Vec<Segment>,
    /// The number of each label, 0 where it is in no segment.
    numbers: [u8; 128],
}

impl Segments {
    /// The most segments there may be.
    pub const MOST: usize = 8;

    /// How far the weights' sum may be from 1: what rounding to two digits does to eight numbers.
    const SLACK: f64 = 0.04;

    /// Takes 1 to [`Self::MOST`] segments. Weights are divided by their sum, so that three of 0.33 make exactly one.
    ///
    /// # Errors
    /// When there are none or too many, a name stands twice, a segment has no label, a label is no label of a part or
    /// is in two segments, a weight is negative or no number, or they are far from summing to 1.
    pub fn new(mut segments: Vec<Segment>) -> Result<Self> {
        let (count, most) = (segments.len(), Self::MOST);
        ensure!((1..=most).contains(&count), "there are {count} segments, expected 1 to {most}");
        let mut numbers = [0_u8; 128];
        for (at, segment) in segments.iter().enumerate() {
            let name = format!("\"{}\"", shortened(&segment.name));
            let twin = segments[..at].iter().any(|other| other.name == segment.name);
            ensure!(!twin, "two segments are called {name}, expected different names");
            ensure!(!segment.labels.is_empty(), "segment {name} has no labels, expected those of its body parts");
            ensure!(
                segment.weight.is_finite() && segment.weight >= 0.0,
                "segment {name} has the weight {}, expected 0 or more",
                segment.weight
            );
            for &label in &segment.labels {
                let Some(number) = numbers.get_mut(usize::from(label)).filter(|_| label > 0) else {
                    bail!("segment {name} has the label {label}, expected 1 to 127");
                };
                if let Some(other) = usize::from(*number).checked_sub(1) {
                    bail!(
                        "label {label} is in segment \"{}\" and in segment {name}, expected it in one at most and once",
                        shortened(&segments[other].name)
                    );
                }
                *number = at as u8 + 1;
            }
        }
        let sum: f64 = segments.iter().map(|segment| f64::from(segment.weight)).sum();
        ensure!((sum - 1.0).abs() <= Self::SLACK, "the weights of the segments sum to {sum:.4}, expected 1");
        segments.iter_mut().for_each(|segment| segment.weight = (f64::from(segment.weight) / sum) as f32);
        Ok(Self { segments, numbers })
    }

    /// The segments, number 1 first.
    pub fn as_slice(&self) -> &[Segment] {
        &self.segments
    }

    /// The segment number of a part's label; 0 for a label in no segment.
    pub fn number(&self, label: u8) -> u8 {
        self.numbers[usize::from(label & 127)]
    }
}

/// Which segment each pixel of one picture belongs to. The segments are shared by all views and frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Segmentation {
    segments: Arc<Segments>,
    width: u32,
    height: u32,
    numbers: Vec<u8>,
}

impl Segmentation {
    /// Takes `numbers`, row-major, `width * height` of them: 0 for no segment, `s` for the segment `s - 1` of the slice.
    ///
    /// # Errors
    /// When there are more or fewer numbers than pixels, or one is larger than the number of segments.
    pub fn new(segments: Arc<Segments>, width: u32, height: u32, numbers: Vec<u8>) -> Result<Self> {
        let pixels = width as usize * height as usize;
        ensure!(
            numbers.len() == pixels,
            "a segmentation of {width} x {height} pixels holds {} numbers, expected {pixels}",
            numbers.len()
        );
        let count = segments.as_slice().len();
        if let Some(at) = numbers.iter().position(|&number| usize::from(number) > count) {
            let (x, y) = (at % width as usize, at / width as usize);
            bail!("pixel ({x}, {y}) is of segment {}, expected 0 to {count}", numbers[at]);
        }
        Ok(Self { segments, width, height, numbers })
    }

    /// The same with no segment at the given places.
    pub(super) fn without(mut self, pixels: &[usize]) -> Self {
        pixels.iter().for_each(|&at| self.numbers[at] = 0);
        self
    }

    /// The segments.
    pub fn segments(&self) -> &Arc<Segments> {
        &self.segments
    }

    /// Width and height, pixels.
    pub fn dimensions(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Row-major segment numbers.
    pub fn numbers(&self) -> &[u8] {
        &self.numbers
    }

    /// The pixels of each segment, number 1 first.
    pub fn areas(&self) -> Vec<u32> {
        let mut areas = vec![0; self.segments.as_slice().len()];
        for &number in &self.numbers {
            if let Some(at) = usize::from(number).checked_sub(1) {
                areas[at] += 1;
            }
        }
        areas
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment(name: &str, labels: &[u8], weight: f32) -> Segment {
        Segment { name: name.to_owned(), labels: labels.to_vec(), weight }
    }

    #[test]
    fn labels_have_numbers_and_weights_sum_to_one() {
        let third = 0.33;
        let list = vec![segment("a", &[5, 1], third), segment("b", &[127], third), segment("c", &[2], third)];
        let segments = Segments::new(list).unwrap();
        assert_eq!([1, 2, 3, 5, 127].map(|label| segments.number(label)), [1, 3, 0, 1, 2]);
        let sum: f32 = segments.as_slice().iter().map(|segment| segment.weight).sum();
        assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        let numbers = vec![0, 1, 3, 3, 2, 0];
        let segmentation = Segmentation::new(Arc::new(segments), 3, 2, numbers.clone()).unwrap();
        assert_eq!((segmentation.dimensions(), segmentation.numbers()), ((3, 2), &numbers[..]));
        assert_eq!(segmentation.areas(), [1, 1, 2]);
    }

    #[test]
    fn wrong_segments_are_clear_sentences() {
        let nine: Vec<Segment> = (1..=9).map(|label| segment(&label.to_string(), &[label], 1.0 / 9.0)).collect();
        for (list, parts) in [
            (vec![], &["0 segments", "1 to 8"][..]),
            (nine, &["9 segments"]),
            (vec![segment("a", &[1], 0.5), segment("a", &[2], 0.5)], &["two segments", "\"a\""]),
            (vec![segment("a", &[], 1.0)], &["\"a\"", "no labels"]),
            (vec![segment("a", &[0], 1.0)], &["label 0", "1 to 127"]),
            (vec![segment("a", &[128], 1.0)], &["label 128"]),
            (vec![segment("a", &[3], 0.5), segment("b", &[3], 0.5)], &["label 3", "\"a\"", "\"b\""]),
            (vec![segment("a", &[3, 3], 1.0)], &["label 3", "once"]),
            (vec![segment("a", &[3], -1.0)], &["weight -1"]),
            (vec![segment("a", &[3], f32::NAN)], &["weight NaN"]),
            (vec![segment("a", &[3], 0.5)], &["sum to 0.5", "expected 1"]),
            (vec![segment("two\nlines", &[], 1.0)], &["two\\nlines"]),
        ] {
            let error = Segments::new(list).unwrap_err().to_string();
            assert!(parts.iter().all(|part| error.contains(part)), "{error}");
        }
        let segments = Arc::new(Segments::new(vec![segment("a", &[1], 1.0)]).unwrap());
        let error = Segmentation::new(Arc::clone(&segments), 3, 2, vec![0; 5]).unwrap_err().to_string();
        assert!(error.contains("5 numbers, expected 6"), "{error}");
        let error = Segmentation::new(segments, 3, 2, vec![0, 0, 0, 0, 2, 0]).unwrap_err().to_string();
        assert!(error.contains("(1, 1) is of segment 2, expected 0 to 1"), "{error}");
    }
}
