//! First roots of a scalar function by the paper's two searches, judged before they are timed.
use criterion::{Criterion, criterion_group, criterion_main};
use d2m::interval::Interval;
use d2m::root::{
    Gamma, InclusionFunction, IntervalFunction, RootSearch, SearchLimits, SecondOrder, bboi, hrfoi,
};
use std::f64::consts::FRAC_PI_2;
use std::hint::black_box;

/// cos t − offset, every root a contact.
struct Cosine {
    offset: f64,
}

impl IntervalFunction for Cosine {
    fn enclose(&mut self, t: Interval) -> Interval {
        t.cos() - self.offset
    }
}

impl SecondOrder for Cosine {
    fn inclusion_function(&mut self, t: Interval) -> InclusionFunction {
        let start = Interval::point(t.lo());
        InclusionFunction::new(start.cos() - self.offset, -start.sin(), -t.cos(), t)
    }
}

impl Gamma for Cosine {
    fn may_touch(&mut self, _: Interval) -> bool {
        true
    }
}

fn judge(found: &RootSearch, root: f64) {
    let RootSearch::Bracket(bracket) = found else { panic!("the root {root} was lost") };
    assert!(bracket.lo() <= root + 1e-15 && bracket.hi() >= root - 1e-15 && bracket.width() <= 1e-12);
}

fn first_roots(c: &mut Criterion) {
    let domain = Interval::new(0.0, 8.0);
    let limits = SearchLimits::new(1e-12);
    judge(&hrfoi(&mut Cosine { offset: 0.0 }, domain, limits), FRAC_PI_2);
    judge(&bboi(&mut Cosine { offset: 0.0 }, domain, limits), FRAC_PI_2);
    assert!(matches!(hrfoi(&mut Cosine { offset: 1.001 }, domain, limits), RootSearch::None));
    let mut group = c.benchmark_group("first root of cos t");
    group.bench_function("HRFOI", |b| {
        b.iter(|| hrfoi(&mut Cosine { offset: 0.0 }, black_box(domain), limits));
    });
    group.bench_function("BBOI", |b| b.iter(|| bboi(&mut Cosine { offset: 0.0 }, black_box(domain), limits)));
    group.bench_function("HRFOI, no root", |b| {
        b.iter(|| hrfoi(&mut Cosine { offset: 1.001 }, black_box(domain), limits));
    });
    group.finish();
}

criterion_group!(benches, first_roots);
criterion_main!(benches);
