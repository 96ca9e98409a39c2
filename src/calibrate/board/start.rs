//! Where the cameras stand to each other, from moments at which two of them see the board.

use anyhow::{Result, bail};
use glam::{DAffine3, DMat3};

/// Places every camera in the frame of the first (camera from world), through the neighbours that see the board together
/// most often. `poses` holds camera from board, a list of cameras a moment.
///
/// # Errors
/// When no moment joins some camera to the others.
pub(super) fn place_cameras(poses: &[Vec<Option<DAffine3>>], names: &[String]) -> Result<Vec<DAffine3>> {
    let mut places: Vec<Option<DAffine3>> = vec![None; names.len()];
    if let Some(first) = places.first_mut() {
        *first = Some(DAffine3::IDENTITY);
    }
    let together = |a: usize, b: usize| poses.iter().filter(|views| views[a].is_some() && views[b].is_some()).count();
    while places.iter().any(Option::is_none) {
        let known = (0..names.len()).filter(|&camera| places[camera].is_some());
        let pairs = known.flat_map(|known| (0..names.len()).map(move |other| (known, other)));
        let open = pairs.filter(|&(_, other)| places[other].is_none());
        let best = open.map(|(known, other)| (together(known, other), known, other)).max_by_key(|&(count, ..)| count);
        let Some((1.., known, other)) = best else {
            let name = names.iter().zip(&places).find(|(_, place)| place.is_none()).map_or("", |(name, _)| name);
            bail!(
                "camera `{name}` never sees the board at a moment at which one of the others does, expected that two \
                 cameras see it at once, in videos that begin at the same moment"
            );
        };
        let relative: Vec<DAffine3> =
            poses.iter().filter_map(|views| Some(views[other]? * views[known]?.inverse())).collect();
        if let (Some(relative), Some(place)) = (most_central(&relative), places[known]) {
            places[other] = Some(relative * place);
        }
    }
    Ok(places.into_iter().flatten().collect())
}

/// The motion that is nearest to all others together: one wrong board cannot move it.
fn most_central(motions: &[DAffine3]) -> Option<DAffine3> {
    let apart = |one: &DAffine3, other: &DAffine3| {
        let length = one.translation.length().max(1.0);
        one.translation.distance(other.translation) + length * angle(one.matrix3, other.matrix3)
    };
    let total = |one: &DAffine3| motions.iter().map(|other| apart(one, other)).sum::<f64>();
    motions.iter().min_by(|a, b| total(a).total_cmp(&total(b))).copied()
}

/// The angle between two rotations, radians.
fn angle(one: DMat3, other: DMat3) -> f64 {
    let turn = one.transpose() * other;
    let trace = turn.x_axis.x + turn.y_axis.y + turn.z_axis.z;
    (0.5 * (trace - 1.0)).clamp(-1.0, 1.0).acos()
}
