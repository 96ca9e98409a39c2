/// The stage `search_tests/random.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod random_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search_tests/random.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2348, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search_tests/random.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 12,
        bindings: &[
            crate::gpu::BindingLayout { name: "Counters", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Words", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Normals", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::RandomPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Counters`, read; set 0, binding 0.
        pub counters: &'a crate::gpu::Buffer,
        /// Storage buffer `Words`, written; set 0, binding 1.
        pub words: &'a crate::gpu::Buffer,
        /// Storage buffer `Normals`, written; set 0, binding 2.
        pub normals: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.counters) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.words) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.normals) },
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
/// The stage `search_tests/score.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod score_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "search_tests/score.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<761, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/search_tests/score.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 20,
        bindings: &[
            crate::gpu::BindingLayout { name: "Target", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Positions", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Fitness", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Sums", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::ScorePush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Target`, read; set 0, binding 0.
        pub target: &'a crate::gpu::Buffer,
        /// Storage buffer `Positions`, read; set 0, binding 1.
        pub positions: &'a crate::gpu::Buffer,
        /// Storage buffer `Fitness`, written; set 0, binding 2.
        pub fitness: &'a crate::gpu::Buffer,
        /// Storage buffer `Sums`, written; set 0, binding 3.
        pub sums: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.target) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.positions) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.fitness) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.sums) },
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
    /// `RandomPush` in memory, 12 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct RandomPush {
        /// `count` at byte 0.
        pub count: u32,
        /// `key_low` at byte 4.
        pub key_low: u32,
        /// `key_high` at byte 8.
        pub key_high: u32,
    }
    const _: () = assert!(size_of::<RandomPush>() == 12);
    const _: () = assert!(std::mem::offset_of!(RandomPush, count) == 0);
    const _: () = assert!(std::mem::offset_of!(RandomPush, key_low) == 4);
    const _: () = assert!(std::mem::offset_of!(RandomPush, key_high) == 8);
    /// `ScorePush` in memory, 20 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct ScorePush {
        /// `candidates` at byte 0.
        pub candidates: u32,
        /// `dofs` at byte 4.
        pub dofs: u32,
        /// `bad_from` at byte 8.
        pub bad_from: u32,
        /// `bad` at byte 12.
        pub bad: u32,
        /// `nudged` at byte 16.
        pub nudged: u32,
    }
    const _: () = assert!(size_of::<ScorePush>() == 20);
    const _: () = assert!(std::mem::offset_of!(ScorePush, candidates) == 0);
    const _: () = assert!(std::mem::offset_of!(ScorePush, dofs) == 4);
    const _: () = assert!(std::mem::offset_of!(ScorePush, bad_from) == 8);
    const _: () = assert!(std::mem::offset_of!(ScorePush, bad) == 12);
    const _: () = assert!(std::mem::offset_of!(ScorePush, nudged) == 16);
}
/// Every stage of the folder, for tests that try them all.
#[cfg(test)]
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub static SHADERS: &[&crate::gpu::Shader] = &[&random_comp::SHADER, &score_comp::SHADER];
