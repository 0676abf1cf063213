"""What Python adds to a query, and to a batch: `python benches/overhead.py [D2M]`, D2M the command built with --release.

Without the command only the call itself is measured. Build the wheel with optimisation first: `pip install .`, not `maturin develop`.
"""

from __future__ import annotations

import csv
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Callable

import d2m_ccd
import numpy as np

SHAPE_A, SHAPE_B = "shape:torus-knot?triangles=4000", "shape:torus-knot?triangles=2000"
TRIALS = 100_000
ROUNDS = 5


def random_motions(count: int, seed: int, distance: float) -> np.ndarray:
    """Bodies that fly at each other from all sides and spin, about half of them past each other."""
    random = np.random.default_rng(seed)
    q = random.normal(size=(count, 4))
    x = random.normal(size=(count, 3))
    x *= distance / np.linalg.norm(x, axis=1, keepdims=True)
    v = random.normal(size=(count, 3)) * (0.2 * distance) - x
    return np.hstack([q, x, v, random.normal(size=(count, 3))])


def best(run: Callable[[], object], rounds: int) -> float:
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return min(times)


def calls() -> None:
    """Calls of one query, against the same query in a batch on one thread, where Python has no part.

    In turns, the best of many short rounds: what else the machine does is in neither.
    """
    box = d2m_ccd.Tree("shape:box")
    cases = {
        "far apart": d2m_ccd.ConstantTwist(x=[90, 0, 0], v=[1, 0, 0]),
        "contact": d2m_ccd.ConstantTwist(x=[5, 0, 0], v=[-4, 0, 0]),
    }
    for name, motion in cases.items():
        rows = np.tile(motion.to_array(), (200, 1))
        called, alone = [], []

        def python() -> None:
            for _ in range(200):
                d2m_ccd.time_of_contact(box, box, motion)

        for _ in range(100):
            called.append(best(python, 1) / 200)
            alone.append(best(lambda: d2m_ccd.batch(box, box, rows, threads=1), 1) / len(rows))
        added = min(called) - min(alone)
        print(f"{name}: query {min(alone) * 1e6:.2f} µs, from Python {min(called) * 1e6:.2f} µs, added {added * 1e6:.2f} µs")


def edges() -> None:
    """The same of `Robot.check_edge`, against `check_edges` on one thread."""
    robot = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF, threads=1)
    robot.add_obstacle("wall", "shape:box?x=0.05&y=0.05&z=0.5", d2m_ccd.Pose(x=[0, 0.7, 0]))
    for name, to in {"free edge": 0.3, "edge into a wall": 2.0}.items():
        start, end = np.zeros(1), np.array([to])
        starts, ends = np.tile(start, (200, 1)), np.tile(end, (200, 1))
        called, alone = [], []

        def python() -> None:
            for _ in range(200):
                robot.check_edge(start, end)

        for _ in range(100):
            called.append(best(python, 1) / 200)
            alone.append(best(lambda: robot.check_edges(starts, ends), 1) / 200)
        added = min(called) - min(alone)
        print(f"{name}: query {min(alone) * 1e6:.2f} µs, from Python {min(called) * 1e6:.2f} µs, added {added * 1e6:.2f} µs")


def batches(command: str) -> None:
    """A batch from Python against `d2m batch` with the same trials on the same threads, alternating; trees are built before."""
    a, b = d2m_ccd.Tree(SHAPE_A), d2m_ccd.Tree(SHAPE_B)
    distance = 1.5 * (a.radius + b.radius)
    first, second = random_motions(TRIALS, 1, distance), random_motions(TRIALS, 2, 0.1 * distance)
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        trials, out = Path(folder, "trials.csv"), Path(folder, "out.csv")
        with trials.open("w", newline="") as file:
            csv.writer(file).writerows(np.hstack([first, second]).tolist())
        for _ in range(ROUNDS):
            start = time.perf_counter()
            results = d2m_ccd.batch(a, b, first, second)
            python = time.perf_counter() - start
            arguments = [command, "batch", SHAPE_A, SHAPE_B, "--trials", str(trials), "--out", str(out)]
            arguments += ["--threads", str(os.cpu_count())]
            text = subprocess.run(arguments, capture_output=True, text=True, check=True).stderr
            rust = duration(text.split("all trials in ")[1])
            ratios.append(python / rust)
            print(f"batch of {TRIALS}: Python {python:.3f} s, Rust {rust:.3f} s, ratio {python / rust:.3f}")
        with out.open() as file:
            rows = list(csv.DictReader(file))
    same = [float(row["toc"]) for row in rows] == results["time_lo"].tolist()
    print(f"median ratio {statistics.median(ratios):.3f}; the same bits: {same}")
    if not same:
        raise SystemExit("the answers differ")


def duration(text: str) -> float:
    """Of "12.3 µs", "4.5 ms" or "6.7 s"."""
    number, unit = text.split()[:2]
    return float(number) * {"µs": 1e-6, "ms": 1e-3, "s": 1.0}[unit]


if __name__ == "__main__":
    calls()
    edges()
    if len(sys.argv) > 1:
        batches(sys.argv[1])
