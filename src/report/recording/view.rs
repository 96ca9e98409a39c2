//! What a recording shows of a camera.

use std::path::PathBuf;

use crate::geometry::Camera;

/// A view with its pictures. They are read one after the other, so there may be many.
#[derive(Clone, Debug)]
pub struct RecordedView<'a> {
    /// Its camera, for pictures of the size they have.
    pub camera: &'a Camera,
    /// Frames and their picture, PNG files.
    pub pictures: Vec<(usize, PathBuf)>,
}
