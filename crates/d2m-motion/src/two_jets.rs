//! Jets of two vectors about the same time, side by side.
use crate::path_jet::{position, velocity};
use crate::two::TwoVec3;
use crate::{PathJet, Remainder};
use glam::DVec3;

/// Two [`PathJet`]s about the same time.
#[derive(Clone, Copy)]
pub struct TwoJets {
    /// Positions at the center.
    pub p: TwoVec3,
    /// Velocities.
    pub v: TwoVec3,
    /// Accelerations.
    pub a: TwoVec3,
    /// Third derivatives.
    pub j: TwoVec3,
    /// What these leave out.
    pub remainders: [Remainder; 2],
}

/// The jets of two edges, one of A and one of B, in axes that turn with B.
#[derive(Clone, Copy)]
pub struct EdgeJets {
    /// Of the difference of the midpoints, and of A's half edge.
    pub jets: TwoJets,
    /// B's half edge, which is at rest in these axes.
    pub half_b: DVec3,
}

impl TwoJets {
    /// Side by side.
    #[inline(always)]
    pub fn new(first: &PathJet, second: &PathJet) -> Self {
        Self {
            p: TwoVec3::new(first.p, second.p),
            v: TwoVec3::new(first.v, second.v),
            a: TwoVec3::new(first.a, second.a),
            j: TwoVec3::new(first.j, second.j),
            remainders: [first.remainder, second.remainder],
        }
    }

    /// One after the other.
    #[inline(always)]
    pub fn split(&self) -> [PathJet; 2] {
        let Self { p, v, a, j, remainders: [first, second] } = *self;
        [
            PathJet { p: p.first(), v: v.first(), a: a.first(), j: j.first(), remainder: first },
            PathJet { p: p.second(), v: v.second(), a: a.second(), j: j.second(), remainder: second },
        ]
    }

    /// [`PathJet::at`].
    #[inline(always)]
    pub fn at(&self, s: f64) -> TwoVec3 {
        position([self.p, self.v, self.a, self.j], s)
    }

    /// [`PathJet::moved`].
    #[inline(always)]
    pub fn moved(&self, m: f64) -> Self {
        Self {
            p: self.at(m),
            v: velocity([self.v, self.a, self.j], m),
            a: self.a + self.j * m,
            j: TwoVec3::splat(glam::DVec3::ZERO),
            remainders: self.remainders,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn side_by_side_gives_the_same_bits() {
        let jet = |x: f64| PathJet {
            p: DVec3::new(x, 1.0 / x, -x),
            v: DVec3::new(x.sqrt(), x, 0.3),
            a: DVec3::new(-0.7, x * x, x),
            j: DVec3::new(0.1 * x, -x, 1.1),
            remainder: Remainder { e0: x, ..Remainder::default() },
        };
        let (first, second) = (jet(0.37), jet(2.9));
        let both = TwoJets::new(&first, &second);
        assert_eq!(both.split(), [first, second]);
        for s in [0.0, 0.21, -1.7] {
            assert_eq!([both.at(s).first(), both.at(s).second()], [first.at(s), second.at(s)]);
            assert_eq!(both.moved(s).split(), [first.moved(s), second.moved(s)]);
        }
    }
}
