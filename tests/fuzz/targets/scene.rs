//! scene.toml: any settings are refused or sound.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::files::parse_toml;
use pantin::synth::Scene;

fuzz_target!(|text: &str| {
    if let Ok(scene) = parse_toml::<Scene>(text, "fuzz.toml") {
        let _ = scene.check();
    }
});
