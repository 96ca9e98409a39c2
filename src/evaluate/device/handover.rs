//! Observations that a device made itself and holds, brought to where the evaluator compares with them, and their evidence made there: on
//! the device, without the host.

use anyhow::Result;

use super::scene::DeviceScene;
use crate::features::{HeldFrame, HeldView};
use crate::gpu::{Recorder, Recording, Timing};

/// Memories that frames are held in whose recordings are kept: two take turns.
const MOST: usize = 4;

/// The recordings that bring held observations, one for each memory that they are held in.
#[derive(Debug, Default)]
pub(super) struct Handovers {
    /// The newest last.
    recorded: Vec<(Vec<HeldView>, Recording)>,
    /// Whether the newest is still to be run.
    is_due: bool,
}

impl Handovers {
    /// Has a frame's observations brought ahead of what runs next, and after that what `more` records for their views.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn take(
        &mut self,
        scene: &DeviceScene,
        frame: &HeldFrame,
        more: impl FnOnce(&mut Recorder, &[HeldView]) -> Result<()>,
    ) -> Result<()> {
        let is_it = |(views, _): &(Vec<HeldView>, Recording)| {
            let mut pairs = views.iter().zip(frame.views());
            views.len() == frame.views().len()
                && pairs.all(|(own, held)| own.pixels.is(&held.pixels) && own.planes.is(&held.planes))
        };
        match self.recorded.iter().position(is_it) {
            Some(place) => self.recorded[place..].rotate_left(1),
            None => {
                if self.recorded.len() == MOST {
                    self.recorded.remove(0);
                }
                let mut recorder = record(scene, frame.views())?;
                more(&mut recorder, frame.views())?;
                self.recorded.push((frame.views().to_vec(), recorder.finish()?));
            }
        }
        self.is_due = true;
        Ok(())
    }

    /// Forgets what was recorded: it brings observations to where they are looked for no longer.
    pub(super) fn clear(&mut self) {
        self.recorded.clear();
        self.is_due = false;
    }

    /// Whether something is still to be brought.
    pub(super) fn is_due(&self) -> bool {
        self.is_due
    }

    /// Forgets what was to be brought: newer observations come from the host.
    pub(super) fn leave(&mut self) {
        self.is_due = false;
    }

    /// What is to run ahead of anything that looks at the observations, once.
    pub(super) fn due(&mut self) -> Option<&mut Recording> {
        let is_due = std::mem::take(&mut self.is_due);
        self.recorded.last_mut().filter(|_| is_due).map(|(_, recording)| recording)
    }
}

/// Begins with the copies of all views, two passes.
fn record(scene: &DeviceScene, views: &[HeldView]) -> Result<Recorder> {
    let mut recorder = scene.device.recorder(Timing::Off)?;
    let place = |first: u32, bytes: usize| u64::from(first) * bytes as u64;
    let planes: Vec<_> = views
        .iter()
        .zip(scene.first_plane_words())
        .map(|(view, first)| (&view.planes, place(first, size_of::<[u32; 8]>())))
        .collect();
    let pixels: Vec<_> = views
        .iter()
        .zip(scene.first_pixel_words())
        .map(|(view, first)| (&view.pixels, place(first, size_of::<u32>())))
        .collect();
    recorder.gather("hand planes over", &planes, &scene.planes.buffer)?;
    recorder.gather("hand pixels over", &pixels, &scene.pixels.buffer)?;
    Ok(recorder)
}
