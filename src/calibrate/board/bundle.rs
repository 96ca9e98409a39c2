//! Levenberg-Marquardt over lenses, places of cameras and places of the board together: the pixels' distances from the
//! projected corners.

use glam::{DAffine3, DMat3, DVec3};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, storage::Owned};

use super::super::parameters::Parameters;
use super::super::refine::{NOWHERE, step_scale};
use super::super::residuals::robust_deviation;
use super::target::{Board, SeenCorner};
use crate::geometry::{Camera, rodrigues_matrix};

/// Values of a pose: a small turn after its rotation, a translation.
const POSE: usize = 6;

/// The board's place: world from board.
#[derive(Clone, Debug)]
pub(super) struct BoardPose {
    rotation: DMat3,
    values: [f64; POSE],
}

impl BoardPose {
    pub(super) fn new(world_from_board: DAffine3) -> Self {
        let [x, y, z] = world_from_board.translation.to_array();
        Self { rotation: world_from_board.matrix3, values: [0.0, 0.0, 0.0, x, y, z] }
    }

    pub(super) fn world_from_board(&self) -> DAffine3 {
        let turn = rodrigues_matrix(DVec3::from_slice(&self.values[..3]));
        DAffine3::from_mat3_translation(turn * self.rotation, DVec3::from_slice(&self.values[3..]))
    }
}

/// One camera's view of the board at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoardView<'a> {
    /// The moment's.
    pub(super) frame: usize,
    pub(super) camera: usize,
    /// Place in the bundle's boards.
    pub(super) board: usize,
    pub(super) corners: &'a [SeenCorner],
}

/// What is moved, and what it is held against.
#[derive(Clone, Debug)]
pub(super) struct Bundle<'a> {
    pub(super) board: &'a Board,
    /// Lens and place of every camera.
    pub(super) cameras: Vec<Parameters>,
    /// Values of a lens that are moved.
    pub(super) lens: &'a [usize],
    /// Whether a camera's place is moved.
    pub(super) moves: Vec<bool>,
    pub(super) boards: Vec<BoardPose>,
    pub(super) views: Vec<BoardView<'a>>,
}

impl Bundle<'_> {
    /// Moves everything to the least sum of squares.
    pub(super) fn minimise(self) -> Self {
        let solver = LevenbergMarquardt::new().with_tol(1e-10).with_patience(40);
        let (mut solved, _) = solver.minimize(self);
        solved.cameras.iter_mut().for_each(Parameters::settle);
        for board in &mut solved.boards {
            *board = BoardPose::new(board.world_from_board());
        }
        solved
    }

    /// Root of the mean squared distance of each view, pixels.
    pub(super) fn deviations(&self) -> Vec<f64> {
        let offsets = self.offsets();
        let mut first = 0;
        let deviation = |view: &BoardView| {
            let rows = 2 * view.corners.len();
            let squares = offsets.rows(first, rows).norm_squared();
            first += rows;
            (squares / view.corners.len() as f64).sqrt()
        };
        self.views.iter().map(deviation).collect()
    }

    /// Moves everything to the least sum of squares of the views that agree, and how many others were left out: of each board
    /// the view that is farthest off, where it is much farther off than most, again and again, since a wrong view drags its board away
    /// from the right ones.
    pub(super) fn minimise_agreeing(self) -> (Self, usize) {
        /// Views of one recording differ by a factor of two or three, with blur; wrong ones are off by tens of pixels.
        const MANY: f64 = 5.0;
        /// Nobody finds corners better than this, pixels.
        const FINEST: f64 = 0.3;
        const ROUNDS: usize = 4;
        let before = self.views.len();
        let mut solved = self.minimise();
        for _ in 0..ROUNDS {
            let deviations = solved.deviations();
            // The root of the mean square of two normal coordinates, as `robust_deviation` would have it.
            let limit = (MANY * robust_deviation(&deviations) * 1.177_4).max(FINEST);
            let mut worst = vec![limit; solved.boards.len()];
            for (view, &deviation) in solved.views.iter().zip(&deviations) {
                worst[view.board] = worst[view.board].max(deviation);
            }
            let is_kept =
                |(view, deviation): (&BoardView, &f64)| *deviation < worst[view.board] || worst[view.board] <= limit;
            let kept: Vec<bool> = solved.views.iter().zip(&deviations).map(is_kept).collect();
            if kept.iter().all(|kept| *kept) {
                break;
            }
            let mut kept = kept.into_iter();
            solved.views.retain(|_| kept.next().unwrap_or(true));
            solved = solved.without_unseen_boards().minimise();
        }
        let left_out = before - solved.views.len();
        (solved, left_out)
    }

    /// The same without boards that no view is left of: they would move nothing.
    fn without_unseen_boards(mut self) -> Self {
        let mut places = vec![None; self.boards.len()];
        let mut boards = Vec::new();
        for view in &mut self.views {
            let place = *places[view.board].get_or_insert_with(|| {
                boards.push(self.boards[view.board].clone());
                boards.len() - 1
            });
            view.board = place;
        }
        self.boards = boards;
        self
    }

    /// Standard deviation of a coordinate in the views of one camera, pixels.
    pub(super) fn noise(&self, camera: usize) -> f64 {
        let views = self.views.iter().zip(self.deviations()).filter(|(view, _)| view.camera == camera);
        let (squares, count) = views.fold((0.0, 0.0), |(squares, count), (view, deviation)| {
            let corners = view.corners.len() as f64;
            (squares + corners * deviation * deviation, count + corners)
        });
        // A camera's share of the parameters.
        let moved = (self.lens.len() + POSE) as f64 + POSE as f64 * self.views.len() as f64 / self.cameras.len() as f64;
        (squares / (2.0 * count - moved).max(1.0)).sqrt()
    }

    /// Standard deviations of the values in the order of [`LeastSquaresProblem::params`], for a noise of one pixel; None
    /// where some of them change nothing.
    pub(super) fn unit_deviations(&self) -> Option<Vec<f64>> {
        let derivative = self.derivative();
        let inverse = derivative.tr_mul(&derivative).cholesky()?.inverse();
        let deviations: Vec<f64> = inverse.diagonal().iter().map(|variance| variance.sqrt()).collect();
        deviations.iter().all(|deviation| deviation.is_finite()).then_some(deviations)
    }

    /// Place of a camera's first value among all.
    pub(super) fn first_of(&self, camera: usize) -> usize {
        let poses = self.moves[..camera].iter().filter(|moves| **moves).count();
        camera * self.lens.len() + poses * POSE
    }

    /// The values of a camera that are moved.
    fn moved(&self, camera: usize) -> impl Iterator<Item = usize> {
        let pose = if self.moves[camera] { 0..POSE } else { 0..0 };
        self.lens.iter().copied().chain(pose)
    }

    fn first_of_boards(&self) -> usize {
        self.first_of(self.cameras.len() - 1) + self.moved(self.cameras.len() - 1).count()
    }

    fn offsets(&self) -> DVector<f64> {
        let cameras: Vec<Camera> = self.cameras.iter().map(|camera| camera.camera("")).collect();
        let boards: Vec<DAffine3> = self.boards.iter().map(BoardPose::world_from_board).collect();
        let mut offsets = Vec::with_capacity(2 * self.views.iter().map(|view| view.corners.len()).sum::<usize>());
        for view in &self.views {
            offsets_of(self.board, &cameras[view.camera], &boards[view.board], view.corners, &mut offsets);
        }
        DVector::from_vec(offsets)
    }

    /// By central differences, view by view: nothing else moves a view's corners than its camera and its board.
    fn derivative(&self) -> DMatrix<f64> {
        let rows = 2 * self.views.iter().map(|view| view.corners.len()).sum::<usize>();
        let boards_at = self.first_of_boards();
        let mut matrix = DMatrix::zeros(rows, boards_at + POSE * self.boards.len());
        let mut first_row = 0;
        let [mut ahead, mut behind] = [Vec::new(), Vec::new()];
        for view in &self.views {
            let (parameters, board) = (&self.cameras[view.camera], &self.boards[view.board]);
            let (camera, pose) = (parameters.camera(""), board.world_from_board());
            let mut fill = |column: usize, step: f64, ahead: &[f64], behind: &[f64]| {
                for (row, (ahead, behind)) in ahead.iter().zip(behind).enumerate() {
                    matrix[(first_row + row, column)] = (ahead - behind) / (2.0 * step);
                }
            };
            for (column, at) in (self.first_of(view.camera)..).zip(self.moved(view.camera)) {
                let step = 1e-6 * step_scale(parameters, at);
                for (offsets, step) in [(&mut ahead, step), (&mut behind, -step)] {
                    let mut moved = parameters.clone();
                    moved.values[at] += step;
                    offsets.clear();
                    offsets_of(self.board, &moved.camera(""), &pose, view.corners, offsets);
                }
                fill(column, step, &ahead, &behind);
            }
            let away = (camera.camera_from_world * pose).translation.length().max(1.0);
            for at in 0..POSE {
                let step = 1e-6 * if at < 3 { 1.0 } else { away };
                for (offsets, step) in [(&mut ahead, step), (&mut behind, -step)] {
                    let mut moved = board.clone();
                    moved.values[at] += step;
                    offsets.clear();
                    offsets_of(self.board, &camera, &moved.world_from_board(), view.corners, offsets);
                }
                fill(boards_at + POSE * view.board + at, step, &ahead, &behind);
            }
            first_row += 2 * view.corners.len();
        }
        matrix
    }
}

/// The offsets seen - projected of a view's corners, u and v of each in turn.
fn offsets_of(
    board: &Board,
    camera: &Camera,
    world_from_board: &DAffine3,
    corners: &[SeenCorner],
    offsets: &mut Vec<f64>,
) {
    for seen in corners {
        let projected = camera.project(world_from_board.transform_point3(board.corner(seen.corner)));
        offsets.extend(projected.map_or([NOWHERE; 2], |pixel| (seen.pixel - pixel).to_array()));
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Bundle<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        let mut next = x.iter();
        for camera in 0..self.cameras.len() {
            let moved: Vec<usize> = self.moved(camera).collect();
            for (at, value) in moved.into_iter().zip(&mut next) {
                self.cameras[camera].values[at] = *value;
            }
        }
        for (place, value) in self.boards.iter_mut().flat_map(|board| &mut board.values).zip(next) {
            *place = *value;
        }
    }

    fn params(&self) -> DVector<f64> {
        let of_camera = |camera: usize| self.moved(camera).map(move |at| self.cameras[camera].values[at]);
        let cameras = (0..self.cameras.len()).flat_map(of_camera);
        let boards = self.boards.iter().flat_map(|board| board.values);
        DVector::from_vec(cameras.chain(boards).collect())
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(self.offsets())
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        Some(self.derivative())
    }
}
