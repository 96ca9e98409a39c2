"""Opens a motion in Blender as a user does, compares it with joints.csv and draws it: blender_opens.py FILE joints.csv FOLDER"""

import csv
import sys
from pathlib import Path

import bpy
import matplotlib
from mathutils import Vector

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # noqa: E402

path, joints_csv, folder = map(Path, sys.argv[1:4])
with open(joints_csv, newline="") as file:
    rows = list(csv.DictReader(file))
names = [column[:-2] for column in rows[0] if column.endswith(".x")]
steps = [float(later["time"]) - float(row["time"]) for row, later in zip(rows, rows[1:])]
rate = round(len(steps) / sum(steps), 3)

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
# Animations in seconds are laid onto the frames of the scene.
scene.render.fps = round(rate)
is_bvh = path.suffix == ".bvh"
if is_bvh:
    bpy.ops.import_anim.bvh(filepath=str(path))
else:
    bpy.ops.import_scene.gltf(filepath=str(path))
armature = next(thing for thing in bpy.data.objects if thing.type == "ARMATURE")
# How long a unit of the scene is: a BVH's unit is whatever the file has, here centimetres or metres.
unit = 0.01 if path.name == "motion.bvh" else 1.0
first = 1 if is_bvh else 0


def stands_on_floor(points, what):
    height = max(point.z for point in points) - min(point.z for point in points)
    assert 1.3 < height < 2.1, f"{path.name}: {what} is {height:.2f} m tall"
    assert -0.12 < min(point.z for point in points) < 0.25, f"{path.name}: {what} stands at {min(p.z for p in points):.2f} m"
    return height


# Blender's importers turn y up to z up: our (x forward, y left) then stands as (y, -x).
worst, compared, gaps, height = 0.0, set(), 0, []
tracks, seen = {name: [] for name in names}, []
for index, row in enumerate(rows):
    scene.frame_set(first + index)
    pose = {}
    for bone in armature.pose.bones:
        pose[bone.name] = unit * (armature.matrix_world @ bone.head)
        if is_bvh and not bone.children and bone.name in ("left_knee", "right_knee", "left_elbow", "right_elbow", "head"):
            end = {"knee": "ankle", "elbow": "wrist"}.get(bone.name.split("_")[-1])
            end = bone.name.split("_")[0] + "_" + end if end else "head_top"
            pose[end] = unit * (armature.matrix_world @ bone.tail)
    seen.append(pose)
    if not row[f"{names[0]}.x"]:
        gaps += 1
        continue
    height.append(stands_on_floor(pose.values(), f"the skeleton of frame {row['frame']}"))
    for name in names:
        if name not in pose:
            continue
        x, y, z = (float(row[f"{name}.{axis}"]) / 1000 for axis in "xyz")
        worst = max(worst, (pose[name] - Vector((y, -x, z))).length)
        compared.add(name)
missing = set(names) - compared
assert not missing, f"{path.name}: Blender has no {missing}"
assert gaps, "expected frames without a person"
assert worst < 1e-3, f"{path.name}: joints are up to {1000 * worst:.3f} mm off"
way = (seen[-1]["pelvis"] - seen[0]["pelvis"]).length
assert way > 0.1, f"{path.name}: moves by {way} m"
print(
    f"Blender {bpy.app.version_string}, {path.name}: {len(compared)} joints in {len(rows) - gaps} frames at most "
    f"{1000 * worst:.4f} mm off, {min(height):.2f} to {max(height):.2f} m tall, moves by {way:.2f} m"
)

meshes = [thing for thing in bpy.data.objects if thing.type == "MESH" and thing.modifiers]
if not is_bvh:
    assert meshes, f"{path.name}: no skinned mesh"


def skin():
    """The vertices of the mesh as it is drawn now, in the world."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    mesh = meshes[0].evaluated_get(depsgraph)
    return [mesh.matrix_world @ vertex.co for vertex in mesh.data.vertices], [list(face.vertices) for face in mesh.data.polygons]


figure = plt.figure(figsize=(15, 5))
for place, index in enumerate([0, len(rows) // 2, len(rows) - 1]):
    scene.frame_set(first + index)
    axes = figure.add_subplot(1, 3, place + 1, projection="3d")
    if meshes:
        vertices, faces = skin()
        stands_on_floor(vertices, "the mesh")
        corners = [[vertices[corner] for corner in face] for face in faces]
        axes.add_collection3d(Poly3DCollection(corners, facecolor="tan", edgecolor="gray", linewidth=0.1))
    for bone in armature.pose.bones:
        # Bones of glTF have no ends of their own, those of BVH have.
        ends = (bone.head, bone.tail) if is_bvh else (bone.parent.head, bone.head) if bone.parent else ()
        if ends:
            axes.plot(*zip(*(unit * (armature.matrix_world @ end) for end in ends)), "k-", linewidth=2)
    middle = seen[index]["pelvis"]
    axes.set(xlim=(middle.x - 1, middle.x + 1), ylim=(middle.y - 1, middle.y + 1), zlim=(0, 2), title=f"frame {rows[index]['frame']}")
    axes.set_box_aspect((1, 1, 1))
    axes.view_init(elev=12, azim=-60)
figure.suptitle(f"{path.name} in Blender, z up")
figure.savefig(folder / f"blender_{path.stem}_{path.suffix[1:]}.png", dpi=80)
