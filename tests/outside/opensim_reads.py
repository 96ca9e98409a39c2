"""Reads a track's files with OpenSim and compares them with joints.csv: opensim_reads.py TRACK MARKERS.trc"""

import csv
import math
import sys
import tomllib
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


def compare_motion(name, expected, decimals):
    """`expected` gives a row of values by coordinate, or None for a frame without one, for each row of joints.csv."""
    path = str(track / name)
    storage, table = opensim.Storage(path), opensim.TimeSeriesTable(path)
    assert storage.isInDegrees(), name
    labels = list(table.getColumnLabels())
    assert [storage.getColumnLabels().get(index) for index in range(1, len(labels) + 1)] == labels, name
    rows_there = [index for index, row in enumerate(joints) if expected(index) is not None]
    assert table.getNumRows() == storage.getSize() == len(rows_there) < len(joints), f"{name}: {table.getNumRows()} rows"
    worst = 0.0
    for found, index in enumerate(rows_there):
        values, meant = table.getRowAtIndex(found), expected(index)
        assert sorted(meant) == sorted(labels), name
        assert abs(table.getIndependentColumn()[found] - float(joints[index]["time"])) < 1e-5, name
        data = storage.getStateVector(found).getData()
        for column, label in enumerate(labels):
            assert abs(data.get(column) - values[column]) < 1e-12, name
            worst = max(worst, abs(values[column] - meant[label]))
    assert worst < 10**-decimals, f"{name}: off by {worst}"
    print(f"{name}: {len(rows_there)} rows, {len(labels)} coordinates in degrees and metres, at most {worst:.1e} off")


poses, states = rows(track / "poses.csv"), [row["state"] for row in rows(track / "confidence.csv")]
with open(track / "coordinates.toml", "rb") as file:
    mapping = tomllib.load(file)["coordinate"]


def coordinates(index):
    if states[index] == "lost":
        return None
    values = {}
    for dof, to in mapping.items():
        value = float(poses[index][dof]) / (1000 if dof.split(".")[1][0] == "t" else 1)
        values[to["name"]] = to.get("factor", 1) * value + to.get("offset", 0)
    return values


compare_motion("motion.mot", coordinates, 6)
# The pelvis is where the markers' file has it.
table, points = opensim.TimeSeriesTable(str(track / "motion.mot")), opensim.TimeSeriesTableVec3(str(track / "joints_opensim.trc"))
pelvis = points.getDependentColumn("pelvis")
place = [table.getDependentColumn(f"pelvis_t{axis}")[0] for axis in "xyz"]
assert math.dist(place, [pelvis[0].get(axis) for axis in range(3)]) < 1e-6, place

deviations = opensim.TimeSeriesTable(str(track / "motion_sd.mot"))
assert list(deviations.getColumnLabels()) == list(table.getColumnLabels())
assert list(deviations.getIndependentColumn()) == list(table.getIndependentColumn())
knees = [deviations.getDependentColumn("knee_angle_l")[row] for row in range(deviations.getNumRows())]
assert min(knees) > 0 and max(knees) < 90, knees
print(f"motion_sd.mot: {deviations.getNumRows()} rows; the left knee's angle is known to {min(knees):.1f} to {max(knees):.1f} degrees")
