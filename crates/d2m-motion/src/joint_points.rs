//! The values of a joint through points at times: straight, cubic and quintic Hermite polynomials.
use crate::MotionError;
use crate::enclosed::Enclosed;
use crate::error::{TimesFault, fault, find_times_fault};
use d2m_lanes::DoubleDouble;

/// Spans of time between these have fifth powers that neither under- nor overflow.
pub(crate) const SHORTEST: f64 = 1e-50;
pub(crate) const LONGEST: f64 = 1e50;

/// Can polynomials of the fifth degree last so long?
pub(crate) fn is_length(span: f64) -> bool {
    (SHORTEST..=LONGEST).contains(&span)
}

/// What a joint passes through: positions at times and, where they are known, velocities and accelerations there. As in a
/// `JointTrajectory` of ROS.
///
/// Between two points the joint follows the polynomial of least degree through what is given at both: a straight line
/// (positions), the cubic Hermite polynomial (velocities too) or the quintic one (accelerations too).
///
/// ```
/// use d2m_motion::{JointPoints, JointValue};
/// let points = JointPoints::new(vec![0.0, 1.0, 3.0], vec![0.0, 1.0, 0.0]);
/// let straight = JointValue::through(points.clone())?;
/// assert_eq!((straight.value(0.5), straight.value(2.0), straight.next_time(0.5)), (0.5, 0.5, Some(1.0)));
/// let smooth = JointValue::through(points.with_velocities(vec![0.0, 0.5, 0.0]))?;
/// assert_eq!((smooth.value(1.0), smooth.value(0.5)), (1.0, 0.4375));
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct JointPoints {
    /// Strictly increasing.
    pub times: Vec<f64>,
    /// Radians, or units of length.
    pub positions: Vec<f64>,
    /// Rates of the positions.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub velocities: Option<Vec<f64>>,
    /// Rates of the velocities.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub accelerations: Option<Vec<f64>>,
}

impl JointPoints {
    /// Positions at times, joined by straight lines.
    pub const fn new(times: Vec<f64>, positions: Vec<f64>) -> Self {
        Self { times, positions, velocities: None, accelerations: None }
    }

    /// With the velocities at these times.
    #[must_use]
    pub fn with_velocities(self, velocities: Vec<f64>) -> Self {
        Self { velocities: Some(velocities), ..self }
    }

    /// With the accelerations at these times, which need the velocities.
    #[must_use]
    pub fn with_accelerations(self, accelerations: Vec<f64>) -> Self {
        Self { accelerations: Some(accelerations), ..self }
    }

    pub(crate) fn times(&self) -> &[f64] {
        &self.times
    }

    /// Each list by its name, its numbers finite and as many as there are times.
    pub(crate) fn check(&self) -> Result<(), MotionError> {
        if let Some(TimesFault { index, reason }) = find_times_fault(&self.times) {
            return Err(fault(format!("value, times[{index}]"), reason));
        }
        if self.accelerations.is_some() && self.velocities.is_none() {
            let reason = "accelerations need velocities".to_owned();
            return Err(fault("value, velocities".to_owned(), reason));
        }
        let lists = [
            ("positions", Some(&self.positions)),
            ("velocities", self.velocities.as_ref()),
            ("accelerations", self.accelerations.as_ref()),
        ];
        for (name, list) in lists.into_iter().filter_map(|(name, list)| Some((name, list?))) {
            if let Some(index) = list.iter().position(|number| !number.is_finite()) {
                return Err(fault(
                    format!("value, {name}[{index}]"),
                    format!("{} is not finite", list[index]),
                ));
            }
            if list.len() != self.times.len() {
                let reason = format!("{} of them for {} times", list.len(), self.times.len());
                return Err(fault(format!("value, {name}"), reason));
            }
        }
        Ok(())
    }

    /// Enclosures of the coefficients in t − times\[piece\], lowest first; `None` where doubles cannot hold them.
    ///
    /// With h the length of the piece and Δ the way from one position to the other. Straight: c₁ = Δ/h. Cubic:
    /// c₂ = (3Δ − (2v₀ + v₁)h)/h², c₃ = ((v₀ + v₁)h − 2Δ)/h³. Quintic: c₂ = a₀/2,
    /// c₃ = (20Δ − (8v₁ + 12v₀)h + (a₁ − 3a₀)h²)/2h³, c₄ = ((14v₁ + 16v₀)h − 30Δ + (3a₀ − 2a₁)h²)/2h⁴,
    /// c₅ = (12Δ − 6(v₁ + v₀)h + (a₁ − a₀)h²)/2h⁵.
    pub(crate) fn coefficients(&self, piece: usize) -> Option<Vec<Enclosed>> {
        let ends = |list: &[f64]| [list[piece], list[piece + 1]].map(Enclosed::exact);
        let h = DoubleDouble::from_difference(self.times[piece + 1], self.times[piece]);
        if !is_length(h.hi) {
            return None;
        }
        let length = Enclosed { center: h, radius: 0.0 };
        let [start, end] = ends(&self.positions);
        let way = end - start;
        let mut terms = vec![start];
        match (&self.velocities, &self.accelerations) {
            (Some(velocities), Some(accelerations)) => {
                let ([v0, v1], [a0, a1]) = (ends(velocities), ends(accelerations));
                let square = length * length;
                let [c3, c4, c5] = [
                    way * 20.0 - (v1 * 8.0 + v0 * 12.0) * length + (a1 - a0 * 3.0) * square,
                    (v1 * 14.0 + v0 * 16.0) * length - way * 30.0 + (a0 * 3.0 - a1 * 2.0) * square,
                    way * 12.0 - (v1 + v0) * 6.0 * length + (a1 - a0) * square,
                ]
                .map(|c| c * 0.5);
                terms.extend([v0, a0 * 0.5, c3.over(h, 3), c4.over(h, 4), c5.over(h, 5)]);
            }
            (Some(velocities), None) => {
                let [v0, v1] = ends(velocities);
                let (c2, c3) = (way * 3.0 - (v0 * 2.0 + v1) * length, (v0 + v1) * length - way * 2.0);
                terms.extend([v0, c2.over(h, 2), c3.over(h, 3)]);
            }
            (None, _) => terms.push(way.over(h, 1)),
        }
        terms.into_iter().map(Enclosed::if_finite).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::JointValue;
    use d2m_testing::{Draw, Random};

    type Dd = DoubleDouble;

    /// The polynomial by the Hermite basis in pairs of doubles: other formulas, in u = (t − t₀)/h.
    fn hermite(points: &JointPoints, piece: usize, t: f64) -> Dd {
        let h = Dd::from_difference(points.times[piece + 1], points.times[piece]);
        let u = Dd::from_difference(t, points.times[piece]).div_accurately(h);
        let ends = |list: &[f64]| [list[piece], list[piece + 1]].map(Dd::from_f64);
        let [p, q] = ends(&points.positions);
        let w = Dd::ONE - u;
        let (square, cube) = (u * u, u * u * u);
        let Some(velocities) = &points.velocities else { return p * w + q * u };
        let [v0, v1] = ends(velocities).map(|v| v * h);
        let Some(accelerations) = &points.accelerations else {
            return p * w * w * (Dd::ONE + u * 2.0)
                + q * square * (Dd::from_f64(3.0) - u * 2.0)
                + v0 * u * w * w
                - v1 * square * w;
        };
        let [a0, a1] = ends(accelerations).map(|a| a * h * h);
        let (w3, u2) = (w * w * w, square);
        p * w3 * (Dd::ONE + u * 3.0 + u2 * 6.0)
            + q * cube * (Dd::from_f64(10.0) - u * 15.0 + u2 * 6.0)
            + v0 * u * w3 * (Dd::ONE + u * 3.0)
            - v1 * cube * w * (Dd::from_f64(4.0) - u * 3.0)
            + a0 * u2 * w3 * 0.5
            + a1 * cube * w * w * 0.5
    }

    fn random_points(random: &mut Random, degree: usize, start: f64) -> JointPoints {
        let count = 2 + (random.unit() * 5.0) as usize;
        let mut time = start;
        let times = (0..count).map(|_| {
            time += 0.01 + random.unit();
            time
        });
        let times = times.collect();
        let list = |random: &mut Random| (0..count).map(|_| 3.0 * random.signed()).collect::<Vec<_>>();
        let mut points = JointPoints::new(times, list(random));
        points.velocities = (degree > 0).then(|| list(random));
        points.accelerations = (degree > 1).then(|| list(random));
        points
    }

    #[test]
    fn values_hold_the_true_polynomial_and_no_more() {
        let mut random = Random(41);
        for round in 0..300 {
            let (degree, start) = (round % 3, [0.0, 1e5, -3.0][round / 3 % 3]);
            let points = random_points(&mut random, degree, start);
            let value = JointValue::through(points.clone()).unwrap();
            for piece in 0..points.times.len() - 1 {
                let [from, to] = [points.times[piece], points.times[piece + 1]];
                for k in 0..=8 {
                    let t = if k == 8 { to } else { from + (to - from) * f64::from(k) / 8.0 };
                    let truth = hermite(&points, piece, t);
                    let over = if k == 8 { value.over(from, to) } else { value.over(t, t) };
                    let apart = (truth - over.value.center).hi.abs();
                    assert!(apart <= over.value.radius + 1e-28, "{round} {piece} {k} {apart:e}");
                    if k < 8 {
                        // What the difference t − t₀ loses of a double, at the rate of the joint.
                        assert!(over.value.radius < 1e-13, "{round} {:e}", over.value.radius);
                    }
                }
            }
        }
    }

    #[test]
    fn pieces_meet_and_pass_through_what_was_given() {
        let mut random = Random(42);
        for round in 0..100 {
            let degree = round % 3;
            let points = random_points(&mut random, degree, 0.0);
            let value = JointValue::through(points.clone()).unwrap();
            for (index, &t) in points.times.iter().enumerate() {
                let at = value.over(t, t);
                assert!(
                    (at.value.center.add_f64(-points.positions[index])).hi.abs() <= at.value.radius + 1e-26
                );
                assert_eq!(value.value(t), points.positions[index]);
                for (list, part) in [(&points.velocities, at.rate), (&points.accelerations, at.second)] {
                    let Some(list) = list else { continue };
                    let apart = part.center.add_f64(-list[index]).hi.abs();
                    assert!(apart <= part.radius + 1e-24, "{apart:e} {:e}", part.radius);
                }
            }
        }
    }

    #[test]
    fn a_mimic_is_the_exact_multiple() {
        let mut random = Random(43);
        for round in 0..60 {
            let points = random_points(&mut random, round % 3, 0.0);
            let value = JointValue::through(points.clone()).unwrap();
            let (multiplier, offset) = (random.signed() * 2.0, random.signed());
            let follower = value.scaled(multiplier, offset).unwrap();
            let t = points.times[0] + 0.37 * (points.times[1] - points.times[0]);
            let truth = (hermite(&points, 0, t) * multiplier).add_f64(offset);
            let over = follower.over(t, t).value;
            assert!((truth - over.center).hi.abs() <= over.radius + 1e-28 && over.radius < 1e-13);
            assert_eq!(follower.times(), value.times());
        }
        let huge = JointValue::try_polynomial(vec![1e300]).unwrap().scaled(1e300, 0.0);
        assert!(huge.unwrap_err().to_string().contains("pieces[0][0]"));
    }

    #[test]
    fn faults_name_the_list_and_the_value() {
        let points = |times: &[f64], positions: &[f64]| JointPoints::new(times.to_vec(), positions.to_vec());
        let two = || points(&[0.0, 1.0], &[0.0, 1.0]);
        for (points, expected) in [
            (points(&[0.0], &[1.0]), "value, times[1]: at least two times"),
            (points(&[0.0, 0.0], &[1.0, 1.0]), "value, times[1]: 0.0 does not come after 0.0"),
            (points(&[0.0, f64::NAN], &[1.0, 1.0]), "value, times[1]: NaN"),
            (points(&[0.0, 1.0], &[1.0]), "value, positions: 1 of them for 2 times"),
            (points(&[0.0, 1.0], &[1.0, f64::INFINITY]), "value, positions[1]: inf"),
            (two().with_velocities(vec![f64::NAN, 0.0]), "value, velocities[0]: NaN"),
            (two().with_accelerations(vec![0.0, 0.0]), "value, velocities: accelerations need"),
            (points(&[0.0, 1e-60], &[0.0, 1.0]), "value, pieces[0]: from 0.0 to 1e-60"),
            (points(&[-1e308, 1e308], &[0.0, 1.0]), "value, pieces[0]"),
            (points(&[0.0, 1e-40], &[0.0, 1e300]), "value, pieces[0]"),
        ] {
            let message = JointValue::through(points).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}\n{expected}");
        }
    }
}
