//! Other interval crates on the same kernel.
use criterion::Criterion;

use super::{Number, row};

#[derive(Clone, Copy)]
struct Maryada(maryada::Interval);

impl Number for Maryada {
    fn new(lo: f64, hi: f64) -> Self {
        Self(maryada::Interval::nums_to_interval(lo, hi, &mut ()))
    }
    fn add(self, o: Self) -> Self {
        Self(self.0 + o.0)
    }
    fn sub(self, o: Self) -> Self {
        Self(self.0 - o.0)
    }
    fn mul(self, o: Self) -> Self {
        Self(self.0 * o.0)
    }
    fn sqr(self) -> Self {
        Self(maryada::sqr(self.0))
    }
    fn sin_cos(self) -> (Self, Self) {
        (Self(maryada::sin(self.0)), Self(maryada::cos(self.0)))
    }
    fn ends(self) -> (f64, f64) {
        (maryada::inf(self.0), maryada::sup(self.0))
    }
}

pub(crate) fn rows(criterion: &mut Criterion) {
    row::<Maryada>(criterion, "kernel/maryada", true);
}
