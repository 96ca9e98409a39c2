//! Work on frames of a window side by side. A generation is too small to be shared by more than a few threads, so each piece of work has an
//! evaluator and threads of its own; what comes of it does not depend on how many there are.

use std::panic::resume_unwind;
use std::sync::{Mutex, PoisonError};
use std::thread::{Builder, scope};

use anyhow::{Context, Result};
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::scorer::Scorer;
use crate::body::{Body, Mesh};
use crate::evaluate::Evaluator;
use crate::evaluate::cpu::{Cpu, InstructionSet};
use crate::geometry::Camera;
use crate::track::passes::SecondPass;

/// Those who work side by side.
pub(super) struct Team<'a> {
    members: Vec<Member<'a>>,
}

struct Member<'a> {
    scorer: Scorer<'a>,
    /// Its threads; none where it has all there are.
    threads: Option<ThreadPool>,
}

impl<'a> Team<'a> {
    /// The scorers, with an even share of `all` threads each; one by itself has those of the pool it is called on.
    ///
    /// # Errors
    /// When a thread cannot be started.
    pub(super) fn of(scorers: impl ExactSizeIterator<Item = Scorer<'a>>, all: usize) -> Result<Self> {
        let count = scorers.len();
        let threads = |at: usize| {
            if count == 1 {
                return Ok(None);
            }
            let named = ThreadPoolBuilder::new().thread_name(move |nth| format!("second pass {at}.{nth}"));
            named.num_threads(all / count).build().map(Some).context("cannot start the threads of the second pass")
        };
        let member = |(at, scorer)| Ok(Member { scorer, threads: threads(at)? });
        Ok(Self { members: scorers.enumerate().map(member).collect::<Result<_>>()? })
    }

    /// Has every job done by one of them, and hands on what comes of each in the order of the jobs.
    ///
    /// # Errors
    /// When one fails: that of the first job that does.
    pub(super) fn share<J: Send, T: Send>(
        &mut self,
        jobs: impl Iterator<Item = J> + Send,
        work: impl Fn(&mut Scorer<'_>, J) -> Result<T> + Sync,
    ) -> Result<Vec<T>> {
        if let [Member { scorer, threads: None }] = &mut self.members[..] {
            return on_the_pool(|| jobs.map(|job| work(scorer, job)).collect());
        }
        let jobs = Mutex::new(jobs.enumerate());
        let next = || jobs.lock().unwrap_or_else(PoisonError::into_inner).next();
        let take_turns = |scorer: &mut Scorer<'_>| {
            let mut done = Vec::new();
            while let Some((at, job)) = next() {
                done.push((at, work(scorer, job)));
            }
            done
        };
        let take_turns = &take_turns;
        let mut done = scope(|scope| {
            let mut started = Vec::new();
            for Member { scorer, threads } in &mut self.members {
                let turns = move || match threads {
                    Some(threads) => threads.install(|| take_turns(scorer)),
                    None => take_turns(scorer),
                };
                started.push(
                    Builder::new().spawn_scoped(scope, turns).context("cannot start a thread of the second pass")?,
                );
            }
            let ended = started.into_iter().map(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)));
            anyhow::Ok(ended.flatten().collect::<Vec<_>>())
        })?;
        done.sort_unstable_by_key(|(at, _)| *at);
        done.into_iter().map(|(_, result)| result).collect()
    }
}

/// Does work that shares out small pieces, a generation's costs, on a thread of the pool: from any other each piece would wait for one to
/// wake up, or to be done with the features of a frame.
pub(super) fn on_the_pool<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    rayon::scope(|_| work())
}

/// Evaluators on the processor that work side by side on so many `pieces` of a run's second pass: as many as there is work for, with an even share
/// of `all` threads each. None where the `run`'s own works alone.
///
/// # Errors
/// When they cannot be made.
pub(super) fn side_by_side(
    run: &dyn Evaluator,
    body: &Body,
    mesh: Option<&Mesh>,
    cameras: &[Camera],
    [pieces, all]: [usize; 2],
) -> Result<Vec<Cpu>> {
    let count = all.min(pieces).max(1);
    let set = match SecondPass::of(run) {
        SecondPass::InPlace(set) => set,
        SecondPass::Alike if count > 1 => InstructionSet::best(),
        SecondPass::Alike | SecondPass::Run => return Ok(Vec::new()),
    };
    let one = |_| match mesh {
        None => Cpu::with(body, cameras, set, all / count),
        Some(mesh) => Cpu::of_mesh_with(body, mesh.clone(), cameras, set, all / count),
    };
    (0..count).map(one).collect()
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use anyhow::bail;

    use super::*;
    use crate::evaluate::{Objective, ObjectiveKind, Reference};
    use crate::search::{SearchSettings, SearchSpace};
    use crate::track::fit_tests::cameras_around;
    use crate::track::hindsight::shape::Shape;

    /// Those who come to the end first wait for nobody, and still what they did stands in the order of the jobs, as does what fails.
    #[test]
    fn what_is_shared_comes_back_in_order() {
        let body = Body::adult(1750.0).unwrap();
        let space = SearchSpace::of(&body).unwrap();
        let (objective, shape) = (Objective::of(ObjectiveKind::Ws), Shape::new(&body));
        let settings = SearchSettings::default();
        let mut cpus: Vec<Cpu> =
            (0..4).map(|_| Cpu::with(&body, &cameras_around(), InstructionSet::best(), 1).unwrap()).collect();
        let (alone, cpus) = cpus.split_at_mut(1);
        let scorer = |cpu| Scorer::new(cpu, &objective, &space, &shape, &settings);
        let threads = |team: &Team<'_>| -> Vec<Option<usize>> {
            team.members.iter().map(|member| member.threads.as_ref().map(ThreadPool::current_num_threads)).collect()
        };
        // One by itself has those there are.
        assert_eq!(threads(&Team::of(alone.iter_mut().map(|cpu| scorer(cpu)), 7).unwrap()), [None]);
        let mut team = Team::of(cpus.iter_mut().map(|cpu| scorer(cpu)), 7).unwrap();
        assert_eq!(threads(&team), [Some(2); 3]);
        let slow_first = |job: u64| std::thread::sleep(Duration::from_millis(20 - job));
        let doubled = team.share(0..20, |_, job| {
            slow_first(job);
            Ok(2 * job)
        });
        assert_eq!(doubled.unwrap(), (0..20).map(|job| 2 * job).collect::<Vec<_>>());
        assert!(team.share(0..0, |_, job: u64| Ok(job)).unwrap().is_empty());
        let failed = team.share(0..20, |_, job| {
            slow_first(job);
            if job % 5 == 3 { bail!("job {job}") } else { Ok(()) }
        });
        assert_eq!(failed.unwrap_err().to_string(), "job 3");
    }

    #[test]
    fn a_run_on_the_processor_is_shared_and_a_slow_one_is_not() {
        let body = Body::adult(1750.0).unwrap();
        let cameras = cameras_around();
        let reference = Reference::new(&body, &cameras);
        let cpu = Cpu::new(&body, &cameras).unwrap();
        let shared =
            |run: &dyn Evaluator, pieces: usize| side_by_side(run, &body, None, &cameras, [pieces, 6]).unwrap().len();
        assert_eq!(shared(&reference, 10), 0);
        assert_eq!([1, 2, 5, 10].map(|pieces| shared(&cpu, pieces)), [0, 2, 5, 6]);
        assert_eq!([&reference as &dyn Evaluator, &cpu].map(SecondPass::of), [SecondPass::Run, SecondPass::Alike]);
    }
}
