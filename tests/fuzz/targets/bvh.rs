//! BVH: what is read can be posed, and is the same skeleton after writing and reading again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::motion::{parse_bvh, write_bvh};

fuzz_target!(|text: &str| {
    if let Ok(motion) = parse_bvh(text, "fuzz.bvh") {
        // Far joints and huge products are refused, never a panic.
        let _ = motion.to_points();
        let mut written = Vec::new();
        write_bvh(&mut written, &motion).expect("what is read can be written");
        let again = parse_bvh(std::str::from_utf8(&written).expect("text"), "again.bvh").expect("what is written is read");
        let tree = |motion: &pantin::motion::BvhMotion| -> Vec<_> {
            motion.joints.iter().map(|joint| (joint.name.clone(), joint.parent, joint.channels.clone())).collect()
        };
        assert_eq!((tree(&again), again.frames.len()), (tree(&motion), motion.frames.len()));
    }
});
