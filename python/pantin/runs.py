"""What the program's commands do, as functions.

Options have the names that they have on the command line, with `_` for `-` (`overlay_every=10` is `--overlay-every 10`); `True` gives
one, `False` and `None` do not. `pantin COMMAND --help` and docs/CHOICES.md list them; an unknown one is an error that names the nearest.
"""

from __future__ import annotations

import csv
import json
import os
import pathlib
import tempfile
from dataclasses import dataclass, field
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import _pantin
from .body import Body, Path


class Step(NamedTuple):
    """A step of long work, as `progress` is told of it."""

    #: Units done, frames mostly.
    done: int
    #: Units in all; None where that is not known.
    total: Optional[int]
    #: What is being done: `begin`, `frames`, `second pass`.
    stage: str
    #: Of tracking: the frame that was done.
    frame: Optional[int] = None
    #: Of tracking: the fitness of its pose, 0 to 1.
    fitness: Optional[float] = None
    #: Of tracking: its confidence, 0 to 1.
    confidence: Optional[float] = None


Progress = Callable[[Step], Any]


@dataclass(frozen=True)
class Track:
    """A tracked person."""

    #: The folder that holds poses.csv, joints.csv, joints.trc, markers.c3d, motion.bvh, confidence.csv, report.html and more.
    folder: pathlib.Path
    #: Which backend scored the poses.
    backend: str
    #: Frames tracked.
    frames: int
    #: The first of them.
    first_frame: int
    #: Frames a second.
    frames_per_second: float
    #: Mean fitness of the poses, 0 to 1.
    mean_fitness: float
    #: Mean confidence, 0 to 1.
    mean_confidence: float
    #: Mean error against the truth and its standard deviation, mm, where the sequence names one.
    mean_error: Optional[float]
    std_error: Optional[float]
    #: Mean time of each stage of a frame, ms.
    stage_ms: Dict[str, float] = field(repr=False)
    #: Sentences that a user should read.
    warnings: List[str] = field(repr=False)

    def poses(self, body: Body) -> Tuple[NDArray[np.int64], NDArray[np.float32]]:
        """Frames, int64 [n], and poses, float32 [n, dofs], mm and radians."""
        return body.read_poses(self.folder / "poses.csv")

    def joints(self) -> Tuple[NDArray[np.float64], Dict[str, NDArray[np.float64]]]:
        """Times, float64 [n], s, and each joint's positions, float64 [n, 3], mm; not a number in frames in which the person is
        lost."""
        columns = _columns(self.folder / "joints.csv")
        times = columns["time"]
        names = [column[:-2] for column in columns if column.endswith(".x")]
        stacked = {name: np.stack([columns[f"{name}.{axis}"] for axis in "xyz"], axis=-1) for name in names}
        return times, stacked

    def confidence(self) -> Dict[str, NDArray[np.float64]]:
        """The columns of confidence.csv, each float64 [n]."""
        return _columns(self.folder / "confidence.csv")


@dataclass(frozen=True)
class Fit:
    """A measured person."""

    #: The body.
    body: Body
    #: The height that it was scaled to, mm; None where the body was kept.
    height: Optional[float]
    #: The frames that were used, int64 [n].
    frames: NDArray[np.int64]
    #: The person's poses in them, float32 [n, dofs].
    poses: NDArray[np.float32]
    #: Mean fitness of the poses.
    fitness: float
    #: By view, first and fitted: shares of the seen silhouette that the model covers, and of the model's that was seen.
    coverage: Dict[str, Tuple[Tuple[float, float], Tuple[float, float]]]


def track(
    sequence: Path,
    output: Path,
    *,
    progress: Optional[Progress] = None,
    **options: Any,
) -> Union[Track, Dict[str, Track]]:
    """Tracks a person through a sequence (`pantin track`), into the folder `output`. Of a sequence that names several people it returns
    each one's track by name.

    `progress` is called with a `Step` after every frame. What it raises, and Ctrl-C, stop the run after the frame in work; it goes on
    with `resume=True`, to the same files as a run that was not stopped.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     walk = synth(f"{folder}/walk", preset="demo", frames=3)
    ...     steps = []
    ...     tracked = track(walk, f"{folder}/out", backend="cpu", particles=50, iterations=5, progress=steps.append)
    ...     times, joints = tracked.joints()
    >>> tracked.frames, joints["head_top"].shape, [step.done for step in steps if step.stage == "frames"]
    (3, (3, 3), [1, 2, 3])
    """
    given = _options({"sequence": sequence, "output": output, **options})
    tracked = _pantin.track(given, _told(progress))
    tracks = {pathlib.Path(folder): Track(folder=pathlib.Path(folder), **summary) for folder, summary in tracked}
    alone = tracks.get(pathlib.Path(output))
    return alone if alone is not None else {folder.name: track for folder, track in tracks.items()}


def fit(sequence: Path, output: Optional[Path] = None, **options: Any) -> Fit:
    """Measures the person in a sequence (`pantin fit`): a body's proportions and poses, from silhouettes. The body is written to
    `output`, the poses to `start_out`, where these are given. Ctrl-C leaves it: it ends by itself, and its result is dropped."""
    with tempfile.TemporaryDirectory() as folder:
        # Without a file to write the command would keep the sequence's own body.
        body = pathlib.Path(folder, "body.toml") if output is None else output
        measured = _pantin.fit(_options({"sequence": sequence, "output": body, **options}))
    return Fit(body=Body(measured.pop("body")), **measured)


def check(sequence: Path, **options: Any) -> Dict[str, Any]:
    """Is a sequence sane (`pantin check`)? A dict: `sane`, whether no check failed; `checks`, a list with each check's name, number,
    limit, what was found and what to do; `frames`, those looked at."""
    return json.loads(_pantin.check(_options({"sequence": sequence, **options})))


def synth(
    output: Path,
    scene: Optional[Path] = None,
    *,
    progress: Optional[Progress] = None,
    **options: Any,
) -> pathlib.Path:
    """Makes a synthetic sequence with exact truth (`pantin synth`) from a scene.toml, `preset="demo"` or another built-in scene, or
    `lottery=SEED`, and returns its folder, which `track` takes.

    `progress` is called with a `Step` after every frame; what it raises, and Ctrl-C, break the work off. `resume=True` goes on."""
    return pathlib.Path(_pantin.synth(_options({"output": output, "scene": scene, **options}), _told(progress)))


def features(sequence: Path, frames: Union[str, int, range] = "..") -> Iterator[Tuple[int, Dict[str, Dict[str, NDArray[Any]]]]]:
    """What the tracker sees of a sequence: an iterator over (frame, {camera: {stage: picture}}).

    `frames` is one frame, a range, or `"A..B"` without B. Pictures are uint8 or uint16 [height, width], or [height, width, 3] of
    colours; the stages are `input`, `foreground`, `silhouette`, `edges`, `distance`, `proximity`, `observation` (packed, as
    `Evaluator.observe` takes it), `region`, and `segments` where body parts are told apart."""
    native = _pantin.Features(os.fspath(sequence), _frames(frames))
    while True:
        frame = native.next()
        if frame is None:
            return
        yield frame


def texture(material: Optional[str] = None, **options: Any) -> NDArray[Any]:
    """A procedural material, a texture after one example or several (`example=`), or without either a sheet of all materials (`pantin texture`):
    uint8 or uint16 [height, width, 3], or [height, width] of a `height_map`. `size` is (width, height); with `output` the picture is
    written too.

    >>> texture("marble", size=(64, 32), seed=1).shape
    (32, 64, 3)
    >>> texture("marbel")
    Traceback (most recent call last):
        ...
    pantin.PantinError: unknown material `marbel`, the nearest is `marble` (known: ...
    """
    if material is None and options.get("example") is None:
        options["list"] = True
    return _pantin.texture(_options({"material": material, **options}))


def _told(progress: Optional[Progress]) -> Optional[Callable[..., Any]]:
    return None if progress is None else lambda *step: progress(Step(*step))


def _frames(frames: Union[str, int, range]) -> str:
    if isinstance(frames, range):
        if frames.step != 1:
            raise _pantin.PantinError(f"frames are {frames}, expected a range without steps")
        return f"{frames.start}..{frames.stop}"
    return f"{frames}..{frames + 1}" if isinstance(frames, int) else frames


#: Options that are pairs or more numbers, and what stands between them on the command line.
_JOINED = {"size": "x", "offset": ",", "patch": "x"}


def _options(options: Dict[str, Any]) -> List[Tuple[str, Any]]:
    """Options as the engine takes them."""
    given: List[Tuple[str, Any]] = []
    for name, value in options.items():
        if value is None:
            continue
        if isinstance(value, (bool, np.bool_)):
            given.append((name, bool(value)))
        elif isinstance(value, range):
            given.append((name, _frames(value)))
        elif isinstance(value, (list, tuple)):
            texts = [_text(each) for each in value]
            given.append((name, _JOINED[name].join(texts) if name in _JOINED else texts))
        else:
            given.append((name, _text(value)))
    return given


def _text(value: Any) -> str:
    return os.fspath(value) if isinstance(value, os.PathLike) else str(value)


def _columns(path: pathlib.Path) -> Dict[str, NDArray[np.float64]]:
    """The columns of a table; empty cells are not a number, words too."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    values = np.full((len(rows) - 1, len(rows[0])), np.nan)
    for index, row in enumerate(rows[1:]):
        for column, cell in enumerate(row):
            try:
                values[index, column] = float(cell)
            except ValueError:
                continue
    return {name: values[:, column] for column, name in enumerate(rows[0])}
