"""Bodies and cameras."""

from __future__ import annotations

import json
import os
from typing import List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _pantin, opencap

Path = Union[str, "os.PathLike[str]"]


class Body:
    """A jointed body: bones with degrees of freedom, and the parts that are drawn.

    A pose is a row of one value a degree of freedom, in the order of `dofs`: mm for those whose name ends in `.tx`, `.ty` or `.tz`,
    radians for the others. Files hold degrees.

    >>> body = Body.adult(1750)
    >>> len(body.dofs), body.dofs[:3]
    (31, ['pelvis.tx', 'pelvis.ty', 'pelvis.tz'])
    """

    def __init__(self, native: _pantin.Body) -> None:
        self._native = native

    @classmethod
    def load(cls, path: Path) -> "Body":
        """Reads a body.toml."""
        return cls(_pantin.Body.load(os.fspath(path)))

    @classmethod
    def adult(cls, height: float) -> "Body":
        """An adult of average proportions, `height` in mm."""
        return cls(_pantin.Body.adult(height))

    @property
    def name(self) -> str:
        """Its name."""
        return self._native.name

    @property
    def dofs(self) -> List[str]:
        """Names of the degrees of freedom, in the order of a pose: `<bone>.<tx, ty, tz, rx, ry or rz>`."""
        return self._native.dofs

    @property
    def joints(self) -> List[str]:
        """Names of the joints: every bone's origin, then the free ends."""
        return self._native.joints

    @property
    def limits(self) -> NDArray[np.float64]:
        """Smallest and largest value of each degree of freedom: float64 [dofs, 2], mm and radians."""
        return self._native.limits()

    @property
    def steps(self) -> NDArray[np.float64]:
        """How far each degree of freedom usually moves from one frame to the next: float64 [dofs], mm and radians."""
        return self._native.steps()

    def standing_pose(self) -> NDArray[np.float32]:
        """Standing on the floor at the world's origin with the arms down: float32 [dofs]."""
        return self._native.standing_pose()

    def joint_positions(self, poses: ArrayLike) -> NDArray[np.float64]:
        """Where the joints are in poses [n, dofs]: float64 [n, joints, 3], mm, in the world.

        >>> body = Body.adult(1750)
        >>> head = body.joints.index("head_top")
        >>> positions = body.joint_positions([body.standing_pose()])
        >>> positions.shape, round(float(positions[0, head, 2]), -1)
        ((1, 20, 3), 1750.0)
        """
        return self._native.joint_positions(_rows(poses))

    def read_poses(self, path: Path) -> Tuple[NDArray[np.int64], NDArray[np.float32]]:
        """Reads a poses.csv: frames, int64 [n], and poses, float32 [n, dofs]."""
        return self._native.read_poses(os.fspath(path))

    def write_poses(self, path: Path, frames: ArrayLike, poses: ArrayLike, *, force: bool = False) -> None:
        """Writes a poses.csv, as one that `track` and `evaluate` read; with `force` over a file that is there."""
        self._native.write_poses(os.fspath(path), np.ascontiguousarray(frames, np.uint64), _rows(poses), force)

    def to_toml(self) -> str:
        """The body as the text of a body.toml."""
        return self._native.to_toml()

    def save(self, path: Path, *, force: bool = False) -> None:
        """Writes a body.toml; with `force` over a file that is there."""
        self._native.save(os.fspath(path), force)

    def __repr__(self) -> str:
        return f"<Body {self.name!r} of {len(self.dofs)} degrees of freedom>"


class Cameras:
    """Calibrated cameras, in the order of their file."""

    def __init__(self, native: _pantin.Cameras) -> None:
        self._native = native

    @classmethod
    def load(cls, path: Path) -> "Cameras":
        """Reads a calibration in any of the formats that the program reads: cameras.toml, .qca.txt, .xcp, OpenCV's YAML and XML,
        EasyMocap's pair, a folder with a file a camera."""
        return cls(_pantin.Cameras.load(os.fspath(path)))

    @classmethod
    def of_arrays(
        cls,
        names: Sequence[str],
        sizes: ArrayLike,
        matrices: ArrayLike,
        distortions: ArrayLike,
        rotations: ArrayLike,
        translations: ArrayLike,
    ) -> "Cameras":
        """Cameras as OpenCV has them: picture sizes [n, 2] (width, height), camera matrices [n, 3, 3], distortions [n, 4 or 5]
        (k1, k2, p1, p2, k3), rotations camera from world [n, 3, 3] or Rodrigues vectors [n, 3], translations [n, 3], mm.

        >>> cameras = Cameras.of_arrays(
        ...     ["front"], [[640, 480]], [[[800, 0, 320], [0, 800, 240], [0, 0, 1]]], [[0, 0, 0, 0]], [[0, 0, 0]], [[0, 0, 3000]])
        >>> cameras.project([[0, 0, 0]]).tolist()
        [[[320.0, 240.0]]]
        """
        if len(names) == 0:
            raise _pantin.PantinError("no camera was given, expected at least one")
        for at, name in enumerate(names):
            if name in names[:at]:
                raise _pantin.PantinError(f"two cameras are named `{name}`, expected a name of its own for each")
        parts = {"K": matrices, "D": distortions, "image_size": sizes, "R": rotations, "T": translations}
        rows = {key: np.asarray(value, np.float64) for key, value in parts.items()}
        for key, value in rows.items():
            if value.ndim < 2 or len(value) != len(names):
                found = " x ".join(map(str, value.shape))
                raise _pantin.PantinError(f"{key} of {len(names)} cameras has the shape {found}, expected an array a camera")
        texts = [
            json.dumps({"camera_name": name, "units": "mm", **{key: value[at].tolist() for key, value in rows.items()}})
            for at, name in enumerate(names)
        ]
        return cls(_pantin.Cameras.of_texts(texts))

    @classmethod
    def of_opencap(
        cls,
        session: Union[Path, Mapping[str, Path]],
        up: Optional[str] = None,
        origin_height: float = 0.0,
    ) -> "Cameras":
        """OpenCap's cameras: a session's folder (`Videos/Cam0/cameraIntrinsicsExtrinsics.pickle` …) or pickles by camera.

        OpenCap's world is its checkerboard. Here z is the axis of the board that points up: `up`, "-y" say, or without it the one
        nearest to the mean upward direction of the pictures. The board's origin is `origin_height` mm above the floor. Pickles
        that hold anything but arrays and plain values are refused: they could run programs."""
        cameras = {name: opencap.read(path) for name, path in opencap.files(session).items()}
        columns = {key: np.array([camera[key] for camera in cameras.values()]) for key in ("rotation", "translation")}
        rotations, translations = opencap.upright(
            columns["rotation"].reshape(-1, 3, 3), columns["translation"], up, origin_height
        )
        matrices = [camera["intrinsicMat"].reshape(3, 3) for camera in cameras.values()]
        sizes = [camera["imageSize"] for camera in cameras.values()]
        distortions = [camera["distortion"] for camera in cameras.values()]
        return cls.of_arrays(list(cameras), sizes, matrices, distortions, rotations, translations)

    def save(self, path: Path, force: bool = False) -> None:
        """Writes them as cameras.toml, mm; replaces a file with `force` alone."""
        self._native.save(os.fspath(path), force)

    @classmethod
    def of_sequence(cls, sequence: Path) -> "Cameras":
        """The cameras of a sequence's views, in their order and at the size that the sequence is worked on in."""
        return cls(_pantin.Cameras.of_sequence(os.fspath(sequence)))

    @property
    def names(self) -> List[str]:
        """Their names."""
        return self._native.names

    @property
    def sizes(self) -> List[Tuple[int, int]]:
        """Width and height of each one's pictures, pixels."""
        return self._native.sizes

    def scaled(self, sizes: Sequence[Tuple[int, int]]) -> "Cameras":
        """The same cameras with pictures of these widths and heights, pixels."""
        return Cameras(self._native.scaled(list(sizes)))

    def project(self, points: ArrayLike) -> NDArray[np.float64]:
        """Where the cameras see points [n, 3] of the world, mm: float64 [cameras, n, 2], pixels, x to the right and y down; not a number
        where a camera has no image of a point."""
        return self._native.project(np.ascontiguousarray(points, np.float64).reshape(-1, np.shape(points)[-1]))

    def __len__(self) -> int:
        return len(self.names)

    def __repr__(self) -> str:
        return f"<Cameras {', '.join(self.names)}>"


def _rows(poses: ArrayLike) -> NDArray[np.float32]:
    """Poses as the engine takes them; not copied where they are so already."""
    rows = np.ascontiguousarray(poses, np.float32)
    if rows.ndim != 2:
        raise _pantin.PantinError(f"poses have {rows.ndim} dimensions, expected 2: [n, dofs]")
    return rows
