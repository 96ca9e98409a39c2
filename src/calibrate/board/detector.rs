//! The corners of a board in a picture, by the crates calib-targets-chessboard and calib-targets-charuco.

use std::collections::HashSet;

use anyhow::{Context, Result, anyhow};
use calib_targets_charuco::{CharucoBoardSpec, CharucoDetector, CharucoParams, resolve_dictionary};
use calib_targets_chessboard::{
    ChessboardDetector, ChessboardParams, GrayImageView, default_chess_config, detect_corners,
};
use glam::DVec2;
use image::GrayImage;
use image::imageops::{self, FilterType};

use super::target::{Board, BoardKind, FEWEST_CORNERS, SeenCorner};

/// From a board's column and row, and how many of each it has, to the detector's.
type Way = fn([i32; 2], [i32; 2]) -> [i32; 2];

/// Finds one board in pictures.
pub struct BoardDetector {
    board: Board,
    finder: Finder,
}

enum Finder {
    Chessboard(ChessboardDetector),
    Charuco(Box<CharucoDetector>),
}

impl BoardDetector {
    /// For one board.
    ///
    /// # Errors
    /// When there is no such board ([`Board::check`]), or its markers' dictionary is unknown or too small.
    pub fn new(board: &Board) -> Result<Self> {
        board.check()?;
        let finder = match (board.kind, &board.markers) {
            (BoardKind::Charuco, Some((marker, dictionary))) => {
                let known = resolve_dictionary(dictionary).ok_or_else(|| {
                    anyhow!("unknown dictionary {dictionary:?}, expected one of OpenCV's, DICT_4X4_50 or DICT_APRILTAG_36h11 say")
                })?;
                let [columns, rows] = board.corners.map(|count| count + 1);
                let (square, part) = (board.square as f32, (marker / board.square) as f32);
                let spec = CharucoBoardSpec::new(rows, columns, square, part, known);
                let found = CharucoDetector::new(CharucoParams::for_board(spec));
                Finder::Charuco(Box::new(found.with_context(|| format!("the board with markers of {dictionary}"))?))
            }
            _ => Finder::Chessboard(ChessboardDetector::new(ChessboardParams::default()).context("the chessboard")?),
        };
        Ok(Self { board: board.clone(), finder })
    }

    /// The corners of the board in a picture; none where it is not seen, or a chessboard not whole.
    pub fn find(&self, picture: &GrayImage) -> Vec<SeenCorner> {
        let seen = match &self.finder {
            Finder::Charuco(detector) => {
                let found = charuco(detector, picture);
                if found.is_empty() { charuco_small(detector, picture) } else { found }
            }
            Finder::Chessboard(detector) => {
                let corners = detect_corners(&view_of(picture), &default_chess_config());
                let cells = detector.detect(&corners).map_or_else(Vec::new, |found| {
                    let corners = found.corners.iter();
                    corners
                        .map(|at| ([at.grid.u, at.grid.v], DVec2::new(at.position.x.into(), at.position.y.into())))
                        .collect::<Vec<_>>()
                });
                self.chessboard(&cells, picture)
            }
        };
        if seen.len() < FEWEST_CORNERS {
            return Vec::new();
        }
        let mut seen: Vec<SeenCorner> = seen.into_iter().map(|(corner, pixel)| SeenCorner { corner, pixel }).collect();
        seen.sort_by_key(|seen| seen.corner);
        seen
    }

    /// The first of the cells between which all of the board's corners are; in small pictures something beside the board may
    /// have been counted as a corner more. None where it is not whole, or there are two such places.
    fn whole(&self, cells: &[([i32; 2], DVec2)]) -> Option<[i32; 2]> {
        let [columns, rows] = self.board.corners.map(|count| count as i32);
        let known: HashSet<[i32; 2]> = cells.iter().map(|(cell, _)| *cell).collect();
        let holds = |[left, top]: &[i32; 2], [width, height]: [i32; 2]| {
            (0..height).all(|v| (0..width).all(|u| known.contains(&[left + u, top + v])))
        };
        let mut places = known.iter().filter(|place| holds(place, [columns, rows]) || holds(place, [rows, columns]));
        let place = places.next();
        place.filter(|_| places.next().is_none()).copied()
    }

    /// Counts the cells of a chessboard as the board does: seen whole, and turned so that the square before the first corner is
    /// black.
    fn chessboard(&self, cells: &[([i32; 2], DVec2)], picture: &GrayImage) -> Vec<(usize, DVec2)> {
        let [columns, rows] = self.board.corners.map(|count| count as i32);
        let at = |cell: [i32; 2]| cells.iter().find(|(known, _)| *known == cell).map(|(_, pixel)| *pixel);
        let Some([left, top]) = self.whole(cells) else { return Vec::new() };
        // The detector counts to the right and down, whichever way the board is turned.
        let ways: [Way; 4] = [
            |[u, v], _| [u, v],
            |[u, v], [columns, rows]| [columns - 1 - u, rows - 1 - v],
            |[u, v], [_, rows]| [rows - 1 - v, u],
            |[u, v], [columns, _]| [v, columns - 1 - u],
        ];
        for way in ways {
            let pixel = |u: i32, v: i32| {
                let [u, v] = way([u, v], [columns, rows]);
                at([left + u, top + v])
            };
            let is_there = pixel(0, 0).is_some() && pixel(columns - 1, rows - 1).is_some();
            if !is_there || darkness(&pixel, [columns, rows], picture) <= 0.0 {
                continue;
            }
            let all = (0..rows).flat_map(|v| (0..columns).map(move |u| [u, v]));
            let seen = all.map(|[u, v]| Some(((v * columns + u) as usize, pixel(u, v)?)));
            return seen.collect::<Option<Vec<_>>>().unwrap_or_default();
        }
        Vec::new()
    }
}

fn view_of(picture: &GrayImage) -> GrayImageView<'_> {
    GrayImageView { width: picture.width() as usize, height: picture.height() as usize, data: picture.as_raw() }
}

fn charuco(detector: &CharucoDetector, picture: &GrayImage) -> Vec<(usize, DVec2)> {
    let Ok(found) = detector.detect(&view_of(picture)) else { return Vec::new() };
    let corners = found.corners.iter();
    corners.map(|at| (at.id as usize, DVec2::new(at.position.x.into(), at.position.y.into()))).collect()
}

/// In the picture enlarged twofold: the corners of markers a few pixels wide run into those of the squares.
fn charuco_small(detector: &CharucoDetector, picture: &GrayImage) -> Vec<(usize, DVec2)> {
    let [width, height] = [picture.width() * 2, picture.height() * 2];
    let larger = imageops::resize(picture, width, height, FilterType::CatmullRom);
    let found = charuco(detector, &larger);
    found.into_iter().map(|(corner, pixel)| (corner, (pixel + 0.5) / 2.0 - 0.5)).collect()
}

/// How much darker the squares are that have the colour of the one before the first corner, grey levels.
fn darkness(pixel: &dyn Fn(i32, i32) -> Option<DVec2>, [columns, rows]: [i32; 2], picture: &GrayImage) -> f64 {
    let mut sums = [[0.0_f64; 2]; 2];
    for v in 0..rows - 1 {
        for u in 0..columns - 1 {
            let corners = [pixel(u, v), pixel(u + 1, v), pixel(u, v + 1), pixel(u + 1, v + 1)];
            let Some(sum) = corners.into_iter().sum::<Option<DVec2>>() else { continue };
            let at = 0.25 * sum;
            let Some(grey) = picture.get_pixel_checked(at.x.round().max(0.0) as u32, at.y.round().max(0.0) as u32)
            else {
                continue;
            };
            let colour = usize::from((u + v) % 2 != 0);
            sums[colour][0] += f64::from(grey[0]);
            sums[colour][1] += 1.0;
        }
    }
    let [same, other] = sums.map(|[sum, count]| sum / count.max(1.0));
    other - same
}
