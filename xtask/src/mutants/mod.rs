//! `cargo xtask mutants`: the table of deliberate faults, each of which a named test must notice.
mod copy;
mod run;
mod table;

pub(crate) use run::{Options, run};
pub(crate) use table::{Change, MUTANTS, Mutant};

/// A line of docs/guarantees.md.
impl Mutant {
    /// `| fault | where | killed by |`.
    pub(crate) fn row(&self) -> String {
        let place = match self.change {
            Change::Patch { file, .. } => format!("`{file}`"),
            Change::InTest => "in the test".into(),
        };
        format!("| {} | {place} | `{}` |", self.name, self.test)
    }

    /// The file and the name of the test.
    pub(crate) fn test(&self) -> (&'static str, &'static str) {
        self.test.split_once("::").expect("file.rs::test")
    }

    /// What cargo is asked for: the package and the target in which the test lives.
    fn target(&self) -> Vec<String> {
        let file = self.test().0;
        let package = file.split('/').next().unwrap_or_default();
        let mut arguments = vec!["-p".to_string(), package.to_string()];
        match file.strip_prefix(package).and_then(|rest| rest.strip_prefix("/tests/")) {
            Some(test) => arguments.extend(["--test".into(), test.trim_end_matches(".rs").into()]),
            None if package == "xtask" => arguments.extend(["--bin".into(), "xtask".into()]),
            None => arguments.push("--lib".into()),
        }
        arguments
    }
}

/// Disagreements of the table with the sources and with docs/guarantees.md.
pub(crate) fn check(root: &std::path::Path) -> std::io::Result<Vec<String>> {
    let page = std::fs::read_to_string(root.join("docs/guarantees.md"))?;
    let rows: Vec<String> = MUTANTS.iter().map(Mutant::row).collect();
    let mut findings = compare(&page, &rows);
    for mutant in MUTANTS {
        let Change::Patch { file, from, .. } = mutant.change else { continue };
        let text = std::fs::read_to_string(root.join(file)).unwrap_or_default();
        let found = text.matches(from).count();
        if found != 1 {
            findings.push(format!(
                "mutant \"{}\": {file} holds its text {found} times instead of once: {from}",
                mutant.name
            ));
        }
    }
    Ok(findings)
}

/// Rows that only one of table and page has.
fn compare(page: &str, rows: &[String]) -> Vec<String> {
    let on_page: Vec<&str> = page
        .lines()
        .skip_while(|line| !line.starts_with("## Mutants"))
        .filter(|line| line.starts_with('|') && line.contains(".rs::"))
        .collect();
    let missing = rows.iter().filter(|row| !on_page.contains(&row.as_str()));
    let extra = on_page.iter().filter(|line| !rows.iter().any(|row| row == *line));
    let missing = missing.map(|row| format!("docs/guarantees.md lacks the mutant {row}"));
    let extra = extra.map(|line| format!("docs/guarantees.md has a mutant that the table lacks: {line}"));
    missing.chain(extra).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn page_and_table_are_compared_both_ways() {
        let row = |name: &str| format!("| {name} | `a.rs` | `p/tests/t.rs::f` |");
        let page = format!("| promise | `b.rs::g` |\n## Mutants\n{}\n{}\n", row("one"), row("two"));
        assert_eq!(compare(&page, &[row("one"), row("two")]), [""; 0]);
        assert_eq!(compare(&page, &[row("one")]).len(), 1);
        assert_eq!(compare(&page, &[row("one"), row("two"), row("three")]).len(), 1);
    }

    #[test]
    fn targets_of_tests() {
        let of = |test| Mutant { name: "", change: Change::InTest, test }.target().join(" ");
        assert_eq!(of("d2m-bvh/tests/engine.rs::f"), "-p d2m-bvh --test engine");
        assert_eq!(of("d2m-bvh/src/search/tests.rs::f"), "-p d2m-bvh --lib");
        assert_eq!(of("xtask/src/judge/tests.rs::f"), "-p xtask --bin xtask");
    }

    #[test]
    fn names_are_distinct() {
        let mut names: Vec<&str> = MUTANTS.iter().map(|m| m.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), MUTANTS.len());
    }
}
