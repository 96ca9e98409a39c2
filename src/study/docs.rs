//! Tables of a study in a document: written there by a command from the rows, never by hand.

use std::path::Path;

use anyhow::{Context, Result, ensure};

use super::outcome::Row;
use super::runner::write_pictures;
use super::runs_csv::read_rows;
use super::settings::{Study, TableSettings};
use super::tables::{self, Table};
use crate::files::{Limit, OutputFolder, Overwrite, write_atomically};

const DOCUMENT: Limit = Limit { what: "a document", most: 16 << 20 };
/// What ends a table in a document.
const END: &str = "<!-- end of study -->";

/// Writes the study's tables of runs.csv and stages.csv in `folder` into a Markdown file, each between the marks
/// `<!-- study: NAME TABLE -->` and `<!-- end of study -->`, and the plots that the file shows beside the rows. Gives the number of tables.
///
/// # Errors
/// When rows or document cannot be read, no table of the study has a mark in it, or a table with a mark would be empty: times without
/// stages.csv, say.
pub fn write_docs(study: &Study, folder: &OutputFolder, document: &Path) -> Result<usize> {
    let rows = read_rows(folder.path())?;
    let text = DOCUMENT.read_text(document)?;
    let (text, count) = with_tables(study, &text, |settings| body(settings, &rows, folder.path()))
        .with_context(|| document.display().to_string())?;
    write_atomically(document, Overwrite::Replace, |out| Ok(out.write_all(text.as_bytes())?))?;
    write_pictures(study, &rows, folder, |file| text.contains(file))?;
    Ok(count)
}

/// A table of the rows in a folder, which must say something.
fn body(settings: &TableSettings, rows: &[Row], folder: &Path) -> Result<String> {
    let table = Table::new(settings, rows);
    ensure!(
        !table.is_empty(),
        "table \"{}\": no run in {} has its value ({}){}",
        settings.name,
        folder.join("runs.csv").display(),
        settings.value.heading(),
        if folder.join("stages.csv").exists() { "" } else { "; times are in stages.csv, which is not there" }
    );
    Ok(table.body())
}

/// A document with the study's tables put between their marks, and how many there were.
fn with_tables(study: &Study, text: &str, table: impl Fn(&TableSettings) -> Result<String>) -> Result<(String, usize)> {
    let (mut text, mut count) = (text.to_string(), 0);
    let mut marks = Vec::new();
    for settings in tables::settings(study) {
        let mark = format!("<!-- study: {} {} -->", study.name, settings.name);
        if let Some(begin) = text.find(&mark) {
            let begin = begin + mark.len();
            let end = text[begin..].find(END).with_context(|| format!("`{mark}` has no `{END}` behind it"))?;
            text.replace_range(begin..begin + end, &format!("\n\n{}\n", table(&settings)?));
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
        let (text, count) = with_tables(&study, text, |settings| Ok(format!("| {} |\n", settings.name))).unwrap();
        assert_eq!(count, 1);
        assert_eq!(text, "before\n<!-- study: s rate -->\n\n| rate |\n\n<!-- end of study -->\nafter\n");
        let refused = |text: &str| with_tables(&study, text, |_| Ok(String::new())).unwrap_err().to_string();
        assert!(refused("nothing").contains("expected <!-- study: s error --> or <!-- study: s rate -->"));
        assert!(refused("<!-- study: s rate --> no end").contains("has no `<!-- end of study -->`"));
    }

    /// Times of rows without their stages are a sentence, not a table of dashes.
    #[test]
    fn a_table_without_a_value_is_refused() {
        let text = "name = \"s\"\nseeds = [1]\n[[sequence]]\npreset = \"demo\"\n[[table]]\nname = \"times\"\nvalue = \
                    \"search_time\"\nrows = [\"particles\"]\ncolumns = []\n";
        let study = Study::parse(text, "s").unwrap();
        let folder = tempfile::tempdir().unwrap();
        let output = OutputFolder::open(folder.path()).unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        write("doc.md", "<!-- study: s times --><!-- end of study -->");
        let settings = "sequence,backend,model,objective,search,particles,iterations,seed";
        write("runs.csv", &format!("{settings},frames\ndemo,cpu,flat,sp,pso,100,10,1,5\n"));
        let document = folder.path().join("doc.md");
        let error = format!("{:#}", write_docs(&study, &output, &document).unwrap_err());
        assert!(error.contains("table \"times\"") && error.contains("stages.csv, which is not there"), "{error}");
        write("stages.csv", &format!("{settings},stage,ms\ndemo,cpu,flat,sp,pso,100,10,1,search,12.5\n"));
        assert_eq!(write_docs(&study, &output, &document).unwrap(), 1);
        assert!(std::fs::read_to_string(&document).unwrap().contains("| 100 | 12.5 |"));
        // Of the study's plots the one that is shown.
        let is_there = |name: &str| folder.path().join(name).exists();
        assert!(!is_there("plot-error.svg") && !is_there("plot-rate.svg"));
        write("doc.md", "<!-- study: s times --><!-- end of study -->\n![Errors](results/plot-error.svg)\n");
        write_docs(&study, &output, &document).unwrap();
        assert!(is_there("plot-error.svg") && !is_there("plot-rate.svg"));
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
            let (again, count) = with_tables(&study, &document, |settings| body(settings, &rows, &folder)).unwrap();
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
