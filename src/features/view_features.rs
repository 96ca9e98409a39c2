//! Everything that is found in one view of a frame.

use super::{BitImage, DistanceMap, FeatureSettings, Likelihood, Observation, Region};

/// What was found in one view of one frame; every intermediate picture can be looked at.
#[derive(Clone, Debug)]
pub struct ViewFeatures {
    /// Foreground as segmented, before cleaning; a ready mask as it came.
    pub foreground: BitImage,
    /// The cleaned silhouette: up to four blobs.
    pub silhouette: BitImage,
    /// Edges near the silhouette.
    pub edges: BitImage,
    /// Distances from them, up to the distance at which proximity ends.
    pub distance: DistanceMap,
    /// The silhouette's bounding box enlarged for motion; the whole picture where there is no silhouette.
    pub region: Region,
    /// Silhouette and edge proximity, packed.
    pub observation: Observation,
    /// How likely each pixel is as background, where that was asked for ([`super::FeatureSettings::likelihoods`]).
    pub likelihood: Option<Likelihood>,
}

impl ViewFeatures {
    /// Features of nothing.
    pub fn empty(width: u32, height: u32) -> Self {
        Self {
            foreground: BitImage::new(width, height),
            silhouette: BitImage::new(width, height),
            edges: BitImage::new(width, height),
            distance: DistanceMap::default(),
            region: Region::whole(width, height),
            observation: Observation::empty(width, height),
            likelihood: None,
        }
    }

    /// The region from the silhouette.
    pub(super) fn find_region(&mut self, settings: &FeatureSettings) {
        let (width, height) = (self.silhouette.width(), self.silhouette.height());
        let bounds = self.silhouette.bounds();
        self.region = bounds
            .map_or(Region::whole(width, height), |bounds| bounds.enlarged(settings.silhouette.motion, width, height));
    }

    /// From edges to distance and packed bytes.
    pub(super) fn measure_edges(&mut self, settings: &FeatureSettings, proximity: &[u8]) {
        self.distance.measure(&self.edges, settings.distance.metric, settings.proximity.limit());
        self.observation.pack(&self.silhouette, &self.distance, proximity);
    }
}
