//! Peers outside of Rust, if `crates/d2m-evaluation/peers/run_all.py` was run: what their rows in `.bench/peers` come to.
use super::parts::round;
use super::text;
use crate::bench::{Method, Store};
use crate::judge::Claim;
use crate::statistics::Summary;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

type Error = Box<dyn std::error::Error>;

const FILE: &str = "peers.csv";
const HEADER: &str =
    "peer,on,queries,contacts,late,median_difference,worst_difference,time_median,time_worst";

/// What one peer did on one set of questions. A difference is that of its time of contact from ours.
#[derive(Debug, Default)]
struct Found {
    queries: usize,
    /// Of them those that are compared with ours.
    compared: usize,
    contacts: usize,
    /// Contacts missed, or later than ours by more than [`LATE`].
    late: usize,
    differences: Vec<f64>,
    microseconds: Vec<f64>,
}

/// Of the window: what rounding of either side explains.
const LATE: f64 = 1e-9;

impl Found {
    /// `ours` is infinite where there is no contact; NaN where the peer is only timed.
    fn note(&mut self, toc: f64, ours: f64, microseconds: f64) {
        self.queries += 1;
        self.microseconds.push(microseconds);
        if ours.is_nan() {
            return;
        }
        self.compared += 1;
        self.contacts += usize::from(toc.is_finite());
        self.late += usize::from(toc > ours + LATE);
        if toc.is_finite() && ours.is_finite() {
            self.differences.push((toc - ours).abs());
        }
    }

    fn line(self, peer: &str, on: &str) -> String {
        let queries = self.queries;
        let [contacts, late] = [self.contacts, self.late]
            .map(|count| if self.compared > 0 { count.to_string() } else { String::new() });
        let number = |values: Vec<f64>, pick: [fn(&Summary) -> f64; 2]| {
            let summary = Summary::of(values);
            pick.map(|f| summary.as_ref().map_or(String::new(), |s| format!("{:.4e}", f(s)))).join(",")
        };
        let pick: [fn(&Summary) -> f64; 2] = [|s| s.median, |s| s.worst];
        let (differences, times) = (number(self.differences, pick), number(self.microseconds, pick));
        format!("{peer},{on},{queries},{contacts},{late},{differences},{times}")
    }
}

/// A row of a peer on a trial of the bench, with our answer to it.
struct BenchTrial {
    /// The pair and its speed.
    on: String,
    ours: f64,
    our_microseconds: f64,
    numbers: Vec<f64>,
}

impl BenchTrial {
    /// `pair,speed,trial,` and numbers. None where the store has no right answer of ours.
    fn of(store: &Store, line: &str) -> Option<Self> {
        let fields: Vec<&str> = line.split(',').collect();
        let [pair, speed, trial, numbers @ ..] = &fields[..] else { return None };
        let numbers = numbers.iter().filter_map(|f| f.parse().ok()).collect();
        let (speed, trial) = (speed.parse::<f64>().ok()?, trial.parse::<usize>().ok()?);
        let accurate = store.load(pair, speed, Method::Accurate.name()).unwrap_or_default();
        let row = accurate.iter().find(|row| row.trial == trial && row.fault.is_empty())?;
        let ours = if let Claim::Contact { lo, .. } = row.claim { lo } else { f64::INFINITY };
        Some(Self {
            on: format!("{pair} at speed {speed}"),
            ours,
            our_microseconds: row.microseconds,
            numbers,
        })
    }

    fn note(&self, file: &str, found: &mut BTreeMap<(&str, String), Found>) {
        let mut note = |peer, toc, ours, clock| {
            found.entry((peer, self.on.clone())).or_default().note(toc, ours, clock);
        };
        let (ours, nan) = (self.ours, f64::NAN);
        match (file, &self.numbers[..]) {
            ("fcl.csv", &[toc, clock, distance, continuous, continuous_clock]) => {
                note("FCL: advancement to 1e-9 over its distance", toc, ours, clock);
                note("FCL: one distance, mean over the advancement", nan, nan, distance);
                note("FCL: continuousCollide between the end poses", continuous, ours, continuous_clock);
                note("d2m accurate", ours, ours, self.our_microseconds);
            }
            ("pqp.csv", &[toc, clock, collision, distance]) => {
                note("PQP: advancement to 1e-9 over its distance", toc, ours, clock);
                if toc.is_finite() {
                    note("PQP: one collision at the time of contact", nan, nan, collision);
                    note("PQP: one distance at the time of contact", nan, nan, distance);
                }
            }
            ("c2a.csv", &[toc, clock, _]) => note("C2A: as it comes, tolerance 1e-4", toc, ours, clock),
            ("c2a-near.csv", &[toc, clock, _]) => note("C2A: tolerance 1e-9", toc, ours, clock),
            _ => {}
        }
    }
}

/// Sums up the rows of the peers, against our answers to the same questions in the store.
pub(super) fn collect(store: &Store, folder: &Path) -> Result<(), Error> {
    let Some(rows) = store.folder.parent().map(|parent| parent.join("peers")) else { return Ok(()) };
    let mut found: BTreeMap<(&str, String), Found> = BTreeMap::new();
    for file in ["fcl.csv", "pqp.csv", "c2a.csv", "c2a-near.csv"] {
        for line in text(&rows, file).lines().skip(1) {
            if let Some(trial) = BenchTrial::of(store, line) {
                trial.note(file, &mut found);
            }
        }
    }
    for line in text(&rows, "ipc.csv").lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let n: Vec<f64> = fields.iter().filter_map(|f| f.parse().ok()).collect();
        let &[_, rescaling, planted, toc, clock, ours, own_clock] = &n[..] else { continue };
        let mut note = |peer, toc: f64, clock| {
            // A pair may touch before the planted contact: the earlier of the two is the truth to both.
            found.entry((peer, "planted vertex/face".into())).or_default().note(
                toc,
                planted.min(ours),
                clock,
            );
        };
        if rescaling == 0.8 {
            note("IPC Toolkit: nonlinear point_triangle_ccd as it comes", toc, clock);
            note("d2m features", ours, own_clock);
        } else {
            note("IPC Toolkit: the same with conservative_rescaling 0.999", toc, clock);
        }
    }
    if found.is_empty() {
        return Ok(());
    }
    let lines = found.into_iter().map(|((peer, on), found)| found.line(peer, &on) + "\n");
    Ok(std::fs::write(folder.join(FILE), format!("{HEADER}\n{}", lines.collect::<String>()))?)
}

/// The section of the page.
pub(super) fn write(page: &mut String, folder: &Path) -> Result<(), Error> {
    let table = text(folder, FILE);
    if table.is_empty() {
        return Ok(());
    }
    writeln!(page, "### Peers outside of Rust\n")?;
    writeln!(
        page,
        "From `crates/d2m-evaluation/peers/run_all.py`: the same meshes, trials and machine. Late: a contact missed, or later than \
        ours by more than {LATE:e}.\n"
    )?;
    writeln!(
        page,
        "| peer | on | queries | contacts | late | median, worst difference of times | µs, median | worst |"
    )?;
    writeln!(page, "|---|---|---|---|---|---|---|---|")?;
    for line in table.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [peer, on, queries, contacts, late, middle, most, median, worst] = fields[..] else { continue };
        let number = |f: &str| f.parse::<f64>().ok();
        let times = |f: &str| number(f).map_or("–".into(), round);
        let count = |f: &str| if f.is_empty() { "–".into() } else { f.to_string() };
        let small = |f: &str| number(f).map_or("–".into(), |v| format!("{v:.1e}"));
        writeln!(
            page,
            "| {peer} | {on} | {queries} | {} | {} | {}, {} | {} | {} |",
            count(contacts),
            count(late),
            small(middle),
            small(most),
            times(median),
            times(worst)
        )?;
    }
    Ok(writeln!(page)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn late_and_missed_contacts_are_counted() {
        let mut found = Found::default();
        let none = f64::INFINITY;
        for (toc, ours) in [(0.5, 0.5), (0.4, 0.5), (0.6, 0.5), (none, 0.5), (none, none)] {
            found.note(toc, ours, 10.0);
        }
        assert_eq!((found.queries, found.contacts, found.late), (5, 3, 2));
        let line = found.line("p", "pair");
        assert_eq!(line, "p,pair,5,3,2,1.0000e-1,1.0000e-1,1.0000e1,1.0000e1");
        let mut blind = Found::default();
        blind.note(none, 0.5, 3.0);
        assert_eq!(blind.line("p", "q"), "p,q,1,0,1,,,3.0000e0,3.0000e0", "a peer that finds nothing misses");
        let mut timed = Found::default();
        timed.note(f64::NAN, f64::NAN, 3.0);
        assert_eq!(timed.line("p", "q"), "p,q,1,,,,,3.0000e0,3.0000e0", "only timed: nothing is compared");
    }
}
