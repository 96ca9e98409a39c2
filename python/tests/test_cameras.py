"""Cameras from arrays and from OpenCap's pickles."""

import os
import pathlib
import pickle

import numpy as np
import pytest

import pantin


def test_arrays_give_the_cameras_back(walk: pathlib.Path, tmp_path: pathlib.Path) -> None:
    """What is saved reads as what was given."""
    turn = np.array([[0, -1, 0], [0, 0, -1], [1, 0, 0]], np.float64)
    given = dict(
        names=["left", "right"],
        sizes=[[640, 480]] * 2,
        matrices=[[[500, 0, 320], [0, 510, 240], [0, 0, 1]]] * 2,
        distortions=[[-0.1, 0.02, 0.001, 0], [0, 0, 0, 0]],
        rotations=[turn, turn],
        translations=[[0, 100, 3000], [50, 100, 3000]],
    )
    cameras = pantin.Cameras.of_arrays(**given)
    assert (cameras.names, cameras.sizes) == (["left", "right"], [(640, 480)] * 2)
    # z of the world is up in the picture.
    low, high = cameras.project([[0, 0, 0], [0, 0, 500]])[1]
    assert high[1] < low[1] - 50
    cameras.save(tmp_path / "cameras.toml")
    points = np.random.default_rng(1).normal(size=(20, 3)) * 300
    np.testing.assert_allclose(pantin.Cameras.load(tmp_path / "cameras.toml").project(points), cameras.project(points), atol=1e-9)
    with pytest.raises(pantin.PantinError, match="exists"):
        cameras.save(tmp_path / "cameras.toml")
    cameras.save(tmp_path / "cameras.toml", force=True)
    for change, sentence in [
        (dict(names=["left", "left"]), "two cameras are named `left`"),
        (dict(names=["left"]), "of 1 cameras has the shape"),
        (dict(rotations=np.eye(3)[None] * [[[2.0]], [[1.0]]]), "camera `left`: rotation is"),
        (dict(matrices=[[[np.nan, 0, 1], [0, 1, 1], [0, 0, 1]]] * 2), "expected finite numbers"),
    ]:
        with pytest.raises(pantin.PantinError, match=sentence):
            pantin.Cameras.of_arrays(**{**given, **change})


def opencap(folder: pathlib.Path, name: str, **change: object) -> pathlib.Path:
    """A camera three metres before a board on the wall, whose y runs down; looking along the board's z."""
    held = dict(
        intrinsicMat=np.array([[1000.0, 0, 359.5], [0, 1000, 639.5], [0, 0, 1]]),
        distortion=np.array([[0.1, -0.2, 0.0, 0.0, 0.05]]),
        imageSize=np.array([[1280], [720]]),
        rotation=np.eye(3),
        translation=np.array([[-200.0], [-100.0], [3000.0]]),
        rotation_EulerAngles=np.zeros((3, 1)),
    )
    held.update(change)
    path = folder / "Videos" / name / "cameraIntrinsicsExtrinsics.pickle"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(pickle.dumps(held))
    return path


def test_opencaps_session_reads_upright(tmp_path: pathlib.Path) -> None:
    """z is up, lengths are millimetres, sizes are width before height."""
    opencap(tmp_path, "Cam0")
    opencap(tmp_path, "Cam1", imageSize=np.array([720, 1280]))
    cameras = pantin.Cameras.of_opencap(tmp_path, origin_height=900)
    assert (cameras.names, cameras.sizes) == (["Cam0", "Cam1"], [(720, 1280)] * 2)
    # The board's origin is 900 mm up; what is above it is above it in the picture, its x to the right.
    origin, above, right = cameras.project([[0, 0, 900], [0, 0, 1400], [300, 0, 900]])[0]
    np.testing.assert_allclose(origin, [359.5 - 1000 * 200 / 3000, 639.5 - 1000 * 100 / 3000], atol=0.5)
    assert above[1] < origin[1] - 100 and right[0] > origin[0] + 90
    named = pantin.Cameras.of_opencap({"a": tmp_path / "Videos/Cam0/cameraIntrinsicsExtrinsics.pickle"}, up="-y", origin_height=900)
    np.testing.assert_allclose(named.project([[0, 0, 900]])[0][0], origin)
    with pytest.raises(pantin.PantinError, match="up is 'north'"):
        pantin.Cameras.of_opencap(tmp_path, up="north")


class Harmful:
    """What a pickle could do."""

    def __reduce__(self) -> object:
        return (os.system, ("touch harmed",))


def test_bad_pickles_are_sentences(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing that a pickle names is run."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(pantin.PantinError, match="holds no cameraIntrinsicsExtrinsics.pickle"):
        pantin.Cameras.of_opencap(tmp_path)
    path = opencap(tmp_path, "Cam0", rotation=Harmful())
    with pytest.raises(pantin.PantinError, match="is no calibration of OpenCap's: it holds (posix|nt).system"):
        pantin.Cameras.of_opencap(tmp_path)
    assert not (tmp_path / "harmed").exists()
    for change, sentence in [
        (dict(rotation=None), "rotation holds"),
        (dict(translation=np.zeros(4)), "translation holds 4 numbers, expected 3"),
        (dict(distortion="none"), "distortion holds 0 numbers"),
    ]:
        opencap(tmp_path, "Cam0", **change)
        with pytest.raises(pantin.PantinError, match=sentence):
            pantin.Cameras.of_opencap(tmp_path)
    path.write_bytes(pickle.dumps({"intrinsicMat": np.eye(3)}))
    with pytest.raises(pantin.PantinError, match="distortion is missing"):
        pantin.Cameras.of_opencap(tmp_path)
    path.write_bytes(b"not a pickle")
    with pytest.raises(pantin.PantinError, match="is no calibration of OpenCap's"):
        pantin.Cameras.of_opencap(tmp_path)
    with pytest.raises(pantin.PantinError, match="cannot read"):
        pantin.Cameras.of_opencap({"a": tmp_path / "absent.pickle"})
