"""Types of the extension module; what its names do stands in their docstrings."""

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal, Protocol, SupportsFloat, SupportsIndex, final, type_check_only

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Self, TypeAlias

__all__ = [
    "Answer",
    "BodyId",
    "Chain",
    "Clearance",
    "ConstantTwist",
    "Contact",
    "Departure",
    "Distance",
    "FirstContact",
    "Frozen",
    "Impulse",
    "Joint",
    "JointTrajectories",
    "Keyframes",
    "Mesh",
    "Motion",
    "Motor",
    "PairContact",
    "PathAnswer",
    "PathClearance",
    "Pose",
    "PoseTrajectories",
    "RayAnswer",
    "Robot",
    "Screw",
    "Segment",
    "Separated",
    "Simulation",
    "Snapshot",
    "Spline",
    "Spring",
    "TouchEvent",
    "Tree",
    "Undecided",
    "Verdict",
    "Witness",
    "World",
    "batch",
    "clearance",
    "collide",
    "contact_exists",
    "departure",
    "distance",
    "feature_text",
    "proximities",
    "spans",
    "time_of_contact",
    "verify",
]

@type_check_only
class _HasFaces(Protocol):
    @property
    def vertices(self) -> Any: ...
    @property
    def faces(self) -> Any: ...

@type_check_only
class _Bar(Protocol):
    def update(self, n: int, /) -> object: ...

_Float: TypeAlias = SupportsFloat | SupportsIndex
_Window: TypeAlias = tuple[_Float, _Float]
_MeshLike: TypeAlias = Mesh | Tree | _HasFaces | str | os.PathLike[str]
_MotionLike: TypeAlias = Motion | ArrayLike | Mapping[str, Any] | None
_MotionsLike: TypeAlias = _MotionLike | Sequence[Motion | Mapping[str, Any] | None] | PoseTrajectories | JointTrajectories
_PoseLike: TypeAlias = Pose | ArrayLike | None
_Solid: TypeAlias = bool | Literal["filled", "surface"] | None
_Solids: TypeAlias = _Solid | tuple[_Solid, _Solid]
_Radii: TypeAlias = _Float | tuple[_Float, _Float] | None
_Kind: TypeAlias = Literal["dynamic", "static", "kinematic", "driven"]
_Start: TypeAlias = Literal["report", "leave"]
_Mode: TypeAlias = Literal["accurate", "capoeira"]
_Status: TypeAlias = Literal["separated", "contact", "undecided"]
_State: TypeAlias = Literal["apart", "touching", "overlapping", "contained", "undecided"]
_Progress: TypeAlias = Callable[[int, int], object] | _Bar | None
_Doubles: TypeAlias = NDArray[np.float64]

@final
class Mesh:
    def __new__(cls, vertices: _MeshLike | ArrayLike, faces: ArrayLike | None = None) -> Self: ...
    @property
    def vertices(self) -> _Doubles: ...
    @property
    def faces(self) -> NDArray[np.uint32]: ...
    @property
    def vertex_count(self) -> int: ...
    @property
    def triangle_count(self) -> int: ...
    @property
    def is_watertight(self) -> bool: ...
    def validate(self) -> dict[str, Any]: ...

@final
class Tree:
    def __new__(cls, mesh: _MeshLike | ArrayLike, faces: ArrayLike | None = None) -> Self: ...
    @staticmethod
    def from_bytes(data: bytes) -> Tree: ...
    def to_bytes(self) -> bytes: ...
    @property
    def mesh(self) -> Mesh: ...
    @property
    def triangle_count(self) -> int: ...
    @property
    def is_watertight(self) -> bool: ...
    @property
    def center(self) -> _Doubles: ...
    @property
    def radius(self) -> float: ...

@final
class Pose:
    def __new__(cls, x: ArrayLike | None = None, q: ArrayLike | None = None, at: ArrayLike | None = None) -> Self: ...
    @staticmethod
    def from_matrix(matrix: ArrayLike) -> Pose: ...
    def matrix(self) -> _Doubles: ...
    @property
    def x(self) -> _Doubles: ...
    @property
    def q(self) -> _Doubles: ...
    @property
    def at(self) -> _Doubles: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

class Motion:
    @staticmethod
    def from_json(text: str) -> Motion: ...
    def to_json(self) -> str: ...
    def pose(self, time: _Float) -> Pose: ...
    def twist(self, time: _Float) -> list[_Doubles]: ...
    @property
    def domain(self) -> tuple[float, float]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class ConstantTwist(Motion):
    def __new__(
        cls,
        x: ArrayLike | None = None,
        q: ArrayLike | None = None,
        v: ArrayLike | None = None,
        w: ArrayLike | None = None,
        *,
        at: ArrayLike | None = None,
        t: _Float = 0.0,
    ) -> Self: ...
    @staticmethod
    def from_array(array: ArrayLike) -> ConstantTwist: ...
    def to_array(self) -> _Doubles: ...
    @property
    def x(self) -> _Doubles: ...
    @property
    def q(self) -> _Doubles: ...
    @property
    def v(self) -> _Doubles: ...
    @property
    def w(self) -> _Doubles: ...
    @property
    def at(self) -> _Doubles: ...
    @property
    def t(self) -> float: ...

@final
class Screw(Motion):
    def __new__(cls, start: Pose | ArrayLike, end: Pose | ArrayLike, t0: _Float = 0.0, t1: _Float = 1.0) -> Self: ...
    @staticmethod
    def from_twist(pose: _PoseLike, v: ArrayLike, w: ArrayLike, t: _Float = 0.0) -> Screw: ...
    @property
    def axis_point(self) -> _Doubles: ...
    @property
    def axis_direction(self) -> _Doubles: ...
    @property
    def pitch(self) -> float | None: ...

@final
class Keyframes(Motion):
    def __new__(
        cls, times: ArrayLike, poses: ArrayLike | Sequence[Pose], *, join: Literal["linear", "screw"] = "linear"
    ) -> Self: ...
    @property
    def times(self) -> _Doubles: ...

@final
class Spline(Motion):
    def __new__(
        cls,
        times: ArrayLike,
        poses: ArrayLike | Sequence[Pose],
        twists: ArrayLike | None = None,
        *,
        degree: Literal[3, 5] = 3,
    ) -> Self: ...
    @property
    def times(self) -> _Doubles: ...
    @property
    def degree(self) -> int: ...

@final
class Joint:
    def __new__(
        cls,
        kind: Literal["fixed", "revolute", "prismatic"] = "fixed",
        *,
        x: ArrayLike | None = None,
        q: ArrayLike | None = None,
        axis: ArrayLike | None = None,
        value: ArrayLike | tuple[ArrayLike, Sequence[ArrayLike]] | Mapping[str, Any] | None = None,
    ) -> Self: ...
    @property
    def kind(self) -> Literal["fixed", "revolute", "prismatic"]: ...
    @property
    def x(self) -> _Doubles: ...
    @property
    def q(self) -> _Doubles: ...
    @property
    def axis(self) -> _Doubles | None: ...

@final
class Chain(Motion):
    def __new__(cls, joints: Iterable[Joint | Mapping[str, Any]]) -> Self: ...

@final
class PoseTrajectories:
    def __new__(
        cls,
        times: ArrayLike,
        poses: ArrayLike,
        *,
        join: Literal["linear", "screw", "cubic", "quintic"] = "linear",
    ) -> Self: ...
    def __len__(self) -> int: ...
    def __getitem__(self, trials: slice, /) -> PoseTrajectories: ...

@final
class JointTrajectories:
    def __new__(
        cls,
        joints: Iterable[Joint | Mapping[str, Any]],
        times: ArrayLike,
        values: ArrayLike,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
    ) -> Self: ...
    def __len__(self) -> int: ...
    def __getitem__(self, trials: slice, /) -> JointTrajectories: ...

class Answer:
    @property
    def status(self) -> _Status: ...
    @property
    def clear_until(self) -> float: ...
    def to_json(self) -> str: ...
    def __bool__(self) -> bool: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Separated(Answer):
    @property
    def status(self) -> Literal["separated"]: ...

@final
class Undecided(Answer):
    @property
    def status(self) -> Literal["undecided"]: ...

@final
class Contact(Answer):
    @property
    def status(self) -> Literal["contact"]: ...
    @property
    def time_lo(self) -> float: ...
    @property
    def time_hi(self) -> float: ...
    @property
    def evidence(self) -> Literal["crossing", "near", "early"]: ...
    @property
    def separation(self) -> float: ...
    @property
    def tolerance(self) -> float: ...
    @property
    def normal(self) -> _Doubles: ...
    @property
    def point_a(self) -> _Doubles: ...
    @property
    def point_b(self) -> _Doubles: ...
    @property
    def feature(self) -> str: ...
    @property
    def triangle_a(self) -> int: ...
    @property
    def triangle_b(self) -> int: ...
    @property
    def barycentric_a(self) -> _Doubles: ...
    @property
    def barycentric_b(self) -> _Doubles: ...
    @property
    def closing_speed(self) -> float: ...
    @property
    def left(self) -> tuple[float, float] | None: ...
    @property
    def start(self) -> _State: ...

class Witness:
    @property
    def point_a(self) -> _Doubles: ...
    @property
    def point_b(self) -> _Doubles: ...
    @property
    def normal(self) -> _Doubles: ...
    @property
    def triangle_a(self) -> int: ...
    @property
    def triangle_b(self) -> int: ...

@final
class Distance(Witness):
    @property
    def value(self) -> float: ...
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def state(self) -> _State: ...
    def __float__(self) -> float: ...

@final
class Clearance(Witness):
    @property
    def status(self) -> Literal["clear", "contact", "undecided"]: ...
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def time(self) -> float: ...

@final
class Departure:
    @property
    def start(self) -> _State: ...
    @property
    def left(self) -> tuple[float, float] | None: ...
    @property
    def answer(self) -> Separated | Contact | Undecided: ...

@final
class Verdict:
    @property
    def status(self) -> Literal["verified", "refuted", "unproven"]: ...
    @property
    def time(self) -> float | None: ...
    @property
    def distance(self) -> tuple[float, float] | None: ...
    @property
    def triangles(self) -> tuple[int, int] | None: ...
    @property
    def reason(self) -> str | None: ...
    @property
    def clear_until(self) -> float | None: ...
    @property
    def a(self) -> str | None: ...
    @property
    def b(self) -> str | None: ...
    def __bool__(self) -> bool: ...

@final
class BodyId:
    @property
    def index(self) -> int: ...
    @property
    def name(self) -> str | None: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class PairContact:
    @property
    def a(self) -> BodyId: ...
    @property
    def b(self) -> BodyId: ...
    @property
    def answer(self) -> Contact | Undecided: ...

@final
class FirstContact:
    @property
    def status(self) -> _Status: ...
    @property
    def a(self) -> BodyId | None: ...
    @property
    def b(self) -> BodyId | None: ...
    @property
    def contact(self) -> Contact | None: ...
    @property
    def overlapping(self) -> list[PairContact]: ...
    @property
    def clear_until(self) -> float: ...
    def __bool__(self) -> bool: ...

@final
class World:
    def __new__(
        cls,
        *,
        tolerance: _Float | None = None,
        min_separation: _Float = 0.0,
        start: _Start = "report",
        mode: _Mode = "accurate",
        node_tests: int | None = None,
        time_limit: _Float | None = None,
        threads: int | None = None,
    ) -> Self: ...
    def add(
        self,
        tree: _MeshLike,
        motion: _MotionLike = None,
        *,
        name: str | None = None,
        group: int | None = None,
        radius: _Float = 0.0,
        solid: _Solid = None,
    ) -> BodyId: ...
    def remove(self, body: BodyId | str) -> None: ...
    def set_motion(self, body: BodyId | str, motion: _MotionLike) -> None: ...
    def ignore_pair(self, a: BodyId | str, b: BodyId | str, ignored: bool = True) -> None: ...
    def ignore_groups(self, a: int, b: int, ignored: bool = True) -> None: ...
    def set_min_separation(self, a: BodyId | str, b: BodyId | str, separation: _Float | None) -> None: ...
    def set_start(self, a: BodyId | str, b: BodyId | str, start: _Start | None) -> None: ...
    def bodies(self) -> list[BodyId]: ...
    def first_contact(self, window: _Window = ..., *, progress: _Progress = None) -> FirstContact: ...
    def contacts(self, window: _Window = ..., *, progress: _Progress = None) -> list[PairContact]: ...
    def first_contact_of(
        self,
        plan: Mapping[BodyId, _MotionLike] | Mapping[str, _MotionLike] | Iterable[tuple[BodyId | str, _MotionLike]],
        window: _Window = ...,
    ) -> FirstContact: ...
    def proximities(
        self, time: _Float, margin: _Float, *, cone_slack: _Float = 0.0
    ) -> list[tuple[BodyId, BodyId, NDArray[np.void]]]: ...
    def __len__(self) -> int: ...

@final
class PathAnswer:
    @property
    def status(self) -> Literal["free", "contact", "undecided"]: ...
    @property
    def free_until(self) -> float: ...
    @property
    def a(self) -> str | None: ...
    @property
    def b(self) -> str | None: ...
    @property
    def contact(self) -> Contact | None: ...
    def __bool__(self) -> bool: ...

@final
class PathClearance:
    @property
    def status(self) -> Literal["clear", "contact", "undecided"]: ...
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def time(self) -> float: ...
    @property
    def a(self) -> str: ...
    @property
    def b(self) -> str: ...

@final
class Robot:
    def __new__(
        cls,
        urdf: str | os.PathLike[str],
        *,
        srdf: str | os.PathLike[str] | None = None,
        packages: Mapping[str, str | os.PathLike[str]] | None = None,
        tolerance: _Float | None = None,
        min_separation: _Float = 0.0,
        start: _Start = "report",
        node_tests: int | None = None,
        time_limit: _Float | None = None,
        threads: int | None = None,
    ) -> Self: ...
    @property
    def link_names(self) -> list[str]: ...
    @property
    def joint_names(self) -> list[str]: ...
    @property
    def body_names(self) -> list[str]: ...
    @property
    def remarks(self) -> list[str]: ...
    def limits(self, joint: str) -> tuple[float, float, float]: ...
    def add_obstacle(
        self,
        name: str,
        tree: _MeshLike,
        pose: _PoseLike = None,
        *,
        motion: _MotionLike = None,
        radius: _Float = 0.0,
        solid: _Solid = None,
    ) -> None: ...
    def attach(
        self,
        name: str,
        link: str,
        tree: _MeshLike,
        pose: _PoseLike = None,
        *,
        radius: _Float = 0.0,
        solid: _Solid = None,
    ) -> None: ...
    def ignore(self, a: str, b: str) -> None: ...
    def set_start(self, a: str, b: str, start: _Start) -> None: ...
    def set_min_separation(self, a: str, b: str, distance: _Float) -> None: ...
    def clearance(
        self,
        times: ArrayLike,
        positions: ArrayLike,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
        *,
        joints: Sequence[str] | None = None,
    ) -> PathClearance | None: ...
    def verify(
        self,
        answer: PathAnswer,
        times: ArrayLike,
        positions: ArrayLike,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
        *,
        joints: Sequence[str] | None = None,
        steps: int | None = None,
    ) -> Verdict: ...
    def check_path(
        self,
        times: ArrayLike,
        positions: ArrayLike,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
        *,
        joints: Sequence[str] | None = None,
    ) -> PathAnswer: ...
    def limit_warnings(
        self,
        times: ArrayLike,
        positions: ArrayLike,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
        *,
        joints: Sequence[str] | None = None,
    ) -> list[dict[str, Any]]: ...
    def check_edge(self, start: ArrayLike, end: ArrayLike, *, joints: Sequence[str] | None = None) -> PathAnswer: ...
    def check_edges(
        self,
        start: ArrayLike,
        end: ArrayLike,
        *,
        joints: Sequence[str] | None = None,
        threads: int | None = None,
        progress: _Progress = None,
    ) -> NDArray[np.void]: ...

@final
class Impulse:
    @property
    def a(self) -> int: ...
    @property
    def b(self) -> int: ...
    @property
    def time(self) -> float: ...
    @property
    def point(self) -> _Doubles: ...
    @property
    def normal(self) -> _Doubles: ...
    @property
    def impulse(self) -> _Doubles: ...

@final
class Segment:
    @property
    def start(self) -> float: ...
    @property
    def end(self) -> float: ...
    @property
    def skipped(self) -> float: ...
    @property
    def changed(self) -> list[tuple[int, ConstantTwist]]: ...
    @property
    def removed(self) -> list[int]: ...
    @property
    def contacts(self) -> list[Impulse]: ...

@final
class TouchEvent:
    @property
    def a(self) -> int: ...
    @property
    def b(self) -> int: ...
    @property
    def time(self) -> float: ...
    @property
    def change(self) -> Literal["began", "ended"]: ...

@final
class Motor:
    def __new__(
        cls,
        *,
        velocity: _Float | None = None,
        position: _Float | None = None,
        most: _Float | None = None,
        stiffness: _Float = 0.0,
        damping: _Float = 0.0,
    ) -> Self: ...
    @property
    def velocity(self) -> float | None: ...
    @property
    def position(self) -> float | None: ...
    @property
    def most(self) -> float | None: ...
    @property
    def stiffness(self) -> float: ...
    @property
    def damping(self) -> float: ...

@final
class Spring:
    def __new__(cls, stiffness: _Float, damping: _Float = 0.0, rest: _Float = 0.0) -> Self: ...
    @property
    def stiffness(self) -> float: ...
    @property
    def damping(self) -> float: ...
    @property
    def rest(self) -> float: ...

@final
class RayAnswer:
    @property
    def status(self) -> Literal["free", "hit", "undecided"]: ...
    @property
    def body(self) -> int | None: ...
    @property
    def lo(self) -> float | None: ...
    @property
    def hi(self) -> float | None: ...
    @property
    def point(self) -> _Doubles | None: ...
    @property
    def normal(self) -> _Doubles | None: ...
    @property
    def free_until(self) -> float | None: ...

@final
class Frozen:
    def ray(self, origin: ArrayLike, way: ArrayLike) -> RayAnswer: ...
    def distance(self, a: int | str, b: int | str) -> Distance: ...
    def __len__(self) -> int: ...

@final
class Snapshot:
    def to_bytes(self) -> bytes: ...
    @staticmethod
    def from_bytes(data: bytes) -> Snapshot: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

@final
class Simulation:
    def __new__(
        cls,
        *,
        gravity: ArrayLike | None = None,
        step: _Float = 0.01,
        gap: _Float = 0.001,
        max_events: int = 128,
        sleeping: bool = True,
        threads: int | None = None,
    ) -> Self: ...
    def add(
        self,
        tree: _MeshLike,
        *,
        name: str | None = None,
        kind: _Kind = "dynamic",
        pose: _PoseLike = None,
        motion: _MotionLike = None,
        v: ArrayLike | None = None,
        w: ArrayLike | None = None,
        density: _Float | None = None,
        mass: _Float | None = None,
        center: ArrayLike | None = None,
        inertia: ArrayLike | None = None,
        restitution: _Float = 0.0,
        friction: _Float = 0.0,
        solid: _Solid = None,
        radius: _Float = 0.0,
        linear_damping: _Float = 0.0,
        angular_damping: _Float = 0.0,
        groups: tuple[int, int] | None = None,
        presence: Literal["solid", "sensor"] = "solid",
        surface_velocity: ArrayLike | None = None,
        checked: bool = False,
    ) -> int: ...
    def remove(self, body: int | str) -> None: ...
    def set_pose(self, body: int | str, pose: _PoseLike) -> None: ...
    def set_velocity(self, body: int | str, v: ArrayLike, w: ArrayLike | None = None) -> None: ...
    def set_gravity(self, gravity: ArrayLike) -> None: ...
    def set_material(self, body: int | str, *, restitution: _Float, friction: _Float) -> None: ...
    def set_damping(self, body: int | str, *, linear: _Float = 0.0, angular: _Float = 0.0) -> None: ...
    def set_surface_velocity(self, body: int | str, velocity: ArrayLike) -> None: ...
    def set_groups(self, body: int | str, *, member: int | None = None, meets: int | None = None) -> None: ...
    def set_kind(self, body: int | str, kind: _Kind, *, motion: _MotionLike = None) -> None: ...
    def set_motion(self, body: int | str, motion: _MotionLike) -> None: ...
    def set_target(self, body: int | str, pose: _PoseLike) -> None: ...
    def ignore(self, a: int | str, b: int | str) -> None: ...
    def heed(self, a: int | str, b: int | str) -> None: ...
    def set_pair(self, a: int | str, b: int | str, *, restitution: _Float, friction: _Float) -> None: ...
    def set_force(self, body: int | str, force: ArrayLike, torque: ArrayLike | None = None) -> None: ...
    def add_force_at(self, body: int | str, force: ArrayLike, point: ArrayLike) -> None: ...
    def apply_impulse(self, body: int | str, impulse: ArrayLike, angular: ArrayLike | None = None) -> None: ...
    def apply_impulse_at(self, body: int | str, impulse: ArrayLike, point: ArrayLike) -> None: ...
    def wake(self, body: int | str) -> None: ...
    def is_asleep(self, body: int | str) -> bool: ...
    def touch(self, a: int | str, b: int | str) -> bool: ...
    def add_joint(
        self,
        kind: Literal["fixed", "revolute", "prismatic", "spherical", "locked"],
        a: int | str,
        b: int | str | None = None,
        *,
        point: ArrayLike | None = None,
        axis: ArrayLike | None = None,
        limits: tuple[_Float, _Float] | None = None,
        motor: Motor | None = None,
        spring: Spring | None = None,
        friction: _Float = 0.0,
        collide: bool = False,
        ways: Sequence[bool] | None = None,
        turns: Sequence[bool] | None = None,
    ) -> int: ...
    def remove_joint(self, joint: int) -> None: ...
    def joint_value(self, joint: int) -> float: ...
    def set_motor(self, joint: int, motor: Motor | None) -> None: ...
    def frozen(self, *, node_tests: int | None = None, time_limit: _Float | None = None) -> Frozen: ...
    def snapshot(self) -> Snapshot: ...
    def restore(self, snapshot: Snapshot) -> None: ...
    def advance(self, until: _Float, *, progress: _Progress = None) -> list[Segment]: ...
    @property
    def touches(self) -> list[TouchEvent]: ...
    @property
    def time(self) -> float: ...
    def pose(self, body: int | str) -> Pose: ...
    def poses(self) -> _Doubles: ...
    def velocities(self) -> _Doubles: ...
    def __len__(self) -> int: ...

def time_of_contact(
    a: _MeshLike,
    b: _MeshLike,
    motion_a: _MotionLike = None,
    motion_b: _MotionLike = None,
    *,
    window: _Window = ...,
    tolerance: _Float | None = None,
    min_separation: _Float = 0.0,
    radius: _Radii = None,
    solid: _Solids = None,
    start: _Start = "report",
    mode: _Mode = "accurate",
    node_tests: int | None = None,
    time_limit: _Float | None = None,
    parallel: bool = False,
) -> Separated | Contact | Undecided: ...
def contact_exists(
    a: _MeshLike,
    b: _MeshLike,
    motion_a: _MotionLike = None,
    motion_b: _MotionLike = None,
    *,
    window: _Window = ...,
    tolerance: _Float | None = None,
    min_separation: _Float = 0.0,
    radius: _Radii = None,
    solid: _Solids = None,
    node_tests: int | None = None,
    time_limit: _Float | None = None,
) -> bool | None: ...
def departure(
    a: _MeshLike,
    b: _MeshLike,
    motion_a: _MotionLike = None,
    motion_b: _MotionLike = None,
    *,
    window: _Window = ...,
    tolerance: _Float | None = None,
    min_separation: _Float = 0.0,
    radius: _Radii = None,
    solid: _Solids = None,
    node_tests: int | None = None,
    time_limit: _Float | None = None,
) -> Departure: ...
def clearance(
    a: _MeshLike,
    b: _MeshLike,
    motion_a: _MotionLike = None,
    motion_b: _MotionLike = None,
    *,
    window: _Window = ...,
    accuracy: _Float = 1e-6,
    tolerance: _Float | None = None,
    radius: _Radii = None,
    solid: _Solids = None,
    node_tests: int | None = None,
    time_limit: _Float | None = None,
) -> Clearance: ...
def spans(
    a: _MeshLike,
    b: _MeshLike,
    motion_a: _MotionLike = None,
    motion_b: _MotionLike = None,
    *,
    window: _Window = ...,
    resolution: _Float | None = None,
    tolerance: _Float | None = None,
    min_separation: _Float = 0.0,
    radius: _Radii = None,
    solid: _Solids = None,
    node_tests: int | None = None,
    time_limit: _Float | None = None,
) -> list[tuple[float, float, Literal["clear", "contact", "undecided"]]]: ...
def batch(
    a: _MeshLike,
    b: _MeshLike,
    motions_a: _MotionsLike = None,
    motions_b: _MotionsLike = None,
    *,
    window: _Window | ArrayLike | None = None,
    tolerance: _Float | None = None,
    min_separation: _Float = 0.0,
    radius: _Radii = None,
    solid: _Solids = None,
    start: _Start = "report",
    mode: _Mode = "accurate",
    node_tests: int | None = None,
    time_limit: _Float | None = None,
    threads: int | None = None,
    progress: _Progress = None,
) -> NDArray[np.void]: ...
def distance(
    a: _MeshLike,
    b: _MeshLike,
    pose_a: _PoseLike = None,
    pose_b: _PoseLike = None,
    *,
    solid: _Solids = None,
    cutoff: _Float | None = None,
) -> Distance | None: ...
def collide(
    a: _MeshLike,
    b: _MeshLike,
    pose_a: _PoseLike = None,
    pose_b: _PoseLike = None,
    *,
    solid: _Solids = None,
    node_tests: int | None = None,
    time_limit: _Float | None = None,
) -> bool | None: ...
def proximities(
    a: _MeshLike,
    b: _MeshLike,
    pose_a: _PoseLike = None,
    pose_b: _PoseLike = None,
    *,
    margin: _Float,
    cone_slack: _Float = 0.0,
) -> NDArray[np.void]: ...
def feature_text(kind: int, features: Sequence[int] | NDArray[np.uint32]) -> str: ...
def verify(
    a: _MeshLike,
    b: _MeshLike,
    answer: Answer | Departure,
    motion_a: _MotionLike = None,
    motion_b: _MotionLike = None,
    *,
    window: _Window = ...,
    tolerance: _Float | None = None,
    min_separation: _Float = 0.0,
    radius: _Radii = None,
    solid: _Solids = None,
    start: _Start = "report",
    mode: _Mode = "accurate",
    steps: int | None = None,
) -> Verdict: ...
