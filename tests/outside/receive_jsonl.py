"""Keeps every line that comes from a port until its end: receive_jsonl.py PORT FILE."""

import json
import socket
import sys

with socket.create_connection(("127.0.0.1", int(sys.argv[1]))) as connection:
    lines = [json.loads(line) for line in connection.makefile(encoding="utf-8")]
with open(sys.argv[2], "w", encoding="utf-8") as file:
    json.dump(lines, file)
