/// Coordinates beyond 1e25 count as this, as their bits.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const FARTHEST_BITS: u32 = 1761892689;
/// Materials, as the library numbers them; 0 is none. Scenes' stages have those up to MATERIALS_OF_CLOTHES.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_CLOUDS: u32 = 1;
/// `MATERIAL_LAVA` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_LAVA: u32 = 2;
/// `MATERIAL_MARBLE` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_MARBLE: u32 = 3;
/// `MATERIAL_GRANITE` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_GRANITE: u32 = 4;
/// `MATERIAL_WOOD` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_WOOD: u32 = 5;
/// `MATERIAL_BRICK` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_BRICK: u32 = 6;
/// `MATERIAL_FABRIC` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_FABRIC: u32 = 7;
/// `MATERIAL_TIMBER` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_TIMBER: u32 = 8;
/// `MATERIALS_OF_CLOTHES` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIALS_OF_CLOTHES: u32 = 8;
/// `MATERIAL_GRASS` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_GRASS: u32 = 9;
/// `MATERIAL_SKIN` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_SKIN: u32 = 10;
/// `MATERIAL_FRACTAL` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_FRACTAL: u32 = 11;
/// `MATERIAL_TERRAIN` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_TERRAIN: u32 = 12;
/// Numbers, sums of noise and octaves of them all that describe a material at most.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_NUMBERS: u32 = 24;
/// `MATERIAL_SUMS` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_SUMS: u32 = 4;
/// `MATERIAL_OCTAVES` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MATERIAL_OCTAVES: u32 = 16;
/// What a picture of a material shows: its colours, its heights, its colours where rays meet a lit object.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const SHOWS_COLOURS: u32 = 0;
/// `SHOWS_HEIGHTS` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const SHOWS_HEIGHTS: u32 = 1;
/// `SHOWS_RAYS` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const SHOWS_RAYS: u32 = 2;
/// What a pass of mid-point displacement does: middles of squares, middles of sides, the least and the greatest height, all to [0, 1].
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const DISPLACES_SQUARES: u32 = 0;
/// `DISPLACES_SIDES` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const DISPLACES_SIDES: u32 = 1;
/// `DISPLACES_EXTREMES` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const DISPLACES_EXTREMES: u32 = 2;
/// `DISPLACES_SCALING` of `texture/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const DISPLACES_SCALING: u32 = 3;
/// The stage `texture/displace.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod displace_comp {
    // Accesses are as declared: naga cannot read this stage (unsupported instruction UMulExtended at Function).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "texture/displace.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2152, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/texture/displace.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 20,
        bindings: &[
            crate::gpu::BindingLayout { name: "Surface", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Extremes", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "DISPLACES", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `DISPLACES`, 0 by default.
        pub displaces: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { displaces: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.displaces), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Displace;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Surface`, read and written; set 0, binding 0.
        pub surface: &'a crate::gpu::Buffer,
        /// Storage buffer `Extremes`, read and written; set 0, binding 1.
        pub extremes: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.surface) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.extremes) },
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
/// The stage `texture/matching.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod matching_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "texture/matching.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<649, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/texture/matching.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 0,
        bindings: &[
            crate::gpu::BindingLayout { name: "Example", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "KnownPixels", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "KnownWeights", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "request", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Errors", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
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
        /// Storage buffer `Example`, read; set 0, binding 0.
        pub example: &'a crate::gpu::Buffer,
        /// Storage buffer `KnownPixels`, read; set 0, binding 1.
        pub known_pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `KnownWeights`, read; set 0, binding 2.
        pub known_weights: &'a crate::gpu::Buffer,
        /// Storage buffer `Request`, read; set 0, binding 3.
        pub request: &'a crate::gpu::Buffer,
        /// Storage buffer `Errors`, written; set 0, binding 4.
        pub errors: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 5] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.example) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.known_pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.known_weights) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.request) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.errors) },
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
/// The stage `texture/material.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod material_comp {
    // Accesses are as declared: naga cannot read this stage (unsupported instruction UMulExtended at Function).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "texture/material.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<73980, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/texture/material.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 0,
        bindings: &[
            crate::gpu::BindingLayout { name: "Materials", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tables", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "noise_tables", set: 0, binding: 2, kind: crate::gpu::BindingKind::SampledImage, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "noise_volume", set: 0, binding: 3, kind: crate::gpu::BindingKind::SampledImage, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllRequests", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Rays", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Words", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "KIND", id: 0, default: 1 },
            crate::gpu::SpecConstant { name: "WAY", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "SHOWS", id: 2, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `KIND`, 1 by default.
        pub kind: u32,
        /// `WAY`, 0 by default.
        pub way: u32,
        /// `SHOWS`, 0 by default.
        pub shows: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { kind: 1, way: 0, shows: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.kind), (1, constants.way), (2, constants.shows), ] }
    }
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Materials`, read; set 0, binding 0.
        pub materials: &'a crate::gpu::Buffer,
        /// Storage buffer `Tables`, read; set 0, binding 1.
        pub tables: &'a crate::gpu::Buffer,
        /// Texture, read; set 0, binding 2.
        pub noise_tables: &'a crate::gpu::Image,
        /// Texture, read; set 0, binding 3.
        pub noise_volume: &'a crate::gpu::Image,
        /// Storage buffer `AllRequests`, read; set 0, binding 4.
        pub all_requests: &'a crate::gpu::Buffer,
        /// Storage buffer `Rays`, read; set 0, binding 5.
        pub rays: &'a crate::gpu::Buffer,
        /// Storage buffer `Words`, written; set 0, binding 6.
        pub words: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 7] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.materials) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.tables) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Image(self.noise_tables) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Image(self.noise_volume) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_requests) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.rays) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.words) },
            ]
        }
    }
    impl<'a> Bindings<'a> {
        /// A run on them.
        pub fn dispatch(self, constants: Constants, groups: crate::gpu::Groups<'a>)
            -> crate::gpu::Dispatch<'a> {
            let bindings = self.bound().to_vec();
            crate::gpu::Dispatch { stage: stage(constants), bindings, push: Vec::new(), groups }
        }
    }
}
/// The stage `texture/noise.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod noise_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "texture/noise.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<22125, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/texture/noise.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 8,
        bindings: &[
            crate::gpu::BindingLayout { name: "Points", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllOctaves", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tables", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Values", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Words", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "DIMENSIONS", id: 0, default: 3 },
            crate::gpu::SpecConstant { name: "KIND", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "SUM", id: 2, default: 0 },
            crate::gpu::SpecConstant { name: "SOURCE", id: 3, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `DIMENSIONS`, 3 by default.
        pub dimensions: u32,
        /// `KIND`, 0 by default.
        pub kind: u32,
        /// `SUM`, 0 by default.
        pub sum: u32,
        /// `SOURCE`, 0 by default.
        pub source: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { dimensions: 3, kind: 0, sum: 0, source: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.dimensions), (1, constants.kind), (2, constants.sum), (3, constants.source), ] }
    }
    /// Push constants.
    pub type Push = super::layout::NoisePush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Points`, read; set 0, binding 0.
        pub points: &'a crate::gpu::Buffer,
        /// Storage buffer `AllOctaves`, read; set 0, binding 1.
        pub all_octaves: &'a crate::gpu::Buffer,
        /// Storage buffer `Tables`, read; set 0, binding 2.
        pub tables: &'a crate::gpu::Buffer,
        /// Storage buffer `Values`, written; set 0, binding 3.
        pub values: &'a crate::gpu::Buffer,
        /// Storage buffer `Words`, written; set 0, binding 4.
        pub words: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 5] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.points) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_octaves) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.tables) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.values) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.words) },
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
/// The stage `texture/noise_image.frag`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod noise_image_frag {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "texture/noise_image.frag",
        kind: crate::gpu::ShaderKind::Fragment,
        spirv: &crate::gpu::words::<21794, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/texture/noise_image.frag.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 8,
        bindings: &[
            crate::gpu::BindingLayout { name: "Points", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllOctaves", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tables", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "DIMENSIONS", id: 0, default: 3 },
            crate::gpu::SpecConstant { name: "KIND", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "SUM", id: 2, default: 0 },
            crate::gpu::SpecConstant { name: "SOURCE", id: 3, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `DIMENSIONS`, 3 by default.
        pub dimensions: u32,
        /// `KIND`, 0 by default.
        pub kind: u32,
        /// `SUM`, 0 by default.
        pub sum: u32,
        /// `SOURCE`, 0 by default.
        pub source: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { dimensions: 3, kind: 0, sum: 0, source: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.dimensions), (1, constants.kind), (2, constants.sum), (3, constants.source), ] }
    }
    /// Push constants.
    pub type Push = super::layout::NoiseImagePush;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Points`, read; set 0, binding 0.
        pub points: &'a crate::gpu::Buffer,
        /// Storage buffer `AllOctaves`, read; set 0, binding 1.
        pub all_octaves: &'a crate::gpu::Buffer,
        /// Storage buffer `Tables`, read; set 0, binding 2.
        pub tables: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.points) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_octaves) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.tables) },
            ]
        }
    }
}
/// The stage `texture/noise_image.vert`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod noise_image_vert {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "texture/noise_image.vert",
        kind: crate::gpu::ShaderKind::Vertex,
        spirv: &crate::gpu::words::<213, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/texture/noise_image.vert.spv"))),
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
/// Memory layouts of the blocks.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub mod layout {
    /// `AllRequests` in memory, 48 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct AllRequests {
        /// `request` at byte 0.
        pub request: PictureRequest,
    }
    const _: () = assert!(size_of::<AllRequests>() == 48);
    const _: () = assert!(std::mem::offset_of!(AllRequests, request) == 0);
    /// `Displace` in memory, 20 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Displace {
        /// `first` at byte 0.
        pub first: u32,
        /// `side` at byte 4.
        pub side: u32,
        /// `halved` at byte 8.
        pub halved: u32,
        /// `seed` at byte 12.
        pub seed: u32,
        /// `amplitude` at byte 16.
        pub amplitude: f32,
    }
    const _: () = assert!(size_of::<Displace>() == 20);
    const _: () = assert!(std::mem::offset_of!(Displace, first) == 0);
    const _: () = assert!(std::mem::offset_of!(Displace, side) == 4);
    const _: () = assert!(std::mem::offset_of!(Displace, halved) == 8);
    const _: () = assert!(std::mem::offset_of!(Displace, seed) == 12);
    const _: () = assert!(std::mem::offset_of!(Displace, amplitude) == 16);
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
    /// `Materials` in memory, 912 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Materials {
        /// `material` at byte 0.
        pub material: Material,
    }
    const _: () = assert!(size_of::<Materials>() == 912);
    const _: () = assert!(std::mem::offset_of!(Materials, material) == 0);
    /// `NoiseImagePush` in memory, 8 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct NoiseImagePush {
        /// `width` at byte 0.
        pub width: u32,
        /// `octaves` at byte 4.
        pub octaves: u32,
    }
    const _: () = assert!(size_of::<NoiseImagePush>() == 8);
    const _: () = assert!(std::mem::offset_of!(NoiseImagePush, width) == 0);
    const _: () = assert!(std::mem::offset_of!(NoiseImagePush, octaves) == 4);
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
    /// `NoisePush` in memory, 8 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct NoisePush {
        /// `count` at byte 0.
        pub count: u32,
        /// `octaves` at byte 4.
        pub octaves: u32,
    }
    const _: () = assert!(size_of::<NoisePush>() == 8);
    const _: () = assert!(std::mem::offset_of!(NoisePush, count) == 0);
    const _: () = assert!(std::mem::offset_of!(NoisePush, octaves) == 4);
    /// `Octave` in memory, 48 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Octave {
        /// `frequency` at byte 0.
        pub frequency: [f32; 4],
        /// `period` at byte 16.
        pub period: [i32; 4],
        /// `amplitude` at byte 32.
        pub amplitude: f32,
        /// `state` at byte 36.
        pub state: u32,
        /// Padding.
        pub _pad0: [u32; 2],
    }
    const _: () = assert!(size_of::<Octave>() == 48);
    const _: () = assert!(std::mem::offset_of!(Octave, frequency) == 0);
    const _: () = assert!(std::mem::offset_of!(Octave, period) == 16);
    const _: () = assert!(std::mem::offset_of!(Octave, amplitude) == 32);
    const _: () = assert!(std::mem::offset_of!(Octave, state) == 36);
    /// `PictureRequest` in memory, 48 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct PictureRequest {
        /// `size` at byte 0.
        pub size: [u32; 2],
        /// `first` at byte 8.
        pub first: u32,
        /// `pixels` at byte 12.
        pub pixels: u32,
        /// `offset` at byte 16.
        pub offset: [f32; 3],
        /// `pixel` at byte 28.
        pub pixel: f32,
        /// `samples` at byte 32.
        pub samples: u32,
        /// Padding.
        pub _pad0: [u32; 3],
    }
    const _: () = assert!(size_of::<PictureRequest>() == 48);
    const _: () = assert!(std::mem::offset_of!(PictureRequest, size) == 0);
    const _: () = assert!(std::mem::offset_of!(PictureRequest, first) == 8);
    const _: () = assert!(std::mem::offset_of!(PictureRequest, pixels) == 12);
    const _: () = assert!(std::mem::offset_of!(PictureRequest, offset) == 16);
    const _: () = assert!(std::mem::offset_of!(PictureRequest, pixel) == 28);
    const _: () = assert!(std::mem::offset_of!(PictureRequest, samples) == 32);
    /// `Request` in memory, 28 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Request {
        /// `groups` at byte 0.
        pub groups: [u32; 3],
        /// `width` at byte 12.
        pub width: u32,
        /// `columns` at byte 16.
        pub columns: u32,
        /// `placements` at byte 20.
        pub placements: u32,
        /// `known_count` at byte 24.
        pub known_count: u32,
    }
    const _: () = assert!(size_of::<Request>() == 28);
    const _: () = assert!(std::mem::offset_of!(Request, groups) == 0);
    const _: () = assert!(std::mem::offset_of!(Request, width) == 12);
    const _: () = assert!(std::mem::offset_of!(Request, columns) == 16);
    const _: () = assert!(std::mem::offset_of!(Request, placements) == 20);
    const _: () = assert!(std::mem::offset_of!(Request, known_count) == 24);
}
/// Every stage of the folder, for tests that try them all.
#[cfg(test)]
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub static SHADERS: &[&crate::gpu::Shader] = &[&displace_comp::SHADER, &matching_comp::SHADER, &material_comp::SHADER, &noise_comp::SHADER, &noise_image_frag::SHADER, &noise_image_vert::SHADER];
