//! The journal of a run: what each frame yielded, bit for bit, appended a frame at a time. A run that is killed loses at
//! most the frame in work, and one that goes on from here ends with the same bytes as one that was never stopped.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};

use super::JointHints;
use crate::body::Body;
use crate::geometry::Camera;

/// What a frame's search found.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameResult {
    /// Index of the frame in the sequence, from 0.
    pub frame: usize,
    /// The pose: mm, radians, in state-vector order.
    pub pose: Vec<f32>,
    /// Its fitness, in [0, 1].
    pub fitness: f32,
    /// Standard deviation of the candidates behind it, one a degree of freedom: mm, radians.
    pub spread: Vec<f32>,
    /// f1 and f2 (METHOD A7) of each view, [`Self::LEFT_OUT`] of one that does not fit the others.
    pub views: Vec<[f32; 2]>,
    /// What the frame says of each joint.
    pub joints: Vec<JointHints>,
}

/// How many values a frame's result has.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) dofs: usize,
    pub(super) views: usize,
    pub(super) joints: usize,
}

impl Extent {
    pub(super) fn of(body: &Body, cameras: &[Camera]) -> Self {
        Self { dofs: body.dof_count(), views: cameras.len(), joints: body.joint_names().len() }
    }
}

impl FrameResult {
    /// The terms of a view that was left out since it does not fit the others: no numbers.
    pub const LEFT_OUT: [f32; 2] = [f32::NAN; 2];

    /// The views that were not left out, and their terms.
    pub fn counted_views(&self) -> impl Iterator<Item = (usize, &[f32; 2])> {
        self.views.iter().enumerate().filter(|(_, terms)| is_counted(terms))
    }

    /// The views that were left out.
    pub fn left_out(&self) -> impl Iterator<Item = usize> + '_ {
        self.views.iter().enumerate().filter(|(_, terms)| !is_counted(terms)).map(|(view, _)| view)
    }

    /// Mean f1 of the views that were not left out; 0 without one.
    pub fn mean_f1(&self) -> f64 {
        let f1 = || self.counted_views().map(|(_, terms)| f64::from(terms[0]));
        f1().sum::<f64>() / f1().count().max(1) as f64
    }

    /// A line of the journal: the frame, the bits of every number in hexadecimal, a checksum of all that. It is of first passes, which leave
    /// ambiguity to the second.
    fn to_line(&self) -> String {
        let mut line = format!("{} {:08x}", self.frame, self.fitness.to_bits());
        let joints = self.joints.iter().flat_map(|hints| [hints.seen, hints.looseness, hints.support]);
        let values = self.pose.iter().chain(&self.spread).chain(self.views.as_flattened()).copied();
        for value in values.chain(joints) {
            line.push_str(&format!(" {:08x}", value.to_bits()));
        }
        let sum = checksum(line.as_bytes());
        line.push_str(&format!(" {sum:016x}\n"));
        line
    }

    /// The inverse; `None` for anything that [`Self::to_line`] does not write.
    fn from_line(line: &str, extent: Extent) -> Option<Self> {
        let (values, sum) = line.rsplit_once(' ')?;
        if u64::from_str_radix(sum, 16).ok()? != checksum(values.as_bytes()) {
            return None;
        }
        let mut words = values.split(' ');
        let frame = words.next()?.parse().ok()?;
        let bits: Option<Vec<f32>> =
            words.map(|word| Some(f32::from_bits(u32::from_str_radix(word, 16).ok()?))).collect();
        let bits = bits?;
        let Extent { dofs, views, joints } = extent;
        if bits.len() != 1 + 2 * dofs + 2 * views + 3 * joints {
            return None;
        }
        let (pose, rest) = bits[1..].split_at(dofs);
        let (spread, rest) = rest.split_at(dofs);
        let (views, joints) = rest.split_at(2 * views);
        Some(Self {
            frame,
            fitness: bits[0],
            pose: pose.to_vec(),
            spread: spread.to_vec(),
            views: views.as_chunks().0.to_vec(),
            joints: (joints.as_chunks().0.iter())
                .map(|&[seen, looseness, support]| JointHints { seen, looseness, support, ambiguity: None })
                .collect(),
        })
    }
}

/// Whether a view of these terms was not left out.
pub(super) fn is_counted(terms: &[f32; 2]) -> bool {
    terms.iter().all(|term| !term.is_nan())
}

/// FNV-1a, 64 bits: enough to tell a line that was written whole from one that was not.
pub(super) fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |sum, byte| (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Which frames a journal holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Numbering {
    /// Each from this one on.
    EachFrom(usize),
    /// Rising ones: real time leaves some out.
    Rising,
}

/// The open journal of a run.
#[derive(Debug)]
pub(super) struct Journal {
    path: PathBuf,
    file: File,
}

impl Journal {
    /// Its name in a track's folder.
    pub(super) const NAME: &'static str = "journal.txt";

    /// Starts an empty journal.
    pub(super) fn create(path: &Path) -> Result<Self> {
        let file = File::create(path).with_context(|| format!("cannot write {}", path.display()))?;
        Ok(Self { path: path.to_path_buf(), file })
    }

    /// Opens the journal of an earlier run and yields its frames. A last line that
    /// was not written whole is cut off; a missing file is an empty journal.
    ///
    /// # Errors
    /// When a line before the last is damaged, frames do not follow each other, or the file cannot be used.
    pub(super) fn resume(path: &Path, numbering: Numbering, extent: Extent) -> Result<(Self, Vec<FrameResult>)> {
        let cannot = || format!("cannot read {}", path.display());
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).with_context(cannot)?;
        let mut reader = BufReader::new(&file);
        let mut results: Vec<FrameResult> = Vec::new();
        let mut whole = 0;
        let mut line = Vec::new();
        loop {
            line.clear();
            if reader.read_until(b'\n', &mut line).with_context(cannot)? == 0 {
                break;
            }
            let number = results.len() + 1;
            let text = std::str::from_utf8(&line).ok().and_then(|line| line.strip_suffix('\n'));
            let Some(result) = text.and_then(|text| FrameResult::from_line(text, extent)) else {
                let is_last = reader.fill_buf().with_context(cannot)?.is_empty();
                ensure!(
                    is_last,
                    "{}, line {number}: it is damaged, expected a frame's result; track again with --force",
                    path.display()
                );
                break;
            };
            let frame = result.frame;
            match (numbering, results.last()) {
                (Numbering::EachFrom(first), _) if frame != first + results.len() => {
                    bail!(
                        "{}, line {number}: it is of frame {frame}, expected {}",
                        path.display(),
                        first + results.len()
                    );
                }
                (Numbering::Rising, Some(before)) if frame <= before.frame => {
                    bail!("{}, line {number}: it is of frame {frame}, after {}", path.display(), before.frame);
                }
                _ => {}
            }
            whole += line.len() as u64;
            results.push(result);
        }
        file.set_len(whole).with_context(cannot)?;
        file.seek(SeekFrom::End(0)).with_context(cannot)?;
        Ok((Self { path: path.to_path_buf(), file }, results))
    }

    /// Adds a frame; after this it survives whatever happens to the process.
    ///
    /// # Errors
    /// When it cannot be written (a full disk, say). What was there before stays.
    pub(super) fn append(&mut self, result: &FrameResult) -> Result<()> {
        // One write of a whole line to the file itself: nothing waits in a buffer of ours.
        self.file.write_all(result.to_line().as_bytes()).with_context(|| {
            format!("cannot write frame {} to {}; the frames before it are safe", result.frame, self.path.display())
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const EXTENT: Extent = Extent { dofs: 3, views: 2, joints: 2 };

    fn result(frame: usize) -> FrameResult {
        let at = frame as f32;
        FrameResult {
            frame,
            pose: vec![0.1 + at, -0.0, f32::MIN_POSITIVE / 2.0],
            fitness: 0.1 * at,
            spread: vec![1.0 / 3.0, 0.0, 7.0],
            views: vec![[0.5, 0.25], [at, 1.0]],
            joints: vec![
                JointHints { seen: 0.75, looseness: at, support: -0.25, ambiguity: None },
                JointHints { seen: at, looseness: 7.0, support: 1.0, ambiguity: None },
            ],
        }
    }

    fn written(frames: std::ops::Range<usize>) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(Journal::NAME);
        let mut journal = Journal::create(&path).unwrap();
        frames.for_each(|frame| journal.append(&result(frame)).unwrap());
        (folder, path)
    }

    #[test]
    fn every_bit_comes_back() {
        let (_folder, path) = written(4..9);
        let (_, results) = Journal::resume(&path, Numbering::EachFrom(4), EXTENT).unwrap();
        let bits = |r: &FrameResult| -> Vec<u32> {
            let joints = r.joints.iter().flat_map(|hints| [hints.seen, hints.looseness, hints.support]);
            let values = r.pose.iter().chain(&r.spread).chain(r.views.as_flattened()).copied();
            values.chain(joints).map(f32::to_bits).collect()
        };
        assert_eq!(results.len(), 5);
        for (at, found) in results.iter().enumerate() {
            assert_eq!(bits(found), bits(&result(4 + at)));
        }
    }

    #[test]
    fn a_cut_at_any_byte_loses_one_frame() {
        let (_folder, path) = written(0..3);
        let all = std::fs::read(&path).unwrap();
        for length in 0..all.len() {
            std::fs::write(&path, &all[..length]).unwrap();
            let (mut journal, results) = Journal::resume(&path, Numbering::EachFrom(0), EXTENT).unwrap();
            let whole = all[..length].iter().filter(|byte| **byte == b'\n').count();
            assert_eq!(results.len(), whole, "cut at {length}");
            (results.len()..3).for_each(|frame| journal.append(&result(frame)).unwrap());
            assert_eq!(std::fs::read(&path).unwrap(), all, "cut at {length}");
        }
    }

    #[test]
    fn damage_is_named() {
        let (_folder, path) = written(0..3);
        let mut bytes = std::fs::read(&path).unwrap();
        bytes[12] ^= 1;
        std::fs::write(&path, &bytes).unwrap();
        let error = Journal::resume(&path, Numbering::EachFrom(0), EXTENT).unwrap_err().to_string();
        assert!(error.contains("journal.txt, line 1: it is damaged"), "{error}");
        let (_folder, path) = written(2..3);
        let error = Journal::resume(&path, Numbering::EachFrom(0), EXTENT).unwrap_err().to_string();
        assert!(error.contains("line 1: it is of frame 2, expected 0"), "{error}");
        // Frames left out are no damage where they are expected; frames that go back are.
        let (_folder, path) = written(0..3);
        let text = std::fs::read_to_string(&path).unwrap();
        let lines: Vec<&str> = text.split_inclusive('\n').collect();
        std::fs::write(&path, [lines[0], lines[2]].concat()).unwrap();
        assert!(Journal::resume(&path, Numbering::EachFrom(0), EXTENT).is_err());
        assert_eq!(Journal::resume(&path, Numbering::Rising, EXTENT).unwrap().1.len(), 2);
        std::fs::write(&path, [lines[2], lines[1]].concat()).unwrap();
        let error = Journal::resume(&path, Numbering::Rising, EXTENT).unwrap_err().to_string();
        assert!(error.contains("line 2: it is of frame 1, after 2"), "{error}");
    }

    #[test]
    fn a_full_disk_is_one_sentence() {
        if !Path::new("/dev/full").exists() {
            return;
        }
        let mut journal = Journal::create(Path::new("/dev/full")).unwrap();
        let error = format!("{:#}", journal.append(&result(7)).unwrap_err());
        assert!(error.contains("cannot write frame 7 to /dev/full") && error.contains("No space"), "{error}");
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("j");
            std::fs::write(&path, bytes).unwrap();
            let _ = Journal::resume(&path, Numbering::EachFrom(0), EXTENT);
        }
    }
}
