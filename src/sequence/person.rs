//! The people of a sequence that tracks several of them.

use std::path::PathBuf;

use anyhow::{Result, bail};
use serde::Deserialize;

use super::named_files::NamedFiles;

/// One of several people who are tracked together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Person {
    /// Her name, and that of the folder of her results.
    pub name: String,
    /// Her body file.
    pub body: PathBuf,
    /// A poses.csv with her first pose.
    pub start: PathBuf,
    /// Her reference motion.
    pub truth: Option<PathBuf>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PersonTable {
    name: String,
    body: PathBuf,
    start: PathBuf,
    truth: Option<PathBuf>,
}

impl PersonTable {
    /// The person with the files of the manifest.
    ///
    /// # Errors
    /// When one of them is missing.
    pub(super) fn open(&self, files: NamedFiles<'_>) -> Result<Person> {
        let key = |part: &str| format!("the {part} of person {:?}", self.name);
        Ok(Person {
            name: self.name.clone(),
            body: files.existing(&key("body"), &self.body)?,
            start: files.existing(&key("start"), &self.start)?,
            truth: self.truth.as_deref().map(|truth| files.existing(&key("truth"), truth)).transpose()?,
        })
    }
}

/// Checks the names of people, each of which becomes a folder; `manifest` stands for the file in messages.
///
/// # Errors
/// When one is no name of a folder, or two are the same.
pub(super) fn check_names(people: &[PersonTable], manifest: &str) -> Result<()> {
    for (index, PersonTable { name, .. }) in people.iter().enumerate() {
        let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | ' ' | '.');
        if name.trim() != name
            || name.is_empty()
            || name.len() > 100
            || name.starts_with('.')
            || !name.chars().all(is_plain)
        {
            bail!(
                "{manifest}: the name of person {} is {name:?}, expected a name that a folder may have: letters, digits, \
                 spaces inside, _ - and no leading .",
                index + 1
            );
        }
        // Folders of some systems do not tell capitals apart.
        if people[..index].iter().any(|earlier| earlier.name.to_lowercase() == name.to_lowercase()) {
            bail!(
                "{manifest}: two people are called {name:?}, expected a name of each one's own for the folder of the results"
            );
        }
    }
    Ok(())
}
