//! Noise beside other crates: samples a second of gradient noise in space and of its fbm (4 octaves), on a grid of
//! 128 x 128 x 64 points, the processor beside a device; pictures of materials by size and way of noise, the processor beside a device; and synthesis from an
//! example.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark ends where something fails, and says what it leaves out"
)]

mod table;

use std::hint::black_box;

use noise::{MultiFractal, NoiseFn};
use pantin::evaluate::device::open_device;
use pantin::gpu::{Device, Memory, Recording, Timing};
use pantin::texture::device::{DeviceNoise, NoiseKind, NoiseRequest, NoiseSource};
use pantin::texture::example::{Example, Settings, synthesise};
use pantin::texture::materials::{Material, MaterialKind, Parameters};
use pantin::texture::noise::{HashLattice, NoiseWay, Octaves, Perlin, TableLattice, Tables, Value};
use pantin::texture::painter::Painter;
use pantin::texture::picture::View;
use table::{Table, is_measuring};

const FREQUENCY: f32 = 0.037;

/// The work of one task after another.
fn on_one_thread(rows: [&[f32]; 3], out: &mut [f32], fill: impl Fn([&[f32]; 3], &mut [f32])) {
    for (i, out) in out.chunks_mut(4096).enumerate() {
        fill(black_box(rows).map(|row| &row[i * 4096..][..out.len()]), out);
    }
}

/// One pass of a device over all points, from submission to the wait for it.
fn on_device(device: &Device, rows: [&[f32]; 3], octaves: Octaves, source: NoiseSource<'_>) -> Recording {
    let samples = rows[0].len();
    let at: Vec<[f32; 4]> = (0..samples).map(|i| [rows[0][i], rows[1][i], rows[2][i], 0.0]).collect();
    let points = device.buffer::<[f32; 4]>("points", samples, Memory::Upload).unwrap();
    points.write(0, &at).unwrap();
    let out = ["values", "words"].map(|name| device.buffer::<f32>(name, samples, Memory::Device).unwrap());
    let request = NoiseRequest { dimensions: 3, kind: NoiseKind::Perlin, octaves, source, tile: [0.0; 4] };
    let mut recorder = device.recorder(Timing::Off).unwrap();
    let noise = DeviceNoise::new(device, &request).unwrap();
    noise.record(&mut recorder, &points, &out[0], &out[1], samples as u32).unwrap();
    recorder.finish().unwrap()
}

fn of_noise() {
    let device = open_device().map_err(|error| println!("SKIPPED noise on a device: {error:#}")).ok();
    let size = if is_measuring() { [128, 128, 64] } else { [128, 8, 4] };
    let samples = size.iter().product::<usize>();
    let at = |i: usize| [i % size[0], i / size[0] % size[1], i / size[0] / size[1]];
    let grid: [Vec<f32>; 3] = std::array::from_fn(|axis| (0..samples).map(|i| at(i)[axis] as f32).collect());
    let rows = [grid[0].as_slice(), grid[1].as_slice(), grid[2].as_slice()];
    let (lattice, tables) = (HashLattice::new(1), Tables::new(1));
    let (lattice, from_tables) = (&lattice, TableLattice::new(&tables));
    let point = |i: usize| [rows[0][i], rows[1][i], rows[2][i]];
    for count in [1, 4] {
        let octaves = Octaves { count, frequency: FREQUENCY, ..Octaves::default() };
        let mut table = Table::new(format!("{count} octaves"), "sample");
        let samples_out = || vec![0.0_f32; samples];
        let mut out = samples_out();
        table.row("pantin perlin, all threads", samples, move || {
            octaves.fill(Perlin, lattice, black_box(rows), &mut out)
        });
        let mut out = samples_out();
        table.row("pantin perlin, one thread", samples, move || {
            on_one_thread(rows, &mut out, |rows, out| octaves.fill(Perlin, lattice, rows, out));
        });
        let mut out = samples_out();
        table.row("pantin value, one thread", samples, move || {
            on_one_thread(rows, &mut out, |rows, out| octaves.fill(Value, lattice, rows, out));
        });
        // An eighth of the points.
        let mut out = samples_out();
        table.row("pantin perlin, one point at a time", samples / 8, move || {
            (0..samples / 8).for_each(|i| out[i] = octaves.at(Perlin, lattice, [0.0; 3], point(i)));
        });
        for (name, source) in
            [("perlin", NoiseSource::Hash(*lattice)), ("perlin from tables", NoiseSource::Tables(&tables))]
        {
            if let Some(device) = &device {
                let mut pass = on_device(device, rows, octaves, source);
                table.row(format!("pantin {name}, device"), samples, move || pass.run().unwrap());
            }
        }
        let (mut out, from_tables) = (samples_out(), &from_tables);
        table.row("pantin perlin from tables, one point at a time", samples / 8, move || {
            (0..samples / 8).for_each(|i| out[i] = octaves.at(Perlin, from_tables, [0.0; 3], point(i)));
        });
        table.row("simdnoise, one thread", samples, move || {
            let [x, y, z] = size;
            if count == 1 {
                simdnoise::NoiseBuilder::gradient_3d(x, y, z).with_freq(FREQUENCY).generate()
            } else {
                simdnoise::NoiseBuilder::fbm_3d(x, y, z).with_freq(FREQUENCY).with_octaves(4).generate()
            }
        });
        let mut lite = fastnoise_lite::FastNoiseLite::with_seed(1);
        lite.set_noise_type(Some(fastnoise_lite::NoiseType::Perlin));
        lite.set_frequency(Some(FREQUENCY));
        if count > 1 {
            lite.set_fractal_type(Some(fastnoise_lite::FractalType::FBm));
            lite.set_fractal_octaves(Some(count as i32));
        }
        let mut out = samples_out();
        table.row("fastnoise-lite, one thread", samples, move || {
            for (i, out) in out.iter_mut().enumerate() {
                let [x, y, z] = point(i);
                *out = lite.get_noise_3d(x, y, z);
            }
        });
        let fbm = noise::Fbm::<noise::Perlin>::new(1).set_octaves(count as usize).set_frequency(f64::from(FREQUENCY));
        let mut out = samples_out();
        table.row("noise-rs, one thread", samples, move || {
            for (i, out) in out.iter_mut().enumerate() {
                *out = fbm.get(point(i).map(f64::from)) as f32;
            }
        });
        table.run();
    }
}

/// Time over the size of the result and the number of threads; 64 x 64 pixels of brick.
fn from_example() {
    let brick = Material::new("brick", Parameters::Defaults, 1, None).unwrap();
    let example = image::RgbImage::from_fn(64, 64, |x, y| {
        image::Rgb(brick.at([x as f32 * 0.03, y as f32 * 0.03, 0.2]).colour.map(|c| (c * 255.0) as u8))
    });
    let sides: &[u32] = if is_measuring() { &[64, 128, 256] } else { &[24] };
    let mut table = Table::new("from an example", "pixel");
    for &side in sides {
        for threads in [1, 2] {
            for delta_max in [0.0, 0.004, 1.0] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                let settings = Settings { size: [side, side], delta_max, ..Settings::default() };
                let name = format!("{side} x {side}, delta_max {delta_max}, {threads} threads");
                let examples = [Example { picture: &example, mask: None }];
                table.row(name, (side * side) as usize, move || {
                    pool.install(|| synthesise(black_box(&examples), None, &settings, None, || ()))
                });
            }
        }
    }
    table.run();
}

/// Pictures of every material, of a few by each way of noise, and of one by size: pixels a second, and how often as fast as the
/// processor.
fn of_materials() {
    let device = open_device().map_err(|error| println!("SKIPPED pictures of materials by a device: {error:#}")).ok();
    let seed = 1;
    let rows = |title: String, side: u32, materials: &[(NoiseWay, MaterialKind)]| {
        let view = View { size: [side, side], offset: [0.0; 3], scale: 4.0 };
        let pixels = (side * side) as usize;
        let made: Vec<Material> = materials
            .iter()
            .map(|&(way, kind)| Material::of_noise(way, kind.name(), Parameters::Defaults, seed, None).unwrap())
            .collect();
        let mut table = Table::new(title, "pixel");
        for (material, (way, kind)) in made.iter().zip(materials) {
            for (place, device) in [("cpu", None), ("device", device.as_ref())] {
                if place == "device" && device.is_none() {
                    continue;
                }
                let painter = Painter::new(material, device).unwrap();
                let name = format!("{kind}, {way} noise, {side} x {side}, {place}");
                table.row(name, pixels, move || painter.flat(black_box(&view)).unwrap());
            }
        }
        table.run();
    };
    let usual = if is_measuring() { 512 } else { 16 };
    let all: Vec<_> = MaterialKind::ALL.into_iter().map(|kind| (NoiseWay::Arithmetic, kind)).collect();
    rows("pictures of materials".into(), usual, &all);
    let ways: Vec<_> = [MaterialKind::Marble, MaterialKind::Terrain]
        .into_iter()
        .flat_map(|kind| NoiseWay::ALL.into_iter().map(move |way| (way, kind)))
        .collect();
    rows("ways of noise".into(), usual, &ways);
    let sides: &[u32] = if is_measuring() { &[64, 256, 1024, 2048] } else { &[8] };
    for &side in sides {
        rows(format!("pictures of {side} x {side}"), side, &[(NoiseWay::Arithmetic, MaterialKind::Marble)]);
    }
}

fn main() {
    of_noise();
    of_materials();
    from_example();
}
