"""Batches over Ray: the bits of one machine, in order, whatever dies."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import d2m_ccd
import numpy as np
import pytest
from conftest import random_motions

ray = pytest.importorskip("ray")


@pytest.fixture(scope="module", autouse=True)
def cluster() -> Iterator[None]:
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    yield
    ray.shutdown()


def trials(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree], count: int) -> tuple[np.ndarray, np.ndarray]:
    distance = 1.5 * (knots[0].radius + knots[1].radius)
    return random_motions(count, 21, distance), random_motions(count, 22, 0.1 * distance)


def test_the_bits_of_one_machine(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree]) -> None:
    import d2m_ccd.ray

    rows = trials(knots, 3000)
    done: list[int] = []
    results = d2m_ccd.ray.batch(*knots, *rows, progress=lambda now, total: done.append(now), tolerance=1e-9)
    assert results.tobytes() == d2m_ccd.batch(*knots, *rows, tolerance=1e-9).tobytes()
    assert done == sorted(done) and done[-1] == 3000 and len(done) > 3


def test_motions_of_every_kind(box: d2m_ccd.Tree) -> None:
    import d2m_ccd.ray

    random = np.random.default_rng(23)
    poses = np.concatenate([random.normal(size=(200, 3, 4)), random.normal(size=(200, 3, 3)) * 3], axis=2)
    paths = d2m_ccd.PoseTrajectories([0, 0.5, 1], poses)
    windows = np.sort(random.random((200, 2)), axis=1)
    one = d2m_ccd.batch(box, box, paths, {"x": [1, 0, 0]}, window=windows)
    assert d2m_ccd.ray.batch(box, box, paths, {"x": [1, 0, 0]}, window=windows).tobytes() == one.tobytes()
    motions = [d2m_ccd.Keyframes([0, 0.5, 1], row) for row in poses[:80]]
    assert d2m_ccd.ray.batch(box, box, motions, {"x": [1, 0, 0]}, window=windows[:80]).tobytes() == one[:80].tobytes()


def test_a_stream_is_lazy_and_in_order(box: d2m_ccd.Tree) -> None:
    import d2m_ccd.ray
    from d2m_ccd.ray import Trials

    rows = random_motions(1000, 24, 3.0)
    taken: list[int] = []

    def chunks() -> Iterator[Trials]:
        for start in range(0, 1000, 50):
            taken.append(start)
            yield Trials(rows[start : start + 50], None, None)

    results = d2m_ccd.ray.stream(box, box, chunks(), in_flight=2)
    first = next(results)
    assert len(taken) <= 10
    everything = np.concatenate([first, *results])
    assert everything.tobytes() == d2m_ccd.batch(box, box, rows).tobytes()


def test_chunks_that_are_made_and_reduced_on_workers(box: d2m_ccd.Tree) -> None:
    import d2m_ccd.ray

    def make(seed: int) -> Any:
        random = np.random.default_rng(seed)
        rows = np.zeros((200, 13))
        rows[:, 0], rows[:, 4:7], rows[:, 7:10] = 1.0, random.normal(size=(200, 3)) * 3, random.normal(size=(200, 3)) * 3
        return d2m_ccd.ray.Trials(rows, None, None)

    def count(trials: Any, results: Any) -> tuple[int, int]:
        return len(results), int((results["status"] == 1).sum())

    from functools import partial

    counts = list(d2m_ccd.ray.stream(box, box, (partial(make, seed) for seed in range(8)), reduce=count))
    expected = [count(None, d2m_ccd.batch(box, box, make(seed).motions_a)) for seed in range(8)]
    assert counts == expected


def test_a_bad_trial_has_its_number_among_all(box: d2m_ccd.Tree) -> None:
    import d2m_ccd.ray

    rows = random_motions(1000, 25, 3.0)
    rows[[700, 900], 5] = np.nan
    with pytest.raises(d2m_ccd.InputError) as caught:
        d2m_ccd.ray.batch(box, box, rows)
    assert caught.value.index == 700 and "trial 700" in str(caught.value)


def test_batches_and_streams_that_end_early_leave_the_process_alone(box: d2m_ccd.Tree) -> None:
    """Cancelling what was in flight ended the process, mostly in the second such batch."""
    import d2m_ccd.ray

    rows = random_motions(1000, 26, 3.0)
    bad = rows.copy()
    bad[700, 5] = np.nan
    for count in range(20):
        with pytest.raises(d2m_ccd.InputError, match="trial 700"):
            d2m_ccd.ray.batch(box, box, bad[: 900 + count])
        chunks = (d2m_ccd.ray.Trials(rows[start : start + 100], None, None) for start in range(0, 1000, 100))
        stream = d2m_ccd.ray.stream(box, box, chunks)
        assert next(stream).tobytes() == d2m_ccd.batch(box, box, rows[:100]).tobytes()
        stream.close()


def robot_in_a_scene(tmp_path: Path) -> d2m_ccd.Robot:
    """With a mesh of a file that is gone when workers read the robot."""
    (tmp_path / "arm.obj").write_text("v 0 0 0\nv 0.8 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    box = '<geometry><box size="0.8 0.1 0.1"/></geometry>'
    text = d2m_ccd.EXAMPLE_URDF.replace(box, '<geometry><mesh filename="arm.obj" scale="1 2 1"/></geometry>')
    (tmp_path / "two.urdf").write_text(text)
    robot = d2m_ccd.Robot(tmp_path / "two.urdf", srdf="<robot name='two'/>", min_separation=1e-3)
    robot.add_obstacle("wall", "shape:box?x=0.05&y=0.05&z=0.5", d2m_ccd.Pose(x=[0, 0.7, 0]))
    robot.add_obstacle("ball", "shape:box?x=0.1&y=0.1&z=0.1", motion={"x": [0.5, -3, 0], "v": [0, 3, 0]})
    robot.attach("rod", "arm", "shape:box?x=0.01&y=0.3&z=0.01", d2m_ccd.Pose(x=[0.7, 0, 0]), radius=0.01, solid=False)
    robot.ignore("base", "wall")
    robot.set_start("rod", "wall", "leave")
    robot.set_min_separation("arm", "wall", 0.01)
    for file in tmp_path.iterdir():
        file.unlink()
    return robot


def test_edges_of_a_robot(tmp_path: Path) -> None:
    import d2m_ccd.ray
    from d2m_ccd.ray import Edges

    robot = robot_in_a_scene(tmp_path)
    random = np.random.default_rng(27)
    start, end = random.uniform(-3, 3, (1500, 1)), random.uniform(-3, 3, (1500, 1))
    here = robot.check_edges(start, end)
    assert set(here["status"]) == {0, 1}
    done: list[int] = []
    results = d2m_ccd.ray.check_edges(robot, start, end, progress=lambda now, total: done.append(now))
    assert results.tobytes() == here.tobytes() and done[-1] == 1500
    chunks = (Edges(start[k : k + 100], end[k : k + 100], ["turn"]) for k in range(0, 1500, 100))
    free = d2m_ccd.ray.stream_edges(robot, chunks, reduce=lambda edges, results: (results["status"] == 0).sum())
    assert sum(free) == (here["status"] == 0).sum()
    end[[900, 1200]] = np.nan
    with pytest.raises(d2m_ccd.InputError, match="edge 900") as caught:
        d2m_ccd.ray.check_edges(robot, start, end)
    assert caught.value.index == 900
    with pytest.raises(d2m_ccd.InputError, match="shape"):
        d2m_ccd.ray.check_edges(robot, start, end[:5])


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent otherwise there")
@pytest.mark.parametrize("what", ["trials", "edges"])
def test_a_killed_worker_loses_nothing(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree], what: str, tmp_path: Path) -> None:
    import d2m_ccd.ray

    @ray.remote(num_cpus=1)
    def pid() -> int:
        time.sleep(0.3)
        return os.getpid()

    workers = set(ray.get([pid.remote() for _ in range(4)]))
    killed: list[int] = []

    def kill(done: int, total: int) -> None:
        if not killed and done < total // 2:
            killed.extend(workers)
            for worker in workers:
                os.kill(worker, signal.SIGKILL)

    if what == "edges":
        robot, edges = robot_in_a_scene(tmp_path), np.random.default_rng(28).uniform(-3, 3, (2, 8_000, 1))
        results = d2m_ccd.ray.check_edges(robot, *edges, progress=kill)
        assert killed and results.tobytes() == robot.check_edges(*edges).tobytes()
        return
    rows = trials(knots, 20_000)
    results = d2m_ccd.ray.batch(*knots, *rows, progress=kill)
    assert killed
    assert results.tobytes() == d2m_ccd.batch(*knots, *rows).tobytes()


def test_the_command(tmp_path: Path) -> None:
    shapes = ["shape:torus-knot?triangles=1500", "shape:torus-knot?triangles=1000"]
    trees = d2m_ccd.Tree(shapes[0]), d2m_ccd.Tree(shapes[1])
    rows = np.hstack(trials(trees, 300))
    np.savetxt(tmp_path / "t.csv", rows, delimiter=",", fmt="%.17g")
    run = subprocess.run(command(tmp_path, *shapes), capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stderr
    lines = (tmp_path / "r.csv").read_text().splitlines()
    assert lines[0].startswith("trial,status,toc,toc_hi") and len(lines) == 301
    results = d2m_ccd.batch(*trees, rows[:, :13], rows[:, 13:])
    for line, result in zip(lines[1:], results):
        fields = line.split(",")
        assert len(fields) == 17
        assert fields[1] == d2m_ccd.Status(result["status"]).name.lower()
        assert float(fields[2]) == result["time_lo"] and float(fields[3]) == result["time_hi"]
    (tmp_path / "t.csv").write_text("1,2,3\n")
    run = subprocess.run(command(tmp_path, *shapes), capture_output=True, text=True, timeout=300)
    assert run.returncode == 3 and "t.csv, line 1: expected 26 numbers" in run.stderr


def command(folder: Path, *shapes: str) -> list[Any]:
    files = ["--trials", str(folder / "t.csv"), "--out", str(folder / "r.csv"), "--workers", "2"]
    return [sys.executable, "-m", "d2m_ccd.ray", *shapes, *files]
