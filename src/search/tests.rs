use proptest::prelude::*;
use rayon::prelude::*;

use super::*;
use crate::body::Body;

fn adult_space() -> SearchSpace {
    SearchSpace::of(&Body::adult(1750.0).unwrap()).unwrap()
}

fn standing() -> Vec<f32> {
    Body::adult(1750.0).unwrap().standing_pose().into_iter().map(|value| value as f32).collect()
}

fn box_space(dofs: usize, half: f32, step: f32) -> SearchSpace {
    SearchSpace::new(vec![-half; dofs], vec![half; dofs], vec![step; dofs]).unwrap()
}

fn settings(kind: SearchKind, particles: usize, iterations: usize, seed: u64) -> SearchSettings {
    SearchSettings { kind, particles, iterations, seed, ..SearchSettings::default() }
}

/// Fitness 1 at a target, falling with the distance in units of `scale`.
fn towards<'a>(target: &'a [f32], scale: &'a [f32]) -> impl FnMut(&[f32], &mut [f32]) -> Result<()> + 'a {
    move |poses, fitness| {
        for (row, fitness) in poses.chunks_exact(target.len()).zip(fitness) {
            let squares = row.iter().zip(target).zip(scale).map(|((x, t), s)| ((x - t) / s).powi(2));
            *fitness = (-squares.sum::<f32>() / (2.0 * target.len() as f32)).exp();
        }
        Ok(())
    }
}

fn distance(a: &[f32], b: &[f32], scale: &[f32]) -> f32 {
    let squares = a.iter().zip(b).zip(scale).map(|((a, b), s)| ((a - b) / s).powi(2));
    (squares.sum::<f32>() / a.len() as f32).sqrt()
}

#[test]
fn the_swarm_converges_in_31_dimensions() {
    let (space, centre) = (adult_space(), standing());
    let spread = space.spread(0.04).unwrap();
    let offset: Vec<f32> = (0..31).map(|d| if d % 3 == 0 { 1.2 } else { -0.7 }).collect();
    let mut target: Vec<f32> = centre.iter().zip(&spread).zip(&offset).map(|((c, s), o)| c + s * o).collect();
    space.clamp(&mut target);
    let before = distance(&centre, &target, &spread);
    // The bounds are some three times what three seeds gave; a frame's budget first, then many iterations.
    for (iterations, factor) in [(15, 0.5), (100, 0.02)] {
        for seed in 0..3 {
            let mut search = settings(SearchKind::Pso, 300, iterations, seed).build(&space).unwrap();
            let found = search.search_frame(0, &centre, &spread, &mut towards(&target, &spread)).unwrap();
            let after = distance(&found.pose, &target, &spread);
            assert!(after < factor * before, "{iterations} iterations, seed {seed}: {after} of {before}");
            assert_eq!(found.evaluations, 300 * iterations);
            let mut again = [0.0];
            towards(&target, &spread)(&found.pose, &mut again).unwrap();
            assert_eq!(again[0], found.fitness, "the fitness is that of the pose");
            assert!(found.spread.iter().all(|spread| spread.is_finite() && *spread >= 0.0));
        }
    }
}

#[test]
fn every_search_scores_its_budget_and_comes_nearer() {
    let (space, centre) = (adult_space(), standing());
    let spread = space.spread(0.04).unwrap();
    let offset: Vec<f32> = (0..31).map(|d| if d % 3 == 0 { 1.2 } else { -0.7 }).collect();
    let mut target: Vec<f32> = centre.iter().zip(&spread).zip(&offset).map(|((c, s), o)| c + s * o).collect();
    space.clamp(&mut target);
    let before = distance(&centre, &target, &spread);
    for kind in SearchKind::ALL {
        // A mean is scored as one pose more; a bootstrap filter only weighs what it scattered.
        let is_mean = !matches!(kind, SearchKind::Pso | SearchKind::Hierarchical);
        let nearer = if kind == SearchKind::ParticleFilter { 1.0 } else { 0.8 };
        for (particles, iterations, refine) in [(300, 15, 0), (200, 1, 0), (37, 2, 11), (60, 3, 0), (7, 9, 300)] {
            let settings = SearchSettings { refine, ..settings(kind, particles, iterations, 4) };
            let mut search = settings.build(&space).unwrap();
            let mut scored = 0;
            let mut score = towards(&target, &spread);
            let found = search
                .search_frame(0, &centre, &spread, &mut |poses, fitness| {
                    scored += fitness.len();
                    assert_eq!(poses.len(), 31 * fitness.len());
                    score(poses, fitness)
                })
                .unwrap();
            let budget = particles * iterations + usize::from(is_mean) + refine;
            assert_eq!(
                (scored, found.evaluations),
                (budget, budget),
                "{kind:?}, {particles} x {iterations} + {refine}"
            );
            assert!(found.spread.iter().all(|spread| spread.is_finite() && *spread >= 0.0));
            if particles == 300 {
                let after = distance(&found.pose, &target, &spread);
                println!("{kind:?}: {after} of {before}");
                assert!(after < nearer * before, "{kind:?}: {after} of {before}");
            }
        }
    }
}

#[test]
fn a_valley_and_many_hills() {
    // Rosenbrock's valley in 2 dimensions and Rastrigin's hills in 4, as fitness 1 / (1 + f), optimum 1. Hills are a unit
    // apart and each step away from the top one costs 1, so 0.5 is a hill next to it: a swarm that settles may stop there.
    let rosenbrock = |x: &[f32]| (1.0 - x[0]).powi(2) + 100.0 * (x[1] - x[0] * x[0]).powi(2);
    let rastrigin = |x: &[f32]| x.iter().map(|x| x * x - 10.0 * (std::f32::consts::TAU * x).cos() + 10.0).sum::<f32>();
    type Function<'a> = (&'a str, usize, &'a dyn Fn(&[f32]) -> f32, f32);
    let functions: [Function; 2] = [("rosenbrock", 2, &rosenbrock, 0.99), ("rastrigin", 4, &rastrigin, 0.3)];
    for (name, dofs, function, bound) in functions {
        let space = box_space(dofs, 5.12, 1.0);
        let (centre, spread) = (vec![-3.0; dofs], vec![2.0; dofs]);
        let found: Vec<f32> = (0..5)
            .map(|seed| {
                let mut search = settings(SearchKind::Pso, 100, 200, seed).build(&space).unwrap();
                let mut fitness = |poses: &[f32], fitness: &mut [f32]| {
                    for (row, fitness) in poses.chunks_exact(dofs).zip(fitness) {
                        *fitness = 1.0 / (1.0 + function(row));
                    }
                    Ok(())
                };
                search.search_frame(0, &centre, &spread, &mut fitness).unwrap().fitness
            })
            .collect();
        assert!(found.iter().all(|fitness| *fitness > bound), "{name}: {found:?}");
        assert!(found.iter().any(|fitness| *fitness > 0.99), "{name}: {found:?}");
    }
}

#[test]
fn a_move_is_the_documented_formula_bit_for_bit() {
    let (particles, dofs) = (7, 45);
    let space = box_space(dofs, 3.0, 1.0);
    let target = vec![0.5; dofs];
    let mut seen: Vec<Vec<f32>> = Vec::new();
    let mut scores: Vec<Vec<f32>> = Vec::new();
    let mut search = settings(SearchKind::Pso, particles, 5, 99).build(&space).unwrap();
    let scale = vec![1.0; dofs];
    let mut score = towards(&target, &scale);
    search
        .search_frame(12, &vec![0.1; dofs], &vec![2.0; dofs], &mut |poses, fitness| {
            score(poses, fitness)?;
            seen.push(poses.to_vec());
            scores.push(fitness.to_vec());
            Ok(())
        })
        .unwrap();

    let random = Random::new(99);
    let stream = |iteration, particle, draw| Stream { frame: 12, iteration, particle, draw };
    let mut x = vec![0.1_f32; particles * dofs];
    for particle in 1..particles {
        let mut normals = vec![0.0; dofs];
        random.normals(stream(0, particle as u32, Draw::Scatter), &mut normals);
        for d in 0..dofs {
            x[particle * dofs + d] = (0.1 + normals[d] * 2.0).clamp(-3.0, 3.0);
        }
    }
    let (mut v, mut p, mut p_score) = (vec![0.0; x.len()], x.clone(), vec![-1.0_f32; particles]);
    let mut held = 0;
    for iteration in 0..5_usize {
        if iteration > 0 {
            let omega = 0.8 + (0.2 - 0.8) * ((iteration - 1) as f32 / 3.0);
            let leader = (0..particles).rev().max_by(|a, b| p_score[*a].total_cmp(&p_score[*b])).unwrap();
            let g = p[leader * dofs..(leader + 1) * dofs].to_vec();
            for particle in 0..particles {
                let (mut r1, mut r2) = (vec![0.0; dofs], vec![0.0; dofs]);
                random.uniforms(stream(iteration as u32, particle as u32, Draw::Cognitive), &mut r1);
                random.uniforms(stream(iteration as u32, particle as u32, Draw::Social), &mut r2);
                for d in 0..dofs {
                    let i = particle * dofs + d;
                    v[i] = omega * v[i] + 1.496_18 * r1[d] * (p[i] - x[i]) + 1.496_18 * r2[d] * (g[d] - x[i]);
                    let free = x[i] + v[i];
                    x[i] = free.clamp(-3.0, 3.0);
                    if x[i] != free {
                        v[i] = 0.0;
                        held += 1;
                    }
                }
            }
        }
        assert_eq!(x, seen[iteration], "iteration {iteration}");
        for particle in 0..particles {
            if scores[iteration][particle] > p_score[particle] {
                p_score[particle] = scores[iteration][particle];
                let row = particle * dofs..(particle + 1) * dofs;
                p[row.clone()].copy_from_slice(&x[row]);
            }
        }
    }
    assert!(held > 0, "the limits took part");
}

#[test]
fn the_result_does_not_depend_on_threads_and_does_on_the_seed() {
    let (space, centre) = (adult_space(), standing());
    let spread = space.spread(1.0 / 60.0).unwrap();
    let run = |kind, seed, threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut search = settings(kind, 64, 6, seed).build(&space).unwrap();
        let mut centre = centre.clone();
        let mut result = Vec::new();
        for frame in 0..4 {
            let target: Vec<f32> = centre.iter().zip(&spread).map(|(c, s)| c + s).collect();
            let mut fitness = |poses: &[f32], fitness: &mut [f32]| {
                pool.install(|| {
                    poses.par_chunks_exact(31).zip(fitness.par_iter_mut()).for_each(|(row, fitness)| {
                        let mut one = [0.0];
                        // This closure's fitness cannot fail.
                        let _ = towards(&target, &spread)(row, &mut one);
                        *fitness = one[0];
                    });
                });
                Ok(())
            };
            let found = search.search_frame(frame, &centre, &spread, &mut fitness).unwrap();
            centre.clone_from(&found.pose);
            result.push(found);
        }
        result
    };
    for kind in SearchKind::ALL {
        let first = run(kind, 7, 1);
        for threads in [2, 3, 8] {
            assert_eq!(run(kind, 7, threads), first, "{kind:?} with {threads} threads");
        }
        assert_eq!(run(kind, 7, 1), first, "{kind:?} repeated");
        assert_ne!(run(kind, 8, 1), first, "{kind:?} with another seed");
    }
}

#[test]
fn standing_still_is_always_a_candidate() {
    let (space, centre) = (adult_space(), standing());
    let spread = space.spread(0.04).unwrap();
    let mut search = settings(SearchKind::Pso, 20, 3, 1).build(&space).unwrap();
    // Only the exact centre scores.
    let mut fitness = |poses: &[f32], fitness: &mut [f32]| {
        for (row, fitness) in poses.chunks_exact(31).zip(fitness) {
            *fitness = if row == centre { 0.9 } else { 0.1 };
        }
        Ok(())
    };
    for frame in 0..3 {
        let found = search.search_frame(frame, &centre, &spread, &mut fitness).unwrap();
        assert_eq!((found.pose, found.fitness), (centre.clone(), 0.9));
    }
    // Of equals the lowest index leads.
    let mut equal = |_: &[f32], fitness: &mut [f32]| {
        fitness.fill(0.5);
        Ok(())
    };
    assert_eq!(search.search_frame(3, &centre, &spread, &mut equal).unwrap().pose, centre);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn limits_always_hold(
        seed in any::<u64>(), frame in any::<u32>(), size in 0.01_f32..1e6, kind in 0..SearchKind::ALL.len(), far in -1e6_f32..1e6,
        refine in 0..50_usize
    ) {
        let space = adult_space();
        let settings = SearchSettings { refine, ..settings(SearchKind::ALL[kind], 16, 6, seed) };
        let mut search = settings.build(&space).unwrap();
        let target = vec![far; 31];
        let scale = vec![1e5; 31];
        let mut score = towards(&target, &scale);
        let mut outside = 0;
        let mut fitness = |poses: &[f32], fitness: &mut [f32]| {
            outside += poses.chunks_exact(31).filter(|row| !space.contains(row)).count();
            score(poses, fitness)
        };
        let found = search.search_frame(frame, &[far; 31], &[size; 31], &mut fitness).unwrap();
        prop_assert!(space.contains(&found.pose));
        prop_assert_eq!(outside, 0);
    }
}

#[test]
fn what_is_not_a_number_never_wins() {
    let space = box_space(3, 10.0, 1.0);
    for kind in SearchKind::ALL {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut search = settings(kind, 40, 5, 2).build(&space).unwrap();
            let mut partly = |poses: &[f32], fitness: &mut [f32]| {
                for (row, fitness) in poses.chunks_exact(3).zip(fitness) {
                    *fitness = if row[0] > 0.0 { bad } else { 1.0 / (1.0 + row[0] * row[0]) };
                }
                Ok(())
            };
            let found = search.search_frame(0, &[-1.0; 3], &[1.0; 3], &mut partly).unwrap();
            assert!(found.pose[0] <= 0.0 && found.fitness.is_finite(), "{kind:?}: {found:?}");
            let mut all = |_: &[f32], fitness: &mut [f32]| {
                fitness.fill(bad);
                Ok(())
            };
            let error = search.search_frame(1, &[0.0; 3], &[1.0; 3], &mut all).unwrap_err().to_string();
            assert!(error.contains("none of the 200 poses of frame 1 has a finite fitness"), "{error}");
        }
    }
}

#[test]
fn the_filter_is_the_exact_filter_where_there_is_one() {
    // With f = 1 - |x - z| the weights are a Gaussian likelihood, and with steps far from the limits the motion is a
    // Gaussian walk: in one dimension Kalman's filter is exact.
    let space = box_space(1, 1e4, 1.0);
    let (sigma, step) = (2.0_f64, 1.5_f64);
    let mut settings = settings(SearchKind::ParticleFilter, 2000, 10, 3);
    settings.filter.sigma = sigma as f32;
    let mut search = settings.build(&space).unwrap();
    let (mut mean, mut variance) = (0.0_f64, 0.0_f64);
    let mut centre = vec![0.0_f32];
    for frame in 0..30 {
        let seen = 0.8 * f64::from(frame) + 3.0 * f64::from(frame).sin();
        let predicted = variance + step * step;
        let gain = predicted / (predicted + sigma * sigma);
        mean += gain * (seen - mean);
        variance = (1.0 - gain) * predicted;
        let mut fitness = |poses: &[f32], fitness: &mut [f32]| {
            for (x, fitness) in poses.iter().zip(fitness) {
                *fitness = (1.0 - (f64::from(*x) - seen).abs()) as f32;
            }
            Ok(())
        };
        let found = search.search_frame(frame, &centre, &[step as f32], &mut fitness).unwrap();
        assert!((f64::from(found.pose[0]) - mean).abs() < 0.1, "frame {frame}: {} for {mean}", found.pose[0]);
        let deviation = variance.sqrt();
        assert!((f64::from(found.spread[0]) / deviation - 1.0).abs() < 0.1, "{} for {deviation}", found.spread[0]);
        assert_eq!(found.evaluations, 20_001);
        centre = found.pose;
    }
    // A centre that is not its own estimate is a fresh start there.
    let mut flat = |_: &[f32], fitness: &mut [f32]| {
        fitness.fill(0.5);
        Ok(())
    };
    let found = search.search_frame(30, &[500.0], &[0.5], &mut flat).unwrap();
    assert!((found.pose[0] - 500.0).abs() < 0.05 && (found.spread[0] - 0.5).abs() < 0.05, "{found:?}");
}

#[test]
fn fewer_iterations_give_an_estimate_too() {
    let space = box_space(2, 10.0, 1.0);
    let (target, scale) = ([1.0, -1.0], [1.0, 1.0]);
    for kind in SearchKind::ALL {
        let mut search = settings(kind, 50, 10, 2).build(&space).unwrap();
        let mut fitness = towards(&target, &scale);
        search.start_frame(0, &[0.0; 2], &[1.0; 2]).unwrap();
        search.iterate(&mut fitness).unwrap();
        search.iterate(&mut fitness).unwrap();
        let found = search.estimate(&mut fitness).unwrap();
        assert_eq!(found.evaluations / 50, 2);
        search.search_frame(1, &found.pose, &[1.0; 2], &mut fitness).unwrap();
    }
}

#[test]
fn misuse_and_bad_settings_have_their_sentences() {
    let space = box_space(2, 10.0, 1.0);
    let mut flat = |_: &[f32], fitness: &mut [f32]| {
        fitness.fill(0.5);
        Ok(())
    };
    for kind in SearchKind::ALL {
        let mut search = settings(kind, 4, 2, 2).build(&space).unwrap();
        assert_eq!((search.name(), search.iterations()), (kind.name(), 2));
        assert_eq!(SearchKind::from_name(search.name()).unwrap(), kind);
        assert!(search.iterate(&mut flat).unwrap_err().to_string().contains("no frame yet"));
        assert!(search.estimate(&mut flat).unwrap_err().to_string().contains("nothing to estimate"));
        for (centre, spread, sentence) in [
            (vec![0.0], vec![1.0; 2], "centre has 1 values, expected 2"),
            (vec![0.0; 2], vec![1.0; 3], "spread has 3 values, expected 2"),
            (vec![0.0, f32::NAN], vec![1.0; 2], "centre is NaN at index 1"),
            (vec![0.0; 2], vec![f32::INFINITY, 1.0], "spread is inf at index 0"),
            (vec![0.0; 2], vec![1.0, -1.0], "spread is -1 at index 1"),
        ] {
            let error = search.start_frame(0, &centre, &spread).unwrap_err().to_string();
            assert!(error.contains(sentence), "{error}");
        }
        search.search_frame(0, &[0.0; 2], &[1.0; 2], &mut flat).unwrap();
        assert!(search.iterate(&mut flat).unwrap_err().to_string().contains("all 2 iterations of frame 0 are done"));
        let mut broken = |_: &[f32], _: &mut [f32]| anyhow::bail!("the device is gone");
        let error = search.search_frame(1, &[0.0; 2], &[1.0; 2], &mut broken).unwrap_err().to_string();
        assert_eq!(error, "the device is gone");
    }
    let change = |change: &dyn Fn(&mut SearchSettings)| {
        let mut settings = SearchSettings::default();
        change(&mut settings);
        settings.build(&space).map(|_| ()).unwrap_err().to_string()
    };
    for (error, sentence) in [
        (change(&|s| s.particles = 0), "particles is 0, expected 1 to 1048576"),
        (change(&|s| s.particles = usize::MAX), "particles is 18446744073709551615"),
        (change(&|s| s.iterations = 0), "iterations is 0, expected 1 to 65536"),
        (change(&|s| s.pso.inertia[1] = f32::NAN), "inertia is NaN, expected 0 to 1"),
        (change(&|s| s.pso.cognitive = -1.0), "cognitive weight is -1, expected 0 to 4"),
        (change(&|s| s.pso.social = f32::INFINITY), "social weight is inf"),
        (change(&|s| s.filter.sigma = 0.0), "sigma is 0, expected"),
        (
            change(&|s| (s.kind, s.particles, s.iterations) = (SearchKind::ParticleFilter, 1 << 20, 1 << 16)),
            "do not fit, expected at most",
        ),
    ] {
        assert!(error.contains(sentence), "{error}");
    }
    let space = |lower: &[f32], upper: &[f32], step: &[f32]| {
        SearchSpace::new(lower.to_vec(), upper.to_vec(), step.to_vec()).unwrap_err().to_string()
    };
    for (error, sentence) in [
        (space(&[], &[], &[]), "no degree of freedom"),
        (space(&[0.0], &[], &[1.0]), "1 lower limits come with 0 upper ones"),
        (space(&[1.0], &[0.0], &[1.0]), "limits of dimension 0 are 1 and 0"),
        (space(&[f32::NAN], &[0.0], &[1.0]), "limits of dimension 0 are NaN"),
        (space(&[0.0], &[1.0], &[-1.0]), "step of dimension 0 is -1"),
    ] {
        assert!(error.contains(sentence), "{error}");
    }
}

#[test]
fn a_bodys_space_keeps_its_limits_in_double_precision() {
    let body = Body::adult(1750.0).unwrap();
    let space = SearchSpace::of(&body).unwrap();
    for ((_, dof), (low, high)) in body.dofs().zip(space.lower().iter().zip(space.upper())) {
        assert!(f64::from(*low) >= dof.limits[0] && f64::from(*high) <= dof.limits[1]);
        assert!((f64::from(*low) - dof.limits[0]).abs() <= 1e-6 * dof.limits[0].abs());
    }
    let (slow, fast) = (space.spread(0.04).unwrap(), space.spread(0.02).unwrap());
    for ((_, dof), (slow, fast)) in body.dofs().zip(slow.iter().zip(&fast)) {
        assert!((f64::from(*slow) / dof.step - 1.0).abs() < 1e-6 && (slow / fast - 2.0).abs() < 1e-6);
    }
    for interval in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(space.spread(interval).unwrap_err().to_string().contains("expected a positive number"));
    }
}
