//! DeepMimic characters.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::motion::parse_deepmimic_skeleton;

fuzz_target!(|text: &str| {
    let _ = parse_deepmimic_skeleton(text, "fuzz.txt");
});
