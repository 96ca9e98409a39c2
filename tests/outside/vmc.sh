#!/bin/sh
# `pantin track --realtime --send` to real receivers on this machine: VMC into PyPI's python-osc, lines of JSON into Python's own json; both
# against the tables of the same run. Installs python-osc into a virtual environment that is thrown away.
. "$(dirname "$0")/live_run.sh"
python_with python-osc
vmc=$(free_port)
lines=$(free_port)
"$python" "$here/receive_vmc.py" "$vmc" "$place/vmc.json" &
receiver=$!
started="$started $receiver"
start_run --rate 0.8 --loop 6 --send "vmc://127.0.0.1:$vmc" --send "jsonl://127.0.0.1:$lines"
wait_for "connect to 127.0.0.1:$lines"
"$python" "$here/receive_jsonl.py" "$lines" "$place/lines.json"
wait "$run"
kill -INT "$receiver"
wait "$receiver" || true
cat "$place/told"
"$python" "$here/compare_sent.py" "$place/track" "$place/vmc.json" "$place/lines.json"
