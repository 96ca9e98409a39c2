//! The writer: Intel reals, the form that every program reads.

use std::io::Write;

use anyhow::{Result, ensure};

use super::super::LowPass;
use super::super::points::{PointFile, PointTrajectory};
use super::{BLOCK, CUT_OFF, FILTER, SMOOTHING, parse_c3d};

/// Files of points.
pub(crate) const POINTS: PointFile =
    PointFile { read: parse_c3d, write: Ok(|out, points, _| write_c3d(out, points)), write_metres: None };

/// The parameter section starts in the second block.
const PARAMETER_BLOCK: u8 = 2;
/// One parameter holds at most this many labels; the others follow in LABELS2, LABELS3, …
const LABELS_A_PARAMETER: usize = 255;
/// Long recordings are counted in a 32-bit real, exact up to here: 77 hours at 60 frames a second.
const LAST_FRAME: usize = 1 << 24;
/// The header counts frames in 16 bits.
const LAST_COUNTED: usize = 65535;

/// Writes the points as C3D in mm with 32-bit reals; a missing point has the residual -1. Recordings past 65535 frames
/// get `POINT:LONG_FRAMES` and `TRIAL:ACTUAL_START_FIELD`, `ACTUAL_END_FIELD`, smoothed points `SMOOTHING:CUT_OFF` and `FILTER`.
///
/// # Errors
/// When the trajectory breaks [`PointTrajectory::check`], its rate is unknown, a name is longer than 120 bytes, there
/// are more points than the format can name, or writing fails.
pub fn write_c3d(out: &mut dyn Write, points: &PointTrajectory) -> Result<()> {
    points.check()?;
    ensure!(points.rate > 0.0, "the frame rate is unknown, but C3D needs one: give it");
    let count = points.names.len();
    ensure!(count <= LAST_COUNTED, "there are {count} points, expected at most {LAST_COUNTED} in a C3D file");
    let last_frame = points.first_frame.saturating_add(points.frames.len());
    ensure!(last_frame <= LAST_FRAME, "the last frame is {last_frame}, expected at most {LAST_FRAME} in a C3D file");

    // The section's length does not depend on where the data starts, so it is built twice.
    let draft = parameter_section(points, 0)?;
    let blocks = draft.len() / BLOCK;
    ensure!(blocks <= 255, "the names of {count} points need {blocks} blocks of parameters, expected at most 255");
    let data_start = u16::try_from(blocks + usize::from(PARAMETER_BLOCK))?;
    out.write_all(&header(points, data_start))?;
    out.write_all(&parameter_section(points, data_start)?)?;

    let mut written = 0;
    for frame in &points.frames {
        for point in frame {
            let (p, residual) = point.map_or((glam::Vec3::ZERO, -1.0), |p| (p.as_vec3(), 0.0f32));
            for value in [p.x, p.y, p.z, residual] {
                out.write_all(&value.to_le_bytes())?;
                written += size_of::<f32>();
            }
        }
    }
    out.write_all(&vec![0; written.next_multiple_of(BLOCK) - written])?;
    Ok(())
}

/// A count in the 16 bits that the format gave it, the largest standing for "more".
fn saturated(count: usize) -> u16 {
    u16::try_from(count).unwrap_or(u16::MAX)
}

fn header(points: &PointTrajectory, data_start: u16) -> [u8; BLOCK] {
    let mut header = [0; BLOCK];
    let first = points.first_frame + 1;
    let last = points.first_frame + points.frames.len();
    let mut put = |word: usize, bytes: &[u8]| header[2 * word..2 * word + bytes.len()].copy_from_slice(bytes);
    put(0, &[PARAMETER_BLOCK, 0x50]);
    put(1, &saturated(points.names.len()).to_le_bytes());
    put(3, &saturated(first).to_le_bytes());
    put(4, &saturated(last).to_le_bytes());
    put(6, &(-1.0f32).to_le_bytes());
    put(8, &data_start.to_le_bytes());
    put(10, &(points.rate as f32).to_le_bytes());
    header
}

fn parameter_section(points: &PointTrajectory, data_start: u16) -> Result<Vec<u8>> {
    let (first, last) = (points.first_frame + 1, points.first_frame + points.frames.len());
    let mut section = Section::new();
    let group = section.group("POINT")?;
    section.integers(group, "USED", &[saturated(points.names.len())])?;
    section.integers(group, "FRAMES", &[saturated(points.frames.len())])?;
    section.reals(group, "SCALE", &[-1.0])?;
    section.integers(group, "DATA_START", &[data_start])?;
    section.reals(group, "RATE", &[points.rate as f32])?;
    section.texts(group, "UNITS", &["mm".to_string()])?;
    section.texts(group, "X_SCREEN", &["+X".to_string()])?;
    section.texts(group, "Y_SCREEN", &["+Z".to_string()])?;
    section.tables(group, "LABELS", &points.names)?;
    section.tables(group, "DESCRIPTIONS", &vec![" ".to_string(); points.names.len()])?;
    if last > LAST_COUNTED {
        section.reals(group, "LONG_FRAMES", &[points.frames.len() as f32])?;
    }
    // Programs that look for analog data and force plates want to be told that there are none.
    let group = section.group("ANALOG")?;
    section.integers(group, "USED", &[0])?;
    let group = section.group("FORCE_PLATFORM")?;
    section.integers(group, "USED", &[0])?;
    if last > LAST_COUNTED {
        let group = section.group("TRIAL")?;
        let halves = |frame: usize| [(frame & 0xffff) as u16, (frame >> 16) as u16];
        section.integers(group, "ACTUAL_START_FIELD", &halves(first))?;
        section.integers(group, "ACTUAL_END_FIELD", &halves(last))?;
    }
    if let Some(cutoff) = points.smoothed {
        let group = section.group(SMOOTHING)?;
        section.reals(group, CUT_OFF, &[cutoff as f32])?;
        section.texts(group, FILTER, &[LowPass::FILTER.to_string()])?;
    }
    Ok(section.finish())
}

/// The parameter section as it grows.
struct Section {
    bytes: Vec<u8>,
    groups: i8,
}

impl Section {
    fn new() -> Self {
        // Two unused bytes, the number of blocks (known at the end), the processor (Intel).
        Self { bytes: vec![1, 0x50, 0, 84], groups: 0 }
    }

    fn group(&mut self, name: &str) -> Result<i8> {
        self.groups += 1;
        // The body of a group is its description's length.
        self.record(-self.groups, name, &[0])?;
        Ok(self.groups)
    }

    fn integers(&mut self, group: i8, name: &str, values: &[u16]) -> Result<()> {
        let data: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.parameter(group, name, 2, &vector_dimensions(values.len())?, &data)
    }

    fn reals(&mut self, group: i8, name: &str, values: &[f32]) -> Result<()> {
        let data: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.parameter(group, name, 4, &vector_dimensions(values.len())?, &data)
    }

    /// One parameter of texts, padded with blanks to the longest.
    fn texts(&mut self, group: i8, name: &str, texts: &[String]) -> Result<()> {
        let length = texts.iter().map(String::len).max().unwrap_or(0);
        let mut data = Vec::with_capacity(length * texts.len());
        for text in texts {
            ensure!(
                text.len() <= 120,
                "the name `{text}` is {} bytes long, expected at most 120 in a C3D file",
                text.len()
            );
            data.extend_from_slice(text.as_bytes());
            data.resize(data.len() + length - text.len(), b' ');
        }
        self.parameter(group, name, -1, &[u8::try_from(length)?, u8::try_from(texts.len())?], &data)
    }

    /// Any number of texts, split over `name`, `name2`, …
    fn tables(&mut self, group: i8, name: &str, texts: &[String]) -> Result<()> {
        for (index, chunk) in texts.chunks(LABELS_A_PARAMETER).enumerate() {
            let name = if index == 0 { name.to_string() } else { format!("{name}{}", index + 1) };
            self.texts(group, &name, chunk)?;
        }
        Ok(())
    }

    fn parameter(&mut self, group: i8, name: &str, kind: i8, dimensions: &[u8], data: &[u8]) -> Result<()> {
        let mut body = vec![kind.cast_unsigned(), u8::try_from(dimensions.len())?];
        body.extend_from_slice(dimensions);
        body.extend_from_slice(data);
        // No description.
        body.push(0);
        self.record(group, name, &body)
    }

    fn record(&mut self, id: i8, name: &str, body: &[u8]) -> Result<()> {
        self.bytes.extend([u8::try_from(name.len())?, id.cast_unsigned()]);
        self.bytes.extend_from_slice(name.as_bytes());
        // From this field to the next record: the field itself and the body.
        self.bytes.extend_from_slice(&u16::try_from(body.len() + 2)?.to_le_bytes());
        self.bytes.extend_from_slice(body);
        Ok(())
    }

    /// Closes the chain with a zero and fills the last block. Block counts beyond a byte are refused by the caller.
    fn finish(mut self) -> Vec<u8> {
        self.bytes.extend([0, 0]);
        self.bytes.resize(self.bytes.len().next_multiple_of(BLOCK), 0);
        self.bytes[2] = (self.bytes.len() / BLOCK).min(255) as u8;
        self.bytes
    }
}

/// A single value has no dimensions, as other programs write it.
fn vector_dimensions(length: usize) -> Result<Vec<u8>> {
    Ok(if length == 1 { Vec::new() } else { vec![u8::try_from(length)?] })
}
