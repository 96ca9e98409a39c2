//! Given poses against one frame: components and fitness, and the candidate images they come from.

use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

use super::Drawing;
use crate::body::{Body, Model, PoseTable};
use crate::evaluate::{Components, EdgeTerm, Evaluator, Objective, Reference, SegmentSums};
use crate::features::Observation;
use crate::files::{OutputFolder, file_stem};
use crate::geometry::Camera;
use crate::observe::{
    Appearance, Observer, check_background, feature_settings, take_likelihoods, take_observations, with_plates,
};
use crate::sequence::Sequence;

/// Poses scored at once: enough to keep every worker busy, and a bound on the memory.
const BATCH: usize = 4096;

/// What one frame is compared with.
pub struct ScoredFrame {
    /// The body.
    pub body: Body,
    /// The cameras at the size of the observations.
    pub cameras: Vec<Camera>,
    /// What was seen, one a camera.
    pub observations: Vec<Observation>,
}

impl ScoredFrame {
    /// Frame `frame` of a sequence; with evidence where `objective` weighs it, by which every colour of the person is as likely.
    ///
    /// # Errors
    /// When the sequence has no such frame, or anything it names cannot be read.
    pub fn of_sequence(sequence: &Sequence, frame: usize, objective: &Objective) -> Result<Self> {
        ensure!(
            frame < sequence.frame_count,
            "{} has no frame {frame}, expected 0 to {}",
            sequence.path.display(),
            sequence.frame_count.saturating_sub(1)
        );
        let range = frame..frame + 1;
        let plated = with_plates(sequence, &mut |_, _, _| {})?;
        let sequence = plated.sequence.as_ref();
        check_background(sequence, &range)?;
        let mut settings = feature_settings(sequence)?;
        settings.likelihoods = objective.weighs_evidence();
        let mut observer = Observer::new(sequence, settings, range, frame)?;
        let body = Body::load(&sequence.body)?;
        let mut seen = None;
        while let Some(set) = observer.read()? {
            if let Some(features) = observer.features(&set, true)? {
                seen = Some((take_observations(features), take_likelihoods(features)));
            }
        }
        let ended = || format!("{} ended before frame {frame}", sequence.path.display());
        let (mut observations, likelihoods) = seen.with_context(ended)?;
        Appearance::new(&body).give(&likelihoods, &mut observations)?;
        Ok(Self { body, cameras: sequence.cameras.clone(), observations })
    }

    /// Packed observations `<camera>.png` from a folder.
    ///
    /// # Errors
    /// When one is missing, no 8-bit grey picture, or of another size than its camera's pictures.
    pub fn of_observations(folder: &Path, cameras: Vec<Camera>, body: Body) -> Result<Self> {
        let mut observations = Vec::with_capacity(cameras.len());
        for camera in &cameras {
            let path = folder.join(format!("{}.png", camera.name));
            let observation = Observation::read_png(&path)?;
            ensure!(
                [observation.width, observation.height] == camera.size,
                "{} is {}x{} pixels, camera {:?} has {}x{}",
                path.display(),
                observation.width,
                observation.height,
                camera.name,
                camera.size[0],
                camera.size[1]
            );
            observations.push(observation);
        }
        Ok(Self { body, cameras, observations })
    }
}

/// How poses were scored.
#[derive(Clone, Debug, PartialEq)]
pub struct Scores {
    /// One a pose, in [0, 1].
    pub fitness: Vec<f32>,
    /// Which evaluator, and why.
    pub backend: String,
    /// Whether the reference drew the images, because the evaluator keeps no pictures.
    pub drawn_by_reference: bool,
}

/// Scores poses against a frame; one fitness a pose. With `output` it writes components.csv and fitness.csv there, segments.csv where
/// the observations tell body parts apart, evidence.csv where they carry evidence, and with `images` besides every candidate as `images/pose_%06d_<camera>.png` (8-bit grey:
/// bits 0-6 the label, bit 7 the edge), as the evaluator drew it, or the reference for one that keeps no picture.
/// Poses are counted from 0 in the order of the table, whatever their frames.
///
/// # Errors
/// When the backend cannot be made or a file not written.
pub fn score_poses(
    frame: &ScoredFrame,
    poses: &PoseTable,
    drawing: Drawing,
    devices: &[usize],
    model: Model,
    objective: &Objective,
    output: Option<&OutputFolder>,
    images: bool,
) -> Result<Scores> {
    let mesh = model.mesh(&frame.body)?;
    let rows = single_precision(&frame.body, poses);
    let dofs = frame.body.dof_count();
    let standing: Vec<f32> = frame.body.standing_pose().iter().map(|value| *value as f32).collect();
    let around = rows.get(..dofs).unwrap_or(&standing);
    let mut built = drawing.build(devices, mesh.as_ref(), &frame.body, &frame.cameras, around)?;
    let evaluator = built.evaluator.as_mut();
    evaluator.observe(&frame.observations)?;
    let mut all = Vec::with_capacity(poses.poses.len());
    for batch in rows.chunks(BATCH * dofs) {
        let first = all.len();
        all.resize(first + batch.len() / dofs, 0.0);
        evaluator.fitness(batch, objective, &mut all[first..])?;
    }
    let mut scores = Scores { fitness: all, backend: built.reason, drawn_by_reference: false };
    let Some(output) = output else { return Ok(scores) };
    output.write("components.csv", |writer| write_components(writer, frame, evaluator, &rows))?;
    output.write("fitness.csv", |writer| write_fitness(writer, &scores.fitness))?;
    if evaluator.segments().is_some() {
        output.write("segments.csv", |writer| write_segments(writer, frame, evaluator, &rows, objective.edges))?;
    }
    if evaluator.best_evidence().is_some() {
        output.write("evidence.csv", |writer| write_evidence(writer, frame, evaluator, &rows))?;
    }
    if images {
        let reference = match mesh {
            None => Reference::new(&frame.body, &frame.cameras),
            Some(mesh) => Reference::of_mesh(&frame.body, mesh, &frame.cameras)?,
        };
        scores.drawn_by_reference = write_images(output, frame, evaluator, &reference, &rows)?;
    }
    Ok(scores)
}

/// Every pose in every view as the evaluator drew it, else as the reference does; whether that was necessary.
fn write_images(
    output: &OutputFolder,
    frame: &ScoredFrame,
    evaluator: &mut dyn Evaluator,
    reference: &Reference,
    rows: &[f32],
) -> Result<bool> {
    let mut drawn_by_reference = false;
    for (index, pose) in rows.chunks_exact(frame.body.dof_count()).enumerate() {
        for (view, camera) in frame.cameras.iter().enumerate() {
            let image = evaluator.drawn(pose, view)?.unwrap_or_else(|| {
                drawn_by_reference = true;
                reference.draw(pose, view)
            });
            output.write(&format!("images/pose_{index:06}_{}.png", file_stem(&camera.name)), |writer| {
                let size = (image.width, image.height);
                Ok(PngEncoder::new(writer).write_image(&image.bytes, size.0, size.1, ExtendedColorType::L8)?)
            })?;
        }
    }
    Ok(drawn_by_reference)
}

/// `pose,fitness`.
///
/// # Errors
/// When writing fails.
pub fn write_fitness(out: &mut dyn Write, fitness: &[f32]) -> Result<()> {
    writeln!(out, "pose,fitness")?;
    for (pose, value) in fitness.iter().enumerate() {
        writeln!(out, "{pose},{value}")?;
    }
    Ok(())
}

fn write_components(
    out: &mut dyn Write,
    frame: &ScoredFrame,
    evaluator: &mut dyn Evaluator,
    rows: &[f32],
) -> Result<()> {
    let (views, dofs) = (frame.cameras.len(), frame.body.dof_count());
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(["pose", "view", "area_obs", "area_model", "overlap", "edges", "proximity"])?;
    let mut components = Vec::new();
    for (index, batch) in rows.chunks(BATCH * dofs).enumerate() {
        components.clear();
        components.resize(batch.len() / dofs * views, Components::default());
        evaluator.components(batch, &mut components)?;
        for (at, found) in components.iter().enumerate() {
            let pose = (index * BATCH + at / views).to_string();
            let Components { area_obs, area_model, overlap, edges, proximity } = *found;
            let numbers = [area_obs, area_model, overlap, edges, proximity].map(|number| number.to_string());
            let cells = [pose.as_str(), &frame.cameras[at % views].name];
            writer.write_record(cells.into_iter().chain(numbers.iter().map(String::as_str)))?;
        }
    }
    Ok(writer.flush()?)
}

/// Areas and overlaps, and the edges where the objective weighs them by segments.
fn write_segments(
    out: &mut dyn Write,
    frame: &ScoredFrame,
    evaluator: &mut dyn Evaluator,
    rows: &[f32],
    edges: EdgeTerm,
) -> Result<()> {
    let (views, dofs) = (frame.cameras.len(), frame.body.dof_count());
    let Some(segments) = evaluator.segments().cloned() else { return Ok(()) };
    let segments = segments.as_slice();
    let mut writer = csv::Writer::from_writer(out);
    let counted = match edges {
        EdgeTerm::Whole => 3,
        EdgeTerm::Segments => 5,
    };
    let names = ["area_obs", "area_model", "overlap", "edges", "proximity"];
    writer.write_record(["pose", "view", "segment"].iter().chain(&names[..counted]))?;
    let mut sums = Vec::new();
    for (index, batch) in rows.chunks(BATCH * dofs).enumerate() {
        sums.clear();
        sums.resize(batch.len() / dofs * views * segments.len(), SegmentSums::default());
        evaluator.segment_sums(batch, &mut sums)?;
        for (at, found) in sums.iter().enumerate() {
            let (image, segment) = (at / segments.len(), &segments[at % segments.len()].name);
            let pose = (index * BATCH + image / views).to_string();
            let SegmentSums { area_obs, area_model, overlap, edges, proximity } = *found;
            let numbers = [area_obs, area_model, overlap, edges, proximity].map(|number| number.to_string());
            let cells = [pose.as_str(), &frame.cameras[image % views].name, segment];
            writer.write_record(cells.into_iter().chain(numbers[..counted].iter().map(String::as_str)))?;
        }
    }
    Ok(writer.flush()?)
}

fn write_evidence(out: &mut dyn Write, frame: &ScoredFrame, evaluator: &mut dyn Evaluator, rows: &[f32]) -> Result<()> {
    let (views, dofs) = (frame.cameras.len(), frame.body.dof_count());
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(["pose", "view", "evidence"])?;
    let mut sums = Vec::new();
    for (index, batch) in rows.chunks(BATCH * dofs).enumerate() {
        sums.clear();
        sums.resize(batch.len() / dofs * views, 0);
        evaluator.evidence_sums(batch, &mut sums)?;
        for (at, sum) in sums.iter().enumerate() {
            let pose = (index * BATCH + at / views).to_string();
            writer.write_record([pose.as_str(), &frame.cameras[at % views].name, &sum.to_string()])?;
        }
    }
    Ok(writer.flush()?)
}

/// Poses as evaluators take them. An angle is brought to [-pi, pi] while it is double precision: a large one would lose
/// its digits.
fn single_precision(body: &Body, poses: &PoseTable) -> Vec<f32> {
    let is_rotation: Vec<bool> = body.dofs().map(|(_, dof)| dof.axis.is_rotation()).collect();
    let rows = poses.poses.iter().flat_map(|pose| pose.iter().zip(&is_rotation));
    rows.map(|(&value, &is_rotation)| (if is_rotation { reduced(value) } else { value }) as f32).collect()
}

/// The same angle in [-pi, pi]; one that is there already keeps its bits.
fn reduced(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    if angle.abs() <= PI { angle } else { angle - (angle / TAU).round() * TAU }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::evaluate::CandidateImage;
    use crate::features::{Evidence, PartClasses};

    /// An evaluator that keeps pictures of one view alone.
    struct Painter;

    impl Evaluator for Painter {
        fn name(&self) -> &'static str {
            "painter"
        }

        fn variant(&self) -> &'static str {
            "oil"
        }

        fn view_count(&self) -> usize {
            4
        }

        fn dof_count(&self) -> usize {
            31
        }

        fn observe(&mut self, _: &[Observation]) -> Result<()> {
            Ok(())
        }

        fn components(&mut self, _: &[f32], _: &mut [Components]) -> Result<()> {
            Ok(())
        }

        fn fitness(&mut self, _: &[f32], _: &Objective, _: &mut [f32]) -> Result<()> {
            Ok(())
        }

        fn drawn(&mut self, pose: &[f32], view: usize) -> Result<Option<CandidateImage>> {
            Ok((view == 1).then(|| CandidateImage { width: 2, height: 1, bytes: vec![pose[0] as u8, 7] }))
        }
    }

    #[test]
    fn images_are_the_evaluator_s_own_where_it_has_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        let output = OutputFolder::create(&path, crate::files::Overwrite::Refuse).unwrap();
        let body = Body::adult(1750.0).unwrap();
        let cameras = crate::synth::rig::four_cameras(glam::DVec2::splat(2000.0), [64, 48]);
        let reference = Reference::new(&body, &cameras);
        let names: Vec<String> = cameras.iter().map(|camera| camera.name.clone()).collect();
        let frame = ScoredFrame { body, cameras, observations: Vec::new() };
        let mut rows = vec![0.0; 62];
        rows[31] = 9.0;
        assert!(
            write_images(&output, &frame, &mut Painter, &reference, &rows).unwrap(),
            "three views are the reference's"
        );
        let read = |view: usize| {
            let path = path.join(format!("images/pose_000001_{}.png", names[view]));
            image::open(path).unwrap().into_luma8().into_raw()
        };
        assert_eq!(read(1), [9, 7]);
        assert_eq!(read(2), reference.draw(&rows[31..], 2).bytes);
        let mut own = Reference::new(&frame.body, &frame.cameras);
        let again = OutputFolder::create(&folder.path().join("own"), crate::files::Overwrite::Refuse).unwrap();
        assert!(!write_images(&again, &frame, &mut own, &reference, &rows).unwrap());
    }

    #[test]
    fn evidence_is_written_a_row_a_pose_and_view() {
        let body = Body::adult(1750.0).unwrap();
        let cameras = crate::synth::rig::four_cameras(glam::DVec2::splat(2000.0), [64, 48]);
        let classes = Arc::new(PartClasses::one());
        let words = |view: u32| (0..64 * 48).map(|at| 8 + (at + view) % 3).collect();
        let seen = |view| {
            let evidence = Evidence::new(Arc::clone(&classes), 64, 48, words(view)).unwrap();
            Observation { evidence: Some(evidence), ..Observation::empty(64, 48) }
        };
        let frame = ScoredFrame { observations: (0..4).map(seen).collect(), body, cameras };
        let mut evaluator = Reference::new(&frame.body, &frame.cameras);
        evaluator.observe(&frame.observations).unwrap();
        let standing: Vec<f32> = frame.body.standing_pose().iter().map(|value| *value as f32).collect();
        let rows = [standing.clone(), standing].concat();
        let mut sums = [0; 8];
        evaluator.evidence_sums(&rows, &mut sums).unwrap();
        assert!(sums.iter().all(|sum| *sum > 0), "{sums:?}");
        let mut written = Vec::new();
        write_evidence(&mut written, &frame, &mut evaluator, &rows).unwrap();
        let lines: Vec<String> = String::from_utf8(written).unwrap().lines().map(str::to_owned).collect();
        assert_eq!((lines[0].as_str(), lines.len()), ("pose,view,evidence", 9));
        assert_eq!(lines[7], format!("1,{},{}", frame.cameras[2].name, sums[6]));
    }

    #[test]
    fn angles_are_reduced_before_they_lose_digits() {
        use std::f64::consts::{PI, TAU};
        assert_eq!(reduced(1.25), 1.25);
        assert_eq!(reduced(-PI), -PI);
        for turns in [-7.0, 1.0, 1000.0, 25_000.0] {
            assert!((reduced(0.3 + turns * TAU) - 0.3).abs() < 1e-9, "{turns}");
        }
        let body = Body::adult(1750.0).unwrap();
        let mut pose = body.standing_pose();
        pose[0] = 1000.0;
        pose[5] = 0.3 + 20_000.0 * TAU;
        let row = single_precision(&body, &PoseTable { frames: vec![0], poses: vec![pose] });
        assert_eq!((row[0], row[5]), (1000.0, 0.3));
    }
}
