//! The serde forms of the motion types: the same keys as the text form, checked on the way in.
use crate::{ConstantTwist, MotionError, ScrewMotion, serde_object};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ConstantTwistForm {
    #[serde(default)]
    pub(crate) x: [f64; 3],
    #[serde(default = "identity")]
    pub(crate) q: [f64; 4],
    #[serde(default)]
    pub(crate) v: [f64; 3],
    #[serde(default)]
    pub(crate) w: [f64; 3],
    #[serde(default, skip_serializing_if = "is_zero")]
    pub(crate) at: [f64; 3],
    #[serde(default, skip_serializing_if = "is_zero_time")]
    pub(crate) t: f64,
}

pub(crate) const fn identity() -> [f64; 4] {
    [1.0, 0.0, 0.0, 0.0]
}

fn is_zero(v: &[f64; 3]) -> bool {
    *v == [0.0; 3]
}

#[allow(clippy::trivially_copy_pass_by_ref)] // serde calls it with a reference
fn is_zero_time(t: &f64) -> bool {
    *t == 0.0
}

impl From<&ConstantTwist> for ConstantTwistForm {
    fn from(m: &ConstantTwist) -> Self {
        let q = m.orientation();
        Self {
            x: m.position().to_array(),
            q: [q.w, q.x, q.y, q.z],
            v: m.linear_velocity().to_array(),
            w: m.angular_velocity().to_array(),
            at: m.at().to_array(),
            t: m.reference_time(),
        }
    }
}

impl TryFrom<ConstantTwistForm> for ConstantTwist {
    type Error = MotionError;
    fn try_from(form: ConstantTwistForm) -> Result<Self, MotionError> {
        let [w, x, y, z] = form.q;
        let (position, orientation) = (DVec3::from_array(form.x), DQuat::from_xyzw(x, y, z, w));
        ConstantTwist::try_new(position, orientation, DVec3::from_array(form.v), DVec3::from_array(form.w))?
            .try_with_at(DVec3::from_array(form.at))?
            .try_with_reference_time(form.t)
    }
}

impl Serialize for ConstantTwist {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        ConstantTwistForm::from(self).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for ConstantTwist {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        serde_object::one::<ConstantTwistForm, D>(deserializer)?.try_into().map_err(D::Error::custom)
    }
}

/// A screw is stored as its constant twist and checked to be one again.
impl Serialize for ScrewMotion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.as_constant_twist().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for ScrewMotion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        ScrewMotion::try_from_constant_twist(ConstantTwist::deserialize(deserializer)?)
            .map_err(D::Error::custom)
    }
}
