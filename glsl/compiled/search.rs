/// Invocations of a workgroup where every invocation has a block of random numbers.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const SEARCH_GROUP: u32 = 64;
/// Invocations of the one workgroup that looks over all candidates.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LOOK_GROUP: u32 = 256;
/// Most samples, and most degrees of freedom, of a generation that is scored and learnt from in one stage: it keeps something of each in
/// shared memory.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LEARN_SAMPLES: u32 = 256;
/// `LEARN_DOFS` of `search/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LEARN_DOFS: u32 = 256;
/// Running sums of a mean; also the invocations of a workgroup of `spread`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const SUM_LANES: u32 = 64;
/// How the sharpness of an annealed filter is found: bit patterns of the least and the greatest one, 2^-10 and 2^24, how often
/// what lies between them is halved, running sums of the shares that a sharpness leaves, and how many halvings one workgroup
/// looks into at once: their tree, less than 2^5 times as many sums, is a workgroup.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LEAST_SHARPNESS: u32 = 981467136;
/// `MOST_SHARPNESS` of `search/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MOST_SHARPNESS: u32 = 1266679808;
/// `HALVINGS` of `search/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const HALVINGS: u32 = 20;
/// `ANNEAL_LANES` of `search/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const ANNEAL_LANES: u32 = 8;
/// `HALVINGS_AT_ONCE` of `search/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const HALVINGS_AT_ONCE: u32 = 5;
/// Bit patterns of the least and the greatest step size of an evolution, 1e-6 and 1e6 of the frame's spread.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LEAST_SIGMA: u32 = 897988541;
/// `MOST_SIGMA` of `search/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MOST_SIGMA: u32 = 1232348160;
/// The stage `search/advance.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod advance_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/advance.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<3306, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/advance.comp.spv"))),
        workgroup_size: [256, 1, 1],
        push_size: 60,
        bindings: &[
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Fitness", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "frame", set: 1, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 1, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Poses", set: 1, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Positions", set: 1, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Velocities", set: 1, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Best", set: 1, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Own", set: 1, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "History", set: 1, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "BestSums", set: 1, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Lead", set: 1, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Advance;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `AllSums`, read; set 0, binding 1.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Fitness`, read; set 0, binding 2.
        pub fitness: &'a crate::gpu::Buffer,
        /// Storage buffer `Frame`, read; set 1, binding 0.
        pub frame: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, written; set 1, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Poses`, written; set 1, binding 2.
        pub poses: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, read and written; set 1, binding 3.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `Velocities`, read and written; set 1, binding 4.
        pub velocities: &'a crate::gpu::Buffer,
        /// Storage buffer `Best`, read and written; set 1, binding 5.
        pub best: &'a crate::gpu::Buffer,
        /// Storage buffer `Own`, read and written; set 1, binding 6.
        pub own: &'a crate::gpu::Buffer,
        /// Storage buffer `History`, written; set 1, binding 7.
        pub history: &'a crate::gpu::Buffer,
        /// Storage buffer `BestSums`, written; set 1, binding 8.
        pub best_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Lead`, read and written; set 1, binding 9.
        pub lead: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 12] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.fitness) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.frame) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.poses) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.velocities) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.best) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.own) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.history) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.best_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[11], bound: crate::gpu::Bound::Buffer(self.lead) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/advance_evidence.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod advance_evidence_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/advance_evidence.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<13323, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/advance_evidence.comp.spv"))),
        workgroup_size: [256, 1, 1],
        push_size: 60,
        bindings: &[
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllEvidence", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "frame", set: 1, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 1, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Poses", set: 1, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Positions", set: 1, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Velocities", set: 1, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Best", set: 1, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Own", set: 1, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "History", set: 1, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "BestSums", set: 1, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Lead", set: 1, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Advance;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `AllSums`, read; set 0, binding 1.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidenceTable`, read; set 0, binding 3.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `AllEvidence`, read; set 0, binding 4.
        pub all_evidence: &'a crate::gpu::Buffer,
        /// Storage buffer `Frame`, read; set 1, binding 0.
        pub frame: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, written; set 1, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Poses`, written; set 1, binding 2.
        pub poses: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, read and written; set 1, binding 3.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `Velocities`, read and written; set 1, binding 4.
        pub velocities: &'a crate::gpu::Buffer,
        /// Storage buffer `Best`, read and written; set 1, binding 5.
        pub best: &'a crate::gpu::Buffer,
        /// Storage buffer `Own`, read and written; set 1, binding 6.
        pub own: &'a crate::gpu::Buffer,
        /// Storage buffer `History`, written; set 1, binding 7.
        pub history: &'a crate::gpu::Buffer,
        /// Storage buffer `BestSums`, written; set 1, binding 8.
        pub best_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Lead`, read and written; set 1, binding 9.
        pub lead: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 13] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_evidence) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.frame) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.poses) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.velocities) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.best) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.own) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.history) },
                crate::gpu::Binding { layout: &SHADER.bindings[11], bound: crate::gpu::Bound::Buffer(self.best_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[12], bound: crate::gpu::Bound::Buffer(self.lead) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/advance_objective.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod advance_objective_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/advance_objective.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<14182, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/advance_objective.comp.spv"))),
        workgroup_size: [256, 1, 1],
        push_size: 60,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "frame", set: 1, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 1, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Poses", set: 1, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Positions", set: 1, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Velocities", set: 1, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Best", set: 1, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Own", set: 1, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "History", set: 1, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "BestSums", set: 1, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Lead", set: 1, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Advance;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read; set 0, binding 1.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Frame`, read; set 1, binding 0.
        pub frame: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, written; set 1, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Poses`, written; set 1, binding 2.
        pub poses: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, read and written; set 1, binding 3.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `Velocities`, read and written; set 1, binding 4.
        pub velocities: &'a crate::gpu::Buffer,
        /// Storage buffer `Best`, read and written; set 1, binding 5.
        pub best: &'a crate::gpu::Buffer,
        /// Storage buffer `Own`, read and written; set 1, binding 6.
        pub own: &'a crate::gpu::Buffer,
        /// Storage buffer `History`, written; set 1, binding 7.
        pub history: &'a crate::gpu::Buffer,
        /// Storage buffer `BestSums`, written; set 1, binding 8.
        pub best_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Lead`, read and written; set 1, binding 9.
        pub lead: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 12] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.frame) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.poses) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.velocities) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.best) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.own) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.history) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.best_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[11], bound: crate::gpu::Bound::Buffer(self.lead) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/advance_segments.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod advance_segments_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/advance_segments.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<16043, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/advance_segments.comp.spv"))),
        workgroup_size: [256, 1, 1],
        push_size: 60,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSegmentSums", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "frame", set: 1, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 1, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Poses", set: 1, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Positions", set: 1, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Velocities", set: 1, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Best", set: 1, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Own", set: 1, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "History", set: 1, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "BestSums", set: 1, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Lead", set: 1, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "SEGMENT_EDGES", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `SEGMENT_EDGES`, false by default.
        pub segment_edges: bool,
    }
    impl Default for Constants {
        fn default() -> Self { Self { segment_edges: false, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, u32::from(constants.segment_edges)), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Advance;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read; set 0, binding 1.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `SegmentTable`, read; set 0, binding 3.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSegmentSums`, read; set 0, binding 4.
        pub all_segment_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Frame`, read; set 1, binding 0.
        pub frame: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, written; set 1, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Poses`, written; set 1, binding 2.
        pub poses: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, read and written; set 1, binding 3.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `Velocities`, read and written; set 1, binding 4.
        pub velocities: &'a crate::gpu::Buffer,
        /// Storage buffer `Best`, read and written; set 1, binding 5.
        pub best: &'a crate::gpu::Buffer,
        /// Storage buffer `Own`, read and written; set 1, binding 6.
        pub own: &'a crate::gpu::Buffer,
        /// Storage buffer `History`, written; set 1, binding 7.
        pub history: &'a crate::gpu::Buffer,
        /// Storage buffer `BestSums`, written; set 1, binding 8.
        pub best_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Lead`, read and written; set 1, binding 9.
        pub lead: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 14] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.all_segment_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.frame) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.poses) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.velocities) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.best) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.own) },
                crate::gpu::Binding { layout: &SHADER.bindings[11], bound: crate::gpu::Bound::Buffer(self.history) },
                crate::gpu::Binding { layout: &SHADER.bindings[12], bound: crate::gpu::Bound::Buffer(self.best_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[13], bound: crate::gpu::Bound::Buffer(self.lead) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, constants: Constants, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(constants), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/begin.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod begin_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/begin.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<888, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/begin.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 8,
        bindings: &[
            crate::gpu::BindingLayout { name: "frame", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "evolution", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Matrix", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::BeginPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Frame`, read; set 0, binding 0.
        pub frame: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, written; set 0, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Evolution`, written; set 0, binding 2.
        pub evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `Matrix`, written; set 0, binding 3.
        pub matrix: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.frame) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.matrix) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/best.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod best_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/best.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1355, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/best.comp.spv"))),
        workgroup_size: [256, 1, 1],
        push_size: 20,
        bindings: &[
            crate::gpu::BindingLayout { name: "Fitness", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Positions", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Own", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "History", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Sums", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "BestSums", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::BestPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Fitness`, read; set 0, binding 0.
        pub fitness: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, read and written; set 0, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, read; set 0, binding 2.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `Own`, read and written; set 0, binding 3.
        pub own: &'a crate::gpu::Buffer,
        /// Storage buffer `History`, written; set 0, binding 4.
        pub history: &'a crate::gpu::Buffer,
        /// Storage buffer `Sums`, read; set 0, binding 5.
        pub sums: &'a crate::gpu::Buffer,
        /// Storage buffer `BestSums`, written; set 0, binding 6.
        pub best_sums: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 7] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.fitness) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.own) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.history) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.best_sums) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/choose.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod choose_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/choose.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<723, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/choose.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 8,
        bindings: &[
            crate::gpu::BindingLayout { name: "Fitness", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Sums", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "BestSums", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::ChoosePush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Fitness`, read; set 0, binding 0.
        pub fitness: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, read and written; set 0, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Sums`, read; set 0, binding 2.
        pub sums: &'a crate::gpu::Buffer,
        /// Storage buffer `BestSums`, written; set 0, binding 3.
        pub best_sums: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.fitness) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.best_sums) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/follow.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod follow_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/follow.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2641, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/follow.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 28,
        bindings: &[
            crate::gpu::BindingLayout { name: "outcome", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "evolution", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Fitness", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Weights", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Normals", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Steps", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Positions", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Sums", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "BestSums", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::FollowPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Outcome`, read and written; set 0, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Evolution`, read and written; set 0, binding 2.
        pub evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `Fitness`, read; set 0, binding 3.
        pub fitness: &'a crate::gpu::Buffer,
        /// Storage buffer `Weights`, read; set 0, binding 4.
        pub weights: &'a crate::gpu::Buffer,
        /// Storage buffer `Normals`, read; set 0, binding 5.
        pub normals: &'a crate::gpu::Buffer,
        /// Storage buffer `Steps`, read; set 0, binding 6.
        pub steps: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, read; set 0, binding 7.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `Sums`, read; set 0, binding 8.
        pub sums: &'a crate::gpu::Buffer,
        /// Storage buffer `BestSums`, written; set 0, binding 9.
        pub best_sums: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 9] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.fitness) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.weights) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.normals) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.steps) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.best_sums) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/layer.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod layer_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/layer.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<3739, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/layer.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 16,
        bindings: &[
            crate::gpu::BindingLayout { name: "frame", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Previous", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cumulated", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Positions", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::LayerPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Frame`, read; set 0, binding 0.
        pub frame: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, read; set 0, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Previous`, read; set 0, binding 2.
        pub previous: &'a crate::gpu::Buffer,
        /// Storage buffer `Cumulated`, read; set 0, binding 3.
        pub cumulated: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, written; set 0, binding 4.
        pub positions: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 5] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.frame) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.previous) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.cumulated) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.positions) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/learn.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod learn_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/learn.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<4355, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/learn.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 68,
        bindings: &[
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Fitness", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 1, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "evolution", set: 1, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "next_evolution", set: 1, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Ranked", set: 1, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Normals", set: 1, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Steps", set: 1, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Matrix", set: 1, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Next", set: 1, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Positions", set: 1, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "BestSums", set: 1, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Learn;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `AllSums`, read; set 0, binding 1.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Fitness`, read; set 0, binding 2.
        pub fitness: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, read and written; set 1, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Evolution`, read; set 1, binding 2.
        pub evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `NextEvolution`, written; set 1, binding 3.
        pub next_evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `Ranked`, read; set 1, binding 4.
        pub ranked: &'a crate::gpu::Buffer,
        /// Storage buffer `Normals`, read; set 1, binding 5.
        pub normals: &'a crate::gpu::Buffer,
        /// Storage buffer `Steps`, read; set 1, binding 6.
        pub steps: &'a crate::gpu::Buffer,
        /// Storage buffer `Matrix`, read; set 1, binding 7.
        pub matrix: &'a crate::gpu::Buffer,
        /// Storage buffer `Next`, written; set 1, binding 8.
        pub next: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, read; set 1, binding 9.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `BestSums`, written; set 1, binding 10.
        pub best_sums: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 12] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.fitness) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.next_evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.ranked) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.normals) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.steps) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.matrix) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.next) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[11], bound: crate::gpu::Bound::Buffer(self.best_sums) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/learn_evidence.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod learn_evidence_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/learn_evidence.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<14312, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/learn_evidence.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 68,
        bindings: &[
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllEvidence", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 1, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "evolution", set: 1, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "next_evolution", set: 1, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Ranked", set: 1, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Normals", set: 1, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Steps", set: 1, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Matrix", set: 1, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Next", set: 1, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Positions", set: 1, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "BestSums", set: 1, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Learn;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `AllSums`, read; set 0, binding 1.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidenceTable`, read; set 0, binding 3.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `AllEvidence`, read; set 0, binding 4.
        pub all_evidence: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, read and written; set 1, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Evolution`, read; set 1, binding 2.
        pub evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `NextEvolution`, written; set 1, binding 3.
        pub next_evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `Ranked`, read; set 1, binding 4.
        pub ranked: &'a crate::gpu::Buffer,
        /// Storage buffer `Normals`, read; set 1, binding 5.
        pub normals: &'a crate::gpu::Buffer,
        /// Storage buffer `Steps`, read; set 1, binding 6.
        pub steps: &'a crate::gpu::Buffer,
        /// Storage buffer `Matrix`, read; set 1, binding 7.
        pub matrix: &'a crate::gpu::Buffer,
        /// Storage buffer `Next`, written; set 1, binding 8.
        pub next: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, read; set 1, binding 9.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `BestSums`, written; set 1, binding 10.
        pub best_sums: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 13] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_evidence) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.next_evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.ranked) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.normals) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.steps) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.matrix) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.next) },
                crate::gpu::Binding { layout: &SHADER.bindings[11], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[12], bound: crate::gpu::Bound::Buffer(self.best_sums) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/learn_objective.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod learn_objective_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/learn_objective.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<15179, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/learn_objective.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 68,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 1, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "evolution", set: 1, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "next_evolution", set: 1, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Ranked", set: 1, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Normals", set: 1, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Steps", set: 1, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Matrix", set: 1, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Next", set: 1, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Positions", set: 1, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "BestSums", set: 1, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Learn;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read; set 0, binding 1.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, read and written; set 1, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Evolution`, read; set 1, binding 2.
        pub evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `NextEvolution`, written; set 1, binding 3.
        pub next_evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `Ranked`, read; set 1, binding 4.
        pub ranked: &'a crate::gpu::Buffer,
        /// Storage buffer `Normals`, read; set 1, binding 5.
        pub normals: &'a crate::gpu::Buffer,
        /// Storage buffer `Steps`, read; set 1, binding 6.
        pub steps: &'a crate::gpu::Buffer,
        /// Storage buffer `Matrix`, read; set 1, binding 7.
        pub matrix: &'a crate::gpu::Buffer,
        /// Storage buffer `Next`, written; set 1, binding 8.
        pub next: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, read; set 1, binding 9.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `BestSums`, written; set 1, binding 10.
        pub best_sums: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 12] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.next_evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.ranked) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.normals) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.steps) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.matrix) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.next) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[11], bound: crate::gpu::Bound::Buffer(self.best_sums) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/learn_segments.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod learn_segments_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/learn_segments.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<17040, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/learn_segments.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 68,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSegmentSums", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 1, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "evolution", set: 1, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "next_evolution", set: 1, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Ranked", set: 1, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Normals", set: 1, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Steps", set: 1, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Matrix", set: 1, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Next", set: 1, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Positions", set: 1, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "BestSums", set: 1, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "SEGMENT_EDGES", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `SEGMENT_EDGES`, false by default.
        pub segment_edges: bool,
    }
    impl Default for Constants {
        fn default() -> Self { Self { segment_edges: false, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, u32::from(constants.segment_edges)), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Learn;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read; set 0, binding 1.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `SegmentTable`, read; set 0, binding 3.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSegmentSums`, read; set 0, binding 4.
        pub all_segment_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, read and written; set 1, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Evolution`, read; set 1, binding 2.
        pub evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `NextEvolution`, written; set 1, binding 3.
        pub next_evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `Ranked`, read; set 1, binding 4.
        pub ranked: &'a crate::gpu::Buffer,
        /// Storage buffer `Normals`, read; set 1, binding 5.
        pub normals: &'a crate::gpu::Buffer,
        /// Storage buffer `Steps`, read; set 1, binding 6.
        pub steps: &'a crate::gpu::Buffer,
        /// Storage buffer `Matrix`, read; set 1, binding 7.
        pub matrix: &'a crate::gpu::Buffer,
        /// Storage buffer `Next`, written; set 1, binding 8.
        pub next: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, read; set 1, binding 9.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `BestSums`, written; set 1, binding 10.
        pub best_sums: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 14] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.all_segment_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.next_evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.ranked) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.normals) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.steps) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.matrix) },
                crate::gpu::Binding { layout: &SHADER.bindings[11], bound: crate::gpu::Bound::Buffer(self.next) },
                crate::gpu::Binding { layout: &SHADER.bindings[12], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[13], bound: crate::gpu::Bound::Buffer(self.best_sums) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, constants: Constants, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(constants), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/move.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod move_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/move.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1791, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/move.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "frame", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Positions", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Velocities", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Best", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Own", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::MovePush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Frame`, read; set 0, binding 0.
        pub frame: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, read; set 0, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, read and written; set 0, binding 2.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `Velocities`, read and written; set 0, binding 3.
        pub velocities: &'a crate::gpu::Buffer,
        /// Storage buffer `Best`, read and written; set 0, binding 4.
        pub best: &'a crate::gpu::Buffer,
        /// Storage buffer `Own`, read; set 0, binding 5.
        pub own: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 6] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.frame) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.velocities) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.best) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.own) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/propagate.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod propagate_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/propagate.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<3701, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/propagate.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 16,
        bindings: &[
            crate::gpu::BindingLayout { name: "frame", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Previous", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cumulated", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Particles", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Positions", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::PropagatePush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Frame`, read; set 0, binding 0.
        pub frame: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, read; set 0, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Previous`, read; set 0, binding 2.
        pub previous: &'a crate::gpu::Buffer,
        /// Storage buffer `Cumulated`, read; set 0, binding 3.
        pub cumulated: &'a crate::gpu::Buffer,
        /// Storage buffer `Particles`, written; set 0, binding 4.
        pub particles: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, written; set 0, binding 5.
        pub positions: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 6] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.frame) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.previous) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.cumulated) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.particles) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.positions) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/rank.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod rank_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/rank.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<912, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/rank.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 12,
        bindings: &[
            crate::gpu::BindingLayout { name: "evolution", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Fitness", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Ranked", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Weights", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::RankPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Evolution`, written; set 0, binding 2.
        pub evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `Fitness`, read; set 0, binding 3.
        pub fitness: &'a crate::gpu::Buffer,
        /// Storage buffer `Ranked`, read; set 0, binding 4.
        pub ranked: &'a crate::gpu::Buffer,
        /// Storage buffer `Weights`, written; set 0, binding 5.
        pub weights: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.fitness) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.ranked) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.weights) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/sample.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod sample_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/sample.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<3512, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/sample.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 16,
        bindings: &[
            crate::gpu::BindingLayout { name: "frame", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "evolution", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Matrix", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Normals", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Steps", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Positions", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::SamplePush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Frame`, read; set 0, binding 0.
        pub frame: &'a crate::gpu::Buffer,
        /// Storage buffer `Evolution`, read; set 0, binding 2.
        pub evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `Matrix`, read; set 0, binding 3.
        pub matrix: &'a crate::gpu::Buffer,
        /// Storage buffer `Normals`, written; set 0, binding 4.
        pub normals: &'a crate::gpu::Buffer,
        /// Storage buffer `Steps`, written; set 0, binding 5.
        pub steps: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, written; set 0, binding 6.
        pub positions: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 6] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.frame) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.matrix) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.normals) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.steps) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.positions) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/scatter.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod scatter_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/scatter.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2981, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/scatter.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 16,
        bindings: &[
            crate::gpu::BindingLayout { name: "frame", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Positions", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Velocities", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Best", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Factors", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::ScatterPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Frame`, read; set 0, binding 0.
        pub frame: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, read; set 0, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, written; set 0, binding 2.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `Velocities`, written; set 0, binding 3.
        pub velocities: &'a crate::gpu::Buffer,
        /// Storage buffer `Best`, written; set 0, binding 4.
        pub best: &'a crate::gpu::Buffer,
        /// Storage buffer `Factors`, read; set 0, binding 5.
        pub factors: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 6] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.frame) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.velocities) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.best) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.factors) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/settle.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod settle_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/settle.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<793, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/settle.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 4,
        bindings: &[
            crate::gpu::BindingLayout { name: "frame", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "evolution", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Matrix", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::SettlePush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Frame`, read; set 0, binding 0.
        pub frame: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, written; set 0, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Evolution`, read; set 0, binding 2.
        pub evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `Matrix`, read; set 0, binding 3.
        pub matrix: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.frame) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.matrix) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/spread.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod spread_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/spread.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1518, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/spread.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 12,
        bindings: &[
            crate::gpu::BindingLayout { name: "frame", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Rows", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Weights", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Factors", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::SpreadPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Frame`, read; set 0, binding 0.
        pub frame: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, read and written; set 0, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Rows`, read; set 0, binding 2.
        pub rows: &'a crate::gpu::Buffer,
        /// Storage buffer `Weights`, read; set 0, binding 3.
        pub weights: &'a crate::gpu::Buffer,
        /// Storage buffer `Factors`, read; set 0, binding 4.
        pub factors: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 5] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.frame) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.rows) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.weights) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.factors) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/turn.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod turn_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/turn.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1288, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/turn.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 20,
        bindings: &[
            crate::gpu::BindingLayout { name: "evolution", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Fitness", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Weights", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Normals", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Steps", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Matrix", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Next", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::TurnPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Evolution`, read; set 0, binding 2.
        pub evolution: &'a crate::gpu::Buffer,
        /// Storage buffer `Fitness`, read; set 0, binding 3.
        pub fitness: &'a crate::gpu::Buffer,
        /// Storage buffer `Weights`, read; set 0, binding 4.
        pub weights: &'a crate::gpu::Buffer,
        /// Storage buffer `Normals`, read; set 0, binding 5.
        pub normals: &'a crate::gpu::Buffer,
        /// Storage buffer `Steps`, read; set 0, binding 6.
        pub steps: &'a crate::gpu::Buffer,
        /// Storage buffer `Matrix`, read; set 0, binding 7.
        pub matrix: &'a crate::gpu::Buffer,
        /// Storage buffer `Next`, written; set 0, binding 8.
        pub next: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 7] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.evolution) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.fitness) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.weights) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.normals) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.steps) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.matrix) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.next) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// The stage `search/weigh.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod weigh_comp {
    // Accesses are as declared: naga cannot read this stage (Function [6] 'halved(vu2;u1;' is invalid: Expression [64] is invalid: Operation Subtract can't work with [63] (of type Scalar(Scalar { kind: Uint, width: 4 })) and [17] (of type Scalar(Scalar { kind: Sint, width: 4 }))).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search/weigh.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<3317, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search/weigh.comp.spv"))),
        workgroup_size: [256, 1, 1],
        push_size: 12,
        bindings: &[
            crate::gpu::BindingLayout { name: "Fitness", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "outcome", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Particles", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Weights", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Cumulated", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Sharpness", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::WeighPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Fitness`, read; set 0, binding 0.
        pub fitness: &'a crate::gpu::Buffer,
        /// Storage buffer `Outcome`, read and written; set 0, binding 1.
        pub outcome: &'a crate::gpu::Buffer,
        /// Storage buffer `Particles`, read; set 0, binding 2.
        pub particles: &'a crate::gpu::Buffer,
        /// Storage buffer `Weights`, written; set 0, binding 3.
        pub weights: &'a crate::gpu::Buffer,
        /// Storage buffer `Cumulated`, read and written; set 0, binding 4.
        pub cumulated: &'a crate::gpu::Buffer,
        /// Storage buffer `Sharpness`, read and written; set 0, binding 5.
        pub sharpness: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 6] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.fitness) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.outcome) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.particles) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.weights) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.cumulated) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.sharpness) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, push: Push, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: bytemuck::bytes_of(&push).to_vec(), groups }
        }
    }
}
/// Memory layouts of the blocks.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub mod layout {
    /// `Advance` in memory, 60 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Advance {
        /// `scoring` at byte 0.
        pub scoring: Scoring,
        /// `dofs` at byte 28.
        pub dofs: u32,
        /// `done` at byte 32.
        pub done: u32,
        /// `is_first` at byte 36.
        pub is_first: u32,
        /// `side` at byte 40.
        pub side: u32,
        /// `iteration` at byte 44.
        pub iteration: u32,
        /// `inertia` at byte 48.
        pub inertia: f32,
        /// `cognitive` at byte 52.
        pub cognitive: f32,
        /// `social` at byte 56.
        pub social: f32,
    }
    const _: () = assert!(size_of::<Advance>() == 60);
    const _: () = assert!(std::mem::offset_of!(Advance, scoring) == 0);
    const _: () = assert!(std::mem::offset_of!(Advance, dofs) == 28);
    const _: () = assert!(std::mem::offset_of!(Advance, done) == 32);
    const _: () = assert!(std::mem::offset_of!(Advance, is_first) == 36);
    const _: () = assert!(std::mem::offset_of!(Advance, side) == 40);
    const _: () = assert!(std::mem::offset_of!(Advance, iteration) == 44);
    const _: () = assert!(std::mem::offset_of!(Advance, inertia) == 48);
    const _: () = assert!(std::mem::offset_of!(Advance, cognitive) == 52);
    const _: () = assert!(std::mem::offset_of!(Advance, social) == 56);
    /// `BeginPush` in memory, 8 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct BeginPush {
        /// `dofs` at byte 0.
        pub dofs: u32,
        /// `sigma` at byte 4.
        pub sigma: f32,
    }
    const _: () = assert!(size_of::<BeginPush>() == 8);
    const _: () = assert!(std::mem::offset_of!(BeginPush, dofs) == 0);
    const _: () = assert!(std::mem::offset_of!(BeginPush, sigma) == 4);
    /// `BestPush` in memory, 20 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct BestPush {
        /// `particles` at byte 0.
        pub particles: u32,
        /// `dofs` at byte 4.
        pub dofs: u32,
        /// `views` at byte 8.
        pub views: u32,
        /// `iteration` at byte 12.
        pub iteration: u32,
        /// `is_first` at byte 16.
        pub is_first: u32,
    }
    const _: () = assert!(size_of::<BestPush>() == 20);
    const _: () = assert!(std::mem::offset_of!(BestPush, particles) == 0);
    const _: () = assert!(std::mem::offset_of!(BestPush, dofs) == 4);
    const _: () = assert!(std::mem::offset_of!(BestPush, views) == 8);
    const _: () = assert!(std::mem::offset_of!(BestPush, iteration) == 12);
    const _: () = assert!(std::mem::offset_of!(BestPush, is_first) == 16);
    /// `Camera` in memory, 128 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Camera {
        /// `camera_from_world` at byte 0.
        pub camera_from_world: [[f32; 4]; 3],
        /// `centre` at byte 48.
        pub centre: [f32; 3],
        /// `lens` at byte 60.
        pub lens: u32,
        /// `focal` at byte 64.
        pub focal: [f32; 2],
        /// `principal` at byte 72.
        pub principal: [f32; 2],
        /// `radial` at byte 80.
        pub radial: [f32; 3],
        /// `max_radius_squared` at byte 92.
        pub max_radius_squared: f32,
        /// `tangential` at byte 96.
        pub tangential: [f32; 2],
        /// `size` at byte 104.
        pub size: [u32; 2],
        /// `words` at byte 112.
        pub words: u32,
        /// `first_plane_word` at byte 116.
        pub first_plane_word: u32,
        /// `first_pixel_word` at byte 120.
        pub first_pixel_word: u32,
        /// `area_obs` at byte 124.
        pub area_obs: u32,
    }
    const _: () = assert!(size_of::<Camera>() == 128);
    const _: () = assert!(std::mem::offset_of!(Camera, camera_from_world) == 0);
    const _: () = assert!(std::mem::offset_of!(Camera, centre) == 48);
    const _: () = assert!(std::mem::offset_of!(Camera, lens) == 60);
    const _: () = assert!(std::mem::offset_of!(Camera, focal) == 64);
    const _: () = assert!(std::mem::offset_of!(Camera, principal) == 72);
    const _: () = assert!(std::mem::offset_of!(Camera, radial) == 80);
    const _: () = assert!(std::mem::offset_of!(Camera, max_radius_squared) == 92);
    const _: () = assert!(std::mem::offset_of!(Camera, tangential) == 96);
    const _: () = assert!(std::mem::offset_of!(Camera, size) == 104);
    const _: () = assert!(std::mem::offset_of!(Camera, words) == 112);
    const _: () = assert!(std::mem::offset_of!(Camera, first_plane_word) == 116);
    const _: () = assert!(std::mem::offset_of!(Camera, first_pixel_word) == 120);
    const _: () = assert!(std::mem::offset_of!(Camera, area_obs) == 124);
    /// `ChoosePush` in memory, 8 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct ChoosePush {
        /// `dofs` at byte 0.
        pub dofs: u32,
        /// `views` at byte 4.
        pub views: u32,
    }
    const _: () = assert!(size_of::<ChoosePush>() == 8);
    const _: () = assert!(std::mem::offset_of!(ChoosePush, dofs) == 0);
    const _: () = assert!(std::mem::offset_of!(ChoosePush, views) == 4);
    /// `EvidenceTableHeader` in memory, 516 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct EvidenceTableHeader {
        /// `classes` at byte 0.
        pub classes: [u32; 128],
        /// `count` at byte 512.
        pub count: u32,
    }
    const _: () = assert!(size_of::<EvidenceTableHeader>() == 516);
    const _: () = assert!(std::mem::offset_of!(EvidenceTableHeader, classes) == 0);
    const _: () = assert!(std::mem::offset_of!(EvidenceTableHeader, count) == 512);
    /// `EvolutionHeader` in memory, 8 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct EvolutionHeader {
        /// `sigma` at byte 0.
        pub sigma: f32,
        /// `first` at byte 4.
        pub first: u32,
    }
    const _: () = assert!(size_of::<EvolutionHeader>() == 8);
    const _: () = assert!(std::mem::offset_of!(EvolutionHeader, sigma) == 0);
    const _: () = assert!(std::mem::offset_of!(EvolutionHeader, first) == 4);
    /// `FollowPush` in memory, 28 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct FollowPush {
        /// `samples` at byte 0.
        pub samples: u32,
        /// `dofs` at byte 4.
        pub dofs: u32,
        /// `views` at byte 8.
        pub views: u32,
        /// `path_kept` at byte 12.
        pub path_kept: f32,
        /// `path_gain` at byte 16.
        pub path_gain: f32,
        /// `sigma_gain` at byte 20.
        pub sigma_gain: f32,
        /// `sigma_loss` at byte 24.
        pub sigma_loss: f32,
    }
    const _: () = assert!(size_of::<FollowPush>() == 28);
    const _: () = assert!(std::mem::offset_of!(FollowPush, samples) == 0);
    const _: () = assert!(std::mem::offset_of!(FollowPush, dofs) == 4);
    const _: () = assert!(std::mem::offset_of!(FollowPush, views) == 8);
    const _: () = assert!(std::mem::offset_of!(FollowPush, path_kept) == 12);
    const _: () = assert!(std::mem::offset_of!(FollowPush, path_gain) == 16);
    const _: () = assert!(std::mem::offset_of!(FollowPush, sigma_gain) == 20);
    const _: () = assert!(std::mem::offset_of!(FollowPush, sigma_loss) == 24);
    /// `FrameHeader` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct FrameHeader {
        /// `number` at byte 0.
        pub number: u32,
        /// `goes_on` at byte 4.
        pub goes_on: u32,
        /// `seed` at byte 8.
        pub seed: [u32; 2],
    }
    const _: () = assert!(size_of::<FrameHeader>() == 16);
    const _: () = assert!(std::mem::offset_of!(FrameHeader, number) == 0);
    const _: () = assert!(std::mem::offset_of!(FrameHeader, goes_on) == 4);
    const _: () = assert!(std::mem::offset_of!(FrameHeader, seed) == 8);
    /// `LayerPush` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct LayerPush {
        /// `particles` at byte 0.
        pub particles: u32,
        /// `dofs` at byte 4.
        pub dofs: u32,
        /// `layer` at byte 8.
        pub layer: u32,
        /// `noise` at byte 12.
        pub noise: f32,
    }
    const _: () = assert!(size_of::<LayerPush>() == 16);
    const _: () = assert!(std::mem::offset_of!(LayerPush, particles) == 0);
    const _: () = assert!(std::mem::offset_of!(LayerPush, dofs) == 4);
    const _: () = assert!(std::mem::offset_of!(LayerPush, layer) == 8);
    const _: () = assert!(std::mem::offset_of!(LayerPush, noise) == 12);
    /// `Learn` in memory, 68 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Learn {
        /// `scoring` at byte 0.
        pub scoring: Scoring,
        /// `dofs` at byte 28.
        pub dofs: u32,
        /// `first_weight` at byte 32.
        pub first_weight: u32,
        /// `parents` at byte 36.
        pub parents: u32,
        /// `path_kept` at byte 40.
        pub path_kept: f32,
        /// `path_gain` at byte 44.
        pub path_gain: f32,
        /// `sigma_gain` at byte 48.
        pub sigma_gain: f32,
        /// `sigma_loss` at byte 52.
        pub sigma_loss: f32,
        /// `kept` at byte 56.
        pub kept: f32,
        /// `of_path` at byte 60.
        pub of_path: f32,
        /// `of_samples` at byte 64.
        pub of_samples: f32,
    }
    const _: () = assert!(size_of::<Learn>() == 68);
    const _: () = assert!(std::mem::offset_of!(Learn, scoring) == 0);
    const _: () = assert!(std::mem::offset_of!(Learn, dofs) == 28);
    const _: () = assert!(std::mem::offset_of!(Learn, first_weight) == 32);
    const _: () = assert!(std::mem::offset_of!(Learn, parents) == 36);
    const _: () = assert!(std::mem::offset_of!(Learn, path_kept) == 40);
    const _: () = assert!(std::mem::offset_of!(Learn, path_gain) == 44);
    const _: () = assert!(std::mem::offset_of!(Learn, sigma_gain) == 48);
    const _: () = assert!(std::mem::offset_of!(Learn, sigma_loss) == 52);
    const _: () = assert!(std::mem::offset_of!(Learn, kept) == 56);
    const _: () = assert!(std::mem::offset_of!(Learn, of_path) == 60);
    const _: () = assert!(std::mem::offset_of!(Learn, of_samples) == 64);
    /// `MovePush` in memory, 24 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct MovePush {
        /// `particles` at byte 0.
        pub particles: u32,
        /// `dofs` at byte 4.
        pub dofs: u32,
        /// `iteration` at byte 8.
        pub iteration: u32,
        /// `inertia` at byte 12.
        pub inertia: f32,
        /// `cognitive` at byte 16.
        pub cognitive: f32,
        /// `social` at byte 20.
        pub social: f32,
    }
    const _: () = assert!(size_of::<MovePush>() == 24);
    const _: () = assert!(std::mem::offset_of!(MovePush, particles) == 0);
    const _: () = assert!(std::mem::offset_of!(MovePush, dofs) == 4);
    const _: () = assert!(std::mem::offset_of!(MovePush, iteration) == 8);
    const _: () = assert!(std::mem::offset_of!(MovePush, inertia) == 12);
    const _: () = assert!(std::mem::offset_of!(MovePush, cognitive) == 16);
    const _: () = assert!(std::mem::offset_of!(MovePush, social) == 20);
    /// `NextEvolutionHeader` in memory, 8 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct NextEvolutionHeader {
        /// `sigma` at byte 0.
        pub sigma: f32,
        /// `first` at byte 4.
        pub first: u32,
    }
    const _: () = assert!(size_of::<NextEvolutionHeader>() == 8);
    const _: () = assert!(std::mem::offset_of!(NextEvolutionHeader, sigma) == 0);
    const _: () = assert!(std::mem::offset_of!(NextEvolutionHeader, first) == 4);
    /// `OutcomeHeader` in memory, 8 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct OutcomeHeader {
        /// `key` at byte 0.
        pub key: u32,
        /// `stride` at byte 4.
        pub stride: u32,
    }
    const _: () = assert!(size_of::<OutcomeHeader>() == 8);
    const _: () = assert!(std::mem::offset_of!(OutcomeHeader, key) == 0);
    const _: () = assert!(std::mem::offset_of!(OutcomeHeader, stride) == 4);
    /// `PropagatePush` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct PropagatePush {
        /// `first` at byte 0.
        pub first: u32,
        /// `batch` at byte 4.
        pub batch: u32,
        /// `count` at byte 8.
        pub count: u32,
        /// `dofs` at byte 12.
        pub dofs: u32,
    }
    const _: () = assert!(size_of::<PropagatePush>() == 16);
    const _: () = assert!(std::mem::offset_of!(PropagatePush, first) == 0);
    const _: () = assert!(std::mem::offset_of!(PropagatePush, batch) == 4);
    const _: () = assert!(std::mem::offset_of!(PropagatePush, count) == 8);
    const _: () = assert!(std::mem::offset_of!(PropagatePush, dofs) == 12);
    /// `RankPush` in memory, 12 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct RankPush {
        /// `samples` at byte 0.
        pub samples: u32,
        /// `first_weight` at byte 4.
        pub first_weight: u32,
        /// `parents` at byte 8.
        pub parents: u32,
    }
    const _: () = assert!(size_of::<RankPush>() == 12);
    const _: () = assert!(std::mem::offset_of!(RankPush, samples) == 0);
    const _: () = assert!(std::mem::offset_of!(RankPush, first_weight) == 4);
    const _: () = assert!(std::mem::offset_of!(RankPush, parents) == 8);
    /// `SamplePush` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct SamplePush {
        /// `samples` at byte 0.
        pub samples: u32,
        /// `dofs` at byte 4.
        pub dofs: u32,
        /// `iteration` at byte 8.
        pub iteration: u32,
        /// `first` at byte 12.
        pub first: u32,
    }
    const _: () = assert!(size_of::<SamplePush>() == 16);
    const _: () = assert!(std::mem::offset_of!(SamplePush, samples) == 0);
    const _: () = assert!(std::mem::offset_of!(SamplePush, dofs) == 4);
    const _: () = assert!(std::mem::offset_of!(SamplePush, iteration) == 8);
    const _: () = assert!(std::mem::offset_of!(SamplePush, first) == 12);
    /// `ScatterPush` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct ScatterPush {
        /// `particles` at byte 0.
        pub particles: u32,
        /// `dofs` at byte 4.
        pub dofs: u32,
        /// `level` at byte 8.
        pub level: u32,
        /// `iteration` at byte 12.
        pub iteration: u32,
    }
    const _: () = assert!(size_of::<ScatterPush>() == 16);
    const _: () = assert!(std::mem::offset_of!(ScatterPush, particles) == 0);
    const _: () = assert!(std::mem::offset_of!(ScatterPush, dofs) == 4);
    const _: () = assert!(std::mem::offset_of!(ScatterPush, level) == 8);
    const _: () = assert!(std::mem::offset_of!(ScatterPush, iteration) == 12);
    /// `Scoring` in memory, 28 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Scoring {
        /// `candidates` at byte 0.
        pub candidates: u32,
        /// `views` at byte 4.
        pub views: u32,
        /// `terms` at byte 8.
        pub terms: u32,
        /// `over` at byte 12.
        pub over: u32,
        /// `beta` at byte 16.
        pub beta: f32,
        /// `w1` at byte 20.
        pub w1: f32,
        /// `w2` at byte 24.
        pub w2: f32,
    }
    const _: () = assert!(size_of::<Scoring>() == 28);
    const _: () = assert!(std::mem::offset_of!(Scoring, candidates) == 0);
    const _: () = assert!(std::mem::offset_of!(Scoring, views) == 4);
    const _: () = assert!(std::mem::offset_of!(Scoring, terms) == 8);
    const _: () = assert!(std::mem::offset_of!(Scoring, over) == 12);
    const _: () = assert!(std::mem::offset_of!(Scoring, beta) == 16);
    const _: () = assert!(std::mem::offset_of!(Scoring, w1) == 20);
    const _: () = assert!(std::mem::offset_of!(Scoring, w2) == 24);
    /// `SegmentTableHeader` in memory, 544 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct SegmentTableHeader {
        /// `weights` at byte 0.
        pub weights: [f32; 8],
        /// `numbers` at byte 32.
        pub numbers: [u32; 128],
    }
    const _: () = assert!(size_of::<SegmentTableHeader>() == 544);
    const _: () = assert!(std::mem::offset_of!(SegmentTableHeader, weights) == 0);
    const _: () = assert!(std::mem::offset_of!(SegmentTableHeader, numbers) == 32);
    /// `SettlePush` in memory, 4 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct SettlePush {
        /// `dofs` at byte 0.
        pub dofs: u32,
    }
    const _: () = assert!(size_of::<SettlePush>() == 4);
    const _: () = assert!(std::mem::offset_of!(SettlePush, dofs) == 0);
    /// `Sharpness` in memory, 4 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Sharpness {
        /// `sharpness` at byte 0.
        pub sharpness: f32,
    }
    const _: () = assert!(size_of::<Sharpness>() == 4);
    const _: () = assert!(std::mem::offset_of!(Sharpness, sharpness) == 0);
    /// `SpreadPush` in memory, 12 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct SpreadPush {
        /// `count` at byte 0.
        pub count: u32,
        /// `dofs` at byte 4.
        pub dofs: u32,
        /// `level` at byte 8.
        pub level: u32,
    }
    const _: () = assert!(size_of::<SpreadPush>() == 12);
    const _: () = assert!(std::mem::offset_of!(SpreadPush, count) == 0);
    const _: () = assert!(std::mem::offset_of!(SpreadPush, dofs) == 4);
    const _: () = assert!(std::mem::offset_of!(SpreadPush, level) == 8);
    /// `Sums` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Sums {
        /// `area_model` at byte 0.
        pub area_model: u32,
        /// `overlap` at byte 4.
        pub overlap: u32,
        /// `edges` at byte 8.
        pub edges: u32,
        /// `proximity` at byte 12.
        pub proximity: u32,
    }
    const _: () = assert!(size_of::<Sums>() == 16);
    const _: () = assert!(std::mem::offset_of!(Sums, area_model) == 0);
    const _: () = assert!(std::mem::offset_of!(Sums, overlap) == 4);
    const _: () = assert!(std::mem::offset_of!(Sums, edges) == 8);
    const _: () = assert!(std::mem::offset_of!(Sums, proximity) == 12);
    /// `TurnPush` in memory, 20 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct TurnPush {
        /// `samples` at byte 0.
        pub samples: u32,
        /// `dofs` at byte 4.
        pub dofs: u32,
        /// `kept` at byte 8.
        pub kept: f32,
        /// `of_path` at byte 12.
        pub of_path: f32,
        /// `of_samples` at byte 16.
        pub of_samples: f32,
    }
    const _: () = assert!(size_of::<TurnPush>() == 20);
    const _: () = assert!(std::mem::offset_of!(TurnPush, samples) == 0);
    const _: () = assert!(std::mem::offset_of!(TurnPush, dofs) == 4);
    const _: () = assert!(std::mem::offset_of!(TurnPush, kept) == 8);
    const _: () = assert!(std::mem::offset_of!(TurnPush, of_path) == 12);
    const _: () = assert!(std::mem::offset_of!(TurnPush, of_samples) == 16);
    /// `WeighPush` in memory, 12 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct WeighPush {
        /// `count` at byte 0.
        pub count: u32,
        /// `dofs` at byte 4.
        pub dofs: u32,
        /// `survival` at byte 8.
        pub survival: f32,
    }
    const _: () = assert!(size_of::<WeighPush>() == 12);
    const _: () = assert!(std::mem::offset_of!(WeighPush, count) == 0);
    const _: () = assert!(std::mem::offset_of!(WeighPush, dofs) == 4);
    const _: () = assert!(std::mem::offset_of!(WeighPush, survival) == 8);
}
/// Every stage of the folder, for tests that try them all.
#[cfg(test)]
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub static SHADERS: &[&crate::gpu::Shader] = &[&advance_comp::SHADER, &advance_evidence_comp::SHADER, &advance_objective_comp::SHADER, &advance_segments_comp::SHADER, &begin_comp::SHADER, &best_comp::SHADER, &choose_comp::SHADER, &follow_comp::SHADER, &layer_comp::SHADER, &learn_comp::SHADER, &learn_evidence_comp::SHADER, &learn_objective_comp::SHADER, &learn_segments_comp::SHADER, &move_comp::SHADER, &propagate_comp::SHADER, &rank_comp::SHADER, &sample_comp::SHADER, &scatter_comp::SHADER, &settle_comp::SHADER, &spread_comp::SHADER, &turn_comp::SHADER, &weigh_comp::SHADER];
