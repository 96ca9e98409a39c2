//! Tables of marker tracks.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::calibrate::parse_tracks;

fuzz_target!(|text: &str| {
    if let Ok(tracks) = parse_tracks(text, "fuzz.csv") {
        assert!(tracks.iter().all(|track| track.pixel.is_finite() && !track.marker.is_empty()));
    }
});
