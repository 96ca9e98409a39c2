//! Scenes that a study draws from seeds, made once and kept.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result};
use serde::Deserialize;

use crate::files::{OutputFolder, choices};
use crate::sequence::Sequence;
use crate::synth::{Lottery, LotterySettings};
use crate::track::write_unseen;

/// `[lottery]`: every scene with every manifest is a sequence of the study.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LotteryTable {
    /// The seeds of the scenes.
    pub seeds: Vec<u64>,
    /// Recorded motions, seen from the study's file; built-in gaits without.
    pub motions: Option<PathBuf>,
    /// Skinned people, likewise; our own figures without.
    pub people: Option<PathBuf>,
    /// Frames of a scene, if another number than the lottery's own.
    pub frames: Option<usize>,
    /// What a tracker is told.
    #[serde(default = "measured")]
    pub manifests: Vec<LotteryManifest>,
    /// Where the scenes are made and kept, seen from the study's file; in the study's own folder without. Several studies may
    /// share one.
    pub scenes: Option<PathBuf>,
}

choices! {
    /// Which of a drawn scene's manifests is tracked.
    #[derive(Default)]
    "manifest" pub enum LotteryManifest => pub(super) file: &'static str {
        /// What a user has: measured body and start pose, pictures and plates.
        "sequence" #[default] Sequence => "sequence.toml",
        /// The same with exact silhouettes.
        "exact" Exact => "exact.toml",
        /// The actor's own body and pose.
        "true_sequence" TrueSequence => "true_sequence.toml",
    }
}

fn measured() -> Vec<LotteryManifest> {
    vec![LotteryManifest::default()]
}

/// A scene of a lottery and the manifest that is tracked.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    settings: LotterySettings,
    manifest: LotteryManifest,
    scenes: Option<PathBuf>,
}

impl LotteryTable {
    /// All scenes by name: `lottery07`, `lottery07_exact`.
    pub(super) fn scenes(&self) -> Vec<(String, Drawn)> {
        let scene = |seed: u64, manifest: LotteryManifest| {
            let suffix = if manifest == LotteryManifest::Sequence { String::new() } else { format!("_{manifest}") };
            let (motions, people) = (self.motions.clone(), self.people.clone());
            let settings = LotterySettings { seed, motions, people, frames: self.frames };
            let drawn = Drawn { settings, manifest, scenes: self.scenes.clone() };
            (format!("lottery{seed:02}{suffix}"), drawn)
        };
        let of_seed = |seed: &u64| self.manifests.iter().map(move |manifest| (*seed, *manifest)).collect::<Vec<_>>();
        self.seeds.iter().flat_map(of_seed).map(|(seed, manifest)| scene(seed, manifest)).collect()
    }
}

impl Drawn {
    /// Opens the scene, which is made first unless it is there.
    ///
    /// # Errors
    /// When it cannot be drawn or written.
    pub(super) fn open(&self, output: &OutputFolder, progress: &(dyn Fn(usize, usize) + Sync)) -> Result<Sequence> {
        let seed = self.settings.seed;
        let scenes = self.scenes.clone().unwrap_or_else(|| output.path().join("scenes"));
        let name = format!("{seed:02}");
        let folder = OutputFolder::open(&scenes.join(&name))?;
        // Other processes, and other studies, may want the scene too.
        OutputFolder::open(&scenes)?.alone(&name, || self.make(&folder, progress))?;
        Sequence::open(&folder.path().join(self.manifest.file()))
    }

    /// Draws the scene into its folder unless it is there.
    fn make(&self, folder: &OutputFolder, progress: &(dyn Fn(usize, usize) + Sync)) -> Result<()> {
        let seed = self.settings.seed;
        if !folder.path().join("sequence.toml").exists() {
            let lottery = Lottery::draw(&self.settings)?;
            let frames = lottery.scene.frames + lottery.t_pose.frames;
            let done = AtomicUsize::new(0);
            let is_begun = folder.path().join("scene.toml").exists();
            write_unseen(&lottery, folder, is_begun, None, &|_| {
                progress(done.fetch_add(1, Ordering::Relaxed) + 1, frames);
                Ok(())
            })
            .with_context(|| format!("the scene of seed {seed}"))?;
        }
        Ok(())
    }
}
