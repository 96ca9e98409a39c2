//! What is known of a person's colours, in the form that makes evidence of likelihoods on a device (METHOD A12).

use std::sync::Arc;

use super::PartClasses;
use super::likelihood::ColourBin;

/// The log densities of all colours in the person and in each class of her parts, over the uniform one, in steps of 1 /
/// [`super::likelihood::LOG_STEPS`].
#[derive(Clone, Debug, PartialEq)]
pub struct ColourTables {
    classes: Arc<PartClasses>,
    values: Vec<i16>,
}

impl ColourTables {
    /// Takes the tables of cameras that see colours, and then those of cameras that see in grey: each of the whole person, and then of each
    /// class, [`ColourBin::COUNT`] values by a colour's index.
    pub(crate) fn new<'a>(classes: &Arc<PartClasses>, tables: impl IntoIterator<Item = &'a [i16]>) -> Self {
        let values: Vec<i16> = tables.into_iter().flatten().copied().collect();
        debug_assert_eq!(values.len(), 2 * Self::words(classes.count()), "a table is missing");
        Self { classes: Arc::clone(classes), values }
    }

    /// 32-bit words that the tables of so many classes fill.
    pub(crate) fn words(classes: usize) -> usize {
        // Two values a word, two kinds of cameras.
        (classes + 1) * ColourBin::COUNT
    }

    /// The classes.
    pub fn classes(&self) -> &Arc<PartClasses> {
        &self.classes
    }

    /// All values, in the order of [`Self::new`].
    pub(crate) fn values(&self) -> &[i16] {
        &self.values
    }
}
