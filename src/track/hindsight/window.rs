//! Frames seen again, some in a row at a time.

use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread::{Builder, Scope, ScopedJoinHandle};

use anyhow::{Context, Result};
use image::RgbImage;

use crate::features::Observation;
use crate::geometry::Camera;
use crate::track::appearance::RunAppearance;
use crate::track::dissent::leave_out;
use crate::track::feed::{Frames, Prepared, ended_well};
use crate::track::journal::FrameResult;

/// Bytes that the observations of a window may take, and as many those of frames that are made while it is worked on; frames that it has at least
/// and at most.
const BYTES: usize = 512 << 20;
const FRAMES: [usize; 2] = [8, 256];
/// What a pixel of them takes, with evidence.
const BYTES_PER_PIXEL: usize = 5;
/// Frames of a window that the next one sees again, and at most which share of it, as its inverse.
const OVERLAP: usize = 16;
const SHARE: usize = 4;

/// What was seen in a frame.
pub(super) struct Seen {
    pub(super) index: usize,
    pub(super) observations: Vec<Observation>,
    /// Its pictures, where they are asked for.
    pub(super) pictures: Option<Vec<RgbImage>>,
}

/// The frames of a run again, in windows that overlap. They are made by a thread of their own, so that those of the next window are there when
/// the poses of one are settled.
pub(super) struct Windows<'scope> {
    made: Receiver<Result<Seen>>,
    thread: Option<ScopedJoinHandle<'scope, ()>>,
    seen: VecDeque<Seen>,
    size: usize,
    is_over: bool,
}

impl<'scope> Windows<'scope> {
    /// From the first frame of a run on, seen by cameras at working size; the evidence is what `appearance` knows, without that of views which
    /// the first pass, `forward`, leaves out. Every `pictures_every` frames keep their pictures.
    ///
    /// # Errors
    /// When the thread cannot be started.
    pub(super) fn begin<'env>(
        scope: &'scope Scope<'scope, 'env>,
        feed: &'env mut dyn Frames,
        (appearance, forward): (Option<&'env RunAppearance>, &'env [FrameResult]),
        cameras: &[Camera],
        pictures_every: usize,
    ) -> Result<Self> {
        let pixels: usize = cameras.iter().map(|camera| camera.size[0] as usize * camera.size[1] as usize).sum();
        let ahead = BYTES / (BYTES_PER_PIXEL * pixels).max(1);
        let (sender, made) = sync_channel(ahead.clamp(1, FRAMES[1]));
        let send_all = move || {
            let mut forward = forward.iter();
            // Without a receiver nobody wants more.
            while let Some(seen) = next(feed, appearance, pictures_every, forward.next()).transpose() {
                let is_last = seen.is_err();
                if sender.send(seen).is_err() || is_last {
                    return;
                }
            }
        };
        let thread = Builder::new().name("frames again".to_string()).spawn_scoped(scope, send_all);
        let thread = thread.context("cannot start the thread for the frames of the second pass")?;
        Ok(Self { made, thread: Some(thread), seen: VecDeque::new(), size: FRAMES[0], is_over: false })
    }

    /// Takes frames until the window is full or there are no more.
    ///
    /// # Errors
    /// When a frame cannot be read.
    pub(super) fn fill(&mut self) -> Result<()> {
        while !self.is_over && self.seen.len() < self.size {
            let Ok(seen) = self.made.recv() else {
                self.is_over = true;
                ended_well(self.thread.take().map(ScopedJoinHandle::join), "the frames of the second pass")?;
                break;
            };
            let seen = seen?;
            let bytes: usize = seen.observations.iter().map(bytes_of).sum();
            self.size = (BYTES / bytes.max(1)).clamp(FRAMES[0], FRAMES[1]);
            self.seen.push_back(seen);
        }
        Ok(())
    }

    /// The frames in it.
    pub(super) fn seen(&self) -> &VecDeque<Seen> {
        &self.seen
    }

    /// How many of its frames are settled with it: the others are seen again in the next.
    pub(super) fn settled(&self) -> usize {
        let count = self.seen.len();
        if self.is_over { count } else { count - OVERLAP.min(count / SHARE) }
    }

    /// Forgets the first frames.
    pub(super) fn forget(&mut self, count: usize) {
        self.seen.drain(..count);
    }
}

/// The next frame of a feed as it is seen again, without the views that its result in the first pass leaves out; none after
/// the last.
fn next(
    feed: &mut dyn Frames,
    appearance: Option<&RunAppearance>,
    pictures_every: usize,
    first: Option<&FrameResult>,
) -> Result<Option<Seen>> {
    let Some(mut prepared) = feed.next()? else { return Ok(None) };
    if let Some(appearance) = appearance {
        appearance.observe(&mut prepared)?;
    }
    let Prepared { index, mut observations, pictures, .. } = prepared;
    for view in first.into_iter().flat_map(FrameResult::left_out) {
        leave_out(&mut observations[view])?;
    }
    let is_shown = pictures_every > 0 && index.is_multiple_of(pictures_every);
    Ok(Some(Seen { index, observations, pictures: is_shown.then_some(pictures) }))
}

/// What an observation takes in memory.
fn bytes_of(observation: &Observation) -> usize {
    let segments = observation.segmentation.as_ref().map_or(0, |segmentation| segmentation.numbers().len());
    let evidence = observation.evidence.as_ref().map_or(0, |evidence| 4 * evidence.words().len());
    observation.bytes.len() + segments + evidence
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use anyhow::anyhow;

    use super::*;
    use crate::track::timings::Span;

    /// Frames of one small view; after those something goes wrong, or nothing comes.
    struct Made {
        given: usize,
        until: usize,
        end: fn() -> Result<Option<Prepared>>,
    }

    impl Frames for Made {
        fn next(&mut self) -> Result<Option<Prepared>> {
            if self.given == self.until {
                return (self.end)();
            }
            let index = self.given;
            self.given += 1;
            let span = Span::since(Instant::now());
            Ok(Some(Prepared {
                index,
                pictures: vec![RgbImage::new(4, 2)],
                observations: vec![Observation::empty(4, 2)],
                held: None,
                likelihoods: Vec::new(),
                features_kept: Vec::new(),
                silent: Vec::new(),
                read: span,
                features: span,
                captured: None,
            }))
        }
    }

    /// The indices of the frames of each window of a run, and of those that keep their pictures, until none is left.
    fn windows(mut feed: Made) -> Result<Vec<[Vec<usize>; 2]>> {
        std::thread::scope(|scope| {
            let mut windows = Windows::begin(scope, &mut feed, (None, &[]), &[], 10)?;
            let mut all = Vec::new();
            loop {
                windows.fill()?;
                if windows.seen().is_empty() {
                    return Ok(all);
                }
                let shown = windows.seen().iter().filter(|seen| seen.pictures.is_some());
                let shown = shown.map(|seen| seen.index).collect();
                all.push([windows.seen().iter().map(|seen| seen.index).collect(), shown]);
                let count = windows.settled();
                windows.forget(count);
            }
        })
    }

    #[test]
    fn windows_overlap_and_end_with_the_run() {
        let made = |until| Made { given: 0, until, end: || Ok(None) };
        assert_eq!(windows(made(0)).unwrap(), Vec::<[Vec<usize>; 2]>::new());
        assert_eq!(windows(made(3)).unwrap(), [[vec![0, 1, 2], vec![0]]]);
        // Small frames fill windows of 256, of which 240 are settled.
        let found = windows(made(300)).unwrap();
        let expected = [(0..256, 0), (240..300, 240)];
        assert_eq!(found.len(), 2);
        for ([indices, shown], (range, first)) in found.into_iter().zip(expected) {
            assert_eq!(indices, range.clone().collect::<Vec<_>>());
            assert_eq!(shown, (first..range.end).step_by(10).collect::<Vec<_>>());
        }
    }

    #[test]
    fn what_goes_wrong_in_the_thread_is_told() {
        let told = |end| windows(Made { given: 0, until: 5, end }).unwrap_err().to_string();
        assert_eq!(told(|| Err(anyhow!("frame 5 is no picture"))), "frame 5 is no picture");
        assert!(told(|| panic!("planned")).starts_with("the thread for the frames of the second pass failed"));
    }

    /// Who stops early does not wait for frames that nobody wants.
    #[test]
    fn nobody_waits_for_frames_that_are_not_wanted() {
        let mut feed = Made { given: 0, until: usize::MAX, end: || Ok(None) };
        std::thread::scope(|scope| {
            let mut windows = Windows::begin(scope, &mut feed, (None, &[]), &[], 0).unwrap();
            windows.fill().unwrap();
        });
        assert!(feed.given < 1000, "{} were made", feed.given);
    }
}
