//! Pairs that are in contact at the start, are let go and do not meet again: no contact says so.

use crate::output::short;
use crate::report::{start_in_json, start_word};
use d2m::bvh::{
    Moving, QueryOptions, Start, StartState, TimeBracket, TimeOfContact, Window, departure, time_of_contact,
};
use serde_json::{Value, json};

/// Two bodies that were in contact at the start, and when they had parted.
pub(super) struct LetGo {
    names: [String; 2],
    start: StartState,
    left: TimeBracket,
}

impl LetGo {
    /// What became of a pair; none if it is not to leave, begins apart or does not part.
    pub(super) fn of(
        names: [&str; 2],
        [a, b]: [Moving<'_>; 2],
        window: Window,
        options: &QueryOptions,
    ) -> Option<Self> {
        if options.start != Start::Leave || at_start([a, b], window, options) == StartState::Apart {
            return None;
        }
        let parting = departure(a, b, window, options).ok()?;
        let left = parting.left.filter(|_| parting.start != StartState::Apart)?;
        Some(Self { names: names.map(str::to_owned), start: parting.start, left })
    }

    /// For a program.
    pub(super) fn json(&self) -> Value {
        let Self { names: [a, b], start, left } = self;
        let proven = *start != StartState::Undecided;
        json!({ "a": a, "b": b, "start": start_in_json(*start), "start_proven": proven, "left": left })
    }

    /// For a person.
    pub(super) fn words(&self) -> String {
        let Self { names: [a, b], start, left } = self;
        format!("{a} \u{2013} {b}: {} at the start, proven apart at {}", start_word(*start), short(left.hi))
    }
}

/// How two bodies stand at the start.
pub(super) fn at_start([a, b]: [Moving<'_>; 2], window: Window, options: &QueryOptions) -> StartState {
    let options = options.with_start(Start::Report);
    let now = Window::try_new(window.start(), window.start());
    match now.ok().map(|now| time_of_contact(a, b, now, &options)) {
        Some(Ok(TimeOfContact::Contact(contact))) => contact.start,
        Some(Ok(TimeOfContact::Separated)) => StartState::Apart,
        _ => StartState::Undecided,
    }
}

/// What is said of a certificate where pairs are let go.
pub(super) const fn exception(let_go: &[LetGo]) -> &'static str {
    if let_go.is_empty() { "" } else { ", but for what was in contact at the start until it had parted" }
}
