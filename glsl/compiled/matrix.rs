/// Side of the square of elements that a workgroup computes.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const TILE: u32 = 16;
/// Bits of an element at most.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const PLANES: u32 = 32;
/// The stage `matrix/bit_planes.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod bit_planes_comp {
    // Accesses are as declared: naga cannot read this stage (Function [2] 'main' is invalid: The type of [176] doesn't match the type stored in [44]).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "matrix/bit_planes.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1187, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/matrix/bit_planes.comp.spv"))),
        workgroup_size: [16, 16, 1],
        push_size: 12,
        bindings: &[
            crate::gpu::BindingLayout { name: "RowPlanes", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "ColumnPlanes", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Product", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::BitPlanesPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `RowPlanes`, read; set 0, binding 0.
        pub row_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `ColumnPlanes`, read; set 0, binding 1.
        pub column_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `Product`, written; set 0, binding 2.
        pub product: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.row_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.column_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.product) },
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
/// The stage `matrix/integers.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod integers_comp {
    // Accesses are as declared: naga cannot read this stage (unsupported instruction SMulExtended at Function).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "matrix/integers.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<982, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/matrix/integers.comp.spv"))),
        workgroup_size: [16, 16, 1],
        push_size: 4,
        bindings: &[
            crate::gpu::BindingLayout { name: "A", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "B", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Product", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "WIDE", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `WIDE`, 0 by default.
        pub wide: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { wide: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.wide), ] }
    }
    /// Push constants.
    pub type Push = super::layout::IntegersPush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `A`, read; set 0, binding 0.
        pub a: &'a crate::gpu::Buffer,
        /// Storage buffer `B`, read; set 0, binding 1.
        pub b: &'a crate::gpu::Buffer,
        /// Storage buffer `Product`, written; set 0, binding 2.
        pub product: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.a) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.b) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.product) },
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
    /// `BitPlanesPush` in memory, 12 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct BitPlanesPush {
        /// `n` at byte 0.
        pub n: u32,
        /// `bits` at byte 4.
        pub bits: u32,
        /// `words` at byte 8.
        pub words: u32,
    }
    const _: () = assert!(size_of::<BitPlanesPush>() == 12);
    const _: () = assert!(std::mem::offset_of!(BitPlanesPush, n) == 0);
    const _: () = assert!(std::mem::offset_of!(BitPlanesPush, bits) == 4);
    const _: () = assert!(std::mem::offset_of!(BitPlanesPush, words) == 8);
    /// `IntegersPush` in memory, 4 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct IntegersPush {
        /// `n` at byte 0.
        pub n: u32,
    }
    const _: () = assert!(size_of::<IntegersPush>() == 4);
    const _: () = assert!(std::mem::offset_of!(IntegersPush, n) == 0);
}
/// Every stage of the folder, for tests that try them all.
#[cfg(test)]
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub static SHADERS: &[&crate::gpu::Shader] = &[&bit_planes_comp::SHADER, &integers_comp::SHADER];
