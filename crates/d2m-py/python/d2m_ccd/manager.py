"""A collision manager with the methods of `trimesh.collision.CollisionManager`, and the first contact of objects that move."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ._d2m import Distance, FirstContact, Pose, Tree, World, collide, distance
from ._errors import InputError

_EXTERNAL = "__external"

#: Spheres are compared in floating point: what is closer than this part of the lengths that enter is asked exactly.
_SLACK = 1e-9


class ContactData:
    """Two objects that share a point.

    `names` of both; `index(name)`: a triangle of that object which meets the other one; `point`: a point of that triangle, shape (3,).
    Surfaces that cross have no proven depth: `depth` is not a number, and `normal` is zero.

    >>> import d2m_ccd
    >>> manager = d2m_ccd.CollisionManager()
    >>> for name in ("a", "b"):
    ...     manager.add_object(name, "shape:box")
    >>> collides, contacts = manager.in_collision_internal(return_data=True)
    >>> sorted(contacts[0].names)
    ['a', 'b']
    """

    def __init__(self, names: tuple[str, str], found: Distance) -> None:
        self.names = set(names)
        self._triangles = {names[0]: found.triangle_a, names[1]: found.triangle_b}
        self._found = found

    @property
    def normal(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """Zero: surfaces that cross have none."""
        return self._found.normal

    @property
    def point(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """A point of the first object's triangle, shape (3,)."""
        return self._found.point_a

    @property
    def depth(self) -> float:
        """Not a number: no depth is proven."""
        return float("nan")

    def index(self, name: str) -> int:
        """The triangle of that object."""
        return self._triangles[name]


class DistanceData:
    """How far apart two objects are, and where.

    `names` of both; `distance`, and `lower` and `upper`, which are proven; `index(name)`: the closest triangle; `point(name)`: the closest
    point, world frame, shape (3,).

    >>> import d2m_ccd
    >>> manager = d2m_ccd.CollisionManager()
    >>> manager.add_object("a", "shape:box?x=0.5&y=0.5&z=0.5")
    >>> manager.add_object("b", "shape:box?x=0.5&y=0.5&z=0.5", d2m_ccd.Pose(x=[3, 0, 0]))
    >>> least, data = manager.min_distance_internal(return_data=True)
    >>> round(least, 12), data.point("b").round(9).tolist()[0]
    (2.0, 2.5)
    """

    def __init__(self, names: tuple[str, str], found: Distance) -> None:
        self.names = set(names)
        self._triangles = {names[0]: found.triangle_a, names[1]: found.triangle_b}
        self._points = {names[0]: found.point_a, names[1]: found.point_b}
        self._found = found

    @property
    def distance(self) -> float:
        """The distance to rounding; 0 if the objects are not proven apart."""
        return self._found.value

    @property
    def lower(self) -> float:
        """Proven: the distance is at least this."""
        return self._found.lower

    @property
    def upper(self) -> float:
        """Proven: the distance is at most this."""
        return self._found.upper

    def index(self, name: str) -> int:
        """The closest triangle of that object."""
        return self._triangles[name]

    def point(self, name: str) -> np.ndarray[Any, np.dtype[np.float64]]:
        """The closest point on that object, world frame, shape (3,)."""
        return self._points[name]


class _Object:
    def __init__(self, tree: Tree, pose: Pose) -> None:
        self.tree = tree
        self.place(pose)

    def place(self, pose: Pose) -> None:
        self.pose = pose
        matrix = pose.matrix()
        self.middle = matrix[:3, :3] @ self.tree.center + matrix[:3, 3]


class CollisionManager:
    """Objects at rest, by name, with the methods of `trimesh.collision.CollisionManager`; and `first_contact`.

    Change the import and keep the rest. What differs: answers are certified ("no collision" is a proof); transforms stay in double
    precision; a closed mesh is solid, so that what is inside of it collides (`solid=False` for surfaces, as FCL has them); objects
    that collide have distance 0 instead of a negative one; contacts name one pair of triangles for each pair of objects.

    Raises `InputError` for meshes and transforms that are none, and `ValueError` for names that are not there.

    >>> import numpy, d2m_ccd
    >>> manager = d2m_ccd.CollisionManager()
    >>> manager.add_object("table", "shape:box?x=0.5&y=0.5&z=0.5")
    >>> above = numpy.eye(4)
    >>> above[2, 3] = 3
    >>> manager.add_object("cup", "shape:box?x=0.5&y=0.5&z=0.5", above)
    >>> manager.in_collision_internal(), round(manager.min_distance_internal(), 9)
    (False, 2.0)
    >>> first = manager.first_contact({"cup": {"x": [0, 0, 3], "v": [0, 0, -4]}})
    >>> first.status, first.a.name, first.b.name
    ('contact', 'table', 'cup')
    """

    def __init__(self, *, solid: bool | None = None) -> None:
        self._objects: dict[str, _Object] = {}
        self._solid = solid

    def __len__(self) -> int:
        return len(self._objects)

    def __repr__(self) -> str:
        return f"CollisionManager({len(self)} objects)"

    def add_object(self, name: str, mesh: Any, transform: Any = None) -> None:
        """Adds an object, or replaces that of the same name: a mesh (what `Tree` takes) and a matrix of shape (4, 4).

        >>> import d2m_ccd
        >>> d2m_ccd.CollisionManager().add_object("a", "shape:box")
        """
        tree = mesh if isinstance(mesh, Tree) else Tree(mesh)
        self._objects[name] = _Object(tree, _pose(transform))

    def remove_object(self, name: str) -> None:
        """Takes an object out."""
        self._find(name)
        del self._objects[name]

    def set_transform(self, name: str, transform: Any) -> None:
        """Places an object: a matrix of shape (4, 4), or a `Pose`."""
        self._find(name).place(_pose(transform))

    def in_collision_single(
        self, mesh: Any, transform: Any = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Does this mesh share a point with an object? With the names of those objects, and a list of `ContactData`, if asked."""
        single = _Object(mesh if isinstance(mesh, Tree) else Tree(mesh), _pose(transform))
        pairs = [((name, _EXTERNAL), (other, single)) for name, other in self._objects.items()]
        found, contacts = self._colliding(pairs, return_names or return_data, return_data)
        return _collision_answer(bool(found), {names[0] for names in found}, contacts, return_names, return_data)

    def in_collision_internal(self, return_names: bool = False, return_data: bool = False) -> Any:
        """Do two objects share a point? With a set of their names, and a list of `ContactData`, if asked."""
        found, contacts = self._colliding(self._near_pairs(), return_names or return_data, return_data)
        names = {(min(pair), max(pair)) for pair in found}
        return _collision_answer(bool(found), names, contacts, return_names, return_data)

    def in_collision_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """Does an object share a point with one of another manager? With names (first of this one), and data, if asked."""
        pairs = _between(self, other_manager)
        found, contacts = self._colliding(pairs, return_names or return_data, return_data)
        return _collision_answer(bool(found), set(found), contacts, return_names, return_data)

    def min_distance_single(
        self, mesh: Any, transform: Any = None, return_name: bool = False, return_data: bool = False
    ) -> Any:
        """The distance of this mesh to the nearest object; with its name, and `DistanceData`, if asked."""
        single = _Object(mesh if isinstance(mesh, Tree) else Tree(mesh), _pose(transform))
        pairs = [((name, _EXTERNAL), (other, single)) for name, other in self._objects.items()]
        names, found = self._nearest(pairs)
        return _distance_answer(names[0] if names else None, names, found, return_name, return_data)

    def min_distance_internal(
        self, name: str | None = None, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """The least distance of two objects (one of which is `name`); with their names, and `DistanceData`, if asked."""
        if name is not None:
            self._find(name)
        pairs = [pair for pair in _within(self) if name is None or name in pair[0]]
        names, found = self._nearest(pairs)
        ordered = None if names is None else (min(names), max(names))
        return _distance_answer(ordered, names, found, return_names, return_data)

    def min_distance_other(
        self, other_manager: CollisionManager, return_names: bool = False, return_data: bool = False
    ) -> Any:
        """The least distance to an object of another manager; with names (first of this one), and data, if asked."""
        names, found = self._nearest(_between(self, other_manager))
        return _distance_answer(names, names, found, return_names, return_data)

    def first_contact(
        self, motions: Mapping[str, Any], window: tuple[float, float] = (0.0, 1.0), **options: Any
    ) -> FirstContact:
        """The first contact in the window when these objects move so, and the others stay.

        `motions`: motions by names, as of `time_of_contact`, which say where the objects are instead of their transforms. `options`
        are those of `World`. Pairs that stay are left out.

        >>> import d2m_ccd
        >>> manager = d2m_ccd.CollisionManager()
        >>> manager.add_object("a", "shape:box")
        >>> manager.first_contact({"a": {"v": [1, 0, 0]}}).status
        'separated'
        """
        for name in motions:
            self._find(name)
        world = World(**options)
        bodies = {}
        for name, placed in self._objects.items():
            pose = placed.pose
            motion = {"x": pose.x, "q": pose.q, "at": pose.at}
            group = None if name in motions else 0
            bodies[name] = world.add(placed.tree, motion, name=name, group=group, solid=self._solid)
        world.ignore_groups(0, 0)
        return world.first_contact_of({bodies[name]: motion for name, motion in motions.items()}, window)

    def _find(self, name: str) -> _Object:
        try:
            return self._objects[name]
        except KeyError:
            raise ValueError(f"{name} not in collision manager!") from None

    def _near_pairs(self) -> Iterator[_Pair]:
        """Pairs whose spheres are not apart."""
        names = list(self._objects)
        placed = list(self._objects.values())
        middles = np.array([one.middle for one in placed]).reshape(-1, 3)
        radii = np.array([one.tree.radius for one in placed])
        size = np.abs(middles).sum(axis=1) + radii
        for i in range(len(placed) - 1):
            apart = np.linalg.norm(middles[i + 1 :] - middles[i], axis=1)
            reach = radii[i + 1 :] + radii[i] + _SLACK * (size[i + 1 :] + size[i])
            # A comparison with what is no number keeps the pair.
            for j in np.flatnonzero(~(apart > reach)) + i + 1:
                yield (names[i], names[j]), (placed[i], placed[j])

    def _colliding(
        self, pairs: Iterator[_Pair] | list[_Pair], all_of_them: bool, data: bool
    ) -> tuple[list[tuple[str, str]], list[ContactData]]:
        found, contacts = [], []
        for names, (a, b) in pairs:
            if collide(a.tree, b.tree, a.pose, b.pose, solid=self._solid):
                found.append(names)
                if data:
                    contacts.append(ContactData(names, _distance(a, b, self._solid)))
                if not all_of_them:
                    break
        return found, contacts

    def _nearest(self, pairs: list[_Pair]) -> tuple[tuple[str, str] | None, Distance | None]:
        """Nearest spheres first, so that most of the others are beyond the cutoff at once."""
        if not pairs:
            return None, None
        middles = np.array([[a.middle, b.middle] for _, (a, b) in pairs])
        reach = np.array([a.tree.radius + b.tree.radius for _, (a, b) in pairs])
        order = np.argsort(np.linalg.norm(middles[:, 1] - middles[:, 0], axis=1) - reach, kind="stable")
        best: tuple[tuple[str, str] | None, Distance | None] = (None, None)
        cutoff = None
        for place in order:
            names, (a, b) = pairs[place]
            found = distance(a.tree, b.tree, a.pose, b.pose, solid=self._solid, cutoff=cutoff)
            if found is not None and (cutoff is None or found.value < cutoff):
                best, cutoff = (names, found), found.value
                if cutoff == 0.0:
                    break
        return best


_Pair = tuple[tuple[str, str], tuple[_Object, _Object]]


def _pose(transform: Any) -> Pose:
    if transform is None:
        return Pose()
    if isinstance(transform, Pose):
        return transform
    return Pose.from_matrix(transform)


def _distance(a: _Object, b: _Object, solid: bool | None) -> Distance:
    found = distance(a.tree, b.tree, a.pose, b.pose, solid=solid)
    if found is None:
        raise InputError("without a cutoff there is always a distance")
    return found


def _within(manager: CollisionManager) -> list[_Pair]:
    pairs = itertools.combinations(manager._objects.items(), 2)
    return [((a, b), (one, other)) for (a, one), (b, other) in pairs]


def _between(manager: CollisionManager, other: CollisionManager) -> list[_Pair]:
    pairs = itertools.product(manager._objects.items(), other._objects.items())
    return [((a, b), (one, two)) for (a, one), (b, two) in pairs]


def _collision_answer(result: bool, names: set[Any], contacts: list[ContactData], with_names: bool, with_data: bool) -> Any:
    if with_names and with_data:
        return result, names, contacts
    if with_names:
        return result, names
    return (result, contacts) if with_data else result


def _distance_answer(
    shown: Any, names: tuple[str, str] | None, found: Distance | None, with_names: bool, with_data: bool
) -> Any:
    value = float("inf") if found is None else found.value
    data = None if found is None or names is None else DistanceData(names, found)
    if with_names and with_data:
        return value, shown, data
    if with_names:
        return value, shown
    return (value, data) if with_data else value
