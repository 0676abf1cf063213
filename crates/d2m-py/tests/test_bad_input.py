"""Bad input gives an exception with index and value, never a crash."""

from __future__ import annotations

import math
from typing import Any, Callable

import d2m_ccd
import numpy as np
import pytest
from d2m_ccd import InputError

CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
NAN = math.nan


def corners(place: tuple[int, int], value: Any, dtype: Any = float) -> np.ndarray:
    changed = CORNERS.astype(dtype)
    changed[place] = value
    return changed


def faces(place: tuple[int, int], value: Any, dtype: Any = np.int64) -> np.ndarray:
    changed = FACES.astype(dtype)
    changed[place] = value
    return changed


def expect(make: Callable[[], Any], index: Any, value: Any, *words: str) -> None:
    with pytest.raises(InputError) as caught:
        make()
    error = caught.value
    assert error.index == index
    assert error.value == value or (value != value and error.value != error.value)
    for word in words:
        assert word in str(error)


@pytest.mark.parametrize("value", [NAN, math.inf, -math.inf])
def test_vertices_that_are_not_finite(value: float) -> None:
    expect(lambda: d2m_ccd.Mesh(corners((2, 1), value), FACES), (2, 1), value, "vertex 2", "y")


def test_vertices_beyond_the_limit() -> None:
    expect(lambda: d2m_ccd.Mesh(corners((1, 2), 1e61), FACES), (1, 2), 1e61, "1e60")


@pytest.mark.parametrize("dtype", [np.int8, np.int16, np.int32, np.int64])
def test_negative_vertex_numbers(dtype: Any) -> None:
    expect(lambda: d2m_ccd.Mesh(CORNERS, faces((1, 2), -1, dtype)), (1, 2), -1, "triangle 1")


@pytest.mark.parametrize(("value", "dtype"), [(2**32, np.int64), (2**63 - 1, np.int64), (2**64 - 1, np.uint64)])
def test_huge_vertex_numbers(value: int, dtype: Any) -> None:
    expect(lambda: d2m_ccd.Mesh(CORNERS, faces((3, 0), value, dtype)), (3, 0), value, "triangle 3")


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.uint32, np.uint64, np.int8, np.int32, np.int64])
def test_vertex_numbers_out_of_range(dtype: Any) -> None:
    expect(lambda: d2m_ccd.Mesh(CORNERS, faces((3, 0), 4, dtype)), 3, 4, "triangle 3", "4 vertices")


def test_whole_numbers_that_are_no_doubles() -> None:
    value = 2**53 + 1
    expect(lambda: d2m_ccd.Mesh(corners((3, 2), value, np.int64), FACES), (3, 2), value, "2^53")
    expect(lambda: d2m_ccd.Mesh([[2**70, 0, 0]] * 3, [[0, 1, 2]]), None, "object", "object")


def test_whole_numbers_that_are_doubles() -> None:
    mesh = d2m_ccd.Mesh(corners((3, 2), 2**53 - 1, np.int64), FACES)
    assert mesh.vertices[3, 2] == 2**53 - 1


@pytest.mark.parametrize("bad", [np.float64, np.bool_, np.complex128, object, "U4"])
def test_faces_of_other_types(bad: Any) -> None:
    with pytest.raises(InputError, match="whole numbers"):
        d2m_ccd.Mesh(CORNERS, FACES.astype(bad))


@pytest.mark.parametrize("bad", [np.bool_, np.complex128, object, "U4", "M8[s]"])
def test_vertices_of_other_types(bad: Any) -> None:
    with pytest.raises(InputError, match="numbers"):
        d2m_ccd.Mesh(CORNERS.astype(np.int64).astype(bad) if bad == "M8[s]" else CORNERS.astype(bad), FACES)


@pytest.mark.parametrize("shape", [(4,), (4, 2), (4, 4), (2, 2, 3), (), (0, 2)])
def test_vertices_of_other_shapes(shape: tuple[int, ...]) -> None:
    with pytest.raises(InputError, match="shape"):
        d2m_ccd.Mesh(np.zeros(shape), FACES)


@pytest.mark.parametrize("shape", [(4,), (4, 4), (2, 2, 3), ()])
def test_faces_of_other_shapes(shape: tuple[int, ...]) -> None:
    with pytest.raises(InputError, match="shape"):
        d2m_ccd.Mesh(CORNERS, np.zeros(shape, int))


@pytest.mark.parametrize("empty", [[], np.zeros((0, 3), int), np.zeros((0, 3))])
def test_meshes_without_triangles(empty: Any) -> None:
    expect(lambda: d2m_ccd.Mesh(CORNERS, empty), None, None, "no triangles")


def test_ragged_lists() -> None:
    with pytest.raises(InputError, match="not an array"):
        d2m_ccd.Mesh([[0, 0, 0], [1, 0]], FACES)


@pytest.mark.parametrize("thing", [None, 5, object(), {}, [1, 2, 3]])
def test_what_is_no_mesh(thing: Any) -> None:
    with pytest.raises((TypeError, InputError)):
        d2m_ccd.Tree(thing)


def test_files_that_are_no_meshes(tmp_path: Any) -> None:
    bad = tmp_path / "bad.obj"
    bad.write_text("v 0 0 0\nv 0 NaN 0\n")
    with pytest.raises(InputError, match="bad.obj, line 2"):
        d2m_ccd.Mesh(bad)
    with pytest.raises(InputError, match="missing.stl"):
        d2m_ccd.Mesh(str(tmp_path / "missing.stl"))
    with pytest.raises(InputError):
        d2m_ccd.Mesh("shape:no-such-shape")
    with pytest.raises(InputError, match="unknown"):
        d2m_ccd.Mesh("mesh.xyz")


def test_bytes_that_are_no_tree(box: d2m_ccd.Tree) -> None:
    data = bytearray(box.to_bytes())
    for bad in (b"", b"x" * 100, bytes(data[:-1]), bytes(data) + b"0"):
        with pytest.raises(InputError):
            d2m_ccd.Tree.from_bytes(bad)
    data[100] ^= 1
    with pytest.raises(InputError, match="damaged"):
        d2m_ccd.Tree.from_bytes(bytes(data))


@pytest.mark.parametrize("name", ["x", "v", "w", "at"])
def test_motions_that_are_not_finite(name: str) -> None:
    expect(lambda: d2m_ccd.ConstantTwist(**{name: [0.0, NAN, 0.0]}), 1, NAN, name)
    with pytest.raises(InputError, match="shape"):
        d2m_ccd.ConstantTwist(**{name: [0.0, 1.0]})


def test_quaternions_of_length_zero() -> None:
    expect(lambda: d2m_ccd.ConstantTwist(q=[0, 0, 0, 0]), None, (0.0, 0.0, 0.0, 0.0), "q")
    expect(lambda: d2m_ccd.Pose(q=[0, 0, 0, 0]), None, (0.0, 0.0, 0.0, 0.0), "q")


def test_rows_that_are_no_motions() -> None:
    row = np.zeros(13)
    with pytest.raises(InputError, match="orientation"):
        d2m_ccd.ConstantTwist.from_array(row)
    row[0], row[8] = 1.0, NAN
    expect(lambda: d2m_ccd.ConstantTwist.from_array(row), 8, NAN)
    with pytest.raises(InputError, match="13"):
        d2m_ccd.ConstantTwist.from_array(np.zeros(12))


def test_keyframes() -> None:
    pose = [1.0, 0, 0, 0, 0, 0, 0]
    expect(lambda: d2m_ccd.Keyframes([0, 0], [pose, pose]), 1, 0.0, "increase")
    with pytest.raises(InputError, match="2 times for 3 poses"):
        d2m_ccd.Keyframes([0, 1], [pose, pose, pose])
    with pytest.raises(InputError):
        d2m_ccd.Keyframes([0], [pose])
    half_turn = [0.0, 0, 0, 1, 0, 0, 0]
    expect(lambda: d2m_ccd.Keyframes([0, 1, 2], [pose, pose, half_turn]), 2, 2.0, "half a circle")
    with pytest.raises(InputError, match="join"):
        d2m_ccd.Keyframes([0, 1], [pose, pose], join="curly")  # type: ignore[arg-type]
    expect(lambda: d2m_ccd.Keyframes([0, 1], [pose, [1, 0, 0, 0, 0, NAN, 0]]), (1, 5), NAN, "poses[1, 5]")
    with pytest.raises(InputError, match="degree"):
        d2m_ccd.Spline([0, 1], [pose, pose], degree=4)  # type: ignore[arg-type]


def test_matrices_that_are_no_rotations() -> None:
    for bad in (np.diag([1.0, 1, -1, 1]), np.diag([2.0, 2, 2, 1]), np.ones((4, 4)), np.zeros((4, 4))):
        with pytest.raises(InputError):
            d2m_ccd.Pose.from_matrix(bad)
    broken = np.eye(4)
    broken[1, 2] = NAN
    expect(lambda: d2m_ccd.Pose.from_matrix(broken), (1, 2), NAN)


def test_joints() -> None:
    with pytest.raises(InputError, match="axis"):
        d2m_ccd.Joint("revolute", axis=[0, 0, 0], value=[1])
    with pytest.raises(InputError, match="axis"):
        d2m_ccd.Joint("revolute")
    with pytest.raises(InputError, match="kind"):
        d2m_ccd.Joint("spherical")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="fixed joint has none"):
        d2m_ccd.Joint(value=[1])
    with pytest.raises(InputError, match="jumps"):
        d2m_ccd.Joint("revolute", axis=[0, 0, 1], value=([0, 1, 2], [[0, 1], [5]]))
    open_joint = d2m_ccd.Joint("revolute", axis=[0, 0, 1])
    expect(lambda: d2m_ccd.Chain([d2m_ccd.Joint(), open_joint]), 1, None, "chain[1]")
    with pytest.raises(InputError):
        d2m_ccd.Chain([])
    with pytest.raises(TypeError):
        d2m_ccd.Chain([5])  # type: ignore[list-item]


def test_options(box: d2m_ccd.Tree) -> None:
    expect(lambda: d2m_ccd.time_of_contact(box, box, window=(1.0, 0.0)), None, (1.0, 0.0), "window")
    expect(lambda: d2m_ccd.time_of_contact(box, box, tolerance=NAN), None, NAN, "tolerance")
    expect(lambda: d2m_ccd.time_of_contact(box, box, tolerance=0.0), None, 0.0, "tolerance")
    expect(lambda: d2m_ccd.time_of_contact(box, box, min_separation=-1.0), None, -1.0, "min_separation")
    expect(lambda: d2m_ccd.time_of_contact(box, box, time_limit=NAN), None, NAN, "time_limit")
    expect(lambda: d2m_ccd.time_of_contact(box, box, mode="fast"), None, "fast", "mode")  # type: ignore[arg-type]
    with pytest.raises(OverflowError):
        d2m_ccd.time_of_contact(box, box, node_tests=-1)
    with pytest.raises(TypeError, match="solid"):
        d2m_ccd.time_of_contact(box, box, solid="wood")  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        d2m_ccd.time_of_contact(box, box, windows=(0, 1))  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="motion_a"):
        d2m_ccd.time_of_contact(box, box, 5)  # type: ignore[arg-type]


def test_windows_outside_of_a_motion(box: d2m_ccd.Tree) -> None:
    path = d2m_ccd.Keyframes([0, 1], [[1, 0, 0, 0, 9, 0, 0]] * 2)
    expect(lambda: d2m_ccd.time_of_contact(box, box, None, path, window=(0, 2)), 1, (0.0, 1.0), "body 1")
    with pytest.raises(InputError, match="time 2"):
        path.pose(2.0)


def test_open_meshes_are_no_solids(box: d2m_ccd.Tree) -> None:
    card = d2m_ccd.Tree(CORNERS, FACES[:1])
    assert d2m_ccd.time_of_contact(box, card, {"x": [9, 0, 0]}).status == "separated"
    expect(lambda: d2m_ccd.time_of_contact(box, card, solid=True), 1, None, "watertight")


def test_answers_have_no_truth_value(box: d2m_ccd.Tree) -> None:
    with pytest.raises(TypeError, match="truth"):
        bool(d2m_ccd.time_of_contact(box, box))
    with pytest.raises(TypeError, match="truth"):
        bool(d2m_ccd.World().first_contact())


def test_batches_name_the_first_bad_trial(box: d2m_ccd.Tree) -> None:
    rows = np.tile([1.0, 0, 0, 0, 9, 0, 0, 0, 0, 0, 0, 0, 0], (5000, 1))
    rows[[4000, 1234, 4999], 5] = NAN
    for threads in (1, 2):
        expect(lambda: d2m_ccd.batch(box, box, rows, threads=threads), 1234, NAN, "trial 1234", "motion of A")
    windows = np.tile([0.0, 1.0], (5000, 1))
    windows[77] = [1, 0]
    expect(lambda: d2m_ccd.batch(box, box, None, None, window=windows), 77, (1.0, 0.0), "trial 77")


def test_masked_numbers_are_none(box: d2m_ccd.Tree) -> None:
    corners, faces = np.array(CORNERS, float), np.array(FACES)
    whole = d2m_ccd.Mesh(np.ma.array(corners), np.ma.array(faces))
    assert whole.vertices.tolist() == corners.tolist() and whole.faces.tolist() == faces.tolist()
    for vertices, triangles in (
        (np.ma.masked_equal(corners, corners.max()), faces),
        (np.ma.masked_equal(corners, corners.max())[::-1], faces),
        (corners, np.ma.masked_equal(faces, 1)),
    ):
        with pytest.raises(InputError, match="masked"):
            d2m_ccd.Mesh(vertices, triangles)
    rows = np.ma.array(np.eye(13)[:1], mask=np.eye(13)[1:2])
    with pytest.raises(InputError, match="motions_a has masked"):
        d2m_ccd.batch(box, box, rows)


def test_batches_of_other_shapes(box: d2m_ccd.Tree) -> None:
    for bad in (np.zeros((5, 12)), np.zeros((5, 13, 1)), np.zeros(12)):
        with pytest.raises(InputError, match="shape"):
            d2m_ccd.batch(box, box, bad)
    with pytest.raises(InputError, match="trials"):
        d2m_ccd.batch(box, box, np.ones((5, 13)), np.ones((6, 13)))
    with pytest.raises(InputError, match="window"):
        d2m_ccd.batch(box, box, window=np.zeros((3, 3)))
    with pytest.raises(InputError, match="threads"):
        d2m_ccd.batch(box, box, threads=0)
    with pytest.raises(InputError, match="threads"):
        d2m_ccd.batch(box, box, threads=10**9)
    with pytest.raises(InputError, match="numbers"):
        d2m_ccd.batch(box, box, np.ones((5, 13), object))
    with pytest.raises(InputError, match="shape"):
        d2m_ccd.PoseTrajectories([0, 1], np.ones((5, 2, 6)))
    with pytest.raises(InputError, match="times"):
        d2m_ccd.PoseTrajectories([0, 1, 2], np.ones((5, 2, 7)))
    joints = [d2m_ccd.Joint("revolute", axis=[0, 0, 1])]
    with pytest.raises(InputError, match="values"):
        d2m_ccd.JointTrajectories(joints, [0, 1], np.ones((5, 2, 2)))
    with pytest.raises(InputError, match="velocities"):
        d2m_ccd.JointTrajectories(joints, [0, 1], np.ones((5, 2, 1)), accelerations=np.ones((5, 2, 1)))
    half = d2m_ccd.PoseTrajectories([0, 0], np.tile([1.0, 0, 0, 0, 9, 0, 0], (5, 2, 1)))
    expect(lambda: d2m_ccd.batch(box, box, None, half), 0, 0.0, "trial 0", "motion of B", "increase")


def test_worlds(box: d2m_ccd.Tree) -> None:
    world = d2m_ccd.World()
    body = world.add(box, name="one")
    with pytest.raises(InputError, match="taken"):
        world.add(box, name="one")
    world.remove(body)
    for gone in (body, "one", d2m_ccd.World().add(box)):
        with pytest.raises(KeyError):
            world.set_motion(gone, None)
    with pytest.raises(KeyError):
        world.first_contact_of({body: None})
    other = world.add(box, name="one")
    assert other != body
    with pytest.raises(InputError, match="min_separation"):
        world.set_min_separation(other, world.add(box), NAN)
    with pytest.raises(InputError) as caught:
        world.proximities(0.0, 1.0)
    assert caught.value.index == (0, 1)
    card = world.add(d2m_ccd.Tree(CORNERS, FACES[:1]), {"x": [50, 0, 0]})
    assert world.bodies()[-1] == card
    # A body and itself are no pair.
    world.ignore_pair(card, card)
    world.ignore_pair(card, card, False)
    world.set_min_separation(card, card, 1.0)
    assert [(pair.a, pair.b) for pair in world.contacts()] == [tuple(world.bodies()[:2])]


def test_simulations(box: d2m_ccd.Tree) -> None:
    with pytest.raises(InputError, match="step"):
        d2m_ccd.Simulation(step=0.0)
    simulation = d2m_ccd.Simulation()
    with pytest.raises(InputError, match="mesh is open"):
        simulation.add(d2m_ccd.Tree(CORNERS, FACES[:1]))
    assert len(simulation) == 0
    simulation.add(box, name="a")
    simulation.add(box)
    with pytest.raises(InputError, match="intersect"):
        simulation.advance(0.1)
    with pytest.raises(KeyError):
        simulation.ignore(0, 2)
    with pytest.raises(InputError, match="kind"):
        simulation.add(box, kind="gas")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="motion"):
        simulation.add(box, kind="kinematic")
    with pytest.raises(InputError, match="density"):
        simulation.add(box, density=1.0, mass=2.0)
    with pytest.raises(InputError, match=r"force\[1\]"):
        simulation.set_force("a", [0, NAN, 0])


def test_managers(box: d2m_ccd.Tree) -> None:
    manager = d2m_ccd.CollisionManager()
    for act in (manager.remove_object, lambda name: manager.set_transform(name, np.eye(4))):
        with pytest.raises(ValueError, match="not in collision manager"):
            act("nobody")
    with pytest.raises(InputError, match="rotation"):
        manager.add_object("a", box, np.diag([2.0, 2, 2, 1]))
