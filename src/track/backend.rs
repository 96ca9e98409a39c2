//! The evaluators by name.

use crate::files::choices;

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

#[cfg(test)]
mod tests {
    use super::*;

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
}
