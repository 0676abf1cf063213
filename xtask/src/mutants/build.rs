//! Builds the program in which a test lives, or names the places that do not compile.
use super::Error;
use super::copy::Copy;
use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What cargo made of a target.
pub(super) enum Built {
    Programs(Programs),
    Refused(Refusal),
}

/// The programs of tests, by the folders of their packages.
pub(super) struct Programs(BTreeMap<PathBuf, PathBuf>);

impl Programs {
    /// The program of the package in a folder of the copy.
    pub(super) fn of(&self, copy: &Copy, folder: &str) -> Result<&Path, Error> {
        let program = self.0.get(&copy.root.join(folder));
        Ok(program.ok_or_else(|| format!("cargo names no test program of {folder}"))?)
    }
}

/// Why a target does not compile.
pub(super) struct Refusal {
    pub(super) places: Vec<Place>,
    /// The first error in the words of the compiler.
    pub(super) text: String,
}

/// A part of a source file.
#[derive(Debug, PartialEq)]
pub(super) struct Place {
    pub(super) file: String,
    pub(super) bytes: Range<usize>,
}

/// Builds the targets that the arguments of cargo name.
pub(super) fn build(copy: &Copy, targets: &[String]) -> Result<Built, Error> {
    let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["test", "--locked", "--no-run", "--message-format=json"])
        .args(targets)
        .current_dir(&copy.root)
        .env("CARGO_TARGET_DIR", &copy.build)
        // Most of the time is the compiler's, also where one build serves many faults.
        .env("CARGO_PROFILE_DEV_OPT_LEVEL", "1")
        .env("CARGO_PROFILE_DEV_DEBUG", "0")
        .env_remove("CARGO_MANIFEST_DIR")
        .output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let messages: Vec<Value> = text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
    if output.status.success() {
        let tests = messages
            .iter()
            .filter(|m| m["reason"] == "compiler-artifact" && m["profile"]["test"] == true)
            .filter_map(|m| {
                let folder = Path::new(m["manifest_path"].as_str()?).parent()?;
                Some((folder.into(), PathBuf::from(m["executable"].as_str()?)))
            });
        return Ok(Built::Programs(Programs(tests.collect())));
    }
    let refusal = refusal(&messages);
    if refusal.text.is_empty() {
        return Err(format!("cargo: {}", String::from_utf8_lossy(&output.stderr).trim()).into());
    }
    Ok(Built::Refused(refusal))
}

fn refusal(messages: &[Value]) -> Refusal {
    let errors = messages
        .iter()
        .filter(|m| m["reason"] == "compiler-message" && m["message"]["level"] == "error")
        .map(|m| &m["message"]);
    let mut refusal = Refusal { places: Vec::new(), text: String::new() };
    for error in errors {
        let spans = error["spans"].as_array().into_iter().flatten();
        for span in spans.filter(|span| span["is_primary"] == true) {
            refusal.places.extend(places(span));
        }
        if refusal.text.is_empty() {
            refusal.text = error["rendered"].as_str().unwrap_or("an error without a text").trim().into();
        }
    }
    refusal
}

/// A span of the compiler's, and where macros were called that it comes from.
fn places(span: &Value) -> Vec<Place> {
    let spans = std::iter::successors(Some(span), |span| call(span));
    let offset = |number: &Value| number.as_u64().and_then(|offset| usize::try_from(offset).ok());
    spans
        .filter_map(|span| {
            let bytes = offset(&span["byte_start"])?..offset(&span["byte_end"])?;
            Some(Place { file: span["file_name"].as_str()?.replace('\\', "/"), bytes })
        })
        .collect()
}

/// Where the macro was called that a span comes from.
fn call(span: &Value) -> Option<&Value> {
    Some(&span["expansion"]["span"]).filter(|call| call.is_object())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn errors_name_their_places_and_those_of_macros() {
        let call = json!({"file_name": "b.rs", "byte_start": 7, "byte_end": 9, "expansion": null});
        let span = |primary| {
            json!({"file_name": "a.rs", "byte_start": 1, "byte_end": 3, "is_primary": primary,
                "expansion": {"span": call}})
        };
        let message = |level: &str| {
            json!({"reason": "compiler-message",
                "message": {"level": level, "rendered": format!("{level}\n"), "spans": [span(true), span(false)]}})
        };
        let refusal = refusal(&[message("warning"), json!({"reason": "build-finished"}), message("error")]);
        let place = |file: &str, bytes| Place { file: file.into(), bytes };
        assert_eq!(refusal.places, [place("a.rs", 1..3), place("b.rs", 7..9)]);
        assert_eq!(refusal.text, "error");
    }
}
