//! Evidence that the device makes of likelihoods which it holds (METHOD A12): the twin of [`crate::observe::Appearance`]'s, which says what
//! the colours of its classes are.

use std::sync::{Arc, OnceLock};

use anyhow::{Result, ensure};

use super::scene::DeviceScene;
use crate::evaluate::shaders::{evidence_at_comp, evidence_best_comp, evidence_codes_comp, layout};
use crate::features::{ColourTables, HeldFrame, HeldLikelihood, HeldView, PartClasses};
use crate::gpu::{Buffer, Groups, Memory, Recorder, Recording, StagedBuffer, Timing};

/// What the host brings for it, and what comes back.
#[derive(Debug)]
pub(super) struct HeldEvidence {
    classes: u32,
    /// Those of the newest frame.
    part_classes: Option<Arc<PartClasses>>,
    /// The log densities of colours.
    colours: StagedBuffer,
    /// What differs between the views of a frame.
    looks: StagedBuffer,
    /// The best of each view.
    best: Buffer,
    best_out: Buffer,
    /// That of the newest frame, once the host has asked.
    best_read: OnceLock<Vec<u32>>,
    asking: Option<Asking>,
}

/// Single pixels whose codes the host wants.
#[derive(Debug)]
struct Asking {
    count: usize,
    pixels: StagedBuffer,
    told: Buffer,
    recording: Recording,
}

impl HeldEvidence {
    pub(super) fn new(scene: &DeviceScene, classes: usize) -> Result<Self> {
        let (device, views) = (&scene.device, scene.sizes.len());
        Ok(Self {
            classes: u32::try_from(classes)?,
            part_classes: None,
            colours: StagedBuffer::new::<u32>(device, "colours", ColourTables::words(classes))?,
            looks: StagedBuffer::new::<[u32; 2]>(device, "looks", views)?,
            best: device.buffer::<u32>("best evidence", views, Memory::Device)?,
            best_out: device.buffer::<u32>("best evidence readback", views, Memory::Readback)?,
            best_read: OnceLock::new(),
            asking: None,
        })
    }

    /// Takes what is known of a frame's views and of the person's colours.
    pub(super) fn observe(&mut self, frame: &HeldFrame, colours: &ColourTables) -> Result<()> {
        self.best_read = OnceLock::new();
        self.part_classes = Some(Arc::clone(colours.classes()));
        self.colours.staging.write(0, colours.values())?;
        let looks: Vec<[u32; 2]> =
            frame.looks().iter().map(|look| [look.is_masked, look.is_grey].map(u32::from)).collect();
        self.looks.staging.write(0, &looks)
    }

    /// The classes of the newest frame.
    pub(super) fn part_classes(&self) -> Option<&PartClasses> {
        self.part_classes.as_deref()
    }

    /// Records everything from the likelihoods of held views to the `planes` of their codes, the best in the `table`, and what comes back.
    pub(super) fn record(
        &self,
        recorder: &mut Recorder,
        scene: &DeviceScene,
        (table, planes): (&StagedBuffer, &Buffer),
        views: &[HeldView],
    ) -> Result<()> {
        let likely: Vec<&HeldLikelihood> = views.iter().filter_map(|view| view.likelihood.as_ref()).collect();
        ensure!(
            likely.len() == scene.sizes.len(),
            "a device held observations without likelihoods, and evidence is wanted"
        );
        for staged in [table, &self.colours, &self.looks] {
            staged.record_upload(recorder)?;
        }
        scene.counted.iter().try_for_each(|counted| counted.planes.record_upload(recorder))?;
        recorder.fill("best evidence", &self.best, 0)?;
        likely.iter().try_for_each(|view| recorder.fill("empty pixels", &view.empty, 0))?;
        let each = || scene.sizes.iter().zip(scene.first_plane_words()).zip(0..);
        let constants = evidence_codes_comp::Constants { ignores: scene.counted.is_some() };
        recorder.run_all(each().zip(&likely).map(|(((&[width, height], first_group), view), likely)| {
            let push = layout::EvidenceView {
                width,
                height,
                stride: 2 * width.div_ceil(64),
                first_group,
                view,
                classes: self.classes,
                motion: likely.motion,
            };
            evidence_codes_comp::Bindings {
                seen: &likely.seen,
                sides: &likely.sides,
                colour_tables: &self.colours.buffer,
                looks: &self.looks.buffer,
                counted_planes: scene.counted_planes(),
                evidence_planes: planes,
                empty: &likely.empty,
            }
            .dispatch(constants, push, Groups::Flat(width.div_ceil(32) * height * self.classes))
        }))?;
        recorder.run_all(each().map(|((&[width, height], first_group), view)| {
            let groups = width.div_ceil(32) * height;
            evidence_best_comp::Bindings { evidence_planes: planes, best_evidence: &self.best }.dispatch(
                layout::EvidenceBest { first_group, groups, view, classes: self.classes },
                Groups::Flat(groups),
            )
        }))?;
        let header = size_of::<layout::EvidenceTableHeader>() as u64;
        recorder.copy("best evidence", (&self.best, 0), (&table.buffer, header), self.best.size())?;
        recorder.copy("read best evidence", (&self.best, 0), (&self.best_out, 0), self.best.size())?;
        likely.iter().try_for_each(|view| {
            recorder.copy("read empty pixels", (&view.empty, 0), (&view.empty_out, 0), view.empty.size())
        })
    }

    /// The best of each view, when what was recorded has run.
    pub(super) fn best(&self) -> Option<&[u32]> {
        if let Some(best) = self.best_read.get() {
            return Some(best);
        }
        let mut best = vec![0; (self.best_out.size() / 4) as usize];
        self.best_out.read(0, &mut best).ok()?;
        Some(self.best_read.get_or_init(|| best))
    }

    /// The codes of pixels, each a view and its place in the picture's rows; what was recorded has run.
    pub(super) fn at(&mut self, scene: &DeviceScene, planes: &Buffer, pixels: &[[usize; 2]]) -> Result<Vec<u32>> {
        let firsts: Vec<u32> = scene.first_plane_words().collect();
        let place = |&[view, at]: &[usize; 2]| {
            let (Some(first), Some([width, height])) = (firsts.get(view), scene.sizes.get(view)) else { return None };
            let (x, y) = (at as u32 % width, at as u32 / width);
            (y < *height).then_some([first + y * width.div_ceil(32) + x / 32, x % 32])
        };
        let places: Option<Vec<[u32; 2]>> = pixels.iter().map(place).collect();
        let Some(places) = places else {
            anyhow::bail!("the evidence of a pixel outside of its picture was asked for")
        };
        if places.is_empty() {
            return Ok(Vec::new());
        }
        let asking = match self.asking.take().filter(|asking| asking.count >= places.len()) {
            Some(asking) => asking,
            None => Asking::new(scene, self.classes, planes, places.len().next_power_of_two())?,
        };
        let asking = self.asking.insert(asking);
        asking.pixels.staging.write(0, &places)?;
        asking.recording.run()?;
        let mut told = vec![0; places.len()];
        asking.told.read(0, &mut told)?;
        Ok(told)
    }
}

impl Asking {
    fn new(scene: &DeviceScene, classes: u32, planes: &Buffer, count: usize) -> Result<Self> {
        let device = &scene.device;
        let pixels = StagedBuffer::of(device, "asked pixels", &vec![[0_u32; 2]; count])?;
        let codes = device.buffer::<u32>("told codes", count, Memory::Device)?;
        let told = device.buffer::<u32>("told codes readback", count, Memory::Readback)?;
        let mut recorder = device.recorder(Timing::Off)?;
        pixels.record_upload(&mut recorder)?;
        let push = layout::EvidenceAt { count: u32::try_from(count)?, classes };
        let bindings =
            evidence_at_comp::Bindings { asked_pixels: &pixels.buffer, evidence_planes: planes, told_codes: &codes };
        recorder.run(bindings.dispatch(push, Groups::Flat(push.count)))?;
        recorder.copy("read codes", (&codes, 0), (&told, 0), told.size())?;
        Ok(Self { count, pixels, told, recording: recorder.finish()? })
    }
}
