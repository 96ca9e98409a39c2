//! Pictures that are the picture before again: of a camera that stopped, or of a file that was filled up.

use image::RgbImage;

use super::finding::Finding;
use crate::sequence::{FrameSet, Sequence, View};

/// Pictures of a camera that may be the one before again, %: one here and there harms nobody.
const MOST: f64 = 10.0;

/// Which pictures of a stretch of frames are the one before again, to the last bit.
#[derive(Clone, Debug, Default)]
pub(super) struct Repeats {
    before: Vec<RgbImage>,
    /// A row a frame but the first: its number, and of each view whether its picture is the one before.
    rows: Vec<(usize, Vec<bool>)>,
}

impl Repeats {
    /// Takes note of the frame after the last.
    pub(super) fn note(&mut self, frame: &FrameSet) {
        if !self.before.is_empty() {
            let is_same = frame.pictures.iter().zip(&self.before).map(|(picture, before)| picture == before);
            self.rows.push((frame.index, is_same.collect()));
        }
        self.before.clone_from(&frame.pictures);
    }

    /// How often each camera shows the picture before again.
    pub(super) fn findings(&self, sequence: &Sequence) -> Vec<Finding> {
        sequence.views.iter().enumerate().map(|(at, view)| self.finding(at, view)).collect()
    }

    fn finding(&self, at: usize, view: &View) -> Finding {
        // Where frames are the pictures nearest in time, one of a slower camera stands for several.
        let is_taken_again =
            |frame: usize| view.picks.as_ref().is_some_and(|picks| picks.get(frame) == picks.get(frame - 1));
        let (again, all) = self.of_view(at, is_taken_again);
        if all == 0 {
            return Finding::not_measured("repeated pictures", "nothing goes on in the pictures").of(&view.camera);
        }
        let longest = again.chunk_by(|before, next| before + 1 == *next).max_by_key(|run| run.len());
        let where_most = match longest {
            Some([first, .., last]) => format!(", those of frames {first} to {last} on end"),
            Some([only]) => format!(", that of frame {only} one of them"),
            _ => String::new(),
        };
        let percent = 100.0 * again.len() as f64 / all as f64;
        Finding::number("repeated pictures", "% of the pictures", percent, [0.0, MOST])
            // So do those of a room in which nobody is, where there is no noise or a codec took it away.
            .doubtful_within([0.0, 100.0])
            .of(&view.camera)
            .found(format!("{} of {all} are the one before again{where_most}, while other cameras' go on", again.len()))
            .or(
                "the camera stopped, or its file was filled up with pictures when its rate was changed: leave these frames out, or give the \
                 file as the camera wrote it, with its own rate or time stamps",
            )
    }

    /// The frames in which a view's picture is the one before again, of so many in which most views go on and which do not have the same picture
    /// because it was taken again.
    fn of_view(&self, at: usize, is_taken_again: impl Fn(usize) -> bool) -> (Vec<usize>, usize) {
        let go_on = |is_same: &[bool]| 2 * is_same.iter().filter(|is_same| **is_same).count() < is_same.len();
        let rows = || self.rows.iter().filter(|(frame, is_same)| go_on(is_same) && !is_taken_again(*frame));
        (rows().filter(|(_, is_same)| is_same[at]).map(|(frame, _)| *frame).collect(), rows().count())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Frames 10 to 19 of views whose pictures are these numbers' grey.
    fn noted(greys: impl Fn(usize) -> Vec<u8>) -> Repeats {
        let mut repeats = Repeats::default();
        for index in 10..20 {
            let pictures: Vec<RgbImage> =
                greys(index).into_iter().map(|grey| RgbImage::from_pixel(2, 2, image::Rgb([grey; 3]))).collect();
            let (masks, ignored) = (vec![None; pictures.len()], vec![None; pictures.len()]);
            repeats.note(&FrameSet { index, pictures, masks, ignored });
        }
        repeats
    }

    #[test]
    fn pictures_that_stand_still_are_counted_where_others_go_on() {
        let grey = |frame: usize| frame as u8;
        // The second view stops in frame 13, the third shows every picture twice, all stand still in the last frame.
        let repeats = noted(|frame| {
            let frame = frame.min(18);
            vec![grey(frame), grey(frame.min(13)), grey(frame / 2), grey(frame), grey(frame)]
        });
        let of_view = |at: usize| repeats.of_view(at, |_| false);
        assert_eq!([0, 1, 2].map(of_view), [(vec![], 8), (vec![14, 15, 16, 17, 18], 8), (vec![11, 13, 15, 17], 8)]);
        assert_eq!(
            repeats.of_view(2, |frame| frame % 2 == 1),
            (vec![], 4),
            "taken again, since it is the nearest in time"
        );
        assert_eq!(noted(|_| vec![7; 3]).of_view(0, |_| false), (vec![], 0), "nothing goes on");
    }
}
