//! The objective functions (METHOD A7): from what is counted of a candidate to one number in [0, 1], to be maximised.

use std::ops::Range;

use anyhow::{Result, ensure};

use super::components::Components;
use super::edge_term::EdgeTerm;
use super::evidence::EvidenceSum;
use super::segments::SegmentSums;
use super::view_counts::ViewCounts;
use crate::arithmetic::real_power;
use crate::features::{Segment, Segments};
use crate::files::choices;

choices! {
    /// How the silhouette and the edge terms of the cameras are combined.
    #[derive(Default)]
    "objective" pub enum ObjectiveKind => pub formula: (Area, Terms, Views) {
        /// Weighted sum of the terms over all cameras together.
        "ws" Ws => (Area::Silhouette, Terms::Sum, Views::Together),
        /// Product of powers of the terms over all cameras together; the default where silhouettes are compared, best on average of these.
        "sp" #[default] Sp => (Area::Silhouette, Terms::Product, Views::Together),
        /// Mean over cameras of the weighted sums.
        "aows" Aows => (Area::Silhouette, Terms::Sum, Views::Mean),
        /// Mean over cameras of the products.
        "aosp" Aosp => (Area::Silhouette, Terms::Product, Views::Mean),
        /// Product over cameras of the products.
        "posp" Posp => (Area::Silhouette, Terms::Product, Views::Product),
        /// Product of powers over all cameras together, of soft evidence in place of the silhouette; the default of `track` with `maes` off line.
        "evidence" Evidence => (Area::Evidence, Terms::Product, Views::Together),
    }
}

/// What the first term judges the drawn area by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Area {
    /// The observed silhouette, whole or in segments.
    Silhouette,
    /// Soft evidence, which the observations must carry.
    Evidence,
}

/// How the silhouette and the edge term become one number; `glsl/evaluate/objective.glsl` has the same under the same numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Terms {
    /// Their sum, each times its weight.
    Sum = 0,
    /// The product of their powers.
    Product = 1,
}

/// Over which cameras; `glsl/evaluate/objective.glsl` has the same under the same numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Views {
    /// All together: their components are added up first.
    Together = 0,
    /// Each by itself, and the mean of what they yield.
    Mean = 1,
    /// Each by itself, and the product of what they yield.
    Product = 2,
}

/// An objective function with its weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Objective {
    /// How terms combine.
    pub kind: ObjectiveKind,
    /// Share of "observed silhouette covered" against "drawn silhouette on the observed one", in [0, 1].
    pub beta: f32,
    /// Weight or exponent of the silhouette term.
    pub w1: f32,
    /// Weight or exponent of the edge term.
    pub w2: f32,
    /// What the edge term is made of where there are segments.
    pub edges: EdgeTerm,
}

impl Default for Objective {
    fn default() -> Self {
        Self::of(ObjectiveKind::default())
    }
}

/// What the first term is made of, besides the components.
#[derive(Clone, Copy, Debug)]
pub(crate) enum AreaSums<'a> {
    /// Nothing: silhouettes are whole.
    Whole,
    /// Sums of segments, `[candidate][view][segment]`.
    Segments(&'a Segments, &'a [SegmentSums]),
    /// Evidence, `[candidate][view]`, and before it the best of each view.
    Evidence(&'a [u32], &'a [i32]),
}

/// What the first term of evidence never falls below, so that edges lead to a candidate on which none speaks for a person.
const LEAST_EVIDENCE: f32 = 1e-6;

impl Objective {
    /// A kind with its default weights: equal ones, and with evidence, beside which equal edges count too much, 3 to 1.
    pub fn of(kind: ObjectiveKind) -> Self {
        let (w1, w2) = match kind.formula().0 {
            Area::Silhouette => (0.5, 0.5),
            Area::Evidence => (0.75, 0.25),
        };
        Self { kind, beta: 0.5, w1, w2, edges: EdgeTerm::Whole }
    }

    /// Whether it weighs evidence, which the observations must then carry.
    pub fn weighs_evidence(&self) -> bool {
        self.kind.formula().0 == Area::Evidence
    }

    /// Whether the numbers make sense: weights of a sum are in [0, 1] and sum to 1, exponents of a product in (0, 1] (METHOD A7).
    ///
    /// # Errors
    /// With the number and what was expected.
    pub fn check(&self) -> Result<()> {
        let Self { kind, beta, w1, w2, .. } = *self;
        ensure!((0.0..=1.0).contains(&beta), "the objective's beta is {beta}, expected 0 to 1");
        let is_sum = kind.formula().1 == Terms::Sum;
        for (name, weight) in [("w1", w1), ("w2", w2)] {
            let (fits, expected) = if is_sum {
                ((0.0..=1.0).contains(&weight), "a weight from 0 to 1")
            } else {
                (weight > 0.0 && weight <= 1.0, "an exponent over 0 and up to 1")
            };
            ensure!(fits, "{name} of the objective {kind} is {weight}, expected {expected}");
        }
        ensure!(
            !is_sum || (w1 + w2 - 1.0).abs() < 1e-4,
            "w1 and w2 of the objective {kind} are {w1} and {w2}, expected a sum of 1"
        );
        Ok(())
    }

    /// Whether what is observed serves it: edges are weighed by segments where there are some.
    ///
    /// # Errors
    /// When there are none to weigh them by.
    pub fn check_segments(&self, has_segments: bool) -> Result<()> {
        ensure!(
            self.edges == EdgeTerm::Whole || has_segments,
            "the objective's edges are to be weighed by {}, and no [[features.segment]] tells body parts apart, expected {}",
            EdgeTerm::Segments,
            EdgeTerm::Whole
        );
        Ok(())
    }

    /// The fitness of one candidate from its components, one a view. Nothing drawn or nothing observed scores 0; 0/0 is 0. So does
    /// any candidate by an objective that weighs evidence, of which there is none here.
    pub fn fitness(&self, views: &[Components]) -> f32 {
        if self.weighs_evidence() {
            return 0.0;
        }
        self.combined(views, |_, sums| sums.is_something().then(|| [sums.silhouette(self.beta), sums.edge()]))
    }

    /// The segmented form: the silhouette term, and the edge term where [`Self::edges`] says so, is the weighted mean of the segments'
    /// own, `segment_sums[view * segments + segment]`.
    pub fn segmented_fitness(&self, views: &[Components], segments: &Segments, segment_sums: &[SegmentSums]) -> f32 {
        if self.weighs_evidence() {
            return 0.0;
        }
        let segments = segments.as_slice();
        self.combined(views, |views, sums| {
            let rows = &segment_sums[views.start * segments.len()..views.end * segments.len()];
            let weighed = |term: &dyn Fn(&Sums) -> f32| -> f32 {
                let own = |(at, segment): (usize, &Segment)| {
                    let of_segment = rows.iter().skip(at).step_by(segments.len());
                    segment.weight * term(&of_segment.fold(Sums::default(), Sums::plus_segment))
                };
                segments.iter().enumerate().map(own).sum()
            };
            let edge = || match self.edges {
                EdgeTerm::Whole => sums.edge(),
                EdgeTerm::Segments => weighed(&Sums::edge),
            };
            sums.is_something().then(|| [weighed(&|sums| sums.silhouette(self.beta)), edge()])
        })
    }

    /// With the evidence of every view in place of the silhouette term. Nothing drawn, or no evidence for anybody, scores 0.
    pub fn evidence_fitness(&self, views: &[Components], evidence: &[EvidenceSum]) -> f32 {
        self.weighed(views, |views| evidence[views].iter().copied())
    }

    /// The fitness of every candidate from `components[candidate * views + view]` and what the first term is made of besides.
    pub(crate) fn score(&self, views: usize, components: &[Components], area: AreaSums<'_>, fitness: &mut [f32]) {
        let rows = fitness.iter_mut().zip(components.chunks_exact(views));
        match area {
            AreaSums::Whole => rows.for_each(|(value, row)| *value = self.fitness(row)),
            AreaSums::Segments(segments, sums) => {
                let sums = sums.chunks_exact(views * segments.as_slice().len());
                rows.zip(sums).for_each(|((value, row), sums)| *value = self.segmented_fitness(row, segments, sums));
            }
            AreaSums::Evidence(best, sums) => rows.zip(sums.chunks_exact(views)).for_each(|((value, row), sums)| {
                let of_views = |views: Range<usize>| {
                    let pairs = sums[views.clone()].iter().zip(&best[views]);
                    pairs.map(|(&sum, &best)| EvidenceSum { sum, best })
                };
                *value = self.weighed(row, of_views);
            }),
        }
    }

    /// f1 and f2 (METHOD A7) of one camera by itself; by evidence f1 is its share of the best, and 0 where there is none.
    pub fn view_terms(&self, view: &ViewCounts) -> [f32; 2] {
        let sums = Sums::default().plus(&view.components);
        let area = if self.weighs_evidence() {
            share_of_best(view.evidence).unwrap_or(0.0)
        } else {
            sums.silhouette(self.beta)
        };
        [area, sums.edge()]
    }

    /// [`Self::evidence_fitness`] with the evidence of a range of views.
    fn weighed<E: Iterator<Item = EvidenceSum>>(
        &self,
        views: &[Components],
        evidence: impl Fn(Range<usize>) -> E,
    ) -> f32 {
        self.combined(views, |views, sums| {
            let share = share_of_best(evidence(views)).filter(|_| sums.area_model > 0);
            share.map(|share| [share.max(LEAST_EVIDENCE), sums.edge()])
        })
    }

    /// The terms of all views together or of each by itself, put together; `both` is f1 and f2 of some of the views and their sums,
    /// and none where they score 0.
    fn combined(&self, views: &[Components], both: impl Fn(Range<usize>, &Sums) -> Option<[f32; 2]>) -> f32 {
        let (_, terms, over) = self.kind.formula();
        let score = |range: Range<usize>| {
            let sums = views[range.clone()].iter().fold(Sums::default(), Sums::plus);
            let Some([f1, f2]) = both(range, &sums) else { return 0.0 };
            match terms {
                Terms::Sum => self.w1 * f1 + self.w2 * f2,
                Terms::Product => power(f1, self.w1) * power(f2, self.w2),
            }
        };
        let each = (0..views.len()).map(|view| score(view..view + 1));
        match over {
            Views::Together => score(0..views.len()),
            Views::Mean => each.sum::<f32>() / views.len().max(1) as f32,
            Views::Product if views.is_empty() => 0.0,
            Views::Product => each.product(),
        }
    }
}

/// The evidence of some views in shares of the best, 0 where more speaks against; none where nothing speaks for anybody.
fn share_of_best(views: impl IntoIterator<Item = EvidenceSum>) -> Option<f32> {
    let (sum, best) = views
        .into_iter()
        .fold((0_i64, 0), |(sum, best), view| (sum + i64::from(view.sum), best + u64::from(view.best)));
    (best > 0).then(|| ratio(sum.max(0).unsigned_abs(), best))
}

/// x^w for x in [0, 1] and w > 0, the same bits on every device. Exponents in eighths are products of square roots, correctly rounded.
fn power(x: f32, w: f32) -> f32 {
    let eighths = 8.0 * w;
    if eighths.fract() != 0.0 || !(1.0..=8.0).contains(&eighths) {
        return if x > 0.0 { real_power(x, w) } else { 0.0 };
    }
    let (eighths, half) = (eighths as u32, x.sqrt());
    let quarter = half.sqrt();
    let mut product = 1.0;
    for (bit, root) in [(8, x), (4, half), (2, quarter), (1, quarter.sqrt())] {
        if eighths & bit != 0 {
            product *= root;
        }
    }
    product
}

/// Components summed over one or more cameras, as wide as the sum of many views needs.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    area_obs: u64,
    area_model: u64,
    overlap: u64,
    edges: u64,
    proximity: u64,
}

impl Sums {
    fn plus(self, view: &Components) -> Self {
        Self {
            area_obs: self.area_obs + u64::from(view.area_obs),
            area_model: self.area_model + u64::from(view.area_model),
            overlap: self.overlap + u64::from(view.overlap),
            edges: self.edges + u64::from(view.edges),
            proximity: self.proximity + u64::from(view.proximity),
        }
    }

    fn plus_segment(self, segment: &SegmentSums) -> Self {
        Self {
            area_obs: self.area_obs + u64::from(segment.area_obs),
            area_model: self.area_model + u64::from(segment.area_model),
            overlap: self.overlap + u64::from(segment.overlap),
            edges: self.edges + u64::from(segment.edges),
            proximity: self.proximity + u64::from(segment.proximity),
        }
    }

    /// Whether something was drawn and something observed.
    fn is_something(&self) -> bool {
        self.area_obs > 0 && self.area_model > 0
    }

    /// f1 (METHOD A7).
    fn silhouette(&self, beta: f32) -> f32 {
        beta * ratio(self.overlap, self.area_obs) + (1.0 - beta) * ratio(self.overlap, self.area_model)
    }

    /// f2 (METHOD A7).
    fn edge(&self) -> f32 {
        ratio(self.proximity, 127 * self.edges)
    }
}

/// A ratio of counts; 0/0 is 0.
fn ratio(numerator: u64, denominator: u64) -> f32 {
    if denominator == 0 { 0.0 } else { numerator as f32 / denominator as f32 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn views() -> [Components; 2] {
        [
            Components { area_obs: 100, area_model: 80, overlap: 60, edges: 10, proximity: 635 },
            Components { area_obs: 200, area_model: 100, overlap: 50, edges: 30, proximity: 381 },
        ]
    }

    const W1: f64 = 0.6;
    const W2: f64 = 0.4;

    /// The five formulas from the terms of two cameras and of both together.
    fn five(f1: [f64; 2], f2: [f64; 2], f1_all: f64, f2_all: f64) -> [f64; 5] {
        let sum = |f1: f64, f2: f64| W1 * f1 + W2 * f2;
        let product = |f1: f64, f2: f64| f1.powf(W1) * f2.powf(W2);
        let products = [product(f1[0], f2[0]), product(f1[1], f2[1])];
        [
            sum(f1_all, f2_all),
            product(f1_all, f2_all),
            (sum(f1[0], f2[0]) + sum(f1[1], f2[1])) / 2.0,
            (products[0] + products[1]) / 2.0,
            products[0] * products[1],
        ]
    }

    /// METHOD A7 written out by hand for the two views above.
    #[test]
    fn the_five_formulas() {
        let beta = 0.3_f64;
        let f1 = [beta * 0.6 + 0.7 * 0.75, beta * 0.25 + 0.7 * 0.5];
        let f2 = [0.5, 0.1];
        let f1_all = beta * 110.0 / 300.0 + 0.7 * 110.0 / 180.0;
        let f2_all = 1016.0 / (127.0 * 40.0);
        for (kind, expected) in ObjectiveKind::ALL.into_iter().zip(five(f1, f2, f1_all, f2_all)) {
            let objective = Objective { beta: 0.3, w1: W1 as f32, w2: W2 as f32, ..Objective::of(kind) };
            let seen = ViewCounts { components: views()[1], evidence: None };
            let [term1, term2] = objective.view_terms(&seen).map(f64::from);
            assert!((term1 - f1[1]).abs() < 1e-6 && (term2 - f2[1]).abs() < 1e-6, "{term1} {term2}");
            let found = f64::from(objective.fitness(&views()));
            assert!((found - expected).abs() < 1e-6, "{}: {found} is not {expected}", kind.name());
        }
    }

    /// Two segments, 3/4 and 1/4 of the terms: sums of each in each of the two views.
    fn in_segments() -> (Segments, [SegmentSums; 4]) {
        let segment = |name: &str, label, weight| Segment { name: name.into(), labels: vec![label], weight };
        let segments = Segments::new(vec![segment("a", 1, 0.75), segment("b", 2, 0.25)]).unwrap();
        let sums = [[40, 50, 30, 4, 127], [60, 20, 10, 5, 381], [150, 60, 30, 20, 254], [0, 40, 0, 0, 0]];
        let sums = sums.map(|[area_obs, area_model, overlap, edges, proximity]| SegmentSums {
            area_obs,
            area_model,
            overlap,
            edges,
            proximity,
        });
        (segments, sums)
    }

    /// The same with the silhouette term of the segments, and with that and their edge term; one of them shows no edge in a view.
    #[test]
    fn the_five_segmented_formulas() {
        let (segments, sums) = in_segments();
        let beta = 0.3_f64;
        let f = |overlap: f64, obs: f64, model: f64| {
            if overlap == 0.0 { 0.0 } else { beta * overlap / obs + 0.7 * overlap / model }
        };
        let f1 = [0.75 * f(30.0, 40.0, 50.0) + 0.25 * f(10.0, 60.0, 20.0), 0.75 * f(30.0, 150.0, 60.0)];
        let f1_all = 0.75 * f(60.0, 190.0, 110.0) + 0.25 * f(10.0, 60.0, 60.0);
        let whole = ([0.5, 0.1], 1016.0 / (127.0 * 40.0));
        // 127 of each of 4, 3 x 127 of 5, 2 x 127 of 20.
        let in_parts = ([0.75 / 4.0 + 0.25 * 3.0 / 5.0, 0.75 * 2.0 / 20.0], 0.75 * 3.0 / 24.0 + 0.25 * 3.0 / 5.0);
        for (edges, (f2, f2_all)) in [(EdgeTerm::Whole, whole), (EdgeTerm::Segments, in_parts)] {
            for (kind, expected) in ObjectiveKind::ALL.into_iter().zip(five(f1, f2, f1_all, f2_all)) {
                let weights = Objective { beta: 0.3, w1: W1 as f32, w2: W2 as f32, ..Objective::of(kind) };
                let objective = Objective { edges, ..weights };
                let found = f64::from(objective.segmented_fitness(&views(), &segments, &sums));
                assert!((found - expected).abs() < 1e-6, "{}, {edges}: {found} is not {expected}", kind.name());
            }
        }
    }

    #[test]
    fn edges_by_segments_need_segments() {
        let objective = Objective { edges: EdgeTerm::Segments, ..Objective::default() };
        let error = objective.check_segments(false).unwrap_err().to_string();
        assert!(
            ["by segments", "[[features.segment]]", "expected whole"].iter().all(|part| error.contains(part)),
            "{error}"
        );
        assert!(objective.check_segments(true).is_ok() && Objective::default().check_segments(false).is_ok());
    }

    /// METHOD A7 written out by hand: the two views above with evidence, of which one speaks against the candidate.
    #[test]
    fn the_formula_of_evidence() {
        let objective = Objective::of(ObjectiveKind::Evidence);
        assert_eq!((objective.w1, objective.w2), (0.75, 0.25));
        let evidence = [EvidenceSum { sum: 900, best: 1000 }, EvidenceSum { sum: -150, best: 500 }];
        let (share, edge) = (750.0_f64 / 1500.0, 1016.0_f64 / (127.0 * 40.0));
        let found = f64::from(objective.evidence_fitness(&views(), &evidence));
        assert!((found - share.powf(0.75) * edge.powf(0.25)).abs() < 1e-6, "{found}");
        let seen = |view: usize| ViewCounts { components: views()[view], evidence: Some(evidence[view]) };
        assert_eq!([0, 1].map(|view| objective.view_terms(&seen(view))), [[0.9, 0.5], [0.0, 0.1]]);
        // By itself the second view speaks for nobody, and its edges still count.
        let against = f64::from(objective.evidence_fitness(&views()[1..], &evidence[1..]));
        assert!((against - 1e-6_f64.powf(0.75) * 0.1_f64.powf(0.25)).abs() < 1e-9, "{against}");
        // Nothing drawn; nothing to be drawn.
        let nothing = Components { area_model: 0, ..views()[0] };
        assert_eq!(objective.evidence_fitness(&[nothing], &evidence[..1]), 0.0);
        assert_eq!(objective.evidence_fitness(&views()[..1], &[EvidenceSum { sum: 0, best: 0 }]), 0.0);
        // Batches are rows of views.
        let mut fitness = [-1.0; 2];
        let components = [views(), views()].concat();
        objective.score(2, &components, AreaSums::Evidence(&[1000, 500], &[900, -150, 400, 500]), &mut fitness);
        let other = [EvidenceSum { sum: 400, best: 1000 }, EvidenceSum { sum: 500, best: 500 }];
        assert_eq!(fitness, [evidence, other].map(|evidence| objective.evidence_fitness(&views(), &evidence)));
    }

    #[test]
    fn powers_in_eighths_are_roots() {
        for x in [0.0_f32, 1e-6, 0.1, 0.37, 0.9999, 1.0] {
            assert_eq!(power(x, 0.5), x.sqrt());
            assert_eq!(power(x, 1.0), x);
            assert_eq!(power(x, 0.75), x.sqrt() * x.sqrt().sqrt());
            for eighths in 1..=16 {
                let w = eighths as f32 / 16.0;
                let exact = f64::from(x).powf(f64::from(w));
                assert!((f64::from(power(x, w)) - exact).abs() < 1e-6, "{x}^{w}");
            }
        }
    }

    #[test]
    fn nothing_scores_zero_and_never_nan() {
        for kind in ObjectiveKind::ALL {
            let objective = Objective::of(kind);
            for nothing in [
                vec![],
                vec![Components::default(); 3],
                vec![Components { area_obs: 50, ..Components::default() }],
                vec![Components { area_model: 50, edges: 5, ..Components::default() }],
            ] {
                assert_eq!(objective.fitness(&nothing), 0.0, "{} of {nothing:?}", kind.name());
            }
        }
    }

    #[test]
    fn a_perfect_candidate_scores_one() {
        let perfect = Components { area_obs: 70, area_model: 70, overlap: 70, edges: 9, proximity: 9 * 127 };
        for kind in ObjectiveKind::ALL {
            let objective = Objective::of(kind);
            let fitness = if objective.weighs_evidence() {
                objective.evidence_fitness(&[perfect; 4], &[EvidenceSum { sum: 350, best: 350 }; 4])
            } else {
                objective.fitness(&[perfect; 4])
            };
            assert!((fitness - 1.0).abs() < 1e-6, "{}: {fitness}", kind.name());
        }
    }
}
