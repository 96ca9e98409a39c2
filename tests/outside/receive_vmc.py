"""Keeps every VMC message that arrives at a port until it is interrupted: receive_vmc.py PORT FILE."""

import json
import signal
import sys

from pythonosc.dispatcher import Dispatcher
from pythonosc.osc_server import BlockingOSCUDPServer

port, path = int(sys.argv[1]), sys.argv[2]
messages = []
dispatcher = Dispatcher()
dispatcher.set_default_handler(lambda address, *args: messages.append([address, *args]))


def end(*_):
    with open(path, "w", encoding="utf-8") as file:
        json.dump(messages, file)
    sys.exit(0)


signal.signal(signal.SIGINT, end)
signal.signal(signal.SIGTERM, end)
BlockingOSCUDPServer(("127.0.0.1", port), dispatcher).serve_forever()
