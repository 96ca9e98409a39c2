//! Where the pictures of a view come from.

use std::path::{Path, PathBuf};

use super::pictures::PicturePattern;
use super::turn::Turn;

/// Pictures of a live source: no end is known.
pub(super) const NO_END: usize = u32::MAX as usize;

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

impl Source {
    /// How its stored pictures are turned.
    pub(crate) fn turn(&self) -> Turn {
        match self {
            Self::Video(video) => video.turn,
            Self::Pictures(pattern) => pattern.turn,
            Self::Live(_) => Turn::None,
        }
    }
}

/// A video file, and how its pictures are turned when they are read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Video {
    /// The file.
    pub path: PathBuf,
    /// Size of its pictures as they are stored, pixels, width then height.
    pub stored: [u32; 2],
    /// How its stored pictures are turned.
    pub turn: Turn,
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

    /// Whether it goes on where it is, once it is opened again: not so a file, or pictures that ffmpeg makes up, which begin anew.
    pub(super) fn may_return(&self) -> bool {
        !Path::new(&self.address).is_file() && !self.input.iter().any(|word| word == "lavfi")
    }

    /// Whether it comes over a network, where the other end may be gone for long before that is noticed.
    pub(super) fn is_connection(&self) -> bool {
        self.address.contains("://")
    }
}
