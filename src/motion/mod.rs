//! Trajectories of points and bodies: C3D, TRC, BVH, ASF/AMC, DeepMimic and CSV files, and the error between two of them (METHOD A10).

mod bvh;
mod c3d;
mod convention;
mod error;
mod gaps;
mod joint_names;
mod low_pass;
mod mot;
mod number;
mod pairing;
mod points;
mod points_csv;
mod skeletal;
#[cfg(test)]
mod test_points;
mod trc;
mod whole_file;

use std::path::Path;

use anyhow::{Context, Result, anyhow};

pub(crate) use convention::y_up;
pub(crate) use number::{finite, whole};

pub use bvh::{BvhChannel, BvhJoint, BvhMotion, BvhStatement, parse_bvh, write_bvh};
pub use c3d::{parse_c3d, write_c3d};
pub use convention::Convention;
pub use error::{FARTHEST_SHIFT, FrameError, Matching, PointError, TrajectoryError, best_shift, write_frame_errors};
pub use low_pass::{LeftAsIs, LowPass, runs_of, unwrap_angles};
pub use mot::{CoordinateTable, write_mot};
pub use pairing::PointPairs;
pub use points::{LARGEST_COORDINATE, PointTrajectory};
pub use points_csv::{parse_points_csv, write_points_csv, write_points_csv_with_sigmas};
pub use skeletal::{
    AsfBone, AsfSkeleton, DeepMimicSkeleton, MotionFormat, Placement, SkeletalJoint, SkeletalMotion, UpAxis, parse_amc,
    parse_asf, parse_deepmimic, parse_deepmimic_skeleton, read_skeletal_motion,
};
pub use trc::{parse_trc, write_pose2sim_trc, write_trc};

use crate::files::{Overwrite, check_regular, choices, write_atomically};
use points::PointFile;
use whole_file::{extension, read_bytes, text};

choices! {
    /// The formats that hold points, by their extensions.
    "point format" pub enum PointFormat => file: &'static PointFile {
        /// C3D of any processor, with units and a frame rate.
        "c3d" C3d => &c3d::POINTS,
        /// OpenSim's TRC.
        "trc" Trc => &trc::POINTS,
        /// A table with columns of x, y and z a point.
        "csv" Csv => &points_csv::POINTS,
        /// BVH, whose joints and free ends are read as points.
        "bvh" Bvh => &bvh::POINTS,
    }
}

impl PointFormat {
    /// From a file's extension, in any case.
    ///
    /// # Errors
    /// When it is that of no format.
    pub fn of(path: &Path) -> Result<Self> {
        Self::from_name(&extension(path)).with_context(|| path.display().to_string())
    }

    /// Of a file that is to be read.
    ///
    /// # Errors
    /// As [`Self::of`], and when nothing that can be read is there.
    pub(crate) fn of_input(path: &Path) -> Result<Self> {
        // A name without an ending is more often a wrong one than a file of no known format.
        if extension(path).is_empty() {
            check_regular(path).map_err(|why| anyhow!(why))?;
        }
        Self::of(path)
    }
}

/// Reads points (mm) from a file, whose format its extension tells. A BVH's joints and free ends become points
/// ([`BvhMotion::to_points`]); one that says no unit is taken to be in millimetres. Axes stay as they are in the file, but for a BVH that
/// says them.
///
/// # Errors
/// One sentence with the file, the line or byte, what was found and what was expected.
pub fn read_points(path: &Path) -> Result<PointTrajectory> {
    let format = PointFormat::of_input(path)?;
    (format.file().read)(&read_bytes(path)?, &path.display().to_string())
}

/// Reads points (mm) from a file whose axes are y-up, and turns them z-up; a BVH that says so itself is turned once.
///
/// # Errors
/// As [`read_points`].
pub fn read_y_up_points(path: &Path) -> Result<PointTrajectory> {
    if PointFormat::of_input(path)? == PointFormat::Bvh {
        let motion = read_bvh(path)?;
        let points = motion.to_points().with_context(|| path.display().to_string())?;
        return Ok(if motion.statement.is_some() { points } else { points.y_up_to_z_up() });
    }
    Ok(read_points(path)?.y_up_to_z_up())
}

/// Reads a BVH file with its skeleton.
///
/// # Errors
/// As [`parse_bvh`], and when the file cannot be read.
pub fn read_bvh(path: &Path) -> Result<BvhMotion> {
    let bytes = read_bytes(path)?;
    let name = path.display().to_string();
    parse_bvh(text(&bytes, &name)?, &name)
}

/// Writes points as the extension says, through a temporary name.
///
/// # Errors
/// When the trajectory breaks [`PointTrajectory::check`], the format needs a frame rate that is unknown, the file is
/// there and may not be replaced, writing fails, or the extension is `.bvh`, which needs a skeleton.
pub fn write_points(path: &Path, points: &PointTrajectory, overwrite: Overwrite) -> Result<()> {
    let write = writer_of(path)?;
    let file_name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    write_atomically(path, overwrite, |out| write(out, points, &file_name))
}

/// Writes points (mm, z up) as the extension says, in the axes and the unit of a convention.
///
/// # Errors
/// As [`write_points`], and when the format states no unit but the convention's is not mm.
pub fn write_points_by(
    path: &Path,
    points: PointTrajectory,
    convention: Convention,
    overwrite: Overwrite,
) -> Result<()> {
    if convention == Convention::Pantin {
        return write_points(path, &points, overwrite);
    }
    writer_of(path)?;
    let format = PointFormat::of(path)?;
    let write = format.file().write_metres.ok_or_else(|| {
        let others = PointFormat::ALL.into_iter().filter(|format| format.file().write_metres.is_some());
        let others: Vec<String> = others.map(|format| format!(".{format}")).collect();
        anyhow!(
            "cannot write {}: .{format} files here are in mm with z up, expected {} for the convention {convention}",
            path.display(),
            others.join(", ")
        )
    })?;
    let points = points.z_up_to_y_up();
    let file_name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    write_atomically(path, overwrite, |out| write(out, &points, &file_name))
}

/// How points are written into a file of that name.
fn writer_of(path: &Path) -> Result<points::WritePoints> {
    let format = PointFormat::of(path)?;
    format.file().write.map_err(|why| {
        let others = PointFormat::ALL.into_iter().filter(|format| format.file().write.is_ok());
        let others: Vec<String> = others.map(|format| format!(".{format}")).collect();
        anyhow!("cannot write {}: {why}; expected one of {}", path.display(), others.join(", "))
    })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::test_points::{close, trajectories};
    use super::*;
    use proptest::strategy::{Strategy, ValueTree};

    #[test]
    fn by_extension_and_never_over_a_file() {
        let folder = tempfile::tempdir().unwrap();
        let mut runner = proptest::test_runner::TestRunner::deterministic();
        let mut points = trajectories().new_tree(&mut runner).unwrap().current();
        points.rate = 50.0;
        points.first_frame = 2;
        for file in ["a.c3d", "a.TRC", "a.csv"] {
            let path = folder.path().join(file);
            write_points(&path, &points, Overwrite::Refuse).unwrap();
            assert!(close(&points, &read_points(&path).unwrap(), 1e-3), "{file}");
            let message = format!("{:#}", write_points(&path, &points, Overwrite::Refuse).unwrap_err());
            assert!(message.contains("--force"), "{message}");
        }
    }

    #[test]
    fn each_fault_is_one_sentence() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let message = |path: &Path| format!("{:#}", read_points(path).unwrap_err());
        assert!(
            message(&at("walk.fbx"))
                .contains("walk.fbx: unknown point format `fbx`, the nearest is `c3d` (known: c3d, trc, csv, bvh)")
        );
        assert!(message(&at("none.trc")).contains("cannot read"));
        fs::write(at("binary.trc"), b"Path\n\xff\xfe").unwrap();
        assert!(message(&at("binary.trc")).contains("line 2: byte 5 is not UTF-8"));
        fs::create_dir(at("folder.csv")).unwrap();
        assert!(message(&at("folder.csv")).contains("is a folder, expected a recording of motion"));
        let mut runner = proptest::test_runner::TestRunner::deterministic();
        let mut points = trajectories().new_tree(&mut runner).unwrap().current();
        let refused = format!("{:#}", write_points(&at("a.bvh"), &points, Overwrite::Refuse).unwrap_err());
        assert!(refused.contains("a skeleton, which points alone do not give"), "{refused}");
        points.rate = 50.0;
        let by = |name: &str, convention| write_points_by(&at(name), points.clone(), convention, Overwrite::Refuse);
        let refused = format!("{:#}", by("b.csv", Convention::OpenSim).unwrap_err());
        assert!(refused.contains("b.csv: .csv files here are in mm with z up, expected .trc for"), "{refused}");
        assert!(format!("{:#}", by("b.bvh", Convention::OpenSim).unwrap_err()).contains("a skeleton"));
        by("b.trc", Convention::OpenSim).unwrap();
        assert!(close(&points, &read_points(&at("b.trc")).unwrap().y_up_to_z_up(), 6e-5));
        points.rate = 0.0;
        for file in ["a.c3d", "a.trc"] {
            let refused = format!("{:#}", write_points(&at(file), &points, Overwrite::Refuse).unwrap_err());
            assert!(refused.contains("frame rate is unknown"), "{refused}");
            assert!(!at(file).exists());
        }
    }
}
