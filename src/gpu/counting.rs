//! Stages that count their own work: each block of their code, when it runs, adds one to a counter of its own.
//!
//! The counters lie in a buffer that the pipeline binds beside what the stage knows of; multiplied by what a run of each block
//! does ([`super::work`]) they give the operations and bytes of a pass, whatever its loops and branches did.

use super::interface::{Access, BindingKind, ShaderKind};
use super::shader::BindingLayout;
use super::spirv::{HEADER, instructions, op};

/// Where the counters of a pipeline are bound: beside the first set's own.
pub(super) const COUNTERS: BindingLayout = BindingLayout {
    name: "counters",
    set: 0,
    binding: 63,
    kind: BindingKind::StorageBuffer,
    access: Access::ReadWrite,
};

/// Numbers of instructions and what goes with them, from the SPIR-V specification.
mod code {
    pub(super) const LINE: u32 = 8;
    pub(super) const NO_LINE: u32 = 317;
    pub(super) const TYPE_RUNTIME_ARRAY: u32 = 29;
    pub(super) const FUNCTION: u32 = 54;
    pub(super) const VARIABLE: u32 = 59;
    pub(super) const ACCESS_CHAIN: u32 = 65;
    pub(super) const DECORATE: u32 = 71;
    pub(super) const MEMBER_DECORATE: u32 = 72;
    pub(super) const SELECT: u32 = 169;
    pub(super) const I_EQUAL: u32 = 170;
    pub(super) const ATOMIC_I_ADD: u32 = 234;
    pub(super) const PHI: u32 = 245;
    pub(super) const KILL: u32 = 252;
    pub(super) const DEMOTE: u32 = 5380;
    pub(super) const EARLY_FRAGMENT_TESTS: u32 = 9;
    pub(super) const DEPTH_REPLACING: u32 = 12;
    pub(super) const BLOCK: u32 = 2;
    pub(super) const ARRAY_STRIDE: u32 = 6;
    pub(super) const BINDING: u32 = 33;
    pub(super) const DESCRIPTOR_SET: u32 = 34;
    pub(super) const OFFSET: u32 = 35;
    pub(super) const STORAGE_BUFFER: u32 = 12;
    /// Memory scope of the whole device, no order.
    pub(super) const DEVICE: u32 = 1;
}

/// Appends an instruction.
fn put(words: &mut Vec<u32>, number: u32, operands: &[u32]) {
    words.push((operands.len() as u32 + 1) << 16 | number);
    words.extend_from_slice(operands);
}

/// Ids of what is added to a module.
struct Ids {
    uint: u32,
    truth: u32,
    pointer: u32,
    variable: u32,
    scope: u32,
    none: u32,
    one: u32,
    most: u32,
    /// The constant of the first counter; those of the others follow.
    counters: u32,
    /// The next id that is free.
    bound: u32,
}

impl Ids {
    fn take(&mut self) -> u32 {
        self.bound += 1;
        self.bound - 1
    }
}

/// The code of a stage that counts: block after block of it adds one to the 64-bit counters from number `first` on, each two
/// words, the low one first.
pub(super) fn counted(spirv: &[u32], kind: ShaderKind, first: u32) -> Vec<u32> {
    let number = |words: &[u32]| words[0] & 0xffff;
    let blocks = instructions(spirv).filter(|words| number(words) == op::LABEL).count() as u32;
    let known = |found: &dyn Fn(&[u32]) -> bool| instructions(spirv).find(|words| found(words)).map(|words| words[1]);
    let uint = known(&|words| number(words) == op::TYPE_INT && words[2..] == [32, 0]);
    let truth = known(&|words| number(words) == op::TYPE_BOOL);
    let mut ids = Ids {
        bound: spirv[HEADER - 2],
        uint: uint.unwrap_or_default(),
        truth: truth.unwrap_or_default(),
        pointer: 0,
        variable: 0,
        scope: 0,
        none: 0,
        one: 0,
        most: 0,
        counters: 0,
    };
    let (array, block, whole) = (ids.take(), ids.take(), ids.take());
    ids.pointer = ids.take();
    ids.variable = ids.take();
    let mut decorations = Vec::new();
    put(&mut decorations, code::DECORATE, &[array, code::ARRAY_STRIDE, 4]);
    put(&mut decorations, code::MEMBER_DECORATE, &[block, 0, code::OFFSET, 0]);
    put(&mut decorations, code::DECORATE, &[block, code::BLOCK]);
    put(&mut decorations, code::DECORATE, &[ids.variable, code::DESCRIPTOR_SET, COUNTERS.set]);
    put(&mut decorations, code::DECORATE, &[ids.variable, code::BINDING, COUNTERS.binding]);
    let mut types = Vec::new();
    if uint.is_none() {
        ids.uint = ids.take();
        put(&mut types, op::TYPE_INT, &[ids.uint, 32, 0]);
    }
    if truth.is_none() {
        ids.truth = ids.take();
        put(&mut types, op::TYPE_BOOL, &[ids.truth]);
    }
    put(&mut types, code::TYPE_RUNTIME_ARRAY, &[array, ids.uint]);
    put(&mut types, op::TYPE_STRUCT, &[block, array]);
    put(&mut types, op::TYPE_POINTER, &[whole, code::STORAGE_BUFFER, block]);
    put(&mut types, op::TYPE_POINTER, &[ids.pointer, code::STORAGE_BUFFER, ids.uint]);
    put(&mut types, code::VARIABLE, &[whole, ids.variable, code::STORAGE_BUFFER]);
    let mut constant = |ids: &mut Ids, value: u32| {
        let id = ids.take();
        put(&mut types, op::CONSTANT, &[ids.uint, id, value]);
        id
    };
    ids.scope = constant(&mut ids, code::DEVICE);
    ids.none = constant(&mut ids, 0);
    ids.one = constant(&mut ids, 1);
    ids.most = constant(&mut ids, u32::MAX);
    ids.counters = ids.bound;
    for counter in 2 * first..2 * (first + blocks) {
        constant(&mut ids, counter);
    }

    // Fragments that a depth test hides are not to run because they count.
    let early = kind == ShaderKind::Fragment
        && !instructions(spirv).any(|words| match number(words) {
            op::EXECUTION_MODE => matches!(words[2], code::DEPTH_REPLACING | code::EARLY_FRAGMENT_TESTS),
            number => matches!(number, code::KILL | code::DEMOTE),
        });
    let mut words = spirv[..HEADER].to_vec();
    let (mut is_decorated, mut has_types, mut pending, mut before, mut entry) = (false, false, None, 0, 0);
    let mut at = 0;
    for instruction in instructions(spirv) {
        let now = number(instruction);
        if before == op::ENTRY_POINT && now != op::ENTRY_POINT && early {
            put(&mut words, op::EXECUTION_MODE, &[entry, code::EARLY_FRAGMENT_TESTS]);
        }
        if !is_decorated && (op::TYPE_VOID..=op::TYPE_FUNCTION).contains(&now) {
            words.append(&mut decorations);
            is_decorated = true;
        }
        if !has_types && now == code::FUNCTION {
            words.append(&mut types);
            has_types = true;
        }
        // A block's counting stands behind what must stand first in it.
        if !matches!(now, code::PHI | code::VARIABLE | code::LINE | code::NO_LINE)
            && let Some(counter) = pending.take()
        {
            add_one(&mut words, &mut ids, counter);
        }
        words.extend_from_slice(instruction);
        if now == op::LABEL {
            pending = Some(at);
            at += 1;
        }
        if now == op::ENTRY_POINT {
            entry = instruction[2];
        }
        before = now;
    }
    words[HEADER - 2] = ids.bound;
    words
}

/// Adds one to the low word of a counter, and what that carries to the high one.
fn add_one(words: &mut Vec<u32>, ids: &mut Ids, counter: u32) {
    let low = ids.counters + 2 * counter;
    let old = add(words, ids, low, ids.one);
    let (is_full, carry) = (ids.take(), ids.take());
    put(words, code::I_EQUAL, &[ids.truth, is_full, old, ids.most]);
    put(words, code::SELECT, &[ids.uint, carry, is_full, ids.one, ids.none]);
    add(words, ids, low + 1, carry);
}

/// Adds `value` to a word of the counters; the id of what it was before.
fn add(words: &mut Vec<u32>, ids: &mut Ids, word: u32, value: u32) -> u32 {
    let (pointer, old) = (ids.take(), ids.take());
    put(words, code::ACCESS_CHAIN, &[ids.pointer, pointer, ids.variable, ids.none, word]);
    put(words, code::ATOMIC_I_ADD, &[ids.uint, old, pointer, ids.scope, ids.none, value]);
    old
}
