//! Numbered pictures (`frames/cam01_%04d.png`) and single ones, in any of the formats that are read; of several in a file the first.

use std::fs;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use image::{DynamicImage, GrayImage, ImageDecoder, ImageReader, RgbImage};

use super::turn::Turn;
use crate::files::{Limit, PICTURE_FORMATS};

/// Pictures are held in memory whole.
const PICTURE: Limit = Limit { what: "a picture", most: 1 << 30 };

/// A name with a number in it, as printf writes it, and the pictures that are there under it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PicturePattern {
    folder: PathBuf,
    prefix: String,
    suffix: String,
    /// Numbers are padded with zeros to this many digits.
    digits: usize,
    /// The smallest number that is there: the name of frame 0.
    first: u64,
    count: usize,
    /// How the stored pictures are turned when they are read.
    pub(super) turn: Turn,
}

impl PicturePattern {
    /// Finds the pictures of a pattern: one `%d` or `%0Nd` in the file name, `%%` for a percent sign. Frame 0 is the
    /// smallest number there is.
    ///
    /// # Errors
    /// One sentence naming the pattern when it is not one, when no picture is there, or when a number is missing
    /// between the smallest and the largest.
    pub fn open(pattern: &Path) -> Result<Self> {
        let shown = pattern.display();
        let name = pattern.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let (prefix, digits, suffix) = split_pattern(name)
            .ok_or_else(|| anyhow!("{shown}: expected one %d or %0Nd in the file name (frames/cam01_%04d.png)"))?;
        let folder = match pattern.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
            _ => PathBuf::from("."),
        };
        let mut numbers = Vec::new();
        let listing =
            fs::read_dir(&folder).with_context(|| format!("cannot read the folder of the pictures {shown}"))?;
        for entry in listing {
            let entry = entry.with_context(|| format!("cannot read the folder of the pictures {shown}"))?;
            let Ok(name) = entry.file_name().into_string() else { continue };
            let number = name.strip_prefix(&prefix).and_then(|rest| rest.strip_suffix(&suffix));
            numbers.extend(number.and_then(|number| number_of(number, digits)));
        }
        numbers.sort_unstable();
        let Some(&first) = numbers.first() else { bail!("there are no pictures {shown}") };
        if let Some(pair) = numbers.windows(2).find(|pair| pair[1] != pair[0] + 1) {
            bail!("the pictures {shown} have a gap: number {} is missing, number {} is there", pair[0] + 1, pair[1]);
        }
        Ok(Self { folder, prefix, suffix, digits, first, count: numbers.len(), turn: Turn::None })
    }

    /// How many pictures there are.
    pub fn frame_count(&self) -> usize {
        self.count
    }

    /// The file of one frame, counted from 0.
    pub fn file(&self, frame: usize) -> PathBuf {
        let number = self.first + frame as u64;
        self.folder.join(format!("{}{number:0digits$}{}", self.prefix, self.suffix, digits = self.digits))
    }
}

impl PicturePattern {
    /// One frame's picture, turned as it is to be and then of the size `size`.
    ///
    /// # Errors
    /// As [`read_picture`].
    pub(super) fn read(&self, frame: usize, size: [u32; 2]) -> Result<DynamicImage> {
        Ok(self.turn.of(read_picture(&self.file(frame), &[self.turn.back().turned(size)])?))
    }

    /// [`header`] of the first picture.
    ///
    /// # Errors
    /// As [`picture_size`].
    pub(super) fn header(&self) -> Result<(Turn, [u32; 2])> {
        header(&self.file(0))
    }
}

/// A picture in colour. The library leads grey ones through single precision, which takes longer than decoding them.
pub(super) fn in_colour(picture: DynamicImage) -> RgbImage {
    let DynamicImage::ImageLuma8(grey) = picture else { return picture.into_rgb8() };
    let (width, height) = grey.dimensions();
    let mut colour = RgbImage::new(width, height);
    for (colour, grey) in colour.pixels_mut().zip(grey.as_raw()) {
        colour.0 = [*grey; 3];
    }
    colour
}

/// A picture in grey, as the library makes it; where it holds nothing but grey, without the way through single precision either.
pub(super) fn in_grey(picture: DynamicImage) -> GrayImage {
    fn grey<const N: usize>(picture: &DynamicImage) -> Option<GrayImage> {
        let (pixels, _) = picture.as_bytes().as_chunks::<N>();
        let is_grey = pixels.iter().all(|pixel| pixel[0] == pixel[1] && pixel[0] == pixel[2]);
        let values = is_grey.then(|| pixels.iter().map(|pixel| pixel[0]).collect())?;
        GrayImage::from_raw(picture.width(), picture.height(), values)
    }
    let found = match &picture {
        DynamicImage::ImageRgb8(_) => grey::<3>(&picture),
        DynamicImage::ImageRgba8(_) => grey::<4>(&picture),
        _ => None,
    };
    found.unwrap_or_else(|| picture.into_luma8())
}

/// A pattern's text before the number, its digits, and the text after.
fn split_pattern(name: &str) -> Option<(String, usize, String)> {
    let (mut before, mut after, mut digits) = (String::new(), String::new(), None);
    let mut rest = name;
    while let Some(at) = rest.find('%') {
        let text = if digits.is_none() { &mut before } else { &mut after };
        text.push_str(&rest[..at]);
        rest = &rest[at + 1..];
        if let Some(tail) = rest.strip_prefix('%') {
            text.push('%');
            rest = tail;
            continue;
        }
        let (width, tail) = rest.split_once('d')?;
        let width = match width {
            "" => 0,
            // More digits than a number can have are a mistake, and would only cost memory.
            _ => width.strip_prefix('0')?.parse::<usize>().ok().filter(|width| (1..=19).contains(width))?,
        };
        if digits.replace(width).is_some() {
            return None;
        }
        rest = tail;
    }
    after.push_str(rest);
    Some((before, digits?, after))
}

/// The number printf would have written so with that many digits.
fn number_of(text: &str, digits: usize) -> Option<u64> {
    if text.is_empty() || !text.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    // The largest number is left out so that the one after it always exists.
    let number: u64 = text.parse().ok().filter(|&number| number < u64::MAX)?;
    (format!("{number:0digits$}") == text).then_some(number)
}

/// The size of a picture, from its header.
///
/// # Errors
/// When the file is missing or of none of the formats that are read.
pub(super) fn picture_size(path: &Path) -> Result<[u32; 2]> {
    Ok(decoder(path)?.dimensions().into())
}

/// How viewers turn a picture, and its size as it is stored: a telephone marks its photographs so (EXIF); one whose mark cannot be read
/// has none.
///
/// # Errors
/// As [`picture_size`].
fn header(path: &Path) -> Result<(Turn, [u32; 2])> {
    let mut decoder = decoder(path)?;
    let mark = decoder.orientation().map_or(Turn::None, Turn::of_photograph);
    Ok((mark, decoder.dimensions().into()))
}

/// A still picture that goes with a camera's: upright, as its mark says, where that alone makes its size one of those that
/// `fits` takes, or the mark changes no size; with its size.
///
/// # Errors
/// As [`picture_size`].
pub(super) fn still(path: &Path, fits: impl Fn([u32; 2]) -> bool) -> Result<(Turn, [u32; 2])> {
    let (mark, stored) = header(path)?;
    let upright = mark.turned(stored);
    Ok(if fits(stored) && !fits(upright) { (Turn::None, stored) } else { (mark, upright) })
}

/// Reads a picture as it is stored.
///
/// # Errors
/// When it cannot be read, or its size is none of `sizes`; the message names the file and both sizes.
pub(super) fn read_picture(path: &Path, sizes: &[[u32; 2]]) -> Result<DynamicImage> {
    let decoder = decoder(path)?;
    let found: [u32; 2] = decoder.dimensions().into();
    // Checked before anything is decoded: a header may promise more pixels than there is memory.
    if !sizes.contains(&found) {
        let expected: Vec<String> = sizes.iter().map(|size| shown(*size)).collect();
        bail!("{} is {} pixels, expected {}", path.display(), shown(found), expected.join(" or "));
    }
    DynamicImage::from_decoder(decoder).with_context(|| format!("cannot read the picture {}", path.display()))
}

fn decoder(path: &Path) -> Result<impl ImageDecoder + use<>> {
    let reader = ImageReader::new(BufReader::new(PICTURE.open(path)?));
    let reader = reader.with_guessed_format().map_err(anyhow::Error::from);
    reader
        .and_then(|reader| Ok(reader.into_decoder()?))
        .with_context(|| format!("cannot read the picture {} ({PICTURE_FORMATS} are read)", path.display()))
}

/// A size as messages show it.
pub(super) fn shown(size: [u32; 2]) -> String {
    format!("{}x{}", size[0], size[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn touch(folder: &Path, names: &[&str]) {
        for name in names {
            fs::write(folder.join(name), b"").unwrap();
        }
    }

    #[test]
    fn numbering_starts_at_the_smallest_and_ignores_other_names() {
        let folder = tempfile::tempdir().unwrap();
        touch(
            folder.path(),
            &["c_0098.png", "c_0099.png", "c_0100.png", "c_99.png", "c_x.png", "d_0001.png", "c_00098.png"],
        );
        let pattern = PicturePattern::open(&folder.path().join("c_%04d.png")).unwrap();
        assert_eq!(pattern.frame_count(), 3);
        assert_eq!(pattern.file(0), folder.path().join("c_0098.png"));
        assert_eq!(pattern.file(2), folder.path().join("c_0100.png"));
        touch(folder.path(), &["50%_9.png", "50%_10.png"]);
        let plain = PicturePattern::open(&folder.path().join("50%%_%d.png")).unwrap();
        assert_eq!((plain.frame_count(), plain.file(1)), (2, folder.path().join("50%_10.png")));
    }

    #[test]
    fn bad_patterns_are_sentences() {
        let folder = tempfile::tempdir().unwrap();
        touch(folder.path(), &["c_1.png", "c_3.png"]);
        let message = |name: &str| format!("{:#}", PicturePattern::open(&folder.path().join(name)).unwrap_err());
        assert!(message("c_%d.png").contains("number 2 is missing"), "{}", message("c_%d.png"));
        assert!(message("e_%d.png").contains("there are no pictures"), "{}", message("e_%d.png"));
        assert!(message("no/c_%d.png").contains("no/c_%d.png"), "{}", message("no/c_%d.png"));
        for name in ["c.png", "c_%s.png", "c_%d_%d.png", "c_%4d.png", "c_%099999d.png", "c_%", "c_%0d.png"] {
            assert!(message(name).contains("expected one %d or %0Nd"), "{name}: {}", message(name));
        }
    }

    #[test]
    fn broken_pictures_are_sentences() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("p.png");
        RgbImage::new(40, 30).save(&path).unwrap();
        assert_eq!(picture_size(&path).unwrap(), [40, 30]);
        let error = format!("{:#}", read_picture(&path, &[[80, 60], [20, 15]]).unwrap_err());
        assert!(error.contains("p.png is 40x30 pixels, expected 80x60 or 20x15"), "{error}");
        let whole = fs::read(&path).unwrap();
        fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        let error = format!("{:#}", read_picture(&path, &[[40, 30]]).unwrap_err());
        assert!(error.contains("cannot read the picture") && error.contains("p.png"), "{error}");
        fs::write(&path, b"no picture").unwrap();
        let error = format!("{:#}", picture_size(&path).unwrap_err());
        assert!(error.contains("p.png (PNG, JPEG, GIF, TIFF, WebP and BMP are read)"), "{error}");
    }

    #[test]
    fn grey_pictures_have_the_library_s_colours() {
        let grey = DynamicImage::from(GrayImage::from_fn(32, 8, |x, y| image::Luma([(8 * x + y) as u8])));
        assert_eq!(in_colour(grey.clone()), grey.to_rgb8());
        let deep = image::ImageBuffer::from_fn(32, 8, |x, y| image::Luma([(2040 * x + 255 * y) as u16]));
        for other in [DynamicImage::from(deep), DynamicImage::from(grey.to_luma_alpha8()), grey.to_rgba8().into()] {
            assert_eq!(in_colour(other.clone()), other.to_rgb8());
        }
    }

    #[test]
    fn masks_have_the_library_s_grey() {
        let colour = |spread: u32| {
            DynamicImage::from(RgbImage::from_fn(32, 8, |x, y| {
                let grey = 8 * x + y;
                image::Rgb([grey, grey.saturating_sub(spread * (x % 3)), grey].map(|value| value as u8))
            }))
        };
        for picture in [colour(0), colour(40)] {
            let whole =
                [picture.clone(), picture.to_rgba8().into(), picture.to_luma8().into(), picture.to_rgb16().into()];
            for picture in whole {
                assert_eq!(in_grey(picture.clone()), picture.to_luma8(), "{:?}", picture.color());
            }
        }
    }

    #[test]
    fn every_format_is_read_and_held_to_its_size_before_it_is_decoded() {
        let folder = tempfile::tempdir().unwrap();
        let picture = RgbImage::from_fn(40, 30, |x, y| image::Rgb([(6 * x) as u8, (8 * y) as u8, 90]));
        for (end, off) in [("png", 0), ("bmp", 0), ("tiff", 0), ("webp", 0), ("gif", 40), ("jpg", 40)] {
            let path = folder.path().join(format!("p_1.{end}"));
            picture.save(&path).unwrap();
            let pattern = PicturePattern::open(&folder.path().join(format!("p_%d.{end}"))).unwrap();
            assert_eq!((pattern.frame_count(), picture_size(&pattern.file(0)).unwrap()), (1, [40, 30]), "{end}");
            let read = read_picture(&path, &[[40, 30]]).unwrap().into_rgb8();
            let worst = read.as_raw().iter().zip(picture.as_raw()).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
            assert!(worst <= off, "{end}: {worst}");
            let error = format!("{:#}", read_picture(&path, &[[41, 30]]).unwrap_err());
            assert!(error.contains(&format!("p_1.{end} is 40x30 pixels, expected 41x30")), "{error}");
            let whole = fs::read(&path).unwrap();
            fs::write(&path, &whole[..whole.len() / 3]).unwrap();
            let error = format!("{:#}", read_picture(&path, &[[40, 30]]).unwrap_err());
            assert!(error.contains("cannot read the picture") && error.contains(&format!("p_1.{end}")), "{error}");
        }
        // Of pictures that follow each other in a file, the first.
        let path = folder.path().join("moving.gif");
        let frames = [20, 220]
            .map(|grey| image::Frame::new(image::RgbaImage::from_pixel(8, 6, image::Rgba([grey, grey, grey, 255]))));
        image::codecs::gif::GifEncoder::new(fs::File::create(&path).unwrap()).encode_frames(frames).unwrap();
        let first = read_picture(&path, &[[8, 6]]).unwrap().into_luma8();
        assert!(first.pixels().all(|pixel| pixel[0].abs_diff(20) < 4), "{:?}", first.get_pixel(0, 0));
    }

    /// A JPEG with a mark of its orientation (EXIF, 1 to 8): a small TIFF with that one entry.
    fn save_marked(path: &Path, picture: &RgbImage, orientation: u8) {
        use image::ImageEncoder as _;
        let mut exif = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0".to_vec();
        exif.extend([orientation, 0, 0, 0, 0, 0, 0, 0]);
        let mut encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(fs::File::create(path).unwrap(), 95);
        encoder.set_exif_metadata(exif).unwrap();
        encoder
            .write_image(picture.as_raw(), picture.width(), picture.height(), image::ExtendedColorType::Rgb8)
            .unwrap();
    }

    /// Of every mark that a camera writes, the picture comes out upright: its dark corner lies in the upper left.
    #[test]
    fn photographs_are_read_as_they_are_marked() {
        let folder = tempfile::tempdir().unwrap();
        let upright = RgbImage::from_fn(48, 32, |x, y| image::Rgb([if x < 16 && y < 8 { 20 } else { 230 }; 3]));
        for orientation in 1..=8 {
            let path = folder.path().join(format!("p{orientation}_1.jpg"));
            let mark = Turn::of_photograph(image::metadata::Orientation::from_exif(orientation).unwrap());
            let stored = mark.back().of(upright.clone().into()).into_rgb8();
            save_marked(&path, &stored, orientation);
            let footage = super::super::Footage::open(&folder.path().join(format!("p{orientation}_%d.jpg"))).unwrap();
            assert_eq!((footage.size, footage.marked), ([48, 32], mark), "{orientation}");
            assert_eq!(footage.turned().is_some(), mark != Turn::None);
            let pattern = PicturePattern::open(&folder.path().join(format!("p{orientation}_%d.jpg"))).unwrap();
            let read =
                PicturePattern { turn: pattern.header().unwrap().0, ..pattern }.read(0, [48, 32]).unwrap().into_luma8();
            assert!(read.get_pixel(4, 3)[0] < 60 && read.get_pixel(24, 3)[0] > 200 && read.get_pixel(4, 20)[0] > 200);
            // A calibration of the pictures as they are stored has its way.
            let lying = <[u32; 2]>::from(stored.dimensions());
            if lying != [48, 32] {
                let as_stored =
                    super::super::Footage::open(&folder.path().join(format!("p{orientation}_%d.jpg"))).unwrap();
                assert_eq!(as_stored.fitting(lying).size, lying);
            }
            let is = |size: [u32; 2]| move |found: [u32; 2]| found == size;
            assert_eq!(still(&path, is([48, 32])).unwrap(), (mark, [48, 32]));
            assert_eq!(still(&path, is(lying)).unwrap().1, lying);
        }
    }

    /// A header may promise more than there is memory; nothing of it is taken before the size is known to be right.
    #[test]
    fn headers_that_promise_too_much_are_sentences() {
        let folder = tempfile::tempdir().unwrap();
        let mut gif = Vec::new();
        let small = RgbImage::new(8, 6);
        small.write_to(&mut std::io::Cursor::new(&mut gif), image::ImageFormat::Gif).unwrap();
        gif[6..10].fill(255);
        let mut bmp = b"BM".to_vec();
        bmp.extend([0_u8; 8].iter().chain(&54_u32.to_le_bytes()).chain(&40_u32.to_le_bytes()));
        bmp.extend(
            60_000_u32.to_le_bytes().iter().chain(&60_000_u32.to_le_bytes()).chain(&[1, 0, 24, 0]).chain(&[0; 24]),
        );
        for (name, bytes, size) in [("large.gif", gif, "65535x65535"), ("large.bmp", bmp, "60000x60000")] {
            let path = folder.path().join(name);
            fs::write(&path, bytes).unwrap();
            let error = format!("{:#}", read_picture(&path, &[[40, 30]]).unwrap_err());
            assert!(error.contains(&format!("{name} is {size} pixels, expected 40x30")), "{error}");
        }
    }
}
