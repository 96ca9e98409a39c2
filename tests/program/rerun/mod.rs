//! Recordings for the Rerun viewer, read back with the decoder of their own library: entities, frames, coordinates, cameras,
//! pictures, curves; and what can go wrong with the file.

mod made;
mod read_back;
mod tracked;
