//! The manifest `sequence.toml`: which files make a sequence, checked before anything long is started.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, anyhow, bail};

use super::calibration::read_cameras_sized;
use super::coverage::check_coverage;
use super::likely_delays::likely_delays;
use super::manifest_file::ManifestFile;
use super::named_files::NamedFiles;
use super::person::Person;
use super::source::{LiveSource, NO_END, Source};
use super::synchrony::{Recorded, Stamps, synchronise};
use super::view::{View, check_sizes, open_view, working_size};
use crate::files::{nearest, read_toml};
use crate::geometry::Camera;

/// A sequence: synchronised pictures of calibrated cameras, and what belongs to them (METHOD A2, FORMATS).
#[derive(Clone, Debug)]
pub struct Sequence {
    /// The manifest's file.
    pub path: PathBuf,
    /// The manifest's folder; relative paths in the manifest start here.
    pub dir: PathBuf,
    /// The sequence's name.
    pub name: String,
    /// Frames per second.
    pub fps: f64,
    /// Working size over stored size, in (0, 1].
    pub scale: f64,
    /// The views' cameras in the order of the views, already scaled to the working size.
    pub cameras: Vec<Camera>,
    /// The views' working sizes, pixels, width then height: the stored size times `scale`, rounded, at least 1.
    pub sizes: Vec<[u32; 2]>,
    /// The people where several are tracked ([`Self::of_person`]); else none, and the person is this sequence's own.
    pub people: Vec<Person>,
    /// The body file, the first person's where there are several; one that is yet to be made where [`Self::needs_body`].
    pub body: PathBuf,
    /// The height of the person, mm, where the manifest tells it.
    pub height: Option<f64>,
    /// Whether the body was measured in one posture, so that a track that goes over its frames twice measures it again in the poses of the first;
    /// none where the manifest does not say: so it is with a body that the track finds by itself.
    pub measure_again: Option<bool>,
    names_body: bool,
    /// A poses.csv with the first pose.
    pub start: Option<PathBuf>,
    /// Reference motion.
    pub truth: Option<PathBuf>,
    /// What each camera saw.
    pub views: Vec<View>,
    /// Frames in every view; [`Sequence::NO_END`] where they are live.
    pub frame_count: usize,
    /// The views as they were recorded, and what their times are taken for.
    recorded: Arc<[Recorded]>,
    stamps: Option<Stamps>,
    /// What a user should know of how the videos were recorded, a sentence each.
    warnings: Vec<String>,
    /// What is made of them because the files or the manifest say so, a sentence each.
    notes: Vec<String>,
    /// The `[objective]` table as written, for the search to read.
    pub objective: Option<toml::Table>,
    /// The `[features]` table as written, for the features to read.
    pub features: Option<toml::Table>,
}

/// A learnt background may be doubtful in this share of the picture, %.
pub const DOUBTFUL: f64 = 1.0;

impl Sequence {
    /// Opens a sequence: `path` is its manifest, or the folder with a `sequence.toml` in it. Every file it names is
    /// looked at (videos are counted, not decoded).
    ///
    /// # Errors
    /// One sentence naming the manifest (or the file at fault), the key, what was found and what was expected: an
    /// unknown key, an unknown or repeated camera, no views, views of different length, pictures of another size than
    /// the calibration's, a missing or unreadable file, a scale or frame rate out of range, a camera that does not see
    /// what the others see.
    pub fn open(path: &Path) -> Result<Self> {
        let sequence = Self::open_with(path, true)?;
        sequence.refuse_live()?;
        Ok(sequence)
    }

    /// As [`Self::open`], but the views may be live sources: cameras and streams (FORMATS: `source` with an address like
    /// `rtsp://…` or a device like `/dev/video0`, or any `source` with `input`, options for ffmpeg).
    ///
    /// # Errors
    /// As [`Self::open`]; and when some views are live and others are not.
    pub fn open_live(path: &Path) -> Result<Self> {
        Self::open_with(path, true)
    }

    /// The number of frames of a live sequence.
    pub const NO_END: usize = NO_END;

    /// Whether its views are live sources.
    pub fn is_live(&self) -> bool {
        self.views.iter().any(|view| matches!(view.source, Source::Live(_)))
    }

    /// What whoever tracks it should know of its views, a sentence each.
    pub fn remarks(&self) -> Vec<String> {
        let doubtful = self.views.iter().filter(|view| view.background_doubtful > DOUBTFUL);
        let plates = doubtful.filter_map(|view| {
            let plate = view.background.as_ref()?.display();
            Some(format!(
                "the background of camera {:?} was learnt and {:.1} % of it is doubtful: look at {plate}, and where the person stands in it \
                 film the empty scene or on until he has left that place; limbs are lost there",
                view.camera, view.background_doubtful
            ))
        });
        self.remarks_on_recordings().into_iter().chain(plates).collect()
    }

    /// The same without what is to be known of its backgrounds.
    pub fn remarks_on_recordings(&self) -> Vec<String> {
        let path = self.path.display();
        let one = (self.views.len() == 1).then(|| {
            format!(
                "{path} has one view, in which near and far look alike: depth is a guess, expected two views or more"
            )
        });
        one.into_iter().chain(self.notes.iter().cloned()).chain(self.warnings.iter().cloned()).collect()
    }

    /// Those remarks by which nothing is amiss: what is made of the videos because they or the manifest say so.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Delays of its views that their files make likely, whole frames each: how long they are, their clocks and time stamps. None where all
    /// say that the cameras began together, or the manifest states a delay.
    pub fn likely_delays(&self) -> Vec<Vec<f64>> {
        if self.is_live() { Vec::new() } else { likely_delays(&self.recorded, self.fps) }
    }

    /// The same sequence as if its manifest stated these delays, frames, one a view.
    ///
    /// # Errors
    /// When a view has no frame that the others have, or it is live.
    pub fn delayed(&self, delays: &[f64]) -> Result<Self> {
        let with = |(recorded, &delay): (&Recorded, &f64)| Recorded { delay: Some(delay), ..recorded.clone() };
        let recorded: Arc<[Recorded]> = self.recorded.iter().zip(delays).map(with).collect();
        let together =
            synchronise(&recorded, self.fps, self.stamps).with_context(|| self.path.display().to_string())?;
        let views = self.views.iter().zip(together.picks).zip(delays);
        let views = views.map(|((view, picks), &delay)| View { picks, delay, ..view.clone() }).collect();
        let turned = recorded.iter().filter_map(|view| view.footage.turned());
        Ok(Self {
            notes: turned.chain(together.notes).collect(),
            warnings: together.remarks,
            frame_count: together.frame_count,
            views,
            recorded,
            ..self.clone()
        })
    }

    fn refuse_live(&self) -> Result<()> {
        if let Some(view) = self.views.iter().find(|view| matches!(view.source, Source::Live(_))) {
            bail!(
                "{}: the source of camera {:?} is live, which only `track --realtime` reads",
                self.path.display(),
                view.camera
            );
        }
        Ok(())
    }

    /// Which view's background must be learnt from the frames, the first of them, where there is one: the beginning of a sentence that names
    /// the manifest and the camera.
    pub fn unknown_background(&self) -> Option<String> {
        let view = self.views.iter().find(|view| view.learns_background())?;
        Some(format!("{}: camera {:?} has neither a background picture nor masks", self.path.display(), view.camera))
    }

    /// Whether the manifest names no body, so that one has to be measured first.
    pub fn needs_body(&self) -> bool {
        !self.names_body
    }

    /// Whether the manifest names a body, and it is not `file`, which may be yet to be made.
    pub fn names_another_body(&self, file: &Path) -> bool {
        let whole = |path: &Path| {
            let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
            Some(parent.canonicalize().ok()?.join(path.file_name()?))
        };
        self.names_body && whole(file).is_some_and(|file| Some(file) != whole(&self.body))
    }

    /// The same sequence with one of its people alone.
    #[must_use]
    pub fn of_person(&self, person: &Person) -> Self {
        let Person { body, start, truth, .. } = person.clone();
        Self { people: Vec::new(), body, start: Some(start), truth, ..self.clone() }
    }

    /// As [`Self::open`], but the files of the body and the start pose may be yet to be made.
    ///
    /// # Errors
    /// As [`Self::open`], those two files apart.
    pub fn open_unfitted(path: &Path) -> Result<Self> {
        let sequence = Self::open_with(path, false)?;
        sequence.refuse_live()?;
        Ok(sequence)
    }

    fn open_with(path: &Path, is_fitted: bool) -> Result<Self> {
        let path = if path.is_dir() { path.join("sequence.toml") } else { path.to_path_buf() };
        let file: ManifestFile = read_toml(&path)?;
        let shown_path = path.display();
        file.check(&shown_path.to_string())?;
        let dir = path.parent().map(Path::to_path_buf).unwrap_or_default();
        let files = NamedFiles { manifest: &path, dir: &dir };
        // A folder may hold a calibration file a camera.
        let cameras_path = match files.place(&file.cameras) {
            folder if folder.is_dir() => folder,
            _ => files.existing("cameras", &file.cameras)?,
        };
        let fitted = |key: &str, relative: &Path| -> Result<PathBuf> {
            if is_fitted { files.existing(key, relative) } else { Ok(files.place(relative)) }
        };
        let people = file.person.iter().map(|person| person.open(files)).collect::<Result<Vec<Person>>>()?;
        let first = people.first();
        let names_body = file.body.is_some() || first.is_some();
        let body = file.body.as_deref().map_or_else(|| Ok(dir.join("body.toml")), |body| fitted("body", body))?;
        let start = file.start.as_deref().map(|start| fitted("start", start)).transpose()?;
        let truth = file.truth.as_deref().map(|truth| files.existing("truth", truth)).transpose()?;
        let body = first.map_or(body, |person| person.body.clone());
        let start = first.map(|person| person.start.clone()).or(start);
        let truth = first.and_then(|person| person.truth.clone()).or(truth);
        // Some calibrations leave the size of the pictures to the pictures.
        let size_of = |camera: &str| -> Result<Option<[u32; 2]>> {
            let Some(view) = file.view.iter().find(|view| view.camera == camera) else { return Ok(None) };
            if LiveSource::of(&view.source, view.input.as_deref(), &dir).is_some() {
                return Ok(None);
            }
            let source = files.footage(&format!("the source of camera {camera:?}"), &view.source)?;
            Ok(Some(view.oriented(source, None).size))
        };
        let calibrated = read_cameras_sized(&cameras_path, &size_of)?;

        let (mut opened, mut recorded, mut cameras) = (Vec::new(), Vec::new(), Vec::new());
        for (index, table) in file.view.iter().enumerate() {
            if file.view[..index].iter().any(|earlier| earlier.camera == table.camera) {
                bail!("{shown_path}: camera {:?} has two views, expected one", table.camera);
            }
            let camera = find_camera(&calibrated, &table.camera)
                .ok_or_else(|| unknown_camera(&path, &cameras_path, &calibrated, &table.camera))?;
            let (view, footage) = open_view(table, camera, files, file.scale)?;
            opened.push(view);
            recorded.push(Recorded { camera: table.camera.clone(), footage, delay: table.delay });
            cameras.push(camera.clone());
        }
        let together = synchronise(&recorded, file.fps, file.timestamps).with_context(|| shown_path.to_string())?;
        check_coverage(&path, &cameras)?;

        let notes = recorded.iter().filter_map(|view| view.footage.turned()).chain(together.notes).collect();
        let warnings = together.remarks;
        let views: Vec<View> =
            opened.into_iter().zip(together.picks).map(|(view, picks)| View { picks, ..view }).collect();
        check_sizes(&views, file.scale).with_context(|| path.display().to_string())?;
        let sizes: Vec<[u32; 2]> = views.iter().map(|view| working_size(view.size, file.scale)).collect();
        let cameras = cameras.iter().zip(&sizes).map(|(camera, &size)| camera.scaled(size)).collect();
        Ok(Self {
            name: file.name,
            fps: file.fps,
            scale: file.scale,
            cameras,
            sizes,
            people,
            body,
            height: file.height,
            measure_again: file.measure_again,
            names_body,
            start,
            truth,
            views,
            frame_count: together.frame_count,
            recorded: recorded.into(),
            stamps: file.timestamps,
            warnings,
            notes,
            objective: file.objective,
            features: file.features,
            dir,
            path,
        })
    }
}

fn find_camera<'a>(cameras: &'a [Camera], name: &str) -> Option<&'a Camera> {
    cameras.iter().find(|camera| camera.name == name)
}

fn unknown_camera(path: &Path, cameras_path: &Path, cameras: &[Camera], name: &str) -> anyhow::Error {
    let nearest = nearest(name, cameras.iter().map(|camera| camera.name.as_str()));
    let nearest = nearest.map_or_else(|| "it has no cameras".to_string(), |near| format!("the nearest is {near:?}"));
    anyhow!("{}: {} has no camera {name:?}, {nearest}", path.display(), cameras_path.display())
}

#[cfg(test)]
#[path = "recordings_tests.rs"]
pub(super) mod recordings_tests;
#[cfg(test)]
#[path = "manifest_tests.rs"]
pub(super) mod tests;
