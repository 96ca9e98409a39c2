//! Recordings for the Rerun viewer, read back with the decoder of their own library: entities, frames, coordinates, cameras,
//! pictures, curves; and what can go wrong with the file.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of tests may fail as they do")]

mod made;
mod read_back;
mod tracked;
