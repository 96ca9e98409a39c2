#!/usr/bin/env python3
"""Poses of `pantin track --realtime --send jsonl://HOST:PORT` as a stream of the Lab Streaming Layer.

    pip install pylsl
    python jsonl_to_lsl.py HOST PORT [--name pantin] [--source-id ID] [--wait SECONDS]

A sample a pose, stamped with the moment at which its pictures were captured: x, y, z of every joint (millimetres; world, z up), its expected
error, every degree of freedom (millimetres, degrees), then confidence, wrong, lost and frame. Which channel is what stands in the
stream's description, as XDF's meta-data for motion capture has it. Poses come when they come, so the nominal rate is irregular.
"""

import argparse
import json
import math
import socket
import sys
import time

import pylsl

WHOLE = [("confidence", "Confidence", "normalized"), ("wrong", "Probability", "normalized"), ("lost", "Flag", "boolean"),
         ("frame", "FrameNumber", "count")]


def channels(line):
    """What each channel is: label, object, type, unit."""
    for joint in line["joints"]:
        for axis in "XYZ":
            yield f"{joint}.{axis.lower()}", joint, f"Position{axis}", "millimeters"
        yield f"{joint}.sigma", joint, "ExpectedError", "millimeters"
    for dof in line["pose"]:
        bone, axis = dof.rsplit(".", 1)
        kind = "Rotation" if axis[0] == "r" else "Translation"
        yield dof, bone, kind + axis[1].upper(), "degrees" if axis[0] == "r" else "millimeters"
    for name, kind, unit in WHOLE:
        yield name, "body", kind, unit


def sample(line):
    """The values, in the order of the channels; what is missing is no number."""
    values = []
    for joint, place in line["joints"].items():
        values += [*place, line["sigma"][joint]]
    values += list(line["pose"].values()) + [line[name] for name, _, _ in WHOLE]
    return [math.nan if value is None else float(value) for value in values]


def outlet(line, name, source):
    """The stream, described by its first line."""
    kinds = list(channels(line))
    info = pylsl.StreamInfo(name, "MoCap", len(kinds), pylsl.IRREGULAR_RATE, pylsl.cf_float32, source)
    description = info.desc()
    listed = description.append_child("channels")
    for label, what, kind, unit in kinds:
        channel = listed.append_child("channel")
        for key, value in (("label", label), ("object", what), ("type", kind), ("unit", unit)):
            channel.append_child_value(key, value)
    setup = description.append_child("setup")
    setup.append_child_value("name", "world frame of the cameras: right-handed, z up")
    description.append_child("acquisition").append_child_value("model", "pantin")
    return pylsl.StreamOutlet(info)


def connected(host, port, wait):
    """A connection, once pantin listens."""
    until = time.monotonic() + wait
    while True:
        try:
            return socket.create_connection((host, port), timeout=10)
        except OSError as error:
            if time.monotonic() > until:
                sys.exit(f"nobody listens at {host}:{port} ({error}): start pantin with --send jsonl://{host}:{port}")
            time.sleep(0.1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("host")
    parser.add_argument("port", type=int)
    parser.add_argument("--name", default="pantin", help="the stream's name")
    parser.add_argument("--source-id", help="what tells it from other sources; HOST:PORT without")
    parser.add_argument("--wait", type=float, default=60, help="how long to wait for pantin to listen, s")
    options = parser.parse_args()
    stream = None
    connection = connected(options.host, options.port, options.wait)
    connection.settimeout(None)
    for text in connection.makefile(encoding="utf-8"):
        line = json.loads(text)
        captured = pylsl.local_clock() - line["latency"] / 1000
        if stream is None:
            source = options.source_id or f"pantin {options.host}:{options.port}"
            stream = outlet(line, options.name, source)
            print(f"stream {options.name!r}: {len(sample(line))} channels", flush=True)
        stream.push_sample(sample(line), captured)


if __name__ == "__main__":
    main()
