//! Connected components of bit pictures: the twin of [`crate::features::blobs::Components`], whichever of its choices is made.
//!
//! Four or five passes: every run a component of its own, neighbours joined, areas summed, the largest chosen, those kept drawn. The
//! forest that joining makes has the same roots in whatever order the device works, so nothing is repeated until it settles.

use anyhow::Result;

use super::view::{DeviceView, Plane};
use crate::features::SilhouetteSettings;
use crate::features::shaders::{
    KEEP_HOLES, KEEP_LARGEST, KEEP_TOUCHED, components_join_comp, components_keep_comp, components_label_comp,
    components_largest_comp, components_measure_comp, layout,
};
use crate::gpu::{Groups, Recorder};

/// Which components are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Keep {
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
    pub(super) fn largest(settings: &SilhouetteSettings) -> Self {
        let SilhouetteSettings { blobs, min_area, min_share, max_cover, .. } = *settings;
        Self::Largest { count: blobs as u32, min_area, min_share, max_cover }
    }

    /// The shaders' number of the choice.
    fn number(self) -> u32 {
        match self {
            Self::Largest { .. } => KEEP_LARGEST,
            Self::Touched => KEEP_TOUCHED,
            Self::Holes(_) => KEEP_HOLES,
        }
    }

    fn push(self, view: &DeviceView) -> layout::Components {
        let (width, height, stride) = (view.picture.width, view.picture.height, view.picture.stride);
        let any = layout::Components { width, height, stride, most: 0, least: 0, share: 0.0, cover: 0 };
        match self {
            Self::Largest { count, min_area, min_share, max_cover } => {
                // A whole number is larger than the share just where it is larger than the whole part.
                let cover = f64::from(max_cover) * (f64::from(width) * f64::from(height));
                layout::Components { most: count, least: min_area, share: min_share, cover: cover as u32, ..any }
            }
            Self::Touched => any,
            Self::Holes(max_area) => layout::Components { most: max_area, ..any },
        }
    }
}

/// Records what is kept of one plane to another. `strong` is what [`Keep::Touched`] asks for, and not looked at otherwise.
pub(super) fn components(
    recorder: &mut Recorder,
    views: &[&DeviceView],
    choice: Keep,
    strong: Plane,
    [from, to]: [Plane; 2],
) -> Result<()> {
    let keep = choice.number();
    recorder.run_all(views.iter().map(|view| {
        components_label_comp::Bindings {
            image: view.plane(from),
            labels: &view.forest.labels,
            areas: &view.forest.areas,
            roots: &view.forest.roots,
        }
        .dispatch(components_label_comp::Constants { keep }, choice.push(view), view.every_word())
    }))?;
    recorder.run_all(views.iter().map(|view| {
        components_join_comp::Bindings { image: view.plane(from), labels: &view.forest.labels }.dispatch(
            components_join_comp::Constants { keep },
            choice.push(view),
            view.every_word(),
        )
    }))?;
    recorder.run_all(views.iter().map(|view| {
        components_measure_comp::Bindings {
            image: view.plane(from),
            strong: view.plane(strong),
            labels: &view.forest.labels,
            areas: &view.forest.areas,
            roots: &view.forest.roots,
        }
        .dispatch(components_measure_comp::Constants { keep }, choice.push(view), view.every_word())
    }))?;
    if keep == KEEP_LARGEST {
        recorder.run_all(views.iter().map(|view| {
            components_largest_comp::Bindings { roots: &view.forest.roots, areas: &view.forest.areas }
                .dispatch(choice.push(view), Groups::Count([1; 3]))
        }))?;
    }
    recorder.run_all(views.iter().map(|view| {
        components_keep_comp::Bindings {
            image: view.plane(from),
            labels: &view.forest.labels,
            areas: &view.forest.areas,
            kept: view.plane(to),
        }
        .dispatch(components_keep_comp::Constants { keep }, choice.push(view), view.every_word())
    }))
}
