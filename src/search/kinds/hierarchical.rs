//! Hierarchical particle swarm: the torso first, then limb by limb, then everything a little (John, Trucco and Ivekovic:
//! "Markerless human articulated tracking using hierarchical particle swarm optimisation", 2010).

use anyhow::{Result, bail, ensure};
use serde::Serialize;
use toml::Table;

use super::form::{Budget, SearchForm};
use super::{Pso, PsoSettings};
use crate::files::table_of;
use crate::search::{Estimate, Fitness, Search, SearchSpace, check_start};

/// Constants of the hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HierarchySettings {
    /// Share of the iterations that move everything in the end: what an early stage got wrong, a later one cannot mend
    /// alone.
    pub joint_share: f32,
    /// Factor on the frame's spread that these begin with.
    pub joint_spread: f32,
}

impl Default for HierarchySettings {
    fn default() -> Self {
        Self { joint_share: 0.4, joint_spread: 0.4 }
    }
}

impl HierarchySettings {
    /// The stages of a space, whose iterations add up to `iterations`: the torso, each limb, everything. With fewer iterations
    /// than stages limbs share one; a single iteration moves everything at once.
    pub(crate) fn stages(&self, space: &SearchSpace, iterations: usize) -> Vec<SwarmStage> {
        let groups = space.groups();
        let limbs = groups.iter().copied().max().unwrap_or(0);
        if limbs == 0 || iterations == 1 {
            return vec![SwarmStage::whole(space, iterations)];
        }
        let joint = if iterations > 2 { 1 } else { 0 };
        let limb_stages = limbs.min(iterations - 1 - joint);
        let stage_of = |group: usize| if group == 0 { 0 } else { 1 + (group - 1) % limb_stages };
        let mut weights = vec![0.0; 1 + limb_stages];
        for &group in groups {
            weights[stage_of(group)] += 1.0;
        }
        let mut stages: Vec<SwarmStage> = (0..=limb_stages)
            .map(|stage| {
                let factors = groups.iter().map(|&group| if stage_of(group) == stage { 1.0 } else { 0.0 }).collect();
                SwarmStage { factors, iterations: 1 }
            })
            .collect();
        if joint == 1 {
            stages.push(SwarmStage { factors: vec![self.joint_spread; groups.len()], iterations: 1 });
            let share = f64::from(self.joint_share.min(0.99));
            weights.push(groups.len() as f64 * share / (1.0 - share));
        }
        // Each further iteration goes where it is missed most, of equals to the first.
        for _ in stages.len()..iterations {
            let mut neediest = 0;
            for (index, weight) in weights.iter().enumerate() {
                let need = |index: usize, weight: f64| weight / stages[index].iterations as f64;
                if need(index, *weight) > need(neediest, weights[neediest]) {
                    neediest = index;
                }
            }
            stages[neediest].iterations += 1;
        }
        stages
    }
}

/// A swarm of its own over some dimensions.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SwarmStage {
    /// Factor on the frame's spread of every dimension; one of 0 stands still.
    pub(crate) factors: Vec<f32>,
    pub(crate) iterations: usize,
}

impl SwarmStage {
    /// Everything at once.
    pub(crate) fn whole(space: &SearchSpace, iterations: usize) -> Self {
        Self { factors: vec![1.0; space.dof_count()], iterations }
    }
}

/// The hierarchical swarm by its constants and those of its swarms.
#[derive(Serialize)]
pub(super) struct SwarmHierarchy {
    #[serde(flatten)]
    pub(super) swarm: PsoSettings,
    #[serde(flatten)]
    pub(super) hierarchy: HierarchySettings,
}

impl SearchForm for SwarmHierarchy {
    fn build(&self, budget: &Budget, space: &SearchSpace) -> Box<dyn Search> {
        Box::new(HierarchicalPso::new(self, budget, space))
    }

    fn check(&self) -> Result<()> {
        for (name, value) in
            [("joint share", self.hierarchy.joint_share), ("joint spread", self.hierarchy.joint_spread)]
        {
            ensure!((0.0..=1.0).contains(&value), "the hierarchy's {name} is {value}, expected 0 to 1");
        }
        Ok(())
    }

    fn constants(&self) -> Result<Table> {
        table_of(self)
    }

    fn has_device_form(&self) -> bool {
        true
    }
}

/// The search. A stage is a swarm ([`Pso`]) around the best pose so far, at rest, in which only the stage's dimensions move;
/// which are a limb's is [`SearchSpace::groups`]'s to say. Nothing ever gets worse: the best pose so far is a particle of
/// the next stage.
pub struct HierarchicalPso {
    swarm: Pso,
    stages: Vec<SwarmStage>,
    iterations: usize,
    /// Iterations done in this frame; `None` before the first frame.
    done: Option<usize>,
    /// The stage in work, and its iterations that are left.
    stage: usize,
    left: usize,
    frame: u32,
    centre: Vec<f32>,
    spread: Vec<f32>,
    /// The frame's spread times the stage's factors.
    scaled: Vec<f32>,
    /// Spread of the candidates of the last stage that moved a dimension; the frame's where none did yet.
    settled: Vec<f32>,
}

impl HierarchicalPso {
    /// A search from checked settings.
    fn new(settings: &SwarmHierarchy, budget: &Budget, space: &SearchSpace) -> Self {
        let dofs = space.dof_count();
        Self {
            swarm: Pso::new(&settings.swarm, budget, space),
            stages: settings.hierarchy.stages(space, budget.iterations),
            iterations: budget.iterations,
            done: None,
            stage: 0,
            left: 0,
            frame: 0,
            centre: vec![0.0; dofs],
            spread: vec![0.0; dofs],
            scaled: vec![0.0; dofs],
            settled: vec![0.0; dofs],
        }
    }

    /// Takes over the spread of what the stage in work moves.
    fn settle(&mut self) {
        let spread = self.swarm.deviation();
        for ((settled, spread), factor) in self.settled.iter_mut().zip(spread).zip(&self.stages[self.stage].factors) {
            if *factor > 0.0 {
                *settled = spread;
            }
        }
    }

    /// Begins the stage `self.stage` around the best pose so far, `done` iterations into the frame.
    fn begin(&mut self, done: usize) {
        let stage = &self.stages[self.stage];
        for ((scaled, spread), factor) in self.scaled.iter_mut().zip(&self.spread).zip(&stage.factors) {
            *scaled = spread * factor;
        }
        self.left = stage.iterations;
        self.swarm.begin(self.frame, [done, stage.iterations], &self.centre, &self.scaled);
    }
}

impl Search for HierarchicalPso {
    fn name(&self) -> &'static str {
        self.swarm.name()
    }

    fn iterations(&self) -> usize {
        self.iterations
    }

    fn start_frame(&mut self, frame: u32, centre: &[f32], spread: &[f32]) -> Result<()> {
        check_start(self.centre.len(), centre, spread)?;
        self.frame = frame;
        self.centre.copy_from_slice(centre);
        self.spread.copy_from_slice(spread);
        self.settled.copy_from_slice(spread);
        self.stage = 0;
        self.begin(0);
        self.done = Some(0);
        Ok(())
    }

    fn iterate(&mut self, fitness: &mut Fitness<'_>) -> Result<()> {
        let Some(done) = self.done else { bail!("the search has no frame yet: start one before iterating") };
        ensure!(done < self.iterations, "all {done} iterations of frame {} are done", self.frame);
        if self.left == 0 {
            self.settle();
            self.centre.copy_from_slice(self.swarm.leader());
            self.stage += 1;
            self.begin(done);
        }
        self.swarm.iterate(fitness)?;
        self.left -= 1;
        self.done = Some(done + 1);
        Ok(())
    }

    fn estimate(&mut self, fitness: &mut Fitness<'_>) -> Result<Estimate> {
        // The swarm counts the evaluations of the whole frame, and its leader is the best of all stages.
        let estimate = self.swarm.estimate(fitness)?;
        self.settle();
        Ok(Estimate { spread: self.settled.clone(), ..estimate })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Body;

    #[test]
    fn stages_share_the_iterations_and_cover_everything() {
        let space = SearchSpace::of(&Body::adult(1750.0).unwrap()).unwrap();
        for iterations in 1..40 {
            let stages = HierarchySettings::default().stages(&space, iterations);
            assert_eq!(stages.iter().map(|stage| stage.iterations).sum::<usize>(), iterations);
            assert!(stages.iter().all(|stage| stage.iterations > 0));
            for d in 0..space.dof_count() {
                assert!(stages.iter().any(|stage| stage.factors[d] == 1.0), "{d} of {iterations}");
            }
        }
        let many = HierarchySettings::default().stages(&space, 30);
        assert_eq!(many.len(), 7, "torso, two legs, two arms, head, everything");
        assert!(many[0].factors[0] == 1.0 && many[1].factors[0] == 0.0, "the root is the torso's");
    }
}
