/// Largest side of a picture, pixels.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LARGEST_SIDE: u32 = 16384;
/// Corners farther from the origin than this, in x or y, have no image.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const FARTHEST_PIXEL: f32 = 16384.0;
/// Most invocations of a workgroup of the projection, and how many are usual; also the most parts that a body may have there.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const PROJECT_GROUP: u32 = 128;
/// Invocations of a workgroup that places images in the framebuffer.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const PLACE_GROUP: u32 = 64;
/// Invocations of a workgroup of the comparison, and how many there may be; powers of two.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const COMPARE_GROUP: u32 = 128;
/// `MOST_COMPARE_GROUP` of `evaluate/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MOST_COMPARE_GROUP: u32 = 256;
/// How a candidate's pixel is a byte: the largest of 2 rank + edge, or the nearest label with bit 7 on edges; or, wrong where parts or
/// candidates overlap, the largest label that passes the depth test, of all channels at once.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const PACK_MAX: u32 = 0;
/// `PACK_DEPTH` of `evaluate/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const PACK_DEPTH: u32 = 1;
/// `PACK_AT_ONCE` of `evaluate/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const PACK_AT_ONCE: u32 = 2;
/// Invocations of a workgroup that draws and compares an image, a row each, and how many there may be; powers of two.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const RASTER_GROUP: u32 = 32;
/// `MOST_RASTER_GROUP` of `evaluate/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MOST_RASTER_GROUP: u32 = 256;
/// Parts whose corners, or edges, it keeps at once.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const RASTER_PARTS: u32 = 32;
/// Words of a row that it draws at once, and how many there may be: fewer compute the spans of wide parts more often, more make masks of
/// nothing.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const RASTER_WORDS: u32 = 3;
/// `MOST_RASTER_WORDS` of `evaluate/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MOST_RASTER_WORDS: u32 = 4;
/// Most segments that observations tell apart.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MOST_SEGMENTS: u32 = 8;
/// The code of evidence that says nothing.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const EVIDENCE_NEUTRAL: u32 = 7;
/// Labels of parts, 0 for nothing.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LABELS: u32 = 128;
/// Codes of a framebuffer's parts that the comparison by segments keeps in registers: a word holds a bit of each.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const SHORT_CODES: u32 = 32;
/// Invocations of a workgroup of the objective.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const OBJECTIVE_GROUP: u32 = 64;
/// Invocations of a workgroup of the mesh's stages.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MESH_GROUP: u32 = 64;
/// The depth of a point of the mesh at camera-space z mm is 1 - MESH_NEAR / z; silhouette edges are brought nearer by the bias,
/// and what is nearer than MESH_NEAREST has no image.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MESH_NEAR: f32 = 100.0;
/// `MESH_EDGE_BIAS` of `evaluate/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MESH_EDGE_BIAS: f32 = 30.0;
/// `MESH_NEAREST` of `evaluate/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MESH_NEAREST: f32 = 200.0;
/// Invocations of a workgroup that draws and compares tiles of an image of a mesh; the pixels that it keeps in shared memory, of which
/// every device has 16 KiB, and the most words of them in a row.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MESH_RASTER_GROUP: u32 = 64;
/// `MESH_KEYS` of `evaluate/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MESH_KEYS: u32 = 3584;
/// `MESH_WORDS` of `evaluate/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MESH_WORDS: u32 = 8;
/// Vertices that a silhouette edge is drawn with: two triangles.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const OUTLINE_VERTICES: u32 = 6;
/// The stage `evaluate/bind.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod bind_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/bind.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<858, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/bind.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 32,
        bindings: &[
            crate::gpu::BindingLayout { name: "World", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "InverseBind", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Skin", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::MeshBatch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `World`, read; set 0, binding 0.
        pub world: &'a crate::gpu::Buffer,
        /// Storage buffer `InverseBind`, read; set 0, binding 1.
        pub inverse_bind: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 2.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Skin`, written; set 0, binding 3.
        pub skin: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, written; set 0, binding 4.
        pub all_bounds: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 5] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.world) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.inverse_bind) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.skin) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
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
/// The stage `evaluate/compare_shared.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod compare_shared_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [17] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/compare_shared.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2150, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/compare_shared.comp.spv"))),
        workgroup_size: [128, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Pixels", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "framebuffer", set: 0, binding: 5, kind: crate::gpu::BindingKind::SampledImage, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "EDGE_BIT", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "IGNORES", id: 3, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 4, default: 128 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `EDGE_BIT`, 0 by default.
        pub edge_bit: u32,
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 128 by default.
        pub local_size_x: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { edge_bit: 0, ignores: false, local_size_x: 128, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.edge_bit), (3, u32::from(constants.ignores)), (4, constants.local_size_x), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Placements`, read; set 0, binding 0.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 1.
        pub tiles: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 2.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Pixels`, read; set 0, binding 3.
        pub pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read and written; set 0, binding 4.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Texture, read; set 0, binding 5.
        pub framebuffer: &'a crate::gpu::Image,
        /// Storage buffer `Counted`, read; set 0, binding 10.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 7] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.tiles) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Image(self.framebuffer) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/compare_shared_segments.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod compare_shared_segments_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [19] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/compare_shared_segments.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<5341, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/compare_shared_segments.comp.spv"))),
        workgroup_size: [128, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Pixels", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "framebuffer", set: 0, binding: 5, kind: crate::gpu::BindingKind::SampledImage, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "SegmentPixels", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSegmentSums", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "EDGE_BIT", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "CODES", id: 1, default: 128 },
            crate::gpu::SpecConstant { name: "SEGMENTS", id: 2, default: 8 },
            crate::gpu::SpecConstant { name: "IGNORES", id: 3, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 4, default: 128 },
            crate::gpu::SpecConstant { name: "SEGMENT_EDGES", id: 5, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `EDGE_BIT`, 0 by default.
        pub edge_bit: u32,
        /// `CODES`, 128 by default.
        pub codes: u32,
        /// `SEGMENTS`, 8 by default.
        pub segments: u32,
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 128 by default.
        pub local_size_x: u32,
        /// `SEGMENT_EDGES`, false by default.
        pub segment_edges: bool,
    }
    impl Default for Constants {
        fn default() -> Self { Self { edge_bit: 0, codes: 128, segments: 8, ignores: false, local_size_x: 128, segment_edges: false, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.edge_bit), (1, constants.codes), (2, constants.segments), (3, u32::from(constants.ignores)), (4, constants.local_size_x), (5, u32::from(constants.segment_edges)), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Placements`, read; set 0, binding 0.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 1.
        pub tiles: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 2.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Pixels`, read; set 0, binding 3.
        pub pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read and written; set 0, binding 4.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Texture, read; set 0, binding 5.
        pub framebuffer: &'a crate::gpu::Image,
        /// Storage buffer `SegmentTable`, read; set 0, binding 6.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, read; set 0, binding 7.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `SegmentPixels`, read; set 0, binding 8.
        pub segment_pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSegmentSums`, read and written; set 0, binding 9.
        pub all_segment_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 10.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 11] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.tiles) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Image(self.framebuffer) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.segment_pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.all_segment_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/compare_subgroup.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod compare_subgroup_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [17] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/compare_subgroup.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2341, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/compare_subgroup.comp.spv"))),
        workgroup_size: [128, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Pixels", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "framebuffer", set: 0, binding: 5, kind: crate::gpu::BindingKind::SampledImage, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "EDGE_BIT", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "IGNORES", id: 3, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 4, default: 128 },
            crate::gpu::SpecConstant { name: "FULL_SUBGROUP", id: 31, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `EDGE_BIT`, 0 by default.
        pub edge_bit: u32,
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 128 by default.
        pub local_size_x: u32,
        /// `FULL_SUBGROUP`, 0 by default.
        pub full_subgroup: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { edge_bit: 0, ignores: false, local_size_x: 128, full_subgroup: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.edge_bit), (3, u32::from(constants.ignores)), (4, constants.local_size_x), (31, constants.full_subgroup), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Placements`, read; set 0, binding 0.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 1.
        pub tiles: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 2.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Pixels`, read; set 0, binding 3.
        pub pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read and written; set 0, binding 4.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Texture, read; set 0, binding 5.
        pub framebuffer: &'a crate::gpu::Image,
        /// Storage buffer `Counted`, read; set 0, binding 10.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 7] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.tiles) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Image(self.framebuffer) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/compare_subgroup_segments.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod compare_subgroup_segments_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [19] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/compare_subgroup_segments.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<5661, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/compare_subgroup_segments.comp.spv"))),
        workgroup_size: [128, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Pixels", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "framebuffer", set: 0, binding: 5, kind: crate::gpu::BindingKind::SampledImage, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "SegmentPixels", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSegmentSums", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "EDGE_BIT", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "CODES", id: 1, default: 128 },
            crate::gpu::SpecConstant { name: "SEGMENTS", id: 2, default: 8 },
            crate::gpu::SpecConstant { name: "IGNORES", id: 3, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 4, default: 128 },
            crate::gpu::SpecConstant { name: "SEGMENT_EDGES", id: 5, default: 0 },
            crate::gpu::SpecConstant { name: "FULL_SUBGROUP", id: 31, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `EDGE_BIT`, 0 by default.
        pub edge_bit: u32,
        /// `CODES`, 128 by default.
        pub codes: u32,
        /// `SEGMENTS`, 8 by default.
        pub segments: u32,
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 128 by default.
        pub local_size_x: u32,
        /// `SEGMENT_EDGES`, false by default.
        pub segment_edges: bool,
        /// `FULL_SUBGROUP`, 0 by default.
        pub full_subgroup: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { edge_bit: 0, codes: 128, segments: 8, ignores: false, local_size_x: 128, segment_edges: false, full_subgroup: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.edge_bit), (1, constants.codes), (2, constants.segments), (3, u32::from(constants.ignores)), (4, constants.local_size_x), (5, u32::from(constants.segment_edges)), (31, constants.full_subgroup), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Placements`, read; set 0, binding 0.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 1.
        pub tiles: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 2.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Pixels`, read; set 0, binding 3.
        pub pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read and written; set 0, binding 4.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Texture, read; set 0, binding 5.
        pub framebuffer: &'a crate::gpu::Image,
        /// Storage buffer `SegmentTable`, read; set 0, binding 6.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, read; set 0, binding 7.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `SegmentPixels`, read; set 0, binding 8.
        pub segment_pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSegmentSums`, read and written; set 0, binding 9.
        pub all_segment_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 10.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 11] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.tiles) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Image(self.framebuffer) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.segment_pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.all_segment_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/compare_texels.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod compare_texels_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [17] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/compare_texels.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<3566, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/compare_texels.comp.spv"))),
        workgroup_size: [128, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Pixels", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "framebuffer", set: 0, binding: 5, kind: crate::gpu::BindingKind::SampledImage, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "EDGE_BIT", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "IGNORES", id: 3, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 4, default: 128 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `EDGE_BIT`, 0 by default.
        pub edge_bit: u32,
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 128 by default.
        pub local_size_x: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { edge_bit: 0, ignores: false, local_size_x: 128, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.edge_bit), (3, u32::from(constants.ignores)), (4, constants.local_size_x), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Placements`, read; set 0, binding 0.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 1.
        pub tiles: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 2.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Pixels`, read; set 0, binding 3.
        pub pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read and written; set 0, binding 4.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Texture, read; set 0, binding 5.
        pub framebuffer: &'a crate::gpu::Image,
        /// Storage buffer `Counted`, read; set 0, binding 10.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 7] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.tiles) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Image(self.framebuffer) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/compare_texels_segments.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod compare_texels_segments_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [19] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/compare_texels_segments.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<10619, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/compare_texels_segments.comp.spv"))),
        workgroup_size: [128, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Pixels", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "framebuffer", set: 0, binding: 5, kind: crate::gpu::BindingKind::SampledImage, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "SegmentPixels", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSegmentSums", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "EDGE_BIT", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "CODES", id: 1, default: 128 },
            crate::gpu::SpecConstant { name: "SEGMENTS", id: 2, default: 8 },
            crate::gpu::SpecConstant { name: "IGNORES", id: 3, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 4, default: 128 },
            crate::gpu::SpecConstant { name: "SEGMENT_EDGES", id: 5, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `EDGE_BIT`, 0 by default.
        pub edge_bit: u32,
        /// `CODES`, 128 by default.
        pub codes: u32,
        /// `SEGMENTS`, 8 by default.
        pub segments: u32,
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 128 by default.
        pub local_size_x: u32,
        /// `SEGMENT_EDGES`, false by default.
        pub segment_edges: bool,
    }
    impl Default for Constants {
        fn default() -> Self { Self { edge_bit: 0, codes: 128, segments: 8, ignores: false, local_size_x: 128, segment_edges: false, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.edge_bit), (1, constants.codes), (2, constants.segments), (3, u32::from(constants.ignores)), (4, constants.local_size_x), (5, u32::from(constants.segment_edges)), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Placements`, read; set 0, binding 0.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 1.
        pub tiles: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 2.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Pixels`, read; set 0, binding 3.
        pub pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read and written; set 0, binding 4.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Texture, read; set 0, binding 5.
        pub framebuffer: &'a crate::gpu::Image,
        /// Storage buffer `SegmentTable`, read; set 0, binding 6.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, read; set 0, binding 7.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `SegmentPixels`, read; set 0, binding 8.
        pub segment_pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSegmentSums`, read and written; set 0, binding 9.
        pub all_segment_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 10.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 11] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.tiles) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Image(self.framebuffer) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.segment_pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.all_segment_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/draw_border.geom`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod draw_border_geom {
    // Accesses are as declared: naga cannot read this stage (unsupported execution model %3).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/draw_border.geom",
        kind: crate::gpu::ShaderKind::Geometry,
        spirv: &crate::gpu::words::<1347, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/draw_border.geom.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "PACKING", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "CHANNEL", id: 1, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `PACKING`, 0 by default.
        pub packing: u32,
        /// `CHANNEL`, 0 by default.
        pub channel: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { packing: 0, channel: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.packing), (1, constants.channel), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Quads`, read; set 0, binding 0.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `Placements`, read; set 0, binding 1.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 2.
        pub tiles: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.tiles) },
            ]
        }
    }
}
/// The stage `evaluate/draw_border.vert`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod draw_border_vert {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/draw_border.vert",
        kind: crate::gpu::ShaderKind::Vertex,
        spirv: &crate::gpu::words::<1274, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/draw_border.vert.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "PACKING", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "CHANNEL", id: 1, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `PACKING`, 0 by default.
        pub packing: u32,
        /// `CHANNEL`, 0 by default.
        pub channel: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { packing: 0, channel: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.packing), (1, constants.channel), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Quads`, read; set 0, binding 0.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `Placements`, read; set 0, binding 1.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 2.
        pub tiles: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.tiles) },
            ]
        }
    }
}
/// The stage `evaluate/draw_exact.frag`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod draw_exact_frag {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/draw_exact.frag",
        kind: crate::gpu::ShaderKind::Fragment,
        spirv: &crate::gpu::words::<1964, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/draw_exact.frag.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 0,
        bindings: &[
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "PACKING", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `PACKING`, 0 by default.
        pub packing: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { packing: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.packing), ] }
    }
}
/// The stage `evaluate/draw_exact.geom`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod draw_exact_geom {
    // Accesses are as declared: naga cannot read this stage (unsupported execution model %3).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/draw_exact.geom",
        kind: crate::gpu::ShaderKind::Geometry,
        spirv: &crate::gpu::words::<4652, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/draw_exact.geom.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "PACKING", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "CHANNEL", id: 1, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `PACKING`, 0 by default.
        pub packing: u32,
        /// `CHANNEL`, 0 by default.
        pub channel: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { packing: 0, channel: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.packing), (1, constants.channel), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Quads`, read; set 0, binding 0.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `Placements`, read; set 0, binding 1.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 2.
        pub tiles: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.tiles) },
            ]
        }
    }
}
/// The stage `evaluate/draw_exact.vert`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod draw_exact_vert {
    // Accesses are as declared: naga cannot read this stage (unsupported instruction SMulExtended at Function).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/draw_exact.vert",
        kind: crate::gpu::ShaderKind::Vertex,
        spirv: &crate::gpu::words::<4542, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/draw_exact.vert.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "PACKING", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "CHANNEL", id: 1, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `PACKING`, 0 by default.
        pub packing: u32,
        /// `CHANNEL`, 0 by default.
        pub channel: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { packing: 0, channel: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.packing), (1, constants.channel), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Quads`, read; set 0, binding 0.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `Placements`, read; set 0, binding 1.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 2.
        pub tiles: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.tiles) },
            ]
        }
    }
}
/// The stage `evaluate/draw_fill.geom`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod draw_fill_geom {
    // Accesses are as declared: naga cannot read this stage (unsupported execution model %3).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/draw_fill.geom",
        kind: crate::gpu::ShaderKind::Geometry,
        spirv: &crate::gpu::words::<1295, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/draw_fill.geom.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "PACKING", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "CHANNEL", id: 1, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `PACKING`, 0 by default.
        pub packing: u32,
        /// `CHANNEL`, 0 by default.
        pub channel: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { packing: 0, channel: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.packing), (1, constants.channel), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Quads`, read; set 0, binding 0.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `Placements`, read; set 0, binding 1.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 2.
        pub tiles: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.tiles) },
            ]
        }
    }
}
/// The stage `evaluate/draw_fill.vert`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod draw_fill_vert {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/draw_fill.vert",
        kind: crate::gpu::ShaderKind::Vertex,
        spirv: &crate::gpu::words::<1236, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/draw_fill.vert.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "PACKING", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "CHANNEL", id: 1, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `PACKING`, 0 by default.
        pub packing: u32,
        /// `CHANNEL`, 0 by default.
        pub channel: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { packing: 0, channel: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.packing), (1, constants.channel), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Quads`, read; set 0, binding 0.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `Placements`, read; set 0, binding 1.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 2.
        pub tiles: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.tiles) },
            ]
        }
    }
}
/// The stage `evaluate/draw_plain.frag`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod draw_plain_frag {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/draw_plain.frag",
        kind: crate::gpu::ShaderKind::Fragment,
        spirv: &crate::gpu::words::<357, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/draw_plain.frag.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 0,
        bindings: &[
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "PACKING", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `PACKING`, 0 by default.
        pub packing: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { packing: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.packing), ] }
    }
}
/// The stage `evaluate/draw_point.vert`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod draw_point_vert {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/draw_point.vert",
        kind: crate::gpu::ShaderKind::Vertex,
        spirv: &crate::gpu::words::<209, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/draw_point.vert.spv"))),
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
/// The stage `evaluate/evidence.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod evidence_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [19] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/evidence.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<4364, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/evidence.comp.spv"))),
        workgroup_size: [128, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "framebuffer", set: 0, binding: 5, kind: crate::gpu::BindingKind::SampledImage, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "EvidencePixels", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllEvidence", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "EDGE_BIT", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "CODES", id: 1, default: 128 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 4, default: 128 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `EDGE_BIT`, 0 by default.
        pub edge_bit: u32,
        /// `CODES`, 128 by default.
        pub codes: u32,
        /// `local_size_x`, 128 by default.
        pub local_size_x: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { edge_bit: 0, codes: 128, local_size_x: 128, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.edge_bit), (1, constants.codes), (4, constants.local_size_x), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Placements`, read; set 0, binding 0.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 1.
        pub tiles: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 2.
        pub cameras: &'a crate::gpu::Buffer,
        /// Texture, read; set 0, binding 5.
        pub framebuffer: &'a crate::gpu::Image,
        /// Storage buffer `EvidenceTable`, read; set 0, binding 6.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, read; set 0, binding 7.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidencePixels`, read; set 0, binding 8.
        pub evidence_pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `AllEvidence`, read and written; set 0, binding 9.
        pub all_evidence: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 8] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.tiles) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Image(self.framebuffer) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.evidence_pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.all_evidence) },
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
/// The stage `evaluate/evidence_at.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod evidence_at_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/evidence_at.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<579, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/evidence_at.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 8,
        bindings: &[
            crate::gpu::BindingLayout { name: "AskedPixels", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "EvidencePlanes", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "ToldCodes", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::EvidenceAt;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `AskedPixels`, read; set 0, binding 0.
        pub asked_pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidencePlanes`, read; set 0, binding 1.
        pub evidence_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `ToldCodes`, written; set 0, binding 2.
        pub told_codes: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.asked_pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.evidence_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.told_codes) },
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
/// The stage `evaluate/evidence_best.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod evidence_best_comp {
    // Accesses are as declared: naga cannot read this stage (Function [1] 'main' is invalid: Expression [132] is invalid: Operation Multiply can't work with [33] (of type Scalar(Scalar { kind: Sint, width: 4 })) and [131] (of type Scalar(Scalar { kind: Uint, width: 4 }))).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/evidence_best.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<841, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/evidence_best.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 16,
        bindings: &[
            crate::gpu::BindingLayout { name: "EvidencePlanes", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "BestEvidence", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::EvidenceBest;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `EvidencePlanes`, read; set 0, binding 0.
        pub evidence_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `BestEvidence`, read and written; set 0, binding 1.
        pub best_evidence: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.evidence_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.best_evidence) },
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
/// The stage `evaluate/evidence_codes.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod evidence_codes_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/evidence_codes.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<4536, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/evidence_codes.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 28,
        bindings: &[
            crate::gpu::BindingLayout { name: "Seen", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Sides", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "ColourTables", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Looks", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "CountedPlanes", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "EvidencePlanes", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Empty", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "IGNORES", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `IGNORES`, false by default.
        pub ignores: bool,
    }
    impl Default for Constants {
        fn default() -> Self { Self { ignores: false, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, u32::from(constants.ignores)), ] }
    }
    /// Push constants.
    pub type Push = super::layout::EvidenceView;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Seen`, read; set 0, binding 0.
        pub seen: &'a crate::gpu::Buffer,
        /// Storage buffer `Sides`, read; set 0, binding 1.
        pub sides: &'a crate::gpu::Buffer,
        /// Storage buffer `ColourTables`, read; set 0, binding 2.
        pub colour_tables: &'a crate::gpu::Buffer,
        /// Storage buffer `Looks`, read; set 0, binding 3.
        pub looks: &'a crate::gpu::Buffer,
        /// Storage buffer `CountedPlanes`, read; set 0, binding 4.
        pub counted_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidencePlanes`, written; set 0, binding 5.
        pub evidence_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `Empty`, written; set 0, binding 6.
        pub empty: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 7] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.seen) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.sides) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.colour_tables) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.looks) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.counted_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.evidence_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.empty) },
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
/// The stage `evaluate/evidence_words.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod evidence_words_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/evidence_words.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<868, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/evidence_words.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 20,
        bindings: &[
            crate::gpu::BindingLayout { name: "EvidencePlanes", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "CountedPlanes", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "EvidencePixels", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "IGNORES", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `IGNORES`, false by default.
        pub ignores: bool,
    }
    impl Default for Constants {
        fn default() -> Self { Self { ignores: false, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, u32::from(constants.ignores)), ] }
    }
    /// Push constants.
    pub type Push = super::layout::EvidenceWords;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `EvidencePlanes`, read; set 0, binding 0.
        pub evidence_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `CountedPlanes`, read; set 0, binding 1.
        pub counted_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidencePixels`, written; set 0, binding 2.
        pub evidence_pixels: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.evidence_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.counted_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.evidence_pixels) },
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
/// The stage `evaluate/mesh_edge.geom`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod mesh_edge_geom {
    // Accesses are as declared: naga cannot read this stage (unsupported execution model %3).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/mesh_edge.geom",
        kind: crate::gpu::ShaderKind::Geometry,
        spirv: &crate::gpu::words::<3181, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/mesh_edge.geom.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 32,
        bindings: &[
            crate::gpu::BindingLayout { name: "Vertices", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSeen", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "CHANNEL", id: 1, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `CHANNEL`, 0 by default.
        pub channel: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { channel: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(1, constants.channel), ] }
    }
    /// Push constants.
    pub type Push = super::layout::MeshBatch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Vertices`, read; set 0, binding 0.
        pub vertices: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSeen`, read; set 0, binding 1.
        pub all_seen: &'a crate::gpu::Buffer,
        /// Storage buffer `Placements`, read; set 0, binding 2.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 3.
        pub tiles: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.vertices) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_seen) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.tiles) },
            ]
        }
    }
}
/// The stage `evaluate/mesh_edge.vert`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod mesh_edge_vert {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/mesh_edge.vert",
        kind: crate::gpu::ShaderKind::Vertex,
        spirv: &crate::gpu::words::<2305, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/mesh_edge.vert.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 32,
        bindings: &[
            crate::gpu::BindingLayout { name: "Vertices", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSeen", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Edges", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Outlines", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "CHANNEL", id: 1, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `CHANNEL`, 0 by default.
        pub channel: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { channel: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(1, constants.channel), ] }
    }
    /// Push constants.
    pub type Push = super::layout::MeshBatch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Vertices`, read; set 0, binding 0.
        pub vertices: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSeen`, read; set 0, binding 1.
        pub all_seen: &'a crate::gpu::Buffer,
        /// Storage buffer `Placements`, read; set 0, binding 2.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 3.
        pub tiles: &'a crate::gpu::Buffer,
        /// Storage buffer `Edges`, read; set 0, binding 4.
        pub edges: &'a crate::gpu::Buffer,
        /// Storage buffer `Outlines`, read; set 0, binding 5.
        pub outlines: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 6] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.vertices) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_seen) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.tiles) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.edges) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.outlines) },
            ]
        }
    }
}
/// The stage `evaluate/mesh_fill.vert`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod mesh_fill_vert {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/mesh_fill.vert",
        kind: crate::gpu::ShaderKind::Vertex,
        spirv: &crate::gpu::words::<944, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/mesh_fill.vert.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 32,
        bindings: &[
            crate::gpu::BindingLayout { name: "Vertices", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSeen", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "CHANNEL", id: 1, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `CHANNEL`, 0 by default.
        pub channel: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { channel: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(1, constants.channel), ] }
    }
    /// Push constants.
    pub type Push = super::layout::MeshBatch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Vertices`, read; set 0, binding 0.
        pub vertices: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSeen`, read; set 0, binding 1.
        pub all_seen: &'a crate::gpu::Buffer,
        /// Storage buffer `Placements`, read; set 0, binding 2.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 3.
        pub tiles: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.vertices) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_seen) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.tiles) },
            ]
        }
    }
}
/// The stage `evaluate/objective.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod objective_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/objective.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<11320, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/objective.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 28,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Fitness", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Objective;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read; set 0, binding 1.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Fitness`, written; set 0, binding 2.
        pub fitness: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.fitness) },
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
/// The stage `evaluate/objective_evidence.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod objective_evidence_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/objective_evidence.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<10449, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/objective_evidence.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 28,
        bindings: &[
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Fitness", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllEvidence", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Objective;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `AllSums`, read; set 0, binding 1.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Fitness`, written; set 0, binding 2.
        pub fitness: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidenceTable`, read; set 0, binding 3.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `AllEvidence`, read; set 0, binding 4.
        pub all_evidence: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.fitness) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.all_evidence) },
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
/// The stage `evaluate/objective_segments.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod objective_segments_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/objective_segments.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<13185, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/objective_segments.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 28,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Fitness", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSegmentSums", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
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
    pub type Push = super::layout::Objective;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read; set 0, binding 1.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Fitness`, written; set 0, binding 2.
        pub fitness: &'a crate::gpu::Buffer,
        /// Storage buffer `SegmentTable`, read; set 0, binding 3.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSegmentSums`, read; set 0, binding 4.
        pub all_segment_sums: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 5] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.fitness) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_segment_sums) },
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
/// The stage `evaluate/order.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod order_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [15] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/order.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1567, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/order.comp.spv"))),
        workgroup_size: [128, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Captured", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "local_size_x", id: 0, default: 128 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `local_size_x`, 128 by default.
        pub local_size_x: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { local_size_x: 128, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.local_size_x), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Captured`, read; set 0, binding 1.
        pub captured: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, written; set 0, binding 3.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, written; set 0, binding 4.
        pub all_bounds: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.captured) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
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
/// The stage `evaluate/outline.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod outline_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/outline.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1420, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/outline.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 32,
        bindings: &[
            crate::gpu::BindingLayout { name: "Edges", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSeen", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Outlines", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Counts", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::MeshBatch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Edges`, read; set 0, binding 0.
        pub edges: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSeen`, read; set 0, binding 1.
        pub all_seen: &'a crate::gpu::Buffer,
        /// Storage buffer `Placements`, read; set 0, binding 2.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `Outlines`, written; set 0, binding 3.
        pub outlines: &'a crate::gpu::Buffer,
        /// Storage buffer `Counts`, read and written; set 0, binding 4.
        pub counts: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 5] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.edges) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_seen) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.outlines) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.counts) },
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
/// The stage `evaluate/place.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod place_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/place.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1562, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/place.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Tiles", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Placements", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Listed", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `AllBounds`, read; set 0, binding 0.
        pub all_bounds: &'a crate::gpu::Buffer,
        /// Storage buffer `Tiles`, read; set 0, binding 1.
        pub tiles: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 2.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Placements`, written; set 0, binding 3.
        pub placements: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, written; set 0, binding 4.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Listed`, read and written; set 0, binding 5.
        pub listed: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, read; set 0, binding 6.
        pub quads: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 7] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.tiles) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.placements) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.listed) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.quads) },
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
/// The stage `evaluate/pose.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod pose_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/pose.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2471, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/pose.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "World", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Bones", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Poses", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `World`, read and written; set 0, binding 2.
        pub world: &'a crate::gpu::Buffer,
        /// Storage buffer `Bones`, read; set 0, binding 5.
        pub bones: &'a crate::gpu::Buffer,
        /// Storage buffer `Poses`, read; set 0, binding 6.
        pub poses: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.world) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.bones) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.poses) },
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
/// The stage `evaluate/pose_project.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod pose_project_comp {
    // Accesses are as declared: naga cannot read this stage (invalid array size %1138).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/pose_project.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<9689, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/pose_project.comp.spv"))),
        workgroup_size: [128, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Parts", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Bones", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Poses", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "posed_rows", id: 0, default: 96 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 1, default: 128 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `posed_rows`, 96 by default.
        pub posed_rows: u32,
        /// `local_size_x`, 128 by default.
        pub local_size_x: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { posed_rows: 96, local_size_x: 128, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.posed_rows), (1, constants.local_size_x), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Parts`, read; set 0, binding 0.
        pub parts: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 1.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, written; set 0, binding 3.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, written; set 0, binding 4.
        pub all_bounds: &'a crate::gpu::Buffer,
        /// Storage buffer `Bones`, read; set 0, binding 5.
        pub bones: &'a crate::gpu::Buffer,
        /// Storage buffer `Poses`, read; set 0, binding 6.
        pub poses: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 6] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.parts) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.bones) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.poses) },
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
/// The stage `evaluate/project.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod project_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [48] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/project.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<7226, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/project.comp.spv"))),
        workgroup_size: [128, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Parts", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "World", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "local_size_x", id: 0, default: 128 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `local_size_x`, 128 by default.
        pub local_size_x: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { local_size_x: 128, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.local_size_x), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Parts`, read; set 0, binding 0.
        pub parts: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 1.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `World`, read; set 0, binding 2.
        pub world: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, written; set 0, binding 3.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, written; set 0, binding 4.
        pub all_bounds: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 5] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.parts) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.world) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
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
/// The stage `evaluate/project_feedback.vert`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod project_feedback_vert {
    // Accesses are as declared: naga cannot read this stage (unsupported capability TransformFeedback).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/project_feedback.vert",
        kind: crate::gpu::ShaderKind::Vertex,
        spirv: &crate::gpu::words::<6246, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/project_feedback.vert.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Parts", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "World", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Parts`, read; set 0, binding 0.
        pub parts: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 1.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `World`, read; set 0, binding 2.
        pub world: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.parts) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.world) },
            ]
        }
    }
}
/// The stage `evaluate/raster.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod raster_comp {
    // Accesses are as declared: naga cannot read this stage (invalid array size %872).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/raster.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<5935, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/raster.comp.spv"))),
        workgroup_size: [32, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Planes", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "List", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "LISTED", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "IGNORES", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 2, default: 32 },
            crate::gpu::SpecConstant { name: "WORDS", id: 3, default: 3 },
            crate::gpu::SpecConstant { name: "KEEPS_EDGES", id: 6, default: 0 },
            crate::gpu::SpecConstant { name: "EDGES_KEPT", id: 7, default: 1 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `LISTED`, false by default.
        pub listed: bool,
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 32 by default.
        pub local_size_x: u32,
        /// `WORDS`, 3 by default.
        pub words: u32,
        /// `KEEPS_EDGES`, false by default.
        pub keeps_edges: bool,
        /// `EDGES_KEPT`, 1 by default.
        pub edges_kept: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { listed: false, ignores: false, local_size_x: 32, words: 3, keeps_edges: false, edges_kept: 1, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, u32::from(constants.listed)), (1, u32::from(constants.ignores)), (2, constants.local_size_x), (3, constants.words), (6, u32::from(constants.keeps_edges)), (7, constants.edges_kept), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, read; set 0, binding 1.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, read; set 0, binding 2.
        pub all_bounds: &'a crate::gpu::Buffer,
        /// Storage buffer `Planes`, read; set 0, binding 3.
        pub planes: &'a crate::gpu::Buffer,
        /// Storage buffer `List`, read; set 0, binding 4.
        pub list: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, written; set 0, binding 5.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 9.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 7] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.list) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/raster_evidence.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod raster_evidence_comp {
    // Accesses are as declared: naga cannot read this stage (invalid array size %920).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/raster_evidence.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<6437, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/raster_evidence.comp.spv"))),
        workgroup_size: [32, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Planes", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "List", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "EvidencePlanes", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllEvidence", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "LISTED", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "IGNORES", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 2, default: 32 },
            crate::gpu::SpecConstant { name: "WORDS", id: 3, default: 3 },
            crate::gpu::SpecConstant { name: "KEEPS_EDGES", id: 6, default: 0 },
            crate::gpu::SpecConstant { name: "EDGES_KEPT", id: 7, default: 1 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `LISTED`, false by default.
        pub listed: bool,
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 32 by default.
        pub local_size_x: u32,
        /// `WORDS`, 3 by default.
        pub words: u32,
        /// `KEEPS_EDGES`, false by default.
        pub keeps_edges: bool,
        /// `EDGES_KEPT`, 1 by default.
        pub edges_kept: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { listed: false, ignores: false, local_size_x: 32, words: 3, keeps_edges: false, edges_kept: 1, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, u32::from(constants.listed)), (1, u32::from(constants.ignores)), (2, constants.local_size_x), (3, constants.words), (6, u32::from(constants.keeps_edges)), (7, constants.edges_kept), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, read; set 0, binding 1.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, read; set 0, binding 2.
        pub all_bounds: &'a crate::gpu::Buffer,
        /// Storage buffer `Planes`, read; set 0, binding 3.
        pub planes: &'a crate::gpu::Buffer,
        /// Storage buffer `List`, read; set 0, binding 4.
        pub list: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, written; set 0, binding 5.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidenceTable`, read; set 0, binding 6.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidencePlanes`, read; set 0, binding 7.
        pub evidence_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `AllEvidence`, written; set 0, binding 8.
        pub all_evidence: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 9.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 10] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.list) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.evidence_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.all_evidence) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/raster_mesh.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod raster_mesh_comp {
    // Accesses are as declared: naga cannot read this stage (unsupported instruction UMulExtended at Function).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/raster_mesh.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<11035, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/raster_mesh.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 32,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSeen", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Planes", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Triangles", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Vertices", set: 0, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Edges", set: 0, binding: 11, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "IGNORES", id: 1, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `IGNORES`, false by default.
        pub ignores: bool,
    }
    impl Default for Constants {
        fn default() -> Self { Self { ignores: false, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(1, u32::from(constants.ignores)), ] }
    }
    /// Push constants.
    pub type Push = super::layout::MeshBatch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSeen`, read; set 0, binding 1.
        pub all_seen: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, read; set 0, binding 2.
        pub all_bounds: &'a crate::gpu::Buffer,
        /// Storage buffer `Planes`, read; set 0, binding 3.
        pub planes: &'a crate::gpu::Buffer,
        /// Storage buffer `Triangles`, read; set 0, binding 4.
        pub triangles: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read and written; set 0, binding 5.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 9.
        pub counted: &'a crate::gpu::Buffer,
        /// Storage buffer `Vertices`, read; set 0, binding 10.
        pub vertices: &'a crate::gpu::Buffer,
        /// Storage buffer `Edges`, read; set 0, binding 11.
        pub edges: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 9] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_seen) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.triangles) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.counted) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.vertices) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.edges) },
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
/// The stage `evaluate/raster_mesh_evidence.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod raster_mesh_evidence_comp {
    // Accesses are as declared: naga cannot read this stage (unsupported instruction UMulExtended at Function).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/raster_mesh_evidence.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<11595, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/raster_mesh_evidence.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 32,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSeen", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Planes", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Triangles", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "EvidencePlanes", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllEvidence", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Vertices", set: 0, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Edges", set: 0, binding: 11, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "IGNORES", id: 1, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `IGNORES`, false by default.
        pub ignores: bool,
    }
    impl Default for Constants {
        fn default() -> Self { Self { ignores: false, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(1, u32::from(constants.ignores)), ] }
    }
    /// Push constants.
    pub type Push = super::layout::MeshBatch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSeen`, read; set 0, binding 1.
        pub all_seen: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, read; set 0, binding 2.
        pub all_bounds: &'a crate::gpu::Buffer,
        /// Storage buffer `Planes`, read; set 0, binding 3.
        pub planes: &'a crate::gpu::Buffer,
        /// Storage buffer `Triangles`, read; set 0, binding 4.
        pub triangles: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read and written; set 0, binding 5.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidenceTable`, read; set 0, binding 6.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidencePlanes`, read; set 0, binding 7.
        pub evidence_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `AllEvidence`, read and written; set 0, binding 8.
        pub all_evidence: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 9.
        pub counted: &'a crate::gpu::Buffer,
        /// Storage buffer `Vertices`, read; set 0, binding 10.
        pub vertices: &'a crate::gpu::Buffer,
        /// Storage buffer `Edges`, read; set 0, binding 11.
        pub edges: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 12] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_seen) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.triangles) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.evidence_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.all_evidence) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.counted) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.vertices) },
                crate::gpu::Binding { layout: &SHADER.bindings[11], bound: crate::gpu::Bound::Buffer(self.edges) },
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
/// The stage `evaluate/raster_mesh_segments.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod raster_mesh_segments_comp {
    // Accesses are as declared: naga cannot read this stage (unsupported instruction UMulExtended at Function).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/raster_mesh_segments.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<11912, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/raster_mesh_segments.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 32,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSeen", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Planes", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Triangles", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "SegmentPlanes", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSegmentSums", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Vertices", set: 0, binding: 10, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Edges", set: 0, binding: 11, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "IGNORES", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "SEGMENT_EDGES", id: 4, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `SEGMENT_EDGES`, false by default.
        pub segment_edges: bool,
    }
    impl Default for Constants {
        fn default() -> Self { Self { ignores: false, segment_edges: false, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(1, u32::from(constants.ignores)), (4, u32::from(constants.segment_edges)), ] }
    }
    /// Push constants.
    pub type Push = super::layout::MeshBatch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSeen`, read; set 0, binding 1.
        pub all_seen: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, read; set 0, binding 2.
        pub all_bounds: &'a crate::gpu::Buffer,
        /// Storage buffer `Planes`, read; set 0, binding 3.
        pub planes: &'a crate::gpu::Buffer,
        /// Storage buffer `Triangles`, read; set 0, binding 4.
        pub triangles: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read and written; set 0, binding 5.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `SegmentTable`, read; set 0, binding 6.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `SegmentPlanes`, read; set 0, binding 7.
        pub segment_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSegmentSums`, read and written; set 0, binding 8.
        pub all_segment_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 9.
        pub counted: &'a crate::gpu::Buffer,
        /// Storage buffer `Vertices`, read; set 0, binding 10.
        pub vertices: &'a crate::gpu::Buffer,
        /// Storage buffer `Edges`, read; set 0, binding 11.
        pub edges: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 12] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.all_seen) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.triangles) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.segment_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.all_segment_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.counted) },
                crate::gpu::Binding { layout: &SHADER.bindings[10], bound: crate::gpu::Bound::Buffer(self.vertices) },
                crate::gpu::Binding { layout: &SHADER.bindings[11], bound: crate::gpu::Bound::Buffer(self.edges) },
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
/// The stage `evaluate/raster_segments.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod raster_segments_comp {
    // Accesses are as declared: naga cannot read this stage (invalid array size %1018).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/raster_segments.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<6839, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/raster_segments.comp.spv"))),
        workgroup_size: [32, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Planes", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "List", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "SegmentPlanes", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSegmentSums", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "LISTED", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "IGNORES", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 2, default: 32 },
            crate::gpu::SpecConstant { name: "WORDS", id: 3, default: 3 },
            crate::gpu::SpecConstant { name: "SEGMENT_EDGES", id: 4, default: 0 },
            crate::gpu::SpecConstant { name: "KEEPS_EDGES", id: 6, default: 0 },
            crate::gpu::SpecConstant { name: "EDGES_KEPT", id: 7, default: 1 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `LISTED`, false by default.
        pub listed: bool,
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 32 by default.
        pub local_size_x: u32,
        /// `WORDS`, 3 by default.
        pub words: u32,
        /// `SEGMENT_EDGES`, false by default.
        pub segment_edges: bool,
        /// `KEEPS_EDGES`, false by default.
        pub keeps_edges: bool,
        /// `EDGES_KEPT`, 1 by default.
        pub edges_kept: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { listed: false, ignores: false, local_size_x: 32, words: 3, segment_edges: false, keeps_edges: false, edges_kept: 1, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, u32::from(constants.listed)), (1, u32::from(constants.ignores)), (2, constants.local_size_x), (3, constants.words), (4, u32::from(constants.segment_edges)), (6, u32::from(constants.keeps_edges)), (7, constants.edges_kept), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, read; set 0, binding 1.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, read; set 0, binding 2.
        pub all_bounds: &'a crate::gpu::Buffer,
        /// Storage buffer `Planes`, read; set 0, binding 3.
        pub planes: &'a crate::gpu::Buffer,
        /// Storage buffer `List`, read; set 0, binding 4.
        pub list: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, written; set 0, binding 5.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `SegmentTable`, read; set 0, binding 6.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `SegmentPlanes`, read; set 0, binding 7.
        pub segment_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSegmentSums`, written; set 0, binding 8.
        pub all_segment_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 9.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 10] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.list) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.segment_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.all_segment_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[9], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/raster_shared.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod raster_shared_comp {
    // Accesses are as declared: naga cannot read this stage (invalid array size %872).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/raster_shared.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<5887, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/raster_shared.comp.spv"))),
        workgroup_size: [32, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Planes", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "List", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "LISTED", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "IGNORES", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 2, default: 32 },
            crate::gpu::SpecConstant { name: "WORDS", id: 3, default: 3 },
            crate::gpu::SpecConstant { name: "KEEPS_EDGES", id: 6, default: 0 },
            crate::gpu::SpecConstant { name: "EDGES_KEPT", id: 7, default: 1 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `LISTED`, false by default.
        pub listed: bool,
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 32 by default.
        pub local_size_x: u32,
        /// `WORDS`, 3 by default.
        pub words: u32,
        /// `KEEPS_EDGES`, false by default.
        pub keeps_edges: bool,
        /// `EDGES_KEPT`, 1 by default.
        pub edges_kept: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { listed: false, ignores: false, local_size_x: 32, words: 3, keeps_edges: false, edges_kept: 1, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, u32::from(constants.listed)), (1, u32::from(constants.ignores)), (2, constants.local_size_x), (3, constants.words), (6, u32::from(constants.keeps_edges)), (7, constants.edges_kept), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, read; set 0, binding 1.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, read; set 0, binding 2.
        pub all_bounds: &'a crate::gpu::Buffer,
        /// Storage buffer `Planes`, read; set 0, binding 3.
        pub planes: &'a crate::gpu::Buffer,
        /// Storage buffer `List`, read; set 0, binding 4.
        pub list: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, written; set 0, binding 5.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 9.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 7] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.list) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/raster_spans.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod raster_spans_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [33] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/raster_spans.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<5111, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/raster_spans.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Planes", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "IGNORES", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 2, default: 64 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 64 by default.
        pub local_size_x: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { ignores: false, local_size_x: 64, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(1, u32::from(constants.ignores)), (2, constants.local_size_x), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, read; set 0, binding 1.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, read; set 0, binding 2.
        pub all_bounds: &'a crate::gpu::Buffer,
        /// Storage buffer `Planes`, read; set 0, binding 3.
        pub planes: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read and written; set 0, binding 5.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 9.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 6] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/raster_spans_evidence.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod raster_spans_evidence_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [35] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/raster_spans_evidence.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<5556, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/raster_spans_evidence.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Planes", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "EvidencePlanes", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllEvidence", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "IGNORES", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 2, default: 64 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 64 by default.
        pub local_size_x: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { ignores: false, local_size_x: 64, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(1, u32::from(constants.ignores)), (2, constants.local_size_x), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, read; set 0, binding 1.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, read; set 0, binding 2.
        pub all_bounds: &'a crate::gpu::Buffer,
        /// Storage buffer `Planes`, read; set 0, binding 3.
        pub planes: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read and written; set 0, binding 5.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidenceTable`, read; set 0, binding 6.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `EvidencePlanes`, read; set 0, binding 7.
        pub evidence_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `AllEvidence`, read and written; set 0, binding 8.
        pub all_evidence: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 9.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 9] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.evidence_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.all_evidence) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/raster_spans_segments.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod raster_spans_segments_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [37] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/raster_spans_segments.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<6038, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/raster_spans_segments.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Quads", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Planes", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSums", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "table", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "SegmentPlanes", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSegmentSums", set: 0, binding: 8, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 9, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "IGNORES", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "local_size_x", id: 2, default: 64 },
            crate::gpu::SpecConstant { name: "SEGMENT_EDGES", id: 4, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `IGNORES`, false by default.
        pub ignores: bool,
        /// `local_size_x`, 64 by default.
        pub local_size_x: u32,
        /// `SEGMENT_EDGES`, false by default.
        pub segment_edges: bool,
    }
    impl Default for Constants {
        fn default() -> Self { Self { ignores: false, local_size_x: 64, segment_edges: false, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(1, u32::from(constants.ignores)), (2, constants.local_size_x), (4, u32::from(constants.segment_edges)), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Batch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Cameras`, read; set 0, binding 0.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `Quads`, read; set 0, binding 1.
        pub quads: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, read; set 0, binding 2.
        pub all_bounds: &'a crate::gpu::Buffer,
        /// Storage buffer `Planes`, read; set 0, binding 3.
        pub planes: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSums`, read and written; set 0, binding 5.
        pub all_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `SegmentTable`, read; set 0, binding 6.
        pub table: &'a crate::gpu::Buffer,
        /// Storage buffer `SegmentPlanes`, read; set 0, binding 7.
        pub segment_planes: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSegmentSums`, read and written; set 0, binding 8.
        pub all_segment_sums: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 9.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 9] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.quads) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.table) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.segment_planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.all_segment_sums) },
                crate::gpu::Binding { layout: &SHADER.bindings[8], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `evaluate/skin.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod skin_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/skin.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<4867, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/skin.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 32,
        bindings: &[
            crate::gpu::BindingLayout { name: "Vertices", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Skin", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllSeen", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "IS_SMOOTH", id: 0, default: 1 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `IS_SMOOTH`, 1 by default.
        pub is_smooth: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { is_smooth: 1, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.is_smooth), ] }
    }
    /// Push constants.
    pub type Push = super::layout::MeshBatch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Vertices`, read; set 0, binding 0.
        pub vertices: &'a crate::gpu::Buffer,
        /// Storage buffer `Skin`, read; set 0, binding 1.
        pub skin: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 2.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `AllSeen`, written; set 0, binding 3.
        pub all_seen: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, read and written; set 0, binding 4.
        pub all_bounds: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 5] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.vertices) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.skin) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.all_seen) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
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
/// The stage `evaluate/skin_feedback.vert`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod skin_feedback_vert {
    // Accesses are as declared: naga cannot read this stage (unsupported capability TransformFeedback).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/skin_feedback.vert",
        kind: crate::gpu::ShaderKind::Vertex,
        spirv: &crate::gpu::words::<4351, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/skin_feedback.vert.spv"))),
        workgroup_size: [1, 1, 1],
        push_size: 32,
        bindings: &[
            crate::gpu::BindingLayout { name: "Vertices", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Skin", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "IS_SMOOTH", id: 0, default: 1 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `IS_SMOOTH`, 1 by default.
        pub is_smooth: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { is_smooth: 1, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.is_smooth), ] }
    }
    /// Push constants.
    pub type Push = super::layout::MeshBatch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Vertices`, read; set 0, binding 0.
        pub vertices: &'a crate::gpu::Buffer,
        /// Storage buffer `Skin`, read; set 0, binding 1.
        pub skin: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 2.
        pub cameras: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.vertices) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.skin) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.cameras) },
            ]
        }
    }
}
/// The stage `evaluate/touched.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod touched_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "evaluate/touched.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<918, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/evaluate/touched.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 32,
        bindings: &[
            crate::gpu::BindingLayout { name: "AllSeen", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Cameras", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "AllBounds", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::MeshBatch;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `AllSeen`, read; set 0, binding 0.
        pub all_seen: &'a crate::gpu::Buffer,
        /// Storage buffer `Cameras`, read; set 0, binding 1.
        pub cameras: &'a crate::gpu::Buffer,
        /// Storage buffer `AllBounds`, read and written; set 0, binding 4.
        pub all_bounds: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.all_seen) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.cameras) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.all_bounds) },
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
    /// `Batch` in memory, 24 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Batch {
        /// `candidates` at byte 0.
        pub candidates: u32,
        /// `views` at byte 4.
        pub views: u32,
        /// `bones` at byte 8.
        pub bones: u32,
        /// `parts` at byte 12.
        pub parts: u32,
        /// `dofs` at byte 16.
        pub dofs: u32,
        /// `first` at byte 20.
        pub first: u32,
    }
    const _: () = assert!(size_of::<Batch>() == 24);
    const _: () = assert!(std::mem::offset_of!(Batch, candidates) == 0);
    const _: () = assert!(std::mem::offset_of!(Batch, views) == 4);
    const _: () = assert!(std::mem::offset_of!(Batch, bones) == 8);
    const _: () = assert!(std::mem::offset_of!(Batch, parts) == 12);
    const _: () = assert!(std::mem::offset_of!(Batch, dofs) == 16);
    const _: () = assert!(std::mem::offset_of!(Batch, first) == 20);
    /// `Bone` in memory, 48 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Bone {
        /// `offset` at byte 0.
        pub offset: [f32; 3],
        /// `parity` at byte 12.
        pub parity: f32,
        /// `parent` at byte 16.
        pub parent: i32,
        /// `axes` at byte 20.
        pub axes: u32,
        /// `slots` at byte 24.
        pub slots: [i32; 6],
    }
    const _: () = assert!(size_of::<Bone>() == 48);
    const _: () = assert!(std::mem::offset_of!(Bone, offset) == 0);
    const _: () = assert!(std::mem::offset_of!(Bone, parity) == 12);
    const _: () = assert!(std::mem::offset_of!(Bone, parent) == 16);
    const _: () = assert!(std::mem::offset_of!(Bone, axes) == 20);
    const _: () = assert!(std::mem::offset_of!(Bone, slots) == 24);
    /// `Bounds` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Bounds {
        /// `low` at byte 0.
        pub low: [i32; 2],
        /// `high` at byte 8.
        pub high: [i32; 2],
    }
    const _: () = assert!(size_of::<Bounds>() == 16);
    const _: () = assert!(std::mem::offset_of!(Bounds, low) == 0);
    const _: () = assert!(std::mem::offset_of!(Bounds, high) == 8);
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
    /// `EvidenceAt` in memory, 8 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct EvidenceAt {
        /// `count` at byte 0.
        pub count: u32,
        /// `classes` at byte 4.
        pub classes: u32,
    }
    const _: () = assert!(size_of::<EvidenceAt>() == 8);
    const _: () = assert!(std::mem::offset_of!(EvidenceAt, count) == 0);
    const _: () = assert!(std::mem::offset_of!(EvidenceAt, classes) == 4);
    /// `EvidenceBest` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct EvidenceBest {
        /// `first_group` at byte 0.
        pub first_group: u32,
        /// `groups` at byte 4.
        pub groups: u32,
        /// `view` at byte 8.
        pub view: u32,
        /// `classes` at byte 12.
        pub classes: u32,
    }
    const _: () = assert!(size_of::<EvidenceBest>() == 16);
    const _: () = assert!(std::mem::offset_of!(EvidenceBest, first_group) == 0);
    const _: () = assert!(std::mem::offset_of!(EvidenceBest, groups) == 4);
    const _: () = assert!(std::mem::offset_of!(EvidenceBest, view) == 8);
    const _: () = assert!(std::mem::offset_of!(EvidenceBest, classes) == 12);
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
    /// `EvidenceView` in memory, 28 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct EvidenceView {
        /// `width` at byte 0.
        pub width: u32,
        /// `height` at byte 4.
        pub height: u32,
        /// `stride` at byte 8.
        pub stride: u32,
        /// `first_group` at byte 12.
        pub first_group: u32,
        /// `view` at byte 16.
        pub view: u32,
        /// `classes` at byte 20.
        pub classes: u32,
        /// `motion` at byte 24.
        pub motion: u32,
    }
    const _: () = assert!(size_of::<EvidenceView>() == 28);
    const _: () = assert!(std::mem::offset_of!(EvidenceView, width) == 0);
    const _: () = assert!(std::mem::offset_of!(EvidenceView, height) == 4);
    const _: () = assert!(std::mem::offset_of!(EvidenceView, stride) == 8);
    const _: () = assert!(std::mem::offset_of!(EvidenceView, first_group) == 12);
    const _: () = assert!(std::mem::offset_of!(EvidenceView, view) == 16);
    const _: () = assert!(std::mem::offset_of!(EvidenceView, classes) == 20);
    const _: () = assert!(std::mem::offset_of!(EvidenceView, motion) == 24);
    /// `EvidenceWords` in memory, 20 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct EvidenceWords {
        /// `width` at byte 0.
        pub width: u32,
        /// `height` at byte 4.
        pub height: u32,
        /// `first_group` at byte 8.
        pub first_group: u32,
        /// `first_word` at byte 12.
        pub first_word: u32,
        /// `classes` at byte 16.
        pub classes: u32,
    }
    const _: () = assert!(size_of::<EvidenceWords>() == 20);
    const _: () = assert!(std::mem::offset_of!(EvidenceWords, width) == 0);
    const _: () = assert!(std::mem::offset_of!(EvidenceWords, height) == 4);
    const _: () = assert!(std::mem::offset_of!(EvidenceWords, first_group) == 8);
    const _: () = assert!(std::mem::offset_of!(EvidenceWords, first_word) == 12);
    const _: () = assert!(std::mem::offset_of!(EvidenceWords, classes) == 16);
    /// `ListedHeader` in memory, 12 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct ListedHeader {
        /// `listed_count` at byte 0.
        pub listed_count: u32,
        /// `listed_one` at byte 4.
        pub listed_one: [u32; 2],
    }
    const _: () = assert!(size_of::<ListedHeader>() == 12);
    const _: () = assert!(std::mem::offset_of!(ListedHeader, listed_count) == 0);
    const _: () = assert!(std::mem::offset_of!(ListedHeader, listed_one) == 4);
    /// `MeshBatch` in memory, 32 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct MeshBatch {
        /// `candidates` at byte 0.
        pub candidates: u32,
        /// `views` at byte 4.
        pub views: u32,
        /// `bones` at byte 8.
        pub bones: u32,
        /// `vertices` at byte 12.
        pub vertices: u32,
        /// `edges` at byte 16.
        pub edges: u32,
        /// `most_outlines` at byte 20.
        pub most_outlines: u32,
        /// `triangles` at byte 24.
        pub triangles: u32,
        /// `first` at byte 28.
        pub first: u32,
    }
    const _: () = assert!(size_of::<MeshBatch>() == 32);
    const _: () = assert!(std::mem::offset_of!(MeshBatch, candidates) == 0);
    const _: () = assert!(std::mem::offset_of!(MeshBatch, views) == 4);
    const _: () = assert!(std::mem::offset_of!(MeshBatch, bones) == 8);
    const _: () = assert!(std::mem::offset_of!(MeshBatch, vertices) == 12);
    const _: () = assert!(std::mem::offset_of!(MeshBatch, edges) == 16);
    const _: () = assert!(std::mem::offset_of!(MeshBatch, most_outlines) == 20);
    const _: () = assert!(std::mem::offset_of!(MeshBatch, triangles) == 24);
    const _: () = assert!(std::mem::offset_of!(MeshBatch, first) == 28);
    /// `MeshEdge` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct MeshEdge {
        /// `ends` at byte 0.
        pub ends: [u32; 2],
        /// `opposite` at byte 8.
        pub opposite: [u32; 2],
    }
    const _: () = assert!(size_of::<MeshEdge>() == 16);
    const _: () = assert!(std::mem::offset_of!(MeshEdge, ends) == 0);
    const _: () = assert!(std::mem::offset_of!(MeshEdge, opposite) == 8);
    /// `MeshVertex` in memory, 48 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct MeshVertex {
        /// `position` at byte 0.
        pub position: [f32; 3],
        /// `label` at byte 12.
        pub label: u32,
        /// `weights` at byte 16.
        pub weights: [f32; 4],
        /// `bones` at byte 32.
        pub bones: [u32; 4],
    }
    const _: () = assert!(size_of::<MeshVertex>() == 48);
    const _: () = assert!(std::mem::offset_of!(MeshVertex, position) == 0);
    const _: () = assert!(std::mem::offset_of!(MeshVertex, label) == 12);
    const _: () = assert!(std::mem::offset_of!(MeshVertex, weights) == 16);
    const _: () = assert!(std::mem::offset_of!(MeshVertex, bones) == 32);
    /// `Objective` in memory, 28 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Objective {
        /// `scoring` at byte 0.
        pub scoring: Scoring,
    }
    const _: () = assert!(size_of::<Objective>() == 28);
    const _: () = assert!(std::mem::offset_of!(Objective, scoring) == 0);
    /// `Part` in memory, 48 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Part {
        /// `a` at byte 0.
        pub a: [f32; 3],
        /// `radius_a` at byte 12.
        pub radius_a: f32,
        /// `b` at byte 16.
        pub b: [f32; 3],
        /// `radius_b` at byte 28.
        pub radius_b: f32,
        /// `bone` at byte 32.
        pub bone: u32,
        /// `label` at byte 36.
        pub label: u32,
        /// `pad0` at byte 40.
        pub pad0: u32,
        /// `pad1` at byte 44.
        pub pad1: u32,
    }
    const _: () = assert!(size_of::<Part>() == 48);
    const _: () = assert!(std::mem::offset_of!(Part, a) == 0);
    const _: () = assert!(std::mem::offset_of!(Part, radius_a) == 12);
    const _: () = assert!(std::mem::offset_of!(Part, b) == 16);
    const _: () = assert!(std::mem::offset_of!(Part, radius_b) == 28);
    const _: () = assert!(std::mem::offset_of!(Part, bone) == 32);
    const _: () = assert!(std::mem::offset_of!(Part, label) == 36);
    const _: () = assert!(std::mem::offset_of!(Part, pad0) == 40);
    const _: () = assert!(std::mem::offset_of!(Part, pad1) == 44);
    /// `Placement` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Placement {
        /// `shift` at byte 0.
        pub shift: [i32; 2],
        /// `low` at byte 8.
        pub low: u32,
        /// `high` at byte 12.
        pub high: u32,
    }
    const _: () = assert!(size_of::<Placement>() == 16);
    const _: () = assert!(std::mem::offset_of!(Placement, shift) == 0);
    const _: () = assert!(std::mem::offset_of!(Placement, low) == 8);
    const _: () = assert!(std::mem::offset_of!(Placement, high) == 12);
    /// `Quad` in memory, 48 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Quad {
        /// `x` at byte 0.
        pub x: [i32; 4],
        /// `y` at byte 16.
        pub y: [i32; 4],
        /// `drawn` at byte 32.
        pub drawn: u32,
        /// `label` at byte 36.
        pub label: u32,
        /// `part` at byte 40.
        pub part: u32,
        /// `depth_squared` at byte 44.
        pub depth_squared: f32,
    }
    const _: () = assert!(size_of::<Quad>() == 48);
    const _: () = assert!(std::mem::offset_of!(Quad, x) == 0);
    const _: () = assert!(std::mem::offset_of!(Quad, y) == 16);
    const _: () = assert!(std::mem::offset_of!(Quad, drawn) == 32);
    const _: () = assert!(std::mem::offset_of!(Quad, label) == 36);
    const _: () = assert!(std::mem::offset_of!(Quad, part) == 40);
    const _: () = assert!(std::mem::offset_of!(Quad, depth_squared) == 44);
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
    /// `Seen` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Seen {
        /// `at` at byte 0.
        pub at: [i32; 2],
        /// `depth` at byte 8.
        pub depth: f32,
        /// `edge_depth` at byte 12.
        pub edge_depth: f32,
    }
    const _: () = assert!(size_of::<Seen>() == 16);
    const _: () = assert!(std::mem::offset_of!(Seen, at) == 0);
    const _: () = assert!(std::mem::offset_of!(Seen, depth) == 8);
    const _: () = assert!(std::mem::offset_of!(Seen, edge_depth) == 12);
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
    /// `TilesHeader` in memory, 8 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct TilesHeader {
        /// `to_clip` at byte 0.
        pub to_clip: [f32; 2],
    }
    const _: () = assert!(size_of::<TilesHeader>() == 8);
    const _: () = assert!(std::mem::offset_of!(TilesHeader, to_clip) == 0);
    /// `ViewTiles` in memory, 24 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct ViewTiles {
        /// `origin` at byte 0.
        pub origin: [u32; 2],
        /// `size` at byte 8.
        pub size: [u32; 2],
        /// `per_row` at byte 16.
        pub per_row: u32,
        /// `whole` at byte 20.
        pub whole: u32,
    }
    const _: () = assert!(size_of::<ViewTiles>() == 24);
    const _: () = assert!(std::mem::offset_of!(ViewTiles, origin) == 0);
    const _: () = assert!(std::mem::offset_of!(ViewTiles, size) == 8);
    const _: () = assert!(std::mem::offset_of!(ViewTiles, per_row) == 16);
    const _: () = assert!(std::mem::offset_of!(ViewTiles, whole) == 20);
}
/// Every stage of the folder, for tests that try them all.
#[cfg(test)]
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub static SHADERS: &[&crate::gpu::Shader] = &[&bind_comp::SHADER, &compare_shared_comp::SHADER, &compare_shared_segments_comp::SHADER, &compare_subgroup_comp::SHADER, &compare_subgroup_segments_comp::SHADER, &compare_texels_comp::SHADER, &compare_texels_segments_comp::SHADER, &draw_border_geom::SHADER, &draw_border_vert::SHADER, &draw_exact_frag::SHADER, &draw_exact_geom::SHADER, &draw_exact_vert::SHADER, &draw_fill_geom::SHADER, &draw_fill_vert::SHADER, &draw_plain_frag::SHADER, &draw_point_vert::SHADER, &evidence_comp::SHADER, &evidence_at_comp::SHADER, &evidence_best_comp::SHADER, &evidence_codes_comp::SHADER, &evidence_words_comp::SHADER, &mesh_edge_geom::SHADER, &mesh_edge_vert::SHADER, &mesh_fill_vert::SHADER, &objective_comp::SHADER, &objective_evidence_comp::SHADER, &objective_segments_comp::SHADER, &order_comp::SHADER, &outline_comp::SHADER, &place_comp::SHADER, &pose_comp::SHADER, &pose_project_comp::SHADER, &project_comp::SHADER, &project_feedback_vert::SHADER, &raster_comp::SHADER, &raster_evidence_comp::SHADER, &raster_mesh_comp::SHADER, &raster_mesh_evidence_comp::SHADER, &raster_mesh_segments_comp::SHADER, &raster_segments_comp::SHADER, &raster_shared_comp::SHADER, &raster_spans_comp::SHADER, &raster_spans_evidence_comp::SHADER, &raster_spans_segments_comp::SHADER, &skin_comp::SHADER, &skin_feedback_vert::SHADER, &touched_comp::SHADER];
