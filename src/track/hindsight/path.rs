//! The path through the candidates of frames that is worth most together (Viterbi 1967), over pairs of frames, so that a joint may move
//! as fast as it likes but not jerk (METHOD A14).

/// Finds the path of greatest worth. `worth[t][k]` is what candidate k of frame t is worth by itself; `cost(t, i, j, k)` what it costs to
/// go from candidate i of frame t - 2 over j of frame t - 1 to k of frame t, and `first(j, k)` from j of frame 0 to k of frame 1. The
/// indices of the candidates, one a frame; of equals the first. Every frame has at least one.
pub(super) fn best_path(
    worth: &[Vec<f64>],
    first: &dyn Fn(usize, usize) -> f64,
    cost: &dyn Fn(usize, usize, usize, usize) -> f64,
) -> Vec<usize> {
    let count = worth.len();
    if count < 2 {
        return worth.iter().map(|values| greatest(values.iter().copied())).collect();
    }
    // sums[j][k]: the best worth of all paths that end with j, k.
    let mut sums: Vec<Vec<f64>> = worth[0]
        .iter()
        .enumerate()
        .map(|(j, own)| worth[1].iter().enumerate().map(|(k, next)| own + next - first(j, k)).collect())
        .collect();
    let mut came: Vec<Vec<Vec<usize>>> = Vec::with_capacity(count);
    for t in 2..count {
        let mut next = vec![vec![f64::NEG_INFINITY; worth[t].len()]; worth[t - 1].len()];
        let mut from = vec![vec![0; worth[t].len()]; worth[t - 1].len()];
        for j in 0..worth[t - 1].len() {
            for k in 0..worth[t].len() {
                for (i, sums) in sums.iter().enumerate() {
                    let sum = sums[j] - cost(t, i, j, k);
                    if sum > next[j][k] || i == 0 {
                        (next[j][k], from[j][k]) = (sum, i);
                    }
                }
                next[j][k] += worth[t][k];
            }
        }
        sums = next;
        came.push(from);
    }
    let width = worth[count - 1].len();
    let end = greatest(sums.into_iter().flatten());
    let mut path = vec![end % width, end / width];
    for from in came.iter().rev() {
        let [.., k, j] = path[..] else { break };
        path.push(from[j][k]);
    }
    path.reverse();
    path
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

    /// Every path there is.
    fn brute_force(worth: &[Vec<f64>], sum: &dyn Fn(&[usize]) -> f64) -> Vec<usize> {
        let mut path = vec![0; worth.len()];
        let mut best = (f64::NEG_INFINITY, path.clone());
        loop {
            let sum = sum(&path);
            if sum > best.0 {
                best = (sum, path.clone());
            }
            let Some(at) = (0..path.len()).rev().find(|&at| path[at] + 1 < worth[at].len()) else { return best.1 };
            path[at] += 1;
            path[at + 1..].fill(0);
        }
    }

    #[test]
    fn the_best_of_all_paths_is_found() {
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
            let found = best_path(&worth, &first, &cost);
            assert_eq!(found, brute_force(&worth, &sum), "table {table} of {sizes:?}");
        }
    }
}
