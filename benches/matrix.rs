//! Products of matrices of integers: by bit planes and by multiplying, on the processor and on a device. A unit of work is a
//! multiplication and addition of two elements.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark ends where something fails, and prints a table"
)]

mod table;

use std::hint::black_box;

use pantin::evaluate::device::open_device;
use pantin::matrix::{DeviceProduct, DeviceWay, Square, bit_plane_product, integer_product};
use table::{Table, is_measuring};

/// The product as one writes it first, row by column, in the narrowest type that holds its sums.
fn in_32_bits(a: &[i32], b: &[i32], n: usize, product: &mut [i32]) {
    for (i, out) in product.chunks_mut(n).enumerate() {
        out.fill(0);
        for (k, &factor) in a[i * n..][..n].iter().enumerate() {
            out.iter_mut().zip(&b[k * n..][..n]).for_each(|(sum, &element)| *sum += factor * element);
        }
    }
}

fn main() {
    let device = open_device();
    if let Err(error) = &device {
        println!("no device: {error:#}");
    }
    let sizes: &[usize] = if is_measuring() { &[256, 1024] } else { &[40] };
    for &n in sizes {
        for bits in [2, 4, 8] {
            let (a, b) = (Square::drawn(n, bits, 1).unwrap(), Square::drawn(n, bits, 2).unwrap());
            let expected = integer_product(&a, &b).unwrap();
            assert_eq!(bit_plane_product(&a, &b).unwrap(), expected);
            let mut table = Table::new(format!("{n} x {n}, {bits} bits"), "product");
            let work = n * n * n;
            let (a, b) = (&a, &b);
            table.row("bit planes, processor", work, move || bit_plane_product(black_box(a), b).unwrap());
            let narrow = |of: &Square| of.elements().iter().map(|&element| element as i32).collect::<Vec<_>>();
            let (left, right, mut out) = (narrow(a), narrow(b), vec![0; n * n]);
            table.row("32-bit integers, processor, one thread", work, move || {
                in_32_bits(black_box(&left), &right, n, &mut out);
            });
            table
                .row("64-bit integers, processor, one thread", work, move || integer_product(black_box(a), b).unwrap());
            if let Ok(device) = &device {
                for (name, way) in [("bit planes", DeviceWay::BitPlanes), ("integers", DeviceWay::Integers)] {
                    let mut product = DeviceProduct::new(device, way, a, b).unwrap();
                    product.run().unwrap();
                    assert_eq!(product.read().unwrap(), expected);
                    if is_measuring() {
                        println!(
                            "{n} x {n}, {bits} bits, {name}: {:.3} ms on the device",
                            product.milliseconds().unwrap()
                        );
                    }
                    table.row(format!("{name}, device"), work, move || product.run().unwrap());
                }
            }
            table.run();
        }
    }
}
