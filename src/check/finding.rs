//! What a check says.

use serde::Serialize;

/// How a check came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Within its limit.
    Ok,
    /// Beyond its limit, where something harmless, or silhouettes that lose parts of the person, would do as much: look at it, nothing is held against the
    /// sequence.
    Doubtful,
    /// Beyond its limit.
    Failed,
    /// There was nothing to measure it on.
    NotMeasured,
}

/// One check: its number, its limit, and what to do where it failed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Which check.
    pub check: &'static str,
    /// The camera it is about; None for the whole sequence.
    pub camera: Option<String>,
    /// How it came out.
    pub status: Status,
    /// The number it is based on; None where there is none.
    pub value: Option<f64>,
    /// One standard deviation of the number, where it was judged against the scatter of the silhouettes.
    pub scatter: Option<f64>,
    /// The number's unit.
    pub unit: &'static str,
    /// What the number may be.
    pub limit: String,
    /// What was found, in words.
    pub found: String,
    /// What to do; empty where the check came out well.
    pub advice: String,
}

impl Finding {
    /// A number that may lie from `low` to `high`.
    pub(super) fn number(check: &'static str, unit: &'static str, value: f64, [low, high]: [f64; 2]) -> Self {
        let limit = match (low.is_finite(), high.is_finite()) {
            (true, true) => format!("{low} to {high}"),
            (true, false) => format!("at least {low}"),
            _ => format!("at most {high}"),
        };
        // What is not a number lies nowhere.
        let status = if (low..=high).contains(&value) { Status::Ok } else { Status::Failed };
        let value = value.is_finite().then_some(value);
        Self {
            check,
            camera: None,
            status,
            value,
            scatter: None,
            unit,
            limit,
            found: String::new(),
            advice: String::new(),
        }
    }

    /// A check that could not be made.
    pub(super) fn not_measured(check: &'static str, why: &str) -> Self {
        Self { status: Status::NotMeasured, found: why.to_string(), ..Self::number(check, "", 0.0, [0.0, 0.0]) }
    }

    /// Of one camera.
    pub(super) fn of(mut self, camera: &str) -> Self {
        self.camera = Some(camera.to_string());
        self
    }

    /// With what was found in words.
    pub(super) fn found(mut self, found: impl Into<String>) -> Self {
        self.found = found.into();
        self
    }

    /// Give or take one standard deviation.
    pub(super) fn give_or_take(mut self, scatter: f64) -> Self {
        self.scatter = scatter.is_finite().then_some(scatter);
        self
    }

    /// A number that is beyond its limit but still from `low` to `high` is doubtful.
    pub(super) fn doubtful_within(mut self, [low, high]: [f64; 2]) -> Self {
        if self.status == Status::Failed && self.value.is_some_and(|value| (low..=high).contains(&value)) {
            self.status = Status::Doubtful;
        }
        self
    }

    /// With what to do should it not have come out well.
    pub(super) fn or(mut self, advice: impl Into<String>) -> Self {
        if matches!(self.status, Status::Doubtful | Status::Failed) {
            self.advice = advice.into();
        }
        self
    }
}
