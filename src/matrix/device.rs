//! Products of matrices on a device, by bit planes and by integers: the integers of [`super::integer_product`].

use anyhow::Result;

use super::planes::device_words;
use super::shaders::{bit_planes_comp, integers_comp};
use super::square::{Square, check_pair, sum_bits};
use crate::gpu::{Buffer, Device, Groups, Memory, Recording, Timing};

/// How a device multiplies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeviceWay {
    /// AND and bit counts.
    BitPlanes,
    /// Multiplications: in 32 bits where the sums fit them, else in 64.
    Integers,
}

/// A product of two matrices, recorded, to be run any number of times.
#[derive(Debug)]
pub struct DeviceProduct {
    product: Buffer,
    recording: Recording,
    n: usize,
}

impl DeviceProduct {
    /// Hands the matrices to the device and records the product.
    ///
    /// # Errors
    /// When the matrices are of unlike size or bits, or the device has no memory for them.
    pub fn new(device: &Device, way: DeviceWay, a: &Square, b: &Square) -> Result<Self> {
        check_pair(a, b)?;
        let (n, bits) = (a.n(), a.bits());
        let product = device.buffer::<[u32; 2]>("matrix product", n * n, Memory::Readback)?;
        let upload = |name: &'static str, words: &[u32]| -> Result<Buffer> {
            let buffer = device.buffer::<u32>(name, words.len(), Memory::Upload)?;
            buffer.write(0, words)?;
            Ok(buffer)
        };
        let mut recorder = device.recorder(Timing::Stamps)?;
        let groups = Groups::Over([n as u32, n as u32, 1]);
        match way {
            DeviceWay::BitPlanes => {
                let rows = upload("planes of rows", &device_words(a, false))?;
                let columns = upload("planes of columns", &device_words(b, true))?;
                let bindings =
                    bit_planes_comp::Bindings { row_planes: &rows, column_planes: &columns, product: &product };
                let push = bit_planes_comp::Push { n: n as u32, bits, words: n.div_ceil(32) as u32 };
                recorder.run(bindings.dispatch(push, groups))?;
            }
            DeviceWay::Integers => {
                let words = |of: &Square| of.elements().iter().map(|&element| element as u32).collect::<Vec<_>>();
                let (a, b) = (upload("matrix A", &words(a))?, upload("matrix B", &words(b))?);
                let constants = integers_comp::Constants { wide: u32::from(sum_bits(n, bits) > 32) };
                let push = integers_comp::Push { n: n as u32 };
                let bindings = integers_comp::Bindings { a: &a, b: &b, product: &product };
                recorder.run(bindings.dispatch(constants, push, groups))?;
            }
        }
        Ok(Self { product, recording: recorder.finish()?, n })
    }

    /// Multiplies, and waits.
    ///
    /// # Errors
    /// When the device fails.
    pub fn run(&mut self) -> Result<()> {
        self.recording.run()
    }

    /// Milliseconds of the last run on the device itself.
    ///
    /// # Errors
    /// When the device gives no times.
    pub fn milliseconds(&mut self) -> Result<f64> {
        Ok(crate::gpu::by_name(&self.recording.timings()?).iter().map(|(_, ms, _)| ms).sum())
    }

    /// What the last run gave, row by row.
    ///
    /// # Errors
    /// When the device's memory cannot be read.
    pub fn read(&self) -> Result<Vec<i64>> {
        let mut words = vec![[0_u32; 2]; self.n * self.n];
        self.product.read(0, &mut words)?;
        Ok(words.into_iter().map(|[low, high]| (u64::from(high) << 32 | u64::from(low)) as i64).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::super::integer_product;
    use super::*;
    use crate::gpu::DeviceSettings;
    use crate::gpu::test_device::device;

    #[test]
    fn a_device_has_the_product_of_the_integers() {
        let name = "a_device_has_the_product_of_the_integers";
        let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
        let multiplied = |way, a: &Square, b: &Square| {
            let mut product = DeviceProduct::new(&device, way, a, b).unwrap();
            product.run().unwrap();
            product.read().unwrap()
        };
        for (n, bits) in [(1, 2), (3, 32 - 1), (16, 8), (33, 16), (40, 17), (70, 28), (65, 5)] {
            let (least, largest) = (-(1_i64 << (bits - 1)), (1_i64 << (bits - 1)) - 1);
            let filled = |element| Square::filled(n, bits, element).unwrap();
            let (a, b) = (Square::drawn(n, bits, 1).unwrap(), Square::drawn(n, bits, 2).unwrap());
            let pairs = [
                (a, b),
                (filled(least), filled(least)),
                (filled(least), filled(largest)),
                (filled(-1), filled(largest)),
            ];
            for (a, b) in &pairs {
                let expected = integer_product(a, b).unwrap();
                for way in [DeviceWay::BitPlanes, DeviceWay::Integers] {
                    assert_eq!(multiplied(way, a, b), expected, "{n} x {n} of {bits} bits, {way:?}");
                }
            }
            // A bit that is turned shows (one element may be multiplied by 0).
            if n == 1 {
                continue;
            }
            let mut elements = pairs[0].0.elements().to_vec();
            elements[n * n - 1] ^= 1;
            let other = Square::new(n, bits, elements).unwrap();
            let expected = integer_product(&pairs[0].0, &pairs[0].1).unwrap();
            assert_ne!(multiplied(DeviceWay::BitPlanes, &other, &pairs[0].1), expected);
        }
        drop(device);
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}
