"""Against python-fcl, trimesh and dense sampling."""

from __future__ import annotations

from typing import Any

import d2m_ccd
import numpy as np
import pytest
from conftest import random_motions

fcl = pytest.importorskip("fcl")
trimesh = pytest.importorskip("trimesh")


def model(tree: d2m_ccd.Tree) -> Any:
    mesh = tree.mesh
    model = fcl.BVHModel()
    model.beginModel(len(mesh.vertices), len(mesh.faces))
    model.addSubModel(mesh.vertices, mesh.faces.astype(np.int64))
    model.endModel()
    return model


def placed(shape: Any, pose: d2m_ccd.Pose) -> Any:
    matrix = pose.matrix()
    return fcl.CollisionObject(shape, fcl.Transform(np.ascontiguousarray(matrix[:3, :3]), matrix[:3, 3].copy()))


def random_poses(count: int, seed: int, size: float) -> list[d2m_ccd.Pose]:
    random = np.random.default_rng(seed)
    return [d2m_ccd.Pose(x=random.normal(size=3) * size, q=random.normal(size=4)) for _ in range(count)]


def test_static_queries_agree_with_fcl(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree]) -> None:
    a, b = knots
    shapes = model(a), model(b)
    collisions = 0
    for pose_a, pose_b in zip(random_poses(60, 1, 0.2 * a.radius), random_poses(60, 2, 0.8 * a.radius)):
        objects = [placed(shape, pose) for shape, pose in zip(shapes, (pose_a, pose_b))]
        theirs = fcl.collide(*objects, fcl.CollisionRequest(), fcl.CollisionResult()) > 0
        assert d2m_ccd.collide(a, b, pose_a, pose_b, solid=False) == theirs
        collisions += theirs
        if not theirs:
            result = fcl.DistanceResult()
            fcl.distance(*objects, fcl.DistanceRequest(enable_nearest_points=True), result)
            ours = d2m_ccd.distance(a, b, pose_a, pose_b, solid=False)
            assert ours is not None
            assert ours.lower - 1e-9 <= result.min_distance <= ours.upper + 1e-9
            assert np.linalg.norm(ours.point_b - ours.point_a) == pytest.approx(ours.value, abs=1e-9)
    assert 10 < collisions < 50


def test_no_sample_collides_before_the_time_of_contact(knots: tuple[d2m_ccd.Tree, d2m_ccd.Tree]) -> None:
    a, b = knots
    shapes = model(a), model(b)
    distance = 1.5 * (a.radius + b.radius)
    motions_a, motions_b = random_motions(40, 3, distance), random_motions(40, 4, 0.1 * distance)
    results = d2m_ccd.batch(a, b, motions_a, motions_b, solid=False)
    contacts = 0
    for row_a, row_b, result in zip(motions_a, motions_b, results):
        motions = [d2m_ccd.ConstantTwist.from_array(row) for row in (row_a, row_b)]

        def objects(time: float) -> list[Any]:
            return [placed(shape, motion.pose(time)) for shape, motion in zip(shapes, motions)]

        end = min(result["time_lo"], 1.0)
        for time in np.linspace(0.0, end, 60)[:-1]:
            assert fcl.collide(*objects(time), fcl.CollisionRequest(), fcl.CollisionResult()) == 0
        if result["status"] == d2m_ccd.Status.CONTACT and result["start"] == d2m_ccd.Start.APART:
            contacts += 1
            left = d2m_ccd.distance(a, b, *(motion.pose(result["time_hi"]) for motion in motions), solid=False)
            assert left is not None and left.lower <= result["tolerance"]
            theirs = fcl.distance(*objects(result["time_lo"]), fcl.DistanceRequest(), fcl.DistanceResult())
            assert theirs < 1e-6
    assert 10 < contacts < 40


def test_boxes_head_on_that_fcl_misses() -> None:
    """Two thin plates that pass each other between two samples."""
    plate = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.001")
    flight = d2m_ccd.ConstantTwist(x=[0, 0, 1], v=[0, 0, -2])
    answer = d2m_ccd.time_of_contact(plate, plate, flight)
    assert isinstance(answer, d2m_ccd.Contact)
    assert answer.time_lo <= 0.499 <= answer.time_hi + 1e-9
    objects = [placed(model(plate), pose) for pose in (flight.pose(0.0), d2m_ccd.Pose())]
    assert fcl.collide(*objects, fcl.CollisionRequest(), fcl.CollisionResult()) == 0


def filled(manager: Any, meshes: dict[str, Any], poses: dict[str, Any]) -> Any:
    for name, mesh in meshes.items():
        manager.add_object(name, mesh, poses[name])
    return manager


@pytest.fixture(scope="module")
def scene() -> tuple[dict[str, Any], dict[str, Any]]:
    meshes, poses = {}, {}
    random = np.random.default_rng(5)
    for place in range(14):
        name = f"body {place}"
        meshes[name] = trimesh.creation.box((1, 1, 1)) if place % 2 else trimesh.creation.icosphere(2, 0.7)
        poses[name] = trimesh.transformations.random_rotation_matrix(random.random(3))
        poses[name][:3, 3] = random.normal(size=3) * 2.5
    return meshes, poses


def test_the_manager_answers_as_that_of_trimesh(scene: tuple[dict[str, Any], dict[str, Any]]) -> None:
    meshes, poses = scene
    theirs = filled(trimesh.collision.CollisionManager(), meshes, poses)
    ours = filled(d2m_ccd.CollisionManager(solid=False), meshes, poses)
    expected = theirs.in_collision_internal(return_names=True)
    assert ours.in_collision_internal(return_names=True) == expected
    assert expected[0] and ours.in_collision_internal()
    collides, names, contacts = ours.in_collision_internal(return_names=True, return_data=True)
    assert collides and {tuple(sorted(contact.names)) for contact in contacts} == names
    probe = trimesh.creation.box((1, 1, 1))
    for name, pose in poses.items():
        moved = pose.copy()
        moved[0, 3] += 0.4
        assert ours.in_collision_single(probe, moved, return_names=True) == theirs.in_collision_single(
            probe, moved, return_names=True
        )
        moved[2, 3] += 30
        far = theirs.min_distance_single(probe, moved, return_name=True)
        mine = ours.min_distance_single(probe, moved, return_name=True)
        # Transforms of trimesh's manager are of single precision.
        assert mine[1] == far[1] and mine[0] == pytest.approx(far[0], rel=1e-5)


def test_two_managers(scene: tuple[dict[str, Any], dict[str, Any]]) -> None:
    meshes, poses = scene
    shifted = {name: pose + np.array([[0, 0, 0, 40.0], [0] * 4, [0] * 4, [0] * 4]) for name, pose in poses.items()}
    answers = []
    for manager in (trimesh.collision.CollisionManager, lambda: d2m_ccd.CollisionManager(solid=False)):
        one, two = filled(manager(), meshes, poses), filled(manager(), meshes, shifted)
        answers.append((one.in_collision_other(two), *one.min_distance_other(two, return_names=True)))
        assert one.in_collision_other(one)
        single = [name for name in meshes][0]
        two.set_transform(single, poses[single])
        assert one.in_collision_other(two, return_names=True)[0]
        two.remove_object(single)
        assert not one.in_collision_other(two)
    (theirs_hit, theirs_distance, theirs_names), (hit, distance, names) = answers
    assert (hit, names) == (theirs_hit, theirs_names)
    assert distance == pytest.approx(theirs_distance, rel=1e-5)


def test_least_distances_of_a_manager() -> None:
    meshes = {name: trimesh.creation.icosphere(2, 0.4) for name in "abcd"}
    poses = {name: trimesh.transformations.translation_matrix([k * k, 0, 0]) for k, name in enumerate("abcd", 1)}
    theirs = filled(trimesh.collision.CollisionManager(), meshes, poses)
    ours = filled(d2m_ccd.CollisionManager(), meshes, poses)
    for arguments in ({}, {"name": "c"}, {"name": "d"}):
        expected = theirs.min_distance_internal(return_names=True, return_data=True, **arguments)
        found = ours.min_distance_internal(return_names=True, return_data=True, **arguments)
        assert found[1] == expected[1] and found[0] == pytest.approx(expected[0], rel=1e-5)
        assert found[2].lower <= found[2].distance <= found[2].upper
        assert found[2].point(found[1][0]) == pytest.approx(expected[2].point(found[1][0]), abs=1e-4)
    assert ours.min_distance_internal() == pytest.approx(3 - 0.8, abs=0.02)


def test_the_first_contact_of_a_manager() -> None:
    manager = d2m_ccd.CollisionManager()
    for k, name in enumerate(("wall", "post", "door")):
        manager.add_object(name, trimesh.creation.box((1, 1, 1)), trimesh.transformations.translation_matrix([3 * k, 0, 0]))
    first = manager.first_contact({"door": d2m_ccd.ConstantTwist(x=[6, 0, 0], v=[-4, 0, 0])})
    assert first.a is not None and first.b is not None and first.contact is not None
    assert {first.a.name, first.b.name} == {"post", "door"}
    assert first.contact.time_lo <= 0.5 <= first.contact.time_hi + 1e-9
    assert manager.first_contact({"door": {"x": [6, 0, 0], "v": [4, 0, 0]}}).status == "separated"


def test_meshes_of_trimesh_and_of_arrays_are_the_same() -> None:
    ball = trimesh.creation.icosphere(3, 0.7)
    trees = [d2m_ccd.Tree(ball), d2m_ccd.Tree(ball.vertices, ball.faces), d2m_ccd.Tree(d2m_ccd.Mesh(ball))]
    assert len({tree.to_bytes() for tree in trees}) == 1
    single = d2m_ccd.Mesh(ball.vertices.astype(np.float32), ball.faces.astype(np.uint16))
    assert (single.vertices == ball.vertices.astype(np.float32)).all()
