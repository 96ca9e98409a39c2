//! A body: its degrees of freedom, its joints in space, tables of its poses.

use std::path::PathBuf;

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pantin::body::{self, PoseTable};
use pantin::files::Overwrite;
use pyo3::prelude::*;

use crate::arrays::{rows, shaped};
use crate::raised;

#[pyclass(frozen, module = "pantin._pantin")]
pub(crate) struct Body(pub(crate) body::Body);

pub(crate) fn overwrite(force: bool) -> Overwrite {
    if force { Overwrite::Replace } else { Overwrite::Refuse }
}

#[pymethods]
impl Body {
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        Ok(Self(body::Body::load(&path).map_err(raised)?))
    }

    #[staticmethod]
    fn adult(height: f64) -> PyResult<Self> {
        Ok(Self(body::Body::adult(height).map_err(raised)?))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    #[getter]
    fn dofs(&self) -> Vec<String> {
        self.0.dof_names()
    }

    #[getter]
    fn joints(&self) -> Vec<String> {
        self.0.joint_names()
    }

    fn limits(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let limits: Vec<f64> = self.0.dofs().flat_map(|(_, dof)| dof.limits).collect();
        shaped(py, limits, [self.0.dof_count(), 2])
    }

    fn steps(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        shaped(py, self.0.dofs().map(|(_, dof)| dof.step).collect::<Vec<f64>>(), [self.0.dof_count()])
    }

    fn standing_pose(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        shaped(py, self.0.standing_pose().iter().map(|value| *value as f32).collect::<Vec<f32>>(), [self.0.dof_count()])
    }

    fn joint_positions(&self, py: Python<'_>, poses: PyReadonlyArray2<'_, f32>) -> PyResult<Py<PyAny>> {
        let dofs = self.0.dof_count();
        let mut positions = Vec::new();
        let rows = rows(&poses, dofs)?;
        for row in rows.chunks_exact(dofs.max(1)) {
            let pose: Vec<f64> = row.iter().map(|value| f64::from(*value)).collect();
            let world = self.0.world_from_bones(&pose).map_err(raised)?;
            positions.extend(self.0.joint_positions(&world).iter().flat_map(|position| position.to_array()));
        }
        shaped(py, positions, [rows.len() / dofs.max(1), self.0.joint_names().len(), 3])
    }

    fn to_toml(&self) -> String {
        self.0.to_toml()
    }

    fn save(&self, path: PathBuf, force: bool) -> PyResult<()> {
        self.0.save(&path, overwrite(force)).map_err(raised)
    }

    /// Frames and poses of a poses.csv.
    fn read_poses(&self, py: Python<'_>, path: PathBuf) -> PyResult<(Py<PyAny>, Py<PyAny>)> {
        let table = PoseTable::read(&path, &self.0).map_err(raised)?;
        let frames: Vec<i64> = table.frames.iter().map(|frame| *frame as i64).collect();
        let poses: Vec<f32> = table.poses.iter().flatten().map(|value| *value as f32).collect();
        let count = frames.len();
        Ok((shaped(py, frames, [count])?, shaped(py, poses, [count, self.0.dof_count()])?))
    }

    fn write_poses(
        &self,
        path: PathBuf,
        frames: PyReadonlyArray1<'_, u64>,
        poses: PyReadonlyArray2<'_, f32>,
        force: bool,
    ) -> PyResult<()> {
        let dofs = self.0.dof_count();
        let rows = rows(&poses, dofs)?.chunks_exact(dofs.max(1));
        let table = PoseTable {
            frames: frames.as_array().iter().map(|frame| *frame as usize).collect(),
            poses: rows.map(|row| row.iter().map(|value| f64::from(*value)).collect()).collect(),
        };
        if table.frames.len() != table.poses.len() {
            let (frames, poses) = (table.frames.len(), table.poses.len());
            return Err(raised(anyhow::anyhow!("{frames} frames were given for {poses} poses, expected one a pose")));
        }
        table.write(&path, overwrite(force), &self.0).map_err(raised)
    }
}
