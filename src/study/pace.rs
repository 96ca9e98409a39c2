//! How a run keeps time.

use crate::files::choices;

choices! {
    /// How a run keeps time with the pictures.
    #[derive(Default)]
    "pace" pub enum Pace {
        /// every frame gets its whole search, however long it takes (the default)
        "offline" #[default] Offline,
        /// pictures come at the sequence's rate, and what comes too fast is passed over (METHOD A11)
        "realtime" Realtime,
    }
}

impl Pace {
    pub(super) fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}
