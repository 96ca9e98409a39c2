//! The packed observation: what one camera saw in one frame, one byte a pixel (METHOD A5.5).

use std::io::BufReader;
use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result, bail, ensure};
use image::codecs::png::PngEncoder;
use image::{DynamicImage, ExtendedColorType, GrayImage, ImageEncoder, ImageReader};

use super::distance::Codes;
use super::{BitImage, DistanceMap, Evidence, Segmentation};
use crate::files::{Limit, Overwrite, write_atomically};

const PACKED: Limit = Limit { what: "a packed observation", most: 1 << 30 };

/// One camera's packed observation: bit 7 the silhouette, bits 0..=6 the edge proximity (127 on an edge, 0 far away); and
/// the body parts in a second plane, where they are told apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// Row-major bytes, `width * height` of them.
    pub bytes: Vec<u8>,
    /// The segment of each pixel, of the same size; [`Self::with_segmentation`] checks that. `None` without segments.
    pub segmentation: Option<Segmentation>,
    /// How likely each pixel is of each class of parts, of the same size; `None` where silhouettes alone are compared.
    pub evidence: Option<Evidence>,
    /// The pixels that count neither for nor against a candidate, of the same size, as [`Self::ignore`] leaves them: without
    /// silhouette, proximity, segment or evidence. `None` where all count.
    pub ignored: Option<Arc<BitImage>>,
}

impl Observation {
    /// Bit of the silhouette in a packed byte.
    pub const SILHOUETTE: u8 = 0x80;
    /// Bits of the edge proximity in a packed byte.
    pub const PROXIMITY: u8 = 0x7f;

    /// An observation of nothing.
    pub fn empty(width: u32, height: u32) -> Self {
        let bytes = vec![0; width as usize * height as usize];
        Self { width, height, bytes, segmentation: None, evidence: None, ignored: None }
    }

    /// Has more pixels count neither for nor against a candidate: nothing is seen there, and what is drawn there is passed over.
    ///
    /// # Errors
    /// When the mask is of another size.
    pub fn ignore(&mut self, ignored: &Arc<BitImage>) -> Result<()> {
        check_ignored(ignored, (self.width, self.height))?;
        let pixels: Vec<usize> = ignored.pixels().collect();
        pixels.iter().for_each(|&at| self.bytes[at] = 0);
        self.segmentation = self.segmentation.take().map(|found| found.without(&pixels));
        self.evidence = self.evidence.take().map(|found| found.without(&pixels)).transpose()?;
        self.ignored = Some(match self.ignored.take() {
            None => Arc::clone(ignored),
            Some(mut before) => {
                Arc::make_mut(&mut before).or(ignored);
                before
            }
        });
        Ok(())
    }

    /// 0xff where a pixel counts, 0 where it is ignored.
    pub(crate) fn counts(&self, x: u32, y: u32) -> u8 {
        if self.ignored.as_ref().is_some_and(|ignored| ignored.get(x, y)) { 0 } else { 0xff }
    }

    /// Whether a pixel, by its place in the picture's rows, counts neither for nor against a candidate.
    pub fn ignores(&self, at: usize) -> bool {
        let width = self.width as usize;
        self.ignored.as_ref().is_some_and(|ignored| ignored.get((at % width) as u32, (at / width) as u32))
    }

    /// The observation with its body parts told apart.
    ///
    /// # Errors
    /// When the segmentation is of another size, or a pixel outside the silhouette has a segment.
    pub fn with_segmentation(mut self, segmentation: Segmentation) -> Result<Self> {
        let (width, height) = segmentation.dimensions();
        ensure!(
            (width, height) == (self.width, self.height) && self.bytes.len() == segmentation.numbers().len(),
            "a segmentation of {width} x {height} pixels was given for an observation of {} x {}",
            self.width,
            self.height
        );
        let mut pairs = self.bytes.iter().zip(segmentation.numbers());
        if let Some(at) = pairs.position(|(byte, &number)| number != 0 && byte & Self::SILHOUETTE == 0) {
            let (x, y) = (at % width as usize, at / width as usize);
            bail!("pixel ({x}, {y}) has a segment and lies outside the silhouette, expected segments only inside");
        }
        self.segmentation = Some(segmentation);
        Ok(self)
    }

    /// The number of silhouette pixels.
    pub fn area(&self) -> u32 {
        let all: u32 = self.bytes.iter().map(|byte| u32::from(byte >> 7)).sum();
        let ignored = self.ignored.iter().flat_map(|ignored| ignored.pixels());
        all - ignored.filter_map(|at| self.bytes.get(at)).map(|byte| u32::from(byte >> 7)).sum::<u32>()
    }

    /// Packs a silhouette and a distance map of one size; `proximity` holds the 7-bit value of every code of the map.
    pub(super) fn pack(&mut self, silhouette: &BitImage, distance: &DistanceMap, proximity: &[u8]) {
        let width = silhouette.width() as usize;
        (self.width, self.height) = (silhouette.width(), silhouette.height());
        self.bytes.resize(width * self.height as usize, 0);
        for (y, bytes) in self.bytes.chunks_exact_mut(width.max(1)).enumerate() {
            match distance.row(y) {
                Codes::Bytes(codes) => pack_row(bytes, codes, silhouette.row(y), proximity),
                Codes::Words(codes) => pack_row(bytes, codes, silhouette.row(y), proximity),
            }
        }
    }

    /// The silhouette alone.
    pub fn silhouette(&self) -> BitImage {
        let width = self.width;
        BitImage::from_fn(width, self.height, |x, y| {
            self.bytes.get(y as usize * width as usize + x as usize).is_some_and(|byte| byte & Self::SILHOUETTE != 0)
        })
    }

    /// The edge proximity alone, 0..=127.
    pub fn proximity(&self) -> GrayImage {
        let mut image = GrayImage::new(self.width, self.height);
        for (pixel, byte) in image.iter_mut().zip(&self.bytes) {
            *pixel = byte & Self::PROXIMITY;
        }
        image
    }

    /// Writes the bytes as an 8-bit grey PNG.
    ///
    /// # Errors
    /// When the file is there and may not be replaced, when it cannot be written, or when `bytes` does not hold
    /// `width * height` pixels.
    pub fn write_png(&self, path: &Path, overwrite: Overwrite) -> Result<()> {
        let pixels = self.width as usize * self.height as usize;
        if self.bytes.len() != pixels || pixels == 0 {
            bail!(
                "cannot write {}: an observation of {} x {} pixels holds {} bytes, expected {pixels} and at least one",
                path.display(),
                self.width,
                self.height,
                self.bytes.len()
            );
        }
        write_atomically(path, overwrite, |writer| {
            Ok(PngEncoder::new(writer).write_image(&self.bytes, self.width, self.height, ExtendedColorType::L8)?)
        })
    }

    /// Reads an observation from an 8-bit grey PNG.
    ///
    /// # Errors
    /// When the file cannot be read or is no 8-bit grey picture; the message names it.
    pub fn read_png(path: &Path) -> Result<Self> {
        let picture = (|| -> Result<DynamicImage> {
            Ok(ImageReader::new(BufReader::new(PACKED.open(path)?)).with_guessed_format()?.decode()?)
        })()
        .with_context(|| format!("cannot read the packed observation {}", path.display()))?;
        match picture {
            DynamicImage::ImageLuma8(gray) => Ok(Self {
                width: gray.width(),
                height: gray.height(),
                bytes: gray.into_raw(),
                segmentation: None,
                evidence: None,
                ignored: None,
            }),
            other => bail!(
                "{} holds pixels of the kind {:?}, expected a packed observation: one 8-bit grey value a pixel",
                path.display(),
                other.color()
            ),
        }
    }
}

/// Packs one row of bytes from its distances and the words of its silhouette.
fn pack_row<T: Copy + Into<u32>>(bytes: &mut [u8], codes: &[T], silhouette: &[u64], proximity: &[u8]) {
    for ((bytes, codes), &word) in bytes.chunks_mut(64).zip(codes.chunks(64)).zip(silhouette) {
        for (at, (byte, &code)) in bytes.iter_mut().zip(codes).enumerate() {
            let code: u32 = code.into();
            *byte = proximity[code as usize] | ((word >> at & 1) as u8) << 7;
        }
    }
}

/// That a mask of ignored pixels has the size of its observation.
pub(super) fn check_ignored(ignored: &BitImage, size: (u32, u32)) -> Result<()> {
    let found = (ignored.width(), ignored.height());
    ensure!(
        found == size,
        "the ignored pixels of {} x {} were given for an observation of {} x {}",
        found.0,
        found.1,
        size.0,
        size.1
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::bit_image::any_bit_image;
    use super::super::{Metric, PartClasses, ProximitySettings, Segment, Segments};
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn packing_round_trip(silhouette in any_bit_image()) {
            let edges = BitImage::from_fn(silhouette.width(), silhouette.height(), |x, y| x == 3 && y % 5 == 0);
            for metric in [Metric::Chessboard, Metric::Euclidean] {
                let mut distance = DistanceMap::default();
                distance.measure(&edges, metric, 16);
                let table = ProximitySettings::default().table(metric);
                let mut packed = Observation::empty(1, 1);
                packed.pack(&silhouette, &distance, &table);
                prop_assert_eq!(packed.area(), silhouette.count());
                prop_assert_eq!(&packed.silhouette(), &silhouette);
                let code = |d: f32| if metric == Metric::Euclidean { d * d } else { d };
                let expected = distance.distances().into_iter().map(|d| table[code(d).round() as usize]);
                prop_assert_eq!(packed.proximity().into_raw(), expected.collect::<Vec<u8>>());
            }
        }
    }

    #[test]
    fn png_round_trip_and_a_changed_byte_shows() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cam01.png");
        let mut observation = Observation { bytes: (0..=255).collect(), ..Observation::empty(16, 16) };
        observation.write_png(&path, Overwrite::Refuse).unwrap();
        assert_eq!(Observation::read_png(&path).unwrap(), observation);
        observation.bytes[77] ^= 1;
        assert_ne!(Observation::read_png(&path).unwrap(), observation);
        let refused = observation.write_png(&path, Overwrite::Refuse).unwrap_err();
        assert!(format!("{refused:#}").contains("cam01.png"), "{refused:#}");
    }

    #[test]
    fn what_is_no_observation_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("colour.png");
        image::RgbImage::new(4, 4).save(&path).unwrap();
        let error = format!("{:#}", Observation::read_png(&path).unwrap_err());
        assert!(error.contains("colour.png") && error.contains("8-bit grey"), "{error}");
        for (name, bytes) in [("empty.png", &b""[..]), ("half.png", &std::fs::read(&path).unwrap()[..40])] {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            let error = format!("{:#}", Observation::read_png(&path).unwrap_err());
            assert!(error.contains(name), "{error}");
        }
        assert!(Observation::read_png(&folder.path().join("none.png")).is_err());
        let broken = Observation { bytes: vec![0; 8], ..Observation::empty(3, 3) };
        let error = broken.write_png(&folder.path().join("broken.png"), Overwrite::Refuse).unwrap_err().to_string();
        assert!(error.contains("3 x 3") && error.contains('8'), "{error}");
    }

    #[test]
    fn nothing_is_seen_where_pixels_are_ignored() {
        let segment = Segment { name: "skin".to_owned(), labels: vec![4], weight: 1.0 };
        let segments = Arc::new(Segments::new(vec![segment]).unwrap());
        let segmentation = Segmentation::new(segments, 2, 2, vec![1, 1, 1, 0]).unwrap();
        let evidence = Evidence::new(Arc::new(PartClasses::one()), 2, 2, vec![14, 9, 0, 3]).unwrap();
        let seen = Observation { bytes: vec![0x80, 0x85, 0xff, 0x7f], ..Observation::empty(2, 2) };
        let mut seen = Observation { evidence: Some(evidence), ..seen.with_segmentation(segmentation).unwrap() };
        seen.ignore(&Arc::new(BitImage::from_fn(2, 2, |x, y| (x, y) == (0, 0)))).unwrap();
        assert_eq!((seen.area(), seen.evidence.as_ref().unwrap().best()), (2, 2));
        assert_eq!(seen.segmentation.as_ref().unwrap().areas(), [2]);
        // And more.
        seen.ignore(&Arc::new(BitImage::from_fn(2, 2, |x, y| (x, y) == (0, 1)))).unwrap();
        assert_eq!(seen.bytes, [0, 0x85, 0, 0x7f]);
        assert_eq!([0, 1, 2, 3].map(|at| seen.ignores(at)), [true, false, true, false]);
        assert_eq!(seen.evidence.as_ref().unwrap().words()[2], Evidence::SAYS_NOTHING);
        let error = seen.ignore(&Arc::new(BitImage::new(2, 3))).unwrap_err().to_string();
        assert_eq!(error, "the ignored pixels of 2 x 3 were given for an observation of 2 x 2");
    }

    #[test]
    fn segments_lie_inside_the_silhouette() {
        let segment = Segment { name: "skin".to_owned(), labels: vec![4], weight: 1.0 };
        let segments = Arc::new(Segments::new(vec![segment]).unwrap());
        let seen = Observation { bytes: vec![0x80, 0x85, 0x7f, 0], ..Observation::empty(2, 2) };
        let plane = |width, height, numbers: &[u8]| {
            Segmentation::new(Arc::clone(&segments), width, height, numbers.to_vec()).unwrap()
        };
        let segmented = seen.clone().with_segmentation(plane(2, 2, &[1, 0, 0, 0])).unwrap();
        assert_eq!(segmented.segmentation.unwrap().areas(), [1]);
        let outside = seen.clone().with_segmentation(plane(2, 2, &[1, 1, 1, 0])).unwrap_err().to_string();
        assert!(outside.contains("(0, 1)") && outside.contains("outside the silhouette"), "{outside}");
        let wider = seen.with_segmentation(plane(4, 1, &[0; 4])).unwrap_err().to_string();
        assert!(wider.contains("4 x 1") && wider.contains("2 x 2"), "{wider}");
    }
}
