//! Closed-form bounds of the relative motion and of the rounding of its frames.
use super::RelativeMotion;
use super::frame::cross_columns;
use crate::Remainder;
use crate::rotation::Spin;
use crate::rounding::{UNIT, UP};
use d2m_lanes::{power_of_two, power_of_two_below};
use glam::{DMat3, DVec3};

/// Rounding of a frame and of all dot products made with it, in units of 2⁻⁵³·S0 (docs/theory/features.md).
const ROUNDING: f64 = 128.0;
/// The same per radian of rotation: the angle ωτ is rounded.
const ROUNDING_PER_RADIAN: f64 = 6.0;

/// Rounding of the third derivative and of what is computed with it along a direction, in units of the rounding of positions
/// times (a + b)³S0 + 3b²U (docs/theory/features.md, "Single jets").
const ROUNDING_OF_THIRD: f64 = 3.0;

/// Rounding of the orientations at the epoch, in units of 2⁻⁵³ per radian from the reference time to the epoch: the
/// rotation is made in double-double, whose product |ω|(t − t_ref) and reduction by π/2 err by less than 2⁻⁹⁸ of the
/// angle, 2⁻⁴⁵ units.
const EPOCH_ROUNDING_PER_RADIAN: f64 = power_of_two(-45);
/// Radians from the reference time to the epoch from which on nothing is known of the orientation: 2⁵³ quarter turns can
/// no longer be counted in a double; 2⁵² radians are fewer.
const LARGEST_EPOCH_ANGLE: f64 = power_of_two(52);
/// Rounding of a component `ω_i v_j − ω_j v_i` in units of 2⁻⁵³·(|ω_i|·m_j + |ω_j|·m_i), with v made of terms that add up
/// to m in size: each product errs by 1, their difference by 2 at most, v by 4. Nothing is lost where ω is along v.
const PRODUCT_ROUNDING: f64 = 16.0 * UNIT;

/// Upper bound of |ω × v| for the true v, of which `v` differs by at most 4·2⁻⁵³ of `terms`, component by component.
fn bound_product(omega: DVec3, v: DVec3, terms: DVec3) -> f64 {
    let size = omega.abs();
    let sums = DVec3::new(
        size.y * terms.z + size.z * terms.y,
        size.z * terms.x + size.x * terms.z,
        size.x * terms.y + size.y * terms.x,
    );
    (length(omega.cross(v)) + PRODUCT_ROUNDING * length(sums)) * UP
}

/// Upper bound of a length, for vectors of any finite magnitude: scaled by a power of two so that no square under- or
/// overflows.
pub(super) fn length(v: DVec3) -> f64 {
    let largest = v.abs().max_element();
    // The squares of numbers in this range are normal, and so is their sum.
    if (SMALL_SQUARE_ROOT..LARGE_SQUARE_ROOT).contains(&largest) || largest == 0.0 {
        return v.length() * UP;
    }
    if !largest.is_finite() {
        return f64::INFINITY;
    }
    let factor = if largest < 1.0 { LARGE_SQUARE_ROOT } else { SMALL_SQUARE_ROOT };
    // Twice, so that also the smallest subnormal number is brought into the range.
    (v * factor * factor).length() / factor / factor * UP
}

/// 2⁻⁴⁸⁰ and 2⁴⁸⁰: the squares of what lies between lose no bit that matters to a relative error of 2⁻⁵⁰, even with
/// components 2⁻³⁰ of the largest.
const SMALL_SQUARE_ROOT: f64 = power_of_two(-480);
const LARGE_SQUARE_ROOT: f64 = power_of_two(480);

/// Scalars that every bound is made of; each is an upper bound.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    /// U = |u|.
    pub(super) speed: f64,
    /// Y = max |g + uτ| over the window (convex: at one of the ends).
    pub(super) reach: f64,
    /// a = |ω_A|.
    pub(super) a: f64,
    /// b = |ω_B|.
    pub(super) b: f64,
    /// w = |ω_A − ω_B|.
    pub(super) w: f64,
    /// bY⊥ = max |ω_B × (g + uτ)| over the window (convex: at one of the ends), Y⊥ the distance of A's reference point
    /// from the axis of B: of the distance, only what is across B's axis turns.
    pub(super) swept: f64,
    /// |ω_B × u|: of the velocity, only what is across B's axis turns.
    pub(super) across: f64,
    /// Kₖ = ‖Tₖ‖: see [`direction_bounds`].
    pub(super) k3: f64,
    pub(super) k4: f64,
    /// k = 2⁻⁵³·(128 + 6(a + b)T).
    pub(super) rounding: f64,
}

impl Bounds {
    pub(super) fn new(
        offset: DVec3,
        velocity: DVec3,
        spin_a: &Spin,
        spin_b: &Spin,
        difference: DVec3,
        duration: f64,
        epoch_angle: f64,
    ) -> Self {
        let speed = length(velocity);
        let end = offset + velocity * duration;
        let magnitude = length(offset) + speed * duration;
        let reach = length(offset).max(length(end)) * UP + 8.0 * UNIT * magnitude;
        let (a, b) = (spin_a.speed * UP, spin_b.speed * UP);
        let w = length(difference);
        let terms = offset.abs() + velocity.abs() * duration;
        let at_start = bound_product(spin_b.omega, offset, terms);
        let swept = at_start.max(bound_product(spin_b.omega, end, terms)).min(b * reach * UP);
        let across = bound_product(spin_b.omega, velocity, velocity.abs()).min(b * speed * UP);
        let [k3, k4] = direction_bounds(spin_a.omega, spin_b.omega, difference, a + b);
        let turn = (a + b) * duration;
        let rounding = if turn <= crate::sin_cos::LARGEST_ANGLE && epoch_angle <= LARGEST_EPOCH_ANGLE {
            UNIT * (ROUNDING + ROUNDING_PER_RADIAN * turn + EPOCH_ROUNDING_PER_RADIAN * epoch_angle) * UP
        } else {
            f64::INFINITY
        };
        Self { speed, reach, a, b, w, swept, across, k3, k4, rounding }
    }

    /// bY⊥ while the reference points are within `reach` of each other.
    fn swept_within(&self, reach: f64) -> f64 {
        (self.b * reach * UP).min(self.swept)
    }
}

/// Bounds of the third and fourth derivative of a direction of A of length 1 in the axes of B: the norms of the
/// constant matrices `T₁ = [ω_A − ω_B]`, `Tₖ₊₁ = Tₖ[ω_A] − [ω_B]Tₖ`, as `z⁽ᵏ⁾ = R_Bᵀ Tₖ R_A d`.
///
/// Rates are divided by `sum` ≥ |ω_A| + |ω_B| first: then ‖Tₖ₊₁‖ ≤ ‖Tₖ‖ ≤ 1, and rounding adds at most 64·2⁻⁵³
/// of ‖T₁‖ (docs/theory/features.md). Exchanging A and B gives the same norms.
fn direction_bounds(spin_a: DVec3, spin_b: DVec3, difference: DVec3, sum: f64) -> [f64; 2] {
    if sum == 0.0 || difference == DVec3::ZERO {
        // Bodies that turn alike: nothing of A turns in the axes of B.
        return [0.0; 2];
    }
    if sum < SLOWEST {
        // ‖Tₖ‖ ≤ sumᵏ ≤ sum² < 2⁻¹⁸⁰⁰, far below the smallest number.
        return [f64::MIN_POSITIVE; 2];
    }
    let scale = 1.0 / sum;
    let (a, b) = (spin_a * scale, spin_b * scale);
    // T[ω] is the transpose of −[ω]Tᵀ.
    let derivative = |turn: DMat3| -cross_columns(a, &turn.transpose()).transpose() - cross_columns(b, &turn);
    let second = derivative(cross_columns(difference * scale, &DMat3::IDENTITY));
    let third = derivative(second);
    let rounding = TURN_ROUNDING * length(difference * scale) + f64::MIN_POSITIVE;
    let cube = sum * sum * sum;
    [(third, cube), (derivative(third), cube * sum)]
        .map(|(turn, power)| (norm(&turn) + rounding) * power * UP)
}

/// Rounding of Tₖ, k ≤ 4, as a part of ‖T₁‖ where rates are divided by their sum (docs/theory/features.md counts it).
const TURN_ROUNDING: f64 = 64.0 * UNIT;

/// 2⁻⁹⁰⁰: rates below it have no quotient 1/rate that is certainly finite, and nothing turns that slowly.
const SLOWEST: f64 = power_of_two(-900);

/// Upper bound of the operator norm, less than 1.08 of it: with the singular values σ, `(Σσ¹⁶)^(1/16)`, as
/// `‖(MᵀM)⁴‖^(1/8)` (Frobenius norm).
fn norm(m: &DMat3) -> f64 {
    let largest = [m.x_axis, m.y_axis, m.z_axis].map(|v| v.abs().max_element());
    let largest = largest[0].max(largest[1]).max(largest[2]);
    // Also NaN ends here.
    if largest == 0.0 || largest.is_nan() {
        return largest;
    }
    let m = *m * (1.0 / largest);
    let gram = m.transpose() * m;
    let square = gram * gram;
    let fourth = square * square;
    let sum =
        fourth.x_axis.length_squared() + fourth.y_axis.length_squared() + fourth.z_axis.length_squared();
    largest * sum.sqrt().sqrt().sqrt().sqrt() * UP
}

/// A part of a window, as offsets τ from its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffsetRange {
    /// Its first offset.
    pub from: f64,
    /// Its last offset.
    pub to: f64,
}

/// The difference of two reference points, `g + uτ` over a window.
#[derive(Clone, Copy)]
struct Line {
    g: DVec3,
    u: DVec3,
    /// At least |u|.
    speed: f64,
    duration: f64,
}

/// 2⁻²⁴⁰ and 2²⁴⁰: squares of products of two lengths between them are numbers, and keep their digits.
const PRODUCTS: core::ops::Range<f64> = power_of_two(-240)..power_of_two(240);

impl Line {
    /// R: the distance, padded.
    fn radius(&self, distance: f64) -> f64 {
        distance * UP + 64.0 * UNIT * (self.g.length() + self.speed * self.duration)
    }

    /// Are all the products of [`Line::times_within`] known to rounding?
    fn has_squares(&self, distance: f64) -> bool {
        PRODUCTS.contains(&self.radius(distance))
            && PRODUCTS.contains(&self.u.abs().max_element())
            && self.g.abs().max_element() < PRODUCTS.end
    }

    fn times_within(&self, distance: f64) -> Option<OffsetRange> {
        let Self { g, u, duration, .. } = *self;
        let (square, radius) = (u.length_squared(), self.radius(distance));
        let speed = square.sqrt();
        let nearest = g.cross(u).length() / speed;
        if nearest > radius {
            return None;
        }
        let half = ((radius - nearest) * (radius + nearest)).sqrt() / speed * UP;
        let middle = -g.dot(u) / square;
        let rounding = 16.0 * UNIT * (middle.abs() + half);
        let (from, to) = (middle - half - rounding, middle + half + rounding);
        if to < 0.0 || from > duration {
            return None;
        }
        // f64::max and min drop a NaN: then it is the whole window.
        Some(OffsetRange { from: from.max(0.0), to: to.min(duration) })
    }

    /// The same in units near the duration and the largest of the lengths, in which the padded distance is more than 2⁻⁴⁸.
    #[cold]
    fn times_in_units(&self, distance: f64) -> Option<OffsetRange> {
        let whole = OffsetRange { from: 0.0, to: self.duration };
        let second = power_of_two_below(self.duration);
        let (g, gone) = (self.g, self.u * second);
        let largest = g.abs().max(gone.abs()).max_element().max(distance);
        if !(largest > 0.0 && largest < f64::INFINITY) {
            return Some(whole);
        }
        let meter = power_of_two_below(largest);
        let (g, u, distance) = (g / meter, gone / meter, distance / meter);
        let line = Self { g, u, speed: length(u), duration: self.duration / second };
        if line.has_squares(distance) {
            let OffsetRange { from, to } = line.times_within(distance)?;
            let [from, to] = [from, to].map(|offset| offset * second);
            // What is subnormal is rounded.
            let from = if from < f64::MIN_POSITIVE { 0.0 } else { from };
            return Some(OffsetRange { from, to: to.max(f64::MIN_POSITIVE).min(self.duration) });
        }
        // It goes by less than rounding.
        let apart = u.abs().max_element() < PRODUCTS.start && g.length() > line.radius(distance);
        (!apart).then_some(whole)
    }
}

impl RelativeMotion {
    /// Bound of the distance from B's reference point of a point of A within `radius`: `Y + ρ`.
    pub fn bound_reach(&self, radius: f64) -> f64 {
        (self.bounds.reach + radius + self.anchor_arm()) * UP
    }

    /// The part of the window (τ) in which the reference points come within `distance` of each other, rounded
    /// outward; `None` if they never do. Straight relative motion of two points: no rotation matters.
    ///
    /// `|g + uτ| ≤ R` for `(τ − τ*)² ≤ (R² − d²)/|u|²`, `τ* = −g·u/|u|²`, `d = |g × u|/|u|`. R is padded by
    /// 64·2⁻⁵³(|g| + |u|T): more than the errors of g, u, d and of |u|τ* (≤ |g|).
    ///
    /// ```
    /// use d2m_motion::{ConstantTwist, RelativeMotion};
    /// use glam::DVec3;
    /// let passing = ConstantTwist::REST.with_position(-4.0 * DVec3::X).with_linear_velocity(8.0 * DVec3::X);
    /// let relative = RelativeMotion::new(&passing, &ConstantTwist::REST, 0.0, 1.0);
    /// let times = relative.times_within(2.0).unwrap();
    /// assert!(times.from <= 0.25 && times.from > 0.2499 && times.to >= 0.75 && times.to < 0.7501);
    /// let beside = RelativeMotion::new(&passing.with_position(DVec3::splat(-4.0)), &ConstantTwist::REST, 0.0, 1.0);
    /// assert_eq!(beside.times_within(2.0), None);
    /// ```
    pub fn times_within(&self, distance: f64) -> Option<OffsetRange> {
        let line =
            Line { g: self.offset, u: self.velocity, speed: self.bounds.speed, duration: self.duration };
        if line.has_squares(distance) { line.times_within(distance) } else { line.times_in_units(distance) }
    }

    /// Bound V of the speed of a point of A within `radius` of A's reference point: `U + bY⊥ + wρ`.
    ///
    /// Y⊥ is the greatest distance of A's reference point from the axis of B's spin through B's: what lies along that axis
    /// does not turn. With an anchor, `radius` is from the anchor and the arm of the anchor is added.
    pub fn bound_speed(&self, radius: f64) -> f64 {
        self.bound_speed_within(radius, self.bounds.reach)
    }

    /// The same while the reference points are within `reach` of each other: `Y⊥ ≤ reach`.
    pub fn bound_speed_within(&self, radius: f64, reach: f64) -> f64 {
        let k = &self.bounds;
        (k.speed + k.swept_within(reach) + k.w * (radius + self.anchor_arm())) * UP
    }

    /// Bound M3 of the third derivative while the reference points are within `reach` of each other:
    /// `b(3|ω_B × u| + b²Y⊥) + K3·ρ`.
    pub(super) fn bound_jerk_within(&self, radius: f64, reach: f64) -> f64 {
        let k = &self.bounds;
        (k.b * (3.0 * k.across + k.b * k.swept_within(reach)) + k.k3 * (radius + self.anchor_arm())) * UP
    }

    /// Bound of the speed of the tip of a direction of A of length 1: `w`.
    pub fn bound_direction_speed(&self) -> f64 {
        self.bounds.w
    }

    /// Remainder of every point jet with `|r| ≤ radius`, dotted with a vector of length at most 1 and compared with
    /// points of B of length at most `extent`: `E(h) + M3·h³/6`, `E(h) = k(S0 + S1·h + S2·h²)`,
    /// `S0 = Y + ρ + extent`, `S1 = 2(U + (a + b)S0)`, `S2 = 4((a + b)²S0 + bU)`.
    pub fn point_remainder(&self, radius: f64, extent: f64) -> Remainder {
        self.point_remainder_within(radius, extent, self.bounds.reach)
    }

    /// The same for times at which the reference points are within `reach` of each other: `Y = reach`, plus 8·2⁻⁵³ of
    /// the window's Y for the rounding of g + uτ itself.
    pub fn point_remainder_within(&self, radius: f64, extent: f64, reach: f64) -> Remainder {
        let k = &self.bounds;
        let here = if reach < k.reach { reach + k.reach * (8.0 * UNIT / k.rounding) } else { k.reach };
        let s0 = here + radius + extent + self.anchor_arm();
        let turn = k.a + k.b;
        // An anchored frame brings the rounding of its own position: see `Frame::point_jet`.
        let e0 = if self.anchor.is_some() { (radius + extent) * k.rounding } else { s0 * k.rounding };
        Remainder {
            e0: e0 * UP,
            e1: 2.0 * (k.speed + turn * s0) * k.rounding * UP,
            e2: 4.0 * (turn * turn * s0 + k.b * k.speed) * k.rounding * UP,
            m3: self.bound_jerk_within(radius, reach),
            m4: 0.0,
        }
    }

    /// Bound M4 of the fourth derivative while the reference points are within `reach` of each other:
    /// `b²(4|ω_B × u| + b²Y⊥) + K4·ρ`.
    pub fn bound_fourth_derivative_within(&self, radius: f64, reach: f64) -> f64 {
        let k = &self.bounds;
        (k.b * k.b * (4.0 * k.across + k.b * k.swept_within(reach)) + k.k4 * (radius + self.anchor_arm()))
            * UP
    }

    /// The remainder of jets to third order of the points whose jets to second order have the remainder `second` of
    /// [`RelativeMotion::point_remainder_within`]: `M4·h⁴/24` and the rounding of the third derivative,
    /// `3k((a + b)³S0 + 3b²U)`, in place of `M3·h³/6`.
    pub fn point_remainder_third_order(&self, second: Remainder, fourth_derivative: f64) -> Remainder {
        let k = &self.bounds;
        let turn = k.a + k.b;
        let size = turn * turn * turn * second.e0 + 3.0 * k.b * k.b * k.speed * k.rounding;
        let rounding = ROUNDING_OF_THIRD * size * UP;
        Remainder { m3: rounding, m4: fourth_derivative, ..second }
    }

    /// The same for directions: `K4·h⁴/24` of the length in place of `K3·h³/6`.
    pub fn direction_remainder_third_order(&self, length: f64) -> Remainder {
        let k = &self.bounds;
        let second = self.direction_remainder(length);
        let turn = k.a + k.b;
        let rounding = ROUNDING_OF_THIRD * turn * turn * turn * second.e0 * UP;
        Remainder { m3: rounding, m4: k.k4 * length * UP, ..second }
    }

    /// Remainder of the jet of a direction of A of the given length: as a point with `g = u = 0`.
    pub fn direction_remainder(&self, length: f64) -> Remainder {
        let k = &self.bounds;
        let turn = k.a + k.b;
        let e0 = length * k.rounding * UP;
        Remainder {
            e0,
            e1: 2.0 * turn * e0 * UP,
            e2: 4.0 * turn * turn * e0 * UP,
            m3: k.k3 * length * UP,
            m4: 0.0,
        }
    }

    /// Bound of how far the anchors are from the reference points, added; 0 without anchors. Points within `radius` and
    /// `extent` of the origins of a frame meet only while the reference points are within `radius + extent` and this of
    /// each other.
    pub fn bound_anchor_arms(&self) -> f64 {
        self.anchor.as_ref().map_or(0.0, |anchor| anchor.arms)
    }

    fn anchor_arm(&self) -> f64 {
        self.anchor.as_ref().map_or(0.0, |anchor| anchor.arm)
    }
}
