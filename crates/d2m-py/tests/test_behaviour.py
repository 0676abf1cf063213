"""Batches, threads, signals, progress, pickles and files."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import d2m_ccd
import numpy as np
import pytest
from conftest import BOX, random_motions

HERE = Path(__file__).parent


def assert_same_bits(one: np.ndarray, other: np.ndarray) -> None:
    assert one.dtype == other.dtype == d2m_ccd.RESULT
    assert one.tobytes() == other.tobytes()


def trials(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree], count: int) -> tuple[np.ndarray, np.ndarray]:
    distance = 1.5 * (knots[0].radius + knots[1].radius)
    return random_motions(count, 7, distance), random_motions(count, 8, 0.1 * distance)


def test_a_batch_has_the_answers_of_single_queries(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree]) -> None:
    rows_a, rows_b = trials(knots, 100)
    results = d2m_ccd.batch(*knots, rows_a, rows_b)
    seen = set()
    for row_a, row_b, result in zip(rows_a, rows_b, results):
        answer = d2m_ccd.time_of_contact(*knots, row_a, row_b)
        status = d2m_ccd.Status(result["status"])
        seen.add(status)
        assert answer.status == status.name.lower()
        assert answer.clear_until == result["time_lo"]
        if isinstance(answer, d2m_ccd.Contact):
            for name in ("time_hi", "separation", "tolerance", "closing_speed", "triangle_a", "triangle_b"):
                assert getattr(answer, name) == result[name]
            for name in ("normal", "point_a", "point_b", "barycentric_a", "barycentric_b"):
                assert (getattr(answer, name) == result[name]).all()
            assert answer.evidence == d2m_ccd.Evidence(result["evidence"]).name.lower()
            assert answer.start == d2m_ccd.Start(result["start"]).name.lower()
            assert answer.feature == d2m_ccd.feature_text(result["feature_kind"], result["features"])
    assert seen == {d2m_ccd.Status.CONTACT, d2m_ccd.Status.SEPARATED}


def test_the_same_bits_at_any_number_of_threads(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree]) -> None:
    rows = trials(knots, 300)
    one = d2m_ccd.batch(*knots, *rows, threads=1)
    for threads in (2, 3, 8, None):
        assert_same_bits(one, d2m_ccd.batch(*knots, *rows, threads=threads))


def test_arrays_of_any_layout(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree]) -> None:
    rows_a, rows_b = trials(knots, 50)
    expected = d2m_ccd.batch(*knots, rows_a, rows_b)
    wide = np.zeros((100, 26))
    wide[::2, 3:16] = rows_a
    unaligned = np.frombuffer(b"x" + rows_a.tobytes(), dtype="u1")[1:].view("f8").reshape(rows_a.shape)
    for same in (np.asfortranarray(rows_a), wide[::2, 3:16], rows_a.astype(">f8"), unaligned, rows_a.tolist()):
        assert_same_bits(expected, d2m_ccd.batch(*knots, same, rows_b))
    rows_a.flags.writeable = False
    assert_same_bits(expected, d2m_ccd.batch(*knots, rows_a, rows_b))
    motions = [d2m_ccd.ConstantTwist.from_array(row) for row in rows_a]
    assert_same_bits(expected, d2m_ccd.batch(*knots, motions, rows_b))
    single = rows_a.astype(np.float32)
    assert_same_bits(d2m_ccd.batch(*knots, single.astype(float), rows_b), d2m_ccd.batch(*knots, single, rows_b))


def test_sequences_of_motions_hold_none_and_may_be_empty(box: d2m_ccd.Tree) -> None:
    away = {"x": [3, 0, 0]}
    expected = d2m_ccd.batch(box, box, [d2m_ccd.ConstantTwist(), away, d2m_ccd.ConstantTwist()])
    assert len(set(expected["status"].tolist())) == 2
    assert_same_bits(expected, d2m_ccd.batch(box, box, [None, away, None]))
    assert_same_bits(expected[:2], d2m_ccd.batch(box, box, ({}, away), (None, None)))
    for empty in ([], (), np.zeros((0, 13))):
        none = d2m_ccd.batch(box, box, empty)
        assert len(none) == 0 and none.dtype == d2m_ccd.RESULT


def test_windows_of_trials(box: d2m_ccd.Tree) -> None:
    falling = d2m_ccd.ConstantTwist(x=[0, 0, 5], v=[0, 0, -1])
    windows = np.array([[0, 3], [0, 4.5], [4, 8], [5, 6], [10, 20]], float)
    results = d2m_ccd.batch(box, box, falling, window=windows)
    assert results["status"].tolist() == [0, 1, 1, 1, 0]
    assert results["time_lo"][1] == pytest.approx(4.0, abs=1e-8)
    assert results["start"].tolist()[3] == d2m_ccd.Start.OVERLAPPING
    assert len(d2m_ccd.batch(box, box, falling, window=np.zeros((0, 2)))) == 0
    assert len(d2m_ccd.batch(box, box, np.zeros((0, 13)))) == 0
    assert len(d2m_ccd.batch(box, box, falling, window=(0.0, 5.0))) == 1


@pytest.mark.parametrize("join", ["linear", "screw", "cubic", "quintic"])
def test_trajectories_of_poses(box: d2m_ccd.Tree, join: Any) -> None:
    random = np.random.default_rng(9)
    poses = np.concatenate([random.normal(size=(20, 4, 4)), random.normal(size=(20, 4, 3)) * 3], axis=2)
    times = np.sort(random.random((20, 4)), axis=1)
    times[:, 0], times[:, 3] = 0.0, 1.0
    trajectories = d2m_ccd.PoseTrajectories(times, poses, join=join)
    results = d2m_ccd.batch(box, box, trajectories)
    for k in range(20):
        if join in ("linear", "screw"):
            motion: d2m_ccd.Motion = d2m_ccd.Keyframes(times[k], poses[k], join=join)
        else:
            motion = d2m_ccd.Spline(times[k], poses[k], degree=3 if join == "cubic" else 5)
        assert d2m_ccd.time_of_contact(box, box, motion).clear_until == results["time_lo"][k]
    assert {0, 1} >= set(results["status"]) and 1 in results["status"]
    matrices = np.array([[d2m_ccd.Pose(row[4:], row[:4]).matrix() for row in rows] for rows in poses])
    again = d2m_ccd.batch(box, box, d2m_ccd.PoseTrajectories(times, matrices, join=join))
    assert (again["status"] == results["status"]).mean() > 0.9
    assert_same_bits(results[3:7], d2m_ccd.batch(box, box, pickle.loads(pickle.dumps(trajectories[3:7]))))


def test_trajectories_of_joints(box: d2m_ccd.Tree) -> None:
    shoulder = d2m_ccd.Joint("revolute", axis=[0, 0, 1])
    joints = [shoulder, d2m_ccd.Joint(x=[2, 0, 0]), d2m_ccd.Joint("prismatic", axis=[1, 0, 0]), d2m_ccd.Joint(x=[1, 0, 0])]
    random = np.random.default_rng(10)
    times, values = [0.0, 0.4, 1.0], random.normal(size=(30, 3, 2)) * 2
    obstacle = d2m_ccd.Keyframes([0, 1], [[1, 0, 0, 0, 2.5, 1.5, 0]] * 2)
    trajectories = d2m_ccd.JointTrajectories(joints, times, values)
    results = d2m_ccd.batch(box, box, trajectories, obstacle)
    assert set(results["status"]) == {0, 1}
    for k in range(30):
        moving = [
            d2m_ccd.Joint("revolute", axis=[0, 0, 1], value={"times": times, "positions": values[k, :, 0]}),
            joints[1],
            d2m_ccd.Joint("prismatic", axis=[1, 0, 0], value={"times": times, "positions": values[k, :, 1]}),
            joints[3],
        ]
        answer = d2m_ccd.time_of_contact(box, box, d2m_ccd.Chain(moving), obstacle)
        assert answer.clear_until == results["time_lo"][k]
    smooth = d2m_ccd.JointTrajectories(joints, times, values, np.zeros_like(values), np.zeros_like(values))
    assert len(d2m_ccd.batch(box, box, smooth, obstacle)) == 30
    assert_same_bits(results[5:9], d2m_ccd.batch(box, box, pickle.loads(pickle.dumps(trajectories[5:9])), obstacle))


def test_everything_that_should_comes_back_from_a_pickle(box: d2m_ccd.Tree) -> None:
    pose = [1.0, 0, 0, 0, 0, 0, 0]
    other = [0.5, 0.5, 0.5, 0.5, 1, 2, 3]
    joint = d2m_ccd.Joint("revolute", axis=[0, 0, 2], value=([0, 1, 2], [[0, 1], [1, 2]]))
    motions = [
        d2m_ccd.ConstantTwist(x=[0.1, 0, 0], w=[0, 0.3, 0], at=[1, 2, 3], t=0.7),
        d2m_ccd.Screw(pose, other),
        d2m_ccd.Keyframes([0, 1], [pose, other], join="screw"),
        d2m_ccd.Spline([0, 1], [pose, other]),
        d2m_ccd.Spline([0, 1], [pose, other], np.ones((2, 6)), degree=5),
        d2m_ccd.Chain([joint, d2m_ccd.Joint(x=[1, 0, 0])]),
    ]
    for motion in motions:
        again = pickle.loads(pickle.dumps(motion))
        assert type(again) is type(motion) and again == motion and hash(again) == hash(motion)
        assert again.pose(0.3) == motion.pose(0.3)
    answers = [
        d2m_ccd.time_of_contact(box, box, {"x": [9, 0, 0]}),
        d2m_ccd.time_of_contact(box, box, {"x": [9, 0, 0], "v": [-9, 0, 0]}),
        d2m_ccd.time_of_contact(box, box, {"x": [9, 0, 0], "v": [-9, 0, 0]}, node_tests=0),
    ]
    for answer in answers:
        again = pickle.loads(pickle.dumps(answer))
        assert type(again) is type(answer) and again == answer
    mesh = pickle.loads(pickle.dumps(box.mesh))
    assert (mesh.vertices == box.mesh.vertices).all() and (mesh.faces == box.mesh.faces).all()
    error = pickle.loads(pickle.dumps(d2m_ccd.InputError("text", 3, 4.0)))
    assert (str(error), error.index, error.value) == ("text", 3, 4.0)
    placed = d2m_ccd.Pose([1, 2, 3], [1, 1, 0, 0], [4, 5, 6])
    assert pickle.loads(pickle.dumps(placed)) == placed


def test_everything_is_frozen(box: d2m_ccd.Tree) -> None:
    answer = d2m_ccd.time_of_contact(box, box)
    for thing, name in ((answer, "time_lo"), (box, "radius"), (d2m_ccd.Pose(), "x"), (box.mesh, "vertices")):
        with pytest.raises(AttributeError):
            setattr(thing, name, 0.0)
    normal = answer.normal  # type: ignore[union-attr]
    normal[:] = 7.0
    assert (answer.normal != 7.0).any()  # type: ignore[union-attr]


def test_threads_share_trees_and_run_side_by_side(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree]) -> None:
    rows = trials(knots, 60)
    expected = d2m_ccd.batch(*knots, *rows)
    with ThreadPoolExecutor(8) as pool:
        for results in pool.map(lambda _: d2m_ccd.batch(*knots, *rows, threads=2), range(16)):
            assert_same_bits(expected, results)
        singles = pool.map(lambda pair: d2m_ccd.time_of_contact(*knots, *pair).clear_until, zip(*rows))
        assert list(singles) == expected["time_lo"].tolist()
    world = d2m_ccd.World()
    with ThreadPoolExecutor(8) as pool:
        ids = list(pool.map(lambda k: world.add(knots[0], {"x": [4.0 * k, 0, 0]}), range(40)))
        assert len(set(ids)) == 40
        for first in pool.map(lambda _: world.first_contact(), range(8)):
            assert first.status == "separated"


def test_python_goes_on_while_a_batch_runs(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree]) -> None:
    rows = trials(knots, 20_000)
    ended = threading.Event()

    def run() -> None:
        d2m_ccd.batch(*knots, *rows, threads=1)
        ended.set()

    thread = threading.Thread(target=run)
    thread.start()
    turns = 0
    while not ended.is_set():
        turns += 1
        time.sleep(1e-4)
    thread.join()
    assert turns > 20


def test_progress(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree]) -> None:
    rows = trials(knots, 3000)
    calls: list[tuple[int, int]] = []
    d2m_ccd.batch(*knots, *rows, progress=lambda done, total: calls.append((done, total)))
    assert calls[-1] == (3000, 3000)
    assert calls == sorted(calls)

    class Bar:
        total = 0

        def update(self, n: int) -> None:
            self.total += n

    bar = Bar()
    d2m_ccd.batch(*knots, *rows, progress=bar)
    assert bar.total == 3000

    def fail(done: int, total: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        d2m_ccd.batch(*knots, *rows, progress=fail)


INTERRUPTED = """
import os, signal, threading, time
import d2m_ccd, numpy as np
tree = d2m_ccd.Tree("shape:torus-knot?triangles=1500")
rows = np.tile([1.0, 0, 0, 0, 3, 0, 0, -3, 0, 0, 9, 0, 0], (3_000_000, 1))
# What a shell runs in the background ignores interrupts.
signal.signal(signal.SIGINT, signal.default_int_handler)
sent = []
def send():
    time.sleep(0.5)
    sent.append(time.perf_counter())
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=send).start()
try:
    d2m_ccd.batch(tree, tree, rows)
except KeyboardInterrupt:
    print("late", time.perf_counter() - sent[0])
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent otherwise there")
def test_an_interrupt_ends_a_batch() -> None:
    # How fast is a matter of benches/interrupt.py: here the machine may do anything else meanwhile.
    run = subprocess.run([sys.executable, "-c", INTERRUPTED], capture_output=True, text=True, timeout=60)
    assert run.stdout.startswith("late "), run.stderr
    assert run.returncode == 0


def in_child(_: int) -> bytes:
    box = d2m_ccd.Tree(BOX)
    rows = np.tile([1.0, 0, 0, 0, 5, 0, 0, -8, 0, 0, 0, 0, 0], (100, 1))
    return d2m_ccd.batch(box, box, rows, threads=2).tobytes()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
def test_processes_that_are_forked_after_a_batch() -> None:
    expected = in_child(0)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map_async(in_child, range(4)).get(timeout=60) == [expected] * 4


def test_limits_end_a_query(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree]) -> None:
    spin = d2m_ccd.ConstantTwist(x=[1.9, 0, 0], w=[3e4, 2e4, 1e4])
    answer = d2m_ccd.time_of_contact(*knots, spin, {"w": [-1e4, 3e4, 1e4]}, min_separation=1e-9, node_tests=50)
    assert answer.status == "undecided" and 0.0 <= answer.clear_until <= 1.0
    assert d2m_ccd.contact_exists(*knots, spin, node_tests=0) is None
    assert d2m_ccd.collide(*knots, node_tests=0) is None


def test_the_answers_of_a_world_are_those_of_its_pairs(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree]) -> None:
    rows = random_motions(12, 11, 4.0 * knots[0].radius)
    world = d2m_ccd.World(threads=2)
    ids = [world.add(knots[k % 2], row, name=f"body {k}") for k, row in enumerate(rows)]
    contacts = {(pair.a, pair.b): pair.answer for pair in world.contacts()}
    assert contacts
    for i in range(12):
        for j in range(i + 1, 12):
            answer = d2m_ccd.time_of_contact(knots[i % 2], knots[j % 2], rows[i], rows[j])
            found = contacts.get((ids[i], ids[j]))
            assert (found is None) == (answer.status == "separated")
            if found is not None:
                # Earlier queries of a world may show in the last digits.
                assert found.clear_until == pytest.approx(answer.clear_until, abs=1e-9)
    first = world.first_contact()
    assert first.clear_until == min(answer.clear_until for answer in contacts.values())
    assert first.a == world.bodies()[ids.index(first.a)]  # type: ignore[arg-type]


def test_a_simulation_is_changed() -> None:
    simulation = d2m_ccd.Simulation()
    shelf = simulation.add(BOX, name="shelf", kind="static")
    cup = simulation.add(BOX, name="cup", pose=d2m_ccd.Pose(x=[0, 1.001, 0]))
    simulation.advance(1.0)
    assert abs(simulation.pose(cup).x[1] - 1.001) < 1e-3
    with pytest.raises(d2m_ccd.InputError, match="intersect"):
        simulation.set_pose("cup", d2m_ccd.Pose(x=[0, 0.5, 0]))
    simulation.remove("shelf")
    with pytest.raises(KeyError):
        simulation.pose("shelf")
    with pytest.raises(KeyError):
        simulation.pose(shelf)
    segments = simulation.advance(1.1)
    assert any(segment.removed == [shelf] for segment in segments)
    assert simulation.velocities()[0, 1] < -0.5
    simulation.set_gravity([0, 0, 0])
    simulation.set_velocity(cup, [1, 0, 0])
    x = simulation.pose(cup).x[0]
    simulation.advance(2.1)
    assert abs(simulation.pose(cup).x[0] - x - 1) < 1e-9
    assert simulation.add(BOX, pose=d2m_ccd.Pose(x=[0, 50, 0])) == shelf
    assert len(simulation) == 2


def test_files(tmp_path: Path) -> None:
    text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (tmp_path / "corner.obj").write_text(text)
    tree = d2m_ccd.Tree(tmp_path / "corner.obj")
    assert tree.is_watertight and tree.triangle_count == 4
    (tmp_path / "corner.d2mtree").write_bytes(tree.to_bytes())
    assert d2m_ccd.Tree(str(tmp_path / "corner.d2mtree")).to_bytes() == tree.to_bytes()
    assert d2m_ccd.Mesh(tmp_path / "corner.d2mtree").vertex_count == 4


def test_what_a_user_writes_runs() -> None:
    import typing_of_a_user

    assert isinstance(typing_of_a_user.use(), float)
    assert typing_of_a_user.world().startswith("separated")
    assert isinstance(typing_of_a_user.simulation(), float)


@pytest.mark.parametrize("checker", ["mypy", "pyright", "stubtest"])
def test_types(checker: str) -> None:
    pytest.importorskip("mypy" if checker == "stubtest" else checker)
    commands = {
        "mypy": ["-m", "mypy", "--strict", "--config-file", str(HERE.parent / "pyproject.toml"), "typing_of_a_user.py"],
        "pyright": ["-m", "pyright", "--pythonpath", sys.executable, "typing_of_a_user.py"],
        "stubtest": ["-m", "mypy.stubtest", "d2m_ccd._d2m", "--ignore-disjoint-bases"],
    }
    run = subprocess.run([sys.executable, *commands[checker]], capture_output=True, text=True, cwd=HERE, timeout=500)
    assert run.returncode == 0, run.stdout + run.stderr
