//! Who can be measured: every backend and variant, and why a machine does not run one of them.

use std::fmt;

use anyhow::{Result, anyhow, bail, ensure};
use serde::Serialize;

use super::Scene;
use super::yardstick::{Yardstick, YardstickKind};
use crate::body::{Body, Mesh};
use crate::evaluate::cpu::{Cpu, InstructionSet};
use crate::evaluate::device::{
    Channels, Comparison, Compute, Coverage, Gathering, Graphics, GraphicsSettings, Packing, Primitives, Projection,
    RasterKernel, Tiling, device_settings, open_instance,
};
use crate::evaluate::{CandidateImage, Evaluator, Reference};
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

/// Pixels that are drawn otherwise than they should be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct WrongPixels {
    /// Pictures that were compared.
    pub pictures: usize,
    /// Pixels that are drawn there.
    pub drawn: u64,
    /// Those with another label, or with an edge in one alone.
    pub wrong: u64,
    /// Edge pixels that should be there.
    pub edges: u64,
    /// Those of them that are hidden.
    pub hidden: u64,
    /// Pixels that would be wrong if the body's labels fell in the order of its parts instead of growing.
    pub with_falling_labels: u64,
}

impl WrongPixels {
    fn between(found: &[CandidateImage], expected: &[CandidateImage]) -> Self {
        let mut all = Self { pictures: expected.len(), ..Self::default() };
        for (found, expected) in found.iter().zip(expected) {
            for (found, expected) in found.bytes.iter().zip(&expected.bytes) {
                all.drawn += u64::from(*expected != 0);
                all.wrong += u64::from(found != expected);
                all.edges += u64::from(*expected & 0x80 != 0);
                all.hidden += u64::from(*expected & !*found & 0x80 != 0);
            }
        }
        all
    }
}

impl fmt::Display for WrongPixels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { pictures, drawn, wrong, edges, hidden, with_falling_labels } = *self;
        let share = |of: u64, all: u64| 100.0 * of as f64 / all.max(1) as f64;
        write!(
            f,
            "{wrong} of {drawn} pixels ({:.1} %) wrong in {pictures} pictures, {hidden} of {edges} edge pixels ({:.1} %) hidden; with \
             labels that fall from part to part {with_falling_labels} ({:.1} %) wrong",
            share(wrong, drawn),
            share(hidden, edges),
            share(with_falling_labels, drawn)
        )
    }
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
    /// measured them, projection by transform feedback, primitives of a geometry stage, coverage by the hardware, with whole pictures for
    /// tiles what one writes first, and all channels at once, which is wrong.
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
            GraphicsSettings { primitives: Primitives::Geometry, ..usual },
            GraphicsSettings { coverage: Coverage::Hardware, ..usual },
            GraphicsSettings { coverage: Coverage::Hardware, primitives: Primitives::Geometry, ..usual },
            GraphicsSettings { coverage: Coverage::Hardware, packing: Packing::Depth, ..usual },
            GraphicsSettings { packing: Packing::Depth, tiling: Tiling::Pictures, ..usual },
            Self::AT_ONCE,
        ];
        all.extend(more.map(Self::Graphics));
        all
    }

    /// The largest value staying and depth ranges of the channels, all in one pass (METHOD A9): what they do not do together.
    const AT_ONCE: GraphicsSettings = GraphicsSettings {
        packing: Packing::Depth,
        coverage: Coverage::Hardware,
        comparison: Comparison::Device(Gathering::Texels),
        tiling: Tiling::Regions,
        projection: Projection::Compute,
        primitives: Primitives::Vertices,
        channels: Channels::AtOnce,
    };

    /// Whether it is known to draw what is not there, and measured all the same.
    pub fn is_wrong(self) -> bool {
        matches!(self, Self::Graphics(settings) if settings.channels == Channels::AtOnce)
    }

    /// Of one that is known to be wrong, how much: of poses that are drawn together, pixel by pixel beside the same without what makes
    /// it wrong.
    ///
    /// # Errors
    /// When there is no device, or it fails.
    pub fn wrong_pixels(
        self,
        scene: &Scene,
        device: &Result<Device, String>,
        poses: &[f32],
    ) -> Result<Option<WrongPixels>> {
        let Self::Graphics(settings) = self else { return Ok(None) };
        if !self.is_wrong() {
            return Ok(None);
        }
        let device = device.as_ref().map_err(|why| anyhow!("{why}"))?;
        let wrong = |body: &Body| -> Result<WrongPixels> {
            let pictures = |settings| Graphics::on(device, body, &scene.cameras, settings)?.pictures(poses);
            let found = pictures(settings)?;
            Ok(WrongPixels::between(&found, &pictures(GraphicsSettings { channels: Channels::InTurn, ..settings })?))
        };
        // Which labels the parts have decides what the largest value hides.
        let mut falling = scene.body.clone();
        let labels: Vec<u8> = falling.parts.iter().rev().map(|part| part.label).collect();
        falling.parts.iter_mut().zip(labels).for_each(|(part, label)| part.label = label);
        let with_falling_labels = wrong(&falling)?.wrong;
        Ok(Some(WrongPixels { with_falling_labels, ..wrong(&scene.body)? }))
    }

    /// How far its fitness may lie from the reference's: where the hardware covers, other pixels are drawn along borders.
    pub(super) fn tolerance(self) -> f32 {
        match self {
            Self::Graphics(_) if self.is_wrong() => f32::INFINITY,
            Self::Graphics(settings) if settings.coverage == Coverage::Hardware => COVERED_BY_HARDWARE,
            _ => TOLERANCE,
        }
    }

    /// Everybody who draws meshes, the reference first.
    pub fn of_meshes() -> Vec<Self> {
        let mut all = vec![Self::Reference];
        all.extend(InstructionSet::ALL.map(Self::Cpu));
        all.push(Self::Compute { subgroup: false });
        let usual = GraphicsSettings { packing: Packing::Depth, ..GraphicsSettings::default() };
        let feedback = GraphicsSettings { projection: Projection::Feedback, ..usual };
        let geometry = GraphicsSettings { primitives: Primitives::Geometry, ..usual };
        all.extend([usual, feedback, geometry].map(Self::Graphics));
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
            (Self::Graphics(settings), None) => {
                can(settings, device()?)?;
                Box::new(Graphics::on(device()?, body, cameras, settings)?)
            }
            (Self::Graphics(settings), Some(mesh)) => {
                can(settings.of_mesh(), device()?)?;
                Box::new(Graphics::of_mesh(device()?, body, mesh.clone(), cameras, settings)?)
            }
            (_, Some(_)) => bail!("{} {} draws the flat model alone", self.backend(), self.variant()),
        };
        evaluator.observe(&scene.observations)?;
        Ok(evaluator)
    }
}

/// Holds a device to what a row says of it, but for exchanges that every device has in some way.
fn can(settings: GraphicsSettings, device: &Device) -> Result<()> {
    let found = GraphicsSettings { comparison: settings.comparison, ..settings.on(device.capabilities()) };
    ensure!(
        found == settings,
        "the device draws it as {}, since it cannot do {}: pantin devices says what it lacks",
        found.name(),
        settings.name()
    );
    Ok(())
}

/// Workgroups of the row in two phases; `pantin devices` tells what others take.
const SPANS: RasterKernel = RasterKernel::Spans { group: 64, workgroups: 2 };

/// The device that the program would open, opened once more without arithmetic in subgroups.
fn without_subgroups() -> Result<Device> {
    let lower = |capabilities: &mut Capabilities| capabilities.subgroup_arithmetic = false;
    Device::open(&open_instance()?, DeviceSettings { lower: Some(lower), ..device_settings()? })
}
