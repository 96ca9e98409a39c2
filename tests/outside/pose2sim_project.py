"""Lays out the beam recording as a session of Pose2Sim with one trial, and its T-pose as a sequence of ours, by which the body is measured:
pose2sim_project.py DATA SESSION TPOSE"""

import json
import shutil
import sys
from pathlib import Path

import Pose2Sim

data, session, tpose = map(Path, sys.argv[1:])
demo = Path(Pose2Sim.__file__).parent / "Demo_Batch"
cameras = json.loads((data / "cameras.json").read_text())["cameras"]


def calibration(path, video, unit, factor):
    """In the layout that Pose2Sim writes."""
    text = f'[metadata]\nadjusted = false\nerror = 0.0\nunits = "{unit}"\n'
    for camera in cameras:
        pictures = video(camera)
        text += f'\n[{camera["name"]}]\nname = "{camera["name"]}"\n'
        text += f'size = [{pictures["width"]:.1f}, {pictures["height"]:.1f}]\nmatrix = {pictures["K"]}\n'
        text += f'distortions = {camera["dist"]}\nrotation = {camera["rvec"]}\n'
        text += f'translation = {[length * factor for length in camera["t"]]}\nfisheye = false\n'
    path.write_text(text)


# The demo's own files of both levels, as they are.
for folder in ("calibration", "plates", "Balancing/videos"):
    (session / folder).mkdir(parents=True)
shutil.copy(demo / "Config.toml", session)
shutil.copy(demo / "Trial_1" / "Config.toml", session / "Balancing")
calibration(session / "calibration" / "Calib.toml", lambda camera: camera, "m", 1e-3)
for camera in cameras:
    name = camera["name"]
    shutil.copy(data / "videos" / f"{name}.mp4", session / "Balancing" / "videos")
    shutil.copy(data / "background" / f"bg_{name}.png", session / "plates" / f"{name}.png")

tpose.mkdir(parents=True)
calibration(tpose / "cameras.toml", lambda camera: camera["tpose_video"], "mm", 1)
manifest = 'name = "tpose"\nfps = 60\nheight = 1720\nscale = 0.25\ncameras = "cameras.toml"\n'
for camera in cameras:
    name = camera["name"]
    shutil.copy(data / "tpose" / f"{name}.mp4", tpose)
    manifest += f'[[view]]\ncamera = "{name}"\nsource = "{name}.mp4"\nmask = "masks/{name}_%02d.png"\n'
shutil.copytree(data / "tpose" / "masks", tpose / "masks")
(tpose / "sequence.toml").write_text(manifest)
