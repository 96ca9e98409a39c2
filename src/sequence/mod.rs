//! Sequences: the manifest, video and picture input, calibration files (SPEC A2, INTERFACES).
