//! What impulses a block of rows may have, and how they depend on its rates.

/// The law of a block: impulses λ in a closed convex set K, which the rates u above their targets b answer by
///
/// ```text
/// λ = P(λ − (u − b + s e)/d)     for any d > 0, with the projection P on K
/// ```
///
/// A contact has Coulomb's cone for K and, in de Saxcé's form, the shift s = μ |u_t| of its normal rate; the others have none.
///
/// ```
/// use d2m_contact::Law;
/// // A motor that pushes with no more than 3 either way.
/// let motor = Law::Range { lo: -3.0, hi: 3.0, softness: 0.0 };
/// assert_eq!(motor.project([5.0, 0.0, 0.0]), [3.0, 0.0, 0.0]);
/// // A contact that slides: its impulse is on the cone.
/// let [along, across, _] = Law::Cone { friction: 0.5 }.project([1.0, 2.0, 0.0]);
/// assert!((across - 0.5 * along).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Along a normal and two tangents: |λ_t| ≤ μ λ_n.
    Cone {
        /// Coulomb's coefficient μ, not negative.
        friction: f64,
    },
    /// One row: lo ≤ λ ≤ hi, and the rate yields by `softness` λ.
    Range {
        /// The least impulse, which may be −∞.
        lo: f64,
        /// The greatest one, which may be ∞.
        hi: f64,
        /// The rate by which it yields to an impulse of one: zero if it is hard.
        softness: f64,
    },
}

/// The derivative of a projection: symmetric, in the order nn, nt, nu, tt, tu, uu.
pub(super) type Slope = [f64; 6];

/// A projection and its derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Projected {
    pub(super) impulse: [f64; 3],
    /// None: it is zero.
    pub(super) slope: Option<Slope>,
}

impl Law {
    /// A contact that only pushes.
    pub(super) const PUSH: Self = Self::Range { lo: 0.0, hi: f64::INFINITY, softness: 0.0 };

    /// How many of the rows count.
    pub(super) fn rows(self) -> usize {
        match self {
            Self::Cone { .. } => 3,
            Self::Range { .. } => 1,
        }
    }

    pub(super) fn friction(self) -> f64 {
        match self {
            Self::Cone { friction } => friction,
            Self::Range { .. } => 0.0,
        }
    }

    pub(super) fn softness(self) -> f64 {
        match self {
            Self::Cone { .. } => 0.0,
            Self::Range { softness, .. } => softness,
        }
    }

    /// The nearest impulses that the law allows, P(y).
    #[inline]
    #[must_use]
    pub fn project(self, y: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Range { lo, hi, .. } => [y[0].max(lo).min(hi), 0.0, 0.0],
            Self::Cone { friction } => {
                let length = (y[1] * y[1] + y[2] * y[2]).sqrt();
                if length <= friction * y[0] {
                    y
                } else if friction * length <= -y[0] {
                    [0.0; 3]
                } else {
                    let along = (y[0] + friction * length) / (1.0 + friction * friction);
                    let across = friction * along / length;
                    [along, y[1] * across, y[2] * across]
                }
            }
        }
    }

    /// As [`Self::project`], with the derivative: of a cone, with the unit vector e of the tangential part and q = (1, μ e)/√(1 + μ²),
    /// where it slides q qᵀ + (μ λ_n/|y_t|)(1 − e eᵀ).
    pub(super) fn project_with_slope(self, y: [f64; 3]) -> Projected {
        let impulse = self.project(y);
        let slope = match self {
            Self::Range { lo, hi, .. } => {
                (lo <= y[0] && y[0] <= hi).then_some([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
            }
            Self::Cone { friction } => {
                let length = (y[1] * y[1] + y[2] * y[2]).sqrt();
                if length <= friction * y[0] {
                    Some([1.0, 0.0, 0.0, 1.0, 0.0, 1.0])
                } else if friction * length <= -y[0] {
                    None
                } else {
                    let (e, f) = (y[1] / length, y[2] / length);
                    let part = 1.0 / (1.0 + friction * friction);
                    let (mixed, both) = (friction * part, friction * friction * part);
                    let turn = friction * impulse[0] / length;
                    Some([
                        part,
                        mixed * e,
                        mixed * f,
                        both * e * e + turn * f * f,
                        (both - turn) * e * f,
                        both * f * f + turn * e * e,
                    ])
                }
            }
        };
        Projected { impulse, slope }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_testing::{Draw, KnuthRandom};

    /// What is left over lies in the polar cone and is orthogonal to the projection: Moreau's theorem, which says that it is the nearest.
    #[test]
    fn projections_are_the_nearest_impulses() {
        let state = &mut KnuthRandom(3);
        let mut seen = [0; 3];
        for _ in 0..2000 {
            let friction = 2.0 * state.signed().abs();
            let y = [2.0 * state.signed(), state.signed(), state.signed()];
            let p = Law::Cone { friction }.project(y);
            let left = [0, 1, 2].map(|i| y[i] - p[i]);
            let length = |x: [f64; 3]| x[1].hypot(x[2]);
            assert!(length(p) <= friction * p[0] + 1e-12);
            // The polar cone: n ≤ −μ |t|.
            assert!(left[0] + friction * length(left) <= 1e-12);
            assert!((0..3).map(|i| p[i] * left[i]).sum::<f64>().abs() < 1e-12);
            seen[if p == y { 0 } else { 1 + usize::from(p == [0.0; 3]) }] += 1;
        }
        assert!(seen.iter().all(|&count| count > 100), "{seen:?}");
    }

    /// The derivative is that of differences.
    #[test]
    fn slopes_are_derivatives() {
        let state = &mut KnuthRandom(5);
        for _ in 0..500 {
            let law = Law::Cone { friction: 0.1 + state.signed().abs() };
            let y = [state.signed(), state.signed(), state.signed()];
            let [nn, nt, nu, tt, tu, uu] = law.project_with_slope(y).slope.unwrap_or_default();
            let slope = [[nn, nt, nu], [nt, tt, tu], [nu, tu, uu]];
            for (column, expected) in slope.iter().enumerate() {
                let moved = |by: f64| {
                    let mut y = y;
                    y[column] += by;
                    law.project(y)
                };
                let (more, less) = (moved(1e-6), moved(-1e-6));
                for row in 0..3 {
                    let found = (more[row] - less[row]) / 2e-6;
                    // At a corner of the projection there are two.
                    let corner = law.project_with_slope(moved_by(y, column, 1e-6)).slope.is_some()
                        != law.project_with_slope(moved_by(y, column, -1e-6)).slope.is_some();
                    assert!((found - expected[row]).abs() < 1e-3 || corner, "{found} {expected:?}");
                }
            }
        }
    }

    fn moved_by(mut y: [f64; 3], column: usize, by: f64) -> [f64; 3] {
        y[column] += by;
        y
    }
}
