//! The flat model: its parts, the planes that it is compared with, and the room of every worker.

use std::sync::{Arc, Mutex, PoisonError};

use anyhow::Result;

use crate::body::Body;
use crate::evaluate::besides::Besides;
use crate::evaluate::projection::Projector;
use crate::features::{Observation, PartClasses, Segments};
use crate::geometry::Camera;

use super::front::{Front, QuadChunk};
use super::group::{FlatGroup, Scratch, Sums};
use super::instruction_set::Code;
use super::kernel::Canvas;
use super::planes::Planes;
use super::workers::Workers;

/// The flat model of a body, drawn and compared.
#[derive(Debug)]
pub(super) struct FlatModel {
    pub(super) projector: Projector,
    planes: Vec<Planes>,
    /// One a worker; the locks are never contended.
    scratch: Vec<Mutex<Scratch>>,
    /// Labels of the parts in the body's order.
    labels: Vec<u8>,
}

impl FlatModel {
    pub(super) fn new(body: &Body, cameras: &[Camera], workers: usize) -> Self {
        let projector = Projector::new(body, cameras);
        let planes: Vec<Planes> = cameras.iter().map(|camera| Planes::new(camera.size[0], camera.size[1])).collect();
        let most_cells = planes.iter().map(Planes::canvas_cells).max().unwrap_or(0);
        let scratch = || {
            let front = Front::new(&projector.rig);
            let chunks = front.chunk_count();
            Mutex::new(Scratch {
                front,
                quads: vec![QuadChunk::default(); chunks],
                canvas: Canvas::new(chunks, most_cells, Vec::new()),
                segmented: None,
            })
        };
        let scratch = std::iter::repeat_with(scratch).take(workers).collect();
        let labels = body.parts.iter().map(|part| part.label).collect();
        Self { projector, planes, scratch, labels }
    }

    /// Exchanges the body for another one of as many degrees of freedom and parts; segments and classes have to be set anew.
    ///
    /// # Errors
    /// When their numbers differ.
    pub(super) fn set_body(&mut self, body: &Body) -> Result<()> {
        self.projector.set_body(body)?;
        for scratch in &mut self.scratch {
            scratch.get_mut().unwrap_or_else(PoisonError::into_inner).front = Front::new(&self.projector.rig);
        }
        self.labels = body.parts.iter().map(|part| part.label).collect();
        Ok(())
    }

    /// Takes observations, one a view, whose segments and classes are set; false when a worker panicked.
    pub(super) fn observe(&mut self, observations: &[Observation], workers: &mut Workers) -> bool {
        workers.each(self.planes.iter_mut().zip(observations), |_, (planes, observation)| planes.fill(observation))
    }

    /// Compares by these segments from now on; none for whole silhouettes.
    pub(super) fn set_segments(&mut self, segments: Option<&Arc<Segments>>) {
        let of_part = |segments: &Arc<Segments>| self.labels.iter().map(|&label| segments.number(label)).collect();
        let numbers: Option<Vec<u8>> = segments.map(of_part);
        let cells = self.planes.iter().map(Planes::canvas_cells).max().unwrap_or(0);
        for scratch in &mut self.scratch {
            let scratch = scratch.get_mut().unwrap_or_else(PoisonError::into_inner);
            let chunks = scratch.quads.len();
            scratch.segmented = numbers.clone().map(|numbers| Canvas::new(chunks, cells, numbers));
        }
    }

    /// Weighs evidence by these classes from now on.
    pub(super) fn set_classes(&mut self, classes: Option<&Arc<PartClasses>>) {
        let of_part = |classes: &Arc<PartClasses>| self.labels.iter().map(|&label| classes.of_label(label)).collect();
        let numbers: Vec<u8> = classes.map(of_part).unwrap_or_default();
        for scratch in &mut self.scratch {
            let scratch = scratch.get_mut().unwrap_or_else(PoisonError::into_inner);
            scratch.canvas.set_classes(numbers.clone());
        }
    }

    /// Up to sixteen candidates in every view, by one of the workers.
    pub(super) fn evaluate(&self, code: Code, worker: usize, poses: &[f32], besides: Besides, sums: &mut Sums) {
        let mut scratch = self.scratch[worker].lock().unwrap_or_else(PoisonError::into_inner);
        let (projector, planes) = (&self.projector, &self.planes);
        code.run(FlatGroup { projector, planes, poses, besides, scratch: &mut scratch, sums });
    }
}
