//! What the settings know of a kind of search.

use anyhow::Result;
use serde::Serialize;
use toml::Table;

use crate::files::table_of;
use crate::search::device::DeviceForm;
use crate::search::{Search, SearchSpace};

/// What a search of any kind is given.
#[derive(Clone, Copy)]
pub(super) struct Budget {
    /// The kind's name.
    pub(super) name: &'static str,
    /// Poses scored at once.
    pub(super) particles: usize,
    pub(super) iterations: usize,
    pub(super) seed: u64,
}

/// What the estimate of a search is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// The best pose it scored.
    Best,
    /// A mean, which is scored as one pose more.
    Mean,
    /// The better of the two.
    Better,
}

/// Constants of a kind of search.
pub(super) trait Constants {
    /// As the record of a run has them.
    fn constants(&self) -> Result<Table>;
}

impl<T: Serialize> Constants for T {
    fn constants(&self) -> Result<Table> {
        table_of(self)
    }
}

/// A kind of search by the constants that it alone uses.
pub(super) trait SearchForm: Constants {
    /// Makes it from checked constants.
    fn build(&self, budget: &Budget, space: &SearchSpace) -> Box<dyn Search>;

    /// Holds the constants to their ranges.
    fn check(&self) -> Result<()>;

    /// It depends on the frames before by more than its centre: by all samples of the last one, which it holds.
    fn carries_on(&self) -> bool {
        false
    }

    /// What its estimate is.
    fn answer(&self) -> Answer {
        Answer::Best
    }

    /// Its form that runs whole on a device; one without is driven from the host.
    fn on_device(&self) -> Option<&dyn DeviceForm> {
        None
    }
}
