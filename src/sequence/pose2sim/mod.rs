//! Projects of Pose2Sim: its folders and its Config.toml with what one level inherits from the other (FORMATS).

mod chosen_calibration;
mod config;
mod layout;
mod listing;
mod trial;
mod videos;

pub use config::LargeGaps;
pub use layout::pose2sim_trials;
pub use trial::{Pose2SimTrial, Pose2SimView};
