"""OpenCap's calibrations: a pickle a camera, in the frame of a checkerboard."""

import os
import pathlib
import pickle
from typing import Any, Dict, List, Mapping, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from ._pantin import PantinError

FILE = "cameraIntrinsicsExtrinsics.pickle"
AXES: Dict[str, List[float]] = {
    "x": [1, 0, 0], "-x": [-1, 0, 0], "y": [0, 1, 0], "-y": [0, -1, 0], "z": [0, 0, 1], "-z": [0, 0, -1],
}


class _Arrays(pickle.Unpickler):
    """Reads arrays and plain values. Any other pickle could run whatever it likes."""

    allowed = {
        ("numpy", "ndarray"), ("numpy", "dtype"), ("_codecs", "encode"),
        ("numpy.core.multiarray", "_reconstruct"), ("numpy._core.multiarray", "_reconstruct"),
        ("numpy.core.multiarray", "scalar"), ("numpy._core.multiarray", "scalar"),
        ("numpy._core.numeric", "_frombuffer"), ("numpy.core.numeric", "_frombuffer"),
    }

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) not in self.allowed:
            raise pickle.UnpicklingError(f"it holds {module}.{name}")
        return super().find_class(module, name)


def files(source: Union[str, "os.PathLike[str]", Mapping[str, "os.PathLike[str]"]]) -> Dict[str, pathlib.Path]:
    """The pickles by the names of their cameras."""
    if isinstance(source, Mapping):
        return {name: pathlib.Path(path) for name, path in source.items()}
    folder = pathlib.Path(source)
    found = sorted(folder.glob(f"Videos/*/{FILE}")) or sorted(folder.glob(f"*/{FILE}"))
    if not found:
        raise PantinError(f"{folder} holds no {FILE} in Videos/Cam0 and so on, expected a session of OpenCap's")
    return {path.parent.name: path for path in found}


def read(path: pathlib.Path) -> Dict[str, NDArray[np.float64]]:
    """Camera matrix, distortion, rotation, translation (mm) and size (width, height) of a pickle."""
    try:
        with open(path, "rb") as file:
            held = _Arrays(file).load()
    except OSError as error:
        raise PantinError(f"cannot read {path}: {error.strerror}") from error
    except Exception as error:  # Whatever a damaged pickle makes of it.
        raise PantinError(f"{path} is no calibration of OpenCap's: {error}") from error
    shapes = {"intrinsicMat": (9,), "distortion": (4, 5, 8, 12, 14), "rotation": (9,), "translation": (3,), "imageSize": (2,)}
    values: Dict[str, NDArray[np.float64]] = {}
    for key, sizes in shapes.items():
        if not isinstance(held, dict) or key not in held:
            raise PantinError(f"{path}: {key} is missing, expected a calibration with extrinsics, as OpenCap keeps it")
        try:
            value = np.asarray(held[key], np.float64).ravel()
        except (TypeError, ValueError):
            value = np.empty(0)
        if value.size not in sizes:
            raise PantinError(f"{path}: {key} holds {value.size} numbers, expected {' or '.join(map(str, sizes))}")
        values[key] = value
    # OpenCap writes height before width, other programs that write its pickles do not: the principal point is near the middle.
    centre = values["intrinsicMat"][[2, 5]]
    orders = [values["imageSize"][::-1], values["imageSize"]]
    values["imageSize"] = min(orders, key=lambda size: float(np.abs(centre - 0.5 * size).max()))
    return values


def upright(
    rotations: NDArray[np.float64], translations: NDArray[np.float64], up: Union[str, None], origin_height: float
) -> Tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The same cameras in a world whose z is the board's axis `up`; without one that nearest to the pictures' mean upward
    direction. The board's origin is `origin_height` mm above the floor."""
    if up is None:
        upward = -rotations[:, 1, :].mean(axis=0)
        up = max(AXES, key=lambda name: float(np.dot(upward, AXES[name])))
    if up not in AXES:
        raise PantinError(f"up is {up!r}, expected one of {', '.join(AXES)}")
    z = np.array(AXES[up], np.float64)
    x = np.array([1.0, 0.0, 0.0]) if abs(z[0]) < 0.5 else np.array([0.0, 1.0, 0.0])
    board_from_world = np.column_stack([x, np.cross(z, x), z])
    turned = rotations @ board_from_world
    return turned, translations - turned @ np.array([0.0, 0.0, origin_height])
