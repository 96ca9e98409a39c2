//! Recordings as files: read whole, told apart by their extensions.

use std::path::Path;

use anyhow::{Result, anyhow};

use crate::files::Limit;

/// A recording is held in memory whole, several times its size in the file; a larger file is a mistake (a video, say).
const RECORDING: Limit = Limit { what: "a recording of motion", most: 2 << 30 };

/// A file's extension in lower case.
pub(super) fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

/// The bytes of a file.
pub(super) fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    RECORDING.read(path)
}

/// The text that they are.
pub(super) fn text<'a>(bytes: &'a [u8], name: &str) -> Result<&'a str> {
    std::str::from_utf8(bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count() + 1;
        anyhow!("{name}, line {line}: byte {} is not UTF-8, expected a text file", error.valid_up_to())
    })
}
