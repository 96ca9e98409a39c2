//! What a BVH written here says of its numbers. The format has no place for a unit, for axes or for the number of the first frame,
//! and most programs refuse a comment wherever it stands. All of them pass over blanks, so it is said in a last line of nothing but
//! blanks: the text `pantin up=y unit=cm first=0`, eight blanks a byte, the highest bit first, a tab for 1 and a space for 0.

use super::super::number::whole;
use super::super::points::millimetres_in;

/// That y is up (x left, z forward), and what the file's numbers are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BvhStatement {
    /// Length of the file's unit, mm: 1, 10 or 1000.
    pub millimetres: f64,
    /// The frame of the first row, counted from 0.
    pub first_frame: usize,
}

/// Units that can be said.
const UNITS: [(&str, f64); 3] = [("mm", 1.0), ("cm", 10.0), ("m", 1000.0)];

impl BvhStatement {
    /// The last line that says it; none where the unit has no name.
    pub(super) fn line(self) -> Option<String> {
        let (unit, _) = UNITS.into_iter().find(|(_, length)| *length == self.millimetres)?;
        let text = format!("pantin up=y unit={unit} first={}", self.first_frame);
        let blank = |byte: u8, bit: u8| if byte >> (7 - bit) & 1 == 1 { '\t' } else { ' ' };
        Some(text.bytes().flat_map(|byte| (0..8).map(move |bit| blank(byte, bit))).collect())
    }

    /// What the end of a file says; none where it says nothing.
    pub(super) fn find(text: &str) -> Option<Self> {
        // The longest statement is far shorter; files may end in megabytes of blanks.
        const LONGEST: usize = 8 * 64;
        let line = text.lines().rev().take(3).find(|line| !line.is_empty())?;
        if line.len() > LONGEST
            || !line.len().is_multiple_of(8)
            || !line.bytes().all(|blank| matches!(blank, b' ' | b'\t'))
        {
            return None;
        }
        let byte = |bits: &[u8]| bits.iter().fold(0, |byte: u8, blank| byte << 1 | u8::from(*blank == b'\t'));
        let said: Vec<u8> = line.as_bytes().chunks_exact(8).map(byte).collect();
        let said = std::str::from_utf8(&said).ok()?;
        let (unit, first) = said.strip_prefix("pantin up=y unit=")?.split_once(" first=")?;
        Some(Self { millimetres: millimetres_in(unit).ok()?, first_frame: whole(first).ok()? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_is_found_again_and_nothing_else_is() {
        for (_, millimetres) in UNITS {
            let statement = BvhStatement { millimetres, first_frame: 1234 };
            let line = statement.line().unwrap();
            assert!(line.trim().is_empty() && !line.contains('\n'));
            for end in ["", "\n", "\r\n", "\n\n"] {
                assert_eq!(BvhStatement::find(&format!("1 2 3\n{line}{end}")), Some(statement));
            }
            assert_eq!(BvhStatement::find(&format!("{line}\n1 2 3\n")), None, "it is the end that says it");
            assert_eq!(BvhStatement::find(&format!("1 2 3\n{}\n", &line[8..])), None);
        }
        for silent in ["", "\n", "1 2 3\n", "1 2 3\n        \n", "1\n\t \n", "é\n"] {
            assert_eq!(BvhStatement::find(silent), None, "{silent:?}");
        }
        assert_eq!(BvhStatement { millimetres: 25.4, first_frame: 0 }.line(), None);
    }
}
