//! Files as users meet them: TOML read with errors that name file, line, key and the nearest known key; results
//! written to a temporary name and renamed, never over an existing file unless asked.

mod output;
mod shortened;
mod toml_file;

pub use output::{OutputFolder, Overwrite, write_atomically};
pub use shortened::shortened;
pub use toml_file::{parse_table, parse_toml, read_toml};
