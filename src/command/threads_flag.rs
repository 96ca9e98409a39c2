//! The flag that says how many threads work.

use anyhow::{Result, ensure};

/// How many threads work.
#[derive(clap::Args, Clone, Debug)]
pub(super) struct ThreadsFlag {
    /// Threads that work, for several runs on one machine. The results do not depend on it [default: one a processor].
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
}

/// More than this is a mistake.
const MOST: usize = 4096;

impl ThreadsFlag {
    /// Has the process work with so many from now on.
    ///
    /// # Errors
    /// When it is no sensible number, or the process works with another number already.
    pub(super) fn apply(&self) -> Result<()> {
        let Some(threads) = self.threads else { return Ok(()) };
        ensure!((1..=MOST).contains(&threads), "--threads is {threads}, expected 1 to {MOST}");
        if rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().is_err() {
            let now = rayon::current_num_threads();
            ensure!(
                now == threads,
                "threads is {threads}, and this process works with {now} since its first work, expected the same"
            );
        }
        Ok(())
    }
}
