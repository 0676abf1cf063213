//! Answers about paths, proven again by the verifier, which shares nothing with the search.

use crate::failure::Failure;
use crate::output::short;
use d2m::bvh::TimeOfContact;
use d2m::verify::{DEFAULT_STEPS, Verdict, Verifier};
use d2m_robot::{PathAnswer, PathBodies};

/// Was an answer proven again?
pub(super) enum Proof {
    /// In so many steps.
    Verified(u64),
    /// Why it was not.
    Unverified(String),
}

/// Proves an answer pair by pair: the pair that meets as it was found, all others apart until then. The steps are for all pairs.
pub(super) fn prove(bodies: &PathBodies<'_>, answer: &PathAnswer) -> Result<Proof, Failure> {
    let window = bodies.window();
    let until = answer.free_until();
    let apart = if until < window.end() {
        TimeOfContact::Undecided { clear_until: until }
    } else {
        TimeOfContact::Separated
    };
    let found = answer.contact();
    let mut left = DEFAULT_STEPS;
    for &pair in bodies.pairs() {
        let met = found.filter(|found| {
            let [a, b] = found.bodies;
            pair == [a, b] || pair == [b, a]
        });
        let (pair, claimed) =
            met.map_or((pair, apart), |found| (found.bodies, TimeOfContact::Contact(found.contact)));
        let names = pair.map(|body| bodies.name(body));
        let moving = pair.map(|body| bodies.moving(body));
        let [a, b] = moving.map(|body| body.body.mesh());
        let verifier = Verifier::try_new(a, b).map_err(|error| Failure::at("--verify", error))?;
        match verifier.time_of_contact(&moving, window, bodies.options(), &claimed, left) {
            Verdict::Verified { steps } => left = left.saturating_sub(steps),
            Verdict::Refuted { time, distance, .. } => {
                let [time, lo, hi] = [time, distance.lo(), distance.hi()].map(short);
                return Ok(unverified(
                    names,
                    &format!("REFUTED: at t = {time} they are between {lo} and {hi} apart"),
                ));
            }
            Verdict::Unproven { clear_until, reason, .. } => {
                let reason = format!("not proven: {reason}; clear until {}", short(clear_until));
                return Ok(unverified(names, &reason));
            }
        }
    }
    Ok(Proof::Verified(DEFAULT_STEPS - left))
}

fn unverified([a, b]: [&str; 2], why: &str) -> Proof {
    Proof::Unverified(format!("{a} \u{2013} {b}: {why}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m::bvh::QueryOptions;
    use d2m_robot::{Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
    use std::sync::Arc;

    const SLIDE: &str = r#"<robot name="slide">
      <link name="rail"><collision><geometry><box size="2 0.1 0.1"/></geometry></collision></link>
      <link name="cart"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
      <link name="stop"><collision><origin xyz="0.5 0 0.2"/><geometry><box size="0.1 1 1"/></geometry></collision></link>
      <joint name="run" type="prismatic"><parent link="rail"/><child link="cart"/><origin xyz="0 0 0.2"/></joint>
      <joint name="weld" type="fixed"><parent link="rail"/><child link="stop"/></joint></robot>"#;

    /// Answers of one scene are held against bodies that are kept further apart, or against another path.
    #[test]
    fn wrong_answers_are_not_verified() {
        let robot = Arc::new(Robot::parse("slide.urdf", SLIDE, &RobotOptions::new()).unwrap());
        let scene = |separation: f64| {
            let options = QueryOptions::default().with_min_separation(separation);
            RobotScene::new(Arc::clone(&robot), None, options).unwrap()
        };
        let path = |end: f64| {
            let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
            Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(1.0, end)])
        };
        let (plain, wide) = (scene(0.0), scene(0.2));
        let [free, met] = [0.39, 0.8].map(|end| plain.check_path(&path(end)).unwrap());
        assert!(free.is_free() && met.contact().is_some());
        let proof = |scene: &RobotScene, end: f64, answer: &PathAnswer| {
            prove(&scene.bodies_along(&path(end)).unwrap(), answer).unwrap()
        };
        for (end, answer) in [(0.39, &free), (0.8, &met)] {
            assert!(matches!(proof(&plain, end, answer), Proof::Verified(steps) if steps > 0));
        }
        for (scene, end, answer) in [(&wide, 0.39, &free), (&plain, 0.8, &free), (&plain, 0.81, &met)] {
            let Proof::Unverified(why) = proof(scene, end, answer) else { panic!("verified: {answer:?}") };
            assert!(why.contains("cart") && why.contains("stop"), "{why}");
        }
    }
}
