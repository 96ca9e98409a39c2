//! From a picture to a silhouette: foreground by plate or mixture, then cleaning.

use image::RgbImage;

use super::blobs::Components;
use super::mixture::Mixture;
use super::morphology::Morphology;
use super::plate::{DifferenceRow, Plate};
use super::{BitImage, FeatureSettings, SilhouetteSettings};

/// Where a view's foreground comes from when a frame brings no mask.
enum Background {
    Plate { plate: Box<Plate>, row: DifferenceRow },
    Mixture { mixture: Mixture, foreground: Vec<u8> },
}

/// The foreground of one view: its background model and its buffers.
pub(super) struct Foreground {
    background: Background,
    strong: BitImage,
    faint: BitImage,
    bridged: BitImage,
    morphology: Morphology,
    components: Components,
}

impl Foreground {
    /// Prepares for pictures of `width` × `height` pixels, the size of the plate.
    pub(super) fn new(width: u32, height: u32, plate: Option<RgbImage>, settings: &FeatureSettings) -> Self {
        let background = match plate {
            Some(plate) => {
                Background::Plate { plate: Box::new(Plate::new(plate)), row: DifferenceRow::new(width as usize) }
            }
            None => Background::Mixture {
                mixture: Mixture::new(settings.mixture, width, height),
                foreground: vec![0; width as usize * height as usize],
            },
        };
        Self {
            background,
            strong: BitImage::new(width, height),
            faint: BitImage::new(width, height),
            bridged: BitImage::new(width, height),
            morphology: Morphology::default(),
            components: Components::default(),
        }
    }

    /// The picture of the empty scene, where there is one.
    pub(super) fn plate(&self) -> Option<&RgbImage> {
        match &self.background {
            Background::Plate { plate, .. } => Some(plate.image()),
            Background::Mixture { .. } => None,
        }
    }

    /// The empty scene as it was learnt so far, where it is learnt and something was seen.
    pub(super) fn learnt(&self) -> Option<RgbImage> {
        match &self.background {
            Background::Plate { .. } => None,
            Background::Mixture { mixture, .. } => mixture.most_probable_colours(),
        }
    }

    /// Shows a picture to a background model that learns.
    pub(super) fn learn(&mut self, picture: &RgbImage, settings: &FeatureSettings) {
        if let Background::Mixture { mixture, foreground } = &mut self.background {
            mixture.update(picture, &settings.shadow, foreground);
        }
    }

    /// Finds the raw `foreground` of a picture and the cleaned `silhouette`.
    pub(super) fn find(
        &mut self,
        picture: &RgbImage,
        settings: &FeatureSettings,
        foreground: &mut BitImage,
        silhouette: &mut BitImage,
    ) {
        let width = picture.width() as usize;
        match &mut self.background {
            Background::Plate { plate, row } => {
                let gain = if settings.plate.gain { plate.gain(picture) } else { [1.0; 3] };
                for (y, rgb) in picture.as_raw().chunks_exact(width * 3).enumerate() {
                    plate.compare_row(y, rgb, gain, &settings.plate, &settings.shadow, row);
                    foreground.pack_row(y, &row.weak);
                    self.strong.pack_row(y, &row.strong);
                    self.faint.pack_row(y, &row.faint);
                }
                silhouette.copy_from(foreground);
                self.morphology.open(silhouette, settings.opening());
                self.components.keep_touched(silhouette, &self.strong);
                self.bridged.copy_from(silhouette);
                self.morphology.close(&mut self.bridged, settings.bridge());
                self.bridged.and(&self.faint);
                silhouette.or(&self.bridged);
            }
            Background::Mixture { mixture, foreground: flags } => {
                mixture.update(picture, &settings.shadow, flags);
                for (y, flags) in flags.chunks_exact(width).enumerate() {
                    foreground.pack_row(y, flags);
                }
                silhouette.copy_from(foreground);
                self.morphology.open(silhouette, settings.opening());
            }
        }
        clean(silhouette, settings, &mut self.morphology, &mut self.components);
    }
}

/// From foreground to silhouette: what belongs together is joined, then the largest blobs are kept and their holes filled; nothing is
/// left where too much of the picture is foreground.
pub(super) fn clean(
    silhouette: &mut BitImage,
    settings: &FeatureSettings,
    morphology: &mut Morphology,
    components: &mut Components,
) {
    morphology.close(silhouette, settings.closing());
    let SilhouetteSettings { blobs, min_area, min_share, max_hole, max_cover, .. } = settings.silhouette;
    let pixels = f64::from(silhouette.width()) * f64::from(silhouette.height());
    if f64::from(silhouette.count()) > f64::from(max_cover) * pixels {
        silhouette.clear();
        return;
    }
    components.keep_largest(silhouette, blobs, min_area, min_share);
    components.fill_holes(silhouette, max_hole);
}
