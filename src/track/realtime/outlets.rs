//! Poses sent on as they are found: a thread makes of each what goes out, judged as confidence.csv judges it, and hands it to the
//! outlets. The tracker only leaves a copy of its result.

use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

use super::painter::Painter;
use crate::body::{Body, Mesh};
use crate::live::{Board, Lines, LivePose, Outgoing, Outlet, PageServer, SentSummary, Slot};
use crate::report::{LivePage, live_page};
use crate::sequence::Sequence;
use crate::track::confidence::{Confidence, LossRule};
use crate::track::feed::Prepared;
use crate::track::page::live_player;
use crate::track::{FrameResult, TrackSettings};

/// Poses that wait to be made ready. The thread waits for nobody, so there are hardly ever two.
const ROOM: usize = 256;

/// Outlets that are open, before the run begins.
#[derive(Default)]
pub(crate) struct OpenOutlets {
    outlets: Vec<Box<dyn Outlet>>,
    /// Where overlays are shown.
    board: Option<Arc<Board>>,
}

impl OpenOutlets {
    /// Those that the settings ask for.
    ///
    /// # Errors
    /// One sentence with the destination that cannot be opened, or the page's port.
    pub(crate) fn of(sequence: &Sequence, settings: &TrackSettings, body: &Body) -> Result<Self> {
        let Some(realtime) = &settings.realtime else { return Ok(Self::default()) };
        let mut open = Self { outlets: crate::live::open(&realtime.send, body)?, board: None };
        if let Some(port) = realtime.live {
            let deadline_ms = realtime.deadline.map(|deadline| deadline.as_secs_f64() * 1e3);
            let page = PageServer::open(port, live_page(&described(sequence, body, deadline_ms))?)?;
            open.board = Some(page.board());
            open.outlets.push(Box::new(page));
        }
        Ok(open)
    }

    /// Starts the threads, where there is anything to do; `done` are the frames of an earlier run, by which later ones are judged.
    pub(super) fn start(
        self,
        sequence: &Sequence,
        body: &Body,
        mesh: Option<&Mesh>,
        done: &[FrameResult],
    ) -> Result<Option<Outlets>> {
        let Self { outlets, board } = self;
        if outlets.is_empty() {
            return Ok(None);
        }
        let painter = board.map(|board| Painter::start(board, body, mesh, &sequence.cameras)).transpose()?;
        let mut confidence = Confidence::new(body, LossRule::default());
        done.iter().for_each(|result| drop(confidence.next(result)));
        let addresses = outlets.iter().map(|outlet| outlet.address()).collect();
        let (poses, error): (Arc<Slot<Found>>, Arc<Mutex<Option<String>>>) =
            (Arc::new(Slot::with_room(ROOM)), Arc::default());
        let worker = Worker { body: body.clone(), lines: Lines::new(body), fps: sequence.fps, confidence, outlets };
        let (queue, failure) = (Arc::clone(&poses), Arc::clone(&error));
        let thread = thread::Builder::new()
            .name("outlets".to_string())
            .spawn(move || worker.run(&queue, &failure))
            .context("cannot start the thread that sends poses")?;
        Ok(Some(Outlets { painter, poses, thread: Some(thread), addresses, error }))
    }
}

/// What the live page begins with.
fn described(sequence: &Sequence, body: &Body, deadline_ms: Option<f64>) -> LivePage {
    let cameras = &sequence.cameras;
    LivePage {
        title: sequence.name.clone(),
        subtitle: format!("{} cameras at {} frames/s, tracked as the pictures come", cameras.len(), sequence.fps),
        views: cameras.iter().map(|camera| (camera.name.clone(), camera.size)).collect(),
        player: live_player(sequence, body),
        deadline_ms,
    }
}

/// A pose as the tracker leaves it.
struct Found {
    result: FrameResult,
    latency: Duration,
}

/// The outlets of a run at work. Dropping them ends them.
pub(super) struct Outlets {
    painter: Option<Painter>,
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

    /// Leaves a frame to be drawn for whoever looks.
    pub(super) fn show(&self, prepared: &Prepared, result: &FrameResult) {
        if let Some(painter) = &self.painter {
            painter.offer(prepared, result);
        }
    }

    /// Sends what waits and ends; what could not be sent for another reason than its receiver becomes a warning.
    pub(super) fn finish(mut self, warnings: &mut Vec<String>) -> Vec<SentSummary> {
        let summaries = self.end();
        let error = self.error.lock().unwrap_or_else(PoisonError::into_inner).take();
        warnings.extend(error.map(|error| format!("poses could not be sent: {error}")));
        summaries
    }

    fn end(&mut self) -> Vec<SentSummary> {
        self.painter = None;
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
