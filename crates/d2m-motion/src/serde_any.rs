//! The serde forms of keyframes, chains and of any of the motions: checked on the way in, faults with their place.
use crate::error::fault;
use crate::serde_form::{ConstantTwistForm, identity};
use crate::spline::Knot;
use crate::{
    AnyMotion, Chain, ConstantTwist, Joint, JointKind, JointPoints, JointValue, Keyframes, MotionError, Pose,
    Span, Spline, SplineDegree, Twist, serde_object,
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
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "serde_object::list")]
    poses: Option<Vec<PoseForm>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    join: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "serde_object::list")]
    twists: Option<Vec<TwistForm>>,
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "serde_object::list")]
    spans: Option<Vec<ConstantTwistForm>>,
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "serde_object::list")]
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

/// Velocities at a pose of a spline.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TwistForm {
    #[serde(default)]
    v: [f64; 3],
    #[serde(default)]
    w: [f64; 3],
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
    Pieces(#[serde(deserialize_with = "serde_object::one")] PiecesForm),
    Points(#[serde(deserialize_with = "serde_object::one")] JointPoints),
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

/// The poses of keyframes or of a spline at their times.
fn posed_at(times: Vec<f64>, poses: Vec<PoseForm>) -> Result<Vec<(f64, Pose)>, MotionError> {
    if times.len() != poses.len() {
        return Err(fault("times".into(), format!("{} times for {} poses", times.len(), poses.len())));
    }
    let pose = |form: PoseForm| Pose {
        rotation: quaternion(form.q),
        translation: DVec3::from_array(form.x),
        at: DVec3::ZERO,
    };
    Ok(times.into_iter().zip(poses.into_iter().map(pose)).collect())
}

/// The degree of a spline that a word stands for.
fn degree_of(join: Option<&str>) -> Option<SplineDegree> {
    match join {
        Some("cubic") => Some(SplineDegree::Cubic),
        Some("quintic") => Some(SplineDegree::Quintic),
        _ => None,
    }
}

fn spline(form: AnyForm, degree: SplineDegree) -> Result<Spline, MotionError> {
    let AnyForm { times, poses, twists, spans, .. } = form;
    if spans.is_some() {
        return Err(fault("join".into(), "it belongs to poses, not to spans".into()));
    }
    let missing = |key: &str| fault(key.to_owned(), "a spline needs it".into());
    let times = times.ok_or_else(|| missing("times"))?;
    let frames = posed_at(times, poses.ok_or_else(|| missing("poses"))?)?;
    let Some(twists) = twists else { return Spline::try_through(&frames, degree) };
    if twists.len() != frames.len() {
        return Err(fault("twists".into(), format!("{} twists for {} poses", twists.len(), frames.len())));
    }
    let twist = |form: TwistForm| Twist { linear: form.v.into(), angular: form.w.into() };
    let frames: Vec<(f64, Pose, Twist)> =
        frames.into_iter().zip(twists).map(|((time, pose), form)| (time, pose, twist(form))).collect();
    Spline::try_with_twists(&frames, degree)
}

fn keyframes(form: AnyForm) -> Result<Keyframes, MotionError> {
    let AnyForm { times, poses, join, spans, twists, .. } = form;
    if twists.is_some() && matches!(join.as_deref(), None | Some("linear" | "screw")) {
        return Err(fault("twists".into(), "they belong to splines, with the join cubic or quintic".into()));
    }
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
                    return Err(fault(
                        "join".into(),
                        format!("{other:?} is unknown: linear, screw, cubic or quintic"),
                    ));
                }
            };
            let frames = posed_at(times, poses)?;
            Keyframes::try_new(&frames, span)
        }
    }
}

impl TryFrom<AnyForm> for AnyMotion {
    type Error = MotionError;
    fn try_from(form: AnyForm) -> Result<Self, MotionError> {
        let AnyForm { x, q, v, w, at, t, times, poses, join, twists, spans, chain } = &form;
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
            ("twists", twists.is_some()),
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
            return match (twist, degree_of(join.as_deref())) {
                (Some(key), _) => Err(foreign(key, "keyframes")),
                (None, Some(degree)) => spline(form, degree).map(Self::Spline),
                (None, None) => keyframes(form).map(Self::Keyframes),
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
        serde_object::one::<AnyForm, D>(deserializer)?.try_into().map_err(D::Error::custom)
    }
}

impl Serialize for AnyMotion {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::ConstantTwist(motion) => motion.serialize(serializer),
            Self::Keyframes(motion) => motion.serialize(serializer),
            Self::Chain(motion) => motion.serialize(serializer),
            Self::Spline(motion) => motion.serialize(serializer),
        }
    }
}

/// Poses and twists of the body origin: the motion to the last bit.
impl Serialize for Spline {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let pose = |knot: &Knot| {
            let q = knot.pose.rotation;
            PoseForm { x: knot.pose.translation.to_array(), q: [q.w, q.x, q.y, q.z] }
        };
        let twist =
            |knot: &Knot| TwistForm { v: knot.twist.linear.to_array(), w: knot.twist.angular.to_array() };
        let join = match self.degree() {
            SplineDegree::Cubic => "cubic",
            SplineDegree::Quintic => "quintic",
        };
        AnyForm {
            times: Some(self.times().to_vec()),
            poses: Some(self.knots().iter().map(pose).collect()),
            twists: Some(self.knots().iter().map(twist).collect()),
            join: Some(join.to_owned()),
            ..AnyForm::default()
        }
        .serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Spline {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match AnyMotion::deserialize(deserializer)? {
            AnyMotion::Spline(spline) => Ok(spline),
            _ => Err(D::Error::custom("expected a spline: \"poses\" with the join cubic or quintic")),
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
