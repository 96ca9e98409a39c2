//! Tables of calibration pairs, and cameras from what is read: found or refused, never a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::calibrate::{CalibrationSettings, calibrate, parse_pairs};

fuzz_target!(|text: &str| {
    for camera in parse_pairs(text, "fuzz.csv", 1.0).unwrap_or_default() {
        if camera.pairs.len() < 100 {
            let _ = calibrate(&camera, [640, 480], &CalibrationSettings::default());
        }
    }
});
