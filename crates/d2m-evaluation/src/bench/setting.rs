//! The questions of one pair, speed and method: asked on one thread, then judged on all.
use super::body::Pair;
use super::clock::Phases;
use super::method::{Answer, Method, Question, answers};
use super::row::Row;
use super::{Options, peers};
use crate::judge::{Claim, Judge, place};
use crate::trials::Trial;
use rayon::prelude::*;

type Error = Box<dyn std::error::Error>;

/// Answers of parry that are compared with the judge's, per pair, speed and method: it is slow.
const PARRY_CHECKS: usize = 4;
/// Triangles of a pair beyond which parry's distance is not asked: one query then takes from seconds to minutes.
const PARRY_TRIANGLES: usize = 20_000;
/// And the paper's method: its trees and queries are made for models of the paper's size.
const PAPER_TRIANGLES: usize = 300_000;
/// How far parry's distance may be from ours: it iterates to a tolerance of about this on its own.
const PARRY_AGREES: f64 = 1e-7;

/// One file's worth of questions.
pub(super) struct Setting<'a> {
    pub(super) options: &'a Options,
    pub(super) pair: &'a Pair,
    pub(super) speed: f64,
    pub(super) trials: &'a [Trial],
    pub(super) method: Method,
    /// For each trial, the time before which an earlier answer, found right, said that nothing touches.
    pub(super) known: &'a [f64],
}

impl Setting<'_> {
    pub(super) fn rows(&self, accurate: Option<&[Row]>, phases: &mut Phases) -> Result<Vec<Row>, Error> {
        match self.method {
            Method::AdvanceParry | Method::ParryDistance if self.triangle_count() > PARRY_TRIANGLES => {
                return Ok(Vec::new());
            }
            Method::Paper if self.triangle_count() > PAPER_TRIANGLES => return Ok(Vec::new()),
            _ => {}
        }
        let places = self.places(accurate);
        let questions: Vec<Question<'_>> = places
            .iter()
            .map(|&(trial, at)| {
                Question::new(self.pair, &self.trials[trial], self.options.tolerance, at)
                    .map(|question| question.with_cap(self.options.cap()))
            })
            .collect::<Result<_, Error>>()?;
        phases.time("lazy trees", || self.prepare());
        // One thread asks and nothing else runs; only then all threads judge.
        let answers = phases.time("asked", || answers(&questions, self.method, self.options));
        let trials: Vec<usize> = places.iter().map(|&(trial, _)| trial).collect();
        Ok(phases.time("judged", || self.judged(&trials, answers)))
    }

    /// Builds what the method needs of the bodies and others do not.
    fn prepare(&self) {
        for body in [&self.pair.a, &self.pair.b] {
            match self.method {
                Method::Paper => {
                    body.spheres();
                }
                Method::AdvanceParry | Method::ParryIntersection | Method::ParryDistance => {
                    body.parry();
                }
                _ => {}
            }
        }
    }

    fn triangle_count(&self) -> usize {
        self.pair.a.triangle_count() + self.pair.b.triangle_count()
    }

    /// Which trials, and the time for static methods: only those that end in contact.
    fn places(&self, accurate: Option<&[Row]>) -> Vec<(usize, f64)> {
        if !self.method.is_static() {
            return (0..self.trials.len()).map(|i| (i, 0.0)).collect();
        }
        let rows = accurate.unwrap_or_default();
        let contact = |row: &Row| match row.claim {
            Claim::Contact { lo, .. } if row.fault.is_empty() => Some((row.trial, lo)),
            _ => None,
        };
        rows.iter().filter_map(contact).collect()
    }

    /// The rows of the answers on these trials; a slow method may have answered the first ones only.
    fn judged(&self, trials: &[usize], answers: Vec<Answer>) -> Vec<Row> {
        let sabotage = self.options.sabotage.filter(|_| self.method == Method::Accurate);
        let mut rows: Vec<Row> = trials
            .par_iter()
            .zip(answers)
            .map(|(&trial, Answer { claim, microseconds })| {
                let claim = sabotage.map_or(claim, |fault| fault.spoil(claim));
                let verdict = if self.method.is_static() {
                    Ok(f64::INFINITY)
                } else {
                    let known = self.known.get(trial).copied().unwrap_or_default();
                    self.judge(&self.trials[trial]).check_after(known, &claim, self.method.is_exact())
                };
                Row::judged(trial, claim, microseconds, verdict)
            })
            .collect();
        if self.method.is_ours()
            && self.method != Method::AdvanceOwn
            && self.triangle_count() <= PARRY_TRIANGLES
        {
            self.ask_parry(&mut rows);
        }
        rows
    }

    fn judge<'a>(&'a self, trial: &'a Trial) -> Judge<'a> {
        Judge { a: &self.pair.a.boxes, b: &self.pair.b.boxes, trial }
    }

    /// The second opinion on the separation, on some trials.
    fn ask_parry(&self, rows: &mut [Row]) {
        let contacts: Vec<(&mut Row, f64)> = rows
            .iter_mut()
            .filter_map(|row| match row.claim {
                Claim::Contact { lo, .. } if row.separation.is_finite() => Some((row, lo)),
                _ => None,
            })
            .take(PARRY_CHECKS)
            .collect();
        contacts.into_par_iter().for_each(|(row, lo)| {
            let trial = &self.trials[row.trial];
            let (at_a, at_b) = (place(&trial.a, lo), place(&trial.b, lo));
            row.parry_separation = peers::distance(self.pair.a.parry(), self.pair.b.parry(), &at_a, &at_b);
            if (row.parry_separation - row.separation).abs() > PARRY_AGREES {
                row.fault = format!("parry measures a separation of {:.3e}", row.parry_separation);
            }
        });
    }
}
