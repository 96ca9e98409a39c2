//! The kinds of searches, and their settings, checked before anything is made from them.

mod annealed;
mod cma_es;
mod evolution;
mod form;
mod hierarchical;
mod ma_es;
mod particle_filter;
mod pso;

use anyhow::{Context as _, Result, ensure};
use toml::Table;

pub use annealed::{AnnealedFilter, AnnealingSettings};
pub use cma_es::CmaSettings;
pub(super) use evolution::generations;
pub(super) use form::Answer;
use form::{Budget, SearchForm};
pub use hierarchical::{HierarchicalPso, HierarchySettings};
pub(super) use hierarchical::{SwarmHierarchy, SwarmLevel};
pub use ma_es::MatrixSettings;
pub(super) use ma_es::Rates;
pub use particle_filter::{FilterSettings, ParticleFilter};
pub use pso::{Pso, PsoSettings};

use super::device::FrameRecording;
use super::refinement::{Refined, Refinement};
use super::{Search, SearchSpace};
use crate::files::choices;
use crate::gpu::Device;

/// Most particles of a search. More is a slip of the keyboard, not a plan.
const MOST_PARTICLES: usize = 1 << 20;
const MOST_ITERATIONS: usize = 1 << 16;
/// What makes the random numbers of one search after the other different: the golden ratio's 64 bits.
const SEED_STEP: u64 = 0x9E37_79B9_7F4A_7C15;
/// Most numbers one buffer of a search may hold (1 GiB of them).
const LARGEST_BUFFER: usize = 1 << 28;

choices! {
    /// Which search.
    #[derive(Default)]
    "search" pub enum SearchKind => form: fn(&SearchSettings) -> Box<dyn SearchForm> {
        /// Particle swarm, global best.
        "pso" Pso => |settings| Box::new(settings.pso),
        /// Bootstrap particle filter: N K samples once, which it carries on; a resumed run begins again.
        "pf" ParticleFilter => |settings| Box::new(settings.filter),
        /// Annealed particle filter: K layers of N samples.
        "apf" Annealed => |settings| Box::new(settings.annealing),
        /// Hierarchical particle swarm: swarms over the torso, limb after limb, everything.
        "hpso" Hierarchical => |settings| {
            Box::new(SwarmHierarchy { swarm: settings.pso, hierarchy: settings.hierarchy })
        },
        /// CMA-ES: evolution of a normal distribution, generations of 50 or more samples.
        "cmaes" CmaEs => |settings| Box::new(settings.cma),
        /// MA-ES: the same by the matrix that makes the samples, products alone in single precision (the default).
        "maes" #[default] MaEs => |settings| Box::new(settings.matrix),
    }
}

impl SearchKind {
    /// Its form, whose constants do not matter.
    fn form_by_default(self) -> Box<dyn SearchForm> {
        self.form()(&SearchSettings::default())
    }

    /// Whether a frame depends on the frames before by more than its centre.
    pub fn carries_on(self) -> bool {
        self.form_by_default().carries_on()
    }

    /// Whether its estimate is a mean, which is scored as one pose more.
    pub fn estimates_a_mean(self) -> bool {
        self.answer() != Answer::Best
    }

    /// What its estimate is.
    pub(super) fn answer(self) -> Answer {
        self.form_by_default().answer()
    }

    /// Whether it has a form that runs whole on a device; the others are driven from the host.
    pub fn has_device_form(self) -> bool {
        self.form_by_default().on_device().is_some()
    }

    /// Whether it has one, and the device has workgroups large enough for it.
    pub fn fits(self, device: &Device) -> bool {
        let most = device.capabilities().max_workgroup;
        self.form_by_default().on_device().is_some_and(|form| form.largest_workgroup() <= most)
    }
}

/// Everything a search is made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchSettings {
    /// Which search.
    pub kind: SearchKind,
    /// Poses scored at once.
    pub particles: usize,
    /// Batches of `particles` poses scored a frame, by every kind alike. A particle filter is not iterative: it holds
    /// particles times iterations samples. What is a mean (pf, apf, cmaes, maes) is scored as one pose more.
    pub iterations: usize,
    /// Seed of all random numbers.
    pub seed: u64,
    /// What only the swarm uses.
    pub pso: PsoSettings,
    /// What only the particle filter uses.
    pub filter: FilterSettings,
    /// What only the annealed particle filter uses.
    pub annealing: AnnealingSettings,
    /// What only the hierarchical swarm uses, beside what the swarm does.
    pub hierarchy: HierarchySettings,
    /// What only CMA-ES uses.
    pub cma: CmaSettings,
    /// What only MA-ES uses.
    pub matrix: MatrixSettings,
    /// Poses scored to refine the winner, beyond those of the iterations.
    pub refine: usize,
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
            annealing: AnnealingSettings::default(),
            hierarchy: HierarchySettings::default(),
            cma: CmaSettings::default(),
            matrix: MatrixSettings::default(),
            refine: 0,
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
        ensure!(self.refine <= MOST_PARTICLES, "refine is {}, expected 0 to {MOST_PARTICLES}", self.refine);
        SearchKind::ALL.iter().try_for_each(|kind| kind.form()(self).check())
    }

    /// Whether the search's buffers are of a sensible size.
    ///
    /// # Errors
    /// When they are not: the sentence names the numbers.
    pub fn check_room(&self, space: &SearchSpace) -> Result<()> {
        let samples = self.particles * if self.kind.carries_on() { self.iterations } else { 1 };
        ensure!(
            samples.saturating_mul(space.dof_count()) <= LARGEST_BUFFER,
            "{samples} particles of {} values do not fit, expected at most {} particles",
            space.dof_count(),
            LARGEST_BUFFER / space.dof_count()
        );
        Ok(())
    }

    /// What only the kind of search uses, as the record of a run has it.
    ///
    /// # Errors
    /// When it cannot be a table.
    pub fn constants(&self) -> Result<Table> {
        self.kind.form()(self).constants()
    }

    /// Records a frame's iterations for a device.
    ///
    /// # Errors
    /// When the search has no form for devices, and as [`DeviceForm::record`](super::device::DeviceForm::record).
    pub(super) fn record(&self, frame: &mut FrameRecording, space: &SearchSpace) -> Result<()> {
        let form = self.kind.form()(self);
        let form =
            form.on_device().with_context(|| format!("the search {} has no form for devices", self.kind.name()))?;
        form.record(frame, space, self.iterations)
    }

    /// With random numbers of their own for a further search of the same frames: `turn` tells such searches apart, and 0 is the run's own.
    #[must_use]
    pub(crate) fn reseeded(self, turn: u64) -> Self {
        Self { seed: self.seed.wrapping_add(turn.wrapping_mul(SEED_STEP)), ..self }
    }

    /// Makes the search.
    ///
    /// # Errors
    /// As [`Self::check`], or when the settings ask for more memory than sense.
    pub fn build(&self, space: &SearchSpace) -> Result<Box<dyn Search>> {
        self.check()?;
        self.check_room(space)?;
        let Self { kind, particles, iterations, seed, .. } = *self;
        let search = kind.form()(self).build(&Budget { name: kind.name(), particles, iterations, seed }, space);
        if self.refine == 0 {
            return Ok(search);
        }
        Ok(Box::new(Refined::new(search, Refinement::new(self.refine, space))))
    }
}
