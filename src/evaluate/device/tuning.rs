//! Which of the stages that draw the flat model in compute a device runs fastest, measured once and kept beside its pipelines.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::Result;
use bytemuck::Zeroable;
use serde::{Deserialize, Serialize};

use super::open::cache_folder;
use super::passes::{self, Images};
use super::raster_kernel::RasterKernel;
use super::scene::{DeviceScene, Share};
use super::spans;
use super::summed::Summed;
use super::workspace::Workspace;
use crate::evaluate::shaders::layout;
use crate::files::{Overwrite, write_atomically};
use crate::gpu::{DeviceFacts, Memory, Recorder, Recording, Timing, kept_file};

/// What was measured of one way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Measured {
    #[serde(flatten)]
    kernel: RasterKernel,
    /// Milliseconds of a drawing of all candidates, the shortest of some rounds.
    ms: f64,
}

/// What was measured of one kind of work.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Choice {
    parts: u32,
    views: u32,
    /// Of the largest picture, pixels.
    size: [u32; 2],
    candidates: u32,
    measured: Vec<Measured>,
}

impl Choice {
    /// The usual way, unless another one that workgroups of `most` invocations allow takes less than 0.95 of its time: so that two runs on
    /// one machine choose alike.
    fn fastest(&self, usual: RasterKernel, most: u32) -> RasterKernel {
        let own = self.measured.iter().find(|each| each.kernel == usual).map_or(f64::INFINITY, |it| it.ms);
        let allowed = self.measured.iter().filter(|each| each.kernel.check(most).is_ok());
        let best = allowed.min_by(|a, b| a.ms.total_cmp(&b.ms));
        best.filter(|best| best.ms < 0.95 * own).map_or(usual, |best| best.kernel)
    }
}

/// The file of a device.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Choices {
    #[serde(default)]
    choice: Vec<Choice>,
}

/// Kind and ending of the file.
const FILE: [&str; 2] = ["raster", "toml"];
/// Kinds of work that are kept, the newest.
const KEPT: usize = 64;

impl Choices {
    /// What is no file of ours is none.
    fn read(path: &Path) -> Self {
        fs::read_to_string(path).ok().and_then(|text| toml::from_str(&text).ok()).unwrap_or_default()
    }

    /// A file that cannot be written costs the next run a measurement, nothing else.
    fn write(&self, path: &Path) {
        let Ok(text) = toml::to_string(self) else { return };
        let head = "# How fast this device draws the flat model in compute, in milliseconds; pantin measures what is missing here.\n";
        let _ = path.parent().map(fs::create_dir_all);
        let _ = write_atomically(path, Overwrite::Replace, |file| {
            Ok(file.write_all((head.to_string() + &text).as_bytes())?)
        });
    }
}

/// The fastest way for a scene, as it is kept, or as it is measured now on poses like those to come and then kept. The usual one where
/// the device keeps nothing, and where the poses show nothing.
///
/// # Errors
/// When the device fails.
pub(super) fn fastest_kernel(scene: &DeviceScene, poses: &[f32]) -> Result<RasterKernel> {
    let [kind, ending] = FILE;
    let (usual, most) = (RasterKernel::usual(scene.device.capabilities()), scene.device.capabilities().max_workgroup);
    let Some(path) = scene.device.kept_file(kind, ending) else { return Ok(usual) };
    let (parts, views) = (scene.counts.parts, scene.counts.views);
    let size = scene.sizes.iter().copied().max_by_key(|[width, height]| width * height).unwrap_or_default();
    let mut choices = Choices::read(&path);
    let is_alike = |choice: &&Choice| (choice.parts, choice.views, choice.size) == (parts, views, size);
    if let Some(known) = choices.choice.iter().find(is_alike) {
        return Ok(known.fastest(usual, most));
    }
    let (candidates, measured) = measure(scene, poses, &RasterKernel::all(scene.device.capabilities()))?;
    if measured.is_empty() {
        return Ok(usual);
    }
    let choice = Choice { parts, views, size, candidates, measured };
    let fastest = choice.fastest(usual, most);
    choices.choice.insert(0, choice);
    choices.choice.truncate(KEPT);
    choices.write(&path);
    Ok(fastest)
}

/// What is kept of a device, a sentence for each kind of work.
pub fn kept_kernels(facts: &DeviceFacts) -> Vec<String> {
    let Some(folder) = cache_folder() else { return Vec::new() };
    let choices = Choices::read(&kept_file(&folder, facts, FILE));
    let sentence = |choice: &Choice| {
        let [width, height] = choice.size;
        let usual = RasterKernel::usual(&facts.capabilities);
        let times: Vec<String> = choice.measured.iter().map(|it| format!("{} {:.3} ms", it.kernel, it.ms)).collect();
        format!(
            "compute draws {} parts in {} pictures of up to {width}x{height} {}; {} poses: {}",
            choice.parts,
            choice.views,
            choice.fastest(usual, facts.capabilities.max_workgroup),
            choice.candidates,
            times.join(", ")
        )
    };
    choices.choice.iter().map(sentence).collect()
}

/// Rounds that are measured, after one that is not.
const ROUNDS: usize = 3;
/// Drawings in each: so many that what a submission costs does not tell, which is as much as a drawing on a card, and no more.
const DRAWINGS: [usize; 2] = [2, 40];
const LONG_ENOUGH: Duration = Duration::from_millis(4);

/// Times of drawing poses, and how many they were; none where they show nothing. A way whose sums are not those of row by row is
/// left out.
fn measure(scene: &DeviceScene, poses: &[f32], kernels: &[RasterKernel]) -> Result<(u32, Vec<Measured>)> {
    let device = &scene.device;
    let dofs = scene.counts.dofs as usize;
    let workspace = Workspace::new(device, scene.counts, (poses.len() / dofs) as u32)?;
    let share = Share { first: 0, candidates: workspace.candidates.min(workspace.batch) };
    let images = (share.candidates * scene.counts.views) as usize;
    let staging = device.buffer::<f32>("poses to measure", share.candidates as usize * dofs, Memory::Upload)?;
    staging.write(0, &poses[..share.candidates as usize * dofs])?;
    let seen = device.buffer::<layout::Sums>("measured sums", images, Memory::Readback)?;
    let mut recorder = device.recorder(Timing::Off)?;
    scene.record_upload(&mut recorder)?;
    recorder.copy("poses", (&staging, 0), (&workspace.poses, 0), staging.size())?;
    passes::pose(&mut recorder, scene, &workspace, share)?;
    passes::project(&mut recorder, scene, &workspace, share)?;
    recorder.finish()?.run()?;

    let draw = |recorder: &mut Recorder, kernel: RasterKernel| -> Result<()> {
        match kernel {
            RasterKernel::Rows(way) => {
                passes::raster(recorder, (scene, &workspace), Summed::Nothing, Images::All(way), share)
            }
            RasterKernel::Spans { .. } => spans::raster(recorder, (scene, &workspace), Summed::Nothing, kernel, share),
        }
    };
    let mut known: Option<Vec<[u32; 4]>> = None;
    let mut running: Vec<(RasterKernel, Recording, Duration)> = Vec::new();
    let mut drawings = DRAWINGS[0];
    for &kernel in kernels {
        let mut recorder = device.recorder(Timing::Off)?;
        draw(&mut recorder, kernel)?;
        recorder.copy("sums", (&workspace.sums, 0), (&seen, 0), seen.size())?;
        let mut recording = recorder.finish()?;
        recording.run()?;
        if known.is_none() {
            // The first run of all makes rooms and touches memory.
            let begin = Instant::now();
            recording.run()?;
            let count = LONG_ENOUGH.as_secs_f64() / begin.elapsed().as_secs_f64();
            drawings = (count as usize).clamp(DRAWINGS[0], DRAWINGS[1]);
        }
        let mut sums = vec![layout::Sums::zeroed(); images];
        seen.read(0, &mut sums)?;
        let sums: Vec<[u32; 4]> = sums.iter().map(|it| [it.area_model, it.overlap, it.edges, it.proximity]).collect();
        if sums.iter().all(|sums| sums[0] == 0) && known.is_none() {
            return Ok((share.candidates, Vec::new()));
        }
        if known.get_or_insert_with(|| sums.clone()) == &sums {
            let mut recorder = device.recorder(Timing::Off)?;
            (0..drawings).try_for_each(|_| draw(&mut recorder, kernel))?;
            running.push((kernel, recorder.finish()?, Duration::MAX));
        }
    }
    for _ in 0..ROUNDS {
        for (_, recording, shortest) in &mut running {
            let begin = Instant::now();
            recording.run()?;
            *shortest = begin.elapsed().min(*shortest);
        }
    }
    let measured = running
        .iter()
        .map(|(kernel, _, shortest)| Measured { kernel: *kernel, ms: shortest.as_secs_f64() * 1e3 / drawings as f64 });
    Ok((share.candidates, measured.collect()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test stops at the first surprise, and prints")]

    use super::super::Compute;
    use super::super::raster_kernel::RowWay;
    use super::super::tests::{cameras, device};
    use super::*;
    use crate::body::Body;
    use crate::evaluate::Evaluator;
    use crate::gpu::DeviceSettings;

    fn measured(kernel: RasterKernel, ms: f64) -> Measured {
        Measured { kernel, ms }
    }

    #[test]
    fn row_by_row_gives_way_to_what_is_clearly_faster() {
        let spans = |group| RasterKernel::Spans { group, workgroups: 2 };
        let of = |times: &[(RasterKernel, f64)]| Choice {
            parts: 16,
            views: 4,
            size: [640, 480],
            candidates: 64,
            measured: times.iter().map(|&(kernel, ms)| measured(kernel, ms)).collect(),
        };
        let usual = RasterKernel::ROWS;
        assert_eq!(of(&[(RasterKernel::ROWS, 1.0), (spans(64), 0.96)]).fastest(usual, 128), RasterKernel::ROWS);
        let card = RasterKernel::Rows(RowWay::OF_CARDS);
        assert_eq!(of(&[(RasterKernel::ROWS, 0.96), (card, 1.0)]).fastest(card, 128), card);
        let choice = of(&[(RasterKernel::ROWS, 1.0), (spans(64), 0.9), (spans(128), 0.8), (spans(256), 0.1)]);
        assert_eq!(choice.fastest(usual, 128), spans(128));
        assert_eq!(choice.fastest(usual, 64), spans(64));
        assert_eq!(choice.fastest(usual, 32), RasterKernel::ROWS);
        // What no program of ours writes.
        assert_eq!(of(&[(spans(0), 0.1)]).fastest(usual, 128), RasterKernel::ROWS);
        assert_eq!(of(&[]).fastest(usual, 128), RasterKernel::ROWS);
        let rows = |words| RasterKernel::Rows(RowWay { group: 64, words, keeps_edges: false });
        let more = [(RasterKernel::ROWS, 1.0), (rows(4), 0.7), (rows(2), 0.8), (rows(9), 0.1), (spans(64), 0.9)];
        assert_eq!(of(&more).fastest(usual, 128), rows(4));
    }

    #[test]
    fn what_was_measured_is_kept_and_taken_again() {
        let folder = tempfile::tempdir().unwrap();
        let settings = DeviceSettings { pipeline_cache: Some(folder.path().into()), ..DeviceSettings::default() };
        let Some((device, log)) = device("what_was_measured_is_kept_and_taken_again", settings) else { return };
        let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
        let pose: Vec<f32> = body.standing_pose().iter().map(|value| *value as f32).collect();
        let mut compute = Compute::on(&device, &body, &cameras).unwrap();
        let path = device.kept_file("raster", "toml").unwrap();

        // Nothing is drawn, nothing is learnt.
        compute.tune(&vec![f32::NAN; pose.len()]).unwrap();
        assert_eq!((compute.kernel(), path.exists()), (RasterKernel::usual(device.capabilities()), false));

        compute.tune(&pose.repeat(8)).unwrap();
        let kept = Choices::read(&path);
        let [choice] = kept.choice.as_slice() else { panic!("{kept:?}") };
        assert_eq!((choice.parts, choice.candidates), (body.parts.len() as u32, 8));
        let kernels: Vec<RasterKernel> = choice.measured.iter().map(|each| each.kernel).collect();
        assert_eq!(kernels, RasterKernel::all(device.capabilities()));
        assert!(choice.measured.iter().all(|each| each.ms > 0.0));

        // Another device's numbers, written there: they are believed.
        let spans = RasterKernel::Spans { group: 64, workgroups: 2 };
        let mut changed = kept.clone();
        for each in &mut changed.choice[0].measured {
            each.ms = if each.kernel == spans { 0.001 } else { 1.0 };
        }
        changed.write(&path);
        compute.tune(&pose).unwrap();
        assert_eq!((compute.kernel(), compute.variant()), (spans, "spans"));
        assert_eq!(Choices::read(&path), changed);

        // Files of before there were ways to draw row by row say less, and are measured anew; so is what is no file of ours.
        let old = fs::read_to_string(&path).unwrap().replace("group = 32\nwords = 3\nkeeps_edges = false\n", "");
        fs::write(&path, &old).unwrap();
        assert!(old.contains("kernel = \"rows\"\nms"), "{old}");
        assert_eq!(Choices::read(&path), Choices::default());
        fs::write(&path, "choice = 3").unwrap();
        compute.tune(&pose).unwrap();
        assert_eq!(Choices::read(&path).choice.len(), 1);
        drop((compute, device));
        assert_eq!(log.messages(), Vec::<String>::new());
    }

    #[test]
    fn workgroups_that_no_device_has_are_refused() {
        let Some((device, _)) = device("workgroups_that_no_device_has_are_refused", DeviceSettings::default()) else {
            return;
        };
        let spans = |group, workgroups| RasterKernel::Spans { group, workgroups };
        let rows = |group, words| RasterKernel::Rows(RowWay { group, words, keeps_edges: false });
        for (kernel, told) in [
            (spans(0, 1), "this device has workgroups of 1 to"),
            (spans(1 << 20, 1), "this device has workgroups of 1 to"),
            (spans(64, 0), "expected at least one"),
            (rows(48, 3), "a workgroup has 48 rows, expected a power of two from 8 to 256"),
            (rows(4, 3), "a workgroup has 4 rows, expected a power of two from 8 to 256"),
            (rows(32, 5), "5 words at once, expected 1 to 4"),
            (rows(32, 0), "0 words at once, expected 1 to 4"),
        ] {
            let body = Body::adult(1750.0).unwrap();
            let error = Compute::with_kernel(&device, &body, &cameras(), kernel).unwrap_err().to_string();
            assert!(error.contains(told), "{error}");
        }
    }
}
