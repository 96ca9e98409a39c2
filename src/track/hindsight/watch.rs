//! Who waits for a second pass hears how far it is, and may end it between two frames of a window: a window is minutes of work on a machine of few
//! cores.

use std::fmt::{Display, Formatter, Result as Written};
use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::{Result, bail};

use crate::track::progress::Progress;

/// The one who waits, whom all that work side by side tell.
pub(super) struct Watch<'a>(Mutex<Told<'a>>);

struct Told<'a> {
    progress: &'a mut dyn Progress,
    /// Frames handed on, and what was told last.
    done: usize,
    told: usize,
    /// Work that is done and work in all of the window, and frames that are handed on after it.
    window: [usize; 2],
    frames: usize,
}

/// The run is to end here.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stopped;

impl Display for Stopped {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Written {
        formatter.write_str("the run was stopped")
    }
}

impl std::error::Error for Stopped {}

impl<'a> Watch<'a> {
    pub(super) fn of(progress: &'a mut dyn Progress) -> Self {
        Self(Mutex::new(Told { progress, done: 0, told: 0, window: [0, 1], frames: 0 }))
    }

    fn told(&self) -> MutexGuard<'_, Told<'a>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A window of so much work begins, after which the first `settled` frames are handed on.
    pub(super) fn begin(&self, work: usize, settled: usize) {
        let mut told = self.told();
        (told.window, told.frames) = ([0, work.max(1)], settled);
    }

    /// So much of it is done.
    ///
    /// # Errors
    /// [`Stopped`] where the run is to end.
    pub(super) fn work(&self, share: usize) -> Result<()> {
        let mut told = self.told();
        let [done, all] = told.window;
        told.window[0] = (done + share).min(all);
        let frames = told.done + told.frames * told.window[0] / all;
        told.tell(frames);
        if told.progress.should_stop() {
            bail!(Stopped);
        }
        Ok(())
    }

    /// A frame is handed on; whether to go on.
    pub(super) fn frame(&self) -> bool {
        let mut told = self.told();
        told.done += 1;
        let done = told.done;
        told.tell(done);
        !told.progress.should_stop()
    }
}

impl Told<'_> {
    fn tell(&mut self, frames: usize) {
        if frames > self.told {
            self.told = frames;
            self.progress.looked_back(frames);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keeps what it is told, and stops after so many frames.
    struct Kept {
        told: Vec<usize>,
        stops_at: usize,
    }

    impl Progress for Kept {
        fn looked_back(&mut self, done: usize) {
            self.told.push(done);
        }

        fn should_stop(&self) -> bool {
            self.told.last().is_some_and(|told| *told >= self.stops_at)
        }
    }

    /// A window's frames are told while they are worked on, once each and up to the last; what is worked on twice, since windows overlap, is
    /// not told twice.
    #[test]
    fn frames_are_told_while_a_window_is_worked_on() {
        let mut kept = Kept { told: Vec::new(), stops_at: usize::MAX };
        let watch = Watch::of(&mut kept);
        for (frames, settled) in [(6, 4), (4, 4)] {
            watch.begin(5 * frames, settled);
            for _ in 0..frames {
                watch.work(3).unwrap();
            }
            let half = watch.told().told;
            assert!(half > watch.told().done && half < watch.told().done + settled, "{half}");
            for _ in 0..2 * frames {
                watch.work(1).unwrap();
            }
            // More than was reckoned with.
            watch.work(3).unwrap();
            assert!((0..settled).all(|_| watch.frame()));
        }
        assert_eq!(kept.told, (1..=8).collect::<Vec<_>>());
    }

    #[test]
    fn a_run_is_stopped_between_two_frames_of_a_window() {
        let mut kept = Kept { told: Vec::new(), stops_at: 2 };
        let watch = Watch::of(&mut kept);
        watch.begin(12, 3);
        let ended = (0..12).find_map(|_| watch.work(1).err()).unwrap();
        assert!(ended.is::<Stopped>(), "{ended}");
        assert_eq!(kept.told, [1, 2]);
    }
}
