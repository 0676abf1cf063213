//! Long work: on other threads, without the interpreter's lock, while the calling thread looks after signals and progress.

use crate::fault::Fault;
use d2m::bvh::{Canceller, QueryOptions};
use pyo3::intern;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;

/// How often signals are looked for: Ctrl-C ends a batch within 50 ms, and what is left of that is for the workers.
const PATIENCE: Duration = Duration::from_millis(10);

/// More threads than this are a mistake.
const MOST_THREADS: usize = 1024;

/// What the workers and the calling thread share.
#[derive(Default)]
pub(crate) struct Supervision {
    canceller: Canceller,
    done: AtomicUsize,
}

impl Supervision {
    /// Should the workers stop?
    pub(crate) fn is_cancelled(&self) -> bool {
        self.canceller.flag().is_cancelled()
    }

    /// The same options for queries that end when the workers should stop.
    pub(crate) fn cancels(&self, options: &QueryOptions) -> QueryOptions {
        options.with_budget(options.budget.with_cancel(self.canceller.flag()))
    }

    /// So many more are done.
    pub(crate) fn add_done(&self, count: usize) {
        self.done.fetch_add(count, Ordering::Relaxed);
    }

    /// So many are done, in all.
    pub(crate) fn set_done(&self, count: usize) {
        self.done.fetch_max(count, Ordering::Relaxed);
    }
}

/// A progress argument: `callable(done, total)`, or a bar with `update(n)` such as one of tqdm.
struct Progress<'a> {
    target: &'a Py<PyAny>,
    total: usize,
    shown: usize,
}

impl Progress<'_> {
    fn show(&mut self, py: Python<'_>, done: usize) -> PyResult<()> {
        if done == self.shown {
            return Ok(());
        }
        let target = self.target.bind(py);
        match target.getattr_opt(intern!(py, "update"))? {
            Some(update) => {
                update.call1((done - self.shown,))?;
            }
            None => {
                target.call1((done, self.total))?;
            }
        }
        self.shown = done;
        Ok(())
    }
}

/// What long work is to be called with.
#[derive(Default)]
pub(crate) struct Watch<'a> {
    /// Called with what is done.
    pub(crate) progress: Option<&'a Bound<'a, PyAny>>,
    /// How much there is.
    pub(crate) total: usize,
}

/// Runs `work` on a thread of its own; the calling one looks for signals and reports progress.
///
/// # Errors
/// The exception of a signal handler or of the progress callback; the work has ended by then.
pub(crate) fn supervised<T: Send>(
    py: Python<'_>,
    watch: &Watch<'_>,
    work: impl FnOnce(&Supervision) -> T + Send,
) -> PyResult<T> {
    let target = watch.progress.filter(|any| !any.is_none()).map(|any| any.clone().unbind());
    let total = watch.total;
    py.detach(|| {
        let supervision = Supervision::default();
        let mut progress = target.as_ref().map(|target| Progress { target, total, shown: 0 });
        let mut look = || {
            Python::attach(|py| {
                py.check_signals()?;
                let done = supervision.done.load(Ordering::Relaxed);
                progress.as_mut().map_or(Ok(()), |progress| progress.show(py, done))
            })
        };
        let mut failure = None;
        let result = std::thread::scope(|scope| {
            let (ended, end) = channel::<()>();
            let supervision = &supervision;
            let worker = scope.spawn(move || {
                // Dropped at the end, also that of a panic.
                let _ended = ended;
                work(supervision)
            });
            while end.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                if failure.is_none()
                    && let Err(error) = look()
                {
                    failure = Some(error);
                    supervision.canceller.cancel();
                }
            }
            worker.join()
        });
        let result = result.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        if failure.is_none() {
            failure = look().err();
        }
        failure.map_or(Ok(result), Err)
    })
}

/// The pool with so many threads, by default one a processor, of this process: a process that was forked has none of the threads of
/// its parent, so it gets pools of its own.
///
/// # Errors
/// The system gives no threads.
pub(crate) fn pool(threads: Option<usize>) -> Result<Arc<ThreadPool>, Fault> {
    type Pools = HashMap<(u32, usize), Arc<ThreadPool>>;
    static POOLS: OnceLock<Mutex<Pools>> = OnceLock::new();
    if let Some(count) = threads.filter(|count| !(1..=MOST_THREADS).contains(count)) {
        let message = format!("threads is {count}, it must be in [1, {MOST_THREADS}]");
        return Err(Fault::new(message).found(count as f64));
    }
    let count = threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
    let mut pools = POOLS.get_or_init(Mutex::default).lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(pool) = pools.get(&(std::process::id(), count)) {
        return Ok(Arc::clone(pool));
    }
    let pool = ThreadPoolBuilder::new().num_threads(count).build();
    let pool = Arc::new(pool.map_err(|error| Fault::new(format!("{count} threads: {error}")))?);
    pools.insert((std::process::id(), count), Arc::clone(&pool));
    Ok(pool)
}
