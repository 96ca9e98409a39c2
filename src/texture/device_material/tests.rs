//! A device's pictures of materials beside the processor's, under the validation layer.

#![allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]

use super::*;
use crate::gpu::DeviceSettings;
use crate::gpu::rough::{Change, rough};
use crate::gpu::test_device::device;
use crate::texture::materials::{MaterialKind, Parameters, Surface};
use crate::texture::noise::NoiseWay;
use crate::texture::picture::{flat, heights, shown};

/// Pixels of three pictures of a material by the device that are not the processor's: its colours, heights, and on a cylinder.
fn differences(device: &Device, material: &Material, view: &View) -> [usize; 3] {
    let staged = DeviceMaterial::new(device, material).unwrap();
    let samples = material.samples(view.pixel(), 1);
    let differ = |one: &[u16], other: &[u16]| one.iter().zip(other).filter(|(a, b)| a != b).count();
    let ray = |u: f32, v: f32| {
        let across = 1.0 - u * u;
        let seen = || Seen { point: [u, v, across.sqrt()].map(|x| 1.7 * x + view.offset[0]), cosine: 0.8 - 0.9 * u };
        (across >= 0.04).then(seen)
    };
    [
        differ(&staged.flat(view, samples).unwrap(), &flat(material, view)),
        differ(&staged.heights(view, samples).unwrap(), &heights(material, view)),
        differ(&staged.shown(view.size, 2, ray).unwrap(), &shown(material, view.size, 2, ray)),
    ]
}

/// Every material with a tile and without, from near and so far that pixels are means, and two by every way of noise.
fn every_material_has_the_processors_bits(name: &str, code: Option<Change>) {
    let settings = DeviceSettings { code, ..DeviceSettings::default() };
    let Some((device, log)) = device(name, settings) else { return };
    let mut differing = Vec::new();
    for kind in MaterialKind::ALL {
        let near = View { size: [61, 37], offset: [-1.3, 0.7, 0.41], scale: 3.0 };
        // Granite and fabric are means here.
        let far = View { size: [13, 9], offset: [40.0, -71.0, 3.0], scale: 9.0 };
        let mut cases = vec![(NoiseWay::Arithmetic, true, near), (NoiseWay::Arithmetic, false, far)];
        // Noise is one piece of code for all of them.
        if matches!(kind, MaterialKind::Marble | MaterialKind::Terrain) {
            cases.extend([(NoiseWay::Tables, true, near), (NoiseWay::Volume, false, near)]);
        }
        for (way, is_tiled, view) in cases {
            let tile = is_tiled.then(|| view.extent());
            let material = Material::of_noise(way, kind.name(), Parameters::Defaults, 5, tile).unwrap();
            let found = differences(&device, &material, &view);
            if found != [0; 3] {
                differing.push(format!("{kind} by {way}, tiled {is_tiled}, {} units across: {found:?}", view.scale));
            }
        }
    }
    assert_eq!(differing, Vec::<String>::new());
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn pictures_of_materials_have_the_processors_bits() {
    every_material_has_the_processors_bits("pictures_of_materials_have_the_processors_bits", None);
}

/// On a device as inexact as Vulkan lets it be. Beside the other one, since each is a minute of compiling shaders.
#[test]
fn a_rough_device_has_the_processors_bits() {
    every_material_has_the_processors_bits("a_rough_device_has_the_processors_bits", Some(rough));
}

/// A picture of several runs, and parameters that are not the defaults.
#[test]
fn large_pictures_are_drawn_run_by_run() {
    let Some((device, log)) = device("large_pictures_are_drawn_run_by_run", DeviceSettings::default()) else { return };
    let view = View { size: [1021, 1031], offset: [0.2, -3.0, 0.0], scale: 5.0 };
    let table = "octaves = 3\nsum = \"ridged\"\nscale = -1.5\n[map]\nisolines = 0.0\nsea = 0.2\n".parse().unwrap();
    let material = Material::new("terrain", Parameters::Table(&table), 8, None).unwrap();
    let staged = DeviceMaterial::new(&device, &material).unwrap();
    assert!(staged.flat(&view, 1).unwrap() == flat(&material, &view));
    drop((staged, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// Surfaces of every size, rough ones and smooth ones, height by height; also on a device as inexact as Vulkan lets it be.
#[test]
fn surfaces_are_displaced_to_the_processors_bits() {
    for code in [None, Some(rough as Change)] {
        let settings = DeviceSettings { code, ..DeviceSettings::default() };
        let Some((device, log)) = device("surfaces_are_displaced_to_the_processors_bits", settings) else { return };
        for (seed, levels, smoothness) in [(1, 1, 0.95), (2, 2, 0.0), (3, 5, 2.0), (4, 9, 0.95), (5, 11, 0.3)] {
            let displacement = Displacement::new(seed, levels, smoothness);
            let bands = [0.25; 3];
            let tables = tables(&device, &bands, Some(&displacement)).unwrap();
            let read = device.buffer::<u8>("read", tables.size() as usize, Memory::Readback).unwrap();
            let mut recorder = device.recorder(Timing::Off).unwrap();
            recorder.copy("read", (&tables, 0), (&read, 0), tables.size()).unwrap();
            recorder.finish().unwrap().run().unwrap();
            let mut found = vec![0.0_f32; tables.size() as usize / 4];
            read.read(0, &mut found).unwrap();
            let surface = Surface::new(seed, levels, smoothness);
            assert!(found[..3] == bands && found[3..] == *surface.heights(), "{levels} levels");
        }
        drop(device);
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}
