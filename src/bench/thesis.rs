//! The figures of METHOD A10 that a row may stand beside: four cameras, GTX 780 Ti, Xeon X5690.

/// Names of the columns of [`times`].
pub(super) const COLUMNS: [&str; 6] = ["CPU", "CUDA", "GL+CPU", "GL+SSE", "GL+CUDA", "GL+OpenCL"];

/// Milliseconds an iteration on pictures of 640x480, flat model.
const ITERATION: [(usize, [f64; 6]); 3] = [
    (96, [26.3, 14.7, 80.2, 71.5, 4.40, 5.11]),
    (304, [92.6, 23.4, 255.0, 235.0, 6.30, 7.38]),
    (512, [177.0, 37.9, 394.0, 354.0, 8.23, 10.0]),
];

/// Particles that the ladder of models was measured with.
const LADDER_PARTICLES: [usize; 2] = [96, 304];

/// Milliseconds a frame of 10 iterations by model, all else of a frame included.
const LADDER: [(&str, [f64; 2]); 8] = [
    ("flat", [75.7, 90.9]),
    ("square", [82.5, 97.8]),
    ("elliptic-18", [79.1, 103.5]),
    ("elliptic-34", [86.7, 111.4]),
    ("elliptic-66", [90.7, 128.8]),
    ("elliptic-130", [104.2, 158.3]),
    ("elliptic-258", [131.6, 237.4]),
    ("elliptic-514", [170.5, 389.6]),
];

/// The thesis's times for a row; none where it has none.
pub(super) fn times(model: &str, particles: usize, size: [u32; 2]) -> Option<[f64; 6]> {
    let row = ITERATION.iter().find(|row| row.0 == particles)?;
    (model == "flat" && size == [640, 480]).then_some(row.1)
}

/// The thesis's time for a rung of the model ladder, ms a frame of 10 iterations.
pub(super) fn ladder(model: &str, particles: usize) -> Option<f64> {
    let times = LADDER.iter().find(|rung| rung.0 == model)?.1;
    LADDER_PARTICLES.iter().zip(times).find(|(of, _)| **of == particles).map(|(_, ms)| ms)
}

/// Sentences below the table.
pub(super) const NOTES: [&str; 3] = [
    "The thesis (GTX 780 Ti, Xeon X5690), ms an iteration at 640x480, stands in the last columns; of its ladder at 96 \
     and 304 particles ms a frame of 10 iterations, all else of a frame included, and a tenth of that.",
    "Of its 8.23 ms at 512 (GL+CUDA): matrices 0.82, transfer 0.30 + 0.38, drawing 3.81, comparison 2.39, overhead 0.53.",
    "At 480x270 it took 27.9 to 37.6 ms a frame of 10 iterations for 100 to 400 particles: 2.8 to 3.8 ms an iteration.",
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_stand_beside_their_own_rows_alone() {
        assert_eq!(times("flat", 512, [640, 480]).unwrap()[4], 8.23);
        assert!(times("flat", 512, [480, 270]).is_none() && times("square", 512, [640, 480]).is_none());
        assert!(times("flat", 100, [640, 480]).is_none());
        assert_eq!((ladder("elliptic-514", 304), ladder("elliptic-34", 96)), (Some(389.6), Some(86.7)));
        assert_eq!((ladder("elliptic-34", 512), ladder("elliptic-20", 96)), (None, None));
    }
}
