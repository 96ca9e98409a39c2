//! From pictures to packed observations (METHOD A5).
//!
//! One file a stage, in the order of the data: [`plate`] or [`mixture`] (with [`shadow`]) → [`morphology`] and [`blobs`]
//! → [`edges`] → [`distance`] → [`proximity`] → [`Observation`]. [`Extractor`] runs them all, one view a task, or a Vulkan device
//! does, all views at once. [`clean_plate`] makes a plate where none was filmed.

mod bit_image;
pub mod blobs;
pub mod clean_plate;
mod colour_tables;
mod device;
pub mod distance;
pub mod edges;
pub mod evidence;
mod extractor;
#[cfg(test)]
mod extractor_tests;
mod foreground;
mod held;
mod ignoring;
mod light;
pub mod likelihood;
pub mod mixture;
pub mod morphology;
mod observation;
mod pictures;
pub mod plate;
pub mod proximity;
mod region;
mod segment;
mod segmentation;
mod settings;
mod shaders;
pub mod shadow;
mod view_chain;
mod view_features;

pub use bit_image::BitImage;
pub use clean_plate::{Doubt, DoubtKind, LearntPlate};
pub use colour_tables::ColourTables;
pub use distance::{DistanceMap, Metric};
pub use edges::{EdgeSettings, Magnitude, Operator};
pub use evidence::{Evidence, PartClasses};
pub use extractor::Extractor;
pub use held::{HeldFrame, HeldLikelihood, HeldLook, HeldView, SeenFrame, SeenView};
pub use ignoring::Ignoring;
pub use likelihood::Likelihood;
pub use mixture::{Adaptation, MixtureSettings};
pub use morphology::Shape;
pub use observation::Observation;
pub use plate::PlateSettings;
pub use proximity::{Normalisation, ProximitySettings};
pub use region::Region;
pub use segment::{Cue, SegmentSettings};
pub use segmentation::{Segment, Segmentation, Segments};
pub use settings::{DistanceSettings, FeatureSettings, ForegroundKind, SilhouetteSettings};
pub use shadow::ShadowSettings;
pub use view_chain::ViewSource;
pub use view_features::ViewFeatures;
