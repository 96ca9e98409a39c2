#!/bin/sh
# docs/receivers/jsonl_to_lsl.py between a real-time run and a real inlet of the Lab Streaming Layer on this machine (PyPI's pylsl, whose wheel
# holds liblsl), against the tables of the same run. Installs pylsl into a virtual environment that is thrown away.
. "$(dirname "$0")/live_run.sh"
python_with pylsl
# Streams are found on this machine alone.
printf '[multicast]\nResolveScope = machine\n[lab]\nKnownPeers = {127.0.0.1}\nSessionID = pantin-%s\n' "$$" > "$place/lsl_api.cfg"
export LSLAPICFG="$place/lsl_api.cfg"
port=$(free_port)
"$python" "$here/../../docs/receivers/jsonl_to_lsl.py" 127.0.0.1 "$port" &
bridge=$!
started="$started $bridge"
"$python" "$here/receive_lsl.py" "$place/samples.json" &
inlet=$!
started="$started $inlet"
start_run --rate 0.5 --loop 12 --send "jsonl://127.0.0.1:$port"
wait "$run"
cat "$place/told"
wait "$inlet"
"$python" "$here/compare_lsl.py" "$place/track" "$place/samples.json"
