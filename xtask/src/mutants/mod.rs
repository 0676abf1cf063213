//! `cargo xtask mutants`: the table of deliberate faults, each of which a named test must notice.
mod copy;
mod run;
mod table;

pub(crate) use run::{Options, run};
pub(crate) use table::{Change, Mutant, all};

/// Workers hand theirs to the thread that started them.
type Error = Box<dyn std::error::Error + Send + Sync>;

/// Packages with a feature of this name.
const WITH_SERDE: [&str; 6] = ["d2m", "d2m-bvh", "d2m-dynamics", "d2m-feature", "d2m-interval", "d2m-motion"];

/// A test by its file and its name.
pub(crate) struct TestName {
    pub(crate) file: &'static str,
    pub(crate) name: &'static str,
}

impl Mutant {
    /// A line of `cargo xtask mutants --list`: `| fault | where | killed by |`.
    pub(crate) fn row(&self) -> String {
        let place = match self.change {
            Change::Patch { file, .. } => format!("`{file}`"),
            Change::InTest => "in the test".into(),
        };
        format!("| {} | {place} | `{}` |", self.name, self.test)
    }

    /// Where the test is, and its name.
    pub(crate) fn test(&self) -> TestName {
        let (file, name) = self.test.split_once("::").expect("file.rs::test");
        TestName { file, name }
    }

    /// The folder of the package in which the test lives.
    fn package_folder(&self) -> &'static str {
        let file = self.test().file;
        file.split_once("/tests/").or_else(|| file.split_once("/src/")).map_or("", |(folder, _)| folder)
    }

    /// What cargo builds: the package and the target in which the test lives.
    fn target(&self) -> Vec<String> {
        let file = self.test().file;
        let file = file.strip_prefix("crates/").unwrap_or(file);
        let package = file.split('/').next().unwrap_or_default();
        let mut arguments = vec!["-p".to_string(), package.to_string()];
        match file.strip_prefix(package).and_then(|rest| rest.strip_prefix("/tests/")) {
            Some(test) => arguments.extend(["--test".into(), test.trim_end_matches(".rs").into()]),
            None if package == "xtask" => {
                arguments.extend(["--features", "full", "--bin", "xtask"].map(String::from));
            }
            None if package == "d2m-cli" => arguments.extend(["--bin", "d2m"].map(String::from)),
            None => arguments.push("--lib".into()),
        }
        // Some tests are about written forms; without the feature they would not be among those of their target.
        if WITH_SERDE.contains(&package) {
            arguments.extend(["--features", "serde"].map(String::from));
        }
        arguments
    }
}

/// Texts to be replaced that do not occur exactly once in their file, and tests that do not exist.
pub(crate) fn check(root: &std::path::Path) -> Vec<String> {
    let mut findings = Vec::new();
    for mutant in all() {
        let TestName { file, name: test } = mutant.test();
        let source = std::fs::read_to_string(root.join(file)).unwrap_or_default();
        if !source.contains(&format!("fn {test}(")) {
            findings.push(format!("mutant \"{}\": there is no test {}", mutant.name, mutant.test));
        }
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
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_of_tests() {
        let of = |test| Mutant { name: "", change: Change::InTest, test }.target().join(" ");
        assert_eq!(of("crates/d2m-bvh/tests/engine.rs::f"), "-p d2m-bvh --test engine --features serde");
        assert_eq!(of("crates/d2m-bvh/src/search/tests.rs::f"), "-p d2m-bvh --lib --features serde");
        assert_eq!(of("xtask/src/judge/tests.rs::f"), "-p xtask --features full --bin xtask");
        let folder = |test| Mutant { name: "", change: Change::InTest, test }.package_folder();
        assert_eq!(folder("crates/d2m-bvh/tests/engine.rs::f"), "crates/d2m-bvh");
        assert_eq!(folder("xtask/src/judge/tests.rs::f"), "xtask");
    }

    #[test]
    fn names_are_distinct() {
        let mut names: Vec<&str> = all().map(|m| m.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all().count());
    }
}
