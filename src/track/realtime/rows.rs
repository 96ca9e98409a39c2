//! poses.csv and joints.csv, written a row at a time as the poses come, for those who watch.

use std::fs::File;
use std::io::Write;

use anyhow::{Context, Result};

use crate::body::{Body, PoseTable, PoseWriter};
use crate::files::OutputFolder;
use crate::motion::write_points_csv;
use crate::track::FrameResult;
use crate::track::held::Held;

/// The two tables. Each row is one write, so that a reader sees whole rows.
#[derive(Debug)]
pub(super) struct Rows {
    poses: File,
    joints: File,
    fps: f64,
    before: Option<FrameResult>,
}

impl Rows {
    /// Begins both, with the rows of an earlier run.
    pub(super) fn create(output: &OutputFolder, body: &Body, fps: f64, done: &[FrameResult]) -> Result<Self> {
        let mut header = Vec::new();
        PoseWriter::new(&mut header, body)?.flush()?;
        let create = |name: &str| -> Result<File> {
            let path = output.file(name)?;
            File::create(&path).with_context(|| format!("cannot write {}", path.display()))
        };
        let mut rows = Self { poses: create("poses.csv")?, joints: create("joints.csv")?, fps, before: None };
        rows.poses.write_all(&header).context("cannot write poses.csv")?;
        done.iter().try_for_each(|result| rows.append(body, result))?;
        Ok(rows)
    }

    /// Adds a pose; joints.csv gets empty rows for the frames before it that were left out.
    pub(super) fn append(&mut self, body: &Body, result: &FrameResult) -> Result<()> {
        let both: Vec<FrameResult> = self.before.take().into_iter().chain([result.clone()]).collect();
        let PoseTable { frames, poses } = Held::new(&both, &[], false).table;
        let mut row = Vec::new();
        if let Some(pose) = poses.last() {
            let mut writer = PoseWriter::append(&mut row, body);
            writer.write(result.frame, pose)?;
            writer.flush()?;
        }
        let cannot = |name: &str| format!("cannot write frame {} to {name}; the journal has it", result.frame);
        self.poses.write_all(&row).with_context(|| cannot("poses.csv"))?;
        let mut text = Vec::new();
        write_points_csv(&mut text, &body.joint_trajectory(&PoseTable { frames, poses }, self.fps)?)?;
        // The header and the row of the frame before are there already.
        let known = if both.len() > 1 { 2 } else { 0 };
        let new: Vec<u8> = text.split_inclusive(|byte| *byte == b'\n').skip(known).flatten().copied().collect();
        self.joints.write_all(&new).with_context(|| cannot("joints.csv"))?;
        self.before = Some(result.clone());
        Ok(())
    }
}
