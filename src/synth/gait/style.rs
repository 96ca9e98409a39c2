//! How somebody goes: joint angles over the gait cycle, which starts when the heel strikes.

/// A way of going.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Flexion of the hip, degrees at every tenth of the cycle.
    pub hip: [f64; 10],
    /// Flexion of the knee, likewise.
    pub knee: [f64; 10],
    /// The phase at which the foot leaves the floor; before a half there is a flight.
    pub lift: f64,
    /// The phase at which the body is over the foot.
    pub over: f64,
    /// Height of the flight, mm.
    pub flight_height: f64,
    /// Swing of the arms to either side, degrees.
    pub arm_swing: f64,
    /// Flexion of the elbow: mean and swing, degrees.
    pub elbow: [f64; 2],
    /// Lean of the trunk, degrees.
    pub lean: f64,
}

impl Style {
    /// A walk. The shape is that of the normal data of gait laboratories (hip from flexion to extension in stance, a knee
    /// that gives in a little under load and bends to 60 degrees in swing). The body has no ankle, so what an ankle would
    /// do is shared out: the ranges of the hip are those of a slow walk, and the knee bends early before the foot leaves the
    /// floor.
    pub const WALK: Self = Self {
        hip: [19.0, 16.0, 10.0, 0.0, -10.0, -14.0, -4.0, 13.0, 25.0, 25.0],
        knee: [3.0, 9.0, 10.0, 10.0, 12.0, 32.0, 56.0, 60.0, 44.0, 17.0],
        lift: 0.56,
        over: 0.27,
        flight_height: 0.0,
        arm_swing: 22.0,
        elbow: [26.0, 13.0],
        lean: 4.0,
    };

    /// A run: a third of the cycle on each foot and a flight between, knees high, elbows bent, the trunk a little forward.
    pub const RUN: Self = Self {
        hip: [36.0, 31.0, 19.0, 1.0, -9.0, -3.0, 18.0, 40.0, 48.0, 43.0],
        knee: [18.0, 34.0, 36.0, 24.0, 24.0, 54.0, 88.0, 96.0, 70.0, 32.0],
        lift: 0.38,
        over: 0.18,
        flight_height: 45.0,
        arm_swing: 38.0,
        elbow: [82.0, 12.0],
        lean: 9.0,
    };

    /// How high the flight lifts the feet at a phase, mm.
    pub(super) fn flight(&self, phase: f64) -> f64 {
        let half = phase.rem_euclid(0.5);
        if half <= self.lift {
            return 0.0;
        }
        // A parabola from one foot's leaving to the other's landing, on the floor at both.
        let t = (half - self.lift) / (0.5 - self.lift);
        self.flight_height * 4.0 * t * (1.0 - t)
    }
}
