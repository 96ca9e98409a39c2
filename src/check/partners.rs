//! Which views a view is compared with. All others where there are few; with many cameras that would grow as the square of their number
//! and more, and eight others all around say as much of a view.

/// Views that a view is compared with at most.
const MOST: usize = 8;
/// What would take long with many cameras is looked for among as many that agree least.
const MOST_SUSPECTS: usize = 9;
/// From this many cameras on a check that takes long has fewer rays a silhouette, so that it takes no longer.
const MANY: usize = 16;

/// The views that `view` of `count` is compared with, in their order or, where there are many, evenly spread over it.
pub(super) fn partners(view: usize, count: usize) -> Vec<usize> {
    let others = count.saturating_sub(1);
    if others <= MOST {
        return (0..count).filter(|other| *other != view).collect();
    }
    (0..MOST).map(|at| (view + 1 + at * others / MOST) % count).collect()
}

/// The views that agree least with the others, in their order, by a number each that is smallest for those.
pub(super) fn worst(agreement: &[f64]) -> Vec<usize> {
    let mut worst: Vec<usize> = (0..agreement.len()).collect();
    worst.sort_by(|&a, &b| agreement[a].total_cmp(&agreement[b]));
    worst.truncate(MOST_SUSPECTS);
    worst.sort_unstable();
    worst
}

/// Whether a change of `changed` shows in what is measured of `view`.
pub(super) fn shows(changed: usize, view: usize, count: usize) -> bool {
    changed == view || partners(view, count).contains(&changed)
}

/// Rays a silhouette, of `rays` where there are few cameras.
pub(super) fn fewer(rays: usize, cameras: usize) -> usize {
    (rays * MANY / cameras.max(MANY)).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_has_all_others_or_eight_of_them() {
        assert_eq!(partners(1, 4), [0, 2, 3]);
        assert!(partners(0, 1).is_empty() && partners(0, 9).len() == 8);
        for count in [10, 16, 64, 1000] {
            let mut named = vec![0; count];
            for view in 0..count {
                let mut partners = partners(view, count);
                partners.iter().for_each(|&other| named[other] += 1);
                partners.sort_unstable();
                partners.dedup();
                assert!(partners.len() == MOST && !partners.contains(&view), "{view} of {count}: {partners:?}");
            }
            assert!(named.iter().all(|times| *times == MOST), "every view is as often a partner");
        }
        assert_eq!([9, 16, 64].map(|cameras| fewer(80, cameras)), [80, 80, 20]);
    }
}
