//! What became of the faults when they were made last: `docs/results/mutants.md`.
use super::Error;
use super::program::End;
use super::table::Mutant;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

/// Where the table is, seen from the root of the workspace.
const PATH: &str = "docs/results/mutants.md";

const HEAD: &str = "# Deliberate faults, and what noticed them

Written by `cargo xtask mutants`; do not edit. A row is what the last run made of a fault, rows of earlier runs stay. Killed by a *test*; by a
*verdict*, where the verifier refuses an answer; or by the *audit* of what the engine concludes on its way. Faults without a row have not been
made since the table is kept. What each of them changes: `xtask/mutants/`.
";

/// What became of a mutant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outcome {
    Killed,
    /// A fault that hangs is noticed, too.
    KilledByHanging,
    /// The test makes the fault itself, and passes.
    KilledInTest,
    Survives,
    /// A fault of the table, not a kill.
    DoesNotCompile,
    /// The test notices nothing: it fails with the right code.
    FailsAnyway,
}

impl Outcome {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Killed => "killed",
            Self::KilledByHanging => "killed (it hangs)",
            Self::KilledInTest => "killed in the test",
            Self::Survives => "SURVIVES",
            Self::DoesNotCompile => "DOES NOT COMPILE",
            Self::FailsAnyway => "TEST FAILS ANYWAY",
        }
    }

    pub(super) fn is_kill(self) -> bool {
        matches!(self, Self::Killed | Self::KilledByHanging | Self::KilledInTest)
    }
}

impl From<End> for Outcome {
    fn from(end: End) -> Self {
        match end {
            End::Failed => Self::Killed,
            End::Hung => Self::KilledByHanging,
            End::Passed => Self::Survives,
        }
    }
}

/// One result.
pub(super) struct Judged<'a> {
    pub(super) mutant: &'a Mutant,
    pub(super) outcome: Outcome,
}

/// What kind of test it is that notices a fault.
fn kind(test: &str) -> &'static str {
    let file = test.split("::").next().unwrap_or(test);
    if file.ends_with("audit.rs") {
        "audit"
    } else if file.starts_with("crates/d2m/tests/verify") || file.starts_with("crates/d2m-verify/") {
        "verdict"
    } else {
        "test"
    }
}

/// The table as one run writes it.
pub(super) struct Record<'a> {
    path: PathBuf,
    all: &'a [Mutant],
    /// The commit that the sources of the run are of, and the day on which it began.
    commit: String,
    day: String,
}

impl<'a> Record<'a> {
    pub(super) fn new(root: &Path, all: &'a [Mutant]) -> Result<Self, Error> {
        let commit = Command::new("git")
            .args(["log", "-1", "--format=%h"])
            .current_dir(root)
            .output()
            .map_err(|e| format!("git: {e}"))?;
        let commit = String::from_utf8_lossy(&commit.stdout).trim().to_owned();
        let seconds = SystemTime::now().duration_since(UNIX_EPOCH)?.as_secs();
        Ok(Self { path: root.join(PATH), all, commit, day: date(seconds / 86_400) })
    }

    /// The names of the faults that have a row of this commit.
    pub(super) fn known(&self) -> Result<BTreeSet<String>, Error> {
        let before = fs::read_to_string(&self.path)?;
        let cells = before.lines().map(|row| row.split(" | ").collect::<Vec<_>>());
        let of_commit = cells.filter(|cells| cells.iter().rev().nth(1) == Some(&self.commit.as_str()));
        Ok(of_commit.map(|cells| cells[0].trim_start_matches("| ").to_owned()).collect())
    }

    /// Brings the table up to date: rows of these are written anew, those of faults that are gone are dropped.
    pub(super) fn write(&self, judged: &[Judged<'_>]) -> Result<(), Error> {
        let before = fs::read_to_string(&self.path).unwrap_or_default();
        let mut rows: BTreeMap<&str, String> = BTreeMap::new();
        for mutant in self.all {
            let start = format!("| {} |", mutant.name);
            rows.extend(
                before.lines().find(|row| row.starts_with(&start)).map(|row| (&*mutant.name, row.into())),
            );
        }
        for Judged { mutant, outcome } in judged {
            let (word, kind) = (outcome.word(), kind(&mutant.test));
            let (name, test, Self { commit, day, .. }) = (&mutant.name, &mutant.test, self);
            let row = format!("| {name} | {word} | {kind} | `{test}` | {commit} | {day} |");
            rows.insert(&mutant.name, row);
        }
        let count = format!("{} of {} faults have a row.", rows.len(), self.all.len());
        let rows: Vec<String> = rows.into_values().collect();
        let title = "| fault | result | by | which | at commit | run on |\n|---|---|---|---|---|---|";
        fs::write(&self.path, format!("{HEAD}\n{count}\n\n{title}\n{}\n", rows.join("\n")))?;
        Ok(())
    }
}

/// The date of a day that is counted from 1970-01-01, in the Gregorian calendar.
fn date(days: u64) -> String {
    // Years begin in March here, so that the day of a leap year is the last one of its year.
    let days = days + 719_468;
    let (era, of_era) = (days / 146_097, days % 146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let from_march = (5 * of_year + 2) / 153;
    let (day, month) = (of_year - (153 * from_march + 2) / 5 + 1, (from_march + 2) % 12 + 1);
    format!("{:04}-{month:02}-{day:02}", 400 * era + year + u64::from(month <= 2))
}

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn dates_of_days() {
        for (days, wanted) in
            [(0, "1970-01-01"), (59, "1970-03-01"), (11_016, "2000-02-29"), (20_783, "2026-11-26")]
        {
            assert_eq!(date(days), wanted);
        }
    }
}
