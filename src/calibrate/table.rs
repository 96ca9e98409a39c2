//! Tables with named columns in any order.

use anyhow::{Context, Result, bail, ensure};

use crate::files::shortened;
use crate::motion::finite;

/// One row, its cells in the order of the wanted columns.
pub(super) struct Row<'a> {
    /// The file and the line, for messages.
    pub(super) place: String,
    cells: Vec<&'a str>,
}

impl Row<'_> {
    /// The cell of a column, without blanks around it; empty for an optional column that the table has not.
    pub(super) fn text(&self, column: usize) -> &str {
        self.cells[column]
    }

    /// The number in a column, called `name`.
    pub(super) fn number(&self, column: usize, name: &str) -> Result<f64> {
        finite(self.cells[column]).with_context(|| format!("{}: column {name}", self.place))
    }
}

/// Hands every row of a CSV table to `each`. The header must hold all of `required` and may hold `optional`.
///
/// # Errors
/// One sentence with the file, the line, what was found and what was expected.
pub(super) fn each_row(
    text: &str,
    name: &str,
    required: &[&str],
    optional: &[&str],
    mut each: impl FnMut(&Row) -> Result<()>,
) -> Result<()> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut reader =
        csv::ReaderBuilder::new().has_headers(false).flexible(true).trim(csv::Trim::All).from_reader(text.as_bytes());
    let mut records = reader.records();
    let expected = || format!("the columns {}", required.join(", "));
    let header = records.next().transpose().with_context(|| name.to_string())?;
    let Some(header) = header else { bail!("{name} is empty, expected a table with {}", expected()) };
    let mut places = Vec::new();
    for wanted in required.iter().chain(optional) {
        let mut found = header.iter().enumerate().filter(|(_, column)| column.eq_ignore_ascii_case(wanted));
        let place = found.next().map(|(place, _)| place);
        ensure!(found.next().is_none(), "{name}, line 1: there are two columns `{wanted}`, expected one");
        ensure!(
            place.is_some() || optional.contains(wanted),
            "{name}, line 1: there is no column `{wanted}`, expected {}",
            expected()
        );
        places.push(place);
    }
    for (place, column) in header.iter().enumerate() {
        ensure!(
            places.contains(&Some(place)),
            "{name}, line 1: found the column `{}`, expected {} and nothing else{}",
            shortened(column),
            expected(),
            optional.iter().map(|column| format!(" but {column}")).collect::<String>()
        );
    }
    for record in records {
        let record = record.with_context(|| name.to_string())?;
        let place = format!("{name}, line {}", record.position().map_or(0, csv::Position::line));
        ensure!(
            record.len() == header.len(),
            "{place}: found {} cells, expected {} as in the header",
            record.len(),
            header.len()
        );
        let cells = places.iter().map(|column| column.map_or("", |column| &record[column])).collect();
        each(&Row { place, cells })?;
    }
    Ok(())
}
