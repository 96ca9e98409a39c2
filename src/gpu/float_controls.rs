//! How a device is to round: asked for in the code itself, where the device lets one (VK_KHR_shader_float_controls).

use super::capability::Capabilities;
use super::spirv::{HEADER, instructions, op};

/// A mode of floating point and the capability it needs, as numbered in the SPIR-V specification.
struct Mode {
    execution_mode: u32,
    capability: u32,
}

const DENORM_PRESERVE: Mode = Mode { execution_mode: 4459, capability: 4464 };
const ROUNDING_MODE_RTE: Mode = Mode { execution_mode: 4462, capability: 4467 };

/// The code of a stage with the modes that a device of these capabilities lets one ask for: sums and products rounded to the
/// nearest, and numbers below 2^-126 kept.
pub(super) fn controlled(spirv: &[u32], capabilities: &Capabilities) -> Vec<u32> {
    let offered =
        [(capabilities.rounds_to_nearest, ROUNDING_MODE_RTE), (capabilities.keeps_denormals, DENORM_PRESERVE)];
    let modes: Vec<Mode> = offered.into_iter().filter_map(|(offered, mode)| offered.then_some(mode)).collect();
    if modes.is_empty() {
        return spirv.to_vec();
    }
    let mut words = spirv[..HEADER].to_vec();
    words.extend(modes.iter().flat_map(|mode| [2 << 16 | op::CAPABILITY, mode.capability]));
    let mut is_extended = false;
    let mut before = op::CAPABILITY;
    for instruction in instructions(spirv) {
        let code = instruction[0] & 0xffff;
        if code != op::CAPABILITY && !is_extended {
            let name = text(b"SPV_KHR_float_controls");
            words.push((name.len() as u32 + 1) << 16 | op::EXTENSION);
            words.extend(name);
            is_extended = true;
        }
        if before == op::ENTRY_POINT && code != op::ENTRY_POINT {
            let entry = entry_point(spirv);
            words.extend(modes.iter().flat_map(|mode| [4 << 16 | op::EXECUTION_MODE, entry, mode.execution_mode, 32]));
        }
        words.extend_from_slice(instruction);
        before = code;
    }
    words
}

/// The number of the stage's one entry point.
fn entry_point(spirv: &[u32]) -> u32 {
    instructions(spirv).find(|instruction| instruction[0] & 0xffff == op::ENTRY_POINT).map_or(0, |found| found[2])
}

/// A string as SPIR-V holds it: four bytes a word, zeros behind it.
fn text(bytes: &[u8]) -> Vec<u32> {
    let mut padded = bytes.to_vec();
    padded.resize((bytes.len() + 4) / 4 * 4, 0);
    padded.chunks_exact(4).map(|four| four.iter().rev().fold(0, |word, &byte| word << 8 | u32::from(byte))).collect()
}
