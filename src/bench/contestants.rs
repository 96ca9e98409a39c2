//! Who is measured: every backend and variant that this machine runs, and why it does not run the others.

use anyhow::{Result, anyhow, bail};
use serde::Serialize;

use super::Scene;
use super::yardstick::{Yardstick, YardstickKind};
use crate::body::Model;
use crate::evaluate::cpu::{Cpu, InstructionSet};
use crate::evaluate::device::{
    Comparison, Compute, Gathering, Graphics, GraphicsSettings, HostComparison, Packing, Tiling, device_settings,
    open_instance,
};
use crate::evaluate::{Evaluator, Reference};
use crate::gpu::{Capabilities, Device, DeviceSettings};

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

/// Who is measured on a scene, and who is not.
#[derive(Default)]
pub(super) struct Contestants {
    pub(super) present: Vec<Box<dyn Evaluator>>,
    pub(super) missing: Vec<Missing>,
}

/// Variants of the compute backend, and what is taken from a device for it to take the variant.
const COMPUTE: [(&str, Option<Lower>); 2] =
    [("subgroup", None), ("shared", Some(|capabilities| capabilities.subgroup_arithmetic = false))];

/// Variants of the graphics backend: packings by comparisons, as the thesis measured them, and with whole pictures for tiles what
/// one writes first.
fn graphics_variants() -> Vec<(String, GraphicsSettings)> {
    let comparisons = [
        Comparison::Device(Gathering::Texels),
        Comparison::Device(Gathering::Subgroup),
        Comparison::Device(Gathering::Shared),
        Comparison::Host(HostComparison::Scalar),
        Comparison::Host(HostComparison::Simd),
    ];
    let mut variants = Vec::new();
    for packing in [Packing::Max, Packing::Depth] {
        for comparison in comparisons {
            let settings = GraphicsSettings { packing, comparison, ..GraphicsSettings::default() };
            variants.push((settings.name().to_string(), settings));
        }
    }
    let whole = GraphicsSettings { packing: Packing::Depth, tiling: Tiling::Pictures, ..GraphicsSettings::default() };
    variants.push((whole.name().to_string(), whole));
    variants
}

type Lower = fn(&mut Capabilities);

/// The device, opened once more where it is to be capable of less.
fn variant_on(device: &Result<Device, String>, lower: Option<Lower>) -> Result<Device> {
    let device = device.as_ref().map_err(|why| anyhow!("{why}"))?;
    match lower {
        None => Ok(device.clone()),
        Some(_) => Device::open(&open_instance()?, DeviceSettings { lower, ..device_settings()? }),
    }
}

impl Contestants {
    /// Everybody who draws the model; the first is the one whose fitness the others are held to.
    ///
    /// `device` is the Vulkan device, or why there is none.
    pub(super) fn new(model: Model, scene: &Scene, device: &Result<Device, String>) -> Result<Self> {
        let Scene { body, cameras, .. } = scene;
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let mut all = Self::default();
        match model.mesh(body)? {
            None => {
                all.add(model, "reference", "", Ok(Box::new(Reference::new(body, cameras))));
                for kind in YardstickKind::ALL {
                    all.add(model, "cpu", kind.name(), Ok(Box::new(Yardstick::new(body, cameras, kind, threads))));
                }
                for set in InstructionSet::ALL {
                    let cpu = Cpu::with(body, cameras, set, threads).map(|cpu| Box::new(cpu) as Box<dyn Evaluator>);
                    all.add(model, "cpu", set.name(), cpu);
                }
                for (variant, lower) in COMPUTE {
                    let compute = variant_on(device, lower).and_then(|device| Compute::on(&device, body, cameras));
                    let is_it = |compute: &Compute| compute.variant() == variant;
                    let compute = compute.and_then(|compute| match is_it(&compute) {
                        true => Ok(Box::new(compute) as Box<dyn Evaluator>),
                        false => bail!("the device lacks what it needs: pantin devices says what"),
                    });
                    all.add(model, "compute", variant, compute);
                }
                for (variant, settings) in graphics_variants() {
                    let graphics = variant_on(device, None)
                        .and_then(|device| Graphics::on(&device, body, cameras, settings))
                        .map(|graphics| Box::new(graphics) as Box<dyn Evaluator>);
                    all.add(model, "graphics", &variant, graphics);
                }
            }
            Some(mesh) => {
                all.add(model, "reference", "", Ok(Box::new(Reference::of_mesh(body, mesh.clone(), cameras)?)));
                let settings = GraphicsSettings::default();
                let graphics = variant_on(device, None)
                    .and_then(|device| Graphics::of_mesh(&device, body, mesh, cameras, settings))
                    .map(|graphics| Box::new(graphics) as Box<dyn Evaluator>);
                let variant = graphics.as_ref().map_or("depth-texels", |graphics| graphics.variant());
                all.add(model, "graphics", variant, graphics);
            }
        }
        for evaluator in &mut all.present {
            evaluator.observe(&scene.observations)?;
        }
        Ok(all)
    }

    fn add(&mut self, model: Model, backend: &str, variant: &str, evaluator: Result<Box<dyn Evaluator>>) {
        match evaluator {
            Ok(evaluator) => self.present.push(evaluator),
            Err(error) => self.missing.push(Missing {
                backend: backend.to_string(),
                variant: variant.to_string(),
                model: model.to_string(),
                reason: format!("{error:#}"),
            }),
        }
    }
}
