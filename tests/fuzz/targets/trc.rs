//! TRC: what is read holds its promises and can be written and read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::motion::{parse_trc, write_trc};

fuzz_target!(|text: &str| {
    if let Ok(points) = parse_trc(text, "fuzz.trc") {
        points.check().expect("what is read is valid");
        let mut written = Vec::new();
        write_trc(&mut written, &points, "fuzz.trc").expect("what is read can be written");
        let again = parse_trc(std::str::from_utf8(&written).expect("text"), "again.trc").expect("what is written is read");
        assert_eq!((again.names, again.frames.len()), (points.names, points.frames.len()));
    }
});
