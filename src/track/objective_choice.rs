//! Which objective function: its kind's defaults, a sequence's `[objective]` table over them, the command line over both.

use anyhow::Result;
use serde::Deserialize;

use crate::evaluate::{Objective, ObjectiveKind};
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
    /// over the defaults of the kind that both come to, or of `usual` where neither names one.
    ///
    /// # Errors
    /// An unknown key or kind, a value of the wrong type or one that makes no sense (METHOD A7: weights of a sum are in
    /// [0, 1] and sum to 1, exponents of a product in (0, 1]).
    pub fn resolve_over(&self, usual: ObjectiveKind, table: Option<&toml::Table>, name: &str) -> Result<Objective> {
        let written = match table {
            Some(table) => parse_table(table, &format!("{name}, table [objective]"))?,
            None => Self::default(),
        };
        let usual = Objective::of(self.kind.or(written.kind).unwrap_or(usual));
        let objective = Objective {
            beta: self.beta.or(written.beta).unwrap_or(usual.beta),
            w1: self.w1.or(written.w1).unwrap_or(usual.w1),
            w2: self.w2.or(written.w2).unwrap_or(usual.w2),
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
        assert_eq!(objective, Objective { kind: ObjectiveKind::Aows, beta: 0.25, w1: 0.4, w2: 0.6 });
        assert_eq!(ObjectiveChoice::default().resolve(None, "s").unwrap(), Objective::default());
        // Weights that nobody writes are the kind's, wherever that comes from.
        let evidence = Objective::of(ObjectiveKind::Evidence);
        assert_eq!(resolve("kind = 'evidence'", "kind = 'sp'").unwrap(), evidence);
        assert_eq!(resolve("w2 = 0.5", "kind = 'evidence'").unwrap(), Objective { w2: 0.5, ..evidence });
        assert_eq!(resolve("kind = 'sp'", "kind = 'evidence'").unwrap(), Objective::default());
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
        ] {
            let error = format!("{:#}", resolve(flags, table).unwrap_err());
            for sentence in sentences {
                assert!(error.contains(sentence), "`{error}` lacks `{sentence}`");
            }
        }
    }
}
