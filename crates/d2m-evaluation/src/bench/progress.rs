//! How much work is left, for the bar, and what the bar says.
use super::Options;
use super::catalogue::Entry;
use super::method::Method;
use super::store::Store;
use super::sweep::Step;
use indicatif::{ProgressBar, ProgressStyle};

/// The parts of a run, in order: what matters most comes first, so that a run that is stopped has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// The engine and its static queries on every pair.
    Engine,
    /// The series.
    Series,
    /// The reference method and the peers on every pair, each until its cap.
    Peers,
}

impl Part {
    pub(super) const ALL: [Self; 3] = [Self::Engine, Self::Series, Self::Peers];

    /// For a reader.
    const fn title(self) -> &'static str {
        match self {
            Self::Engine => "1 of 3, the engine",
            Self::Series => "2 of 3, series",
            Self::Peers => "3 of 3, reference and peers",
        }
    }

    /// Is this method asked in this part?
    pub(super) fn asks(self, method: Method) -> bool {
        match self {
            Self::Engine => !method.is_slow(),
            Self::Series => false,
            Self::Peers => method.is_slow(),
        }
    }
}

/// Files of one pair that the store lacks, by speed and method.
pub(super) fn open(store: &Store, entry: &Entry, part: Part, methods: &[Method]) -> Vec<(f64, Method)> {
    let asked = || methods.iter().copied().filter(|&m| part.asks(m));
    let all = entry.trials.iter().flat_map(|(speed, _)| asked().map(move |m| (*speed, m)));
    all.filter(|(speed, method)| store.load(&entry.name, *speed, method.name()).is_none()).collect()
}

/// About how long the trees of a pair take, in seconds on a quiet machine of 2.5 GHz. Only the bar believes this and
/// the following.
pub(super) fn tree_seconds(entry: &Entry) -> f64 {
    0.05 + 4e-6 * entry.triangles_about() as f64
}

/// About how long a method is busy with the trials of one pair and speed.
pub(super) fn ask_seconds(options: &Options, method: Method, trials: usize) -> f64 {
    let judge = if method.is_static() { 0.0 } else { 0.006 * trials as f64 };
    let rest = if method.is_slow() { options.cap() } else { 2e-4 * (options.rounds * trials) as f64 };
    judge + rest
}

/// The bar of a run over what is expected to take this long; it learns the true pace as it goes.
pub(super) struct Progress(ProgressBar);

impl Progress {
    pub(super) fn new(seconds: f64) -> Self {
        let style = ProgressStyle::with_template("{bar:24} {percent} %, {eta} left  {msg}");
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        Self(ProgressBar::new(milliseconds(seconds)).with_style(style))
    }

    /// Seconds of everything that is open.
    pub(super) fn plan(
        options: &Options,
        store: &Store,
        entries: &[Entry],
        methods: &[Method],
        steps: &[Step],
    ) -> f64 {
        let mut seconds: f64 = steps.iter().map(|step| step.seconds).sum();
        for part in Part::ALL {
            for entry in entries {
                let open = open(store, entry, part, methods);
                let count = entry.trials.first().map_or(0, |t| t.1.len());
                let asked: f64 = open.iter().map(|o| ask_seconds(options, o.1, count)).sum();
                seconds += asked + if open.is_empty() { 0.0 } else { tree_seconds(entry) };
            }
        }
        seconds
    }

    /// What is done now, and about how long it takes.
    pub(super) fn begin(&self, part: Part, what: &str, seconds: f64) {
        self.0.set_message(format!("({}) {what}, about {seconds:.0} s", part.title()));
    }

    /// What is done now.
    pub(super) fn tell(&self, what: &str) {
        self.0.set_message(what.to_owned());
    }

    /// Adds to the part of the expected time that has passed.
    pub(super) fn done(&self, seconds: f64) {
        self.0.inc(milliseconds(seconds));
    }

    /// A line above the bar, or on stdout where there is none.
    pub(super) fn say(&self, text: &str) {
        if self.0.is_hidden() { println!("{text}") } else { self.0.println(text) }
    }

    pub(super) fn end(&self) {
        self.0.finish_and_clear();
    }
}

fn milliseconds(seconds: f64) -> u64 {
    (1e3 * seconds) as u64
}
