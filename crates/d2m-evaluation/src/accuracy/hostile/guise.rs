//! One motion in several types: what the library knows of it differs, the answer must not.
use d2m::motion::{Composed, ConstantTwist, Keyframes, Retimed, RigidMotion};
use d2m_testing::{Opaque, OpaqueWithState};
use glam::{DQuat, DVec3};

/// How a constant twist is given to the library.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Guise {
    /// As what it is.
    ConstantTwist,
    /// A type of the user's, which gives enclosures only.
    Enclosures,
    /// A type of the user's, which gives its state at a time too.
    States,
    /// The same twist in two spans.
    Spans,
    /// After a motion that rests at the origin.
    Composed,
    /// Reversed twice.
    Reversed,
}

impl Guise {
    /// All but the plain one. The last one rounds times, the others are exactly the same motion.
    pub(crate) const OTHERS: [Self; 5] =
        [Self::Enclosures, Self::States, Self::Spans, Self::Composed, Self::Reversed];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::ConstantTwist => "constant twist",
            Self::Enclosures => "enclosures",
            Self::States => "states",
            Self::Spans => "two spans",
            Self::Composed => "composed",
            Self::Reversed => "reversed twice",
        }
    }

    pub(crate) fn from_name(name: &str) -> Option<Self> {
        Self::OTHERS.into_iter().chain([Self::ConstantTwist]).find(|guise| guise.name() == name)
    }

    /// The motion over a window in this type; `None` where the type can't hold it.
    pub(crate) fn of(self, twist: ConstantTwist, window: [f64; 2]) -> Option<Box<dyn RigidMotion + Send>> {
        Some(match self {
            Self::ConstantTwist => Box::new(twist),
            Self::Enclosures => Box::new(Opaque(twist)),
            Self::States => Box::new(OpaqueWithState(twist)),
            Self::Spans => {
                let [start, end] = window;
                let before = (start - (end - start)).min(start.next_down());
                let after = (end + (end - start)).max(end.next_up());
                let middle = 0.5 * (start + end);
                let times = vec![before, middle, after];
                Box::new(Keyframes::try_from_spans(times, vec![twist, twist]).ok()?)
            }
            Self::Composed => {
                let rest = ConstantTwist::try_new(DVec3::ZERO, DQuat::IDENTITY, DVec3::ZERO, DVec3::ZERO);
                Box::new(Composed::new(rest.ok()?, twist))
            }
            Self::Reversed => {
                let [start, end] = window;
                let once = Retimed::try_reversed(twist, start, end).ok()?;
                Box::new(Retimed::try_reversed(once, start, end).ok()?)
            }
        })
    }
}
