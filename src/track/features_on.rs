//! Who makes the features of a run, by name.

use crate::files::choices;

choices! {
    /// Who makes the features, to the same bits, as `--features` names it.
    #[derive(Default)]
    "maker of features" pub enum FeaturesOn {
        /// The device that poses are scored on, where it is one device, no part of the processor, and can hold what is compared (the default).
        "auto" #[default] Auto,
        /// The processor.
        "cpu" Cpu,
        /// The device that poses are scored on; an error where it cannot.
        "device" Device,
    }
}
