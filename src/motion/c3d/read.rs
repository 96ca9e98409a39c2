//! The reader.

use std::collections::{HashMap, HashSet};

use anyhow::{Context, Result, bail, ensure};
use glam::DVec3;

use super::super::LowPass;
use super::super::points::{LARGEST_COORDINATE, PointTrajectory, millimetres_in, numbered};
use super::numbers::Processor;
use super::parameters::Parameters;
use super::{BLOCK, CUT_OFF, FILTER, NOT_POSITIONS, SMOOTHING};

/// The first frame that the header's 16 bits cannot count.
const SATURATED: usize = 65535;

/// Reads the bytes of a C3D file; `name` stands for the file in messages. Positions come in mm whatever the file's
/// unit; a negative residual or a coordinate that is not a number means missing; points that are angles, forces,
/// moments or powers are left out. Of points with one label the second is called `<label>#2`, and so on. A point without a label (or `*`) is called `point<column>`, columns counted from 1.
///
/// # Errors
/// One sentence with the file, the byte, frame or parameter, what was found and what was expected. Counts are compared
/// with the file's length before anything is allocated.
pub fn parse_c3d(bytes: &[u8], name: &str) -> Result<PointTrajectory> {
    let points = parse(bytes).with_context(|| name.to_string())?;
    points.check().with_context(|| name.to_string())?;
    Ok(points)
}

fn parse(bytes: &[u8]) -> Result<PointTrajectory> {
    let Some(header) = bytes.first_chunk::<BLOCK>() else {
        bail!("the file holds {} bytes, expected a C3D file with a header of {BLOCK}", bytes.len());
    };
    ensure!(
        header[1] == 0x50 && header[0] > 0,
        "the file starts with bytes {:#04x} {:#04x}, expected a C3D file, which has 0x50 as its second byte",
        header[0],
        header[1]
    );
    let section = (usize::from(header[0]) - 1) * BLOCK;
    let Some(&[_, _, blocks, code]) = bytes.get(section..section + 4) else {
        bail!("the parameters should be at byte {section}, but the file holds {} bytes", bytes.len());
    };
    let processor = Processor::from_code(code).with_context(|| format!("byte {}", section + 3))?;
    // Not every program counts its blocks right, but no parameters stand behind the start of the data.
    let data_block = usize::from(processor.u16([header[16], header[17]]));
    let end = (section + usize::from(blocks) * BLOCK).max(data_block.saturating_sub(1) * BLOCK);
    let parameters = Parameters::parse(bytes, section + 4, end, processor)?;
    let layout = Layout::find(header, processor, &parameters, bytes.len())?;
    let columns = columns(&parameters, layout.points)?;
    let unit = parameters.texts("POINT", "UNITS").into_iter().next().unwrap_or_default();
    let factor = if unit.is_empty() { 1.0 } else { millimetres_in(&unit).context("POINT:UNITS")? };

    // `Layout::find` has compared this range with the file's length.
    let data = &bytes[layout.start..layout.start + layout.frames * layout.frame_bytes];
    let mut frames = Vec::with_capacity(layout.frames);
    for (row, frame) in data.chunks_exact(layout.frame_bytes).enumerate() {
        let mut points = Vec::with_capacity(columns.len());
        for (column, label) in &columns {
            let size = layout.point_bytes();
            let Some(p) = layout.point(processor, &frame[column * size..(column + 1) * size]) else {
                points.push(None);
                continue;
            };
            let p = p * factor;
            ensure!(
                p.abs().max_element() <= LARGEST_COORDINATE,
                "point `{label}` in frame {} is at ({}, {}, {}) mm, expected coordinates below {LARGEST_COORDINATE:e} mm",
                layout.first_frame + row,
                p.x,
                p.y,
                p.z
            );
            points.push(Some(p));
        }
        frames.push(points);
    }
    let names = columns.into_iter().map(|(_, label)| label).collect();
    // A cut-off in another program's file may be that of another filter.
    let is_ours = parameters.texts(SMOOTHING, FILTER).first().is_some_and(|filter| filter == LowPass::FILTER);
    let cutoff =
        parameters.number(SMOOTHING, CUT_OFF, 0).filter(|cutoff| is_ours && cutoff.is_finite() && *cutoff > 0.0);
    Ok(PointTrajectory { names, rate: layout.rate, first_frame: layout.first_frame, frames, smoothed: cutoff })
}

/// Where the numbers lie.
struct Layout {
    points: usize,
    /// Millimetre-like units for one step of an integer; `None` where coordinates are reals.
    scale: Option<f64>,
    frames: usize,
    first_frame: usize,
    frame_bytes: usize,
    start: usize,
    rate: f64,
}

impl Layout {
    /// What header and parameters say together. Where they disagree the parameters count, as the format's manual has
    /// it, but for the number of frames (below) and the start of the data, which some programs leave 0 among the
    /// parameters.
    fn find(header: &[u8; BLOCK], processor: Processor, parameters: &Parameters<'_>, length: usize) -> Result<Self> {
        let word = |index: usize| usize::from(processor.u16([header[2 * index], header[2 * index + 1]]));
        let real = |index: usize| {
            let at = 2 * index;
            f64::from(processor.f32([header[at], header[at + 1], header[at + 2], header[at + 3]]))
        };
        let points = parameters.count("POINT", "USED")?.unwrap_or(word(1));
        ensure!(points > 0, "the file holds no points, expected at least one");
        let scale = parameters.number("POINT", "SCALE", 0).unwrap_or(real(6));
        ensure!(scale.is_finite() && scale != 0.0, "POINT:SCALE is {scale}, expected a number other than 0");
        let scale = (scale > 0.0).then_some(scale);
        let rate = parameters.number("POINT", "RATE", 0).unwrap_or(real(10));
        ensure!(rate.is_finite() && rate > 0.0, "POINT:RATE is {rate}, expected a positive number of frames a second");
        let value_bytes = if scale.is_some() { 2 } else { 4 };
        let frame_bytes = (4 * points + word(2)) * value_bytes;
        let block = match word(8) {
            0 => parameters.count("POINT", "DATA_START")?.unwrap_or(0),
            block => block,
        };
        ensure!(block > 0, "the start of the data is block 0, expected 1 or more");
        let start = (block - 1) * BLOCK;
        ensure!(start <= length, "the data should start at byte {start}, but the file holds {length} bytes");

        // Files disagree with themselves about the number of frames. 16 bits cannot count a long recording, so what was
        // added for those comes first; else the first count that the file is long enough for.
        let long = |name: &str| {
            let low = parameters.number("TRIAL", name, 0)?;
            let frame = low + 65536.0 * parameters.number("TRIAL", name, 1)?;
            // Not every program's fields hold what their names say.
            (1.0..4e9).contains(&frame).then_some(frame as usize)
        };
        let (first, last) = (long("ACTUAL_START_FIELD"), long("ACTUAL_END_FIELD"));
        let trial = first.zip(last).and_then(|(first, last)| (last + 1).checked_sub(first));
        let from_header = (word(4) < SATURATED).then(|| (word(4) + 1).saturating_sub(word(3)));
        let claims = match (trial, parameters.count("POINT", "LONG_FRAMES")?) {
            (_, Some(count)) => vec![count],
            (Some(count), None) if count > SATURATED => vec![count],
            (trial, None) => [parameters.count("POINT", "FRAMES")?, trial, from_header].into_iter().flatten().collect(),
        };
        ensure!(claims.iter().any(|&count| count > 0), "the file holds no frames, expected at least one");
        let held = (length - start) / frame_bytes;
        let Some(&frames) = claims.iter().find(|&&count| 0 < count && count <= held) else {
            bail!(
                "the file is truncated: it holds {held} whole frames, expected {}",
                claims.first().copied().unwrap_or_default()
            );
        };
        let first_frame = first.unwrap_or(word(3)).saturating_sub(1);
        Ok(Self { points, scale, frames, first_frame, frame_bytes, start, rate })
    }

    fn point_bytes(&self) -> usize {
        if self.scale.is_some() { 8 } else { 16 }
    }

    /// A point from its bytes, in the file's unit; `None` where it is missing.
    fn point(&self, processor: Processor, bytes: &[u8]) -> Option<DVec3> {
        let word = |index: usize| f64::from(processor.i16([bytes[2 * index], bytes[2 * index + 1]]));
        let real = |index: usize| {
            let at = 4 * index;
            f64::from(processor.f32([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]))
        };
        let (p, residual) = match self.scale {
            Some(scale) => (DVec3::new(word(0), word(1), word(2)) * scale, word(3)),
            None => (DVec3::new(real(0), real(1), real(2)), real(3)),
        };
        (residual >= 0.0 && !p.is_nan()).then_some(p)
    }
}

/// Labels that stand several times get a number: `LKNE`, `LKNE#2`, `LKNE#3`.
fn name_apart(columns: &mut [(usize, String)]) {
    let mut taken: HashSet<String> = columns.iter().map(|(_, label)| label.clone()).collect();
    let mut counts: HashMap<String, usize> = HashMap::new();
    for (_, label) in columns {
        let count = counts.entry(label.clone()).or_insert(0);
        *count += 1;
        if *count == 1 {
            continue;
        }
        let mut name = numbered(label, *count);
        while !taken.insert(name.clone()) {
            *count += 1;
            name = numbered(label, *count);
        }
        *label = name;
    }
}

/// The columns that are positions, with their names.
fn columns(parameters: &Parameters<'_>, points: usize) -> Result<Vec<(usize, String)>> {
    let mut labels = parameters.texts("POINT", "LABELS");
    labels.truncate(points);
    let others: HashSet<String> = NOT_POSITIONS
        .iter()
        .flat_map(|group| parameters.texts("POINT", group))
        .filter(|name| !name.is_empty())
        .collect();
    let mut columns: Vec<(usize, String)> = (0..points)
        .filter_map(|column| match labels.get(column) {
            Some(label) if others.contains(label) => None,
            Some(label) if !label.is_empty() && label != "*" => Some((column, label.clone())),
            _ => Some((column, format!("point{}", column + 1))),
        })
        .collect();
    ensure!(!columns.is_empty(), "all {points} points are angles, forces, moments or powers, expected a position");
    name_apart(&mut columns);
    Ok(columns)
}

#[cfg(test)]
mod tests {
    use super::super::write_c3d;
    use super::*;
    use crate::motion::test_points::{close, real_data, trajectories};
    use proptest::prelude::*;

    fn small() -> PointTrajectory {
        PointTrajectory {
            names: vec!["LKNE".into(), "RKNE".into()],
            rate: 50.0,
            first_frame: 4,
            frames: vec![
                vec![Some(DVec3::new(1.5, -2.0, 3.0)), None],
                vec![Some(DVec3::new(4.0, 5.0, 6.0)), Some(DVec3::new(7.0, 8.0, 9.0))],
            ],
            smoothed: None,
        }
    }

    fn written(points: &PointTrajectory) -> Vec<u8> {
        let mut bytes = Vec::new();
        write_c3d(&mut bytes, points).unwrap();
        bytes
    }

    /// The byte where a parameter's values start, found by its name.
    fn values_of(bytes: &[u8], name: &str) -> usize {
        let at = bytes.windows(name.len()).position(|window| window == name.as_bytes()).unwrap();
        let dimensions = at + name.len() + 3;
        dimensions + 1 + usize::from(bytes[dimensions])
    }

    #[test]
    fn each_fault_is_one_sentence() {
        let whole = written(&small());
        type Change = fn(&mut Vec<u8>);
        let cases: [(&str, Change); 20] = [
            ("holds 0 bytes, expected a C3D file", |b| b.clear()),
            ("holds 511 bytes, expected a C3D file", |b| b.truncate(511)),
            ("expected a C3D file, which has 0x50", |b| b[1] = b'P' + 1),
            ("the parameters should be at byte 512, but the file holds 512", |b| b.truncate(512)),
            ("byte 515: the processor code is 0", |b| b[515] = 0),
            ("needs", |b| b.truncate(700)),
            ("the data should start at byte 1024, but the file holds 1023", |b| b.truncate(1023)),
            ("truncated: it holds 1 whole frames, expected 2", |b| b.truncate(1024 + 63)),
            ("truncated: it holds 8 whole frames, expected 65535", |b| {
                let at = values_of(b, "FRAMES");
                b[at..at + 2].copy_from_slice(&[255, 255]);
                b[8..10].copy_from_slice(&[255, 255]);
                b.resize(1024 + 8 * 64, 0);
                // Frames of 4 reals a point and 8 analog values.
                b[4] = 8;
            }),
            ("truncated: it holds 0 whole frames", |b| {
                let at = values_of(b, "USED");
                b[at..at + 2].copy_from_slice(&[255, 255]);
            }),
            ("holds no points", |b| {
                let at = values_of(b, "USED");
                b[at] = 0;
            }),
            ("holds no frames", |b| {
                let at = values_of(b, "FRAMES");
                b[at] = 0;
                b[8] = 4;
            }),
            ("POINT:SCALE is 0", |b| {
                let at = values_of(b, "SCALE");
                b[at..at + 4].fill(0);
            }),
            ("POINT:RATE is NaN", |b| {
                let at = values_of(b, "RATE");
                b[at..at + 4].fill(255);
            }),
            ("POINT:RATE is inf", |b| {
                let at = values_of(b, "RATE");
                b[at..at + 4].copy_from_slice(&f32::INFINITY.to_le_bytes());
            }),
            ("POINT:UNITS: the unit is `ft`", |b| {
                let at = values_of(b, "UNITS");
                b[at..at + 2].copy_from_slice(b"ft");
            }),
            ("point `LKNE` in frame 4 is at (inf,", |b| b[1024..1028].copy_from_slice(&f32::INFINITY.to_le_bytes())),
            ("point `LKNE` in frame 4 is at (10000000000,", |b| b[1024..1028].copy_from_slice(&1e10f32.to_le_bytes())),
            ("`USED`: has the type 3, expected -1, 1, 2 or 4", |b| {
                let at = values_of(b, "USED") - 2;
                b[at] = 3;
            }),
            ("points back into itself", |b| {
                let at = values_of(b, "USED") - 4;
                b[at..at + 2].copy_from_slice(&[1, 0]);
            }),
        ];
        for (expected, change) in cases {
            let mut bytes = whole.clone();
            change(&mut bytes);
            let message = format!("{:#}", parse_c3d(&bytes, "t.c3d").unwrap_err());
            assert!(message.contains(expected) && message.starts_with("t.c3d"), "{message}\nshould say: {expected}");
            assert!(!message.contains('\n'), "{message}");
        }
    }

    #[test]
    fn metres_and_points_without_a_name() {
        let mut bytes = written(&small());
        let at = values_of(&bytes, "UNITS");
        bytes[at..at + 2].copy_from_slice(b"m ");
        let at = values_of(&bytes, "LABELS");
        bytes[at..at + 8].copy_from_slice(b"*       ");
        let points = parse_c3d(&bytes, "t.c3d").unwrap();
        assert_eq!(points.names, ["point1", "point2"]);
        assert_eq!(points.frames[0], [Some(DVec3::new(1500.0, -2000.0, 3000.0)), None]);
        assert_eq!(points.first_frame, 4);
    }

    #[test]
    fn labels_that_stand_twice_are_named_apart() {
        let mut bytes = written(&small());
        let at = values_of(&bytes, "LABELS");
        bytes[at + 4] = b'L';
        let points = parse_c3d(&bytes, "t.c3d").unwrap();
        assert_eq!(points.names, ["LKNE", "LKNE#2"]);
        assert_eq!(points.frames[1][1], Some(DVec3::new(7.0, 8.0, 9.0)));
        assert_eq!(
            points.same_labels().unwrap(),
            "labels that stand several times were numbered, so a point is called LKNE#2"
        );
        assert_eq!(small().same_labels(), None);
        let apart = |labels: &[&str]| {
            let mut columns: Vec<(usize, String)> = labels.iter().map(|label| (0, (*label).to_string())).collect();
            name_apart(&mut columns);
            columns.into_iter().map(|(_, name)| name).collect::<Vec<_>>()
        };
        assert_eq!(apart(&["a", "a#2", "a", "a", "b"]), ["a", "a#2", "a#3", "a#4", "b"]);
        assert_eq!(apart(&["a", "a", "a#2", "a#2"]), ["a", "a#3", "a#2", "a#2#2"]);
    }

    #[test]
    fn coordinates_that_are_no_numbers_are_missing() {
        let mut bytes = written(&small());
        bytes[1024..1028].copy_from_slice(&f32::NAN.to_le_bytes());
        assert_eq!(parse_c3d(&bytes, "t.c3d").unwrap().frames[0][0], None);
    }

    #[test]
    fn six_encodings_of_one_trial() {
        let Some(folder) = real_data("six_encodings_of_one_trial", "c3d") else { return };
        let read = |file: &str| parse_c3d(&std::fs::read(folder.join(file)).unwrap(), file).unwrap();
        let reference = read("sample02_pc_real.c3d");
        assert_eq!((reference.names.len(), reference.frames.len(), reference.rate), (36, 89, 50.0));
        assert_eq!(reference.names[0], "RFT1");
        assert_eq!(reference.frames[0][0], None, "the first marker is not seen at first");
        assert!((reference.frames[10][0].unwrap() - DVec3::new(363.568_15, 361.037_54, 81.542_74)).length() < 1e-4);
        for file in ["dec_real", "sgi_real"] {
            assert_eq!(read(&format!("sample02_{file}.c3d")), reference, "{file}");
        }
        // The integers of this trial were made by three programs, some cutting off: up to one step of POINT:SCALE.
        for file in ["pc_int", "dec_int", "sgi_int"] {
            let integers = read(&format!("sample02_{file}.c3d"));
            assert!(close(&reference, &integers, 0.2812), "{file}");
        }
        assert_eq!(read("sample02_pc_int.c3d"), read("sample02_sgi_int.c3d"));
        let reference = read("sample01_Eb015pr.c3d");
        assert_eq!((reference.names.len(), reference.frames.len()), (26, 450));
        for file in ["pi", "sr", "vi"] {
            assert!(close(&reference, &read(&format!("sample01_Eb015{file}.c3d")), 1e-3), "{file}");
        }
    }

    #[test]
    fn files_of_two_makers() {
        let Some(folder) = real_data("files_of_two_makers", "c3d") else { return };
        let read = |file: &str| parse_c3d(&std::fs::read(folder.join(file)).unwrap(), file).unwrap();
        let vicon = read("sample09_vicon_plugingait.c3d");
        assert_eq!((vicon.frames.len(), vicon.rate, vicon.first_frame), (281, 60.0, 0));
        // 86 columns, of which 32 are angles, forces, moments and powers.
        assert_eq!(vicon.names.len(), 54);
        assert!(vicon.column("LKneeAngles").is_none());
        let knee = vicon.frames[0][vicon.column("RKNE").unwrap()].unwrap();
        assert!((knee - DVec3::new(-1060.822, 109.117, 568.298)).length() < 1e-2, "{knee}");
        // Says 500 frames among its parameters, 499 in its header, and holds 499.
        let dance = read("sample13_dance.c3d");
        assert_eq!((dance.names.len(), dance.frames.len()), (40, 499));
        assert!((dance.rate - 65.053).abs() < 1e-3);
    }

    #[test]
    fn a_second_opinion_on_real_files() {
        let Some(folder) = real_data("a_second_opinion_on_real_files", "c3d") else { return };
        for file in ["sample01_Eb015vi", "sample02_sgi_int", "sample02_dec_real", "sample09_vicon_plugingait"] {
            let bytes = std::fs::read(folder.join(file).with_extension("c3d")).unwrap();
            same_as_c3dio(&bytes, &parse_c3d(&bytes, file).unwrap());
        }
    }

    /// The other reader finds the same labels, frames and positions.
    fn same_as_c3dio(bytes: &[u8], points: &PointTrajectory) {
        let other = c3dio::C3d::from_bytes(bytes).unwrap();
        assert_eq!(other.points.size().0, points.frames.len());
        assert!((f64::from(other.points.frame_rate) - points.rate).abs() < 1e-3);
        for (column, name) in points.names.iter().enumerate() {
            // It knows the first 255 labels only; the columns beyond are in order.
            let theirs = other.points.labels.iter().position(|label| label == name).unwrap_or(column);
            for (row, frame) in points.frames.iter().enumerate() {
                let there = other.points[row][theirs];
                assert_eq!(frame[column].is_none(), there.residual < 0.0, "{name} in frame {row}");
                let Some(p) = frame[column] else { continue };
                let q = DVec3::new(there.point[0].into(), there.point[1].into(), there.point[2].into());
                assert!((p - q).length() <= 1e-3 + 1e-6 * q.length(), "{name} in frame {row}: {p} {q}");
            }
        }
    }

    #[test]
    fn smoothed_points_say_their_cut_off() {
        let mut points = crate::motion::test_points::trajectory(50.0, 0, 20);
        assert!(!written(&points).windows(SMOOTHING.len()).any(|bytes| bytes == SMOOTHING.as_bytes()));
        LowPass::new(6.25, points.rate).unwrap().smooth_points(&mut points).unwrap();
        let bytes = written(&points);
        assert_eq!(parse_c3d(&bytes, "s.c3d").unwrap().smoothed, Some(6.25));
        // Whoever does not know the group reads the points all the same.
        same_as_c3dio(&bytes, &points);
        let mut foreign = bytes;
        let at = values_of(&foreign, "FILTER");
        foreign[at] = b'b';
        assert_eq!(parse_c3d(&foreign, "s.c3d").unwrap().smoothed, None, "another program's filter");
    }

    #[test]
    fn more_labels_than_one_parameter_holds() {
        for count in [127, 128, 255, 256, 600] {
            let points = PointTrajectory {
                names: (0..count).map(|i| format!("marker {i:03}")).collect(),
                rate: 100.0,
                first_frame: 0,
                frames: vec![(0..count).map(|i| (i % 7 != 0).then(|| DVec3::splat(f64::from(i)))).collect(); 2],
                smoothed: None,
            };
            let bytes = written(&points);
            assert_eq!(parse_c3d(&bytes, "t.c3d").unwrap(), points, "{count}");
            same_as_c3dio(&bytes, &points);
        }
    }

    #[test]
    fn more_frames_than_sixteen_bits_count() {
        for (first_frame, frames) in [(0, 65_535), (0, 65_536), (0, 100_000), (65_530, 10), (70_000, 10)] {
            let points = PointTrajectory {
                names: vec!["a".into()],
                rate: 100.0,
                first_frame,
                frames: (0..frames).map(|i| vec![Some(DVec3::new(f64::from(i), 1.0, 2.0))]).collect(),
                smoothed: None,
            };
            let bytes = written(&points);
            let again = parse_c3d(&bytes, "long.c3d").unwrap();
            assert!(again == points, "{first_frame} {frames}: {} {}", again.first_frame, again.frames.len());
            if first_frame == 0 {
                same_as_c3dio(&bytes, &points);
            }
        }
    }

    #[test]
    fn what_the_format_cannot_hold_is_refused() {
        let message = |points: &PointTrajectory| write_c3d(&mut Vec::new(), points).unwrap_err().to_string();
        let mut points = small();
        points.names[0] = "n".repeat(121);
        assert!(message(&points).contains("121 bytes long, expected at most 120"));
        let names: Vec<String> = (0..5000).map(|i| format!("{i:0>100}")).collect();
        let crowd =
            PointTrajectory { frames: vec![vec![None; names.len()]], names, rate: 1.0, first_frame: 0, smoothed: None };
        assert!(message(&crowd).contains("blocks of parameters, expected at most 255"));
        points = small();
        points.first_frame = usize::MAX - 1;
        assert!(message(&points).contains("the last frame is"));
    }

    proptest! {
        #[test]
        fn written_and_read_again(points in trajectories()) {
            let bytes = written(&points);
            let again = parse_c3d(&bytes, "p.c3d").unwrap();
            prop_assert!(close(&points, &again, 1e-6), "{points:?}\n{again:?}");
            prop_assert_eq!(bytes.len() % BLOCK, 0);
        }
    }
}
