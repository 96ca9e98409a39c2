//! Pictures that are turned or mirrored when they are read.

use glam::DVec2;
use image::DynamicImage;

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
}

impl Turn {
    /// Every turn that changes a picture.
    pub(crate) const ALL: [Self; 4] = [Self::Half, Self::Mirrored, Self::Clockwise, Self::Counterclockwise];

    /// What a file's mark says, degrees counterclockwise as ffprobe writes them; no quarter turn is none.
    pub(super) fn marked(degrees: i32) -> Self {
        match degrees.rem_euclid(360) {
            90 => Self::Counterclockwise,
            180 => Self::Half,
            270 => Self::Clockwise,
            _ => Self::None,
        }
    }

    /// The size of a picture of `size` pixels that is turned so.
    pub fn turned(self, size: [u32; 2]) -> [u32; 2] {
        match self {
            Self::None | Self::Half | Self::Mirrored => size,
            Self::Clockwise | Self::Counterclockwise => [size[1], size[0]],
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

    /// This turn and then another, where that is a turn by itself: a turned picture that is mirrored is none.
    pub(crate) fn then(self, next: Self) -> Option<Self> {
        match (self, next) {
            (Self::None, turn) | (turn, Self::None) => Some(turn),
            (Self::Mirrored, Self::Mirrored) => Some(Self::None),
            (Self::Mirrored, _) | (_, Self::Mirrored) => None,
            (first, second) => {
                let quarters = [Self::None, Self::Clockwise, Self::Half, Self::Counterclockwise];
                let number = |turn| quarters.iter().position(|known| *known == turn).unwrap_or(0);
                Some(quarters[(number(first) + number(second)) % 4])
            }
        }
    }

    /// A picture, turned.
    pub(crate) fn of(self, picture: DynamicImage) -> DynamicImage {
        match self {
            Self::None => picture,
            Self::Clockwise => picture.rotate90(),
            Self::Half => picture.rotate180(),
            Self::Counterclockwise => picture.rotate270(),
            Self::Mirrored => picture.fliph(),
        }
    }
}
