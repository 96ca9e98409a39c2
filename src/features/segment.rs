//! Which body part a silhouette's pixel belongs to, by skin, by the clothes' colour, and by where it lies (METHOD A5.5).
//!
//! A pixel of the silhouette belongs to the first segment listed whose cue holds there, and to none where none holds.

use std::sync::Arc;

use anyhow::{Context, Result, bail, ensure};
use image::RgbImage;
use serde::Deserialize;

use super::{BitImage, Region, Segment, Segmentation, Segments};
use crate::files::{choices, shortened};

choices! {
    /// What a segment is known by.
    "cue" pub enum Cue {
        /// The colour of skin: `cb` and `cr`.
        "skin" Skin,
        /// Of all colours listed in all segments, the nearest in RGB is one of this segment's `colours` and at most `tolerance`
        /// away.
        "colour" Colour,
        /// Nothing but where it is: `within`.
        "position" Position,
    }
}

/// One `[[features.segment]]`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SegmentSettings {
    /// What it is called.
    pub name: String,
    /// The names of its parts in body.toml.
    #[serde(default)]
    pub parts: Vec<String>,
    /// The labels of its parts, beside those that are named.
    #[serde(default)]
    pub labels: Vec<u8>,
    /// Its weight in the segmented objective; those of all segments sum to 1.
    pub weight: f32,
    /// What it is known by.
    pub cue: Cue,
    /// Where it may lie at all: left, top, right and bottom as fractions of the silhouette's bounding box.
    #[serde(default = "everywhere")]
    pub within: [f32; 4],
    /// The colours of the clothes, red green blue.
    #[serde(default)]
    pub colours: Vec<[u8; 3]>,
    /// How far a pixel may be from the nearest of them, grey levels.
    #[serde(default = "default_tolerance")]
    pub tolerance: f32,
    /// The least and largest Cb of skin.
    #[serde(default = "default_cb")]
    pub cb: [u8; 2],
    /// The least and largest Cr of skin.
    #[serde(default = "default_cr")]
    pub cr: [u8; 2],
}

fn everywhere() -> [f32; 4] {
    [0.0, 0.0, 1.0, 1.0]
}

fn default_tolerance() -> f32 {
    60.0
}

fn default_cb() -> [u8; 2] {
    [77, 127]
}

fn default_cr() -> [u8; 2] {
    [133, 173]
}

impl SegmentSettings {
    /// Checks all that needs no body.
    ///
    /// # Errors
    /// One sentence with the segment, the key, the value, and what was expected.
    pub(super) fn check(&self) -> Result<()> {
        let name = shortened(&self.name);
        let [left, top, right, bottom] = self.within;
        let inside = |value: f32| (0.0..=1.0).contains(&value);
        ensure!(
            self.within.into_iter().all(inside) && left < right && top < bottom,
            "[features] segment \"{name}\": within is {:?}, expected left, top, right, bottom as fractions from 0 to 1, left \
             before right and top before bottom",
            self.within
        );
        ensure!(
            (0.0..=442.0).contains(&self.tolerance),
            "[features] segment \"{name}\": tolerance is {}, expected 0 to 442",
            self.tolerance
        );
        for (key, [low, high]) in [("cb", self.cb), ("cr", self.cr)] {
            ensure!(low <= high, "[features] segment \"{name}\": {key} is [{low}, {high}], expected the smaller first");
        }
        match (self.cue, self.colours.is_empty()) {
            (Cue::Colour, true) => bail!("[features] segment \"{name}\" has the cue \"colour\" and no colours"),
            (Cue::Skin | Cue::Position, false) => {
                bail!("[features] segment \"{name}\" has colours, which go with the cue \"colour\" alone")
            }
            (Cue::Colour, false) | (Cue::Skin | Cue::Position, true) => Ok(()),
        }
    }

    /// Turns the names of parts into labels, by the body's parts.
    ///
    /// # Errors
    /// When no part has a name, which is then named with the nearest one.
    pub(super) fn take_labels(&mut self, parts: &[(&str, u8)]) -> Result<()> {
        for name in std::mem::take(&mut self.parts) {
            let mut labels = parts.iter().filter(|(part, _)| *part == name).map(|&(_, label)| label).peekable();
            if labels.peek().is_none() {
                let likeness = |part: &str| strsim::jaro_winkler(part, &name);
                let nearest = parts.iter().map(|(part, _)| *part).max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
                bail!(
                    "[features] segment \"{}\": the body has no part \"{}\", the nearest is \"{}\"",
                    shortened(&self.name),
                    shortened(&name),
                    shortened(nearest.unwrap_or_default())
                );
            }
            self.labels.extend(labels);
        }
        Ok(())
    }

    /// Whether the cue holds at a pixel; `nearest` is the segment of the nearest colour and its squared distance.
    fn holds(&self, at: usize, colour: [u8; 3], nearest: Option<(usize, i32)>) -> bool {
        match self.cue {
            Cue::Position => true,
            Cue::Colour => nearest
                .is_some_and(|(segment, distance)| segment == at && distance as f32 <= self.tolerance * self.tolerance),
            Cue::Skin => {
                let [cb, cr] = chroma(colour);
                (self.cb[0]..=self.cb[1]).contains(&cb) && (self.cr[0]..=self.cr[1]).contains(&cr)
            }
        }
    }
}

/// Cb and Cr of a colour as JPEG defines them, in 256ths.
fn chroma([r, g, b]: [u8; 3]) -> [u8; 2] {
    let [r, g, b] = [r, g, b].map(i32::from);
    let bounded = |value: i32| ((value + 128) >> 8).clamp(-128, 127) + 128;
    [bounded(-43 * r - 85 * g + 128 * b) as u8, bounded(128 * r - 107 * g - 21 * b) as u8]
}

/// The segments of a run and what they are known by.
#[derive(Clone, Debug)]
pub(super) struct Segmenter {
    settings: Vec<SegmentSettings>,
    segments: Arc<Segments>,
}

impl Segmenter {
    /// Takes settings whose parts have their labels; `None` without segments.
    ///
    /// # Errors
    /// When a part's name was not turned into its label, or the segments make no sense together.
    pub(super) fn new(settings: &[SegmentSettings]) -> Result<Option<Self>> {
        if settings.is_empty() {
            return Ok(None);
        }
        if let Some(name) = settings.iter().flat_map(|segment| &segment.parts).next() {
            bail!("[features] a segment has the part \"{}\", and no body says what label that is", shortened(name));
        }
        let segment =
            |s: &SegmentSettings| Segment { name: s.name.clone(), labels: s.labels.clone(), weight: s.weight };
        let segments = Segments::new(settings.iter().map(segment).collect()).context("[features] segment")?;
        Ok(Some(Self { settings: settings.to_vec(), segments: Arc::new(segments) }))
    }

    /// The segment of every pixel of the silhouette.
    ///
    /// # Errors
    /// When picture and silhouette differ in size.
    pub(super) fn segment(&self, picture: &RgbImage, silhouette: &BitImage) -> Result<Segmentation> {
        let (width, height) = (silhouette.width(), silhouette.height());
        let mut numbers = vec![0; width as usize * height as usize];
        if let Some(bounds) = silhouette.bounds() {
            let boxes: Vec<_> = self.settings.iter().map(|segment| placed(segment.within, bounds)).collect();
            let (pixels, _) = picture.as_raw().as_chunks::<3>();
            silhouette.for_each_run(|y, columns| {
                let row = y * width as usize;
                for x in columns {
                    let colour = pixels.get(row + x).copied().unwrap_or_default();
                    let nearest = self.nearest_colour(colour);
                    let mut each = self.settings.iter().zip(&boxes).enumerate();
                    let found = each.position(|(at, (segment, within))| {
                        contains(*within, x as f32, y as f32) && segment.holds(at, colour, nearest)
                    });
                    numbers[row + x] = found.map_or(0, |at| at as u8 + 1);
                }
            });
        }
        Segmentation::new(Arc::clone(&self.segments), width, height, numbers)
    }

    /// The segment that lists the colour nearest to `colour`, and the squared distance; of equals the first listed.
    fn nearest_colour(&self, colour: [u8; 3]) -> Option<(usize, i32)> {
        let each = self.settings.iter().enumerate().flat_map(|(at, segment)| {
            segment.colours.iter().map(move |listed| {
                let difference = |channel: usize| i32::from(listed[channel]) - i32::from(colour[channel]);
                (at, [0, 1, 2].map(|channel| difference(channel) * difference(channel)).iter().sum())
            })
        });
        each.min_by_key(|&(_, distance)| distance)
    }
}

/// A box of fractions in the pixels of a region: left, top, right, bottom of pixel centres.
fn placed(within: [f32; 4], bounds: Region) -> [f32; 4] {
    let (width, height) = (bounds.width() as f32, bounds.height() as f32);
    let (left, top) = (bounds.x0 as f32 - 0.5, bounds.y0 as f32 - 0.5);
    [left + within[0] * width, top + within[1] * height, left + within[2] * width, top + within[3] * height]
}

fn contains([left, top, right, bottom]: [f32; 4], x: f32, y: f32) -> bool {
    x >= left && x < right && y >= top && y < bottom
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    fn segment(text: &str) -> SegmentSettings {
        toml::from_str(text).unwrap()
    }

    const SKIN: [u8; 3] = [200, 140, 110];
    const SHIRT: [u8; 3] = [30, 60, 160];
    const TROUSERS: [u8; 3] = [70, 70, 75];

    /// A person 20 pixels wide and 40 tall at (10, 5): head, shirt with bare hands, trousers, bare feet.
    fn person() -> (RgbImage, BitImage) {
        let picture = RgbImage::from_fn(40, 50, |x, y| {
            let hand = (20..25).contains(&y) && !(12..28).contains(&x);
            Rgb(match y {
                0..13 => SKIN,
                _ if hand => SKIN,
                13..27 => SHIRT,
                27..42 => TROUSERS,
                _ => SKIN,
            })
        });
        (picture, BitImage::from_fn(40, 50, |x, y| (10..30).contains(&x) && (5..45).contains(&y)))
    }

    fn settings() -> Vec<SegmentSettings> {
        vec![
            segment("name = 'head'\nlabels = [1]\nweight = 0.2\ncue = 'skin'\nwithin = [0, 0, 1, 0.3]"),
            segment("name = 'shirt'\nlabels = [2]\nweight = 0.2\ncue = 'colour'\ncolours = [[35, 62, 150]]"),
            segment(
                "name = 'legs'\nlabels = [3, 4]\nweight = 0.2\ncue = 'colour'\ncolours = [[0, 0, 0], [72, 70, 70]]",
            ),
            segment("name = 'skin'\nlabels = [5]\nweight = 0.2\ncue = 'skin'\nwithin = [0, 0, 1, 0.8]"),
            segment("name = 'rest'\nlabels = [6]\nweight = 0.2\ncue = 'position'\nwithin = [0, 0, 0.5, 1]"),
        ]
    }

    #[test]
    fn each_part_goes_by_its_cue() {
        let (picture, silhouette) = person();
        let segmenter = Segmenter::new(&settings()).unwrap().unwrap();
        let found = segmenter.segment(&picture, &silhouette).unwrap();
        let expected = |x: u32, y: u32| match (x, y) {
            _ if !silhouette.get(x, y) => 0,
            (_, 0..13) => 1,
            (10 | 11 | 28 | 29, 20..25) => 4,
            (_, 13..27) => 2,
            (_, 27..42) => 3,
            // The bare feet are below the skin's box; their left half is in the rest's.
            (10..20, _) => 5,
            _ => 0,
        };
        for (at, &number) in (0_u32..).zip(found.numbers()) {
            assert_eq!(number, expected(at % 40, at / 40), "({}, {})", at % 40, at / 40);
        }
        assert_eq!(segmenter.segment(&picture, &BitImage::new(40, 50)).unwrap().areas(), [0; 5]);
        assert!(Segmenter::new(&[]).unwrap().is_none());
    }

    #[test]
    fn skin_of_every_shade_is_skin_and_a_wall_is_not() {
        let skin = segment("name = 'a'\nweight = 1\ncue = 'skin'");
        for colour in [[255, 219, 190], [224, 172, 130], [141, 85, 50], [90, 56, 37]] {
            assert!(skin.holds(0, colour, None), "{colour:?}");
        }
        for colour in [[128, 128, 128], [255; 3], [0; 3], [40, 90, 200], [60, 160, 60], [255, 0, 0]] {
            assert!(!skin.holds(0, colour, None), "{colour:?}");
        }
    }

    #[test]
    fn names_become_labels_and_wrong_ones_are_named() {
        let parts = [("head", 4), ("left_hand", 9), ("left_hand", 10)];
        let mut named = segment("name = 'a'\nparts = ['left_hand', 'head']\nlabels = [1]\nweight = 1\ncue = 'skin'");
        assert!(Segmenter::new(&[named.clone()]).unwrap_err().to_string().contains("left_hand"));
        named.take_labels(&parts).unwrap();
        assert_eq!(named.labels, [1, 9, 10, 4]);
        let mut wrong = segment("name = 'a'\nparts = ['haed']\nweight = 1\ncue = 'skin'");
        let error = wrong.take_labels(&parts).unwrap_err().to_string();
        assert!(error.contains("\"haed\"") && error.contains("\"head\""), "{error}");
    }

    #[test]
    fn wrong_settings_are_clear_sentences() {
        for (text, parts) in [
            ("cue = 'colour'", &["\"a\"", "no colours"][..]),
            ("cue = 'skin'\ncolours = [[1, 2, 3]]", &["\"a\"", "colours", "alone"]),
            ("cue = 'position'\nwithin = [0.5, 0, 0.5, 1]", &["within is [0.5, 0.0, 0.5, 1.0]"]),
            ("cue = 'position'\nwithin = [0, nan, 1, 1]", &["within", "NaN"]),
            ("cue = 'skin'\ncb = [9, 3]", &["cb is [9, 3]"]),
            ("cue = 'colour'\ncolours = [[1, 2, 3]]\ntolerance = -1", &["tolerance is -1"]),
        ] {
            let error = segment(&format!("name = 'a'\nweight = 1\n{text}")).check().unwrap_err().to_string();
            assert!(parts.iter().all(|part| error.contains(part)), "{error}");
        }
    }
}
