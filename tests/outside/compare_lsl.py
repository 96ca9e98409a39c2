"""Holds what an inlet received to the tables of the run: compare_lsl.py TRACK SAMPLES."""

import json
import sys

from tables import Table, near

track, stream = sys.argv[1], json.load(open(sys.argv[2]))
poses, joints, confidence = (Table(track, name) for name in ("poses.csv", "joints.csv", "confidence.csv"))
channels, samples = stream["channels"], stream["samples"]
assert (stream["type"], stream["rate"]) == ("MoCap", 0.0), stream["type"]
columns = next(iter(joints.rows.values())).keys() - {"frame", "time"}
angles = next(iter(poses.rows.values())).keys() - {"frame"}
labels = [channel["label"] for channel in channels]
assert set(labels) == columns | angles | {"confidence", "wrong", "lost", "frame"}, labels
assert len(labels) == len(set(labels)) == len(samples[0]["values"])
assert all(channel["object"] and channel["type"] and channel["unit"] for channel in channels)
assert {"label": "pelvis.x", "object": "pelvis", "type": "PositionX", "unit": "millimeters"} in channels
for sample in samples:
    values = dict(zip(labels, sample["values"]))
    frame = round(values["frame"])
    for name in columns:
        near(values[name], joints.value(frame, name), 0.012, f"frame {frame}, {name}")
    for name in angles:
        near(values[name], poses.value(frame, name), 1e-3, f"frame {frame}, {name}")
    near(values["confidence"], confidence.value(frame, "confidence"), 1e-5, f"frame {frame}, confidence")
    age = sample["now"] - sample["stamp"] - sample["correction"]
    assert 0 < age < 2, f"frame {frame}: stamped {age} s ago"
stamps = [sample["stamp"] for sample in samples]
assert stamps == sorted(stamps), "stamps go back"
print(f"{len(samples)} samples of {len(labels)} channels are what the tables hold")
