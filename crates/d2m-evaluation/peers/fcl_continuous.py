"""FCL on trials: conservative advancement over its distance query, and its own continuous collision.

usage: fcl_continuous.py A.obj B.obj TRIALS.csv [--limit K]
install: pip install numpy python-fcl

Prints `trial,advance_toc,advance_microseconds,distance_microseconds,continuous_toc,continuous_microseconds`.
FCL's continuous collision is asked for linear motion between the end poses by conservative advancement, the settings
nearest to the trials (bodies turn by less than pi); with its defaults it finds fewer contacts.
"""
import csv
import math
import sys
import time

import fcl
import numpy as np


def load(path):
    vertices, triangles = [], []
    for line in open(path):
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(w) for w in words[1:4]])
        elif words[:1] == ["f"]:
            face = [int(w.split("/")[0]) - 1 for w in words[1:]]
            triangles += [[face[0], face[k - 1], face[k]] for k in range(2, len(face))]
    return np.array(vertices), np.array(triangles)


def product(a, b):
    w, x, y, z = a
    W, X, Y, Z = b
    return np.array([w * W - x * X - y * Y - z * Z, w * X + x * W + y * Z - z * Y,
                     w * Y - x * Z + y * W + z * X, w * Z + x * Y - y * X + z * W])


def pose(body, t):
    """Quaternion (w, x, y, z) and translation at t of q, x, v, w."""
    q, x, v, w = body[:4], body[4:7], body[7:10], body[10:13]
    angle = np.linalg.norm(w) * t
    axis = w / np.linalg.norm(w) if angle > 0 else np.zeros(3)
    turn = np.concatenate([[math.cos(angle / 2)], math.sin(angle / 2) * axis])
    return product(turn, q / np.linalg.norm(q)), x + t * v


def model(mesh):
    vertices, triangles = mesh
    bvh = fcl.BVHModel()
    bvh.beginModel(len(vertices), len(triangles))
    bvh.addSubModel(vertices, triangles)
    bvh.endModel()
    return bvh


def rows(path_a, path_b, path_trials, limit):
    """For each trial: the numbers of the printed table after `trial`."""
    meshes = load(path_a), load(path_b)
    radii = [float(np.linalg.norm(vertices, axis=1).max()) for vertices, _ in meshes]
    objects = [fcl.CollisionObject(model(mesh), fcl.Transform()) for mesh in meshes]
    spent = [0.0, 0]

    def distance(bodies, t):
        for thing, body in zip(objects, bodies):
            thing.setTransform(fcl.Transform(*pose(body, t)))
        start = time.perf_counter()
        found = fcl.distance(*objects, fcl.DistanceRequest(), fcl.DistanceResult())
        spent[0] += time.perf_counter() - start
        spent[1] += 1
        return found

    for index, row in enumerate(csv.reader(open(path_trials))):
        if index >= limit:
            break
        numbers = np.array([float(w) for w in row])
        bodies = numbers[:13], numbers[13:]
        speed = np.linalg.norm(bodies[1][7:10] - bodies[0][7:10])
        speed += sum(np.linalg.norm(body[10:13]) * radius for body, radius in zip(bodies, radii))
        t, toc, spent[:] = 0.0, math.inf, [0.0, 0]
        start = time.perf_counter()
        while t < 1.0:
            gap = distance(bodies, t)
            if gap <= 1e-9:
                toc = t
                break
            t += gap * (1 - 1e-9) / speed
        advance = time.perf_counter() - start

        for thing, body in zip(objects, bodies):
            thing.setTransform(fcl.Transform(*pose(body, 0.0)))
        ends = [fcl.Transform(*pose(body, 1.0)) for body in bodies]
        request = fcl.ContinuousCollisionRequest(
            num_max_iterations=1000, ccd_motion_type=fcl.CCDMotionType.CCDM_LINEAR,
            ccd_solver_type=fcl.CCDSolverType.CCDC_CONSERVATIVE_ADVANCEMENT)
        result = fcl.ContinuousCollisionResult()
        start = time.perf_counter()
        fcl.continuousCollide(objects[0], ends[0], objects[1], ends[1], request, result)
        clock = time.perf_counter() - start
        continuous = result.time_of_contact if result.is_collide else math.inf
        yield float(toc), advance * 1e6, spent[0] / spent[1] * 1e6, float(continuous), clock * 1e6


def text(row):
    """A row as the table has it."""
    toc, advance, distance, continuous, clock = row
    return f"{toc!r},{advance:.1f},{distance:.1f},{continuous!r},{clock:.1f}"


def main(path_a, path_b, path_trials, limit):
    print("trial,advance_toc,advance_microseconds,distance_microseconds,continuous_toc,continuous_microseconds")
    for index, row in enumerate(rows(path_a, path_b, path_trials, limit)):
        print(f"{index},{text(row)}")


if __name__ == "__main__":
    words = sys.argv[1:]
    if len(words) < 3:
        sys.exit(__doc__)
    most = int(words[words.index("--limit") + 1]) if "--limit" in words else 10**9
    main(words[0], words[1], words[2], most)
