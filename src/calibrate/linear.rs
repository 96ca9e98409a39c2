//! Tsai's linear phase: the radial alignment constraint (METHOD A2). An image point lies on the line from the image centre
//! through its ideal place, however strong the radial distortion: X_d y_c = Y_d x_c. That is linear in the rotation's first
//! two rows and the translation across the view; focal length and distance follow from a second linear step.
//!
//! Written homogeneously, so that nothing breaks where T_y is 0 (Tsai divides by it and asks the user to avoid that).

use glam::{DAffine3, DMat3, DVec2, DVec3};
use nalgebra::{DMatrix, SymmetricEigen};

use super::layout::Layout;

/// A plane closer than this to parallel with the picture (cosine of 10 degrees) shows too little perspective: pixels 1.3 % from
/// square look like as much of a tilt.
const PARALLEL: f64 = 0.985;

/// What the linear phase finds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    pub(super) camera_from_local: DAffine3,
    /// Pixels.
    pub(super) focal: f64,
    /// s_x.
    pub(super) aspect: f64,
}

/// Why there is no start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Failure {
    /// The equations do not determine the rotation.
    Undetermined,
    /// The plane is parallel to the picture.
    Parallel,
    /// The focal length comes out negative or points come out behind the camera.
    Behind,
}

/// The pose and focal length of `points` (a frame of their own, near its origin; z = 0 where they are coplanar) at
/// `offsets` from the image centre (pixels). With `focal` that length is taken instead of the estimate.
pub(super) fn radial_alignment(
    layout: Layout,
    points: &[DVec3],
    offsets: &[DVec2],
    focal: Option<f64>,
) -> Result<Start, Failure> {
    // Lengths near 1 on both sides keep the squared equations well conditioned.
    let size = (points.iter().map(|p| p.length_squared()).sum::<f64>() / points.len() as f64).sqrt();
    let reach = (offsets.iter().map(|o| o.length_squared()).sum::<f64>() / offsets.len() as f64).sqrt();
    // All in one place: nothing to align, and what follows would not be numbers.
    if size.is_nan() || size <= 0.0 || reach.is_nan() || reach <= 0.0 {
        return Err(Failure::Undetermined);
    }
    let points: Vec<DVec3> = points.iter().map(|p| p / size).collect();
    let seen: Vec<DVec2> = offsets.iter().map(|o| o / reach).collect();
    let alignment = alignment(layout, &points, &seen)?;
    let Alignment { rows: [first, second], across, aspect } = alignment;
    let third = first.cross(second);
    // The rows are estimates: the nearest rotation.
    let rotation = nearest_rotation(DMat3::from_cols(first, second, third).transpose());
    let [first, second, third] = [0, 1, 2].map(|row| rotation.row(row));
    if layout == Layout::Coplanar && third.z.abs() > PARALLEL {
        return Err(Failure::Parallel);
    }
    // f (r p + t) = X (r3 p + t_z), for both picture axes; sums of the normal equations of f and t_z.
    let (mut ff, mut ft, mut tt, mut fr, mut tr) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (p, seen) in points.iter().zip(&seen) {
        let depth = third.dot(*p);
        for (ideal, seen) in [(first.dot(*p) + across.x, seen.x / aspect), (second.dot(*p) + across.y, seen.y)] {
            (ff, ft, tt) = (ff + ideal * ideal, ft - ideal * seen, tt + seen * seen);
            (fr, tr) = (fr + ideal * seen * depth, tr - seen * seen * depth);
        }
    }
    let (scaled_focal, distance) = match focal {
        Some(focal) => {
            let focal = focal / reach;
            (focal, (tr - ft * focal) / tt)
        }
        None => {
            let determinant = ff * tt - ft * ft;
            ((fr * tt - tr * ft) / determinant, (ff * tr - ft * fr) / determinant)
        }
    };
    let in_front = points.iter().all(|p| third.dot(*p) + distance > 0.0);
    // Written so that what is not a number fails.
    if !(scaled_focal > 1e-3 && distance > 0.0 && in_front) {
        return Err(Failure::Behind);
    }
    let translation = DVec3::new(across.x, across.y, distance) * size;
    let camera_from_local = DAffine3::from_mat3_translation(rotation, translation);
    let is_finite = translation.is_finite() && aspect.is_finite() && scaled_focal.is_finite();
    is_finite.then_some(Start { camera_from_local, focal: scaled_focal * reach, aspect }).ok_or(Failure::Undetermined)
}

/// The first two rows of the rotation and the translation across the view.
struct Alignment {
    rows: [DVec3; 2],
    across: DVec2,
    aspect: f64,
}

fn alignment(layout: Layout, points: &[DVec3], seen: &[DVec2]) -> Result<Alignment, Failure> {
    let unknowns = if layout == Layout::Coplanar { 6 } else { 8 };
    let row = |(p, seen): (&DVec3, &DVec2)| match layout {
        Layout::Coplanar => {
            vec![seen.y * p.x, seen.y * p.y, seen.y, -seen.x * p.x, -seen.x * p.y, -seen.x]
        }
        Layout::General => {
            let [x, y, z] = p.to_array();
            vec![seen.y * x, seen.y * y, seen.y * z, seen.y, -seen.x * x, -seen.x * y, -seen.x * z, -seen.x]
        }
    };
    let mut squared = DMatrix::zeros(unknowns, unknowns);
    for equation in points.iter().zip(seen).map(row) {
        let equation = nalgebra::DVector::from_vec(equation);
        squared += &equation * equation.transpose();
    }
    let eigen = SymmetricEigen::new(squared);
    let mut order: Vec<usize> = (0..unknowns).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    // A second direction without a residual leaves the solution open; squares halve the digits.
    if eigen.eigenvalues[order[1]].is_nan()
        || eigen.eigenvalues[order[1]] < 1e-13 * eigen.eigenvalues[order[unknowns - 1]]
    {
        return Err(Failure::Undetermined);
    }
    let solution = eigen.eigenvectors.column(order[0]);
    let mut found = match layout {
        Layout::Coplanar => planar_rows(solution.as_slice()),
        Layout::General => rows_in_space(solution.as_slice()),
    };
    // The solution's sign: what lies right of the centre is seen there.
    let side: f64 = points
        .iter()
        .zip(seen)
        .map(|(p, seen)| {
            let ideal = DVec2::new(found.rows[0].dot(*p), found.rows[1].dot(*p)) + found.across;
            ideal.dot(*seen)
        })
        .sum();
    if side < 0.0 {
        found.across = -found.across;
        // In a plane the rows' third elements follow from the others up to a sign of their own.
        found.rows = match layout {
            Layout::General => found.rows.map(|row| -row),
            Layout::Coplanar => found.rows.map(|row| DVec3::new(-row.x, -row.y, row.z)),
        };
    }
    if layout == Layout::Coplanar {
        choose_tilt(&mut found, points, seen);
    }
    let is_finite = found.rows.iter().all(|row| row.is_finite()) && found.aspect > 0.0;
    if is_finite { Ok(found) } else { Err(Failure::Undetermined) }
}

/// s_x r1, s_x r2, s_x r3, s_x T_x, r4, r5, r6, T_y, all times one factor.
fn rows_in_space(solution: &[f64]) -> Alignment {
    let (first, second) = (DVec3::from_slice(&solution[..3]), DVec3::from_slice(&solution[4..7]));
    let (scaled, scale) = (first.length(), second.length());
    let aspect = scaled / scale;
    Alignment {
        rows: [first / scaled, second / scale],
        across: DVec2::new(solution[3] / scaled, solution[7] / scale),
        aspect,
    }
}

/// r1, r2, T_x, r4, r5, T_y, all times one factor: the larger singular value of [r1 r2; r4 r5] is 1 in any rotation.
fn planar_rows(solution: &[f64]) -> Alignment {
    let [a, b, tx, c, d, ty] = [0, 1, 2, 3, 4, 5].map(|at| solution[at]);
    let (sum, determinant) = (a * a + b * b + c * c + d * d, a * d - b * c);
    let largest = (0.5 * (sum + (sum * sum - 4.0 * determinant * determinant).max(0.0).sqrt())).sqrt();
    let [a, b, c, d] = [a, b, c, d].map(|element| element / largest);
    let r3 = (1.0 - a * a - b * b).max(0.0).sqrt();
    let r6 = (1.0 - c * c - d * d).max(0.0).sqrt().copysign(-(a * c + b * d));
    Alignment { rows: [DVec3::new(a, b, r3), DVec3::new(c, d, r6)], across: DVec2::new(tx, ty) / largest, aspect: 1.0 }
}

/// Of the two tilts of a plane that fit the alignment, the one with a positive focal length: what is seen larger is
/// nearer.
fn choose_tilt(found: &mut Alignment, points: &[DVec3], seen: &[DVec2]) {
    let third = found.rows[0].cross(found.rows[1]);
    // Ideal places grow with depth against what is seen: the correlation of depth with ideal / seen is positive.
    let ratios: Vec<(f64, f64, f64)> = points
        .iter()
        .zip(seen)
        .map(|(p, seen)| {
            let ideal = DVec2::new(found.rows[0].dot(*p), found.rows[1].dot(*p)) + found.across;
            (third.dot(*p), ideal.dot(*seen), seen.length_squared())
        })
        .collect();
    let (top, bottom) = ratios.iter().fold((0.0, 0.0), |(t, b), (_, is, s)| (t + is, b + s));
    let mean = top / bottom;
    let trend: f64 = ratios.iter().map(|(depth, is, s)| depth * (is - mean * s)).sum();
    if trend < 0.0 {
        found.rows = found.rows.map(|row| DVec3::new(row.x, row.y, -row.z));
    }
}

/// The rotation nearest to a matrix that is nearly one, by Newton's iteration for the polar decomposition.
fn nearest_rotation(mut matrix: DMat3) -> DMat3 {
    for _ in 0..20 {
        let inverse = matrix.inverse().transpose();
        if !inverse.is_finite() {
            break;
        }
        matrix = (matrix + inverse) * 0.5;
    }
    matrix
}
