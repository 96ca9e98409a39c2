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

/// Who does the second pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SecondPass {
    /// The run's own evaluator, alone: it draws other pixels than the processor, or there is nobody faster.
    Run,
    /// The run's own, the processor's, or several like it side by side.
    Alike,
    /// The processor, with these instructions, in a device's place and to the same integers: a generation is too small for a device.
    InPlace(InstructionSet),
}

impl SecondPass {
    /// Of a run with this evaluator.
    pub(super) fn of(run: &dyn Evaluator) -> Self {
        let set = InstructionSet::best();
        if run.name() == Backend::Cpu.name() {
            Self::Alike
        } else if run.name() == Backend::Compute.name() && set != InstructionSet::Portable {
            Self::InPlace(set)
        } else {
            Self::Run
        }
    }
}
