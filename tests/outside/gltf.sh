#!/bin/sh
# Validates a track's motion.glb, and one made of poses.csv, with Khronos' validator (npm's `gltf-validator`).
. "$(dirname "$0")/outside.sh"

modules=$work/gltf/node_modules
if [ ! -d "$modules/gltf-validator" ]; then
    mkdir -p "$work/gltf"
    npm install --silent --no-fund --no-audit --prefix "$work/gltf" gltf-validator@2.0.0-dev.3.10
fi
"$PANTIN" convert "$track/poses.csv" "$work/poses.glb" --body "$walk/body.toml" --rate 25 --force
node "$here/gltf_validates.js" "$modules" "$track/motion.glb" "$work/poses.glb"
