//! ASF: what is read is a tree whose parents come first.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::motion::parse_asf;

fuzz_target!(|text: &str| {
    if let Ok(skeleton) = parse_asf(text, "fuzz.asf") {
        let in_order = |(index, bone): (usize, &pantin::motion::AsfBone)| bone.parent.is_none_or(|parent| parent < index);
        assert!(skeleton.bones.iter().enumerate().all(in_order));
    }
});
