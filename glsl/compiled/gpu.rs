/// Invocations of one workgroup of double.comp.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const DOUBLE_WORKGROUP: u32 = 64;
/// The stage `gpu/double.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod double_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "gpu/double.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<299, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/gpu/double.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 8,
        bindings: &[
            crate::gpu::BindingLayout { name: "Source", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Target", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::DoublePush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Source`, read; set 0, binding 0.
        pub source: &'a crate::gpu::Buffer,
        /// Storage buffer `Target`, written; set 0, binding 1.
        pub target: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.source) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.target) },
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
/// The stage `gpu/double_in_place.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod double_in_place_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "gpu/double_in_place.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<302, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/gpu/double_in_place.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 8,
        bindings: &[
            crate::gpu::BindingLayout { name: "Source", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Target", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::DoublePush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Source`, read and written; set 0, binding 0.
        pub source: &'a crate::gpu::Buffer,
        /// Storage buffer `Target`, written; set 0, binding 1.
        pub target: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.source) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.target) },
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
/// The stage `gpu/fill.frag`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod fill_frag {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "gpu/fill.frag",
        kind: crate::gpu::ShaderKind::Fragment,
        spirv: &crate::gpu::words::<78, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/gpu/fill.frag.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 0,
        bindings: &[
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
}
/// The stage `gpu/fill.vert`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod fill_vert {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "gpu/fill.vert",
        kind: crate::gpu::ShaderKind::Vertex,
        spirv: &crate::gpu::words::<252, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/gpu/fill.vert.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 0,
        bindings: &[
            crate::gpu::BindingLayout { name: "Corners", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Corners`, read; set 0, binding 0.
        pub corners: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 1] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.corners) },
            ]
        }
    }
}
/// The stage `gpu/recolour.frag`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod recolour_frag {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "gpu/recolour.frag",
        kind: crate::gpu::ShaderKind::Fragment,
        spirv: &crate::gpu::words::<170, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/gpu/recolour.frag.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 0,
        bindings: &[
            crate::gpu::BindingLayout { name: "Corners", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Corners`, written; set 0, binding 0.
        pub corners: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 1] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.corners) },
            ]
        }
    }
}
/// Memory layouts of the blocks.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub mod layout {
    /// `Corner` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Corner {
        /// `position` at byte 0.
        pub position: [f32; 2],
        /// `colour` at byte 8.
        pub colour: u32,
        /// Padding.
        pub _pad0: [u32; 1],
    }
    const _: () = assert!(size_of::<Corner>() == 16);
    const _: () = assert!(std::mem::offset_of!(Corner, position) == 0);
    const _: () = assert!(std::mem::offset_of!(Corner, colour) == 8);
    /// `DoublePush` in memory, 8 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct DoublePush {
        /// `count` at byte 0.
        pub count: u32,
        /// `factor` at byte 4.
        pub factor: f32,
    }
    const _: () = assert!(size_of::<DoublePush>() == 8);
    const _: () = assert!(std::mem::offset_of!(DoublePush, count) == 0);
    const _: () = assert!(std::mem::offset_of!(DoublePush, factor) == 4);
}
/// Every stage of the folder, for tests that try them all.
#[cfg(test)]
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub static SHADERS: &[&crate::gpu::Shader] = &[&double_comp::SHADER, &double_in_place_comp::SHADER, &fill_frag::SHADER, &fill_vert::SHADER, &recolour_frag::SHADER];
