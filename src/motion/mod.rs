//! Trajectories of points and bodies: C3D, TRC, BVH and CSV files, and the error between two of them (SPEC A10).

mod points;

pub use points::PointTrajectory;
