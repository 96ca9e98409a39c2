//! Pixels that count neither for nor against anybody, left out of features that are made already (METHOD A5).

use std::sync::Arc;

use anyhow::{Result, bail};
use rayon::prelude::*;

use super::observation::check_ignored;
use super::{BitImage, FeatureSettings, ViewFeatures};

/// Leaves pixels out of features that are made already.
#[derive(Clone, Debug)]
pub struct Ignoring {
    settings: FeatureSettings,
    proximity: Vec<u8>,
}

impl Ignoring {
    /// For features of these settings.
    pub fn new(settings: &FeatureSettings) -> Self {
        Self { settings: settings.clone(), proximity: settings.proximity.table(settings.distance.metric) }
    }

    /// Has pixels of a frame's features count neither for nor against a candidate: no silhouette is there and no edge, so that none of
    /// their edges is near a pixel that counts. One mask a view, or none.
    ///
    /// # Errors
    /// When there are not as many masks as views, or one is of another size.
    pub fn apply(&self, features: &mut [ViewFeatures], ignored: &[Option<Arc<BitImage>>]) -> Result<()> {
        apply(&self.settings, &self.proximity, features, ignored)
    }
}

fn check_count(masks: usize, views: usize) -> Result<()> {
    if masks != views {
        bail!("{views} views were given {masks} masks of ignored pixels or gaps, expected one each");
    }
    Ok(())
}

/// That there is a mask of ignored pixels, or none, for each of the views of these sizes.
pub(super) fn check(ignored: &[Option<Arc<BitImage>>], sizes: &[(u32, u32)]) -> Result<()> {
    check_count(ignored.len(), sizes.len())?;
    for (ignored, size) in ignored.iter().zip(sizes) {
        let Some(ignored) = ignored else { continue };
        check_ignored(ignored, *size)?;
    }
    Ok(())
}

/// [`Ignoring::apply`] for features of these settings.
pub(super) fn apply(
    settings: &FeatureSettings,
    proximity: &[u8],
    features: &mut [ViewFeatures],
    ignored: &[Option<Arc<BitImage>>],
) -> Result<()> {
    check_count(ignored.len(), features.len())?;
    features.par_iter_mut().zip(ignored).try_for_each(|(features, ignored)| {
        let Some(ignored) = ignored else { return Ok(()) };
        features.silhouette.and_not(ignored);
        features.find_region(settings);
        features.edges.and_not(ignored);
        features.measure_edges(settings, proximity);
        features.observation.ignore(ignored)
    })
}
