"""What several tests share."""

from __future__ import annotations

import d2m_ccd
import numpy as np
import pytest

BOX = "shape:box?x=0.5&y=0.5&z=0.5"


@pytest.fixture(scope="session")
def box() -> d2m_ccd.Tree:
    """A cube of edge length 1 about the origin."""
    return d2m_ccd.Tree(BOX)


@pytest.fixture(scope="session")
def knots() -> tuple[d2m_ccd.Tree, d2m_ccd.Tree]:
    """Two bodies that are not convex."""
    return d2m_ccd.Tree("shape:torus-knot?triangles=1500"), d2m_ccd.Tree("shape:torus-knot?triangles=1000")


def random_motions(count: int, seed: int, distance: float) -> np.ndarray:
    """Bodies that fly by the origin, from all sides and about this distance away, and spin."""
    random = np.random.default_rng(seed)
    q = random.normal(size=(count, 4))
    x = random.normal(size=(count, 3))
    x *= distance / np.linalg.norm(x, axis=1, keepdims=True)
    v = random.normal(size=(count, 3)) * (0.2 * distance) - x
    return np.hstack([q, x, v, random.normal(size=(count, 3))])
