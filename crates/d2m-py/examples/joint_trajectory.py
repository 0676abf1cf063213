"""A trajectory of Drake or ROS as plain arrays: is the arm free of contact with the scene, until when, and which link meets what?

From ROS: `times = [p.time_from_start.sec + 1e-9 * p.time_from_start.nanosec for p in msg.points]`, `positions = [p.positions for p in
msg.points]`, `velocities = [p.velocities for p in msg.points]`. From Drake: `times = trajectory.get_segment_times()`,
`positions = trajectory.vector_values(times).T`, `velocities = trajectory.MakeDerivative().vector_values(times).T`.
Neither has to be installed.
"""

from __future__ import annotations

from typing import Any

import d2m_ccd
import numpy as np

#: An arm of three links: where each joint stands in the link before it, and its axis.
JOINTS = [
    ([0.0, 0.0, 0.4], [0, 0, 1]),
    ([0.0, 0.0, 0.2], [0, 1, 0]),
    ([0.0, 0.0, 0.6], [0, 1, 0]),
]
LINK = "shape:box?x=0.05&y=0.05&z=0.25"


def link_motions(times: Any, positions: Any, velocities: Any = None) -> list[d2m_ccd.Chain]:
    """The motion of every link, from values of shape (k, 3) at the times, cubic between them where there are velocities."""
    joints, links = [], []
    for number, (x, axis) in enumerate(JOINTS):
        value = {"times": np.asarray(times), "positions": np.asarray(positions)[:, number]}
        if velocities is not None:
            value["velocities"] = np.asarray(velocities)[:, number]
        joints.append(d2m_ccd.Joint("revolute", x=x, axis=axis, value=value))
        # The mesh of a link stands on its joint.
        links.append(d2m_ccd.Chain([*joints, d2m_ccd.Joint(x=[0, 0, 0.3])]))
    return links


def check(times: Any, positions: Any, velocities: Any = None) -> d2m_ccd.FirstContact:
    """The first contact of the arm with the scene, or with itself."""
    world = d2m_ccd.World(min_separation=1e-3)
    tree = d2m_ccd.Tree(LINK)
    names = [f"link {number}" for number in range(len(JOINTS))]
    for name, motion in zip(names, link_motions(times, positions, velocities)):
        world.add(tree, motion, name=name)
    # Links that a joint connects touch each other.
    for one, other in zip(names, names[1:]):
        world.ignore_pair(one, other)
    world.add("shape:box?x=0.3&y=0.5&z=0.002", {"x": [0.7, 0, 0.9]}, name="shelf")
    return world.first_contact((float(times[0]), float(times[-1])))


def example() -> tuple[d2m_ccd.FirstContact, d2m_ccd.FirstContact]:
    """A path beside the shelf, and one through it."""
    times = [0.0, 1.0, 2.5]
    still = np.zeros((3, 3))
    beside = check(times, [[1.5, 0, 0], [2.0, 0.8, 0.5], [2.5, 0.2, 0.2]], still)
    through = check(times, [[0, 0, 0], [0.0, 0.6, 0.6], [0.0, 1.2, 0.4]], still)
    return beside, through


if __name__ == "__main__":
    for name, first in zip(("beside the shelf", "through the shelf"), example()):
        met = "" if first.a is None or first.b is None else f": {first.a.name} and {first.b.name}"
        print(f"{name}: {first.status}{met}, free until {first.clear_until:.6f} s")
