//! Threads that stay: bound to processors of their own where there are free ones, woken for each batch without allocating.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use anyhow::{Context, Result};

use super::processors::claimed;

/// A task as the workers see it: called with the worker's number.
type Task = dyn Fn(usize) + Sync;

/// A team of `count` workers; the calling thread is worker 0, the others have threads of their own.
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
    /// Helpers still at work on the current batch.
    busy: AtomicUsize,
    failed: AtomicBool,
}

#[derive(Debug)]
struct State {
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
    /// A team of `count` (at least 1); each helper thread is bound to a processor of its own, while there are such.
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
            let shared = Arc::clone(&shared);
            let processor = processors.next();
            let thread = std::thread::Builder::new()
                .name(format!("pantin-cpu-{worker}"))
                .spawn(move || {
                    if let Some(processor) = &processor {
                        processor.bind();
                    }
                    shared.serve(worker);
                })
                .with_context(|| format!("cannot start worker thread {worker} of {count}"))?;
            threads.push(thread);
        }
        Ok(Self { shared, threads })
    }

    /// Calls `task` once on every worker, each with its number, and returns when all have returned. False when one
    /// panicked.
    pub(super) fn run(&mut self, task: &(dyn Fn(usize) + Sync)) -> bool {
        let shared = &self.shared;
        shared.busy.store(self.threads.len(), Ordering::Relaxed);
        shared.failed.store(false, Ordering::Relaxed);
        let pointer: *const (dyn Fn(usize) + Sync) = task;
        // SAFETY: only the lifetime changes. Helpers use the task before they count down `busy`, and this function does
        // not return before `busy` is zero, whatever happens in `task`.
        let pointer = unsafe { std::mem::transmute::<*const (dyn Fn(usize) + Sync), *const Task>(pointer) };
        {
            // Under the lock, so that no helper falls asleep between its last look at the epoch and the wake-up.
            let mut state = shared.lock();
            state.task = Some(TaskPointer(pointer));
            shared.epoch.fetch_add(1, Ordering::Release);
        }
        if !self.threads.is_empty() {
            shared.wake.notify_all();
        }
        if catch_unwind(AssertUnwindSafe(|| task(0))).is_err() {
            shared.failed.store(true, Ordering::Relaxed);
        }
        let mut looks = 0;
        while shared.busy.load(Ordering::Acquire) != 0 {
            looks += 1;
            if looks < SPINS { std::hint::spin_loop() } else { std::thread::yield_now() }
        }
        !shared.failed.load(Ordering::Relaxed)
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        // The state is two plain values, whole at every moment; a panic elsewhere does not spoil it.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
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
            let task = state.task;
            drop(state);
            seen = self.epoch.load(Ordering::Acquire);
            if let Some(TaskPointer(task)) = task {
                // SAFETY: `run` waits for this worker to count down `busy` before the task can go away.
                let task = unsafe { &*task };
                if catch_unwind(AssertUnwindSafe(|| task(worker))).is_err() {
                    self.failed.store(true, Ordering::Relaxed);
                }
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

    #[test]
    fn every_worker_is_called_once_a_batch() {
        let mut workers = Workers::new(3).unwrap();
        let calls = [const { AtomicUsize::new(0) }; 3];
        for _ in 0..1000 {
            assert!(workers.run(&|worker| {
                calls[worker].fetch_add(1, Ordering::Relaxed);
            }));
        }
        assert_eq!(calls.map(AtomicUsize::into_inner), [1000; 3]);
    }

    #[test]
    fn a_panic_is_reported_and_the_team_goes_on() {
        let mut workers = Workers::new(2).unwrap();
        assert!(!workers.run(&|worker| assert!(worker == 0, "planned")));
        assert!(workers.run(&|_| ()));
    }
}
