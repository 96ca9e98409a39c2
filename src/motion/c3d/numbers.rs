//! Numbers of the three processors that C3D files come from.

use anyhow::{Result, bail};

/// The machine whose number formats a file uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Processor {
    /// Little-endian, IEEE reals.
    Intel,
    /// Little-endian integers, VAX F reals.
    Dec,
    /// Big-endian, IEEE reals.
    Mips,
}

impl Processor {
    /// From the fourth byte of the parameter section.
    pub(super) fn from_code(code: u8) -> Result<Self> {
        match code {
            84 => Ok(Self::Intel),
            85 => Ok(Self::Dec),
            86 => Ok(Self::Mips),
            other => bail!("the processor code is {other}, expected 84 (Intel), 85 (DEC) or 86 (MIPS)"),
        }
    }

    pub(super) fn u16(self, bytes: [u8; 2]) -> u16 {
        match self {
            Self::Intel | Self::Dec => u16::from_le_bytes(bytes),
            Self::Mips => u16::from_be_bytes(bytes),
        }
    }

    pub(super) fn i16(self, bytes: [u8; 2]) -> i16 {
        self.u16(bytes).cast_signed()
    }

    pub(super) fn f32(self, bytes: [u8; 4]) -> f32 {
        match self {
            Self::Intel => f32::from_le_bytes(bytes),
            Self::Mips => f32::from_be_bytes(bytes),
            Self::Dec => vax_f(bytes),
        }
    }
}

/// A VAX F real: two little-endian words, the high one first; 0.1m binary times 2^(e - 128). There is no infinity;
/// exponent 0 with a sign is "reserved", which stands here as NaN.
fn vax_f(bytes: [u8; 4]) -> f32 {
    let bits = u32::from_le_bytes([bytes[2], bytes[3], bytes[0], bytes[1]]);
    let (negative, exponent, fraction) = (bits >> 31 != 0, (bits >> 23) & 0xff, bits & 0x7f_ffff);
    if exponent == 0 {
        return if negative { f32::NAN } else { 0.0 };
    }
    let magnitude = (1.0 + f64::from(fraction) / f64::from(1 << 23)) * 2f64.powi(exponent.cast_signed() - 129);
    (if negative { -magnitude } else { magnitude }) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_numbers_on_three_machines() {
        // 50 and -1.5 as the three write them; the VAX bytes are those of a real file's rate.
        for (processor, bytes, expected) in [
            (Processor::Intel, [0x00, 0x00, 0x48, 0x42], 50.0),
            (Processor::Mips, [0x42, 0x48, 0x00, 0x00], 50.0),
            (Processor::Dec, [0x48, 0x43, 0x00, 0x00], 50.0),
            (Processor::Dec, [0xc0, 0xc0, 0x00, 0x00], -1.5),
            (Processor::Dec, [0x00, 0x00, 0x00, 0x00], 0.0),
            (Processor::Dec, [0xff, 0x7f, 0xff, 0xff], 1.701_411_7e38),
        ] {
            assert_eq!(processor.f32(bytes), expected, "{processor:?} {bytes:x?}");
        }
        assert!(Processor::Dec.f32([0x00, 0x80, 0x00, 0x00]).is_nan());
        assert_eq!(Processor::Mips.i16([0xff, 0xfe]), -2);
        assert_eq!(Processor::Dec.i16([0xfe, 0xff]), -2);
        assert!(Processor::from_code(0).unwrap_err().to_string().contains("code is 0"));
    }
}
