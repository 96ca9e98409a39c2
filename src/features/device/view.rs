//! What the device keeps of one view.

use anyhow::Result;
use image::RgbImage;

use super::light_input::LightInput;
use crate::features::MixtureSettings;
use crate::features::shaders::layout::{Picture, Rates};
use crate::features::shaders::{MIXTURE_FIELDS, RATIO_COUNTS, RATIO_GRID};
use crate::gpu::{Buffer, Device, Groups, Memory, Recorder};

/// A bit picture of a view; rows are whole 64-bit words, as those of [`crate::features::BitImage`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Plane {
    /// As segmented.
    Foreground,
    /// What differs from the plate beyond doubt; then Canny's edges beyond doubt.
    Strong,
    /// What differs from the plate at all.
    Faint,
    /// Written over by whatever needs room.
    WorkA,
    /// Likewise.
    WorkB,
    /// Likewise.
    WorkC,
    /// The cleaned silhouette.
    Silhouette,
    /// That, dilated.
    Near,
    /// Edges near the silhouette.
    Edges,
    /// What does not count.
    Ignored,
    /// What does not look like background by its likelihood.
    LikelyForeground,
    /// That, cleaned.
    LikelySilhouette,
}

impl Plane {
    /// How many there are.
    const COUNT: usize = Self::LikelySilhouette as usize + 1;
}

/// The forest of connected components; most a node for every two pixels.
#[derive(Debug)]
pub(super) struct Forest {
    /// Of each node, another of its component that comes no later.
    pub(super) labels: Buffer,
    /// Of each root, the pixels of its component and a mark.
    pub(super) areas: Buffer,
    /// The number of roots, and the roots.
    pub(super) roots: Buffer,
}

/// What is known of the light.
#[derive(Debug)]
pub(super) struct Light {
    /// The background's colours on a grid of pixels, a word each.
    pub(super) grid: Buffer,
    /// Counted ratios of the three channels.
    pub(super) counts: Buffer,
    /// How bright the picture is, channel by channel.
    pub(super) gains: Buffer,
}

/// Rows of a mixture's state: as many as the device binds at once.
#[derive(Debug)]
pub(super) struct Band {
    /// First row of the picture.
    pub(super) first_row: u32,
    /// Number of rows.
    pub(super) rows: u32,
    /// Single-precision numbers by component, field, pixel.
    pub(super) state: Buffer,
}

#[derive(Debug)]
enum Background {
    Plate(Buffer),
    Mixture(Vec<Band>),
}

/// The buffers of one view.
#[derive(Debug)]
pub(super) struct DeviceView {
    /// What passes on it are told.
    pub(super) picture: Picture,
    /// Red, green, blue bytes, row-major.
    pub(super) colours: Buffer,
    planes: Vec<Buffer>,
    background: Background,
    /// How the picture's light differs from the background's.
    pub(super) light: Light,
    /// Room for finding components.
    pub(super) forest: Forest,
    /// The silhouette's bounding box.
    pub(super) sides: Buffer,
    /// Grey values, a word each.
    pub(super) smoothed: Buffer,
    /// Vertical distances, a word each.
    pub(super) reach: Buffer,
    /// Distances as [`crate::features::Metric::code`] writes them, a word each.
    pub(super) codes: Buffer,
}

/// What a view's recording is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Brings {
    /// Whether the frame brings its silhouette with it.
    pub(super) mask: bool,
    /// Whether it says which pixels do not count.
    pub(super) ignored: bool,
}

/// What the host fills of a view for a frame.
#[derive(Debug)]
pub(super) struct Input {
    /// Red, green, blue bytes, row-major.
    pub(super) colours: Buffer,
    pub(super) mask: Buffer,
    /// The pixels that do not count, a bit picture.
    pub(super) ignored: Buffer,
    /// The rates of a mixture's step.
    pub(super) rates: Buffer,
    /// The light of the picture, where likelihoods are made by it.
    pub(super) light: Option<LightInput>,
}

impl Input {
    pub(super) fn new(device: &Device, view: &DeviceView) -> Result<Self> {
        let words = |name: &str, bytes: u64| device.buffer::<u32>(name, bytes as usize / 4, Memory::Upload);
        Ok(Self {
            colours: words("colours staging", view.colours.size())?,
            mask: words("mask staging", view.plane(Plane::Silhouette).size())?,
            ignored: words("ignored pixels staging", view.plane(Plane::Ignored).size())?,
            rates: device.buffer::<Rates>("rates", 1, Memory::Upload)?,
            light: None,
        })
    }
}

impl DeviceView {
    /// Buffers for pictures of that size, with the plate's pixels uploaded where there is one.
    pub(super) fn new(
        device: &Device,
        [width, height]: [u32; 2],
        plate: Option<&RgbImage>,
        mixture: &MixtureSettings,
        limit: u8,
    ) -> Result<Self> {
        let (pixels, rows) = (width as usize * height as usize, height as usize);
        // As the words of a `BitImage`, whose rows are whole 64-bit words.
        let stride = 2 * width.div_ceil(64);
        let words = |name: &str, count: usize, memory: Memory| device.buffer::<u32>(name, count, memory);
        let (bits, colours) = (stride as usize * rows, (3 * pixels).div_ceil(4));
        let grid = (width.div_ceil(RATIO_GRID) * height.div_ceil(RATIO_GRID)) as usize;
        let (background, light_grid) = match plate {
            Some(plate) => {
                let mut bytes = plate.as_raw().clone();
                bytes.resize(4 * colours, 0);
                let on_grid: Vec<u32> = (0..height)
                    .step_by(RATIO_GRID as usize)
                    .flat_map(|y| (0..width).step_by(RATIO_GRID as usize).map(move |x| (x, y)))
                    .map(|(x, y)| {
                        let [red, green, blue] = plate.get_pixel(x, y).0;
                        u32::from_le_bytes([red, green, blue, 0])
                    })
                    .collect();
                (Background::Plate(device.uploaded("plate", &bytes)?), device.uploaded("light's grid", &on_grid)?)
            }
            None => (
                Background::Mixture(bands(device, [width, height], mixture.components as u32)?),
                words("light's grid", grid, Memory::Device)?,
            ),
        };
        Ok(Self {
            picture: Picture { width, height, stride, limit: u32::from(limit), amount: 0, low: 0 },
            colours: words("colours", colours, Memory::Device)?,
            planes: (0..Plane::COUNT).map(|_| words("bit picture", bits, Memory::Device)).collect::<Result<_>>()?,
            background,
            light: Light {
                grid: light_grid,
                counts: words("ratios", 3 * RATIO_COUNTS as usize, Memory::Device)?,
                gains: words("gains", 3, Memory::Device)?,
            },
            forest: Forest {
                labels: words("labels", 16 * bits, Memory::Device)?,
                areas: words("areas", 16 * bits, Memory::Device)?,
                // Two components are a pixel apart in either direction.
                roots: words("roots", 1 + width.div_ceil(2) as usize * rows.div_ceil(2), Memory::Device)?,
            },
            sides: words("bounds", 4, Memory::Device)?,
            smoothed: words("smoothed", pixels, Memory::Device)?,
            reach: words("reach", pixels, Memory::Device)?,
            codes: words("codes", pixels, Memory::Device)?,
        })
    }

    /// A bit picture.
    pub(super) fn plane(&self, plane: Plane) -> &Buffer {
        &self.planes[plane as usize]
    }

    /// Words of a bit picture.
    pub(super) fn words(&self) -> u32 {
        self.picture.stride * self.picture.height
    }

    /// An invocation for every word of a bit picture.
    pub(super) fn every_word(&self) -> Groups<'static> {
        Groups::Flat(self.words())
    }

    /// Words of its packed bytes, whose rows are padded to whole words, and of their bit planes.
    pub(super) fn packed_words(&self) -> [usize; 2] {
        let rows = self.picture.height as usize;
        [self.picture.width.div_ceil(4) as usize * rows, 8 * self.picture.width.div_ceil(32) as usize * rows]
    }

    /// An invocation for every pixel, in rows.
    pub(super) fn every_pixel(&self) -> Groups<'static> {
        Groups::Over([self.picture.width, self.picture.height, 1])
    }

    /// Red, green, blue bytes of the plate, where there is one.
    pub(super) fn plate(&self) -> Option<&Buffer> {
        match &self.background {
            Background::Plate(plate) => Some(plate),
            Background::Mixture(_) => None,
        }
    }

    /// The mixture's state; nothing where there is a plate.
    pub(super) fn bands(&self) -> &[Band] {
        match &self.background {
            Background::Plate(_) => &[],
            Background::Mixture(bands) => bands,
        }
    }
}

/// Records the copy of a whole buffer into one of the same size.
pub(super) fn copy_whole(recorder: &mut Recorder, name: &str, from: &Buffer, to: &Buffer) -> Result<()> {
    recorder.copy(name, (from, 0), (to, 0), from.size())
}

/// Room for the mixtures of a picture, in bands of rows that the device can bind.
fn bands(device: &Device, [width, height]: [u32; 2], components: u32) -> Result<Vec<Band>> {
    let row = u64::from(width * components * MIXTURE_FIELDS);
    let most = device.capabilities().max_storage / (4 * row);
    // Whole rows of the grid, so that every band begins on one.
    let most = (u32::try_from(most).unwrap_or(u32::MAX) / RATIO_GRID).max(1).saturating_mul(RATIO_GRID);
    (0..height)
        .step_by(most as usize)
        .map(|first_row| {
            let rows = most.min(height - first_row);
            let state = device.buffer::<f32>("mixtures", row as usize * rows as usize, Memory::Device)?;
            Ok(Band { first_row, rows, state })
        })
        .collect()
}
