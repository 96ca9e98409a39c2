//! One view of the board: the plane's mapping to the picture, and what it says of lens and pose (Zhang 2000).

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3};
use nalgebra::{DMatrix, Matrix3, SymmetricEigen};

use super::target::{Board, SeenCorner};

/// The mapping of the board's plane (mm) to pixels, by the direct linear method on coordinates of like size.
pub(super) fn homography(board: &Board, seen: &[SeenCorner]) -> Option<DMat3> {
    let on_board: Vec<DVec2> = seen.iter().map(|at| board.corner(at.corner).truncate()).collect();
    let pixels: Vec<DVec2> = seen.iter().map(|at| at.pixel).collect();
    let (to_like, to_unit) = (normaliser(&on_board)?, normaliser(&pixels)?);
    let mut squares = DMatrix::<f64>::zeros(9, 9);
    for (&point, &pixel) in on_board.iter().zip(&pixels) {
        let (p, q) = (to_like * point.extend(1.0), to_unit * pixel.extend(1.0));
        let rows = [
            [p.x, p.y, 1.0, 0.0, 0.0, 0.0, -q.x * p.x, -q.x * p.y, -q.x],
            [0.0, 0.0, 0.0, p.x, p.y, 1.0, -q.y * p.x, -q.y * p.y, -q.y],
        ];
        for row in rows {
            for i in 0..9 {
                for j in 0..9 {
                    squares[(i, j)] += row[i] * row[j];
                }
            }
        }
    }
    let eigen = SymmetricEigen::new(squares);
    let least = eigen.eigenvalues.imin();
    let h = eigen.eigenvectors.column(least);
    // Row by row in the vector, column by column in the matrix.
    let found = DMat3::from_cols_array(&[h[0], h[3], h[6], h[1], h[4], h[7], h[2], h[5], h[8]]);
    let found = to_unit.inverse() * found * to_like;
    (found.is_finite() && found.z_axis.z.abs() > 1e-12).then(|| found * (1.0 / found.z_axis.z))
}

/// Moves and scales points to their centroid and a mean distance of 1.
fn normaliser(points: &[DVec2]) -> Option<DMat3> {
    let count = points.len() as f64;
    let middle = points.iter().sum::<DVec2>() / count;
    let away = points.iter().map(|point| point.distance(middle)).sum::<f64>() / count;
    (away > 1e-9).then(|| {
        let s = 1.0 / away;
        DMat3::from_cols(DVec3::X * s, DVec3::Y * s, (-middle * s).extend(1.0))
    })
}

/// The focal length in pixels that the mappings of several views agree on, for square pixels and a known centre: the
/// images of the board's two axes are at right angles and of one length. None where no view is tilted enough to tell.
pub(super) fn focal_length(mappings: &[DMat3], centre: DVec2) -> Option<f64> {
    let to_centre = DMat3::from_cols(DVec3::X, DVec3::Y, (-centre).extend(1.0));
    // a (…) = b, a = 1/f², two equations a view, in coordinates of like size.
    let size = centre.length().max(1.0);
    let shrink = DMat3::from_diagonal(DVec3::new(1.0 / size, 1.0 / size, 1.0));
    let (mut squared, mut product) = (0.0, 0.0);
    for mapping in mappings {
        let h = shrink * to_centre * *mapping;
        let scale = 1.0 / h.x_axis.length().max(h.y_axis.length());
        let (p, q) = (h.x_axis * scale, h.y_axis * scale);
        for (of_a, b) in [
            (p.x * q.x + p.y * q.y, -p.z * q.z),
            (p.x * p.x + p.y * p.y - q.x * q.x - q.y * q.y, q.z * q.z - p.z * p.z),
        ] {
            squared += of_a * of_a;
            product += of_a * b;
        }
    }
    let a = product / squared;
    (a.is_finite() && a > 1e-6).then(|| size / a.sqrt())
}

/// The board's pose before a camera without distortion: camera from board.
pub(super) fn pose(mapping: &DMat3, focal: f64, centre: DVec2) -> Option<DAffine3> {
    let inverse = DMat3::from_cols(
        DVec3::new(1.0 / focal, 0.0, 0.0),
        DVec3::new(0.0, 1.0 / focal, 0.0),
        DVec3::new(-centre.x / focal, -centre.y / focal, 1.0),
    );
    let h = inverse * *mapping;
    let scale = 2.0 / (h.x_axis.length() + h.y_axis.length());
    // The board stands before the camera.
    let scale = if h.z_axis.z < 0.0 { -scale } else { scale };
    let (x, y) = (h.x_axis * scale, h.y_axis * scale);
    let rough = DMat3::from_cols(x, y, x.cross(y));
    let pose = DAffine3::from_mat3_translation(nearest_rotation(rough)?, h.z_axis * scale);
    pose.is_finite().then_some(pose)
}

/// The rotation nearest to a matrix.
fn nearest_rotation(matrix: DMat3) -> Option<DMat3> {
    let svd = Matrix3::from_column_slice(&matrix.to_cols_array()).svd(true, true);
    let rotation = svd.u? * svd.v_t?;
    let rotation = DMat3::from_cols_slice(rotation.as_slice());
    (rotation.determinant() > 0.0).then(|| DMat3::from_quat(DQuat::from_mat3(&rotation).normalize()))
}
