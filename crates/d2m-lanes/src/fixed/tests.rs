//! Every back end against the scalar twin, bit for bit.
use super::{F64x2, scalar};
use core::ops::{Add, Div, Mul, Neg, Sub};

const VALUES: [f64; 22] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.1,
    -0.3,
    1.5e300,
    -1.5e300,
    f64::MAX,
    -f64::MAX,
    f64::MIN_POSITIVE,
    -f64::MIN_POSITIVE,
    5e-324,
    -5e-324,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    6_755_399_441_055_745.0,
    6_755_399_441_055_746.0,
    6_755_399_441_055_747.0,
    2.0,
    1e-160,
];

fn same(a: [f64; 2], b: [f64; 2]) -> bool {
    a.iter().zip(&b).all(|(a, b)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()))
}

fn same_bits(a: [f64; 2], b: [f64; 2]) -> bool {
    a.map(f64::to_bits) == b.map(f64::to_bits)
}

#[test]
fn equals_the_scalar_twin() {
    let values = if cfg!(miri) { &VALUES[10..17] } else { &VALUES[..] };
    for &a in values {
        for &b in values {
            for (c, d) in [(a, b), (b, 1.25), (-3.0, a), (b, b)] {
                let (x, y) = (F64x2::pack(a, b), F64x2::new(c, d));
                let (p, q) = (scalar::F64x2::pack(a, b), scalar::F64x2::new(c, d));
                macro_rules! binary { ($($f:ident)*) => { $(
                    assert!(same(x.$f(y).to_array(), p.$f(q).to_array()), "{} {a:e} {b:e} {c:e} {d:e}", stringify!($f));
                )* } }
                binary!(add sub mul div max min first_and_second);
                macro_rules! masks { ($($f:ident)*) => { $(
                    assert!(same_bits(x.$f(y).to_array(), p.$f(q).to_array()), "{} {a:e} {b:e} {c:e} {d:e}", stringify!($f));
                )* } }
                masks!(lt le and xor);
                macro_rules! unary { ($($f:ident)*) => { $(
                    assert!(same(x.$f().to_array(), p.$f().to_array()), "{} {a:e} {b:e}", stringify!($f));
                )* } }
                unary!(sqrt abs neg neg_first swap both_first both_second lowest_bit second_bit_as_sign);
                assert_eq!(x.sign_bits(), p.sign_bits());
                assert!(same([x.first(), x.second()], [p.first(), p.second()]));
                let (m, n) = (x.lt(y), p.lt(q));
                assert!(same(m.select(x, y).to_array(), n.select(p, q).to_array()));
                assert!(same(F64x2::splat(a).to_array(), scalar::F64x2::splat(a).to_array()));
            }
        }
    }
}

#[test]
fn integer_square_root_is_correctly_rounded() {
    let mut state = 3u64;
    let mut check = |x: f64| {
        let (soft, hard) = (super::soft_sqrt::sqrt(x), x.sqrt());
        assert!(soft == hard || soft.is_nan() && hard.is_nan(), "{x:e}: {soft:e} {hard:e}");
    };
    VALUES.into_iter().for_each(&mut check);
    for _ in 0..if cfg!(miri) { 20 } else { 200_000 } {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        check(f64::from_bits(state >> 1));
        // Squares and their neighbours.
        let root = ((state >> 38) as f64) * 1024.0 + 1.0;
        check(root * root);
        check((root * root).next_up());
        check((root * root).next_down());
    }
}
