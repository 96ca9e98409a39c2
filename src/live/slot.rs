//! What stands between two threads: room for so many things, and the newest win.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use anyhow::Result;

/// Room for things on their way from a writer to a reader, by default for one.
#[derive(Debug)]
pub(crate) struct Slot<T> {
    room: usize,
    state: Mutex<State<T>>,
    changed: Condvar,
}

#[derive(Debug)]
struct State<T> {
    /// Oldest first.
    newest: VecDeque<T>,
    /// How the writer ended.
    end: Option<Result<()>>,
    is_read: bool,
}

/// The reader is gone.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Closed;

impl<T> Default for Slot<T> {
    fn default() -> Self {
        Self::with_room(1)
    }
}

impl<T> Slot<T> {
    /// With room for so many things, at least one.
    pub(crate) fn with_room(room: usize) -> Self {
        let state = State { newest: VecDeque::new(), end: None, is_read: true };
        Self { room: room.max(1), state: Mutex::new(state), changed: Condvar::new() }
    }

    /// Puts a thing behind those that were not taken yet. Where there is no room, the oldest of them makes it and comes back.
    pub(crate) fn put(&self, thing: T) -> Result<Option<T>, Closed> {
        let mut state = self.lock();
        if !state.is_read {
            return Err(Closed);
        }
        let passed_over = if state.newest.len() < self.room { None } else { state.newest.pop_front() };
        state.newest.push_back(thing);
        self.changed.notify_all();
        Ok(passed_over)
    }

    /// Nothing more comes, or what went wrong. The first word counts.
    pub(crate) fn finish(&self, end: Result<()>) {
        self.lock().end.get_or_insert(end);
        self.changed.notify_all();
    }

    /// Waits for a thing; `None` when there is none left and none to come.
    ///
    /// # Errors
    /// What went wrong at the writer's, after the last thing was taken.
    pub(crate) fn take(&self) -> Result<Option<T>> {
        let mut state = self.lock();
        loop {
            if let Some(thing) = state.newest.pop_front() {
                return Ok(Some(thing));
            }
            if let Some(end) = &mut state.end {
                return std::mem::replace(end, Ok(())).map(|()| None);
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Nobody reads any more: how many things were not taken.
    pub(crate) fn close(&self) -> usize {
        let mut state = self.lock();
        state.is_read = false;
        let left = std::mem::take(&mut state.newest).len();
        drop(state);
        self.changed.notify_all();
        left
    }

    /// Whether nothing more comes.
    pub(crate) fn has_ended(&self) -> bool {
        self.lock().end.is_some()
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
    fn where_there_is_room_for_more_the_oldest_goes_first() {
        let slot = Slot::with_room(2);
        assert_eq!([1, 2, 3, 4].map(|thing| slot.put(thing)), [Ok(None), Ok(None), Ok(Some(1)), Ok(Some(2))]);
        assert_eq!(slot.take().unwrap(), Some(3));
        assert!(!slot.has_ended());
        slot.finish(Ok(()));
        assert!(slot.has_ended());
        assert_eq!(slot.close(), 1, "the 4 was not taken");
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
