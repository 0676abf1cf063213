//! Answers about paths, proven again by the verifier, which shares nothing with the search.

use crate::failure::Failure;
use crate::output::short;
use d2m::verify::{DEFAULT_STEPS, PathVerdict, Verdict, verify_path};
use d2m_robot::{PathAnswer, PathBodies};

/// Was an answer proven again?
pub(super) enum Proof {
    /// In so many steps.
    Verified(u64),
    /// Why it was not.
    Unverified(String),
}

/// Proves an answer again, pair by pair.
pub(super) fn prove(bodies: &PathBodies<'_>, answer: &PathAnswer) -> Result<Proof, Failure> {
    let names = |pair: [usize; 2]| pair.map(|body| bodies.name(body));
    let verdict = verify_path(bodies, answer, DEFAULT_STEPS).map_err(|fault| {
        let [a, b] = names(fault.pair);
        Failure::at("--verify", format!("{a:?} and {b:?}: {}", fault.fault))
    })?;
    Ok(match verdict {
        PathVerdict::Verified { steps } => Proof::Verified(steps),
        PathVerdict::MeetBefore { pair, clear_until } => unverified(
            names(pair),
            &format!("let go at the start, they meet again at t = {}", short(clear_until)),
        ),
        PathVerdict::Pair { pair, verdict } => unverified(names(pair), &why(&verdict)),
        PathVerdict::OtherBodies => Proof::Unverified("the answer is about other bodies".to_owned()),
        other => Proof::Unverified(format!("{other:?}")),
    })
}

fn why(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Verified { steps } => format!("proven in {steps} steps"),
        Verdict::Refuted { time, distance, .. } => {
            let [time, lo, hi] = [*time, distance.lo(), distance.hi()].map(short);
            format!("REFUTED: at t = {time} they are between {lo} and {hi} apart")
        }
        Verdict::Unproven { clear_until, reason, .. } => {
            format!("not proven: {reason}; clear until {}", short(*clear_until))
        }
    }
}

fn unverified([a, b]: [&str; 2], why: &str) -> Proof {
    Proof::Unverified(format!("{a} \u{2013} {b}: {why}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m::bvh::{QueryOptions, Start};
    use d2m_robot::{PathContact, Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
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
        // A contact of bodies that are not checked, by their numbers or by their names, was proven with all others.
        let PathAnswer::Contact(found) = &met else { unreachable!("they meet") };
        let edited = |edit: &dyn Fn(&mut PathContact)| {
            let mut lie = found.clone();
            edit(&mut lie);
            proof(&plain, 0.8, &PathAnswer::Contact(lie))
        };
        assert!(matches!(edited(&|_| ()), Proof::Verified(_)));
        let lies: [&dyn Fn(&mut PathContact); 4] = [
            &|lie| lie.bodies = [0, 0],
            &|lie| lie.bodies = [900, 901],
            &|lie| lie.a = "rail".into(),
            &|lie| std::mem::swap(&mut lie.a, &mut lie.b),
        ];
        for lie in lies {
            assert!(
                matches!(edited(lie), Proof::Unverified(why) if why == "the answer is about other bodies")
            );
        }
    }

    /// The cart begins in the stop: what is let go has to leave, and counts again after that.
    #[test]
    fn bodies_that_never_leave_are_not_verified_as_free() {
        let robot = Arc::new(Robot::parse("slide.urdf", SLIDE, &RobotOptions::new()).unwrap());
        let scene = |start: Start| {
            let options = QueryOptions::default().with_start(start);
            RobotScene::new(Arc::clone(&robot), None, options).unwrap()
        };
        let path = |ways: &[f64]| {
            let points = ways.iter().enumerate().map(|(k, &x)| TrajectoryPoint::new(k as f64, vec![x]));
            Trajectory::new(vec!["run".into()], points.collect())
        };
        let leaving = scene(Start::Leave);
        let mut blind = leaving.clone();
        assert!(blind.ignore("cart", "stop"));
        let (out, back, stay) = (path(&[0.45, 0.0]), path(&[0.45, 0.0, 0.45]), path(&[0.45, 0.47]));
        let proof = |path: &Trajectory, by: &RobotScene| {
            let answer = by.check_path(path).unwrap();
            (answer.clone(), prove(&leaving.bodies_along(path).unwrap(), &answer).unwrap())
        };
        let is_proven = |proof: &Proof| matches!(proof, Proof::Verified(_));
        for (path, until) in [(&out, 1.0), (&back, 1.0 + 0.4 / 0.45), (&stay, 0.0)] {
            let (answer, found) = proof(path, &leaving);
            assert!((answer.free_until() - until).abs() < 1e-6 && is_proven(&found), "{answer:?}");
        }
        // What leaves the pair out says free; only of the path on which it parts and stays away is that true.
        assert!(is_proven(&proof(&out, &blind).1));
        for path in [&back, &stay] {
            let (answer, found) = proof(path, &blind);
            let Proof::Unverified(why) = found else { panic!("verified: {answer:?}") };
            assert!(answer.is_free() && why.contains("cart") && why.contains("stop"), "{why}");
        }
    }
}
