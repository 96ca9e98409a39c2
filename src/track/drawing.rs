//! How poses are drawn: by which backend, in which of its ways, on which devices, and what `auto` takes.

use std::fmt;

use anyhow::{Result, anyhow, bail, ensure};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::Backend;
use super::auto::{fastest, is_device_worth_measuring};
use crate::bench::swarm;
use crate::body::{Body, Mesh};
use crate::evaluate::cpu::Cpu;
use crate::evaluate::device::{Compute, Graphics, GraphicsSettings, Shared, open_devices};
use crate::evaluate::{Evaluator, Reference};
use crate::files::unknown;
use crate::geometry::Camera;
use crate::gpu::Device;

/// A backend and the way it draws, where it has several. As text, in a study's `backends`: the backend's name, or `graphics-` and what
/// `bench` calls the way, `graphics-depth-readback` say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Drawing {
    /// Who draws and compares.
    pub backend: Backend,
    /// How graphics does it.
    pub graphics: GraphicsSettings,
}

/// An evaluator and why it was taken.
pub struct BuiltBackend {
    /// The evaluator.
    pub evaluator: Box<dyn Evaluator>,
    /// A sentence for the user.
    pub reason: String,
}

impl From<Backend> for Drawing {
    fn from(backend: Backend) -> Self {
        Self { backend, ..Self::default() }
    }
}

impl fmt::Display for Drawing {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.graphics == GraphicsSettings::default() {
            return self.backend.fmt(out);
        }
        out.pad(&format!("{}-{}", self.backend, self.graphics.name()))
    }
}

impl Serialize for Drawing {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Drawing {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Self::named(&name).map_err(serde::de::Error::custom)
    }
}

impl Drawing {
    /// The backend, or the way of graphics, of that name.
    ///
    /// # Errors
    /// When there is none: the nearest one and all are named.
    pub fn named(name: &str) -> Result<Self> {
        let Some(way) = name.strip_prefix("graphics-") else { return Ok(Backend::from_name(name)?.into()) };
        let ways = || GraphicsSettings::all().filter(GraphicsSettings::is_for_tracking);
        let found = ways().find(|known| known.name() == way);
        let names = || ways().map(|way| way.name()).collect::<Vec<_>>();
        let graphics = found.ok_or_else(|| unknown("way of the backend graphics", way, &names()))?;
        Ok(Self { backend: Backend::Graphics, graphics })
    }

    /// Holds the backend to what is asked of it beside.
    ///
    /// # Errors
    /// When it draws in one way alone, or is on no device.
    pub fn check(self, devices: &[usize]) -> Result<()> {
        let Self { backend, graphics } = self;
        ensure!(
            backend == Backend::Graphics || graphics == GraphicsSettings::default(),
            "packing, gather, projection, coverage and primitives say how the backend graphics draws, and the backend is {backend}: expected \
             --backend graphics"
        );
        ensure!(
            devices.is_empty() || matches!(backend, Backend::Compute | Backend::Graphics),
            "devices are shared by the backends compute and graphics, and the backend is {backend}: expected --backend compute or \
             --backend graphics"
        );
        Ok(())
    }

    /// Makes the evaluator of a body for its cameras at working size: of its flat model, or of a mesh bound to it
    /// ([`crate::body::Model::mesh`]). `devices` are numbers in Vulkan's list: on several each draws a share of the poses; without any
    /// it is the device of the environment, or the best. `around` is a pose to measure by, should there be a choice. Every backend gives
    /// the same integers for the same model, but for few pixels of a mesh drawn by graphics and for coverage by the hardware, so which
    /// one it is changes the time alone.
    ///
    /// # Errors
    /// When there is no camera, no degree of freedom, the backend does not draw the model, or the evaluator cannot be made.
    pub fn build(
        self,
        devices: &[usize],
        mesh: Option<&Mesh>,
        body: &Body,
        cameras: &[Camera],
        around: &[f32],
    ) -> Result<BuiltBackend> {
        if cameras.is_empty() {
            bail!("there are no cameras, expected at least one to compare poses with");
        }
        if body.dof_count() == 0 {
            bail!("the body `{}` has no degree of freedom, expected at least one to move", body.name);
        }
        self.check(devices)?;
        let asked = Asked { drawing: self, mesh, body, cameras, around };
        match self.backend {
            Backend::Reference => asked.reference(),
            Backend::Cpu => {
                let cpu = asked.cpu()?;
                let (of, with) = (if mesh.is_some() { "the mesh model on " } else { "" }, cpu.variant());
                let reason = format!("{of}the processor with {with} instructions, as asked");
                Ok(BuiltBackend { evaluator: Box::new(cpu), reason })
            }
            Backend::Compute | Backend::Graphics => asked.on_devices(devices).map_err(|error| match devices {
                [] => without_vulkan(self.backend, &error),
                _ => error.context(format!("the backend {} cannot be used", self.backend)),
            }),
            Backend::Auto => asked.auto(),
        }
    }
}

/// What an evaluator is made for.
#[derive(Clone, Copy)]
struct Asked<'a> {
    drawing: Drawing,
    mesh: Option<&'a Mesh>,
    body: &'a Body,
    cameras: &'a [Camera],
    around: &'a [f32],
}

/// Poses by which the way to draw is chosen.
const TUNED_BY: usize = 64;

impl Asked<'_> {
    fn reference(self) -> Result<BuiltBackend> {
        let (evaluator, of): (Box<dyn Evaluator>, _) = match self.mesh {
            None => (Box::new(Reference::new(self.body, self.cameras)), ""),
            Some(mesh) => (Box::new(Reference::of_mesh(self.body, mesh.clone(), self.cameras)?), " of the mesh model"),
        };
        Ok(BuiltBackend { evaluator, reason: format!("the reference evaluator{of}, as asked") })
    }

    fn cpu(self) -> Result<Cpu> {
        match self.mesh {
            None => Cpu::new(self.body, self.cameras),
            Some(mesh) => Cpu::of_mesh(self.body, mesh.clone(), self.cameras),
        }
    }

    /// The backend on its devices, all of them at work on the same batches where they are several.
    fn on_devices(self, devices: &[usize]) -> Result<BuiltBackend> {
        let opened = open_devices(devices, self.drawing.backend == Backend::Graphics)?;
        let (mut evaluators, mut names) = (Vec::new(), Vec::new());
        for device in &opened {
            let (evaluator, how) = self.on(device)?;
            evaluators.push(evaluator);
            names.push(format!("{}{how}", device.facts().name));
        }
        let of = if self.mesh.is_some() { " of the mesh model" } else { "" };
        let (backend, names) = (self.drawing.backend, names.join(" and "));
        let (evaluator, on, share): (Box<dyn Evaluator>, _, _) = match evaluators.len() {
            1 => (evaluators.swap_remove(0), "device", ""),
            _ => (Box::new(Shared::new(evaluators)?), "devices", ", which share the poses"),
        };
        Ok(BuiltBackend { evaluator, reason: format!("{backend}{of} on the Vulkan {on} {names}{share}, as asked") })
    }

    /// The backend on a device, and how it draws there.
    fn on(self, device: &Device) -> Result<(Box<dyn Evaluator>, String)> {
        let Self { drawing: Drawing { backend, graphics: settings }, body, cameras, .. } = self;
        Ok(match (backend, self.mesh) {
            (Backend::Graphics, None) => {
                let graphics = Graphics::on(device, body, cameras, settings)?;
                let how = match graphics.settings() {
                    found if found == settings => format!(" ({})", graphics.variant()),
                    _ => format!(" ({}, since it cannot do {})", graphics.variant(), settings.name()),
                };
                (Box::new(graphics), how)
            }
            (Backend::Graphics, Some(mesh)) => {
                let graphics = Graphics::of_mesh(device, body, mesh.clone(), cameras, settings)?;
                let how = match settings.of_mesh() {
                    // As before there was a choice.
                    asked if asked == GraphicsSettings::default().of_mesh() => String::new(),
                    asked if asked == graphics.settings() => format!(" ({})", graphics.variant()),
                    asked => format!(" ({}, since it cannot do {})", graphics.variant(), asked.name()),
                };
                (Box::new(graphics), how)
            }
            (_, None) => {
                let mut compute = Compute::on(device, body, cameras)?;
                compute.tune(&swarm(body, self.around, TUNED_BY))?;
                let how = format!(" ({}, {})", compute.variant(), compute.kernel());
                (Box::new(compute), how)
            }
            (_, Some(mesh)) => (Box::new(Compute::of_mesh(device, body, mesh.clone(), cameras)?), String::new()),
        })
    }

    /// The processor, unless a device is worth it and measured to be faster.
    fn auto(self) -> Result<BuiltBackend> {
        let cpu = self.cpu()?;
        let with = cpu.variant();
        let stays = |cpu: Box<dyn Evaluator>, why: String| {
            let reason = format!("auto chose cpu, with {with} instructions: {why}");
            Ok(BuiltBackend { evaluator: cpu, reason })
        };
        if let Err(why) = is_device_worth_measuring() {
            return stays(Box::new(cpu), why);
        }
        let mut rivals: Vec<Box<dyn Evaluator>> = vec![Box::new(cpu)];
        let mut failures = Vec::new();
        for backend in [Backend::Compute, Backend::Graphics] {
            match (Self { drawing: backend.into(), ..self }).on_devices(&[]) {
                Ok(built) => rivals.push(built.evaluator),
                Err(error) => failures.push(format!("{backend} failed ({error:#})")),
            }
        }
        if rivals.len() == 1 {
            return stays(rivals.swap_remove(0), failures.join("; "));
        }
        let (evaluator, reason) = fastest(rivals, self.body, self.cameras, self.around)?;
        let reason = format!("auto chose {}, {reason}", evaluator.name());
        Ok(BuiltBackend { evaluator, reason })
    }
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
    use crate::evaluate::device::{Comparison, Coverage, HostComparison, Packing, Projection};

    #[test]
    fn a_way_to_draw_is_a_name_in_files() {
        for backend in Backend::ALL {
            assert_eq!(Drawing::named(backend.name()).unwrap(), backend.into());
        }
        let usual = GraphicsSettings::default();
        let graphics = GraphicsSettings {
            packing: Packing::Depth,
            coverage: Coverage::Hardware,
            comparison: Comparison::Host(HostComparison::Simd),
            projection: Projection::Feedback,
            ..usual
        };
        let drawing = Drawing { backend: Backend::Graphics, graphics };
        assert_eq!(drawing.to_string(), "graphics-depth-hardware-readback-simd-feedback");
        assert_eq!(Drawing::named(&drawing.to_string()).unwrap(), drawing);
        assert_eq!(Drawing::named("graphics-max-texels").unwrap().to_string(), "graphics");
        let error = Drawing::named("graphics-max-texel").unwrap_err().to_string();
        assert!(
            error.starts_with("unknown way of the backend graphics `max-texel`, the nearest is `max-texels`"),
            "{error}"
        );
        assert!(Drawing::named("gpu").unwrap_err().to_string().starts_with("unknown backend `gpu`"));
    }

    #[test]
    fn what_a_backend_cannot_do_is_said() {
        let error = |drawing: Drawing, devices: &[usize]| drawing.check(devices).unwrap_err().to_string();
        let depth = GraphicsSettings { packing: Packing::Depth, ..GraphicsSettings::default() };
        let drawing = Drawing { backend: Backend::Compute, graphics: depth };
        assert!(error(drawing, &[]).contains("and the backend is compute: expected --backend graphics"));
        assert!(error(Backend::Auto.into(), &[0]).contains("and the backend is auto: expected --backend compute"));
        Drawing { backend: Backend::Graphics, graphics: depth }.check(&[0, 1]).unwrap();
    }

    #[test]
    fn auto_says_what_it_chose() {
        let body = Body::adult(1750.0).unwrap();
        let error = Drawing::default().build(&[], None, &body, &[], &[]).err().unwrap().to_string();
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
            let built = Drawing::from(backend).build(&[], mesh.as_ref(), &body, &cameras, &around).unwrap();
            assert_eq!(built.evaluator.name(), name);
            assert!(built.reason.contains("the mesh model"), "{}", built.reason);
        }
        // Nothing but a device that draws faster takes the processor's place.
        let auto = Drawing::default().build(&[], mesh.as_ref(), &body, &cameras, &around).unwrap();
        assert!(["cpu", "compute", "graphics"].contains(&auto.evaluator.name()), "{}", auto.reason);
        if is_device_worth_measuring().is_err() {
            assert_eq!(auto.evaluator.name(), "cpu");
        }
        assert!(auto.reason.starts_with(&format!("auto chose {}, ", auto.evaluator.name())), "{}", auto.reason);
        for backend in [Backend::Compute, Backend::Graphics] {
            match Drawing::from(backend).build(&[], mesh.as_ref(), &body, &cameras, &[]) {
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
