//! `run.toml`: what a run was made from, enough to run it again, and to refuse going on with another one.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};
use serde::{Serialize, Serializer};
use toml::{Table, Value};

use super::journal::checksum;
use super::plan::Plan;
use super::{Backend, FeaturesOn, Passes, RealtimeSettings, TrackSettings, Width};
use crate::body::{MeshSource, Model};
use crate::evaluate::device::GraphicsSettings;
use crate::evaluate::{EdgeTerm, Objective};
use crate::files::{Limit, OutputFolder, read_toml, table_of};
use crate::sequence::{Ignored, Sequence, Source, Turn, Video, View};

/// Its name in a track's folder.
pub(super) const NAME: &str = "run.toml";

/// What a run is made from, but for pictures and videos.
const INPUT: Limit = Limit { what: "an input", most: 2 << 30 };

/// Tables of `run.toml` that a run may only be gone on with when they are the same.
const DECISIVE: [&str; 2] = ["settings", "inputs"];

/// The record of a run.
pub(super) struct RunRecord {
    table: Table,
}

impl RunRecord {
    pub(super) fn new(sequence: &Sequence, settings: &TrackSettings, plan: &Plan) -> Result<Self> {
        let contents = Contents {
            run: Run::of(sequence, settings, plan),
            settings: Settings::of(sequence, settings, plan)?,
            inputs: Inputs::of(sequence, settings, plan)?,
            machine: Machine::of(plan),
        };
        Ok(Self { table: table_of(&contents).context("cannot write run.toml")? })
    }

    /// Writes it into the folder.
    pub(super) fn write(&self, output: &OutputFolder) -> Result<()> {
        let text = toml::to_string(&self.table).context("cannot write run.toml")?;
        output.write(NAME, |writer| Ok(writer.write_all(text.as_bytes())?))
    }

    /// Holds this run to the one whose record the folder has.
    ///
    /// # Errors
    /// When there is no record, or a setting or an input differs: it is named with both values.
    pub(super) fn check_same(&self, output: &OutputFolder) -> Result<()> {
        let path = output.path().join(NAME);
        if !path.exists() {
            bail!("{} holds no run to resume ({NAME} is missing): leave out --resume", output.path().display());
        }
        let old: Table = read_toml(&path)?;
        for name in DECISIVE {
            let empty = Table::new();
            let before = old.get(name).and_then(Value::as_table).unwrap_or(&empty);
            let now = self.table.get(name).and_then(Value::as_table).unwrap_or(&empty);
            let mut keys: Vec<&String> = before.keys().chain(now.keys()).collect();
            keys.sort();
            for key in keys {
                if before.get(key) != now.get(key) {
                    let shown = |value: Option<&Value>| value.map_or("absent".to_string(), Value::to_string);
                    bail!(
                        "{} was made with another {key}: {} there, {} now; resume with the same, or choose another folder",
                        path.display(),
                        shown(before.get(key)),
                        shown(now.get(key))
                    );
                }
            }
        }
        Ok(())
    }

    /// Names and values for people.
    pub(super) fn rows(&self) -> Vec<(String, String)> {
        let tables = self.table.values().filter_map(Value::as_table);
        tables.flatten().map(|(key, value)| (key.clone(), plain(value))).collect()
    }
}

/// The backend that the run in a folder was begun with; none where the folder holds no record, or one without it.
///
/// # Errors
/// When the record cannot be read or names an unknown backend.
pub(super) fn recorded_backend(output: &OutputFolder) -> Result<Option<Backend>> {
    let path = output.path().join(NAME);
    if !path.exists() {
        return Ok(None);
    }
    let table: Table = read_toml(&path)?;
    let name = table.get("settings").and_then(|settings| settings.get("backend")).and_then(Value::as_str);
    name.map(|name| Backend::from_name(name).with_context(|| path.display().to_string())).transpose()
}

fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_string)
}

/// What the file holds.
#[derive(Serialize)]
struct Contents<'a> {
    run: Run,
    settings: Settings<'a>,
    inputs: Inputs<'a>,
    machine: Machine<'a>,
}

#[derive(Serialize)]
struct Run {
    pantin: &'static str,
    sequence: String,
    start: String,
    command: String,
}

impl Run {
    fn of(sequence: &Sequence, settings: &TrackSettings, plan: &Plan) -> Self {
        let Objective { kind, beta, w1, w2, .. } = plan.objective;
        let search = &settings.search;
        let start = settings.start.as_ref().map(|start| format!(" --start '{}'", start.display())).unwrap_or_default();
        let command = format!(
            "pantin track '{}' -o DIR --frames {}..{} --search {} --particles {} --iterations {} --seed {} --spread {} \
             --refine {} --predict {}{}{}{} --recover {} --objective {} --beta {beta} --w1 {w1} --w2 {w2}{} --backend {}{} --model {} --overlay-every {}{}{start}{}{}{}",
            sequence.path.display(),
            plan.range.start,
            plan.range.end,
            search.kind.name(),
            search.particles,
            search.iterations,
            search.seed,
            settings.spread,
            search.refine,
            settings.prediction().name(),
            learnt_width(settings).map(|width| format!(" --width {width}")).unwrap_or_default(),
            more_passes(settings).map(|passes| format!(" --passes {passes}")).unwrap_or_default(),
            measured_again(settings, sequence),
            yes_or_no(settings.recover),
            kind.name(),
            edge_term(plan).map(|edges| format!(" --edges {edges}")).unwrap_or_default(),
            plan.backend.evaluator.name(),
            drawing_flags(settings),
            settings.model.name(),
            settings.overlay_every,
            if settings.labels { " --labels" } else { "" },
            settings.smooth.map(|cutoff| format!(" --smooth {cutoff}")).unwrap_or_default(),
            if settings.recording { " --rerun" } else { "" },
            settings.realtime.as_ref().map(|realtime| realtime.flags()).unwrap_or_default(),
        );
        Self {
            pantin: env!("CARGO_PKG_VERSION"),
            sequence: sequence.path.display().to_string(),
            start: plan.start_path.display().to_string(),
            command,
        }
    }
}

/// How wide the start is where that is not the body's steps, which runs had before there was a choice.
fn learnt_width(settings: &TrackSettings) -> Option<&'static str> {
    let width = settings.width();
    (width != Width::Steps).then(|| width.name())
}

/// How often the run goes over its frames where that is not once, as all did before there was a choice.
fn more_passes(settings: &TrackSettings) -> Option<&'static str> {
    let passes = settings.passes();
    (passes != Passes::Forward).then(|| passes.name())
}

/// Whether the person is measured again, as a command says it whatever a sequence that says so by itself would have.
fn measured_again(settings: &TrackSettings, sequence: &Sequence) -> &'static str {
    match (settings.measures_again(sequence), sequence.measure_again == Some(true)) {
        (true, _) => " --measure-again",
        (false, true) => " --measure-again=no",
        (false, false) => "",
    }
}

/// What the edge term is made of where that is not all edges together, as it was before there was a choice.
fn edge_term(plan: &Plan) -> Option<&'static str> {
    let edges = plan.objective.edges;
    (edges != EdgeTerm::Whole).then(|| edges.name())
}

/// Whether graphics draws in another way than the usual one, which runs had before there was a choice.
fn is_drawn_otherwise(settings: &TrackSettings) -> bool {
    settings.drawing.graphics != GraphicsSettings::default()
}

/// The devices and the way to draw as the command line takes them.
fn drawing_flags(settings: &TrackSettings) -> String {
    let mut flags = String::new();
    if settings.features_on == FeaturesOn::Device {
        flags += " --features device";
    }
    if !settings.devices.is_empty() {
        let devices: Vec<String> = settings.devices.iter().map(usize::to_string).collect();
        flags += &format!(" --devices {}", devices.join(","));
    }
    // What is as usual is left out: a mesh refuses most of it.
    let (found, usual) = (settings.drawing.graphics, GraphicsSettings::default());
    let ways = [
        ("packing", found.packing.name(), usual.packing.name()),
        ("gather", found.comparison.name(), usual.comparison.name()),
        ("projection", found.projection.name(), usual.projection.name()),
        ("coverage", found.coverage.name(), usual.coverage.name()),
        ("primitives", found.primitives.name(), usual.primitives.name()),
    ];
    ways.iter()
        .filter(|(_, name, usual)| name != usual)
        .for_each(|(flag, name, _)| flags += &format!(" --{flag} {name}"));
    flags
}

#[derive(Serialize)]
struct Settings<'a> {
    frames: String,
    search: &'static str,
    particles: usize,
    iterations: usize,
    #[serde(serialize_with = "whole")]
    seed: u64,
    spread: f64,
    refine: usize,
    predict: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    width: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    passes: Option<&'static str>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    measure_again: bool,
    recover: &'static str,
    #[serde(flatten)]
    constants: Table,
    objective: &'static str,
    beta: f32,
    w1: f32,
    w2: f32,
    #[serde(skip_serializing_if = "Option::is_none")]
    edges: Option<&'static str>,
    backend: &'static str,
    /// How graphics draws, where that is not as usual.
    #[serde(skip_serializing_if = "Option::is_none")]
    graphics: Option<&'static str>,
    model: &'static str,
    overlay_every: usize,
    /// Cut-off, Hz.
    #[serde(skip_serializing_if = "Option::is_none")]
    smooth: Option<f64>,
    #[serde(flatten)]
    realtime: Option<Realtime>,
    features: Cow<'a, Table>,
}

#[derive(Serialize)]
struct Realtime {
    rate: f64,
    r#loop: String,
    deadline: String,
    delay: usize,
}

impl<'a> Settings<'a> {
    fn of(sequence: &'a Sequence, settings: &TrackSettings, plan: &Plan) -> Result<Self> {
        let search = &settings.search;
        let Objective { kind, beta, w1, w2, .. } = plan.objective;
        let realtime = |realtime: &RealtimeSettings| Realtime {
            rate: realtime.rate,
            r#loop: realtime.repeat.to_string(),
            deadline: realtime.deadline.map_or_else(|| "none".to_string(), |time| format!("{time:?}")),
            delay: realtime.delay,
        };
        Ok(Self {
            frames: format!("{}..{}", plan.range.start, plan.range.end),
            search: search.kind.name(),
            particles: search.particles,
            iterations: search.iterations,
            seed: search.seed,
            spread: settings.spread,
            refine: search.refine,
            predict: settings.prediction().name(),
            width: learnt_width(settings),
            passes: more_passes(settings),
            measure_again: settings.measures_again(sequence),
            recover: yes_or_no(settings.recover),
            constants: search.constants()?,
            objective: kind.name(),
            beta,
            w1,
            w2,
            edges: edge_term(plan),
            backend: plan.backend.evaluator.name(),
            graphics: is_drawn_otherwise(settings).then(|| settings.drawing.graphics.name()),
            model: settings.model.name(),
            overlay_every: settings.overlay_every,
            smooth: settings.smooth,
            realtime: settings.realtime.as_ref().map(realtime),
            features: sequence.features.as_ref().map_or_else(Cow::default, Cow::Borrowed),
        })
    }
}

/// What the run reads: small inputs by a checksum of what they hold, pictures by where they are and how large.
#[derive(Serialize)]
struct Inputs<'a> {
    name: &'a str,
    fps: f64,
    scale: f64,
    frame_count: usize,
    body: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    mesh: Option<String>,
    start_pose: String,
    cameras: String,
    #[serde(flatten)]
    views: BTreeMap<String, Vec<String>>,
}

impl<'a> Inputs<'a> {
    fn of(sequence: &'a Sequence, settings: &TrackSettings, plan: &Plan) -> Result<Self> {
        let mesh = match (settings.model, &plan.body.mesh) {
            (Model::Mesh, Some(MeshSource::Skinned { file, .. })) => Some(sum_of(file)?),
            _ => None,
        };
        let mut views = BTreeMap::new();
        for view in &sequence.views {
            let mut files = vec![described(&view.source)?];
            files.extend(view.background.as_deref().map(sum_of).transpose()?);
            files.extend(view.mask.as_ref().map(|(mask, _)| described(mask)).transpose()?);
            if let Some((first, count)) = view.ignored.as_ref().map(Ignored::first) {
                files.push(count.map_or_else(|| sum_of(&first), |count| described_pictures(&first, count))?);
            }
            files.extend(changed(view));
            views.insert(format!("view {}", view.camera), files);
        }
        Ok(Self {
            name: &sequence.name,
            fps: sequence.fps,
            scale: sequence.scale,
            frame_count: sequence.frame_count,
            body: sum_of(&sequence.body)?,
            mesh,
            start_pose: sum(bytemuck::cast_slice(&plan.start)),
            // The shortest text of every number, so equal exactly where the cameras are.
            cameras: sum(format!("{:?}", sequence.cameras).as_bytes()),
            views,
        })
    }
}

/// A source by its name and size, which tell a replaced one without reading it.
fn described(source: &Source) -> Result<String> {
    match source {
        Source::Live(live) => Ok(live.address.clone()),
        Source::Video(Video { path, .. }) => {
            let size = fs::metadata(path).with_context(|| format!("cannot read {}", path.display()))?.len();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            Ok(format!("{name}, {size} bytes"))
        }
        Source::Pictures(pattern) => described_pictures(&pattern.file(0), pattern.frame_count()),
    }
}

/// What is made of a view's pictures before they are frames, where it is something: which they are, and how they are turned.
fn changed(view: &View) -> Vec<String> {
    let turn = view.source.turn();
    let turned = (turn != Turn::None).then(|| turn.said().to_string());
    let picked = view.picks.as_deref().map(|picks| {
        let bytes: Vec<u8> = picks.iter().flat_map(|pick| pick.to_le_bytes()).collect();
        format!("pictures {} and on for frames, {}", picks.first().copied().unwrap_or(0), sum(&bytes))
    });
    turned.into_iter().chain(picked).collect()
}

/// Numbered pictures by the name of the first and their number.
fn described_pictures(first: &Path, count: usize) -> Result<String> {
    let name = first.file_name().ok_or_else(|| anyhow!("{} names no file", first.display()))?.to_string_lossy();
    Ok(format!("{name} and on, {count} pictures"))
}

#[derive(Serialize)]
struct Machine<'a> {
    os: &'static str,
    architecture: &'static str,
    processors: usize,
    variant: &'static str,
    backend_reason: &'a str,
    /// Who made the features: the same bits either way.
    features_made_by: &'static str,
}

impl<'a> Machine<'a> {
    fn of(plan: &'a Plan) -> Self {
        Self {
            os: std::env::consts::OS,
            architecture: std::env::consts::ARCH,
            processors: std::thread::available_parallelism().map_or(1, usize::from),
            variant: plan.backend.evaluator.variant(),
            backend_reason: &plan.backend.reason,
            features_made_by: if plan.made.device.is_some() { "device" } else { "cpu" },
        }
    }
}

fn sum(bytes: &[u8]) -> String {
    format!("{:016x} ({} bytes)", checksum(bytes), bytes.len())
}

fn sum_of(file: &Path) -> Result<String> {
    Ok(sum(&INPUT.read(file)?))
}

fn yes_or_no(value: bool) -> &'static str {
    if value { "yes" } else { "no" }
}

/// TOML's integers end at 2^63; a larger one is kept as text.
fn whole<S: Serializer>(value: &u64, serializer: S) -> Result<S::Ok, S::Error> {
    match i64::try_from(*value) {
        Ok(value) => serializer.serialize_i64(value),
        Err(_) => serializer.collect_str(value),
    }
}
