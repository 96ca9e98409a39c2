"""Scoring poses against what the cameras saw."""

from __future__ import annotations

import os
from typing import Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _pantin
from .body import Body, Cameras, Path, _rows

#: What the last axis of `Evaluator.components` counts, in pixels; `proximity` is a sum of 0 to 127 a pixel.
COMPONENTS = ("area_obs", "area_model", "overlap", "edges", "proximity")


class Evaluator:
    """Draws poses into every camera and compares them with what was observed there.

    It keeps its workers, or its buffers on the device, over as many batches and frames as there are. Backends give the same integers:
    `cpu`, `compute` and `graphics` (on a Vulkan device), `reference` (simple and slow), or `auto`, the fastest one here. While it works
    other Python threads run; a second thread that asks the same evaluator waits.

    >>> import numpy as np
    >>> from pantin import Body, Evaluator, PantinError
    >>> body = Body.adult(1750)
    >>> evaluator = Evaluator(body, demo_cameras(), backend="cpu")
    >>> evaluator.observe([np.zeros((270, 480), np.uint8)] * len(demo_cameras()))
    >>> components = evaluator.components([body.standing_pose()])
    >>> components.shape, components.dtype.name
    ((1, 4, 5), 'uint32')
    >>> evaluator.components(np.zeros((2, 7)))
    Traceback (most recent call last):
        ...
    pantin.PantinError: poses are 2 x 7, expected 31 columns, one a degree of freedom of the body
    """

    def __init__(self, body: Body, cameras: Cameras, *, backend: str = "auto", model: str = "flat") -> None:
        self._native = _pantin.Evaluator(body._native, cameras._native, backend, model)

    @classmethod
    def of_frame(
        cls,
        sequence: Path,
        frame: int,
        *,
        backend: str = "auto",
        model: str = "flat",
        objective: str = "sp",
    ) -> "Evaluator":
        """An evaluator that has observed one frame of a sequence, with the sequence's body, cameras and settings of features; with
        evidence where the objective weighs it."""
        evaluator = cls.__new__(cls)
        evaluator._native = _pantin.Evaluator.of_frame(os.fspath(sequence), frame, backend, model, objective)
        return evaluator

    @property
    def backend(self) -> str:
        """The backend's name."""
        return self._native.backend

    @property
    def variant(self) -> str:
        """How it does it: `avx512`, `avx2`, `portable`, …"""
        return self._native.variant

    @property
    def reason(self) -> str:
        """Why this backend, in one sentence."""
        return self._native.reason

    def observe(self, observations: Sequence[ArrayLike]) -> None:
        """Takes what was seen in a frame, one uint8 array [height, width] a camera in their order: bit 7 the silhouette, bits 0 to 6
        the proximity of edges, 127 on one. These are the `observation` pictures of `features`."""
        self._native.observe([np.ascontiguousarray(seen, np.uint8) for seen in observations])

    def components(self, poses: ArrayLike) -> NDArray[np.uint32]:
        """What the comparison of every pose [n, dofs] counts in every view: uint32 [n, views, 5], the last axis as `COMPONENTS`
        says. Poses that are float32 and contiguous are not copied."""
        return self._native.components(_rows(poses))

    def fitness(
        self,
        poses: ArrayLike,
        objective: str = "sp",
        *,
        beta: Optional[float] = None,
        w1: Optional[float] = None,
        w2: Optional[float] = None,
        edges: Optional[str] = None,
    ) -> NDArray[np.float32]:
        """The fitness of every pose [n, dofs]: float32 [n], 0 to 1, the larger the better. `beta` is the share of "observed
        silhouette covered", `w1` and `w2` weigh silhouette and edges, and `edges` says whether these are `whole` (the default) or
        weighed by `segments`."""
        return self._native.fitness(_rows(poses), objective, [beta, w1, w2], edges)

    def drawn(self, pose: ArrayLike, view: int) -> Optional[NDArray[np.uint8]]:
        """A pose [dofs] as it is drawn in a view: uint8 [height, width], bits 0 to 6 the label of the part that is seen, bit 7 an
        edge. None with a backend that keeps no pictures (`cpu`, `compute`)."""
        return self._native.drawn(np.ascontiguousarray(pose, np.float32), view)

    def __repr__(self) -> str:
        return f"<Evaluator {self.backend} ({self.variant}), {self._native.view_count} views>"


def score(
    body: Body,
    cameras: Cameras,
    observations: Sequence[ArrayLike],
    poses: ArrayLike,
    *,
    backend: str = "auto",
    model: str = "flat",
) -> NDArray[np.uint32]:
    """`Evaluator.components` in one call: poses [n, dofs] against observations, one uint8 array [height, width] a camera; uint32
    [n, views, 5]."""
    evaluator = Evaluator(body, cameras, backend=backend, model=model)
    evaluator.observe(observations)
    return evaluator.components(poses)
