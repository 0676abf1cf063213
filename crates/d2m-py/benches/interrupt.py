"""How long after Ctrl-C a batch has ended: `python benches/interrupt.py`. It should be below 50 ms on a machine that is not loaded."""

from __future__ import annotations

import os
import signal
import threading
import time

import d2m_ccd
import numpy as np

ROUNDS = 20


def main() -> None:
    tree = d2m_ccd.Tree("shape:torus-knot?triangles=20000")
    rows = np.tile([1.0, 0, 0, 0, 3, 0, 0, -3, 0, 0, 9, 0, 0], (3_000_000, 1))
    late = []
    for _ in range(ROUNDS):
        sent: list[float] = []

        def send() -> None:
            time.sleep(0.2)
            sent.append(time.perf_counter())
            os.kill(os.getpid(), signal.SIGINT)

        threading.Thread(target=send).start()
        try:
            d2m_ccd.batch(tree, tree, rows)
        except KeyboardInterrupt:
            late.append(time.perf_counter() - sent[0])
    late.sort()
    print(f"Ctrl-C ends a batch after {1e3 * late[len(late) // 2]:.1f} ms (median of {len(late)}), {1e3 * late[-1]:.1f} ms at most")


if __name__ == "__main__":
    main()
