//! The features of one frame after the other, prepared by a thread of their own while the frame before is searched.

use std::ops::Range;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use image::RgbImage;

use super::stages::Span;
use crate::features::{Extractor, FeatureSettings, Observation, ViewFeatures, ViewSource};
use crate::sequence::{FrameReader, Sequence};

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
    /// Prepares the frames of `range`, handing over those from `from` on. Views whose background is learnt (neither mask
    /// nor plate) are shown every frame before `range` as empty scene, and every frame in it: their features depend on all
    /// of them, so a run that is resumed must see them again.
    ///
    /// # Errors
    /// When the feature settings make no sense, a plate cannot be read, decoders cannot be started, or a background
    /// would have to be learnt with no frame to learn it from.
    pub(super) fn start(
        sequence: &Sequence,
        settings: FeatureSettings,
        range: Range<usize>,
        from: usize,
        stall_timeout: Duration,
    ) -> Result<Self> {
        let first_read = if learns_background(sequence, &range)? { 0 } else { from };
        let extractor =
            Extractor::new(settings, view_sources(sequence)?).with_context(|| sequence.path.display().to_string())?;
        let reader = sequence.read_frames(first_read..range.end)?.with_stall_timeout(stall_timeout);
        let (sender, frames) = sync_channel(AHEAD);
        let mut worker = Worker { reader, extractor, features: Vec::new(), range, from };
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

/// What the features must know of each view.
///
/// # Errors
/// When a plate cannot be read.
pub(super) fn view_sources(sequence: &Sequence) -> Result<Vec<ViewSource>> {
    let sources = sequence.backgrounds()?.into_iter().zip(&sequence.sizes);
    Ok(sources.map(|(plate, &[width, height])| ViewSource { width, height, plate }).collect())
}

/// Whether a view's background must be learnt from the frames, having neither mask nor plate.
///
/// # Errors
/// When one must and no frame comes before `range` to learn it from.
pub(super) fn learns_background(sequence: &Sequence, range: &Range<usize>) -> Result<bool> {
    let Some(view) = sequence.views.iter().find(|view| view.mask.is_none() && view.background.is_none()) else {
        return Ok(false);
    };
    ensure!(
        range.start > 0,
        "{}: camera {:?} has neither a background picture nor masks, and no frame comes before frame 0 to learn the empty \
         scene from: give it one of them, or start later with --frames",
        sequence.path.display(),
        view.camera
    );
    Ok(true)
}

struct Worker {
    reader: FrameReader,
    extractor: Extractor,
    features: Vec<ViewFeatures>,
    range: Range<usize>,
    from: usize,
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
            let Some(frame) = self.reader.next_frame()? else { return Ok(None) };
            let read = Span::since(start);
            if frame.index < self.range.start {
                self.extractor.prime(&frame.pictures)?;
                continue;
            }
            let start = Instant::now();
            self.extractor.extract_into(&frame.pictures, &frame.masks, &mut self.features)?;
            let features = Span::since(start);
            if frame.index >= self.from {
                let take = |view: &mut ViewFeatures| std::mem::replace(&mut view.observation, Observation::empty(0, 0));
                return Ok(Some(Prepared {
                    index: frame.index,
                    observations: self.features.iter_mut().map(take).collect(),
                    pictures: frame.pictures,
                    read,
                    features,
                    captured: None,
                }));
            }
        }
    }
}
