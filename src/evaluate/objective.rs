//! The five objective functions (SPEC A7): from a candidate's components to one number in [0, 1], to be maximised.

use super::Components;

/// How the silhouette and the edge terms of the cameras are combined.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ObjectiveKind {
    /// Weighted sum of the terms over all cameras together.
    Ws,
    /// Product of powers of the terms over all cameras together; the default, best on average.
    #[default]
    Sp,
    /// Mean over cameras of the weighted sums.
    Aows,
    /// Mean over cameras of the products.
    Aosp,
    /// Product over cameras of the products.
    Posp,
}

impl ObjectiveKind {
    /// All five.
    pub const ALL: [Self; 5] = [Self::Ws, Self::Sp, Self::Aows, Self::Aosp, Self::Posp];

    /// The name as `--objective` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ws => "ws",
            Self::Sp => "sp",
            Self::Aows => "aows",
            Self::Aosp => "aosp",
            Self::Posp => "posp",
        }
    }
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
}

impl Default for Objective {
    fn default() -> Self {
        Self { kind: ObjectiveKind::default(), beta: 0.5, w1: 0.5, w2: 0.5 }
    }
}

impl Objective {
    /// The fitness of one candidate from its components, one a view. Nothing drawn or nothing observed scores 0; 0/0 is 0.
    pub fn fitness(&self, views: &[Components]) -> f32 {
        let _ = views;
        0.0
    }
}
