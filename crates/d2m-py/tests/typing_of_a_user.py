"""What a user writes, for mypy and pyright: it is read by them and run by pytest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import d2m_ccd
import numpy as np

if TYPE_CHECKING:
    from typing_extensions import assert_type


def use() -> float:
    tree = d2m_ccd.Tree(d2m_ccd.Mesh("shape:box"))
    answer = d2m_ccd.time_of_contact(tree, tree, d2m_ccd.ConstantTwist(x=[9, 0, 0], v=[-9, 0, 0]), window=(0, 1))
    if TYPE_CHECKING:
        assert_type(answer, "d2m_ccd.Separated | d2m_ccd.Contact | d2m_ccd.Undecided")
    if isinstance(answer, d2m_ccd.Contact):
        if TYPE_CHECKING:
            assert_type(answer.time_lo, float)
        return float(answer.normal @ answer.point_a)
    results = d2m_ccd.batch(tree, tree, np.zeros((3, 13)), [None, None, None], window=np.zeros((3, 2)), threads=1)
    return float(results["time_lo"].min())


def world() -> str:
    scene = d2m_ccd.World(min_separation=1e-3)
    scene.add("shape:box", name="a")
    first = scene.first_contact((0.0, 2.0), progress=lambda done, total: None)
    near = d2m_ccd.distance("shape:box", "shape:box", np.eye(4), cutoff=1.0)
    return first.status + (near.state if near is not None else "far")


def simulation() -> float:
    running = d2m_ccd.Simulation()
    gate = running.add("shape:box", kind="driven", presence="sensor", groups=(1, 3))
    hung = running.add("shape:box", name="hung", surface_velocity=np.zeros(3), checked=True)
    hinge = running.add_joint("revolute", "hung", limits=(-1, 1), spring=d2m_ccd.Spring(1.0))
    running.set_motor(hinge, d2m_ccd.Motor(velocity=1, most=2))
    running.set_target(gate, d2m_ccd.Pose(x=[0.01, 0, 0]))
    running.advance(0.1)
    running.restore(d2m_ccd.Snapshot.from_bytes(running.snapshot().to_bytes()))
    met = running.frozen(node_tests=10**6).ray([0, 5, 0], np.array([0.0, -10, 0]))
    if TYPE_CHECKING:
        assert_type(met.body, "int | None")
        assert_type(running.touches, "list[d2m_ccd.TouchEvent]")
    return running.joint_value(hinge) + hung
