//! AMC: what is read can be posed at any time.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::motion::{parse_amc, parse_asf};

fuzz_target!(|text: &str| {
    let skeleton = parse_asf(include_str!("../seeds/asf/leg.asf"), "leg.asf").expect("the seed is read");
    if let Ok(motion) = parse_amc(text, "fuzz.amc", &skeleton, 120.0) {
        motion.check().expect("what is read is sound");
        let _ = motion.global(&motion.at(0.5 * motion.duration()));
    }
});
