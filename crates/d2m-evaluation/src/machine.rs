//! On what, and on which code, figures were measured.
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::process::Command;

/// A machine and the state of the code.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Machine {
    pub(crate) cpu: String,
    pub(crate) cores: usize,
    /// Of the vector extensions that matter here, those that the processor has.
    pub(crate) extensions: Vec<String>,
    pub(crate) system: String,
    pub(crate) rustc: String,
    pub(crate) commit: String,
    pub(crate) commit_date: String,
    /// Were there changes of code that are in no commit?
    pub(crate) is_dirty: bool,
    /// Load average of the last minute when the run began, where the system reports it.
    #[serde(default)]
    pub(crate) load: Option<f64>,
}

impl Machine {
    pub(crate) fn this(root: &Path) -> Self {
        // Words and results change no answer and no time.
        let code = ["status", "--porcelain", "--untracked-files=no", "--", ":!docs", ":!*.md", ":!*.csv"];
        let status = output(root, "git", &code);
        Self {
            cpu: cpu(),
            cores: std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
            extensions: extensions(),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            rustc: output(root, "rustc", &["--version"]).unwrap_or_else(|| "unknown".into()),
            commit: output(root, "git", &["rev-parse", "--short=12", "HEAD"])
                .unwrap_or_else(|| "unknown".into()),
            commit_date: output(root, "git", &["log", "-1", "--format=%cs"]).unwrap_or_default(),
            is_dirty: status.is_none_or(|text| !text.is_empty()),
            load: load(),
        }
    }

    /// In names of folders.
    pub(crate) fn slug(&self) -> String {
        slug(&format!("{} {} cores", self.cpu, self.cores))
    }
}

fn output(root: &Path, program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).current_dir(root).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_string())
}

fn cpu() -> String {
    let linux = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = linux
        .lines()
        .find_map(|l| l.strip_prefix("model name")?.split_once(':').map(|p| p.1.trim().to_string()));
    name.or_else(|| output(Path::new("."), "sysctl", &["-n", "machdep.cpu.brand_string"]))
        .or_else(|| std::env::var("PROCESSOR_IDENTIFIER").ok())
        .unwrap_or_else(|| std::env::consts::ARCH.into())
}

fn load() -> Option<f64> {
    std::fs::read_to_string("/proc/loadavg").ok()?.split_whitespace().next()?.parse().ok()
}

#[cfg(target_arch = "x86_64")]
fn extensions() -> Vec<String> {
    let all = [
        ("avx", std::is_x86_feature_detected!("avx")),
        ("avx2", std::is_x86_feature_detected!("avx2")),
        ("fma", std::is_x86_feature_detected!("fma")),
        ("avx512f", std::is_x86_feature_detected!("avx512f")),
        ("avx512vl", std::is_x86_feature_detected!("avx512vl")),
    ];
    all.iter().filter(|e| e.1).map(|e| e.0.to_string()).collect()
}

#[cfg(not(target_arch = "x86_64"))]
fn extensions() -> Vec<String> {
    Vec::new()
}

/// Letters, digits and single dashes.
pub(crate) fn slug(name: &str) -> String {
    let mut text = String::new();
    for c in name.chars() {
        if c.is_ascii_alphanumeric() || c == '_' || c == '.' {
            text.push(c.to_ascii_lowercase());
        } else if !text.ends_with('-') {
            text.push('-');
        }
    }
    text.trim_matches('-').into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slugs() {
        assert_eq!(slug("pebble/pebble 1.1 M"), "pebble-pebble-1.1-m");
        assert_eq!(slug("AMD EPYC (2)"), "amd-epyc-2");
    }
}
