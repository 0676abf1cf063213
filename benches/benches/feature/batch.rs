//! Four at once: ns a feature of the shared-frame rejections, every rejection judged by the single test first.
use crate::families::Random;
use d2m_feature::{ContactOptions, EdgeQuad, FirstContact, PairMotion, PointQuad, TriangleQuad};
use d2m_motion::ConstantTwist;
use glam::DVec3;
use std::hint::black_box;
use std::time::Instant;

struct Quads {
    points: PointQuad,
    triangles: TriangleQuad,
    a: EdgeQuad,
    b: EdgeQuad,
}

/// Prints the rows of the rejections: unit features spread over six units, a window of a tenth.
pub(crate) fn print() {
    let mut random = Random::new(11);
    let mut motion = |v: f64| {
        ConstantTwist::try_new(random.ball(), random.turn(), random.ball() * v, random.ball() * 3.0)
            .expect("finite")
    };
    let pair = PairMotion::new(&motion(4.0), &motion(1.0), 0.0, 0.1);
    let options = ContactOptions::new();
    let (mut rejected, mut count) = ([0, 0], 0);
    let quads: Vec<Quads> = (0..256)
        .map(|_| {
            let place = |random: &mut Random| random.ball() * 3.0;
            let mut triple = |_| {
                let at = place(&mut random);
                [at + random.ball(), at + random.ball(), at + random.ball()]
            };
            let (mine, theirs) = ([0, 1, 2, 3].map(&mut triple), [0, 1, 2, 3].map(&mut triple));
            let edges = |triples: &[[DVec3; 3]; 4]| triples.map(|t| [t[0], t[1]]);
            let quad = Quads {
                points: pair.place_points(&mine.map(|t| t[0])),
                triangles: pair.place_triangles(&theirs),
                a: pair.place_edges_a(&edges(&mine)),
                b: pair.place_edges_b(&edges(&theirs)),
            };
            let (p, e) = (
                pair.reject_points(&quad.points, &quad.triangles, 0.0),
                pair.reject_edges(&quad.a, &quad.b, 0.0),
            );
            for i in 0..4 {
                let (mine, theirs) = (mine[i], theirs[i]);
                assert!(!p[i] || pair.point_triangle(mine[0], &theirs, &options) == FirstContact::Clear);
                let (a, b) = ([mine[0], mine[1]], [theirs[0], theirs[1]]);
                assert!(!e[i] || pair.edge_edge(a, b, &options) == FirstContact::Clear);
                rejected[0] += usize::from(p[i]);
                rejected[1] += usize::from(e[i]);
                count += 1;
            }
            quad
        })
        .collect();
    let row = |name: &str, share: usize, ask: &dyn Fn(&Quads) -> [bool; 4]| {
        let best = (0..50).fold(f64::INFINITY, |best, _| {
            let start = Instant::now();
            for _ in 0..20 {
                for quad in &quads {
                    black_box(ask(black_box(quad)));
                }
            }
            best.min(start.elapsed().as_secs_f64() * 1e9 / (20.0 * count as f64))
        });
        println!(
            "{name:<32} {best:>6.1} ns a feature, {:.0} % rejected",
            100.0 * share as f64 / count as f64
        );
    };
    row("batch vertex/face", rejected[0], &|q| pair.reject_points(&q.points, &q.triangles, 0.0));
    row("batch vertex/face, portable", rejected[0], &|q| {
        pair.reject_points_portable(&q.points, &q.triangles)
    });
    row("batch edge/edge", rejected[1], &|q| pair.reject_edges(&q.a, &q.b, 0.0));
    row("batch edge/edge, portable", rejected[1], &|q| pair.reject_edges_portable(&q.a, &q.b));
}
