"""FCL's distance on the pairs of `cargo xtask bench --only scenes`, which must run first on the same machine.

usage: fcl_distance.py [--rounds K]
install: python -m venv VENV && VENV/bin/pip install numpy python-fcl     (outside of the project)

Reads the meshes and `distance.csv` from `.bench/scenes`, checks that both distances agree, and prints
`pair,gap,distance,fcl_distance,microseconds,fcl_microseconds,ratio`. FCL's tree is that of oriented boxes and rectangle swept
spheres, its search that of PQP, whose code it goes back to. PQP itself is in no package index (pip, apt), so it is not here.
The call from Python is counted: measured with one triangle a body, it is printed on the last line.
"""
import argparse
import csv
import pathlib
import sys
import time

import fcl
import numpy as np

from fcl_continuous import load, model

FOLDER = pathlib.Path(__file__).resolve().parents[3] / ".bench" / "scenes"
# FCL stops at a relative error of its own; it also works with other roundings.
AGREE = 1e-6


def least(rounds, query):
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        value = query()
        times.append(time.perf_counter() - start)
    return min(times) * 1e6, value


def distance(a, b):
    return lambda: fcl.distance(a, b, fcl.DistanceRequest(), fcl.DistanceResult())


def main(rounds):
    objects = {}
    disagree = 0
    print("pair,gap,distance,fcl_distance,microseconds,fcl_microseconds,ratio")
    for row in csv.DictReader((FOLDER / "distance.csv").open()):
        pair = row["pair"]
        if pair not in objects:
            objects = {pair: [fcl.CollisionObject(model(load(FOLDER / f"{pair}_{letter}.obj")), fcl.Transform())
                              for letter in "ab"]}
        a, b = objects[pair]
        turn = [float(row[key]) for key in ("qw", "qx", "qy", "qz")]
        a.setTransform(fcl.Transform(np.array(turn), np.array([float(row[key]) for key in "xyz"])))
        clock, value = least(rounds, distance(a, b))
        ours, own = float(row["distance"]), float(row["microseconds"])
        if abs(value - ours) > AGREE * (1 + ours):
            disagree += 1
            print(f"{pair} at {row['gap']}: {ours} but FCL {value}", file=sys.stderr)
        print(f"{pair},{row['gap']},{ours:.9g},{value:.9g},{own:.1f},{clock:.1f},{own / clock:.3f}")
    corner = np.eye(3)
    single = [fcl.CollisionObject(model((corner + k * 5, np.array([[0, 1, 2]]))), fcl.Transform()) for k in (0, 1)]
    print(f"one triangle a body,,,,,{least(200, distance(*single))[0]:.1f},")
    sys.exit(f"{disagree} distances disagree" if disagree else 0)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    main(parser.parse_args().rounds)
