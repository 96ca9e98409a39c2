//! SPIR-V as far as code that is loaded is changed: its instructions, one after the other.

/// Words before the first instruction; the fourth is one more than the largest number of a result.
pub(super) const HEADER: usize = 5;

/// Numbers of instructions, from the SPIR-V specification.
pub(super) mod op {
    pub(crate) const EXTENSION: u32 = 10;
    pub(crate) const ENTRY_POINT: u32 = 15;
    pub(crate) const EXECUTION_MODE: u32 = 16;
    pub(crate) const CAPABILITY: u32 = 17;
}

/// The instructions of a module, each with its first word, which holds its length above and its number below.
pub(super) fn instructions(spirv: &[u32]) -> impl Iterator<Item = &[u32]> {
    let mut rest = spirv.get(HEADER..).unwrap_or_default();
    std::iter::from_fn(move || {
        let length = (*rest.first()? >> 16) as usize;
        let (instruction, behind) = rest.split_at_checked(length.max(1))?;
        rest = behind;
        Some(instruction)
    })
}

/// Whether a stage does anything over subgroups.
pub(super) fn uses_subgroups(spirv: &[u32]) -> bool {
    /// The capability GroupNonUniform.
    const GROUP_NON_UNIFORM: u32 = 61;
    instructions(spirv)
        .take_while(|instruction| instruction[0] & 0xffff == op::CAPABILITY)
        .any(|instruction| instruction[1] == GROUP_NON_UNIFORM)
}
