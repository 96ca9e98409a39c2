//! A device as inexact as Vulkan lets it be, for tests: code whose quotients, roots and library functions are off by up to three
//! units in the last place, and whose products are rounded otherwise where a device may fuse them with a sum.

use std::collections::{HashMap, HashSet};

use super::spirv::op::{CONSTANT, LABEL, TYPE_BOOL, TYPE_FLOAT, TYPE_FUNCTION, TYPE_INT, TYPE_VECTOR};
use super::spirv::{HEADER, instructions};

/// Numbers of instructions, decorations and instructions of GLSL.std.450, from the SPIR-V specification.
const EXT_INST: u32 = 12;
const FUNCTION: u32 = 54;
const FUNCTION_PARAMETER: u32 = 55;
const FUNCTION_END: u32 = 56;
const FUNCTION_CALL: u32 = 57;
const DECORATE: u32 = 71;
const COMPOSITE_CONSTRUCT: u32 = 80;
const COMPOSITE_EXTRACT: u32 = 81;
const BITCAST: u32 = 124;
const I_ADD: u32 = 128;
const F_ADD: u32 = 129;
const I_SUB: u32 = 130;
const F_SUB: u32 = 131;
const I_MUL: u32 = 132;
const F_MUL: u32 = 133;
const F_DIV: u32 = 136;
const U_MOD: u32 = 137;
const F_REM: u32 = 140;
const F_MOD: u32 = 141;
const DOT: u32 = 148;
const SELECT: u32 = 169;
const U_LESS_THAN: u32 = 176;
const SHIFT_RIGHT: u32 = 194;
const XOR: u32 = 198;
const AND: u32 = 199;
const RETURN_VALUE: u32 = 254;
const NO_CONTRACTION: u32 = 42;
/// Sine to inverse square root, length, distance, cross product, unit vector.
const INEXACT_FUNCTIONS: [std::ops::RangeInclusive<u32>; 2] = [13..=32, 66..=69];

/// A change of code before it is loaded: of a stage's name and words.
pub(crate) type Change = fn(&str, &[u32]) -> Vec<u32>;

/// The code of a stage with every result that Vulkan does not round to the nearest moved by -3 to 3 units in the last place, and
/// every product that may be fused with a sum by -1 to 1, by a hash of its bits.
pub(crate) fn rough(_name: &str, spirv: &[u32]) -> Vec<u32> {
    let mut module = Module::new(spirv);
    let off_by = HashMap::from([(3, module.next()), (1, module.next())]);
    let mut words = spirv[..HEADER].to_vec();
    let moved: HashMap<u32, (u32, u32)> = module
        .inexact
        .iter()
        .map(|(&result, &most)| {
            module.bound += 1;
            (result, (module.bound - 1, off_by[&most]))
        })
        .collect();
    let mut declared = false;
    for instruction in instructions(spirv) {
        let code = instruction[0] & 0xffff;
        if code == FUNCTION && !declared {
            words.extend(module.declarations());
            declared = true;
        }
        // What is known of a result holds for the exact one.
        if code == DECORATE
            && let Some((exact, _)) = moved.get(&instruction[1])
        {
            words.extend([instruction[0], *exact]);
            words.extend_from_slice(&instruction[2..]);
            continue;
        }
        let result = if instruction.len() > 2 { moved.get(&instruction[2]) } else { None };
        let Some(&(exact, function)) = result.filter(|_| module.is_inexact(instruction)) else {
            words.extend_from_slice(instruction);
            continue;
        };
        words.extend([instruction[0], instruction[1], exact]);
        words.extend_from_slice(&instruction[3..]);
        let (ty, result) = (instruction[1], instruction[2]);
        let float = module.float;
        let Some(&count) = module.vectors.get(&ty) else {
            words.extend([5 << 16 | FUNCTION_CALL, ty, result, function, exact]);
            continue;
        };
        let parts: Vec<u32> = (0..count)
            .map(|part| {
                let (own, called) = (module.next(), module.next());
                words.extend([5 << 16 | COMPOSITE_EXTRACT, float, own, exact, part]);
                words.extend([5 << 16 | FUNCTION_CALL, float, called, function, own]);
                called
            })
            .collect();
        words.extend([(3 + count) << 16 | COMPOSITE_CONSTRUCT, ty, result]);
        words.extend(parts);
    }
    for (most, function) in off_by {
        let moving = module.mover(function, most);
        words.extend(moving);
    }
    words[3] = module.bound;
    words
}

/// What is known of a module, and what is added to it.
struct Module {
    bound: u32,
    float: u32,
    uint: u32,
    boolean: u32,
    /// float(float)
    function: u32,
    /// Vectors of floats and their lengths.
    vectors: HashMap<u32, u32>,
    /// Results that are moved, and by how much at most.
    inexact: HashMap<u32, u32>,
    constants: HashMap<u32, u32>,
    /// Types that were not there.
    added: Vec<u32>,
}

impl Module {
    fn new(spirv: &[u32]) -> Self {
        let mut types: HashMap<Vec<u32>, u32> = HashMap::new();
        let mut exact = HashSet::new();
        let mut products = HashSet::new();
        for instruction in instructions(spirv) {
            match instruction[0] & 0xffff {
                TYPE_BOOL | TYPE_INT | TYPE_FLOAT | TYPE_VECTOR | TYPE_FUNCTION => {
                    let key = std::iter::once(instruction[0]).chain(instruction[2..].iter().copied());
                    types.insert(key.collect(), instruction[1]);
                }
                DECORATE if instruction[2] == NO_CONTRACTION => drop(exact.insert(instruction[1])),
                F_MUL => drop(products.insert(instruction[2])),
                _ => {}
            }
        }
        let mut module = Self {
            bound: spirv[3],
            float: 0,
            uint: 0,
            boolean: 0,
            function: 0,
            vectors: HashMap::new(),
            inexact: HashMap::new(),
            constants: HashMap::new(),
            added: Vec::new(),
        };
        let get = |key: Vec<u32>, module: &mut Self| {
            types.get(&key).copied().unwrap_or_else(|| {
                let own = module.next();
                module.added.extend([key[0], own]);
                module.added.extend_from_slice(&key[1..]);
                own
            })
        };
        module.float = get(vec![3 << 16 | TYPE_FLOAT, 32], &mut module);
        module.uint = get(vec![4 << 16 | TYPE_INT, 32, 0], &mut module);
        module.boolean = get(vec![2 << 16 | TYPE_BOOL], &mut module);
        module.function = get(vec![4 << 16 | TYPE_FUNCTION, module.float, module.float], &mut module);
        for (key, &own) in types.iter().filter(|(key, _)| key[0] & 0xffff == TYPE_VECTOR && key[1] == module.float) {
            module.vectors.insert(own, key[2]);
        }
        for value in [0x9e37_79b1, 0x85eb_ca6b, 15, 24, 23, 7, 3, 1, 255, 253] {
            let own = module.next();
            module.constants.insert(value, own);
        }
        let is_float = |module: &Self, ty: u32| ty == module.float || module.vectors.contains_key(&ty);
        for instruction in instructions(spirv) {
            if module.is_inexact(instruction) && is_float(&module, instruction[1]) {
                let is_product = instruction[0] & 0xffff == F_MUL;
                module.inexact.entry(instruction[2]).or_insert(if is_product { 1 } else { 3 });
            }
        }
        // Of the products those stay that a sum takes, where neither forbids to fuse them.
        let fused: HashSet<u32> = instructions(spirv)
            .filter(|sum| [F_ADD, F_SUB].contains(&(sum[0] & 0xffff)) && !exact.contains(&sum[2]))
            .flat_map(|sum| [sum[3], sum[4]])
            .filter(|operand| products.contains(operand) && !exact.contains(operand))
            .collect();
        module.inexact.retain(|result, most| *most == 3 || fused.contains(result));
        module
    }

    /// Whether the instruction is one whose results are moved; products are looked through later.
    fn is_inexact(&self, instruction: &[u32]) -> bool {
        match instruction[0] & 0xffff {
            F_DIV | F_REM | F_MOD | DOT | F_MUL => true,
            EXT_INST => INEXACT_FUNCTIONS.iter().any(|range| range.contains(&instruction[4])),
            _ => false,
        }
    }

    fn next(&mut self) -> u32 {
        self.bound += 1;
        self.bound - 1
    }

    fn declarations(&self) -> Vec<u32> {
        let constants = self.constants.iter().flat_map(|(&value, &own)| [4 << 16 | CONSTANT, self.uint, own, value]);
        self.added.iter().copied().chain(constants).collect()
    }

    /// A function that moves a number by a hash of its bits, by `most` units at most; what is not normal stays.
    fn mover(&mut self, function: u32, most: u32) -> Vec<u32> {
        let (float, uint, boolean) = (self.float, self.uint, self.boolean);
        let steps = if most == 3 { 7 } else { 3 };
        let ids: Vec<u32> = (0..16).map(|_| self.next()).collect();
        let c = |value: u32| self.constants[&value];
        let [
            x,
            label,
            bits,
            mixed,
            high,
            folded,
            hash,
            top,
            step,
            signed,
            moved,
            shifted,
            exponent,
            less,
            normal,
            kept,
        ] = *ids.as_slice()
        else {
            unreachable!("sixteen were made")
        };
        let result = self.bound;
        self.bound += 1;
        let binary = |code: u32, own: u32, a: u32, b: u32| [5 << 16 | code, uint, own, a, b];
        let constants = [0x9e37_79b1, 15, 0x85eb_ca6b, 24, steps, most, 23, 255, 1].map(c);
        let [k1, fifteen, k2, twenty_four, steps, most, twenty_three, mask, one] = constants;
        let limit = c(253);
        let mut words = vec![5 << 16 | FUNCTION, float, function, 0, self.function];
        words.extend([3 << 16 | FUNCTION_PARAMETER, float, x, 2 << 16 | LABEL, label]);
        words.extend([4 << 16 | BITCAST, uint, bits, x]);
        words.extend(binary(I_MUL, mixed, bits, k1));
        words.extend(binary(SHIFT_RIGHT, high, mixed, fifteen));
        words.extend(binary(XOR, folded, mixed, high));
        words.extend(binary(I_MUL, hash, folded, k2));
        words.extend(binary(SHIFT_RIGHT, top, hash, twenty_four));
        words.extend(binary(U_MOD, step, top, steps));
        words.extend(binary(I_SUB, signed, step, most));
        words.extend(binary(I_ADD, moved, bits, signed));
        words.extend(binary(SHIFT_RIGHT, shifted, bits, twenty_three));
        words.extend(binary(AND, exponent, shifted, mask));
        words.extend(binary(I_SUB, less, exponent, one));
        words.extend([5 << 16 | U_LESS_THAN, boolean, normal, less, limit]);
        words.extend([6 << 16 | SELECT, uint, kept, normal, moved, bits]);
        words.extend([4 << 16 | BITCAST, float, result, kept]);
        words.extend([2 << 16 | RETURN_VALUE, result, 1 << 16 | FUNCTION_END]);
        words
    }
}
