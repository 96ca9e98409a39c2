//! Where an iteration's time goes on a device, pass by pass: time, invocations, operations and bytes, and what share of the
//! device's measured peaks that is.
//!
//! Times are measured on one device, work is counted on another opening of it whose stages count ([`crate::gpu::Inspect`]): counting
//! takes several times as long.

mod comparison;
mod measure;
mod peaks;
mod report;
mod table;

pub use comparison::Comparison;
pub use measure::run;
pub use peaks::Peaks;
pub use report::{CompiledStage, Invocations, Pass, Profile, ProfileReport, Statistic, write_trace};
