//! A contact point with its impulse.

use super::law::Law;
use crate::body::momenta::Momenta;
use crate::body::velocity::Velocity;
use d2m_feature::FeaturePair;
use glam::DVec3;

/// The part of a distance that a flight leaves if it shares what room there is: more than the part at which it would meet, which is
/// one half, and 1/16 more.
const SHARED: f64 = 0.625;

/// How two bodies touch.
///
/// ```
/// # use std::sync::Arc;
/// # let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5")?));
/// use d2m_dynamics::{Body, Simulation, SimulationOptions};
/// use glam::DVec3;
/// let mut simulation = Simulation::new(SimulationOptions::default())?;
/// let ice = simulation.add(&Body::new("ice", Arc::clone(&cube)).with_friction(0.1))?;
/// let rubber = Body::new("rubber", cube).with_friction(0.9).with_restitution(0.7).with_position(DVec3::Y * 2.0);
/// let rubber = simulation.add(&rubber)?;
/// let pair = simulation.pair(ice, rubber);
/// assert_eq!((pair.friction, pair.restitution), (0.5, 0.7)); // the mean, and the greater one
/// simulation.set_pair(ice, rubber, 0.0, 0.2)?; // known better
/// assert_eq!(simulation.pair(rubber, ice).friction, 0.2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// Coefficient of restitution, from 0 to 1.
    pub restitution: f64,
    /// Coulomb's coefficient of friction, not negative.
    pub friction: f64,
}

/// A row of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JointRow {
    /// Of the turn about the normal, instead of the way along it.
    pub(crate) is_angular: bool,
    pub(crate) law: Law,
    /// The rate that impulses see to, and that of the flight, which also takes back what the joint is off.
    pub(crate) pushing: f64,
    pub(crate) target: f64,
    /// The number of the joint and of its equation, whose rate follows from where the flight ends.
    pub(crate) equation: Option<[usize; 2]>,
    /// Of a motor, whose impulses of a step add up.
    pub(crate) is_motor: bool,
}

/// A pair of closest features of two bodies, and the impulse between them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactPoint {
    /// Body numbers.
    pub(crate) a: usize,
    pub(crate) b: usize,
    pub(crate) feature: FeaturePair,
    /// Unit, from a to b.
    pub(crate) normal: DVec3,
    /// Two unit vectors that complete the normal.
    pub(crate) tangents: [DVec3; 2],
    pub(crate) distance: f64,
    /// Not met yet: the normal is that of where flights will meet, the distance is what it is now along it.
    pub(crate) is_expected: bool,
    /// The distance that the pair keeps.
    pub(crate) gap: f64,
    /// From the centers of mass to one point, so that impulses there make no angular momentum: the middle of the closest points.
    pub(crate) arm_a: DVec3,
    pub(crate) arm_b: DVec3,
    /// Middle of the closest points.
    pub(crate) point: DVec3,
    pub(crate) material: Material,
    /// By how much the surface of b runs faster over its body than that of a, along the tangents.
    pub(crate) running: [f64; 2],
    /// None: a contact.
    pub(crate) row: Option<JointRow>,
    /// Impulses on b along the normal and the tangents.
    pub(crate) impulse: f64,
    pub(crate) sliding: [f64; 2],
}

impl ContactPoint {
    /// The rate at which the distance grows with these velocities of the two bodies.
    pub(crate) fn rate(&self, a: Velocity, b: Velocity) -> f64 {
        self.normal.dot(b.of_point(self.arm_b) - a.of_point(self.arm_a))
    }

    /// The number of the joint of which it is a row.
    pub(crate) fn joint(&self) -> Option<usize> {
        match (self.row, self.feature) {
            (Some(_), FeaturePair::VertexFace { face, .. }) => Some(face as usize),
            _ => None,
        }
    }

    /// The sizes that what was measured of it is computed from.
    pub(crate) fn size(&self) -> f64 {
        self.point.length() + self.arm_a.length() + self.arm_b.length() + self.distance
    }

    /// By how much it may close in a flight that shares what room there is, at least.
    pub(crate) fn shared_room(&self) -> f64 {
        self.distance - SHARED * self.distance.min(self.gap)
    }

    /// An angular impulse on a body: two impulses at arms that are one apart. None: it is zero.
    pub(crate) fn couple(body: usize, angular: DVec3) -> Option<Self> {
        let impulse = angular.length();
        if !(impulse > 0.0 && impulse.is_finite()) {
            return None;
        }
        let [normal, arm] = tangents(angular / impulse);
        let (lo, hi) = (f64::NEG_INFINITY, f64::INFINITY);
        let law = Law::Range { lo, hi, softness: 0.0 };
        Some(Self {
            a: body,
            b: body,
            feature: FeaturePair::VertexFace { vertex: 0, face: 0 },
            normal,
            tangents: tangents(normal),
            distance: 0.0,
            is_expected: false,
            gap: 0.0,
            arm_a: arm * 0.5,
            arm_b: arm * -0.5,
            point: DVec3::ZERO,
            material: Material { restitution: 0.0, friction: 0.0 },
            running: [0.0; 2],
            row: Some(JointRow {
                is_angular: false,
                law,
                pushing: 0.0,
                target: 0.0,
                equation: None,
                is_motor: false,
            }),
            impulse,
            sliding: [0.0; 2],
        })
    }

    /// The same contact of bodies that slip, without an impulse.
    pub(crate) fn without_friction(&self) -> Self {
        let material = Material { friction: 0.0, ..self.material };
        Self { material, impulse: 0.0, sliding: [0.0; 2], ..*self }
    }

    /// Along the normal and the tangents.
    pub(crate) fn impulses(&self) -> [f64; 3] {
        [self.impulse, self.sliding[0], self.sliding[1]]
    }

    /// What the impulse adds to the momenta of b if it acts at this arm.
    pub(crate) fn momenta(&self, arm: DVec3) -> Momenta {
        match self.row {
            Some(row) if row.is_angular => {
                Momenta { linear: DVec3::ZERO, angular: self.normal * self.impulse }
            }
            _ => Momenta::of_impulse(self.total(), arm),
        }
    }

    /// What the impulse adds to the momenta of the first body, or of the second one.
    pub(crate) fn exerted(&self, on: usize) -> Momenta {
        if on == 0 { -self.momenta(self.arm_a) } else { self.momenta(self.arm_b) }
    }

    /// The impulse on b.
    pub(crate) fn total(&self) -> DVec3 {
        self.normal * self.impulse + self.tangents[0] * self.sliding[0] + self.tangents[1] * self.sliding[1]
    }
}

/// Adds what the impulses of contacts do to the momenta of their bodies, each of which `place` finds in the list.
pub(crate) fn add(contacts: &[ContactPoint], added: &mut [Momenta], place: impl Fn(usize) -> usize) {
    for c in contacts {
        let (a, b) = (place(c.a), place(c.b));
        added[a] = added[a] + -c.momenta(c.arm_a);
        added[b] = added[b] + c.momenta(c.arm_b);
    }
}

/// Two unit vectors that make a right-handed frame with a unit normal (Duff et al. 2017).
pub(crate) fn tangents(normal: DVec3) -> [DVec3; 2] {
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
    let normal = DVec3::Y;
    ContactPoint {
        a,
        b,
        feature: FeaturePair::VertexFace { vertex: 0, face: 0 },
        normal,
        tangents: tangents(normal),
        distance: 0.0,
        is_expected: false,
        gap: 1.0,
        arm_a: normal * 0.5,
        arm_b: normal * -0.5,
        point: DVec3::ZERO,
        material: Material { restitution: 0.0, friction: 0.0 },
        running: [0.0; 2],
        row: None,
        impulse: 0.0,
        sliding: [0.0; 2],
    }
}
