//! One frame's search: driven by the host over any evaluator, or whole on the device that the evaluator works on.

use std::time::Instant;

use anyhow::{Context, Result, bail};

use super::stages::Span;
use crate::evaluate::{Components, Evaluator, Objective};
use crate::features::Observation;
use crate::gpu::{DevicePass, Timing};
use crate::search::{DeviceSearch, Estimate, Search, SearchKind, SearchSettings, SearchSpace};

/// The search of a run.
pub(super) enum Searcher {
    /// The host proposes poses and the evaluator scores a batch at a time.
    Host(Box<dyn Search>),
    /// A frame is one submission to a device.
    Device(Box<OnDevice>),
}

/// A search on the evaluator's device. It is recorded when the first observations are there, which say how much room pictures
/// need, and again when they have outgrown that.
pub(super) struct OnDevice {
    settings: SearchSettings,
    space: SearchSpace,
    objective: Objective,
    timing: Timing,
    recorded: Option<DeviceSearch>,
}

impl OnDevice {
    /// The search, recorded for the newest observations.
    fn search(&mut self, evaluator: &mut dyn Evaluator) -> Result<&mut DeviceSearch> {
        let name = evaluator.name();
        let Some(evaluator) = evaluator.on_device() else { bail!("the backend {name} has left its device") };
        // A filter's samples live in its recording: it stays with the old one, which is slower and no less right.
        let is_outgrown = self.settings.kind == SearchKind::Pso && evaluator.has_outgrown_its_recording();
        if let Some(recorded) = self.recorded.take_if(|_| !is_outgrown) {
            return Ok(self.recorded.insert(recorded));
        }
        let recorded = DeviceSearch::new(evaluator, &self.objective, &self.settings, &self.space, self.timing)
            .with_context(|| format!("the backend {name} cannot search; --backend cpu works without"))?;
        Ok(self.recorded.insert(recorded))
    }
}

/// Iterations of a frame that are done however late it is.
const FEWEST_ITERATIONS: usize = 2;

/// Where a frame's search starts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start<'a> {
    /// The frame, as the random numbers count it.
    pub(super) frame: u32,
    /// The pose before: mm, radians.
    pub(super) centre: &'a [f32],
    /// Standard deviation of the change since.
    pub(super) spread: &'a [f32],
    /// When to be done: an iteration that would take longer is left out. A search on a device is one piece and takes no
    /// notice.
    pub(super) until: Option<Instant>,
}

/// A frame's result.
pub(super) struct Searched {
    pub(super) estimate: Estimate,
    /// What the comparison of the estimate with the observations yields, one a view.
    pub(super) components: Vec<Components>,
    /// When the evaluator worked. On a device that is the whole submission, the search's own stages included.
    pub(super) evaluations: Vec<Span>,
    /// The passes that ran on the device, where they are measured.
    pub(super) passes: Vec<DevicePass>,
}

impl Searcher {
    /// The search of these settings, on the evaluator's device if it has one; there `timing` is what is measured of its passes.
    ///
    /// # Errors
    /// As [`SearchSettings::build`].
    pub(super) fn new(
        evaluator: &mut dyn Evaluator,
        objective: &Objective,
        settings: &SearchSettings,
        space: &SearchSpace,
        timing: Timing,
    ) -> Result<Self> {
        Ok(match evaluator.on_device() {
            None => Self::Host(settings.build(space)?),
            Some(_) => {
                settings.check_room(space)?;
                Self::Device(Box::new(OnDevice {
                    settings: *settings,
                    space: space.clone(),
                    objective: *objective,
                    timing,
                    recorded: None,
                }))
            }
        })
    }

    /// Searches a frame whose observations are these.
    ///
    /// # Errors
    /// When the observations do not fit the cameras, no pose has a finite fitness, or the device fails.
    pub(super) fn search(
        &mut self,
        evaluator: &mut dyn Evaluator,
        objective: &Objective,
        observations: &[Observation],
        start: Start<'_>,
    ) -> Result<Searched> {
        let Start { frame, centre, spread, until } = start;
        evaluator.observe(observations)?;
        match self {
            Self::Host(search) => {
                let mut evaluations = Vec::with_capacity(search.iterations() + 1);
                let mut passes = Vec::new();
                let fitness = &mut |poses: &[f32], fitness: &mut [f32]| {
                    let begin = Instant::now();
                    evaluator.fitness(poses, objective, fitness)?;
                    evaluations.push(Span::since(begin));
                    passes.extend(evaluator.device_passes());
                    Ok(())
                };
                search.start_frame(frame, centre, spread)?;
                for done in 0..search.iterations() {
                    let begin = Instant::now();
                    search.iterate(fitness)?;
                    if until.is_some_and(|until| Instant::now() + begin.elapsed() > until)
                        && done + 1 >= FEWEST_ITERATIONS
                    {
                        break;
                    }
                }
                let estimate = search.estimate(fitness)?;
                let mut components = vec![Components::default(); evaluator.view_count()];
                evaluator.components(&estimate.pose, &mut components)?;
                passes.extend(evaluator.device_passes());
                Ok(Searched { estimate, components, evaluations, passes })
            }
            Self::Device(search) => {
                let begin = Instant::now();
                let search = search.search(evaluator)?;
                let found = search.search_frame(frame, centre, spread)?;
                let evaluations = vec![Span::since(begin)];
                let passes = search.passes_run(Instant::now())?;
                let components = observations
                    .iter()
                    .zip(found.sums)
                    .map(|(observation, [area_model, overlap, edges, proximity])| Components {
                        area_obs: observation.area(),
                        area_model,
                        overlap,
                        edges,
                        proximity,
                    })
                    .collect();
                Ok(Searched { estimate: found.estimate, components, evaluations, passes })
            }
        }
    }
}
