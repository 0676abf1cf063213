//! Boxes that pass each other: apart for the rest of the time that matters, although along no one direction.
//!
//! While two bodies pass, their boxes are apart along a line across their way, and soon after that along the way itself, along which they still overlap now. Until the first of these ends pairs would wait in the queue, whole trees of them, only to be
//! found far apart then. So the time that boxes are apart along one direction is followed by spheres: let it end at s₁, and let no time after S
//! matter. A point of the single box, seen from one of a lane's box, is at
//!
//! q(s) = c + v s + (p + s·ω × p) − (p′ + s·ω′ × p′) + d,  |d| ≤ M s²/2,
//!
//! with c and v the place and velocity of the centers, p and p′ the points as seen from them. |p + s·ω × p| ≤ |p|(1 + |ω|²s²/2), so with the radii r
//! and r′ of the boxes, R = (r + r′)(1 + θ²/2), θ the larger angle that a body turns by until S, and any unit vector n
//!
//! |q(s)| ≥ n·c + n·v s − R − M s²/2.
//!
//! That is concave in s, so boxes for which it exceeds the level at s₁ and at S are apart all the time between. n is the direction of c + v s₁.
//!
//! Places err by 3u(|t|₁ + ext) and speeds by 8u(|V|₁ + |ω| ext) here, of 48u each that the margins hold; the roundings of c + v s₁ and of its length
//! take 6u of both, those of n·v (S − s₁) and of the last sum 12u of the speeds'. What is added to the radii has eight roundings, and 1 + 32u
//! covers them and those of a length of its own size. No square is lost to underflow: what is compared is above the floor of margins, 2⁻⁴⁵ of a body.
//! Where c + v s₁ is longer than 2⁶⁴ its square is infinite and its length is not a number; where it is not, no product with a speed
//! overflows, for speeds of more than 2⁶² have an infinite margin. What is not a number is apart for no longer.

use super::node_scale::NodeScale;
use super::node_test::Placed;
use d2m_lanes::Lanes;
use d2m_lanes::three::dot;
use d2m_mesh::margin::UNIT_F32;
use d2m_mesh::node::WideNode;

/// What covers the roundings of what the distance of two centers is compared with.
const ROUNDED_UP: f32 = 1.0 + 32.0 * UNIT_F32 as f32;

/// The eight boxes of a node against a single one.
pub(super) struct PassingBoxes<'p, L> {
    pub(super) wide: &'p WideNode,
    pub(super) placed: &'p Placed,
    /// From the lanes' centers to the single one's, and its rate.
    pub(super) line: [L; 3],
    pub(super) velocity: [L; 3],
    /// No later time matters, counted from the frame.
    pub(super) left: f32,
}

impl<L: Lanes> PassingBoxes<'_, L> {
    /// The times until which boxes are apart; infinite where they are so for all that matters. `until`: times until which they are known to
    /// be apart, not positive or not a number where nothing is known.
    #[inline(always)]
    pub(super) fn apart_until(&self, until: L, scale: &NodeScale) -> L {
        let Self { placed, left, line, velocity, .. } = *self;
        let zero = L::splat(0.0);
        // Of two the greater is the second one where either is not a number.
        let from = until.max(zero).min(L::splat(left));
        let at = [line[0] + velocity[0] * from, line[1] + velocity[1] * from, line[2] + velocity[2] * from];
        let square = dot(&at, &at);
        let distance = square * (L::splat(1.0) / square.sqrt());
        let angle = scale.spin[0].max(scale.spin[1]) * left;
        let radii =
            (L::load(&self.wide.radius) + L::splat(placed.radius)) * L::splat(1.0 + 0.5 * angle * angle);
        let need =
            (radii + L::splat(placed.boxed.margin + placed.speed_margin * left)) * L::splat(ROUNDED_UP);
        let bend = 0.5 * scale.acceleration * ROUNDED_UP;
        let now = distance - (need + L::splat(bend) * (from * from));
        // Times the distance.
        let parting = dot(&at, &velocity) * (L::splat(left) - from);
        let later = distance * (distance - (need + L::splat(bend * (left * left)))) + parting;
        let all_the_time = L::splat(f32::INFINITY);
        L::if_greater(now, zero, L::if_greater(later, zero, all_the_time, until), until)
    }
}
