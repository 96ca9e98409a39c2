//! What cannot be synthesised, said before any work.

use anyhow::{Result, bail, ensure};
use image::GrayImage;

use super::settings::{Example, RADIUS, Settings};

/// Most pixels of a result.
const MOST_PIXELS: u64 = 1 << 26;
/// Most pixels of all examples together.
const MOST_EXAMPLE: u64 = 1 << 22;

/// Whether a pixel of a mask says that the picture's is meant.
pub(super) fn is_bright(mask: &GrayImage, x: u32, y: u32) -> bool {
    mask.get_pixel(x, y).0[0] >= 128
}

fn area([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height)
}

/// Checks what [`super::synthesise`] is given.
///
/// # Errors
/// When a size or a setting makes no sense or nothing of the examples may be used.
pub(super) fn check(examples: &[Example<'_>], holes: Option<&GrayImage>, settings: &Settings) -> Result<()> {
    let Settings { size: [width, height], patch, overlap, delta_max, delta_pixel, .. } = *settings;
    let Some(first) = examples.first() else { bail!("no example, expected one or more") };
    let mut pixels = 0;
    for example in examples {
        let [width, height] = [example.picture.width(), example.picture.height()];
        pixels += area([width, height]);
        if area([width, height]) == 0 || area([width, height]) > MOST_EXAMPLE {
            bail!("an example of {width} x {height} pixels, expected 1 to {MOST_EXAMPLE} pixels");
        }
    }
    ensure!(pixels <= MOST_EXAMPLE, "examples of {pixels} pixels together, expected at most {MOST_EXAMPLE}");
    if area([width, height]) == 0 || area([width, height]) > MOST_PIXELS {
        bail!("a texture of {width} x {height} pixels, expected 1 to {MOST_PIXELS} pixels");
    }
    if patch.iter().any(|side| !side.is_power_of_two() || *side > 4096) {
        let [columns, rows] = patch;
        let sides =
            if columns == rows { format!("{rows} pixels a side") } else { format!("{columns} x {rows} pixels") };
        bail!("patches of {sides}, expected powers of two from 1 to 4096 (16, 32, 64 ...)");
    }
    if !(RADIUS as u32..=1024).contains(&overlap) {
        bail!("patches that overlap by {overlap} pixels, expected {RADIUS} to 1024");
    }
    for (name, delta) in [("delta_max", delta_max), ("delta_pixel", delta_pixel)] {
        if !(0.0..=1.0).contains(&delta) {
            bail!("{name} is {delta}, expected a number from 0 to 1");
        }
    }
    check_masks(examples, holes)?;
    let expected = [first.picture.width(), first.picture.height()];
    if holes.is_some() && settings.size != expected {
        bail!(
            "a texture of {width} x {height} pixels, expected the {} x {} of the example whose holes are filled",
            expected[0],
            expected[1]
        );
    }
    Ok(())
}

/// Checks sizes of masks and holes, and that they leave something to use.
fn check_masks(examples: &[Example<'_>], holes: Option<&GrayImage>) -> Result<()> {
    let mut is_any_usable = false;
    for (i, &Example { picture, mask }) in examples.iter().enumerate() {
        let holes = holes.filter(|_| i == 0);
        for (what, given) in [("mask", mask), ("picture of holes", holes)] {
            let Some(given) = given.filter(|given| given.dimensions() != picture.dimensions()) else { continue };
            bail!(
                "the {what} has {} x {} pixels, expected the example's {} x {}",
                given.width(),
                given.height(),
                picture.width(),
                picture.height()
            );
        }
        let may = |given: Option<&GrayImage>, x, y| given.is_none_or(|given| is_bright(given, x, y));
        is_any_usable |= picture.enumerate_pixels().any(|(x, y, _)| may(mask, x, y) && may(holes, x, y));
    }
    if is_any_usable {
        return Ok(());
    }
    let is_dark = |given: &GrayImage| given.pixels().all(|pixel| pixel.0[0] < 128);
    match holes {
        Some(holes) if is_dark(holes) && examples.len() == 1 => {
            bail!("the picture of holes is dark all over, so that nothing of the example is known")
        }
        Some(_) => bail!("masks and holes are dark wherever the examples are, so that no pixel of them may be used"),
        None if examples.len() == 1 => bail!("the mask is dark all over, so that no pixel of the example may be used"),
        None => bail!("the masks are dark all over, so that no pixel of the examples may be used"),
    }
}
