//! The memory of this process, where the system reports it: proc(5), Linux.

/// Bytes in use now.
pub(crate) fn resident() -> Option<u64> {
    bytes("VmRSS:")
}

/// Starts to count the largest use anew; bytes in use now.
pub(crate) fn restart_peak() -> Option<u64> {
    // Writing 5 there resets the peak: proc(5), clear_refs.
    std::fs::write("/proc/self/clear_refs", "5").ok()?;
    resident()
}

/// The largest use since then, in bytes; zero where the system does not report it.
pub(crate) fn peak() -> u64 {
    bytes("VmHWM:").unwrap_or(0)
}

fn bytes(key: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(key))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}
