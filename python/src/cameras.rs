//! Calibrated cameras.

use std::path::PathBuf;

use anyhow::ensure;
use glam::DVec3;
use numpy::PyReadonlyArray2;
use pantin::geometry::Camera;
use pantin::sequence::{Sequence, parse_opencv_yaml, read_cameras, write_cameras_toml};
use pyo3::prelude::*;

use crate::arrays::shaped;
use crate::body::overwrite;
use crate::raised;

#[pyclass(frozen, module = "pantin._pantin")]
pub(crate) struct Cameras(pub(crate) Vec<Camera>);

#[pymethods]
impl Cameras {
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        Ok(Self(read_cameras(&path).map_err(raised)?))
    }

    #[staticmethod]
    fn of_sequence(path: PathBuf) -> PyResult<Self> {
        Ok(Self(Sequence::open_unfitted(&path).map_err(raised)?.cameras))
    }

    /// Cameras as texts in OpenCV's keys, one each.
    #[staticmethod]
    fn of_texts(texts: Vec<String>) -> PyResult<Self> {
        let cameras = texts.iter().map(|text| parse_opencv_yaml(text, "the arrays"));
        Ok(Self(cameras.collect::<anyhow::Result<Vec<_>>>().map_err(raised)?.concat()))
    }

    fn save(&self, path: PathBuf, force: bool) -> PyResult<()> {
        write_cameras_toml(&path, &self.0, overwrite(force)).map_err(raised)
    }

    #[getter]
    fn names(&self) -> Vec<String> {
        self.0.iter().map(|camera| camera.name.clone()).collect()
    }

    #[getter]
    fn sizes(&self) -> Vec<(u32, u32)> {
        self.0.iter().map(|camera| (camera.size[0], camera.size[1])).collect()
    }

    /// The cameras as if each took pictures of this size.
    fn scaled(&self, sizes: Vec<(u32, u32)>) -> PyResult<Self> {
        let check = || {
            let (found, expected) = (sizes.len(), self.0.len());
            ensure!(found == expected, "{found} sizes were given for {expected} cameras");
            for &(width, height) in &sizes {
                ensure!(width > 0 && height > 0, "a picture of {width} x {height} was asked for, expected pixels");
            }
            Ok(())
        };
        check().map_err(raised)?;
        Ok(Self(self.0.iter().zip(&sizes).map(|(camera, size)| camera.scaled([size.0, size.1])).collect()))
    }

    /// Where each camera sees points of the world, pixels; not a number where it has no image of one.
    fn project(&self, py: Python<'_>, points: PyReadonlyArray2<'_, f64>) -> PyResult<Py<PyAny>> {
        let points = points.as_array();
        let count = points.nrows();
        if points.ncols() != 3 {
            let columns = points.ncols();
            return Err(raised(anyhow::anyhow!("points are {count} x {columns}, expected 3 columns: x, y, z, mm")));
        }
        let mut pixels = Vec::with_capacity(2 * count * self.0.len());
        for camera in &self.0 {
            for point in points.rows() {
                let pixel = camera.project(DVec3::new(point[0], point[1], point[2]));
                pixels.extend(pixel.map_or([f64::NAN; 2], |pixel| pixel.to_array()));
            }
        }
        shaped(py, pixels, [self.0.len(), count, 2])
    }
}
