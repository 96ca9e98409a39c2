//! From the pictures of a sequence to observations: the settings of its features, which backgrounds have to be learnt, and its
//! frames one after the other. Whoever looks at a sequence does it through this room.

mod appearance;
mod observer;
mod plates;
mod settings;

pub use appearance::{Appearance, Lesson, SeenColours};
pub use observer::{Observer, check_background, take_likelihoods, take_observations, view_extractors};
pub use plates::{Advance, PlateLesson, Plated, ViewPlate, learn_plate, with_plates};
pub use settings::{feature_settings, silhouette_settings};
