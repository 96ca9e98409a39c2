//! The features as pictures to look at: one a stage.

use image::{DynamicImage, GrayImage, Rgb, RgbImage};

use super::{Region, Segmentation, Segments, ViewFeatures};

/// The colour that marks the region of interest.
const MARK: Rgb<u8> = Rgb([0, 255, 0]);

/// Black, and one colour a segment: hues far apart that colour-blind eyes tell apart too.
const COLOURS: [[u8; 3]; Segments::MOST + 1] = [
    [0, 0, 0],
    [230, 159, 0],
    [86, 180, 233],
    [0, 158, 115],
    [240, 228, 66],
    [0, 114, 178],
    [213, 94, 0],
    [204, 121, 167],
    [190, 190, 190],
];

impl ViewFeatures {
    /// Every stage's name and picture, from the working picture `input` to the packed bytes; all of one size. The
    /// segments are there where body parts are told apart.
    pub fn pictures(&self, input: &RgbImage) -> Vec<(&'static str, DynamicImage)> {
        let mut proximity = self.observation.proximity();
        // Seven bits, shown over the whole range.
        proximity.iter_mut().for_each(|value| *value = *value << 1 | *value >> 6);
        let observation = &self.observation;
        let packed =
            GrayImage::from_raw(observation.width, observation.height, observation.bytes.clone()).unwrap_or_default();
        let mut pictures: Vec<(_, DynamicImage)> = vec![
            ("input", input.clone().into()),
            ("foreground", self.foreground.to_gray().into()),
            ("silhouette", self.silhouette.to_gray().into()),
            ("edges", self.edges.to_gray().into()),
            ("distance", self.distance.to_gray().into()),
            ("proximity", proximity.into()),
            ("observation", packed.into()),
            ("region", framed(input, self.region).into()),
        ];
        pictures.extend(observation.segmentation.iter().map(|plane| ("segments", coloured(plane).into())));
        pictures
    }
}

/// Each segment in a colour of its own, black where there is none.
fn coloured(segmentation: &Segmentation) -> RgbImage {
    let (width, height) = segmentation.dimensions();
    let mut picture = RgbImage::new(width, height);
    for (pixel, &number) in picture.pixels_mut().zip(segmentation.numbers()) {
        *pixel = Rgb(COLOURS[usize::from(number) % COLOURS.len()]);
    }
    picture
}

/// The picture with the region's outermost pixels marked.
fn framed(picture: &RgbImage, region: Region) -> RgbImage {
    let mut picture = picture.clone();
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        let inside = (region.x0..region.x1).contains(&x) && (region.y0..region.y1).contains(&y);
        if inside && (x == region.x0 || y == region.y0 || x + 1 == region.x1 || y + 1 == region.y1) {
            *pixel = MARK;
        }
    }
    picture
}

#[cfg(test)]
mod tests {
    use super::super::{Extractor, FeatureSettings, ViewSource};
    use super::*;
    use image::Luma;

    #[test]
    fn every_stage_shows_what_was_found() {
        let source = ViewSource { width: 40, height: 30, plate: None };
        let lower = "[[segment]]\nname = 'legs'\nlabels = [1]\nweight = 1\ncue = 'position'\nwithin = [0, 0.5, 1, 1]";
        let settings = FeatureSettings::from_table(&lower.parse().unwrap(), "test").unwrap();
        let mut extractor = Extractor::new(settings, vec![source]).unwrap();
        let input = RgbImage::from_fn(40, 30, |x, _| Rgb(if x < 20 { [20; 3] } else { [220; 3] }));
        let mask = GrayImage::from_fn(40, 30, |x, y| Luma([if x < 20 && y > 20 { 255 } else { 0 }]));
        let features = extractor.extract(std::slice::from_ref(&input), &[Some(mask.clone())]).unwrap();
        let pictures = features[0].pictures(&input);
        assert!(pictures.iter().all(|(_, picture)| (picture.width(), picture.height()) == (40, 30)));
        let picture = |stage: &str| pictures.iter().find(|(name, _)| *name == stage).unwrap().1.clone();
        assert_eq!(picture("silhouette").to_luma8(), mask);
        assert_eq!(picture("input").to_rgb8(), input);
        let [edges, distance, proximity] = ["edges", "distance", "proximity"].map(|stage| picture(stage).to_luma8());
        let (on, off) = (|image: &GrayImage| image.get_pixel(19, 25)[0], |image: &GrayImage| image.get_pixel(39, 2)[0]);
        assert_eq!((on(&edges), on(&distance), on(&proximity)), (255, 255, 255));
        assert_eq!((off(&edges), off(&distance), off(&proximity)), (0, 0, 0));
        assert_eq!(picture("observation").to_luma8().get_pixel(19, 25), &Luma([255]));
        // Rows 21..30 of the person; the lower half begins in the middle of row 25, and with it.
        let segments = picture("segments").to_rgb8();
        assert_eq!([(5, 24), (5, 25), (5, 29), (25, 29)].map(|(x, y)| segments.get_pixel(x, y).0[0]), [0, 230, 230, 0]);
        // The silhouette spans columns 0..20 and rows 21..30; the margin of 16 makes that 0..36 and 5..30.
        let region = picture("region").to_rgb8();
        assert_eq!((region.get_pixel(35, 5), region.get_pixel(0, 29)), (&MARK, &MARK));
        assert_eq!(region.get_pixel(36, 5), input.get_pixel(36, 5));
        assert_eq!(region.get_pixel(20, 20), input.get_pixel(20, 20));
    }
}
