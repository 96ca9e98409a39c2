//! One frame's search: driven by the host over any evaluator, or whole on the device that the evaluator works on.

use std::time::Instant;

use anyhow::{Context, Result, anyhow, ensure};

use super::timings::Span;
use crate::evaluate::{Components, Evaluator, Objective, ViewCounts};
use crate::features::{SeenFrame, SeenView};
use crate::gpu::{DevicePass, Timing};
use crate::search::{DeviceSearch, Estimate, Refinement, Search, SearchSettings, SearchSpace};

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
    refinement: Refinement,
    /// What the device estimated last, and what refinement made of it: a filter goes on from its own estimate alone.
    estimated: [Vec<f32>; 2],
}

impl OnDevice {
    /// The search, recorded for the newest observations.
    fn search(&mut self, evaluator: &mut dyn Evaluator) -> Result<&mut DeviceSearch> {
        let name = evaluator.name();
        let Some(evaluator) = evaluator.on_device() else { return Err(left_its_device(name)) };
        let is_handed = evaluator.is_handed_observations();
        let comes_otherwise =
            self.recorded.as_ref().is_some_and(|recorded| recorded.is_handed_observations() != is_handed);
        let carries_on = self.settings.kind.carries_on();
        ensure!(
            !(carries_on && comes_otherwise),
            "the search {} is recorded for observations that come in another way than the newest ones",
            self.settings.kind.name()
        );
        // A filter's samples live in its recording: it stays with the old one, which is slower and no less right.
        let is_outgrown = comes_otherwise || !carries_on && evaluator.has_outgrown_its_recording();
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
    pub(super) views: Vec<ViewCounts>,
    /// When the evaluator worked. On a device that is the whole submission, the search's own stages included.
    pub(super) evaluations: Vec<Span>,
    /// The passes that ran on the device, where they are measured.
    pub(super) passes: Vec<DevicePass>,
}

impl Searcher {
    /// The search of these settings, on the evaluator's device if both have a form for that; there `timing` is what is
    /// measured of its passes.
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
        if evaluator.on_device().is_none_or(|there| !settings.kind.fits(there.device())) {
            return Self::on_host(settings, space);
        }
        settings.check_room(space)?;
        Ok(Self::Device(Box::new(OnDevice {
            settings: *settings,
            space: space.clone(),
            objective: *objective,
            timing,
            recorded: None,
            refinement: Refinement::new(settings.refine, space),
            estimated: [Vec::new(), Vec::new()],
        })))
    }

    /// The search of these settings, driven by the host.
    ///
    /// # Errors
    /// As [`SearchSettings::build`].
    pub(super) fn on_host(settings: &SearchSettings, space: &SearchSpace) -> Result<Self> {
        Ok(Self::Host(settings.build(space)?))
    }

    /// Searches a frame in which this was seen.
    ///
    /// # Errors
    /// When the observations do not fit the cameras, no pose has a finite fitness, or the device fails.
    pub(super) fn search(
        &mut self,
        evaluator: &mut dyn Evaluator,
        objective: &Objective,
        seen: SeenFrame<'_>,
        start: Start<'_>,
    ) -> Result<Searched> {
        let Start { frame, centre, spread, until } = start;
        evaluator.observe_seen(seen)?;
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
                let views = evaluator.view_counts(&estimate.pose, objective)?;
                passes.extend(evaluator.device_passes());
                Ok(Searched { estimate, views, evaluations, passes })
            }
            Self::Device(search) => search.search_frame(evaluator, objective, seen, start),
        }
    }

    /// What the user should know about where it runs.
    pub(super) fn note(&self, evaluator: &mut dyn Evaluator) -> Option<String> {
        let Self::Host(search) = self else { return None };
        evaluator.on_device()?;
        let (search, backend) = (search.name(), evaluator.name());
        Some(format!(
            "the search {search} has no form for this device: the host drives it, and {backend} scores its batches"
        ))
    }
}

impl OnDevice {
    /// A frame in one submission; its refinement, where there is one, is driven by the host.
    fn search_frame(
        &mut self,
        evaluator: &mut dyn Evaluator,
        objective: &Objective,
        seen: SeenFrame<'_>,
        Start { frame, centre, spread, .. }: Start<'_>,
    ) -> Result<Searched> {
        let begin = Instant::now();
        let [before, after] = &self.estimated;
        let own_centre = if after == centre { before.clone() } else { centre.to_vec() };
        let search = self.search(evaluator)?;
        let name = evaluator.name();
        let Some(on_device) = evaluator.on_device() else { return Err(left_its_device(name)) };
        let found = search.search_frame_behind(on_device.handover(), frame, &own_centre, spread)?;
        let mut evaluations = vec![Span::since(begin)];
        let mut passes = search.passes_run(Instant::now())?;
        let mut estimate = found.estimate;
        if self.settings.refine == 0 {
            if objective.weighs_evidence() {
                // The search brings no evidence back: its best pose is weighed once more.
                let views = evaluator.view_counts(&estimate.pose, objective)?;
                passes.extend(evaluator.device_passes());
                return Ok(Searched { estimate, views, evaluations, passes });
            }
            let counts = |(view, sums): (SeenView<'_>, [u32; 4])| {
                let ([area_model, overlap, edges, proximity], area_obs) = (sums, view.area());
                let components = Components { area_obs, area_model, overlap, edges, proximity };
                ViewCounts { components, evidence: None }
            };
            let views = seen.views().into_iter().zip(found.sums).map(counts).collect();
            return Ok(Searched { estimate, views, evaluations, passes });
        }
        let before = estimate.pose.clone();
        self.refinement.improve(&mut estimate, spread, &mut |poses, fitness| {
            let begin = Instant::now();
            evaluator.fitness(poses, objective, fitness)?;
            evaluations.push(Span::since(begin));
            passes.extend(evaluator.device_passes());
            Ok(())
        })?;
        self.estimated = [before, estimate.pose.clone()];
        let views = evaluator.view_counts(&estimate.pose, objective)?;
        passes.extend(evaluator.device_passes());
        Ok(Searched { estimate, views, evaluations, passes })
    }
}

fn left_its_device(backend: &str) -> anyhow::Error {
    anyhow!("the backend {backend} has left its device")
}
