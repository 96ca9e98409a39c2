//! poses.csv: what is read can be posed.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use pantin::body::{Body, PoseTable, parse_body};

static BODY: LazyLock<Body> =
    LazyLock::new(|| parse_body(include_str!("../seeds/body/leg.toml"), "leg.toml").expect("the seed is a body"));

fuzz_target!(|bytes: &[u8]| {
    if let Ok(table) = PoseTable::parse(bytes, "fuzz.csv", &BODY) {
        for pose in &table.poses {
            BODY.check_pose(pose).expect("what is read is valid");
        }
    }
});
