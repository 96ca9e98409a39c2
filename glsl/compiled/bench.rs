/// Invocations of a workgroup.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const PEAK_WORKGROUP: u32 = 128;
/// Sums, shifts and bit operations of whole numbers.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const PEAK_INTEGER: u32 = 0;
/// Products and sums in floating point.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const PEAK_FLOAT: u32 = 1;
/// Reads from a large buffer.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const PEAK_MEMORY: u32 = 2;
/// Reads from the shared memory of a workgroup.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const PEAK_SHARED: u32 = 3;
/// The stage `bench/peak.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod peak_comp {
    // Accesses are as declared: naga cannot read this stage (unsupported instruction SpecConstantOp at Type).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "bench/peak.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1406, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/bench/peak.comp.spv"))),
        workgroup_size: [128, 1, 1],
        push_size: 12,
        bindings: &[
            crate::gpu::BindingLayout { name: "Data", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Result", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "KIND", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `KIND`, 0 by default.
        pub kind: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { kind: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.kind), ] }
    }
    /// Push constants.
    pub type Push = super::layout::PeakPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Data`, read; set 0, binding 0.
        pub data: &'a crate::gpu::Buffer,
        /// Storage buffer `Result`, written; set 0, binding 1.
        pub result: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.data) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.result) },
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
/// Memory layouts of the blocks.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub mod layout {
    /// `PeakPush` in memory, 12 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct PeakPush {
        /// `rounds` at byte 0.
        pub rounds: u32,
        /// `mask` at byte 4.
        pub mask: u32,
        /// `stride` at byte 8.
        pub stride: u32,
    }
    const _: () = assert!(size_of::<PeakPush>() == 12);
    const _: () = assert!(std::mem::offset_of!(PeakPush, rounds) == 0);
    const _: () = assert!(std::mem::offset_of!(PeakPush, mask) == 4);
    const _: () = assert!(std::mem::offset_of!(PeakPush, stride) == 8);
}
/// Every stage of the folder, for tests that try them all.
#[cfg(test)]
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub static SHADERS: &[&crate::gpu::Shader] = &[&peak_comp::SHADER];
