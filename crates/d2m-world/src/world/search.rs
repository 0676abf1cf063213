//! The narrow phase: pairs in the order of the times at which they may meet first, in rounds.
//!
//! The rounds have fixed sizes and every pair of a round is searched up to the same time, so the answers do not depend on
//! which thread is done first.

use super::pair_state::{Entry, Known, PairState};
use super::schedule::{MeetingSpan, Prepared, Rules};
use super::{Threads, World, WorldError};
use crate::batches::PAIRS;
use crate::box_tree::IndexPair;
#[cfg(feature = "audit")]
use d2m_bvh::audit::Place;
use d2m_bvh::{
    Contact, Meter, PairCache, QueryError, QueryOptions, Start, StartState, TimeBracket, TimeOfContact,
    Window, time_of_contact_with,
};
use d2m_mesh::parallel::map_in_order;
use std::collections::HashSet;

/// Pairs of the first round; each round is twice as long as the one before, so what is searched beyond the first contact
/// is at most about as much as what had to be searched.
const FIRST_ROUND: usize = 2;
/// Pairs of a round at most: enough for many threads.
const LONGEST_ROUND: usize = 256;
/// The same where every pair is searched anyway: all threads wait for the last pair of a round, and progress is reported then.
const ROUND_OF_ALL: usize = 1024;

/// A query of one pair.
struct Question {
    pair: IndexPair,
    entry: Entry,
    window: Window,
    /// Without a contact in the window the pair is proven free up to here.
    clear_until: f64,
    /// End of the span that the boxes hold for.
    clear_after: f64,
    options: QueryOptions,
    cache: PairCache,
    kind: Kind,
}

/// What is to be found of a pair.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Its first contact.
    Usual,
    /// The same: it would be let go if it were in contact at the start, but the boxes prove it apart then.
    BeginsApart,
    /// Its first contact after it has parted. The answer holds for this window alone and is not kept.
    Departure,
}

/// What came of it.
struct Reply {
    answer: Result<TimeOfContact, QueryError>,
    cache: PairCache,
    /// In node tests.
    work: u64,
}

/// When to stop.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Goal {
    First,
    All,
}

/// What a search has found so far.
#[derive(Default)]
pub(super) struct Finding {
    pub(super) contacts: Vec<(IndexPair, Contact)>,
    /// Pairs that could not be decided, and until when each is free.
    pub(super) undecided: Vec<(IndexPair, f64)>,
    /// Pairs that were judged: each once a search.
    seen: HashSet<IndexPair>,
    /// Entries that later queries need again.
    kept: Vec<Entry>,
}

impl Finding {
    /// The earliest contact, and of several the one of the smallest places.
    pub(super) fn best(&self) -> Option<&(IndexPair, Contact)> {
        let rank = |(pair, contact): &(IndexPair, Contact)| (contact.time_lo, *pair);
        self.contacts.iter().min_by(|x, y| {
            let (x, y) = (rank(x), rank(y));
            x.0.total_cmp(&y.0).then_with(|| x.1.cmp(&y.1))
        })
    }

    /// The budget is used up: these pairs are free until their windows begin.
    fn give_up(&mut self, questions: Vec<Question>) {
        for question in questions {
            self.undecided.push((question.pair, question.window.start()));
            self.kept.push(question.entry);
        }
    }

    /// The pair that is undecided first, and of several the one of the smallest places.
    pub(super) fn first_undecided(&self) -> Option<(IndexPair, f64)> {
        let earlier =
            |x: &&(IndexPair, f64), y: &&(IndexPair, f64)| x.1.total_cmp(&y.1).then_with(|| x.0.cmp(&y.0));
        self.undecided.iter().min_by(earlier).copied()
    }
}

/// The contact of bodies that were apart at that time already, where that is of interest.
const fn with_start(mut contact: Contact, apart_at: Option<f64>) -> Contact {
    if let Some(time) = apart_at {
        contact.left = Some(TimeBracket { lo: time, hi: time });
    }
    contact
}

impl World {
    /// What pairs meet in the window: the first contact, or those of all.
    pub(super) fn search(
        &mut self,
        window: Window,
        goal: Goal,
        progress: &dyn Fn(usize, usize),
    ) -> Result<Finding, WorldError> {
        self.prepare(window)?;
        let mut finding = Finding::default();
        let mut meter = Meter::new(&self.options.budget);
        // Node tests are spent pair after pair, so that no thread's turn counts. The clock is the same for all.
        let is_limited = self.options.budget.node_tests.is_some();
        let mut round = match goal {
            _ if is_limited => 1,
            Goal::First => FIRST_ROUND,
            // Every pair is searched over the whole window, whatever the others give.
            Goal::All => ROUND_OF_ALL,
        };
        let outcome = loop {
            let best = finding.best().filter(|_| goal == Goal::First);
            let at_start =
                |contact: &Contact| contact.time_lo <= window.start() && contact.start != StartState::Apart;
            if best.is_some_and(|(_, contact)| at_start(contact)) {
                break Ok(());
            }
            let limit = best.map_or(window.end(), |(_, contact)| contact.time_hi.min(window.end()));
            let questions = self.next_round(window, limit, round, &mut finding);
            if questions.is_empty() {
                break Ok(());
            }
            if meter.is_exhausted() {
                finding.give_up(questions);
                // What was known of a pair may free it for longer than its place in the queue says: others may be earlier.
                let earliest = finding.first_undecided().map_or(limit, |(_, until)| until);
                if goal == Goal::First && !self.schedule.may_begin_before(earliest) {
                    break Ok(());
                }
                continue;
            }
            if let Err(error) = self.answer(questions, &mut meter, &mut finding) {
                break Err(error);
            }
            progress(finding.seen.len(), finding.seen.len() + self.schedule.waiting());
            if !is_limited {
                round = (2 * round).min(LONGEST_ROUND).max(round);
            }
        };
        for entry in core::mem::take(&mut finding.kept) {
            self.schedule.push(entry);
        }
        #[cfg(feature = "audit")]
        if outcome.is_ok() {
            self.conclude_left_out();
        }
        outcome.map(|()| finding)
    }

    fn prepare(&mut self, window: Window) -> Result<(), WorldError> {
        let mut changed = core::mem::take(&mut self.changed);
        changed.sort_unstable();
        changed.dedup();
        let rules = Rules { slots: &self.slots, filter: &self.filter, options: &self.options };
        // After a failure everything is made anew, also what changed.
        let prepared = self.schedule.prepare(rules, window, &changed);
        let prepared = prepared.map_err(|uncovered| self.uncovered(uncovered))?;
        if prepared == Prepared::Anew && !self.states.is_empty() {
            let pairs = self.schedule.pairs();
            self.states.retain(|pair, _| pairs.binary_search(pair).is_ok());
        }
        for pair in core::mem::take(&mut self.changed_pairs) {
            self.schedule.push_pair(rules, pair);
        }
        Ok(())
    }

    /// The next questions in the order of their times; contacts that are known already go to the finding.
    fn next_round(
        &mut self,
        window: Window,
        limit: f64,
        most: usize,
        finding: &mut Finding,
    ) -> Vec<Question> {
        let mut questions: Vec<Question> = Vec::with_capacity(most);
        while questions.len() < most {
            let Some(entry) = self.schedule.pop(&self.slots, limit) else { break };
            let pair = entry.pair;
            // Twins of an entry: after a search, or after a change of the pair's separation.
            if !finding.seen.insert(pair) {
                continue;
            }
            let rules = self.rules();
            let separation = rules.separation(pair);
            if rules.filter.ignores(pair, rules.slots.groups(pair)) {
                continue;
            }
            let Some(meeting) = self.schedule.meeting_span(rules, pair) else {
                #[cfg(feature = "audit")]
                if let Some(end) = self.schedule.end() {
                    self.conclude(Place::BroadPhase, pair, [self.schedule.from(), end]);
                }
                continue;
            };
            #[cfg(feature = "audit")]
            if meeting.start > self.schedule.from() {
                self.conclude(Place::BroadPhase, pair, [self.schedule.from(), meeting.start]);
            }
            let leaves = rules.filter.start(pair, self.options.start) == Start::Leave;
            if leaves && meeting.start <= window.start() {
                // Whether and when they part is a question about the whole window.
                questions.push(self.departure_of(entry, window, separation));
                continue;
            }
            let state = self.states.get(&pair);
            let valid = state.filter(|state| {
                state.versions == entry.versions
                    && state.separation == separation
                    && state.from <= window.start()
            });
            let mut start = meeting.start.max(window.start());
            match valid.map(|state| &state.known) {
                Some(Known::Contact(contact)) if contact.time_lo >= window.start() => {
                    finding.kept.push(entry);
                    if contact.time_lo <= limit {
                        let begin = window.start();
                        finding.contacts.push((pair, with_start(**contact, leaves.then_some(begin))));
                    }
                    continue;
                }
                Some(&Known::ClearUntil(until)) if until >= meeting.clear_after => continue,
                Some(&Known::ClearUntil(until)) if until >= limit => {
                    finding.kept.push(Entry { time: until, ..entry });
                    continue;
                }
                Some(&Known::ClearUntil(until)) => start = start.max(until),
                Some(Known::Contact(_) | Known::Nothing) | None => {}
            }
            if start > limit {
                finding.kept.push(Entry { time: start, ..entry });
                continue;
            }
            let MeetingSpan { end, clear_after, .. } = meeting;
            let (end, clear_until) = if end <= limit { (end, clear_after) } else { (limit, limit) };
            // No window at all: the boxes part before the pair need be queried.
            let Ok(window) = Window::try_new(start, end) else { continue };
            let options = self.options.with_min_separation(separation).with_start(Start::Report);
            let cache = state.map_or_else(PairCache::new, |state| *state.cache);
            let kind = if leaves { Kind::BeginsApart } else { Kind::Usual };
            questions.push(Question { pair, entry, window, clear_until, clear_after, options, cache, kind });
        }
        questions
    }

    /// The question when a pair parts that may be in contact at the start, and what it meets then.
    fn departure_of(&self, entry: Entry, window: Window, separation: f64) -> Question {
        let options = self.options.with_min_separation(separation).with_start(Start::Leave);
        Question {
            pair: entry.pair,
            entry,
            window,
            clear_until: window.end(),
            clear_after: window.end(),
            options,
            cache: PairCache::new(),
            kind: Kind::Departure,
        }
    }

    /// Answers the questions of a round and keeps what is proven.
    fn answer(
        &mut self,
        questions: Vec<Question>,
        meter: &mut Meter,
        finding: &mut Finding,
    ) -> Result<(), WorldError> {
        // The boxes prove what lies between the start of the query and that of a pair's own window.
        let span_start = self.schedule.from();
        let (slots, rest) = (&self.slots, meter.rest());
        let least = match self.threads {
            Threads::All => PAIRS,
            Threads::Own => usize::MAX,
        };
        let replies = map_in_order(&questions, least, |question| {
            let mut cache = question.cache;
            let work_before = cache.work();
            let [Some(a), Some(b)] = question.pair.map(|place| slots.at(place)) else {
                return Reply { answer: Ok(TimeOfContact::Separated), cache, work: 0 };
            };
            let options = question.options.with_budget(rest);
            let answer = time_of_contact_with(a.moving(), b.moving(), question.window, &options, &mut cache);
            Reply { answer, work: cache.work() - work_before, cache }
        });
        let mut failure = None;
        for (question, reply) in questions.into_iter().zip(replies) {
            // Also a pair that is answered at once costs something.
            meter.spend(reply.work.max(1));
            let Question { pair, entry, window, clear_until, clear_after, options, kind, .. } = question;
            if kind == Kind::Departure && reply.answer.is_ok() {
                finding.kept.push(entry);
                match reply.answer {
                    Ok(TimeOfContact::Contact(contact)) => finding.contacts.push((pair, contact)),
                    Ok(TimeOfContact::Undecided { clear_until }) => {
                        finding.undecided.push((pair, clear_until));
                    }
                    Ok(TimeOfContact::Separated) | Err(_) => {}
                }
                continue;
            }
            let known = match reply.answer {
                Err(error) => {
                    let [a, b] = pair.map(|place| self.slots.id(place));
                    failure = failure.or(Some(WorldError::Pair { a, b, error }));
                    finding.kept.push(entry);
                    continue;
                }
                Ok(TimeOfContact::Separated) => {
                    // Free to the end of the span: nothing to do until one of the bodies changes.
                    if clear_until < clear_after {
                        finding.kept.push(Entry { time: clear_until, ..entry });
                    }
                    Known::ClearUntil(clear_until)
                }
                Ok(TimeOfContact::Undecided { clear_until }) => {
                    finding.undecided.push((pair, clear_until));
                    finding.kept.push(Entry { time: clear_until, ..entry });
                    // Free before that time: the last number before it is proven.
                    let until = clear_until.next_down();
                    if until >= window.start() { Known::ClearUntil(until) } else { Known::Nothing }
                }
                Ok(TimeOfContact::Contact(mut contact)) => {
                    if window.start() > span_start {
                        // Proven apart before its own question begins, and so at the start of this one.
                        contact.start = StartState::Apart;
                    }
                    let begin = (kind == Kind::BeginsApart).then_some(span_start);
                    finding.contacts.push((pair, with_start(contact, begin)));
                    finding.kept.push(Entry { time: contact.time_lo, ..entry });
                    // How bodies meet at the start takes a search of its own: one that the budget may have ended is to be made again.
                    if contact.start != StartState::Apart && meter.is_exhausted() {
                        Known::Nothing
                    } else {
                        Known::Contact(Box::new(contact))
                    }
                }
            };
            #[cfg(feature = "audit")]
            if let Known::ClearUntil(until) = known {
                self.conclude(Place::WorldPair, pair, [span_start, until]);
            }
            let (versions, separation) = (entry.versions, options.min_separation);
            let state =
                PairState { versions, separation, from: span_start, known, cache: Box::new(reply.cache) };
            self.states.insert(pair, state);
        }
        failure.map_or(Ok(()), Err)
    }
}
