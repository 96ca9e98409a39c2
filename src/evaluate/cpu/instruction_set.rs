//! The instruction sets that the evaluator is built for, and the proof that the processor has one.

#[cfg(target_arch = "x86_64")]
use std::arch::is_x86_feature_detected;

use crate::files::choices;

use super::portable::Portable;
use super::simd::{Simd, Task};

/// A token that only a processor with some features makes, and tasks compiled for them with the operations that
/// `$simd` makes of the token.
#[cfg(target_arch = "x86_64")]
macro_rules! token {
    ($(#[$docs:meta])* $name:ident, $simd:expr, $($feature:tt)+) => {
        $(#[$docs])*
        #[derive(Clone, Copy, Debug)]
        pub(super) struct $name(());

        impl $name {
            /// The token, on a processor that has the instructions.
            fn detect() -> Option<Self> {
                ($(is_x86_feature_detected!($feature))&&+).then_some(Self(()))
            }

            fn run(self, task: impl Task) {
                $(#[target_feature(enable = $feature)])+
                fn compiled(task: impl Task, simd: impl Simd) {
                    task.run(simd);
                }
                // SAFETY: the token proves that the processor has these features.
                unsafe { compiled(task, ($simd)(self)) }
            }
        }
    };
}

#[cfg(target_arch = "x86_64")]
token!(
    /// The AVX-512 subsets used here and what comes with them.
    Avx512, |token: Avx512| token,
    "avx512f" "avx512bw" "avx512cd" "avx512dq" "avx512vl" "avx512vpopcntdq" "avx2" "fma" "bmi1" "bmi2" "lzcnt" "popcnt"
);
#[cfg(target_arch = "x86_64")]
token!(
    /// AVX2 and what comes with it.
    Avx2, |token: Avx2| token,
    "avx2" "fma" "bmi1" "bmi2" "lzcnt" "popcnt"
);
#[cfg(target_arch = "x86_64")]
token!(
    /// What makes the portable code faster where it is there.
    Sse, |_: Sse| Portable,
    "sse4.2" "popcnt"
);

choices! {
    /// An instruction set the evaluator is built for; the fastest is listed first.
    "instruction set" pub enum InstructionSet {
        /// AVX-512 with bit counts in registers (Ice Lake, Zen 4 and later).
        "avx512" Avx512,
        /// AVX2 with FMA and BMI (Haswell, Zen and later).
        "avx2" Avx2,
        /// Any processor.
        "portable" Portable,
    }
}

impl InstructionSet {
    /// Whether this processor has it.
    pub fn is_available(self) -> bool {
        Code::of(self).is_some()
    }

    /// The fastest one this processor has.
    pub fn best() -> Self {
        Self::ALL.into_iter().find(|set| set.is_available()).unwrap_or(Self::Portable)
    }
}

/// An instruction set together with the proof that it is there.
#[derive(Clone, Copy, Debug)]
pub(super) enum Code {
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    #[cfg(target_arch = "x86_64")]
    Sse(Sse),
    Portable,
}

impl Code {
    pub(super) fn of(set: InstructionSet) -> Option<Self> {
        match set {
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => Avx512::detect().map(Self::Avx512),
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx2 => Avx2::detect().map(Self::Avx2),
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Portable => Some(Sse::detect().map_or(Self::Portable, Self::Sse)),
            #[cfg(not(target_arch = "x86_64"))]
            InstructionSet::Avx512 | InstructionSet::Avx2 => None,
            #[cfg(not(target_arch = "x86_64"))]
            InstructionSet::Portable => Some(Self::Portable),
        }
    }

    /// Runs a task as it is compiled for this instruction set.
    pub(super) fn run(self, task: impl Task) {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512(token) => token.run(task),
            #[cfg(target_arch = "x86_64")]
            Self::Avx2(token) => token.run(task),
            #[cfg(target_arch = "x86_64")]
            Self::Sse(token) => token.run(task),
            Self::Portable => task.run(Portable),
        }
    }
}
