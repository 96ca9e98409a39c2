//! Poses sent on as they are found: a thread makes of each what goes out, judged as confidence.csv judges it, and hands it to the
//! outlets. The tracker only leaves a copy of its result.

use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

use crate::body::Body;
use crate::live::{Lines, LivePose, Outgoing, Outlet, SentSummary, Slot};
use crate::track::confidence::{Confidence, LossRule};
use crate::track::{FrameResult, TrackSettings};

/// Poses that wait to be made ready. The thread waits for nobody, so there are hardly ever two.
const ROOM: usize = 256;

/// Outlets that are open, before the run begins.
pub(crate) struct OpenOutlets(Vec<Box<dyn Outlet>>);

impl OpenOutlets {
    /// Those that the settings ask for.
    ///
    /// # Errors
    /// One sentence with the destination that cannot be opened.
    pub(crate) fn of(settings: &TrackSettings, body: &Body) -> Result<Self> {
        let Some(realtime) = &settings.realtime else { return Ok(Self(Vec::new())) };
        Ok(Self(crate::live::open(&realtime.send, body)?))
    }

    /// Starts the thread, where there is anything to do; `done` are the frames of an earlier run, by which later ones are judged.
    pub(super) fn start(self, body: &Body, fps: f64, done: &[FrameResult]) -> Result<Option<Outlets>> {
        if self.0.is_empty() {
            return Ok(None);
        }
        let mut confidence = Confidence::new(body, LossRule::default());
        done.iter().for_each(|result| drop(confidence.next(result)));
        let addresses = self.0.iter().map(|outlet| outlet.address()).collect();
        let (poses, error): (Arc<Slot<Found>>, Arc<Mutex<Option<String>>>) =
            (Arc::new(Slot::with_room(ROOM)), Arc::default());
        let worker = Worker { body: body.clone(), lines: Lines::new(body), fps, confidence, outlets: self.0 };
        let (queue, failure) = (Arc::clone(&poses), Arc::clone(&error));
        let thread = thread::Builder::new()
            .name("outlets".to_string())
            .spawn(move || worker.run(&queue, &failure))
            .context("cannot start the thread that sends poses")?;
        Ok(Some(Outlets { poses, thread: Some(thread), addresses, error }))
    }
}

/// A pose as the tracker leaves it.
struct Found {
    result: FrameResult,
    latency: Duration,
}

/// The outlets of a run at work. Dropping them ends them.
pub(super) struct Outlets {
    poses: Arc<Slot<Found>>,
    thread: Option<JoinHandle<Vec<SentSummary>>>,
    addresses: Vec<String>,
    /// Why poses could not be made ready, the first time.
    error: Arc<Mutex<Option<String>>>,
}

impl Outlets {
    /// Where poses can be had.
    pub(super) fn addresses(&self) -> &[String] {
        &self.addresses
    }

    /// Leaves a pose to be sent.
    pub(super) fn send(&self, result: &FrameResult, captured: Option<Instant>) {
        let latency = captured.map_or(Duration::ZERO, |captured| captured.elapsed());
        // A thread that died has said so, and the run is worth more than what it sends.
        let _ = self.poses.put(Found { result: result.clone(), latency });
    }

    /// Sends what waits and ends; what could not be sent for another reason than its receiver becomes a warning.
    pub(super) fn finish(mut self, warnings: &mut Vec<String>) -> Vec<SentSummary> {
        let summaries = self.end();
        let error = self.error.lock().unwrap_or_else(PoisonError::into_inner).take();
        warnings.extend(error.map(|error| format!("poses could not be sent: {error}")));
        summaries
    }

    fn end(&mut self) -> Vec<SentSummary> {
        self.poses.finish(Ok(()));
        self.thread.take().and_then(|thread| thread.join().ok()).unwrap_or_default()
    }
}

impl Drop for Outlets {
    fn drop(&mut self) {
        self.end();
    }
}

struct Worker {
    body: Body,
    lines: Lines,
    fps: f64,
    confidence: Confidence,
    outlets: Vec<Box<dyn Outlet>>,
}

impl Worker {
    fn run(mut self, poses: &Slot<Found>, error: &Mutex<Option<String>>) -> Vec<SentSummary> {
        while let Ok(Some(found)) = poses.take() {
            if let Err(why) = self.send(found) {
                error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(|| format!("{why:#}"));
            }
        }
        self.outlets.into_iter().map(|outlet| outlet.finish()).collect()
    }

    fn send(&mut self, Found { result, latency }: Found) -> Result<()> {
        let judged = self.confidence.next(&result);
        let pose: Vec<f64> = result.pose.iter().map(|value| f64::from(*value)).collect();
        let bones = self.body.world_from_bones(&pose)?;
        let live = LivePose {
            frame: result.frame,
            time: result.frame as f64 / self.fps,
            latency,
            joints: self.body.joint_positions(&bones),
            pose,
            sigmas: judged.joints.iter().map(|joint| joint.sigma).collect(),
            fitness: f64::from(result.fitness),
            confidence: judged.confidence,
            wrong: judged.wrong,
            is_lost: judged.is_lost,
        };
        let outgoing = Outgoing::new(&live, &self.lines);
        self.outlets.iter_mut().try_for_each(|outlet| outlet.send(&outgoing))
    }
}
