"""What pickled objects are made again by."""

from __future__ import annotations

from typing import Any

from . import _d2m


def spline(times: Any, poses: Any, twists: Any, degree: int) -> _d2m.Spline:
    """A spline of its arguments."""
    return _d2m.Spline(times, poses, twists, degree=degree)


def joint(kind: str, x: Any, q: Any, axis: Any, value: Any) -> _d2m.Joint:
    """A joint of its arguments."""
    return _d2m.Joint(kind, x=x, q=q, axis=axis, value=value)
