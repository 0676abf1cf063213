//! What an audit prints.
use super::Options;
use crate::TaskResult;
use d2m::audit::{Findings, Tally};
use indicatif::{ProgressBar, ProgressStyle};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// Lines of open conclusions that are shown.
const MOST_OPEN: usize = 8;

/// Counts of the whole run.
pub(super) struct Report {
    all: Findings,
    families: BTreeMap<&'static str, Tally>,
    begin: Instant,
    claims: u64,
    time: Option<Duration>,
    progress: ProgressBar,
}

impl Report {
    pub(super) fn new(options: &Options) -> Self {
        let style = ProgressStyle::with_template(
            "{bar:30} {human_pos}/{human_len} judged, {per_sec}, {eta} left  {msg}",
        );
        let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
        let progress = ProgressBar::new(options.claims).with_style(style);
        let time = options.seconds.map(Duration::from_secs_f64);
        let (all, families) = (Findings::default(), BTreeMap::new());
        Self { all, families, begin: Instant::now(), claims: options.claims, time, progress }
    }

    /// Adds what one case of a family gave; is it enough?
    pub(super) fn add(&mut self, family: &'static str, found: &Findings) -> bool {
        self.families.entry(family).or_default().merge(&found.total());
        for (place, tally) in &found.places {
            self.all.places.entry(*place).or_default().merge(tally);
        }
        for line in &found.refuted {
            self.progress.suspend(|| println!("REFUTED  {line}"));
        }
        self.all.refuted.extend_from_slice(&found.refuted);
        let room = MOST_OPEN.saturating_sub(self.all.open.len());
        self.all.open.extend(found.open.iter().take(room).cloned());
        let judged = self.all.total().judged;
        self.progress.set_position(judged);
        self.progress.set_message(format!("{} refuted", self.all.total().refuted));
        judged >= self.claims || self.time.is_some_and(|time| self.begin.elapsed() >= time)
    }

    /// # Errors
    /// A conclusion that is false.
    pub(super) fn finish(self) -> TaskResult {
        self.progress.finish_and_clear();
        let head = |first: &str| {
            println!(
                "{first:<26} {:>12} {:>10} {:>10} {:>8}  unproven",
                "reported", "judged", "verified", "refuted"
            );
        };
        head("family");
        for (family, tally) in &self.families {
            println!("{}", row(family, tally));
        }
        head("place");
        for (place, tally) in &self.all.places {
            println!("{}", row(place.name(), tally));
        }
        let total = self.all.total();
        println!("{}", row("all", &total));
        for line in &self.all.open {
            println!("open  {line}");
        }
        let seconds = self.begin.elapsed().as_secs_f64();
        println!(
            "{} conclusions reported, {} of them judged in {seconds:.1} s ({:.0} a second)",
            total.reported,
            total.judged,
            total.judged as f64 / seconds
        );
        if total.refuted == 0 {
            return Ok(());
        }
        Err(format!(
            "{} conclusions are false: again with cargo xtask accuracy audit and the options above",
            total.refuted
        )
        .into())
    }
}

fn row(name: &str, tally: &Tally) -> String {
    let reasons: Vec<String> =
        tally.unproven.iter().map(|(reason, count)| format!("{reason:?} {count}")).collect();
    let Tally { reported, judged, verified, refuted, .. } = tally;
    format!("{name:<26} {reported:>12} {judged:>10} {verified:>10} {refuted:>8}  {}", reasons.join(", "))
}
