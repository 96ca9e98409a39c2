//! Who can be measured: every backend and variant, and why a machine does not run one of them.

use anyhow::{Result, anyhow, bail, ensure};
use serde::Serialize;

use super::Scene;
use super::yardstick::{Yardstick, YardstickKind};
use crate::body::Mesh;
use crate::evaluate::cpu::{Cpu, InstructionSet};
use crate::evaluate::device::{
    Comparison, Compute, Coverage, Graphics, GraphicsSettings, Packing, Projection, RasterKernel, Tiling,
    device_settings, open_instance,
};
use crate::evaluate::{Evaluator, Reference};
use crate::gpu::{Capabilities, Device, DeviceSettings};

/// How far a fitness may lie from the reference's.
const TOLERANCE: f32 = 1e-3;
/// The same where the hardware covers.
const COVERED_BY_HARDWARE: f32 = 0.01;

/// A backend or variant that this machine cannot run.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Missing {
    /// The backend.
    pub backend: String,
    /// The variant.
    pub variant: String,
    /// The model.
    pub model: String,
    /// Why not, in a sentence.
    pub reason: String,
}

/// A backend in one of its variants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contestant {
    /// The reference, whose fitness the others are held to.
    Reference,
    /// What one writes first.
    Yardstick(YardstickKind),
    /// The processor with an instruction set.
    Cpu(InstructionSet),
    /// The compute backend on a device with arithmetic in subgroups, or with that taken from it.
    Compute {
        /// Whether subgroups have arithmetic.
        subgroup: bool,
    },
    /// The compute backend in two phases: spans first, then pixels.
    Spans,
    /// The graphics backend so set.
    Graphics(GraphicsSettings),
}

impl Contestant {
    /// Everybody who draws the flat model, the reference first: of the graphics backend packings by comparisons, as the thesis
    /// measured them, projection by transform feedback, coverage by the hardware, and with whole pictures for tiles what one writes
    /// first.
    pub fn of_flat() -> Vec<Self> {
        let usual = GraphicsSettings::default();
        let mut all = vec![Self::Reference];
        all.extend(YardstickKind::ALL.map(Self::Yardstick));
        all.extend(InstructionSet::ALL.map(Self::Cpu));
        all.extend([true, false].map(|subgroup| Self::Compute { subgroup }));
        all.push(Self::Spans);
        for packing in Packing::ALL {
            all.extend(
                Comparison::all().map(|comparison| Self::Graphics(GraphicsSettings { packing, comparison, ..usual })),
            );
        }
        let more = [
            GraphicsSettings { projection: Projection::Feedback, ..usual },
            GraphicsSettings { coverage: Coverage::Hardware, ..usual },
            GraphicsSettings { coverage: Coverage::Hardware, packing: Packing::Depth, ..usual },
            GraphicsSettings { packing: Packing::Depth, tiling: Tiling::Pictures, ..usual },
        ];
        all.extend(more.map(Self::Graphics));
        all
    }

    /// How far its fitness may lie from the reference's: where the hardware covers, other pixels are drawn along borders.
    pub(super) fn tolerance(self) -> f32 {
        match self {
            Self::Graphics(settings) if settings.coverage == Coverage::Hardware => COVERED_BY_HARDWARE,
            _ => TOLERANCE,
        }
    }

    /// Everybody who draws meshes, the reference first.
    pub fn of_meshes() -> Vec<Self> {
        let mut all = vec![Self::Reference];
        all.extend(InstructionSet::ALL.map(Self::Cpu));
        all.push(Self::Compute { subgroup: false });
        all.push(Self::Graphics(GraphicsSettings { packing: Packing::Depth, ..GraphicsSettings::default() }));
        all
    }

    /// The backend's name as `--backend` takes it.
    pub fn backend(self) -> &'static str {
        match self {
            Self::Reference => "reference",
            Self::Yardstick(_) | Self::Cpu(_) => "cpu",
            Self::Compute { .. } | Self::Spans => "compute",
            Self::Graphics(_) => "graphics",
        }
    }

    /// The variant's name.
    pub fn variant(self) -> &'static str {
        match self {
            Self::Reference => "exact",
            Self::Yardstick(kind) => kind.name(),
            Self::Cpu(set) => set.name(),
            Self::Compute { subgroup: true } => "subgroup",
            Self::Compute { subgroup: false } => "shared",
            Self::Spans => "spans",
            Self::Graphics(settings) => settings.name(),
        }
    }

    /// Its evaluator, which has seen the scene's observations; of a mesh, or of the flat model.
    ///
    /// `device` is the Vulkan device, or why there is none.
    ///
    /// # Errors
    /// When this machine cannot run it, or it draws no meshes.
    pub fn build(
        self,
        scene: &Scene,
        mesh: Option<&Mesh>,
        device: &Result<Device, String>,
    ) -> Result<Box<dyn Evaluator>> {
        let Scene { body, cameras, .. } = scene;
        let device = || device.as_ref().map_err(|why| anyhow!("{why}"));
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let mut evaluator: Box<dyn Evaluator> = match (self, mesh) {
            (Self::Reference, None) => Box::new(Reference::new(body, cameras)),
            (Self::Reference, Some(mesh)) => Box::new(Reference::of_mesh(body, mesh.clone(), cameras)?),
            (Self::Yardstick(kind), None) => Box::new(Yardstick::new(body, cameras, kind, threads)),
            (Self::Cpu(set), None) => Box::new(Cpu::with(body, cameras, set, threads)?),
            (Self::Cpu(set), Some(mesh)) => Box::new(Cpu::of_mesh_with(body, mesh.clone(), cameras, set, threads)?),
            (Self::Compute { subgroup }, None) => {
                let own = device()?;
                let is_as_wanted = subgroup || !own.capabilities().subgroup_arithmetic;
                let device = if is_as_wanted { own.clone() } else { without_subgroups()? };
                let compute = Compute::on(&device, body, cameras)?;
                ensure!(
                    compute.variant() == self.variant(),
                    "the device lacks what it needs: pantin devices says what"
                );
                Box::new(compute)
            }
            (Self::Spans, None) => Box::new(Compute::with_kernel(device()?, body, cameras, SPANS)?),
            // Sums meet in shared memory on every device.
            (Self::Compute { subgroup: false }, Some(mesh)) => {
                Box::new(Compute::of_mesh(device()?, body, mesh.clone(), cameras)?)
            }
            (Self::Graphics(settings), None) => Box::new(Graphics::on(device()?, body, cameras, settings)?),
            (Self::Graphics(settings), Some(mesh)) => {
                Box::new(Graphics::of_mesh(device()?, body, mesh.clone(), cameras, settings)?)
            }
            (_, Some(_)) => bail!("{} {} draws the flat model alone", self.backend(), self.variant()),
        };
        evaluator.observe(&scene.observations)?;
        Ok(evaluator)
    }
}

/// Workgroups of the row in two phases; `pantin devices` tells what others take.
const SPANS: RasterKernel = RasterKernel::Spans { group: 64, workgroups: 2 };

/// The device that the program would open, opened once more without arithmetic in subgroups.
fn without_subgroups() -> Result<Device> {
    let lower = |capabilities: &mut Capabilities| capabilities.subgroup_arithmetic = false;
    Device::open(&open_instance()?, DeviceSettings { lower: Some(lower), ..device_settings()? })
}
