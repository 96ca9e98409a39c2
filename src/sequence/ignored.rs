//! The pixels of a view that count neither for nor against anybody: furniture, the dead corner of a camera.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Result, bail};
use image::GrayImage;

use crate::files::check_regular;

use super::pictures::{PicturePattern, in_grey, picture_size, read_picture, shown};
use super::resample::nearest_mask;

/// Where a view's ignored pixels are stored: white, at least half as bright, is ignored.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ignored {
    masks: Masks,
    /// Width and height as stored.
    size: [u32; 2],
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Masks {
    /// One for all frames.
    Still(PathBuf),
    /// One a frame.
    Numbered(PicturePattern),
}

/// A view's ignored pixels, frame by frame.
pub(super) enum IgnoredFrames {
    Still(Arc<GrayImage>),
    Numbered(PicturePattern, [u32; 2]),
}

impl Ignored {
    /// Looks at what `ignore` of a view names: `key` says so in messages. `size` is the view's, `frames` how many it has, none where it is
    /// live.
    ///
    /// # Errors
    /// When nothing is there, no picture, one of another shape than the view's, or another number of them.
    pub(super) fn open(key: &str, file: &Path, size: [u32; 2], frames: Option<usize>) -> Result<Self> {
        let is_pattern = file.file_name().is_some_and(|name| name.to_string_lossy().contains('%')) && !file.is_file();
        let (masks, found) = if is_pattern {
            let pattern = PicturePattern::open(file)?;
            if Some(pattern.frame_count()) != frames {
                let each =
                    frames.map_or_else(String::new, |frames| format!("one for each of the {frames} frames, or "));
                bail!(
                    "{key} is {} pictures ({}), expected {each}one picture for all",
                    pattern.frame_count(),
                    file.display()
                );
            }
            let found = picture_size(&pattern.file(0))?;
            (Masks::Numbered(pattern), found)
        } else {
            if let Err(why) = check_regular(file) {
                bail!("{key}: {why}: name a picture or a pattern of pictures");
            }
            (Masks::Still(file.to_path_buf()), picture_size(file)?)
        };
        let ([width, height], [across, down]) = (size.map(u64::from), found.map(u64::from));
        if (width * down).abs_diff(height * across) > width.max(height) {
            bail!("{key}: {} is {} pixels, expected the shape of {}", file.display(), shown(found), shown(size));
        }
        Ok(Self { masks, size: found })
    }

    /// The file of the first frame's, and how many there are where there is one a frame.
    pub(crate) fn first(&self) -> (PathBuf, Option<usize>) {
        match &self.masks {
            Masks::Still(path) => (path.clone(), None),
            Masks::Numbered(pattern) => (pattern.file(0), Some(pattern.frame_count())),
        }
    }

    /// Ready to be read at a working size.
    ///
    /// # Errors
    /// When the one picture cannot be read.
    pub(super) fn frames(&self, working: [u32; 2]) -> Result<IgnoredFrames> {
        Ok(match &self.masks {
            Masks::Still(path) => IgnoredFrames::Still(Arc::new(read(path, self.size, working)?)),
            Masks::Numbered(pattern) => IgnoredFrames::Numbered(pattern.clone(), self.size),
        })
    }
}

impl IgnoredFrames {
    /// Those of one frame at a working size: 255 where a pixel is ignored, 0 elsewhere.
    ///
    /// # Errors
    /// When the frame's picture cannot be read.
    pub(super) fn of_frame(&self, frame: usize, working: [u32; 2]) -> Result<Arc<GrayImage>> {
        match self {
            Self::Still(mask) => Ok(Arc::clone(mask)),
            Self::Numbered(pattern, stored) => Ok(Arc::new(read(&pattern.file(frame), *stored, working)?)),
        }
    }
}

fn read(path: &Path, stored: [u32; 2], working: [u32; 2]) -> Result<GrayImage> {
    Ok(nearest_mask(&in_grey(read_picture(path, &[stored])?), working))
}
