//! The figures of METHOD A10 that a row may stand beside: four cameras, GTX 780 Ti, Xeon X5690.

/// Names of the columns of [`times`].
pub(super) const COLUMNS: [&str; 6] = ["CPU", "CUDA", "GL+CPU", "GL+SSE", "GL+CUDA", "GL+OpenCL"];

/// Milliseconds an iteration on pictures of 640x480, flat model.
const ITERATION: [(usize, [f64; 6]); 3] = [
    (96, [26.3, 14.7, 80.2, 71.5, 4.40, 5.11]),
    (304, [92.6, 23.4, 255.0, 235.0, 6.30, 7.38]),
    (512, [177.0, 37.9, 394.0, 354.0, 8.23, 10.0]),
];

/// Milliseconds a frame of 10 iterations of 304 particles by model, all else of a frame included; the thesis gives both ends of
/// the elliptic ladder.
const LADDER: [(&str, f64); 4] = [("flat", 90.9), ("square", 97.8), ("elliptic-18", 103.5), ("elliptic-514", 389.6)];

/// The thesis's times for a row; none where it has none.
pub(super) fn times(model: &str, particles: usize, size: [u32; 2]) -> Option<[f64; 6]> {
    let row = ITERATION.iter().find(|row| row.0 == particles)?;
    (model == "flat" && size == [640, 480]).then_some(row.1)
}

/// The thesis's time for a rung of the model ladder, ms a frame of 10 iterations.
pub(super) fn ladder(model: &str, particles: usize) -> Option<f64> {
    let rung = LADDER.iter().find(|rung| rung.0 == model)?;
    (particles == 304).then_some(rung.1)
}

/// Sentences below the table.
pub(super) const NOTES: [&str; 3] = [
    "The thesis (GTX 780 Ti, Xeon X5690), ms an iteration at 640x480, stands in the last columns; of its ladder at 304 \
     particles ms a frame of 10 iterations, all else of a frame included, and a tenth of that.",
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
        assert_eq!((ladder("elliptic-514", 304), ladder("elliptic-34", 304)), (Some(389.6), None));
    }
}
