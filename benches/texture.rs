//! Noise beside other crates: samples a second of gradient noise in space and of its fbm (4 octaves), on a grid of
//! 128 x 128 x 64 points; and synthesis from an example.
#![allow(missing_docs, reason = "criterion_group! makes an undocumented function")]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use noise::{MultiFractal, NoiseFn};
use pantin::texture::example::{Settings, synthesise};
use pantin::texture::materials::{Material, Parameters};
use pantin::texture::noise::{HashLattice, Octaves, Perlin, TableLattice, Tables, Value};

const SIZE: [usize; 3] = [128, 128, 64];
const SAMPLES: usize = SIZE[0] * SIZE[1] * SIZE[2];
const FREQUENCY: f32 = 0.037;

fn grid() -> [Vec<f32>; 3] {
    let at = |i: usize| [i % SIZE[0], i / SIZE[0] % SIZE[1], i / SIZE[0] / SIZE[1]];
    std::array::from_fn(|axis| (0..SAMPLES).map(|i| at(i)[axis] as f32).collect())
}

fn of_noise(criterion: &mut Criterion) {
    let grid = grid();
    let rows = [grid[0].as_slice(), grid[1].as_slice(), grid[2].as_slice()];
    let mut out = vec![0.0; SAMPLES];
    let lattice = HashLattice::new(1);
    let tables = Tables::new(1);
    let point = |i: usize| [grid[0][i], grid[1][i], grid[2][i]];
    for count in [1, 4] {
        let octaves = Octaves { count, frequency: FREQUENCY, ..Octaves::default() };
        let mut group = criterion.benchmark_group(format!("{count} octaves"));
        group.throughput(Throughput::Elements(SAMPLES as u64)).sample_size(10);
        group.bench_function("pantin perlin, all threads", |b| {
            b.iter(|| octaves.fill(Perlin, &lattice, black_box(rows), &mut out));
        });
        // The work of one task after another: one thread.
        let single = |b: &mut criterion::Bencher<'_>, value: bool, out: &mut [f32]| {
            b.iter(|| {
                for (i, out) in out.chunks_mut(4096).enumerate() {
                    let rows = black_box(rows).map(|row| &row[i * 4096..][..out.len()]);
                    if value {
                        octaves.fill(Value, &lattice, rows, out);
                    } else {
                        octaves.fill(Perlin, &lattice, rows, out);
                    }
                }
            });
        };
        group.bench_function("pantin perlin, one thread", |b| single(b, false, &mut out));
        group.bench_function("pantin value, one thread", |b| single(b, true, &mut out));
        group.bench_function("pantin perlin, one point at a time", |b| {
            b.iter(|| (0..SAMPLES / 8).for_each(|i| out[i] = octaves.at(Perlin, &lattice, [0.0; 3], point(i))));
        });
        group.bench_function("pantin perlin from tables, one point at a time", |b| {
            let lattice = TableLattice::new(&tables);
            b.iter(|| (0..SAMPLES / 8).for_each(|i| out[i] = octaves.at(Perlin, &lattice, [0.0; 3], point(i))));
        });
        group.bench_function("simdnoise, one thread", |b| {
            b.iter(|| {
                let [x, y, z] = SIZE;
                if count == 1 {
                    simdnoise::NoiseBuilder::gradient_3d(x, y, z).with_freq(FREQUENCY).generate()
                } else {
                    simdnoise::NoiseBuilder::fbm_3d(x, y, z).with_freq(FREQUENCY).with_octaves(4).generate()
                }
            });
        });
        let mut lite = fastnoise_lite::FastNoiseLite::with_seed(1);
        lite.set_noise_type(Some(fastnoise_lite::NoiseType::Perlin));
        lite.set_frequency(Some(FREQUENCY));
        if count > 1 {
            lite.set_fractal_type(Some(fastnoise_lite::FractalType::FBm));
            lite.set_fractal_octaves(Some(count as i32));
        }
        group.bench_function("fastnoise-lite, one thread", |b| {
            b.iter(|| {
                for (i, out) in out.iter_mut().enumerate() {
                    let [x, y, z] = point(i);
                    *out = lite.get_noise_3d(x, y, z);
                }
            });
        });
        let fbm = noise::Fbm::<noise::Perlin>::new(1).set_octaves(count as usize).set_frequency(f64::from(FREQUENCY));
        group.bench_function("noise-rs, one thread", |b| {
            b.iter(|| {
                for (i, out) in out.iter_mut().enumerate() {
                    *out = fbm.get(point(i).map(f64::from)) as f32;
                }
            });
        });
        group.finish();
    }
}

/// Time over the size of the result and the number of threads; 64 x 64 pixels of brick.
fn from_example(criterion: &mut Criterion) {
    let Ok(brick) = Material::new("brick", Parameters::Defaults, 1, None) else { return };
    let example = image::RgbImage::from_fn(64, 64, |x, y| {
        image::Rgb(brick.at([x as f32 * 0.03, y as f32 * 0.03, 0.2]).colour.map(|c| (c * 255.0) as u8))
    });
    let mut group = criterion.benchmark_group("from an example");
    group.sample_size(10);
    for side in [64, 128, 256] {
        for threads in [1, 2] {
            let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads).build() else { return };
            for delta_max in [0.0, 0.004, 1.0] {
                let settings = Settings { size: [side, side], delta_max, ..Settings::default() };
                let name = format!("{side} x {side}, delta_max {delta_max}, {threads} threads");
                group.throughput(Throughput::Elements(u64::from(side * side)));
                group.bench_function(name, |b| {
                    b.iter(|| pool.install(|| synthesise(black_box(&example), None, &settings, None, || ())));
                });
            }
        }
    }
    group.finish();
}

criterion_group!(texture, of_noise, from_example);
criterion_main!(texture);
