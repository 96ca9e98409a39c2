"""The tables of a track's folder, for the checks beside this file."""

import csv
import pathlib


class Table:
    """A table by frame and column."""

    def __init__(self, folder, name):
        with open(pathlib.Path(folder) / name, encoding="utf-8", newline="") as file:
            self.rows = {int(row["frame"]): row for row in csv.DictReader(file)}

    def value(self, frame, column):
        return float(self.rows[frame][column])


def near(found, expected, within, what):
    if not abs(found - expected) <= within:
        raise SystemExit(f"{what}: {found} came, {expected} is in the file")
