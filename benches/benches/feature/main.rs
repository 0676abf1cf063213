//! First contact of single feature pairs: the table of times by family, then criterion's statistics of the same.
//!
//! `cargo bench -p d2m-benches --bench feature` prints the table first; every answer is judged before it is timed.
mod table;

use criterion::Criterion;
use d2m_feature::ContactOptions;
use d2m_testing::planted::families::Kind;
use std::hint::black_box;
use table::{COLUMNS, Method};

fn main() {
    table::print(2000);
    let mut criterion = Criterion::default().configure_from_args();
    let options = ContactOptions::new();
    for (name, kind, method) in [
        ("rigid vertex/face", Kind::PointTriangle, Method::Rigid),
        ("rigid edge/edge", Kind::EdgeEdge, Method::Rigid),
        ("rigid vertex/face from numbers", Kind::PointTriangle, Method::RigidFromNumbers),
        ("rigid edge/edge from numbers", Kind::EdgeEdge, Method::RigidFromNumbers),
        ("straight vertex/face", Kind::PointTriangle, Method::Straight),
        ("straight edge/edge", Kind::EdgeEdge, Method::Straight),
    ] {
        let mut group = criterion.benchmark_group(name);
        for (column, family) in COLUMNS {
            let queries = table::queries(kind, family, 1024, 7);
            let mut next = 0;
            group.bench_function(column, |bencher| {
                bencher.iter(|| {
                    next = (next + 1) % queries.len();
                    black_box(queries[next].ask(method, &options))
                });
            });
        }
        group.finish();
    }
    criterion.final_summary();
}
