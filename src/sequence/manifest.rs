//! The manifest `sequence.toml`: which files make a sequence, checked before anything long is started.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result, anyhow, bail};
use serde::Deserialize;

use super::calibration::read_cameras_sized;
use super::coverage::check_coverage;
use super::footage::{Footage, is_pattern};
use super::ignored::Ignored;
use super::likely_delays::likely_delays;
use super::live_options;
use super::person::{Person, PersonTable, check_names};
use super::pictures::{shown, still};
use super::source::{LiveSource, Source};
use super::synchrony::{MOST_DELAY, Recorded, Stamps, synchronise};
use super::turn::Turn;
use crate::files::{beside, check_regular, choices, nearest, parse_toml, read_toml};
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

/// What one camera saw.
#[derive(Clone, Debug)]
pub struct View {
    /// The camera's name.
    pub camera: String,
    /// The size of its pictures as they are read, pixels, width then height: that of the calibration.
    pub size: [u32; 2],
    /// Its pictures.
    pub source: Source,
    /// How many there are.
    pub stored: usize,
    /// The number of each frame's picture, ascending; none where frames and pictures are the same.
    pub picks: Option<Arc<[u32]>>,
    /// Frames by which its pictures come too late, as the manifest says.
    pub delay: f64,
    /// A picture of the empty scene.
    pub background: Option<PathBuf>,
    /// How much of it is doubtful since it was learnt from pictures with the person, % of the picture; 0 for one that was filmed.
    pub background_doubtful: f64,
    /// Ready silhouettes and the size they are stored at.
    pub mask: Option<(Source, [u32; 2])>,
    /// Pixels that count neither for nor against anybody.
    pub ignored: Option<Ignored>,
    /// A picture of the empty scene that was learnt, at the working size; no manifest names one.
    pub learnt: Option<Arc<image::RgbImage>>,
}

impl View {
    /// Whether it has neither mask nor plate, so that its background must be learnt from the frames.
    pub fn learns_background(&self) -> bool {
        self.mask.is_none() && self.background.is_none() && self.learnt.is_none()
    }

    /// Its pictures by themselves, all that there are.
    pub fn footage(&self) -> Footage {
        let shown = format!("the pictures of camera {:?}", self.camera);
        Footage::plain(shown, self.source.clone(), self.size, self.stored)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ManifestFile {
    name: String,
    fps: f64,
    cameras: PathBuf,
    body: Option<PathBuf>,
    height: Option<f64>,
    measure_again: Option<bool>,
    start: Option<PathBuf>,
    truth: Option<PathBuf>,
    #[serde(default = "full_size")]
    scale: f64,
    timestamps: Option<Stamps>,
    #[serde(default)]
    view: Vec<ViewTable>,
    #[serde(default)]
    person: Vec<PersonTable>,
    objective: Option<toml::Table>,
    features: Option<toml::Table>,
}

/// A learnt background may be doubtful in this share of the picture, %.
pub const DOUBTFUL: f64 = 1.0;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ViewTable {
    camera: String,
    source: PathBuf,
    input: Option<Vec<String>>,
    background: Option<PathBuf>,
    background_doubtful: Option<f64>,
    mask: Option<PathBuf>,
    ignore: Option<PathBuf>,
    delay: Option<f64>,
    #[serde(default, deserialize_with = "number_or_name")]
    orientation: Option<Orientation>,
}

choices! {
    /// How the stored pictures of a view are turned when they are read.
    "orientation" pub enum Orientation {
        /// Turned as a video is marked to be for display, as players and OpenCV show it.
        "upright" Upright,
        /// As they are stored.
        "stored" Stored,
        /// As they are stored, turned clockwise by 90 degrees.
        "90" Clockwise,
        /// As they are stored, turned by 180 degrees.
        "180" Half,
        /// As they are stored, turned clockwise by 270 degrees.
        "270" Counterclockwise,
        /// As they are stored, left for right.
        "mirrored" Mirrored,
    }
}

impl Orientation {
    /// How stored pictures are turned, where that does not depend on the file.
    pub(crate) fn turn(self) -> Option<Turn> {
        match self {
            Self::Upright => None,
            Self::Stored => Some(Turn::None),
            Self::Clockwise => Some(Turn::Clockwise),
            Self::Half => Some(Turn::Half),
            Self::Counterclockwise => Some(Turn::Counterclockwise),
            Self::Mirrored => Some(Turn::Mirrored),
        }
    }

    /// The orientation in which stored pictures are turned so.
    pub(crate) fn of(turn: Turn) -> Option<Self> {
        Self::ALL.into_iter().find(|orientation| orientation.turn() == Some(turn))
    }

    /// As a manifest has it: degrees as a number.
    pub(crate) fn value(self) -> toml::Value {
        let name = self.name();
        name.parse::<i64>().map_or_else(|_| name.into(), toml::Value::from)
    }

    /// Footage as a view wants it: as its manifest says, else as it fits the size that a camera is calibrated for, else upright.
    pub(crate) fn orient(own: Option<Self>, footage: Footage, size: Option<[u32; 2]>) -> Footage {
        match (own.map(Self::turn), size) {
            (Some(Some(turn)), _) => footage.put(turn),
            (None, Some(size)) => footage.fitting(size),
            _ => footage,
        }
    }
}

/// An orientation by its name, which may be a number.
fn number_or_name<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Option<Orientation>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Written {
        Number(i64),
        Name(String),
    }
    let name = match Written::deserialize(deserializer)? {
        Written::Number(number) => number.to_string(),
        Written::Name(name) => name,
    };
    Orientation::from_name(&name).map(Some).map_err(serde::de::Error::custom)
}

impl ViewTable {
    fn oriented(&self, footage: Footage, size: Option<[u32; 2]>) -> Footage {
        Orientation::orient(self.orientation, footage, size)
    }
}

/// The smallest working scale.
const SMALLEST_SCALE: f64 = 0.01;

/// Pixels a side that scaling leaves of a picture at least.
const SMALLEST_SIDE: u32 = 8;

fn full_size() -> f64 {
    1.0
}

impl ManifestFile {
    /// What can be said of a manifest without looking at the files it names.
    fn check(&self, name: &str) -> Result<()> {
        check_fps(self.fps).with_context(|| name.to_string())?;
        check_scale(self.scale).with_context(|| name.to_string())?;
        let own = [("body", self.body.is_some()), ("start", self.start.is_some()), ("truth", self.truth.is_some())];
        let more = [("height", self.height.is_some()), ("measure_again", self.measure_again.is_some())];
        let own = own.into_iter().chain(more).find(|(_, is_there)| *is_there);
        if let (Some((key, _)), false) = (own, self.person.is_empty()) {
            bail!("{name} has `{key}` and [[person]], expected a `body` and `start` in each [[person]] alone");
        }
        check_names(&self.person, name)?;
        if self.body.is_none() && self.height.is_none() && self.person.is_empty() {
            bail!(
                "{name} has neither `body` nor `height`, expected the file of the person's body or how tall the person is, mm"
            );
        }
        if let Some(height) = self.height.filter(|height| !(500.0..=2500.0).contains(height)) {
            bail!("{name}: height is {height}, expected 500 to 2500 mm");
        }
        if self.view.is_empty() {
            bail!("{name} has no views, expected a [[view]] with `camera` and `source` for each camera");
        }
        for view in &self.view {
            let options = view.input.as_deref().unwrap_or_default();
            let checked = live_options::check(&view.source.to_string_lossy(), options);
            checked.with_context(|| format!("{name}: the source of camera {:?}", view.camera))?;
            if let Some(delay) = view.delay.filter(|delay| delay.is_nan() || delay.abs() > MOST_DELAY) {
                bail!(
                    "{name}: the delay of camera {:?} is {}, expected at most {MOST_DELAY} frames, whole or not",
                    view.camera,
                    shown_number(delay)
                );
            }
        }
        Ok(())
    }
}

/// Checks a manifest's text alone, without the files it names; `name` stands for the file in messages.
///
/// # Errors
/// As [`Sequence::open`], as far as the text goes.
pub fn check_manifest(text: &str, name: &str) -> Result<()> {
    parse_toml::<ManifestFile>(text, name)?.check(name)
}

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
    pub const NO_END: usize = u32::MAX as usize;

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
        let existing = |key: &str, relative: &Path| -> Result<PathBuf> {
            let file = beside(&dir, relative);
            if let Err(why) = check_regular(&file) {
                bail!("{shown_path}: {key} is {:?}, and {why}", relative.display());
            }
            Ok(file)
        };
        // A folder may hold a calibration file a camera.
        let cameras_path = match beside(&dir, &file.cameras) {
            folder if folder.is_dir() => folder,
            _ => existing("cameras", &file.cameras)?,
        };
        let fitted = |key: &str, relative: &Path| -> Result<PathBuf> {
            if is_fitted { existing(key, relative) } else { Ok(beside(&dir, relative)) }
        };
        let people = file.person.iter().map(|person| person.open(&existing)).collect::<Result<Vec<Person>>>()?;
        let first = people.first();
        let names_body = file.body.is_some() || first.is_some();
        let body = file.body.as_deref().map_or_else(|| Ok(dir.join("body.toml")), |body| fitted("body", body))?;
        let start = file.start.as_deref().map(|start| fitted("start", start)).transpose()?;
        let truth = file.truth.as_deref().map(|truth| existing("truth", truth)).transpose()?;
        let body = first.map_or(body, |person| person.body.clone());
        let start = first.map(|person| person.start.clone()).or(start);
        let truth = first.and_then(|person| person.truth.clone()).or(truth);
        // Some calibrations leave the size of the pictures to the pictures.
        let size_of = |camera: &str| -> Result<Option<[u32; 2]>> {
            let Some(view) = file.view.iter().find(|view| view.camera == camera) else { return Ok(None) };
            if LiveSource::of(&view.source, view.input.as_deref(), &dir).is_some() {
                return Ok(None);
            }
            let source =
                open_source(&format!("the source of camera {camera:?}"), &view.source, &existing, (&path, &dir))?;
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
            let (view, footage) = open_view(table, camera, &existing, (&path, &dir), file.scale)?;
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

/// Holds a frame rate to what cameras record: steps in time, and how far a person gets in one, follow from it.
///
/// # Errors
/// With the value and the range.
pub(crate) fn check_fps(fps: f64) -> Result<()> {
    let [lowest, highest] = [0.01, 1e5];
    if !(lowest..=highest).contains(&fps) {
        bail!("fps is {}, expected {lowest} to {highest} frames per second", shown_number(fps));
    }
    Ok(())
}

/// Holds the working scale to where a picture is left of a picture.
///
/// # Errors
/// With the value and the range.
pub(crate) fn check_scale(scale: f64) -> Result<()> {
    if !(SMALLEST_SCALE..=1.0).contains(&scale) {
        bail!("scale is {}, expected {SMALLEST_SCALE} to 1", shown_number(scale));
    }
    Ok(())
}

/// Without the hundreds of digits of the largest and the smallest.
fn shown_number(value: f64) -> String {
    if value != 0.0 && value.is_finite() && !(1e-6..1e9).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

/// The size pictures are worked on at.
fn working_size(size: [u32; 2], scale: f64) -> [u32; 2] {
    size.map(|length| ((f64::from(length) * scale).round() as u32).max(1))
}

/// Refuses a scale that leaves nothing of a camera's pictures.
fn check_sizes(views: &[View], scale: f64) -> Result<()> {
    for View { camera, size, .. } in views {
        let smallest = size.map(|side| side.min(SMALLEST_SIDE));
        let working = working_size(*size, scale);
        if working[0] < smallest[0] || working[1] < smallest[1] {
            bail!(
                "scale is {scale}, which leaves {} pixels of the {} of camera {camera:?}, expected {SMALLEST_SIDE} or more a side",
                shown(working),
                shown(*size)
            );
        }
    }
    Ok(())
}

fn find_camera<'a>(cameras: &'a [Camera], name: &str) -> Option<&'a Camera> {
    cameras.iter().find(|camera| camera.name == name)
}

fn unknown_camera(path: &Path, cameras_path: &Path, cameras: &[Camera], name: &str) -> anyhow::Error {
    let nearest = nearest(name, cameras.iter().map(|camera| camera.name.as_str()));
    let nearest = nearest.map_or_else(|| "it has no cameras".to_string(), |near| format!("the nearest is {near:?}"));
    anyhow!("{}: {} has no camera {name:?}, {nearest}", path.display(), cameras_path.display())
}

/// Whether a plate of size `found` shows what pictures of size `full` show: it is an exact fraction of them, or of the working size.
pub(super) fn is_plate_size(found: [u32; 2], full: [u32; 2], working: [u32; 2]) -> bool {
    let ([width, height], [full_width, full_height]) = (found.map(u64::from), full.map(u64::from));
    (width * full_height == height * full_width && width <= full_width) || found == working
}

/// Looks at everything a view names, in the manifest `path` in `dir`; with the view, its pictures by themselves.
fn open_view(
    table: &ViewTable,
    camera: &Camera,
    existing: &impl Fn(&str, &Path) -> Result<PathBuf>,
    (path, dir): (&Path, &Path),
    scale: f64,
) -> Result<(View, Footage)> {
    let name = &table.camera;
    let key = |part: &str| format!("the {part} of camera {name:?}");
    let source = match LiveSource::of(&table.source, table.input.as_deref(), dir) {
        Some(live) => {
            if table.mask.is_some() {
                bail!("{}: camera {name:?} is live and has `mask`, expected `background` alone", path.display());
            }
            if let Some(turned) = table.orientation.filter(|orientation| orientation.turn().is_some()) {
                bail!(
                    "{}: camera {name:?} is live and has `orientation = \"{turned}\"`, expected that of recordings alone",
                    path.display()
                );
            }
            let shown = live.address.clone();
            // What it delivers is looked at when it is opened: a camera can be opened once.
            let (size, frame_count) = (camera.size, Sequence::NO_END);
            Footage::plain(shown, Source::Live(live), size, frame_count)
        }
        None => table.oriented(open_source(&key("source"), &table.source, existing, (path, dir))?, Some(camera.size)),
    };
    if source.size != camera.size {
        bail!(
            "{} has pictures of {} pixels, but camera {name:?} is calibrated for {}{}",
            source.shown,
            shown(source.size),
            shown(camera.size),
            source.why_another_size(camera.size)
        );
    }
    let background = table.background.as_deref().map(|plate| existing(&key("background"), plate)).transpose()?;
    if let Some(plate) = &background {
        let working = working_size(camera.size, scale);
        let (_, found) = still(plate, |found| is_plate_size(found, camera.size, working))?;
        if !is_plate_size(found, camera.size, working) {
            bail!(
                "{} is {} pixels, expected {} (as camera {name:?} is calibrated), an exact fraction of that, or {} (the working \
                 size)",
                plate.display(),
                shown(found),
                shown(camera.size),
                shown(working)
            );
        }
    }
    let background_doubtful = table.background_doubtful.unwrap_or(0.0);
    if table.background_doubtful.is_some() && (background.is_none() || !(0.0..=100.0).contains(&background_doubtful)) {
        bail!(
            "{}: camera {name:?} has `background_doubtful = {background_doubtful}`, expected it beside `background`, 0 to 100 % of the picture",
            path.display()
        );
    }
    let mask = match &table.mask {
        None => None,
        Some(mask) => {
            let mask = table.oriented(open_source(&key("mask"), mask, existing, (path, dir))?, None);
            check_mask(name, camera.size, source.frame_count, &mask).with_context(|| path.display().to_string())?;
            Some((mask.source, mask.size))
        }
    };
    let length = Some(source.frame_count).filter(|count| *count != Sequence::NO_END);
    let ignored =
        table.ignore.as_deref().map(|ignore| Ignored::open(&key("ignore"), &beside(dir, ignore), camera.size, length));
    let ignored = ignored.transpose().with_context(|| path.display().to_string())?;
    let view = View {
        camera: name.clone(),
        size: camera.size,
        source: source.source.clone(),
        stored: source.frame_count,
        picks: None,
        delay: table.delay.unwrap_or(0.0),
        background,
        background_doubtful,
        mask,
        ignored,
        learnt: None,
    };
    Ok((view, source))
}

/// Masks may be smaller or larger than the pictures, but of the same shape, to a pixel, and as many.
fn check_mask(camera: &str, size: [u32; 2], frame_count: usize, mask: &Footage) -> Result<()> {
    let ([width, height], [mask_width, mask_height]) = (size.map(u64::from), mask.size.map(u64::from));
    if (width * mask_height).abs_diff(height * mask_width) > width.max(height) {
        bail!("{} has masks of {} pixels, expected the shape of {}", mask.shown, shown(mask.size), shown(size));
    }
    if mask.frame_count != frame_count {
        bail!(
            "camera {camera:?} has {frame_count} pictures and {} masks ({}), expected as many",
            mask.frame_count,
            mask.shown
        );
    }
    Ok(())
}

fn open_source(
    key: &str,
    relative: &Path,
    existing: &impl Fn(&str, &Path) -> Result<PathBuf>,
    (manifest, dir): (&Path, &Path),
) -> Result<Footage> {
    let file = beside(dir, relative);
    if is_pattern(&file) {
        return Footage::open(&file)
            .with_context(|| format!("{}: {key} is {:?}", manifest.display(), relative.display()));
    }
    Footage::open(&existing(key, relative)?)
}

#[cfg(test)]
#[path = "manifest_tests.rs"]
pub(super) mod tests;
