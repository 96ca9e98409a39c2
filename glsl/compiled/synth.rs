/// Pixels a side of a tile, and so of a workgroup.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const TILE_SIDE: u32 = 8;
/// Cells a side of the grid of shadow on the floor, and their width, mm.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const SHADOW_SIDE: u32 = 130;
/// `SHADOW_CELL` of `synth/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const SHADOW_CELL: f32 = 22.0;
/// What a primitive is made of.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LOOK_SKIN: u32 = 0;
/// `LOOK_FACE` of `synth/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LOOK_FACE: u32 = 1;
/// `LOOK_HAIR` of `synth/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LOOK_HAIR: u32 = 2;
/// `LOOK_SHIRT` of `synth/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LOOK_SHIRT: u32 = 3;
/// `LOOK_TROUSERS` of `synth/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LOOK_TROUSERS: u32 = 4;
/// `LOOK_SHOE` of `synth/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LOOK_SHOE: u32 = 5;
/// A candidate of a tile: the member above, the primitive's number in the bits below.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MEMBER_SHIFT: u32 = 28;
/// The stage `synth/occlude.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod occlude_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "synth/occlude.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2960, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/synth/occlude.comp.spv"))),
        workgroup_size: [8, 8, 1],
        push_size: 4,
        bindings: &[
            crate::gpu::BindingLayout { name: "Members", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Solids", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Triangles", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Bins", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Balls", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Hidden", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::OccludePush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Members`, read; set 0, binding 0.
        pub members: &'a crate::gpu::Buffer,
        /// Storage buffer `Solids`, read; set 0, binding 1.
        pub solids: &'a crate::gpu::Buffer,
        /// Storage buffer `Triangles`, read; set 0, binding 2.
        pub triangles: &'a crate::gpu::Buffer,
        /// Storage buffer `Bins`, read; set 0, binding 3.
        pub bins: &'a crate::gpu::Buffer,
        /// Storage buffer `Balls`, read; set 0, binding 4.
        pub balls: &'a crate::gpu::Buffer,
        /// Storage buffer `Hidden`, written; set 0, binding 5.
        pub hidden: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 6] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.members) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.solids) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.triangles) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.bins) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.balls) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.hidden) },
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
/// The stage `synth/picture.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod picture_comp {
    // Accesses are as declared: naga cannot read this stage (unsupported instruction UMulExtended at Function).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "synth/picture.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<45346, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/synth/picture.comp.spv"))),
        workgroup_size: [8, 8, 1],
        push_size: 4,
        bindings: &[
            crate::gpu::BindingLayout { name: "Members", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Solids", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Triangles", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Bins", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Views", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Finishes", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Directions", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Plates", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Floors", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Shades", set: 0, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Pictures", set: 0, binding: 11, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::PicturePush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Members`, read; set 0, binding 0.
        pub members: &'a crate::gpu::Buffer,
        /// Storage buffer `Solids`, read; set 0, binding 1.
        pub solids: &'a crate::gpu::Buffer,
        /// Storage buffer `Triangles`, read; set 0, binding 2.
        pub triangles: &'a crate::gpu::Buffer,
        /// Storage buffer `Bins`, read; set 0, binding 3.
        pub bins: &'a crate::gpu::Buffer,
        /// Storage buffer `Views`, read; set 0, binding 4.
        pub views: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 5.
        pub tiles: &'a crate::gpu::Buffer,
        /// Storage buffer `Finishes`, read; set 0, binding 6.
        pub finishes: &'a crate::gpu::Buffer,
        /// Storage buffer `Directions`, read; set 0, binding 7.
        pub directions: &'a crate::gpu::Buffer,
        /// Storage buffer `Plates`, read; set 0, binding 8.
        pub plates: &'a crate::gpu::Buffer,
        /// Storage buffer `Floors`, read; set 0, binding 9.
        pub floors: &'a crate::gpu::Buffer,
        /// Storage buffer `Shades`, read; set 0, binding 10.
        pub shades: &'a crate::gpu::Buffer,
        /// Storage buffer `Pictures`, written; set 0, binding 11.
        pub pictures: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 12] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.members) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.solids) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.triangles) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.bins) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.views) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.tiles) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.finishes) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.directions) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.plates) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.floors) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.shades) },
                crate::gpu::Binding { layout: &SHADER.bindings[11], bound: crate::gpu::Bound::Buffer(self.pictures) },
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
/// The stage `synth/soften.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod soften_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "synth/soften.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<749, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/synth/soften.comp.spv"))),
        workgroup_size: [8, 8, 1],
        push_size: 0,
        bindings: &[
            crate::gpu::BindingLayout { name: "Hidden", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Shades", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
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
        /// Storage buffer `Hidden`, read; set 0, binding 0.
        pub hidden: &'a crate::gpu::Buffer,
        /// Storage buffer `Shades`, written; set 0, binding 1.
        pub shades: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.hidden) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.shades) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(), bindings, push: Vec::new(), groups }
        }
    }
}
/// Memory layouts of the blocks.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub mod layout {
    /// `Finish` in memory, 928 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Finish {
        /// `tint` at byte 0.
        pub tint: [f32; 4],
        /// `material` at byte 16.
        pub material: Material,
    }
    const _: () = assert!(size_of::<Finish>() == 928);
    const _: () = assert!(std::mem::offset_of!(Finish, tint) == 0);
    const _: () = assert!(std::mem::offset_of!(Finish, material) == 16);
    /// `Material` in memory, 912 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Material {
        /// `kind` at byte 0.
        pub kind: u32,
        /// Padding.
        pub _pad0: [u32; 1],
        /// `dice` at byte 8.
        pub dice: [[u32; 2]; 3],
        /// `numbers` at byte 32.
        pub numbers: [f32; 24],
        /// `sums` at byte 128.
        pub sums: [u32; 4],
        /// `octaves` at byte 144.
        pub octaves: [NoiseOctave; 16],
    }
    const _: () = assert!(size_of::<Material>() == 912);
    const _: () = assert!(std::mem::offset_of!(Material, kind) == 0);
    const _: () = assert!(std::mem::offset_of!(Material, dice) == 8);
    const _: () = assert!(std::mem::offset_of!(Material, numbers) == 32);
    const _: () = assert!(std::mem::offset_of!(Material, sums) == 128);
    const _: () = assert!(std::mem::offset_of!(Material, octaves) == 144);
    /// `Member` in memory, 96 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Member {
        /// `to_light` at byte 0.
        pub to_light: [f32; 4],
        /// `across` at byte 16.
        pub across: [[f32; 4]; 2],
        /// `bins_origin` at byte 48.
        pub bins_origin: [f32; 2],
        /// `bins_size` at byte 56.
        pub bins_size: [u32; 2],
        /// `bin_width` at byte 64.
        pub bin_width: f32,
        /// `first_bin` at byte 68.
        pub first_bin: u32,
        /// `is_mesh` at byte 72.
        pub is_mesh: u32,
        /// `first_pair` at byte 76.
        pub first_pair: u32,
        /// `pairs` at byte 80.
        pub pairs: u32,
        /// `pad0` at byte 84.
        pub pad0: u32,
        /// `floor_middle` at byte 88.
        pub floor_middle: [f32; 2],
    }
    const _: () = assert!(size_of::<Member>() == 96);
    const _: () = assert!(std::mem::offset_of!(Member, to_light) == 0);
    const _: () = assert!(std::mem::offset_of!(Member, across) == 16);
    const _: () = assert!(std::mem::offset_of!(Member, bins_origin) == 48);
    const _: () = assert!(std::mem::offset_of!(Member, bins_size) == 56);
    const _: () = assert!(std::mem::offset_of!(Member, bin_width) == 64);
    const _: () = assert!(std::mem::offset_of!(Member, first_bin) == 68);
    const _: () = assert!(std::mem::offset_of!(Member, is_mesh) == 72);
    const _: () = assert!(std::mem::offset_of!(Member, first_pair) == 76);
    const _: () = assert!(std::mem::offset_of!(Member, pairs) == 80);
    const _: () = assert!(std::mem::offset_of!(Member, pad0) == 84);
    const _: () = assert!(std::mem::offset_of!(Member, floor_middle) == 88);
    /// `NoiseOctave` in memory, 48 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct NoiseOctave {
        /// `scale` at byte 0.
        pub scale: [f32; 3],
        /// `state` at byte 12.
        pub state: u32,
        /// `frequency` at byte 16.
        pub frequency: [f32; 3],
        /// `amplitude` at byte 28.
        pub amplitude: f32,
        /// `period` at byte 32.
        pub period: [i32; 3],
        /// Padding.
        pub _pad0: [u32; 1],
    }
    const _: () = assert!(size_of::<NoiseOctave>() == 48);
    const _: () = assert!(std::mem::offset_of!(NoiseOctave, scale) == 0);
    const _: () = assert!(std::mem::offset_of!(NoiseOctave, state) == 12);
    const _: () = assert!(std::mem::offset_of!(NoiseOctave, frequency) == 16);
    const _: () = assert!(std::mem::offset_of!(NoiseOctave, amplitude) == 28);
    const _: () = assert!(std::mem::offset_of!(NoiseOctave, period) == 32);
    /// `OccludePush` in memory, 4 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct OccludePush {
        /// `members` at byte 0.
        pub members: u32,
    }
    const _: () = assert!(size_of::<OccludePush>() == 4);
    const _: () = assert!(std::mem::offset_of!(OccludePush, members) == 0);
    /// `PicturePush` in memory, 4 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct PicturePush {
        /// `members` at byte 0.
        pub members: u32,
    }
    const _: () = assert!(size_of::<PicturePush>() == 4);
    const _: () = assert!(std::mem::offset_of!(PicturePush, members) == 0);
    /// `Solid` in memory, 128 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Solid {
        /// `local` at byte 0.
        pub local: [[f32; 4]; 3],
        /// `object` at byte 48.
        pub object: [[f32; 4]; 3],
        /// `centre` at byte 96.
        pub centre: [f32; 4],
        /// `is_capsule` at byte 112.
        pub is_capsule: u32,
        /// `look` at byte 116.
        pub look: u32,
        /// `finish` at byte 120.
        pub finish: u32,
        /// `is_jaw` at byte 124.
        pub is_jaw: u32,
    }
    const _: () = assert!(size_of::<Solid>() == 128);
    const _: () = assert!(std::mem::offset_of!(Solid, local) == 0);
    const _: () = assert!(std::mem::offset_of!(Solid, object) == 48);
    const _: () = assert!(std::mem::offset_of!(Solid, centre) == 96);
    const _: () = assert!(std::mem::offset_of!(Solid, is_capsule) == 112);
    const _: () = assert!(std::mem::offset_of!(Solid, look) == 116);
    const _: () = assert!(std::mem::offset_of!(Solid, finish) == 120);
    const _: () = assert!(std::mem::offset_of!(Solid, is_jaw) == 124);
    /// `Triangle` in memory, 160 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Triangle {
        /// `corner` at byte 0.
        pub corner: [f32; 4],
        /// `edges` at byte 16.
        pub edges: [[f32; 4]; 2],
        /// `normals` at byte 48.
        pub normals: [[f32; 4]; 3],
        /// `rest` at byte 96.
        pub rest: [[f32; 4]; 3],
        /// `look` at byte 144.
        pub look: u32,
        /// `finish` at byte 148.
        pub finish: u32,
        /// `pad0` at byte 152.
        pub pad0: u32,
        /// `pad1` at byte 156.
        pub pad1: u32,
    }
    const _: () = assert!(size_of::<Triangle>() == 160);
    const _: () = assert!(std::mem::offset_of!(Triangle, corner) == 0);
    const _: () = assert!(std::mem::offset_of!(Triangle, edges) == 16);
    const _: () = assert!(std::mem::offset_of!(Triangle, normals) == 48);
    const _: () = assert!(std::mem::offset_of!(Triangle, rest) == 96);
    const _: () = assert!(std::mem::offset_of!(Triangle, look) == 144);
    const _: () = assert!(std::mem::offset_of!(Triangle, finish) == 148);
    const _: () = assert!(std::mem::offset_of!(Triangle, pad0) == 152);
    const _: () = assert!(std::mem::offset_of!(Triangle, pad1) == 156);
    /// `View` in memory, 48 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct View {
        /// `centre` at byte 0.
        pub centre: [f32; 3],
        /// `is_wanted` at byte 12.
        pub is_wanted: u32,
        /// `size` at byte 16.
        pub size: [u32; 2],
        /// `first_pixel` at byte 24.
        pub first_pixel: u32,
        /// `first_corner` at byte 28.
        pub first_corner: u32,
        /// `first_tile` at byte 32.
        pub first_tile: u32,
        /// `columns` at byte 36.
        pub columns: u32,
        /// `tiles` at byte 40.
        pub tiles: u32,
        /// `pad0` at byte 44.
        pub pad0: u32,
    }
    const _: () = assert!(size_of::<View>() == 48);
    const _: () = assert!(std::mem::offset_of!(View, centre) == 0);
    const _: () = assert!(std::mem::offset_of!(View, is_wanted) == 12);
    const _: () = assert!(std::mem::offset_of!(View, size) == 16);
    const _: () = assert!(std::mem::offset_of!(View, first_pixel) == 24);
    const _: () = assert!(std::mem::offset_of!(View, first_corner) == 28);
    const _: () = assert!(std::mem::offset_of!(View, first_tile) == 32);
    const _: () = assert!(std::mem::offset_of!(View, columns) == 36);
    const _: () = assert!(std::mem::offset_of!(View, tiles) == 40);
    const _: () = assert!(std::mem::offset_of!(View, pad0) == 44);
}
/// Every stage of the folder, for tests that try them all.
#[cfg(test)]
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub static SHADERS: &[&crate::gpu::Shader] = &[&occlude_comp::SHADER, &picture_comp::SHADER, &soften_comp::SHADER];
