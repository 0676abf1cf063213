//! What physics asks of a run.
use super::super::scene::Scene;
use d2m::motion::Pose;
use d2m_dynamics::{BodyId, StepError};
use glam::DVec3;

/// A run that is over.
pub(super) struct Ran<'s> {
    /// As it is at the end.
    pub(super) scene: &'s Scene,
    /// When the bodies were where: at the start and after each step.
    pub(super) track: &'s [(f64, Vec<Pose>)],
    /// Why it could not go on.
    pub(super) ended: Option<&'s StepError>,
    /// Kinetic energy and momentum of all dynamic bodies at the start.
    pub(super) energy: f64,
    pub(super) momentum: DVec3,
}

type Check = dyn Fn(&Ran<'_>) -> Option<String>;

/// In words, and how it is found out: what is wrong, if anything is.
pub(super) struct Law {
    pub(super) words: String,
    pub(super) check: Box<Check>,
}

impl Law {
    pub(super) fn new(
        words: impl Into<String>,
        check: impl Fn(&Ran<'_>) -> Option<String> + 'static,
    ) -> Self {
        Self { words: words.into(), check: Box::new(check) }
    }
}

impl Ran<'_> {
    /// How far a body has gone, by the time that is given.
    fn way(&self, body: BodyId, instant: usize) -> DVec3 {
        self.track[instant].1[body.index()].translation - self.track[0].1[body.index()].translation
    }

    fn last(&self) -> usize {
        self.track.len() - 1
    }
}

/// Kinetic energy and momentum of the dynamic bodies.
pub(super) fn kinetic(scene: &Scene) -> (f64, DVec3) {
    let simulation = &scene.simulation;
    let mut sums = (0.0, DVec3::ZERO);
    for &id in &scene.ids {
        let Some(properties) = simulation.mass_properties(id) else { continue };
        let velocity = simulation.linear_velocity(id);
        let spin = simulation.orientation(id).conjugate() * simulation.angular_velocity(id);
        sums.0 += 0.5 * (properties.mass * velocity.length_squared() + spin.dot(properties.inertia * spin));
        sums.1 += properties.mass * velocity;
    }
    sums
}

/// No dynamic body is ever further than this from where it began.
pub(super) fn stays(within: f64) -> Law {
    Law::new(format!("nothing moves by more than {within}"), move |ran| {
        let far = |&id: &BodyId| (0..ran.track.len()).map(|k| ran.way(id, k).length()).fold(0.0, f64::max);
        let most = ran.scene.ids.iter().map(far).fold(0.0, f64::max);
        (most > within).then(|| format!("a body moved by {most:.3e}, not {within:.3e} at most"))
    })
}

/// Surfaces are no faster than this at the end.
pub(super) fn rests(speed: f64) -> Law {
    Law::new(format!("at the end nothing is faster than {speed}"), move |ran| {
        let simulation = &ran.scene.simulation;
        let of = |&id: &BodyId| {
            simulation.linear_velocity(id).length()
                + simulation.angular_velocity(id).length() * simulation.radius(id)
        };
        let most = ran.scene.ids.iter().map(of).fold(0.0, f64::max);
        (most > speed).then(|| format!("{most:.3e} fast at the end"))
    })
}

/// At the end the body has gone this way, up to `within`.
pub(super) fn goes(body: BodyId, way: DVec3, within: f64) -> Law {
    Law::new(format!("body {} goes by {way}, ± {within:.3e}", body.index()), move |ran| {
        let found = ran.way(body, ran.last());
        let off = found.distance(way);
        (off > within).then(|| format!("it went by {found}, {off:.3e} off {way}"))
    })
}

/// At the end the body has gone by at least this far along the direction.
pub(super) fn gets_along(body: BodyId, direction: DVec3, least: f64) -> Law {
    Law::new(format!("body {} gets along {direction} by {least:.3e} or more", body.index()), move |ran| {
        let found = ran.way(body, ran.last()).dot(direction);
        (found < least).then(|| format!("it got {found:.3e} along {direction}, not {least:.3e}"))
    })
}

/// What this gives of the places of the bodies is never more than `most`.
pub(super) fn never_more(what: &'static str, most: f64, of: impl Fn(&[Pose]) -> f64 + 'static) -> Law {
    Law::new(format!("{what} is never more than {most:.6e}"), move |ran| {
        let worst = ran.track.iter().map(|(_, poses)| of(poses)).fold(f64::NEG_INFINITY, f64::max);
        (worst > most || worst.is_nan()).then(|| format!("{what} is {worst:.6e}, not {most:.6e} at most"))
    })
}

/// The velocity of the body at the end, up to `within`.
pub(super) fn leaves_at(body: BodyId, velocity: DVec3, within: f64) -> Law {
    Law::new(format!("body {} ends at the velocity {velocity}, ± {within:.1e}", body.index()), move |ran| {
        let found = ran.scene.simulation.linear_velocity(body);
        let off = found.distance(velocity);
        (off > within).then(|| format!("body {} ends at the velocity {found}, not {velocity}", body.index()))
    })
}

/// The kinetic energy at the end is that of the start, up to this part of it.
pub(super) fn keeps_energy(part: f64) -> Law {
    Law::new(format!("kinetic energy is kept to {part:.0e}"), move |ran| {
        let ratio = kinetic(ran.scene).0 / ran.energy;
        let off = (ratio - 1.0).abs();
        (off > part || off.is_nan()).then(|| format!("kinetic energy × {ratio}"))
    })
}

/// So is the momentum, up to this part of `scale`.
pub(super) fn keeps_momentum(part: f64, scale: f64) -> Law {
    Law::new(format!("momentum is kept to {part:.0e}"), move |ran| {
        let off = (kinetic(ran.scene).1 - ran.momentum).length();
        (off > part * scale).then(|| format!("momentum off by {off:.3e}"))
    })
}

/// The run ends because something is crushed or cornered, between these times: before the first one there is room.
pub(super) fn is_crushed(from: f64, to: f64) -> Law {
    Law::new(format!("a body is crushed, or cornered, between {from} and {to}"), move |ran| {
        let time = match ran.ended {
            Some(StepError::Crushed { time, .. } | StepError::Cornered { time, .. }) => *time,
            Some(_) => return None,
            None => return Some("nothing was crushed".into()),
        };
        (!(from..=to).contains(&time)).then(|| format!("ended {:.3e} s before there was no room", to - time))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each law is broken by a run that it forbids, and by no other.
    #[test]
    fn laws_are_broken_by_what_they_forbid() {
        let mut scene = Scene::stack(2).unwrap();
        let starts = scene.poses();
        let (energy, momentum) = (1.0, DVec3::ZERO);
        let id = scene.ids[0];
        scene.simulation.set_velocity(id, DVec3::X, DVec3::ZERO).unwrap();
        let mut moved = starts.clone();
        moved[id.index()].translation += DVec3::X;
        let track = [(0.0, starts), (1.0, moved)];
        let crushed = |time: f64| StepError::Crushed { pushing: "a".into(), crushed: "b".into(), time };
        let errors = [crushed(1.0), crushed(0.5)];
        let breaks = |law: &Law, ended: Option<&StepError>| {
            (law.check)(&Ran { scene: &scene, track: &track, ended, energy, momentum }).is_some()
        };
        let (kinetic, speed) = (kinetic(&scene).0, 1.0);
        for (law, is_broken) in [
            (stays(0.9), true),
            (stays(1.1), false),
            (goes(id, DVec3::X, 1e-9), false),
            (goes(id, DVec3::Y, 1e-9), true),
            (gets_along(id, DVec3::X, 0.9), false),
            (gets_along(id, DVec3::X, 1.1), true),
            (rests(0.9 * speed), true),
            (rests(1.1 * speed), false),
            (leaves_at(id, DVec3::X, 1e-9), false),
            (leaves_at(id, DVec3::ZERO, 1e-9), true),
            (keeps_energy(2.0 * kinetic), false),
            (keeps_energy(0.5 * kinetic), true),
            (keeps_momentum(1.0, 2.0 * kinetic), false),
            (keeps_momentum(1.0, kinetic), true),
            (never_more("x", 0.5, move |poses| poses[id.index()].translation.x), true),
            (never_more("x", 1.5, move |poses| poses[id.index()].translation.x), false),
            (is_crushed(0.0, 1.0), true),
        ] {
            assert_eq!(breaks(&law, None), is_broken, "{}", law.words);
        }
        let window = is_crushed(0.9, 1.1);
        assert!(!breaks(&window, Some(&errors[0])) && breaks(&window, Some(&errors[1])));
    }
}
