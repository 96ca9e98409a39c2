//! What stands between two modules: room for one thing, and the newest wins.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use anyhow::Result;

/// Room for one thing on its way from a writer to a reader.
#[derive(Debug)]
pub(super) struct Slot<T> {
    state: Mutex<State<T>>,
    changed: Condvar,
}

#[derive(Debug)]
struct State<T> {
    newest: Option<T>,
    /// How the writer ended.
    end: Option<Result<()>>,
    is_read: bool,
}

/// The reader is gone.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Closed;

impl<T> Default for Slot<T> {
    fn default() -> Self {
        Self { state: Mutex::new(State { newest: None, end: None, is_read: true }), changed: Condvar::new() }
    }
}

impl<T> Slot<T> {
    /// Puts a thing in place of the one that was not taken yet, which comes back.
    pub(super) fn put(&self, thing: T) -> Result<Option<T>, Closed> {
        let mut state = self.lock();
        if !state.is_read {
            return Err(Closed);
        }
        let passed_over = state.newest.replace(thing);
        self.changed.notify_all();
        Ok(passed_over)
    }

    /// Nothing more comes, or what went wrong. The first word counts.
    pub(super) fn finish(&self, end: Result<()>) {
        self.lock().end.get_or_insert(end);
        self.changed.notify_all();
    }

    /// Waits for a thing; `None` when there is none left and none to come.
    ///
    /// # Errors
    /// What went wrong at the writer's, after the last thing was taken.
    pub(super) fn take(&self) -> Result<Option<T>> {
        let mut state = self.lock();
        loop {
            if let Some(thing) = state.newest.take() {
                return Ok(Some(thing));
            }
            if let Some(end) = &mut state.end {
                return std::mem::replace(end, Ok(())).map(|()| None);
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Nobody reads any more.
    pub(super) fn close(&self) {
        let mut state = self.lock();
        state.is_read = false;
        state.newest = None;
        drop(state);
        self.changed.notify_all();
    }

    /// The state is never left half changed, so a lock that a dying thread held is as good as any.
    fn lock(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::thread;

    use anyhow::anyhow;

    use super::*;

    #[test]
    fn the_newest_wins_and_the_last_is_taken_before_the_end() {
        let slot = Slot::default();
        assert_eq!(slot.put(1), Ok(None));
        assert_eq!(slot.put(2), Ok(Some(1)));
        assert_eq!(slot.take().unwrap(), Some(2));
        slot.put(3).unwrap();
        slot.finish(Err(anyhow!("no light")));
        slot.finish(Ok(()));
        assert_eq!(slot.take().unwrap(), Some(3));
        assert_eq!(slot.take().unwrap_err().to_string(), "no light");
        assert_eq!(slot.take().unwrap(), None);
        slot.close();
        assert_eq!(slot.put(4), Err(Closed));
    }

    #[test]
    fn a_reader_waits_for_a_writer() {
        let slot = Slot::default();
        thread::scope(|scope| {
            let reader = scope.spawn(|| {
                let mut taken = Vec::new();
                while let Some(thing) = slot.take().unwrap() {
                    taken.push(thing);
                }
                taken
            });
            let passed_over = (0..1000).filter(|thing| slot.put(*thing).unwrap().is_some()).count();
            slot.finish(Ok(()));
            let taken = reader.join().unwrap();
            assert_eq!((taken.len() + passed_over, taken.last()), (1000, Some(&999)));
            assert!(taken.is_sorted());
        });
    }
}
