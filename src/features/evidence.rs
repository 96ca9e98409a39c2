//! Soft evidence (METHOD A12): for every pixel and class of body parts, by how much its colour is likelier to be of such a part than
//! of the background. What a hard silhouette decides once and for all stays a matter of degree.

use std::sync::Arc;

use anyhow::{Result, bail, ensure};

/// Which class of look-alike parts each part of the body is of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartClasses {
    /// The class of each label; 0 for labels that are no part's.
    classes: [u8; 128],
    count: usize,
}

impl PartClasses {
    /// The most classes there may be: a pixel's codes are one 32-bit word.
    pub const MOST: usize = 8;

    /// Takes the class of every label, counted from 0.
    ///
    /// # Errors
    /// When a label is no label of a part or a class is none of the eight.
    pub fn new(labels: impl IntoIterator<Item = (u8, u8)>) -> Result<Self> {
        let mut classes = [0; 128];
        let mut count = 1;
        for (label, class) in labels {
            ensure!((1..=127).contains(&label), "the class {class} has the label {label}, expected 1 to 127");
            ensure!(
                usize::from(class) < Self::MOST,
                "label {label} is of class {class}, expected 0 to {}",
                Self::MOST - 1
            );
            classes[usize::from(label)] = class;
            count = count.max(usize::from(class) + 1);
        }
        Ok(Self { classes, count })
    }

    /// All parts in one class.
    pub fn one() -> Self {
        Self { classes: [0; 128], count: 1 }
    }

    /// How many classes there are; at least one.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The class of a part by its label.
    pub fn of_label(&self, label: u8) -> u8 {
        self.classes[usize::from(label & 0x7f)]
    }
}

/// The evidence of one view: a word a pixel, four bits a class.
///
/// A code c stands for the log-likelihood ratio (c - 7) / 1.4, clipped to 5: 0 is surely background, 7 says nothing, 14 is surely such
/// a part. Sums over drawn pixels of c - 7 are whole numbers, the same on every device.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Evidence {
    classes: Arc<PartClasses>,
    width: u32,
    height: u32,
    words: Vec<u32>,
    best: u32,
}

impl Evidence {
    /// Bits of a code.
    pub const BITS: usize = 4;
    /// The code that says nothing.
    pub const NEUTRAL: u32 = 7;
    /// The word of a pixel that says nothing of any class.
    pub const SAYS_NOTHING: u32 = 0x1111_1111 * Self::NEUTRAL;
    /// The largest code.
    pub const MOST: u32 = 14;
    /// Steps of the code a unit of the log-likelihood ratio.
    pub const STEPS: f32 = 1.4;

    /// Takes `words[y * width + x]`, in which bits 4 k to 4 k + 3 are the code of class k.
    ///
    /// # Errors
    /// When there are not as many words as pixels, or a code is larger than [`Self::MOST`].
    pub fn new(classes: Arc<PartClasses>, width: u32, height: u32, words: Vec<u32>) -> Result<Self> {
        let pixels = width as usize * height as usize;
        ensure!(
            words.len() == pixels,
            "evidence of {width} x {height} pixels holds {} words, expected {pixels}",
            words.len()
        );
        let mut best = 0;
        let mut largest = [0; AT_ONCE];
        for (block, words) in words.chunks(AT_ONCE).enumerate() {
            let largest = &mut largest[..words.len()];
            largest_codes(words, classes.count(), largest);
            if let Some(wrong) = largest.iter().position(|code| *code > Self::MOST) {
                let (at, width, wrong) = (block * AT_ONCE + wrong, width as usize, largest[wrong]);
                bail!("pixel ({}, {}) has the evidence {wrong}, expected 0 to {}", at % width, at / width, Self::MOST);
            }
            best += largest.iter().map(|code| code.saturating_sub(Self::NEUTRAL)).sum::<u32>();
        }
        Ok(Self { classes, width, height, words, best })
    }

    /// The same that says nothing at the given places.
    pub(super) fn without(mut self, pixels: &[usize]) -> Result<Self> {
        pixels.iter().for_each(|&at| self.words[at] = Self::SAYS_NOTHING);
        Self::new(self.classes, self.width, self.height, self.words)
    }

    /// The classes.
    pub fn classes(&self) -> &Arc<PartClasses> {
        &self.classes
    }

    /// Width and height, pixels.
    pub fn dimensions(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Row-major words.
    pub fn words(&self) -> &[u32] {
        &self.words
    }

    /// The sum that a drawing could have at best: every pixel that speaks for some class, by the one it speaks for most.
    pub fn best(&self) -> u32 {
        self.best
    }
}

/// Words that are looked at together.
const AT_ONCE: usize = 256;

/// The largest code of each word among those of the first `count` classes, of which there is one.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn largest_codes(words: &[u32], count: usize, largest: &mut [u32]) {
    // Class by class, not word by word: so it is done in vectors.
    largest.fill(0);
    for class in 0..count {
        for (largest, &word) in largest.iter_mut().zip(words) {
            *largest = (*largest).max(code(word, class));
        }
    }
}

/// The code of a class in a pixel's word.
pub fn code(word: u32, class: usize) -> u32 {
    word >> (Evidence::BITS * class) & 15
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_sum_takes_each_pixel_by_its_likeliest_class() {
        let classes = Arc::new(PartClasses::new([(1, 0), (2, 1), (3, 0)]).unwrap());
        assert_eq!((classes.count(), classes.of_label(2), classes.of_label(0x83), classes.of_label(9)), (2, 1, 0, 0));
        let word = |first: u32, second: u32| first | second << 4;
        let words = vec![word(14, 0), word(0, 9), word(7, 7), word(3, 2)];
        let evidence = Evidence::new(Arc::clone(&classes), 2, 2, words).unwrap();
        assert_eq!(evidence.best(), 7 + 2);
        assert_eq!([code(evidence.words()[1], 0), code(evidence.words()[1], 1)], [0, 9]);
        // The codes of classes that are not there do not count.
        assert_eq!(Evidence::new(classes, 1, 1, vec![word(7, 7) | 14 << 8]).unwrap().best(), 0);
    }

    #[test]
    fn wrong_evidence_is_a_clear_sentence() {
        let error = PartClasses::new([(1, 8)]).unwrap_err().to_string();
        assert_eq!(error, "label 1 is of class 8, expected 0 to 7");
        assert!(PartClasses::new([(0, 1)]).unwrap_err().to_string().contains("label 0, expected 1 to 127"));
        let one = Arc::new(PartClasses::one());
        let error = Evidence::new(Arc::clone(&one), 3, 2, vec![0; 5]).unwrap_err().to_string();
        assert_eq!(error, "evidence of 3 x 2 pixels holds 5 words, expected 6");
        let error = Evidence::new(Arc::clone(&one), 3, 2, vec![0, 0, 0, 0, 15, 0]).unwrap_err().to_string();
        assert_eq!(error, "pixel (1, 1) has the evidence 15, expected 0 to 14");
        // Beyond what is looked at together.
        let mut words = vec![8; 401 * 3];
        words[401 + 400] = 14;
        assert_eq!(Evidence::new(Arc::clone(&one), 401, 3, words.clone()).unwrap().best(), 401 * 3 + 6);
        words[2 * 401 + 7] = 15;
        let error = Evidence::new(one, 401, 3, words).unwrap_err().to_string();
        assert_eq!(error, "pixel (7, 2) has the evidence 15, expected 0 to 14");
    }
}
