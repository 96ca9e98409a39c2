"""Scoring: the same integers as the program, from arrays of any kind."""

import csv
import os
import pathlib
import subprocess
import threading
import time

import numpy as np
import pytest

import pantin


def poses_round(body: pantin.Body, count: int, seed: int) -> np.ndarray:
    """Poses round the standing one, float32 [count, dofs]."""
    shaken = np.random.default_rng(seed).normal(size=(count, len(body.dofs))) * body.steps
    return (body.standing_pose() + 2.0 * shaken).astype(np.float32)


def seen_in(walk: pathlib.Path, frame: int) -> list:
    ((_, views),) = pantin.features(walk, frame)
    return [views[camera]["observation"] for camera in pantin.Cameras.of_sequence(walk).names]


@pytest.fixture(scope="module")
def body(walk):
    return pantin.Body.load(walk / "body.toml")


@pytest.fixture(scope="module")
def cameras(walk):
    return pantin.Cameras.of_sequence(walk)


def test_backends_count_the_same_pixels(walk, body, cameras):
    poses, seen = poses_round(body, 20, 1), seen_in(walk, 2)
    counted = pantin.score(body, cameras, seen, poses, backend="cpu")
    assert counted.shape == (20, len(cameras), len(pantin.COMPONENTS))
    assert counted.dtype == np.uint32
    np.testing.assert_array_equal(counted, pantin.score(body, cameras, seen, poses, backend="reference"))
    area, drawn, overlap, edges, proximity = np.moveaxis(counted, -1, 0)
    assert (area == [[(view >> 7).sum() for view in seen]]).all()
    assert drawn.min() > 100 and (overlap <= np.minimum(area, drawn)).all() and (proximity <= 127 * edges).all()


def test_the_program_says_the_same(walk, body, tmp_path):
    program = os.environ.get("PANTIN_PROGRAM")
    if program is None:
        pytest.skip("PANTIN_PROGRAM names no program to compare with")
    poses = poses_round(body, 7, 2)
    body.write_poses(tmp_path / "poses.csv", range(7), poses)
    frames, read = body.read_poses(tmp_path / "poses.csv")
    np.testing.assert_array_equal(frames, range(7))
    np.testing.assert_array_equal(read, poses)
    command = [program, "evaluate", "--sequence", walk, "--frame", "1", "--poses", tmp_path / "poses.csv", "-o", tmp_path / "out"]
    subprocess.run([*command, "--backend", "reference", "--objective", "ws"], check=True, capture_output=True)
    evaluator = pantin.Evaluator.of_frame(walk, 1, backend="cpu", objective="ws")
    with open(tmp_path / "out/components.csv", newline="") as file:
        rows = [[int(row[name]) for name in pantin.COMPONENTS] for row in csv.DictReader(file)]
    np.testing.assert_array_equal(evaluator.components(poses).reshape(-1, 5), rows)
    with open(tmp_path / "out/fitness.csv", newline="") as file:
        fitness = [np.float32(row["fitness"]) for row in csv.DictReader(file)]
    np.testing.assert_array_equal(evaluator.fitness(poses, "ws"), fitness)


def test_the_true_pose_is_the_best(walk, body):
    frames, truth = body.read_poses(walk / "truth_poses.csv")
    evaluator = pantin.Evaluator.of_frame(walk, int(frames[3]), objective="evidence")
    near = truth[3] + np.float32(0.3) * (poses_round(body, 200, 3) - body.standing_pose())
    assert evaluator.fitness(truth[3:4], "evidence") > evaluator.fitness(near, "evidence").max()


def test_arrays_of_other_kinds_are_converted(walk, body, cameras):
    evaluator = pantin.Evaluator(body, cameras, backend="cpu")
    evaluator.observe(seen_in(walk, 0))
    poses = poses_round(body, 6, 4)
    expected = evaluator.components(poses)
    for other in (poses.astype(np.float64), np.asfortranarray(poses), poses.tolist(), np.repeat(poses, 2, axis=0)[::2]):
        np.testing.assert_array_equal(evaluator.components(other), expected)
    assert evaluator.components(poses[:0]).shape == (0, len(cameras), 5)


@pytest.mark.parametrize(
    ("work", "sentence"),
    [
        (lambda e, b: e.components(np.zeros(31)), "poses have 1 dimensions, expected 2: [n, dofs]"),
        (lambda e, b: e.components(np.zeros((3, 30))), "poses are 3 x 30, expected 31 columns, one a degree of freedom of the body"),
        (lambda e, b: e.fitness(np.zeros((1, 31)), "spp"), "unknown objective `spp`, the nearest is `sp`"),
        (lambda e, b: e.fitness(np.zeros((1, 31)), "ws", w1=3.0), "w1 of the objective ws is 3, expected a weight from 0 to 1"),
        (lambda e, b: e.fitness(np.zeros((1, 31)), edges="all"), "unknown edge term `all`, the nearest is "),
        (lambda e, b: e.fitness(np.zeros((1, 31)), edges="segments"), "tells body parts apart, expected whole"),
        (lambda e, b: e.observe([np.zeros((2, 2), np.uint8)]), "expected"),
        (lambda e, b: e.drawn(np.zeros(3), 0), "the pose has 3 values, expected 31"),
        (lambda e, b: e.drawn(b.standing_pose(), 9), "there is no view 9, expected 0 to 3"),
        (lambda e, b: pantin.Body.load("nowhere.toml"), "cannot read nowhere.toml"),
        (lambda e, b: pantin.Body.adult(-3), "height"),
        (lambda e, b: pantin.Cameras.load("nowhere.toml"), "nowhere.toml"),
        (lambda e, b: b.write_poses("p.csv", [0], np.zeros((2, 31))), "1 frames were given for 2 poses, expected one a pose"),
        (lambda e, b: b.joint_positions(np.zeros((1, 3))), "poses are 1 x 3, expected 31 columns"),
    ],
)
def test_what_is_wrong_is_one_sentence(body, cameras, work, sentence):
    with pytest.raises(pantin.PantinError) as raised:
        work(pantin.Evaluator(body, cameras, backend="cpu"), body)
    assert sentence in str(raised.value)
    assert "\n" not in str(raised.value)


def test_a_backend_that_is_unknown_is_named(body, cameras):
    with pytest.raises(pantin.PantinError, match="unknown backend `cup`, the nearest is `cpu`"):
        pantin.Evaluator(body, cameras, backend="cup")


def test_a_mesh_is_drawn_by_cpu_as_by_the_reference(walk, body, cameras):
    _, truth = body.read_poses(walk / "truth_poses.csv")
    pictures = {
        (backend, model): pantin.Evaluator(body, cameras, backend=backend, model=model).drawn(truth[0], 1)
        for backend, model in [("cpu", "mesh"), ("reference", "mesh"), ("reference", "flat")]
    }
    assert np.array_equal(pictures["cpu", "mesh"], pictures["reference", "mesh"])
    assert not np.array_equal(pictures["cpu", "mesh"], pictures["reference", "flat"])


def test_pictures_show_the_pose(walk, body, cameras):
    evaluator = pantin.Evaluator(body, cameras, backend="reference")
    _, truth = body.read_poses(walk / "truth_poses.csv")
    picture = evaluator.drawn(truth[0], 1)
    width, height = cameras.sizes[1]
    assert picture.shape == (height, width)
    # The joints of the trunk lie on what is drawn.
    joints = body.joint_positions(truth[:1])[0]
    pixels = cameras.project(joints)[1]
    x, y = np.rint(pixels[body.joints.index("pelvis")]).astype(int)
    assert picture[y, x] & 127 > 0
    assert pantin.Evaluator(body, cameras, backend="cpu").drawn(truth[0], 1) is None


def test_other_threads_run_while_it_works(walk, body, cameras):
    evaluator = pantin.Evaluator(body, cameras, backend="cpu")
    evaluator.observe(seen_in(walk, 0))
    poses = poses_round(body, 20_000, 5)
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.perf_counter()
    evaluator.components(poses)
    end = time.perf_counter()
    done.set()
    thread.join()
    during = [tick for tick in ticks if begin < tick < end]
    assert len(during) > 5, f"{len(during)} ticks in {end - begin:.3f} s"


def test_points_behind_a_camera_have_no_image(cameras):
    pixels = cameras.project([[0.0, 0.0, 1000.0], [1e7, 1e7, -1e7]])
    assert pixels.shape == (len(cameras), 2, 2)
    assert np.isfinite(pixels[:, 0]).all() and np.isnan(pixels[:, 1]).any()
    half = cameras.scaled([(width // 2, height // 2) for width, height in cameras.sizes])
    np.testing.assert_allclose((half.project([[0, 0, 1000]]) + 0.5) * 2, cameras.project([[0, 0, 1000]]) + 0.5, atol=1e-6)
