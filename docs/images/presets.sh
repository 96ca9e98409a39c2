#!/bin/sh
# Makes docs/images/presets.jpg of the sequences that `pantin study docs/studies/errors.toml -o DIR` has made: frame 30 of every preset from
# its four cameras, a preset a row.
#   docs/images/presets.sh DIR/sequences
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for preset in leewalk p1s p1d p2s p2d two_straight two_diagonal; do
    frame="$1/$preset/frames"
    ffmpeg -v error -i "$frame/cam1_0030.png" -i "$frame/cam2_0030.png" -i "$frame/cam3_0030.png" -i "$frame/cam4_0030.png" \
        -filter_complex 'hstack=inputs=4,scale=960:-2,format=rgb24' "$work/$preset.png"
done
cd "$work"
ffmpeg -v error -i leewalk.png -i p1s.png -i p1d.png -i p2s.png -i p2d.png -i two_straight.png -i two_diagonal.png \
    -filter_complex 'vstack=inputs=7' -q:v 4 -y "$here/presets.jpg"
