//! SPIR-V as far as code that is loaded is changed or counted: its instructions, one after the other.

/// Words before the first instruction; the fourth is one more than the largest number of a result.
pub(super) const HEADER: usize = 5;

/// Numbers of instructions, from the SPIR-V specification.
pub(super) mod op {
    pub(crate) const EXTENSION: u32 = 10;
    pub(crate) const ENTRY_POINT: u32 = 15;
    pub(crate) const EXECUTION_MODE: u32 = 16;
    pub(crate) const CAPABILITY: u32 = 17;
    pub(crate) const TYPE_VOID: u32 = 19;
    pub(crate) const TYPE_BOOL: u32 = 20;
    pub(crate) const TYPE_INT: u32 = 21;
    pub(crate) const TYPE_FLOAT: u32 = 22;
    pub(crate) const TYPE_VECTOR: u32 = 23;
    pub(crate) const TYPE_MATRIX: u32 = 24;
    pub(crate) const TYPE_ARRAY: u32 = 28;
    pub(crate) const TYPE_STRUCT: u32 = 30;
    pub(crate) const TYPE_POINTER: u32 = 32;
    pub(crate) const TYPE_FUNCTION: u32 = 33;
    pub(crate) const CONSTANT: u32 = 43;
    pub(crate) const SPEC_CONSTANT: u32 = 50;
    pub(crate) const LABEL: u32 = 248;
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
