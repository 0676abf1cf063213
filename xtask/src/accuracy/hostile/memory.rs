//! The largest memory that this process had at once, where the system tells it (Linux).

/// Starts to count anew; how many bytes are in use now.
pub(super) fn restart_peak() -> Option<u64> {
    // Writing 5 there resets the peak: proc(5), clear_refs.
    std::fs::write("/proc/self/clear_refs", "5").ok()?;
    kilobytes("VmRSS:")
}

/// The largest use since then; zero where the system does not tell it.
pub(super) fn peak() -> u64 {
    kilobytes("VmHWM:").unwrap_or(0)
}

fn kilobytes(key: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with(key))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? * 1024)
}
