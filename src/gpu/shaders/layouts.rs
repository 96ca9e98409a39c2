//! Memory layouts of a room's blocks as Rust structs with every byte accounted for.

use super::reflect::{Layout, Member, Struct};
use anyhow::{Result, ensure};
use std::collections::BTreeMap;
use std::fmt::Write;

/// The structs met so far, by Rust name.
#[derive(Default)]
pub struct Layouts {
    emitted: BTreeMap<String, Emitted>,
}

struct Emitted {
    /// The stage that brought it, to name when another one differs.
    stage: String,
    source: String,
}

impl Layouts {
    /// Adds the block `block` of `stage` under the Rust name `name`, and every struct inside. A run-time array at its
    /// end adds its element's struct; what stands before it becomes `<name>Header`. Returns the bytes of the fixed
    /// part.
    ///
    /// # Errors
    /// Names both stages when another layout has the name already, or the member that has no Rust type.
    pub fn block(&mut self, stage: &str, name: &str, block: &Struct) -> Result<u32> {
        let mut fixed = block.clone();
        let Some(Member { layout: Layout::Array { element, count: None, stride }, name: last, .. }) =
            block.members.last()
        else {
            let size = block.size();
            self.structure(stage, name, block, size)?;
            return Ok(size);
        };
        if let Layout::Struct(element) = element.as_ref() {
            self.structure(stage, &camel_case(&element.name), element, *stride)?;
        } else if let Layout::Array { .. } = element.as_ref() {
            self.rust_type(stage, name, last, element)?;
        }
        let end = fixed.members.pop().map_or(0, |member| member.offset);
        if !fixed.members.is_empty() {
            self.structure(stage, &format!("{name}Header"), &fixed, end)?;
        }
        Ok(end)
    }

    /// Source of the module `layout`.
    pub fn source(&self) -> String {
        if self.emitted.is_empty() {
            return String::new();
        }
        let mut text = String::from(
            "/// Memory layouts of the blocks.\n#[allow(dead_code, unreachable_pub, reason = \"written by the build\")]\npub mod layout {\n",
        );
        for emitted in self.emitted.values() {
            text += &emitted.source;
        }
        text + "}\n"
    }

    fn structure(&mut self, stage: &str, name: &str, structure: &Struct, size: u32) -> Result<()> {
        let mut fields = String::new();
        let mut offsets = Vec::new();
        let (mut at, mut pads) = (0, 0);
        let mut pad = |fields: &mut String, bytes: u32| -> Result<()> {
            let ty = if bytes.is_multiple_of(4) { format!("[u32; {}]", bytes / 4) } else { format!("[u8; {bytes}]") };
            // A member may have been padded by hand, with a name of ours.
            while structure.members.iter().any(|member| member.name == format!("_pad{pads}")) {
                pads += 1;
            }
            if bytes > 0 {
                writeln!(fields, "        /// Padding.\n        pub _pad{pads}: {ty},")?;
                pads += 1;
            }
            Ok(())
        };
        for member in &structure.members {
            let field = identifier(&member.name);
            ensure!(
                !offsets.iter().any(|(name, _)| *name == field),
                "{stage}: two members of {name} are called {field}"
            );
            ensure!(member.offset >= at, "{stage}: the members of {name} overlap at byte {}", member.offset);
            let (ty, bytes) = self.rust_type(stage, name, &member.name, &member.layout)?;
            pad(&mut fields, member.offset - at)?;
            writeln!(fields, "        /// `{}` at byte {}.\n        pub {field}: {ty},", member.name, member.offset)?;
            offsets.push((field, member.offset));
            at = member.offset + bytes;
        }
        ensure!(size >= at, "{stage}: {name} takes {at} bytes, but its array has steps of {size}");
        pad(&mut fields, size - at)?;
        let mut source = format!("    /// `{name}` in memory, {size} bytes.\n    #[repr(C)]\n");
        writeln!(source, "    #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]")?;
        writeln!(source, "    pub struct {name} {{\n{fields}    }}")?;
        writeln!(source, "    const _: () = assert!(size_of::<{name}>() == {size});")?;
        for (field, offset) in &offsets {
            writeln!(source, "    const _: () = assert!(std::mem::offset_of!({name}, {field}) == {offset});")?;
        }
        if let Some(before) = self.emitted.get(name) {
            let other = &before.stage;
            ensure!(
                before.source == source,
                "{stage}: {name} has another memory layout than in {other}; give one of them another name"
            );
            return Ok(());
        }
        self.emitted.insert(name.to_string(), Emitted { stage: stage.to_string(), source });
        Ok(())
    }

    /// Rust type and bytes of a member, once the structs in it are added.
    fn rust_type(&mut self, stage: &str, owner: &str, member: &str, layout: &Layout) -> Result<(String, u32)> {
        Ok(match layout {
            Layout::Scalar(scalar, bytes) => ((*scalar).to_string(), *bytes),
            Layout::Vector(scalar, bytes, count) => (format!("[{scalar}; {count}]"), bytes * count),
            // A column of three keeps its padding as a fourth number.
            Layout::Matrix { scalar, bytes, columns, stride } => {
                (format!("[[{scalar}; {}]; {columns}]", stride / bytes), stride * columns)
            }
            Layout::Struct(structure) => {
                let name = camel_case(&structure.name);
                let size = structure.size();
                self.structure(stage, &name, structure, size)?;
                (name, size)
            }
            Layout::Array { element, count, stride } => {
                let (ty, bytes) = match element.as_ref() {
                    Layout::Struct(structure) => {
                        let name = camel_case(&structure.name);
                        self.structure(stage, &name, structure, *stride)?;
                        (name, *stride)
                    }
                    other => self.rust_type(stage, owner, member, other)?,
                };
                ensure!(
                    bytes == *stride,
                    "{stage}: the elements of {member} in {owner} take {bytes} bytes but lie {stride} apart; \
                     make them vec4 or a struct"
                );
                let Some(count) = count else {
                    anyhow::bail!("{stage}: {member} in {owner} has no length and does not stand last");
                };
                (format!("[{ty}; {count}]"), stride * count)
            }
        })
    }
}

/// `camera_view` and `CameraView` become `CameraView`.
pub fn camel_case(name: &str) -> String {
    let mut text = String::new();
    for word in name.split(|c: char| !c.is_ascii_alphanumeric()) {
        let mut letters = word.chars();
        text.extend(letters.next().map(|first| first.to_ascii_uppercase()));
        text.extend(letters);
    }
    if text.starts_with(|c: char| c.is_ascii_digit()) { format!("_{text}") } else { text }
}

/// A GLSL or file name as a snake-case Rust identifier: `project.comp` becomes `project_comp`, `poseCount` becomes
/// `pose_count`.
pub fn identifier(name: &str) -> String {
    const KEYWORDS: &[&str] = &[
        "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "do", "dyn", "else", "enum",
        "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro", "match", "mod",
        "move", "mut", "override", "priv", "pub", "ref", "return", "static", "struct", "trait", "true", "try", "type",
        "typeof", "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
    ];
    let mut text = String::new();
    let mut lower_before = false;
    for c in name.chars() {
        if c.is_ascii_uppercase() && lower_before {
            text.push('_');
        }
        lower_before = c.is_ascii_lowercase() || c.is_ascii_digit();
        text.push(if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' });
    }
    match text.as_str() {
        "self" | "super" | "crate" | "_" => text + "_",
        word if KEYWORDS.contains(&word) => format!("r#{word}"),
        word if word.starts_with(|c: char| c.is_ascii_digit()) => format!("_{word}"),
        _ => text,
    }
}
