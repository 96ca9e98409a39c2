//! The printed board, and what cameras see of it.

use anyhow::{Result, bail, ensure};
use glam::{DVec2, DVec3};

use crate::files::choices;

choices! {
    /// What is printed on a board.
    "board" pub enum BoardKind {
        /// Black and white squares, seen whole; an even and an odd number of inner corners.
        "chessboard" Chessboard,
        /// Squares with ArUco or AprilTag markers in the white ones; a part of it is enough.
        "charuco" Charuco,
    }
}

/// A printed board. Its frame has the origin at the first inner corner, x along the rows of corners, y down the columns, z
/// into the board, mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Board {
    /// What is printed on it.
    pub kind: BoardKind,
    /// Inner corners, a row and a column.
    pub corners: [u32; 2],
    /// Side of a square, mm.
    pub square: f64,
    /// Side of a marker, mm, and the name of their dictionary: of a ChArUco board alone.
    pub markers: Option<(f64, String)>,
}

impl Board {
    /// Fewest and most inner corners in a row or column.
    const CORNERS: [u32; 2] = [2, 100];

    /// Whether such a board can be printed, and told which way up it is.
    ///
    /// # Errors
    /// One sentence with the number that cannot be.
    pub fn check(&self) -> Result<()> {
        let [columns, rows] = self.corners;
        let [least, most] = Self::CORNERS;
        ensure!(
            [columns, rows].iter().all(|count| (least..=most).contains(count)) && columns * rows >= 6,
            "the board has {columns}x{rows} inner corners, expected {least} to {most} either way and at least 6"
        );
        ensure!(
            self.square > 0.1 && self.square < 1e4,
            "the board's squares have a side of {} mm, expected millimetres, say 30",
            self.square
        );
        match (&self.markers, self.kind) {
            (None, BoardKind::Chessboard) => ensure!(
                (columns + rows) % 2 == 1,
                "a chessboard of {columns}x{rows} inner corners looks the same upside down, expected an even and an odd number \
                 of corners, say 9x6, or a ChArUco board"
            ),
            (Some((marker, _)), BoardKind::Charuco) => ensure!(
                *marker > 0.0 && *marker < self.square,
                "the board's markers have a side of {marker} mm, expected less than the squares' {} mm",
                self.square
            ),
            (None, BoardKind::Charuco) => {
                bail!("a ChArUco board was given without markers, expected their side and dictionary")
            }
            (Some(_), BoardKind::Chessboard) => bail!("a chessboard was given markers, expected none"),
        }
        Ok(())
    }

    /// The number of its inner corners.
    pub(super) fn corner_count(&self) -> usize {
        (self.corners[0] * self.corners[1]) as usize
    }

    /// An inner corner in the board's frame, mm; they are counted row by row.
    pub(super) fn corner(&self, index: usize) -> DVec3 {
        let columns = self.corners[0] as usize;
        DVec3::new((index % columns) as f64, (index / columns) as f64, 0.0) * self.square
    }

    /// The middle of its corners, mm.
    pub(super) fn middle(&self) -> DVec3 {
        0.5 * (self.corner(0) + self.corner(self.corner_count() - 1))
    }
}

/// A corner of the board as a camera sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenCorner {
    /// Which one, row by row.
    pub corner: usize,
    /// Where, pixels from the centre of the top-left one.
    pub pixel: DVec2,
}

/// The board at one moment: what each camera sees of it, nothing where it does not.
#[derive(Clone, Debug, PartialEq)]
pub struct BoardMoment {
    /// The frame, counted from 0.
    pub frame: usize,
    /// A list a camera.
    pub views: Vec<Vec<SeenCorner>>,
}

/// Fewest corners that a view is used with: a third of a row tells nothing of the board's tilt.
pub(super) const FEWEST_CORNERS: usize = 6;
