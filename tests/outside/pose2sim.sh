#!/bin/sh
# A project of Pose2Sim made of the beam recording (../shared/data/beam): `pantin pose2sim` fills its pose-3d, and PyPI's Pose2Sim makes a
# scaled model and angles of it by its own kinematics.
. "$(dirname "$0")/outside.sh"

data=$top/../shared/data/beam
[ -d "$data" ] || { echo "SKIPPED: $data is absent" >&2; exit 0; }
environment pose2sim opensim==4.6 anytree c3d filterpy lxml matplotlib opencv-python-headless pandas rtoml scipy statsmodels tqdm
# Networks and windows, which the kinematics go without, are gigabytes.
"$work/pose2sim/bin/pip" install --quiet --no-deps pose2sim==0.10.49

session=$work/pose2sim_session
tpose=$work/pose2sim_tpose
rm -rf "$session" "$tpose"
"$python" "$here/pose2sim_project.py" "$data" "$session" "$tpose"
"$PANTIN" fit "$tpose" --height 1720 -o "$work/pose2sim_body.toml" --force
"$PANTIN" pose2sim "$session" --body "$work/pose2sim_body.toml" --plates "$session/plates" --backend cpu
# Pose2Sim leaves a log where it runs.
cd "$work"
"$python" "$here/pose2sim_kinematics.py" "$session/Balancing" 100 "$data/reference/authors_Balancing_for_IK.trc" \
    "$work/pose2sim_angles.png"
