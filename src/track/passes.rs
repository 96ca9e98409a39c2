//! How often a run goes over its frames, and who does so the second time.

use super::Backend;
use crate::evaluate::Evaluator;
use crate::evaluate::cpu::InstructionSet;
use crate::files::choices;

choices! {
    /// How often a run goes over its frames.
    "passes" pub enum Passes {
        /// Once, one frame after the other.
        "forward" Forward,
        /// Once so, then again with what comes after each frame known too.
        "both" Both,
    }
}

/// The instructions by which the processor does the second pass in a device's place, to the same integers: a generation is too small for a
/// device. None where it draws other pixels, or has no vector instructions and is slower.
pub(super) fn in_place_of(run: &dyn Evaluator) -> Option<InstructionSet> {
    let set = InstructionSet::best();
    (run.name() == Backend::Compute.name() && set != InstructionSet::Portable).then_some(set)
}
