use super::*;
use d2m_testing::{Draw, Random};

#[test]
fn first_zeros_are_early_and_tight() {
    let mut random = Random(1);
    let mut tight: usize = 0;
    for i in 0..200_000 {
        // (r − x)(s − x)·c, planted as small integers over a power of two: exact coefficients.
        let scale = (0.5_f64).powi(10);
        let r = (random.unit() * 1024.0).ceil() * scale;
        let s = (random.signed() * 1024.0).round() * scale;
        let c = (random.unit() * 16.0).ceil() * if s < 0.0 { -1.0 } else { 1.0 };
        let gap = r * s * c;
        let (slope, curvature) = (-(r + s) * c, 2.0 * c);
        let first = if s > 0.0 { r.min(s) } else { r };
        if gap <= 0.0 {
            continue;
        }
        let bound = Quadratic::bound_first_zero(gap, slope, curvature);
        assert!(bound <= first, "{i}: {bound} > {first}");
        let double = (r - s).abs() < 1e-2;
        assert!(bound >= first * if double { 1.0 - 1e-6 } else { 1.0 - 1e-12 }, "{bound} {first} {r} {s}");
        tight += usize::from(bound > first * (1.0 - 1e-14));
    }
    assert!(tight > 50_000, "{tight}");
}

#[test]
fn first_zeros_of_odd_input_exclude_nothing_wrongly() {
    let zero = Quadratic::bound_first_zero;
    assert_eq!(zero(1.0, 0.0, 0.0), f64::INFINITY);
    assert_eq!(zero(1.0, 1.0, 1.0), f64::INFINITY);
    assert!((zero(1.0, 0.0, -2.0) - 1.0).abs() < 1e-14);
    // Rising first, falling later.
    assert!((zero(1.0, 2.0, -2.0) - (1.0 + 2.0_f64.sqrt())).abs() < 1e-14);
    for (gap, slope, curvature) in [
        (f64::NAN, -1.0, 1.0),
        (1.0, f64::NAN, 1.0),
        (1.0, -1.0, f64::NAN),
        (1.0, 1.0, f64::NAN),
        (f64::INFINITY, -1.0, -1.0),
    ] {
        assert_eq!(zero(gap, slope, curvature), 0.0, "{gap} {slope} {curvature}");
    }
    // Squares that underflow: 1e-170 · 2e-170 may not move the root beyond 0.5·1e0.
    assert!(zero(1e-170, -2e-170, -1e-300) <= 0.5);
    assert!(zero(1e-170, -2e-170, 0.0) <= 0.5);
}

#[test]
fn clipping_keeps_every_time_in_the_band() {
    let mut random = Random(2);
    let (mut empty, mut shorter) = (0, 0);
    for _ in 0..50_000 {
        let q = Quadratic {
            value: random.signed(),
            slope: 4.0 * random.signed(),
            curvature: 9.0 * random.signed(),
        };
        let other = Quadratic { value: random.signed(), slope: random.signed(), curvature: random.signed() };
        let (center, margin) = (random.signed(), 0.3 * random.unit());
        let band = Band { lo: center - margin, hi: center + margin };
        let part = Piece { lo: -random.unit(), hi: random.unit() };
        let clipped = q.clip(band, part);
        let shared = q.clip_shared_sign(&other, margin, part);
        empty += usize::from(clipped.is_none());
        shorter += usize::from(clipped.is_some_and(|c| c.width() < 0.9 * part.width()));
        for i in 0..=64 {
            let s = if i == 64 { part.hi } else { part.lo + part.width() * f64::from(i) / 64.0 };
            let keeps = |piece: Option<Piece>| piece.is_some_and(|p| p.lo <= s && s <= p.hi);
            // Inside the band by 1e-14, for the rounding that the caller's margin covers.
            if q.at(s) >= band.lo + 1e-14 && q.at(s) <= band.hi - 1e-14 {
                assert!(keeps(clipped), "{q:?} {band:?} {part:?} {s}");
            }
            let (f, g) = (q.at(s), other.at(s));
            let share = (f > margin && g > margin) || (f < -margin && g < -margin);
            if !share && f.abs().min(g.abs()) < margin - 1e-14 {
                assert!(keeps(shared), "{q:?} {other:?} {margin} {part:?} {s}");
            }
            assert!(q.bound_below(part) <= q.at(s) + 1e-14);
        }
    }
    assert!(empty > 5000 && shorter > 5000, "{empty} {shorter}");
}

#[test]
fn cubics_are_clipped_to_their_root_and_keep_every_time_in_the_band() {
    let mut random = Random(3);
    let (mut empty, mut tiny, mut worst) = (0, 0, 0.0_f64);
    for _ in 0..50_000 {
        let cubic = super::Cubic {
            value: random.signed(),
            slope: 4.0 * random.signed(),
            curvature: 9.0 * random.signed(),
            jerk: 20.0 * random.signed(),
        };
        let (m, r) = (random.signed(), random.unit());
        let NearbyQuadratic { quadratic, left_out } = cubic.quadratic_near(m, r);
        let part = Piece { lo: -random.unit(), hi: random.unit() };
        let constant = 1e-14 + 0.1 * (random.unit() - 0.5).max(0.0);
        let margin = |h: f64| constant + 1e-3 * h * h * h * h;
        let clipped = cubic.clip(Band { lo: -0.01, hi: 0.02 }, margin, part);
        let root = cubic.clip(Band { lo: 0.0, hi: 0.0 }, |_| 1e-14, part);
        empty += usize::from(clipped.is_none());
        tiny += usize::from(root.is_some_and(|p| p.width() < 1e-3));
        for i in 0..=64 {
            let x = f64::from(i) / 32.0 - 1.0;
            let difference = (cubic.at(m + r * x) - quadratic.at(r * x)).abs();
            assert!(difference <= left_out + 1e-13, "{difference} {left_out}");
            worst = worst.max(difference / (left_out + 1e-13));
            let s = (part.lo + part.width() * f64::from(i) / 64.0).min(part.hi);
            let keeps = |piece: Option<Piece>| piece.is_some_and(|p| p.lo <= s && s <= p.hi);
            let (value, allowed) = (cubic.at(s), margin(s.abs()) - 1e-13);
            if value >= -0.01 - allowed && value <= 0.02 + allowed && allowed > 0.0 {
                assert!(keeps(clipped), "{cubic:?} {part:?} {s}");
            }
        }
        // A change of sign between two samples stays inside.
        for i in 0..64 {
            let at = |i: i32| part.lo + part.width() * f64::from(i) / 64.0;
            if cubic.at(at(i)) * cubic.at(at(i + 1)) < -1e-20 {
                let kept = root.expect("a root is never lost");
                assert!(kept.lo <= at(i + 1) && at(i) <= kept.hi, "{cubic:?} {part:?} {kept:?}");
            }
        }
    }
    assert!(empty > 5000 && tiny > 5000 && worst > 0.9, "{empty} {tiny} {worst}");
}

/// A distance |x(t)| with x a cubic: contact where it vanishes; every answer is exact up to 1e-14.
struct Cubic {
    roots: [f64; 3],
    slope: f64,
    floor: f64,
}

impl Cubic {
    fn value(&self, t: f64) -> f64 {
        self.slope * (t - self.roots[0]) * (t - self.roots[1]) * (t - self.roots[2])
    }
    fn lipschitz(&self) -> f64 {
        // On [0, 1] with roots in [−1, 2].
        self.slope.abs() * 12.0
    }
}

impl PieceTest for Cubic {
    fn too_wide(&self, h: f64) -> bool {
        h > 0.3
    }
    fn evaluate(&mut self, piece: Piece) -> Verdict {
        let (lo, hi) = (self.value(piece.lo), self.value(piece.hi));
        let reach = |x: f64| (x.abs() - 1e-14) / self.lipschitz();
        let part = Piece { lo: piece.lo + reach(lo).max(0.0), hi: piece.hi - reach(hi).max(0.0) };
        if part.lo > part.hi {
            return Verdict::Clear;
        }
        Verdict::Within {
            part,
            certain: self.floor == 0.0 && lo * hi < 0.0 && lo.abs().min(hi.abs()) > 1e-14,
        }
    }
    fn measure(&mut self, _: Piece, at: f64) -> Measurement {
        let distance = self.value(at).abs() + self.floor;
        let clear = (distance - 1e-14) / self.lipschitz();
        Measurement { distance, clear_lo: at - clear, clear_hi: at + clear }
    }
    fn tolerance(&self) -> f64 {
        1e-6
    }
    fn resolution(&self) -> f64 {
        1e-6 / (2.0 * self.lipschitz())
    }
}

#[test]
fn the_first_root_is_isolated_from_the_left() {
    let mut random = Random(3);
    for i in 0..2000 {
        let first = random.unit();
        // The other roots to the right, to the left, or double.
        let other = match i % 4 {
            0 => first,
            1 => first + 1e-9,
            2 => -random.unit(),
            _ => first + random.unit(),
        };
        let mut test =
            Cubic { roots: [first, other, 1.0 + random.unit()], slope: 1.0 + random.unit(), floor: 0.0 };
        let truth = if other >= 0.0 { first.min(other) } else { first };
        let answer = isolate(&mut test, Piece { lo: 0.0, hi: 1.0 }, &IsolatorOptions::new());
        let FirstRoot::Found { bracket, distance, .. } = answer.root else {
            panic!("{:?}: {answer:?}", test.roots);
        };
        assert!(bracket.lo <= truth + 1e-13, "late: {bracket:?} {truth}");
        assert!(distance <= 1e-6);
        let near = test.value(bracket.lo).abs().min(test.value(bracket.hi).abs());
        assert!(near <= 1e-5, "{bracket:?} {truth} {near}");
        assert!(bracket.lo <= bracket.hi && answer.evaluations < 1 << 20, "{:?} {answer:?}", test.roots);
        // With a floor above the tolerance there is none.
        test.floor = 1e-3;
        let apart = isolate(&mut Floored(test), Piece { lo: 0.0, hi: 1.0 }, &IsolatorOptions::new());
        assert_eq!(apart.root, FirstRoot::Clear);
    }
}

/// The same distance, never below its floor.
struct Floored(Cubic);

impl PieceTest for Floored {
    fn too_wide(&self, h: f64) -> bool {
        self.0.too_wide(h)
    }
    fn evaluate(&mut self, piece: Piece) -> Verdict {
        Verdict::Within { part: piece, certain: false }
    }
    fn measure(&mut self, piece: Piece, at: f64) -> Measurement {
        self.0.measure(piece, at)
    }
    fn tolerance(&self) -> f64 {
        self.0.tolerance()
    }
    fn resolution(&self) -> f64 {
        self.0.resolution()
    }
}

#[test]
fn the_budget_gives_a_certified_time_and_the_start_is_seen() {
    let options = IsolatorOptions::new().with_max_evaluations(3);
    let mut test = Floored(Cubic { roots: [0.9, 0.9, 0.9], slope: 1.0, floor: 1e-8 });
    let answer = isolate(&mut test, Piece { lo: 0.0, hi: 1.0 }, &options);
    let FirstRoot::Undecided { clear_until } = answer.root else { panic!("{answer:?}") };
    assert!((0.0..0.95).contains(&clear_until));
    let mut test = Cubic { roots: [0.0, 2.0, 2.0], slope: 1.0, floor: 0.0 };
    let answer = isolate(&mut test, Piece { lo: 0.0, hi: 1.0 }, &IsolatorOptions::new());
    let FirstRoot::Found { bracket, .. } = answer.root else { panic!("{answer:?}") };
    assert_eq!(bracket.lo, 0.0);
    // A window of one moment.
    let mut test = Cubic { roots: [0.5, 2.0, 2.0], slope: 1.0, floor: 0.0 };
    let now = Piece { lo: 0.5, hi: 0.5 };
    let answer = isolate(&mut test, now, &IsolatorOptions::new());
    assert!(matches!(answer.root, FirstRoot::Found { bracket, .. } if bracket == now), "{answer:?}");
}
