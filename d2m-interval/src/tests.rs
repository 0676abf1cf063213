use crate::{Interval, IntervalMat3};
use glam::{DQuat, DVec3};

#[test]
fn trig_encloses_and_is_narrow() {
    let mut x = -70.0;
    while x < 70.0 {
        let (s, c) = Interval::point(x).sin_cos();
        assert!(s.lo() < x.sin() && x.sin() < s.hi() || s.contains(x.sin()), "{x}");
        assert!(c.contains(x.cos()), "{x}");
        assert!(s.width() < 1e-14 && c.width() < 1e-14);
        let w = Interval::new(x, x + 1.3);
        for i in 0..=10 {
            let y = (x + 0.13 * f64::from(i)).min(x + 1.3);
            assert!(w.sin().contains(y.sin()) && w.cos().contains(y.cos()), "{w:?} {y}");
            assert!(y == 0.0 || w.sinc().contains(y.sin() / y), "{w:?} {y} {:?}", w.sinc());
        }
        x += 0.0137;
    }
}

#[test]
fn rotations_agree() {
    let omega = DVec3::new(0.3, -2.0, 1.1);
    let t = 0.77;
    let m = IntervalMat3::rotation(omega, Interval::point(t));
    let q = DQuat::from_scaled_axis(omega * t);
    let n = IntervalMat3::from_quat_normalized(q * 3.0);
    let p = DVec3::new(1.0, 2.0, -3.0);
    for v in [m * p, n * p] {
        assert!((v.mid() - q * p).length() < 1e-14);
        assert!(v.x.width() < 1e-13);
    }
    assert!(m.mul_mat(n.transpose()).rows()[0].x.contains(1.0 - 1e-16));
}
