//! The runs of a study.

use anyhow::Result;

use super::run::Run;
use super::settings::Study;

impl Study {
    /// Every run. All settings of one seed come before the next seed, so that a study that is stopped midway has something
    /// to say about each.
    ///
    /// # Errors
    /// When a sequence's frames are no range.
    pub fn runs(&self) -> Result<Vec<Run>> {
        let mut runs = Vec::new();
        for &seed in &self.seeds {
            for sequence in &self.sequences {
                let (name, frames) = (sequence.name(), sequence.frames()?.to_string());
                let spread = sequence.spread.unwrap_or(self.spread);
                for &backend in &self.backends {
                    for &model in &self.models {
                        for objective in self.objectives() {
                            for &search in &self.searches {
                                for &particles in &self.particles {
                                    for &iterations in &self.iterations {
                                        runs.extend(self.paces.iter().map(|&pace| Run {
                                            sequence: name.clone(),
                                            backend,
                                            model,
                                            objective,
                                            search,
                                            particles,
                                            iterations,
                                            pace,
                                            seed,
                                            frames: frames.clone(),
                                            spread,
                                            passes: self.passes,
                                        }));
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
        Ok(runs)
    }
}
