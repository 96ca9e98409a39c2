//! Which objective function: its kind's defaults, a sequence's `[objective]` table over them, the command line over both.

use anyhow::{Result, ensure};
use serde::Deserialize;

use crate::evaluate::{EdgeTerm, Objective, ObjectiveKind};
use crate::files::parse_table;

/// What is asked of the objective; `None` leaves a value as it is.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectiveChoice {
    /// How terms combine.
    pub kind: Option<ObjectiveKind>,
    /// Share of "observed silhouette covered", in [0, 1].
    pub beta: Option<f32>,
    /// Weight or exponent of the silhouette term.
    pub w1: Option<f32>,
    /// Weight or exponent of the edge term.
    pub w2: Option<f32>,
    /// What the edge term is made of where there are segments.
    pub edges: Option<EdgeTerm>,
}

impl ObjectiveChoice {
    /// As [`Self::resolve_over`] the default objective.
    ///
    /// # Errors
    /// As there.
    pub fn resolve(&self, table: Option<&toml::Table>, name: &str) -> Result<Objective> {
        self.resolve_over(ObjectiveKind::default(), table, name)
    }

    /// The objective: this choice over the `[objective]` table of a sequence (`name` stands for its file in messages)
    /// over the defaults of the kind that both come to, or of `usual` where neither names one. Beside evidence, where segments do not count,
    /// edges are whole whatever the table says.
    ///
    /// # Errors
    /// An unknown key or kind, a value of the wrong type or one that makes no sense (METHOD A7: weights of a sum are in
    /// [0, 1] and sum to 1, exponents of a product in (0, 1]); edges by segments in this choice itself, and evidence.
    pub fn resolve_over(&self, usual: ObjectiveKind, table: Option<&toml::Table>, name: &str) -> Result<Objective> {
        let written = match table {
            Some(table) => parse_table(table, &format!("{name}, table [objective]"))?,
            None => Self::default(),
        };
        let usual = Objective::of(self.kind.or(written.kind).unwrap_or(usual));
        ensure!(
            !usual.weighs_evidence() || self.edges != Some(EdgeTerm::Segments),
            "edges are to be weighed by {}, which do not count in the objective {}, expected another objective or edges that are {}",
            EdgeTerm::Segments,
            usual.kind,
            EdgeTerm::Whole
        );
        let objective = Objective {
            beta: self.beta.or(written.beta).unwrap_or(usual.beta),
            w1: self.w1.or(written.w1).unwrap_or(usual.w1),
            w2: self.w2.or(written.w2).unwrap_or(usual.w2),
            edges: self.edges.or(written.edges).filter(|_| !usual.weighs_evidence()).unwrap_or(usual.edges),
            ..usual
        };
        objective.check()?;
        Ok(objective)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolve(flags: &str, table: &str) -> Result<Objective> {
        let flags: ObjectiveChoice = toml::from_str(flags)?;
        flags.resolve(Some(&table.parse().unwrap()), "sequence.toml")
    }

    #[test]
    fn flags_win_over_the_table_over_the_defaults() {
        let objective = resolve("kind = 'aows'\nw1 = 0.4", "kind = 'ws'\nbeta = 0.25\nw1 = 0.6\nw2 = 0.6").unwrap();
        let aows = Objective::of(ObjectiveKind::Aows);
        assert_eq!(objective, Objective { beta: 0.25, w1: 0.4, w2: 0.6, ..aows });
        assert_eq!(ObjectiveChoice::default().resolve(None, "s").unwrap(), Objective::default());
        // Weights that nobody writes are the kind's, wherever that comes from.
        let evidence = Objective::of(ObjectiveKind::Evidence);
        assert_eq!(resolve("kind = 'evidence'", "kind = 'sp'").unwrap(), evidence);
        assert_eq!(resolve("w2 = 0.5", "kind = 'evidence'").unwrap(), Objective { w2: 0.5, ..evidence });
        assert_eq!(resolve("kind = 'sp'", "kind = 'evidence'").unwrap(), Objective::default());
    }

    #[test]
    fn edges_are_whole_unless_asked_for_by_segments() {
        let by_segments = Objective { edges: EdgeTerm::Segments, ..Objective::default() };
        assert_eq!(Objective::default().edges, EdgeTerm::Whole);
        assert_eq!(resolve("", "edges = 'segments'").unwrap(), by_segments);
        assert_eq!(resolve("edges = 'segments'", "edges = 'whole'").unwrap(), by_segments);
        assert_eq!(resolve("edges = 'whole'", "edges = 'segments'").unwrap(), Objective::default());
        // A sequence that is fitted, or tracked by evidence once, needs no other file.
        let evidence = Objective::of(ObjectiveKind::Evidence);
        assert_eq!(resolve("kind = 'evidence'", "edges = 'segments'").unwrap(), evidence);
        assert_eq!(resolve("edges = 'whole'", "kind = 'evidence'").unwrap(), evidence);
    }

    #[test]
    fn what_makes_no_sense_is_named() {
        for (flags, table, sentences) in [
            ("kind = 'best'", "", &["unknown objective `best`", "ws, sp, aows, aosp, posp, evidence"][..]),
            ("", "kind = 'best'", &["sequence.toml, table [objective]", "`best`"]),
            ("", "bata = 1.0", &["`bata`", "`beta`"]),
            ("", "beta = 'half'", &["sequence.toml", "string"]),
            ("beta = 1.5", "", &["beta is 1.5", "0 to 1"]),
            ("beta = nan", "", &["beta is NaN"]),
            ("w1 = 0.0", "", &["w1 of the objective sp is 0", "over 0"]),
            ("kind = 'ws'\nw1 = 0.9", "", &["0.9 and 0.5", "sum of 1"]),
            ("w2 = inf", "", &["w2 of the objective sp is inf"]),
            (
                "edges = 'segments'",
                "kind = 'evidence'",
                &["do not count in the objective evidence", "another objective"],
            ),
            ("", "edges = 'segment'", &["table [objective]", "unknown edge term `segment`, the nearest is `segments`"]),
        ] {
            let error = format!("{:#}", resolve(flags, table).unwrap_err());
            for sentence in sentences {
                assert!(error.contains(sentence), "`{error}` lacks `{sentence}`");
            }
        }
    }
}
