//! Hierarchical particle swarm: the torso first, then limb by limb, then everything a little (John, Trucco and Ivekovic:
//! "Markerless human articulated tracking using hierarchical particle swarm optimisation", 2010).

use anyhow::{Result, bail, ensure};
use serde::Serialize;

use super::form::{Budget, SearchForm};
use super::{Pso, PsoSettings};
use crate::search::device::DeviceForm;
use crate::search::{Estimate, Fitness, Search, SearchSpace, check_start};

/// Constants of the hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HierarchySettings {
    /// Share of the iterations that move everything in the end: what an early level got wrong, a later one cannot mend
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
    /// The levels of a space, whose iterations add up to `iterations`: the torso, each limb, everything. With fewer iterations
    /// than levels limbs share one; a single iteration moves everything at once.
    pub(crate) fn levels(&self, space: &SearchSpace, iterations: usize) -> Vec<SwarmLevel> {
        let groups = space.groups();
        let limbs = groups.iter().copied().max().unwrap_or(0);
        if limbs == 0 || iterations == 1 {
            return vec![SwarmLevel::whole(space, iterations)];
        }
        let joint = if iterations > 2 { 1 } else { 0 };
        let limb_levels = limbs.min(iterations - 1 - joint);
        let level_of = |group: usize| if group == 0 { 0 } else { 1 + (group - 1) % limb_levels };
        let mut weights = vec![0.0; 1 + limb_levels];
        for &group in groups {
            weights[level_of(group)] += 1.0;
        }
        let mut levels: Vec<SwarmLevel> = (0..=limb_levels)
            .map(|level| {
                let factors = groups.iter().map(|&group| if level_of(group) == level { 1.0 } else { 0.0 }).collect();
                SwarmLevel { factors, iterations: 1 }
            })
            .collect();
        if joint == 1 {
            levels.push(SwarmLevel { factors: vec![self.joint_spread; groups.len()], iterations: 1 });
            let share = f64::from(self.joint_share.min(0.99));
            weights.push(groups.len() as f64 * share / (1.0 - share));
        }
        // Each further iteration goes where it is missed most, of equals to the first.
        for _ in levels.len()..iterations {
            let mut neediest = 0;
            for (index, weight) in weights.iter().enumerate() {
                let need = |index: usize, weight: f64| weight / levels[index].iterations as f64;
                if need(index, *weight) > need(neediest, weights[neediest]) {
                    neediest = index;
                }
            }
            levels[neediest].iterations += 1;
        }
        levels
    }
}

/// A swarm of its own over some dimensions.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SwarmLevel {
    /// Factor on the frame's spread of every dimension; one of 0 stands still.
    pub(crate) factors: Vec<f32>,
    pub(crate) iterations: usize,
}

impl SwarmLevel {
    /// Everything at once.
    pub(crate) fn whole(space: &SearchSpace, iterations: usize) -> Self {
        Self { factors: vec![1.0; space.dof_count()], iterations }
    }
}

/// The hierarchical swarm by its constants and those of its swarms.
#[derive(Serialize)]
pub(crate) struct SwarmHierarchy {
    #[serde(flatten)]
    pub(crate) swarm: PsoSettings,
    #[serde(flatten)]
    pub(crate) hierarchy: HierarchySettings,
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

    fn on_device(&self) -> Option<&dyn DeviceForm> {
        Some(self)
    }
}

/// The search. A level is a swarm ([`Pso`]) around the best pose so far, at rest, in which only the level's dimensions move;
/// which are a limb's is [`SearchSpace::groups`]'s to say. Nothing ever gets worse: the best pose so far is a particle of
/// the next level.
pub struct HierarchicalPso {
    swarm: Pso,
    levels: Vec<SwarmLevel>,
    iterations: usize,
    /// Iterations done in this frame; `None` before the first frame.
    done: Option<usize>,
    /// The level in work, and its iterations that are left.
    level: usize,
    left: usize,
    frame: u32,
    centre: Vec<f32>,
    spread: Vec<f32>,
    /// The frame's spread times the level's factors.
    scaled: Vec<f32>,
    /// Spread of the candidates of the last level that moved a dimension; the frame's where none did yet.
    settled: Vec<f32>,
}

impl HierarchicalPso {
    /// A search from checked settings.
    fn new(settings: &SwarmHierarchy, budget: &Budget, space: &SearchSpace) -> Self {
        let dofs = space.dof_count();
        Self {
            swarm: Pso::new(&settings.swarm, budget, space),
            levels: settings.hierarchy.levels(space, budget.iterations),
            iterations: budget.iterations,
            done: None,
            level: 0,
            left: 0,
            frame: 0,
            centre: vec![0.0; dofs],
            spread: vec![0.0; dofs],
            scaled: vec![0.0; dofs],
            settled: vec![0.0; dofs],
        }
    }

    /// Takes over the spread of what the level in work moves.
    fn settle(&mut self) {
        let spread = self.swarm.deviation();
        for ((settled, spread), factor) in self.settled.iter_mut().zip(spread).zip(&self.levels[self.level].factors) {
            if *factor > 0.0 {
                *settled = spread;
            }
        }
    }

    /// Begins the level `self.level` around the best pose so far, `done` iterations into the frame.
    fn begin(&mut self, done: usize) {
        let level = &self.levels[self.level];
        for ((scaled, spread), factor) in self.scaled.iter_mut().zip(&self.spread).zip(&level.factors) {
            *scaled = spread * factor;
        }
        self.left = level.iterations;
        self.swarm.begin(self.frame, [done, level.iterations], &self.centre, &self.scaled);
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
        self.level = 0;
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
            self.level += 1;
            self.begin(done);
        }
        self.swarm.iterate(fitness)?;
        self.left -= 1;
        self.done = Some(done + 1);
        Ok(())
    }

    fn estimate(&mut self, fitness: &mut Fitness<'_>) -> Result<Estimate> {
        // The swarm counts the evaluations of the whole frame, and its leader is the best of all levels.
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
    fn levels_share_the_iterations_and_cover_everything() {
        let space = SearchSpace::of(&Body::adult(1750.0).unwrap()).unwrap();
        for iterations in 1..40 {
            let levels = HierarchySettings::default().levels(&space, iterations);
            assert_eq!(levels.iter().map(|level| level.iterations).sum::<usize>(), iterations);
            assert!(levels.iter().all(|level| level.iterations > 0));
            for d in 0..space.dof_count() {
                assert!(levels.iter().any(|level| level.factors[d] == 1.0), "{d} of {iterations}");
            }
        }
        let many = HierarchySettings::default().levels(&space, 30);
        assert_eq!(many.len(), 7, "torso, two legs, two arms, head, everything");
        assert!(many[0].factors[0] == 1.0 && many[1].factors[0] == 0.0, "the root is the torso's");
    }
}
