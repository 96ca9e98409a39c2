//! The evaluators by name, and which one `auto` takes.

use anyhow::{Result, anyhow, bail};

use super::auto::{fastest, is_device_worth_measuring};
use crate::bench::swarm;
use crate::body::{Body, Mesh};
use crate::evaluate::cpu::Cpu;
use crate::evaluate::device::{Compute, Graphics, GraphicsSettings, open_device};
use crate::evaluate::{Evaluator, Reference};
use crate::files::choices;
use crate::geometry::Camera;

choices! {
    /// An evaluator as `--backend` names it.
    #[derive(Default)]
    "backend" pub enum Backend {
        /// The fastest one that works on this machine, by a short measurement (the default).
        "auto" #[default] Auto,
        /// The simplest code that is obviously right; slow.
        "reference" Reference,
        /// The fast one on the processor, in the reference's integers.
        "cpu" Cpu,
        /// Drawing in compute on a Vulkan device, in the reference's integers.
        "compute" Compute,
        /// Drawing with the graphics pipeline of a Vulkan device: the flat model in the reference's integers, the mesh model with
        /// the device's own triangles.
        "graphics" Graphics,
    }
}

/// An evaluator and why it was taken.
pub struct BuiltBackend {
    /// The evaluator.
    pub evaluator: Box<dyn Evaluator>,
    /// A sentence for the user.
    pub reason: String,
}

impl Backend {
    /// Makes the evaluator of a body for its cameras at working size: of its flat model, or of a mesh bound to it
    /// ([`crate::body::Model::mesh`]). `around` is a pose to measure by, should `auto` have to choose. Every backend gives the same
    /// integers for the same model, but for few pixels of a mesh drawn by graphics, so which one it is changes the time alone.
    ///
    /// # Errors
    /// When there is no camera, no degree of freedom, the backend does not draw the model, or the evaluator cannot be made.
    pub fn build(self, mesh: Option<&Mesh>, body: &Body, cameras: &[Camera], around: &[f32]) -> Result<BuiltBackend> {
        if cameras.is_empty() {
            bail!("there are no cameras, expected at least one to compare poses with");
        }
        if body.dof_count() == 0 {
            bail!("the body `{}` has no degree of freedom, expected at least one to move", body.name);
        }
        match mesh {
            None => self.build_flat(body, cameras, around),
            Some(mesh) => self.build_mesh(body, mesh, cameras, around),
        }
    }

    fn build_flat(self, body: &Body, cameras: &[Camera], around: &[f32]) -> Result<BuiltBackend> {
        Ok(match self {
            Self::Reference => BuiltBackend {
                evaluator: Box::new(Reference::new(body, cameras)),
                reason: "the reference evaluator, as asked".to_string(),
            },
            Self::Cpu => {
                let cpu = Cpu::new(body, cameras)?;
                let reason = format!("the processor with {} instructions, as asked", cpu.variant());
                BuiltBackend { evaluator: Box::new(cpu), reason }
            }
            Self::Compute => {
                let compute = compute(body, cameras, around).map_err(|error| without_vulkan(self, &error))?;
                let (device, kernel) = (&compute.facts().name, compute.kernel());
                let reason =
                    format!("compute on the Vulkan device {device} ({}, {kernel}), as asked", compute.variant());
                BuiltBackend { evaluator: Box::new(compute), reason }
            }
            Self::Graphics => {
                let graphics = Graphics::new(body, cameras).map_err(|error| without_vulkan(self, &error))?;
                let device = &graphics.facts().name;
                let reason = format!("graphics on the Vulkan device {device} ({}), as asked", graphics.variant());
                BuiltBackend { evaluator: Box::new(graphics), reason }
            }
            Self::Auto => {
                // All of them give the same integers for the flat model.
                let others = || -> Vec<(&str, Result<Box<dyn Evaluator>>)> {
                    vec![
                        ("compute", compute(body, cameras, around).map(|it| Box::new(it) as Box<dyn Evaluator>)),
                        ("graphics", Graphics::new(body, cameras).map(|it| Box::new(it) as Box<dyn Evaluator>)),
                    ]
                };
                choose(Cpu::new(body, cameras)?, others, body, cameras, around)?
            }
        })
    }

    fn build_mesh(self, body: &Body, mesh: &Mesh, cameras: &[Camera], around: &[f32]) -> Result<BuiltBackend> {
        let compute = || Compute::of_mesh(&open_device()?, body, mesh.clone(), cameras);
        let graphics = || Graphics::of_mesh(&open_device()?, body, mesh.clone(), cameras, GraphicsSettings::default());
        Ok(match self {
            Self::Reference => BuiltBackend {
                evaluator: Box::new(Reference::of_mesh(body, mesh.clone(), cameras)?),
                reason: "the reference evaluator of the mesh model, as asked".to_string(),
            },
            Self::Cpu => {
                let cpu = Cpu::of_mesh(body, mesh.clone(), cameras)?;
                let reason = format!("the mesh model on the processor with {} instructions, as asked", cpu.variant());
                BuiltBackend { evaluator: Box::new(cpu), reason }
            }
            Self::Compute => {
                let compute = compute().map_err(|error| without_vulkan(self, &error))?;
                let device = &compute.facts().name;
                let reason = format!("compute of the mesh model on the Vulkan device {device}, as asked");
                BuiltBackend { evaluator: Box::new(compute), reason }
            }
            Self::Graphics => {
                let graphics = graphics().map_err(|error| without_vulkan(self, &error))?;
                let device = &graphics.facts().name;
                let reason = format!("graphics of the mesh model on the Vulkan device {device}, as asked");
                BuiltBackend { evaluator: Box::new(graphics), reason }
            }
            Self::Auto => {
                let others = || {
                    vec![
                        ("compute", compute().map(|it| Box::new(it) as Box<dyn Evaluator>)),
                        ("graphics", graphics().map(|it| Box::new(it) as Box<dyn Evaluator>)),
                    ]
                };
                choose(Cpu::of_mesh(body, mesh.clone(), cameras)?, others, body, cameras, around)?
            }
        })
    }
}

/// Poses by which the way to draw is chosen.
const TUNED_BY: usize = 64;

/// The flat model in compute, drawn the way that is fastest on the device.
fn compute(body: &Body, cameras: &[Camera], around: &[f32]) -> Result<Compute> {
    let mut compute = Compute::new(body, cameras)?;
    compute.tune(&swarm(body, around, TUNED_BY))?;
    Ok(compute)
}

/// What `auto` takes: the processor, unless one of the `others`, on a device that is worth it, is measured to be faster.
fn choose<'a>(
    cpu: Cpu,
    others: impl FnOnce() -> Vec<(&'a str, Result<Box<dyn Evaluator>>)>,
    body: &Body,
    cameras: &[Camera],
    around: &[f32],
) -> Result<BuiltBackend> {
    let with = cpu.variant();
    if let Err(why) = is_device_worth_measuring() {
        let reason = format!("auto chose cpu, with {with} instructions: {why}");
        return Ok(BuiltBackend { evaluator: Box::new(cpu), reason });
    }
    let mut rivals: Vec<Box<dyn Evaluator>> = vec![Box::new(cpu)];
    let mut failures = Vec::new();
    for (name, other) in others() {
        match other {
            Ok(evaluator) => rivals.push(evaluator),
            Err(error) => failures.push(format!("{name} failed ({error:#})")),
        }
    }
    if rivals.len() == 1 {
        let why = failures.join("; ");
        let reason = format!("auto chose cpu, with {with} instructions: {why}");
        return Ok(BuiltBackend { evaluator: rivals.swap_remove(0), reason });
    }
    let (evaluator, reason) = fastest(rivals, body, cameras, around)?;
    let reason = format!("auto chose {}, {reason}", evaluator.name());
    Ok(BuiltBackend { evaluator, reason })
}

/// The sentence of a backend on a device that could not be made.
fn without_vulkan(backend: Backend, error: &anyhow::Error) -> anyhow::Error {
    anyhow!(
        "the backend {} cannot be used: {error:#}; a Vulkan driver (Debian: mesa-vulkan-drivers) makes it work, --backend cpu \
         works without",
        backend.name()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Model;

    #[test]
    fn an_unknown_backend_names_the_known_ones() {
        let error = Backend::from_name("cuda").unwrap_err().to_string();
        assert_eq!(
            error,
            "unknown backend `cuda`, the nearest is `auto` (known: auto, reference, cpu, compute, graphics)"
        );
        for backend in Backend::ALL {
            assert_eq!(Backend::from_name(backend.name()).unwrap(), backend);
        }
    }

    #[test]
    fn auto_says_what_it_chose() {
        let body = Body::adult(1750.0).unwrap();
        let error = Backend::Auto.build(None, &body, &[], &[]).err().unwrap().to_string();
        assert!(error.contains("no cameras"), "{error}");
    }

    #[test]
    fn the_mesh_model_is_drawn_by_those_that_can() {
        let body = Body::adult(1750.0).unwrap();
        let cameras = crate::synth::rig::four_cameras(glam::DVec2::splat(2000.0), [64, 48]);
        assert!(Model::Flat.mesh(&body).unwrap().is_none());
        let mesh = Model::Mesh.mesh(&body).unwrap();
        let around: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
        for (backend, name) in [(Backend::Cpu, "cpu"), (Backend::Reference, "reference")] {
            let built = backend.build(mesh.as_ref(), &body, &cameras, &around).unwrap();
            assert_eq!(built.evaluator.name(), name);
            assert!(built.reason.contains("the mesh model"), "{}", built.reason);
        }
        // Nothing but a device that draws faster takes the processor's place.
        let auto = Backend::Auto.build(mesh.as_ref(), &body, &cameras, &around).unwrap();
        assert!(["cpu", "compute", "graphics"].contains(&auto.evaluator.name()), "{}", auto.reason);
        if is_device_worth_measuring().is_err() {
            assert_eq!(auto.evaluator.name(), "cpu");
        }
        assert!(auto.reason.starts_with(&format!("auto chose {}, ", auto.evaluator.name())), "{}", auto.reason);
        for backend in [Backend::Compute, Backend::Graphics] {
            match backend.build(mesh.as_ref(), &body, &cameras, &[]) {
                Ok(built) => assert_eq!(built.evaluator.name(), backend.name()),
                Err(error) => {
                    assert!(std::env::var_os("PANTIN_NEEDS_VULKAN").is_none(), "{error:#}");
                    assert!(format!("{error:#}").starts_with("the backend graphics cannot be used: "), "{error:#}");
                }
            }
        }
        let error = Model::from_name("solid").unwrap_err().to_string();
        assert_eq!(
            error,
            "unknown model `solid`, the nearest is `flat` (known: flat, mesh, square, elliptic-18, elliptic-34, elliptic-66, \
                    elliptic-130, elliptic-258, elliptic-514)"
        );
    }
}
