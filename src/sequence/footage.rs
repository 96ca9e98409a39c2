//! A video or numbered pictures by themselves: what one camera saw, without a manifest that names it.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result, bail};
use image::RgbImage;

use super::pictures::{PicturePattern, in_colour, shown as shown_size};
use super::resample::area_average;
use super::source::{Source, Video};
use super::timestamps::Timestamps;
use super::turn::Turn;
use super::video::{PixelFormat, VideoDecoder, VideoInfo, probe_video};
use crate::files::check_regular;

/// A video or numbered pictures (`frames/cam01_%04d.png`), looked at and not yet read.
#[derive(Clone, Debug)]
pub struct Footage {
    /// Its name in messages.
    pub shown: String,
    /// Where its pictures come from.
    pub source: Source,
    /// Size of its pictures as they are read, pixels, width then height.
    pub size: [u32; 2],
    /// Number of stored pictures.
    pub frame_count: usize,
    /// How a player turns the stored pictures before it shows them; `source` says how they are turned when they are read.
    pub marked: Turn,
    /// Frames per second, where a video tells.
    pub fps: Option<f64>,
    /// When each picture is to be shown, where a video tells.
    pub times: Option<Timestamps>,
    /// When it was made by the camera's own clock, as a video writes it.
    pub made: Option<String>,
    /// The picture of each frame where frames are not its pictures one by one; as many as there are frames.
    pub(crate) picks: Option<Arc<[u32]>>,
}

impl Footage {
    /// Of a source of which nothing but size and length is known.
    pub(super) fn plain(shown: String, source: Source, size: [u32; 2], frame_count: usize) -> Self {
        Self { shown, source, size, frame_count, marked: Turn::None, fps: None, times: None, made: None, picks: None }
    }

    /// Looks at a file that ffmpeg reads, or at numbered pictures; videos are counted, not decoded. What is marked to be turned for
    /// display is upright, as players show it.
    ///
    /// # Errors
    /// As [`probe_video`] and [`PicturePattern::open`].
    pub fn open(file: &Path) -> Result<Self> {
        let shown = file.display().to_string();
        if is_pattern(file) {
            let pattern = PicturePattern::open(file)?;
            let ((marked, size), frame_count) = (pattern.header()?, pattern.frame_count());
            return Ok(Self { marked, ..Self::plain(shown, Source::Pictures(pattern), size, frame_count) }.put(marked));
        }
        if let Err(why) = check_regular(file) {
            bail!("{why}: name a video or numbered pictures (frames/cam01_%04d.png)");
        }
        let VideoInfo { size, frame_count, turn, fps, times, made } = probe_video(file)?;
        let source = Source::Video(Video { path: file.to_path_buf(), stored: size, turn });
        let size = turn.turned(size);
        Ok(Self { shown, source, size, frame_count, marked: turn, fps, times, made, picks: None })
    }

    /// The same footage with its pictures as they are stored.
    #[must_use]
    pub fn as_stored(self) -> Self {
        self.put(Turn::None)
    }

    /// The same footage with its stored pictures turned so, whatever a player does.
    #[must_use]
    pub fn put(mut self, turn: Turn) -> Self {
        // Turned back, a quarter turn changes the sides again.
        self.size = turn.turned(self.source.turn().back().turned(self.size));
        match &mut self.source {
            Source::Video(video) => video.turn = turn,
            Source::Pictures(pattern) => pattern.turn = turn,
            Source::Live(_) => {}
        }
        self
    }

    /// The same footage upright, or as it is stored where that alone has the size that a camera is calibrated for.
    #[must_use]
    pub fn fitting(self, size: [u32; 2]) -> Self {
        if self.size != size && self.marked.turned(self.size) == size { self.as_stored() } else { self }
    }

    /// A sentence about footage that is marked to be turned for display.
    pub fn turned(&self) -> Option<String> {
        let how = match (self.marked, self.source.turn()) {
            (Turn::None, _) => return None,
            (marked, Turn::None) => format!("would be {} by a player, and is read as it is stored", marked.said()),
            (marked, turn) if turn == marked => format!("is {} when it is read, as players do", marked.said()),
            (marked, turn) => format!("would be {} by a player, and is {} when it is read", marked.said(), turn.said()),
        };
        Some(format!("{} {how}: {}", self.shown, shown_size(self.size)))
    }

    /// What to say, in brackets, of footage that has another size than the one its camera is calibrated for; empty where nothing is known.
    pub(crate) fn why_another_size(&self, size: [u32; 2]) -> String {
        if let Some(turned) = self.turned() {
            return format!(" ({turned})");
        }
        if Turn::Clockwise.turned(self.size) == size {
            return " (turned by 90 degrees it would fit: `orientation = 90` or `270` in its [[view]], clockwise, or `pantin start \
                    --orientation CAMERA=90`)"
                .to_string();
        }
        String::new()
    }

    /// `count` of its frames at `size`, evenly spread over all; all frames where there are fewer.
    ///
    /// # Errors
    /// When a decoder cannot be started, or it is live.
    pub fn spread(&self, count: usize, size: [u32; 2]) -> Result<SpreadFrames> {
        let count = count.min(self.frame_count);
        let frames = match &self.source {
            Source::Video(video) => Frames::Video(match &self.picks {
                None => VideoDecoder::open_spread(video, self.frame_count, count, size)?,
                // The same frames: the last of each share.
                Some(picks) => {
                    let chosen = (1..=count).filter_map(|next| picks.get(last_of_share(next, self.frame_count, count)));
                    let chosen: Arc<[u32]> = chosen.copied().collect();
                    VideoDecoder::open(video, Some(&chosen), 0..chosen.len(), size, PixelFormat::Rgb, 1)?
                }
            }),
            Source::Pictures(pattern) => Frames::Pictures(pattern.clone()),
            Source::Live(live) => bail!("{} is live, expected a recording", live.address),
        };
        Ok(SpreadFrames { frames, stored: self.size, size, total: self.frame_count, count, next: 0 })
    }
}

/// Whether a name is one of numbered pictures. A file may carry a percent sign in its plain name; then it is that file.
pub(super) fn is_pattern(file: &Path) -> bool {
    file.file_name().is_some_and(|name| name.to_string_lossy().contains('%')) && !file.is_file()
}

/// The last frame of share `number`, counted from 1, of so many equal shares of all frames.
pub(crate) fn last_of_share(number: usize, frames: usize, shares: usize) -> usize {
    (number * frames).div_ceil(shares) - 1
}

/// Frames that are evenly spread over footage, one after the other.
#[derive(Debug)]
pub struct SpreadFrames {
    frames: Frames,
    stored: [u32; 2],
    size: [u32; 2],
    total: usize,
    count: usize,
    next: usize,
}

#[derive(Debug)]
enum Frames {
    Video(VideoDecoder),
    Pictures(PicturePattern),
}

impl Iterator for SpreadFrames {
    type Item = Result<RgbImage>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.next >= self.count {
            return None;
        }
        self.next += 1;
        let read = self.read();
        if read.is_err() {
            self.next = self.count;
        }
        Some(read)
    }
}

impl SpreadFrames {
    fn read(&mut self) -> Result<RgbImage> {
        let [width, height] = self.size;
        match &mut self.frames {
            Frames::Video(decoder) => {
                let bytes = decoder.next_frame()?.unwrap_or_default();
                RgbImage::from_raw(width, height, bytes).context("a frame has too few bytes")
            }
            // The same frames as a video's: the last of each share.
            Frames::Pictures(pattern) => {
                let frame = last_of_share(self.next, self.total, self.count);
                Ok(area_average(in_colour(pattern.read(frame, self.stored)?), self.size))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::video::tests::{ffmpeg_is_here, make_video};
    use super::*;

    #[test]
    fn frames_of_pictures_and_of_a_video_are_the_same_ones() {
        let folder = tempfile::tempdir().unwrap();
        for frame in 0..10_u8 {
            let picture = RgbImage::from_pixel(8, 6, image::Rgb([frame * 20; 3]));
            picture.save(folder.path().join(format!("p_{frame:02}.png"))).unwrap();
        }
        let footage = Footage::open(&folder.path().join("p_%02d.png")).unwrap();
        assert_eq!((footage.size, footage.frame_count, footage.fps), ([8, 6], 10, None));
        let shown = |count| -> Vec<u8> {
            footage.spread(count, [4, 3]).unwrap().map(|picture| picture.unwrap().get_pixel(0, 0)[0] / 20).collect()
        };
        assert_eq!((shown(4), shown(10), shown(99)), (vec![2, 4, 7, 9], (0..10).collect(), (0..10).collect()));
        if !ffmpeg_is_here("frames_of_pictures_and_of_a_video_are_the_same_ones") {
            return;
        }
        let path = folder.path().join("v.mp4");
        make_video(&path, "64x48", 10, &[]);
        let video = Footage::open(&path).unwrap();
        assert_eq!((video.size, video.frame_count, video.fps), ([64, 48], 10, Some(25.0)));
        let all: Vec<_> = video.spread(10, [64, 48]).unwrap().map(Result::unwrap).collect();
        let some: Vec<_> = video.spread(4, [64, 48]).unwrap().map(Result::unwrap).collect();
        assert_eq!(some, [2, 4, 7, 9].map(|frame: usize| all[frame].clone()));
        let error = format!("{:#}", Footage::open(&folder.path().join("none.mp4")).unwrap_err());
        assert!(error.contains("none.mp4: name a video or numbered pictures"), "{error}");
    }
}
