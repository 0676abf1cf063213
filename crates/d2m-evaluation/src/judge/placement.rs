//! Where the bodies are at a time, in plain f64 with the platform's sine: the judge's own evaluation.
use crate::trials::{Movement, Trial};
use glam::{DMat3, DQuat, DVec3};

/// A rigid placement: r ↦ rotation·r + position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    pub(crate) rotation: DQuat,
    pub(crate) matrix: DMat3,
    pub(crate) position: DVec3,
}

impl Placement {
    pub(crate) fn new(rotation: DQuat, position: DVec3) -> Self {
        let rotation = rotation.normalize();
        Self { rotation, matrix: DMat3::from_quat(rotation), position }
    }

    /// The other placement seen from this one: this⁻¹ ∘ other.
    pub(crate) fn relative(&self, other: &Self) -> Self {
        let inverse = self.rotation.conjugate();
        Self::new(inverse * other.rotation, inverse * (other.position - self.position))
    }

    pub(crate) fn apply(&self, point: DVec3) -> DVec3 {
        self.matrix * point + self.position
    }
}

/// The body's placement at time t.
pub(crate) fn place(movement: &Movement, t: f64) -> Placement {
    Placement::new(turned(movement, t), movement.position + movement.velocity * t)
}

fn turned(movement: &Movement, t: f64) -> DQuat {
    DQuat::from_scaled_axis(movement.angular_velocity * t) * movement.rotation.normalize()
}

impl Trial {
    /// Both placements at time t in a frame that moves with A's origin: far from the origin of the world, or far from
    /// the meeting place, doubles resolve less than the separations that are judged.
    pub(crate) fn places(&self, t: f64) -> [Placement; 2] {
        let (apart, speed) = (self.b.position - self.a.position, self.b.velocity - self.a.velocity);
        let position = speed.mul_add(DVec3::splat(t), apart);
        [Placement::new(turned(&self.a, t), DVec3::ZERO), Placement::new(turned(&self.b, t), position)]
    }

    /// A bound on how fast the distance of two bodies of these radii about their origins can change.
    pub(crate) fn bound_speed(&self, radius_a: f64, radius_b: f64) -> f64 {
        let centers = (self.b.velocity - self.a.velocity).length();
        centers + self.a.angular_velocity.length() * radius_a + self.b.angular_velocity.length() * radius_b
    }
}
