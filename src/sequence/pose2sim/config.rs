//! Config.toml: what a level does not say, the folder above it does.

use std::path::{Path, PathBuf};

use anyhow::{Error, Result, anyhow, bail};
use toml::{Table, Value};

use crate::files::{read_toml, shortened};

/// A trial's and a session's file.
pub(super) const CONFIG: &str = "Config.toml";

/// What stands in gaps that are too long for a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LargeGaps {
    /// The last place before.
    LastValue,
    /// Nothing.
    Nan,
    /// The origin.
    Zeros,
}

/// The files of a trial, its own first.
pub(super) struct Config {
    levels: Vec<(PathBuf, Table)>,
}

impl Config {
    /// Reads the Config.toml of each folder, the deepest first.
    pub(super) fn read(folders: &[PathBuf]) -> Result<Self> {
        let levels = folders.iter().map(|folder| {
            let file = folder.join(CONFIG);
            Ok((file.clone(), read_toml(&file)?))
        });
        Ok(Self { levels: levels.collect::<Result<_>>()? })
    }

    /// The trial's own file.
    pub(super) fn file(&self) -> &Path {
        self.levels.first().map_or(Path::new(""), |(file, _)| file)
    }

    fn value(&self, table: &'static str, key: &'static str) -> Option<Found<'_>> {
        self.levels.iter().find_map(|(file, level)| {
            let value = level.get(table)?.get(key)?;
            Some(Found { file, table, key, value })
        })
    }

    /// Whether several people are to be followed.
    pub(super) fn multi_person(&self) -> Result<Option<&Path>> {
        let Some(found) = self.value("project", "multi_person") else { return Ok(None) };
        match found.value {
            Value::Boolean(true) => Ok(Some(found.file)),
            Value::Boolean(false) => Ok(None),
            _ => Err(found.refused("true or false")),
        }
    }

    /// The person's height, mm; `None` where it is to be found out.
    pub(super) fn height(&self) -> Result<Option<f64>> {
        let Some(found) = self.value("project", "participant_height") else { return Ok(None) };
        let expected = "'auto' or one person's height in metres, 0.5 to 2.5";
        let value = match found.value {
            Value::Array(heights) if heights.len() == 1 => &heights[0],
            value => value,
        };
        let metres = match value {
            Value::String(word) if word.eq_ignore_ascii_case("auto") => return Ok(None),
            value => number(value).ok_or_else(|| found.refused(expected))?,
        };
        match metres {
            0.0 => Ok(None),
            0.5..=2.5 => Ok(Some(metres * 1000.0)),
            _ => Err(found.refused(expected)),
        }
    }

    /// Frames a second; `None` where they are those of the videos.
    pub(super) fn frame_rate(&self) -> Result<Option<f64>> {
        let Some(found) = self.value("project", "frame_rate") else { return Ok(None) };
        match found.value {
            Value::String(word) if word.eq_ignore_ascii_case("auto") => Ok(None),
            value => {
                let rate = number(value).filter(|rate| *rate > 0.0 && rate.is_finite());
                rate.map(Some).ok_or_else(|| found.refused("'auto' or a positive number of frames a second"))
            }
        }
    }

    /// The first frame and the one after the last; `None` for all.
    pub(super) fn frame_range(&self) -> Result<Option<[usize; 2]>> {
        let Some(found) = self.value("project", "frame_range") else { return Ok(None) };
        let wrong = || found.refused("'auto', 'all' or [first, end] with whole numbers from 0");
        match found.value {
            Value::String(word) if ["auto", "all"].contains(&word.to_lowercase().as_str()) => Ok(None),
            Value::Array(sides) if sides.is_empty() => Ok(None),
            Value::Array(sides) => {
                let whole = |side: &Value| side.as_integer().and_then(|side| usize::try_from(side).ok());
                let sides: Option<Vec<usize>> = sides.iter().map(whole).collect();
                match sides.as_deref() {
                    Some(&[first, end]) if first < end => Ok(Some([first, end])),
                    _ => Err(wrong()),
                }
            }
            _ => Err(wrong()),
        }
    }

    /// The points that its kinematics will be told of, `Body_with_feet` where nobody says.
    pub(super) fn pose_model(&self) -> Result<String> {
        let Some(found) = self.value("pose", "pose_model") else { return Ok("Body_with_feet".to_string()) };
        Ok(found.value.as_str().ok_or_else(|| found.refused("the name of a model"))?.to_string())
    }

    /// The longest gap, frames, that a line bridges: none by `interpolation = 'none'`.
    pub(super) fn longest_line(&self) -> Result<usize> {
        if let Some(found) = self.value("triangulation", "interpolation") {
            let kind = found.value.as_str().ok_or_else(|| found.refused("'linear' or another kind, or 'none'"))?;
            if kind.eq_ignore_ascii_case("none") {
                return Ok(0);
            }
        }
        let Some(found) = self.value("triangulation", "interp_if_gap_smaller_than") else { return Ok(20) };
        let longest = found.value.as_integer().and_then(|frames| usize::try_from(frames).ok());
        longest.ok_or_else(|| found.refused("a whole number of frames from 0"))
    }

    /// What longer gaps hold.
    pub(super) fn large_gaps(&self) -> Result<LargeGaps> {
        let Some(found) = self.value("triangulation", "fill_large_gaps_with") else { return Ok(LargeGaps::LastValue) };
        match found.value.as_str() {
            Some("last_value") => Ok(LargeGaps::LastValue),
            Some("nan") => Ok(LargeGaps::Nan),
            Some("zeros") => Ok(LargeGaps::Zeros),
            _ => Err(found.refused("'last_value', 'nan' or 'zeros'")),
        }
    }

    /// Trials that a batch leaves out, by name or by path from the session's folder.
    pub(super) fn excluded(&self) -> Result<Vec<String>> {
        let Some(found) = self.value("project", "exclude_from_batch") else { return Ok(Vec::new()) };
        let Some(names) = found.value.as_array() else { return Err(found.refused("a list of trials")) };
        let name = |name: &Value| name.as_str().map(ToString::to_string);
        names.iter().map(name).collect::<Option<_>>().ok_or_else(|| found.refused("a list of trials' names"))
    }

    /// Refuses what is no project of one person.
    pub(super) fn check_people(&self) -> Result<()> {
        if let Some(file) = self.multi_person()? {
            bail!(
                "{}: project.multi_person is true, expected false: `pantin pose2sim` follows one person (several by a sequence.toml with \
                 [[person]])",
                file.display()
            );
        }
        Ok(())
    }
}

/// A value and where it stands.
struct Found<'a> {
    file: &'a Path,
    table: &'static str,
    key: &'static str,
    value: &'a Value,
}

impl Found<'_> {
    fn refused(&self, expected: &str) -> Error {
        let Self { file, table, key, value } = self;
        let found = match value {
            Value::String(text) => format!("'{}'", shortened(text)),
            value => shortened(&value.to_string()),
        };
        anyhow!("{}: {table}.{key} is {found}, expected {expected}", file.display())
    }
}

/// A number with or without a point.
fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}
