//! Several people of one sequence, tracked together frame by frame: the pictures are read once, and what shows one of them counts
//! neither for nor against another (METHOD A8).

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};

use super::begin::{Begun, Planned};
use super::crowd::{Crowd, Owners};
use super::driver::plated;
use super::feed::{Feed, Frames, Keeps, Prepared};
use super::journal::FrameResult;
use super::progress::{FrameDone, Progress};
use super::run::Run;
use super::run_record::RunRecord;
use super::summary::{TrackSummary, mean};
use super::timings::Span;
use super::{Backend, Drawing, FeaturesOn, TrackSettings};
use crate::body::Body;
use crate::features::SeenView;
use crate::files::OutputFolder;
use crate::sequence::Sequence;

/// What a run yielded for one of several people.
#[derive(Clone, Debug)]
pub struct PersonSummary {
    /// Her name, and that of her folder.
    pub name: String,
    /// What [`super::track`] yields for one person.
    pub summary: TrackSummary,
}

/// Tracks whom a sequence names: the person ([`super::track`]), or the people together. Each one's folder with what was tracked there; one, that
/// of the results, where the manifest names no people.
///
/// # Errors
/// As [`super::track`] and [`track_people`].
pub fn track_all(
    sequence: &Sequence,
    settings: &TrackSettings,
    output: &OutputFolder,
    progress: &mut dyn Progress,
) -> Result<Vec<(PathBuf, TrackSummary)>> {
    let folder = output.path();
    if sequence.people.is_empty() {
        return Ok(vec![(folder.to_path_buf(), super::track(sequence, settings, output, progress)?)]);
    }
    let people = track_people(sequence, settings, output, progress)?;
    Ok(people.into_iter().map(|PersonSummary { name, summary }| (folder.join(name), summary)).collect())
}

/// Tracks the people of a sequence together and fills a folder of `output` for each, of her name, with what FORMATS calls a track's
/// folder. In every frame a person's search is shown the pixels that nobody else explains, by where the others are expected.
///
/// With [`TrackSettings::resume`] it goes on from the last frame that all have.
///
/// # Errors
/// As [`super::track`]; when the sequence has no [[person]], in real time, or when the settings name a start pose.
pub fn track_people(
    sequence: &Sequence,
    settings: &TrackSettings,
    output: &OutputFolder,
    progress: &mut dyn Progress,
) -> Result<Vec<PersonSummary>> {
    let name = sequence.path.display();
    ensure!(!sequence.people.is_empty(), "{name} has no [[person]], expected one or more to track together");
    ensure!(
        settings.realtime.is_none(),
        "{name} has [[person]], and several people are not tracked in real time: leave out --realtime"
    );
    ensure!(settings.start.is_none(), "{name} has [[person]], each with a start of her own: leave out --start");
    ensure!(
        settings.features_on != FeaturesOn::Device,
        "{name} has [[person]], and what each is compared with is made of all features: expected --features auto or cpu"
    );
    let settings = &TrackSettings { features_on: FeaturesOn::Cpu, ..settings.clone() };
    let plated = plated(sequence, settings, progress)?;
    let sequence = plated.sequence.as_ref();
    let alone: Vec<Sequence> = sequence.people.iter().map(|person| sequence.of_person(person)).collect();
    let folders = sequence.people.iter().map(|person| OutputFolder::open(&output.path().join(&person.name)));
    let folders = folders.collect::<Result<Vec<_>>>()?;
    let warnings = sequence.remarks().into_iter().chain(plated.remarks()).chain(plated.doubt()).collect();
    let [first_alone, other_alone @ ..] = alone.as_slice() else { bail!("{name} has no [[person]]") };
    let first = Planned::new(first_alone, settings, &folders[0], warnings)?;
    // What suits one suits all; it is not timed again.
    let chosen = Backend::from_name(first.plan.backend.evaluator.name())?;
    let drawing = Drawing { backend: chosen, ..settings.drawing };
    let others = TrackSettings { drawing, ..settings.clone() };
    let mut planned = vec![first];
    for (alone, folder) in other_alone.iter().zip(&folders[1..]) {
        let of_person = || format!("person {:?}", folder.path().file_name().unwrap_or_default());
        planned.push(Planned::new(alone, &others, folder, Vec::new()).with_context(of_person)?);
    }
    let bodies: Vec<&Body> = planned.iter().map(|person| &person.plan.body).collect();
    let crowd = Crowd::new(&bodies, &sequence.cameras, &planned[0].plan.features)?;
    let begun = planned.into_iter().map(Planned::begin).collect::<Result<Vec<_>>>()?;
    let done = begun.iter().map(|person| person.done.len()).min().unwrap_or(0);
    let mut people = Vec::new();
    for Begun { mut run, record, done: mut own, warnings } in begun {
        run.go_back_to(&mut own, done)?;
        if people.is_empty() {
            progress.start(&run.start(done, &warnings));
        }
        run.take_over(own)?;
        people.push(Tracked { run, record, warnings });
    }
    search_all(sequence, settings, &crowd, &mut people, progress)?;
    if people.iter().all(|person| person.run.looks_back()) {
        see_again(sequence, settings, &crowd, &mut people, &mut |run, again| {
            run.find_dissent_in(|run, from| Ok(Box::new(again.shares(run, from)?)), progress)
        })?;
        measure_again(&crowd, &mut people, progress)?;
        let bodies: Vec<&Body> = people.iter().map(|person| &person.run.plan.body).collect();
        let crowd = Crowd::new(&bodies, &sequence.cameras, &people[0].run.plan.features)?;
        // A person after the other, now that what comes after each frame is known.
        see_again(sequence, settings, &crowd, &mut people, &mut |run, again| {
            run.look_back_over(&mut again.shares(run, run.plan.range.start)?, progress)
        })?;
    }
    let named = people.into_iter().zip(&sequence.people);
    let finish = |(Tracked { run, record, warnings }, person): (Tracked<'_>, &crate::sequence::Person)| {
        let summary = run.finish(&record, warnings, progress).with_context(|| format!("person {:?}", person.name))?;
        Ok(PersonSummary { name: person.name.clone(), summary })
    };
    named.map(finish).collect()
}

/// One of the people, at work.
struct Tracked<'a> {
    run: Run<'a>,
    record: RunRecord,
    warnings: Vec<String>,
}

/// Searches the frames that are left, until the last or until asked to stop.
fn search_all(
    sequence: &Sequence,
    settings: &TrackSettings,
    crowd: &Crowd,
    people: &mut [Tracked<'_>],
    progress: &mut dyn Progress,
) -> Result<()> {
    let (range, features) = (people[0].run.plan.range.clone(), people[0].run.plan.features.clone());
    let next = people[0].run.next_frame();
    if next >= range.end {
        return Ok(());
    }
    // Their colours are learnt again from the frames that an earlier run did.
    let from = if features.likelihoods { range.start } else { next };
    let mut feed = Feed::start(sequence, features, range.clone(), from, settings.stall_timeout, &Keeps::Features)?;
    loop {
        let start = Instant::now();
        let Some(mut prepared) = feed.next()? else { return Ok(()) };
        let waited = Span::since(start);
        if prepared.index < next {
            let at = prepared.index - range.start;
            let done = people.iter().filter_map(|person| person.run.frames.get(at).cloned()).collect();
            settle(crowd, people, &mut prepared, done, |run, prepared, result| run.learn(prepared, result))?;
            continue;
        }
        let results = search(crowd, people, &mut prepared, waited)?;
        let mut done = Vec::new();
        settle(crowd, people, &mut prepared, results, |run, prepared, result| {
            done.push(run.finish_frame(prepared, result.clone())?);
            Ok(())
        })?;
        progress.frame(&all_of(&done));
        if progress.should_stop() {
            return Ok(());
        }
    }
}

/// Measures everybody again who is to be, each beside where the first pass found the others.
fn measure_again(crowd: &Crowd, people: &mut [Tracked<'_>], progress: &mut dyn Progress) -> Result<()> {
    let found = found(people);
    for (at, person) in people.iter_mut().enumerate() {
        let mut others = |frame: usize, _: &[SeenView<'_>]| Ok(crowd.others(&found.owners(crowd, frame), at));
        person.warnings.extend(person.run.measure_again(Some(&mut others), progress)?);
    }
    Ok(())
}

/// What each person is shown again, by where the first pass found the others.
struct Again<'a> {
    sequence: &'a Sequence,
    settings: &'a TrackSettings,
    crowd: &'a Crowd,
    found: Found,
    person: usize,
}

impl Again<'_> {
    /// The frames that are left to the person whose run this is, from the one of number `from` on.
    fn shares(&self, run: &Run<'_>, from: usize) -> Result<Shares<'_>> {
        let (range, features) = (run.plan.range.clone(), run.plan.features.clone());
        let first = range.start;
        let feed = Feed::start(self.sequence, features, range, from, self.settings.stall_timeout, &Keeps::Features)?;
        Ok(Shares { feed, crowd: self.crowd, found: &self.found, first, person: self.person })
    }
}

/// Has one run after the other see its person's frames again.
fn see_again(
    sequence: &Sequence,
    settings: &TrackSettings,
    crowd: &Crowd,
    people: &mut [Tracked<'_>],
    see: &mut dyn FnMut(&mut Run<'_>, &Again<'_>) -> Result<()>,
) -> Result<()> {
    let mut again = Again { sequence, settings, crowd, found: found(people), person: 0 };
    for (at, person) in people.iter_mut().enumerate() {
        again.person = at;
        see(&mut person.run, &again)?;
    }
    Ok(())
}

/// Where each person shows, `[person][frame]`.
struct Found(Vec<Vec<Option<Vec<f32>>>>);

/// Where the first pass found everybody.
fn found(people: &[Tracked<'_>]) -> Found {
    let shown = |person: &Tracked<'_>| person.run.frames.iter().map(|result| person.run.shown(result)).collect();
    Found(people.iter().map(shown).collect())
}

impl Found {
    /// Who shows where in a frame of the run.
    fn owners(&self, crowd: &Crowd, frame: usize) -> Owners {
        let poses: Vec<_> = self.0.iter().map(|poses| poses.get(frame).cloned().flatten()).collect();
        crowd.owners(&poses)
    }
}

/// The frames as they are left to one of the people by where all were found.
struct Shares<'a> {
    feed: Feed,
    crowd: &'a Crowd,
    found: &'a Found,
    first: usize,
    person: usize,
}

impl Frames for Shares<'_> {
    fn next(&mut self) -> Result<Option<Prepared>> {
        let Some(mut prepared) = self.feed.next()? else { return Ok(None) };
        let owners = self.found.owners(self.crowd, prepared.index - self.first);
        self.crowd.share(&mut prepared, &owners, self.person)?;
        Ok(Some(prepared))
    }
}

/// Searches one frame for everybody, each by where the others are expected.
fn search(
    crowd: &Crowd,
    people: &mut [Tracked<'_>],
    prepared: &mut Prepared,
    waited: Span,
) -> Result<Vec<FrameResult>> {
    let poses: Vec<Option<Vec<f32>>> = people.iter().map(|person| person.run.expected(prepared)).collect();
    let owners = crowd.owners(&poses);
    let mut results = Vec::new();
    for (at, person) in people.iter_mut().enumerate() {
        person.run.note_features(prepared, waited)?;
        crowd.share(prepared, &owners, at)?;
        person.run.observe(prepared)?;
        results.push(person.run.search(prepared)?);
    }
    Ok(results)
}

/// Hands every person's result on with the frame as the results leave it to her.
fn settle(
    crowd: &Crowd,
    people: &mut [Tracked<'_>],
    prepared: &mut Prepared,
    results: Vec<FrameResult>,
    mut take: impl FnMut(&mut Run<'_>, &Prepared, &FrameResult) -> Result<()>,
) -> Result<()> {
    let poses: Vec<Option<Vec<f32>>> =
        people.iter().zip(&results).map(|(person, result)| person.run.shown(result)).collect();
    let owners = crowd.owners(&poses);
    for (at, (person, result)) in people.iter_mut().zip(&results).enumerate() {
        crowd.share(prepared, &owners, at)?;
        take(&mut person.run, prepared, result)?;
    }
    Ok(())
}

/// How a frame went on average.
fn all_of(people: &[FrameDone]) -> FrameDone {
    let [frame, done] = people.first().map_or([0, 0], |first| [first.frame, first.done]);
    let errors: Option<Vec<f64>> = people.iter().map(|person| person.mean_error).collect();
    FrameDone {
        frame,
        done,
        fitness: mean(people.iter().map(|person| f64::from(person.fitness))) as f32,
        confidence: mean(people.iter().map(|person| person.confidence)),
        mean_error: errors.map(|errors| mean(errors.into_iter())),
    }
}
