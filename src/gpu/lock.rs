//! Locks, which outlive a panic.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// A panic elsewhere leaves these values whole: each is replaced or read in one step.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Held while instances and devices are made and destroyed: the loader keeps its list of devices without a lock (Vulkan-Loader, issue 2018),
/// and a thread that opens one reads what another frees by closing one.
pub(super) fn loader() -> MutexGuard<'static, ()> {
    static LOADER: Mutex<()> = Mutex::new(());
    lock(&LOADER)
}
