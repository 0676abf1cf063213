//! A scene of the hostile families: two bodies, a window, options; asked, written down and read back.
use super::guise::Guise;
use d2m::bvh::Evidence;
use d2m::motion::ConstantTwist;
use d2m::{Budget, MeshTree, Moving, QueryOptions, Solid, TimeOfContact, TriMesh, Window, time_of_contact};
use glam::{DQuat, DVec3};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// A query that takes longer counts as undecided.
const PATIENCE: Duration = Duration::from_secs(1);
/// A query may end so much later than its budget of time, by the documented promise.
const LATE: Duration = Duration::from_millis(1);

/// A mesh and how it moves.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    pub(crate) vertices: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) motion: ConstantTwist,
    /// How the motion is given to the library.
    pub(crate) guise: Guise,
}

/// One query.
#[derive(Clone, Debug)]
pub(crate) struct HostileScene {
    pub(crate) bodies: [Body; 2],
    pub(crate) window: [f64; 2],
    pub(crate) solid: Solid,
    pub(crate) tolerance: Option<f64>,
    pub(crate) min_separation: f64,
    /// Asked in the mode that stops early.
    pub(crate) is_early: bool,
    /// Asked on all threads.
    pub(crate) is_parallel: bool,
    pub(crate) budget: Budget,
    /// Times at which the construction puts a contact, or nearly: where the oracle tests first.
    pub(crate) planted: Vec<f64>,
}

/// An answer, as far as it is judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Answer {
    Separated,
    Contact {
        lo: f64,
        hi: f64,
        separation: f64,
        tolerance: f64,
        evidence: Evidence,
        starts_apart: bool,
    },
    Undecided {
        clear_until: f64,
    },
    /// Bad input, by the library's own word.
    Refused,
}

/// For how long this thread has waited for a processor since its begin: the second number of proc(5)'s schedstat, nanoseconds.
fn waiting_time() -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let number = text.split_whitespace().nth(1).and_then(|word| word.parse().ok());
    Duration::from_nanos(number.unwrap_or(0))
}

impl Answer {
    /// The time before which it says that nothing touches.
    pub(crate) fn free_until(&self, window: [f64; 2]) -> f64 {
        match *self {
            Self::Separated => window[1],
            Self::Contact { lo, .. } => lo,
            Self::Undecided { clear_until } => clear_until.clamp(window[0], window[1]),
            Self::Refused => window[0],
        }
    }
}

/// The budget of a scene that is about something else.
pub(crate) const PATIENT: Budget = Budget::UNLIMITED.with_wall_clock(PATIENCE);

/// An answer, and how late it came.
pub(crate) struct TimedAnswer {
    pub(crate) answer: Answer,
    /// How much longer than allowed the query took after the end of its budget, without the time for which other work had the
    /// processor (where the system reports it: Linux).
    pub(crate) late: Duration,
}

impl HostileScene {
    /// The answer to the query, which is made so often at most; the least delay counts.
    pub(crate) fn query_often(&self, tries: u32) -> TimedAnswer {
        let refused = TimedAnswer { answer: Answer::Refused, late: Duration::ZERO };
        let mesh =
            |body: &Body| TriMesh::try_new(body.vertices.clone(), body.triangles.clone()).map(MeshTree::new);
        let (Ok(a), Ok(b)) = (mesh(&self.bodies[0]), mesh(&self.bodies[1])) else { return refused };
        let Ok(window) = Window::try_new(self.window[0], self.window[1]) else { return refused };
        let mut options = QueryOptions::default()
            .with_solid(self.solid)
            .with_min_separation(self.min_separation)
            .with_parallel(self.is_parallel)
            .with_budget(self.budget);
        if self.is_early {
            options = options.with_mode(d2m::Mode::Capoeira);
        }
        if let Some(tolerance) = self.tolerance {
            options = options.with_tolerance(tolerance);
        }
        let [Some(first), Some(second)] = [0, 1].map(|i| {
            let body = &self.bodies[i];
            body.guise.of(body.motion, self.window)
        }) else {
            return refused;
        };
        let limit = self.budget.wall_clock.unwrap_or(Duration::MAX).saturating_add(LATE);
        let mut late = Duration::MAX;
        let mut said = None;
        for _ in 0..tries {
            let (begin, waited) = (Instant::now(), waiting_time());
            said =
                Some(time_of_contact(Moving::new(&a, &*first), Moving::new(&b, &*second), window, &options));
            let spent = begin.elapsed().saturating_sub(waiting_time().saturating_sub(waited));
            late = late.min(spent.saturating_sub(limit));
            if late.is_zero() {
                break;
            }
        }
        let answer = match said {
            None | Some(Err(_)) => Answer::Refused,
            Some(Ok(TimeOfContact::Separated)) => Answer::Separated,
            Some(Ok(TimeOfContact::Undecided { clear_until })) => Answer::Undecided { clear_until },
            Some(Ok(TimeOfContact::Contact(c))) => Answer::Contact {
                lo: c.time_lo,
                hi: c.time_hi,
                separation: c.separation,
                tolerance: c.tolerance,
                evidence: c.evidence,
                starts_apart: c.start == d2m::bvh::StartState::Apart,
            },
        };
        TimedAnswer { answer, late }
    }

    /// The larger extent of the two meshes.
    pub(crate) fn size(&self) -> f64 {
        let extent = |body: &Body| {
            let (lo, hi) = body
                .vertices
                .iter()
                .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
            (hi - lo).max_element()
        };
        extent(&self.bodies[0]).max(extent(&self.bodies[1]))
    }

    /// Everything that is needed to ask again, exactly: numbers as the bits of a double beside their decimals.
    pub(crate) fn to_json(&self) -> Value {
        let body = |b: &Body| {
            let m = &b.motion;
            json!({
                "vertices": b.vertices.iter().map(DVec3::to_array).collect::<Vec<_>>(),
                "triangles": b.triangles,
                "x": m.position().to_array(),
                "q": [m.orientation().w, m.orientation().x, m.orientation().y, m.orientation().z],
                "v": m.linear_velocity().to_array(),
                "w": m.angular_velocity().to_array(),
                "at": m.at().to_array(),
                "t": m.reference_time(),
                "guise": b.guise.name(),
            })
        };
        json!({
            "bodies": [body(&self.bodies[0]), body(&self.bodies[1])],
            "window": self.window,
            "solid": self.solid == Solid::Filled,
            "tolerance": self.tolerance,
            "min_separation": self.min_separation,
            "early": self.is_early,
            "parallel": self.is_parallel,
            "budget": {
                "node_tests": self.budget.node_tests,
                "seconds": self.budget.wall_clock.map(|time| time.as_secs_f64()),
            },
            "planted": self.planted,
        })
    }

    /// What [`Self::to_json`] wrote.
    pub(crate) fn from_json(value: &Value) -> Option<Self> {
        let numbers = |v: &Value| -> Option<Vec<f64>> { v.as_array()?.iter().map(Value::as_f64).collect() };
        let vec3 = |v: &Value| numbers(v).filter(|n| n.len() == 3).map(|n| DVec3::new(n[0], n[1], n[2]));
        let body = |v: &Value| -> Option<Body> {
            let vertices = v["vertices"].as_array()?.iter().map(vec3).collect::<Option<_>>()?;
            let triangle = |t: &Value| -> Option<[u32; 3]> {
                let ids =
                    t.as_array()?.iter().map(|i| i.as_u64().map(|i| i as u32)).collect::<Option<Vec<_>>>()?;
                ids.try_into().ok()
            };
            let triangles = v["triangles"].as_array()?.iter().map(triangle).collect::<Option<_>>()?;
            let q = numbers(&v["q"]).filter(|q| q.len() == 4)?;
            let rotation = DQuat::from_xyzw(q[1], q[2], q[3], q[0]);
            let motion =
                ConstantTwist::try_new(vec3(&v["x"])?, rotation, vec3(&v["v"])?, vec3(&v["w"])?).ok()?;
            let motion = motion.try_with_at(vec3(&v["at"])?).ok()?;
            let motion = motion.try_with_reference_time(v["t"].as_f64()?).ok()?;
            // Cases that were kept before there were guises have none.
            let guise = v["guise"].as_str().map_or(Some(Guise::ConstantTwist), Guise::from_name)?;
            Some(Body { vertices, triangles, motion, guise })
        };
        let window = numbers(&value["window"]).filter(|w| w.len() == 2)?;
        Some(Self {
            bodies: [body(&value["bodies"][0])?, body(&value["bodies"][1])?],
            window: [window[0], window[1]],
            solid: if value["solid"].as_bool()? { Solid::Filled } else { Solid::Surface },
            tolerance: value["tolerance"].as_f64(),
            min_separation: value["min_separation"].as_f64()?,
            is_early: value["early"].as_bool().unwrap_or(false),
            is_parallel: value["parallel"].as_bool().unwrap_or(false),
            budget: value["budget"].as_object().map_or(PATIENT, |budget| {
                let mut read = Budget::UNLIMITED;
                read.node_tests = budget["node_tests"].as_u64();
                read.wall_clock = budget["seconds"].as_f64().map(Duration::from_secs_f64);
                read
            }),
            planted: numbers(&value["planted"])?,
        })
    }
}
