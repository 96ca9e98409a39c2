//! From a picture to a silhouette: foreground by plate or mixture, then cleaning.

use image::RgbImage;

use super::blobs::Components;
use super::mixture::Mixture;
use super::morphology::Morphology;
use super::plate::Plate;
use super::{BitImage, FeatureSettings};

/// Where a view's foreground comes from when a frame brings no mask.
enum Background {
    Plate(Box<Plate>),
    Mixture(Mixture),
}

/// The segmentation of one view: its background model and its buffers.
pub(super) struct Segmentation {
    background: Background,
    /// Flags of one row of a plate's view, of the whole picture for a mixture.
    weak: Vec<u8>,
    strong: Vec<u8>,
    strong_bits: BitImage,
    morphology: Morphology,
    components: Components,
}

impl Segmentation {
    /// A segmentation of pictures of `width` × `height` pixels, the size of the plate.
    pub(super) fn new(width: u32, height: u32, plate: Option<RgbImage>, settings: &FeatureSettings) -> Self {
        let pixels = width as usize * height as usize;
        let (background, flags) = match plate {
            Some(plate) => (Background::Plate(Box::new(Plate::new(plate))), width as usize),
            None => (Background::Mixture(Mixture::new(settings.mixture, width, height)), pixels),
        };
        Self {
            background,
            weak: vec![0; flags],
            strong: vec![0; width as usize],
            strong_bits: BitImage::new(width, height),
            morphology: Morphology::default(),
            components: Components::default(),
        }
    }

    /// Shows a picture to a background model that learns.
    pub(super) fn learn(&mut self, picture: &RgbImage, settings: &FeatureSettings) {
        if let Background::Mixture(mixture) = &mut self.background {
            mixture.update(picture, &settings.shadow, &mut self.weak);
        }
    }

    /// Finds the raw `foreground` of a picture and the cleaned `silhouette`.
    pub(super) fn segment(
        &mut self,
        picture: &RgbImage,
        settings: &FeatureSettings,
        foreground: &mut BitImage,
        silhouette: &mut BitImage,
    ) {
        let width = picture.width() as usize;
        match &mut self.background {
            Background::Plate(plate) => {
                let gain = if settings.plate.gain { plate.gain(picture) } else { [1.0; 3] };
                for (y, rgb) in picture.as_raw().chunks_exact(width * 3).enumerate() {
                    let (weak, strong) = (&mut self.weak, &mut self.strong);
                    plate.compare_row(y, rgb, gain, &settings.plate, &settings.shadow, weak, strong);
                    foreground.pack_row(y, weak);
                    self.strong_bits.pack_row(y, strong);
                }
                silhouette.copy_from(foreground);
                self.morphology.open(silhouette, settings.opening());
                self.components.keep_touched(silhouette, &self.strong_bits);
            }
            Background::Mixture(mixture) => {
                mixture.update(picture, &settings.shadow, &mut self.weak);
                for (y, flags) in self.weak.chunks_exact(width).enumerate() {
                    foreground.pack_row(y, flags);
                }
                silhouette.copy_from(foreground);
                self.morphology.open(silhouette, settings.opening());
            }
        }
        self.morphology.close(silhouette, settings.closing());
        self.components.keep_largest(silhouette, settings.silhouette.blobs, settings.silhouette.min_area);
        self.components.fill_holes(silhouette, settings.silhouette.max_hole);
    }
}
