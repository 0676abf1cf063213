"""What Python adds to a query, and to a batch: `python benches/overhead.py [D2M]`, D2M the command built with --release.

Without the command only the call itself is measured. Build the wheel with optimisation first: `pip install .`, not `maturin develop`.
"""

from __future__ import annotations

import csv
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


def random_motions(count: int, seed: int) -> np.ndarray:
    """Bodies that fly at each other from all sides and spin, about half of them past each other."""
    random = np.random.default_rng(seed)
    q = random.normal(size=(count, 4))
    x = random.normal(size=(count, 3))
    x *= 12.0 / np.linalg.norm(x, axis=1, keepdims=True)
    v = random.normal(size=(count, 3)) * 4.0 - x
    return np.hstack([q, x, v, random.normal(size=(count, 3))])


def best(run: Callable[[], object], rounds: int = ROUNDS) -> float:
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return min(times)


def calls() -> None:
    """One call of a query that is decided at once, against the same one in a batch on one thread, where Python has no part."""
    a, b = d2m_ccd.Tree("shape:box"), d2m_ccd.Tree("shape:box")
    row = np.array([1.0, 0, 0, 0, 90, 0, 0, 1, 0, 0, 0, 0, 0])
    motion = d2m_ccd.ConstantTwist.from_array(row)
    rows = np.tile(row, (TRIALS, 1))
    count = 20_000

    def python() -> None:
        for _ in range(count):
            d2m_ccd.time_of_contact(a, b, motion)

    alone = best(lambda: d2m_ccd.batch(a, b, rows, threads=1)) / TRIALS
    called = best(python) / count
    print(f"far apart: query {alone * 1e6:.2f} µs, from Python {called * 1e6:.2f} µs, added {(called - alone) * 1e6:.2f} µs")

    contact = d2m_ccd.ConstantTwist(x=[3, 0, 0], v=[-4, 0, 0])
    rows = np.tile(contact.to_array(), (TRIALS // 10, 1))

    def meeting() -> None:
        for _ in range(count // 10):
            d2m_ccd.time_of_contact(a, b, contact, window=(0.0, 1.0), tolerance=1e-9).time_lo

    alone = best(lambda: d2m_ccd.batch(a, b, rows, threads=1, tolerance=1e-9)) / len(rows)
    called = best(meeting) / (count // 10)
    print(f"contact: query {alone * 1e6:.2f} µs, from Python {called * 1e6:.2f} µs, added {(called - alone) * 1e6:.2f} µs")


def batches(command: str) -> None:
    """A batch from Python against `d2m batch` with the same trials on the same threads, alternating; trees are built before."""
    a, b = d2m_ccd.Tree(SHAPE_A), d2m_ccd.Tree(SHAPE_B)
    first, second = random_motions(TRIALS, 1), random_motions(TRIALS, 2)
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        trials, out = Path(folder, "trials.csv"), Path(folder, "out.csv")
        with trials.open("w", newline="") as file:
            csv.writer(file).writerows(np.hstack([first, second]).tolist())
        for _ in range(ROUNDS):
            start = time.perf_counter()
            results = d2m_ccd.batch(a, b, first, second)
            python = time.perf_counter() - start
            arguments = [command, "batch", SHAPE_A, SHAPE_B, "--trials", str(trials), "--out", str(out), "--threads"]
            threads = str(len(__import__("os").sched_getaffinity(0)) if hasattr(__import__("os"), "sched_getaffinity") else 0)
            text = subprocess.run([*arguments, threads], capture_output=True, text=True, check=True).stderr
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
    if len(sys.argv) > 1:
        batches(sys.argv[1])
