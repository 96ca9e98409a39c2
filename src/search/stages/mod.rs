//! The search's work on a device, stage by stage. A stage is one file here beside one shader of the same name under
//! `glsl/search/`; the name is its debug label and its row of timings too.

mod best;
mod layer;
mod r#move;
mod propagate;
mod scatter;
mod spread;
mod weigh;

#[allow(clippy::unreadable_literal, clippy::large_stack_arrays, reason = "written by the build")]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/search_stages.rs"));
}

pub(super) use best::BestStage;
pub(super) use generated::{ANNEAL_LANES, HALVINGS, LEAST_SHARPNESS, MOST_SHARPNESS};
pub(super) use generated::{
    best_comp, layer_comp, layout, move_comp, propagate_comp, scatter_comp, spread_comp, weigh_comp,
};
pub(super) use layer::LayerStage;
pub(super) use r#move::{MoveStage, Pull};
pub(super) use propagate::PropagateStage;
pub(super) use scatter::ScatterStage;
pub(super) use spread::SpreadStage;
pub(super) use weigh::WeighStage;

use crate::gpu::{Device, Groups};
use generated::{HALVINGS_AT_ONCE, LOOK_GROUP, SEARCH_GROUP};

/// Dimensions that eight blocks of random numbers serve.
const DIMENSIONS: u32 = 32;
/// Blocks of random numbers that serve them.
const BLOCKS: u32 = 8;

// `weigh.comp` goes down the tree of its halvings in whole rounds, each of which a workgroup has room for.
const _: () =
    assert!(HALVINGS.is_multiple_of(HALVINGS_AT_ONCE) && (1 << HALVINGS_AT_ONCE) * ANNEAL_LANES <= LOOK_GROUP);

/// How many candidates of how many values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Extent {
    pub(super) candidates: u32,
    pub(super) dofs: u32,
}

impl Extent {
    /// Workgroups for one invocation a block of random numbers of every candidate: as many candidates in x as the device
    /// allows and stacked in z, the dimensions in y.
    fn block_groups(self, device: &Device) -> Groups<'static> {
        let groups = self.candidates.div_ceil(SEARCH_GROUP / BLOCKS).max(1);
        let row = groups.min(device.capabilities().max_groups);
        Groups::Count([row, self.dofs.div_ceil(DIMENSIONS), groups.div_ceil(row)])
    }
}
