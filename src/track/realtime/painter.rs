//! The newest overlays for the live page, drawn and packed in a thread of their own: the tracker only leaves a copy of a frame's pictures,
//! at most every half second, and none while nobody looks.

use std::sync::Arc;
use std::thread::{self, JoinHandle};

use anyhow::{Context, Result};
use image::RgbImage;

use crate::body::{Body, Mesh};
use crate::geometry::Camera;
use crate::live::{Board, Slot};
use crate::report::jpeg;
use crate::track::FrameResult;
use crate::track::feed::Prepared;
use crate::track::overlay::Overlay;

/// A frame to be drawn.
struct Shown {
    frame: usize,
    pose: Vec<f32>,
    pictures: Vec<RgbImage>,
}

/// The thread. Dropping it ends it.
pub(super) struct Painter {
    frames: Arc<Slot<Shown>>,
    board: Arc<Board>,
    thread: Option<JoinHandle<()>>,
}

impl Painter {
    /// Draws for a board.
    pub(super) fn start(board: Arc<Board>, body: &Body, mesh: Option<&Mesh>, cameras: &[Camera]) -> Result<Self> {
        let (body, mesh, cameras) = (body.clone(), mesh.cloned(), cameras.to_vec());
        // What cannot be drawn is said before the run begins.
        Overlay::new(&body, mesh.as_ref(), &cameras)?;
        let frames: Arc<Slot<Shown>> = Arc::default();
        let (waiting, shown) = (Arc::clone(&frames), Arc::clone(&board));
        let work = move || {
            let Ok(overlay) = Overlay::new(&body, mesh.as_ref(), &cameras) else { return };
            while let Ok(Some(Shown { frame, pose, pictures })) = waiting.take() {
                let views = pictures.iter().enumerate();
                let drawn = views.map(|(view, picture)| jpeg(&overlay.draw(picture, view, &pose)?));
                // A picture that cannot be drawn leaves the page with the one before.
                if let Ok(views) = drawn.collect::<Result<Vec<_>>>() {
                    shown.show(frame, views);
                }
            }
        };
        let thread = thread::Builder::new().name("painter".to_string()).spawn(work);
        let thread = thread.context("cannot start the thread that draws for the live page")?;
        Ok(Self { frames, board, thread: Some(thread) })
    }

    /// Leaves a frame to be drawn, if it is time for one.
    pub(super) fn offer(&self, prepared: &Prepared, result: &FrameResult) {
        if self.board.wants_pictures() {
            let (pose, pictures) = (result.pose.clone(), prepared.pictures.clone());
            let _ = self.frames.put(Shown { frame: result.frame, pose, pictures });
        }
    }
}

impl Drop for Painter {
    fn drop(&mut self) {
        self.frames.close();
        self.frames.finish(Ok(()));
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
