//! sequence.toml: a manifest is taken or refused.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::sequence::check_manifest;

fuzz_target!(|text: &str| {
    let _ = check_manifest(text, "fuzz.toml");
});
