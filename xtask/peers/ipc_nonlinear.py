"""IPC Toolkit's nonlinear continuous collision detection on vertex/face pairs of turning bodies with a known contact.

usage: ipc_nonlinear.py [COUNT]
install: pip install numpy ipctk

Each case plants a contact: a point of A meets the inside of a triangle of B at a time in (0.2, 0.8), both bodies
turning at up to 3 rad and flying at up to 4 units per unit of time. Prints `case,planted,found,late,microseconds`;
`found` may be smaller than planted when the pair touches before, and must never be larger.
"""
import math
import sys
import time

import ipctk
import numpy as np


def rotation(w, t):
    angle = np.linalg.norm(w) * t
    if angle == 0:
        return np.eye(3)
    x, y, z = w / np.linalg.norm(w)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k


class Path(ipctk.NonlinearTrajectory):
    """A body point r at exp([w] t) r + x + v t."""

    def __init__(self, r, x, v, w):
        super().__init__()
        self.r, self.x, self.v, self.w = r, x, v, w

    def __call__(self, t):
        return rotation(self.w, t) @ self.r + self.x + t * self.v

    def max_distance_from_linear(self, t0, t1):
        # |p''| is at most |w|^2 |r|; a chord over h strays from its arc by at most h^2 / 8 times that.
        return float(np.dot(self.w, self.w) * np.linalg.norm(self.r) * (t1 - t0) ** 2 / 8)


def main(count):
    random = np.random.default_rng(1)
    solver = ipctk.NonlinearCCD()
    print("case,planted,found,late,microseconds")
    for case in range(count):
        toc = random.uniform(0.2, 0.8)
        triangle = random.uniform(-1, 1, (3, 3))
        weights = random.dirichlet([2, 2, 2])
        moves = [(random.uniform(-2, 2, 3), random.uniform(-1, 1, 3) * 3 / math.sqrt(3)) for _ in range(2)]
        (va, wa), (vb, wb) = moves
        meeting = rotation(wb, toc) @ (weights @ triangle) + toc * vb
        r = random.uniform(-1, 1, 3)
        xa = meeting - rotation(wa, toc) @ r - toc * va
        point = Path(r, xa, va, wa)
        corners = [Path(corner, np.zeros(3), vb, wb) for corner in triangle]
        start = time.perf_counter()
        hit, found = solver.point_triangle_ccd(point, *corners)
        clock = time.perf_counter() - start
        found = found if hit else math.inf
        print(f"{case},{float(toc)!r},{float(found)!r},{bool(found > toc + 1e-9)},{clock * 1e6:.1f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100)
