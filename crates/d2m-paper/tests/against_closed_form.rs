//! The closed-form feature tests against the reference method's, on features that meet or miss by little; disputes are
//! settled with 70 digits.

use d2m_feature::{ContactOptions, FirstContact, PairMotion};
use d2m_interval::Interval;
use d2m_motion::ConstantTwist;
use d2m_paper::{PaperOptions, RelativeMotion, edge_edge, point_triangle};
use d2m_root::RootSearch;
use d2m_testing::Draw;
use d2m_testing::Random;
use d2m_testing::fixed::{self, Fix, V, cross, dot, sub};
use glam::{DVec3, dvec3};

/// Two features and their motions.
struct Case {
    motions: [ConstantTwist; 2],
    feature: Feature,
}

enum Feature {
    PointTriangle(DVec3, [DVec3; 3]),
    EdgeEdge([DVec3; 2], [DVec3; 2]),
}

impl Case {
    /// Something that happens around `time`, off by `miss`.
    fn random(random: &mut Random, round: usize) -> Self {
        let (v, w) = [(1.0, 1.0), (512.0, 3.0), (0.25, 12.0), (4.0, 0.0), (0.0, 3.0), (1e5, 1.0)][round % 6];
        let grid = round.is_multiple_of(11);
        let motions: [ConstantTwist; 2] = core::array::from_fn(|_| {
            let m = fixed::random_motion(random, v, w);
            if grid {
                let fall = (random.vector() * 8.0).round() / 4.0;
                ConstantTwist::REST.with_position(m.position().round()).with_linear_velocity(fall)
            } else {
                m
            }
        });
        let miss = random.vector() * [0.0, 1e-3, 1e-6, 1e-9, 1e-11, 1.0][(round / 6) % 6];
        let point = if grid { random.vector().round() } else { random.vector() };
        let q = fixed::relative(&motions[0], &motions[1], point, &Fix::new(0.5))[0].clone();
        let at = dvec3(q[0].to_f64(), q[1].to_f64(), q[2].to_f64()) + miss;
        let size = [1.0, 0.1, 1e-3][round % 3];
        let (e, d) = (random.vector() * size, random.vector() * size);
        let feature = if random.signed() < 0.0 {
            // The planted place is inside, on a side, or at a vertex; slivers and collapsed triangles now and then.
            let thin = [1.0, 1.0, 1e-6, 0.0][round % 4];
            let weights = [(0.4, 0.3), (0.5, 0.0), (0.0, 0.0)][round % 3];
            let d = e * 0.5 + d * thin;
            let vertex = at - e * weights.0 - d * weights.1;
            Feature::PointTriangle(point, [vertex, vertex + e, vertex + d])
        } else {
            let share = [0.5, 0.25, 0.0, 1.0][round % 4];
            let own = if grid { random.vector().round() } else { random.vector() * size };
            Feature::EdgeEdge(
                [point - own * 0.5, point + own * 0.5],
                [at - d * share, at + d * (1.0 - share)],
            )
        };
        Self { motions, feature }
    }

    /// f and, at a root of f, whether the place is strictly inside both features.
    fn function(&self, t: &Fix) -> (Fix, bool) {
        let path = |p: DVec3| fixed::relative(&self.motions[0], &self.motions[1], p, t)[0].clone();
        let (zero, one) = (Fix::new(0.0), Fix::new(1.0));
        let strictly = |x: &Fix| *x > zero && *x < one;
        match &self.feature {
            Feature::PointTriangle(point, triangle) => {
                let c: [V; 3] = triangle.map(fixed::vec);
                let (e, d) = (sub(&c[1], &c[0]), sub(&c[2], &c[0]));
                let n = cross(&e, &d);
                let q = sub(&path(*point), &c[0]);
                let f = dot(&n, &q);
                let nn = dot(&n, &n);
                if nn.0 == dashu_int::IBig::ZERO {
                    return (f, false);
                }
                let s = dot(&cross(&q, &d), &n).divide(&nn);
                let r = dot(&cross(&e, &q), &n).divide(&nn);
                (f, strictly(&s) && strictly(&r) && &s + &r < one)
            }
            Feature::EdgeEdge(mover, observer) => {
                let a = mover.map(path);
                let b = observer.map(fixed::vec);
                let (e, d, w) = (sub(&a[1], &a[0]), sub(&b[1], &b[0]), sub(&b[0], &a[0]));
                let n = cross(&e, &d);
                let nn = dot(&n, &n);
                if nn.0 == dashu_int::IBig::ZERO {
                    return (zero, false);
                }
                let s = dot(&cross(&w, &d), &n).divide(&nn);
                let r = dot(&cross(&w, &e), &n).divide(&nn);
                (dot(&n, &w), strictly(&s) && strictly(&r))
            }
        }
    }

    /// Is there certainly a contact between the two times? (A change of sign with the place inside at both.)
    fn certainly_meet(&self, from: f64, to: f64) -> bool {
        let (f, inside) = self.function(&Fix::new(from));
        let (g, still) = self.function(&Fix::new(to));
        let zero = Fix::new(0.0);
        inside && still && ((f < zero && g > zero) || (f > zero && g < zero))
    }
}

#[test]
fn neither_misses_what_the_other_proves() {
    let mut random = Random(21);
    let window = Interval::UNIT;
    let (mut hits, mut disputes) = (0, 0);
    for round in 0..1600 {
        let case = Case::random(&mut random, round);
        let relative = RelativeMotion::new(&case.motions[0], &case.motions[1]);
        let pair = PairMotion::new(&case.motions[0], &case.motions[1], 0.0, 1.0);
        let options = PaperOptions::DEFAULT;
        let (reference, closed) = match &case.feature {
            Feature::PointTriangle(p, t) => (
                point_triangle(&relative, *p, t, window, &options),
                pair.point_triangle(*p, t, &ContactOptions::new().with_tolerance(1e-10)),
            ),
            Feature::EdgeEdge(a, b) => (
                edge_edge(&relative, a, b, window, &options),
                pair.edge_edge(*a, *b, &ContactOptions::new().with_tolerance(1e-10)),
            ),
        };
        let claim = match reference {
            RootSearch::Bracket(b) => Some((b.lo(), b.hi())),
            RootSearch::None => None,
            RootSearch::Undecided { .. } => panic!("{round}: reference undecided"),
        };
        let other = match closed {
            FirstContact::Contact(b) => Some((b.lo, b.hi)),
            FirstContact::Clear => None,
            FirstContact::Undecided { .. } => panic!("{round}: closed form undecided"),
        };
        // A true contact in or about the bracket, before the time up to which the other one calls it free.
        let mut meet = |(lo, hi): (f64, f64), free: f64| {
            disputes += 1;
            case.certainly_meet((lo - 1e-12).max(0.0), (hi + 1e-12).min(free))
        };
        match (claim, other) {
            (Some(r), None) => assert!(!meet(r, 1.0), "{round}: closed form misses {r:?}"),
            (None, Some(c)) => assert!(!meet(c, 1.0), "{round}: reference misses {c:?}"),
            (Some(r), Some(c)) => {
                hits += 1;
                assert!(c.0 <= r.1 || !meet(r, c.0), "{round}: closed form {c:?} later than {r:?}");
                assert!(r.0 <= c.1 || !meet(c, r.0), "{round}: reference {r:?} later than {c:?}");
            }
            (None, None) => {}
        }
    }
    println!("{hits} hits, {disputes} disputes settled");
    assert!(hits > 500, "{hits}");
}
