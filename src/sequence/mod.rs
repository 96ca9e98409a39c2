//! Sequences: the manifest, video and picture input, calibration files (METHOD A2, FORMATS).

mod calibration;
mod coverage;
mod footage;
mod frames;
mod ignored;
mod in_step;
mod likely_delays;
mod live;
mod live_capture;
mod live_matching;
mod live_options;
mod manifest;
mod manifest_file;
mod named_files;
mod orientation;
mod person;
mod pictures;
mod player;
mod playlist;
mod pose2sim;
mod program;
mod resample;
mod source;
mod synchrony;
mod timestamps;
mod turn;
mod video;
mod video_encoder;
mod view;

pub use calibration::{
    CalibrationFormat, cameras_toml, parse_cameras_toml, parse_opencv_xml, parse_opencv_yaml, parse_qualisys,
    parse_vicon, read_cameras, write_cameras_toml,
};
pub use coverage::nearest_to_axes;
pub(crate) use footage::last_of_share;
pub use footage::{Footage, SpreadFrames};
pub use frames::{FrameReader, FrameSet, STALL_TIMEOUT};
pub use ignored::Ignored;
pub use in_step::{InStep, in_step};
pub use live::LiveReader;
pub use manifest::{DOUBTFUL, Sequence};
pub use manifest_file::check_manifest;
pub(crate) use manifest_file::{check_fps, check_scale};
pub use orientation::Orientation;
pub use person::Person;
pub use pictures::PicturePattern;
pub use player::{Captured, Playback, Player};
pub use pose2sim::{LargeGaps, Pose2SimTrial, Pose2SimView, pose2sim_trials};
pub use source::{LiveSource, Source, Video};
pub(crate) use synchrony::SAME_RATE;
pub use synchrony::Stamps;
pub use timestamps::Timestamps;
pub use turn::Turn;
pub use video::{VideoInfo, probe_video};
pub use video_encoder::VideoEncoder;
pub use view::View;
