//! Threads that stay: bound to processors of their own where there are free ones, woken for each batch without allocating.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use anyhow::{Context, Result};

use super::processors::claimed;

/// A task as the workers see it: called with the worker's number.
type Task = dyn Fn(usize) + Sync;

/// A team of `count` workers; the calling thread is worker 0, the others have threads of their own and help where they come in time.
#[derive(Debug)]
pub(super) struct Workers {
    shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
}

#[derive(Debug)]
struct Shared {
    state: Mutex<State>,
    wake: Condvar,
    /// Counts the batches; a waiting worker spins on it for a moment before it sleeps, because the next batch usually
    /// follows within microseconds.
    epoch: AtomicUsize,
    /// Helpers that are starting or at work on the current batch. For a batch they are counted in under the lock.
    busy: AtomicUsize,
    failed: AtomicBool,
}

#[derive(Debug)]
struct State {
    /// What there is to help with; nothing once the caller has found no work left in it.
    task: Option<TaskPointer>,
    stop: bool,
}

/// A borrowed task whose lifetime the type system no longer sees; [`Workers::run`] keeps it alive.
#[derive(Clone, Copy)]
struct TaskPointer(*const Task);

impl std::fmt::Debug for TaskPointer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("TaskPointer")
    }
}

// SAFETY: the task is `Sync`, so calling it through a shared pointer from another thread is sound while it lives.
unsafe impl Send for TaskPointer {}

/// How often a waiting thread looks before it sleeps or yields: some tens of microseconds.
const SPINS: u32 = 2_000;

impl Workers {
    /// A team of `count` (at least 1), all of it started; each helper thread is bound to a processor of its own, while there are such.
    pub(super) fn new(count: usize) -> Result<Self> {
        let shared = Arc::new(Shared {
            state: Mutex::new(State { task: None, stop: false }),
            wake: Condvar::new(),
            epoch: AtomicUsize::new(0),
            busy: AtomicUsize::new(0),
            failed: AtomicBool::new(false),
        });
        // The caller is left to the scheduler: binding it would bind every thread it starts later.
        let mut processors = claimed(count - 1).into_iter();
        let mut threads = Vec::new();
        for worker in 1..count {
            shared.busy.fetch_add(1, Ordering::Relaxed);
            let (shared, processor) = (Arc::clone(&shared), processors.next());
            let thread = std::thread::Builder::new()
                .name(format!("pantin-cpu-{worker}"))
                .spawn(move || {
                    if let Some(processor) = &processor {
                        processor.bind();
                    }
                    shared.busy.fetch_sub(1, Ordering::Release);
                    shared.serve(worker);
                })
                .with_context(|| format!("cannot start worker thread {worker} of {count}"))?;
            threads.push(thread);
        }
        // A thread allocates while it starts, and no batch is to: a helper that starts late could do so during any of them.
        shared.wait_for_helpers();
        Ok(Self { shared, threads })
    }

    /// Calls `task` on the calling thread, with number 0, and once on each helper that comes to it before that call has returned; returns
    /// when all have. So `task` shares out its work as it goes, and whoever is held up by other work of the machine is not waited for.
    /// `shares` is how many could be at work at once: with one nobody else is woken. False when one panicked.
    pub(super) fn run(&mut self, shares: usize, task: &(dyn Fn(usize) + Sync)) -> bool {
        let shared = &self.shared;
        let calls_helpers = shares > 1 && !self.threads.is_empty();
        shared.failed.store(false, Ordering::Relaxed);
        if calls_helpers {
            let pointer: *const (dyn Fn(usize) + Sync) = task;
            // SAFETY: only the lifetime changes. Helpers take the task under the lock and are counted in there, the task is taken back
            // under the lock, and this function does not return before all that were counted are done, whatever happens in `task`.
            let pointer = unsafe { std::mem::transmute::<*const (dyn Fn(usize) + Sync), *const Task>(pointer) };
            // Under the lock, so that no helper falls asleep between its last look at the epoch and the wake-up.
            let mut state = shared.lock();
            state.task = Some(TaskPointer(pointer));
            shared.epoch.fetch_add(1, Ordering::Release);
            drop(state);
            shared.wake.notify_all();
        }
        if catch_unwind(AssertUnwindSafe(|| task(0))).is_err() {
            shared.failed.store(true, Ordering::Relaxed);
        }
        if calls_helpers {
            shared.lock().task = None;
            shared.wait_for_helpers();
        }
        !shared.failed.load(Ordering::Relaxed)
    }

    /// Calls `work` with each item, and with the number of the worker whose turn it is; returns when all are done. False when one panicked.
    pub(super) fn each<T>(
        &mut self,
        items: impl ExactSizeIterator<Item = T> + Send,
        work: impl Fn(usize, T) + Sync,
    ) -> bool {
        let count = items.len();
        let items = Mutex::new(items);
        self.run(count, &|worker| {
            loop {
                let Some(item) = items.lock().unwrap_or_else(PoisonError::into_inner).next() else { return };
                work(worker, item);
            }
        })
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        // The state is two plain values, whole at every moment; a panic elsewhere does not spoil it.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait_for_helpers(&self) {
        let mut looks = 0;
        while self.busy.load(Ordering::Acquire) != 0 {
            looks += 1;
            if looks < SPINS { std::hint::spin_loop() } else { std::thread::yield_now() }
        }
    }

    fn serve(&self, worker: usize) {
        let mut seen = 0;
        loop {
            let mut looks = 0;
            while self.epoch.load(Ordering::Acquire) == seen && looks < SPINS {
                looks += 1;
                std::hint::spin_loop();
            }
            let mut state = self.lock();
            while self.epoch.load(Ordering::Acquire) == seen && !state.stop {
                state = self.wake.wait(state).unwrap_or_else(PoisonError::into_inner);
            }
            if state.stop {
                return;
            }
            seen = self.epoch.load(Ordering::Acquire);
            let Some(TaskPointer(task)) = state.task else { continue };
            self.busy.fetch_add(1, Ordering::Relaxed);
            drop(state);
            // SAFETY: `run` waits for this worker to count down `busy` before the task can go away.
            let task = unsafe { &*task };
            if catch_unwind(AssertUnwindSafe(|| task(worker))).is_err() {
                self.failed.store(true, Ordering::Relaxed);
            }
            self.busy.fetch_sub(1, Ordering::Release);
        }
    }
}

impl Drop for Workers {
    fn drop(&mut self) {
        self.shared.lock().stop = true;
        self.shared.wake.notify_all();
        for thread in self.threads.drain(..) {
            // A worker that panicked has reported it already.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every share of a batch is done once, by the caller and by whoever comes in time, at most once each; that helpers do come shows
    /// where the caller waits for them.
    #[test]
    fn the_shares_of_a_batch_are_done_once_each() {
        let mut workers = Workers::new(3).unwrap();
        for batch in 0..1000 {
            let calls = [const { AtomicUsize::new(0) }; 3];
            let (next, done) = (AtomicUsize::new(0), [const { AtomicUsize::new(0) }; 20]);
            assert!(workers.run(done.len(), &|worker| {
                calls[worker].fetch_add(1, Ordering::Relaxed);
                while batch % 100 == 0 && worker == 0 && calls.iter().any(|calls| calls.load(Ordering::Relaxed) == 0) {
                    std::thread::yield_now();
                }
                while let Some(share) = done.get(next.fetch_add(1, Ordering::Relaxed)) {
                    share.fetch_add(1, Ordering::Relaxed);
                }
            }));
            let [caller, helpers @ ..] = calls.map(AtomicUsize::into_inner);
            assert!(caller == 1 && helpers.iter().all(|calls| *calls <= 1), "{caller} and {helpers:?}");
            assert!(batch % 100 != 0 || helpers == [1; 2]);
            assert_eq!(done.map(AtomicUsize::into_inner), [1; 20]);
        }
    }

    #[test]
    fn what_is_in_one_piece_wakes_nobody() {
        let mut workers = Workers::new(3).unwrap();
        let calls = [const { AtomicUsize::new(0) }; 3];
        for _ in 0..1000 {
            assert!(workers.run(1, &|worker| {
                calls[worker].fetch_add(1, Ordering::Relaxed);
            }));
        }
        assert_eq!(calls.map(AtomicUsize::into_inner), [1000, 0, 0]);
    }

    #[test]
    fn a_panic_is_reported_and_the_team_goes_on() {
        let mut workers = Workers::new(2).unwrap();
        let came = AtomicBool::new(false);
        assert!(!workers.run(2, &|worker| {
            came.fetch_or(worker == 1, Ordering::Relaxed);
            while !came.load(Ordering::Relaxed) {
                std::thread::yield_now();
            }
            assert!(worker == 0, "planned");
        }));
        assert!(!workers.run(1, &|_| panic!("planned")));
        assert!(workers.run(2, &|_| ()));
    }
}
