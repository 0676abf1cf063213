"""Throughput with one and with two local workers of Ray: `python benches/workers.py [TRIALS]`. Two should do 1.7 times as much at least.

Trials of two meshes, then a tenth as many edges of a robot. Workers are warm: trees are read and code is loaded by a first batch. Needs two processors
that nothing else uses; where something does, two threads without Ray do no better either: that ratio is printed beside.
"""

from __future__ import annotations

import sys
import time
from typing import Callable

import d2m_ccd
import d2m_ccd.ray
import numpy as np
import ray
from overhead import SHAPE_A, SHAPE_B, random_motions


def throughput(workers: int, ask: Callable[[int], np.ndarray], count: int) -> tuple[float, bytes]:
    ray.init(num_cpus=workers, include_dashboard=False, log_to_driver=False)
    try:
        ask(max(count // 100, 100))
        seconds = []
        for _ in range(3):
            start = time.perf_counter()
            results = ask(count)
            seconds.append(time.perf_counter() - start)
        return count / min(seconds), results.tobytes()
    finally:
        ray.shutdown()


def compare(what: str, over_ray: Callable[[int], np.ndarray], here: Callable[[int], np.ndarray], count: int) -> None:
    """`here(threads)` without Ray."""
    one, bits = throughput(1, over_ray, count)
    two, same = throughput(2, over_ray, count)
    alone = []
    for threads in (1, 2):
        start = time.perf_counter()
        results = here(threads)
        alone.append(count / (time.perf_counter() - start))
    print(
        f"{count} {what}: one worker {one:.0f} a second, two {two:.0f}: {two / one:.2f} times; "
        f"without Ray one thread {alone[0]:.0f}, two {alone[1]:.0f}: {alone[1] / alone[0]:.2f} times"
    )
    if not bits == same == results.tobytes():
        raise SystemExit("the answers differ")


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 400_000
    trees = d2m_ccd.Tree(SHAPE_A), d2m_ccd.Tree(SHAPE_B)
    distance = 1.5 * (trees[0].radius + trees[1].radius)
    rows = random_motions(count, 1, distance), random_motions(count, 2, 0.1 * distance)
    compare(
        "trials",
        lambda some: d2m_ccd.ray.batch(*trees, *(part[:some] for part in rows)),
        lambda threads: d2m_ccd.batch(*trees, *rows, threads=threads),
        count,
    )
    robot = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF)
    robot.add_obstacle("knot", SHAPE_A, d2m_ccd.Pose(x=[0, 0.9, 0.1]))
    count //= 10
    edges = np.random.default_rng(3).uniform(-3, 3, (2, count, 1))
    compare(
        "edges",
        lambda some: d2m_ccd.ray.check_edges(robot, *edges[:, :some]),
        lambda threads: robot.check_edges(*edges, threads=threads),
        count,
    )


if __name__ == "__main__":
    main()
