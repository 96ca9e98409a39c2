"""Keeps 30 samples of the stream `pantin` and its description: receive_lsl.py FILE."""

import json
import sys

import pylsl

found = pylsl.resolve_byprop("name", "pantin", timeout=120)
assert found, "there is no stream `pantin`"
inlet = pylsl.StreamInlet(found[0])
info = inlet.info(timeout=20)
channels, channel = [], info.desc().child("channels").child("channel")
while not channel.empty():
    channels.append({key: channel.child_value(key) for key in ("label", "object", "type", "unit")})
    channel = channel.next_sibling("channel")
samples = []
while len(samples) < 30:
    values, stamp = inlet.pull_sample(timeout=20)
    assert values is not None, f"only {len(samples)} samples came"
    samples.append({"values": values, "stamp": stamp, "correction": inlet.time_correction(timeout=5), "now": pylsl.local_clock()})
with open(sys.argv[1], "w", encoding="utf-8") as file:
    json.dump({"type": info.type(), "rate": info.nominal_srate(), "channels": channels, "samples": samples}, file)
