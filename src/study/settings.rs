//! The study file.

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;

use super::axes::{Axis, Value};
use super::lottery::{Drawn, LotteryTable};
use super::pace::Pace;
use crate::body::Model;
use crate::evaluate::ObjectiveKind;
use crate::files::{expected, parse_toml, read_toml, shortened};
use crate::search::{SearchKind, SearchSettings};
use crate::track::{Drawing, FrameRange, Passes};

/// More runs than anyone waits for are a slip of the pen.
const MOST_RUNS: usize = 100_000;

/// A study as its file describes it: every combination of the lists is run with every seed.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Its name.
    pub name: String,
    /// The seeds of the search.
    pub seeds: Vec<u64>,
    /// Poses scored at once.
    #[serde(default = "default_particles")]
    pub particles: Vec<usize>,
    /// Times that many poses are scored a frame.
    #[serde(default = "default_iterations")]
    pub iterations: Vec<usize>,
    /// Objective functions; without any, the one that `track` takes for each search and sequence.
    #[serde(default)]
    pub objectives: Option<Vec<ObjectiveKind>>,
    /// Searches.
    #[serde(default = "only_default")]
    pub searches: Vec<SearchKind>,
    /// What bodies are drawn as.
    #[serde(default = "only_default")]
    pub models: Vec<Model>,
    /// Who scores the poses, and how.
    #[serde(default = "only_default")]
    pub backends: Vec<Drawing>,
    /// How runs keep time.
    #[serde(default = "only_default")]
    pub paces: Vec<Pace>,
    /// Factor on the width of the search round the previous pose.
    #[serde(default = "default_spread")]
    pub spread: f64,
    /// How often runs go over their frames, if not as it suits their search.
    pub passes: Option<Passes>,
    /// What is tracked; with a lottery also its scenes, behind these.
    #[serde(default, rename = "sequence")]
    pub sequences: Vec<SequenceSettings>,
    /// Scenes drawn from seeds.
    pub lottery: Option<LotteryTable>,
    /// The tables; without any, one of the errors and one of the frame rates.
    #[serde(default, rename = "table")]
    pub tables: Vec<TableSettings>,
    /// The plots.
    #[serde(default, rename = "plot")]
    pub plots: Vec<PlotSettings>,
    /// The pictures of where the time goes.
    #[serde(default)]
    pub shares: Vec<SharesSettings>,
}

/// A sequence of a study: a folder, or a preset that is made on the spot.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SequenceSettings {
    /// Its sequence.toml or folder, seen from the study's file.
    pub path: Option<PathBuf>,
    /// A preset of `pantin synth`, instead of a path.
    pub preset: Option<String>,
    /// A scene of the study's lottery, instead of a path: no key of a file.
    #[serde(skip)]
    pub drawn: Option<Drawn>,
    /// The cameras whose views are tracked, if not all.
    #[serde(default)]
    pub cameras: Vec<String>,
    /// Every which frame is tracked.
    pub every: Option<usize>,
    /// Backwards, from the last frame.
    #[serde(default)]
    pub reversed: bool,
    /// The first pose of a reversed sequence, seen from the study's file; it is searched without.
    pub start: Option<PathBuf>,
    /// Where the person faces there, degrees; found out without.
    pub heading: Option<f64>,
    /// How many frames of the preset are made, if not all.
    pub length: Option<usize>,
    /// Its name in rows and tables, if not that of the preset or the sequence's folder.
    pub name: Option<String>,
    /// Which frames are tracked, `A..B`.
    pub frames: Option<String>,
    /// Another factor on the width of the search than the study's.
    pub spread: Option<f64>,
    /// Another truth than the sequence's own, seen from the study's file.
    pub truth: Option<PathBuf>,
    /// The names of the truth's points and ours, where they differ.
    #[serde(default)]
    pub map: BTreeMap<String, String>,
    /// Points that are left out, as `pantin score --exclude`.
    #[serde(default)]
    pub exclude: Vec<String>,
    /// The truth is y-up (OpenSim).
    #[serde(default)]
    pub truth_y_up: bool,
}

/// A table of means and standard deviations over everything that its rows and columns do not tell apart.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableSettings {
    /// The name of its file.
    pub name: String,
    /// What stands above it.
    #[serde(default)]
    pub title: String,
    /// What is told.
    pub value: Value,
    /// What makes a row.
    pub rows: Vec<Axis>,
    /// What makes a column.
    pub columns: Vec<Axis>,
}

/// A plot of a value against a number.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlotSettings {
    /// The name of its file.
    pub name: String,
    /// What is plotted.
    pub value: Value,
    /// Against `particles`, `iterations` or `evaluations`.
    pub x: Axis,
    /// What makes a line.
    #[serde(default)]
    pub lines: Vec<Axis>,
    /// The sequence whose runs alone are plotted, if not those of all.
    pub sequence: Option<String>,
}

/// A picture of the stages' shares of the time.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SharesSettings {
    /// The name of its file.
    pub name: String,
    /// What makes a bar.
    pub bars: Vec<Axis>,
}

fn default_particles() -> Vec<usize> {
    vec![SearchSettings::default().particles]
}

fn default_iterations() -> Vec<usize> {
    vec![SearchSettings::default().iterations]
}

fn only_default<T: Default>() -> Vec<T> {
    vec![T::default()]
}

fn default_spread() -> f64 {
    1.0
}

impl SequenceSettings {
    /// The name in rows and tables.
    pub fn name(&self) -> String {
        let folder = |path: &PathBuf| {
            let named = if path.extension().is_some_and(|end| end == "toml") { path.parent()? } else { path };
            Some(named.file_name()?.to_string_lossy().into_owned())
        };
        self.name
            .clone()
            .or_else(|| self.preset.clone())
            .or_else(|| self.path.as_ref().and_then(folder))
            .unwrap_or_else(|| "sequence".to_string())
    }

    /// Which frames are tracked.
    ///
    /// # Errors
    /// When `frames` is no range.
    pub fn frames(&self) -> Result<FrameRange> {
        self.frames.as_deref().map_or(Ok(FrameRange::default()), str::parse)
    }

    fn check(&self) -> Result<()> {
        ensure!(
            self.drawn.is_some() || self.path.is_some() != self.preset.is_some(),
            "it has {}, expected one of them",
            if self.path.is_some() { "both `path` and `preset`" } else { "neither `path` nor `preset`" }
        );
        ensure!(
            self.length.is_none() || self.preset.is_some(),
            "`length` stands beside `path`, expected it beside `preset`; `frames` chooses frames of any sequence"
        );
        ensure!(self.length != Some(0), "length is 0, expected at least 1 frame");
        self.frames().context("frames")?;
        self.spread.map_or(Ok(()), check_spread)?;
        self.check_taken()?;
        file_name(&self.name())
    }
}

impl Study {
    /// Reads a study file and checks it; paths in it are seen from its folder.
    ///
    /// # Errors
    /// One sentence with the file, the key, what was found and what was expected.
    pub fn load(path: &Path) -> Result<Self> {
        let mut study: Self = read_toml(path)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        for sequence in &mut study.sequences {
            for path in [&mut sequence.path, &mut sequence.truth, &mut sequence.start].into_iter().flatten() {
                *path = folder.join(&*path);
            }
        }
        if let Some(lottery) = &mut study.lottery {
            for path in [&mut lottery.motions, &mut lottery.people, &mut lottery.scenes].into_iter().flatten() {
                *path = folder.join(&*path);
            }
        }
        study.draw();
        study.check().with_context(|| path.display().to_string())?;
        Ok(study)
    }

    /// [`Study::load`] of text in memory; `name` stands for the file in messages, paths stay as they are.
    ///
    /// # Errors
    /// As [`Study::load`].
    pub fn parse(text: &str, name: &str) -> Result<Self> {
        let mut study: Self = parse_toml(text, name)?;
        study.draw();
        study.check().with_context(|| name.to_string())?;
        Ok(study)
    }

    /// Puts the scenes of the lottery behind the other sequences.
    fn draw(&mut self) {
        if let Some(lottery) = &self.lottery {
            self.sequences.extend(lottery.scenes().into_iter().map(|(name, drawn)| SequenceSettings {
                name: Some(name),
                drawn: Some(drawn),
                ..SequenceSettings::default()
            }));
        }
    }

    /// The objective functions of its runs; none for that which `track` takes by itself.
    pub(super) fn objectives(&self) -> Vec<Option<ObjectiveKind>> {
        self.objectives.as_ref().map_or_else(|| vec![None], |kinds| kinds.iter().copied().map(Some).collect())
    }

    /// Whether the study makes sense by itself.
    ///
    /// # Errors
    /// With the key, what was found and what was expected.
    pub fn check(&self) -> Result<()> {
        several("seeds", &self.seeds)?;
        several("particles", &self.particles)?;
        several("iterations", &self.iterations)?;
        self.objectives.as_ref().map_or(Ok(()), |kinds| several("objectives", kinds))?;
        several("searches", &self.searches)?;
        several("models", &self.models)?;
        several("backends", &self.backends)?;
        several("paces", &self.paces)?;
        ensure!(
            !self.paces.contains(&Pace::Realtime) || self.passes.is_none_or(|passes| passes == Passes::Forward),
            "paces holds realtime, which goes over its frames once, expected passes = \"forward\" or none"
        );
        if let Some(lottery) = &self.lottery {
            several("[lottery] seeds", &lottery.seeds)?;
            several("[lottery] manifests", &lottery.manifests)?;
            ensure!(lottery.frames != Some(0), "[lottery] frames is 0, expected at least 1");
        }
        check_spread(self.spread)?;
        for (&particles, &iterations) in self.particles.iter().flat_map(|p| self.iterations.iter().map(move |i| (p, i)))
        {
            for &kind in &self.searches {
                SearchSettings { kind, particles, iterations, ..SearchSettings::default() }.check()?;
            }
        }
        ensure!(!self.sequences.is_empty(), "there is no [[sequence]] and no [lottery], expected one of them");
        let mut names = HashSet::new();
        for sequence in &self.sequences {
            let name = sequence.name();
            sequence.check().with_context(|| format!("[[sequence]] {name:?}"))?;
            ensure!(
                names.insert(name.clone()),
                "two sequences are named {name:?}, expected a `name` of its own for each"
            );
        }
        self.check_pictures()?;
        let lists = [self.seeds.len(), self.particles.len(), self.iterations.len(), self.objectives().len()];
        let more =
            [self.searches.len(), self.models.len(), self.backends.len(), self.paces.len(), self.sequences.len()];
        let runs = lists.into_iter().chain(more).fold(1_usize, usize::saturating_mul);
        ensure!(runs <= MOST_RUNS, "the lists make {runs} runs, expected at most {MOST_RUNS}");
        Ok(())
    }

    fn check_pictures(&self) -> Result<()> {
        let pictures = self.plots.iter().map(|plot| &plot.name).chain(self.shares.iter().map(|shares| &shares.name));
        own_names("[[table]]", self.tables.iter().map(|table| &table.name))?;
        own_names("[[plot]] or [[shares]]", pictures)?;
        for table in &self.tables {
            (|| {
                file_name(&table.name)?;
                ensure!(!table.rows.is_empty(), "rows is empty, expected what makes a row");
                let mut seen = HashSet::new();
                let twice = table.rows.iter().chain(&table.columns).find(|axis| !seen.insert(**axis));
                twice.map_or(Ok(()), |axis| bail!("`{}` stands twice in rows and columns", axis.name()))
            })()
            .with_context(|| format!("[[table]] {:?}", table.name))?;
        }
        for plot in &self.plots {
            (|| {
                file_name(&plot.name)?;
                ensure!(
                    plot.x.is_number(),
                    "x is `{}`, expected `particles`, `iterations` or `evaluations`",
                    plot.x.name()
                );
                ensure!(!plot.lines.contains(&plot.x), "`{}` is both x and a line", plot.x.name());
                let names: Vec<String> = self.sequences.iter().map(SequenceSettings::name).collect();
                match &plot.sequence {
                    Some(name) if !names.contains(name) => {
                        let names: Vec<&str> = names.iter().map(String::as_str).collect();
                        bail!("there is no sequence `{name}`, {}", expected(name, &names))
                    }
                    _ => Ok(()),
                }
            })()
            .with_context(|| format!("[[plot]] {:?}", plot.name))?;
        }
        for shares in &self.shares {
            file_name(&shares.name).with_context(|| format!("[[shares]] {:?}", shares.name))?;
        }
        Ok(())
    }
}

fn check_spread(spread: f64) -> Result<()> {
    ensure!((0.01..=100.0).contains(&spread), "spread is {spread}, expected 0.01 to 100");
    Ok(())
}

/// Names that become files of one folder, some of which do not tell capitals apart.
fn own_names<'a>(what: &str, names: impl Iterator<Item = &'a String>) -> Result<()> {
    let mut seen = HashSet::new();
    for name in names {
        ensure!(seen.insert(name.to_lowercase()), "two {what} are named {name:?}, expected a name of its own for each");
    }
    Ok(())
}

/// Lists make a run for every entry, so each needs one, and none twice.
fn several<T: std::hash::Hash + Eq + std::fmt::Display>(key: &str, list: &[T]) -> Result<()> {
    ensure!(!list.is_empty(), "{key} is empty, expected at least one");
    let mut seen = HashSet::new();
    let twice = list.iter().find(|entry| !seen.insert(*entry));
    twice.map_or(Ok(()), |entry| bail!("{key} holds {entry} twice, expected each once"))
}

/// Names become names of files.
fn file_name(name: &str) -> Result<()> {
    let is_plain = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    ensure!(name.len() <= 100, "the name `{}` is {} bytes long, expected at most 100", shortened(name), name.len());
    ensure!(
        !name.is_empty() && name.chars().all(is_plain) && !name.starts_with('.'),
        "the name {name:?} cannot be part of a file's name, expected letters, digits, `-`, `_` and `.`"
    );
    Ok(())
}
