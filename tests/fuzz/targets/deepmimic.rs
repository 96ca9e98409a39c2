//! DeepMimic clips: what is read fits the default body or is refused.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::body::{Body, RetargetSettings};
use pantin::motion::{DeepMimicSkeleton, parse_deepmimic};

fuzz_target!(|text: &str| {
    if let Ok(motion) = parse_deepmimic(text, "fuzz.txt", &DeepMimicSkeleton::humanoid()) {
        let body = Body::adult(1750.0).expect("the default body");
        if let Ok(table) = body.retarget(&motion, &RetargetSettings::default(), 30.0, 2) {
            table.poses.iter().for_each(|pose| body.check_limits(pose).expect("limits are kept"));
        }
    }
});
