//! The graphics device: shaders and what they want bound.

pub mod shader;
#[cfg(feature = "reload")]
pub mod shaders;

/// Memory on the device.
#[derive(Debug)]
pub struct Buffer;

/// A picture on the device.
#[derive(Debug)]
pub struct Image;

#[cfg(test)]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/gpu_stages.rs"));
}

#[cfg(test)]
mod tests {
    use super::generated::{self, double_comp, fill_vert, layout};
    use super::shader::{Access, Bound, ShaderKind};
    use super::{Buffer, Image};

    #[test]
    fn a_stage_s_bindings_go_where_its_shader_says() {
        let (source, target) = (Buffer, Buffer);
        let bound = double_comp::Bindings { source: &source, target: &target }.bound();
        let at = bound.map(|binding| (binding.layout.name, binding.layout.binding, binding.layout.access));
        assert_eq!(at, [("Source", 0, Access::Read), ("Target", 1, Access::Write)]);
        assert!(bound.iter().all(|binding| matches!(binding.bound, Bound::Buffer(_))));
        assert_eq!(fill_vert::Bindings { corners: &source }.bound().len(), 1);
        assert_eq!(double_comp::SHADER.workgroup_size, [generated::DOUBLE_WORKGROUP, 1, 1]);
        assert_eq!(double_comp::SHADER.push_size as usize, size_of::<double_comp::Push>());
        let push = layout::DoublePush { count: 3, factor: 2.0 };
        assert_eq!(bytemuck::bytes_of(&push)[..4], [3, 0, 0, 0]);
        let _ = Bound::Image(&Image);
    }

    #[test]
    fn every_stage_is_spir_v() {
        let kinds: Vec<ShaderKind> = generated::SHADERS.iter().map(|shader| shader.kind).collect();
        assert_eq!(kinds, [ShaderKind::Compute, ShaderKind::Fragment, ShaderKind::Vertex]);
        for shader in generated::SHADERS {
            assert_eq!(shader.spirv[..2], [0x0723_0203, 0x0001_0300], "{}", shader.name);
        }
    }
}
