"""Simulations that are changed while they run: what is asserted is physics."""

from __future__ import annotations

import math

import d2m_ccd
import numpy as np
import pytest

BOX = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
FLAT = d2m_ccd.Tree("shape:box?x=3&y=0.5&z=3")
WEIGHTLESS = [0, 0, 0]


def at(x: float, y: float, z: float = 0.0) -> d2m_ccd.Pose:
    return d2m_ccd.Pose(x=[x, y, z])


def standing() -> tuple[d2m_ccd.Simulation, int, int]:
    simulation = d2m_ccd.Simulation()
    floor = simulation.add(FLAT, name="floor", kind="static", friction=0.5)
    cup = simulation.add(BOX, name="cup", pose=at(0, 1.001), friction=0.5)
    simulation.advance(0.5)
    return simulation, floor, cup


def test_a_motor_turns_a_hinge_at_its_speed_and_is_changed() -> None:
    simulation = d2m_ccd.Simulation()
    wheel = simulation.add(BOX, name="wheel")
    hinge = simulation.add_joint("revolute", "wheel", axis=[0, 0, 2], motor=d2m_ccd.Motor(velocity=3.0))
    simulation.advance(1.0)
    # Angles go on beyond half a turn.
    assert simulation.joint_value(hinge) == pytest.approx(3.0, abs=1e-3)
    simulation.advance(2.0)
    assert simulation.joint_value(hinge) == pytest.approx(6.0, abs=1e-3)
    assert np.abs(simulation.velocities()[wheel, 3:]) == pytest.approx([0, 0, 3], abs=1e-6)
    simulation.set_motor(hinge, d2m_ccd.Motor(position=0.5))
    simulation.advance(4.0)
    assert simulation.joint_value(hinge) == pytest.approx(0.5, abs=1e-3)
    simulation.set_motor(hinge, None)
    simulation.set_velocity(wheel, [0, 0, 0], [0, 0, -1])
    simulation.advance(5.0)
    assert simulation.joint_value(hinge) == pytest.approx(1.5, abs=1e-2)


@pytest.mark.parametrize("kind", ["fixed", "revolute", "prismatic", "spherical"])
def test_joints_leave_what_their_kind_says(kind: str) -> None:
    simulation = d2m_ccd.Simulation()
    base = simulation.add(BOX, kind="static")
    arm = simulation.add(BOX, pose=at(1, 0), w=[0, 1, 0])
    simulation.add_joint(kind, base, arm, point=[0.5, 0, 0], axis=[0, 0, 1])  # type: ignore[arg-type]
    simulation.advance(0.3)
    pose = simulation.pose(arm)
    sinks, turns = abs(pose.x[1]) > 1e-2, np.abs(pose.q[1:]) > 1e-2
    expected = {
        "fixed": (False, [False] * 3),
        "revolute": (True, [False, False, True]),
        "prismatic": (False, [False] * 3),
        "spherical": (True, [False, True, True]),
    }[kind]
    assert (sinks, turns.tolist()) == expected


def test_limits_stop_a_slide_that_friction_holds_otherwise() -> None:
    simulation = d2m_ccd.Simulation()
    free, rubbing = simulation.add(BOX, mass=1.0), simulation.add(BOX, mass=1.0, pose=at(3, 0))
    guides = [
        simulation.add_joint("prismatic", free, axis=[0, 1, 0], limits=(-0.25, 0.25)),
        simulation.add_joint("prismatic", rubbing, axis=[0, 1, 0], limits=(-0.25, 0.25), friction=10.0),
    ]
    simulation.advance(1.0)
    values = [abs(simulation.joint_value(guide)) for guide in guides]
    assert values == pytest.approx([0.25, 0.0], abs=1e-3)


def test_a_spring_carries_its_load() -> None:
    simulation = d2m_ccd.Simulation()
    load = simulation.add(BOX, mass=8.0)
    guide = simulation.add_joint("prismatic", load, axis=[0, 1, 0], spring=d2m_ccd.Spring(800.0, 80.0))
    simulation.advance(5.0)
    assert abs(simulation.joint_value(guide)) == pytest.approx(8 * 9.81 / 800, abs=1e-4)


def test_locks_keep_a_body_in_a_plane() -> None:
    simulation = d2m_ccd.Simulation()
    thrown = simulation.add(BOX, v=[1, 2, 3], w=[1, 1, 1])
    simulation.add_joint("locked", thrown, ways=[False, False, True], turns=[True, True, False])
    simulation.advance(0.5)
    x, q = simulation.pose(thrown).x, simulation.pose(thrown).q
    assert x[0] == pytest.approx(0.5, abs=1e-9)
    assert abs(x[2]) < 1e-9
    assert np.abs(q[1:3]).max() < 1e-9 < abs(q[3])


def test_a_joint_that_is_taken_out_holds_no_more() -> None:
    simulation = d2m_ccd.Simulation()
    lamp = simulation.add(BOX)
    nail = simulation.add_joint("fixed", lamp)
    simulation.advance(0.2)
    assert abs(simulation.pose(lamp).x[1]) < 1e-9
    simulation.remove_joint(nail)
    simulation.advance(0.4)
    assert simulation.pose(lamp).x[1] == pytest.approx(-0.5 * 9.81 * 0.2**2, rel=0.06)
    for act in (simulation.remove_joint, simulation.joint_value):
        with pytest.raises(KeyError, match="joint 0"):
            act(nail)
    with pytest.raises(KeyError, match="joint 7"):
        simulation.set_motor(7, None)


def test_a_body_that_is_removed_supports_nothing_any_more() -> None:
    simulation, floor, cup = standing()
    simulation.advance(2.0)
    assert simulation.is_asleep(cup)
    simulation.remove(floor)
    assert not simulation.is_asleep(cup)
    simulation.advance(2.5)
    assert simulation.pose(cup).x[1] < 0.0
    assert [(event.a, event.b, event.change) for event in simulation.touches] == [(floor, cup, "ended")]


def test_a_sensor_reports_begin_and_end_and_stops_nothing() -> None:
    simulation = d2m_ccd.Simulation(gravity=WEIGHTLESS)
    gate = simulation.add(BOX, kind="static", presence="sensor")
    ball = simulation.add(BOX, pose=at(-3, 0), v=[4, 0, 0])
    simulation.advance(1.5)
    assert simulation.pose(ball).x[0] == pytest.approx(3.0, abs=1e-9)
    began, ended = simulation.touches
    assert [(event.a, event.b, event.change) for event in (began, ended)] == [
        (gate, ball, "began"),
        (gate, ball, "ended"),
    ]
    # They overlap from 0.5 to 1.0: the events stand outside of that.
    assert began.time <= 0.5
    assert ended.time >= 1.0
    assert not simulation.touch(gate, ball)
    simulation.advance(1.6)
    assert simulation.touches == []


def test_solids_touch_until_they_are_lifted() -> None:
    simulation, floor, cup = standing()
    assert simulation.touch("floor", "cup")
    assert [event.change for event in simulation.touches] == ["began"]
    simulation.set_pose(cup, at(0, 3))
    simulation.advance(0.55)
    assert not simulation.touch(floor, cup)
    assert [event.change for event in simulation.touches] == ["ended"]


@pytest.mark.parametrize("late", [False, True])
def test_a_belt_carries_what_lies_on_it(late: bool) -> None:
    simulation = d2m_ccd.Simulation()
    running = [0.5, 0, 0]
    belt = simulation.add(FLAT, kind="static", friction=0.5, surface_velocity=None if late else running)
    parcel = simulation.add(BOX, pose=at(0, 1.001), friction=0.5)
    if late:
        simulation.set_surface_velocity(belt, running)
    simulation.advance(1.0)
    assert simulation.velocities()[parcel, 0] == pytest.approx(0.5, abs=1e-3)


def test_damping_fades_velocities() -> None:
    simulation = d2m_ccd.Simulation(gravity=WEIGHTLESS)
    first = simulation.add(BOX, v=[1, 0, 0], linear_damping=2.0)
    second = simulation.add(BOX, pose=at(0, 5), w=[0, 0, 1])
    simulation.set_damping(second, angular=2.0)
    simulation.advance(0.5)
    velocities = simulation.velocities()
    assert [velocities[first, 0], velocities[second, 5]] == pytest.approx([math.exp(-1)] * 2, rel=1e-9)


def test_groups_decide_who_meets() -> None:
    simulation, _, cup = standing()
    ghost = simulation.add(BOX, pose=at(2, 1.001), groups=(2, 0))
    simulation.advance(0.9)
    assert simulation.pose(ghost).x[1] < 0.5 < 1.0 < simulation.pose(cup).x[1]
    with pytest.raises(d2m_ccd.InputError, match="intersect"):
        simulation.set_groups(ghost)
    simulation.set_groups(cup, member=4, meets=0)
    simulation.advance(2.0)
    assert simulation.pose(cup).x[1] < 0.0


def test_kinds_and_targets() -> None:
    simulation, floor, cup = standing()
    simulation.set_kind(cup, "static")
    simulation.remove(floor)
    simulation.advance(1.0)
    y = simulation.pose(cup).x[1]
    simulation.set_motion(cup, d2m_ccd.ConstantTwist(x=[0, y - 1.0, 0], v=[0, 1, 0]))
    simulation.advance(1.5)
    assert simulation.pose(cup).x[1] == pytest.approx(y + 0.5, abs=1e-9)
    simulation.set_kind(cup, "driven")
    simulation.set_target(cup, at(0.01, y))
    simulation.advance(1.6)
    assert simulation.pose(cup).x == pytest.approx([0.01, y, 0], abs=1e-12)
    with pytest.raises(d2m_ccd.InputError, match="too fast") as caught:
        simulation.set_target(cup, d2m_ccd.Pose(q=[0, 0, 0, 1]))
    assert caught.value.value == pytest.approx(math.pi)
    with pytest.raises(d2m_ccd.InputError, match="a kinematic body needs one"):
        simulation.set_kind(cup, "kinematic")
    simulation.set_kind(cup, "dynamic")
    simulation.advance(2.6)
    assert simulation.pose(cup).x[1] < y - 4


def test_impulses_and_forces_at_points_turn_a_body() -> None:
    simulation = d2m_ccd.Simulation(gravity=WEIGHTLESS)
    hit, pushed = simulation.add(BOX, mass=1.0), simulation.add(BOX, mass=1.0, pose=at(5, 0))
    simulation.apply_impulse_at(hit, [0, 1, 0], [0.5, 0, 0])
    simulation.add_force_at(pushed, [0, 100, 0], [5.5, 0, 0])
    simulation.advance(0.01)
    # Moments of inertia 1/6; of a step with a force the velocity is that of its middle.
    expected = np.array([[0, 1, 0, 0, 0, 3], [0, 0.5, 0, 0, 0, 1.5]])
    assert simulation.velocities()[[hit, pushed]] == pytest.approx(expected, abs=1e-9)


def test_pairs_meet_again() -> None:
    simulation = d2m_ccd.Simulation(gravity=WEIGHTLESS)
    wall = simulation.add(BOX, kind="static")
    ball = simulation.add(BOX, pose=at(-3, 0), v=[4, 0, 0], restitution=1.0)
    simulation.ignore(wall, ball)
    simulation.advance(0.75)
    with pytest.raises(d2m_ccd.InputError, match="intersect"):
        simulation.heed(wall, ball)
    simulation.advance(1.5)
    simulation.heed(wall, ball)
    simulation.set_velocity(ball, [-4, 0, 0])
    simulation.advance(2.5)
    assert simulation.velocities()[ball, 0] == pytest.approx(4.0)


def test_bodies_are_checked_when_they_are_added() -> None:
    simulation, _, _ = standing()
    with pytest.raises(d2m_ccd.InputError, match="bodies cup and late intersect"):
        simulation.add(BOX, name="late", pose=at(0.9, 1.001), checked=True)
    assert len(simulation) == 2
    assert simulation.add(BOX, name="late", pose=at(1.9, 1.001), checked=True) == 2


def test_what_is_not_named_is_called_by_its_index() -> None:
    simulation = d2m_ccd.Simulation()
    simulation.add_joint("fixed", simulation.add(BOX))  # with the world, which takes a place
    other = simulation.add(BOX, pose=at(0.5, 0))
    with pytest.raises(d2m_ccd.InputError, match=f"bodies 0 and {other} intersect"):
        simulation.advance(0.1)


def test_rays_and_distances_of_the_present() -> None:
    simulation, floor, cup = standing()
    now = simulation.frozen()
    top = simulation.pose(cup).x[1] + 0.5
    hit = now.ray([0, 5, 0], [0, -10, 0])
    assert (hit.status, hit.body) == ("hit", cup)
    assert hit.lo is not None
    assert hit.hi is not None
    assert hit.lo <= 5 - top
    assert hit.lo <= hit.hi == pytest.approx(5 - top, abs=1e-6)
    assert hit.normal == pytest.approx([0, 1, 0], abs=1e-4)
    assert hit.point == pytest.approx([0, top, 0], abs=1e-6)
    side = now.ray([2, 5, 0], [0, -10, 0])
    assert (side.body, now.ray([9, 5, 0], [0, -10, 0]).status) == (floor, "free")
    simulation.set_pose(cup, at(0, 9))
    # It goes on without what was frozen.
    assert now.distance("floor", "cup").value < 2e-3
    assert simulation.frozen().distance(floor, cup).value == pytest.approx(8.0)
    late = simulation.add(BOX, pose=at(0, 20))
    with pytest.raises(KeyError):
        now.distance(floor, late)
    with pytest.raises(d2m_ccd.InputError, match=r"way\[1\]"):
        now.ray([0, 0, 0], [0, math.inf, 0])
    starved = simulation.frozen(node_tests=1).ray([-2.9, 5, 0], [0.01, -10, 0.01])
    assert (starved.status, starved.body, starved.lo) == ("undecided", None, None)
    assert starved.free_until is not None


@pytest.mark.parametrize("written", [False, True])
def test_a_snapshot_goes_on_with_the_same_bits(written: bool) -> None:
    simulation, floor, cup = standing()
    arm = simulation.add(BOX, name="arm", pose=at(5, 3), w=[0.1, 0.2, 0.3])
    hinge = simulation.add_joint("revolute", arm, point=[4.5, 3, 0], motor=d2m_ccd.Motor(velocity=1.0, most=2.0))
    simulation.apply_impulse(cup, [300, 0, 100])
    simulation.advance(0.7)
    before = simulation.snapshot()
    if written:
        before = d2m_ccd.Snapshot.from_bytes(before.to_bytes())
    simulation.advance(1.2)
    once = simulation.poses(), simulation.velocities(), simulation.joint_value(hinge), simulation.time
    simulation.add(BOX, name="late", pose=at(0, 50))
    simulation.remove_joint(hinge)
    simulation.set_gravity([0, 1, 0])
    simulation.restore(before)
    with pytest.raises(KeyError):
        simulation.pose("late")
    assert simulation.snapshot() == before
    simulation.advance(1.2)
    again = simulation.poses(), simulation.velocities(), simulation.joint_value(hinge), simulation.time
    assert all(np.array_equal(a, b) for a, b in zip(once, again))
    simulation.remove(floor)
    with pytest.raises(d2m_ccd.InputError, match="snapshot") as caught:
        simulation.restore(before)
    assert caught.value.index == floor


def test_what_touched_in_a_run_that_was_gone_back_on_is_listed_no_more() -> None:
    simulation = d2m_ccd.Simulation()
    floor = simulation.add(BOX, kind="static")
    cup = simulation.add(BOX, pose=at(0, 1.1))
    before = simulation.snapshot()
    simulation.advance(0.3)
    assert [(event.a, event.b, event.change) for event in simulation.touches] == [(floor, cup, "began")]
    simulation.restore(before)
    assert simulation.touches == [] and not simulation.touch(floor, cup)
    simulation.advance(0.3)
    assert [(event.a, event.b, event.change) for event in simulation.touches] == [(floor, cup, "began")]
    # What was removed touches no more: the next run says so, also after this state was gone back to.
    simulation.remove(cup)
    removed = simulation.snapshot()
    for _ in range(2):
        simulation.advance(simulation.time + 0.1)
        assert [event.change for event in simulation.touches] == ["ended"]
        simulation.restore(removed)


def test_joints_that_cannot_be_made() -> None:
    simulation, floor, cup = standing()
    with pytest.raises(d2m_ccd.InputError, match="glue") as caught:
        simulation.add_joint("glue", floor, cup)  # type: ignore[arg-type]
    assert caught.value.value == "glue"
    with pytest.raises(d2m_ccd.InputError, match="only a locked one"):
        simulation.add_joint("fixed", cup, ways=[True, False, False])
    with pytest.raises(d2m_ccd.InputError, match="axis"):
        simulation.add_joint("revolute", floor, cup, axis=[0, 0, 0])
    with pytest.raises(d2m_ccd.InputError, match="limits"):
        simulation.add_joint("revolute", floor, cup, limits=(1.0, -1.0))
    with pytest.raises(d2m_ccd.InputError, match="dynamic"):
        simulation.add_joint("fixed", floor)
    with pytest.raises(d2m_ccd.InputError, match=r"point\[0\]") as caught:
        simulation.add_joint("fixed", cup, point=[math.nan, 0, 0])
    assert caught.value.index == 0
    for words in ({}, {"velocity": 1.0, "position": 1.0}):
        with pytest.raises(d2m_ccd.InputError, match="either velocity or position"):
            d2m_ccd.Motor(**words)
    hinge = simulation.add_joint("revolute", cup)
    assert hinge == 0
    with pytest.raises(d2m_ccd.InputError, match="motor max"):
        simulation.set_motor(hinge, d2m_ccd.Motor(velocity=1.0, most=-1.0))


def test_bodies_that_cannot_be_changed_so() -> None:
    simulation, floor, cup = standing()
    with pytest.raises(d2m_ccd.InputError, match="not dynamic") as caught:
        simulation.set_velocity(floor, [1, 2, 3])
    assert caught.value.value == (1.0, 2.0, 3.0)
    with pytest.raises(d2m_ccd.InputError, match="linear damping") as caught:
        simulation.set_damping(cup, linear=-1.0)
    assert caught.value.value == -1.0
    with pytest.raises(d2m_ccd.InputError, match="presence"):
        simulation.add(BOX, presence="ghost")  # type: ignore[arg-type]
    with pytest.raises(d2m_ccd.InputError, match="not driven"):
        simulation.set_target(cup, at(0, 1))
    with pytest.raises(d2m_ccd.InputError, match="no snapshot"):
        d2m_ccd.Snapshot.from_bytes(b"nothing")
    with pytest.raises(KeyError, match="nobody"):
        simulation.wake("nobody")
    motor, spring = d2m_ccd.Motor(position=1.0, most=2.0, stiffness=3.0, damping=4.0), d2m_ccd.Spring(1.0, 2.0, 3.0)
    assert repr(motor) == "Motor(position=1.0, most=2.0, stiffness=3.0, damping=4.0)"
    assert (motor.velocity, motor.position, d2m_ccd.Motor(velocity=1.0).most) == (None, 1.0, None)
    assert repr(spring) == "Spring(1.0, 2.0, 3.0)"
