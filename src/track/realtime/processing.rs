//! The module between capture and tracking: the features of each view by a worker of its own (METHOD A11).

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::Instant;

use anyhow::{Context, Result, anyhow};
use image::{GrayImage, RgbImage};

use super::timeline::{Row, Timeline};
use crate::features::{BitImage, Extractor, Likelihood, Observation, ViewFeatures};
use crate::sequence::{Captured, FrameSet};
use crate::track::feed::Prepared;
use crate::track::timings::Span;

/// The workers. A set goes to all of them at once, so that a set is either processed whole or passed over whole.
pub(super) struct Processing {
    workers: Vec<Worker>,
    done: Receiver<(usize, Result<Done>)>,
}

struct Worker {
    tasks: Option<SyncSender<Task>>,
    thread: Option<JoinHandle<()>>,
}

struct Task {
    frame: usize,
    picture: RgbImage,
    mask: Option<GrayImage>,
    ignored: Option<Arc<GrayImage>>,
}

struct Done {
    picture: RgbImage,
    observation: Observation,
    likelihood: Option<Likelihood>,
}

impl Processing {
    /// A worker for each extractor, which is of one view.
    ///
    /// # Errors
    /// When a thread cannot be started.
    pub(super) fn start(extractors: Vec<Extractor>, timeline: &Arc<Timeline>) -> Result<Self> {
        let (sender, done) = channel();
        let mut workers = Vec::new();
        for (view, extractor) in extractors.into_iter().enumerate() {
            let (tasks, received) = sync_channel(1);
            let (sender, timeline) = (sender.clone(), Arc::clone(timeline));
            let thread = thread::Builder::new()
                .name(format!("process {view}"))
                .spawn(move || work(view, extractor, &received, &sender, &timeline))
                .context("cannot start a thread for the features")?;
            workers.push(Worker { tasks: Some(tasks), thread: Some(thread) });
        }
        Ok(Self { workers, done })
    }

    /// The features of a set.
    ///
    /// # Errors
    /// When a picture does not fit its view.
    pub(super) fn process(&self, Captured { set, at, silent }: Captured) -> Result<Prepared> {
        let read = Span::since(at);
        let begin = Instant::now();
        let FrameSet { index, pictures, masks, ignored } = set;
        let failed = || anyhow!("a worker for the features failed; its message stands above");
        for (((worker, picture), mask), ignored) in self.workers.iter().zip(pictures).zip(masks).zip(ignored) {
            let tasks = worker.tasks.as_ref().ok_or_else(failed)?;
            tasks.send(Task { frame: index, picture, mask, ignored }).map_err(|_| failed())?;
        }
        let mut views: Vec<Option<Done>> = self.workers.iter().map(|_| None).collect();
        for _ in &self.workers {
            let (view, done) = self.done.recv().map_err(|_| failed())?;
            views[view] = Some(done?);
        }
        let (mut pictures, mut observations, mut likelihoods) = (Vec::new(), Vec::new(), Vec::new());
        for Done { picture, observation, likelihood } in views.into_iter().flatten() {
            pictures.push(picture);
            observations.push(observation);
            likelihoods.extend(likelihood);
        }
        let features = Span::since(begin);
        let features_kept = Vec::new();
        Ok(Prepared {
            index,
            pictures,
            observations,
            held: None,
            likelihoods,
            features_kept,
            silent,
            read,
            features,
            captured: Some(at),
        })
    }
}

impl Drop for Processing {
    fn drop(&mut self) {
        for worker in &mut self.workers {
            worker.tasks = None;
            if let Some(thread) = worker.thread.take() {
                let _ = thread.join();
            }
        }
    }
}

fn work(
    view: usize,
    mut extractor: Extractor,
    tasks: &Receiver<Task>,
    sender: &Sender<(usize, Result<Done>)>,
    timeline: &Timeline,
) {
    let mut features = vec![ViewFeatures::empty(1, 1)];
    while let Ok(Task { frame, picture, mask, ignored }) = tasks.recv() {
        let start = Instant::now();
        let process = || -> Result<(Observation, Option<Likelihood>)> {
            extractor.extract_into(std::slice::from_ref(&picture), std::slice::from_ref(&mask), &mut features)?;
            let ignored = ignored.as_deref().map(|mask| Arc::new(BitImage::of_gray(mask)));
            extractor.ignore(&mut features, &[ignored])?;
            let observation = std::mem::replace(&mut features[0].observation, Observation::empty(0, 0));
            Ok((observation, features[0].likelihood.take()))
        };
        // A worker that died without a word would leave the others waiting for ever.
        let done = catch_unwind(AssertUnwindSafe(process)).unwrap_or_else(|_| {
            Err(anyhow!("the worker for the features of view {view} failed; its message stands above"))
        });
        timeline.worked(Row::View(view), frame, Span::since(start));
        let done = done.map(|(observation, likelihood)| Done { picture, observation, likelihood });
        if sender.send((view, done)).is_err() {
            return;
        }
    }
}
