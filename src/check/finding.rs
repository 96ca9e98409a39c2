//! What a check says.

use serde::Serialize;

/// How a check came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Within its limit.
    Ok,
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
    /// The number's unit.
    pub unit: &'static str,
    /// What the number may be.
    pub limit: String,
    /// What was found, in words.
    pub found: String,
    /// What to do; empty where nothing is to be done.
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
        Self { check, camera: None, status, value, unit, limit, found: String::new(), advice: String::new() }
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

    /// With what to do should it have failed.
    pub(super) fn or(mut self, advice: impl Into<String>) -> Self {
        if self.status == Status::Failed {
            self.advice = advice.into();
        }
        self
    }
}
