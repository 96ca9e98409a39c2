//! Poses in, components and fitness out.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result, ensure};
use numpy::{PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pantin::body::Model;
use pantin::evaluate::{self, Components, EdgeTerm, Objective, ObjectiveKind};
use pantin::features::Observation;
use pantin::files::Choice as _;
use pantin::sequence::Sequence;
use pantin::track::{Drawing, ObjectiveChoice, ScoredFrame};
use pyo3::prelude::*;

use crate::arrays::{pose, rows, shaped};
use crate::body::Body;
use crate::cameras::Cameras;
use crate::raised;

#[pyclass(frozen, module = "pantin._pantin")]
pub(crate) struct Evaluator {
    evaluator: Mutex<Box<dyn evaluate::Evaluator>>,
    views: usize,
    dofs: usize,
    reason: String,
    names: [&'static str; 2],
}

impl Evaluator {
    fn build(body: &pantin::body::Body, cameras: &[pantin::geometry::Camera], names: [&str; 2]) -> Result<Self> {
        let (backend, model) = (Drawing::named(names[0])?, Model::named(names[1])?);
        let mesh = model.mesh(body)?;
        let standing: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
        let built = backend.build(&[], mesh.as_ref(), body, cameras, &standing)?;
        let names = [built.evaluator.name(), built.evaluator.variant()];
        let (views, dofs) = (cameras.len(), body.dof_count());
        Ok(Self { evaluator: Mutex::new(built.evaluator), views, dofs, reason: built.reason, names })
    }

    fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut dyn evaluate::Evaluator) -> Result<T> + Send,
    ) -> PyResult<T> {
        py.detach(|| work(self.evaluator.lock().unwrap_or_else(PoisonError::into_inner).as_mut())).map_err(raised)
    }
}

/// An objective by its name, with its usual weights and edge term where none are given.
fn objective(name: &str, weights: [Option<f32>; 3], edges: Option<&str>) -> Result<Objective> {
    let [beta, w1, w2] = weights;
    let edges = edges.map(EdgeTerm::named).transpose()?;
    ObjectiveChoice { kind: Some(ObjectiveKind::named(name)?), beta, w1, w2, edges }.resolve(None, "")
}

#[pymethods]
impl Evaluator {
    #[new]
    fn new(py: Python<'_>, body: &Body, cameras: &Cameras, backend: &str, model: &str) -> PyResult<Self> {
        py.detach(|| Self::build(&body.0, &cameras.0, [backend, model])).map_err(raised)
    }

    /// The evaluator of a sequence's frame, which it has observed.
    #[staticmethod]
    fn of_frame(
        py: Python<'_>,
        sequence: PathBuf,
        frame: usize,
        backend: &str,
        model: &str,
        objective_name: &str,
    ) -> PyResult<Self> {
        py.detach(|| {
            let objective = objective(objective_name, [None; 3], None)?;
            let frame = ScoredFrame::of_sequence(&Sequence::open(&sequence)?, frame, &objective)?;
            let built = Self::build(&frame.body, &frame.cameras, [backend, model])?;
            built.evaluator.lock().unwrap_or_else(PoisonError::into_inner).observe(&frame.observations)?;
            Ok(built)
        })
        .map_err(raised)
    }

    #[getter]
    fn backend(&self) -> &str {
        self.names[0]
    }

    #[getter]
    fn variant(&self) -> &str {
        self.names[1]
    }

    #[getter]
    fn reason(&self) -> &str {
        &self.reason
    }

    #[getter]
    fn view_count(&self) -> usize {
        self.views
    }

    #[getter]
    fn dof_count(&self) -> usize {
        self.dofs
    }

    fn observe(&self, py: Python<'_>, observations: Vec<PyReadonlyArray2<'_, u8>>) -> PyResult<()> {
        let views = || -> Result<Vec<Observation>> {
            observations
                .iter()
                .map(|bytes| {
                    let (height, width) = (bytes.as_array().nrows(), bytes.as_array().ncols());
                    let mut observation = Observation::empty(u32::try_from(width)?, u32::try_from(height)?);
                    observation.bytes.copy_from_slice(bytes.as_slice()?);
                    Ok(observation)
                })
                .collect()
        };
        let views = views().map_err(raised)?;
        self.with(py, |evaluator| evaluator.observe(&views))
    }

    fn components<'py>(
        &self,
        py: Python<'py>,
        poses: PyReadonlyArray2<'py, f32>,
    ) -> PyResult<Bound<'py, PyArray3<u32>>> {
        let poses = rows(&poses, self.dofs)?;
        let result = PyArray3::zeros(py, [poses.len() / self.dofs, self.views, 5], false);
        let mut written = result.try_readwrite()?;
        let components: &mut [Components] = bytemuck::cast_slice_mut(written.as_slice_mut()?);
        self.with(py, |evaluator| evaluator.components(poses, components))?;
        drop(written);
        Ok(result)
    }

    fn fitness<'py>(
        &self,
        py: Python<'py>,
        poses: PyReadonlyArray2<'py, f32>,
        objective_name: &str,
        weights: [Option<f32>; 3],
        edges: Option<&str>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let objective = objective(objective_name, weights, edges).map_err(raised)?;
        let poses = rows(&poses, self.dofs)?;
        let result = PyArray1::zeros(py, [poses.len() / self.dofs], false);
        let mut written = result.try_readwrite()?;
        let fitness = written.as_slice_mut()?;
        self.with(py, |evaluator| {
            objective.check_segments(evaluator.segments().is_some())?;
            evaluator.fitness(poses, &objective, fitness)
        })?;
        drop(written);
        Ok(result)
    }

    /// One pose in one view as it is drawn; none where this backend keeps no picture.
    fn drawn(&self, py: Python<'_>, row: PyReadonlyArray1<'_, f32>, view: usize) -> PyResult<Option<Py<PyAny>>> {
        let row = pose(&row, self.dofs)?;
        let image = self.with(py, |evaluator| {
            ensure!(view < self.views, "there is no view {view}, expected 0 to {}", self.views.saturating_sub(1));
            evaluator.drawn(row, view).context("drawing a pose")
        })?;
        image.map(|image| shaped(py, image.bytes, [image.height as usize, image.width as usize])).transpose()
    }
}
