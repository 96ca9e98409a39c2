//! A body in motion as glTF 2.0, for animation programs, engines and browsers: its bones, its drawn mesh bound to them, and how they
//! turn over time.

use std::borrow::Cow;
use std::io::Write;

use anyhow::{Context, Result, bail, ensure};
use glam::{DAffine3, DMat4, DQuat, DVec3};
use gltf::binary::{Glb, Header};
use gltf::json::accessor::ComponentType;
use serde_json::{Value, json};

use super::{Body, Mesh, PoseTable};
use crate::motion::y_up;

/// Millimetres in a metre, glTF's unit.
const METRE: f64 = 1000.0;

impl Body {
    /// Writes the motion of a pose table as a binary glTF file in metres with y up (x left, z forward): a node a bone and free end, the
    /// body's mesh ([`Mesh::of_body`]) bound to them, and one animation with the rotation of every bone and the translation of the
    /// root and of others that can be shifted, a key a frame, at rest where they are in the first. Time is counted from the first
    /// frame, whose number stands in the animation's `extras` beside the rate.
    ///
    /// # Errors
    /// When the table is empty, its frames do not rise, the rate is not positive, a pose does not fit the body, the body has no mesh,
    /// or writing fails.
    pub fn write_gltf(&self, out: &mut dyn Write, poses: &PoseTable, rate: f64) -> Result<()> {
        ensure!(rate > 0.0 && rate.is_finite(), "the frame rate is {rate}, expected a positive number");
        ensure!(!poses.poses.is_empty(), "there are no poses to write as glTF");
        if let Some(pair) = poses.frames.windows(2).find(|pair| pair[0] >= pair[1]) {
            bail!("frame {} follows frame {}, expected rising frames in a motion", pair[1], pair[0]);
        }
        let mesh = Mesh::of_body(self)?;
        let mut data = Data::default();
        let motion = self.local_motion(poses)?;
        let nodes = self.nodes(&motion);
        let skin_matrices = self.skin_matrices(&mesh);
        let bones = nodes.len();
        let primitive = primitive(&mut data, &mesh)?;
        let inverse_bind = data.add("MAT4", ComponentType::F32, None, &skin_matrices)?;
        let animation = self.animation(&mut data, &motion, poses, rate)?;
        let mut all_nodes = nodes;
        all_nodes.push(json!({ "name": format!("{} mesh", self.name), "mesh": 0, "skin": 0 }));
        let root = self.update_order.first().copied().unwrap_or(0);
        let document = json!({
            "asset": { "version": "2.0", "generator": concat!("pantin ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "name": self.name, "nodes": [root, bones] }],
            "nodes": all_nodes,
            "meshes": [{ "name": self.name, "primitives": [primitive] }],
            "materials": [{
                "name": "body",
                "pbrMetallicRoughness": { "baseColorFactor": [0.72, 0.6, 0.5, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9 },
            }],
            "skins": [{
                "name": self.name,
                "inverseBindMatrices": inverse_bind,
                "joints": (0..bones).collect::<Vec<usize>>(),
                "skeleton": root,
            }],
            "animations": [animation],
            "accessors": data.accessors,
            "bufferViews": data.views,
            "buffers": [{ "byteLength": data.bytes.len() }],
        });
        let json = serde_json::to_vec(&document)?;
        let total = json.len() + data.bytes.len();
        ensure!(total < u32::MAX as usize - 64, "it would hold {total} bytes, expected less than 4 GiB in a glTF file");
        let header = Header { magic: *b"glTF", version: 2, length: 0 };
        Glb { header, json: Cow::Owned(json), bin: Some(Cow::Owned(data.bytes)) }.to_writer(out).context("glTF")
    }

    /// `parent_from_bone` of every bone in file order, in the file's axes and unit, a row a pose.
    fn local_motion(&self, poses: &PoseTable) -> Result<Vec<Vec<(DVec3, DQuat)>>> {
        let row = |(frame, pose): (&usize, &Vec<f64>)| {
            self.check_pose(pose).with_context(|| format!("the pose of frame {frame}"))?;
            let mut rest = pose.as_slice();
            Ok(self
                .bones
                .iter()
                .map(|bone| {
                    let (own, others) = rest.split_at(bone.dofs.len());
                    rest = others;
                    let DAffine3 { matrix3, translation } = bone.parent_from_bone(own);
                    let turn = DQuat::from_mat3(&matrix3).normalize();
                    (y_up(translation) / METRE, DQuat::from_vec4(y_up(turn.xyz()).extend(turn.w)))
                })
                .collect())
        };
        let mut motion: Vec<Vec<(DVec3, DQuat)>> =
            poses.frames.iter().zip(&poses.poses).map(row).collect::<Result<_>>()?;
        // Both signs are the same turn; between keys the shorter way is meant.
        for frame in 1..motion.len() {
            let (before, after) = motion.split_at_mut(frame);
            for ((_, last), (_, turn)) in before[frame - 1].iter().zip(&mut after[0]) {
                if last.dot(*turn) < 0.0 {
                    *turn = -*turn;
                }
            }
        }
        Ok(motion)
    }

    /// A node a bone, in file order, then one a free end; they stand as in the first frame.
    fn nodes(&self, motion: &[Vec<(DVec3, DQuat)>]) -> Vec<Value> {
        let ends = self.free_ends();
        let count = self.bones.len();
        let bones = self.bones.iter().enumerate().map(|(index, bone)| {
            let (at, turn) = motion[0][index];
            let below =
                self.bones.iter().enumerate().filter(|(_, other)| other.parent == Some(index)).map(|(child, _)| child);
            let ends = ends.iter().enumerate().filter(|(_, end)| end.bone == index).map(|(end, _)| count + end);
            let children: Vec<usize> = below.chain(ends).collect();
            let mut node = json!({
                "name": bone.name,
                "translation": at.as_vec3().to_array(),
                "rotation": turn.as_quat().normalize().to_array(),
            });
            if !children.is_empty() {
                node["children"] = json!(children);
            }
            node
        });
        let free = ends
            .iter()
            .map(|end| json!({ "name": end.name, "translation": (y_up(end.at) / METRE).as_vec3().to_array() }));
        bones.chain(free).collect()
    }

    /// The inverse bind matrices of [`Self::nodes`], in the file's axes and unit.
    fn skin_matrices(&self, mesh: &Mesh) -> Vec<[f32; 16]> {
        let ends = self.free_ends();
        let ends = ends.iter().map(|end| DAffine3::from_translation(-end.at) * mesh.inverse_bind[end.bone]);
        let in_file = |matrix: DAffine3| {
            // The file's x, y and z are the body's y, z and x.
            let columns = [DVec3::Y, DVec3::Z, DVec3::X].map(|axis| y_up(matrix.matrix3 * axis).extend(0.0));
            let at = (y_up(matrix.translation) / METRE).extend(1.0);
            DMat4::from_cols(columns[0], columns[1], columns[2], at).as_mat4().to_cols_array()
        };
        mesh.inverse_bind.iter().copied().chain(ends).map(in_file).collect()
    }

    fn animation(
        &self,
        data: &mut Data,
        motion: &[Vec<(DVec3, DQuat)>],
        poses: &PoseTable,
        rate: f64,
    ) -> Result<Value> {
        let first = poses.frames[0];
        let times: Vec<[f32; 1]> = poses.frames.iter().map(|frame| [((frame - first) as f64 / rate) as f32]).collect();
        let input = data.add("SCALAR", ComponentType::F32, None, &times)?;
        data.bound(input, &times);
        let (mut samplers, mut channels) = (Vec::new(), Vec::new());
        let mut move_by = |output: usize, node: usize, path: &str| {
            channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": path } }));
            samplers.push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
        };
        for (index, bone) in self.bones.iter().enumerate() {
            let turns: Vec<[f32; 4]> = motion.iter().map(|row| row[index].1.as_quat().normalize().to_array()).collect();
            move_by(data.add("VEC4", ComponentType::F32, None, &turns)?, index, "rotation");
            if bone.parent.is_none() || bone.dofs.iter().any(|dof| !dof.axis.is_rotation()) {
                let places: Vec<[f32; 3]> = motion.iter().map(|row| row[index].0.as_vec3().to_array()).collect();
                move_by(data.add("VEC3", ComponentType::F32, None, &places)?, index, "translation");
            }
        }
        let extras = json!({ "first_frame": first, "frames_per_second": rate });
        Ok(json!({ "name": "motion", "samplers": samplers, "channels": channels, "extras": extras }))
    }
}

/// What a renderer reads a part of the buffer as.
#[derive(Clone, Copy)]
enum Target {
    Vertices = 34962,
    Indices = 34963,
}

/// The buffer as it grows, with what lies in it.
#[derive(Default)]
struct Data {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Data {
    /// Adds elements; `target` says that a renderer reads them as vertices or indices. Gives the accessor.
    fn add<E: bytemuck::NoUninit>(
        &mut self,
        kind: &str,
        component: ComponentType,
        target: Option<Target>,
        elements: &[E],
    ) -> Result<usize> {
        // Every kind here is of two or four bytes, and so is little-endian where the machine is.
        ensure!(cfg!(target_endian = "little"), "glTF is written on little-endian machines alone");
        let bytes: &[u8] = bytemuck::cast_slice(elements);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target as u32);
        }
        self.bytes.extend_from_slice(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.accessors.push(json!({
            "bufferView": self.views.len(),
            "componentType": component.as_gl_enum(),
            "count": elements.len(),
            "type": kind,
        }));
        self.views.push(view);
        Ok(self.accessors.len() - 1)
    }

    /// States the least and the greatest of an accessor's elements.
    fn bound<const N: usize>(&mut self, accessor: usize, elements: &[[f32; N]]) {
        let along =
            |axis: usize, pick: fn(f32, f32) -> f32| elements.iter().map(|at| at[axis]).reduce(pick).unwrap_or(0.0);
        self.accessors[accessor]["min"] = (0..N).map(|axis| json!(along(axis, f32::min))).collect();
        self.accessors[accessor]["max"] = (0..N).map(|axis| json!(along(axis, f32::max))).collect();
    }
}

/// The triangles of the mesh in its bind pose.
fn primitive(data: &mut Data, mesh: &Mesh) -> Result<Value> {
    let places: Vec<[f32; 3]> =
        mesh.vertices.iter().map(|vertex| (y_up(vertex.position.as_dvec3()) / METRE).as_vec3().to_array()).collect();
    let normals: Vec<[f32; 3]> = normals(mesh).into_iter().map(|normal| y_up(normal).as_vec3().to_array()).collect();
    let shares = mesh.vertices.iter().map(|vertex| {
        let sum: f64 = vertex.weights.iter().map(|weight| f64::from(*weight)).sum();
        vertex.weights.map(|weight| (f64::from(weight) / sum) as f32)
    });
    let weights: Vec<[f32; 4]> = shares.collect();
    // A joint without weight is to be number 0.
    let joints: Vec<[u16; 4]> = mesh
        .vertices
        .iter()
        .map(|vertex| [0, 1, 2, 3].map(|slot| if vertex.weights[slot] > 0.0 { vertex.bones[slot] } else { 0 }))
        .collect();
    let vertices = Some(Target::Vertices);
    let position = data.add("VEC3", ComponentType::F32, vertices, &places)?;
    data.bound(position, &places);
    let normal = data.add("VEC3", ComponentType::F32, vertices, &normals)?;
    let joints = data.add("VEC4", ComponentType::U16, vertices, &joints)?;
    let weights = data.add("VEC4", ComponentType::F32, vertices, &weights)?;
    let corners: Vec<u32> = mesh.triangles.as_flattened().to_vec();
    let indices = data.add("SCALAR", ComponentType::U32, Some(Target::Indices), &corners)?;
    Ok(json!({
        "attributes": { "POSITION": position, "NORMAL": normal, "JOINTS_0": joints, "WEIGHTS_0": weights },
        "indices": indices,
        "material": 0,
    }))
}

/// The mean direction of the triangles round each vertex, by their areas.
fn normals(mesh: &Mesh) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; mesh.vertices.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|corner| mesh.vertices[corner as usize].position.as_dvec3());
        let area = (b - a).cross(c - a);
        triangle.iter().for_each(|&corner| sums[corner as usize] += area);
    }
    sums.into_iter().map(|sum| sum.try_normalize().unwrap_or(DVec3::Z)).collect()
}

#[cfg(test)]
mod tests {
    use gltf::animation::util::ReadOutputs;
    use proptest::prelude::*;

    use super::*;
    use crate::body::kinematics::tests::any_body;

    /// The document and its buffer, after the crate's own validation.
    fn read(bytes: &[u8]) -> (gltf::Document, Vec<u8>) {
        let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(bytes).unwrap();
        (document, blob.unwrap())
    }

    fn written(body: &Body, table: &PoseTable) -> Vec<u8> {
        let mut bytes = Vec::new();
        body.write_gltf(&mut bytes, table, 25.0).unwrap();
        bytes
    }

    /// Where the nodes are at a key, by following the file alone.
    fn placed(document: &gltf::Document, blob: &[u8], key: usize) -> Vec<DMat4> {
        let mut local: Vec<(DVec3, DQuat)> = document
            .nodes()
            .map(|node| {
                let (at, turn, _) = node.transform().decomposed();
                (DVec3::from(at.map(f64::from)), DQuat::from_array(turn.map(f64::from)))
            })
            .collect();
        for channel in document.animations().next().unwrap().channels() {
            let node = channel.target().node().index();
            let reader = channel.reader(|_| Some(blob));
            match reader.read_outputs().unwrap() {
                ReadOutputs::Translations(mut at) => local[node].0 = DVec3::from(at.nth(key).unwrap().map(f64::from)),
                ReadOutputs::Rotations(turns) => {
                    local[node].1 = DQuat::from_array(turns.into_f32().nth(key).unwrap().map(f64::from))
                }
                _ => panic!("nothing else moves"),
            }
        }
        let mut world = vec![DMat4::IDENTITY; local.len()];
        let mut pending: Vec<_> =
            document.scenes().next().unwrap().nodes().map(|node| (node, DMat4::IDENTITY)).collect();
        while let Some((node, parent)) = pending.pop() {
            let (at, turn) = local[node.index()];
            world[node.index()] = parent * DMat4::from_rotation_translation(turn, at);
            pending.extend(node.children().map(|child| (child, world[node.index()])));
        }
        world
    }

    proptest! {
        #[test]
        fn every_bone_is_where_the_body_has_it((body, pose) in any_body()) {
            let table = PoseTable { frames: vec![4, 5], poses: vec![vec![0.25; pose.len()], pose] };
            prop_assume!(!body.parts.is_empty());
            let (document, blob) = read(&written(&body, &table));
            for (key, pose) in table.poses.iter().enumerate() {
                let nodes = placed(&document, &blob, key);
                let joints = body.joint_positions(&body.world_from_bones(pose).unwrap());
                for (name, (joint, node)) in body.joint_names().iter().zip(joints.iter().zip(&nodes)) {
                    let at = node.w_axis.truncate();
                    // Single precision along at most twelve bones.
                    prop_assert!((at * METRE).distance(y_up(*joint)) < 1e-2, "{} {} {}", name, at, joint);
                }
            }
        }
    }

    #[test]
    fn the_mesh_moves_as_the_body_draws_it() {
        let body = Body::adult(1750.0).unwrap();
        let mut moved = body.standing_pose();
        moved.iter_mut().enumerate().for_each(|(index, value)| *value += 0.05 * (index % 5) as f64);
        let table =
            PoseTable { frames: vec![100, 101, 103], poses: vec![body.standing_pose(), moved.clone(), moved.clone()] };
        let bytes = written(&body, &table);
        assert_eq!(bytes, written(&body, &table), "the same bytes each time");
        let (document, blob) = read(&bytes);
        let mesh = Mesh::of_body(&body).unwrap();
        let expected = mesh.posed(&body.world_from_bones(&moved).unwrap()).unwrap();
        let nodes = placed(&document, &blob, 1);
        let skin = document.skins().next().unwrap();
        let joints: Vec<usize> = skin.joints().map(|joint| joint.index()).collect();
        let inverse: Vec<DMat4> = skin
            .reader(|_| Some(&blob))
            .read_inverse_bind_matrices()
            .unwrap()
            .map(|matrix| glam::Mat4::from_cols_array_2d(&matrix).as_dmat4())
            .collect();
        let primitive = document.meshes().next().unwrap().primitives().next().unwrap();
        let reader = primitive.reader(|_| Some(&blob));
        let places: Vec<_> = reader.read_positions().unwrap().collect();
        let hung: Vec<_> = reader.read_joints(0).unwrap().into_u16().collect();
        let weights: Vec<_> = reader.read_weights(0).unwrap().into_f32().collect();
        assert_eq!((places.len(), joints.len()), (expected.len(), body.joint_names().len()));
        for (vertex, expected) in expected.iter().enumerate() {
            let at = DVec3::from(places[vertex].map(f64::from));
            let drawn: DVec3 = (0..4)
                .map(|slot| {
                    let joint = usize::from(hung[vertex][slot]);
                    (nodes[joints[joint]] * inverse[joint]).transform_point3(at) * f64::from(weights[vertex][slot])
                })
                .sum();
            assert!((drawn * METRE).distance(y_up(expected.as_dvec3())) < 0.01, "vertex {vertex}");
        }
        let corners: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
        assert_eq!(corners, mesh.triangles.as_flattened());
        assert!(reader.read_normals().unwrap().all(|normal| (glam::Vec3::from(normal).length() - 1.0).abs() < 1e-5));
        // Upright on the floor, in metres.
        let standing = placed(&document, &blob, 0);
        let top = document.nodes().find(|node| node.name() == Some("head_top")).unwrap().index();
        let top = standing[top].w_axis;
        assert!((1.6..1.8).contains(&top.y) && top.x.abs() < 0.2 && top.z.abs() < 0.2, "{top}");
        let animation = document.animations().next().unwrap();
        assert_eq!(animation.channels().count(), body.bones.len() + 1, "every bone's rotation, the root's translation");
        let times: Vec<f32> =
            animation.channels().next().unwrap().reader(|_| Some(&blob)).read_inputs().unwrap().collect();
        assert_eq!(times, [0.0, 0.04, 0.12]);
    }

    #[test]
    fn what_cannot_be_a_motion_is_refused() {
        let body = Body::adult(1750.0).unwrap();
        let error = |frames: Vec<usize>, rate| {
            let poses = vec![body.standing_pose(); frames.len()];
            body.write_gltf(&mut Vec::new(), &PoseTable { frames, poses }, rate).unwrap_err().to_string()
        };
        assert!(error(vec![3, 3], 25.0).contains("frame 3 follows frame 3, expected rising frames"));
        assert!(error(vec![], 25.0).contains("no poses"));
        assert!(error(vec![0], 0.0).contains("frame rate is 0"));
    }
}
