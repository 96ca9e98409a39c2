//! Drawing on a Vulkan device: the renderer of [`super::render`] in single precision, all views of an instant in one submission.
//!
//! The empty room is drawn on the processor, once a camera, and stays on the device; of each instant the device gets the posed
//! primitives, sorted by tile and by where they stand in the light, and gives back linear light. So exposure, noise and
//! compression are the same code for both ways.

use std::sync::{Mutex, PoisonError};

use anyhow::Result;
use bytemuck::Pod;

use super::figure::Figure;
use super::packing::{PackedCast, PackedFinishes, packed_views, tile_count};
use super::render::{Cast, Light, View};
use super::shaders::{SHADOW_SIDE, layout, occlude_comp, picture_comp, soften_comp};
use crate::gpu::{Buffer, Device, Groups, Memory, PassTiming, Recording, Timing};

/// The pictures of a scene's views by a device.
#[derive(Debug)]
pub struct DevicePainter {
    device: Device,
    finishes: PackedFinishes,
    fixed: FixedBuffers,
    /// One instant at a time is on the device.
    instant: Mutex<Instant>,
}

/// What stays the same for a whole scene.
#[derive(Debug)]
struct FixedBuffers {
    finishes: Buffer,
    directions: Buffer,
    plates: Buffer,
    floors: Buffer,
    hidden: Buffer,
    shades: Buffer,
    pictures: Buffer,
    pixels: usize,
    most_tiles: u32,
}

/// What changes from instant to instant, in buffers that grow.
#[derive(Debug, Default)]
struct Instant {
    buffers: Vec<Buffer>,
    readback: Option<Buffer>,
    recording: Option<Recording>,
}

impl FixedBuffers {
    fn new(device: &Device, views: &[View], members: usize, finishes: &PackedFinishes) -> Result<Self> {
        let directions: Vec<[f32; 3]> = views.iter().flat_map(|view| view.directions.iter().copied()).collect();
        let floors: Vec<[f32; 2]> = views.iter().flat_map(|view| view.floor.iter().copied()).collect();
        let light = views.iter().flat_map(|view| view.plate().iter());
        let plates: Vec<[f32; 4]> =
            light.zip(&floors).map(|(&[r, g, b], [x, _])| [r, g, b, if x.is_nan() { 0.0 } else { 1.0 }]).collect();
        // NaN need not survive a device.
        let floors: Vec<[f32; 2]> = floors.iter().map(|at| at.map(|x| if x.is_nan() { 0.0 } else { x })).collect();
        let cells = (SHADOW_SIDE * SHADOW_SIDE) as usize * members;
        let none = [bytemuck::Zeroable::zeroed()];
        let rows: &[layout::Finish] = if finishes.rows.is_empty() { &none } else { &finishes.rows };
        Ok(Self {
            finishes: device.uploaded("finishes", rows)?,
            directions: device.uploaded("directions", &directions)?,
            plates: device.uploaded("plates", &plates)?,
            floors: device.uploaded("floors", &floors)?,
            hidden: device.buffer::<[f32; 2]>("hidden", cells, Memory::Device)?,
            shades: device.buffer::<[f32; 2]>("shades", cells, Memory::Device)?,
            pictures: device.buffer::<[f32; 4]>("pictures", plates.len(), Memory::Device)?,
            pixels: plates.len(),
            most_tiles: views.iter().map(|view| tile_count(view) as u32).max().unwrap_or(0),
        })
    }
}

impl Instant {
    /// Writes an instant's rows, in buffers of twice the size where they no longer fit; the recording is made anew then.
    fn write<T: Pod>(&mut self, device: &Device, index: usize, name: &str, values: &[T]) -> Result<()> {
        let bytes = size_of_val(values) as u64;
        if self.buffers.get(index).is_none_or(|buffer| buffer.size() < bytes) {
            let room = if self.buffers.len() > index { 2 * values.len() } else { values.len() + values.len() / 4 };
            let buffer = device.buffer::<T>(name, room, Memory::Upload)?;
            self.recording = None;
            if index < self.buffers.len() {
                self.buffers[index] = buffer;
            } else {
                self.buffers.push(buffer);
            }
        }
        self.buffers[index].write(0, values)
    }
}

impl DevicePainter {
    /// Prepares a device for the views of a scene.
    ///
    /// # Errors
    /// When a garment is of a material that is drawn on the processor alone, or the device has no memory.
    pub fn new(device: &Device, views: &[View], figures: &[Figure]) -> Result<Self> {
        let finishes = PackedFinishes::new(figures)?;
        Ok(Self {
            fixed: FixedBuffers::new(device, views, figures.len(), &finishes)?,
            finishes,
            device: device.clone(),
            instant: Mutex::default(),
        })
    }

    /// The pictures of the views that are wanted (empty ones of the others), as [`View::picture`] has them: light, and how many
    /// quarters of each pixel the first person covers.
    ///
    /// # Errors
    /// When the device fails.
    pub fn pictures(&self, cast: &Cast<'_>, views: &[View], is_wanted: &[bool]) -> Result<Vec<(Light, Vec<u8>)>> {
        let packed = PackedCast::new(cast, views, is_wanted, &self.finishes)?;
        let mut instant = self.instant.lock().unwrap_or_else(PoisonError::into_inner);
        instant.write(&self.device, 0, "members", &packed.members)?;
        instant.write(&self.device, 1, "solids", &packed.solids)?;
        instant.write(&self.device, 2, "triangles", &packed.triangles)?;
        instant.write(&self.device, 3, "bins", &packed.bins)?;
        instant.write(&self.device, 4, "balls", &packed.balls)?;
        instant.write(&self.device, 5, "tiles", &packed.tiles)?;
        instant.write(&self.device, 6, "views", &packed_views(views, is_wanted))?;
        let readback = match &instant.readback {
            Some(readback) => readback.clone(),
            None => self.device.buffer::<[f32; 4]>("drawn", self.fixed.pixels, Memory::Readback)?,
        };
        if instant.recording.is_none() {
            let (members, views) = (packed.members.len() as u32, views.len() as u32);
            instant.recording = Some(self.record(&instant.buffers, &readback, members, views)?);
        }
        if let Some(recording) = &mut instant.recording {
            recording.run()?;
            self.device.validation_log().check()?;
        }
        let mut pixels = vec![[0.0_f32; 4]; self.fixed.pixels];
        readback.read(0, &mut pixels)?;
        instant.readback = Some(readback);
        drop(instant);
        let mut rest = pixels.as_slice();
        let pictures = views.iter().zip(is_wanted).map(|(view, &is_wanted)| {
            let (own, after) = rest.split_at(view.plate().len());
            rest = after;
            let own = if is_wanted { own } else { &[] };
            (own.iter().map(|&[r, g, b, _]| [r, g, b]).collect(), own.iter().map(|pixel| pixel[3] as u8).collect())
        });
        Ok(pictures.collect())
    }

    fn record(&self, buffers: &[Buffer], readback: &Buffer, members: u32, views: u32) -> Result<Recording> {
        let [all_members, solids, triangles, bins, balls, tiles, all_views] = buffers else {
            anyhow::bail!("an instant has {} buffers, expected 7", buffers.len());
        };
        let fixed = &self.fixed;
        let mut recorder = self.device.recorder(Timing::Stamps)?;
        let cells = Groups::Over([SHADOW_SIDE, SHADOW_SIDE, members]);
        let occlude =
            occlude_comp::Bindings { members: all_members, solids, triangles, bins, balls, hidden: &fixed.hidden };
        recorder.run(occlude.dispatch(occlude_comp::Push { members }, cells))?;
        let soften = soften_comp::Bindings { hidden: &fixed.hidden, shades: &fixed.shades };
        recorder.run(soften.dispatch(cells))?;
        let picture = picture_comp::Bindings {
            members: all_members,
            solids,
            triangles,
            bins,
            views: all_views,
            tiles,
            finishes: &fixed.finishes,
            directions: &fixed.directions,
            plates: &fixed.plates,
            floors: &fixed.floors,
            shades: &fixed.shades,
            pictures: &fixed.pictures,
        };
        // A workgroup a tile of the view that has most.
        let groups = Groups::Count([fixed.most_tiles, views, 1]);
        recorder.run(picture.dispatch(picture_comp::Push { members }, groups))?;
        recorder.copy("read pictures", (&fixed.pictures, 0), (readback, 0), fixed.pictures.size())?;
        recorder.finish()
    }

    /// How long the passes of the last instant took.
    ///
    /// # Errors
    /// When the device fails.
    pub fn timings(&self) -> Result<Vec<PassTiming>> {
        let instant = self.instant.lock().unwrap_or_else(PoisonError::into_inner);
        instant.recording.as_ref().map_or_else(|| Ok(Vec::new()), Recording::timings)
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::super::figure::Wardrobe;
    use super::super::noise::Sensor;
    use super::super::performance::Performance;
    use super::super::rig;
    use super::super::room::Room;
    use super::super::scene::{ActorSettings, MotionSettings, Scene};
    use super::super::shaders::SHADOW_CELL;
    use super::*;
    use crate::body::{Body, MeshSource, Skinning};
    use crate::gpu::DeviceSettings;
    use crate::gpu::test_device::device;

    /// Of the pixels of a picture at most this share differs by more than two levels of 255 in a channel: on edges of shadows
    /// and patterns, where single and double precision fall on different sides. On lavapipe it is 0.00007; four times that is left for
    /// other devices' roots and sines, of this and of the mean.
    const DIFFERING: f64 = 0.0003;
    /// The mean difference of channels, levels of 255; 0.0005 on lavapipe.
    const MEAN: f64 = 0.002;

    /// Compares the light on the floor, cell by cell. A cell whose ray to the lamp just touches someone may fall on either side.
    fn check_shades(painter: &DevicePainter, cast: &Cast<'_>, name: &str) {
        let side = SHADOW_SIDE as usize;
        let mut shades = vec![[0.0_f32; 2]; side * side * cast.members.len()];
        let readback = painter.device.buffer::<[f32; 2]>("read shades", shades.len(), Memory::Readback).unwrap();
        let mut recorder = painter.device.recorder(Timing::Off).unwrap();
        recorder.copy("read shades", (&painter.fixed.shades, 0), (&readback, 0), readback.size()).unwrap();
        recorder.finish().unwrap().run().unwrap();
        readback.read(0, &mut shades).unwrap();
        for (member, shades) in cast.members.iter().zip(shades.chunks_exact(side * side)) {
            let middle = |cell: usize| (cell as f64 + 0.5 - 0.5 * side as f64) * f64::from(SHADOW_CELL);
            let mut differing = 0;
            let mut darkest = 1.0_f32;
            for row in 0..side - 1 {
                for column in 0..side - 1 {
                    // A little into the cell, so that rounding does not leave the grid at its border.
                    let at = member.lamp.shadow_middle + glam::DVec2::new(middle(column), middle(row)) + 1e-6;
                    let (expected, found) = (member.floor_shadow().at(at.x, at.y), shades[row * side + column]);
                    assert!(
                        (expected[1] - found[1]).abs() < 1e-4,
                        "{name}, cell {column}, {row}: {expected:?}, {found:?}"
                    );
                    differing += usize::from((expected[0] - found[0]).abs() > 1e-3);
                    darkest = darkest.min(found[0]);
                }
            }
            assert!(darkest < 0.3, "{name}: somebody throws a shadow");
            // One ray on the other side is seen in the 49 cells that its own is softened into.
            assert!(differing <= 3 * 49, "{name}: {differing} of {} cells differ", side * side);
        }
    }

    /// Draws an instant of a scene both ways and compares all views as bytes.
    fn check(device: &Device, name: &str, scene: &Scene, times: &[f64]) {
        let room = Room::new(&scene.room).unwrap();
        let cameras = rig::cameras(&scene.rig, &room).unwrap();
        let views: Vec<View> = cameras.iter().map(|camera| View::new(camera, &room).unwrap()).collect();
        let (mut figures, mut performances) = (Vec::new(), Vec::new());
        for actor in &scene.actor {
            let mut body = Body::adult(actor.height).unwrap();
            let wardrobe = Wardrobe::new(&actor.clothes).unwrap();
            figures.push(match &actor.mesh {
                None => Figure::of_solids(&body, actor.height, wardrobe).unwrap(),
                Some(file) => {
                    let (skinning, joints) = (Skinning::default(), Default::default());
                    body.mesh = Some(MeshSource::Skinned { file: file.clone(), skinning, joints });
                    Figure::of_mesh(&body, wardrobe).unwrap()
                }
            });
            performances.push(Performance::new(&body, &actor.motion, scene, &room).unwrap());
        }
        let painter = DevicePainter::new(device, &views, &figures).unwrap();
        let sensor = Sensor::new(0.0, 0);
        for &time in times {
            let poses: Vec<Vec<f64>> = performances.iter().map(|performance| performance.pose(time).unwrap()).collect();
            let placed: Vec<_> = figures.iter().zip(&poses).map(|(figure, pose)| figure.place(pose).unwrap()).collect();
            let cast = Cast::new(&placed, scene.light.position.map(glam::DVec3::from)).unwrap();
            let mut is_wanted = vec![true; views.len()];
            is_wanted[1] = false;
            let drawn = painter.pictures(&cast, &views, &is_wanted).unwrap();
            assert!(drawn[1].0.is_empty() && drawn[1].1.is_empty(), "{name}: a view that was not asked for");
            check_shades(&painter, &cast, name);
            for (view, (light, coverage)) in views.iter().zip(&drawn).filter(|(_, (light, _))| !light.is_empty()) {
                let (expected, expected_coverage) = view.picture(&cast);
                let (a, b) = (sensor.expose_clean(light), sensor.expose_clean(&expected));
                let pairs = a.chunks_exact(3).zip(b.chunks_exact(3));
                let worst = |(a, b): (&[u8], &[u8])| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
                let differing = pairs.clone().filter(|pair| worst(*pair) > 2).count() as f64 / light.len() as f64;
                let mean = a.iter().zip(&b).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / a.len() as f64;
                let covered = coverage.iter().zip(&expected_coverage).filter(|(a, b)| a != b).count();
                let area = expected_coverage.iter().filter(|quarters| **quarters > 0).count();
                println!(
                    "{name}, {}: {:.3} % of the pixels differ by more than 2 levels, {mean:.4} on average, \
                     {covered} of {area} in coverage",
                    view.camera().name,
                    100.0 * differing
                );
                assert!(area > 300, "{name}: there is somebody");
                assert!(differing <= DIFFERING, "{name}: {differing} of the pixels differ");
                assert!(mean <= MEAN, "{name}: {mean} levels on average");
                // None on lavapipe.
                assert!(covered * 1000 <= area, "{name}: {covered} of {area} pixels differ in coverage");
            }
        }
        for (pass, ms, _) in crate::gpu::by_name(&painter.timings().unwrap()) {
            println!("{name}: {pass} takes {ms:.1} ms");
        }
    }

    #[test]
    fn a_device_draws_the_processors_pictures() {
        let Some((device, log)) = device("a_device_draws_the_processors_pictures", DeviceSettings::default()) else {
            return;
        };
        let mut plain = Scene { frames: 20, ..Scene::default() };
        plain.rig.size = [320, 240];
        plain.light.position = Some([900.0, -700.0, 2600.0]);
        check(&device, "plain", &plain, &[0.0, 0.5]);
        let mut dressed = Scene { frames: 20, ..Scene::preset("two_diagonal").unwrap() };
        dressed.rig.size = [320, 180];
        let finish = |material: &str| toml::from_str(&format!("material = \"{material}\"\nscale = 120.0")).unwrap();
        for (garment, material) in
            [("skin", "clouds"), ("hair", "lava"), ("shirt", "wood"), ("trousers", "timber"), ("shoes", "brick")]
        {
            dressed.actor[1].clothes.insert(garment.into(), finish(material));
        }
        check(&device, "dressed", &dressed, &[0.2]);
        let file = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/mesh/human_male.glb"));
        if file.is_file() {
            let motion = MotionSettings::default();
            let skinned = ActorSettings { mesh: Some(file), motion, ..ActorSettings::default() };
            check(&device, "skinned", &Scene { actor: vec![skinned], ..plain }, &[0.3]);
        } else {
            println!("SKIPPED the skinned person: ../shared/data is absent");
        }
        drop(device);
        assert_eq!(log.messages(), Vec::<String>::new());
    }

    #[test]
    fn what_a_device_cannot_draw_is_named() {
        let mut scene = Scene { frames: 2, ..Scene::default() };
        let grass = toml::from_str("material = \"grass\"").unwrap();
        scene.actor[0].clothes.insert("trousers".into(), grass);
        let sequence = super::super::SyntheticSequence::new(&scene).unwrap();
        let message = format!("{:#}", sequence.check_for_device().unwrap_err());
        assert_eq!(message, "actor 1: trousers: its material is drawn on the processor alone");
        scene.actor[0].clothes.clear();
        super::super::SyntheticSequence::new(&scene).unwrap().check_for_device().unwrap();
    }
}
