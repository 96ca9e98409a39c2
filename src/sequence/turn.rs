//! Pictures that are turned or mirrored when they are read.

use glam::DVec2;
use image::DynamicImage;
use image::metadata::Orientation;

/// How pictures are turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Not at all.
    None,
    /// By 90 degrees, clockwise.
    Clockwise,
    /// By 180 degrees.
    Half,
    /// By 90 degrees, counterclockwise.
    Counterclockwise,
    /// Not turned, but left for right.
    Mirrored,
    /// Not turned, but upside down as in water.
    Flipped,
    /// Columns for rows: mirrored about the diagonal from the upper left.
    Transposed,
    /// Mirrored about the other diagonal.
    Transversed,
}

impl Turn {
    /// Every turn that a camera may be found to need.
    pub(crate) const ALL: [Self; 4] = [Self::Half, Self::Mirrored, Self::Clockwise, Self::Counterclockwise];

    /// What a video's mark says as ffprobe writes it: the matrix from stored to shown pixels (x' = a x + c y, y' = b x + d y; `a b u`
    /// and `c d v` first, numbers of rows with a colon between); none where that is no turn by quarters.
    pub(super) fn of_matrix(text: &str) -> Option<Self> {
        let numbers: Vec<i64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let &[a, b, _, c, d, ..] = &numbers[..] else { return None };
        // A hundredth of a turn's sine and cosine is how inexact writers are.
        let is_small = |x: i64, beside: i64| 100 * x.abs() < beside.abs();
        if is_small(b, a) && is_small(c, d) {
            return Some(match (a > 0, d > 0) {
                (true, true) => Self::None,
                (false, true) => Self::Mirrored,
                (true, false) => Self::Flipped,
                (false, false) => Self::Half,
            });
        }
        (is_small(a, b) && is_small(d, c)).then_some(match (b > 0, c > 0) {
            (true, true) => Self::Transposed,
            (true, false) => Self::Clockwise,
            (false, true) => Self::Counterclockwise,
            (false, false) => Self::Transversed,
        })
    }

    /// What a photograph's mark says (EXIF).
    pub(super) fn of_photograph(mark: Orientation) -> Self {
        match mark {
            Orientation::NoTransforms => Self::None,
            Orientation::Rotate90 => Self::Clockwise,
            Orientation::Rotate180 => Self::Half,
            Orientation::Rotate270 => Self::Counterclockwise,
            Orientation::FlipHorizontal => Self::Mirrored,
            Orientation::FlipVertical => Self::Flipped,
            Orientation::Rotate90FlipH => Self::Transposed,
            Orientation::Rotate270FlipH => Self::Transversed,
        }
    }

    /// The size of a picture of `size` pixels that is turned so.
    pub fn turned(self, size: [u32; 2]) -> [u32; 2] {
        match self {
            Self::None | Self::Half | Self::Mirrored | Self::Flipped => size,
            Self::Clockwise | Self::Counterclockwise | Self::Transposed | Self::Transversed => [size[1], size[0]],
        }
    }

    /// What ffmpeg's filters are preceded by.
    pub(super) fn filter(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Clockwise => "transpose=clock,",
            Self::Half => "hflip,vflip,",
            Self::Counterclockwise => "transpose=cclock,",
            Self::Mirrored => "hflip,",
            Self::Flipped => "vflip,",
            Self::Transposed => "transpose=cclock_flip,",
            Self::Transversed => "transpose=clock_flip,",
        }
    }

    /// As sentences say it.
    pub(crate) fn said(self) -> &'static str {
        match self {
            Self::None => "not turned",
            Self::Clockwise => "turned by 90 degrees clockwise",
            Self::Half => "turned by 180 degrees",
            Self::Counterclockwise => "turned by 90 degrees counterclockwise",
            Self::Mirrored => "mirrored",
            Self::Flipped => "mirrored upside down",
            Self::Transposed => "mirrored and turned by 90 degrees counterclockwise",
            Self::Transversed => "mirrored and turned by 90 degrees clockwise",
        }
    }

    /// Where a pixel of a picture of `size` pixels comes to lie.
    pub(crate) fn place(self, pixel: DVec2, size: [u32; 2]) -> DVec2 {
        let [right, bottom] = size.map(|side| f64::from(side) - 1.0);
        match self {
            Self::None => pixel,
            Self::Clockwise => DVec2::new(bottom - pixel.y, pixel.x),
            Self::Half => DVec2::new(right - pixel.x, bottom - pixel.y),
            Self::Counterclockwise => DVec2::new(pixel.y, right - pixel.x),
            Self::Mirrored => DVec2::new(right - pixel.x, pixel.y),
            Self::Flipped => DVec2::new(pixel.x, bottom - pixel.y),
            Self::Transposed => DVec2::new(pixel.y, pixel.x),
            Self::Transversed => DVec2::new(bottom - pixel.y, right - pixel.x),
        }
    }

    /// The turn that takes this one back.
    pub(crate) fn back(self) -> Self {
        match self {
            Self::Clockwise => Self::Counterclockwise,
            Self::Counterclockwise => Self::Clockwise,
            same => same,
        }
    }

    /// Turns by their quarters clockwise, those that are mirrored first behind the others.
    const BY_QUARTERS: [[Self; 4]; 2] = [
        [Self::None, Self::Clockwise, Self::Half, Self::Counterclockwise],
        [Self::Mirrored, Self::Transversed, Self::Flipped, Self::Transposed],
    ];

    /// This turn and then another.
    #[must_use]
    pub(crate) fn then(self, next: Self) -> Self {
        let place = |turn: Self| {
            let [plain, mirrored] = Self::BY_QUARTERS.map(|row| row.iter().position(|known| *known == turn));
            plain.map(|quarters| (0, quarters)).or(mirrored.map(|quarters| (1, quarters))).unwrap_or_default()
        };
        let ((first, quarters), (second, more)) = (place(self), place(next));
        // Mirrored, a turn goes the other way.
        let seen = if second == 1 { 4 - quarters } else { quarters };
        Self::BY_QUARTERS[first ^ second][(seen + more) % 4]
    }

    /// A picture, turned.
    pub(crate) fn of(self, picture: DynamicImage) -> DynamicImage {
        match self {
            Self::None => picture,
            Self::Clockwise => picture.rotate90(),
            Self::Half => picture.rotate180(),
            Self::Counterclockwise => picture.rotate270(),
            Self::Mirrored => picture.fliph(),
            Self::Flipped => picture.flipv(),
            Self::Transposed => picture.rotate90().fliph(),
            Self::Transversed => picture.rotate270().fliph(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> impl Iterator<Item = Turn> {
        Turn::BY_QUARTERS.into_iter().flatten()
    }

    /// A picture, a pixel's place, a size, a matrix as ffprobe writes it and two turns in a row all say the same.
    #[test]
    fn turns_are_the_same_wherever_they_are_said() {
        let stored = image::RgbImage::from_fn(5, 3, |x, y| image::Rgb([x as u8, y as u8, 0]));
        let picture = |turn: Turn, of: &image::RgbImage| turn.of(of.clone().into()).into_rgb8();
        for turn in all() {
            let turned = picture(turn, &stored);
            assert_eq!(<[u32; 2]>::from(turned.dimensions()), turn.turned([5, 3]), "{turn:?}");
            for (x, y, pixel) in stored.enumerate_pixels() {
                let at = turn.place(DVec2::new(f64::from(x), f64::from(y)), [5, 3]);
                assert_eq!(turned.get_pixel(at.x as u32, at.y as u32), pixel, "{turn:?}");
            }
            assert_eq!(picture(turn.back(), &turned), stored, "{turn:?}");
            for next in all() {
                assert_eq!(picture(next, &turned), picture(turn.then(next), &stored), "{turn:?} and {next:?}");
            }
            // The matrix moves steps along x and y as the turn moves pixels.
            let origin = turn.place(DVec2::ZERO, [5, 3]);
            let [along_x, along_y] = [DVec2::X, DVec2::Y].map(|step| (turn.place(step, [5, 3]) - origin) * 65536.0);
            let text = format!(
                " 00000000: {} {} 0 00000001: {} {} 0 00000002: 0 0 1073741824 ",
                along_x.x, along_x.y, along_y.x, along_y.y
            );
            assert_eq!(Turn::of_matrix(&text), Some(turn), "{text}");
        }
        assert_eq!(Turn::of_matrix("0: 46341 46341 0 1: -46341 46341 0"), None);
    }
}
