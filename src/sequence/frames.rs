//! The pictures of a sequence, frame by frame, read ahead by one thread a view.

use std::ops::Range;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use anyhow::{Context, Result, anyhow, bail};
use image::{GrayImage, RgbImage};

use super::ignored::IgnoredFrames;
use super::manifest::Sequence;
use super::pictures::{PicturePattern, in_colour, in_grey, read_picture, still};
use super::program::Stopper;
use super::resample::{area_average, nearest_mask};
use super::source::Source;
use super::video::{PixelFormat, VideoDecoder};
use super::view::{View, is_plate_size};

/// Frames a view's thread may be ahead of the reader. Together with the one it is working on this bounds the memory,
/// however long the sequence is.
const READ_AHEAD: usize = 3;

/// One moment, seen by every camera.
#[derive(Clone, Debug)]
pub struct FrameSet {
    /// Number of the frame in the sequence, from 0.
    pub index: usize,
    /// A picture a view, in the order of the views, at the working size.
    pub pictures: Vec<RgbImage>,
    /// A ready silhouette a view, where the view has any: 255 on the person, 0 elsewhere, at the working size.
    pub masks: Vec<Option<GrayImage>>,
    /// The pixels that count neither for nor against anybody, where the view has any: 255 there, 0 elsewhere, at the working size.
    pub ignored: Vec<Option<Arc<GrayImage>>>,
}

/// How long a view may take for a picture before it counts as stalled, unless told otherwise.
pub const STALL_TIMEOUT: Duration = Duration::from_secs(60);
/// What the decoder gets besides for each frame that it has to pass over first.
const PASSED_OVER: Duration = Duration::from_millis(500);

/// Reads consecutive frames of a sequence. Dropping it ends its threads and their decoders.
#[derive(Debug)]
pub struct FrameReader {
    views: Vec<ViewThread>,
    next: usize,
    end: usize,
    stall_timeout: Duration,
    /// Frames before the first that the decoders pass over.
    passed_over: usize,
}

/// A view's picture, mask and ignored pixels of one frame.
type ViewFrame = (RgbImage, Option<GrayImage>, Option<Arc<GrayImage>>);

#[derive(Debug)]
struct ViewThread {
    camera: String,
    frames: Receiver<Result<ViewFrame>>,
    thread: Option<JoinHandle<()>>,
    /// The decoders the thread may be waiting for.
    decoders: Vec<Stopper>,
}

impl Sequence {
    /// Starts reading the frames of `range`.
    ///
    /// # Errors
    /// When the range reaches past the last frame, or a decoder cannot be started.
    pub fn read_frames(&self, range: Range<usize>) -> Result<FrameReader> {
        if range.start > range.end || range.end > self.frame_count {
            bail!(
                "{}: frames {}..{} were asked for, expected a range within 0..{} (the sequence has {} frames)",
                self.path.display(),
                range.start,
                range.end,
                self.frame_count,
                self.frame_count
            );
        }
        let mut reader = FrameReader {
            views: Vec::new(),
            next: range.start,
            end: range.end,
            stall_timeout: STALL_TIMEOUT,
            passed_over: range.start,
        };
        if range.is_empty() {
            return Ok(reader);
        }
        for (view, &size) in self.views.iter().zip(&self.sizes) {
            let mut stream = ViewStream::open(view, range.clone(), size, self.views.len())?;
            let (sender, frames) = sync_channel(READ_AHEAD);
            let decoders = stream.stoppers();
            let thread = thread::Builder::new()
                .name(format!("read {}", view.camera))
                .spawn(move || stream.send_all(&sender))
                .context("cannot start a thread to read pictures")?;
            reader.views.push(ViewThread { camera: view.camera.clone(), frames, thread: Some(thread), decoders });
        }
        Ok(reader)
    }

    /// The plate of each view's empty scene at the working size, given or learnt, where the view has one.
    ///
    /// # Errors
    /// When a plate cannot be read, or is neither of the calibration's size, nor an exact fraction of it, nor of the working size.
    pub fn backgrounds(&self) -> Result<Vec<Option<RgbImage>>> {
        let plates = self.views.iter().zip(&self.sizes).map(|(view, &size)| {
            let Some(path) = &view.background else { return Ok(view.learnt.as_deref().cloned()) };
            let (turn, found) = still(path, |found| is_plate_size(found, view.size, size))?;
            let expected = if is_plate_size(found, view.size, size) { vec![found] } else { vec![view.size, size] };
            let expected: Vec<[u32; 2]> = expected.into_iter().map(|size| turn.back().turned(size)).collect();
            Ok(Some(area_average(in_colour(turn.of(read_picture(path, &expected)?)), size)))
        });
        plates.collect()
    }
}

impl FrameReader {
    /// The same reader, whose views may take `timeout` for a picture; [`STALL_TIMEOUT`] without.
    #[must_use]
    pub fn with_stall_timeout(mut self, timeout: Duration) -> Self {
        self.stall_timeout = timeout;
        self
    }

    /// The next frame of every view; `None` after the last of the range, and after an error.
    ///
    /// # Errors
    /// One sentence with the file: a decoder that stopped, a picture that cannot be read or has another size; or with the
    /// camera: no picture came in time.
    pub fn next_frame(&mut self) -> Result<Option<FrameSet>> {
        if self.next >= self.end {
            return Ok(None);
        }
        let set = self.receive();
        match &set {
            Ok(_) => self.next += 1,
            // The views would be out of step from here on.
            Err(_) => self.end = self.next,
        }
        set.map(Some)
    }

    fn receive(&mut self) -> Result<FrameSet> {
        let patience = self.stall_timeout + PASSED_OVER * u32::try_from(self.passed_over).unwrap_or(u32::MAX);
        self.passed_over = 0;
        let mut set = FrameSet { index: self.next, pictures: Vec::new(), masks: Vec::new(), ignored: Vec::new() };
        for view in &self.views {
            let (picture, mask, ignored) = view.frames.recv_timeout(patience).map_err(|error| match error {
                RecvTimeoutError::Timeout => anyhow!(
                    "camera {:?} stalled: no picture of frame {} came in {:.1} s (--stall-timeout)",
                    view.camera,
                    self.next,
                    patience.as_secs_f64()
                ),
                RecvTimeoutError::Disconnected => {
                    anyhow!("the pictures of camera {:?} ended before frame {}", view.camera, self.next)
                }
            })??;
            set.pictures.push(picture);
            set.masks.push(mask);
            set.ignored.push(ignored);
        }
        Ok(set)
    }
}

impl Drop for FrameReader {
    fn drop(&mut self) {
        for view in self.views.drain(..) {
            let ViewThread { frames, thread, decoders, .. } = view;
            // With the receiver gone the thread's next send fails, which ends it; and it waits for no decoder that is
            // still on its way to the first frame of the range.
            drop(frames);
            decoders.iter().for_each(Stopper::stop);
            if let Some(thread) = thread {
                let _ = thread.join();
            }
        }
    }
}

/// What a view's thread reads from.
struct ViewStream {
    size: [u32; 2],
    frames: Range<usize>,
    pictures: Stream,
    picks: Option<Arc<[u32]>>,
    picture_size: [u32; 2],
    masks: Option<(Stream, [u32; 2])>,
    ignored: Option<IgnoredFrames>,
}

enum Stream {
    Video(VideoDecoder),
    Pictures(PicturePattern),
}

impl Stream {
    fn open(
        (view, source): (&View, &Source),
        frames: Range<usize>,
        size: [u32; 2],
        format: PixelFormat,
        side_by_side: usize,
    ) -> Result<Self> {
        Ok(match source {
            Source::Video(video) => {
                let picks = view.picks.as_ref();
                Self::Video(VideoDecoder::open(video, picks, frames, size, format, side_by_side)?)
            }
            Source::Pictures(pattern) => Self::Pictures(pattern.clone()),
            Source::Live(live) => bail!("{} is live, which only `track --realtime` reads", live.address),
        })
    }
}

/// The number of a frame's stored picture.
fn picked(picks: Option<&[u32]>, frame: usize) -> usize {
    picks.and_then(|picks| picks.get(frame)).map_or(frame, |pick| *pick as usize)
}

impl ViewStream {
    /// The pictures of a view, one of `views` that are read side by side.
    fn open(view: &View, frames: Range<usize>, size: [u32; 2], views: usize) -> Result<Self> {
        let pictures = Stream::open((view, &view.source), frames.clone(), size, PixelFormat::Rgb, views)?;
        let masks = match &view.mask {
            // At the stored size: a silhouette is thinned out by us, never averaged.
            Some((mask, stored)) => {
                Some((Stream::open((view, mask), frames.clone(), *stored, PixelFormat::Grey, views)?, *stored))
            }
            None => None,
        };
        let ignored = view.ignored.as_ref().map(|ignored| ignored.frames(size)).transpose()?;
        Ok(Self { size, frames, pictures, picks: view.picks.clone(), picture_size: view.size, masks, ignored })
    }

    fn stoppers(&self) -> Vec<Stopper> {
        let streams = [Some(&self.pictures), self.masks.as_ref().map(|(masks, _)| masks)];
        let decoders = streams.into_iter().flatten().filter_map(|stream| match stream {
            Stream::Video(decoder) => Some(decoder.stopper()),
            Stream::Pictures(_) => None,
        });
        decoders.collect()
    }

    fn send_all(&mut self, sender: &SyncSender<Result<ViewFrame>>) {
        for frame in self.frames.clone() {
            let read = self.read(frame);
            let failed = read.is_err();
            if sender.send(read).is_err() || failed {
                return;
            }
        }
    }

    fn read(&mut self, frame: usize) -> Result<ViewFrame> {
        let [width, height] = self.size;
        let number = picked(self.picks.as_deref(), frame);
        let picture = match &mut self.pictures {
            Stream::Video(decoder) => {
                let bytes = decoder.next_frame()?.unwrap_or_default();
                RgbImage::from_raw(width, height, bytes).with_context(|| format!("frame {frame} has too few bytes"))?
            }
            Stream::Pictures(pattern) => area_average(in_colour(pattern.read(number, self.picture_size)?), self.size),
        };
        let ignored = self.ignored.as_ref().map(|ignored| ignored.of_frame(number, self.size)).transpose()?;
        let Some((masks, stored)) = &mut self.masks else { return Ok((picture, None, ignored)) };
        let mask = match masks {
            Stream::Video(decoder) => {
                let bytes = decoder.next_frame()?.unwrap_or_default();
                GrayImage::from_raw(stored[0], stored[1], bytes)
                    .with_context(|| format!("the mask of frame {frame} has too few bytes"))?
            }
            Stream::Pictures(pattern) => in_grey(pattern.read(number, *stored)?),
        };
        Ok((picture, Some(nearest_mask(&mask, self.size)), ignored))
    }
}
