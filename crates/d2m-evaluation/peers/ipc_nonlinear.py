"""IPC Toolkit's nonlinear continuous collision detection on vertex/face pairs of turning bodies with a known contact.

usage: ipc_nonlinear.py [COUNT] [--cases CASES.jsonl]
install: pip install numpy ipctk

Each case plants a contact: a point of A meets the inside of a triangle of B at a time in (0.2, 0.8), both bodies
turning at up to 3 rad and flying at up to 4 units per unit of time. Prints `case,planted,found,late,microseconds`;
`found` may be smaller than planted when the pair touches before, and must never be larger. With --cases the same cases
are written for `d2m features`.
"""
import json
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


def cases(count):
    """Times of contact and who moves how: a point r and a triangle, each with x, v, w."""
    random = np.random.default_rng(1)
    for _ in range(count):
        toc = random.uniform(0.2, 0.8)
        triangle = random.uniform(-1, 1, (3, 3))
        weights = random.dirichlet([2, 2, 2])
        (va, wa), (vb, wb) = [(random.uniform(-2, 2, 3), random.uniform(-1, 1, 3) * math.sqrt(3)) for _ in range(2)]
        meeting = rotation(wb, toc) @ (weights @ triangle) + toc * vb
        r = random.uniform(-1, 1, 3)
        xa = meeting - rotation(wa, toc) @ r - toc * va
        yield toc, r, triangle, (xa, va, wa), (np.zeros(3), vb, wb)


def rows(count, rescaling=0.8):
    """For each case: planted and found time, and microseconds of the call. The rescaling of 0.8 is the peer's own
    choice; nearer to 1 it is less early and slower."""
    solver = ipctk.NonlinearCCD(conservative_rescaling=rescaling)
    for toc, r, triangle, a, b in cases(count):
        point = Path(r, *a)
        corners = [Path(corner, *b) for corner in triangle]
        start = time.perf_counter()
        hit, found = solver.point_triangle_ccd(point, *corners)
        clock = time.perf_counter() - start
        yield toc, float(found) if hit else math.inf, clock * 1e6


def write_cases(count, path):
    """The cases as `d2m features` reads them."""
    def motion(x, v, w):
        return {"q": [1, 0, 0, 0], "x": list(x), "v": list(v), "w": list(w)}

    with open(path, "w") as out:
        for case, (toc, r, triangle, a, b) in enumerate(cases(count)):
            line = {"id": str(case), "kind": "point_triangle", "A": {"p": list(r)}, "B": {"tri": triangle.tolist()},
                    "motionA": motion(*a), "motionB": motion(*b), "t0": 0.0, "t1": 1.0, "toc": repr(toc)}
            print(json.dumps(line), file=out)


def main(count, path):
    if path:
        write_cases(count, path)
    print("case,planted,found,late,microseconds")
    for case, (toc, found, clock) in enumerate(rows(count)):
        print(f"{case},{toc!r},{found!r},{found > toc + 1e-9},{clock:.1f}")


if __name__ == "__main__":
    words = sys.argv[1:]
    place = words.index("--cases") if "--cases" in words else len(words)
    main(int(words[0]) if words[:place] else 100, words[place + 1] if place < len(words) else None)
