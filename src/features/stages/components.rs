//! Connected components of bit pictures: the twin of [`crate::features::blobs::Components`], whichever of its choices is made.
//!
//! Four or five passes: every run a component of its own, neighbours joined, areas summed, the largest chosen, those kept drawn. The
//! forest that joining makes has the same roots in whatever order the device works, so nothing is repeated until it settles.

use anyhow::Result;

use super::generated::{
    self, components_join_comp, components_keep_comp, components_label_comp, components_largest_comp,
    components_measure_comp, layout,
};
use super::{flat_groups, record_views};
use crate::features::SilhouetteSettings;
use crate::features::device::{DeviceView, Plane};
use crate::gpu::{ComputeStage, Device, Recorder, Shader, Stage};

/// Which components are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::features) enum Keep {
    /// The largest (8-connected).
    Largest {
        /// How many.
        count: u32,
        /// Of at least so many pixels.
        min_area: u32,
        /// And such a share of the largest one's.
        min_share: f32,
        /// None where all together cover a larger share of the picture.
        max_cover: f32,
    },
    /// Those (8-connected) with a pixel in a second picture.
    Touched,
    /// All, and with them the holes (4-connected, not touching the border) of at most so many pixels.
    Holes(u32),
}

impl Keep {
    /// The blobs that make a silhouette.
    pub(in crate::features) fn largest(settings: &SilhouetteSettings) -> Self {
        let SilhouetteSettings { blobs, min_area, min_share, max_cover, .. } = *settings;
        Self::Largest { count: blobs as u32, min_area, min_share, max_cover }
    }
}

/// The stages of one choice.
#[derive(Debug)]
pub(in crate::features) struct ComponentsStages {
    keep: Keep,
    label: ComputeStage,
    join: ComputeStage,
    measure: ComputeStage,
    largest: Option<ComputeStage>,
    draw: ComputeStage,
}

impl ComponentsStages {
    /// Compiles them.
    pub(in crate::features) fn new(device: &Device, keep: Keep) -> Result<Self> {
        let number = match keep {
            Keep::Largest { .. } => generated::KEEP_LARGEST,
            Keep::Touched => generated::KEEP_TOUCHED,
            Keep::Holes(_) => generated::KEEP_HOLES,
        };
        let compile = |name, shader: &'static Shader, id| {
            ComputeStage::new(device, name, Stage { shader, constants: &[(id, number)] })
        };
        let is_largest = matches!(keep, Keep::Largest { .. });
        let largest = is_largest.then(|| {
            let stage = Stage { shader: &components_largest_comp::SHADER, constants: &[] };
            ComputeStage::new(device, "components_largest", stage)
        });
        use generated::{components_join_comp as join, components_keep_comp as draw};
        use generated::{components_label_comp as label, components_measure_comp as measure};
        Ok(Self {
            keep,
            label: compile("components_label", &label::SHADER, label::constants::KEEP)?,
            join: compile("components_join", &join::SHADER, join::constants::KEEP)?,
            measure: compile("components_measure", &measure::SHADER, measure::constants::KEEP)?,
            largest: largest.transpose()?,
            draw: compile("components_keep", &draw::SHADER, draw::constants::KEEP)?,
        })
    }

    /// Records them from one plane to another. `strong` is what [`Keep::Touched`] asks for, and not looked at otherwise.
    pub(in crate::features) fn record(
        &self,
        recorder: &mut Recorder,
        views: &[&DeviceView],
        strong: Plane,
        [from, to]: [Plane; 2],
    ) -> Result<()> {
        let push = |view: &DeviceView| self.push(view);
        record_views(recorder, &self.label, views, |view| {
            let forest = &view.forest;
            let bindings = components_label_comp::Bindings {
                image: view.plane(from),
                labels: &forest.labels,
                areas: &forest.areas,
                roots: &forest.roots,
            };
            (bindings.bound(), push(view), flat_groups(view.words()))
        })?;
        record_views(recorder, &self.join, views, |view| {
            let bindings = components_join_comp::Bindings { image: view.plane(from), labels: &view.forest.labels };
            (bindings.bound(), push(view), flat_groups(view.words()))
        })?;
        record_views(recorder, &self.measure, views, |view| {
            let forest = &view.forest;
            let bindings = components_measure_comp::Bindings {
                image: view.plane(from),
                strong: view.plane(strong),
                labels: &forest.labels,
                areas: &forest.areas,
                roots: &forest.roots,
            };
            (bindings.bound(), push(view), flat_groups(view.words()))
        })?;
        if let Some(largest) = &self.largest {
            record_views(recorder, largest, views, |view| {
                let bindings =
                    components_largest_comp::Bindings { roots: &view.forest.roots, areas: &view.forest.areas };
                (bindings.bound(), push(view), [1; 3])
            })?;
        }
        record_views(recorder, &self.draw, views, |view| {
            let bindings = components_keep_comp::Bindings {
                image: view.plane(from),
                labels: &view.forest.labels,
                areas: &view.forest.areas,
                kept: view.plane(to),
            };
            (bindings.bound(), push(view), flat_groups(view.words()))
        })
    }

    fn push(&self, view: &DeviceView) -> layout::Components {
        let (width, height, stride) = (view.picture.width, view.picture.height, view.picture.stride);
        let any = layout::Components { width, height, stride, most: 0, least: 0, share: 0.0, cover: 0 };
        match self.keep {
            Keep::Largest { count, min_area, min_share, max_cover } => {
                // A whole number is larger than the share just where it is larger than the whole part.
                let cover = f64::from(max_cover) * (f64::from(width) * f64::from(height));
                layout::Components { most: count, least: min_area, share: min_share, cover: cover as u32, ..any }
            }
            Keep::Touched => any,
            Keep::Holes(max_area) => layout::Components { most: max_area, ..any },
        }
    }
}
