//! The time that a thread has run, which other work on the machine does not lengthen.
use std::time::Duration;

/// For how long this thread has run: the first number of proc(5)'s schedstat. `None` where the system does not say.
pub fn processor_time() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(Duration::from_nanos(text.split(' ').next()?.parse().ok()?))
}
