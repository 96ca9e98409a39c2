//! The features of one frame after the other, prepared by a thread of their own while the frame before is searched.

use std::ops::Range;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use image::RgbImage;

use super::timings::Span;
use crate::features::{FeatureSettings, Likelihood, Observation, ViewFeatures};
use crate::observe::{Observer, take_likelihoods, take_observations};
use crate::sequence::Sequence;

/// Frames that wait for the search. Together with the one being prepared this bounds the memory.
const AHEAD: usize = 1;

/// A frame ready to be searched.
pub(super) struct Prepared {
    /// Its index in the sequence.
    pub(super) index: usize,
    /// The pictures at working size, one a view.
    pub(super) pictures: Vec<RgbImage>,
    /// What was seen, one a view.
    pub(super) observations: Vec<Observation>,
    /// How likely each pixel is as background, one a view; none where poses are not compared by evidence.
    pub(super) likelihoods: Vec<Likelihood>,
    /// All features of every view but the likelihoods, where several people are told apart by them; else none.
    pub(super) features_kept: Vec<ViewFeatures>,
    /// Waiting for the pictures.
    pub(super) read: Span,
    /// Making the features.
    pub(super) features: Span,
    /// When it was captured, where it was just now.
    pub(super) captured: Option<Instant>,
}

/// Where prepared frames come from.
pub(super) trait Frames {
    /// The next frame; `None` after the last.
    ///
    /// # Errors
    /// What went wrong in another thread: a picture that cannot be read, say.
    fn next(&mut self) -> Result<Option<Prepared>>;
}

/// The thread. Dropping it ends it.
pub(super) struct Feed {
    frames: Option<Receiver<Result<Prepared>>>,
    thread: Option<JoinHandle<()>>,
}

impl Feed {
    /// Prepares the frames of `range`, handing over those from `from` on, with all their features where `keeps_features` says so.
    ///
    /// # Errors
    /// As [`Observer::new`], or when the thread cannot be started.
    pub(super) fn start(
        sequence: &Sequence,
        settings: FeatureSettings,
        range: Range<usize>,
        from: usize,
        stall_timeout: Duration,
        keeps_features: bool,
    ) -> Result<Self> {
        let observer = Observer::new(sequence, settings, range, from)?.with_stall_timeout(stall_timeout);
        let (sender, frames) = sync_channel(AHEAD);
        let mut worker = Worker { observer, from, keeps_features };
        let thread = thread::Builder::new()
            .name("features".to_string())
            .spawn(move || worker.run(&sender))
            .context("cannot start the thread for the features")?;
        Ok(Self { frames: Some(frames), thread: Some(thread) })
    }
}

impl Frames for Feed {
    fn next(&mut self) -> Result<Option<Prepared>> {
        let Some(frames) = &self.frames else { return Ok(None) };
        match frames.recv() {
            Ok(prepared) => prepared.map(Some),
            Err(_) => {
                self.frames = None;
                match self.thread.take().map(JoinHandle::join) {
                    Some(Err(_)) => bail!("the thread for the features failed; its message stands above"),
                    _ => Ok(None),
                }
            }
        }
    }
}

impl Drop for Feed {
    fn drop(&mut self) {
        // Without a receiver the thread's next send fails, which ends it.
        self.frames = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

struct Worker {
    observer: Observer,
    from: usize,
    keeps_features: bool,
}

impl Worker {
    fn run(&mut self, sender: &SyncSender<Result<Prepared>>) {
        loop {
            let prepared = self.prepare();
            let failed = prepared.is_err();
            let Some(prepared) = prepared.transpose() else { return };
            if sender.send(prepared).is_err() || failed {
                return;
            }
        }
    }

    /// The next frame that is to be searched; `None` after the last.
    fn prepare(&mut self) -> Result<Option<Prepared>> {
        loop {
            let start = Instant::now();
            let Some(frame) = self.observer.read()? else { return Ok(None) };
            let read = Span::since(start);
            let start = Instant::now();
            let Some(features) = self.observer.features(&frame, frame.index >= self.from)? else { continue };
            let made = Span::since(start);
            let likelihoods = take_likelihoods(features);
            let features_kept = if self.keeps_features { features.to_vec() } else { Vec::new() };
            return Ok(Some(Prepared {
                index: frame.index,
                observations: take_observations(features),
                likelihoods,
                features_kept,
                pictures: frame.pictures,
                read,
                features: made,
                captured: None,
            }));
        }
    }
}
