//! The serde forms of keyframes, chains and of any of the motions: checked on the way in, faults with their place.
use crate::error::fault;
use crate::serde_form::{ConstantTwistForm, identity};
use crate::{
    AnyMotion, Chain, ConstantTwist, Joint, JointKind, JointPoints, JointValue, Keyframes, MotionError, Pose,
    Span,
};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// Every key of every form. Which of them may stand together is checked afterwards, so that a fault can say so.
#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct AnyForm {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    x: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    q: Option<[f64; 4]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    v: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    w: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    at: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    t: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    times: Option<Vec<f64>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    poses: Option<Vec<PoseForm>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    join: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    spans: Option<Vec<ConstantTwistForm>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    chain: Option<Vec<JointForm>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PoseForm {
    #[serde(default)]
    x: [f64; 3],
    #[serde(default = "identity")]
    q: [f64; 4],
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct JointForm {
    #[serde(default)]
    x: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    q: Option<[f64; 4]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    rpy: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    joint: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    axis: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    value: Option<ValueForm>,
}

fn quaternion([w, x, y, z]: [f64; 4]) -> DQuat {
    DQuat::from_xyzw(x, y, z, w)
}

/// A polynomial, pieces, or points.
#[derive(Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a polynomial [c0, c1, …], {\"times\", \"pieces\"} or {\"times\", \"positions\", \"velocities\", \"accelerations\"} and no other key"
)]
enum ValueForm {
    Polynomial(Vec<f64>),
    Pieces(PiecesForm),
    Points(JointPoints),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PiecesForm {
    times: Vec<f64>,
    pieces: Vec<Vec<f64>>,
}

impl From<&JointValue> for ValueForm {
    fn from(value: &JointValue) -> Self {
        if let Some(points) = value.points() {
            return Self::Points(points.clone());
        }
        let mut pieces: Vec<Vec<f64>> = value.pieces().map(<[f64]>::to_vec).collect();
        if value.times().is_empty() {
            Self::Polynomial(pieces.swap_remove(0))
        } else {
            Self::Pieces(PiecesForm { times: value.times().to_vec(), pieces })
        }
    }
}

impl Serialize for JointValue {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        ValueForm::from(self).serialize(serializer)
    }
}

impl TryFrom<ValueForm> for JointValue {
    type Error = MotionError;
    fn try_from(form: ValueForm) -> Result<Self, MotionError> {
        match form {
            ValueForm::Polynomial(coefficients) => Self::try_polynomial(coefficients),
            ValueForm::Pieces(PiecesForm { times, pieces }) => Self::try_pieces(times, pieces),
            ValueForm::Points(points) => Self::through(points),
        }
    }
}

impl<'de> Deserialize<'de> for JointValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        ValueForm::deserialize(deserializer)?.try_into().map_err(D::Error::custom)
    }
}

impl TryFrom<JointForm> for Joint {
    type Error = MotionError;
    fn try_from(form: JointForm) -> Result<Self, MotionError> {
        let JointForm { x, q, rpy, joint, axis, value } = form;
        let name = match (joint.as_deref(), &axis, &value) {
            (Some(name), ..) => name,
            (None, None, None) => "fixed",
            _ => return Err(fault("joint".into(), "it is missing: fixed, revolute or prismatic".into())),
        };
        let missing = |key: &str| fault(key.to_owned(), format!("a {name} joint needs it"));
        let surplus = |key: &str| fault(key.to_owned(), "a fixed joint has none".to_owned());
        let kind = match name {
            "fixed" => match (&axis, &value) {
                (None, None) => JointKind::Fixed,
                (Some(_), _) => return Err(surplus("axis")),
                (None, Some(_)) => return Err(surplus("value")),
            },
            "revolute" | "prismatic" => {
                let axis = DVec3::from_array(axis.ok_or_else(|| missing("axis"))?);
                let value = value.ok_or_else(|| missing("value"))?.try_into()?;
                if name == "revolute" {
                    JointKind::Revolute { axis, value }
                } else {
                    JointKind::Prismatic { axis, value }
                }
            }
            other => {
                let reason = format!("{other:?} is unknown: fixed, revolute or prismatic");
                return Err(fault("joint".into(), reason));
            }
        };
        let x = DVec3::from_array(x);
        match (q, rpy) {
            (Some(_), Some(_)) => Err(fault("rpy".into(), "q and rpy do not go together".into())),
            (q, None) => Self::try_new(x, quaternion(q.unwrap_or(identity())), kind),
            (None, Some(rpy)) => Self::try_with_rpy(x, rpy, kind),
        }
    }
}

impl From<&Joint> for JointForm {
    fn from(joint: &Joint) -> Self {
        let (name, axis, value) = match joint.kind() {
            JointKind::Fixed => ("fixed", None, None),
            JointKind::Revolute { axis, value } => ("revolute", Some(axis), Some(value)),
            JointKind::Prismatic { axis, value } => ("prismatic", Some(axis), Some(value)),
        };
        let q = joint.orientation();
        Self {
            x: joint.position().to_array(),
            q: joint.rpy().is_none().then_some([q.w, q.x, q.y, q.z]),
            rpy: joint.rpy(),
            joint: Some(name.to_owned()),
            axis: axis.map(DVec3::to_array),
            value: value.map(ValueForm::from),
        }
    }
}

impl TryFrom<Vec<JointForm>> for Chain {
    type Error = MotionError;
    fn try_from(forms: Vec<JointForm>) -> Result<Self, MotionError> {
        let joint = |(index, form): (usize, JointForm)| {
            Joint::try_from(form).map_err(|error| error.within(&format!("chain[{index}]")))
        };
        Self::try_new(forms.into_iter().enumerate().map(joint).collect::<Result<_, _>>()?)
    }
}

fn keyframes(form: AnyForm) -> Result<Keyframes, MotionError> {
    let AnyForm { times, poses, join, spans, .. } = form;
    let Some(times) = times else {
        return Err(fault("times".into(), "keyframes need it".into()));
    };
    match (poses, spans) {
        (Some(_), Some(_)) => Err(fault("spans".into(), "poses and spans do not go together".into())),
        (None, None) => Err(fault("poses".into(), "keyframes need it (or spans)".into())),
        (None, Some(spans)) => {
            if join.is_some() {
                return Err(fault("join".into(), "it belongs to poses, not to spans".into()));
            }
            let span = |(index, form): (usize, ConstantTwistForm)| {
                ConstantTwist::try_from(form).map_err(|error| error.within(&format!("spans[{index}]")))
            };
            let motions = spans.into_iter().enumerate().map(span).collect::<Result<_, _>>()?;
            Keyframes::try_from_spans(times, motions)
        }
        (Some(poses), None) => {
            let span = match join.as_deref() {
                None | Some("linear") => Span::Linear,
                Some("screw") => Span::Screw,
                Some(other) => {
                    return Err(fault("join".into(), format!("{other:?} is unknown: linear or screw")));
                }
            };
            if times.len() != poses.len() {
                let reason = format!("{} times for {} poses", times.len(), poses.len());
                return Err(fault("times".into(), reason));
            }
            let pose = |form: PoseForm| Pose {
                rotation: quaternion(form.q),
                translation: DVec3::from_array(form.x),
                at: DVec3::ZERO,
            };
            let frames: Vec<(f64, Pose)> = times.into_iter().zip(poses.into_iter().map(pose)).collect();
            Keyframes::try_new(&frames, span)
        }
    }
}

impl TryFrom<AnyForm> for AnyMotion {
    type Error = MotionError;
    fn try_from(form: AnyForm) -> Result<Self, MotionError> {
        let AnyForm { x, q, v, w, at, t, times, poses, join, spans, chain } = &form;
        let twist = [
            ("x", x.is_some()),
            ("q", q.is_some()),
            ("v", v.is_some()),
            ("w", w.is_some()),
            ("at", at.is_some()),
            ("t", t.is_some()),
        ];
        let frames = [
            ("times", times.is_some()),
            ("poses", poses.is_some()),
            ("join", join.is_some()),
            ("spans", spans.is_some()),
        ];
        let first =
            |keys: &[(&'static str, bool)]| keys.iter().find(|(_, given)| *given).map(|&(key, _)| key);
        let (twist, frames) = (first(&twist), first(&frames));
        let foreign =
            |key: &str, of: &str| fault(key.to_owned(), format!("this key does not belong to {of}"));
        if chain.is_some() {
            return match twist.or(frames) {
                Some(key) => Err(foreign(key, "a chain")),
                None => Chain::try_from(form.chain.unwrap_or_default()).map(Self::Chain),
            };
        }
        if frames.is_some() {
            return match twist {
                Some(key) => Err(foreign(key, "keyframes")),
                None => keyframes(form).map(Self::Keyframes),
            };
        }
        let form = ConstantTwistForm {
            x: form.x.unwrap_or_default(),
            q: form.q.unwrap_or(identity()),
            v: form.v.unwrap_or_default(),
            w: form.w.unwrap_or_default(),
            at: form.at.unwrap_or_default(),
            t: form.t.unwrap_or_default(),
        };
        ConstantTwist::try_from(form).map(Self::ConstantTwist)
    }
}

impl<'de> Deserialize<'de> for AnyMotion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        AnyForm::deserialize(deserializer)?.try_into().map_err(D::Error::custom)
    }
}

impl Serialize for AnyMotion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::ConstantTwist(motion) => motion.serialize(serializer),
            Self::Keyframes(motion) => motion.serialize(serializer),
            Self::Chain(motion) => motion.serialize(serializer),
        }
    }
}

/// The spans, also of keyframes that were made of poses: the motion to the last bit.
impl Serialize for Keyframes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let spans = self.motions().iter().map(ConstantTwistForm::from).collect();
        AnyForm { times: Some(self.times().to_vec()), spans: Some(spans), ..AnyForm::default() }
            .serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Keyframes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match AnyMotion::deserialize(deserializer)? {
            AnyMotion::Keyframes(keyframes) => Ok(keyframes),
            _ => Err(D::Error::custom("expected keyframes: \"times\" with \"poses\" or \"spans\"")),
        }
    }
}

impl Serialize for Chain {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let chain = self.joints().iter().map(JointForm::from).collect();
        AnyForm { chain: Some(chain), ..AnyForm::default() }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Chain {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match AnyMotion::deserialize(deserializer)? {
            AnyMotion::Chain(chain) => Ok(chain),
            _ => Err(D::Error::custom("expected a chain: \"chain\"")),
        }
    }
}
