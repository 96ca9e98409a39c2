//! Units of length as files and command lines name them.

use crate::files::choices;

choices! {
    /// The unit of a file's lengths.
    #[derive(Default)]
    "unit" pub enum LengthUnit => pub mm: f64 {
        /// Millimetres.
        "mm" #[default] Millimetre => 1.0,
        /// Centimetres.
        "cm" Centimetre => 10.0,
        /// Metres.
        "m" Metre => 1000.0,
    }
}
