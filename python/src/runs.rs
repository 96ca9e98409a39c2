//! The commands as functions: options by name, as the command line has them.

use std::path::PathBuf;

use anyhow::{Result, bail};
use pantin::command::call::{self, OptionValue};
use pantin::track::{FrameDone, Progress, RunStart, TrackSummary};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{picture, shaped};
use crate::raised;
use crate::watch::{BrokenOff, Step, Watch, watched};

pub(crate) fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(track, module)?)?;
    module.add_function(wrap_pyfunction!(fit, module)?)?;
    module.add_function(wrap_pyfunction!(check, module)?)?;
    module.add_function(wrap_pyfunction!(synth, module)?)?;
    module.add_function(wrap_pyfunction!(texture, module)?)
}

/// An option as Python hands it over.
#[derive(FromPyObject)]
enum Given {
    Switch(bool),
    Text(String),
    List(Vec<String>),
}

fn options(given: Vec<(String, Given)>) -> Vec<(String, OptionValue)> {
    let value = |given| match given {
        Given::Switch(is_on) => OptionValue::Switch(is_on),
        Given::Text(text) => OptionValue::Text(text),
        Given::List(texts) => OptionValue::List(texts),
    };
    given.into_iter().map(|(key, given)| (key, value(given))).collect()
}

/// Tracking's progress, told as it comes.
struct Watcher {
    watch: Watch,
    total: Option<usize>,
}

impl Progress for Watcher {
    fn start(&mut self, run: &RunStart) {
        self.total = run.frames;
        self.watch.tell(Step { done: run.done, total: self.total, stage: "begin", frame: None });
    }

    fn frame(&mut self, frame: &FrameDone) {
        let told = Some((frame.frame, frame.fitness, frame.confidence));
        self.watch.tell(Step { done: frame.done, total: self.total, stage: "frames", frame: told });
    }

    fn looked_back(&mut self, done: usize) {
        self.watch.tell(Step { done, total: self.total, stage: "second pass", frame: None });
    }

    fn should_stop(&self) -> bool {
        self.watch.should_stop()
    }
}

/// Folder and summary of every person.
#[pyfunction]
fn track<'py>(
    py: Python<'py>,
    given: Vec<(String, Given)>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Vec<(PathBuf, Bound<'py, PyDict>)>> {
    let options = options(given);
    let tracked = watched(py, progress, BrokenOff::Stops, move |watch| {
        call::track(&options, &mut Watcher { watch: watch.clone(), total: None })
    })?;
    tracked.iter().map(|(folder, summary)| Ok((folder.clone(), summary_of(py, summary)?))).collect()
}

fn summary_of<'py>(py: Python<'py>, summary: &TrackSummary) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("backend", summary.backend.join(" "))?;
    dict.set_item("first_frame", summary.first_frame)?;
    dict.set_item("frames", summary.frames.len())?;
    dict.set_item("frames_per_second", summary.frames_per_second)?;
    dict.set_item("mean_fitness", summary.mean_fitness)?;
    dict.set_item("mean_confidence", summary.mean_confidence)?;
    dict.set_item("mean_error", summary.error.as_ref().map(|error| error.error.mean))?;
    dict.set_item("std_error", summary.error.as_ref().map(|error| error.error.std))?;
    let stages = PyDict::new(py);
    for timing in &summary.timings {
        stages.set_item(&timing.name, timing.mean())?;
    }
    dict.set_item("stage_ms", stages)?;
    dict.set_item("warnings", &summary.warnings)?;
    Ok(dict)
}

/// Body as TOML, height, poses with their frames, fitness, coverage a view: seen and drawn, first and fitted.
#[pyfunction]
fn fit<'py>(py: Python<'py>, given: Vec<(String, Given)>) -> PyResult<Bound<'py, PyDict>> {
    let options = options(given);
    let fit = watched(py, None, BrokenOff::IsLeft, move |_| call::fit(&options))?;
    let dict = PyDict::new(py);
    dict.set_item("height", fit.height)?;
    dict.set_item("fitness", fit.fitness)?;
    let frames: Vec<i64> = fit.poses.frames.iter().map(|frame| *frame as i64).collect();
    let count = frames.len();
    dict.set_item("frames", shaped(py, frames, [count])?)?;
    let poses: Vec<f32> = fit.poses.poses.iter().flatten().map(|value| *value as f32).collect();
    dict.set_item("poses", shaped(py, poses, [count, fit.body.dof_count()])?)?;
    let coverage = PyDict::new(py);
    let [before, after] = &fit.coverage;
    for ((view, before), after) in fit.views.iter().zip(before).zip(after) {
        coverage.set_item(view, ((before.seen, before.drawn), (after.seen, after.drawn)))?;
    }
    dict.set_item("coverage", coverage)?;
    let body = Py::new(py, crate::body::Body(fit.body))?;
    dict.set_item("body", body)?;
    Ok(dict)
}

/// The report as JSON.
#[pyfunction]
fn check(py: Python<'_>, given: Vec<(String, Given)>) -> PyResult<String> {
    let options = options(given);
    let report = watched(py, None, BrokenOff::IsLeft, move |_| call::check(&options))?;
    serde_json::to_string(&report).map_err(|error| raised(error.into()))
}

/// The folder that was made.
#[pyfunction]
fn synth(py: Python<'_>, given: Vec<(String, Given)>, progress: Option<&Bound<'_, PyAny>>) -> PyResult<PathBuf> {
    let options = options(given);
    watched(py, progress, BrokenOff::Stops, move |watch| {
        let steps = std::sync::Mutex::new(watch.clone());
        call::synth(&options, &|done, total| -> Result<()> {
            let watch = steps.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            watch.tell(Step { done, total: Some(total), stage: "frames", frame: None });
            if watch.should_stop() {
                bail!("broken off");
            }
            Ok(())
        })
    })
}

#[pyfunction]
fn texture(py: Python<'_>, given: Vec<(String, Given)>) -> PyResult<Py<PyAny>> {
    let options = options(given);
    picture(py, watched(py, None, BrokenOff::IsLeft, move |_| call::texture(&options))?)
}
