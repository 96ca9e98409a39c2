//! Long work in a thread of its own, while Python's thread passes on its progress and listens for Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use anyhow::{Result, anyhow};
use pyo3::prelude::*;

use crate::raised;

/// How often Ctrl-C is looked for.
const LOOK: Duration = Duration::from_millis(50);

/// A step of the work.
pub(crate) struct Step {
    /// Units done.
    pub(crate) done: usize,
    /// Units in all, where that is known.
    pub(crate) total: Option<usize>,
    /// What is being done.
    pub(crate) stage: &'static str,
    /// Of tracking: frame, fitness and confidence.
    pub(crate) frame: Option<(usize, f32, f64)>,
}

/// The work's end of it.
#[derive(Clone)]
pub(crate) struct Watch {
    stop: Arc<AtomicBool>,
    steps: Sender<Step>,
}

impl Watch {
    /// Tells of a step. Nobody may be listening any more.
    pub(crate) fn tell(&self, step: Step) {
        let _ = self.steps.send(step);
    }

    /// Whether to stop.
    pub(crate) fn should_stop(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// What becomes of work when the user breaks off.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum BrokenOff {
    /// It looks at [`Watch::should_stop`] and is waited for.
    Stops,
    /// It goes on to its end, and its result is dropped.
    IsLeft,
}

/// Does the work. `progress` is called with (done, total, stage, frame, fitness, confidence); what it raises breaks the work off, as
/// Ctrl-C does.
pub(crate) fn watched<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    broken_off: BrokenOff,
    work: impl FnOnce(&Watch) -> Result<T> + Send + 'static,
) -> PyResult<T> {
    let (steps, received) = channel();
    let stop = Arc::new(AtomicBool::new(false));
    let watch = Watch { stop: Arc::clone(&stop), steps };
    let worker = thread::spawn(move || work(&watch));
    let mut raised_first = None;
    let mut received = Some(received);
    while let Some(steps) = received.take() {
        let (next, steps) = py.detach(move || next(steps));
        let told = match (&next, progress) {
            (Some(Some(step)), Some(progress)) => tell(progress, step),
            _ => Ok(()),
        };
        if let Err(error) = told.and_then(|()| py.check_signals()) {
            raised_first.get_or_insert(error);
            stop.store(true, Ordering::Relaxed);
            if broken_off == BrokenOff::IsLeft {
                break;
            }
        }
        received = next.map(|_| steps);
    }
    if let Some(error) = raised_first {
        if broken_off == BrokenOff::Stops {
            let _ = py.detach(|| worker.join());
        }
        return Err(error);
    }
    match py.detach(|| worker.join()) {
        Ok(done) => done.map_err(raised),
        Err(_) => Err(raised(anyhow!("the work ended by a mistake of pantin's own; what it printed says where"))),
    }
}

/// The next step, none within the time of a look, or `None` once the work has ended.
fn next(steps: Receiver<Step>) -> (Option<Option<Step>>, Receiver<Step>) {
    match steps.recv_timeout(LOOK) {
        Ok(step) => (Some(Some(step)), steps),
        Err(RecvTimeoutError::Timeout) => (Some(None), steps),
        Err(RecvTimeoutError::Disconnected) => (None, steps),
    }
}

fn tell(progress: &Bound<'_, PyAny>, step: &Step) -> PyResult<()> {
    let (frame, fitness, confidence) = match step.frame {
        Some((frame, fitness, confidence)) => (Some(frame), Some(fitness), Some(confidence)),
        None => (None, None, None),
    };
    progress.call1((step.done, step.total, step.stage, frame, fitness, confidence)).map(|_| ())
}
