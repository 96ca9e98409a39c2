//! The features of one frame after the other, prepared by a thread of their own while the frame before is searched.

use std::ops::Range;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};

use super::held_feed::HeldWorker;
pub(super) use super::prepared::Prepared;
use super::timings::Span;
use crate::features::FeatureSettings;
use crate::gpu::{Device, Timing};
use crate::observe::{Observer, take_likelihoods, take_observations};
use crate::sequence::Sequence;

/// Frames that wait for the search. Together with the one being prepared this bounds the memory.
const AHEAD: usize = 1;

/// What becomes of a frame's features.
pub(super) enum Keeps<'a> {
    /// Observations, and likelihoods where they are asked for.
    Observations,
    /// All features with them.
    Features,
    /// A device makes and holds the observations. Its passes are timed where that is asked for.
    OnDevice(&'a Device, Timing),
}

/// Where prepared frames come from.
pub(super) trait Frames: Send {
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
    /// Prepares the frames of `range`, handing over those from `from` on, with what is kept of them.
    ///
    /// # Errors
    /// As [`Observer::new`] and [`Observer::hold_on`], or when the thread cannot be started.
    pub(super) fn start(
        sequence: &Sequence,
        settings: FeatureSettings,
        range: Range<usize>,
        from: usize,
        stall_timeout: Duration,
        keeps: &Keeps<'_>,
    ) -> Result<Self> {
        let mut observer = Observer::new(sequence, settings, range, from)?.with_stall_timeout(stall_timeout);
        let (sender, frames) = sync_channel(AHEAD);
        let thread = thread::Builder::new().name("features".to_string());
        let thread = match keeps {
            Keeps::Observations | Keeps::Features => {
                let mut worker = Worker { observer, from, keeps_features: matches!(keeps, Keeps::Features) };
                thread.spawn(move || worker.run(&sender))
            }
            Keeps::OnDevice(device, timing) => {
                let hold = observer.hold_on(device, *timing != Timing::Off);
                hold.context("a device cannot make the features: --features cpu does without")?;
                let mut worker = HeldWorker { observer, from };
                thread.spawn(move || worker.run(&sender))
            }
        };
        let thread = thread.context("cannot start the thread for the features")?;
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
                ended_well(self.thread.take().map(JoinHandle::join), "the features")?;
                Ok(None)
            }
        }
    }
}

/// What is said of a thread for something that sends no more.
///
/// # Errors
/// When it panicked.
pub(super) fn ended_well(ended: Option<thread::Result<()>>, what: &str) -> Result<()> {
    ensure!(!matches!(ended, Some(Err(_))), "the thread for {what} failed; its message stands above");
    Ok(())
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
                held: None,
                likelihoods,
                features_kept,
                silent: Vec::new(),
                pictures: frame.pictures,
                read,
                features: made,
                captured: None,
            }));
        }
    }
}
