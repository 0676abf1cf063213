"""The structured arrays that batches and proximities give."""

from __future__ import annotations

import enum

import numpy as np

#: Of `batch`. What a verdict does not have is zero; `time_lo` and `time_hi` of what is separated are infinite, and `time_lo` of
#: what is undecided is the end of what is proven free.
RESULT = np.dtype(
    [
        ("status", "u1"),
        ("evidence", "u1"),
        ("start", "u1"),
        ("feature_kind", "u1"),
        ("reserved", "u4"),
        ("time_lo", "f8"),
        ("time_hi", "f8"),
        ("separation", "f8"),
        ("tolerance", "f8"),
        ("closing_speed", "f8"),
        ("normal", "f8", (3,)),
        ("point_a", "f8", (3,)),
        ("point_b", "f8", (3,)),
        ("barycentric_a", "f8", (3,)),
        ("barycentric_b", "f8", (3,)),
        ("triangle_a", "u4"),
        ("triangle_b", "u4"),
        ("features", "u4", (4,)),
    ]
)

#: Of `Robot.check_edges`: the first contact, the part of the edge that is proven free, and the places of the pair in `body_names`.
EDGE = np.dtype([*((name, RESULT[name]) for name in RESULT.names or ()), ("free_until", "f8"), ("body_a", "i4"), ("body_b", "i4")])

#: A robot of two links that is small enough for examples.
EXAMPLE_URDF = """<robot name="two">
  <link name="base"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="arm"><collision><origin xyz="0.5 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1"/></joint>
</robot>"""

#: Of `proximities`.
PROXIMITY = np.dtype(
    [
        ("feature_kind", "u1"),
        ("reserved", "u1", (7,)),
        ("distance", "f8"),
        ("tilt", "f8"),
        ("normal", "f8", (3,)),
        ("point_a", "f8", (3,)),
        ("point_b", "f8", (3,)),
        ("triangle_a", "u4"),
        ("triangle_b", "u4"),
        ("features", "u4", (4,)),
    ]
)


class Status(enum.IntEnum):
    """The field `status` of a result.

    >>> from d2m_ccd import Status
    >>> Status(1).name
    'CONTACT'
    """

    SEPARATED = 0
    CONTACT = 1
    UNDECIDED = 2


class Evidence(enum.IntEnum):
    """The field `evidence` of a result: what is proven of the meeting itself.

    >>> from d2m_ccd import Evidence
    >>> Evidence.EARLY < Evidence.NEAR < Evidence.CROSSING
    True
    """

    EARLY = 0
    NEAR = 1
    CROSSING = 2


class Start(enum.IntEnum):
    """The field `start` of a result: how the bodies stood at the start of the window.

    >>> from d2m_ccd import Start
    >>> Start(0).name
    'APART'
    """

    APART = 0
    TOUCHING = 1
    OVERLAPPING = 2
    CONTAINED = 3
    UNDECIDED = 4


class FeatureKind(enum.IntEnum):
    """The field `feature_kind`: what the numbers in `features` are.

    >>> from d2m_ccd import FeatureKind
    >>> FeatureKind.EDGE_EDGE.value
    3
    """

    NONE = 0
    VERTEX_FACE = 1
    FACE_VERTEX = 2
    EDGE_EDGE = 3
