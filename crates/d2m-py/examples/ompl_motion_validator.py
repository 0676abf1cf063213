"""Edges of a sampling planner, checked as OMPL's `MotionValidator` wants them: free, or free until a fraction of the edge.

A drone flies from gap to gap; its states are (x, y, z, yaw). With OMPL installed, hand `Validator` to
`space_information.setMotionValidator(OmplValidator(space_information, validator))`; without it this example checks its own edges.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import d2m_ccd
import numpy as np

try:
    from ompl import base as ob
except ImportError:
    ob = None


@dataclass(frozen=True)
class Edge:
    """What is known of an edge: is it free, and how far can it be followed?"""

    is_free: bool
    last_valid: float


class Validator:
    """Checks straight edges of states (x, y, z, yaw) of one body among obstacles at rest. No step length has to be chosen."""

    def __init__(self, body: d2m_ccd.Tree, obstacles: list[tuple[d2m_ccd.Tree, d2m_ccd.Pose]], clearance: float = 0.0) -> None:
        self.world = d2m_ccd.World(min_separation=clearance)
        self.body = self.world.add(body, name="body")
        for tree, pose in obstacles:
            self.world.add(tree, {"x": pose.x, "q": pose.q}, group=0)
        # Nothing but the body moves.
        self.world.ignore_groups(0, 0)

    def check(self, start: Any, end: Any) -> Edge:
        """The edge from one state to another; the yaw turns the short way."""
        (x0, yaw0), (x1, yaw1) = (np.asarray(start[:3], float), start[3]), (np.asarray(end[:3], float), end[3])
        turn = (yaw1 - yaw0 + np.pi) % (2 * np.pi) - np.pi
        q = [np.cos(yaw0 / 2), 0.0, 0.0, np.sin(yaw0 / 2)]
        motion = d2m_ccd.ConstantTwist(x=x0, q=q, v=x1 - x0, w=[0.0, 0.0, turn])
        first = self.world.first_contact_of({self.body: motion})
        return Edge(first.status == "separated", min(first.clear_until, 1.0))


if ob is not None:

    class OmplValidator(ob.MotionValidator):  # type: ignore[misc]
        """`Validator` for OMPL, states of a `RealVectorStateSpace(4)`."""

        def __init__(self, space_information: Any, validator: Validator) -> None:
            super().__init__(space_information)
            self.space, self.validator = space_information.getStateSpace(), validator

        def checkMotion(self, s1: Any, s2: Any, last_valid: Any = None) -> bool:
            edge = self.validator.check([s1[k] for k in range(4)], [s2[k] for k in range(4)])
            if last_valid is not None and not edge.is_free:
                last_valid.second = edge.last_valid
                self.space.interpolate(s1, s2, edge.last_valid, last_valid.first)
            return edge.is_free


def example() -> tuple[Edge, Edge]:
    """A wall with a gap: through it, and into the wall, which is thinner than any sensible step."""
    drone = d2m_ccd.Tree("shape:box?x=0.2&y=0.2&z=0.05")
    wall = d2m_ccd.Tree("shape:box?x=0.001&y=1&z=1")
    obstacles = [(wall, d2m_ccd.Pose(x=[2, y, 0])) for y in (-1.4, 1.4)]
    validator = Validator(drone, obstacles, clearance=0.01)
    return validator.check([0, 0, 0, 0], [4, 0, 0, 1]), validator.check([0, 1, 0, 0], [4, 1, 0, 1])


if __name__ == "__main__":
    through, against = example()
    print(f"through the gap: free {through.is_free}")
    print(f"into the wall: free {against.is_free}, until {against.last_valid:.6f} of the edge")
