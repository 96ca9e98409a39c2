"""Markerless 3D human motion from a few calibrated cameras.

For every video frame hundreds of poses of a jointed body are drawn into every camera and compared with the silhouette and the edges
that the camera saw. This package is the engine itself, with its arrays:

- `Body`, `Cameras`, `Evaluator`, `score`: poses in, counts of pixels and fitness out;
- `track`, `fit`, `check`, `synth`, `features`, `texture`: what the program's commands do, with the program's options.

Lengths are millimetres, angles radians, pixels counted from the centre of the top-left one. The world is right-handed with z up. What
goes wrong is raised as `PantinError`, with one sentence.
"""

from ._pantin import PantinError, __version__
from .body import Body, Cameras
from .evaluator import COMPONENTS, Evaluator, score
from .runs import Fit, Step, Track, check, features, fit, synth, texture, track

__all__ = [
    "COMPONENTS",
    "Body",
    "Cameras",
    "Evaluator",
    "Fit",
    "PantinError",
    "Step",
    "Track",
    "__version__",
    "check",
    "features",
    "fit",
    "score",
    "synth",
    "texture",
    "track",
]
