//! Closest points of two triangles: an upper bound on their distance with the features that attain it.

use glam::DVec3;

/// Where on a triangle a closest point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// Corner, by number.
    Corner(usize),
    /// The edge from this corner to the next.
    Edge(usize),
    /// Inside the triangle.
    Face,
}

/// Two points, one on each triangle, as close as the features allow (up to rounding).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    pub(crate) square: f64,
    pub(crate) points: [DVec3; 2],
    pub(crate) places: [Place; 2],
    /// Along the shortest line from A to B, re-orthogonalised against the edges it ends on; not normalised.
    pub(crate) direction: DVec3,
}

/// Closest points of the two triangles' boundaries, and of corners against faces. For crossing triangles this is not
/// zero: a crossing has to be found by other means.
pub(crate) fn closest(a: &[DVec3; 3], b: &[DVec3; 3]) -> Closest {
    let mut best = Closest {
        square: f64::INFINITY,
        points: [a[0], b[0]],
        places: [Place::Corner(0), Place::Corner(0)],
        direction: b[0] - a[0],
    };
    for i in 0..3 {
        for j in 0..3 {
            edge_edge(&mut best, (a, i), (b, j));
        }
    }
    for i in 0..3 {
        corner_face(&mut best, (a, i), b, false);
        corner_face(&mut best, (b, i), a, true);
    }
    best
}

fn clamp_ratio(numerator: f64, denominator: f64) -> f64 {
    if denominator > 0.0 { (numerator / denominator).clamp(0.0, 1.0) } else { 0.0 }
}

fn edge_edge(best: &mut Closest, (a, i): (&[DVec3; 3], usize), (b, j): (&[DVec3; 3], usize)) {
    let (a0, a1, b0, b1) = (a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
    let (e, d, w) = (a1 - a0, b1 - b0, b0 - a0);
    let k = e.cross(d);
    let (ee, dd, kk) = (e.length_squared(), d.length_squared(), k.length_squared());
    // (w + t·d − s·e) ⟂ e, d gives s = (w × d)·k/|k|²: no cancellation for nearly parallel edges.
    let mut s = clamp_ratio(w.cross(d).dot(k), kk);
    let t = clamp_ratio((e * s - w).dot(d), dd);
    s = clamp_ratio((w + d * t).dot(e), ee);
    let t = clamp_ratio((e * s - w).dot(d), dd);
    let point = |p: DVec3, q: DVec3, v: DVec3, x: f64| {
        if x == 0.0 {
            p
        } else if x == 1.0 {
            q
        } else {
            p + v * x
        }
    };
    let (p, q) = (point(a0, a1, e, s), point(b0, b1, d, t));
    let line = q - p;
    let square = line.length_squared();
    if square >= best.square {
        return;
    }
    let place = |index: usize, x: f64| {
        if x == 0.0 {
            Place::Corner(index)
        } else if x == 1.0 {
            Place::Corner((index + 1) % 3)
        } else {
            Place::Edge(index)
        }
    };
    let places = [place(i, s), place(j, t)];
    let direction = match (places[0], places[1]) {
        (Place::Edge(_), Place::Edge(_)) if kk > 1e-24 * ee * dd => {
            if k.dot(line) < 0.0 {
                -k
            } else {
                k
            }
        }
        (Place::Edge(_), _) => line - e * (line.dot(e) / ee),
        (_, Place::Edge(_)) => line - d * (line.dot(d) / dd),
        _ => line,
    };
    *best = Closest { square, points: [p, q], places, direction };
}

fn corner_face(best: &mut Closest, (corners, i): (&[DVec3; 3], usize), face: &[DVec3; 3], flipped: bool) {
    let p = corners[i];
    let normal = (face[1] - face[0]).cross(face[2] - face[0]);
    let nn = normal.length_squared();
    let height = (p - face[0]).dot(normal);
    if nn.is_nan() || nn <= 0.0 || height * height >= best.square * nn {
        return;
    }
    for k in 0..3 {
        let edge = face[(k + 1) % 3] - face[k];
        if edge.cross(p - face[k]).dot(normal) < 0.0 {
            return;
        }
    }
    let foot = p - normal * (height / nn);
    let square = height * height / nn;
    // Towards the corner from the face.
    let out = if height < 0.0 { -normal } else { normal };
    *best = if flipped {
        Closest { square, points: [foot, p], places: [Place::Face, Place::Corner(i)], direction: out }
    } else {
        Closest { square, points: [p, foot], places: [Place::Corner(i), Place::Face], direction: -out }
    };
}
