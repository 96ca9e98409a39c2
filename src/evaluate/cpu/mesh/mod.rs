//! The mesh model: vertices sixteen at a time, triangles by their rows into keys of depth and label, and the keys counted.

mod counting;
mod eight;
mod raster;
mod setup;
mod surface;
#[cfg(test)]
mod tests;
mod vertices;

use std::sync::{Arc, Mutex, PoisonError};

use anyhow::Result;

use crate::body::{Body, Mesh};
use crate::evaluate::besides::Besides;
use crate::evaluate::mesh_projection::MeshProjector;
use crate::evaluate::projection::Projector;
use crate::evaluate::raster::CandidateImage;
use crate::features::{Observation, PartClasses, Segments};
use crate::geometry::Camera;

use super::group::Sums;
use super::instruction_set::Code;
use super::simd::{Simd, Task};
use super::workers::Workers;
use counting::View;
use raster::Canvas;
use surface::{Seen, Surface};
use vertices::{Posed, Vertices};

/// A mesh, drawn and compared.
#[derive(Debug)]
pub(super) struct MeshModel {
    projector: MeshProjector,
    vertices: Vertices,
    surface: Surface,
    views: Vec<View>,
    /// The segment and the class of every label.
    numbers: [u8; 128],
    classes: [u8; 128],
    /// One a worker; the locks are never contended.
    scratch: Vec<Mutex<Scratch>>,
}

/// Working memory of one worker.
#[derive(Debug)]
struct Scratch {
    posed: Posed,
    seen: Seen,
    canvas: Canvas,
}

impl MeshModel {
    /// # Errors
    /// When the mesh is bound to another number of bones.
    pub(super) fn new(body: &Body, mesh: Mesh, cameras: &[Camera], workers: usize) -> Result<Self> {
        let projector = MeshProjector::new(body, mesh, cameras)?;
        let (vertices, surface) = (Vertices::new(&projector), Surface::new(projector.mesh()));
        let largest = [0, 1].map(|axis| cameras.iter().map(|camera| camera.size[axis] as usize).max().unwrap_or(0));
        let scratch = || {
            Mutex::new(Scratch {
                posed: Posed::new(&vertices, body.bones.len()),
                seen: vertices.seen(),
                canvas: Canvas::new(&surface, largest[0], largest[1]),
            })
        };
        let scratch = std::iter::repeat_with(scratch).take(workers).collect();
        let views = cameras.iter().map(|camera| View::new(camera.size)).collect();
        Ok(Self { projector, vertices, surface, views, numbers: [0; 128], classes: [0; 128], scratch })
    }

    pub(super) fn projector(&self) -> &Projector {
        &self.projector.projector
    }

    /// Takes observations, one a view, whose segments and classes are set; false when a worker panicked.
    pub(super) fn observe(&mut self, observations: &[Observation], workers: &mut Workers) -> bool {
        workers.each(self.views.iter_mut().zip(observations), |_, (view, observation)| view.fill(observation))
    }

    /// Compares by these segments from now on; none for whole silhouettes.
    pub(super) fn set_segments(&mut self, segments: Option<&Arc<Segments>>) {
        let number = |label: usize| segments.map_or(0, |segments| segments.number(label as u8));
        self.numbers = std::array::from_fn(number);
    }

    /// Weighs evidence by these classes from now on.
    pub(super) fn set_classes(&mut self, classes: Option<&Arc<PartClasses>>) {
        let class = |label: usize| classes.map_or(0, |classes| classes.of_label(label as u8));
        self.classes = std::array::from_fn(class);
    }

    /// Some candidates in every view, by one of the workers.
    pub(super) fn evaluate(&self, code: Code, worker: usize, poses: &[f32], besides: Besides, sums: &mut Sums) {
        let mut scratch = self.scratch[worker].lock().unwrap_or_else(PoisonError::into_inner);
        code.run(MeshTask { model: self, poses, scratch: &mut scratch, purpose: Purpose::Compare(besides, sums) });
    }

    /// One pose in one view, as it is drawn.
    pub(super) fn drawn(&self, code: Code, pose: &[f32], view: usize) -> CandidateImage {
        let mut scratch = self.scratch[0].lock().unwrap_or_else(PoisonError::into_inner);
        code.run(MeshTask { model: self, poses: pose, scratch: &mut scratch, purpose: Purpose::Draw(view) });
        let View { width, height, .. } = self.views[view];
        let mut bytes = vec![0; width as usize * height as usize];
        let ([left, top], rows) = scratch.canvas.region();
        for (drawn, bytes) in rows.zip(bytes.chunks_exact_mut(width as usize).skip(top)) {
            bytes[left..].iter_mut().zip(drawn).for_each(|(byte, key)| *byte = !*key as u8);
        }
        CandidateImage { width, height, bytes }
    }
}

impl Scratch {
    /// Draws what is posed into one view.
    #[inline(always)]
    fn draw<S: Simd>(&mut self, simd: S, model: &MeshModel, view: usize) {
        let camera = &model.projector.projector.cameras[view];
        let region = model.vertices.project(camera, &self.posed, &mut self.seen);
        self.canvas.draw(simd, &model.surface, &self.seen, region);
    }
}

/// What some poses are drawn for.
enum Purpose<'a> {
    /// To be compared in every view, and where what they give goes.
    Compare(Besides, &'a mut Sums),
    /// To be looked at, in one view.
    Draw(usize),
}

/// Some poses to draw: one piece of code for either purpose, since it is compiled for every instruction set.
struct MeshTask<'a> {
    model: &'a MeshModel,
    poses: &'a [f32],
    scratch: &'a mut Scratch,
    purpose: Purpose<'a>,
}

impl Task for MeshTask<'_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { model, poses, scratch, mut purpose } = self;
        let views = model.views.len();
        for (candidate, pose) in poses.chunks_exact(model.projector.projector.dof_count()).enumerate() {
            model.vertices.pose(&model.projector, pose, &mut scratch.posed);
            for (number, view) in model.views.iter().enumerate() {
                if matches!(purpose, Purpose::Draw(view) if view != number) {
                    continue;
                }
                scratch.draw(simd, model, number);
                let Purpose::Compare(besides, sums) = &mut purpose else { continue };
                let (image, canvas) = (candidate * views + number, &mut scratch.canvas);
                view.pass_over(canvas);
                sums.components[image] = view.compare(canvas);
                match *besides {
                    Besides::Nothing => (),
                    Besides::Segments | Besides::SegmentEdges => {
                        let segments = view.segment_areas.len();
                        let sums = &mut sums.segments[image * segments..][..segments];
                        view.compare_segments(canvas, &model.numbers, sums);
                        if *besides == Besides::SegmentEdges {
                            view.count_segment_edges(canvas, &model.numbers, sums);
                        }
                    }
                    Besides::Evidence => sums.evidence[image] = view.sum_evidence(canvas, &model.classes),
                }
            }
        }
    }
}
