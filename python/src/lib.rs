//! The native half of the Python package `pantin`. What users see, with its documentation, is the Python beside it: arrays come here as
//! contiguous ones of the right type, and options as names and values.

mod arrays;
mod body;
mod cameras;
mod evaluator;
mod features;
mod runs;
mod watch;

use pyo3::exceptions::PyException;
use pyo3::prelude::*;

pyo3::create_exception!(pantin, PantinError, PyException, "What pantin cannot do, in one sentence.");

/// An error of the engine as Python's, with the same sentence.
fn raised(error: anyhow::Error) -> PyErr {
    PantinError::new_err(format!("{error:#}"))
}

#[pymodule]
fn _pantin(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("PantinError", module.py().get_type::<PantinError>())?;
    module.add_class::<body::Body>()?;
    module.add_class::<cameras::Cameras>()?;
    module.add_class::<evaluator::Evaluator>()?;
    module.add_class::<features::Features>()?;
    runs::add_to(module)
}
