//! Pairs that are in contact at the start and are let go: no first contact says so.

use crate::output::{printable, short};
use d2m::bvh::{
    Moving, QueryOptions, Start, StartState, TimeBracket, TimeOfContact, Window, departure, time_of_contact,
};
use d2m_io::{start_in_json, start_word};
use serde_json::{Value, json};

/// From when on the answer to a pair counts.
pub(crate) enum Beginning {
    /// From the start: the pair is not to leave, or begins apart.
    Start,
    /// Once the bodies had parted.
    Parted(LetGo),
    /// The pair is to leave, and is not proven to have parted in the window.
    NotParted,
}

impl Beginning {
    /// Of a pair.
    pub(crate) fn of(
        names: [&str; 2],
        [a, b]: [Moving<'_>; 2],
        window: Window,
        options: &QueryOptions,
    ) -> Self {
        if options.start != Start::Leave || at_start([a, b], window, options) == StartState::Apart {
            return Self::Start;
        }
        match departure(a, b, window, options) {
            Ok(parting) if parting.start == StartState::Apart => Self::Start,
            Ok(parting) => parting.left.map_or(Self::NotParted, |left| {
                Self::Parted(LetGo { names: names.map(str::to_owned), start: parting.start, left })
            }),
            // The search for contacts had the same bodies and refused them.
            Err(_) => Self::NotParted,
        }
    }

    /// What was let go and has parted.
    pub(crate) const fn let_go(&self) -> Option<&LetGo> {
        match self {
            Self::Parted(let_go) => Some(let_go),
            Self::Start | Self::NotParted => None,
        }
    }
}

/// Two bodies that were in contact at the start, and when they had parted.
pub(crate) struct LetGo {
    names: [String; 2],
    start: StartState,
    /// They are proven apart at its end.
    pub(crate) left: TimeBracket,
}

impl LetGo {
    /// For a program.
    pub(crate) fn json(&self) -> Value {
        let Self { names: [a, b], start, left } = self;
        let proven = *start != StartState::Undecided;
        json!({ "a": a, "b": b, "start": start_in_json(*start), "start_proven": proven, "left": left })
    }

    /// For a person.
    pub(crate) fn words(&self) -> String {
        let Self { names, start, left } = self;
        let [a, b] = names.each_ref().map(|name| printable(name));
        format!("{a} \u{2013} {b}: {} at the start, proven apart at {}", start_word(*start), short(left.hi))
    }
}

/// How two bodies stand at the start.
pub(crate) fn at_start([a, b]: [Moving<'_>; 2], window: Window, options: &QueryOptions) -> StartState {
    let options = options.with_start(Start::Report);
    let now = Window::try_new(window.start(), window.start());
    match now.ok().map(|now| time_of_contact(a, b, now, &options)) {
        Some(Ok(TimeOfContact::Contact(contact))) => contact.start,
        Some(Ok(TimeOfContact::Separated)) => StartState::Apart,
        _ => StartState::Undecided,
    }
}

/// What is said of a certificate where pairs are let go, also where the time was used up before they were
/// proven to have parted.
pub(crate) fn exception(beginnings: &[Beginning]) -> &'static str {
    let is_from_start = beginnings.iter().all(|beginning| matches!(beginning, Beginning::Start));
    if is_from_start { "" } else { ", but for what was in contact at the start until it had parted" }
}
