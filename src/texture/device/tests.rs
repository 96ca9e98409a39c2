//! The device's noise beside the CPU's, under the validation layer.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use super::*;
use crate::gpu::rough::{Change, rough};
use crate::gpu::test_device::{device, device_under};
use crate::gpu::{DeviceSettings, ImageUse, Timing, Validation, by_name};
use crate::texture::noise::{FARTHEST, Noise, Perlin, Sum, Value, hard_coordinates};
use crate::texture::shaders::FARTHEST_BITS;

/// Values and words of a request at points, and the milliseconds of the dispatch.
fn on_device(device: &Device, request: &NoiseRequest<'_>, points: &[[f32; 4]]) -> (Vec<f32>, Vec<u32>, f64) {
    let noise = DeviceNoise::new(device, request).unwrap();
    let input = device.buffer::<[f32; 4]>("points", points.len(), Memory::Upload).unwrap();
    input.write(0, points).unwrap();
    let values = device.buffer::<f32>("values", points.len(), Memory::Readback).unwrap();
    let words = device.buffer::<u32>("words", points.len(), Memory::Readback).unwrap();
    let mut recorder = device.recorder(Timing::Stamps).unwrap();
    noise.record(&mut recorder, &input, &values, &words, points.len() as u32).unwrap();
    let mut recording = recorder.finish().unwrap();
    let mut best = f64::MAX;
    for _ in 0..3 {
        recording.run().unwrap();
        best = by_name(&recording.timings().unwrap()).first().map_or(best, |(_, ms, _)| best.min(*ms));
    }
    let (mut found, mut found_words) = (vec![0.0; points.len()], vec![0; points.len()]);
    values.read(0, &mut found).unwrap();
    words.read(0, &mut found_words).unwrap();
    (found, found_words, best)
}

/// The word of a point's cell in the first octave, by the lattice alone.
fn word(lattice: &impl Lattice, dimensions: usize, p: [f32; 4], octaves: &Octaves, tile: [f32; 4]) -> u32 {
    let row = octaves.rows(tile).next().unwrap();
    let cell = |axis: usize| {
        let cell = (p[axis].clamp(-FARTHEST, FARTHEST) * row.frequency[axis]).floor() as i32;
        if row.period[axis] > 0 { cell.rem_euclid(row.period[axis]) } else { cell }
    };
    lattice.word((1..dimensions).fold(lattice.first(cell(0)), |share, axis| lattice.join(share, axis, cell(axis))))
}

fn agree<const N: usize>(device: &Device, points: &[[f32; 4]], request: &NoiseRequest<'_>)
where
    Perlin: Noise<N>,
    Value: Noise<N>,
{
    let (values, words, _) = on_device(device, request, points);
    for (i, p) in points.iter().enumerate() {
        let first: [f32; N] = std::array::from_fn(|axis| p[axis]);
        let tile: [f32; N] = std::array::from_fn(|axis| request.tile[axis]);
        macro_rules! with {
            ($lattice:expr) => {{
                let lattice = $lattice;
                let value = match request.kind {
                    NoiseKind::Perlin => request.octaves.at(Perlin, &lattice, tile, first),
                    NoiseKind::Value => request.octaves.at(Value, &lattice, tile, first),
                };
                (value, word(&lattice.octave(0), N, *p, &request.octaves, request.tile))
            }};
        }
        let (value, word) = match request.source {
            NoiseSource::Hash(lattice) => with!(lattice),
            NoiseSource::Tables(tables) => with!(TableLattice::new(tables)),
        };
        assert_eq!(words[i], word, "{request:?} at {p:?}");
        assert_eq!(
            values[i].to_bits(),
            value.to_bits(),
            "{request:?} at {p:?}: {} on the device, {value} here",
            values[i]
        );
    }
}

#[test]
fn a_device_has_the_words_and_values_of_the_cpu() {
    for code in [None, Some(rough as Change)] {
        let settings = DeviceSettings { code, ..DeviceSettings::default() };
        let Some((device, log)) = device("a_device_has_the_words_and_values_of_the_cpu", settings) else { return };
        check_noise(&device);
        drop(device);
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

fn check_noise(device: &Device) {
    assert_eq!(f32::from_bits(FARTHEST_BITS), FARTHEST);
    let rows: Vec<Vec<f32>> = (0..4).map(|axis| hard_coordinates(100_000, 40 + axis)).collect();
    let points: Vec<[f32; 4]> = (0..100_000).map(|i| [rows[0][i], rows[1][i], rows[2][i], rows[3][i]]).collect();
    let tables = Tables::new(3);
    let (hash, table) = (NoiseSource::Hash(HashLattice::new(3)), NoiseSource::Tables(&tables));
    let one = Octaves { count: 1, ..Octaves::default() };
    let four = |sum| Octaves { sum, frequency: 1.3, ..Octaves::default() };
    for kind in [NoiseKind::Perlin, NoiseKind::Value] {
        let request = |dimensions, octaves, source, tile| NoiseRequest { dimensions, kind, octaves, source, tile };
        agree::<1>(device, &points, &request(1, one, hash, [0.0; 4]));
        agree::<2>(device, &points, &request(2, one, hash, [0.0; 4]));
        agree::<3>(device, &points, &request(3, one, hash, [0.0; 4]));
        agree::<4>(device, &points, &request(4, one, hash, [0.0; 4]));
        agree::<3>(device, &points, &request(3, one, table, [0.0; 4]));
        agree::<3>(device, &points, &request(3, four(Sum::Turbulence), hash, [0.0; 4]));
        agree::<2>(device, &points, &request(2, four(Sum::Ridged), table, [0.0; 4]));
        agree::<3>(device, &points, &request(3, four(Sum::Fbm), hash, [7.0, 3.5, 0.0, 0.0]));
    }
}

#[test]
fn fragments_have_the_values_of_compute() {
    let name = "fragments_have_the_values_of_compute";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let size = [250, 160];
    let rows: Vec<Vec<f32>> = (0..4).map(|axis| hard_coordinates(40_000, 70 + axis)).collect();
    let points: Vec<[f32; 4]> = (0..40_000).map(|i| [rows[0][i], rows[1][i], rows[2][i], rows[3][i]]).collect();
    let tables = Tables::new(3);
    for (dimensions, kind, source) in [
        (3, NoiseKind::Perlin, NoiseSource::Hash(HashLattice::new(9))),
        (2, NoiseKind::Perlin, NoiseSource::Tables(&tables)),
        (4, NoiseKind::Value, NoiseSource::Hash(HashLattice::new(9))),
    ] {
        let request =
            NoiseRequest { dimensions, kind, octaves: Octaves::default(), source, tile: [0.0, 3.0, 0.0, 0.0] };
        let (computed, _, _) = on_device(&device, &request, &points);
        let noise = DeviceNoise::new(&device, &request).unwrap();
        let input = device.buffer::<[f32; 4]>("points", points.len(), Memory::Upload).unwrap();
        input.write(0, &points).unwrap();
        let picture = device.image("noise", Format::R32Float, size, ImageUse::Target).unwrap();
        let output = device.buffer::<f32>("values", points.len(), Memory::Readback).unwrap();
        let mut recorder = device.recorder(Timing::Off).unwrap();
        noise.record_picture(&mut recorder, &input, &picture).unwrap();
        recorder.read_image("read", &picture, [0, 0, size[0], size[1]], (&output, 0)).unwrap();
        recorder.finish().unwrap().run().unwrap();
        let mut drawn = vec![0.0_f32; points.len()];
        output.read(0, &mut drawn).unwrap();
        for ((drawn, computed), p) in drawn.iter().zip(&computed).zip(&points) {
            assert_eq!(drawn.to_bits(), computed.to_bits(), "{request:?} at {p:?}: {drawn} drawn, {computed} computed");
        }
        let small = device.image("bytes", Format::Rgba8, size, ImageUse::Target).unwrap();
        let error = noise.record_picture(&mut device.recorder(Timing::Off).unwrap(), &input, &small).unwrap_err();
        assert!(error.to_string().contains("no float picture"), "{error}");
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn wrong_requests_and_short_buffers_are_refused() {
    let Some((device, log)) = device("wrong_requests_and_short_buffers_are_refused", DeviceSettings::default()) else {
        return;
    };
    let request = NoiseRequest {
        dimensions: 3,
        kind: NoiseKind::Perlin,
        octaves: Octaves::default(),
        source: NoiseSource::Hash(HashLattice::new(0)),
        tile: [0.0; 4],
    };
    let message = |request: NoiseRequest<'_>| DeviceNoise::new(&device, &request).unwrap_err().to_string();
    assert!(message(NoiseRequest { dimensions: 5, ..request }).contains("noise of 5 dimensions"));
    assert!(
        message(NoiseRequest { octaves: Octaves { count: 0, ..Octaves::default() }, ..request }).contains("0 octaves")
    );
    let noise = DeviceNoise::new(&device, &request).unwrap();
    let short = device.buffer::<f32>("short", 8, Memory::Device).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    let error = noise.record(&mut recorder, &short, &short, &short, 8).unwrap_err().to_string();
    assert!(error.contains("too short"), "{error}");
    drop((recorder, noise, short, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// Prints samples a second by the time stamps around the dispatch: `cargo test --release noise_speed -- --ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn noise_speed_on_the_device() {
    let Some((device, _)) = device_under(Validation::Off, "noise_speed_on_the_device", DeviceSettings::default())
    else {
        return;
    };
    let points: Vec<[f32; 4]> =
        (0..1 << 20).map(|i| [(i % 1024) as f32 * 0.037, (i / 1024) as f32 * 0.037, 0.4, 0.0]).collect();
    for (name, count, source) in [("perlin 3D", 1, true), ("perlin 3D fbm, 4 octaves", 4, true), ("tables", 4, false)] {
        let tables = Tables::new(1);
        let request = NoiseRequest {
            dimensions: 3,
            kind: NoiseKind::Perlin,
            octaves: Octaves { count, ..Octaves::default() },
            source: if source { NoiseSource::Hash(HashLattice::new(1)) } else { NoiseSource::Tables(&tables) },
            tile: [0.0; 4],
        };
        let (_, _, ms) = on_device(&device, &request, &points);
        println!("{name}: {:.1} million samples a second", points.len() as f64 / ms / 1e3);
    }
}
