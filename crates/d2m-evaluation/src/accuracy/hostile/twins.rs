//! Metamorphic twins: the same physical query in other words. What both say must agree.
use super::guise::Guise;
use super::scene::{Body, HostileScene};
use d2m::Budget;
use d2m::motion::ConstantTwist;
use d2m_testing::Xoshiro256 as Random;
use glam::{DQuat, DVec3};
use std::time::Duration;

/// How times and lengths of a twin follow from those of the scene: t′ = scale·t + shift, lengths times `length`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    pub(crate) name: &'static str,
    pub(crate) time_scale: f64,
    pub(crate) time_shift: f64,
    pub(crate) length: f64,
    /// All numbers of the twin are exact images: the verdict must be the same, whatever rounding does.
    pub(crate) is_exact: bool,
    /// The first contact of the twin is not that of the scene (time runs backwards, or the window is cut).
    pub(crate) keeps_first: bool,
}

impl Change {
    const fn of(name: &'static str) -> Self {
        Self { name, time_scale: 1.0, time_shift: 0.0, length: 1.0, is_exact: true, keeps_first: true }
    }

    const fn rounded(self) -> Self {
        Self { is_exact: false, ..self }
    }

    pub(crate) fn time(&self, t: f64) -> f64 {
        self.time_scale * t + self.time_shift
    }
}

/// One of the twins, drawn at random.
pub(crate) fn twin(scene: &HostileScene, random: &mut Random) -> (HostileScene, Change) {
    let mut out = scene.clone();
    let change = match random.bits() % 19 {
        0 => {
            out.bodies.swap(0, 1);
            Change::of("bodies exchanged")
        }
        1 => length(&mut out, random.range(-60.0, 60.0) as i32),
        2 => time(&mut out, random.range(-60.0, 60.0) as i32),
        3 => {
            let (lengths, times) = (random.range(-150.0, 150.0) as i32, random.range(-150.0, 150.0) as i32);
            let (first, second) = (length(&mut out, lengths), time(&mut out, times));
            Change { length: first.length, name: "lengths and times scaled far", ..second }
        }
        4 => {
            let turn = [DQuat::from_xyzw(1.0, 0.0, 0.0, 1.0), DQuat::from_xyzw(0.0, 1.0, 0.0, 1.0)]
                [random.bits() as usize % 2];
            quarter(&mut out, turn);
            Change::of("turned by a right angle").rounded()
        }
        5 => {
            let turn = random.rotation();
            each(&mut out, |m| {
                moved(
                    m,
                    turn * m.position(),
                    turn * m.orientation(),
                    turn * m.linear_velocity(),
                    turn * m.angular_velocity(),
                )
            });
            Change::of("turned").rounded()
        }
        6 => {
            let velocity = random.direction() * 10f64.powf(random.range(-3.0, 3.0)) * scene.size();
            each(&mut out, |m| m.with_linear_velocity(m.linear_velocity() + velocity));
            Change::of("common velocity").rounded()
        }
        7 => {
            permute(&mut out.bodies[random.bits() as usize % 2], random);
            Change::of("vertices and triangles permuted")
        }
        8 => {
            let body = &mut out.bodies[random.bits() as usize % 2];
            subdivide(body, random);
            Change::of("a triangle cut in two").rounded()
        }
        9 => {
            // The window's second part alone, or the first.
            let [t0, t1] = out.window;
            let cut = t0 + (t1 - t0) * random.unit();
            if random.unit() < 0.5 {
                out.window[0] = cut;
            } else {
                out.window[1] = cut;
            }
            Change { keeps_first: false, ..Change::of("window cut") }
        }
        10 => reference_point(&mut out, random),
        12 | 13 => other_type(&mut out, random),
        14 => shifted(&mut out, random),
        15 => {
            let count = 10f64.powf(random.range(0.0, 5.0)) as u64;
            out.budget = out.budget.with_node_tests(count);
            Change::of("a budget of node tests")
        }
        16 => {
            let time = Duration::from_secs_f64(10f64.powf(random.range(-6.0, -2.0)));
            out.budget = Budget::UNLIMITED.with_wall_clock(time);
            Change::of("a budget of time")
        }
        17 => {
            out.is_parallel = true;
            Change::of("on all threads")
        }
        18 => {
            out.is_early = true;
            // A contact that is only near is no contact of the scene's.
            Change { keeps_first: false, ..Change::of("stops early") }
        }
        11 => {
            let [t0, t1] = scene.window;
            each(&mut out, |m| {
                moved(m, m.position(), m.orientation(), -m.linear_velocity(), -m.angular_velocity())
                    .with_reference_time(-m.reference_time())
            });
            out.window = [-t1, -t0];
            Change { keeps_first: false, time_scale: -1.0, ..Change::of("time reversed") }
        }
        _ => {
            // Mirrored in the plane z = 0: orientation of triangles, turns and rotations follow.
            for body in &mut out.bodies {
                for p in &mut body.vertices {
                    p.z = -p.z;
                }
                for t in &mut body.triangles {
                    t.swap(1, 2);
                }
                let m = &body.motion;
                let (q, w) = (m.orientation(), m.angular_velocity());
                let mirror = |p: DVec3| DVec3::new(p.x, p.y, -p.z);
                body.motion = moved(
                    m,
                    mirror(m.position()),
                    DQuat::from_xyzw(-q.x, -q.y, q.z, q.w),
                    mirror(m.linear_velocity()),
                    DVec3::new(-w.x, -w.y, w.z),
                )
                .with_at(mirror(m.at()));
            }
            Change::of("mirrored")
        }
    };
    for t in &mut out.planted {
        *t = change.time(*t);
    }
    (out, change)
}

fn each(scene: &mut HostileScene, change: impl Fn(&ConstantTwist) -> ConstantTwist) {
    for body in &mut scene.bodies {
        body.motion = change(&body.motion);
    }
}

fn moved(m: &ConstantTwist, x: DVec3, q: DQuat, v: DVec3, w: DVec3) -> ConstantTwist {
    m.with_position(x).with_orientation(q).with_linear_velocity(v).with_angular_velocity(w)
}

/// All lengths times 2^k; given tolerances too.
fn length(scene: &mut HostileScene, k: i32) -> Change {
    let factor = 2f64.powi(k);
    scene.tolerance = Some(factor * scene.tolerance.unwrap_or(1e-10 * scene.size()));
    scene.min_separation *= factor;
    for body in &mut scene.bodies {
        for p in &mut body.vertices {
            *p *= factor;
        }
        let m = &body.motion;
        body.motion = m
            .with_position(m.position() * factor)
            .with_linear_velocity(m.linear_velocity() * factor)
            .with_at(m.at() * factor);
    }
    Change { length: factor, ..Change::of("lengths scaled") }
}

/// All times times 2^k.
fn time(scene: &mut HostileScene, k: i32) -> Change {
    let factor = 2f64.powi(k);
    each(scene, |m| {
        m.with_linear_velocity(m.linear_velocity() / factor)
            .with_angular_velocity(m.angular_velocity() / factor)
            .with_reference_time(m.reference_time() * factor)
    });
    scene.window = scene.window.map(|t| t * factor);
    Change { time_scale: factor, ..Change::of("times scaled") }
}

/// The motions in other types.
fn other_type(scene: &mut HostileScene, random: &mut Random) -> Change {
    let mut guise = || Guise::OTHERS[random.bits() as usize % Guise::OTHERS.len()];
    let (first, second) = (guise(), guise());
    scene.bodies[0].guise = first;
    if random.unit() < 0.7 {
        scene.bodies[1].guise = second;
    }
    let change = Change::of("another type of motion");
    // Times that are reversed twice are rounded twice.
    if scene.bodies.iter().any(|body| body.guise == Guise::Reversed) { change.rounded() } else { change }
}

/// All times later by the same amount.
fn shifted(scene: &mut HostileScene, random: &mut Random) -> Change {
    let [start, end] = scene.window;
    let by = (end - start).max(f64::MIN_POSITIVE) * 2f64.powi(random.range(-3.0, 20.0) as i32);
    let is_exact = |t: f64| t + by - by == t && t + by - t == by;
    let change = Change { time_shift: by, ..Change::of("times shifted") };
    let exact = scene.window.iter().all(|&t| is_exact(t))
        && scene.bodies.iter().all(|body| is_exact(body.motion.reference_time()));
    each(scene, |m| m.with_reference_time(m.reference_time() + by));
    scene.window = scene.window.map(|t| t + by);
    if exact { change } else { change.rounded() }
}

/// Turned by a right angle: coordinates are exchanged exactly; orientations are quaternions that are not unit.
fn quarter(scene: &mut HostileScene, turn: DQuat) {
    let unit = turn.normalize();
    let exact = |p: DVec3| {
        let q = unit * p;
        // One of the exchanged coordinates, with its exact digits.
        let pick = |x: f64| {
            let near = |c: &f64| (c.abs() - x.abs()).abs();
            let c = p.to_array().into_iter().min_by(|a, b| near(a).total_cmp(&near(b))).unwrap_or(0.0);
            c.abs().copysign(x)
        };
        DVec3::new(pick(q.x), pick(q.y), pick(q.z))
    };
    each(scene, |m| {
        moved(
            m,
            exact(m.position()),
            turn * m.orientation(),
            exact(m.linear_velocity()),
            exact(m.angular_velocity()),
        )
    });
}

fn permute(body: &mut Body, random: &mut Random) {
    let count = body.vertices.len();
    let mut order: Vec<usize> = (0..count).collect();
    for i in (1..count).rev() {
        order.swap(i, random.bits() as usize % (i + 1));
    }
    let mut place = vec![0u32; count];
    for (new, &old) in order.iter().enumerate() {
        place[old] = new as u32;
    }
    body.vertices = order.iter().map(|&old| body.vertices[old]).collect();
    for t in &mut body.triangles {
        *t = t.map(|i| place[i as usize]);
        let turn = random.bits() as usize % 3;
        t.rotate_left(turn);
    }
    for i in (1..body.triangles.len()).rev() {
        body.triangles.swap(i, random.bits() as usize % (i + 1));
    }
}

/// Cuts an edge, and all triangles at it, in two; the new vertex is on the edge up to rounding.
fn subdivide(body: &mut Body, random: &mut Random) {
    let [p, q, _] = body.triangles[random.bits() as usize % body.triangles.len()];
    let middle = body.vertices.len() as u32;
    body.vertices.push(body.vertices[p as usize].midpoint(body.vertices[q as usize]));
    let mut out = Vec::with_capacity(body.triangles.len() + 2);
    for t in &body.triangles {
        match (0..3).find(|&k| [t[k], t[(k + 1) % 3]] == [p, q] || [t[k], t[(k + 1) % 3]] == [q, p]) {
            Some(k) => {
                let (i, j, l) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
                out.extend([[i, middle, l], [middle, j, l]]);
            }
            None => out.push(*t),
        }
    }
    body.triangles = out;
}

/// Another reference point of one body: the same motion up to rounding where the body turns, exactly where it does not.
fn reference_point(scene: &mut HostileScene, random: &mut Random) -> Change {
    let far = 10f64.powf(random.range(-1.0, 4.0)) * scene.size();
    let by = random.direction() * far;
    let body = &mut scene.bodies[random.bits() as usize % 2];
    let m = body.motion;
    if m.angular_velocity() == DVec3::ZERO {
        let turned = m.orientation().normalize() * by;
        body.motion = m.with_at(m.at() + by).with_position(m.position() + turned);
        return Change::of("reference point moved, no turn").rounded();
    }
    // Along the axis of the spin nothing changes but the position.
    let axis = m.angular_velocity().normalize();
    let by = axis * far;
    let own = m.orientation().normalize().conjugate() * by;
    body.motion = m.with_at(m.at() + own).with_position(m.position() + by);
    Change::of("reference point moved along the axis").rounded()
}
