//! What may be changed of a running simulation, between two steps.

use crate::fault::OrRaise;
use crate::pose::{pose_argument, vec3_or_zero};
use crate::simulation::{Simulation, finite, kind_argument};
use d2m_dynamics::{Damping, Groups};
use pyo3::prelude::*;

#[pymethods]
impl Simulation {
    /// Puts the mesh frame of a body that follows no motion somewhere else; its velocities stay.
    ///
    /// Raises `InputError` if it would intersect another one there: nothing changes then.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> cup = simulation.add("shape:box")
    /// >>> simulation.set_pose(cup, d2m_ccd.Pose(x=[0, 2, 0]))
    /// >>> simulation.pose(cup).x.tolist()
    /// [0.0, 2.0, 0.0]
    fn set_pose(&self, body: &Bound<'_, PyAny>, pose: &Bound<'_, PyAny>) -> PyResult<()> {
        let pose = pose_argument(Some(pose), "pose")?;
        self.change(body, |engine, id| engine.set_pose(id, pose))
    }

    /// Gives a dynamic body these velocities, of its center of mass and angular, world axes.
    ///
    /// Raises `InputError` for a body that is not dynamic and for velocities that are too large: nothing changes then.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.set_velocity(simulation.add("shape:box"), [1, 0, 0])
    #[pyo3(signature = (body, v, w=None))]
    fn set_velocity(
        &self,
        body: &Bound<'_, PyAny>,
        v: &Bound<'_, PyAny>,
        w: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (linear, angular) = (finite(v, "v")?, vec3_or_zero(w, "w")?);
        self.change(body, |engine, id| engine.set_velocity(id, linear, angular))
    }

    /// Another gravity from now on, world axes. All bodies are awake.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Simulation().set_gravity([0, -1.62, 0])
    fn set_gravity(&self, py: Python<'_>, gravity: &Bound<'_, PyAny>) -> PyResult<()> {
        let gravity = finite(gravity, "gravity")?;
        self.lock(py).engine.set_gravity(gravity).or_raise()
    }

    /// Restitution and friction of a body from now on.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.set_material(simulation.add("shape:box"), restitution=0.5, friction=0.2)
    #[pyo3(signature = (body, *, restitution, friction))]
    fn set_material(&self, body: &Bound<'_, PyAny>, restitution: f64, friction: f64) -> PyResult<()> {
        self.change(body, |engine, id| engine.set_material(id, restitution, friction))
    }

    /// How fast the velocities of a body fade from now on: each by the factor exp(-rate step) in a step.
    ///
    /// Raises `InputError` for rates that are negative or not finite.
    ///
    /// >>> import d2m_ccd, math
    /// >>> simulation = d2m_ccd.Simulation(gravity=[0, 0, 0])
    /// >>> puck = simulation.add("shape:box", v=[1, 0, 0])
    /// >>> simulation.set_damping(puck, linear=2.0)
    /// >>> segments = simulation.advance(0.5)
    /// >>> abs(simulation.velocities()[puck, 0] - math.exp(-1)) < 1e-9
    /// np.True_
    #[pyo3(signature = (body, *, linear=0.0, angular=0.0))]
    fn set_damping(&self, body: &Bound<'_, PyAny>, linear: f64, angular: f64) -> PyResult<()> {
        self.change(body, |engine, id| engine.set_damping(id, Damping { linear, angular }))
    }

    /// How fast the surface of a body runs from now on, mesh axes: a belt that stands still itself.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> belt = simulation.add("shape:box?x=5&y=0.5&z=0.5", kind="static", friction=0.5)
    /// >>> parcel = simulation.add("shape:box?x=0.5&y=0.5&z=0.5", pose=d2m_ccd.Pose(x=[0, 1.001, 0]), friction=0.5)
    /// >>> simulation.set_surface_velocity(belt, [0.5, 0, 0])
    /// >>> segments = simulation.advance(1.0)
    /// >>> round(float(simulation.velocities()[parcel, 0]), 3)
    /// 0.5
    fn set_surface_velocity(&self, body: &Bound<'_, PyAny>, velocity: &Bound<'_, PyAny>) -> PyResult<()> {
        let velocity = finite(velocity, "velocity")?;
        self.change(body, |engine, id| engine.set_surface_velocity(id, velocity))
    }

    /// Bits of the groups that a body is in from now on, and of those whose bodies it meets; all by default. Two bodies meet if each is in a
    /// group that the other one meets; else they pass through each other.
    ///
    /// Raises `InputError` if it intersects a body that it would meet: nothing changes then.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> wall, ghost = simulation.add("shape:box", kind="static"), simulation.add("shape:box")
    /// >>> simulation.set_groups(ghost, meets=0)
    /// >>> segments = simulation.advance(0.1)
    /// >>> simulation.set_groups(ghost)  # doctest: +ELLIPSIS
    /// Traceback (most recent call last):
    ///     ...
    /// d2m_ccd._errors.InputError: bodies 0 and 1 intersect at the start: ...
    #[pyo3(signature = (body, *, member=None, meets=None))]
    fn set_groups(&self, body: &Bound<'_, PyAny>, member: Option<u32>, meets: Option<u32>) -> PyResult<()> {
        let Groups { member: all, meets: every } = Groups::ALL;
        let groups = Groups { member: member.unwrap_or(all), meets: meets.unwrap_or(every) };
        self.change(body, |engine, id| engine.set_groups(id, groups))
    }

    /// Makes a body "dynamic", "static", "kinematic" (then `motion`, of the mesh frame) or "driven", where it is; joints stay.
    ///
    /// Raises `InputError` if it intersects a body that it would meet, if mass properties are missing, and for a motion that does not cover
    /// the present time: nothing changes then.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> held = simulation.add("shape:box", kind="static")
    /// >>> simulation.set_kind(held, "dynamic")
    /// >>> segments = simulation.advance(0.1)
    /// >>> bool(simulation.pose(held).x[1] < 0)
    /// True
    #[pyo3(signature = (body, kind, *, motion=None))]
    fn set_kind(
        &self,
        body: &Bound<'_, PyAny>,
        kind: &str,
        motion: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let size = {
            let inner = self.lock(body.py());
            2.0 * inner.engine.radius(inner.find(body)?)
        };
        let kind = kind_argument(kind, motion, size)?;
        self.change(body, |engine, id| engine.set_kind(id, kind))
    }

    /// Another motion for a body, of its mesh frame: it is kinematic from now on. Raises as `set_kind`.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> lift = simulation.add("shape:box", kind="static")
    /// >>> simulation.set_motion(lift, d2m_ccd.ConstantTwist(v=[0, 1, 0]))
    /// >>> segments = simulation.advance(0.5)
    /// >>> round(float(simulation.pose(lift).x[1]), 9)
    /// 0.5
    fn set_motion(&self, body: &Bound<'_, PyAny>, motion: &Bound<'_, PyAny>) -> PyResult<()> {
        self.set_kind(body, "kinematic", Some(motion))
    }

    /// Where the mesh frame of a driven body is to be at the end of the next step, however long that is; it stands still there until it has
    /// another target.
    ///
    /// Raises `InputError` for a turn of 3 radians or more (its value) and for a body that is not driven: nothing changes then.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation(step=0.01)
    /// >>> hand = simulation.add("shape:box", kind="driven")
    /// >>> simulation.set_target(hand, d2m_ccd.Pose(x=[0.02, 0, 0]))
    /// >>> segments = simulation.advance(0.05)
    /// >>> round(float(simulation.pose(hand).x[0]), 9)
    /// 0.02
    fn set_target(&self, body: &Bound<'_, PyAny>, pose: &Bound<'_, PyAny>) -> PyResult<()> {
        let pose = pose_argument(Some(pose), "pose")?;
        self.change(body, |engine, id| engine.set_target(id, pose))
    }

    /// These two bodies may pass through each other.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.ignore(simulation.add("shape:box"), simulation.add("shape:box"))
    fn ignore(&self, a: &Bound<'_, PyAny>, b: &Bound<'_, PyAny>) -> PyResult<()> {
        self.change_pair(a, b, |engine, a, b| {
            engine.ignore(a, b);
            Ok(())
        })
    }

    /// These two bodies meet again, after `ignore` or a joint.
    ///
    /// Raises `InputError` if they intersect: nothing changes then.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> a, b = simulation.add("shape:box"), simulation.add("shape:box", pose=d2m_ccd.Pose(x=[3, 0, 0]))
    /// >>> simulation.ignore(a, b)
    /// >>> simulation.heed(a, b)
    fn heed(&self, a: &Bound<'_, PyAny>, b: &Bound<'_, PyAny>) -> PyResult<()> {
        self.change_pair(a, b, |engine, a, b| engine.heed(a, b))
    }

    /// Restitution and friction of one pair, instead of what follows from its bodies.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.set_pair(simulation.add("shape:box"), simulation.add("shape:box"), restitution=0.5, friction=0.2)
    #[pyo3(signature = (a, b, *, restitution, friction))]
    fn set_pair(
        &self,
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        restitution: f64,
        friction: f64,
    ) -> PyResult<()> {
        self.change_pair(a, b, |engine, a, b| engine.set_pair(a, b, restitution, friction))
    }

    /// A force through the center of mass and a torque over the next step, world axes; gravity comes on top.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.set_force(simulation.add("shape:box"), [0, 100, 0])
    #[pyo3(signature = (body, force, torque=None))]
    fn set_force(
        &self,
        body: &Bound<'_, PyAny>,
        force: &Bound<'_, PyAny>,
        torque: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (force, torque) = (finite(force, "force")?, vec3_or_zero(torque, "torque")?);
        self.change(body, |engine, id| engine.set_force(id, force, torque))
    }

    /// Adds a force that acts at a point over the next step, both in world axes, to those that act already.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation(gravity=[0, 0, 0])
    /// >>> cube = simulation.add("shape:box", mass=1.0)
    /// >>> for side in (1, -1):  # two thrusters, whose torques cancel
    /// ...     simulation.add_force_at(cube, [0, 50, 0], [side, 0, 0])
    /// >>> segments = simulation.advance(0.01)
    /// >>> simulation.velocities()[cube].round(9).tolist()
    /// [0.0, 0.5, 0.0, 0.0, 0.0, 0.0]
    fn add_force_at(
        &self,
        body: &Bound<'_, PyAny>,
        force: &Bound<'_, PyAny>,
        point: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let (force, point) = (finite(force, "force")?, finite(point, "point")?);
        self.change(body, |engine, id| engine.add_force_at(id, force, point))
    }

    /// Adds an impulse at the center of mass and an angular impulse, world axes.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.apply_impulse(simulation.add("shape:box"), [0, 100, 0])
    #[pyo3(signature = (body, impulse, angular=None))]
    fn apply_impulse(
        &self,
        body: &Bound<'_, PyAny>,
        impulse: &Bound<'_, PyAny>,
        angular: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (impulse, angular) = (finite(impulse, "impulse")?, vec3_or_zero(angular, "angular")?);
        self.change(body, |engine, id| engine.apply_impulse(id, impulse, angular))
    }

    /// Adds an impulse that acts at a point, both in world axes.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation(gravity=[0, 0, 0])
    /// >>> cube = simulation.add("shape:box?x=0.5&y=0.5&z=0.5", mass=1.0)  # moments of inertia 1/6
    /// >>> simulation.apply_impulse_at(cube, [0, 1, 0], [0.5, 0, 0])
    /// >>> simulation.velocities()[cube].round(9).tolist()
    /// [0.0, 1.0, 0.0, 0.0, 0.0, 3.0]
    fn apply_impulse_at(
        &self,
        body: &Bound<'_, PyAny>,
        impulse: &Bound<'_, PyAny>,
        point: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let (impulse, point) = (finite(impulse, "impulse")?, finite(point, "point")?);
        self.change(body, |engine, id| engine.apply_impulse_at(id, impulse, point))
    }

    /// The body is simulated again if it sleeps. It falls asleep again where it stays at rest.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> floor = simulation.add("shape:box", kind="static")
    /// >>> cup = simulation.add("shape:box", pose=d2m_ccd.Pose(x=[0, 2.001, 0]))
    /// >>> segments = simulation.advance(2.0)
    /// >>> asleep = simulation.is_asleep(cup)
    /// >>> simulation.wake(cup)
    /// >>> asleep, simulation.is_asleep(cup)
    /// (True, False)
    fn wake(&self, body: &Bound<'_, PyAny>) -> PyResult<()> {
        self.change(body, |engine, id| {
            engine.wake(id);
            Ok(())
        })
    }

    /// Does the body rest, and is not simulated until something comes close?
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.is_asleep(simulation.add("shape:box"))
    /// False
    fn is_asleep(&self, body: &Bound<'_, PyAny>) -> PyResult<bool> {
        let inner = self.lock(body.py());
        Ok(inner.engine.is_asleep(inner.find(body)?))
    }

    /// Do these two bodies touch, as the last `TouchEvent` of them said?
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.touch(simulation.add("shape:box"), simulation.add("shape:box", pose=d2m_ccd.Pose(x=[3, 0, 0])))
    /// False
    fn touch(&self, a: &Bound<'_, PyAny>, b: &Bound<'_, PyAny>) -> PyResult<bool> {
        let inner = self.lock(a.py());
        Ok(inner.engine.touch(inner.find(a)?, inner.find(b)?))
    }
}
