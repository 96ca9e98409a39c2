"""The program's commands as functions."""

import os
import pathlib
import signal
import subprocess
import sys
import textwrap

import numpy as np
import pytest

import pantin

QUICK = {"backend": "cpu", "particles": 40, "iterations": 4, "search": "pso", "seed": 3}


def same_files(left: pathlib.Path, right: pathlib.Path) -> None:
    for name in ("poses.csv", "joints.csv", "joints.trc", "confidence.csv", "motion.bvh"):
        assert (left / name).read_bytes() == (right / name).read_bytes(), name


def test_tracking_gives_what_the_program_gives(walk, tmp_path):
    steps = []
    tracked = pantin.track(walk, tmp_path / "here", progress=steps.append, overlay_every=0, **QUICK)
    assert [step.done for step in steps if step.stage == "frames"] == [1, 2, 3, 4]
    assert steps[0].stage == "begin" and steps[-1].total == 4
    assert all(0 < step.fitness <= 1 for step in steps if step.stage == "frames")
    assert tracked.frames == 4 and 0 < tracked.mean_error < 150 and tracked.backend.startswith("cpu ")
    body = pantin.Body.load(walk / "body.toml")
    frames, poses = tracked.poses(body)
    times, joints = tracked.joints()
    np.testing.assert_array_equal(frames, range(4))
    np.testing.assert_allclose(times, np.arange(4) / 25)
    computed = body.joint_positions(poses)
    for index, name in enumerate(body.joints):
        np.testing.assert_allclose(joints[name], computed[:, index], atol=0.01)
    assert len(tracked.confidence()["confidence"]) == 4
    program = os.environ.get("PANTIN_PROGRAM")
    if program is not None:
        options = [word for name, value in QUICK.items() for word in (f"--{name}", str(value))]
        command = [program, "track", walk, "-o", tmp_path / "there", "--overlay-every", "0", *options]
        subprocess.run(command, check=True, capture_output=True)
        same_files(tmp_path / "here", tmp_path / "there")


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"particels": 7}, "unknown option of track `particels`, the nearest is `particles` (known: sequence, output,"),
        ({"particles": "many"}, "track: invalid value 'many' for '--particles <N>': invalid digit found in string"),
        ({"search": "psso"}, "unknown search `psso`, the nearest is `pso`"),
        ({"trace": 3}, "option `trace` of track is"),
        ({"frames": range(2, 9)}, "frames 2..9 reach past the end of"),
    ],
)
def test_wrong_options_are_one_sentence(walk, tmp_path, options, sentence):
    with pytest.raises(pantin.PantinError) as raised:
        pantin.track(walk, tmp_path / "out", **{"backend": "cpu", **options})
    assert sentence in str(raised.value)
    assert "\n" not in str(raised.value)


def test_errors_are_the_program_s(walk, tmp_path):
    program = os.environ.get("PANTIN_PROGRAM")
    if program is None:
        pytest.skip("PANTIN_PROGRAM names no program to compare with")
    (tmp_path / "sequence.toml").write_text("name = 'walk'\nfsp = 25\n")
    with pytest.raises(pantin.PantinError) as raised:
        pantin.track(tmp_path, tmp_path / "out")
    said = subprocess.run([program, "track", tmp_path, "-o", tmp_path / "out"], capture_output=True, text=True)
    assert said.returncode == 1
    assert said.stderr.strip() == f"pantin: {raised.value}"


@pytest.mark.parametrize("stage", ["frames", "second pass"])
def test_what_progress_raises_stops_and_a_run_goes_on(walk, tmp_path, stage):
    class Enough(Exception):
        pass

    def progress(step):
        if step.stage == stage and step.done == 2:
            raise Enough("two are enough")

    settings = {**QUICK, "overlay_every": 0, "passes": "both"}
    with pytest.raises(Enough, match="two are enough"):
        pantin.track(walk, tmp_path / "out", progress=progress, **settings)
    assert not (tmp_path / "out/report.html").exists()
    resumed = pantin.track(walk, tmp_path / "out", resume=True, **settings)
    assert resumed.frames == 4
    pantin.track(walk, tmp_path / "whole", **settings)
    same_files(tmp_path / "out", tmp_path / "whole")


def test_ctrl_c_ends_a_run_that_can_go_on(walk, tmp_path):
    script = f"""
        import pantin, sys
        try:
            pantin.track({str(walk)!r}, {str(tmp_path / "out")!r}, backend="cpu", particles=3000, iterations=100,
                         progress=lambda step: print(step.stage, flush=True))
        except KeyboardInterrupt:
            sys.exit(33)
    """
    process = subprocess.Popen([sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begin\n"
    assert process.stdout.readline() == "frames\n"
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=120) == 33
    assert any((tmp_path / "out").iterdir()) and not (tmp_path / "out/report.html").exists()


def test_ctrl_c_leaves_what_cannot_be_stopped(walk):
    script = f"""
        import pantin, signal, sys, threading, time
        threading.Timer(0.3, signal.raise_signal, [signal.SIGINT]).start()
        begin = time.monotonic()
        try:
            pantin.fit({str(walk)!r}, height=1750, particles=20000, iterations=100)
        except KeyboardInterrupt:
            print(time.monotonic() - begin, flush=True)
            import os
            os._exit(34)
    """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 34, done.stderr
    assert float(done.stdout) < 3


def test_a_person_is_measured(walk, tmp_path):
    found = pantin.fit(walk, tmp_path / "body.toml", height=1750, particles=60, iterations=8, start_out=tmp_path / "start.csv")
    assert found.height == 1750 and found.poses.shape == (1, 31) and found.frames.tolist() == [0]
    assert set(found.coverage) == set(pantin.Cameras.of_sequence(walk).names)
    saved = pantin.Body.load(tmp_path / "body.toml")
    assert saved.joints == found.body.joints
    _, start = saved.read_poses(tmp_path / "start.csv")
    np.testing.assert_array_equal(start, found.poses)


def test_a_sequence_is_checked(walk):
    report = pantin.check(walk, samples=2)
    assert report["checks"] and {"check", "status", "advice"} <= set(report["checks"][0])
    assert isinstance(report["sane"], bool)


def test_features_come_frame_by_frame(walk):
    frames = list(pantin.features(walk, range(1, 3)))
    assert [frame for frame, _ in frames] == [1, 2]
    _, views = frames[0]
    for stages in views.values():
        silhouette, packed = stages["silhouette"], stages["observation"]
        np.testing.assert_array_equal(silhouette > 0, packed >> 7 > 0)
        assert stages["input"].shape == (*silhouette.shape, 3)
        assert 500 < (silhouette > 0).sum() < silhouette.size / 3
    with pytest.raises(pantin.PantinError, match="frame"):
        next(pantin.features(walk, "7..9"))


def test_a_sequence_is_made_with_progress(tmp_path):
    steps = []
    made = pantin.synth(tmp_path / "walk", preset="demo", frames=2, progress=steps.append)
    assert (made / "sequence.toml").exists()
    assert sorted(step.done for step in steps) == [1, 2] and steps[0].total == 2

    def enough(step):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        pantin.synth(tmp_path / "other", preset="demo", frames=200, progress=enough)
    assert not (tmp_path / "other/sequence.toml").exists()
    with pytest.raises(pantin.PantinError, match="unknown"):
        pantin.synth(tmp_path / "third", preset="dmeo")


def test_textures_are_arrays(tmp_path):
    marble = pantin.texture("marble", size=(48, 32), seed=2, output=tmp_path / "marble.png")
    assert marble.shape == (32, 48, 3) and marble.dtype == np.uint8 and marble.std() > 5
    assert (tmp_path / "marble.png").exists()
    assert pantin.texture("marble", size=(8, 8), depth=16).dtype == np.uint16
    assert pantin.texture("marble", size=(8, 8), height_map=True).shape == (8, 8)
    moved = pantin.texture("marble", size=(48, 32), seed=2, offset=(1, 0))
    assert (moved != marble).any()
    again = pantin.texture(example=tmp_path / "marble.png", size=(24, 24), patch=8, overlap=3, seed=1)
    assert again.shape == (24, 24, 3)
    two = [tmp_path / "marble.png", tmp_path / "marble.png"]
    assert pantin.texture(example=two, size=(24, 20), patch=(8, 4), overlap=3, seed=1).shape == (20, 24, 3)
