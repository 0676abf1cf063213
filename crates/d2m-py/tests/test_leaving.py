"""What is let go at the start, bodies with radii, and separations of single pairs."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import d2m_ccd
import numpy as np
import pytest
from d2m_ccd import InputError

CUBE = "shape:box?x=0.5&y=0.5&z=0.5"
LIFT = """<robot name="lift"><link name="rail"/>
  <link name="hand"><collision><origin xyz="0 0 0.6"/><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <joint name="up" type="prismatic"><parent link="rail"/><child link="hand"/><axis xyz="0 0 1"/></joint></robot>"""


def test_what_is_in_contact_at_the_start_is_let_go() -> None:
    tree = d2m_ccd.Tree(CUBE)
    # Out of the other one at 0.5, and back again at 1.5.
    times, poses = [0.0, 1.0, 2.0], [d2m_ccd.Pose(x=[0, 0, z]) for z in (0.5, 1.5, 0.5)]
    motion = d2m_ccd.Keyframes(times, poses)
    window = (0.0, 2.0)
    assert d2m_ccd.time_of_contact(tree, tree, motion, window=window).clear_until == 0.0
    met = d2m_ccd.time_of_contact(tree, tree, motion, window=window, start="leave")
    assert isinstance(met, d2m_ccd.Contact) and met.left is not None
    assert met.left[0] <= 0.5 + 1e-5 and 0.5 <= met.left[1] < 0.51 and 1.5 - 1e-6 < met.time_lo <= 1.5
    found = d2m_ccd.departure(tree, tree, motion, window=window)
    assert (found.start, found.left, found.answer) == ("overlapping", met.left, met)
    assert d2m_ccd.verify(tree, tree, found, motion, window=window).status == "verified"
    # The answer alone: when they had parted is proven with it.
    for answer, path in ((met, motion), (d2m_ccd.time_of_contact(tree, tree, {"v": [0, 0, 2]}, start="leave"), {"v": [0, 0, 2]})):
        ends = window if answer is met else (0.0, 1.0)
        assert d2m_ccd.verify(tree, tree, answer, path, window=ends, start="leave").status == "verified"
        assert d2m_ccd.verify(tree, tree, answer, path, window=ends).status != "verified"
    staying = d2m_ccd.departure(tree, tree, {"x": [0, 0, 0.5], "v": [0, 0, 0.1]})
    assert staying.left is None and staying.answer.clear_until == 0.0
    results = d2m_ccd.batch(tree, tree, motion, window=np.array([window] * 3), start="leave")
    assert results["time_lo"].tolist() == [met.time_lo] * 3
    with pytest.raises(InputError, match="start is \"go\""):
        d2m_ccd.time_of_contact(tree, tree, start="go")  # type: ignore[call-overload,unused-ignore]


def test_how_bodies_begin_is_the_same_whatever_else_the_machine_does() -> None:
    # More threads than processors: the first limit of a few milliseconds ends some queries between their answer and the judgement of the start.
    tree = d2m_ccd.Tree(CUBE)
    motion = d2m_ccd.Keyframes([0.0, 1.0, 2.0], [d2m_ccd.Pose(x=[0, 0, z]) for z in (0.5, 1.5, 0.5)])
    with ThreadPoolExecutor(16) as pool:
        found = list(pool.map(lambda _: d2m_ccd.departure(tree, tree, motion, window=(0.0, 2.0)), range(3000)))
    assert {one.start for one in found} == {"overlapping"}
    assert all((one.left, one.answer) == (found[0].left, found[0].answer) for one in found)


def test_worlds_let_go_and_have_bodies_with_radii() -> None:
    world = d2m_ccd.World(start="leave")
    table = world.add(CUBE)
    part = world.add(CUBE, {"x": [0, 0, 1], "v": [0, 0, 1]})
    assert world.first_contact().status == "separated"
    world.set_start(table, part, "report")
    assert world.first_contact().status == "contact"
    world.set_start(table, part, None)
    world.add("shape:box?x=1e-3&y=1e-3&z=1e-3", {"x": [0, 0, 4]}, name="ball", radius=1.0)
    first = world.first_contact((0.0, 3.0))
    assert first.b is not None and first.b.name == "ball"
    # The part's top is at 1.5 + t, the ball reaches down to 3 - 1e-3.
    assert first.clear_until == pytest.approx(1.5 - 1e-3, abs=1e-6)
    with pytest.raises(InputError, match="radius is -1"):
        world.add(CUBE, radius=-1)


def test_radii_of_pairs() -> None:
    tree, falling = d2m_ccd.Tree(CUBE), {"x": [0, 0, 3], "v": [0, 0, -4]}
    bare = d2m_ccd.time_of_contact(tree, tree, falling).clear_until
    for radius in (0.2, (0.1, 0.3), (0.4, 0)):
        # Faces that face each other: 0.4 of the way of 4.
        assert d2m_ccd.time_of_contact(tree, tree, falling, radius=radius).clear_until == pytest.approx(bare - 0.1, abs=1e-8)
    assert d2m_ccd.contact_exists(tree, tree, {"x": [0, 0, 1.3]}, radius=0.2) is True
    assert d2m_ccd.clearance(tree, tree, {"x": [0, 0, 3]}, radius=0.2).upper == pytest.approx(1.6, abs=1e-6)
    assert [status for *_, status in d2m_ccd.spans(tree, tree, falling, radius=0.2)] == ["clear", "contact"]
    answer = d2m_ccd.time_of_contact(tree, tree, falling, radius=0.2)
    assert d2m_ccd.verify(tree, tree, answer, falling, radius=0.2).status == "verified"
    assert d2m_ccd.batch(tree, tree, d2m_ccd.ConstantTwist(**falling), radius=0.2)["time_lo"][0] == answer.clear_until
    for radius in (-1, np.nan, (0, -1)):
        with pytest.raises(InputError, match="radius"):
            d2m_ccd.time_of_contact(tree, tree, radius=radius)


@pytest.fixture
def lift() -> d2m_ccd.Robot:
    robot = d2m_ccd.Robot(LIFT)
    robot.attach("part", "hand", "shape:box?x=0.5&y=0.5&z=0.25", d2m_ccd.Pose(x=[0, 0, 0.25]))
    robot.add_obstacle("table", "shape:box?x=2&y=2&z=0.5", d2m_ccd.Pose(x=[0, 0, -0.5]))
    robot.add_obstacle("ceiling", "shape:box?x=2&y=2&z=0.5", d2m_ccd.Pose(x=[0, 0, 2.5]))
    return robot


def test_a_robot_lifts_a_part(lift: d2m_ccd.Robot) -> None:
    times, low, high = [0.0, 2.0], [[0.0], [1.0]], [[0.0], [2.0]]
    assert lift.check_path(times, low).free_until == 0.0
    lift.set_start("part", "table", "leave")
    free, met = lift.check_path(times, low), lift.check_path(times, high)
    assert (free.status, met.status) == ("free", "contact") and met.free_until == pytest.approx(1.3, abs=1e-6)
    assert met.contact is not None and {met.a, met.b} == {"hand", "ceiling"}
    assert lift.verify(free, times, low).status == lift.verify(met, times, high).status == "verified"
    wrong = lift.verify(free, times, high)
    assert wrong.status != "verified" and {wrong.a, wrong.b} == {"hand", "ceiling"}
    # Kept 0.4 away from the ceiling; the part let go meets nothing on the way.
    lift.set_min_separation("hand", "ceiling", 0.4)
    assert lift.check_path(times, high).free_until == pytest.approx(0.9, abs=1e-6)
    lift.ignore("part", "table")
    near = lift.clearance(times, [[0.0], [0.5]])
    assert near is not None and near.status == "clear" and near.upper == pytest.approx(0.4, abs=1e-6)
    assert near.lower <= near.upper and 0.0 <= near.time <= 2.0 and near.a != near.b
    with pytest.raises(KeyError):
        lift.set_start("part", "tabel", "leave")
    with pytest.raises(InputError, match="min_separation"):
        lift.set_min_separation("hand", "ceiling", -1)
    # What stays in contact never leaves: told, and not proven otherwise.
    lifted = d2m_ccd.Robot(LIFT, start="leave")
    lifted.add_obstacle("ball", "shape:box?x=1e-3&y=1e-3&z=1e-3", d2m_ccd.Pose(x=[0, 0, 0.6]), radius=0.5)
    assert lifted.check_path([0.0, 1.0], [[0.0], [0.1]]).free_until == 0.0
    assert lifted.check_path([0.0, 1.0], [[0.0], [1.0]]).status == "free"
