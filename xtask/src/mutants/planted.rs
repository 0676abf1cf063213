//! The faults that lie in a copy of the sources: many behind switches, or one alone.
use super::Error;
use super::build::{Built, Place, Programs, build};
use super::copy::Copy;
use super::switch::{self, Fault, Switched};
use super::table::{Change, Mutant};
use super::target::root_module;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// A copy of the sources and the faults of a run in it. Each has its number among them.
pub(super) struct Planted<'a> {
    mutants: &'a [&'a Mutant],
    pub(super) copy: Copy,
    /// The right texts of the files that are changed.
    right: BTreeMap<String, String>,
    /// Files of which the end reads the switch.
    roots: BTreeSet<String>,
    switched: BTreeMap<String, Switched>,
    /// Faults that must not have a switch.
    alone: BTreeSet<usize>,
}

impl<'a> Planted<'a> {
    /// Brings the copy of a worker up to date, with a switch for each fault that can have one.
    pub(super) fn new(source: &Path, worker: usize, mutants: &'a [&'a Mutant]) -> Result<Self, Error> {
        let (mut right, mut roots) = (BTreeMap::new(), BTreeSet::new());
        let mut alone = BTreeSet::new();
        for (number, mutant) in mutants.iter().enumerate() {
            let Change::Patch { file, .. } = &mutant.change else { continue };
            right.insert(file.clone(), fs::read_to_string(source.join(file))?);
            if let Some(root) = root_module(source, file) {
                right.insert(root.clone(), fs::read_to_string(source.join(&root))?);
                roots.insert(root);
            } else {
                alone.insert(number);
            }
        }
        let switched: BTreeMap<String, Switched> = right
            .iter()
            .map(|(file, text)| (file.clone(), with_switches(file, text, mutants, &alone)))
            .collect();
        let texts =
            switched.iter().map(|(file, one)| (file.clone(), ended(&roots, file, &one.text))).collect();
        let copy = Copy::new(source, worker, &texts)?;
        Ok(Self { mutants, copy, right, roots, switched, alone })
    }

    /// Whether the programs of this copy make the fault when its switch is set.
    pub(super) fn has_switch(&self, number: usize) -> bool {
        self.switched.values().any(|file| file.numbers().any(|one| one == number))
    }

    /// The programs of targets with all the switches. Those whose functions do not compile are taken away.
    pub(super) fn programs(&mut self, targets: &[String]) -> Result<Programs, Error> {
        loop {
            match build(&self.copy, targets)? {
                Built::Programs(programs) => return Ok(programs),
                Built::Refused(refusal) => {
                    let named = self.named(&refusal.places);
                    if named.is_empty() {
                        return Err(refusal.text.into());
                    }
                    self.take_away(&named)?;
                }
            }
        }
    }

    /// Builds targets with one fault that has no switch; all that have one stay, but those of the same file.
    pub(super) fn build_alone(&self, number: usize, targets: &[String]) -> Result<Built, Error> {
        let Change::Patch { file, from, to } = &self.mutants[number].change else {
            return Err("the test makes the fault itself".into());
        };
        let spoilt = self.right[file].replace(from, to);
        self.write(file, &spoilt)?;
        let built = build(&self.copy, targets);
        self.write(file, &self.switched[file].text)?;
        built
    }

    fn write(&self, file: &str, text: &str) -> std::io::Result<()> {
        self.copy.write(file, ended(&self.roots, file, text).as_bytes())
    }

    /// The faults to which errors at these places may be due; where no function of theirs is named, all of the files.
    fn named(&self, places: &[Place]) -> BTreeSet<usize> {
        let files = || places.iter().filter_map(|place| Some((place, self.switched.get(&place.file)?)));
        let close: BTreeSet<usize> =
            files().flat_map(|(place, file)| file.numbers_at(&place.bytes)).collect();
        if close.is_empty() { files().flat_map(|(_, file)| file.numbers()).collect() } else { close }
    }

    fn take_away(&mut self, numbers: &BTreeSet<usize>) -> Result<(), Error> {
        self.alone.extend(numbers);
        for &number in numbers {
            let Change::Patch { file, .. } = &self.mutants[number].change else { continue };
            let switched = with_switches(file, &self.right[file], self.mutants, &self.alone);
            self.write(file, &switched.text)?;
            self.switched.insert(file.clone(), switched);
        }
        Ok(())
    }
}

/// A file as it is written: root modules end with what reads the switch.
fn ended(roots: &BTreeSet<String>, file: &str, text: &str) -> String {
    if roots.contains(file) { format!("{text}{}", switch::reader()) } else { text.into() }
}

fn with_switches(file: &str, right: &str, mutants: &[&Mutant], alone: &BTreeSet<usize>) -> Switched {
    let faults = mutants.iter().enumerate().filter(|(number, _)| !alone.contains(number));
    let faults: Vec<Fault<'_>> = faults
        .filter_map(|(number, mutant)| match &mutant.change {
            Change::Patch { file: at, from, to } if at == file => Some(Fault { number, from, to }),
            _ => None,
        })
        .collect();
    Switched::new(right, &faults)
}
