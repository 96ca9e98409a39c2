"""Holds what came over VMC and as lines of JSON to the tables of the run: compare_sent.py TRACK VMC LINES."""

import json
import sys

from tables import Table, near

track, vmc, lines = sys.argv[1], json.load(open(sys.argv[2])), json.load(open(sys.argv[3]))
poses, joints, confidence = (Table(track, name) for name in ("poses.csv", "joints.csv", "confidence.csv"))

assert len(lines) > 20, f"only {len(lines)} lines"
for line in lines:
    frame = line["frame"]
    for name, value in line["pose"].items():
        near(value, poses.value(frame, name), 1e-6, f"frame {frame}, {name}")
    for name, place in line["joints"].items():
        for axis, value in zip("xyz", place):
            near(value, joints.value(frame, f"{name}.{axis}"), 2e-3, f"frame {frame}, {name}.{axis}")
        near(line["sigma"][name], joints.value(frame, f"{name}.sigma"), 0.01, f"frame {frame}, {name}.sigma")
    near(line["confidence"], confidence.value(frame, "confidence"), 1e-5, f"frame {frame}, confidence")
print(f"{len(lines)} lines of JSON are what the tables hold")

# Unity's name, its parent, our joint.
CHAIN = [("Hips", None, "pelvis"), ("Spine", "Hips", "thorax"), ("Head", "Spine", "head")]
for side, ours in (("Left", "left"), ("Right", "right")):
    CHAIN += [
        (f"{side}UpperLeg", "Hips", f"{ours}_hip"), (f"{side}LowerLeg", f"{side}UpperLeg", f"{ours}_knee"),
        (f"{side}Foot", f"{side}LowerLeg", f"{ours}_ankle"), (f"{side}Shoulder", "Spine", f"{ours}_clavicle"),
        (f"{side}UpperArm", f"{side}Shoulder", f"{ours}_shoulder"), (f"{side}LowerArm", f"{side}UpperArm", f"{ours}_elbow"),
        (f"{side}Hand", f"{side}LowerArm", f"{ours}_wrist"),
    ]


def product(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def turned(q, v):
    x, y, z, w = q
    return product(product(q, (*v, 0.0)), (-x, -y, -z, w))[:3]


fps = len(joints.rows) and 1 / (joints.value(sorted(joints.rows)[1], "time") - joints.value(sorted(joints.rows)[0], "time"))
frames, bones, largest = 0, {}, 0.0
starts = [at for at, message in enumerate(vmc) if message[0] == "/VMC/Ext/T"] + [len(vmc)]
for begin, end in zip(starts, starts[1:]):
    frame = round(vmc[begin][1] * fps)
    bones = {message[1]: message[2:] for message in vmc[begin:end] if message[0] == "/VMC/Ext/Bone/Pos"}
    assert set(bones) == {name for name, _, _ in CHAIN}, f"frame {frame}: {sorted(bones)}"
    world = {None: ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))}
    for name, parent, joint in CHAIN:
        place, rotation = bones[name][:3], bones[name][3:]
        near(sum(value * value for value in rotation), 1.0, 1e-5, f"frame {frame}, {name}: length of the quaternion")
        start, turn = world[parent]
        place = tuple(a + b for a, b in zip(start, turned(turn, place)))
        world[name] = (place, product(turn, rotation))
        x, y, z = (joints.value(frame, f"{joint}.{axis}") / 1000 for axis in "xyz")
        for found, expected in zip(place, (-y, z, x)):
            largest = max(largest, abs(found - expected))
            near(found, expected, 1e-4, f"frame {frame}, {name}")
    frames += 1
assert frames > 20, f"only {frames} poses"
print(f"{frames} poses over VMC: {len(CHAIN)} bones chain to the joints of the tables, {largest * 1000:.4f} mm off at most")
