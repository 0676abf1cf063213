//! All links of an arm over one span of time: what they share is computed once.
use crate::{Arm, SpanMotion};

/// How the links of an arm move over a span of time, as seen from the world or from each other.
///
/// Every joint is enclosed once for a span, and every link once for each frame that it is seen from. Buffers stay for the next span.
///
/// ```
/// use d2m_motion::{Arm, ArmSpan, Joint, JointKind, JointValue};
/// use glam::{DQuat, DVec3};
/// let value = JointValue::try_polynomial(vec![0.0, 1.0])?;
/// let turn = JointKind::Revolute { axis: DVec3::Z, value };
/// let mut arm = Arm::default();
/// let upper = arm.add("upper", None, Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, turn)?)?;
/// let tool = arm.add("tool", Some(upper), Joint::try_new(DVec3::X, DQuat::IDENTITY, JointKind::Fixed)?)?;
/// let mut span = ArmSpan::new(&arm);
/// span.move_to(0.0, 0.2);
/// // In the middle it has turned by 0.1 radian, and its tool moves with one unit of length a unit of time.
/// let tool_seen = span.link(tool, None);
/// assert!((tool_seen.position.center - DVec3::new(0.1_f64.cos(), 0.1_f64.sin(), 0.0)).length() < 1e-15);
/// assert!(tool_seen.linear.bound_length() < 1.2 && tool_seen.linear.bound_length() >= 1.0);
/// // From the upper arm it does not move.
/// assert_eq!(span.link(tool, Some(upper)).linear.bound_length(), 0.0);
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
pub struct ArmSpan<'a> {
    arm: &'a Arm,
    middle: f64,
    half: f64,
    /// Of each joint, in the frame before it.
    joints: Vec<SpanMotion>,
    /// Places in `seen` by the frame (the world first) and the link.
    places: Vec<u32>,
    seen: Vec<SpanMotion>,
}

/// No place: not seen so far.
const UNSEEN: u32 = u32::MAX;

impl<'a> ArmSpan<'a> {
    /// Of no span so far: at the time zero.
    pub fn new(arm: &'a Arm) -> Self {
        let links = arm.len();
        let places = vec![UNSEEN; links * (links + 1)];
        let mut span =
            Self { arm, middle: 0.0, half: 0.0, joints: Vec::with_capacity(links), places, seen: vec![] };
        span.move_to(0.0, 0.0);
        span
    }

    /// The span from one time to another, within the times of all joints.
    pub fn move_to(&mut self, from: f64, to: f64) {
        let middle = (0.5 * from + 0.5 * to).clamp(from, to);
        // Either difference is rounded once.
        (self.middle, self.half) = (middle, (to - middle).max(middle - from).next_up());
        self.joints.clear();
        self.joints.extend(self.arm.joints().map(|joint| joint.over(from, to)));
        self.places.fill(UNSEEN);
        self.seen.clear();
    }

    /// The middle of the span.
    pub const fn middle(&self) -> f64 {
        self.middle
    }

    /// Not less than the time from the middle to either end.
    pub const fn half(&self) -> f64 {
        self.half
    }

    /// A link as seen from the link `from`, which carries it in the end or is the same, or from the world.
    ///
    /// # Panics
    /// An index that is no link, or a link that does not carry the other.
    pub fn link(&mut self, link: usize, from: Option<usize>) -> &SpanMotion {
        if from == Some(link) {
            return &SpanMotion::REST;
        }
        let place = self.place(link, from);
        &self.seen[place]
    }

    /// The place in `seen` of a link that is not the one it is seen from.
    fn place(&mut self, link: usize, from: Option<usize>) -> usize {
        let at = from.map_or(0, |from| from + 1) * self.arm.len() + link;
        if self.places[at] != UNSEEN {
            return self.places[at] as usize;
        }
        let parent = self.arm.parent(link);
        let seen = if parent == from {
            self.joints[link]
        } else if let Some(parent) = parent {
            let parent = self.place(parent, from);
            self.seen[parent].then(&self.joints[link])
        } else {
            panic!("link {from:?} does not carry link {link}");
        };
        let place = self.seen.len();
        self.places[at] = place as u32;
        self.seen.push(seen);
        place
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Joint, JointKind, JointPoints, JointValue, RigidMotion};
    use d2m_testing::{Draw, KnuthRandom};
    use glam::{DQuat, DVec3};

    /// Random trees of links; joints that turn, shift and do nothing, straight and quintic, over one piece and over several.
    #[test]
    fn every_link_is_where_its_span_says_from_the_world_and_from_every_carrier() {
        let mut random = KnuthRandom(29);
        let mut sharpest = 0.0_f64;
        for round in 0..80_usize {
            let mut arm = Arm::default();
            for k in 0..6_usize {
                let positions = (0..3).map(|_| random.vector().x).collect();
                let points = JointPoints::new(vec![0.0, 1.0, 2.0], positions);
                let rates = (0..3).map(|_| random.vector().x).collect();
                let points = if round % 2 == 0 { points } else { points.with_velocities(rates) };
                let value = JointValue::through(points).unwrap();
                let axis = random.vector();
                let kind = match random.index(5) {
                    0 => JointKind::Fixed,
                    1 => JointKind::Prismatic { axis, value },
                    2 => JointKind::Revolute { axis, value: value.scaled(-0.5, 0.25).unwrap() },
                    _ => JointKind::Revolute { axis, value },
                };
                let turn =
                    if round % 3 == 0 { DQuat::IDENTITY } else { DQuat::from_scaled_axis(random.vector()) };
                let parent = k.checked_sub(1 + random.index(2).min(k.saturating_sub(1)));
                arm.add("link", parent, Joint::try_new(random.vector(), turn, kind).unwrap()).unwrap();
            }
            let chains = arm.links().unwrap();
            let [from, to] = [[0.125, 0.375], [0.5, 1.5], [1.0, 2.0], [0.25, 0.251]][round % 4];
            let mut span = ArmSpan::new(&arm);
            span.move_to(from, to);
            for link in 0..arm.len() {
                let mut carrier = Some(link);
                loop {
                    carrier = carrier.and_then(|link| arm.parent(link));
                    let seen = *span.link(link, carrier);
                    let skipped = carrier.map_or(0, |carrier| chains[carrier].joints().len());
                    let rest = chains[link].without_first(skipped);
                    for k in 0..=16 {
                        let t = from + (to - from) * f64::from(k) / 16.0;
                        let (pose, twist) = rest.pose_and_twist(t);
                        let way = (t - span.middle()).abs();
                        let off = pose.translation
                            - seen.position.center
                            - seen.linear.center * (t - span.middle());
                        let most = seen.position.radius + way * seen.linear.radius;
                        assert!(off.length() <= most + 1e-13, "{round} {link} {carrier:?} {t}");
                        assert!(
                            (pose.translation - seen.position.center).length()
                                <= seen.position_spread + 1e-13
                        );
                        assert!(
                            (twist.angular - seen.angular.center).length() <= seen.angular.radius + 1e-13
                        );
                        let turned =
                            glam::DMat3::from_quat(pose.rotation) * DVec3::X - seen.rotation * DVec3::X;
                        assert!(turned.length() <= seen.rotation_spread + 1e-13);
                        if t == span.middle() && (round % 4 != 1) {
                            assert!(seen.position.radius < 1e-12 && seen.rotation_radius < 1e-12);
                            assert!(turned.length() <= 1e-13 && off.length() <= 1e-13);
                        }
                        sharpest = sharpest.max(off.length() / most);
                    }
                    if carrier.is_none() {
                        break;
                    }
                }
            }
        }
        assert!(sharpest > 0.3, "{sharpest}");
    }

    /// Pieces that miss each other by what counts as rounding: no rate bounds the jump between them.
    #[test]
    fn of_a_value_that_jumps_no_rate_is_known() {
        let value = JointValue::try_pieces(vec![0.0, 1.0, 2.0], vec![vec![0.0], vec![0.5e-9]]).unwrap();
        let mut arm = Arm::default();
        let kind = JointKind::Prismatic { axis: DVec3::X, value };
        arm.add("slide", None, Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap()).unwrap();
        let mut span = ArmSpan::new(&arm);
        span.move_to(0.5, 1.5);
        assert_eq!(span.link(0, None).linear.radius, f64::INFINITY);
        span.move_to(0.5, 1.0);
        assert_eq!(span.link(0, None).linear.bound_length(), 0.0);
    }

    #[test]
    fn the_last_common_link_carries_both() {
        let still = || Joint::try_new(DVec3::X, DQuat::IDENTITY, JointKind::Fixed).unwrap();
        let mut arm = Arm::default();
        for parent in [None, Some(0), Some(1), Some(1), Some(3), None] {
            arm.add("link", parent, still()).unwrap();
        }
        for (a, b, common) in
            [(2, 4, Some(1)), (4, 2, Some(1)), (4, 3, Some(3)), (4, 4, Some(4)), (0, 5, None), (5, 4, None)]
        {
            assert_eq!(arm.last_common(a, b), common, "{a} {b}");
        }
        assert_eq!(ArmSpan::new(&arm).link(4, Some(1)).position.center, DVec3::X * 2.0);
    }
}
