//! C3D: what is read holds its promises, and is the same after writing and reading again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::motion::{parse_c3d, write_c3d};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(points) = parse_c3d(bytes, "fuzz.c3d") {
        points.check().expect("what is read is valid");
        let mut written = Vec::new();
        // Names too long or frames too late for the writer are refused, which is no fault of the reader.
        if write_c3d(&mut written, &points).is_ok() {
            let again = parse_c3d(&written, "again.c3d").expect("what is written is read");
            assert_eq!(again.names.len(), points.names.len());
            assert_eq!(again.frames.len(), points.frames.len());
        }
    }
});
