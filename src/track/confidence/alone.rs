//! What views would say of somebody who is alone in them: whoever comes by is no reason to take her for lost (METHOD A8).

use crate::evaluate::{EvidenceSum, Objective, ViewCounts};

/// How much larger than what is drawn somebody may be seen, clothes and hair included: what is seen beyond shows somebody else.
const LARGER: f64 = 1.25;

/// f1 and f2 of each view, as if no more were seen in it than somebody of the drawn one's size shows.
pub(in crate::track) fn terms_alone(objective: &Objective, views: &[ViewCounts]) -> Vec<[f32; 2]> {
    views.iter().map(|view| objective.view_terms(&alone(view))).collect()
}

fn alone(view: &ViewCounts) -> ViewCounts {
    let ViewCounts { mut components, mut evidence } = *view;
    let most = LARGER * f64::from(components.area_model);
    if most < f64::from(components.area_obs) {
        let share = most / f64::from(components.area_obs);
        components.area_obs = most as u32;
        if let Some(EvidenceSum { sum, best }) = &mut evidence {
            *best = ((f64::from(*best) * share) as u32).max((*sum).max(0).unsigned_abs());
        }
    }
    ViewCounts { components, evidence }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::{Components, ObjectiveKind};

    const HERS: Components = Components { area_obs: 1100, area_model: 1000, overlap: 900, edges: 100, proximity: 6350 };

    fn evidence(sum: i32, best: u32) -> Option<EvidenceSum> {
        Some(EvidenceSum { sum, best })
    }

    #[test]
    fn who_comes_by_changes_little_and_who_is_gone_is_gone() {
        let objective = Objective::of(ObjectiveKind::Evidence);
        let term = |components, evidence| terms_alone(&objective, &[ViewCounts { components, evidence }])[0];
        let by_herself = term(HERS, evidence(6000, 7700));
        assert_eq!(by_herself, objective.view_terms(&ViewCounts { components: HERS, evidence: evidence(6000, 7700) }));
        // Somebody as large beside her, of whom as much is to be had.
        let beside = Components { area_obs: 2400, ..HERS };
        let with_another = term(beside, evidence(6000, 16_800));
        assert!((0.85..=1.0).contains(&(with_another[0] / by_herself[0])), "{with_another:?} and {by_herself:?}");
        assert_eq!(with_another[1], by_herself[1]);
        // Only the other one is left, and one who is taken for more than there is of her.
        let gone = Components { overlap: 100, ..beside };
        assert_eq!(term(gone, evidence(-3000, 16_800))[0], 0.0);
        assert_eq!(term(beside, evidence(16_000, 16_800))[0], 1.0);
    }

    #[test]
    fn silhouettes_count_alike() {
        let objective = Objective::of(ObjectiveKind::Ws);
        let term = |components| terms_alone(&objective, &[ViewCounts { components, evidence: None }])[0][0];
        let (by_herself, beside) = (term(HERS), term(Components { area_obs: 2400, ..HERS }));
        assert!((0.9..1.0).contains(&(beside / by_herself)), "{beside} and {by_herself}");
        // Who is drawn much too small matches worse than who is drawn as large as she is.
        let crouching = term(Components { area_model: 400, overlap: 400, ..HERS });
        assert!(crouching < term(Components { area_model: 1000, overlap: 1000, ..HERS }), "{crouching}");
        assert_eq!(term(Components::default()), 0.0);
    }
}
