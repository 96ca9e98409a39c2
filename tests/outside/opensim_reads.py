"""Reads a track's files with OpenSim and compares them with joints.csv: opensim_reads.py TRACK MARKERS.trc"""

import csv
import math
import sys
from pathlib import Path

import opensim

track, markers = Path(sys.argv[1]), Path(sys.argv[2])


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


joints = rows(track / "joints.csv")
names = [column[:-2] for column in joints[0] if column.endswith(".x")]


def expected(row, name, y_up):
    """The point in the file's unit and axes; None where it is missing."""
    cells = [row[f"{name}.{axis}"] for axis in "xyz"]
    if not all(cells):
        return None
    x, y, z = map(float, cells)
    return (y / 1000, z / 1000, x / 1000) if y_up else (x, y, z)


def compare(path, y_up, tolerance):
    table = opensim.TimeSeriesTableVec3(str(path))
    assert list(table.getColumnLabels()) == names, f"{path}: other points"
    assert table.getNumRows() == len(joints), f"{path}: {table.getNumRows()} rows"
    units = table.getTableMetaDataAsString("Units")
    assert units == ("m" if y_up else "mm"), units
    times, worst, gaps = table.getIndependentColumn(), 0.0, 0
    for index, row in enumerate(joints):
        assert abs(times[index] - float(row["time"])) < 1e-5, f"{path}: row {index} is at {times[index]} s"
        values = table.getRowAtIndex(index)
        for column, name in enumerate(names):
            found = [values[column].get(axis) for axis in range(3)]
            meant = expected(row, name, y_up)
            if meant is None:
                assert all(map(math.isnan, found)), f"{path}: {name} in row {index} is {found}, expected a gap"
                gaps += 1
            else:
                worst = max(worst, math.dist(found, meant))
    assert gaps and gaps % len(names) == 0, f"{path}: {gaps} points are missing"
    assert worst < tolerance, f"{path}: off by {worst} {units}"
    print(f"{path.name}: {len(joints)} rows, {len(names)} points, {gaps} missing, at most {worst:.1e} {units} off")


print(f"OpenSim {opensim.GetVersion()}")
compare(track / "joints.trc", y_up=False, tolerance=2e-4)
compare(track / "joints_opensim.trc", y_up=True, tolerance=2e-7)

data = opensim.MarkerData(str(markers))
missing = [index for index, row in enumerate(joints) if not row[f"{names[0]}.x"]]
for index in range(data.getNumFrames()):
    frame = data.getFrame(index)
    heights = [frame.getMarker(marker).get(1) for marker in range(data.getNumMarkers())]
    assert all(map(math.isnan, heights)) == (index in missing), f"{markers}: frame {index}"
    assert index in missing or -0.1 < min(heights) < 0.5 < max(heights) < 2.2, f"{markers}: {heights} m"
print(f"{markers.name}: {data.getNumFrames()} frames of {data.getNumMarkers()} markers in {data.getUnits().getLabel()}")
