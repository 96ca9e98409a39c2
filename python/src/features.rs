//! What the tracker sees of a sequence, frame by frame.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use anyhow::Result;
use image::DynamicImage;
use pantin::observe::{Observer, check_background, feature_settings, with_plates};
use pantin::sequence::Sequence;
use pantin::track::FrameRange;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::picture;
use crate::raised;

/// The stages of a view, by their names.
type Stages = Vec<(&'static str, DynamicImage)>;

#[pyclass(frozen, module = "pantin._pantin")]
pub(crate) struct Features {
    observer: Mutex<Observer>,
    cameras: Vec<String>,
}

impl Features {
    fn open(path: &std::path::Path, frames: &str) -> Result<Self> {
        let sequence = Sequence::open_unfitted(path)?;
        let range: FrameRange = frames.parse()?;
        let range = range.within(sequence.frame_count, &sequence.path.display().to_string())?;
        let plated = with_plates(&sequence, &mut |_, _, _| {})?;
        let sequence = plated.sequence.as_ref();
        check_background(sequence, &range)?;
        let observer = Observer::new(sequence, feature_settings(sequence)?, range.clone(), range.start)?;
        let cameras = sequence.views.iter().map(|view| view.camera.clone()).collect();
        Ok(Self { observer: Mutex::new(observer), cameras })
    }

    /// The next frame and its views' stages.
    fn read(&self) -> Result<Option<(usize, Vec<Stages>)>> {
        let mut observer = self.observer.lock().unwrap_or_else(PoisonError::into_inner);
        while let Some(set) = observer.read()? {
            if let Some(features) = observer.features(&set, true)? {
                let views = set.pictures.iter().zip(&*features);
                return Ok(Some((set.index, views.map(|(input, features)| features.pictures(input)).collect())));
            }
        }
        Ok(None)
    }
}

#[pymethods]
impl Features {
    #[new]
    fn new(py: Python<'_>, sequence: PathBuf, frames: &str) -> PyResult<Self> {
        py.detach(|| Self::open(&sequence, frames)).map_err(raised)
    }

    fn next<'py>(&self, py: Python<'py>) -> PyResult<Option<(usize, Bound<'py, PyDict>)>> {
        let Some((frame, views)) = py.detach(|| self.read()).map_err(raised)? else { return Ok(None) };
        let all = PyDict::new(py);
        for (camera, stages) in self.cameras.iter().zip(views) {
            let dict = PyDict::new(py);
            for (stage, shown) in stages {
                dict.set_item(stage, picture(py, shown)?)?;
            }
            all.set_item(camera, dict)?;
        }
        Ok(Some((frame, all)))
    }
}
