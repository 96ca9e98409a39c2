//! Acquisition and processing in threads of their own, and what they hand to the tracker: the newest complete set.

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use anyhow::{Context, Result, anyhow};

use super::processing::Processing;
use super::tally::Counts;
use super::timeline::{Row, Timeline};
use crate::features::FeatureSettings;
use crate::live::Slot;
use crate::observe::view_extractors;
use crate::sequence::{Captured, LiveReader, Playback, Player, Sequence};
use crate::track::feed::{Frames, Prepared};

/// Where captured sets come from.
pub(super) enum Acquisition {
    Recorded(Box<Player>),
    Live(Box<LiveReader>),
}

/// How the pictures of a run come.
#[derive(Clone, Debug)]
pub(super) struct Input {
    /// The frames of a round.
    pub(super) range: Range<usize>,
    /// Frames to play in all.
    pub(super) frames: usize,
    /// The first frame that is wanted.
    pub(super) from: usize,
    /// Frames a second.
    pub(super) fps: f64,
    pub(super) stall_timeout: Duration,
}

impl Acquisition {
    /// Opens the sources of a sequence.
    ///
    /// # Errors
    /// When a decoder cannot be started.
    pub(super) fn open(sequence: &Sequence, input: &Input) -> Result<Self> {
        let Input { range, frames, from, fps, stall_timeout } = input.clone();
        if sequence.is_live() {
            return Ok(Self::Live(Box::new(sequence.read_live(from, stall_timeout)?)));
        }
        let skip = from - range.start;
        Ok(Self::Recorded(Box::new(Player::start(sequence, Playback { range, fps, frames, skip, stall_timeout })?)))
    }

    /// The next set, which is counted.
    fn next(&mut self, counts: &Counts) -> Result<Option<Captured>> {
        let captured = match self {
            Self::Recorded(player) => {
                let captured = player.next_frame();
                counts.late.store(player.late(), Ordering::Relaxed);
                captured
            }
            Self::Live(reader) => {
                let captured = reader.next_set();
                counts.unmatched.store(reader.unmatched(), Ordering::Relaxed);
                counts.set_apart(reader.apart());
                counts.complaints.store(reader.complaints(), Ordering::Relaxed);
                counts.add_news(reader.take_news());
                if let Some(how) = reader.ended() {
                    counts.end(how);
                }
                captured
            }
        };
        if let Ok(Some(captured)) = &captured {
            counts.capture(captured.at);
        }
        captured
    }
}

/// The threads. Dropping it ends them.
pub(crate) struct RealtimeFeed {
    processed: Arc<Slot<Prepared>>,
    threads: Vec<JoinHandle<()>>,
}

impl RealtimeFeed {
    /// Starts capturing.
    ///
    /// # Errors
    /// When the feature settings make no sense, a plate cannot be read, decoders or threads cannot be started, or the
    /// frames before the range, which a background is learnt from, cannot be read.
    pub(super) fn start(
        sequence: &Sequence,
        settings: &FeatureSettings,
        input: &Input,
        counts: &Arc<Counts>,
        timeline: &Arc<Timeline>,
    ) -> Result<Self> {
        let extractors = view_extractors(sequence, settings, input.range.start)?;
        let processing = Processing::start(extractors, timeline)?;
        let mut acquisition = Acquisition::open(sequence, input)?;
        let captured: Arc<Slot<Captured>> = Arc::default();
        let processed: Arc<Slot<Prepared>> = Arc::default();
        let mut feed = Self { processed: Arc::clone(&processed), threads: Vec::new() };
        {
            let (captured, counts, timeline) = (Arc::clone(&captured), Arc::clone(counts), Arc::clone(timeline));
            let end = tells_end_of(&captured);
            feed.spawn("acquisition", end, move || {
                while let Some(set) = acquisition.next(&counts)? {
                    timeline.came(Row::Acquisition, set.set.index, set.at);
                    let Ok(passed_over) = captured.put(set) else { break };
                    if let Some(old) = passed_over {
                        counts.not_processed.fetch_add(1, Ordering::Relaxed);
                        timeline.dropped(Row::Acquisition, old.set.index);
                    }
                }
                Ok(())
            })?;
        }
        let (counts, timeline) = (Arc::clone(counts), Arc::clone(timeline));
        let end = tells_end_of(&processed);
        // Made here, so that acquisition ends even if this thread never begins.
        let captured = Closes(captured);
        feed.spawn("processing", end, move || {
            let captured = captured;
            while let Some(set) = captured.0.take()? {
                let Ok(passed_over) = processed.put(processing.process(set)?) else { break };
                if let Some(old) = passed_over {
                    counts.not_tracked.fetch_add(1, Ordering::Relaxed);
                    timeline.dropped(Row::Tracking, old.index);
                }
            }
            Ok(())
        })?;
        Ok(feed)
    }

    fn spawn(
        &mut self,
        name: &'static str,
        end: impl Fn(Result<()>) + Send + 'static,
        work: impl FnOnce() -> Result<()> + Send + 'static,
    ) -> Result<()> {
        let run = move || {
            // Whoever waits must hear of the end, however it came.
            let end = Ends { end, name };
            (end.end)(work());
        };
        let thread = thread::Builder::new().name(name.to_string()).spawn(run);
        self.threads.push(thread.with_context(|| format!("cannot start the thread for {name}"))?);
        Ok(())
    }
}

/// How a thread tells the reader of its slot that it has ended.
fn tells_end_of<T: Send + 'static>(slot: &Arc<Slot<T>>) -> impl Fn(Result<()>) + Send + 'static {
    let slot = Arc::clone(slot);
    move |end| slot.finish(end)
}

/// Tells of the end of a thread that panicked; after a proper end it goes unheard.
struct Ends<E: Fn(Result<()>)> {
    end: E,
    name: &'static str,
}

impl<E: Fn(Result<()>)> Drop for Ends<E> {
    fn drop(&mut self) {
        (self.end)(Err(anyhow!("the thread for {} failed; its message stands above", self.name)));
    }
}

/// Closes a slot when its reader ends.
struct Closes<T>(Arc<Slot<T>>);

impl<T> Drop for Closes<T> {
    fn drop(&mut self) {
        self.0.close();
    }
}

impl Frames for RealtimeFeed {
    fn next(&mut self) -> Result<Option<Prepared>> {
        self.processed.take()
    }
}

impl Drop for RealtimeFeed {
    fn drop(&mut self) {
        // Without a reader the threads' next put fails, which ends them.
        self.processed.close();
        for thread in self.threads.drain(..) {
            let _ = thread.join();
        }
    }
}
