# Sourced by the checks against outside programs: a short track with a gap in it, and where programs are installed.
#
# PANTIN names the program to be checked; without it the one of `cargo build --release` is.
set -eu

top=$(cd "$(dirname "$0")/../.." && pwd)
here=$top/tests/outside
work=${OUTSIDE_WORK:-$top/target/outside}
mkdir -p "$work"

if [ -z "${PANTIN:-}" ]; then
    (cd "$top" && cargo build --release --locked)
    PANTIN=$top/target/release/pantin
fi

# environment NAME PACKAGE...: a virtual environment of Python with these packages; sets `python`.
environment() {
    name=$1
    shift
    python=$work/$name/bin/python
    [ -e "$work/$name/complete" ] && return
    rm -rf "${work:?}/$name"
    "${PYTHON:-python3}" -m venv "$work/$name"
    "$work/$name/bin/pip" install --quiet "$@"
    touch "$work/$name/complete"
}

# A person walks a circle, is away in frames 8 to 15, and comes back: `walk`, and its track from frame 4 on, `track`.
walk=$work/walk
track=$work/track
if [ ! -e "$walk/complete" ]; then
    printf 'frames = 28\n[rig]\nsize = [320, 240]\n[[actor]]\n[actor.motion]\ngait = "circle"\n' >"$work/walk.toml"
    "$PANTIN" synth "$work/walk.toml" -o "$walk" --force
    for camera in cam1 cam2 cam3 cam4; do
        for frame in 08 09 10 11 12 13 14 15; do
            cp "$walk/plates/$camera.png" "$walk/frames/${camera}_00$frame.png"
        done
    done
    # The pose of frame 4 begins the track.
    { head -n 1 "$walk/truth_poses.csv"; sed -n 6p "$walk/truth_poses.csv"; } >"$walk/from4.csv"
    touch "$walk/complete"
fi
"$PANTIN" track "$walk" -o "$track" --frames 4.. --start "$walk/from4.csv" --particles 150 --iterations 8 --spread 0.5 \
    --overlay-every 0 --backend cpu --force >/dev/null 2>&1
grep -q ',lost,' "$track/confidence.csv" || { echo "the track has no lost frame to check gaps with" >&2; exit 1; }
