//! The packed observation: what one camera saw in one frame, one byte a pixel (SPEC A5.5).

/// One camera's packed observation: bit 7 the silhouette, bits 0..=6 the edge proximity (127 on an edge, 0 far away).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Observation {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// Row-major bytes, `width * height` of them.
    pub bytes: Vec<u8>,
}

impl Observation {
    /// Bit of the silhouette in a packed byte.
    pub const SILHOUETTE: u8 = 0x80;
    /// Bits of the edge proximity in a packed byte.
    pub const PROXIMITY: u8 = 0x7f;

    /// An observation of nothing.
    pub fn empty(width: u32, height: u32) -> Self {
        Self { width, height, bytes: vec![0; width as usize * height as usize] }
    }

    /// The number of silhouette pixels.
    pub fn area(&self) -> u32 {
        self.bytes.iter().map(|byte| u32::from(byte >> 7)).sum()
    }
}
