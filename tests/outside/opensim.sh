#!/bin/sh
# Opens what `pantin` writes for OpenSim with OpenSim (PyPI's `opensim`, 4.6), and compares values and gaps.
. "$(dirname "$0")/outside.sh"

environment opensim opensim==4.6
"$PANTIN" convert "$track/markers.c3d" "$work/markers.trc" --convention opensim --force
# OpenSim leaves a log where it runs.
cd "$work"
"$python" "$here/opensim_reads.py" "$track" "$work/markers.trc"
