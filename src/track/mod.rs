//! Tracking: one frame in order (features, search, pose, confidence) and the drivers that take a sequence through it
//! (METHOD A1, A8), with everything a track's folder holds (FORMATS).
//!
//! [`track`] is the driver, offline and in real time. [`score_poses`] scores given poses of one frame.

mod appearance;
#[cfg(test)]
mod appearance_tests;
mod auto;
mod backend;
mod begin;
mod confidence;
mod crowd;
mod dissent;
mod drawing;
mod driver;
mod features_made;
mod features_on;
mod feed;
mod figures;
mod filmed_plate;
mod first_try;
mod fit;
mod folder;
mod frame_range;
mod glance;
mod held;
mod held_feed;
mod hindsight;
mod histogram;
mod hull;
mod journal;
mod labels;
mod motion;
mod motion_files;
mod objective_choice;
mod overlay;
mod pace;
mod page;
mod passes;
mod people;
mod plan;
mod pose2sim;
mod prediction;
mod prepared;
mod progress;
mod realtime;
mod recovery;
mod results;
mod run;
mod run_record;
mod scoring;
mod searcher;
mod settings;
mod sight;
mod smoothed;
mod summary;
mod timings;
mod tracked_points;
mod truth;
mod unaided;
mod unseen;
mod worth;

pub use backend::Backend;
pub use confidence::{Confidence, FrameConfidence, JointConfidence, JointHints, LossRule, WRONG};
pub use drawing::{BuiltBackend, Drawing};
pub use driver::track;
pub use features_made::makes_features;
pub use features_on::FeaturesOn;
pub use first_try::{FirstPerson, FirstTry, FirstTrySettings, FirstView, first_try};
pub use fit::{Coverage, Fit, FitSettings, PersonSeen, fit, fit_with, people_in};
pub use frame_range::FrameRange;
pub use journal::FrameResult;
pub use motion::Width;
pub use objective_choice::ObjectiveChoice;
pub use passes::Passes;
pub use people::{PersonSummary, track_all, track_people};
pub use pose2sim::{
    POSE2SIM_OWN, POSE2SIM_POINTS, Pose2SimGiven, Pose2SimPoints, pose2sim_manifest, pose2sim_points, pose2sim_written,
};
pub use prediction::Prediction;
pub use progress::{FrameDone, Progress, RunStart, Silent};
pub use realtime::{Drops, LatencySummary, RealtimeSettings, RealtimeSummary, Repeat};
pub use scoring::{ScoredFrame, Scores, score_poses, write_fitness};
pub use settings::TrackSettings;
pub use summary::{ErrorSummary, TrackSummary};
pub use timings::TimingSummary;
pub use tracked_points::tracked_points;
pub use unseen::{StartPose, UnseenSummary, write_unseen};

#[cfg(test)]
mod fit_tests;
