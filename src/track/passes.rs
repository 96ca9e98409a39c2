//! How often a run goes over its frames.

use crate::files::choices;

choices! {
    /// How often a run goes over its frames.
    "passes" pub enum Passes {
        /// Once, one frame after the other.
        "forward" Forward,
        /// Once so, then again with what comes after each frame known too.
        "both" Both,
    }
}
