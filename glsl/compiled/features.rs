/// Pixels of a row that a workgroup works on; two words of a bit picture.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const ROW_GROUP: u32 = 64;
/// Ratios of a picture's brightness to its background's are counted in steps of one in so many, over every so many rows and columns.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const RATIO_STEPS: u32 = 128;
/// `RATIO_GRID` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const RATIO_GRID: u32 = 4;
/// Ratios of at least two and a half count as none.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const RATIO_COUNTS: u32 = 320;
/// Gains outside of these are no mild change of the lighting but another scene, and are not believed.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const RATIO_LEAST: u32 = 64;
/// `RATIO_MOST` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const RATIO_MOST: u32 = 256;
/// The sum of the channels below which a pixel is so dark that it says nothing when the plate is as dark.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const DARK: u32 = 192;
/// How a component of the mixture follows a pixel.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const ADAPTATION_WEIGHT: u32 = 0;
/// `ADAPTATION_DENSITY` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const ADAPTATION_DENSITY: u32 = 1;
/// Values of a component: weight, mean red, green, blue, variance.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MIXTURE_FIELDS: u32 = 5;
/// Which components of a bit picture are kept.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const KEEP_LARGEST: u32 = 0;
/// `KEEP_TOUCHED` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const KEEP_TOUCHED: u32 = 1;
/// The holes, which are the components of the clear pixels.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const KEEP_HOLES: u32 = 2;
/// Log densities of colours are whole numbers of so many steps a unit.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LIKELIHOOD_STEPS: u32 = 64;
/// The largest log-likelihood ratio that is believed, in steps, and that from which on a pixel is the person's against colours of which
/// nothing is known.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LIKELIHOOD_MOST: u32 = 320;
/// `LIKELIHOOD_FOREGROUND` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LIKELIHOOD_FOREGROUND: u32 = 64;
/// In a ready mask: minus the log density of what is inside, as background, and that of what is outside.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LIKELIHOOD_MASKED: u32 = 192;
/// `LIKELIHOOD_SURE` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LIKELIHOOD_SURE: u32 = 16383;
/// Steps in which the background's slopes are told apart, and those in which shares of shadows are.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const LIKELY_SLOPES: u32 = 64;
/// `SHADOW_STEPS` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const SHADOW_STEPS: u32 = 20;
/// Colours of 16 steps a channel.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const COLOUR_BINS: u32 = 4096;
/// How two derivatives become one magnitude.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MAGNITUDE_EXACT: u32 = 0;
/// `MAGNITUDE_SUM` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MAGNITUDE_SUM: u32 = 1;
/// `MAGNITUDE_MAX` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const MAGNITUDE_MAX: u32 = 2;
/// The forms of an edge operator's masks.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const EDGES_ACROSS: u32 = 0;
/// `EDGES_DIAGONALS` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const EDGES_DIAGONALS: u32 = 1;
/// `EDGES_CROSSINGS` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const EDGES_CROSSINGS: u32 = 2;
/// Which distance.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const METRIC_CHESSBOARD: u32 = 0;
/// `METRIC_CITY_BLOCK` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const METRIC_CITY_BLOCK: u32 = 1;
/// `METRIC_EUCLIDEAN` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const METRIC_EUCLIDEAN: u32 = 2;
/// `METRIC_QUASI_EUCLIDEAN` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const METRIC_QUASI_EUCLIDEAN: u32 = 3;
/// Steps of the quasi-Euclidean distance.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const STEP_STRAIGHT: u32 = 408;
/// `STEP_DIAGONAL` of `features/constants.glsl`.
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub const STEP_DIAGONAL: u32 = 577;
/// The stage `features/bounds.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod bounds_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/bounds.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<628, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/bounds.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 12,
        bindings: &[
            crate::gpu::BindingLayout { name: "Image", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Sides", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Bounds;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Image`, read; set 0, binding 0.
        pub image: &'a crate::gpu::Buffer,
        /// Storage buffer `Sides`, read and written; set 0, binding 1.
        pub sides: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.image) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.sides) },
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
/// The stage `features/bridge.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod bridge_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/bridge.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<439, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/bridge.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 4,
        bindings: &[
            crate::gpu::BindingLayout { name: "Before", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Closed", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Faint", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "After", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Bridge;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Before`, read; set 0, binding 0.
        pub before: &'a crate::gpu::Buffer,
        /// Storage buffer `Closed`, read; set 0, binding 1.
        pub closed: &'a crate::gpu::Buffer,
        /// Storage buffer `Faint`, read; set 0, binding 2.
        pub faint: &'a crate::gpu::Buffer,
        /// Storage buffer `After`, written; set 0, binding 3.
        pub after: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.before) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.closed) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.faint) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.after) },
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
/// The stage `features/canny.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod canny_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/canny.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2642, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/canny.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Smoothed", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Near", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Weak", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Strong", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "MAGNITUDE", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `MAGNITUDE`, 0 by default.
        pub magnitude: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { magnitude: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.magnitude), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Picture;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Smoothed`, read; set 0, binding 0.
        pub smoothed: &'a crate::gpu::Buffer,
        /// Storage buffer `Near`, read; set 0, binding 1.
        pub near: &'a crate::gpu::Buffer,
        /// Storage buffer `Weak`, written; set 0, binding 2.
        pub weak: &'a crate::gpu::Buffer,
        /// Storage buffer `Strong`, written; set 0, binding 3.
        pub strong: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.smoothed) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.near) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.weak) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.strong) },
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
/// The stage `features/components_join.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod components_join_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/components_join.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2831, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/components_join.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 28,
        bindings: &[
            crate::gpu::BindingLayout { name: "Image", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Labels", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "KEEP", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `KEEP`, 0 by default.
        pub keep: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { keep: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.keep), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Components;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Image`, read; set 0, binding 0.
        pub image: &'a crate::gpu::Buffer,
        /// Storage buffer `Labels`, read and written; set 0, binding 1.
        pub labels: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.image) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.labels) },
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
/// The stage `features/components_keep.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod components_keep_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/components_keep.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<919, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/components_keep.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 28,
        bindings: &[
            crate::gpu::BindingLayout { name: "Image", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Labels", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Areas", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Kept", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "KEEP", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `KEEP`, 0 by default.
        pub keep: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { keep: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.keep), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Components;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Image`, read; set 0, binding 0.
        pub image: &'a crate::gpu::Buffer,
        /// Storage buffer `Labels`, read; set 0, binding 1.
        pub labels: &'a crate::gpu::Buffer,
        /// Storage buffer `Areas`, read; set 0, binding 2.
        pub areas: &'a crate::gpu::Buffer,
        /// Storage buffer `Kept`, written; set 0, binding 3.
        pub kept: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.image) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.labels) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.areas) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.kept) },
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
/// The stage `features/components_label.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod components_label_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/components_label.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<803, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/components_label.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 28,
        bindings: &[
            crate::gpu::BindingLayout { name: "Image", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Labels", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Areas", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Roots", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "KEEP", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `KEEP`, 0 by default.
        pub keep: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { keep: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.keep), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Components;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Image`, read; set 0, binding 0.
        pub image: &'a crate::gpu::Buffer,
        /// Storage buffer `Labels`, written; set 0, binding 1.
        pub labels: &'a crate::gpu::Buffer,
        /// Storage buffer `Areas`, written; set 0, binding 2.
        pub areas: &'a crate::gpu::Buffer,
        /// Storage buffer `Roots`, written; set 0, binding 3.
        pub roots: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 4] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.image) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.labels) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.areas) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.roots) },
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
/// The stage `features/components_largest.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod components_largest_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/components_largest.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1081, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/components_largest.comp.spv"))),
        workgroup_size: [128, 1, 1],
        push_size: 28,
        bindings: &[
            crate::gpu::BindingLayout { name: "Roots", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Areas", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Components;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Roots`, read; set 0, binding 0.
        pub roots: &'a crate::gpu::Buffer,
        /// Storage buffer `Areas`, read and written; set 0, binding 1.
        pub areas: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.roots) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.areas) },
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
/// The stage `features/components_measure.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod components_measure_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/components_measure.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1148, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/components_measure.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 28,
        bindings: &[
            crate::gpu::BindingLayout { name: "Image", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Strong", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Labels", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Areas", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Roots", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "KEEP", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `KEEP`, 0 by default.
        pub keep: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { keep: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.keep), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Components;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Image`, read; set 0, binding 0.
        pub image: &'a crate::gpu::Buffer,
        /// Storage buffer `Strong`, read; set 0, binding 1.
        pub strong: &'a crate::gpu::Buffer,
        /// Storage buffer `Labels`, read and written; set 0, binding 2.
        pub labels: &'a crate::gpu::Buffer,
        /// Storage buffer `Areas`, read and written; set 0, binding 3.
        pub areas: &'a crate::gpu::Buffer,
        /// Storage buffer `Roots`, read and written; set 0, binding 4.
        pub roots: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 5] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.image) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.strong) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.labels) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.areas) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.roots) },
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
/// The stage `features/difference.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod difference_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/difference.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2106, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/difference.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 36,
        bindings: &[
            crate::gpu::BindingLayout { name: "Colours", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Plate", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Gains", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Weak", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Strong", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Faint", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Difference;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Colours`, read; set 0, binding 0.
        pub colours: &'a crate::gpu::Buffer,
        /// Storage buffer `Plate`, read; set 0, binding 1.
        pub plate: &'a crate::gpu::Buffer,
        /// Storage buffer `Gains`, read; set 0, binding 2.
        pub gains: &'a crate::gpu::Buffer,
        /// Storage buffer `Weak`, written; set 0, binding 3.
        pub weak: &'a crate::gpu::Buffer,
        /// Storage buffer `Strong`, written; set 0, binding 4.
        pub strong: &'a crate::gpu::Buffer,
        /// Storage buffer `Faint`, written; set 0, binding 5.
        pub faint: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 6] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.colours) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.plate) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.gains) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.weak) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.strong) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.faint) },
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
/// The stage `features/distance.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod distance_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/distance.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1101, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/distance.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Reach", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Codes", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "METRIC", id: 0, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `METRIC`, 0 by default.
        pub metric: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { metric: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.metric), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Picture;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Reach`, read; set 0, binding 0.
        pub reach: &'a crate::gpu::Buffer,
        /// Storage buffer `Codes`, written; set 0, binding 1.
        pub codes: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.reach) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.codes) },
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
/// The stage `features/edges.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod edges_comp {
    // Accesses are as declared: naga cannot read this stage (Constant [6] '' is invalid: Initializer must be a const-expression).
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/edges.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<3615, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/edges.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Smoothed", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Near", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Edges", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "FORM", id: 0, default: 0 },
            crate::gpu::SpecConstant { name: "MAGNITUDE", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "CORNER", id: 2, default: 1 },
            crate::gpu::SpecConstant { name: "SIDE", id: 3, default: 0 },
            crate::gpu::SpecConstant { name: "MIDDLE", id: 4, default: 2 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `FORM`, 0 by default.
        pub form: u32,
        /// `MAGNITUDE`, 0 by default.
        pub magnitude: u32,
        /// `CORNER`, 1 by default.
        pub corner: i32,
        /// `SIDE`, 0 by default.
        pub side: i32,
        /// `MIDDLE`, 2 by default.
        pub middle: i32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { form: 0, magnitude: 0, corner: 1, side: 0, middle: 2, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.form), (1, constants.magnitude), (2, constants.corner.cast_unsigned()), (3, constants.side.cast_unsigned()), (4, constants.middle.cast_unsigned()), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Picture;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Smoothed`, read; set 0, binding 0.
        pub smoothed: &'a crate::gpu::Buffer,
        /// Storage buffer `Near`, read; set 0, binding 1.
        pub near: &'a crate::gpu::Buffer,
        /// Storage buffer `Edges`, written; set 0, binding 2.
        pub edges: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.smoothed) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.near) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.edges) },
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
/// The stage `features/gain.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod gain_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/gain.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<396, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/gain.comp.spv"))),
        workgroup_size: [3, 1, 1],
        push_size: 0,
        bindings: &[
            crate::gpu::BindingLayout { name: "Counts", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Gains", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
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
        /// Storage buffer `Counts`, read; set 0, binding 0.
        pub counts: &'a crate::gpu::Buffer,
        /// Storage buffer `Gains`, written; set 0, binding 1.
        pub gains: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.counts) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.gains) },
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
/// The stage `features/ignore.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod ignore_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/ignore.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<394, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/ignore.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 4,
        bindings: &[
            crate::gpu::BindingLayout { name: "Ignored", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Silhouette", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Edges", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Ignore;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Ignored`, read; set 0, binding 0.
        pub ignored: &'a crate::gpu::Buffer,
        /// Storage buffer `Silhouette`, read and written; set 0, binding 1.
        pub silhouette: &'a crate::gpu::Buffer,
        /// Storage buffer `Edges`, read and written; set 0, binding 2.
        pub edges: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.ignored) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.silhouette) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.edges) },
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
/// The stage `features/likely.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod likely_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/likely.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<3199, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/likely.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 16,
        bindings: &[
            crate::gpu::BindingLayout { name: "Colours", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Plate", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Logarithms", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Slopes", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "light", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Sides", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Seen", set: 0, binding: 7, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Likely;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Colours`, read; set 0, binding 0.
        pub colours: &'a crate::gpu::Buffer,
        /// Storage buffer `Plate`, read; set 0, binding 1.
        pub plate: &'a crate::gpu::Buffer,
        /// Storage buffer `Logarithms`, read; set 0, binding 2.
        pub logarithms: &'a crate::gpu::Buffer,
        /// Storage buffer `Slopes`, read; set 0, binding 3.
        pub slopes: &'a crate::gpu::Buffer,
        /// Storage buffer `LightTable`, read; set 0, binding 4.
        pub light: &'a crate::gpu::Buffer,
        /// Storage buffer `Sides`, read; set 0, binding 5.
        pub sides: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read; set 0, binding 6.
        pub counted: &'a crate::gpu::Buffer,
        /// Storage buffer `Seen`, written; set 0, binding 7.
        pub seen: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 8] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.colours) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.plate) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.logarithms) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.slopes) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.light) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.sides) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.counted) },
                crate::gpu::Binding { layout: &SHADER.bindings[7], bound: crate::gpu::Bound::Buffer(self.seen) },
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
/// The stage `features/masked.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod masked_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/masked.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<619, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/masked.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Colours", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Mask", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Seen", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Picture;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Colours`, read; set 0, binding 0.
        pub colours: &'a crate::gpu::Buffer,
        /// Storage buffer `Mask`, read; set 0, binding 1.
        pub mask: &'a crate::gpu::Buffer,
        /// Storage buffer `Seen`, written; set 0, binding 2.
        pub seen: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.colours) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.mask) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.seen) },
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
/// The stage `features/mixture.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod mixture_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/mixture.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<7008, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/mixture.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 52,
        bindings: &[
            crate::gpu::BindingLayout { name: "Colours", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Gains", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "rates", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "State", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
            crate::gpu::BindingLayout { name: "Foreground", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "COMPONENTS", id: 0, default: 3 },
            crate::gpu::SpecConstant { name: "ADAPTATION", id: 1, default: 0 },
            crate::gpu::SpecConstant { name: "GAIN", id: 2, default: 0 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `COMPONENTS`, 3 by default.
        pub components: u32,
        /// `ADAPTATION`, 0 by default.
        pub adaptation: u32,
        /// `GAIN`, 0 by default.
        pub gain: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { components: 3, adaptation: 0, gain: 0, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.components), (1, constants.adaptation), (2, constants.gain), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Mixture;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Colours`, read; set 0, binding 0.
        pub colours: &'a crate::gpu::Buffer,
        /// Storage buffer `Gains`, read; set 0, binding 1.
        pub gains: &'a crate::gpu::Buffer,
        /// Storage buffer `Rates`, read; set 0, binding 2.
        pub rates: &'a crate::gpu::Buffer,
        /// Storage buffer `State`, read and written; set 0, binding 3.
        pub state: &'a crate::gpu::Buffer,
        /// Storage buffer `Foreground`, written; set 0, binding 4.
        pub foreground: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 5] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.colours) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.gains) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.rates) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.state) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.foreground) },
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
/// The stage `features/morphology.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod morphology_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/morphology.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1779, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/morphology.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Before", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "After", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Morphology;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Before`, read; set 0, binding 0.
        pub before: &'a crate::gpu::Buffer,
        /// Storage buffer `After`, written; set 0, binding 1.
        pub after: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.before) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.after) },
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
/// The stage `features/pack.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod pack_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/pack.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1138, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/pack.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Silhouette", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Codes", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Proximity", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Pixels", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Planes", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
            crate::gpu::BindingLayout { name: "Ignored", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
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
    pub type Push = super::layout::Picture;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Silhouette`, read; set 0, binding 0.
        pub silhouette: &'a crate::gpu::Buffer,
        /// Storage buffer `Codes`, read; set 0, binding 1.
        pub codes: &'a crate::gpu::Buffer,
        /// Storage buffer `Proximity`, read; set 0, binding 2.
        pub proximity: &'a crate::gpu::Buffer,
        /// Storage buffer `Pixels`, written; set 0, binding 3.
        pub pixels: &'a crate::gpu::Buffer,
        /// Storage buffer `Planes`, written; set 0, binding 4.
        pub planes: &'a crate::gpu::Buffer,
        /// Storage buffer `Ignored`, read; set 0, binding 5.
        pub ignored: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 6] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.silhouette) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.codes) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.proximity) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.pixels) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.planes) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.ignored) },
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
/// The stage `features/probable.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod probable_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/probable.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1328, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/probable.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 16,
        bindings: &[
            crate::gpu::BindingLayout { name: "State", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Background", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "COMPONENTS", id: 0, default: 3 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `COMPONENTS`, 3 by default.
        pub components: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { components: 3, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.components), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Probable;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `State`, read; set 0, binding 0.
        pub state: &'a crate::gpu::Buffer,
        /// Storage buffer `Background`, written; set 0, binding 1.
        pub background: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.state) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.background) },
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
/// The stage `features/ratios.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod ratios_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/ratios.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<879, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/ratios.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 8,
        bindings: &[
            crate::gpu::BindingLayout { name: "Colours", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Background", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Counts", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Ratios;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Colours`, read; set 0, binding 0.
        pub colours: &'a crate::gpu::Buffer,
        /// Storage buffer `Background`, read; set 0, binding 1.
        pub background: &'a crate::gpu::Buffer,
        /// Storage buffer `Counts`, read and written; set 0, binding 2.
        pub counts: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 3] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.colours) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.background) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.counts) },
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
/// The stage `features/reach.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod reach_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/reach.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<746, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/reach.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Edges", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Reach", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Picture;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Edges`, read; set 0, binding 0.
        pub edges: &'a crate::gpu::Buffer,
        /// Storage buffer `Reach`, written; set 0, binding 1.
        pub reach: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.edges) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.reach) },
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
/// The stage `features/shadowed.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod shadowed_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/shadowed.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2571, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/shadowed.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 16,
        bindings: &[
            crate::gpu::BindingLayout { name: "Colours", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Plate", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Logarithms", set: 0, binding: 2, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Slopes", set: 0, binding: 3, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "light", set: 0, binding: 4, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Sides", set: 0, binding: 5, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Counted", set: 0, binding: 6, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::ReadWrite },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Likely;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Colours`, read; set 0, binding 0.
        pub colours: &'a crate::gpu::Buffer,
        /// Storage buffer `Plate`, read; set 0, binding 1.
        pub plate: &'a crate::gpu::Buffer,
        /// Storage buffer `Logarithms`, read; set 0, binding 2.
        pub logarithms: &'a crate::gpu::Buffer,
        /// Storage buffer `Slopes`, read; set 0, binding 3.
        pub slopes: &'a crate::gpu::Buffer,
        /// Storage buffer `LightTable`, read; set 0, binding 4.
        pub light: &'a crate::gpu::Buffer,
        /// Storage buffer `Sides`, read; set 0, binding 5.
        pub sides: &'a crate::gpu::Buffer,
        /// Storage buffer `Counted`, read and written; set 0, binding 6.
        pub counted: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 7] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.colours) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.plate) },
                crate::gpu::Binding { layout: &SHADER.bindings[2], bound: crate::gpu::Bound::Buffer(self.logarithms) },
                crate::gpu::Binding { layout: &SHADER.bindings[3], bound: crate::gpu::Bound::Buffer(self.slopes) },
                crate::gpu::Binding { layout: &SHADER.bindings[4], bound: crate::gpu::Bound::Buffer(self.light) },
                crate::gpu::Binding { layout: &SHADER.bindings[5], bound: crate::gpu::Bound::Buffer(self.sides) },
                crate::gpu::Binding { layout: &SHADER.bindings[6], bound: crate::gpu::Bound::Buffer(self.counted) },
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
/// The stage `features/smooth.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod smooth_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/smooth.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<2202, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/smooth.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Colours", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Smoothed", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
            crate::gpu::SpecConstant { name: "SMOOTH", id: 0, default: 1 },
        ],
    };
    /// Specialisation constants.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Constants {
        /// `SMOOTH`, 1 by default.
        pub smooth: u32,
    }
    impl Default for Constants {
        fn default() -> Self { Self { smooth: 1, } }
    }
    /// What a pipeline is compiled from.
    pub fn stage(constants: Constants) -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![(0, constants.smooth), ] }
    }
    /// Push constants.
    pub type Push = super::layout::Picture;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Colours`, read; set 0, binding 0.
        pub colours: &'a crate::gpu::Buffer,
        /// Storage buffer `Smoothed`, written; set 0, binding 1.
        pub smoothed: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.colours) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.smoothed) },
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
/// The stage `features/unlikely.comp`.
#[allow(dead_code, unreachable_pub, clippy::derivable_impls, reason = "written by the build, of use or not")]
pub mod unlikely_comp {
    /// The compiled stage.
    pub static SHADER: crate::gpu::Shader = crate::gpu::Shader {
        name: "features/unlikely.comp",
        kind: crate::gpu::ShaderKind::Compute,
        spirv: &crate::gpu::words::<1096, _>(include_bytes!(concat!(
            env!("CARGO_MANIFEST_DIR"), "/glsl/compiled/features/unlikely.comp.spv"))),
        workgroup_size: [64, 1, 1],
        push_size: 24,
        bindings: &[
            crate::gpu::BindingLayout { name: "Seen", set: 0, binding: 0, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Read },
            crate::gpu::BindingLayout { name: "Foreground", set: 0, binding: 1, kind: crate::gpu::BindingKind::StorageBuffer, access: crate::gpu::Access::Write },
        ],
        constants: &[
        ],
    };
    /// What a pipeline is compiled from.
    pub fn stage() -> crate::gpu::ShaderStage {
        crate::gpu::ShaderStage { shader: &SHADER, constants: vec![] }
    }
    /// Push constants.
    pub type Push = super::layout::Picture;
    /// What the stage works on.
    #[derive(Clone, Copy, Debug)]
    pub struct Bindings<'a> {
        /// Storage buffer `Seen`, read; set 0, binding 0.
        pub seen: &'a crate::gpu::Buffer,
        /// Storage buffer `Foreground`, written; set 0, binding 1.
        pub foreground: &'a crate::gpu::Buffer,
    }
    impl<'a> Bindings<'a> {
        /// Each resource with the place it goes to.
        pub fn bound(&self) -> [crate::gpu::Binding<'a>; 2] {
            [
                crate::gpu::Binding { layout: &SHADER.bindings[0], bound: crate::gpu::Bound::Buffer(self.seen) },
                crate::gpu::Binding { layout: &SHADER.bindings[1], bound: crate::gpu::Bound::Buffer(self.foreground) },
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
    /// `Bounds` in memory, 12 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Bounds {
        /// `width` at byte 0.
        pub width: u32,
        /// `height` at byte 4.
        pub height: u32,
        /// `stride` at byte 8.
        pub stride: u32,
    }
    const _: () = assert!(size_of::<Bounds>() == 12);
    const _: () = assert!(std::mem::offset_of!(Bounds, width) == 0);
    const _: () = assert!(std::mem::offset_of!(Bounds, height) == 4);
    const _: () = assert!(std::mem::offset_of!(Bounds, stride) == 8);
    /// `Bridge` in memory, 4 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Bridge {
        /// `words` at byte 0.
        pub words: u32,
    }
    const _: () = assert!(size_of::<Bridge>() == 4);
    const _: () = assert!(std::mem::offset_of!(Bridge, words) == 0);
    /// `Components` in memory, 28 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Components {
        /// `width` at byte 0.
        pub width: u32,
        /// `height` at byte 4.
        pub height: u32,
        /// `stride` at byte 8.
        pub stride: u32,
        /// `most` at byte 12.
        pub most: u32,
        /// `least` at byte 16.
        pub least: u32,
        /// `share` at byte 20.
        pub share: f32,
        /// `cover` at byte 24.
        pub cover: u32,
    }
    const _: () = assert!(size_of::<Components>() == 28);
    const _: () = assert!(std::mem::offset_of!(Components, width) == 0);
    const _: () = assert!(std::mem::offset_of!(Components, height) == 4);
    const _: () = assert!(std::mem::offset_of!(Components, stride) == 8);
    const _: () = assert!(std::mem::offset_of!(Components, most) == 12);
    const _: () = assert!(std::mem::offset_of!(Components, least) == 16);
    const _: () = assert!(std::mem::offset_of!(Components, share) == 20);
    const _: () = assert!(std::mem::offset_of!(Components, cover) == 24);
    /// `Difference` in memory, 36 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Difference {
        /// `width` at byte 0.
        pub width: u32,
        /// `stride` at byte 4.
        pub stride: u32,
        /// `weak_squared` at byte 8.
        pub weak_squared: f32,
        /// `strong_squared` at byte 12.
        pub strong_squared: f32,
        /// `faint_squared` at byte 16.
        pub faint_squared: f32,
        /// `suppress` at byte 20.
        pub suppress: u32,
        /// `darkest` at byte 24.
        pub darkest: f32,
        /// `brightest` at byte 28.
        pub brightest: f32,
        /// `chroma_squared` at byte 32.
        pub chroma_squared: f32,
    }
    const _: () = assert!(size_of::<Difference>() == 36);
    const _: () = assert!(std::mem::offset_of!(Difference, width) == 0);
    const _: () = assert!(std::mem::offset_of!(Difference, stride) == 4);
    const _: () = assert!(std::mem::offset_of!(Difference, weak_squared) == 8);
    const _: () = assert!(std::mem::offset_of!(Difference, strong_squared) == 12);
    const _: () = assert!(std::mem::offset_of!(Difference, faint_squared) == 16);
    const _: () = assert!(std::mem::offset_of!(Difference, suppress) == 20);
    const _: () = assert!(std::mem::offset_of!(Difference, darkest) == 24);
    const _: () = assert!(std::mem::offset_of!(Difference, brightest) == 28);
    const _: () = assert!(std::mem::offset_of!(Difference, chroma_squared) == 32);
    /// `Ignore` in memory, 4 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Ignore {
        /// `words` at byte 0.
        pub words: u32,
    }
    const _: () = assert!(size_of::<Ignore>() == 4);
    const _: () = assert!(std::mem::offset_of!(Ignore, words) == 0);
    /// `LightTable` in memory, 21636 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct LightTable {
        /// `dim` at byte 0.
        pub dim: [f32; 3],
        /// `outlier` at byte 12.
        pub outlier: f32,
        /// `range` at byte 16.
        pub range: [f32; 2],
        /// `logs` at byte 24.
        pub logs: [f32; 2],
        /// `falls` at byte 32.
        pub falls: [f32; 2],
        /// `assumed` at byte 40.
        pub assumed: [f32; 2],
        /// `believed` at byte 48.
        pub believed: [f32; 2],
        /// `from` at byte 56.
        pub from: [f32; 19],
        /// `counting` at byte 132.
        pub counting: [Widths; 64],
        /// `judging` at byte 1156.
        pub judging: [Widths; 1280],
    }
    const _: () = assert!(size_of::<LightTable>() == 21636);
    const _: () = assert!(std::mem::offset_of!(LightTable, dim) == 0);
    const _: () = assert!(std::mem::offset_of!(LightTable, outlier) == 12);
    const _: () = assert!(std::mem::offset_of!(LightTable, range) == 16);
    const _: () = assert!(std::mem::offset_of!(LightTable, logs) == 24);
    const _: () = assert!(std::mem::offset_of!(LightTable, falls) == 32);
    const _: () = assert!(std::mem::offset_of!(LightTable, assumed) == 40);
    const _: () = assert!(std::mem::offset_of!(LightTable, believed) == 48);
    const _: () = assert!(std::mem::offset_of!(LightTable, from) == 56);
    const _: () = assert!(std::mem::offset_of!(LightTable, counting) == 132);
    const _: () = assert!(std::mem::offset_of!(LightTable, judging) == 1156);
    /// `Likely` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Likely {
        /// `width` at byte 0.
        pub width: u32,
        /// `height` at byte 4.
        pub height: u32,
        /// `motion` at byte 8.
        pub motion: u32,
        /// `again` at byte 12.
        pub again: u32,
    }
    const _: () = assert!(size_of::<Likely>() == 16);
    const _: () = assert!(std::mem::offset_of!(Likely, width) == 0);
    const _: () = assert!(std::mem::offset_of!(Likely, height) == 4);
    const _: () = assert!(std::mem::offset_of!(Likely, motion) == 8);
    const _: () = assert!(std::mem::offset_of!(Likely, again) == 12);
    /// `Mixture` in memory, 52 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Mixture {
        /// `width` at byte 0.
        pub width: u32,
        /// `rows` at byte 4.
        pub rows: u32,
        /// `first_row` at byte 8.
        pub first_row: u32,
        /// `stride` at byte 12.
        pub stride: u32,
        /// `match_squared` at byte 16.
        pub match_squared: f32,
        /// `background_weight` at byte 20.
        pub background_weight: f32,
        /// `initial_variance` at byte 24.
        pub initial_variance: f32,
        /// `initial_weight` at byte 28.
        pub initial_weight: f32,
        /// `least_variance` at byte 32.
        pub least_variance: f32,
        /// `suppress` at byte 36.
        pub suppress: u32,
        /// `darkest` at byte 40.
        pub darkest: f32,
        /// `brightest` at byte 44.
        pub brightest: f32,
        /// `chroma_squared` at byte 48.
        pub chroma_squared: f32,
    }
    const _: () = assert!(size_of::<Mixture>() == 52);
    const _: () = assert!(std::mem::offset_of!(Mixture, width) == 0);
    const _: () = assert!(std::mem::offset_of!(Mixture, rows) == 4);
    const _: () = assert!(std::mem::offset_of!(Mixture, first_row) == 8);
    const _: () = assert!(std::mem::offset_of!(Mixture, stride) == 12);
    const _: () = assert!(std::mem::offset_of!(Mixture, match_squared) == 16);
    const _: () = assert!(std::mem::offset_of!(Mixture, background_weight) == 20);
    const _: () = assert!(std::mem::offset_of!(Mixture, initial_variance) == 24);
    const _: () = assert!(std::mem::offset_of!(Mixture, initial_weight) == 28);
    const _: () = assert!(std::mem::offset_of!(Mixture, least_variance) == 32);
    const _: () = assert!(std::mem::offset_of!(Mixture, suppress) == 36);
    const _: () = assert!(std::mem::offset_of!(Mixture, darkest) == 40);
    const _: () = assert!(std::mem::offset_of!(Mixture, brightest) == 44);
    const _: () = assert!(std::mem::offset_of!(Mixture, chroma_squared) == 48);
    /// `Morphology` in memory, 24 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Morphology {
        /// `width` at byte 0.
        pub width: u32,
        /// `height` at byte 4.
        pub height: u32,
        /// `stride` at byte 8.
        pub stride: u32,
        /// `radius` at byte 12.
        pub radius: i32,
        /// `square` at byte 16.
        pub square: u32,
        /// `erode` at byte 20.
        pub erode: u32,
    }
    const _: () = assert!(size_of::<Morphology>() == 24);
    const _: () = assert!(std::mem::offset_of!(Morphology, width) == 0);
    const _: () = assert!(std::mem::offset_of!(Morphology, height) == 4);
    const _: () = assert!(std::mem::offset_of!(Morphology, stride) == 8);
    const _: () = assert!(std::mem::offset_of!(Morphology, radius) == 12);
    const _: () = assert!(std::mem::offset_of!(Morphology, square) == 16);
    const _: () = assert!(std::mem::offset_of!(Morphology, erode) == 20);
    /// `Picture` in memory, 24 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Picture {
        /// `width` at byte 0.
        pub width: u32,
        /// `height` at byte 4.
        pub height: u32,
        /// `stride` at byte 8.
        pub stride: u32,
        /// `limit` at byte 12.
        pub limit: u32,
        /// `amount` at byte 16.
        pub amount: i32,
        /// `low` at byte 20.
        pub low: i32,
    }
    const _: () = assert!(size_of::<Picture>() == 24);
    const _: () = assert!(std::mem::offset_of!(Picture, width) == 0);
    const _: () = assert!(std::mem::offset_of!(Picture, height) == 4);
    const _: () = assert!(std::mem::offset_of!(Picture, stride) == 8);
    const _: () = assert!(std::mem::offset_of!(Picture, limit) == 12);
    const _: () = assert!(std::mem::offset_of!(Picture, amount) == 16);
    const _: () = assert!(std::mem::offset_of!(Picture, low) == 20);
    /// `Probable` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Probable {
        /// `width` at byte 0.
        pub width: u32,
        /// `rows` at byte 4.
        pub rows: u32,
        /// `first_row` at byte 8.
        pub first_row: u32,
        /// `every` at byte 12.
        pub every: u32,
    }
    const _: () = assert!(size_of::<Probable>() == 16);
    const _: () = assert!(std::mem::offset_of!(Probable, width) == 0);
    const _: () = assert!(std::mem::offset_of!(Probable, rows) == 4);
    const _: () = assert!(std::mem::offset_of!(Probable, first_row) == 8);
    const _: () = assert!(std::mem::offset_of!(Probable, every) == 12);
    /// `Rates` in memory, 8 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Rates {
        /// `alpha` at byte 0.
        pub alpha: f32,
        /// `first` at byte 4.
        pub first: u32,
    }
    const _: () = assert!(size_of::<Rates>() == 8);
    const _: () = assert!(std::mem::offset_of!(Rates, alpha) == 0);
    const _: () = assert!(std::mem::offset_of!(Rates, first) == 4);
    /// `Ratios` in memory, 8 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Ratios {
        /// `width` at byte 0.
        pub width: u32,
        /// `height` at byte 4.
        pub height: u32,
    }
    const _: () = assert!(size_of::<Ratios>() == 8);
    const _: () = assert!(std::mem::offset_of!(Ratios, width) == 0);
    const _: () = assert!(std::mem::offset_of!(Ratios, height) == 4);
    /// `Widths` in memory, 16 bytes.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
    pub struct Widths {
        /// `y` at byte 0.
        pub y: f32,
        /// `c` at byte 4.
        pub c: f32,
        /// `lit` at byte 8.
        pub lit: f32,
        /// `shadow` at byte 12.
        pub shadow: f32,
    }
    const _: () = assert!(size_of::<Widths>() == 16);
    const _: () = assert!(std::mem::offset_of!(Widths, y) == 0);
    const _: () = assert!(std::mem::offset_of!(Widths, c) == 4);
    const _: () = assert!(std::mem::offset_of!(Widths, lit) == 8);
    const _: () = assert!(std::mem::offset_of!(Widths, shadow) == 12);
}
/// Every stage of the folder, for tests that try them all.
#[cfg(test)]
#[allow(dead_code, unreachable_pub, reason = "written by the build")]
pub static SHADERS: &[&crate::gpu::Shader] = &[&bounds_comp::SHADER, &bridge_comp::SHADER, &canny_comp::SHADER, &components_join_comp::SHADER, &components_keep_comp::SHADER, &components_label_comp::SHADER, &components_largest_comp::SHADER, &components_measure_comp::SHADER, &difference_comp::SHADER, &distance_comp::SHADER, &edges_comp::SHADER, &gain_comp::SHADER, &ignore_comp::SHADER, &likely_comp::SHADER, &masked_comp::SHADER, &mixture_comp::SHADER, &morphology_comp::SHADER, &pack_comp::SHADER, &probable_comp::SHADER, &ratios_comp::SHADER, &reach_comp::SHADER, &shadowed_comp::SHADER, &smooth_comp::SHADER, &unlikely_comp::SHADER];
