//! Pipelines, laid out by what the build reflected of their stages.

use std::ffi::CString;
use std::sync::Arc;

use anyhow::{Result, anyhow, bail, ensure};
use ash::vk;

use super::buffer::Buffer;
use super::capability::Capabilities;
use super::counting::{COUNTERS, counted};
use super::device_shared::{DeviceShared, Inspect};
use super::executables::{Executable, executables, flags};
use super::fixed_function::{Drawing, Made};
use super::float_controls::controlled;
use super::hazards::Use;
use super::interface::{Access, BindingKind, ShaderKind};
use super::shader::{Binding, BindingLayout, Bound, Shader, ShaderStage};
use super::spirv::uses_subgroups;
use super::work::{Work, blocks};

/// A compiled pipeline; clones are the same pipeline.
#[derive(Clone)]
pub struct Pipeline {
    pub(super) shared: Arc<PipelineShared>,
}

pub(super) struct PipelineShared {
    device: Arc<DeviceShared>,
    pub(super) name: String,
    pub(super) handle: vk::Pipeline,
    pub(super) layout: vk::PipelineLayout,
    pub(super) set_layouts: Vec<vk::DescriptorSetLayout>,
    pub(super) bind_point: vk::PipelineBindPoint,
    slots: Vec<Slot>,
    pub(super) push_stages: vk::ShaderStageFlags,
    pub(super) push_size: u32,
    /// What a run of each block of its stages does, where it counts them; else empty.
    pub(super) blocks: Vec<Work>,
}

/// A descriptor of a pipeline.
#[derive(Clone, Debug)]
pub(super) struct Slot {
    pub(super) set: u32,
    pub(super) binding: u32,
    pub(super) kind: BindingKind,
    /// What its stages together do with it: of the shaders that run, whichever struct named the resources.
    access: Access,
    name: &'static str,
    visible: vk::ShaderStageFlags,
}

/// A slot and what is bound there.
pub(super) type Resource<'a> = (Slot, Bound<'a>);

impl std::fmt::Debug for Pipeline {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Pipeline").field("name", &self.shared.name).finish_non_exhaustive()
    }
}

impl Pipeline {
    /// Compiles a compute stage.
    pub(super) fn compute(device: &Arc<DeviceShared>, stage: &ShaderStage) -> Result<Self> {
        let shader = stage.shader;
        let size = stage.workgroup_size();
        let group: u32 = size.iter().product();
        let most = device.facts.capabilities.max_workgroup;
        ensure!(shader.kind == ShaderKind::Compute, "{} is not a compute stage", shader.name);
        ensure!(group <= most, "{} wants workgroups of {group}, and this device allows {most}", shader.name);
        let pinned = pinned_subgroup(shader, size, &device.facts.capabilities);
        let mut stage = stage.clone();
        // A stage that asks is told how many invocations each of its subgroups has.
        let asked = shader.constants.iter().find(|constant| constant.name == FULL_SUBGROUP);
        stage.constants.extend(asked.zip(pinned).map(|(constant, size)| (constant.id, size)));
        Self::new(device, shader.name, std::slice::from_ref(&stage), |device, layout, stages| {
            let mut size = vk::PipelineShaderStageRequiredSubgroupSizeCreateInfo::default()
                .required_subgroup_size(pinned.unwrap_or_default());
            let mut stage = stages[0];
            if pinned.is_some() {
                stage = stage.flags(vk::PipelineShaderStageCreateFlags::REQUIRE_FULL_SUBGROUPS).push_next(&mut size);
            }
            let info = [vk::ComputePipelineCreateInfo::default().flags(flags(device)).stage(stage).layout(layout)];
            // SAFETY: the stage and layout live through the call.
            unsafe { device.raw.create_compute_pipelines(device.pipelines, &info, None) }
        })
    }

    /// Compiles a graphics pipeline without vertex buffers: vertex stages read storage buffers. Viewport and scissor are set a draw.
    pub(super) fn graphics(
        device: &Arc<DeviceShared>,
        name: &str,
        stages: &[ShaderStage],
        drawing: &Drawing,
    ) -> Result<Self> {
        Self::new(device, name, stages, |device, layout, stages| drawing.create(device, layout, stages))
    }

    fn new(
        device: &Arc<DeviceShared>,
        name: &str,
        stages: &[ShaderStage],
        create: impl FnOnce(&DeviceShared, vk::PipelineLayout, &[vk::PipelineShaderStageCreateInfo<'_>]) -> Made,
    ) -> Result<Self> {
        let mut slots = slots(name, stages)?;
        let is_counting = counts(device, stages);
        if is_counting {
            let visible =
                stages.iter().fold(vk::ShaderStageFlags::empty(), |all, stage| all | stage_flag(stage.shader.kind));
            let BindingLayout { set, binding, kind, access, name } = COUNTERS;
            slots.push(Slot { set, binding, kind, access, name, visible });
        }
        let mut work = Vec::new();
        let (mut push_stages, mut push_size) = (vk::ShaderStageFlags::empty(), 0);
        for ShaderStage { shader, .. } in stages.iter().filter(|stage| stage.shader.push_size > 0) {
            push_stages |= stage_flag(shader.kind);
            push_size = push_size.max(shader.push_size);
        }
        let room = device.facts.capabilities.push_constants;
        ensure!(push_size <= room, "{name} takes {push_size} bytes of push constants, and this device {room}");
        let mut made =
            Parts { device, set_layouts: Vec::new(), layout: vk::PipelineLayout::null(), modules: Vec::new() };
        let sets = slots.iter().map(|slot| slot.set + 1).max().unwrap_or(0);
        for set in 0..sets {
            let bindings: Vec<_> = slots
                .iter()
                .filter(|slot| slot.set == set)
                .map(|slot| {
                    vk::DescriptorSetLayoutBinding::default()
                        .binding(slot.binding)
                        .descriptor_type(descriptor_type(slot.kind))
                        .descriptor_count(1)
                        .stage_flags(slot.visible)
                })
                .collect();
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            // SAFETY: the bindings live through the call.
            let layout = unsafe { device.raw.create_descriptor_set_layout(&info, None) }
                .map_err(|result| device.failure(result, &format!("lay out the bindings of {name}"), || None))?;
            made.set_layouts.push(layout);
        }
        let push = [vk::PushConstantRange::default().stage_flags(push_stages).size(push_size.next_multiple_of(4))];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&made.set_layouts)
            .push_constant_ranges(if push_size > 0 { &push } else { &[] });
        // SAFETY: everything `info` points to lives through the call.
        made.layout = unsafe { device.raw.create_pipeline_layout(&info, None) }
            .map_err(|result| device.failure(result, &format!("lay out {name}"), || None))?;

        let mut entries = Vec::new();
        let mut data = Vec::new();
        for ShaderStage { shader, constants } in stages {
            for (id, _) in constants {
                ensure!(
                    shader.constants.iter().any(|constant| constant.id == *id),
                    "{} has no specialisation constant {id}",
                    shader.name
                );
            }
            entries.push(
                (0..constants.len())
                    .map(|nth| vk::SpecializationMapEntry {
                        constant_id: constants[nth].0,
                        offset: 4 * nth as u32,
                        size: 4,
                    })
                    .collect::<Vec<_>>(),
            );
            data.push(constants.iter().flat_map(|(_, bits)| bits.to_ne_bytes()).collect::<Vec<u8>>());
            let mut code = code(device, shader);
            if is_counting {
                let first = work.len() as u32;
                work.extend(blocks(&code));
                code = counted(&code, shader.kind, first);
            }
            let info = vk::ShaderModuleCreateInfo::default().code(&code);
            // SAFETY: the code was made and validated by the build.
            let module = unsafe { device.raw.create_shader_module(&info, None) }
                .map_err(|result| device.failure(result, &format!("load the shader {}", shader.name), || None))?;
            made.modules.push(module);
        }
        let special: Vec<_> = entries
            .iter()
            .zip(&data)
            .map(|(entries, data)| vk::SpecializationInfo::default().map_entries(entries).data(data))
            .collect();
        let entry_point = CString::from(c"main");
        let infos: Vec<_> = stages
            .iter()
            .zip(&made.modules)
            .zip(&special)
            .map(|((stage, module), special)| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(stage_flag(stage.shader.kind))
                    .module(*module)
                    .name(&entry_point)
                    .specialization_info(special)
            })
            .collect();
        let handle = create(device, made.layout, &infos)
            .map_err(|(_, result)| device.failure(result, &format!("compile {name}"), || None))?
            .into_iter()
            .next()
            .ok_or_else(|| anyhow!("the driver made no pipeline of {name}"))?;
        device.name(handle, name);
        let is_compute = stages.first().is_some_and(|stage| stage.shader.kind == ShaderKind::Compute);
        let (layout, set_layouts) = made.keep();
        Ok(Self {
            shared: Arc::new(PipelineShared {
                device: device.clone(),
                name: name.to_string(),
                handle,
                layout,
                set_layouts,
                bind_point: if is_compute { vk::PipelineBindPoint::COMPUTE } else { vk::PipelineBindPoint::GRAPHICS },
                slots,
                push_stages,
                push_size,
                blocks: work,
            }),
        })
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.shared.name
    }

    /// What the driver made of its stages.
    pub(super) fn executables(&self) -> Vec<Executable> {
        executables(&self.shared.device, self.shared.handle)
    }

    /// What the pass called `pass` binds to each of its descriptors; other bindings are of no use to it.
    pub(super) fn resources<'a>(&self, pass: &str, bindings: &[Binding<'a>]) -> Result<Vec<Resource<'a>>> {
        let mut resources = Vec::new();
        for slot in &self.shared.slots {
            let at = |binding: &&Binding<'_>| (binding.layout.set, binding.layout.binding) == (slot.set, slot.binding);
            let Some(binding) = bindings.iter().find(at) else {
                bail!("the pass {pass} binds nothing to {} of {}", slot.name, self.name());
            };
            let is_buffer = matches!(slot.kind, BindingKind::StorageBuffer | BindingKind::UniformBuffer);
            ensure!(
                is_buffer == matches!(binding.bound, Bound::Buffer(_)),
                "the pass {pass} binds the wrong kind of resource to {} of {}",
                slot.name,
                self.name()
            );
            resources.push((slot.clone(), binding.bound));
        }
        Ok(resources)
    }
}

/// What a pass does with these resources.
pub(super) fn uses<'a>(resources: &'a [Resource<'_>]) -> impl Iterator<Item = Use> + 'a {
    resources.iter().map(|(slot, bound)| Use { resource: bound.id(), writes: slot.access.writes() })
}

/// Whether all stages of a pipeline count their work: those of a kind that may not write cannot.
fn counts(device: &DeviceShared, stages: &[ShaderStage]) -> bool {
    let capabilities = &device.facts.capabilities;
    device.settings.inspect == Inspect::Work
        && stages.iter().all(|stage| match stage.shader.kind {
            ShaderKind::Compute => true,
            ShaderKind::Vertex | ShaderKind::Geometry => capabilities.vertex_stores,
            ShaderKind::Fragment => capabilities.fragment_stores,
        })
}

/// What is bound to a pipeline that has counters.
pub(super) fn with_counters<'a>(bindings: &[Binding<'a>], counters: Option<&'a Buffer>) -> Vec<Binding<'a>> {
    let counters = counters.map(|buffer| Binding { layout: &COUNTERS, bound: Bound::Buffer(buffer) });
    bindings.iter().copied().chain(counters).collect()
}

/// All descriptors of all stages.
fn slots(name: &str, stages: &[ShaderStage]) -> Result<Vec<Slot>> {
    let mut slots: Vec<Slot> = Vec::new();
    for shader in stages.iter().map(|stage| stage.shader) {
        let visible = stage_flag(shader.kind);
        for layout in shader.bindings {
            let &BindingLayout { set, binding, kind, access, name: own } = layout;
            match slots.iter_mut().find(|slot| (slot.set, slot.binding) == (set, binding)) {
                Some(slot) => {
                    ensure!(
                        slot.kind == kind,
                        "{name}: {} and {own} use set {set} binding {binding} for different things",
                        slot.name
                    );
                    slot.access = slot.access.and(access);
                    slot.visible |= visible;
                }
                None => slots.push(Slot { set, binding, kind, access, name: own, visible }),
            }
        }
    }
    Ok(slots)
}

/// The code of a stage as the device takes it.
fn code(device: &DeviceShared, shader: &Shader) -> Vec<u32> {
    let capabilities = &device.facts.capabilities;
    #[cfg(test)]
    if let Some(change) = device.settings.code {
        return controlled(&change(shader.name, shader.spirv), capabilities);
    }
    controlled(shader.spirv, capabilities)
}

/// The specialisation constant of a stage that asks for the size of its subgroups: 0 where they are not held to one.
const FULL_SUBGROUP: &str = "FULL_SUBGROUP";

/// The subgroup size that a compute stage is held to, with all of its subgroups full: the device's own where the workgroup is a
/// whole number of such, else the largest that fits. None for stages that use no subgroups, and where the device does not let one.
fn pinned_subgroup(shader: &Shader, workgroup: [u32; 3], capabilities: &Capabilities) -> Option<u32> {
    let [least, most] = capabilities.subgroup_sizes?;
    let groups: u32 = workgroup.iter().product();
    let fits =
        |size: &u32| workgroup[0].is_multiple_of(*size) && groups <= size.saturating_mul(capabilities.max_subgroups);
    let sizes = (0..32).map(|power| 1 << power).filter(|size| (least..=most).contains(size));
    let largest = sizes.filter(fits).max();
    let own = Some(capabilities.subgroup_size).filter(|size| (least..=most).contains(size)).filter(fits);
    if uses_subgroups(shader.spirv) { own.or(largest) } else { None }
}

/// Objects on the way to a pipeline, destroyed should it not be reached.
struct Parts<'a> {
    device: &'a DeviceShared,
    set_layouts: Vec<vk::DescriptorSetLayout>,
    layout: vk::PipelineLayout,
    modules: Vec<vk::ShaderModule>,
}

impl Parts<'_> {
    /// What a finished pipeline keeps.
    fn keep(mut self) -> (vk::PipelineLayout, Vec<vk::DescriptorSetLayout>) {
        (std::mem::take(&mut self.layout), std::mem::take(&mut self.set_layouts))
    }
}

impl Drop for Parts<'_> {
    fn drop(&mut self) {
        // SAFETY: modules are not needed once a pipeline is made; layouts left here belong to none.
        unsafe {
            for module in &self.modules {
                self.device.raw.destroy_shader_module(*module, None);
            }
            self.device.raw.destroy_pipeline_layout(self.layout, None);
            for layout in &self.set_layouts {
                self.device.raw.destroy_descriptor_set_layout(*layout, None);
            }
        }
    }
}

impl Drop for PipelineShared {
    fn drop(&mut self) {
        // SAFETY: recordings hold the pipelines they use until the device is done.
        unsafe {
            self.device.raw.destroy_pipeline(self.handle, None);
            self.device.raw.destroy_pipeline_layout(self.layout, None);
            for layout in &self.set_layouts {
                self.device.raw.destroy_descriptor_set_layout(*layout, None);
            }
        }
    }
}

fn stage_flag(kind: ShaderKind) -> vk::ShaderStageFlags {
    match kind {
        ShaderKind::Compute => vk::ShaderStageFlags::COMPUTE,
        ShaderKind::Vertex => vk::ShaderStageFlags::VERTEX,
        ShaderKind::Geometry => vk::ShaderStageFlags::GEOMETRY,
        ShaderKind::Fragment => vk::ShaderStageFlags::FRAGMENT,
    }
}

pub(super) fn descriptor_type(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::UniformBuffer => vk::DescriptorType::UNIFORM_BUFFER,
        BindingKind::SampledImage => vk::DescriptorType::SAMPLED_IMAGE,
        BindingKind::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::test_device::device;
    use crate::gpu::{DeviceSettings, generated};

    #[test]
    fn subgroups_are_pinned_where_the_workgroup_is_a_whole_number_of_them() {
        let Some((device, _)) = device("subgroups_are_pinned", DeviceSettings::default()) else { return };
        let plain = &generated::double_comp::SHADER;
        // The capability GroupNonUniform, before all else.
        let mut code = plain.spirv.to_vec();
        code.splice(5..5, [2 << 16 | 17, 61]);
        let size = |group: u32, own: u32, sizes: Option<[u32; 2]>, most: u32, spirv: &'static [u32]| {
            let shader = Shader { workgroup_size: [group, 1, 1], spirv, ..*plain };
            let capabilities = Capabilities {
                subgroup_size: own,
                subgroup_sizes: sizes,
                max_subgroups: most,
                ..*device.capabilities()
            };
            pinned_subgroup(&shader, shader.workgroup_size, &capabilities)
        };
        let code: &'static [u32] = code.leak();
        assert_eq!(size(128, 32, Some([32, 32]), 32, code), Some(32));
        assert_eq!(size(128, 64, Some([32, 64]), 32, code), Some(64));
        assert_eq!(size(32, 64, Some([32, 64]), 32, code), Some(32), "a smaller one for a small workgroup");
        assert_eq!(size(32, 128, Some([64, 128]), 32, code), None, "none is full");
        assert_eq!(size(128, 8, Some([8, 32]), 8, code), Some(32), "so many subgroups are too many");
        assert_eq!(size(128, 32, None, 32, code), None);
        assert_eq!(size(128, 32, Some([32, 32]), 32, plain.spirv), None, "nothing is done over subgroups");
    }
}
