//! Studies: many runs over sequences x settings x seeds, and what they say together (METHOD A10: every configuration is run
//! with several seeds and told as mean and standard deviation).
//!
//! A [`Study`] is read from a TOML file; [`run`] makes its runs one after the other into a folder, goes on where an
//! earlier call stopped, and writes a tidy row a run, tables and plots. A [`batch`] tracks every sequence under a folder alike.

mod axes;
mod batch;
mod docs;
mod lottery;
mod outcome;
mod pace;
mod plan;
mod plots;
mod run;
mod runner;
mod runs_csv;
mod scenes;
mod settings;
mod summary;
mod tables;
mod taken;

pub use axes::{Axis, Value};
pub use batch::{
    BatchProgress, BatchSummary, Trial, TrialRow, batch, collect as collect_trials, numbered, track_trial, trials,
};
pub use docs::write_docs;
pub use lottery::{LotteryManifest, LotteryTable};
pub use outcome::{Outcome, Row, StageShare};
pub use pace::Pace;
pub use run::Run;
pub use runner::{Progress, StudySummary, collect, run, run_one};
pub use settings::{PlotSettings, SequenceSettings, SharesSettings, Study, TableSettings};
pub use summary::{Cell, Statistic};

#[cfg(test)]
mod tests;
