//! NumPy arrays in and out.

use anyhow::{Result, ensure};
use image::DynamicImage;
use numpy::{IntoPyArray, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::raised;

/// The rows of a table of poses, checked to have one value a degree of freedom. Nothing is copied.
pub(crate) fn rows<'a>(poses: &'a PyReadonlyArray2<'_, f32>, dofs: usize) -> PyResult<&'a [f32]> {
    let check = || -> Result<&'a [f32]> {
        let [rows, columns] = [poses.as_array().nrows(), poses.as_array().ncols()];
        ensure!(
            columns == dofs,
            "poses are {rows} x {columns}, expected {dofs} columns, one a degree of freedom of the body"
        );
        Ok(poses.as_slice()?)
    };
    check().map_err(raised)
}

/// A pose, checked to have one value a degree of freedom.
pub(crate) fn pose<'a>(pose: &'a PyReadonlyArray1<'_, f32>, dofs: usize) -> PyResult<&'a [f32]> {
    let check = || -> Result<&'a [f32]> {
        let found = pose.as_array().len();
        ensure!(found == dofs, "the pose has {found} values, expected {dofs}, one a degree of freedom of the body");
        Ok(pose.as_slice()?)
    };
    check().map_err(raised)
}

/// A flat list of numbers as an array of this shape.
pub(crate) fn shaped<T: numpy::Element, D: numpy::ndarray::IntoDimension>(
    py: Python<'_>,
    values: Vec<T>,
    shape: D,
) -> PyResult<Py<PyAny>> {
    Ok(values.into_pyarray(py).reshape(shape)?.into_any().unbind())
}

/// A picture: uint8 or uint16, [h, w] of grey, [h, w, 3] of colours.
pub(crate) fn picture(py: Python<'_>, picture: DynamicImage) -> PyResult<Py<PyAny>> {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    match picture {
        DynamicImage::ImageLuma8(grey) => shaped(py, grey.into_raw(), [height, width]),
        DynamicImage::ImageLuma16(grey) => shaped(py, grey.into_raw(), [height, width]),
        DynamicImage::ImageRgb16(colours) => shaped(py, colours.into_raw(), [height, width, 3]),
        DynamicImage::ImageRgb8(colours) => shaped(py, colours.into_raw(), [height, width, 3]),
        other => shaped(py, other.into_rgb8().into_raw(), [height, width, 3]),
    }
}
