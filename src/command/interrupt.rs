//! Ctrl-C, or being asked to end by the system (SIGTERM, SIGHUP): once to stop after what is in work, twice to stop at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};

use super::output::tell;

/// Whether the user asked to stop.
#[derive(Clone, Debug)]
pub(super) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Listens from now on, until the program ends.
    pub(super) fn listen() -> Result<Self> {
        let flag = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&flag);
        ctrlc::set_handler(move || {
            // A second time it does not wait for the frame: the journal keeps those before.
            if asked.swap(true, Ordering::SeqCst) {
                std::process::exit(130);
            }
            tell!("stopping after this frame (again to stop at once)");
        })
        .context("cannot listen for Ctrl-C")?;
        Ok(Self(flag))
    }

    pub(super) fn is_asked(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }
}
