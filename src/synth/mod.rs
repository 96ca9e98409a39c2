//! Synthetic sequences with exact truth: an actor, a room, cameras, noise.
