//! Many edges of a robot.

use crate::fault::Fault;
use crate::path_answer::meeting;
use crate::record::{EDGE_WORDS, write_edge};
use crate::supervise::Supervision;
use d2m_robot::EdgeChecker;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Edges from one row of numbers to another.
pub(crate) struct EdgeBatch<'a> {
    pub(crate) from: &'a [f64],
    pub(crate) to: &'a [f64],
    /// Numbers of a row.
    pub(crate) width: usize,
    /// Of the bodies, by name.
    pub(crate) places: &'a HashMap<&'a str, u32>,
}

impl EdgeBatch<'_> {
    /// All edges, in parallel; the fault of the first edge that has one, at any number of threads.
    pub(crate) fn run(
        &self,
        edges: &EdgeChecker<'_>,
        supervision: &Supervision,
        out: &mut [u64],
    ) -> Result<(), Fault> {
        let Self { from, to, width, places } = *self;
        let first: Mutex<Option<(usize, Fault)>> = Mutex::new(None);
        let failed = AtomicUsize::new(usize::MAX);
        out.par_chunks_mut(EDGE_WORDS).enumerate().for_each(|(edge, words)| {
            if supervision.is_cancelled() || edge > failed.load(Ordering::Relaxed) {
                return;
            }
            let at = edge * width..(edge + 1) * width;
            match edges.check(&from[at.clone()], &to[at]) {
                Ok(found) => write_edge(&meeting(&found, places), words),
                Err(error) => {
                    failed.fetch_min(edge, Ordering::Relaxed);
                    let mut first = first.lock().unwrap_or_else(PoisonError::into_inner);
                    if first.as_ref().is_none_or(|(other, _)| edge < *other) {
                        *first = Some((edge, error.into()));
                    }
                }
            }
            supervision.add_done(1);
        });
        match first.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some((edge, fault)) => Err(fault.within(&format!("edge {edge}")).at(edge)),
            None => Ok(()),
        }
    }
}
