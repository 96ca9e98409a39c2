//! study.toml: any lists are refused or make a sane number of runs.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::study::Study;

fuzz_target!(|text: &str| {
    if let Ok(study) = Study::parse(text, "fuzz.toml") {
        let _ = study.runs();
    }
});
