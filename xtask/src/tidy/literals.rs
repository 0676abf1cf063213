//! Certified code holds no small number without a name: each is a constant whose comment derives it.
//!
//! A tolerance that stands in the middle of a comparison was how two answers went wrong; a named constant is read.
use std::fs;
use std::path::Path;

/// Crates of which an answer can depend on a small number.
const CERTIFIED: [&str; 11] = [
    "crates/d2m-lanes/src/",
    "crates/d2m-interval/src/",
    "crates/d2m-motion/src/",
    "crates/d2m-root/src/",
    "crates/d2m-feature/src/",
    "crates/d2m-mesh/src/",
    "crates/d2m-bvh/src/",
    "crates/d2m-verify/src/",
    "crates/d2m-world/src/",
    "crates/d2m-robot/src/",
    "crates/d2m/src/",
];

/// One finding for each line of certified code that holds such a number.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let mut findings = Vec::new();
    for path in super::sources::files(root)? {
        let name = path.strip_prefix(root).unwrap_or(&path).display().to_string();
        if CERTIFIED.iter().any(|folder| name.starts_with(folder)) && !is_test(&name) {
            let text = fs::read_to_string(&path)?;
            findings.extend(unnamed(&text).map(|(line, code)| {
                format!("{name}:{line}: a small number wants a named constant with its derivation: {code}")
            }));
        }
    }
    Ok(findings)
}

/// Tests, what compares methods for them, and what only samples.
fn is_test(name: &str) -> bool {
    let proves_nothing = ["/tests/", "mesh/cross_check.rs", "d2m-motion/src/check_motion.rs"];
    name.ends_with("tests.rs") || proves_nothing.iter().any(|part| name.contains(part))
}

/// Number and code of each line, outside the tests of a file, that holds a small literal and defines no constant.
fn unnamed(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut in_constant = false;
    let mut in_tests = false;
    text.lines()
        .enumerate()
        .filter(move |(_, line)| {
            // The item that follows ends with the first line that begins with no space, and that no other one follows.
            let ends = line.starts_with('}')
                || (line.starts_with(|c: char| c.is_alphabetic()) && line.ends_with(';'));
            let is_tests = in_tests || line.starts_with("#[cfg(test)]");
            in_tests = is_tests && !ends;
            !is_tests
        })
        .map(|(index, line)| (index + 1, line.split("//").next().unwrap_or_default().trim()))
        .filter(move |(_, code)| {
            // A table of constants may have many lines.
            let names = in_constant || (code.contains("const ") && !code.contains("fn "));
            in_constant = names && !code.ends_with(';');
            !names && !code.starts_with('"') && holds_small_number(code)
        })
}

/// Is there a literal such as `1e-15` or `2.5e-3`?
fn holds_small_number(code: &str) -> bool {
    code.match_indices("e-").any(|(at, _)| {
        let is_digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
        let before = code[..at].chars().next_back();
        let number = code[..at].rsplit(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '.')).next();
        let starts_with_digit = is_digit(number.and_then(|number| number.chars().next()));
        (is_digit(before) || before == Some('.'))
            && starts_with_digit
            && is_digit(code[at + 2..].chars().next())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_are_seen_where_they_have_no_name() {
        let lines = |text| unnamed(text).map(|(line, _)| line).collect::<Vec<_>>();
        assert_eq!(lines("if x > 1e-15 {\n    y * (1.0 + 2.5e-3)\n}"), [1, 2]);
        assert_eq!(lines("/// 1e-15\nconst ROUNDING: f64 = 1e-15; // 2e-15\nlet a = b; // 1e-9"), [0; 0]);
        assert_eq!(lines("let name-1 = scale-2; one-1; 0xe-1"), [0; 0]);
        assert_eq!(
            lines("let x = 1;\n#[cfg(test)]\nmod tests { const X: f64 = f(1e-3); let y = 1e-3; }"),
            [0; 0]
        );
        assert_eq!(
            lines(
                "#[cfg(test)]\nmod tests;\nlet x = 1e-3;\n#[cfg(test)]\nmod more {\n    let y = 1e-3;\n}\nlet z = 1e-3;"
            ),
            [3, 8]
        );
    }
}
