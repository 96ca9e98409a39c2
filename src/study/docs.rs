//! Tables of a study in a document: written there by a command from the rows, never by hand.

use std::path::Path;

use anyhow::{Context, Result, ensure};

use super::runner::write_pictures;
use super::runs_csv::read_rows;
use super::settings::Study;
use super::tables::{self, Table};
use crate::files::{Limit, OutputFolder, Overwrite, write_atomically};

const DOCUMENT: Limit = Limit { what: "a document", most: 16 << 20 };
/// What ends a table in a document.
const END: &str = "<!-- end of study -->";

/// Writes the study's tables of runs.csv and stages.csv in `folder` into a Markdown file, each between the marks
/// `<!-- study: NAME TABLE -->` and `<!-- end of study -->`, and its plots beside the rows. Gives the number of tables.
///
/// # Errors
/// When rows or document cannot be read, or no table of the study has a mark in it.
pub fn write_docs(study: &Study, folder: &OutputFolder, document: &Path) -> Result<usize> {
    let rows = read_rows(folder.path())?;
    let text = DOCUMENT.read_text(document)?;
    let (text, count) = with_tables(study, &text, |settings| Table::new(settings, &rows).body())
        .with_context(|| document.display().to_string())?;
    write_atomically(document, Overwrite::Replace, |out| Ok(out.write_all(text.as_bytes())?))?;
    write_pictures(study, &rows, folder)?;
    Ok(count)
}

/// A document with the study's tables put between their marks, and how many there were.
fn with_tables(study: &Study, text: &str, table: impl Fn(&super::TableSettings) -> String) -> Result<(String, usize)> {
    let (mut text, mut count) = (text.to_string(), 0);
    let mut marks = Vec::new();
    for settings in tables::settings(study) {
        let mark = format!("<!-- study: {} {} -->", study.name, settings.name);
        if let Some(begin) = text.find(&mark) {
            let begin = begin + mark.len();
            let end = text[begin..].find(END).with_context(|| format!("`{mark}` has no `{END}` behind it"))?;
            text.replace_range(begin..begin + end, &format!("\n\n{}\n", table(&settings)));
            count += 1;
        }
        marks.push(mark);
    }
    ensure!(count > 0, "it has none of the marks of this study's tables, expected {}", marks.join(" or "));
    Ok((text, count))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]
mod tests {
    use super::*;

    const STUDY: &str = "name = \"s\"\nseeds = [1]\n[[sequence]]\npreset = \"demo\"\n";

    #[test]
    fn tables_stand_between_their_marks() {
        let study = Study::parse(STUDY, "s").unwrap();
        let text = "before\n<!-- study: s rate -->old<!-- end of study -->\nafter\n";
        let (text, count) = with_tables(&study, text, |settings| format!("| {} |\n", settings.name)).unwrap();
        assert_eq!(count, 1);
        assert_eq!(text, "before\n<!-- study: s rate -->\n\n| rate |\n\n<!-- end of study -->\nafter\n");
        let refused = |text: &str| with_tables(&study, text, |_| String::new()).unwrap_err().to_string();
        assert!(refused("nothing").contains("expected <!-- study: s error --> or <!-- study: s rate -->"));
        assert!(refused("<!-- study: s rate --> no end").contains("has no `<!-- end of study -->`"));
    }

    /// What the documents say is what the rows beside the studies say: nobody wrote it by hand.
    #[test]
    fn documented_tables_are_those_of_the_rows() {
        let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
        let document = std::fs::read_to_string(docs.join("STUDIES.md")).unwrap();
        let mut tables = 0;
        for entry in std::fs::read_dir(docs.join("studies/results")).unwrap() {
            let folder = entry.unwrap().path();
            // Beside the folders of studies stand the numbers of a bench.
            if !folder.is_dir() {
                continue;
            }
            let name = folder.file_name().unwrap().to_string_lossy().into_owned();
            let study = Study::load(&docs.join(format!("studies/{name}.toml"))).unwrap();
            let rows = read_rows(&folder).unwrap();
            let (again, count) = with_tables(&study, &document, |settings| Table::new(settings, &rows).body()).unwrap();
            assert!(
                again == document,
                "{name}: `pantin study docs/studies/{name}.toml -o {} --docs docs/STUDIES.md`",
                folder.display()
            );
            tables += count;
        }
        assert!(tables > 0, "no table is made from rows");
    }
}
