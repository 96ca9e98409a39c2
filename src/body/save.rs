//! A body written as `body.toml`, so that fitted bodies can be kept and edited.

use std::fmt::Write as _;
use std::path::{Path, absolute};

use anyhow::Result;
use glam::DVec3;

use super::{Body, Dof, DofAxis, MeshSource};
use crate::files::{Overwrite, write_atomically};
use crate::geometry::EulerOrder;

impl Body {
    /// The text of a `body.toml` (mm and degrees). Reading it gives an equal body back: exactly, where an angle came from
    /// a file; otherwise angles within one unit in the last place.
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        // Writing into a String cannot fail.
        let _ = self.write_toml(&mut text);
        text
    }

    /// Writes `body.toml`, atomically. A mesh's file in the same folder is named from there, so that both can be moved.
    ///
    /// # Errors
    /// When the file exists and may not be replaced, or cannot be written.
    pub fn save(&self, path: &Path, overwrite: Overwrite) -> Result<()> {
        let mut body = self.clone();
        if let Some(MeshSource::Skinned { file, .. }) = &mut body.mesh
            && let Some(folder) = absolute(path).ok().as_deref().and_then(Path::parent)
            && let Ok(below) = file.strip_prefix(folder)
        {
            *file = below.to_path_buf();
        }
        write_atomically(path, overwrite, |writer| Ok(writer.write_all(body.to_toml().as_bytes())?))
    }

    fn write_toml(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "name = {}\nunits = \"mm\"", quoted(&self.name))?;
        for bone in &self.bones {
            let parent = bone.parent.map_or("", |parent| &self.bones[parent].name);
            writeln!(text, "\n[[bone]]\nname = {}\nparent = {}", quoted(&bone.name), quoted(parent))?;
            writeln!(text, "offset = {}", point(bone.offset))?;
            if bone.order != EulerOrder::default() {
                writeln!(text, "order = \"{}\"", bone.order.name())?;
            }
            if !bone.dofs.is_empty() {
                let limits = |dof: &Dof| {
                    let [low, high] = dof.limits.map(|limit| number(dof.axis, limit));
                    format!("[{low}, {high}]")
                };
                writeln!(text, "dof = [{}]", list(&bone.dofs, |dof| format!("\"{}\"", dof.axis.name())))?;
                let named = |dof: &Dof, value: String| format!("{} = {value}", dof.axis.name());
                writeln!(text, "limits = {{ {} }}", list(&bone.dofs, |dof| named(dof, limits(dof))))?;
                let step = |dof: &Dof| named(dof, number(dof.axis, dof.step).to_string());
                writeln!(text, "step = {{ {} }}", list(&bone.dofs, step))?;
            }
        }
        for part in &self.parts {
            let bone = &self.bones[part.bone].name;
            writeln!(text, "\n[[part]]\nname = {}\nbone = {}", quoted(&part.name), quoted(bone))?;
            writeln!(text, "a = {}\nb = {}", point(part.a), point(part.b))?;
            writeln!(text, "radius_a = {}\nradius_b = {}\nlabel = {}", part.radius_a, part.radius_b, part.label)?;
        }
        for marker in &self.markers {
            let bone = &self.bones[marker.bone].name;
            writeln!(text, "\n[[marker]]\nname = {}\nbone = {}", quoted(&marker.name), quoted(bone))?;
            writeln!(text, "at = {}", point(marker.at))?;
        }
        match &self.mesh {
            None => {}
            Some(MeshSource::Skinned { file, skinning, joints }) => {
                writeln!(text, "\n[mesh]\nfile = {}", quoted(&file.display().to_string()))?;
                writeln!(text, "skinning = \"{}\"", skinning.name())?;
                if !joints.is_empty() {
                    writeln!(text, "\n[mesh.bones]")?;
                }
                for (bone, joint) in joints {
                    writeln!(text, "{} = {}", quoted(bone), quoted(joint))?;
                }
            }
            Some(MeshSource::Frusta { base, flattening }) => {
                writeln!(text, "\n[mesh]\nfrusta = \"{}\"\nvertices = {}", base.name(), base.vertices())?;
                if !flattening.is_empty() {
                    writeln!(text, "\n[mesh.flattening]")?;
                }
                for (part, ratio) in flattening {
                    writeln!(text, "{} = {ratio}", quoted(part))?;
                }
            }
        }
        Ok(())
    }
}

fn list(dofs: &[Dof], show: impl Fn(&Dof) -> String) -> String {
    dofs.iter().map(show).collect::<Vec<_>>().join(", ")
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_string()).to_string()
}

fn point(at: DVec3) -> String {
    format!("[{}, {}, {}]", at.x, at.y, at.z)
}

/// The shortest number for the file that reads back as `value`: 30 degrees, not 29.999999999999996.
fn number(axis: DofAxis, value: f64) -> f64 {
    let exact = axis.to_file(value);
    (0..12)
        .map(|decimals| {
            let scale = 10_f64.powi(decimals);
            (exact * scale).round() / scale
        })
        .chain([exact, exact.next_up(), exact.next_down()])
        .find(|&candidate| axis.from_file(candidate) == value)
        .unwrap_or(exact)
}
