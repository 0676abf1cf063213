//! First-order accuracy, shown: a curved motion cut into n pieces, its time of contact against a 30-digit solution.
//!
//! A spike with its tip at (0, 0, −1) turns about the x axis by θ(t) = 0.4 t + 0.9 t² while its origin falls by
//! h(t) = h₀ − 1.6 t + 0.25 t² onto a plate with its upper face at z = 0. The tip touches when h(t) = cos θ(t).
//! Motions that hold still between poses (zeroth order) err by the length of a piece; linear motions through both
//! poses (the paper's) by its square.
use d2m::bvh::{MeshTree, Moving, Posed, QueryOptions, Solid, TriMesh, Window, collide, time_of_contact};
use d2m::motion::{ConstantTwist, Pose};
use d2m_testing::Surface;
use dashu_float::DBig;
use glam::{DQuat, DVec3};
use std::str::FromStr;

type Error = Box<dyn std::error::Error>;

/// Digits carried; 30 are claimed.
const DIGITS: usize = 45;

fn number(text: &str) -> DBig {
    DBig::from_str(text).expect("a decimal number").with_precision(DIGITS).value()
}

/// cos x by its series, |x| < 2.
fn cosine(x: &DBig) -> DBig {
    let square = x * x;
    let (mut term, mut sum) = (number("1"), number("1"));
    for k in 1..30u32 {
        term = -term * &square / number(&(2 * k * (2 * k - 1)).to_string());
        sum += &term;
    }
    sum
}

/// The time at which h(t) = cos θ(t), to 30 digits, by bisection of [0, 0.8]: their difference falls throughout.
pub(super) fn exact_time(height: &str) -> DBig {
    let height = number(height);
    let excess = |t: &DBig| {
        let square = t * t;
        let h = &height - number("1.6") * t + number("0.25") * &square;
        h - cosine(&(number("0.4") * t + number("0.9") * &square))
    };
    let (mut lo, mut hi) = (number("0"), number("0.8"));
    for _ in 0..110 {
        let middle = (&lo + &hi) * number("0.5");
        if excess(&middle) > number("0") { lo = middle } else { hi = middle }
    }
    lo
}

/// Pose of the spike in f64.
fn pose(height: f64, t: f64) -> Pose {
    let angle = 0.4 * t + 0.9 * t * t;
    let fall = height - 1.6 * t + 0.25 * t * t;
    Pose { rotation: DQuat::from_rotation_x(angle), translation: DVec3::Z * fall, at: DVec3::ZERO }
}

struct Bodies {
    spike: MeshTree,
    plate: MeshTree,
}

impl Bodies {
    fn new() -> Result<Self, Error> {
        let points = [
            DVec3::NEG_Z,
            DVec3::new(0.2, 0.0, 0.3),
            DVec3::new(-0.1, 0.2, 0.3),
            DVec3::new(-0.1, -0.2, 0.3),
        ];
        let spike = Surface::tetrahedron(points).into_mesh(TriMesh::try_new);
        let plate = d2m::shapes::mesh("box?x=4&y=4&z=1")?;
        Ok(Self { spike: MeshTree::new(spike), plate: MeshTree::new(plate) })
    }

    /// Zeroth order: the last of the n + 1 poses before the bodies overlap.
    fn held(&self, height: f64, pieces: usize) -> Option<f64> {
        let plate = Pose { translation: DVec3::NEG_Z, ..Pose::IDENTITY };
        let free = |k: usize| {
            let spike = pose(height, k as f64 / pieces as f64);
            !collide(Posed::new(&self.spike, spike), Posed::new(&self.plate, plate), Solid::Filled)
                .unwrap_or(true)
        };
        (0..=pieces).find(|&k| !free(k)).map(|k| (k.max(1) - 1) as f64 / pieces as f64)
    }

    /// First order: constant twist from each pose to the next.
    fn linear(&self, height: f64, pieces: usize) -> Result<Option<f64>, Error> {
        let plate = ConstantTwist::REST.with_position(DVec3::NEG_Z);
        let options = QueryOptions::default().with_tolerance(1e-13);
        let length = 1.0 / pieces as f64;
        for k in 0..pieces {
            let (t0, t1) = (k as f64 * length, (k + 1) as f64 * length);
            let (first, last) = (pose(height, t0), pose(height, t1));
            let turn = (last.rotation * first.rotation.conjugate()).to_scaled_axis();
            let moved = last.translation - first.translation;
            let (x, q) = (first.translation, first.rotation);
            let motion =
                ConstantTwist::try_new(x, q, moved / length, turn / length)?.try_with_reference_time(t0)?;
            let (a, b) = (Moving::new(&self.spike, &motion), Moving::new(&self.plate, &plate));
            let answer = time_of_contact(a, b, Window::try_new(t0, t1)?, &options)?;
            if let Some(contact) = answer.contact() {
                return Ok(Some(contact.time_lo));
            }
        }
        Ok(None)
    }
}

/// Errors of the time of contact over 24 heights.
pub(super) struct Errors {
    pub(super) pieces: usize,
    /// Zeroth order.
    pub(super) held: Vec<f64>,
    /// First order.
    pub(super) linear: Vec<f64>,
}

/// For 2, 4, 8 … pieces.
pub(super) fn errors(most: usize) -> Result<Vec<Errors>, Error> {
    let bodies = Bodies::new()?;
    // Heights that no power of two divides, so that contacts fall anywhere in their piece.
    let heights: Vec<String> = (0..24).map(|k| format!("{:.4}", 1.4 + 0.0137 * f64::from(k))).collect();
    let exact: Vec<(f64, DBig)> =
        heights.iter().map(|h| Ok((h.parse()?, exact_time(h)))).collect::<Result<_, Error>>()?;
    let mut rows = Vec::new();
    let mut pieces = 2;
    while pieces <= most {
        let (mut held, mut linear) = (Vec::new(), Vec::new());
        for (height, time) in &exact {
            let error = |found: f64| (number(&format!("{found:.70}")) - time).to_f64().value().abs();
            held.extend(bodies.held(*height, pieces).map(error));
            linear.extend(bodies.linear(*height, pieces)?.map(error));
        }
        rows.push(Errors { pieces, held, linear });
        pieces *= 2;
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{Summary, exponent};

    #[test]
    fn cosine_to_thirty_digits() {
        // cos 1, OEIS A049470.
        let known = number("0.540302305868139717400936607442976603732310420617922227670097");
        let error = (cosine(&number("1")) - known).to_f64().value().abs();
        assert!(error < 1e-30, "{error:e}");
    }

    #[test]
    fn poses_held_are_of_first_order_and_linear_pieces_of_second() {
        let rows = errors(256).unwrap();
        let slope = |pick: fn(&Errors) -> &Vec<f64>| {
            let median = |row| Summary::of(pick(row).iter().copied()).unwrap().median;
            exponent(&rows.iter().map(|row| (row.pieces as f64, median(row))).collect::<Vec<_>>()).unwrap()
        };
        let (held, linear) = (slope(|row| &row.held), slope(|row| &row.linear));
        assert!((held + 1.0).abs() < 0.15, "{held}");
        assert!((linear + 2.0).abs() < 0.15, "{linear}");
    }
}
