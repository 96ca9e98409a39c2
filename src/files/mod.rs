//! Files and names as users meet them: TOML read with errors that name file, line, key and the nearest known key; lists of
//! choices declared once, with one sentence for a name that is none of them; results written to a temporary name and renamed,
//! never over an existing file unless asked.

mod beside;
mod choice;
mod exact;
mod input;
mod listed;
mod output;
mod shortened;
mod stem;
mod toml_file;

pub(crate) use beside::{beside, seen_from};
pub(crate) use choice::choices;
pub use choice::{Choice, ChoiceParser, deserialize as deserialize_choice, expected, names, nearest, unknown};
pub use exact::{exactly, exactly_if_any};
pub use input::{Limit, check_regular};
pub use listed::listed;
pub(crate) use output::png_name;
pub use output::{Occupied, OutputFolder, Overwrite, write_atomically};
pub use shortened::{one_line, shortened};
pub use stem::file_stem;
pub use toml_file::{parse_table, parse_toml, read_toml, table_of};

/// The formats of pictures that are read.
pub const PICTURE_FORMATS: &str = "PNG, JPEG, GIF, TIFF, WebP and BMP";

/// How the names of their files end, in small letters.
pub const PICTURE_ENDINGS: [&str; 8] = ["png", "jpg", "jpeg", "tif", "tiff", "bmp", "webp", "gif"];
