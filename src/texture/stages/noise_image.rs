//! Sums of octaves of noise drawn into a picture: a triangle over all of it, whose fragments have the values of
//! [`crate::texture::noise`].

use anyhow::{Result, ensure};

use super::generated::{noise_image_frag, noise_image_vert};
use super::request::{NoiseRequest, Requested};
use crate::gpu::{
    Blend, Buffer, Clear, Device, Draw, Drawing, Format, Image, Pipeline, Recorder, Stage, Target, Topology, Viewport,
};

/// The stage for one request, with the request's octaves and tables on the device.
#[derive(Debug)]
pub struct NoiseImageStage {
    pipeline: Pipeline,
    requested: Requested,
}

impl NoiseImageStage {
    /// Its name in timings.
    pub const NAME: &'static str = "noise image";

    /// Compiles it.
    ///
    /// # Errors
    /// When there are not 1 to 4 dimensions, the octaves make no sense, or the device has no memory.
    pub fn new(device: &Device, request: &NoiseRequest<'_>) -> Result<Self> {
        let requested = request.upload(device)?;
        let stages = [
            Stage { shader: &noise_image_vert::SHADER, constants: &[] },
            Stage { shader: &noise_image_frag::SHADER, constants: &requested.constants },
        ];
        let drawing = Drawing {
            topology: Topology::Triangles,
            colour: Some(Format::R32Float),
            depth_test: false,
            depth_write: false,
            depth_bias: None,
            cull_clockwise: false,
            blend: Blend::Replace,
            channels: 1,
        };
        Ok(Self { pipeline: device.graphics_pipeline(Self::NAME, &stages, &drawing)?, requested })
    }

    /// Records it: `points`, one a pixel row by row (four coordinates each, the first `dimensions` count), to a picture of
    /// [`Format::R32Float`].
    ///
    /// # Errors
    /// When the picture is of another format, or there are fewer points than pixels.
    pub fn record(&self, recorder: &mut Recorder, points: &Buffer, picture: &Image) -> Result<()> {
        let [width, height] = picture.size();
        ensure!(
            picture.format() == Format::R32Float && points.size() >= 16 * u64::from(width) * u64::from(height),
            "noise in a picture of {width} x {height} pixels: it is no float picture, or there are fewer points"
        );
        let push = noise_image_frag::Push { width, octaves: self.requested.count };
        let bindings =
            noise_image_frag::Bindings { points, all_octaves: &self.requested.octaves, tables: &self.requested.tables };
        recorder.draw(
            Self::NAME,
            &Target { colour: (picture, Clear::Discard), depth: None, area: [0, 0, width, height] },
            &[Draw {
                pipeline: &self.pipeline,
                bindings: &bindings.bound(),
                push: bytemuck::bytes_of(&push),
                viewport: Viewport { area: [0.0, 0.0, width as f32, height as f32], depth: [0.0, 1.0] },
                scissor: [0, 0, width, height],
                vertices: 0..3,
                instances: 0..1,
                indices: None,
                indirect: None,
            }],
        )
    }
}
