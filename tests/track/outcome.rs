//! The sequence that runs of the program track, and how such runs end.

use std::path::Path;
use std::process::Output;
use std::sync::OnceLock;

use tempfile::TempDir;

use super::walk;

/// The sequence, made once: six frames of pictures and masks, four cameras, 160x120.
pub fn sequence() -> &'static Path {
    static SEQUENCE: OnceLock<TempDir> = OnceLock::new();
    SEQUENCE
        .get_or_init(|| {
            let folder = tempfile::tempdir().unwrap();
            walk::write(folder.path());
            folder
        })
        .path()
}

/// Runs that must fail with status 1 and one sentence that holds `parts`.
#[track_caller]
pub fn refused(output: &Output, parts: &[&str]) {
    let text = stderr(output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    let sentence = text.lines().last().unwrap_or_default();
    assert!(sentence.starts_with("pantin: ") && !text.contains("panicked"), "{text}");
    for part in parts {
        assert!(sentence.contains(part), "`{sentence}` lacks `{part}`");
    }
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}
