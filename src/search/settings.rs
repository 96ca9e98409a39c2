//! Settings of a search, checked before anything is made from them.

use anyhow::{Result, ensure};
use serde::Serialize;

use super::{FilterSettings, ParticleFilter, Pso, PsoSettings, Search, SearchSpace};

/// Most particles of a search. More is a slip of the keyboard, not a plan.
const MOST_PARTICLES: usize = 1 << 20;
const MOST_ITERATIONS: usize = 1 << 16;
/// Most numbers one buffer of a search may hold (1 GiB of them).
const LARGEST_BUFFER: usize = 1 << 28;

/// Which search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub enum SearchKind {
    /// Particle swarm.
    #[default]
    #[serde(rename = "pso")]
    Pso,
    /// Bootstrap particle filter.
    #[serde(rename = "pf")]
    ParticleFilter,
}

impl SearchKind {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Pso, Self::ParticleFilter];

    /// The name as `--search` takes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pso => "pso",
            Self::ParticleFilter => "pf",
        }
    }

    /// The kind of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

/// Everything a search is made from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SearchSettings {
    /// Which search.
    pub kind: SearchKind,
    /// Poses scored at once.
    pub particles: usize,
    /// Batches of `particles` poses scored a frame. A particle filter is not iterative: it holds particles times
    /// iterations samples, so that both kinds score as many poses.
    pub iterations: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// What only the swarm uses.
    pub pso: PsoSettings,
    /// What only the particle filter uses.
    pub filter: FilterSettings,
}

impl Default for SearchSettings {
    fn default() -> Self {
        Self {
            kind: SearchKind::default(),
            particles: 300,
            iterations: 15,
            seed: 1,
            pso: PsoSettings::default(),
            filter: FilterSettings::default(),
        }
    }
}

impl SearchSettings {
    /// Whether a search can be made from these settings.
    ///
    /// # Errors
    /// With the setting, what it is and what was expected.
    pub fn check(&self) -> Result<()> {
        for (name, value, most) in
            [("particles", self.particles, MOST_PARTICLES), ("iterations", self.iterations, MOST_ITERATIONS)]
        {
            ensure!((1..=most).contains(&value), "{name} is {value}, expected 1 to {most}");
        }
        self.pso.check()?;
        self.filter.check()
    }

    /// Whether the search's buffers are of a sensible size.
    ///
    /// # Errors
    /// When they are not: the sentence names the numbers.
    pub fn check_room(&self, space: &SearchSpace) -> Result<()> {
        let samples = match self.kind {
            SearchKind::Pso => self.particles,
            SearchKind::ParticleFilter => self.particles * self.iterations,
        };
        ensure!(
            samples.saturating_mul(space.dof_count()) <= LARGEST_BUFFER,
            "{samples} particles of {} values do not fit, expected at most {} particles",
            space.dof_count(),
            LARGEST_BUFFER / space.dof_count()
        );
        Ok(())
    }

    /// Makes the search.
    ///
    /// # Errors
    /// As [`Self::check`], or when the settings ask for more memory than sense.
    pub fn build(&self, space: &SearchSpace) -> Result<Box<dyn Search>> {
        self.check()?;
        self.check_room(space)?;
        Ok(match self.kind {
            SearchKind::Pso => Box::new(Pso::new(self, space)),
            SearchKind::ParticleFilter => Box::new(ParticleFilter::new(self, space)),
        })
    }
}
