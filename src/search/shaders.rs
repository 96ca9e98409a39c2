//! What the build makes of `glsl/search/`.

#![allow(clippy::unreadable_literal, clippy::large_stack_arrays, reason = "written by the build")]

include!(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search.rs"));

// `weigh.comp` goes down the tree of its halvings in whole rounds, each of which a workgroup has room for.
const _: () =
    assert!(HALVINGS.is_multiple_of(HALVINGS_AT_ONCE) && (1 << HALVINGS_AT_ONCE) * ANNEAL_LANES <= LOOK_GROUP);
