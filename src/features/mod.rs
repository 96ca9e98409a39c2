//! From pictures to packed observations (SPEC A5).

mod observation;

pub use observation::Observation;
