//! How the points lie, and whether a camera can be calibrated from that at all.

use std::collections::HashSet;

use anyhow::{Result, bail, ensure};
use glam::{DAffine3, DMat3, DVec2, DVec3};
use nalgebra::{Matrix3, SymmetricEigen};

use super::pairs::Pair;
use crate::files::choices;

/// Thickness over extent below which points are a plane: a board is flat to a millimetre a metre.
const PLANE: f64 = 2e-3;
/// Width over extent below which points are a line, in the world and in the picture.
const LINE: f64 = 1e-3;

choices! {
    /// How the points of a camera lie (METHOD A2), and the number of them that Tsai's linear phase needs.
    "layout" pub enum Layout => pub fewest: usize {
        /// In a plane: at least 5, and s_x must be held.
        "coplanar" Coplanar => 5,
        /// In space: at least 7.
        "non-coplanar" General => 7,
    }
}

/// The layout of a camera's points and a frame made for them: their centroid, and as its third axis the direction in
/// which they are thinnest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    pub(super) layout: Layout,
    pub(super) local_from_world: DAffine3,
}

impl Placement {
    /// Looks at a camera's points; `wanted` is what the user says they are.
    ///
    /// # Errors
    /// When they are too few, on a line, edge-on in the picture, or not as wanted: with the reason.
    pub(super) fn of(pairs: &[Pair], wanted: Option<Layout>) -> Result<Self> {
        let distinct = pairs.iter().map(|pair| pair.point.to_array().map(f64::to_bits)).collect::<HashSet<_>>().len();
        let fewest = wanted.unwrap_or(Layout::Coplanar).fewest();
        ensure!(
            distinct >= fewest,
            "{distinct} different points are too few, expected at least 5 in a plane or 7 in space"
        );
        let count = pairs.len() as f64;
        let centroid = pairs.iter().map(|pair| pair.point).sum::<DVec3>() / count;
        let mut spread = Matrix3::zeros();
        for pair in pairs {
            let d = nalgebra::Vector3::from((pair.point - centroid).to_array());
            spread += d * d.transpose() / count;
        }
        let eigen = SymmetricEigen::new(spread);
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let [long, wide, thick] = order.map(|at| eigen.eigenvalues[at].max(0.0).sqrt());
        ensure!(
            wide > LINE * long,
            "all points lie on a line (within {:.2} mm of {:.0} mm), expected them spread over a plane or in space",
            2.0 * wide,
            2.0 * long
        );
        ensure!(
            is_spread(pairs),
            "all pixels lie on a line of the picture: the camera sees the points edge-on, or the pairs are wrong"
        );
        let is_flat = thick <= PLANE * long;
        let layout = match wanted {
            None if is_flat => Layout::Coplanar,
            None => Layout::General,
            Some(Layout::General) if is_flat => bail!(
                "the points lie in a plane (within {:.2} mm of {:.0} mm), from which the non-coplanar form cannot tell s_x \
                 and the focal length apart: add points off the plane, or use the coplanar form, which holds s_x",
                2.0 * thick,
                2.0 * long
            ),
            Some(Layout::Coplanar) if !is_flat => bail!(
                "the points do not lie in a plane ({:.2} mm thick, {:.0} mm long), which the coplanar form needs",
                2.0 * thick,
                2.0 * long
            ),
            Some(wanted) => wanted,
        };
        ensure!(
            distinct >= layout.fewest(),
            "{distinct} different points in space are too few, expected at least {}",
            layout.fewest()
        );
        let axis = |at: usize| DVec3::from_slice(eigen.eigenvectors.column(order[at]).as_slice());
        let (x, z) = (axis(0), axis(2));
        // The third axis upwards where it has a choice; a right-handed frame in any case.
        let z = if z.z < 0.0 { -z } else { z };
        let local_from_world = DMat3::from_cols(x, z.cross(x), z).transpose();
        Ok(Self {
            layout,
            local_from_world: DAffine3::from_mat3_translation(local_from_world, -(local_from_world * centroid)),
        })
    }
}

/// Whether the pixels lie on no line.
fn is_spread(pairs: &[Pair]) -> bool {
    let middle = pairs.iter().map(|pair| pair.pixel).sum::<DVec2>() / pairs.len() as f64;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for d in pairs.iter().map(|pair| pair.pixel - middle) {
        (xx, xy, yy) = (xx + d.x * d.x, xy + d.x * d.y, yy + d.y * d.y);
    }
    let (half, apart) = (0.5 * (xx + yy), (0.25 * (xx - yy).powi(2) + xy * xy).sqrt());
    (half - apart).max(0.0).sqrt() > LINE * (half + apart).sqrt()
}
