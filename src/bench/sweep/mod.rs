//! How fast the stages of an iteration are by the size of their workgroups and by their other specialisation constants: what a device
//! runs fastest, and how much it matters there (METHOD A10).

mod measure;
mod point;
mod report;
mod table;

pub use measure::run;
pub use report::{SweepReport, SweepRow};
