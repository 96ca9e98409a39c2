//! From corners seen to calibrated cameras: lenses one by one, then everything together, then the floor.

use anyhow::{Context, Result, bail, ensure};
use glam::{DAffine3, DVec2};

use super::super::layout::Layout;
use super::super::parameters::{Held, LensModel, Parameters, middle};
use super::super::residuals::Residual;
use super::super::solve::{Calibration, Estimate};
use super::bundle::{BoardPose, BoardView, Bundle};
use super::floor::{self, Floor, FloorFound, Placed};
use super::homography::{focal_length, homography, pose};
use super::start::place_cameras;
use super::target::{Board, BoardMoment, FEWEST_CORNERS, SeenCorner};
use super::views::{Outline, of_camera, outline, spread};
use crate::geometry::{Camera, Lens};

/// Views that a lens is first found from.
const LENS_VIEWS: usize = 20;
/// A lens needs boards at several tilts.
const FEWEST_VIEWS: usize = 4;
/// Moments that everything is fitted to together, at which two cameras or more see the board …
const JOINT_MOMENTS: usize = 32;
/// … and a camera's own, for its lens.
const OWN_MOMENTS: usize = 8;

/// Corners farther off than this part of the picture's diagonal are none of this board's, or not of this moment.
const ASTRAY: f64 = 0.01;

/// What to calibrate and how.
#[derive(Clone, Debug, PartialEq)]
pub struct BoardSettings {
    /// The lens.
    pub model: LensModel,
    /// What is not estimated; None: k3.
    pub held: Option<Vec<Held>>,
    /// Side of a pixel, mm: only gives f and kappa of Tsai's model their unit.
    pub pitch: f64,
    /// When the board lies on the floor.
    pub floor: Floor,
    /// How thick the board is, mm: the floor lies so far below its print.
    pub thickness: f64,
}

impl Default for BoardSettings {
    fn default() -> Self {
        Self { model: LensModel::BrownConrady, held: None, pitch: 0.01, floor: Floor::Lowest, thickness: 0.0 }
    }
}

/// Cameras calibrated from a board.
#[derive(Clone, Debug, PartialEq)]
pub struct BoardCalibration {
    /// The cameras, in the world of the floor, with residuals and lens parameters; rotation and translation are not among
    /// the estimates, since only the cameras' places to each other are.
    pub cameras: Vec<Calibration>,
    /// A camera: in how many moments it sees the board, and the noise of its pixels when it is fitted alone, pixels.
    pub alone: Vec<(usize, f64)>,
    /// Moments that everything was fitted to.
    pub moments: usize,
    /// Views left out because they contradict the others.
    pub left_out: usize,
    /// The floor.
    pub floor: FloorFound,
}

/// Calibrates cameras from what they see of a board: `names` and `sizes` (pixels) a camera, in the order of the moments'
/// views.
///
/// # Errors
/// One sentence: a camera that sees the board too seldom, always parallel to its picture, or never together with another;
/// no moment at which it lies on the floor; boards that contradict each other.
pub fn calibrate_board(
    board: &Board,
    names: &[String],
    sizes: &[[u32; 2]],
    moments: &[BoardMoment],
    settings: &BoardSettings,
) -> Result<BoardCalibration> {
    board.check()?;
    ensure!(!names.is_empty(), "there is no camera, expected at least one");
    let held = settings.held.clone().unwrap_or_else(|| vec![Held::K3]);
    let lens: Vec<usize> = Parameters::free(settings.model, &held).into_iter().filter(|&at| at >= 6).collect();
    let outlines: Vec<Vec<Option<Outline>>> = moments
        .iter()
        .map(|moment| {
            let views = moment.views.iter().zip(sizes);
            views.map(|(seen, &size)| (seen.len() >= FEWEST_CORNERS).then(|| outline(board, seen, size))?).collect()
        })
        .collect();

    let mut alone = Vec::new();
    let mut parameters = Vec::new();
    for (camera, (name, &size)) in names.iter().zip(sizes).enumerate() {
        let task = Alone { board, camera, size, moments, outlines: &outlines, lens: &lens, settings };
        let (found, seen, noise) = task.solve().with_context(|| format!("camera `{name}`"))?;
        parameters.push(found);
        alone.push((seen, noise));
    }
    let poses = board_poses(board, &parameters, moments, &outlines);
    for (camera, place) in parameters.iter_mut().zip(place_cameras(&poses, names)?) {
        camera.place(place);
    }

    let chosen = joint_moments(moments, &outlines, names.len());
    let (solved, left_out) = together(board, parameters, &lens, moments, &poses, &chosen, names)?;
    let cameras: Vec<Camera> = solved.cameras.iter().zip(names).map(|(camera, name)| camera.camera(name)).collect();
    let placed = placed_boards(&solved.cameras, moments, &poses);
    let (lying, found) = floor::find(board, &placed, &cameras, settings.floor)?;
    let lying = refined(&solved, moments, &lying);
    let floor_from_world = floor::floor_from_world(board, &lying, settings.thickness)?;
    let cameras = results(&solved, names, floor_from_world);
    Ok(BoardCalibration { cameras, alone, moments: chosen.len(), left_out, floor: found })
}

fn diagonal(size: [u32; 2]) -> f64 {
    f64::from(size[0]).hypot(f64::from(size[1]))
}

/// One camera by itself.
struct Alone<'a> {
    board: &'a Board,
    camera: usize,
    size: [u32; 2],
    moments: &'a [BoardMoment],
    outlines: &'a [Vec<Option<Outline>>],
    lens: &'a [usize],
    settings: &'a BoardSettings,
}

impl Alone<'_> {
    /// Its lens, in how many moments it sees the board, and the noise of its pixels.
    fn solve(&self) -> Result<(Parameters, usize, f64)> {
        let (own, seen) = of_camera(self.outlines, self.camera);
        ensure!(
            seen.len() >= FEWEST_VIEWS,
            "the board is found in {} of {} pictures, expected at least {FEWEST_VIEWS}: is it the board that was printed, seen \
             whole where it is a chessboard, sharp and not too small?",
            seen.len(),
            self.moments.len()
        );
        let chosen = spread(&seen, self.moments, &own, LENS_VIEWS);
        let corners: Vec<&[SeenCorner]> =
            chosen.iter().map(|&moment| &self.moments[moment].views[self.camera][..]).collect();
        let mappings: Vec<_> = corners.iter().filter_map(|corners| homography(self.board, corners)).collect();
        let centre = middle(self.size);
        let focal = focal_length(&mappings, centre).context(
            "the board is parallel to the picture in all views, from which no focal length can be told, expected it tilted",
        )?;
        let boards: Option<Vec<BoardPose>> =
            mappings.iter().map(|mapping| Some(BoardPose::new(pose(mapping, focal, centre)?))).collect();
        let (Some(boards), true) = (boards, mappings.len() == corners.len()) else {
            bail!("the board has no pose in one of its views, expected corners that are not on a line");
        };
        let settings = self.settings;
        let camera = Parameters::new(settings.model, self.size, settings.pitch, DAffine3::IDENTITY, focal, 1.0);
        let views = corners.iter().zip(&chosen).enumerate().map(|(board, (&corners, &moment))| BoardView {
            frame: self.moments[moment].frame,
            camera: 0,
            board,
            corners,
        });
        let bundle = Bundle {
            board: self.board,
            cameras: vec![camera],
            lens: self.lens,
            moves: vec![false],
            boards,
            views: views.collect(),
        };
        let (bundle, left_out) = bundle.minimise_agreeing();
        ensure!(
            bundle.views.len() >= FEWEST_VIEWS.max(left_out),
            "{left_out} of {} views of the board contradict the others: is it flat, and its size as given?",
            left_out + bundle.views.len()
        );
        let noise = bundle.noise(0);
        ensure!(
            noise <= ASTRAY * diagonal(self.size),
            "the views of the board contradict each other, the best lens is {noise:.0} pixels off: is the board flat, and its size \
             as given?"
        );
        let camera = bundle.cameras.into_iter().next().context("there is no lens")?;
        Ok((camera, seen.len(), noise))
    }
}

/// Camera from board, a list of cameras a moment, by the lenses found.
fn board_poses(
    board: &Board,
    cameras: &[Parameters],
    moments: &[BoardMoment],
    outlines: &[Vec<Option<Outline>>],
) -> Vec<Vec<Option<DAffine3>>> {
    let lenses: Vec<Lens> = cameras.iter().map(|camera| camera.camera("").lens).collect();
    let of_view = |seen: &[SeenCorner], lens: &Lens| -> Option<DAffine3> {
        // Before a lens of focal length 1 without distortion.
        let straight =
            |at: &SeenCorner| Some(SeenCorner { corner: at.corner, pixel: lens.undistort(lens.from_pixel(at.pixel))? });
        let straight: Vec<SeenCorner> = seen.iter().map(straight).collect::<Option<_>>()?;
        pose(&homography(board, &straight)?, 1.0, DVec2::ZERO)
    };
    let of_moment = |(moment, outlines): (&BoardMoment, &Vec<Option<Outline>>)| {
        let views = moment.views.iter().zip(&lenses).zip(outlines);
        views.map(|((seen, lens), outline)| outline.as_ref().and_then(|_| of_view(seen, lens))).collect()
    };
    moments.iter().zip(outlines).map(of_moment).collect()
}

/// The moments that everything is fitted to.
fn joint_moments(moments: &[BoardMoment], outlines: &[Vec<Option<Outline>>], cameras: usize) -> Vec<usize> {
    let seen_by = |moment: usize| outlines[moment].iter().flatten().count();
    let shared: Vec<usize> = (0..moments.len()).filter(|&moment| seen_by(moment) >= 2).collect();
    let mut chosen = spread(&shared, moments, outlines, JOINT_MOMENTS);
    for camera in 0..cameras {
        let (own, seen) = of_camera(outlines, camera);
        let most = if shared.is_empty() { LENS_VIEWS } else { OWN_MOMENTS };
        chosen.extend(spread(&seen, moments, &own, most));
    }
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}

/// The board in the world at a moment, by the camera that sees most of it.
fn placed_boards(cameras: &[Parameters], moments: &[BoardMoment], poses: &[Vec<Option<DAffine3>>]) -> Vec<Placed> {
    let places: Vec<DAffine3> = cameras.iter().map(|camera| camera.camera("").camera_from_world.inverse()).collect();
    let placed = |(moment, poses): (&BoardMoment, &Vec<Option<DAffine3>>)| {
        let seen = moment.views.iter().zip(poses).zip(&places);
        let seen = seen.filter_map(|((corners, pose), place)| Some((corners.len(), *place * (*pose)?)));
        let best = seen.clone().max_by_key(|(corners, _)| *corners)?;
        let corners = seen.map(|(corners, _)| corners).sum();
        Some(Placed { frame: moment.frame, world_from_board: best.1, corners })
    };
    moments.iter().zip(poses).filter_map(placed).collect()
}

/// Fits lenses, places and boards together; with how many views were left out.
fn together<'a>(
    board: &'a Board,
    cameras: Vec<Parameters>,
    lens: &'a [usize],
    moments: &'a [BoardMoment],
    poses: &[Vec<Option<DAffine3>>],
    chosen: &[usize],
    names: &[String],
) -> Result<(Bundle<'a>, usize)> {
    let start: Vec<Placed> = placed_boards(&cameras, moments, poses);
    let mut boards = Vec::new();
    let mut views = Vec::new();
    for &moment in chosen {
        let Some(placed) = start.iter().find(|placed| placed.frame == moments[moment].frame) else { continue };
        for (camera, corners) in moments[moment].views.iter().enumerate() {
            if poses[moment][camera].is_some() {
                views.push(BoardView { frame: moments[moment].frame, camera, board: boards.len(), corners });
            }
        }
        boards.push(BoardPose::new(placed.world_from_board));
    }
    let moves = (0..cameras.len()).map(|camera| camera > 0).collect();
    let count = cameras.len();
    let bundle = Bundle { board, cameras, lens, moves, boards, views };
    let (bundle, left_out) = bundle.minimise_agreeing();
    let kept = |camera: usize| bundle.views.iter().filter(|view| view.camera == camera).count();
    ensure!(
        bundle.views.len() > 2 * left_out && (0..count).all(|camera| kept(camera) >= 2),
        "{left_out} of {} views of the board contradict the others: do the videos begin at the same moment?",
        left_out + bundle.views.len()
    );
    for (camera, name) in names.iter().enumerate() {
        let noise = bundle.noise(camera);
        ensure!(
            noise <= ASTRAY * diagonal(bundle.cameras[camera].size()),
            "camera `{name}` contradicts the others, its corners are {noise:.0} pixels off together with them: do the videos begin \
             at the same moment?"
        );
    }
    Ok((bundle, left_out))
}

/// The board on the floor once more, from all cameras that see it then, which stay where they are.
fn refined(solved: &Bundle, moments: &[BoardMoment], lying: &Placed) -> Placed {
    let Some(moment) = moments.iter().find(|moment| moment.frame == lying.frame) else { return *lying };
    let seen = moment.views.iter().enumerate().filter(|(_, corners)| corners.len() >= FEWEST_CORNERS);
    let views = seen.map(|(camera, corners)| BoardView { frame: moment.frame, camera, board: 0, corners }).collect();
    let bundle = Bundle {
        lens: &[],
        moves: vec![false; solved.cameras.len()],
        boards: vec![BoardPose::new(lying.world_from_board)],
        views,
        cameras: solved.cameras.clone(),
        board: solved.board,
    };
    Placed { world_from_board: bundle.minimise().boards[0].world_from_board(), ..*lying }
}

/// The cameras in the world of the floor, with what they are worth.
fn results(solved: &Bundle, names: &[String], floor_from_world: DAffine3) -> Vec<Calibration> {
    let deviations = solved.unit_deviations();
    let world_from_floor = floor_from_world.inverse();
    let calibration = |(camera, name): (usize, &String)| {
        let parameters = &solved.cameras[camera];
        let placed = parameters.camera(name);
        let noise = solved.noise(camera);
        let estimates = Parameters::names(parameters.model).iter().enumerate().skip(6).map(|(at, name)| {
            let place = solved.lens.iter().position(|&free| free == at);
            let deviation = place.and_then(|place| Some(deviations.as_ref()?[solved.first_of(camera) + place] * noise));
            Estimate { name, value: parameters.values[at], deviation }
        });
        let mut residuals = Vec::new();
        for view in solved.views.iter().filter(|view| view.camera == camera) {
            let board = solved.boards[view.board].world_from_board();
            residuals.extend(view.corners.iter().map(|seen| {
                let projected = placed.project(board.transform_point3(solved.board.corner(seen.corner)));
                Residual {
                    name: format!("frame {} corner {}", view.frame, seen.corner),
                    pixel: seen.pixel,
                    offset: projected.map(|pixel| seen.pixel - pixel),
                    is_outlier: false,
                }
            }));
        }
        let camera_from_world = placed.camera_from_world * world_from_floor;
        let camera = Camera { camera_from_world, ..placed };
        Calibration { camera, layout: Layout::General, residuals, estimates: estimates.collect(), noise }
    };
    names.iter().enumerate().map(calibration).collect()
}
