//! The table of docs/theory/features.md: mean, p99 and largest time of a query by family, answers judged first.
use d2m_feature::{ContactOptions, FirstContact, PairMotion, PlacedTriangle, StraightPaths};
use d2m_testing::Random;
use d2m_testing::planted::families::{Family, Kind, Planted, plant};
use d2m_testing::{Opaque, OpaqueWithState};
use std::hint::black_box;
use std::time::Instant;

/// The families of the table.
pub(crate) const COLUMNS: [(&str, Family); 4] =
    [("far", Family::Far), ("near", Family::Near), ("hit", Family::Hit), ("graze", Family::Graze)];

/// A query with its setup done: what is timed is the question alone.
pub(crate) struct Prepared {
    planted: Planted,
    pair: PairMotion<'static>,
    triangle: PlacedTriangle,
    straight: StraightPaths,
    enclosed: PairMotion<'static>,
    opaque: PairMotion<'static>,
}

/// Ways to ask.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Method {
    /// Closed-form jets.
    Rigid,
    /// The same with all that it takes from the numbers of a motion and a feature to the answer.
    RigidFromNumbers,
    /// Straight vertex paths: nothing is set up before.
    Straight,
    /// Any motion, with a state in plain floating point of its own.
    Enclosed,
    /// Any motion, with nothing but the interval enclosures that every motion must give.
    Opaque,
}

/// Queries of one family.
pub(crate) fn queries(kind: Kind, family: Family, count: usize, seed: u64) -> Vec<Prepared> {
    let mut random = Random::new(seed);
    (0..count)
        .map(|_| {
            let planted = plant(kind, family, &mut random);
            let (start, end) = planted.straight();
            // A pair borrows its motions; a bench may keep them for good.
            let keep = |motion| Box::leak(Box::new((motion, OpaqueWithState(motion), Opaque(motion))));
            let (a, b) = (keep(planted.motion_a), keep(planted.motion_b));
            let (t0, t1) = planted.window;
            let pair = PairMotion::new(&a.0, &b.0, t0, t1);
            let triangle = pair.place_triangle(&planted.b);
            Prepared {
                pair,
                triangle,
                straight: StraightPaths::new(start, end),
                enclosed: PairMotion::new(&a.1, &b.1, t0, t1),
                opaque: PairMotion::new(&a.2, &b.2, t0, t1),
                planted,
            }
        })
        .collect()
}

impl Prepared {
    /// The answer.
    pub(crate) fn ask(&self, method: Method, options: &ContactOptions) -> FirstContact {
        let p = &self.planted;
        let edge_b = [p.b[0], p.b[1]];
        match (method, p.kind) {
            (Method::Rigid, Kind::PointTriangle) => self.pair.point_placed(p.a[0], &self.triangle, options),
            (Method::Rigid, Kind::EdgeEdge) => self.pair.edge_edge(p.a, edge_b, options),
            (Method::RigidFromNumbers, kind) => {
                let pair = PairMotion::new(&p.motion_a, &p.motion_b, p.window.0, p.window.1);
                match kind {
                    Kind::PointTriangle => pair.point_triangle(p.a[0], &p.b, options),
                    Kind::EdgeEdge => pair.edge_edge(p.a, edge_b, options),
                }
            }
            (Method::Straight, Kind::PointTriangle) => self.straight.point_triangle(options),
            (Method::Straight, Kind::EdgeEdge) => self.straight.edge_edge(options),
            (Method::Enclosed | Method::Opaque, kind) => {
                let pair = if method == Method::Enclosed { &self.enclosed } else { &self.opaque };
                match kind {
                    Kind::PointTriangle => pair.point_triangle(p.a[0], &p.b, options),
                    Kind::EdgeEdge => pair.edge_edge(p.a, edge_b, options),
                }
            }
        }
    }

    /// What is wrong with an answer: a planted clean crossing must be found, and not after it.
    pub(crate) fn judge(&self, method: Method, answer: &FirstContact) -> Option<String> {
        let p = &self.planted;
        let slack = if method == Method::Straight { 1e-9 } else { 1e-13 };
        match answer {
            FirstContact::Clear if p.family == Family::Hit && method != Method::Straight => {
                Some(format!("a planted contact was missed: {p:?}"))
            }
            FirstContact::Contact(contact) if p.family == Family::Hit && contact.lo > p.time + slack => {
                Some(format!("late: {contact:?} {p:?}"))
            }
            FirstContact::Undecided { .. } => Some(format!("undecided: {p:?}")),
            _ => None,
        }
    }
}

/// Prints the table.
pub(crate) fn print(count: usize) {
    let options = ContactOptions::new();
    println!(
        "mean / p99 / max ns a query, {count} queries a family; setup excluded but for rigid pairs from numbers"
    );
    println!("{:<34} {:>22} {:>22} {:>22} {:>22}", "", "far", "near", "hit", "graze");
    for (name, kind, method) in [
        ("rigid vertex/face", Kind::PointTriangle, Method::Rigid),
        ("rigid edge/edge", Kind::EdgeEdge, Method::Rigid),
        ("rigid vertex/face from numbers", Kind::PointTriangle, Method::RigidFromNumbers),
        ("rigid edge/edge from numbers", Kind::EdgeEdge, Method::RigidFromNumbers),
        ("straight vertex/face", Kind::PointTriangle, Method::Straight),
        ("straight edge/edge", Kind::EdgeEdge, Method::Straight),
        ("own state vertex/face", Kind::PointTriangle, Method::Enclosed),
        ("own state edge/edge", Kind::EdgeEdge, Method::Enclosed),
        ("enclosed vertex/face", Kind::PointTriangle, Method::Opaque),
        ("enclosed edge/edge", Kind::EdgeEdge, Method::Opaque),
    ] {
        print!("{name:<34}");
        for (_, family) in COLUMNS {
            let queries = queries(kind, family, count, 7);
            for query in &queries {
                if let Some(wrong) = query.judge(method, &query.ask(method, &options)) {
                    println!();
                    panic!("{wrong}");
                }
            }
            let Nanoseconds { mean, p99, largest } = measure(&queries, method, &options);
            print!(" {:>22}", format!("{mean:.0} / {p99:.0} / {largest:.0}"));
        }
        println!();
    }
}

/// Times of queries.
struct Nanoseconds {
    mean: f64,
    p99: f64,
    largest: f64,
}

/// The best of seven times of each query, the clock's own time taken off: robust on a busy machine.
fn measure(queries: &[Prepared], method: Method, options: &ContactOptions) -> Nanoseconds {
    let best = |question: &dyn Fn()| {
        (0..7).fold(f64::INFINITY, |best, _| {
            let start = Instant::now();
            question();
            best.min(start.elapsed().as_secs_f64() * 1e9)
        })
    };
    let clock = (0..100).fold(f64::INFINITY, |least: f64, _| least.min(best(&|| ())));
    let mut singles: Vec<f64> = queries
        .iter()
        .map(|query| {
            best(&|| {
                let _ = black_box(query.ask(method, options));
            }) - clock
        })
        .collect();
    singles.sort_by(f64::total_cmp);
    let mean = singles.iter().sum::<f64>() / singles.len() as f64;
    Nanoseconds { mean, p99: singles[singles.len() * 99 / 100], largest: singles[singles.len() - 1] }
}
