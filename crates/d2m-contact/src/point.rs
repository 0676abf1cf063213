//! A contact point with its impulse.

use super::law::Law;
use crate::momenta::Momenta;
use crate::velocity::Velocity;
use d2m_feature::FeaturePair;
use glam::DVec3;

/// The part of a distance that a flight leaves if it shares what room there is: more than the part at which it would meet, which is
/// one half, and 1/16 more.
const SHARED: f64 = 0.625;

/// How two bodies touch.
///
/// ```
/// let rubber = d2m_contact::Material::new(0.7, 0.9);
/// assert_eq!((rubber.restitution, rubber.friction), (0.7, 0.9));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// Coefficient of restitution, from 0 to 1.
    pub restitution: f64,
    /// Coulomb's coefficient of friction, not negative.
    pub friction: f64,
}

impl Material {
    /// These numbers, unchecked: with others than their fields say a solution obeys no law. Its residual tells: it is infinite for such a
    /// friction.
    #[must_use]
    pub const fn new(restitution: f64, friction: f64) -> Self {
        Self { restitution, friction }
    }
}

/// What a row of a joint is about. Rates hold where a flight begins; whoever makes the rows corrects them until what they stand for holds
/// where the flight ends.
///
/// ```
/// use d2m_contact::JointPart;
/// let across = JointPart::Equation { joint: 3, number: 0 };
/// assert_ne!(across, JointPart::Value { joint: 3 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointPart {
    /// A rate, and nothing beyond that.
    Rate,
    /// An equation of a joint: two points that stay together, or two axes that stay parallel.
    Equation {
        /// The joint's number.
        joint: usize,
        /// The number of the equation among those of the joint.
        number: usize,
    },
    /// The value of a joint, an angle or a length, which limits and motors are about.
    Value {
        /// The joint's number.
        joint: usize,
    },
    /// A force along that value, as of a spring, whose impulse depends on how long the flight is.
    Force {
        /// The joint's number.
        joint: usize,
        /// The number of the force among those of the joint.
        number: usize,
    },
}

/// A row of a joint.
///
/// ```
/// use d2m_contact::{Accuracy, ContactPoint, JointPart, JointRow, Law, Material, SolverBody, Start, System};
/// use glam::{DMat3, DVec3};
/// // A motor that turns a wheel about the normal, with an impulse of no more than 3, to 2 radians a unit of time.
/// let law = Law::Range { lo: -3.0, hi: 3.0, softness: 0.0 };
/// let motor = JointRow { is_angular: true, law, pushing: 2.0, target: 2.0, part: JointPart::Rate, is_motor: true };
/// let axle = ContactPoint::new([0, 1], [DVec3::ZERO; 2], DVec3::Z, Material::new(0.0, 0.0));
/// let wheel = SolverBody { inverse_mass: 1.0, inverse_inertia: DMat3::IDENTITY, ..SolverBody::FIXED };
/// let row = ContactPoint { row: Some(motor), ..axle };
/// let mut system = System::new(vec![SolverBody::FIXED, wheel], &[row], |body| body);
/// system.solve(&[motor.target], Accuracy::exact(1e-9), Start::Sticking);
/// assert!((system.bodies[1].velocity.angular.z - 2.0).abs() < 1e-8);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointRow {
    /// Of the turn about the normal, instead of the way along it.
    pub is_angular: bool,
    /// The impulses that it may have.
    pub law: Law,
    /// The rate that impulses see to.
    pub pushing: f64,
    /// That of the flight, which also takes back what the joint is off.
    pub target: f64,
    /// Which part of the joint it is about.
    pub part: JointPart,
    /// Of a motor, whose impulses of a step add up.
    pub is_motor: bool,
}

impl JointRow {
    /// Along the normal of its contact, with no rate: what is coupled by it stays so, as far as the law allows.
    #[must_use]
    pub const fn still(law: Law) -> Self {
        Self { is_angular: false, law, pushing: 0.0, target: 0.0, part: JointPart::Rate, is_motor: false }
    }

    /// Is it of an equation, which holds whatever acts on the bodies?
    #[must_use]
    pub const fn is_equation(&self) -> bool {
        matches!(self.part, JointPart::Equation { .. })
    }
}

/// A pair of closest features of two bodies, or a row of a joint, and the impulse between them. World axes.
///
/// ```
/// use d2m_contact::{ContactPoint, Material, Velocity};
/// use glam::DVec3;
/// let arms = [DVec3::Y * 0.5, DVec3::Y * -0.5];
/// let touching = ContactPoint { impulse: 3.0, ..ContactPoint::new([0, 1], arms, DVec3::Y, Material::new(0.0, 0.5)) };
/// let falling = Velocity { linear: DVec3::NEG_Y, angular: DVec3::ZERO };
/// assert_eq!(touching.rate(Velocity::default(), falling), -1.0);
/// assert_eq!((touching.total(), touching.exerted(0).linear), (DVec3::Y * 3.0, DVec3::Y * -3.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ContactPoint {
    /// The number of the first body.
    pub a: usize,
    /// The number of the second body, which impulses push along the normal.
    pub b: usize,
    /// What is closest; of a row of a joint, the number of the joint as its face.
    pub feature: FeaturePair,
    /// Unit, from a to b.
    pub normal: DVec3,
    /// Two unit vectors that complete the normal.
    pub tangents: [DVec3; 2],
    /// Between the closest points.
    pub distance: f64,
    /// Not met yet: the normal is that of where flights will meet, the distance is what it is now along it.
    pub is_expected: bool,
    /// The distance that the pair keeps.
    pub gap: f64,
    /// From the center of mass of a to the middle of the closest points: both arms end there, so that impulses make no angular momentum.
    pub arm_a: DVec3,
    /// From that of b.
    pub arm_b: DVec3,
    /// Middle of the closest points.
    pub point: DVec3,
    /// What the two surfaces are to each other.
    pub material: Material,
    /// By how much the surface of b runs faster over its body than that of a, along the tangents.
    pub running: [f64; 2],
    /// None: a contact.
    pub row: Option<JointRow>,
    /// The impulse on b along the normal.
    pub impulse: f64,
    /// And along the tangents.
    pub sliding: [f64; 2],
}

impl ContactPoint {
    /// Two bodies that touch, without an impulse; the arms lead from their centers to where they do, the unit normal from a to b. It has no
    /// features (zeros) and no place: the point, the distance and the gap are zero.
    #[inline]
    #[must_use]
    pub fn new([a, b]: [usize; 2], [arm_a, arm_b]: [DVec3; 2], normal: DVec3, material: Material) -> Self {
        Self {
            a,
            b,
            feature: FeaturePair::VertexFace { vertex: 0, face: 0 },
            normal,
            tangents: tangents(normal),
            distance: 0.0,
            is_expected: false,
            gap: 0.0,
            arm_a,
            arm_b,
            point: DVec3::ZERO,
            material,
            running: [0.0; 2],
            row: None,
            impulse: 0.0,
            sliding: [0.0; 2],
        }
    }

    /// The rate at which the distance grows with these velocities of the two bodies.
    #[must_use]
    pub fn rate(&self, a: Velocity, b: Velocity) -> f64 {
        self.normal.dot(b.of_point(self.arm_b) - a.of_point(self.arm_a))
    }

    /// The number of the joint of which it is a row.
    #[must_use]
    pub fn joint(&self) -> Option<usize> {
        match (self.row, self.feature) {
            (Some(_), FeaturePair::VertexFace { face, .. }) => Some(face as usize),
            _ => None,
        }
    }

    /// The sizes that what was measured of it is computed from.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.point.length() + self.arm_a.length() + self.arm_b.length() + self.distance
    }

    /// By how much it may close in a flight that shares what room there is, at least.
    #[must_use]
    pub fn shared_room(&self) -> f64 {
        self.distance - SHARED * self.distance.min(self.gap)
    }

    /// An angular impulse on a body: two impulses at arms that are one apart. None: it is zero.
    #[must_use]
    pub fn couple(body: usize, angular: DVec3) -> Option<Self> {
        let impulse = angular.length();
        if !(impulse > 0.0 && impulse.is_finite()) {
            return None;
        }
        let [normal, arm] = tangents(angular / impulse);
        let (lo, hi) = (f64::NEG_INFINITY, f64::INFINITY);
        let law = Law::Range { lo, hi, softness: 0.0 };
        let none = Self::new([body; 2], [arm * 0.5, arm * -0.5], normal, Material::new(0.0, 0.0));
        Some(Self { row: Some(JointRow::still(law)), impulse, ..none })
    }

    /// The same contact of bodies that slip, without an impulse.
    #[must_use]
    pub fn without_friction(&self) -> Self {
        let material = Material { friction: 0.0, ..self.material };
        Self { material, impulse: 0.0, sliding: [0.0; 2], ..*self }
    }

    /// Along the normal and the tangents.
    #[must_use]
    pub fn impulses(&self) -> [f64; 3] {
        [self.impulse, self.sliding[0], self.sliding[1]]
    }

    /// What the impulse adds to the momenta of b if it acts at this arm.
    #[must_use]
    pub fn momenta(&self, arm: DVec3) -> Momenta {
        match self.row {
            Some(row) if row.is_angular => {
                Momenta { linear: DVec3::ZERO, angular: self.normal * self.impulse }
            }
            _ => Momenta::of_impulse(self.total(), arm),
        }
    }

    /// What the impulse adds to the momenta of the first body, or of the second one.
    #[must_use]
    pub fn exerted(&self, on: usize) -> Momenta {
        if on == 0 { -self.momenta(self.arm_a) } else { self.momenta(self.arm_b) }
    }

    /// The impulse on b.
    #[must_use]
    pub fn total(&self) -> DVec3 {
        self.normal * self.impulse + self.tangents[0] * self.sliding[0] + self.tangents[1] * self.sliding[1]
    }
}

/// Adds what the impulses of contacts do to the momenta of their bodies, each of which `place` finds in the list.
///
/// ```
/// use d2m_contact::{ContactPoint, Material, Momenta, add_impulses};
/// use glam::DVec3;
/// let arms = [DVec3::Y, DVec3::NEG_Y];
/// let pressed = ContactPoint { impulse: 2.0, ..ContactPoint::new([4, 7], arms, DVec3::Y, Material::new(0.0, 0.0)) };
/// let mut added = [Momenta::default(); 2];
/// add_impulses(&[pressed], &mut added, |body| if body == 4 { 0 } else { 1 });
/// assert_eq!(added.map(|momenta| momenta.linear.y), [-2.0, 2.0]);
/// ```
pub fn add_impulses(contacts: &[ContactPoint], added: &mut [Momenta], place: impl Fn(usize) -> usize) {
    for c in contacts {
        let (a, b) = (place(c.a), place(c.b));
        added[a] = added[a] + -c.momenta(c.arm_a);
        added[b] = added[b] + c.momenta(c.arm_b);
    }
}

/// Two unit vectors that make a right-handed frame with a unit normal (Duff et al. 2017).
///
/// ```
/// use glam::DVec3;
/// let [t, u] = d2m_contact::tangents(DVec3::Z);
/// assert_eq!(t.cross(u), DVec3::Z);
/// ```
#[inline]
#[must_use]
pub fn tangents(normal: DVec3) -> [DVec3; 2] {
    let sign = if normal.z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + normal.z);
    let b = normal.x * normal.y * a;
    [
        DVec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
        DVec3::new(b, sign + normal.y * normal.y * a, -normal.y),
    ]
}

/// A contact without friction of two bodies whose centers are one apart along y.
#[cfg(test)]
pub(crate) fn upright([a, b]: [usize; 2]) -> ContactPoint {
    let arms = [DVec3::Y * 0.5, DVec3::Y * -0.5];
    ContactPoint { gap: 1.0, ..ContactPoint::new([a, b], arms, DVec3::Y, Material::new(0.0, 0.0)) }
}
