//! cameras.toml: cameras that are read are written and read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::sequence::{cameras_toml, parse_cameras_toml};

fuzz_target!(|text: &str| {
    if let Ok(cameras) = parse_cameras_toml(text, "fuzz.toml") {
        parse_cameras_toml(&cameras_toml(&cameras), "again.toml").expect("what is written is read");
    }
});
