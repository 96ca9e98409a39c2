//! The build's shader compiler, reflector and generator, on small shaders written for each question.
#![allow(unreachable_pub, reason = "the modules below are the library's too")]
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

#[path = "../src/gpu/shaders/compile.rs"]
mod compile;
#[path = "../src/gpu/shaders/constants.rs"]
mod constants;
#[path = "../src/gpu/shaders/generate.rs"]
mod generate;
#[path = "../src/gpu/interface.rs"]
mod interface;
#[path = "../src/gpu/shaders/kept.rs"]
mod kept;
#[path = "../src/gpu/shaders/layouts.rs"]
mod layouts;
#[path = "../src/gpu/shaders/reflect.rs"]
mod reflect;
#[path = "../src/gpu/shaders/write.rs"]
mod write;

use interface::{Access, BindingKind};
use reflect::Reflection;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A shader folder with these files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let root = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = root.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    root
}

/// The Rust of the room `room`, or the error's sentence.
fn generated(files: &[(&str, &str)]) -> Result<String, String> {
    let root = folder(files);
    generate::generate(root.path(), "room").map(|room| room.source).map_err(|error| format!("{error:#}"))
}

fn refused(files: &[(&str, &str)]) -> String {
    match generated(files) {
        Err(sentence) => {
            assert!(!sentence.contains('\n'), "more than one line: {sentence}");
            sentence
        }
        Ok(text) => panic!("it was accepted:\n{text}"),
    }
}

fn reflected(file: &str, text: &str) -> Reflection {
    let root = folder(&[(file, text)]);
    let compiled = compile::compile(root.path(), file).unwrap();
    reflect::reflect(file, &compiled).unwrap()
}

/// A compute stage with these declarations and this body.
fn compute(declarations: &str, body: &str) -> String {
    format!("#version 460\nlayout(local_size_x = 8) in;\n{declarations}\nvoid main() {{ {body} }}\n")
}

/// A stage whose declarations all stand in a storage block `Data data` of binding 0, and are read.
fn reading(before: &str, members: &str, read: &str) -> String {
    let declarations = format!(
        "{before}\nlayout(std430, set = 0, binding = 0) readonly buffer Data {{ {members} }} data;
        layout(std430, set = 0, binding = 1) writeonly buffer Result {{ float result[]; }};"
    );
    compute(&declarations, &format!("result[0] = float({read});"))
}

/// The lines of one struct's fields, as `name: type`, without documentation.
fn fields(source: &str, name: &str) -> Vec<String> {
    let start =
        source.find(&format!("pub struct {name} {{")).unwrap_or_else(|| panic!("no struct {name} in:\n{source}"));
    let body = &source[start..start + source[start..].find('}').unwrap()];
    let lines = body.lines().skip(1).map(|line| line.trim().trim_start_matches("pub ").trim_end_matches(','));
    lines.filter(|line| !line.starts_with("//") && !line.is_empty()).map(str::to_string).collect()
}

#[test]
fn std430_lies_as_computed_by_hand() {
    // vec3 at 0 (12 bytes), float fills the 16; vec2 at 16; vec4 aligned to 32; mat4 at 48; uint[3] at 112; Bone (align 16) at 128.
    let text = reading(
        "struct Bone { vec3 head; uint parent; vec3 tail; };",
        "vec3 a; float b; vec2 c; vec4 d; mat4 e; uint f[3]; Bone g; int h;",
        "data.b + data.g.tail.x + data.h",
    );
    let source = generated(&[("room/a.comp", &text)]).unwrap();
    assert_eq!(fields(&source, "Bone"), ["head: [f32; 3]", "parent: u32", "tail: [f32; 3]", "_pad0: [u32; 1]"]);
    assert_eq!(
        fields(&source, "Data"),
        [
            "a: [f32; 3]",
            "b: f32",
            "c: [f32; 2]",
            "_pad0: [u32; 2]",
            "d: [f32; 4]",
            "e: [[f32; 4]; 4]",
            "f: [u32; 3]",
            "_pad1: [u32; 1]",
            "g: Bone",
            "h: i32",
            "_pad2: [u32; 3]"
        ]
    );
    for line in [
        "assert!(size_of::<Bone>() == 32)",
        "assert!(size_of::<Data>() == 176)",
        "offset_of!(Data, d) == 32)",
        "offset_of!(Data, e) == 48)",
        "offset_of!(Data, f) == 112)",
        "offset_of!(Data, g) == 128)",
        "offset_of!(Data, h) == 160)",
    ] {
        assert!(source.contains(line), "{line} is missing in:\n{source}");
    }
}

#[test]
fn unusual_blocks_are_laid_out_or_refused() {
    let text = reading("", "vec4 a; float b; float _pad0; vec4 type;", "data.type.x");
    let source = generated(&[("room/a.comp", &text)]).unwrap();
    assert_eq!(fields(&source, "Data"), ["a: [f32; 4]", "b: f32", "_pad0: f32", "_pad1: [u32; 2]", "r#type: [f32; 4]"]);
    let sentence = refused(&[("room/a.comp", &reading("", "float a[500000000];", "data.a[0]"))]);
    assert_eq!(sentence, "room/a.comp: an array takes 2000000000 bytes, and 1073741824 are the most");
    let sentence = refused(&[("room/a.comp", &reading("", "layout(row_major) mat4 a;", "data.a[0].x"))]);
    assert_eq!(sentence, "room/a.comp: a row_major matrix has no Rust type here; use column_major");
    let sentence = refused(&[("room/a.comp", &reading("", "float poseCount; float pose_count;", "data.pose_count"))]);
    assert_eq!(sentence, "room/a.comp: two members of Data are called pose_count");
    // Stages of one stem share a block called Push and must agree on it; another name is its own.
    let fragment = |name: &str, members: &str| {
        format!(
            "#version 460\nlayout(push_constant) uniform {name} {{ {members} }} push;\nlayout(location = 0) out float x;\n\
             void main() {{ x = push.a; }}\n"
        )
    };
    let vertex = "#version 460\nlayout(push_constant) uniform Push { vec2 b; float a; } push;\n\
        void main() { gl_Position = vec4(push.b, push.a, 1); }\n";
    let both = |text: &str| {
        [("room/fill.vert".to_string(), vertex.to_string()), ("room/fill.frag".to_string(), text.to_string())]
    };
    let files = both(&fragment("Options", "float a;"));
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    assert_eq!(fields(&generated(&files).unwrap(), "Options"), ["a: f32"]);
    let files = both(&fragment("Push", "vec2 b; float a;"));
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    assert_eq!(fields(&generated(&files).unwrap(), "FillPush"), ["b: [f32; 2]", "a: f32", "_pad0: [u32; 1]"]);
    let files = both(&fragment("Push", "float a; float b;"));
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    assert_eq!(
        refused(&files),
        "room/fill.vert: FillPush has another memory layout than in room/fill.frag; give one of them another name"
    );
}

#[test]
fn std140_pads_what_std430_packs() {
    let block = "layout(std140, set = 0, binding = 0) uniform Data { float a; Lens lens[2]; mat3 b; float c; } data;
        layout(set = 0, binding = 1) writeonly buffer Result { float result[]; };";
    let text =
        compute(&format!("struct Lens {{ float focal; }};\n{block}"), "result[0] = data.c + data.lens[1].focal;");
    let source = generated(&[("room/a.comp", &text)]).unwrap();
    assert_eq!(fields(&source, "Lens"), ["focal: f32", "_pad0: [u32; 3]"]);
    let data = fields(&source, "Data");
    assert_eq!(data[..5], ["a: f32", "_pad0: [u32; 3]", "lens: [Lens; 2]", "b: [[f32; 4]; 3]", "c: f32"]);
    assert!(source.contains("offset_of!(Data, c) == 96)"), "{source}");
    // A float array in std140 has gaps that [f32; 4] has not.
    let text = text.replace("Lens lens[2]", "float lens[2]").replace("[1].focal", "[1]");
    let sentence = refused(&[("room/a.comp", &text)]);
    assert_eq!(
        sentence,
        "room/a.comp: the elements of lens in Data take 4 bytes but lie 16 apart; make them vec4 or a struct"
    );
}

#[test]
fn run_time_arrays_leave_their_element_and_their_header() {
    let text = reading(
        "struct Item { vec2 place; float weight; };",
        "uint count; Item items[];",
        "data.items[data.count].weight + data.items[0].place.x",
    );
    let source = generated(&[("room/a.comp", &text)]).unwrap();
    // Item is 8-aligned: the header ends at 8.
    assert_eq!(fields(&source, "DataHeader"), ["count: u32", "_pad0: [u32; 1]"]);
    assert_eq!(fields(&source, "Item"), ["place: [f32; 2]", "weight: f32", "_pad0: [u32; 1]"]);
    assert_eq!(fields(&source, "Bindings<'a>"), ["data: &'a crate::gpu::Buffer", "result: &'a crate::gpu::Buffer"]);
    assert!(!source.contains("struct Result"), "an array of floats needs no struct:\n{source}");
}

#[test]
fn one_struct_of_two_stages_is_written_once_and_must_agree() {
    let one = reading("struct Bone { vec2 a; float b; };", "Bone bones[];", "data.bones[0].b");
    let source = generated(&[("room/a.comp", &one), ("room/b.comp", &one)]).unwrap();
    assert_eq!(source.matches("pub struct Bone ").count(), 1);
    assert_eq!(source.matches("pub static SHADER:").count(), 2);
    let other = one.replace("vec2 a; float b;", "float b; vec2 a;");
    let sentence = refused(&[("room/a.comp", &one), ("room/b.comp", &other)]);
    assert_eq!(
        sentence,
        "room/b.comp: Bone has another memory layout than in room/a.comp; give one of them another name"
    );
}

#[test]
fn access_is_what_the_code_does() {
    let buffers = |count: usize| -> String {
        (0..count).map(|i| format!("layout(set = 0, binding = {i}) buffer B{i} {{ uint values[]; }} b{i};\n")).collect()
    };
    let text = compute(
        &buffers(5),
        "uint i = gl_GlobalInvocationID.x; b1.values[i] = b0.values[i]; b2.values[i] += 1u; atomicAdd(b3.values[0], 1u);",
    );
    let reflection = reflected("room/a.comp", &text);
    assert_eq!(reflection.unread, None);
    let found: Vec<(&str, Access)> = reflection.resources.iter().map(|r| (r.name.as_str(), r.access)).collect();
    // b4 is declared and not used, so nothing needs to be bound to it.
    assert_eq!(
        found,
        [("b0", Access::Read), ("b1", Access::Write), ("b2", Access::ReadWrite), ("b3", Access::ReadWrite)]
    );
}

#[test]
fn pictures_are_bound_without_samplers() {
    let text = compute(
        "#extension GL_EXT_samplerless_texture_functions : require
        layout(set = 0, binding = 0) uniform utexture2D labels;
        layout(set = 1, binding = 2, r32ui) uniform writeonly uimage2D target;",
        "imageStore(target, ivec2(0), texelFetch(labels, ivec2(gl_GlobalInvocationID.xy), 0));",
    );
    let reflection = reflected("room/a.comp", &text);
    assert_eq!(reflection.unread, None);
    let found: Vec<_> =
        reflection.resources.iter().map(|r| (r.name.as_str(), r.set, r.binding, r.kind, r.access)).collect();
    assert_eq!(
        found,
        [
            ("labels", 0, 0, BindingKind::SampledImage, Access::Read),
            ("target", 1, 2, BindingKind::StorageImage, Access::Write)
        ]
    );
    // naga cannot read atomics on images: they are found, and both read and written.
    let text = compute(
        "layout(binding = 0, r32ui) uniform uimage2D top; layout(binding = 1, r32ui) uniform uimage2D unused;",
        "imageAtomicMax(top, ivec2(0), 1u);",
    );
    let reflection = reflected("room/a.comp", &text);
    assert!(reflection.unread.is_some(), "naga reads image atomics now: the fallback is untested");
    let found: Vec<_> = reflection.resources.iter().map(|r| (r.name.as_str(), r.kind, r.access)).collect();
    assert_eq!(found, [("top", BindingKind::StorageImage, Access::ReadWrite)]);
    let sampler = compute(
        "layout(set = 0, binding = 0) uniform sampler2D photograph; layout(binding = 1) buffer R { vec4 r; };",
        "r = texture(photograph, vec2(0));",
    );
    let sentence = refused(&[("room/a.comp", &sampler)]);
    assert!(sentence.starts_with("room/a.comp: set 0, binding 0: a sampler is not supported"), "{sentence}");
}

#[test]
fn constants_of_the_pipeline_keep_name_number_and_default() {
    let text = "#version 460
        layout(local_size_x_id = 3, local_size_y = 2) in;
        layout(constant_id = 0) const uint COUNT = 7u;
        layout(constant_id = 1) const float SCALE = 0.5;
        layout(constant_id = 2) const bool MIRROR = true;
        layout(binding = 0) buffer R { float r[]; };
        void main() { if (MIRROR) r[gl_LocalInvocationIndex] = SCALE * float(COUNT); }";
    let reflection = reflected("room/a.comp", text);
    let found: Vec<(&str, u32, u32)> =
        reflection.constants.iter().map(|c| (c.name.as_str(), c.id, c.default)).collect();
    let half = 0.5_f32.to_bits();
    assert_eq!(found, [("COUNT", 0, 7), ("SCALE", 1, half), ("MIRROR", 2, 1), ("local_size_x", 3, 1)]);
    assert_eq!(reflection.workgroup_size, [1, 2, 1]);
    let source = generated(&[("room/a.comp", text)]).unwrap();
    assert_eq!(fields(&source, "Constants"), ["count: u32", "scale: f32", "mirror: bool", "local_size_x: u32"]);
    for line in [
        "Self { count: 7, scale: f32::from_bits(1056964608), mirror: true, local_size_x: 1, }",
        "(0, constants.count), (1, constants.scale.to_bits()), (2, u32::from(constants.mirror)), (3, constants.local_size_x)",
    ] {
        assert!(source.contains(line), "{line} is missing in:\n{source}");
    }
}

#[test]
fn a_geometry_stage_keeps_its_declared_access() {
    let text = "#version 460
        layout(triangles) in;
        layout(line_strip, max_vertices = 2) out;
        layout(set = 0, binding = 0) readonly buffer Sides { vec4 sides[]; };
        layout(set = 0, binding = 1) buffer Count { uint count; };
        layout(push_constant) uniform Push { mat4 view; uint first; } push;
        void main() {
            count = push.first;
            for (int i = 0; i < 2; i++) { gl_Position = push.view * sides[i]; EmitVertex(); }
            EndPrimitive();
        }";
    let reflection = reflected("room/edges.geom", text);
    assert!(reflection.unread.is_some(), "naga reads geometry stages now: the fallback is untested");
    let found: Vec<(&str, Access)> = reflection.resources.iter().map(|r| (r.name.as_str(), r.access)).collect();
    assert_eq!(found, [("Sides", Access::Read), ("Count", Access::ReadWrite)]);
    let source = generated(&[("room/edges.geom", text)]).unwrap();
    assert_eq!(fields(&source, "EdgesPush"), ["view: [[f32; 4]; 4]", "first: u32", "_pad0: [u32; 3]"]);
    assert!(source.contains("ShaderKind::Geometry"), "{source}");
}

#[test]
fn subgroup_code_is_read_by_naga() {
    let text = compute(
        "#extension GL_KHR_shader_subgroup_arithmetic : require
        #extension GL_KHR_shader_subgroup_shuffle : require
        layout(binding = 0) buffer R { uint r[]; };
        shared uint sums[64];",
        "uint sum = subgroupAdd(r[gl_LocalInvocationIndex]); sum += subgroupShuffleXor(sum, 1u);
         sums[gl_LocalInvocationIndex] = sum; barrier(); r[0] = sums[0];",
    );
    assert_eq!(reflected("room/a.comp", &text).unread, None);
}

#[test]
fn a_folder_s_includes_count_once_and_keep_their_lines() {
    let main = "#version 460\n#include \"room/a.glsl\"\n#include \"room/b.glsl\"\nvoid main() { int x = ONE + B; }\n";
    let b = ("room/b.glsl", "#include \"room/a.glsl\"\nconst int B = ONE;\n");
    assert!(generated(&[("room/x.frag", main), ("room/a.glsl", "const int ONE = 1;\n"), b]).is_ok());
    let sentence = refused(&[("room/x.frag", main), ("room/a.glsl", "\nconst int ONE = nothing;\n"), b]);
    assert!(sentence.starts_with("room/a.glsl:2: error: 'nothing' : undeclared identifier"), "{sentence}");
}

#[test]
fn wrong_includes_are_named() {
    let main = "#version 460\n\n#include \"room/a.glsl\"\nvoid main() {}\n";
    let sentence = refused(&[("room/x.frag", main)]);
    assert!(sentence.starts_with("room/x.frag:3: error: '#include'"), "{sentence}");
    assert!(sentence.contains("room/x.frag includes room/a.glsl, which cannot be read from"), "{sentence}");
    let circle = [
        ("room/x.frag", main),
        ("room/a.glsl", "#include \"room/b.glsl\"\n"),
        ("room/b.glsl", "\n#include \"room/a.glsl\"\n"),
    ];
    let sentence = refused(&circle);
    assert!(sentence.starts_with("room/b.glsl:2: error:"), "{sentence}");
    assert!(
        sentence.contains("leads back to itself: room/x.frag -> room/a.glsl -> room/b.glsl -> room/a.glsl"),
        "{sentence}"
    );
    let sentence = refused(&[("room/x.frag", &main.replace("room/a.glsl", "../a.glsl"))]);
    assert!(sentence.contains("an include names a .glsl file from the shader folder on"), "{sentence}");
}

#[test]
fn mistakes_are_one_sentence_with_file_and_line() {
    let sentence = refused(&[("room/x.frag", "#version 460\nvoid main() {\n  int x = y;\n  int z = w;\n}\n")]);
    assert_eq!(sentence, "room/x.frag:3: error: 'y' : undeclared identifier (and 3 more)");
    let sentence = refused(&[("room/x.frag", "#version 460\nvoid main() { int x = }\n")]);
    assert!(sentence.starts_with("room/x.frag:2: error:"), "{sentence}");
    let sentence = refused(&[("room/x.frag", "")]);
    assert!(sentence.starts_with("room/x.frag:"), "{sentence}");
    let twice = compute(
        "layout(binding = 0) buffer A { uint a[]; } poses; layout(binding = 1) buffer Poses { uint b[]; };",
        "b[0] = poses.a[0];",
    );
    let sentence = refused(&[("room/a.comp", &twice)]);
    assert_eq!(sentence, "room/a.comp: two resources are called poses; rename that of set 0, binding 1");
    let same = compute(
        "layout(binding = 0) buffer A { uint a[]; }; layout(binding = 0) buffer B { uint b[]; };",
        "b[0] = a[0];",
    );
    assert_eq!(refused(&[("room/a.comp", &same)]), "room/a.comp: A and B share set 0, binding 0");
    let sentence = refused(&[
        ("room/draw-x.frag", "#version 460\nvoid main() {}\n"),
        ("room/draw_x.frag", "#version 460\nvoid main() {}\n"),
    ]);
    assert_eq!(sentence, "room/draw_x.frag: another stage of the folder has the module name draw_x_frag");
}

#[test]
fn names_become_rust_names() {
    for (glsl, rust) in [
        ("project.comp", "project_comp"),
        ("poseCount", "pose_count"),
        ("BonesOfPose", "bones_of_pose"),
        ("type", "r#type"),
        ("self", "self_"),
        ("2d.frag", "_2d_frag"),
    ] {
        assert_eq!(layouts::identifier(glsl), rust);
    }
    assert_eq!(layouts::camel_case("camera_view"), "CameraView");
    assert_eq!(layouts::camel_case("CameraView"), "CameraView");
}

#[test]
fn shared_constants_read_the_same_in_rust() {
    let text = "// Shared.\n\n// Candidates of a tile.\nconst uint TILE = 16u;\nconst int LEAST = -(3 + 0x1F); // Least level.\n\
        const float NEAR = 1e-3;\nconst float HALF = .5f;\nconst uint ROWS = TILE * 2u;\nconst bool ON = true;\nvec3 f() { return vec3(0); }\n";
    let source = constants::constants("room/constants.glsl", text).unwrap();
    for line in [
        "/// Candidates of a tile.\n#[allow(dead_code, unreachable_pub, reason = \"written by the build\")]\npub const TILE: u32 = 16;",
        "/// Least level.\n#[allow(dead_code, unreachable_pub, reason = \"written by the build\")]\npub const LEAST: i32 = -(3 + 31);",
        "pub const NEAR: f32 = 0.001;",
        "pub const HALF: f32 = 0.5;",
        "/// `ROWS` of `room/constants.glsl`.\n#[allow(dead_code, unreachable_pub, reason = \"written by the build\")]\npub const ROWS: u32 = TILE * 2;",
        "pub const ON: bool = true;",
    ] {
        assert!(source.contains(line), "{line} is missing in:\n{source}");
    }
    assert!(!source.contains("Shared."), "{source}");
    for (text, expected) in [
        (
            "\nconst vec3 UP = vec3(0, 0, 1);",
            "c:2: UP is a vec3, and Rust shares only uint, int, float and bool constants",
        ),
        (
            "const float ROOT = sqrt(2.0);",
            "c:1: sqrt is a function, and a shared constant is made of numbers, names and operators",
        ),
        ("const uint A = 99999999999u;", "c:1: 99999999999u is not a u32"),
        ("const uint A = ;", "c:1: the constant has no value"),
        ("const uint lower = 1u;", "c:1: expected a name in capitals, found lower"),
        ("const uint A = 1u; const uint B = 2u;", "c:1: ; does not belong into a shared constant"),
        ("const uint A", "c:1: expected one constant on one line, such as const uint COUNT = 16u; found const uint A"),
        ("const uint A = é;", "c:1: é does not belong into a shared constant"),
    ] {
        let sentence = constants::constants("c", text).map_err(|error| format!("{error:#}")).unwrap_err();
        assert!(sentence.starts_with(expected), "{sentence}\nexpected\n{expected}");
    }
}

/// Every stage of the repository: compiles, and says what naga could not read, so that a change is noticed.
#[test]
fn the_repository_s_stages_compile() {
    let root = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl"));
    let rooms = generate::rooms(&root).unwrap();
    assert!(rooms.contains(&"gpu".to_string()), "{rooms:?}");
    for room in rooms {
        let source = generate::generate(&root, &room).unwrap();
        assert_eq!(source, generate::generate(&root, &room).unwrap(), "{room} is written differently the second time");
    }
    let double = generate::generate(&root, "gpu").unwrap();
    assert_eq!(fields(&double.source, "DoublePush"), ["count: u32", "factor: f32"]);
}

/// The compiler's mark in a module's header: who wrote it and in which version.
fn compiler(module: &[u8]) -> &[u8] {
    &module[8..12]
}

/// What a build takes is what the sources compile to, file by file, and nothing else lies there.
#[test]
fn the_kept_shaders_are_those_of_the_sources() {
    let base = Path::new(env!("CARGO_MANIFEST_DIR"));
    kept::check(base).unwrap();
    let folder = base.join("glsl").join(kept::FOLDER);
    let files = write::files(base).unwrap();
    assert!(files.len() > 80, "{} files", files.len());
    let mut other_compiler = 0;
    for (name, content) in &files {
        let found = std::fs::read(folder.join(name)).unwrap_or_else(|error| panic!("{}: {error}", name.display()));
        // Another version of the compiler may choose other words. What they mean to the host is the same.
        if name.extension().is_some_and(|kind| kind == "spv") && compiler(&found) != compiler(content) {
            other_compiler += 1;
            continue;
        }
        assert!(found == *content, "{} is not what its source compiles to: run `make shaders`", name.display());
    }
    if other_compiler > 0 {
        println!("SKIPPED: the words of {other_compiler} stages, which another version of the compiler made");
    }
    let mut left = vec![folder.clone()];
    while let Some(path) = left.pop() {
        if path.is_dir() {
            left.extend(std::fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else {
            let name = path.strip_prefix(&folder).unwrap();
            assert!(files.contains_key(name), "{} belongs to no source", name.display());
        }
    }
}

/// Everything that the kept shaders were made from, copied, and what a build says after `change` was done to it.
fn after(change: impl Fn(&Path)) -> Result<(), String> {
    let base = Path::new(env!("CARGO_MANIFEST_DIR"));
    let copy = tempfile::tempdir().unwrap();
    let mut left = vec![base.join("glsl"), base.join("src/gpu/shaders"), base.join("src/gpu/interface.rs")];
    while let Some(path) = left.pop() {
        let to = copy.path().join(path.strip_prefix(base).unwrap());
        if path.is_dir() {
            std::fs::create_dir_all(&to).unwrap();
            left.extend(std::fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else {
            std::fs::create_dir_all(to.parent().unwrap()).unwrap();
            std::fs::copy(&path, &to).unwrap();
        }
    }
    change(copy.path());
    kept::check(copy.path()).map_err(|error| format!("{error:#}"))
}

#[test]
fn a_stale_shader_fails_the_build_with_a_sentence() {
    let since = "since the shaders in glsl/compiled were compiled: run `make shaders`";
    assert_eq!(after(|_| {}), Ok(()));
    let edited = |base: &Path| {
        let path = base.join("glsl/gpu/double.comp");
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replace("push.factor *", "2.0 * push.factor *")).unwrap();
    };
    assert_eq!(after(edited).unwrap_err(), format!("glsl/gpu/double.comp has changed {since}"));
    let other_ends = |base: &Path| {
        let path = base.join("glsl/gpu/double.comp");
        let text = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, text.replace('\n', "\r\n")).unwrap();
    };
    assert_eq!(after(other_ends), Ok(()));
    let new = |base: &Path| std::fs::write(base.join("glsl/gpu/triple.comp"), "").unwrap();
    assert_eq!(after(new).unwrap_err(), format!("glsl/gpu/triple.comp is new {since}"));
    let swap = |base: &Path| std::fs::write(base.join("glsl/gpu/.triple.comp.swp"), "").unwrap();
    assert_eq!(after(swap), Ok(()));
    let gone = |base: &Path| std::fs::remove_file(base.join("src/gpu/shaders/layouts.rs")).unwrap();
    assert_eq!(after(gone).unwrap_err(), format!("src/gpu/shaders/layouts.rs is gone {since}"));
    let list = |base: &Path| std::fs::write(base.join("glsl/compiled/sources.txt"), "0123\n").unwrap();
    let sentence = after(list).unwrap_err();
    assert!(
        sentence.contains("sources.txt, line 1: expected a hash of 16 digits and a path, found \"0123\""),
        "{sentence}"
    );
    let none = |base: &Path| std::fs::remove_dir_all(base.join("glsl/compiled")).unwrap();
    let sentence = after(none).unwrap_err();
    assert!(sentence.contains("sources.txt: run `make shaders`"), "{sentence}");
}

/// A second opinion beside naga's, where spirv-val (Debian package spirv-tools) is installed.
#[test]
fn spirv_val_accepts_every_stage() {
    if std::process::Command::new("spirv-val").arg("--version").output().is_err() {
        println!("SKIPPED spirv_val_accepts_every_stage: spirv-val is not installed");
        return;
    }
    let root = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/glsl"));
    let output = tempfile::tempdir().unwrap();
    let mut count = 0;
    for room in generate::rooms(&root).unwrap().iter().map(|room| root.join(room)) {
        for file in std::fs::read_dir(&room).unwrap().map(|entry| entry.unwrap().path()) {
            let name = file.strip_prefix(&root).unwrap().to_str().unwrap();
            if compile::kind_of(name).is_none() {
                continue;
            }
            let words = compile::compile(&root, name).unwrap().spirv;
            let binary = output.path().join("stage.spv");
            std::fs::write(&binary, words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
            let checked = std::process::Command::new("spirv-val")
                .args(["--target-env", "vulkan1.1"])
                .arg(&binary)
                .output()
                .unwrap();
            assert!(checked.status.success(), "{name}: {}", String::from_utf8_lossy(&checked.stderr));
            count += 1;
        }
    }
    assert!(count > 5, "only {count} stages were found");
}
