"""Robots: paths and edges."""

from __future__ import annotations

from pathlib import Path

import d2m_ccd
import numpy as np
import pytest
from d2m_ccd import InputError

WALL = "shape:box?x=0.05&y=0.05&z=0.5"


@pytest.fixture
def robot() -> d2m_ccd.Robot:
    robot = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF)
    robot.add_obstacle("wall", WALL, d2m_ccd.Pose(x=[0, 0.7, 0]))
    return robot


def test_names(robot: d2m_ccd.Robot) -> None:
    assert (robot.link_names, robot.joint_names) == (["base", "arm"], ["turn"])
    assert robot.body_names == ["base", "arm", "wall"]


def test_an_edge_is_free_until_the_arm_meets_the_wall(robot: d2m_ccd.Robot) -> None:
    answer = robot.check_edge([0.0], [2.0])
    assert (answer.status, answer.a, answer.b) == ("contact", "arm", "wall")
    # The flank of the arm is 0.05 from its middle; the wall's near corner is at (0.05, 0.65).
    angle = np.arctan2(0.65, 0.05) - np.arcsin(0.05 / np.hypot(0.65, 0.05))
    assert answer.free_until == pytest.approx(angle / 2, abs=1e-8) and answer.free_until <= angle / 2
    assert isinstance(answer.contact, d2m_ccd.Contact) and answer.contact.time_lo == answer.free_until
    assert robot.check_edge([0.0], [0.99 * angle]).status == "free"
    with pytest.raises(TypeError, match="truth"):
        bool(answer)


def test_batches_of_edges_are_single_edges(robot: d2m_ccd.Robot) -> None:
    random = np.random.default_rng(31)
    start, end = random.uniform(-3, 3, (200, 1)), random.uniform(-3, 3, (200, 1))
    calls: list[int] = []
    results = robot.check_edges(start, end, progress=lambda done, total: calls.append(done))
    assert results.dtype == d2m_ccd.EDGE and calls[-1] == 200
    for one, other, result in zip(start, end, results):
        answer = robot.check_edge(one, other)
        names = [robot.body_names[place] if place >= 0 else None for place in (result["body_a"], result["body_b"])]
        assert (answer.free_until, answer.a, answer.b) == (result["free_until"], *names)
    assert {0, 1} == set(results["status"])
    single = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF, threads=1)
    single.add_obstacle("wall", WALL, d2m_ccd.Pose(x=[0, 0.7, 0]))
    assert single.check_edges(start, end).tobytes() == results.tobytes()


def test_robots_and_their_answers_come_back_from_pickles(robot: d2m_ccd.Robot, tmp_path: Path) -> None:
    import copy
    import pickle

    robot.attach("rod", "arm", "shape:box?x=0.01&y=0.3&z=0.01", d2m_ccd.Pose(x=[0.7, 0, 0]), radius=0.01)
    robot.set_min_separation("rod", "wall", 0.02)
    robot.set_start("arm", "wall", "leave")
    random = np.random.default_rng(32)
    edges = random.uniform(-3, 3, (2, 100, 1))
    for again in (pickle.loads(pickle.dumps(robot)), copy.deepcopy(robot)):
        assert repr(again) == repr(robot) and again.body_names == robot.body_names
        assert again.check_edges(*edges).tobytes() == robot.check_edges(*edges).tobytes()
        again.add_obstacle("another", WALL, d2m_ccd.Pose(x=[0.7, 0, 0]))
        assert "another" not in robot.body_names
    for end in (0.1, 2.0):
        answer = robot.check_edge([0.0], [end])
        assert pickle.loads(pickle.dumps(answer)) == answer and hash(answer) == hash(pickle.loads(pickle.dumps(answer)))


def test_paths(robot: d2m_ccd.Robot) -> None:
    linear = robot.check_path([5.0, 9.0], [[0.0], [2.0]])
    assert linear.status == "contact"
    assert linear.free_until == pytest.approx(5 + 4 * robot.check_edge([0.0], [2.0]).free_until, abs=1e-7)
    cubic = robot.check_path([0.0, 1.0], [[0.0], [1.0]], [[0.0], [0.0]])
    assert cubic.status == "free" and cubic.free_until == 1.0
    # The cubic overshoots: it leaves with such a speed that it comes to 4/27·9 + 1 = 2.33 on its way back to 1.
    assert robot.check_path([0.0, 1.0], [[1.0], [1.0]], [[9.0], [0.0]]).status == "contact"
    quintic = robot.check_path([0.0, 1.0], [[0.0], [1.0]], [[0.0], [0.0]], [[0.0], [0.0]])
    assert quintic.status == "free"
    assert robot.limit_warnings([0.0, 9.0], [[0.0], [4.0]])[0]["kind"] == "position"


def test_attached_and_moving_bodies(robot: d2m_ccd.Robot) -> None:
    angle = 2 * robot.check_edge([0.0], [2.0]).free_until
    robot.attach("rod", "arm", "shape:box?x=0.01&y=0.3&z=0.01", d2m_ccd.Pose(x=[0.7, 0, 0]))
    carried = robot.check_edge([0.0], [2.0])
    assert {carried.a, carried.b} == {"rod", "wall"} and 2 * carried.free_until < angle
    robot.ignore("rod", "wall")
    assert 2 * robot.check_edge([0.0], [2.0]).free_until == pytest.approx(angle, abs=1e-8)
    robot.add_obstacle("ball", "shape:box?x=0.1&y=0.1&z=0.1", motion={"x": [0.5, -3, 0], "v": [0, 3, 0]})
    hit = robot.check_path([0.0, 1.0], [[0.0], [0.0]])
    assert {hit.a, hit.b} == {"arm", "ball"} and hit.free_until == pytest.approx(2.85 / 3, abs=1e-8)


def test_bad_input(robot: d2m_ccd.Robot, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"start\[0\]|from\[0\]") as caught:
        robot.check_edge([np.nan], [1.0])
    start = np.zeros((50, 1))
    start[[20, 40]] = np.nan
    with pytest.raises(InputError, match="edge 20") as caught:
        robot.check_edges(start, np.ones((50, 1)))
    assert caught.value.index == 20
    with pytest.raises(InputError, match="shape"):
        robot.check_edges(np.zeros((5, 1)), np.zeros((6, 1)))
    with pytest.raises(InputError, match="2 numbers"):
        robot.check_edges(np.zeros((5, 2)), np.zeros((5, 2)))
    with pytest.raises(InputError, match="joint"):
        robot.check_edge([0.0], [1.0], joints=["elbow"])
    with pytest.raises(InputError, match="increase|after"):
        robot.check_path([0.0, 0.0], [[0.0], [1.0]])
    with pytest.raises(InputError, match="shape"):
        robot.check_path([0.0, 1.0], [[0.0, 1.0], [1.0, 1.0]])
    with pytest.raises(InputError, match="wall"):
        robot.add_obstacle("wall", WALL)
    with pytest.raises(InputError, match="no link"):
        robot.attach("cup", "nobody", WALL)
    assert robot.body_names == ["base", "arm", "wall"]
    with pytest.raises(KeyError):
        robot.ignore("nobody", "wall")
    with pytest.raises(KeyError):
        robot.limits("nobody")
    with pytest.raises(InputError, match="missing.urdf"):
        d2m_ccd.Robot(tmp_path / "missing.urdf")
    with pytest.raises(InputError):
        d2m_ccd.Robot("<robot name='x'><link name='a'/></robot>")
    with pytest.raises(InputError, match="line"):
        d2m_ccd.Robot("<robot name='x'><link name='a'>")


BOX = "<collision><geometry><box size='1 1 1'/></geometry></collision>"


def urdf(link: str = BOX, joint: str = "", kind: str = "prismatic") -> str:
    inside = f"<parent link='world'/><child link='m'/>{joint}"
    return f"<robot name='r'>\n<link name='world'/>\n<link name='m'>{link}</link>\n<joint name='j' type='{kind}'>{inside}</joint></robot>"


def test_real_files_hold(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf"
    wall = ("wall", "shape:box?x=0.5&y=5&z=5", d2m_ccd.Pose(x=[3, 0, 0]))
    for text, expected in [
        ("\ufeff<?xml version='1.0'?>\r\n<!-- ä -->" + urdf().replace("\n", "\r\n"), 0.5),
        (urdf(joint="<axis xyz='250 0 0'/>"), 0.5),
        (urdf(BOX + BOX.replace("<geometry>", "<origin xyz='1 0 0'/><geometry>")), 0.25),
        (urdf(joint="<axis xyz='0 0 3'/>", kind="planar"), 0.5),
    ]:
        file.write_text(text, encoding="utf-8")
        robot = d2m_ccd.Robot(file)
        robot.add_obstacle(*wall)
        joints = ["j/x"] if "planar" in text else ["j"]
        until = robot.check_path([0.0, 1.0], [[0.0], [4.0]], joints=joints).free_until
        assert expected - 1e-6 < until <= expected, text
    file.write_bytes("\ufeff".encode("utf-16-le") + urdf().encode("utf-16-le"))
    assert d2m_ccd.Robot(file).joint_names == ["j"]
    srdf = "<robot name='r'><disable_collisions link1='m' link2='hand'/></robot>"
    assert any("no link \"hand\"" in remark for remark in d2m_ccd.Robot(file, srdf=srdf).remarks)


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (urdf(BOX.replace("1 1 1", "1 nan 1")), 3, "size of <box>"),
        (urdf(BOX.replace("</geometry>", "<sphere radius='1'/></geometry>")), 3, "second shape"),
        (urdf("<collision><geometry><mesh filename='none.stl'/></geometry></collision>"), 3, "none.stl"),
        (urdf("<collision><geometry><mesh filename='package://arm/x.stl'/></geometry></collision>"), 3, "package arm=DIR"),
        (urdf(joint="<axis xyz='0 0 0'/>"), 4, "the axis 0 0 0"),
        (urdf(joint="<mimic joint='k'/>"), 4, "mimics"),
        (urdf(joint="<mimic joint='j'/>"), 4, "mimics itself"),
        (urdf().replace("parent link='world'", "parent link='w'"), 4, "\"w\" is no link"),
        (urdf().replace("<link name='m'>", "<link name='world'>"), 3, "second link"),
        (urdf().replace("<geometry>", "<xacro:x/><geometry>"), 3, "xacro"),
        (urdf(""), None, "none of the 2 links has collision geometry"),
    ],
)
def test_bad_files_are_one_line_with_its_place(text: str, line: int | None, words: str, tmp_path: Path) -> None:
    file = tmp_path / "bad.urdf"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        d2m_ccd.Robot(file)
    message = str(caught.value)
    assert "bad.urdf" in message and words in message and "\n" not in message, message
    assert caught.value.index == line


def test_paths_name_point_joint_and_value(robot: d2m_ccd.Robot) -> None:
    for times, positions, words in [
        ([0.0, 1.0], [[0.0], [np.nan]], "positions"),
        ([0.0, np.inf], [[0.0], [1.0]], "times"),
        ([0.0, -1.0], [[0.0], [1.0]], "points[1], time_from_start"),
        ([0.0], [[0.0]], "points: 1 of them"),
        ([], np.zeros((0, 1)), "points: 0 of them"),
    ]:
        with pytest.raises(InputError) as caught:
            robot.check_path(times, positions)
        assert words in str(caught.value) or "points[1]" in str(caught.value), str(caught.value)
    warning = robot.limit_warnings([0.0, 1.0, 2.0], [[0.0], [0.5], [3.5]])
    assert all(found["is_certain"] for found in warning)
    assert [(found["kind"], found["point"], found["limit"]) for found in warning] == [("position", 1, 3.0), ("velocity", 1, 1.0)]
