//! Tests that have a device under the validation layer take turns. The layer looks every call's device up in a table without a lock
//! (Vulkan-ValidationLayers, issue 4391), and what looks there crashes when another thread opens or closes a device just then.

use std::cell::RefCell;
use std::sync::{Mutex, MutexGuard, PoisonError};

static TURN: Mutex<()> = Mutex::new(());

thread_local! {
    static OURS: RefCell<Option<MutexGuard<'static, ()>>> = const { RefCell::new(None) };
}

/// Waits until no other test has such a device. The turn goes on when the test's thread ends, after all that the test holds.
pub(crate) fn take() {
    OURS.with_borrow_mut(|ours| {
        ours.get_or_insert_with(|| TURN.lock().unwrap_or_else(PoisonError::into_inner));
    });
}
