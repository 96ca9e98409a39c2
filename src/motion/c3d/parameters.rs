//! The parameter section: a chain of records, each a group or a named array in a group.

use std::collections::HashMap;

use anyhow::{Context, Result, bail, ensure};

use super::numbers::Processor;
use crate::files::shortened;

/// A named array. Its values stay in the file's bytes until asked for.
struct Parameter<'a> {
    /// -1 characters, 1 bytes, 2 integers, 4 reals: also the size of an element.
    kind: i8,
    dimensions: &'a [u8],
    data: &'a [u8],
}

/// All parameters of a file, by group and name (upper case).
pub(super) struct Parameters<'a> {
    processor: Processor,
    by_name: HashMap<(String, String), Parameter<'a>>,
}

impl<'a> Parameters<'a> {
    /// Follows the chain of records from byte `start` of the file. A record that would start at `end` or beyond closes
    /// the chain (there are files whose last offset has its bytes swapped). Of two records of one name the first
    /// counts.
    ///
    /// # Errors
    /// When a record reaches past the end of the file, points backwards, or has an unknown type; with its byte.
    pub(super) fn parse(file: &'a [u8], start: usize, end: usize, processor: Processor) -> Result<Self> {
        let mut groups: HashMap<i8, String> = HashMap::new();
        let mut found = Vec::new();
        let mut at = start;
        while at < end {
            let place = || format!("parameter record at byte {at}");
            let mut record = Cursor { file, at };
            // A file whose parameters fill their blocks to the last byte has no closing zero.
            let Ok([length, id]) = record.take::<2>() else { break };
            let (length, id) = (length.cast_signed(), id.cast_signed());
            if length == 0 || id == 0 {
                break;
            }
            // A negative length marks a locked parameter.
            let name = record.slice(usize::from(length.unsigned_abs())).with_context(place)?;
            let name = text(name).to_ascii_uppercase();
            let from = record.at;
            let offset = usize::from(processor.u16(record.take().with_context(place)?));
            if id < 0 {
                groups.entry(id.unsigned_abs().cast_signed()).or_insert(name);
            } else {
                let parameter =
                    parameter(&mut record).with_context(|| format!("{} `{}`", place(), shortened(&name)))?;
                found.push((id, name, parameter));
            }
            if offset == 0 {
                break;
            }
            ensure!(offset >= 2, "{}: points back into itself, expected the next record", place());
            at = from + offset;
        }
        let mut by_name = HashMap::new();
        for (id, name, parameter) in found {
            // Groups may stand behind their parameters, so names meet only now.
            let group = groups.get(&id).cloned().unwrap_or_default();
            by_name.entry((group, name)).or_insert(parameter);
        }
        Ok(Self { processor, by_name })
    }

    fn get(&self, group: &str, name: &str) -> Option<&Parameter<'a>> {
        self.by_name.get(&(group.to_string(), name.to_string()))
    }

    /// Element `index` of a numeric parameter. Integers are unsigned: counts beyond 32767 need the sixteenth bit.
    pub(super) fn number(&self, group: &str, name: &str, index: usize) -> Option<f64> {
        let parameter = self.get(group, name)?;
        let size = usize::from(parameter.kind.unsigned_abs());
        let bytes = parameter.data.get(index * size..(index + 1) * size)?;
        match (parameter.kind, bytes) {
            (1, &[a]) => Some(f64::from(a)),
            (2, &[a, b]) => Some(f64::from(self.processor.u16([a, b]))),
            (4, &[a, b, c, d]) => Some(f64::from(self.processor.f32([a, b, c, d]))),
            _ => None,
        }
    }

    /// A number that counts something.
    ///
    /// # Errors
    /// When it is negative, broken or not finite.
    pub(super) fn count(&self, group: &str, name: &str) -> Result<Option<usize>> {
        let Some(number) = self.number(group, name, 0) else { return Ok(None) };
        ensure!(
            (0.0..4e9).contains(&number) && number.fract() == 0.0,
            "{group}:{name} is {number}, expected a whole number from 0"
        );
        Ok(Some(number as usize))
    }

    /// A table of texts: `name`, and `name2`, `name3`, … behind it, since one parameter holds at most 255.
    pub(super) fn texts(&self, group: &str, name: &str) -> Vec<String> {
        let mut texts = Vec::new();
        for number in 1.. {
            let name = if number == 1 { name.to_string() } else { format!("{name}{number}") };
            let Some(parameter) = self.get(group, &name).filter(|p| p.kind == -1) else { break };
            match *parameter.dimensions {
                [] | [_] => texts.push(text(parameter.data)),
                // Rows without characters: nothing to divide the data by.
                [0, ..] => {}
                [length, ..] => texts.extend(parameter.data.chunks(usize::from(length)).map(text)),
            }
        }
        texts
    }
}

fn parameter<'a>(record: &mut Cursor<'a>) -> Result<Parameter<'a>> {
    let [kind, dimension_count] = record.take::<2>()?;
    let kind = kind.cast_signed();
    ensure!(matches!(kind, -1 | 1 | 2 | 4), "has the type {kind}, expected -1, 1, 2 or 4");
    let dimensions = record.slice(usize::from(dimension_count))?;
    let elements = dimensions.iter().fold(1usize, |product, &d| product.saturating_mul(usize::from(d)));
    let data = record.slice(elements.saturating_mul(usize::from(kind.unsigned_abs())))?;
    Ok(Parameter { kind, dimensions, data })
}

/// Text as files hold it: padded with blanks or zeros, in UTF-8 or, failing that, Latin-1.
fn text(bytes: &[u8]) -> String {
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.to_string(),
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
    };
    let text = text.trim_matches(|c: char| c.is_whitespace() || c == '\0');
    text.chars().map(|c| if c.is_control() { '_' } else { c }).collect()
}

/// A place in the file that never reads past its end.
struct Cursor<'a> {
    file: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    fn slice(&mut self, length: usize) -> Result<&'a [u8]> {
        let end = self.at.checked_add(length);
        let Some(bytes) = end.and_then(|end| self.file.get(self.at..end)) else {
            bail!("needs {length} bytes from byte {}, but the file holds {}", self.at, self.file.len());
        };
        self.at += length;
        Ok(bytes)
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N]> {
        let bytes = self.slice(N)?;
        let mut array = [0; N];
        array.copy_from_slice(bytes);
        Ok(array)
    }
}
