//! How fast every evaluator is, side by side in one run, beside the figures of METHOD A10.
//!
//! One round of every evaluator follows the other, so that a noisy moment of the machine touches all alike; what is told is
//! the median of the rounds. Before anything is measured, every evaluator's fitness is compared with the first one's.

mod contestants;
mod preset;
pub mod profile;
mod report;
mod rounds;
mod scene;
mod shaders;
pub mod sweep;
mod table;
mod thesis;
mod yardstick;

pub use contestants::{Contestant, Missing, WrongPixels};
pub use preset::{Preset, run};
pub use report::{BenchReport, Row};
pub use rounds::{Round, Times, interleaved, medians, pass_times};
pub use scene::{Scene, seen_of, swarm};
pub use yardstick::YardstickKind;
