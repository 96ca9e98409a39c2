//! Where the pictures of a view come from.

use std::path::{Path, PathBuf};

use super::pictures::PicturePattern;

/// Where the pictures (or masks) of a view come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// A file that ffmpeg reads.
    Video(Video),
    /// Numbered pictures.
    Pictures(PicturePattern),
    /// A camera or a stream, without an end and without frame numbers.
    Live(LiveSource),
}

/// A video file, and how its pictures are turned when they are read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Video {
    /// The file.
    pub path: PathBuf,
    /// How its stored pictures are turned.
    pub turn: Turn,
}

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
}

impl Turn {
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
            Self::None | Self::Half => size,
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
        }
    }

    /// As sentences say it.
    pub(crate) fn said(self) -> &'static str {
        match self {
            Self::None => "not turned",
            Self::Clockwise => "turned by 90 degrees clockwise",
            Self::Half => "turned by 180 degrees",
            Self::Counterclockwise => "turned by 90 degrees counterclockwise",
        }
    }
}

/// A source without an end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LiveSource {
    /// What ffmpeg opens.
    pub address: String,
    /// Options for ffmpeg before it, each name followed by its value.
    pub input: Vec<String>,
}

impl LiveSource {
    /// What a view's `source` and `input` name, when that is live: an address (`rtsp://…`), a device (`/dev/video0`), or
    /// anything with `input`. A file beside the manifest (a named pipe, say) may then be named as files are.
    pub(super) fn of(source: &Path, input: Option<&[String]>, dir: &Path) -> Option<Self> {
        let text = source.to_string_lossy();
        if input.is_none() && !text.contains("://") && !text.starts_with("/dev/") {
            return None;
        }
        let input = input.unwrap_or_default().to_vec();
        let file = dir.join(source);
        let address = if file.exists() { file.display().to_string() } else { text.into_owned() };
        Some(Self { address, input })
    }
}
