# For the scripts beside it, to be read by them: where pantin is, a place that is thrown away, a virtual environment, and a run in real time.
# PANTIN is the program (target/release/pantin without).

set -eu
here=$(cd "$(dirname "$0")" && pwd)
PANTIN=${PANTIN:-$here/../../target/release/pantin}
[ -x "$PANTIN" ] || { echo "there is no $PANTIN: build it (make build), or set PANTIN" >&2; exit 1; }
place=$(mktemp -d)
started=""
# Only what was started here is ended.
trap 'for each in $started; do kill "$each" 2>/dev/null || true; done; rm -rf "$place"' EXIT

# A virtual environment with these packages.
python_with() {
    python3 -m venv "$place/python"
    "$place/python/bin/pip" install --quiet --disable-pip-version-check "$@"
    python=$place/python/bin/python
}

# A port that is free now.
free_port() {
    python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}

# A real-time run of a synthetic walk, in the background, with these options; what it says is in $place/said.
start_run() {
    "$PANTIN" synth --preset demo --frames 25 -o "$place/scene" 2> /dev/null
    "$PANTIN" track "$place/scene" -o "$place/track" --realtime --backend cpu --particles 64 --iterations 5 --deadline 80 "$@" \
        > "$place/told" 2> "$place/said" &
    run=$!
    started="$started $run"
}

# Waits until the run says something, and for its end.
wait_for() {
    for _ in $(seq 600); do
        grep -q "$1" "$place/said" && return
        kill -0 "$run" 2> /dev/null || { cat "$place/said" >&2; exit 1; }
        sleep 0.1
    done
    echo "the run never said $1" >&2
    exit 1
}
