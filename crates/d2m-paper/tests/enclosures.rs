//! The reference method's enclosures against 70 digits: ends sampled, one-instant spans included, so that rounding that
//! is not outward does not survive.

use d2m_interval::Interval;
use d2m_motion::ConstantTwist;
use d2m_paper::{BodyOverDomain, PointJet, RelativeMotion, test_sphere_pair};
use d2m_testing::Draw;
use d2m_testing::Random;
use d2m_testing::fixed::{self, Fix, V};
use glam::DVec3;

fn spans(random: &mut Random) -> Vec<Interval> {
    let a = random.signed();
    vec![
        Interval::point(a),
        Interval::new(a, a + 2f64.powi(-40)),
        Interval::new(a, a + 0.0625),
        Interval::new(a, a + 1.0),
    ]
}

fn times(span: Interval) -> Vec<f64> {
    let w = span.hi() - span.lo();
    [0.0, 1.0 / 1024.0, 0.25, 0.5, 0.75].iter().map(|f| span.lo() + w * f).chain([span.hi()]).collect()
}

fn check(jet: &PointJet, direction: DVec3, truth: impl Fn(&Fix) -> [V; 3], what: &str) -> f64 {
    let span = jet.span();
    let [value, rate, second] = jet.derivatives();
    let start = truth(&Fix::new(span.lo()));
    let coordinates = |v: &d2m_interval::IntervalVec3| [v.x, v.y, v.z];
    let holds = |v: &V, i: &d2m_interval::IntervalVec3| v.iter().zip(coordinates(i)).all(|(x, c)| x.is_in(c));
    assert!(holds(&start[0], value), "{what}: value at the start of {span:?}");
    assert!(holds(&start[1], rate), "{what}: rate at the start of {span:?}");
    let d = fixed::vec(direction);
    let mut fullest = 0.0f64;
    for t in times(span) {
        let now = truth(&Fix::new(t));
        let x = Interval::point(t) - span.lo();
        let part = jet.enclose(x);
        let along = jet.along(direction).enclose_at_offset(x);
        let all = jet.range_along(direction, jet.offsets(span));
        assert!(holds(&now[2], second), "{what}: second derivative at {t}");
        assert!(holds(&now[0], &part), "{what}: path at {t} of {span:?}");
        // How much of its half width does the acceleration use?
        for (a, c) in now[2].iter().zip(coordinates(second)) {
            fullest = fullest.max((a.to_f64() - c.mid()).abs() / (0.5 * c.width()).max(1e-300));
        }
        let value = fixed::dot(&now[0], &d);
        assert!(value.is_in(along) && value.is_in(all), "{what}: along {direction} at {t}");
    }
    fullest
}

#[test]
fn relative_paths_contain_the_truth() {
    let mut random = Random(1);
    let mut fullest = 0.0f64;
    for round in 0..24 {
        let (v, w) = [(1.0, 1.0), (512.0, 3.0), (0.0, 20.0), (4.0, 0.0)][round % 4];
        let far = if round % 5 == 0 { DVec3::new(1048576.0, -77.0, 5.5) } else { DVec3::ZERO };
        let mut motions: [ConstantTwist; 2] =
            core::array::from_fn(|_| fixed::random_motion(&mut random, v, w));
        if round % 3 == 0 {
            motions[0] = motions[0].with_at(random.vector()).with_reference_time(random.signed());
        }
        let motions = motions.map(|m| m.with_position(m.position() + far));
        let relative = RelativeMotion::new(&motions[0], &motions[1]);
        let (point, direction) = (random.vector(), random.vector());
        for span in spans(&mut random) {
            let [own, other] = relative.frames(span);
            let truth = |i: usize| {
                let (m, o) = (motions[i], motions[1 - i]);
                move |t: &Fix| fixed::relative(&m, &o, point, t)
            };
            fullest = fullest.max(check(&own.jet(point), direction, truth(0), "own frame"));
            check(&other.jet(point), direction, truth(1), "other frame");
            check(&relative.frame(span).jet(point), direction, truth(0), "single frame");
            check(&relative.swapped().frame(span).jet(point), direction, truth(1), "swapped frame");
            let place = relative.placement(span.lo()).enclose_point(point);
            let now = truth(0)(&Fix::new(span.lo()));
            assert!(now[0][0].is_in(place.x) && now[0][1].is_in(place.y) && now[0][2].is_in(place.z));
        }
    }
    assert!(
        fullest <= 1.0 && fullest > 0.5,
        "the acceleration's enclosure is nearly used up somewhere: {fullest}"
    );
}

#[test]
fn world_paths_contain_the_truth() {
    let mut random = Random(2);
    for round in 0..12 {
        let far = if round % 3 == 0 { DVec3::new(1e6, -3e5, 7.0) } else { DVec3::ZERO };
        let m = fixed::random_motion(&mut random, if round % 2 == 0 { 1.0 } else { 512.0 }, 3.0);
        let m = m.with_position(m.position() + far);
        let (point, direction) = (random.vector(), random.vector());
        for span in spans(&mut random) {
            let jet = BodyOverDomain::new(&m, span, far).jet(point);
            let rest = ConstantTwist::REST.with_position(far);
            check(&jet, direction, |t| fixed::relative(&m, &rest, point, t), "world");
        }
    }
}

/// Every time at which two spheres overlap lies in the hull that Test-Sphere-Pair returns.
#[test]
fn sphere_pairs_never_lose_an_overlap() {
    let mut random = Random(3);
    let (mut overlaps, mut empty, mut cut) = (0, 0, 0);
    for round in 0..480 {
        let w = [0.5, 3.0, 20.0][round % 3];
        let motions: [ConstantTwist; 2] = core::array::from_fn(|_| fixed::random_motion(&mut random, 3.0, w));
        let span = Interval::new(0.0, 0.5);
        let centers: [DVec3; 2] = core::array::from_fn(|_| random.vector());
        let radii = [0.5 + 0.25 * random.signed(), 0.5 + 0.25 * random.signed()];
        let spheres: [_; 2] = core::array::from_fn(|i| {
            BodyOverDomain::new(&motions[i], span, DVec3::ZERO).sphere(centers[i], radii[i])
        });
        let from = 0.25 + 0.25 * random.signed();
        let searched = Interval::new(from, (from + 0.3).min(0.5));
        let hull = test_sphere_pair(&spheres[0], &spheres[1], span.lo(), searched);
        for k in 0..=16 {
            let t = searched.lo() + (searched.hi() - searched.lo()) * (k as f64 / 16.0);
            let time = Fix::new(t);
            let gap = fixed::sub(
                &fixed::world(&motions[0], centers[0], &time),
                &fixed::world(&motions[1], centers[1], &time),
            );
            let reach = &Fix::new(radii[0]) + &Fix::new(radii[1]);
            if fixed::dot(&gap, &gap) <= &reach * &reach {
                overlaps += 1;
                assert!(hull.is_some_and(|h| h.contains(t)), "overlap at {t} lost: {hull:?}, {searched:?}");
            }
        }
        match hull {
            None => empty += 1,
            Some(h) if h != searched => cut += 1,
            Some(_) => {}
        }
    }
    assert!(overlaps > 300 && empty > 20 && cut > 20, "{overlaps} {empty} {cut}");
}

/// Erratum 1 at Algorithm 5, line 10: s̈/2 given to a θ that halves again loses the overlap.
#[test]
fn half_twice_loses_an_overlap() {
    // The mover's sphere moves on a circle, starting opposite to the observer's, where ṡ = 0: s = 2 + 2 cos t − r²,
    // s̈ ≥ −2. They meet at t = 1/5.
    let mover = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
    let span = Interval::new(0.0, 0.25);
    let reach = (2.0 + 2.0 * 0.2f64.cos()).sqrt() - 0.5;
    let a = BodyOverDomain::new(&mover, span, DVec3::ZERO).sphere(DVec3::X, 0.5);
    let b = BodyOverDomain::new(&ConstantTwist::REST, span, DVec3::ZERO).sphere(-DVec3::X, reach);
    let hull = test_sphere_pair(&a, &b, 0.0, span).expect("they meet at 1/5");
    assert!(hull.lo() <= 0.2 + 1e-12 && hull.hi() == span.hi());
    let literal = |x: f64| 4.0 - (reach + 0.5).powi(2) - 0.25 * 2.0 * x * x;
    assert!(literal(span.hi()) > 0.0, "the literal text would have been right");
}
