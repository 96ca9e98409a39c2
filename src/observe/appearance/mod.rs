//! The person's colours, part by part, learnt on the way, and the soft evidence that they make of a frame's likelihoods (METHOD A12).

mod classes;
mod colours;
mod rows;

use std::sync::Arc;

use anyhow::Result;
use image::RgbImage;
use rayon::prelude::*;

use self::classes::{Groups, grouped};
use self::colours::{Colours, LogTable};
use crate::body::Body;
use crate::features::likelihood::{ColourBin, MOST_RATIO as MOST, smooth_rows};
use crate::features::{BitImage, ColourTables, Evidence, Likelihood, Observation, PartClasses, SeenView};

/// The uniform share of the person's colours as a whole, and of a class's.
const UNKNOWN_PERSON: f32 = 0.35;
const UNKNOWN_PART: f32 = 0.15;

/// What the person looks like, as far as it is known.
///
/// At first nothing is, and every colour is as likely: evidence then tells by how much a pixel does not look like background. Once poses
/// are found, the pixels under each visible part teach its colours. Parts that look alike share a class, at most eight.
#[derive(Clone, Debug)]
pub struct Appearance {
    groups: Groups,
    /// The colours seen of every group of parts, left and right together.
    seen: Vec<Colours>,
    classes: Arc<PartClasses>,
    /// The log density of every colour in a class, over the uniform one.
    tables: Vec<LogTable>,
    /// The same of the whole person.
    person: LogTable,
}

/// What one view of a frame teaches.
#[derive(Clone, Copy, Debug)]
pub struct Lesson<'a> {
    /// The frame's pose drawn there: a byte a pixel, bits 0 to 6 the label of the visible part, bit 7 an edge.
    pub drawn: &'a [u8],
    /// What was seen there: pixels that it ignores teach nothing.
    pub seen: SeenView<'a>,
    /// Its colours.
    pub colours: SeenColours<'a>,
}

/// The colours of a view, and which pixels show none of the person's.
#[derive(Clone, Copy, Debug)]
pub enum SeenColours<'a> {
    /// By its likelihoods.
    Likely(&'a Likelihood),
    /// By its picture, and what surely is background as the device found that made evidence by the same colours.
    Pictured(&'a RgbImage, &'a BitImage),
}

impl Appearance {
    /// Of a person of whom nothing is known yet.
    pub fn new(body: &Body) -> Self {
        let groups = Groups::of(body);
        Self {
            seen: vec![Colours::default(); groups.count()],
            groups,
            classes: Arc::new(PartClasses::one()),
            tables: vec![LogTable::uniform()],
            person: LogTable::uniform(),
        }
    }

    /// The classes of the parts by now.
    pub fn classes(&self) -> &Arc<PartClasses> {
        &self.classes
    }

    /// What is known of her colours, for a device that makes evidence of likelihoods.
    pub fn tables(&self) -> ColourTables {
        let tables = || [&self.person].into_iter().chain(&self.tables);
        let of = |is_grey: bool| tables().map(move |table| table.values(is_grey));
        ColourTables::new(&self.classes, of(false).chain(of(true)))
    }

    /// Learns from a frame whose pose is known. What was seen before counts `kept` times (0 to 1), so that old colours fade.
    ///
    /// # Errors
    /// When a part's label is no label.
    pub fn learn(&mut self, views: &[Lesson<'_>], kept: f32) -> Result<()> {
        self.seen.iter_mut().for_each(|colours| colours.fade(kept));
        for Lesson { drawn, seen, colours } in views {
            for (at, &byte) in drawn.iter().enumerate() {
                // A border pixel may be its neighbour's, and what surely is background is nobody's colour.
                if byte & 0x80 == 0
                    && let Some(group) = self.groups.of_label(byte)
                    && let Some(colour) = self.shown(*colours, at)
                    && !seen.ignores(at)
                {
                    self.seen[group].add(colour);
                }
            }
        }
        let (classes, of_group) = grouped(&self.groups, &self.seen)?;
        let mut person = Colours::default();
        self.seen.iter().for_each(|colours| person.join(colours));
        self.person = person.table(UNKNOWN_PERSON, None);
        let mut of_classes = vec![Colours::default(); classes.count()];
        for (colours, &class) in self.seen.iter().zip(&of_group) {
            of_classes[usize::from(class)].join(colours);
        }
        self.tables = of_classes.iter().map(|colours| colours.table(UNKNOWN_PART, Some(&person))).collect();
        self.classes = Arc::new(classes);
        Ok(())
    }

    /// The colour of a pixel by its place in the picture's rows; none of what surely is background.
    #[inline]
    fn shown(&self, colours: SeenColours<'_>, at: usize) -> Option<ColourBin> {
        match colours {
            SeenColours::Likely(likelihood) => {
                let colour = likelihood.colours[at];
                let person = self.person.values(likelihood.is_grey)[colour.index()];
                (i32::from(likelihood.background[at]) - i32::from(person) <= MOST).then_some(colour)
            }
            SeenColours::Pictured(picture, empty) => {
                let width = picture.width() as usize;
                let (x, y) = ((at % width) as u32, (at / width) as u32);
                (!empty.get(x, y)).then(|| ColourBin::of(picture.get_pixel(x, y).0))
            }
        }
    }

    /// Gives a frame's observations the evidence of its likelihoods, one a view; none where there are none. What an observation
    /// ignores says nothing, of its neighbours neither.
    ///
    /// # Errors
    /// When likelihoods are of another size than they say.
    pub fn give(&self, likelihoods: &[Likelihood], observations: &mut [Observation]) -> Result<()> {
        observations.par_iter_mut().zip(likelihoods).try_for_each(|(observation, view)| {
            observation.evidence = Some(self.view_evidence(view, observation.ignored.as_deref())?);
            Ok(())
        })
    }

    fn view_evidence(&self, view: &Likelihood, ignored: Option<&BitImage>) -> Result<Evidence> {
        let (width, region) = (view.width as usize, view.region);
        let all_classes = (0..self.classes.count()).fold(0_u32, |word, class| word | 1 << (Evidence::BITS * class));
        let columns = region.x0 as usize..region.x1 as usize;
        let mut words = vec![0; view.background.len()];
        // Away from what may be the person colours are not looked up.
        let rows = words.chunks_exact_mut(width.max(1)).zip(view.background.chunks_exact(width.max(1)));
        for (y, (words, densities)) in rows.enumerate() {
            let inside = if (region.y0..region.y1).contains(&(y as u32)) { columns.clone() } else { width..width };
            for outside in [0..inside.start, inside.end..width] {
                rows::far(&densities[outside.clone()], all_classes, &mut words[outside]);
            }
        }
        let known = view.is_masked.then(|| self.person.values(view.is_grey));
        for (class, table) in self.tables.iter().enumerate() {
            let table = table.values(view.is_grey);
            let make = |y: usize, row: &mut [i16]| {
                let at = (y + region.y0 as usize) * width;
                let densities = &view.background[at..][..width][columns.clone()];
                let colours = &view.colours[at..][..width][columns.clone()];
                rows::ratios(densities, colours, table, known, row);
                if let Some(ignored) = ignored {
                    for (x, ratio) in (region.x0..).zip(row) {
                        if ignored.get(x, y as u32 + region.y0) {
                            *ratio = 0;
                        }
                    }
                }
            };
            let take = |y: usize, sums: &[i16]| {
                let at = (y + region.y0 as usize) * width;
                rows::put(sums, class, &mut words[at..][..width][columns.clone()]);
            };
            smooth_rows(region.width() as usize, region.height() as usize, make, take);
        }
        for at in ignored.into_iter().flat_map(BitImage::pixels) {
            words[at] = Evidence::SAYS_NOTHING;
        }
        Evidence::new(Arc::clone(&self.classes), view.width, view.height, words)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::{Region, evidence};

    /// A picture of 12 x 8 pixels: red left, blue right, both unlike the background, which shows in the last two rows.
    fn seen() -> Likelihood {
        let colours =
            (0..96).map(|at| ColourBin::of(if at % 12 < 6 { [200, 30, 30] } else { [30, 30, 200] })).collect();
        let background = (0..96).map(|at| if at < 72 { -64 } else { 700 }).collect();
        let region = Region::whole(12, 8);
        Likelihood { width: 12, height: 8, background, colours, is_masked: false, is_grey: false, region }
    }

    #[test]
    fn colours_under_parts_tell_them_apart() {
        let body = Body::adult(1750.0).unwrap();
        let label = |name: &str| body.parts.iter().find(|part| part.name == name).unwrap().label;
        let (head, thigh) = (label("head"), label("left_thigh"));
        let mut appearance = Appearance::new(&body);
        let view = seen();
        let before = appearance.view_evidence(&view, None).unwrap();
        assert_eq!(before.classes().count(), 1);
        assert_eq!((evidence::code(before.words()[0], 0), evidence::code(before.words()[90], 0)), (8, 0));
        let drawn: Vec<u8> = (0..96).map(|at| if at % 12 < 6 { head } else { thigh }).collect();
        let observation = Observation::empty(12, 8);
        for _ in 0..40 {
            let (seen, colours) = (SeenView::Whole(&observation), SeenColours::Likely(&view));
            appearance.learn(&[Lesson { drawn: &drawn, seen, colours }], 1.0).unwrap();
        }
        let after = appearance.view_evidence(&view, None).unwrap();
        let at = |pixel: usize, label: u8| {
            evidence::code(after.words()[pixel], usize::from(after.classes().of_label(label)))
        };
        assert_ne!(after.classes().of_label(head), after.classes().of_label(thigh));
        assert_eq!(after.classes().of_label(thigh), after.classes().of_label(label("right_thigh")));
        assert!(at(24, head) == 14 && at(24, thigh) < at(24, head), "{} {}", at(24, head), at(24, thigh));
        assert!(at(34, thigh) == 14 && at(34, head) < at(34, thigh), "{} {}", at(34, head), at(34, thigh));
        assert_eq!(at(95, thigh), 0, "what surely is background stays it");
    }
}
