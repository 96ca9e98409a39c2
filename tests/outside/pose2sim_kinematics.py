"""Runs Pose2Sim's kinematics on a trial, checks the model and the angles, and draws these beside those of the points that Pose2Sim's authors
found in the same videos: pose2sim_kinematics.py TRIAL FRAMES AUTHORS.trc PLOT"""

import math
import os
import shutil
import sys
from pathlib import Path

import opensim
from Pose2Sim import Pose2Sim

trial, frames = Path(sys.argv[1]).resolve(), int(sys.argv[2])
authors, plot = Path(sys.argv[3]).resolve(), Path(sys.argv[4]).resolve()
[points] = trial.glob("pose-3d/*.trc")
assert points.name == f"{trial.name}_0-{frames - 1}.trc", points.name


def kinematics(folder, name):
    """The model's and the angles' file. Pose2Sim looks for the session from where it runs."""
    os.chdir(folder)
    Pose2Sim.kinematics("Config.toml")
    os.chdir(folder.parent)
    model = opensim.Model(str(folder / "kinematics" / f"{name}.osim"))
    model.initSystem()
    return model, opensim.TimeSeriesTable(str(folder / "kinematics" / f"{name}.mot"))


model, table = kinematics(trial, points.stem)
mass = sum(model.getBodySet().get(i).getMass() for i in range(model.getBodySet().getSize()))
assert table.getNumRows() == frames, f"{table.getNumRows()} rows"
times = table.getIndependentColumn()
assert abs(times[-1] - (frames - 1) / 60) < 1e-4, times[-1]

# A trial of the same session with the authors' points, which are those of another network.
other = trial.parent / "Authors"
(other / "pose-3d").mkdir(parents=True)
shutil.copy(authors, other / "pose-3d" / f"Authors_0-{frames - 1}.trc")
(other / "Config.toml").write_text("[pose]\npose_model = 'BODY_25B'\n[project]\nmulti_person = false\n")
_, theirs = kinematics(other, f"Authors_0-{frames - 1}")

# What a man who balances along a beam can do, degrees.
LIMITS = {"knee_angle": (-10, 140), "hip_flexion": (-40, 120), "hip_adduction": (-60, 60), "ankle_angle": (-60, 50),
          "elbow_flex": (-10, 160), "arm_flex": (-120, 180)}
columns = {}
for name, (low, high) in LIMITS.items():
    for side in "rl":
        values = table.getDependentColumn(f"{name}_{side}").to_numpy()
        columns[f"{name}_{side}"] = values
        reference = theirs.getDependentColumn(f"{name}_{side}").to_numpy()
        apart = math.sqrt(sum((values - reference[: len(values)]) ** 2) / len(values))
        jump = max(abs(values[1:] - values[:-1]))
        print(f"{name}_{side}: {min(values):.1f} to {max(values):.1f} degrees, at most {jump:.1f} between two frames; "
              f"{apart:.1f} (RMS) from those of the authors' points")
        assert all(map(math.isfinite, values)), f"{name}_{side}: no number"
        assert low <= min(values) and max(values) <= high, f"{name}_{side}: {min(values)} to {max(values)}"
        assert name != "knee_angle" or apart < 15, f"{name}_{side}: {apart} degrees from the authors' points"
        assert jump < 40, f"{name}_{side}: {jump} degrees in a frame"
for name, (low, high) in {"pelvis_tilt": (-60, 60), "pelvis_list": (-45, 45)}.items():
    values = table.getDependentColumn(name).to_numpy()
    print(f"{name}: {min(values):.1f} to {max(values):.1f} degrees")
    assert low <= min(values) and max(values) <= high, name
assert max(columns["knee_angle_r"]) - min(columns["knee_angle_r"]) > 10, "the right knee never moves"
print(f"{frames} frames, a model of {mass:.1f} kg with {model.getMarkerSet().getSize()} markers")

# What OpenSim says of the distance between the model's markers and ours.
errors = [float(line.split("RMS = ")[1].split()[0].rstrip(",")) for line in
          (trial / "kinematics" / "opensim_logs.txt").read_text().splitlines() if "marker error: RMS = " in line]
if errors:
    print(f"markers of the model and ours: {1000 * sum(errors) / len(errors):.1f} mm apart on average (RMS), at most {1000 * max(errors):.1f}")

import matplotlib.pyplot as plt  # noqa: E402  Pose2Sim chooses what it draws with

figure, axes = plt.subplots(4, 1, figsize=(9, 9), sharex=True)
for axis, name in zip(axes, ["knee_angle", "hip_flexion", "elbow_flex", "ankle_angle"]):
    for side, word, colour in ("r", "right", "C0"), ("l", "left", "C1"):
        axis.plot(times, columns[f"{name}_{side}"], colour, label=word)
        axis.plot(times, theirs.getDependentColumn(f"{name}_{side}").to_numpy()[:frames], colour, linestyle="--",
                  label=f"{word}, Pose2Sim's points")
    axis.set_ylabel(f"{name}, degrees")
    axis.grid(alpha=0.3)
axes[-1].set_xlabel("time, s")
axes[0].legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0))
figure.tight_layout()
figure.savefig(plot, dpi=80)
print(f"plot: {plot}")
