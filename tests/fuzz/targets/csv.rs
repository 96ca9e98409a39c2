//! Points as CSV: what is read holds its promises and can be written.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::motion::{parse_points_csv, write_points_csv};

fuzz_target!(|text: &str| {
    if let Ok(points) = parse_points_csv(text, "fuzz.csv") {
        points.check().expect("what is read is valid");
        write_points_csv(&mut Vec::new(), &points).expect("what is read can be written");
    }
});
