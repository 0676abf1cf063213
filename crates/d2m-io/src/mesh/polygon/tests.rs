use super::*;
use proptest::prelude::*;

fn area(flat: &[DVec2]) -> f64 {
    let next = flat.iter().cycle().skip(1);
    0.5 * flat.iter().zip(next).map(|(p, q)| p.perp_dot(*q)).sum::<f64>()
}

fn triangulate(vertices: &[DVec3]) -> Triangulation {
    let polygon: Vec<u32> = (0..vertices.len() as u32).collect();
    let mut triangulation = Triangulation::default();
    triangulation.add(&polygon, vertices);
    assert_eq!(triangulation.triangles.len(), vertices.len() - 2);
    triangulation
}

/// The sum of the triangles' absolute areas, which exceeds the polygon's if triangles overlap or lie outside; and the
/// counts.
fn covered(flat: &[DVec2]) -> (f64, PolygonCounts) {
    let vertices: Vec<DVec3> = flat.iter().map(|p| DVec3::new(p.x, 2.0 - p.x, p.y)).collect();
    let Triangulation { triangles, counts, .. } = triangulate(&vertices);
    (triangles.iter().map(|t| area(&t.map(|index| flat[index as usize])).abs()).sum(), counts)
}

/// Tests of corners per corner of an outline whose rays or teeth are thin and long.
fn work(flat: &[DVec2]) -> f64 {
    let vertices: Vec<DVec3> = flat.iter().map(|p| p.extend(0.0)).collect();
    triangulate(&vertices).tests as f64 / flat.len() as f64
}

fn assert_covered_once(flat: &[DVec2]) {
    let (area, (covered, counts)) = (area(flat).abs(), covered(flat));
    assert!((covered - area).abs() < 1e-9 * area, "{covered} of {area}: {:?}", &flat[..flat.len().min(50)]);
    assert_eq!(counts, PolygonCounts { cut: 1, ..Default::default() }, "{:?}", &flat[..flat.len().min(50)]);
}

/// Teeth of width and gap 1 and height 2 on a back of height 1.
fn comb(teeth: u32) -> Vec<DVec2> {
    let mut flat = vec![DVec2::ZERO, DVec2::new(f64::from(2 * teeth - 1), 0.0)];
    for tooth in (0..teeth).rev() {
        let x = f64::from(2 * tooth);
        flat.extend([(x + 1.0, 3.0), (x, 3.0), (x, 1.0), (x - 1.0, 1.0)].map(DVec2::from));
    }
    flat.truncate(flat.len() - 2);
    flat
}

#[test]
fn concave_polygons_are_covered_once() {
    let arrow = [(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (0.5, 1.0)];
    let letter = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)];
    // A square with a square hole, joined by a bridge that is run through in both directions.
    let hole = [
        (0.0, 0.0),
        (3.0, 0.0),
        (3.0, 3.0),
        (0.0, 3.0),
        (0.0, 0.0),
        (1.0, 1.0),
        (1.0, 2.0),
        (2.0, 2.0),
        (2.0, 1.0),
        (1.0, 1.0),
    ];
    let comb: Vec<(f64, f64)> = comb(3).into_iter().map(Into::into).collect();
    for polygon in [&arrow[..], &letter, &hole, &comb] {
        for first in 0..polygon.len() {
            let mut flat: Vec<DVec2> = polygon.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
            flat.rotate_left(first);
            assert_covered_once(&flat);
            flat.reverse();
            assert_covered_once(&flat);
        }
    }
}

/// Neither the number of corners nor the scale matters.
#[test]
fn large_and_tiny_outlines_are_covered_once() {
    let star = |count: u32| {
        let step = std::f64::consts::TAU / f64::from(count);
        let radius = |k: u32| if k.is_multiple_of(2) { 1.0 } else { 0.5 + 0.4 * (f64::from(k) * 0.37).sin() };
        (0..count).map(|k| DVec2::from_angle(step * f64::from(k)) * radius(k)).collect::<Vec<_>>()
    };
    assert_covered_once(&star(1002));
    let turned: Vec<DVec2> = comb(5_000).into_iter().map(|p| DVec2::new(-p.y, p.x)).collect();
    for outline in [star(20_000), comb(5_000), turned] {
        assert_covered_once(&outline);
        // A test of all corners for each would make 10 000.
        assert!(work(&outline) < 1000.0, "{}", work(&outline));
    }
    for scale in [1e-200, 1e55] {
        let arrow =
            [(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (0.5, 1.0)].map(|(x, y)| DVec3::new(x, 0.3, y) * scale);
        for first in 0..4 {
            let mut arrow = arrow;
            arrow.rotate_left(first);
            let dent = arrow.iter().position(|p| p.x == 0.5 * scale).unwrap() as u32;
            let Triangulation { triangles, counts, .. } = triangulate(&arrow);
            assert!(triangles.iter().all(|triangle| triangle.contains(&dent)), "{triangles:?}");
            assert_eq!(counts.crossing, 0);
        }
    }
}

#[test]
fn outlines_that_cross_or_bend_are_counted() {
    let flat = |points: &[(f64, f64)]| points.iter().map(|&(x, y)| DVec2::new(x, y)).collect::<Vec<_>>();
    let tie = flat(&[(0.0, 0.0), (2.0, 1.0), (2.0, 0.0), (0.0, 2.0)]);
    assert_eq!(covered(&tie).1, PolygonCounts { cut: 1, crossing: 1, ..Default::default() });
    let pentagram: Vec<DVec2> =
        (0..5).map(|k| DVec2::from_angle(f64::from(k) * 0.8 * std::f64::consts::PI)).collect();
    assert_eq!(covered(&pentagram).1.crossing, 1);
    // All corners on a line: flat triangles only.
    assert_eq!(covered(&flat(&[(0.0, 0.0), (1.0, 0.0), (3.0, 0.0), (2.0, 0.0)])).1.crossing, 0);
    let quad = |height: f64| [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, height), DVec3::Y];
    assert_eq!(triangulate(&quad(1e-7)).counts, PolygonCounts { cut: 1, ..Default::default() });
    assert_eq!(triangulate(&quad(0.1)).counts, PolygonCounts { cut: 1, bent: 1, ..Default::default() });
    let mut pair = Triangulation::default();
    pair.add(&[0, 1], &quad(0.0));
    assert_eq!((pair.triangles.len(), pair.counts.without_area), (0, 1));
}

/// A spiral of long thin arms that winds around a thousand times.
#[test]
fn endless_outlines_end() {
    let arms = 3000;
    let arm = |k: u32, inner: bool| {
        let radius = 1.0 + f64::from(k) - if inner { 0.5 } else { 0.0 };
        DVec2::from_angle(f64::from(k) * 2.4) * radius
    };
    let spiral: Vec<DVec2> =
        (0..arms).map(|k| arm(k, false)).chain((0..arms).rev().map(|k| arm(k, true))).collect();
    assert!(work(&spiral) < 1e5, "{}", work(&spiral));
}

proptest! {
    /// Star-shaped outlines with random radii.
    #[test]
    fn stars_are_covered_once(radii in prop::collection::vec(0.1..1.0_f64, 4..40)) {
        let step = std::f64::consts::TAU / radii.len() as f64;
        let flat: Vec<DVec2> =
            radii.iter().enumerate().map(|(k, &r)| DVec2::from_angle(step * k as f64) * r).collect();
        assert_covered_once(&flat);
    }

    /// Anything at all gives n − 2 triangles that keep the sides.
    #[test]
    fn tangles_keep_their_sides(corners in prop::collection::vec((-2..3, -2..3, -2..3), 4..12)) {
        let vertices: Vec<DVec3> =
            corners.iter().map(|p: &(i32, i32, i32)| DVec3::new(p.0.into(), p.1.into(), p.2.into())).collect();
        let count = vertices.len() as u32;
        let mut balance = std::collections::HashMap::new();
        for [a, b, c] in triangulate(&vertices).triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *balance.entry((from, to)).or_insert(0) += 1;
                *balance.entry((to, from)).or_insert(0) -= 1;
            }
        }
        for k in 0..count {
            prop_assert_eq!(balance.remove(&(k, (k + 1) % count)), Some(1));
        }
        prop_assert_eq!(balance.values().filter(|&&count| count > 0).count(), 0);
    }
}
