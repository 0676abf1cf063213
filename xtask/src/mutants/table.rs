//! The deliberate faults as they stand in `xtask/mutants/<crate>.toml`.
use super::Error;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Where the files are, seen from the root of the workspace.
const FOLDER: &str = "xtask/mutants";

/// A fault and the test that must notice it.
#[derive(Debug)]
pub(super) struct Mutant {
    pub(super) name: String,
    /// `file.rs::test`.
    pub(super) test: String,
    pub(super) change: Change,
}

/// What is wrong.
#[derive(Debug)]
pub(super) enum Change {
    /// In this file this text, which occurs once, becomes that.
    Patch { file: String, from: String, to: String },
    /// The test makes the wrong variant itself and asserts that the same samples refute it.
    InTest,
}

/// One table of a file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    test: String,
    file: Option<String>,
    from: Option<String>,
    to: Option<String>,
}

/// Every deliberate fault: file after file, and in each those together that one test notices.
pub(super) fn read(root: &Path) -> Result<Vec<Mutant>, Error> {
    let folder = root.join(FOLDER);
    let mut paths = Vec::new();
    for entry in fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))? {
        let path = entry?.path();
        if path.extension().is_some_and(|end| end == "toml") {
            paths.push(path);
        }
    }
    paths.sort();
    let mut all: Vec<Mutant> = Vec::new();
    for path in paths {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mutants = parse(&stem, &fs::read_to_string(&path)?)
            .map_err(|error| format!("{FOLDER}/{stem}.toml: {error}"))?;
        if let Some(twice) = mutants.iter().find(|mutant| all.iter().any(|other| other.name == mutant.name)) {
            return Err(format!("{FOLDER}/{stem}.toml: another file has \"{}\", too", twice.name).into());
        }
        all.extend(mutants);
    }
    Ok(all)
}

/// The faults of one file. Names are distinct: TOML refuses a header that comes twice.
fn parse(package: &str, text: &str) -> Result<Vec<Mutant>, Error> {
    let rows: BTreeMap<String, Row> = toml::from_str(text)?;
    let mut mutants = Vec::new();
    for (name, Row { test, file, from, to }) in rows {
        if !test.contains(".rs::") {
            return Err(format!("\"{name}\": the test is not of the form file.rs::name: {test}").into());
        }
        let change = match (file, from, to) {
            (Some(file), Some(from), Some(to)) => Change::Patch { file, from, to },
            (None, None, None) => Change::InTest,
            _ => return Err(format!("\"{name}\": file, from and to come together").into()),
        };
        let mutant = Mutant { name, test, change };
        if mutant.package() != package {
            return Err(format!("\"{}\" belongs to {}.toml", mutant.name, mutant.package()).into());
        }
        mutants.push(mutant);
    }
    mutants.sort_by(|a, b| (&a.test, &a.name).cmp(&(&b.test, &b.name)));
    Ok(mutants)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATCH: &str = "[\"a b\"]\ntest = 'crates/d2m-x/src/t.rs::f'\nfile = 'crates/d2m-x/src/x.rs'\nfrom = '''\n\
        one\n'''\nto = 'two'\n";

    #[test]
    fn texts_are_what_stands_in_the_file() {
        let mutants = parse("d2m-x", &format!("{PATCH}[c]\ntest = 'crates/d2m-x/tests/t.rs::f'\n")).unwrap();
        let Change::Patch { from, to, .. } = &mutants[0].change else { panic!("{mutants:?}") };
        assert_eq!((mutants[0].name.as_str(), from.as_str(), to.as_str()), ("a b", "one\n", "two"));
        assert!(matches!(mutants[1].change, Change::InTest));
    }

    #[test]
    fn what_cannot_be_meant_is_refused() {
        let refused = |package, text: &str| parse(package, text).unwrap_err().to_string();
        assert!(refused("d2m-x", &PATCH.repeat(2)).contains("duplicate"));
        assert!(refused("d2m-x", &PATCH.replace("to =", "too =")).contains("too"));
        assert!(refused("d2m-x", &PATCH.replace("to = 'two'", "")).contains("come together"));
        assert!(refused("d2m-x", &PATCH.replace("t.rs::f", "t.rs")).contains("file.rs::name"));
        assert!(refused("d2m-y", PATCH).contains("belongs to d2m-x.toml"));
    }

    #[test]
    fn the_projects_own_faults_are_read() {
        assert!(read(&crate::workspace_root()).unwrap().len() > 100);
    }
}
