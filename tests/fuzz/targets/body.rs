//! body.toml: a body that is read can be posed, and is the same after writing and reading again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pantin::body::parse_body;

fuzz_target!(|text: &str| {
    if let Ok(body) = parse_body(text, "fuzz.toml") {
        let matrices = body.world_from_bones(&body.standing_pose()).expect("the standing pose has the body's length");
        assert_eq!(body.joint_positions(&matrices).len(), body.joint_names().len());
        parse_body(&body.to_toml(), "again.toml").expect("what is written is read");
    }
});
