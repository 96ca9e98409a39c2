//! The light of a view's picture as the host tells a device of it.

use anyhow::Result;

use crate::features::likelihood::{LightTables, SHADOWS, WidthTables, Widths};
use crate::features::shaders::layout;
use crate::gpu::{Buffer, Device, Memory};

/// The host's end of a picture's light.
#[derive(Debug)]
pub(super) struct LightInput {
    pub(super) staging: Buffer,
    /// What is written there.
    table: Box<layout::LightTable>,
    tables: Option<WidthTables>,
}

impl LightInput {
    pub(super) fn new(device: &Device) -> Result<Self> {
        let mut table: Box<layout::LightTable> = bytemuck::zeroed_box();
        let shadows = &*SHADOWS;
        table.outlier = shadows.falls.outlier;
        (table.range, table.logs, table.falls) = (shadows.falls.range, shadows.falls.logs, shadows.falls.falls);
        (table.assumed, table.believed) = (shadows.assumed, shadows.believed);
        table.from.copy_from_slice(&shadows.from);
        let staging = device.buffer::<layout::LightTable>("light staging", 1, Memory::Upload)?;
        Ok(Self { staging, table, tables: None })
    }

    /// Takes a picture's light.
    pub(super) fn take(&mut self, light: &LightTables) -> Result<()> {
        let table = &mut *self.table;
        let row = |widths: &Widths| layout::Widths { y: widths.y, c: widths.c, lit: widths.lit, shadow: widths.shadow };
        table.dim = light.dim;
        table.counting.iter_mut().zip(&light.counting).for_each(|(to, from)| *to = row(from));
        if light.update(&mut self.tables) {
            let rows = self.tables.iter().flat_map(|tables| tables.of_steps.iter().flatten());
            table.judging.iter_mut().zip(rows).for_each(|(to, from)| *to = row(from));
        }
        self.staging.write(0, std::slice::from_ref(table))
    }
}
