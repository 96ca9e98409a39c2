//! The settings of a sequence's features: its `[features]` table over the defaults.

use anyhow::{Context, Result};

use crate::body::Body;
use crate::features::FeatureSettings;
use crate::sequence::Sequence;

/// The settings with everything that is told apart: parts that segments name are the labels they have in the sequence's body,
/// which is read when there are any.
///
/// # Errors
/// When a setting is unknown or makes no sense, the body cannot be read, or a segment names a part that it has not.
pub fn feature_settings(sequence: &Sequence) -> Result<FeatureSettings> {
    let mut settings = of_table(sequence)?;
    if settings.segment.iter().any(|segment| !segment.parts.is_empty()) {
        let body = Body::load(&sequence.body)?;
        let parts: Vec<_> = body.parts.iter().map(|part| (part.name.as_str(), part.label)).collect();
        settings.take_labels(&parts).with_context(|| sequence.path.display().to_string())?;
    }
    Ok(settings)
}

/// The settings for what asks for silhouettes and edges alone; the sequence's body need not exist.
///
/// # Errors
/// When a setting is unknown or makes no sense.
pub fn silhouette_settings(sequence: &Sequence) -> Result<FeatureSettings> {
    Ok(of_table(sequence)?.without_segments())
}

fn of_table(sequence: &Sequence) -> Result<FeatureSettings> {
    let table = sequence.features.as_ref();
    let read = |table| FeatureSettings::from_table(table, &sequence.path.display().to_string());
    table.map_or_else(|| Ok(FeatureSettings::default()), read)
}
