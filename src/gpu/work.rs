//! What a stage does: operations and bytes of each block of its code, counted from its SPIR-V.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use super::spirv::{instructions, op};

/// Operations and bytes, as the code has them: what a driver leaves out or caches catch is counted like the rest. What the fixed
/// parts of the graphics pipeline, fills and copies do is no code, and not counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// Operations on whole numbers, bits and truth values, one a component.
    pub integer: u64,
    /// Operations in floating point, one a component; a fused product and sum are two, a function is one.
    pub float: u64,
    /// Bytes read from buffers and images; a texel is taken for four.
    pub read: u64,
    /// Bytes written to them.
    pub written: u64,
    /// Bytes read from and written to the shared memory of workgroups.
    pub shared: u64,
    /// Atomic operations.
    pub atomics: u64,
    /// Operations over a subgroup.
    pub subgroup: u64,
}

impl Work {
    /// Bytes of buffers and images, read or written.
    pub fn memory(&self) -> u64 {
        self.read + self.written
    }

    /// Adds that work, so many times.
    pub fn add(&mut self, times: u64, other: &Self) {
        let sum = |own: &mut u64, other: u64| *own = own.saturating_add(other.saturating_mul(times));
        sum(&mut self.integer, other.integer);
        sum(&mut self.float, other.float);
        sum(&mut self.read, other.read);
        sum(&mut self.written, other.written);
        sum(&mut self.shared, other.shared);
        sum(&mut self.atomics, other.atomics);
        sum(&mut self.subgroup, other.subgroup);
    }

    /// Bytes of a pointer's target, by where that lies; locals, push constants, and what stages hand on cost none.
    fn touch(&mut self, class: u32, read: u64, written: u64) {
        match class {
            storage::WORKGROUP => self.shared += read + written,
            storage::UNIFORM | storage::BUFFER | storage::IMAGE => {
                self.read += read;
                self.written += written;
            }
            _ => {}
        }
    }
}

/// Storage classes, from the SPIR-V specification.
mod storage {
    pub(super) const UNIFORM: u32 = 2;
    pub(super) const WORKGROUP: u32 = 4;
    pub(super) const IMAGE: u32 = 11;
    pub(super) const BUFFER: u32 = 12;
}

/// Bytes that a texel is taken for.
const TEXEL: u64 = 4;

/// What is known of a type.
#[derive(Clone, Copy, Debug, Default)]
struct Type {
    /// Numbers in it.
    components: u64,
    bytes: u64,
    /// Storage class and type that a pointer leads to.
    target: Option<(u32, u32)>,
}

/// The types of a module and of its results.
#[derive(Default)]
struct Types {
    types: HashMap<u32, Type>,
    results: HashMap<u32, u32>,
    /// Values of constants, for the lengths of arrays.
    constants: HashMap<u32, u64>,
}

impl Types {
    fn learn(&mut self, words: &[u32]) {
        let at = |place: usize| words.get(place).copied().unwrap_or_default();
        let of = |types: &HashMap<u32, Type>, place: usize| types.get(&at(place)).copied().unwrap_or_default();
        let times = |of: Type, count: u64| Type {
            components: of.components.saturating_mul(count),
            bytes: of.bytes.saturating_mul(count),
            target: None,
        };
        let own = match at(0) & 0xffff {
            op::TYPE_BOOL => Type { components: 1, bytes: 4, target: None },
            op::TYPE_INT | op::TYPE_FLOAT => Type { components: 1, bytes: u64::from(at(2)) / 8, target: None },
            op::TYPE_VECTOR | op::TYPE_MATRIX => times(of(&self.types, 2), u64::from(at(3))),
            op::TYPE_ARRAY => times(of(&self.types, 2), self.constants.get(&at(3)).copied().unwrap_or_default()),
            op::TYPE_STRUCT => {
                (2..words.len()).map(|place| of(&self.types, place)).fold(Type::default(), |sum, one| Type {
                    components: sum.components + one.components,
                    bytes: sum.bytes + one.bytes,
                    target: None,
                })
            }
            op::TYPE_POINTER => Type { target: Some((at(2), at(3))), ..Type::default() },
            code if (op::TYPE_VOID..=op::TYPE_FUNCTION).contains(&code) => Type::default(),
            code => {
                // Every instruction with a result has its type first, and no other has a type there.
                if words.len() > 2 && self.types.contains_key(&at(1)) {
                    self.results.insert(at(2), at(1));
                    if matches!(code, op::CONSTANT | op::SPEC_CONSTANT) {
                        self.constants.insert(at(2), u64::from(at(3)));
                    }
                }
                return;
            }
        };
        self.types.insert(at(1), own);
    }

    fn result(&self, id: u32) -> Type {
        self.results.get(&id).and_then(|ty| self.types.get(ty)).copied().unwrap_or_default()
    }

    /// Storage class and bytes of what a pointer leads to.
    fn target(&self, pointer: u32) -> (u32, u64) {
        let Some((class, ty)) = self.result(pointer).target else { return (0, 0) };
        (class, self.types.get(&ty).map_or(0, |ty| ty.bytes))
    }
}

/// The work of one run of each block of a module, in the order of their labels.
pub(super) fn blocks(spirv: &[u32]) -> Vec<Work> {
    let mut types = Types::default();
    let mut blocks: Vec<Work> = Vec::new();
    for words in instructions(spirv) {
        types.learn(words);
        if words[0] & 0xffff == op::LABEL {
            blocks.push(Work::default());
        } else if let Some(block) = blocks.last_mut() {
            count(block, words, &types);
        }
    }
    blocks
}

fn count(work: &mut Work, words: &[u32], types: &Types) {
    let at = |place: usize| words.get(place).copied().unwrap_or_default();
    let components = |place: usize| types.result(at(place)).components;
    let own = components(2);
    match at(0) & 0xffff {
        // Pointers: read, written, copied.
        61 => {
            let (class, bytes) = types.target(at(3));
            work.touch(class, bytes, 0);
        }
        62 => {
            let (class, bytes) = types.target(at(1));
            work.touch(class, 0, bytes);
        }
        63 => {
            for (place, is_written) in [(1, true), (2, false)] {
                let (class, bytes) = types.target(at(place));
                work.touch(class, if is_written { 0 } else { bytes }, if is_written { bytes } else { 0 });
            }
        }
        // Images: sampled, fetched, gathered, read; written.
        87..=98 => work.read += TEXEL,
        99 => work.written += TEXEL,
        12 => function(work, at(4), own),
        // Conversions between whole and other numbers, and among the latter; among the former.
        109..=112 | 115 => work.float += own,
        113 | 114 => work.integer += own,
        127 | 129 | 131 | 133 | 136 | 140..=143 | 147 | 156..=163 | 180..=191 => work.float += own,
        // A matrix and a vector: a product and a sum for each number of the matrix, but for the first of each sum.
        144 => work.float += 2 * components(4) - own.min(components(4)),
        145 => work.float += 2 * components(3) - own.min(components(3)),
        146 => {
            let inner = ((components(3) * components(4)) as f64 / own.max(1) as f64).sqrt().round() as u64;
            work.float += own * (2 * inner).saturating_sub(1);
        }
        148 => work.float += (2 * components(3)).saturating_sub(1),
        126 | 128 | 130 | 132 | 134 | 135 | 137..=139 | 149..=152 | 164..=179 | 194..=205 => work.integer += own,
        154 | 155 => work.integer += components(3),
        // Atomics: loads, stores, and those that do both.
        code @ 227..=242 => {
            work.atomics += 1;
            let (class, bytes) = types.target(at(if code == 228 { 1 } else { 3 }));
            work.touch(class, if code == 228 { 0 } else { bytes }, if code == 227 { 0 } else { bytes });
        }
        333..=366 => work.subgroup += own.max(1),
        _ => {}
    }
}

/// A function of GLSL.std.450 by its number, of so many components.
fn function(work: &mut Work, number: u32, components: u64) {
    match number {
        // Of whole numbers: magnitude, sign, limits, first bits; packing.
        5 | 7 | 38 | 39 | 41 | 42 | 44 | 45 | 54..=65 | 73..=75 => work.integer += components,
        // mix, fma, cross.
        46 => work.float += 3 * components,
        50 => work.float += 2 * components,
        68 => work.float += 9,
        _ => work.float += components,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::generated::double_comp;

    #[test]
    fn a_stage_is_counted_as_its_source_has_it() {
        let blocks = blocks(double_comp::SHADER.spirv);
        let mut all = Work::default();
        blocks.iter().for_each(|block| all.add(1, block));
        // One comparison; one product of a number that is read and a push constant, written.
        let expected = Work { integer: 1, float: 1, read: 4, written: 4, ..Work::default() };
        assert_eq!(all, expected, "{blocks:?}");
        assert!(blocks.len() >= 3, "before, inside and behind the condition");
        let mut thrice = Work::default();
        thrice.add(3, &all);
        assert_eq!((thrice.memory(), thrice.float), (24, 3));
    }
}
