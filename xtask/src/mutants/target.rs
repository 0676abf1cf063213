//! Which package and which target of it a test is built with.
use super::Error;
use super::table::{Change, Mutant};
use std::collections::BTreeSet;
use std::path::Path;

/// A test by its file and its name.
pub(super) struct TestName<'a> {
    pub(super) file: &'a str,
    pub(super) name: &'a str,
}

impl Mutant {
    /// A line of `cargo xtask mutants --list`: `| fault | where | killed by |`.
    pub(super) fn row(&self) -> String {
        let place = match &self.change {
            Change::Patch { file, .. } => format!("`{file}`"),
            Change::InTest => "in the test".into(),
        };
        format!("| {} | {place} | `{}` |", self.name, self.test)
    }

    /// Where the test is, and its name.
    pub(super) fn test(&self) -> TestName<'_> {
        let (file, name) = self.test.split_once("::").unwrap_or((&self.test, ""));
        TestName { file, name }
    }

    /// The crate that is spoilt.
    pub(super) fn package(&self) -> &str {
        match &self.change {
            Change::Patch { file, .. } => package(file),
            Change::InTest => package(self.test().file),
        }
    }

    /// The folder of the package in which the test lives.
    pub(super) fn package_folder(&self) -> &str {
        folder(self.test().file)
    }

    /// The target in which the test lives.
    pub(super) fn target(&self, root: &Path) -> Result<Target, Error> {
        let file = self.test().file;
        let home = root.join(folder(file));
        let path = home.join("Cargo.toml");
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let manifest: toml::Table = text.parse()?;
        // Most are named as their folder is.
        let named = manifest.get("package").and_then(|package| package.get("name"));
        let package = named.and_then(toml::Value::as_str).unwrap_or_else(|| package(file)).to_string();
        let test = file.strip_prefix(folder(file)).and_then(|rest| rest.strip_prefix("/tests/"));
        let test = test.map(|test| test.trim_end_matches(".rs"));
        let kind = if let Some(test) = test {
            Kind::Test(test.into())
        } else if home.join("src/lib.rs").exists() {
            Kind::Library
        } else {
            let named = manifest.get("bin").and_then(|all| all.get(0)).and_then(|first| first.get("name"));
            Kind::Program(named.and_then(toml::Value::as_str).unwrap_or(&package).into())
        };
        // Some tests are about written forms; without the feature they would not be among those of their target.
        let features = manifest.get("features").and_then(toml::Value::as_table);
        let written = features.filter(|all| all.contains_key("serde")).map(|_| "serde".to_string());
        let required = test.and_then(|test| required_features(&manifest, test)).unwrap_or_default();
        let named = |feature| format!("{package}/{feature}");
        let features = written.into_iter().chain(required).map(named).collect();
        Ok(Target { kind, package, features })
    }
}

/// What cargo calls a target, whatever its package. Programs, which need most other crates, are built last.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    Library,
    Test(String),
    Program(String),
}

/// A target, its package, and the features that it is built with.
#[derive(Clone, Debug)]
pub(super) struct Target {
    pub(super) kind: Kind,
    pub(super) package: String,
    pub(super) features: BTreeSet<String>,
}

/// What cargo builds at once: the targets of a kind in some packages. Crates below them are built once for all calls that
/// choose the same packages and features, as cargo joins the features of what it is given.
#[derive(Clone, Debug)]
pub(super) struct Selection {
    pub(super) packages: BTreeSet<String>,
    pub(super) features: BTreeSet<String>,
}

impl Selection {
    pub(super) fn of<'a>(targets: impl IntoIterator<Item = &'a Target>) -> Self {
        let mut selection = Self { packages: BTreeSet::new(), features: BTreeSet::new() };
        for target in targets {
            selection.packages.insert(target.package.clone());
            selection.features.extend(target.features.iter().cloned());
        }
        selection
    }

    /// The arguments with which cargo builds the targets of a kind.
    pub(super) fn arguments(&self, kind: &Kind) -> Vec<String> {
        let mut arguments = match kind {
            Kind::Library => vec!["--lib".into()],
            Kind::Program(name) => vec!["--bin".into(), name.clone()],
            Kind::Test(name) => vec!["--test".into(), name.clone()],
        };
        for (flag, values) in [("-p", &self.packages), ("--features", &self.features)] {
            arguments.extend(values.iter().flat_map(|value| [flag.to_string(), value.clone()]));
        }
        arguments
    }
}

/// The root module of the crate that holds a source file. Files of tests are crates of their own.
pub(super) fn root_module(root: &Path, file: &str) -> Option<String> {
    let (folder, inside) = file.split_once("/src/")?;
    let library = root.join(folder).join("src/lib.rs").exists();
    let name = if library { "lib.rs" } else { "main.rs" };
    // A program beside a library is another crate.
    (inside != "main.rs" || !library).then(|| format!("{folder}/src/{name}"))
}

/// The features without which a test of `tests` is left out.
fn required_features(manifest: &toml::Table, test: &str) -> Option<Vec<String>> {
    let named = |entry: &&toml::Value| entry.get("name").and_then(toml::Value::as_str) == Some(test);
    let entry = manifest.get("test")?.as_array()?.iter().find(named)?;
    let required = entry.get("required-features")?.as_array()?;
    Some(required.iter().filter_map(|feature| feature.as_str().map(String::from)).collect())
}

/// The folder that holds `src` and `tests`.
fn folder(file: &str) -> &str {
    file.split_once("/tests/").or_else(|| file.split_once("/src/")).map_or("", |(folder, _)| folder)
}

/// A package has the name of its folder.
fn package(file: &str) -> &str {
    folder(file).rsplit('/').next().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_of_tests() {
        let root = crate::workspace_root();
        let mutant = |test: &str| Mutant { name: String::new(), change: Change::InTest, test: test.into() };
        let target = |test| mutant(test).target(&root).unwrap();
        let of = |test| {
            let target = target(test);
            Selection::of([&target]).arguments(&target.kind).join(" ")
        };
        let bvh = "-p d2m-bvh --features d2m-bvh/serde";
        assert_eq!(of("crates/d2m-bvh/tests/engine.rs::f"), format!("--test engine {bvh}"));
        assert_eq!(of("crates/d2m-bvh/src/walk/tests.rs::f"), format!("--lib {bvh}"));
        assert_eq!(of("crates/d2m-cli/src/scene/tests.rs::f"), "--bin d2m -p d2m-cli");
        assert_eq!(of("benches/tests/hard_scenes.rs::f"), "--test hard_scenes -p d2m-benches");
        let [audit, world] = ["crates/d2m/tests/audit.rs::f", "crates/d2m-world/src/world.rs::f"].map(target);
        let both = "-p d2m -p d2m-world --features d2m/audit --features d2m/serde";
        assert_eq!(
            Selection::of([&audit, &world]).arguments(&audit.kind).join(" "),
            format!("--test audit {both}")
        );
        assert_eq!(mutant("crates/d2m-bvh/tests/engine.rs::f").package_folder(), "crates/d2m-bvh");
        assert_eq!(mutant("xtask/src/tidy/map.rs::f").package_folder(), "xtask");
    }

    #[test]
    fn root_modules_of_files() {
        let of = |file| root_module(&crate::workspace_root(), file);
        assert_eq!(of("crates/d2m-bvh/src/pair/scene.rs").unwrap(), "crates/d2m-bvh/src/lib.rs");
        assert_eq!(of("crates/d2m-cli/src/scene/mod.rs").unwrap(), "crates/d2m-cli/src/main.rs");
        assert_eq!(of("crates/d2m-bvh/tests/engine.rs"), None);
    }
}
