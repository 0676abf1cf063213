"""Throughput with one and with two local workers of Ray: `python benches/workers.py [TRIALS]`. Two should do 1.7 times as much at least.

Workers are warm: trees are read and code is loaded by a first batch. Needs two processors that nothing else uses.
"""

from __future__ import annotations

import sys
import time

import d2m_ccd
import d2m_ccd.ray
import numpy as np
import ray
from overhead import SHAPE_A, SHAPE_B, random_motions


def throughput(workers: int, trees: tuple[d2m_ccd.Tree, d2m_ccd.Tree], rows: tuple[np.ndarray, np.ndarray]) -> tuple[float, bytes]:
    ray.init(num_cpus=workers, include_dashboard=False, log_to_driver=False)
    try:
        d2m_ccd.ray.batch(*trees, *(part[:2000] for part in rows))
        seconds = []
        for _ in range(3):
            start = time.perf_counter()
            results = d2m_ccd.ray.batch(*trees, *rows)
            seconds.append(time.perf_counter() - start)
        return len(results) / min(seconds), results.tobytes()
    finally:
        ray.shutdown()


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 400_000
    trees = d2m_ccd.Tree(SHAPE_A), d2m_ccd.Tree(SHAPE_B)
    distance = 1.5 * (trees[0].radius + trees[1].radius)
    rows = random_motions(count, 1, distance), random_motions(count, 2, 0.1 * distance)
    one, bits = throughput(1, trees, rows)
    two, same = throughput(2, trees, rows)
    start = time.perf_counter()
    here = d2m_ccd.batch(*trees, *rows, threads=1)
    alone = count / (time.perf_counter() - start)
    print(f"one worker {one:.0f} trials a second, two {two:.0f}: {two / one:.2f} times; without Ray, one thread: {alone:.0f}")
    if not bits == same == here.tobytes():
        raise SystemExit("the answers differ")


if __name__ == "__main__":
    main()
