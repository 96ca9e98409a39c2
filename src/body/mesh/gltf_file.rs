//! A skinned person in a glTF file (.glb or .gltf), as far as a body needs it: joints and bound vertices in the bind pose.
//!
//! The crate `gltf` reads the structure; the numbers are taken from the buffers here, because a file may claim anything
//! about their size and type.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::{Component, Path};

use anyhow::{Context, Result, anyhow, bail, ensure};
use base64::Engine as _;
use glam::{DMat4, DVec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use gltf::{Accessor, Document, Gltf, Node, Semantic, Skin};

use crate::files::{Limit, shortened};

/// Larger files are no person.
const LARGEST_FILE: u64 = 1 << 30;
const PERSON: Limit = Limit { what: "a glTF file", most: LARGEST_FILE };
const BUFFER: Limit = Limit { what: "a buffer", most: LARGEST_FILE };

/// Nor are nodes that hang deeper than this.
const DEEPEST_NODE: usize = 1000;

/// How far weights may be from a sum of 1; 8-bit weights are rounded.
const WEIGHT_TOLERANCE: f64 = 0.02;

/// A skinned mesh in its bind pose. Positions are in metres in the file's world: y up, z forward by convention.
#[derive(Clone, Debug)]
pub(super) struct SkinnedFile {
    /// The joints; a parent may stand after its child.
    pub(super) joints: Vec<Joint>,
    /// The vertices.
    pub(super) vertices: Vec<BoundVertex>,
    /// Indices of vertices.
    pub(super) triangles: Vec<[u32; 3]>,
}

/// A joint of a [`SkinnedFile`].
#[derive(Clone, Debug)]
pub(super) struct Joint {
    /// Its name.
    pub(super) name: String,
    /// The nearest joint above it.
    pub(super) parent: Option<usize>,
    /// Its origin in the bind pose.
    pub(super) at: DVec3,
}

/// A vertex of a [`SkinnedFile`].
#[derive(Clone, Debug)]
pub(super) struct BoundVertex {
    /// Position in the bind pose.
    pub(super) at: DVec3,
    /// Joints and their weights, more than 0, of sum 1.
    pub(super) weights: Vec<(usize, f64)>,
}

/// Reads the file.
///
/// # Errors
/// One sentence: it cannot be read, is no glTF, has no skin or no triangles, numbers that are not there or make no sense.
pub(super) fn read(path: &Path) -> Result<SkinnedFile> {
    parse(&PERSON.read(path)?, path.parent()).with_context(|| path.display().to_string())
}

/// [`read`] for bytes already in memory; buffers beside the file lie in `folder`.
pub(super) fn parse(bytes: &[u8], folder: Option<&Path>) -> Result<SkinnedFile> {
    if bytes.starts_with(b"glTF") {
        // The crate subtracts the header's size from this length unseen.
        let length = bytes.get(8..12).and_then(|field| field.try_into().ok()).map_or(0, u32::from_le_bytes) as usize;
        let fits = (20..=bytes.len()).contains(&length);
        ensure!(fits, "it is {} bytes long, its header says {length}: is it cut?", bytes.len());
    }
    let no_gltf =
        |error: gltf::Error| anyhow!("it is no glTF file: {}", shortened(&error.to_string()).replace('\n', " "));
    let Gltf { document, blob } = Gltf::from_slice_without_validation(bytes).map_err(no_gltf)?;
    let json = document.into_json();
    // The crate's validation looks positions up unseen.
    let attributes =
        json.meshes.iter().flat_map(|mesh| &mesh.primitives).flat_map(|primitive| primitive.attributes.values());
    if let Some(index) = attributes.map(|index| index.value()).find(|index| *index >= json.accessors.len()) {
        bail!("its mesh names accessor {index} of {}", json.accessors.len());
    }
    let document = Document::from_json(json).map_err(no_gltf)?;
    let buffers = buffers(&document, blob, folder)?;
    let worlds = node_matrices(&document)?;

    let mut file = SkinnedFile { joints: Vec::new(), vertices: Vec::new(), triangles: Vec::new() };
    let mut joint_of_node = BTreeMap::new();
    for node in document.nodes() {
        if let (Some(mesh), Some(skin)) = (node.mesh(), node.skin()) {
            let world_from_mesh = add_joints(&skin, &buffers, &worlds, &mut joint_of_node, &mut file)?;
            let joints: Vec<usize> = skin.joints().map(|joint| joint_of_node[&joint.index()]).collect();
            for primitive in mesh.primitives() {
                ensure!(
                    primitive.mode() == Mode::Triangles,
                    "its mesh is drawn as {:?}, expected triangles",
                    primitive.mode()
                );
                add_primitive(&primitive, &buffers, &joints, world_from_mesh, &mut file)?;
            }
        }
    }
    ensure!(!file.joints.is_empty(), "it has no mesh with a skin, expected a skinned person");
    ensure!(!file.triangles.is_empty(), "it has no triangles, expected a closed surface");
    link_joints(&document, &joint_of_node, &mut file);
    Ok(file)
}

/// The contents of all buffers.
fn buffers(document: &Document, blob: Option<Vec<u8>>, folder: Option<&Path>) -> Result<Vec<Vec<u8>>> {
    let mut blob = blob;
    document
        .buffers()
        .map(|buffer| match buffer.source() {
            gltf::buffer::Source::Bin => blob.take().ok_or_else(|| anyhow!("its binary chunk is missing")),
            gltf::buffer::Source::Uri(uri) => match uri.strip_prefix("data:") {
                Some(data) => {
                    let text = data.split_once(";base64,").map(|(_, text)| text);
                    let text = text.ok_or_else(|| anyhow!("a buffer is a data: address, expected one in base64"))?;
                    base64::engine::general_purpose::STANDARD.decode(text).context("a buffer in base64 is damaged")
                }
                None => beside(uri, buffer.length() as u64, folder),
            },
        })
        .collect()
}

/// The contents of a buffer in a file of its own: a regular one in `folder` or below, as long as declared.
fn beside(uri: &str, length: u64, folder: Option<&Path>) -> Result<Vec<u8>> {
    let is_below = Path::new(uri).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    ensure!(is_below, "its buffer {uri:?} lies elsewhere, expected a file in the folder of the glTF file or below");
    ensure!(length <= LARGEST_FILE, "its buffer {uri:?} is to hold {length} bytes, expected at most {LARGEST_FILE}");
    let path = folder.map_or_else(|| uri.into(), |folder| folder.join(uri));
    let unreadable = || format!("its buffer {} cannot be read", path.display());
    let mut bytes = Vec::new();
    let file = BUFFER.open(&path).context("its buffer")?;
    file.take(length).read_to_end(&mut bytes).with_context(unreadable)?;
    let found = bytes.len();
    ensure!(found as u64 == length, "its buffer {} holds {found} bytes, expected {length}", path.display());
    Ok(bytes)
}

/// `world_from_node` of all nodes as the file has them placed.
fn node_matrices(document: &Document) -> Result<Vec<DMat4>> {
    let parents = node_parents(document);
    let locals: Vec<DMat4> = document
        .nodes()
        .map(|node| DMat4::from_cols_array_2d(&node.transform().matrix().map(|column| column.map(f64::from))))
        .collect();
    (0..locals.len())
        .map(|node| {
            let mut matrix = locals[node];
            let mut at = node;
            for _ in 0..=locals.len().min(DEEPEST_NODE) {
                let Some(parent) = parents[at] else { return Ok(matrix) };
                matrix = locals[parent] * matrix;
                at = parent;
            }
            bail!("its nodes form a cycle or hang more than {DEEPEST_NODE} deep, expected a tree")
        })
        .collect()
}

fn node_parents(document: &Document) -> Vec<Option<usize>> {
    let mut parents = vec![None; document.nodes().len()];
    for node in document.nodes() {
        for child in node.children() {
            parents[child.index()] = Some(node.index());
        }
    }
    parents
}

/// Adds the joints of a skin that are not there yet, and gives the matrix from the space of its mesh to the world.
fn add_joints(
    skin: &Skin,
    buffers: &[Vec<u8>],
    worlds: &[DMat4],
    joint_of_node: &mut BTreeMap<usize, usize>,
    file: &mut SkinnedFile,
) -> Result<DMat4> {
    let nodes: Vec<Node> = skin.joints().collect();
    let accessor = skin.inverse_bind_matrices();
    let accessor = accessor.ok_or_else(|| anyhow!("its skin has no inverse bind matrices, expected one a joint"))?;
    let inverse: Vec<[f64; 16]> = numbers(&accessor, buffers, "inverse bind matrices", Dimensions::Mat4)?;
    ensure!(
        inverse.len() >= nodes.len() && !nodes.is_empty(),
        "its skin has {} inverse bind matrices for {} joints, expected one a joint",
        inverse.len(),
        nodes.len()
    );
    let inverse: Vec<DMat4> = inverse.iter().map(DMat4::from_cols_array).collect();
    // The first joint stands for how the file has the whole person placed: it is the root in practice, and where the
    // nodes hold the bind pose every joint gives the same matrix.
    let world_from_mesh = worlds[nodes[0].index()] * inverse[0];
    for (node, inverse) in nodes.iter().zip(&inverse) {
        let name = node.name().map_or_else(|| format!("node {}", node.index()), str::to_string);
        let at = world_from_mesh.project_point3(inverse.inverse().w_axis.truncate());
        ensure!(at.is_finite(), "the inverse bind matrix of joint `{name}` cannot be inverted");
        joint_of_node.entry(node.index()).or_insert_with(|| {
            file.joints.push(Joint { name, parent: None, at });
            file.joints.len() - 1
        });
    }
    Ok(world_from_mesh)
}

/// Finds every joint's parent: joints may have nodes between them that are none.
fn link_joints(document: &Document, joint_of_node: &BTreeMap<usize, usize>, file: &mut SkinnedFile) {
    let parents = node_parents(document);
    for (&node, &joint) in joint_of_node {
        let above = std::iter::successors(parents[node], |&at| parents[at]);
        file.joints[joint].parent = above.filter_map(|at| joint_of_node.get(&at).copied()).next();
    }
}

fn add_primitive(
    primitive: &gltf::Primitive,
    buffers: &[Vec<u8>],
    joints: &[usize],
    world_from_mesh: DMat4,
    file: &mut SkinnedFile,
) -> Result<()> {
    let first = file.vertices.len();
    let accessor = |semantic: Semantic| primitive.get(&semantic);
    let named = |semantic, name| accessor(semantic).ok_or_else(|| anyhow!("its mesh has no {name}"));
    let positions: Vec<[f64; 3]> =
        numbers(&named(Semantic::Positions, "POSITION")?, buffers, "POSITION", Dimensions::Vec3)?;
    let mut weights: Vec<Vec<(usize, f64)>> = vec![Vec::new(); positions.len()];
    // A vertex with more than four joints has them in further sets.
    let mut set = 0;
    while set == 0 || accessor(Semantic::Joints(set)).is_some() {
        let indices = named(Semantic::Joints(set), "JOINTS_0")?;
        let indices: Vec<[f64; 4]> = numbers(&indices, buffers, "JOINTS_0", Dimensions::Vec4)?;
        let shares = named(Semantic::Weights(set), "WEIGHTS_0")?;
        let shares: Vec<[f64; 4]> = numbers(&shares, buffers, "WEIGHTS_0", Dimensions::Vec4)?;
        ensure!(
            indices.len() == positions.len() && shares.len() == positions.len(),
            "it has {} positions, {} joints and {} weights, expected as many",
            positions.len(),
            indices.len(),
            shares.len()
        );
        for (vertex, (indices, shares)) in indices.iter().zip(&shares).enumerate() {
            for (&index, &share) in indices.iter().zip(shares) {
                ensure!(share >= 0.0, "vertex {vertex} has the weight {share}, expected 0 to 1");
                if share > 0.0 {
                    let joint = joints.get(index as usize);
                    let joint =
                        joint.ok_or_else(|| anyhow!("vertex {vertex} names joint {index} of {}", joints.len()))?;
                    weights[vertex].push((*joint, share));
                }
            }
        }
        set += 1;
    }
    for (vertex, (position, mut weights)) in positions.into_iter().zip(weights).enumerate() {
        let at = world_from_mesh.project_point3(DVec3::from_array(position));
        ensure!(at.is_finite(), "vertex {vertex} stands at {position:?}, expected finite coordinates");
        let sum: f64 = weights.iter().map(|(_, share)| share).sum();
        ensure!((sum - 1.0).abs() <= WEIGHT_TOLERANCE, "the weights of vertex {vertex} sum to {sum}, expected 1");
        weights.iter_mut().for_each(|(_, share)| *share /= sum);
        file.vertices.push(BoundVertex { at, weights });
    }
    let count = file.vertices.len() - first;
    let indices: Vec<u64> = match primitive.indices() {
        Some(accessor) => {
            let indices: Vec<[f64; 1]> = numbers(&accessor, buffers, "indices", Dimensions::Scalar)?;
            indices.into_iter().map(|[index]| index as u64).collect()
        }
        None => (0..count as u64).collect(),
    };
    ensure!(indices.len().is_multiple_of(3), "it has {} indices of triangles, expected a multiple of 3", indices.len());
    for corners in indices.chunks_exact(3) {
        let mut triangle = [0; 3];
        for (corner, &index) in triangle.iter_mut().zip(corners) {
            ensure!(index < count as u64, "a triangle names vertex {index} of {count}");
            *corner = u32::try_from(first as u64 + index).context("it has too many vertices")?;
        }
        file.triangles.push(triangle);
    }
    Ok(())
}

/// The elements of an accessor, every number as it is meant: normalised integers as fractions. Everything the file says
/// about place and type is checked against the bytes that are there.
fn numbers<const N: usize>(
    accessor: &Accessor,
    buffers: &[Vec<u8>],
    name: &str,
    dimensions: Dimensions,
) -> Result<Vec<[f64; N]>> {
    ensure!(
        accessor.dimensions() == dimensions && dimensions.multiplicity() == N,
        "its {name} are {:?}, expected {dimensions:?}",
        accessor.dimensions()
    );
    ensure!(accessor.sparse().is_none(), "its {name} are sparse, expected them in full");
    let view = accessor.view().ok_or_else(|| anyhow!("its {name} have no buffer view"))?;
    let (size, one) = (accessor.data_type().size(), accessor.data_type().size() * N);
    let stride = view.stride().unwrap_or(one);
    let bytes: Cow<[u8]> = buffers
        .get(view.buffer().index())
        .and_then(|buffer| buffer.get(view.offset()..view.offset().checked_add(view.length())?))
        .map(Cow::from)
        .unwrap_or_default();
    let last =
        accessor.count().checked_sub(1).and_then(|last| last.checked_mul(stride)?.checked_add(accessor.offset()));
    let fits = last.and_then(|last| last.checked_add(one)).is_some_and(|end| end <= bytes.len()) && stride >= one;
    ensure!(fits, "its {} {name} do not fit the {} bytes they are said to lie in", accessor.count(), bytes.len());
    let normalized = accessor.normalized();
    let fraction = move |value: f64, most: f64| if normalized { value / most } else { value };
    let number = |at: usize| -> f64 {
        let mut field = [0; 4];
        field[..size].copy_from_slice(&bytes[at..at + size]);
        let low = u16::from_le_bytes([field[0], field[1]]);
        match accessor.data_type() {
            DataType::F32 => f64::from(f32::from_le_bytes(field)),
            DataType::U32 => f64::from(u32::from_le_bytes(field)),
            DataType::U16 => fraction(f64::from(low), 65535.0),
            DataType::I16 => fraction(f64::from(low as i16), 32767.0),
            DataType::U8 => fraction(f64::from(field[0]), 255.0),
            DataType::I8 => fraction(f64::from(field[0] as i8), 127.0),
        }
    };
    Ok((0..accessor.count())
        .map(|element| std::array::from_fn(|nth| number(accessor.offset() + element * stride + nth * size)))
        .collect())
}
