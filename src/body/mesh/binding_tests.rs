use super::*;
use crate::body::{MeshSource, parse_body};

/// A post of two bones, 2 m: hip (the root's only limb) and knee.
const POST: &str = "name = \"post\"\n[[bone]]\nname = \"pelvis\"\nparent = \"\"\noffset = [0, 0, 0]\ndof = [\"tx\"]\n\
    [[bone]]\nname = \"left_hip\"\nparent = \"pelvis\"\noffset = [0, 100, 0]\ndof = [\"rx\"]\n\
    [[bone]]\nname = \"left_knee\"\nparent = \"left_hip\"\noffset = [0, 0, -500]\ndof = [\"ry\"]\n\
    [[part]]\nname = \"thigh\"\nbone = \"left_hip\"\na = [0, 0, 0]\nb = [0, 0, -500]\nradius_a = 50\nradius_b = 50\nlabel = 3\n\
    [[part]]\nname = \"calf\"\nbone = \"left_knee\"\na = [0, 0, 0]\nb = [0, 0, -500]\nradius_a = 50\nradius_b = 50\nlabel = 4\n";

/// A hand-made glTF: a box of two storeys along z or y, and what a test wants to break.
struct Tiny {
    positions: Vec<[f32; 3]>,
    joints: Vec<[u8; 4]>,
    weights: Vec<[f32; 4]>,
    indices: Vec<u16>,
    inverse: Vec<[f32; 16]>,
    names: [&'static str; 3],
    skin: bool,
}

impl Tiny {
    /// A square column hanging from y = 1 m at the hip over the knee at y = 0.6 to y = 0, at x = 0.1; the thigh is
    /// 400 mm where the body has 500.
    fn new() -> Self {
        let mut positions = Vec::new();
        let mut joints = Vec::new();
        let mut weights = Vec::new();
        for (storey, y) in [1.0, 0.6, 0.0].into_iter().enumerate() {
            for (x, z) in [(0.15, 0.05), (0.15, -0.05), (0.05, -0.05), (0.05, 0.05)] {
                positions.push([x, y, z]);
                joints.push([1, 2, 0, 0]);
                weights.push([[1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]][storey]);
            }
        }
        let mut indices: Vec<u16> = vec![0, 1, 2, 0, 2, 3, 8, 10, 9, 8, 11, 10];
        for storey in [0, 4] {
            for side in 0..4 {
                let (a, b) = (storey + side, storey + (side + 1) % 4);
                indices.extend([a, a + 4, b, b, a + 4, b + 4]);
            }
        }
        let at = |y: f32, x: f32| {
            let mut matrix = [0.0; 16];
            [matrix[0], matrix[5], matrix[10], matrix[15]] = [1.0; 4];
            [matrix[12], matrix[13]] = [-x, -y];
            matrix
        };
        Self {
            positions,
            joints,
            weights,
            indices,
            inverse: vec![at(1.0, 0.0), at(1.0, 0.1), at(0.6, 0.1)],
            names: ["Hips", "LeftUpLeg", "LeftLeg"],
            skin: true,
        }
    }

    fn glb(&self) -> Vec<u8> {
        let mut bin: Vec<u8> = Vec::new();
        let mut views = Vec::new();
        let mut put = |bytes: &[u8]| {
            while !bin.len().is_multiple_of(4) {
                bin.push(0);
            }
            views.push(format!("{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}}}", bin.len(), bytes.len()));
            bin.extend(bytes);
        };
        put(bytemuck::cast_slice(&self.positions));
        put(bytemuck::cast_slice(&self.joints));
        put(bytemuck::cast_slice(&self.weights));
        put(bytemuck::cast_slice(&self.indices));
        put(bytemuck::cast_slice(&self.inverse));
        let [a, b, c] = self.names;
        let accessor = |view: usize, kind: u32, count: usize, shape: &str| {
            format!("{{\"bufferView\":{view},\"componentType\":{kind},\"count\":{count},\"type\":\"{shape}\"")
        };
        let count = self.positions.len();
        let accessors = [
            accessor(0, 5126, count, "VEC3") + ",\"min\":[0,0,0],\"max\":[1,1,1]}",
            accessor(1, 5121, self.joints.len(), "VEC4") + "}",
            accessor(2, 5126, self.weights.len(), "VEC4") + "}",
            accessor(3, 5123, self.indices.len(), "SCALAR") + "}",
            accessor(4, 5126, self.inverse.len(), "MAT4") + "}",
        ];
        let skin = if self.skin { ",\"skin\":0" } else { "" };
        let mut json = format!(
            "{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[\
             {{\"name\":\"{a}\",\"translation\":[0,1,0],\"children\":[1]}},\
             {{\"name\":\"{b}\",\"translation\":[0.1,0,0],\"children\":[2]}},\
             {{\"name\":\"{c}\",\"translation\":[0,-0.4,0]}},{{\"name\":\"body\",\"mesh\":0{skin}}}],\
             \"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}},\"indices\":3}}]}}],\
             \"skins\":[{{\"joints\":[0,1,2],\"inverseBindMatrices\":4}}],\"buffers\":[{{\"byteLength\":{}}}],\
             \"bufferViews\":[{}],\"accessors\":[{}]}}",
            bin.len(),
            views.join(","),
            accessors.join(",")
        );
        while !json.len().is_multiple_of(4) {
            json.push(' ');
        }
        let mut file = b"glTF".to_vec();
        let length = (12 + 8 + json.len() + 8 + bin.len()) as u32;
        for word in [2, length, json.len() as u32] {
            file.extend(word.to_le_bytes());
        }
        file.extend(b"JSON");
        file.extend(json.as_bytes());
        file.extend((bin.len() as u32).to_le_bytes());
        file.extend(b"BIN\0");
        file.extend(bin);
        file
    }
}

fn read_bytes(bytes: &[u8], skinning: Skinning, joints: &[(&str, &str)]) -> Result<Mesh> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tiny.glb");
    std::fs::write(&path, bytes).unwrap();
    let mut body = parse_body(POST, "post.toml").unwrap();
    let joints = joints.iter().map(|(bone, joint)| (bone.to_string(), joint.to_string())).collect();
    body.mesh = Some(MeshSource::Skinned { file: path, skinning, joints });
    Mesh::of_body(&body)
}

#[test]
fn a_hand_made_file_is_scaled_stretched_and_bent_at_the_bodys_joints() {
    let body = parse_body(POST, "post.toml").unwrap();
    let mesh = read_bytes(&Tiny::new().glb(), Skinning::Smooth, &[]).unwrap();
    assert_eq!((mesh.vertices.len(), mesh.triangles.len(), mesh.edges.len()), (12, 20, 30));
    // At rest: the file's left is +y, its front +x, the thigh 500 mm long instead of 400.
    let rest = mesh.posed(&body.world_from_bones(&[0.0; 3]).unwrap()).unwrap();
    let expected = [[50.0, 150.0, 0.0], [-50.0, 150.0, 0.0], [-50.0, 50.0, 0.0], [50.0, 50.0, 0.0]];
    for (found, expected) in rest[..4].iter().zip(expected) {
        assert!(found.distance(expected.into()) < 1e-3, "{found} is not {expected:?}");
    }
    // Both bones agree about the knee's ring, and the calf hangs 600 mm below.
    for (ring, z) in [(4, -500.0), (8, -1100.0)] {
        for (vertex, top) in expected.iter().enumerate() {
            let expected = [top[0], top[1], z];
            assert!(
                rest[ring + vertex].distance(expected.into()) < 1e-3,
                "{} is not {expected:?}",
                rest[ring + vertex]
            );
        }
    }
    // The knee bent by a quarter turn lays the calf backwards; its ring is half-way between both bones.
    let bent = mesh.posed(&body.world_from_bones(&[0.0, 0.0, std::f64::consts::FRAC_PI_2]).unwrap()).unwrap();
    assert!(bent[8].distance([-600.0, 150.0, -550.0].into()) < 1e-3, "{}", bent[8]);
    assert!(bent[4].distance([25.0, 150.0, -525.0].into()) < 1e-3, "{}", bent[4]);
    for vertex in &mesh.vertices {
        assert!((vertex.weights.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        assert_eq!(vertex.label, if vertex.bones[0] == 1 { 3 } else { 4 });
    }
    let rigid = read_bytes(&Tiny::new().glb(), Skinning::Rigid, &[]).unwrap();
    assert!(rigid.vertices.iter().all(|vertex| vertex.weights == [1.0, 0.0, 0.0, 0.0]));
}

/// The same column held out to the left instead of hanging: what a T-pose is to an arm.
#[test]
fn a_bind_pose_with_a_limb_held_out_is_the_same_mesh_at_rest() {
    let turned = |[x, y, z]: [f32; 3]| [0.1 + (1.0 - y), 1.0 + (x - 0.1), z];
    let mut tiny = Tiny::new();
    tiny.positions.iter_mut().for_each(|at| *at = turned(*at));
    (tiny.inverse[2][12], tiny.inverse[2][13]) = (-0.5, -1.0);
    // A tetrahedron on the hips keeps the height, which is the scale.
    for at in [[-1.0, 0.3, 0.0], [-1.1, 1.3, 0.0], [-0.9, 1.3, 0.1], [-0.9, 1.3, -0.1]] {
        tiny.positions.push(at);
        tiny.joints.push([0; 4]);
        tiny.weights.push([1.0, 0.0, 0.0, 0.0]);
    }
    tiny.indices.extend([12, 14, 13, 12, 15, 14, 12, 13, 15, 13, 14, 15]);
    let held_out = read_bytes(&tiny.glb(), Skinning::Smooth, &[]).unwrap();
    let hanging = read_bytes(&Tiny::new().glb(), Skinning::Smooth, &[]).unwrap();
    let body = parse_body(POST, "post.toml").unwrap();
    for pose in [[0.0; 3], [300.0, 0.7, 1.1]] {
        let bones = body.world_from_bones(&pose).unwrap();
        let (held_out, hanging) = (held_out.posed(&bones).unwrap(), hanging.posed(&bones).unwrap());
        for (vertex, expected) in hanging.iter().enumerate() {
            let found = held_out[vertex];
            assert!(found.distance(*expected) < 1e-2, "vertex {vertex} of {pose:?}: {found} is not {expected}");
        }
    }
}

#[test]
fn every_bad_file_has_its_sentence() {
    let with = |change: fn(&mut Tiny)| {
        let mut tiny = Tiny::new();
        change(&mut tiny);
        tiny.glb()
    };
    let replaced = |from: &str, to: &str| {
        // Of the same length, so that the chunks' stay right.
        assert_eq!(from.len(), to.len());
        let glb = Tiny::new().glb();
        let at = glb.windows(from.len()).position(|window| window == from.as_bytes()).unwrap();
        [&glb[..at], to.as_bytes(), &glb[at + to.len()..]].concat()
    };
    let cut = Tiny::new().glb()[..300].to_vec();
    for (bytes, sentence) in [
        (Vec::new(), "it is no glTF file"),
        (b"a picture".to_vec(), "it is no glTF file"),
        (b"glTF\x02\0\0\0\0\0\0\0".to_vec(), "its header says 0: is it cut?"),
        (cut, "it is 300 bytes long, its header says"),
        (with(|tiny| tiny.skin = false), "no mesh with a skin"),
        (with(|tiny| tiny.positions[3][1] = f32::NAN), "vertex 3 stands at [0.05000000074505806, NaN"),
        (with(|tiny| tiny.weights[5] = [0.5, 0.0, 0.0, 0.0]), "the weights of vertex 5 sum to 0.5, expected 1"),
        (with(|tiny| tiny.weights[5] = [1.5, -0.5, 0.0, 0.0]), "vertex 5 has the weight -0.5"),
        (with(|tiny| tiny.weights[5][0] = f32::NAN), "vertex 5 has the weight NaN"),
        (with(|tiny| tiny.joints[2] = [7, 0, 0, 0]), "vertex 2 names joint 7 of 3"),
        (with(|tiny| tiny.indices[4] = 99), "a triangle names vertex 99 of 12"),
        (with(|tiny| tiny.indices.truncate(57)), "on one side alone, expected a closed surface"),
        (with(|tiny| tiny.indices.truncate(58)), "58 indices of triangles, expected a multiple of 3"),
        (with(|tiny| tiny.indices.swap(0, 1)), "expected each edge to have two triangles of opposite directions"),
        (with(|tiny| tiny.indices.clear()), "its 0 indices do not fit"),
        (with(|tiny| tiny.inverse.truncate(2)), "2 inverse bind matrices for 3 joints"),
        (with(|tiny| tiny.inverse[1] = [0.0; 16]), "the inverse bind matrix of joint `LeftUpLeg` cannot be inverted"),
        (with(|tiny| tiny.weights.truncate(4)), "12 positions, 12 joints and 4 weights"),
        (with(|tiny| tiny.names = ["Hips", "LeftUpLeg", "strut"]), "no joint of it is known to be `left_knee`"),
        (replaced("\"count\":60", "\"count\":90"), "its 90 indices do not fit the 120 bytes"),
        (replaced("\"type\":\"VEC3\"", "\"type\":\"VEC2\""), "its POSITION are Vec2, expected Vec3"),
        (replaced("\"children\":[2]", "\"children\":[0]"), "its nodes form a cycle"),
        (replaced("\"indices\":3}", "\"mode\":1   }"), "drawn as Lines, expected triangles"),
    ] {
        let error = format!("{:#}", read_bytes(&bytes, Skinning::Smooth, &[]).unwrap_err());
        assert!(error.contains("tiny.glb") && !error.contains('\n'), "{error}");
        assert!(error.contains(sentence), "`{error}` lacks `{sentence}`");
    }
    let error =
        format!("{:#}", read_bytes(&Tiny::new().glb(), Skinning::Smooth, &[("left_hip", "LeftUpLg")]).unwrap_err());
    assert!(error.contains("`LeftUpLg`, which is none, the nearest known one is `LeftUpLeg`"), "{error}");
    let twice = [("left_hip", "LeftLeg"), ("left_knee", "LeftLeg")];
    let error = format!("{:#}", read_bytes(&Tiny::new().glb(), Skinning::Smooth, &twice).unwrap_err());
    assert!(error.contains("both have the joint `LeftLeg`") || error.contains("0 mm"), "{error}");
    let body = parse_body(POST, "post.toml").unwrap();
    let error = Mesh::read(Path::new("nobody.glb"), &body, Skinning::Smooth, &BTreeMap::new()).unwrap_err();
    assert!(format!("{error:#}").starts_with("cannot read nobody.glb"), "{error:#}");
}

#[test]
fn unknown_joints_can_be_named_and_seams_are_closed() {
    let mut tiny = Tiny::new();
    tiny.names = ["a", "b", "c"];
    let named = [("left_hip", "b"), ("left_knee", "c")];
    let mesh = read_bytes(&tiny.glb(), Skinning::Smooth, &named).unwrap();
    assert_eq!(mesh, read_bytes(&Tiny::new().glb(), Skinning::Smooth, &[]).unwrap());
    // One triangle gets corners of its own, as a texture's seam makes them.
    for corner in 0..3 {
        let vertex = tiny.indices[corner] as usize;
        tiny.indices[corner] = tiny.positions.len() as u16;
        tiny.positions.push(tiny.positions[vertex]);
        tiny.joints.push(tiny.joints[vertex]);
        tiny.weights.push(tiny.weights[vertex]);
    }
    assert_eq!(read_bytes(&tiny.glb(), Skinning::Smooth, &named).unwrap(), mesh);
}

#[test]
fn no_changed_byte_panics() {
    let glb = Tiny::new().glb();
    let body = parse_body(POST, "post.toml").unwrap();
    let mut meshes = 0;
    // A fixed walk over the file: every place once, the values spread by a multiplicative hash.
    for at in 0..glb.len() {
        let mut changed = glb.clone();
        changed[at] = (at as u32).wrapping_mul(2_654_435_761).to_be_bytes()[0];
        match gltf_file::parse(&changed, None).and_then(|file| bind(file, &body, Skinning::Smooth, &BTreeMap::new())) {
            Ok(mesh) => {
                meshes += 1;
                assert!(mesh.vertices.iter().all(|vertex| vertex.position.is_finite()));
            }
            Err(error) => assert!(!format!("{error:#}").contains('\n'), "{error:#}"),
        }
    }
    assert!(meshes > 100 && meshes < glb.len(), "{meshes} of {} are meshes still", glb.len());
}

#[test]
fn a_real_person_fits_the_body() {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/mesh/human_male.glb"));
    if !path.exists() {
        println!("SKIPPED a_real_person_fits_the_body: ../shared/data is absent");
        return;
    }
    let body = Body::adult(1750.0).unwrap();
    let mesh = Mesh::read(path, &body, Skinning::Smooth, &BTreeMap::new()).unwrap();
    assert_eq!((mesh.vertices.len(), mesh.triangles.len(), mesh.edges.len()), (13380, 26756, 40134));
    let pose = body.standing_pose();
    let bones = body.world_from_bones(&pose).unwrap();
    let posed = mesh.posed(&bones).unwrap();
    let (low, high) = posed.iter().fold((f32::MAX, f32::MIN), |(low, high), at| (low.min(at.z), high.max(at.z)));
    assert!((high - low - 1750.0).abs() < 40.0 && low.abs() < 40.0, "from {low} to {high}");
    // Every label is on the mesh, and its vertices lie round the part's axis at rest.
    for part in &body.parts {
        let own: Vec<DVec3> = mesh
            .vertices
            .iter()
            .zip(&posed)
            .filter(|(vertex, _)| vertex.label == part.label)
            .map(|(_, at)| at.as_dvec3())
            .collect();
        let centre = own.iter().sum::<DVec3>() / own.len() as f64;
        let middle = bones[part.bone].transform_point3((part.a + part.b) / 2.0);
        assert!(
            own.len() > 100 && centre.distance(middle) < 130.0,
            "{}: {} at {centre}, {middle}",
            part.name,
            own.len()
        );
    }
}

#[test]
fn damaged_files_give_a_body_that_saves_or_a_sentence() {
    let template = parse_body(POST, "post.toml").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tiny.glb");
    let whole = Tiny::new().glb();
    std::fs::write(&path, &whole).unwrap();
    let import = || Body::from_gltf(&path, &template, None, &BTreeMap::new());
    let body = import().unwrap();
    // The thigh of 400 mm in the file, the calf of 600, both 100 mm broad: seen from all sides a square is as broad as a circle of
    // its perimeter.
    assert!((body.bones[2].offset.z + 400.0).abs() < 0.2, "{}", body.bones[2].offset);
    let mut random = 5_u64;
    let mut next = |below: usize| {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 33) as usize % below
    };
    let mut refused = 0;
    for _ in 0..600 {
        let mut bytes = whole.clone();
        for _ in 0..=next(3) {
            let at = 12 + next(bytes.len() - 12);
            bytes[at] = next(256) as u8;
        }
        std::fs::write(&path, bytes).unwrap();
        match import() {
            Ok(body) => assert_eq!(parse_body(&body.to_toml(), "tiny.toml").unwrap().bones, body.bones),
            Err(error) => {
                refused += 1;
                let error = format!("{error:#}");
                assert!(error.contains("tiny.glb") && !error.contains('\n'), "{error}");
            }
        }
    }
    assert!((100..600).contains(&refused), "{refused}");
}

#[test]
fn buffers_lie_beside_the_file_and_are_as_long_as_declared() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("folder")).unwrap();
    std::fs::write(folder.path().join("short.bin"), [0; 4]).unwrap();
    for (uri, length, part) in [
        ("/dev/zero", 8, "\"/dev/zero\" lies elsewhere, expected a file in the folder"),
        ("../../etc/passwd", 8, "lies elsewhere"),
        ("folder/../../secret", 8, "lies elsewhere"),
        ("folder", 8, "is a folder, expected a buffer, which is a regular file"),
        ("short.bin", 8, "holds 4 bytes, expected 8"),
        ("none.bin", 8, "its buffer: cannot read"),
        ("short.bin", 1_u64 << 40, "expected at most"),
        ("short.bin", 4, "no mesh with a skin"),
    ] {
        let json = format!(
            "{{\"asset\":{{\"version\":\"2.0\"}},\"buffers\":[{{\"byteLength\":{length},\"uri\":\"{uri}\"}}]}}"
        );
        let error = format!("{:#}", gltf_file::parse(json.as_bytes(), Some(folder.path())).unwrap_err());
        assert!(error.contains(part), "{uri}: {error}");
    }
}

#[test]
fn long_chains_of_nodes_are_refused_soon() {
    let nodes: Vec<String> = (1..20_000).map(|child| format!("{{\"children\":[{child}]}}")).collect();
    let json = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{},{{}}]}}", nodes.join(","));
    let begin = std::time::Instant::now();
    let error = format!("{:#}", gltf_file::parse(json.as_bytes(), None).unwrap_err());
    assert!(error.contains("hang more than 1000 deep"), "{error}");
    assert!(begin.elapsed().as_secs() < 5, "it took {:?}", begin.elapsed());
}
