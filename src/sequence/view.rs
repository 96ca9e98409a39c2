//! What a camera saw: the files that a view of a manifest names, looked at.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::{Context, Result, bail};

use super::footage::Footage;
use super::ignored::Ignored;
use super::manifest_file::ViewTable;
use super::named_files::NamedFiles;
use super::pictures::{shown, still};
use super::source::{LiveSource, NO_END, Source};
use crate::geometry::Camera;

/// What one camera saw.
#[derive(Clone, Debug)]
pub struct View {
    /// The camera's name.
    pub camera: String,
    /// The size of its pictures as they are read, pixels, width then height: that of the calibration.
    pub size: [u32; 2],
    /// Its pictures.
    pub source: Source,
    /// How many there are.
    pub stored: usize,
    /// The number of each frame's picture, ascending; none where frames and pictures are the same.
    pub picks: Option<Arc<[u32]>>,
    /// Frames by which its pictures come too late, as the manifest says.
    pub delay: f64,
    /// A picture of the empty scene.
    pub background: Option<PathBuf>,
    /// How much of it is doubtful since it was learnt from pictures with the person, % of the picture; 0 for one that was filmed.
    pub background_doubtful: f64,
    /// Ready silhouettes and the size they are stored at.
    pub mask: Option<(Source, [u32; 2])>,
    /// Pixels that count neither for nor against anybody.
    pub ignored: Option<Ignored>,
    /// A picture of the empty scene that was learnt, at the working size; no manifest names one.
    pub learnt: Option<Arc<image::RgbImage>>,
}

impl View {
    /// Whether it has neither mask nor plate, so that its background must be learnt from the frames.
    pub fn learns_background(&self) -> bool {
        self.mask.is_none() && self.background.is_none() && self.learnt.is_none()
    }

    /// Its pictures by themselves, all that there are.
    pub fn footage(&self) -> Footage {
        let shown = format!("the pictures of camera {:?}", self.camera);
        Footage::plain(shown, self.source.clone(), self.size, self.stored)
    }
}

/// Pixels a side that scaling leaves of a picture at least.
const SMALLEST_SIDE: u32 = 8;

/// The size pictures are worked on at.
pub(super) fn working_size(size: [u32; 2], scale: f64) -> [u32; 2] {
    size.map(|length| ((f64::from(length) * scale).round() as u32).max(1))
}

/// Refuses a scale that leaves nothing of a camera's pictures.
pub(super) fn check_sizes(views: &[View], scale: f64) -> Result<()> {
    for View { camera, size, .. } in views {
        let smallest = size.map(|side| side.min(SMALLEST_SIDE));
        let working = working_size(*size, scale);
        if working[0] < smallest[0] || working[1] < smallest[1] {
            bail!(
                "scale is {scale}, which leaves {} pixels of the {} of camera {camera:?}, expected {SMALLEST_SIDE} or more a side",
                shown(working),
                shown(*size)
            );
        }
    }
    Ok(())
}

/// Whether a plate of size `found` shows what pictures of size `full` show: it is an exact fraction of them, or of the working size.
pub(super) fn is_plate_size(found: [u32; 2], full: [u32; 2], working: [u32; 2]) -> bool {
    let ([width, height], [full_width, full_height]) = (found.map(u64::from), full.map(u64::from));
    (width * full_height == height * full_width && width <= full_width) || found == working
}

/// Looks at everything a view names; with the view, its pictures by themselves.
pub(super) fn open_view(
    table: &ViewTable,
    camera: &Camera,
    files: NamedFiles<'_>,
    scale: f64,
) -> Result<(View, Footage)> {
    let name = &table.camera;
    let key = |part: &str| format!("the {part} of camera {name:?}");
    let source = match LiveSource::of(&table.source, table.input.as_deref(), files.dir) {
        Some(live) => {
            if table.mask.is_some() {
                bail!(
                    "{}: camera {name:?} is live and has `mask`, expected `background` alone",
                    files.manifest.display()
                );
            }
            if let Some(turned) = table.orientation.filter(|orientation| orientation.turn().is_some()) {
                bail!(
                    "{}: camera {name:?} is live and has `orientation = \"{turned}\"`, expected that of recordings alone",
                    files.manifest.display()
                );
            }
            let shown = live.address.clone();
            // What it delivers is looked at when it is opened: a camera can be opened once.
            let (size, frame_count) = (camera.size, NO_END);
            Footage::plain(shown, Source::Live(live), size, frame_count)
        }
        None => table.oriented(files.footage(&key("source"), &table.source)?, Some(camera.size)),
    };
    if source.size != camera.size {
        bail!(
            "{} has pictures of {} pixels, but camera {name:?} is calibrated for {}{}",
            source.shown,
            shown(source.size),
            shown(camera.size),
            source.why_another_size(camera.size)
        );
    }
    let background = table.background.as_deref().map(|plate| files.existing(&key("background"), plate)).transpose()?;
    if let Some(plate) = &background {
        let working = working_size(camera.size, scale);
        let (_, found) = still(plate, |found| is_plate_size(found, camera.size, working))?;
        if !is_plate_size(found, camera.size, working) {
            bail!(
                "{} is {} pixels, expected {} (as camera {name:?} is calibrated), an exact fraction of that, or {} (the working \
                 size)",
                plate.display(),
                shown(found),
                shown(camera.size),
                shown(working)
            );
        }
    }
    let background_doubtful = table.background_doubtful.unwrap_or(0.0);
    if table.background_doubtful.is_some() && (background.is_none() || !(0.0..=100.0).contains(&background_doubtful)) {
        bail!(
            "{}: camera {name:?} has `background_doubtful = {background_doubtful}`, expected it beside `background`, 0 to 100 % of the picture",
            files.manifest.display()
        );
    }
    let mask = match &table.mask {
        None => None,
        Some(mask) => {
            let mask = table.oriented(files.footage(&key("mask"), mask)?, None);
            check_mask(name, camera.size, source.frame_count, &mask)
                .with_context(|| files.manifest.display().to_string())?;
            Some((mask.source, mask.size))
        }
    };
    let length = Some(source.frame_count).filter(|count| *count != NO_END);
    let ignored =
        table.ignore.as_deref().map(|ignore| Ignored::open(&key("ignore"), &files.place(ignore), camera.size, length));
    let ignored = ignored.transpose().with_context(|| files.manifest.display().to_string())?;
    let view = View {
        camera: name.clone(),
        size: camera.size,
        source: source.source.clone(),
        stored: source.frame_count,
        picks: None,
        delay: table.delay.unwrap_or(0.0),
        background,
        background_doubtful,
        mask,
        ignored,
        learnt: None,
    };
    Ok((view, source))
}

/// Masks may be smaller or larger than the pictures, but of the same shape, to a pixel, and as many.
fn check_mask(camera: &str, size: [u32; 2], frame_count: usize, mask: &Footage) -> Result<()> {
    let ([width, height], [mask_width, mask_height]) = (size.map(u64::from), mask.size.map(u64::from));
    if (width * mask_height).abs_diff(height * mask_width) > width.max(height) {
        bail!("{} has masks of {} pixels, expected the shape of {}", mask.shown, shown(mask.size), shown(size));
    }
    if mask.frame_count != frame_count {
        bail!(
            "camera {camera:?} has {frame_count} pictures and {} masks ({}), expected as many",
            mask.frame_count,
            mask.shown
        );
    }
    Ok(())
}
