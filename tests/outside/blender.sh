#!/bin/sh
# Opens a track's motion.bvh and motion.glb in Blender (PyPI's `bpy`, 5.0.1, for Python 3.11) with its default import, compares the joints
# with joints.csv, and draws what Blender sees into target/outside.
. "$(dirname "$0")/outside.sh"

PYTHON=${PYTHON:-python3.11} environment blender bpy==5.0.1 matplotlib
"$PANTIN" convert "$track/motion.bvh" "$work/metres.bvh" --convention opensim --force
for file in "$track/motion.bvh" "$work/metres.bvh" "$track/motion.glb"; do
    if [ -e "$file" ]; then "$python" "$here/blender_opens.py" "$file" "$track/joints.csv" "$work"; fi
done
