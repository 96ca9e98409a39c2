//! The flags that say who draws the poses and how, shared by the commands that score poses.

use anyhow::{Result, bail};

use crate::body::Model;
use crate::evaluate::device::{Comparison, Coverage, GraphicsSettings, Packing, Primitives, Projection};
use crate::track::{Backend, Drawing};

/// Who scores poses, and how.
#[derive(clap::Args, Clone, Debug)]
pub(super) struct DrawingFlags {
    /// Who scores the poses.
    #[arg(long, value_name = "NAME", default_value_t)]
    backend: Backend,
    /// Vulkan devices that share the poses of the backends compute and graphics, by the numbers of `pantin devices`: 0,1.
    /// The results are those of one.
    #[arg(long, value_name = "N,N", value_delimiter = ',')]
    pub(super) devices: Vec<usize>,
    /// With --backend graphics: how four candidates share a framebuffer [default: max; of a mesh depth].
    #[arg(long, value_name = "NAME")]
    packing: Option<Packing>,
    /// With --backend graphics: how the framebuffer is compared [default: texels].
    #[arg(long, value_name = "NAME")]
    gather: Option<Comparison>,
    /// With --backend graphics: what projects parts or vertices [default: compute].
    #[arg(long, value_name = "NAME")]
    projection: Option<Projection>,
    /// With --backend graphics: who decides which pixels a part covers [default: exact; of a mesh hardware].
    #[arg(long, value_name = "NAME")]
    coverage: Option<Coverage>,
    /// With --backend graphics: what makes the primitives that are drawn [default: vertices].
    #[arg(long, value_name = "NAME")]
    primitives: Option<Primitives>,
}

impl DrawingFlags {
    /// What they ask for.
    ///
    /// # Errors
    /// When the backend, or its way to draw the model, leaves no choice.
    pub(super) fn drawing(&self, model: Model) -> Result<Drawing> {
        let usual = GraphicsSettings::default();
        let graphics = GraphicsSettings {
            packing: self.packing.unwrap_or(usual.packing),
            comparison: self.gather.unwrap_or(usual.comparison),
            projection: self.projection.unwrap_or(usual.projection),
            coverage: self.coverage.unwrap_or(usual.coverage),
            primitives: self.primitives.unwrap_or(usual.primitives),
            ..usual
        };
        let given = [
            ("--packing", self.packing.map(Packing::name)),
            ("--gather", self.gather.map(Comparison::name)),
            ("--projection", self.projection.map(Projection::name)),
            ("--coverage", self.coverage.map(Coverage::name)),
            ("--primitives", self.primitives.map(Primitives::name)),
        ];
        let first = given.iter().find_map(|(flag, name)| Some((flag, (*name)?)));
        if let (Some((flag, name)), true) = (first, self.backend != Backend::Graphics) {
            bail!(
                "{flag} {name} says how the backend graphics draws, and the backend is {}: expected --backend graphics",
                self.backend
            );
        }
        // Meshes need a depth at every pixel, and the device's own triangles.
        let of_flat = [Packing::Max.name(), Coverage::Exact.name()];
        let refused = given.iter().find(|(_, name)| name.is_some_and(|name| of_flat.contains(&name)));
        if let (Some((flag, Some(name))), true) = (refused, model != Model::Flat) {
            bail!("{flag} {name} is for the flat model, and the model is {model}: leave it out");
        }
        let drawing = Drawing { backend: self.backend, graphics };
        drawing.check(&self.devices)?;
        Ok(drawing)
    }
}
