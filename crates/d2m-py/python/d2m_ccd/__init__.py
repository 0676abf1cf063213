"""d2m: certified continuous collision detection of rigid bodies.

Two bodies are triangle meshes, each with a rigid motion over a window of time: do they meet, and when first? Answers are
certificates: never a missed contact, never a late one.

>>> import d2m_ccd
>>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
>>> d2m_ccd.time_of_contact(box, box, d2m_ccd.ConstantTwist(x=[3, 0, 0], v=[-4, 0, 0])).status
'contact'
"""

from __future__ import annotations

from ._d2m import (
    Answer,
    BodyId,
    Chain,
    Clearance,
    ConstantTwist,
    Contact,
    Distance,
    FirstContact,
    Impulse,
    Joint,
    JointTrajectories,
    Keyframes,
    Mesh,
    Motion,
    PairContact,
    PathAnswer,
    Pose,
    PoseTrajectories,
    Robot,
    Screw,
    Segment,
    Separated,
    Simulation,
    Spline,
    Tree,
    Undecided,
    Verdict,
    World,
    batch,
    clearance,
    collide,
    contact_exists,
    distance,
    feature_text,
    proximities,
    spans,
    time_of_contact,
    verify,
)
from ._errors import InputError
from ._records import EDGE, EXAMPLE_URDF, PROXIMITY, RESULT, Evidence, FeatureKind, Start, Status
from .manager import CollisionManager, ContactData, DistanceData

__all__ = [
    "EDGE",
    "EXAMPLE_URDF",
    "PROXIMITY",
    "RESULT",
    "Answer",
    "BodyId",
    "Chain",
    "Clearance",
    "CollisionManager",
    "ConstantTwist",
    "Contact",
    "ContactData",
    "Distance",
    "DistanceData",
    "Evidence",
    "FeatureKind",
    "FirstContact",
    "Impulse",
    "InputError",
    "Joint",
    "JointTrajectories",
    "Keyframes",
    "Mesh",
    "Motion",
    "PairContact",
    "PathAnswer",
    "Pose",
    "PoseTrajectories",
    "Robot",
    "Screw",
    "Segment",
    "Separated",
    "Simulation",
    "Spline",
    "Start",
    "Status",
    "Tree",
    "Undecided",
    "Verdict",
    "World",
    "batch",
    "clearance",
    "collide",
    "contact_exists",
    "distance",
    "feature_text",
    "proximities",
    "spans",
    "time_of_contact",
    "verify",
]
