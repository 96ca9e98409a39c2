//! Levenberg-Marquardt over a camera's free parameters: the pixels' distances from the projected points.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, storage::Owned};

use super::pairs::Pair;
use super::parameters::Parameters;

/// A point without an image is this far off, pixels: no step into such a camera is taken.
pub(super) const NOWHERE: f64 = 1e5;

/// Pairs to fit, and what is moved for it.
pub(super) struct Reprojection<'a> {
    pub(super) parameters: Parameters,
    pub(super) free: &'a [usize],
    pub(super) pairs: Vec<&'a Pair>,
}

impl Reprojection<'_> {
    /// Moves the free parameters to the least sum of squares, and returns them.
    pub(super) fn minimise(self) -> Parameters {
        // Noise-free pairs are to give their camera back to the last digits.
        let solver = LevenbergMarquardt::new().with_tol(1e-14).with_patience(60);
        let (solved, _) = solver.minimize(self);
        let mut parameters = solved.parameters;
        parameters.settle();
        parameters
    }

    /// The offsets seen - projected, u and v of each pair in turn.
    fn offsets(&self, parameters: &Parameters) -> DVector<f64> {
        let camera = parameters.camera("");
        let offset = |pair: &&Pair| match camera.project(pair.point) {
            Some(pixel) => (pair.pixel - pixel).to_array(),
            None => [NOWHERE; 2],
        };
        DVector::from_iterator(2 * self.pairs.len(), self.pairs.iter().flat_map(offset))
    }

    /// The derivative of the offsets by the free parameters, by central differences.
    pub(super) fn derivative(&self) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(2 * self.pairs.len(), self.free.len());
        let mut moved = self.parameters.clone();
        for (column, &at) in self.free.iter().enumerate() {
            let value = self.parameters.values[at];
            let step = 1e-6 * step_scale(&self.parameters, at);
            let [up, down] = [step, -step].map(|step| {
                moved.values[at] = value + step;
                self.offsets(&moved)
            });
            moved.values[at] = value;
            matrix.set_column(column, &((up - down) / (2.0 * step)));
        }
        matrix
    }
}

/// A length on which a parameter's effect is near linear.
pub(super) fn step_scale(parameters: &Parameters, at: usize) -> f64 {
    let f = parameters.values[6].abs();
    match Parameters::names(parameters.model)[at] {
        "rx" | "ry" | "rz" | "s_x" | "fx/fy" => 1.0,
        "cx" | "cy" => 100.0,
        "f" | "fy" => f,
        "kappa" => 1.0 / (f * f),
        "tx" | "ty" | "tz" => parameters.values[5].abs().max(1.0),
        _ => 1.0,
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Reprojection<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        for (&at, value) in self.free.iter().zip(x.iter()) {
            self.parameters.values[at] = *value;
        }
    }

    fn params(&self) -> DVector<f64> {
        DVector::from_iterator(self.free.len(), self.free.iter().map(|&at| self.parameters.values[at]))
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(self.offsets(&self.parameters))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        Some(self.derivative())
    }
}
