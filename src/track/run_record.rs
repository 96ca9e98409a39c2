//! `run.toml`: what a run was made from, enough to run it again, and to refuse going on with another one.

use std::fs;

use anyhow::{Context, Result, anyhow, bail};
use toml::{Table, Value};

use super::journal::checksum;
use super::plan::Plan;
use super::{Backend, TrackSettings};
use crate::body::{MeshSource, Model};
use crate::evaluate::Objective;
use crate::files::{OutputFolder, read_toml};
use crate::search::SearchKind;
use crate::sequence::{Sequence, Source};

/// Its name in a track's folder.
pub(super) const NAME: &str = "run.toml";

/// Tables of `run.toml` that a run may only be gone on with when they are the same.
const DECISIVE: [&str; 2] = ["settings", "inputs"];

/// The record of a run.
pub(super) struct RunRecord {
    table: Table,
}

impl RunRecord {
    pub(super) fn new(sequence: &Sequence, settings: &TrackSettings, plan: &Plan) -> Result<Self> {
        let mut table = Table::new();
        table.insert("run".into(), Value::Table(run(sequence, settings, plan)));
        table.insert("settings".into(), Value::Table(settings_table(sequence, settings, plan)));
        table.insert("inputs".into(), Value::Table(inputs(sequence, settings, plan)?));
        table.insert("machine".into(), Value::Table(machine(plan)));
        Ok(Self { table })
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

fn run(sequence: &Sequence, settings: &TrackSettings, plan: &Plan) -> Table {
    let Objective { kind, beta, w1, w2 } = plan.objective;
    let search = &settings.search;
    let start = settings.start.as_ref().map(|start| format!(" --start '{}'", start.display())).unwrap_or_default();
    let command = format!(
        "pantin track '{}' -o DIR --frames {}..{} --search {} --particles {} --iterations {} --seed {} --spread {} \
         --refine {} --predict {} --recover {} --objective {} --beta {beta} --w1 {w1} --w2 {w2} --backend {} --model {} --overlay-every {}{start}{}{}",
        sequence.path.display(),
        plan.range.start,
        plan.range.end,
        search.kind.name(),
        search.particles,
        search.iterations,
        search.seed,
        settings.spread,
        search.refine,
        settings.predict.name(),
        yes_or_no(settings.recover),
        kind.name(),
        plan.backend.evaluator.name(),
        settings.model.name(),
        settings.overlay_every,
        if settings.recording { " --rerun" } else { "" },
        settings.realtime.as_ref().map(|realtime| realtime.flags()).unwrap_or_default(),
    );
    Table::from_iter([
        ("pantin".to_string(), Value::from(env!("CARGO_PKG_VERSION"))),
        ("sequence".to_string(), Value::from(sequence.path.display().to_string())),
        ("start".to_string(), Value::from(plan.start_path.display().to_string())),
        ("command".to_string(), Value::from(command)),
    ])
}

fn settings_table(sequence: &Sequence, settings: &TrackSettings, plan: &Plan) -> Table {
    let search = &settings.search;
    let Objective { kind, beta, w1, w2 } = plan.objective;
    let mut table = Table::new();
    let mut put = |name: &str, value: Value| table.insert(name.to_string(), value);
    put("frames", Value::from(format!("{}..{}", plan.range.start, plan.range.end)));
    put("search", Value::from(search.kind.name()));
    put("particles", integer(search.particles as u64));
    put("iterations", integer(search.iterations as u64));
    put("seed", integer(search.seed));
    put("spread", Value::from(settings.spread));
    put("refine", integer(search.refine as u64));
    put("predict", Value::from(settings.predict.name()));
    put("recover", Value::from(yes_or_no(settings.recover)));
    match search.kind {
        SearchKind::ParticleFilter => {
            put("sigma", single(search.filter.sigma));
        }
        SearchKind::Annealed => {
            put("survival", single(search.annealing.survival));
            put("last_noise", single(search.annealing.last_noise));
        }
        SearchKind::CmaEs => {
            put("first_sigma", single(search.cma.sigma));
            put("generation", integer(search.cma.generation as u64));
        }
        SearchKind::Pso | SearchKind::Hierarchical => {
            put("inertia", Value::from(search.pso.inertia.map(single).to_vec()));
            put("cognitive", single(search.pso.cognitive));
            put("social", single(search.pso.social));
        }
    }
    if search.kind == SearchKind::Hierarchical {
        put("joint_share", single(search.hierarchy.joint_share));
        put("joint_spread", single(search.hierarchy.joint_spread));
    }
    put("objective", Value::from(kind.name()));
    put("beta", single(beta));
    put("w1", single(w1));
    put("w2", single(w2));
    put("backend", Value::from(plan.backend.evaluator.name()));
    put("model", Value::from(settings.model.name()));
    put("overlay_every", integer(settings.overlay_every as u64));
    if let Some(realtime) = &settings.realtime {
        put("rate", Value::from(realtime.rate));
        put("loop", Value::from(realtime.repeat.to_string()));
        put("deadline", Value::from(realtime.deadline.map_or_else(|| "none".to_string(), |time| format!("{time:?}"))));
    }
    put("features", Value::Table(sequence.features.clone().unwrap_or_default()));
    table
}

/// What the run reads: small inputs by a checksum of what they hold, pictures by where they are and how large.
fn inputs(sequence: &Sequence, settings: &TrackSettings, plan: &Plan) -> Result<Table> {
    let mut table = Table::new();
    let mut put = |name: &str, value: Value| table.insert(name.to_string(), value);
    put("name", Value::from(sequence.name.clone()));
    put("fps", Value::from(sequence.fps));
    put("scale", Value::from(sequence.scale));
    put("frame_count", integer(sequence.frame_count as u64));
    let body = fs::read(&sequence.body).with_context(|| format!("cannot read {}", sequence.body.display()))?;
    put("body", sum(&body));
    if let (Model::Mesh, Some(MeshSource::Skinned { file, .. })) = (settings.model, &plan.body.mesh) {
        let mesh = fs::read(file).with_context(|| format!("cannot read {}", file.display()))?;
        put("mesh", sum(&mesh));
    }
    put("start_pose", sum(bytemuck::cast_slice(&plan.start)));
    // The shortest text of every number, so equal exactly where the cameras are.
    put("cameras", sum(format!("{:?}", sequence.cameras).as_bytes()));
    for view in &sequence.views {
        let mut files = vec![described(&view.source)?];
        if let Some(background) = &view.background {
            let plate = fs::read(background).with_context(|| format!("cannot read {}", background.display()))?;
            files.push(plain(&sum(&plate)));
        }
        if let Some((mask, _)) = &view.mask {
            files.push(described(mask)?);
        }
        put(&format!("view {}", view.camera), Value::from(files));
    }
    Ok(table)
}

/// A source by its name and size, which tell a replaced one without reading it.
fn described(source: &Source) -> Result<String> {
    match source {
        Source::Live(live) => Ok(live.address.clone()),
        Source::Video(path) => {
            let size = fs::metadata(path).with_context(|| format!("cannot read {}", path.display()))?.len();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            Ok(format!("{name}, {size} bytes"))
        }
        Source::Pictures(pattern) => {
            let first = pattern.file(0);
            let name = first.file_name().ok_or_else(|| anyhow!("{} names no file", first.display()))?.to_string_lossy();
            Ok(format!("{name} and on, {} pictures", pattern.frame_count()))
        }
    }
}

fn machine(plan: &Plan) -> Table {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    Table::from_iter([
        ("os".to_string(), Value::from(std::env::consts::OS)),
        ("architecture".to_string(), Value::from(std::env::consts::ARCH)),
        ("processors".to_string(), integer(processors as u64)),
        ("variant".to_string(), Value::from(plan.backend.evaluator.variant())),
        ("backend_reason".to_string(), Value::from(plan.backend.reason.clone())),
    ])
}

fn sum(bytes: &[u8]) -> Value {
    Value::from(format!("{:016x} ({} bytes)", checksum(bytes), bytes.len()))
}

fn yes_or_no(value: bool) -> &'static str {
    if value { "yes" } else { "no" }
}

/// TOML's integers end at 2^63; a larger one is kept as text.
fn integer(value: u64) -> Value {
    i64::try_from(value).map_or_else(|_| Value::from(value.to_string()), Value::from)
}

/// The shortest decimal of a single-precision number.
fn single(value: f32) -> Value {
    Value::from(value.to_string().parse::<f64>().unwrap_or(f64::from(value)))
}
