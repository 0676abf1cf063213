//! Sphere-Over-Domain and Test-Sphere-Pair (section IV-D and Algorithm 5 of the paper).

use super::PointJet;
use super::relative_motion::has_joint;
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use d2m_motion::RigidMotion;
use d2m_root::InclusionFunction;
use glam::DVec3;

/// All that a body does over one span of time, world axes, positions relative to a scene center.
///
/// Epoch: the start of the span. The enclosures are computed once and shared by all spheres of the body.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_motion::ConstantTwist;
/// use d2m_paper::BodyOverDomain;
/// use glam::DVec3;
/// let spinning = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
/// let body = BodyOverDomain::new(&spinning, Interval::new(0.0, 0.5), DVec3::ZERO);
/// // The path of a body point, and its speed of one.
/// let jet = body.jet(DVec3::X);
/// assert!(jet.enclose(Interval::ZERO).x.contains(1.0) && jet.bound_speed() >= 1.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct BodyOverDomain {
    span: Interval,
    /// A joint of the motion is inside of the span. At each time the body is where one that stands still is: of any place of the span.
    stands: bool,
    at: DVec3,
    rotation: [IntervalMat3; 2],
    position: [IntervalVec3; 2],
    twist: [[IntervalVec3; 2]; 2],
    rate: [IntervalVec3; 2],
}

impl BodyOverDomain {
    /// Encloses `motion` over `span`, with `center` subtracted from all positions.
    ///
    /// The center only keeps numbers small; both bodies of a pair must use the same.
    pub fn new(motion: &dyn RigidMotion, span: Interval, center: DVec3) -> Self {
        let start = Interval::point(span.lo());
        let position = |t: Interval, world: IntervalVec3| match motion.constant_twist() {
            Some(l) => {
                (IntervalVec3::point(l.position()) - center)
                    + IntervalVec3::point(l.linear_velocity()) * (t - l.reference_time())
            }
            None => world - center,
        };
        let stands = has_joint(motion, span);
        let start = if stands { span } else { start };
        let (p0, p) = (motion.enclose_pose(start), motion.enclose_pose(span));
        let (t0, t) = (motion.enclose_twist(start), motion.enclose_twist(span));
        let rate = motion.enclose_twist_rate(span);
        Self {
            span,
            stands,
            at: p0.at,
            rotation: [p0.rotation, p.rotation],
            position: [position(start, p0.translation), position(span, p.translation)],
            twist: [[t0.linear, t0.angular], [t.linear, t.angular]],
            rate: [rate.linear, rate.angular],
        }
    }

    /// The span of time.
    pub const fn span(&self) -> Interval {
        self.span
    }

    /// The path of a body point over the span, world axes, relative to the scene center.
    pub fn jet(&self, point: DVec3) -> PointJet {
        let s = self.sphere(point, 0.0);
        PointJet::new(self.span, [s.position[0], s.velocity[0], s.acceleration])
    }

    /// The sphere with this center (body frame) and radius over the span.
    pub fn sphere(&self, center: DVec3, radius: f64) -> SphereOverDomain {
        let r = IntervalVec3::point(center) - self.at;
        let arm = [self.rotation[0].mul_vec(r), self.rotation[1].mul_vec(r)];
        let spin = self.twist[1][1];
        let mut velocity = [0, 1].map(|i| self.twist[i][0] + self.twist[i][1].cross(arm[i]));
        let mut acceleration = self.rate[0] + self.rate[1].cross(arm[1]) + spin.cross(spin.cross(arm[1]));
        if self.stands {
            velocity = velocity.map(|v| v.hull(IntervalVec3::ZERO));
            acceleration = IntervalVec3::ZERO;
        }
        let position = [self.position[0] + arm[0], self.position[1] + arm[1]];
        let thick = Interval::new(-radius, radius);
        let cube = IntervalVec3::new(thick, thick, thick);
        SphereOverDomain { position, velocity, acceleration, radius, bounding_box: position[1] + cube }
    }
}

/// Sphere-Over-Domain: one moving sphere over one span of time.
///
/// `position[0]` = x_{t,0} and `velocity[0]` = ẋ_{t,0} at the start of the span; `position[1]`, `velocity[1]` and
/// `acceleration` enclose them over all of it.
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_motion::ConstantTwist;
/// use d2m_paper::{BodyOverDomain, test_sphere_pair};
/// use glam::DVec3;
/// let flying = ConstantTwist::REST.with_position(DVec3::X * -4.0).with_linear_velocity(DVec3::X * 4.0);
/// let over = |motion: &ConstantTwist| BodyOverDomain::new(motion, Interval::UNIT, DVec3::ZERO).sphere(DVec3::ZERO, 1.0);
/// let (a, b) = (over(&flying), over(&ConstantTwist::REST));
/// // Balls of radius one, 4 apart, that close by 4: they touch at a half.
/// let part = test_sphere_pair(&a, &b, 0.0, Interval::UNIT).expect("they meet");
/// assert!(part.lo() <= 0.5 && part.lo() > 0.4999);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SphereOverDomain {
    position: [IntervalVec3; 2],
    velocity: [IntervalVec3; 2],
    acceleration: IntervalVec3,
    radius: f64,
    bounding_box: IntervalVec3,
}

/// Test-Sphere-Pair: the hull of the times in `searched` at which the two spheres may overlap; `None` promises that
/// they are disjoint throughout. Times of `searched` outside the hull are certainly free.
///
/// `epoch` is the start of the span of both spheres and `searched` lies in that span. The lower parabola of
/// s(t) = |γ|² − (r_A + r_B)² is valid on the whole span; where it is positive the spheres are apart. Two repairs
/// of Algorithm 5: ½ enters θ once (line 10 halves s̈, and θ halves it again), and "s > 0" (line 13) is judged at the
/// start of `searched`: judged at the epoch, a pair that has begun to overlap between the epoch and the start of
/// `searched` has its exit taken for its entry.
///
/// ```text
///  s │╲                     ╱       s at the epoch > 0, but the search starts inside:
///    │ ╲    searched       ╱        the answer is [start, exit], not [exit, end]
///  0 ┼──╲───[═══════╪═════╱═══]
///    │   `·.________.·'
/// ```
///
/// ```
/// use d2m_paper::{BodyOverDomain, test_sphere_pair};
/// use d2m_interval::Interval;
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_position(4.0 * DVec3::Z).with_linear_velocity(-4.0 * DVec3::Z);
/// let (a, b) = (
///     BodyOverDomain::new(&falling, Interval::UNIT, DVec3::ZERO).sphere(DVec3::ZERO, 1.0),
///     BodyOverDomain::new(&ConstantTwist::REST, Interval::UNIT, DVec3::ZERO).sphere(DVec3::ZERO, 1.0),
/// );
/// let overlap = test_sphere_pair(&a, &b, 0.0, Interval::UNIT).unwrap();
/// assert!(overlap.lo() <= 0.5 && overlap.lo() > 0.499);
/// ```
#[doc(alias = "TSP")]
pub fn test_sphere_pair(
    a: &SphereOverDomain,
    b: &SphereOverDomain,
    epoch: f64,
    searched: Interval,
) -> Option<Interval> {
    if !boxes_meet(&a.bounding_box, &b.bounding_box) {
        return None;
    }
    let gamma = [b.position[0] - a.position[0], b.position[1] - a.position[1]];
    let rate = [b.velocity[0] - a.velocity[0], b.velocity[1] - a.velocity[1]];
    let second = b.acceleration - a.acceleration;
    let radii = Interval::point(a.radius) + b.radius;
    let theta = InclusionFunction::new(
        gamma[0].norm_squared() - radii.sqr(),
        gamma[0].dot(rate[0]) * 2.0,
        (second.dot(gamma[1]) + rate[1].norm_squared()) * 2.0,
        Interval::new(epoch, searched.hi()),
    );
    theta.nonpositive_hull(searched)
}

/// Do two boxes share a point?
pub(crate) fn boxes_meet(a: &IntervalVec3, b: &IntervalVec3) -> bool {
    let meet = |a: Interval, b: Interval| !(a.hi() < b.lo() || b.hi() < a.lo());
    meet(a.x, b.x) && meet(a.y, b.y) && meet(a.z, b.z)
}
