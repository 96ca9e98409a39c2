//! Colours of synthetic pictures.

use glam::DVec3;

/// Linear light or reflectance, red green blue.
pub(super) type Colour = DVec3;
