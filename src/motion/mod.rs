//! Trajectories of points and bodies: C3D, TRC, BVH, ASF/AMC, DeepMimic and CSV files, and the error between two of them (SPEC A10).

mod bvh;
mod c3d;
mod error;
mod number;
mod pairing;
mod point_file;
mod points;
mod points_csv;
mod skeletal;
#[cfg(test)]
mod test_points;
mod trc;
mod whole_file;

pub(crate) use number::{finite, whole};

pub use bvh::{BvhChannel, BvhJoint, BvhMotion, parse_bvh, write_bvh};
pub use c3d::{parse_c3d, write_c3d};
pub use error::{FrameError, Matching, PointError, TrajectoryError, write_frame_errors};
pub use pairing::PointPairs;
pub use point_file::{PointFormat, read_bvh, read_points, write_points};
pub use points::{LARGEST_COORDINATE, PointTrajectory};
pub use points_csv::{parse_points_csv, write_points_csv};
pub use skeletal::{
    AsfBone, AsfSkeleton, DeepMimicSkeleton, MotionFormat, Placement, SkeletalJoint, SkeletalMotion, UpAxis, parse_amc,
    parse_asf, parse_deepmimic, parse_deepmimic_skeleton, read_skeletal_motion,
};
pub use trc::{parse_trc, write_trc};
