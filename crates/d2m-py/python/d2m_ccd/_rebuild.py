"""What pickled objects are made again by."""

from __future__ import annotations

import json
from typing import Any

from . import _d2m


def spline(times: Any, poses: Any, twists: Any, degree: Any) -> _d2m.Spline:
    """A spline of its arguments."""
    return _d2m.Spline(times, poses, twists, degree=degree)


def joint(kind: Any, x: Any, q: Any, axis: Any, value: Any) -> _d2m.Joint:
    """A joint of its arguments."""
    return _d2m.Joint(kind, x=x, q=q, axis=axis, value=None if value is None else json.loads(value))


def pose_trajectories(times: Any, poses: Any, join: Any) -> _d2m.PoseTrajectories:
    """Trajectories of their arguments."""
    return _d2m.PoseTrajectories(times, poses, join=join)


def robot(file: Any, text: Any, meshes: Any, srdf: Any, keywords: Any, changes: Any) -> _d2m.Robot:
    """A robot of its texts and meshes, and of what was added to its scene."""
    made: _d2m.Robot = _d2m.Robot._of_pickle(file, text, meshes, srdf, keywords)
    for method, arguments, named in changes:
        getattr(made, method)(*arguments, **named)
    return made
