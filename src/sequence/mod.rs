//! Sequences: the manifest, video and picture input, calibration files (SPEC A2, INTERFACES).

mod calibration;

pub use calibration::{
    cameras_toml, parse_cameras_toml, parse_opencv_xml, parse_opencv_yaml, parse_qualisys, read_cameras,
    write_cameras_toml,
};
