//! The path through the candidates of frames that is worth most together (Viterbi 1967), over pairs of frames, so that a joint may move
//! as fast as it likes but not jerk (METHOD A14).

/// What it costs to go from a candidate to the next.
#[derive(Clone, Copy)]
pub(super) struct Costs<'a> {
    /// `first(j, k)`: from candidate j of frame 0 to k of frame 1.
    pub(super) first: &'a dyn Fn(usize, usize) -> f64,
    /// `then(t, i, j, k)`: from candidate i of frame t - 2 over j of frame t - 1 to k of frame t.
    pub(super) then: &'a dyn Fn(usize, usize, usize, usize) -> f64,
}

/// All paths through the candidates of frames.
pub(super) struct Ways<'a> {
    worth: Vec<Vec<f64>>,
    /// How many of the first frames are settled, and not asked about.
    settled: usize,
    costs: Costs<'a>,
    /// `[t - 1][j][k]`: the best worth of all paths that end with candidate j of frame t - 1 and k of frame t.
    up_to: Vec<Vec<Vec<f64>>>,
}

impl<'a> Ways<'a> {
    /// `worth[t][k]` is what candidate k of frame t is worth by itself. Every frame has at least one; of the first `settled` nothing is asked.
    pub(super) fn new(worth: Vec<Vec<f64>>, settled: usize, costs: Costs<'a>) -> Self {
        let up_to = worth_up_to(&worth, costs);
        Self { worth, settled, costs, up_to }
    }

    /// The path of greatest worth: the indices of the candidates, one a frame that is not settled; of equals the first.
    pub(super) fn best(&self) -> Vec<usize> {
        let Self { worth, settled, costs, up_to: sums } = self;
        let Some(last) = sums.last() else {
            return worth[*settled..].iter().map(|values| greatest(values.iter().copied())).collect();
        };
        let width = worth[worth.len() - 1].len();
        let end = greatest(last.iter().flatten().copied());
        let mut path = vec![end % width, end / width];
        for t in (2..worth.len()).rev() {
            let [.., k, j] = path[..] else { break };
            path.push(greatest(sums[t - 2].iter().enumerate().map(|(i, sums)| sums[j] - (costs.then)(t, i, j, k))));
        }
        path.reverse();
        path.split_off(*settled)
    }

    /// By how much the best path through each candidate is worth less than the best of all, frame by frame that is not settled.
    pub(super) fn losses(&self) -> Vec<Vec<f64>> {
        let Self { worth, settled, costs, up_to: before } = self;
        let after = worth_from(worth, *costs);
        let most = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::NEG_INFINITY, f64::max);
        if before.is_empty() {
            let alone = |values: &Vec<f64>| {
                let best = most(&mut values.iter().copied());
                values.iter().map(|value| best - value).collect()
            };
            return worth[*settled..].iter().map(alone).collect();
        }
        let both = |pair: usize, j: usize, k: usize| before[pair][j][k] + after[pair][j][k];
        let through = |t: usize, at: usize| match t.checked_sub(1) {
            Some(pair) => most(&mut (0..worth[t - 1].len()).map(|j| both(pair, j, at))),
            None => most(&mut (0..worth[1].len()).map(|k| both(0, at, k))),
        };
        let of_frame = |t: usize| {
            let through: Vec<f64> = (0..worth[t].len()).map(|at| through(t, at)).collect();
            let best = most(&mut through.iter().copied());
            through.iter().map(|worth| best - worth).collect()
        };
        (*settled..worth.len()).map(of_frame).collect()
    }
}

/// `[t - 1][j][k]`: the best worth of all paths that end with candidate j of frame t - 1 and k of frame t.
fn worth_up_to(worth: &[Vec<f64>], costs: Costs<'_>) -> Vec<Vec<Vec<f64>>> {
    let Costs { first, then } = costs;
    let mut sums: Vec<Vec<Vec<f64>>> = Vec::with_capacity(worth.len());
    for (t, pair) in worth.windows(2).enumerate().map(|(before, pair)| (before + 1, pair)) {
        let of_pair = |(j, own): (usize, &f64)| -> Vec<f64> {
            let all = |(k, next): (usize, &f64)| match sums.last() {
                None => own + next - first(j, k),
                Some(sums) => {
                    let ways = sums.iter().enumerate().map(|(i, sums)| sums[j] - then(t, i, j, k));
                    ways.fold(f64::NEG_INFINITY, f64::max) + next
                }
            };
            pair[1].iter().enumerate().map(all).collect()
        };
        let next = pair[0].iter().enumerate().map(of_pair).collect();
        sums.push(next);
    }
    sums
}

/// `[t - 1][j][k]`: the best worth of what comes after candidate j of frame t - 1 and k of frame t.
fn worth_from(worth: &[Vec<f64>], costs: Costs<'_>) -> Vec<Vec<Vec<f64>>> {
    let mut sums: Vec<Vec<Vec<f64>>> = Vec::with_capacity(worth.len());
    for (t, pair) in worth.windows(2).enumerate().map(|(before, pair)| (before + 1, pair)).rev() {
        let goes_on = |j: usize, k: usize| match sums.last() {
            None => 0.0,
            Some(sums) => {
                let ways = sums[k].iter().zip(&worth[t + 1]).enumerate();
                ways.map(|(l, (sum, own))| sum + own - (costs.then)(t + 1, j, k, l)).fold(f64::NEG_INFINITY, f64::max)
            }
        };
        let of_pair = |j: usize| (0..pair[1].len()).map(|k| goes_on(j, k)).collect();
        let next = (0..pair[0].len()).map(of_pair).collect();
        sums.push(next);
    }
    sums.reverse();
    sums
}

/// The index of the greatest value; of equals the first, and of none 0.
pub(super) fn greatest(values: impl Iterator<Item = f64>) -> usize {
    let none = (f64::NEG_INFINITY, 0);
    values.enumerate().fold(none, |best, (at, value)| if value > best.0 { (value, at) } else { best }).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::{Draw, Random, Stream};

    /// Uniform numbers of an address.
    fn numbers(count: usize, table: u32) -> Vec<f64> {
        let mut row = vec![0.0; count];
        Random::new(7).uniforms(Stream { frame: table, iteration: 0, particle: 0, draw: Draw::Scatter }, &mut row);
        row.into_iter().map(f64::from).collect()
    }

    /// The worth of every path there is, the last candidate changing least often.
    fn all_paths(worth: &[Vec<f64>], sum: &dyn Fn(&[usize]) -> f64) -> Vec<(f64, Vec<usize>)> {
        let mut path = vec![0; worth.len()];
        let mut all = Vec::new();
        loop {
            all.push((sum(&path), path.clone()));
            let Some(at) = (0..path.len()).rev().find(|&at| path[at] + 1 < worth[at].len()) else { return all };
            path[at] += 1;
            path[at + 1..].fill(0);
        }
    }

    #[test]
    fn the_best_of_all_paths_is_found_and_what_others_are_worth_less() {
        for table in 0..60 {
            let sizes: Vec<usize> = (0..1 + table as usize % 6).map(|t| 1 + (t * 7 + table as usize) % 4).collect();
            let worth: Vec<Vec<f64>> =
                sizes.iter().enumerate().map(|(t, &n)| numbers(n, 100 * table + t as u32)).collect();
            let costs = numbers(4 * 4 * 4 * 8, 99 + 1000 * table);
            let cost = |t: usize, i: usize, j: usize, k: usize| costs[((t * 4 + i) * 4 + j) * 4 + k];
            let first = |j: usize, k: usize| costs[j * 4 + k] * 0.5;
            let sum = |path: &[usize]| {
                let own: f64 = path.iter().enumerate().map(|(t, &k)| worth[t][k]).sum();
                let begin = if path.len() > 1 { first(path[0], path[1]) } else { 0.0 };
                own - begin - (2..path.len()).map(|t| cost(t, path[t - 2], path[t - 1], path[t])).sum::<f64>()
            };
            let all = all_paths(&worth, &sum);
            let best = &all[greatest(all.iter().map(|(sum, _)| *sum))];
            let settled = (table as usize / 6 % 3).min(sizes.len());
            let ways = Ways::new(worth.clone(), settled, Costs { first: &first, then: &cost });
            assert_eq!(ways.best(), best.1[settled..], "table {table} of {sizes:?}");
            let losses = ways.losses();
            assert_eq!(losses.len(), sizes.len() - settled);
            for (t, losses) in losses.iter().enumerate().map(|(at, losses)| (settled + at, losses)) {
                for (k, loss) in losses.iter().enumerate() {
                    let through = all.iter().filter(|(_, path)| path[t] == k).map(|(sum, _)| *sum);
                    let expected = best.0 - through.fold(f64::NEG_INFINITY, f64::max);
                    assert!(
                        (loss - expected).abs() < 1e-9,
                        "table {table}, candidate {k} of frame {t}: {loss}, {expected}"
                    );
                }
            }
        }
        let nothing = Ways::new(Vec::new(), 0, Costs { first: &|_, _| 0.0, then: &|_, _, _, _| 0.0 });
        assert!(nothing.best().is_empty() && nothing.losses().is_empty());
    }
}
