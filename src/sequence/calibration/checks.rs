//! What the numbers of a camera must be, whichever file they come from. Messages begin with the key; the readers put
//! the file and the camera before it.

use std::collections::HashSet;

use anyhow::{Result, bail, ensure};
use glam::{DMat3, DQuat, DVec2, DVec3};

use crate::files::shortened;
use crate::geometry::{BrownConrady, Camera, LARGEST_SIDE, Lens, rodrigues_matrix};

/// Bytes of a camera's name.
const LONGEST_NAME: usize = 100;

/// A length in the file's own unit beyond which a number is damage, not a place.
const FARTHEST: f64 = 1e9;

/// A picture's size, which some programs write as 1088.0.
pub(super) fn picture_size([width, height]: [f64; 2]) -> Result<[u32; 2]> {
    let sane = |side: f64| side.fract() == 0.0 && (1.0..=f64::from(LARGEST_SIDE)).contains(&side);
    ensure!(
        sane(width) && sane(height),
        "size is [{width}, {height}], expected whole numbers from 1 to {LARGEST_SIDE}: width, then height"
    );
    Ok([width as u32, height as u32])
}

/// A Brown-Conrady lens from a camera matrix (row by row) and k1 k2 p1 p2 (k3, and rational terms that must be 0).
pub(super) fn brown_conrady(matrix: [[f64; 3]; 3], distortions: &[f64]) -> Result<Lens> {
    let [[fx, skew, cx], [zero, fy, cy], last] = matrix;
    ensure!(matrix.iter().flatten().all(|entry| entry.is_finite()), "matrix is {matrix:?}, expected finite numbers");
    ensure!(
        skew == 0.0 && zero == 0.0 && last == [0.0, 0.0, 1.0],
        "matrix is {matrix:?}, expected [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]"
    );
    ensure!(
        fx > 0.0 && fy > 0.0 && fx.max(fy) < FARTHEST,
        "matrix has the focal lengths {fx} and {fy}, expected pixels, more than 0"
    );
    ensure!(
        cx.abs().max(cy.abs()) < FARTHEST,
        "matrix has the principal point [{cx}, {cy}], expected a point near the picture, in pixels"
    );
    ensure!(
        distortions.iter().all(|k| k.is_finite()),
        "distortions is {distortions:?}, expected finite numbers k1, k2, p1, p2 and optionally k3"
    );
    let (&[k1, k2, p1, p2], rest) = distortions.split_first_chunk::<4>().unwrap_or((&[f64::NAN; 4], &[]));
    let higher = rest.split_first().map_or(&[][..], |(_, higher)| higher);
    ensure!(
        matches!(distortions.len(), 4 | 5 | 8 | 12 | 14),
        "distortions holds {} numbers, expected k1, k2, p1, p2 and optionally k3",
        distortions.len()
    );
    ensure!(
        higher.iter().all(|&k| k == 0.0),
        "distortions has terms after k3 ({higher:?}), expected k1, k2, p1, p2 and k3 only: calibrate without the rational, \
         thin prism and tilted models"
    );
    let radial = [k1, k2, rest.first().copied().unwrap_or(0.0)];
    let (focal, centre) = (DVec2::new(fx, fy), DVec2::new(cx, cy));
    Ok(Lens::BrownConrady(BrownConrady { focal, centre, radial, tangential: [p1, p2] }))
}

/// A rotation from a Rodrigues vector.
pub(super) fn rotation_vector(vector: [f64; 3]) -> Result<DMat3> {
    let length = DVec3::from_array(vector).length();
    // Programs stay within half a turn; a whole one is room enough to tell degrees by.
    ensure!(
        length <= std::f64::consts::TAU,
        "rotation is {vector:?}, expected a Rodrigues vector in radians, no longer than a full turn (6.283)"
    );
    Ok(rodrigues_matrix(DVec3::from_array(vector)))
}

/// A rotation from a matrix, row by row, with as few digits as a file may give it.
pub(super) fn rotation_matrix(rows: [[f64; 3]; 3]) -> Result<DMat3> {
    let matrix = DMat3::from_cols_array_2d(&rows).transpose();
    let error = (matrix * matrix.transpose() - DMat3::IDENTITY).to_cols_array().iter().fold(0.0, |worst, e| {
        // A NaN must not hide behind the larger of two numbers.
        if e.is_nan() { f64::INFINITY } else { e.abs().max(worst) }
    });
    ensure!(
        error < 1e-3 && matrix.determinant() > 0.0,
        "rotation is {rows:?}, expected a rotation matrix: rows of length 1, at right angles, right-handed"
    );
    // The nearest exact rotation: the inverse of a camera's transform is taken as the transpose.
    Ok(if error < 1e-12 { matrix } else { DMat3::from_quat(DQuat::from_mat3(&matrix).normalize()) })
}

/// A translation in the file's own unit.
pub(super) fn translation(vector: [f64; 3]) -> Result<DVec3> {
    ensure!(
        vector.iter().all(|value| value.abs() < FARTHEST),
        "translation is {vector:?}, expected three finite lengths of sane size"
    );
    Ok(DVec3::from_array(vector))
}

/// The cameras of a file as a whole: at least one, each with a name of its own that can stand in a file's name.
pub(super) fn names(cameras: &[Camera]) -> Result<()> {
    ensure!(!cameras.is_empty(), "holds no camera, expected at least one");
    let mut seen = HashSet::new();
    for Camera { name, .. } in cameras {
        if name.is_empty() || name == "." || name == ".." || name.chars().any(|c| c.is_control() || "/\\".contains(c)) {
            bail!("camera name {name:?} cannot be part of a file's name, expected one without slashes");
        }
        ensure!(
            name.len() <= LONGEST_NAME,
            "camera name `{}` is {} bytes long, expected at most {LONGEST_NAME}: files are called after it",
            shortened(name),
            name.len()
        );
        ensure!(
            name != "metadata",
            "a camera is named `metadata`, expected another name: files keep that for themselves"
        );
        ensure!(seen.insert(name), "two cameras are named `{name}`, expected a name of its own for each");
    }
    Ok(())
}
