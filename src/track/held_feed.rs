//! Frames whose features a device makes and holds: while it is at work with one, the next is read.

use std::sync::mpsc::SyncSender;
use std::time::Instant;

use anyhow::Result;

use super::prepared::Prepared;
use super::timings::Span;
use crate::observe::Observer;
use crate::sequence::FrameSet;

/// Makes one frame after the other, from the frame `from` on.
pub(super) struct HeldWorker {
    pub(super) observer: Observer,
    pub(super) from: usize,
}

/// A frame that was read, and how long that took.
type Read = (FrameSet, Span);

impl HeldWorker {
    /// Sends all frames, and what went wrong, until nobody listens.
    pub(super) fn run(&mut self, sender: &SyncSender<Result<Prepared>>) {
        if let Err(error) = self.send_all(sender) {
            let _ = sender.send(Err(error));
        }
    }

    fn send_all(&mut self, sender: &SyncSender<Result<Prepared>>) -> Result<()> {
        let Some(mut read) = self.read()? else { return Ok(()) };
        loop {
            // The search may still have both memories.
            self.observer.reserve()?;
            let start = Instant::now();
            self.observer.begin(&read.0)?;
            // What goes wrong with the next frame is told after this one.
            let next = self.read();
            let prepared = self.finish(read, start)?;
            if sender.send(Ok(prepared)).is_err() {
                return Ok(());
            }
            match next? {
                Some(frame) => read = frame,
                None => return Ok(()),
            }
        }
    }

    /// The next frame that is to be searched; `None` after the last.
    fn read(&mut self) -> Result<Option<Read>> {
        loop {
            let start = Instant::now();
            let Some(frame) = self.observer.read()? else { return Ok(None) };
            let read = Span::since(start);
            if self.observer.is_background(&frame)? {
                continue;
            }
            if frame.index >= self.from {
                return Ok(Some((frame, read)));
            }
            if self.observer.learns() {
                self.observer.begin(&frame)?;
                self.observer.finish()?;
            }
        }
    }

    /// The frame that was begun at `start`, when the device is done with it.
    fn finish(&mut self, (frame, read): Read, start: Instant) -> Result<Prepared> {
        let held = self.observer.finish()?;
        Ok(Prepared {
            index: frame.index,
            pictures: frame.pictures,
            observations: Vec::new(),
            held: Some(held),
            likelihoods: Vec::new(),
            features_kept: Vec::new(),
            silent: Vec::new(),
            read,
            features: Span::since(start),
            captured: None,
        })
    }
}
