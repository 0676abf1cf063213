//! Every test that `docs/guarantees.md` names exists.
use std::path::Path;

/// One finding for each `file::test` that is not there.
pub(super) fn check(root: &Path) -> std::io::Result<Vec<String>> {
    let text = std::fs::read_to_string(root.join("docs/guarantees.md"))?;
    Ok(named(&text)
        .filter(|(file, test)| {
            let source = std::fs::read_to_string(root.join(file)).unwrap_or_default();
            !source.contains(&format!("fn {test}("))
        })
        .map(|(file, test)| format!("docs/guarantees.md names {file}::{test}, which does not exist"))
        .collect())
}

/// The file and the name of each test between backticks.
fn named(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.split('`')
        .filter_map(|word| word.split_once(".rs::").map(|(file, test)| (&word[..file.len() + 3], test)))
}

#[cfg(test)]
mod tests {
    #[test]
    fn tests_are_read_from_the_page() {
        let text = "| promise | `a/b.rs::one`, `c.rs::two` | `plain`";
        assert_eq!(super::named(text).collect::<Vec<_>>(), [("a/b.rs", "one"), ("c.rs", "two")]);
    }
}
