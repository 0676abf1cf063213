//! The answers of a batch that was ended, kept beside its results.

use crate::arguments::BatchArguments;
use crate::engine::Pair;
use crate::failure::Failure;
use crate::output::Output;
use crate::report::csv_header;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Lines of results in a file `R.csv.part`, whose first line says from which inputs they come.
#[derive(Debug)]
pub(crate) struct Partial {
    path: PathBuf,
    file: File,
    lines: String,
}

impl Partial {
    /// Opens what an earlier run left of this many trials, or begins anew. What comes of other inputs is
    /// refused, and so is a line that is not the answer to its trial; half a line at the end is dropped.
    pub(crate) fn open(
        arguments: &BatchArguments,
        pair: &Pair,
        out: &Output,
        trials: usize,
    ) -> Result<Self, Failure> {
        let Output::File(out) = out else {
            return Err(Failure::at("--resume", "standard output keeps no answers: name a file with --out"));
        };
        let path = PathBuf::from(format!("{}.part", out.display()));
        Output::File(path.clone()).spare_inputs()?;
        let fault = |error: std::io::Error| Failure::at(path.display(), error);
        let origin = format!("# d2m {} {:016x}\n", env!("CARGO_PKG_VERSION"), fingerprint(arguments, pair)?);
        let known = if path.exists() { fs::read_to_string(&path).map_err(fault)? } else { String::new() };
        let lines = match known.strip_prefix(&origin) {
            Some(lines) => lines[..lines.rfind('\n').map_or(0, |end| end + 1)].to_owned(),
            // Ended within the first line.
            None if origin.starts_with(&known) => String::new(),
            None => {
                let reason =
                    "holds answers of other inputs, options or another version: remove it to begin anew";
                return Err(Failure::at(path.display(), reason));
            }
        };
        let columns = csv_header(arguments.further).split(',').count();
        let mut answers = lines.split_terminator('\n').enumerate();
        if let Some((trial, _)) = answers.find(|&(k, line)| k >= trials || !is_answer(line, k, columns)) {
            let place = format!("{}, line {}", path.display(), trial + 2);
            let reason = format!("is not the answer to trial {trial}: remove the file to begin anew");
            return Err(Failure::at(place, reason));
        }
        fs::write(&path, format!("{origin}{lines}")).map_err(fault)?;
        let file = OpenOptions::new().append(true).open(&path).map_err(fault)?;
        Ok(Self { path, file, lines })
    }

    /// How many trials were answered.
    pub(crate) fn count(&self) -> usize {
        self.lines.lines().count()
    }

    /// The lines of all answers.
    pub(crate) fn lines(&self) -> &str {
        &self.lines
    }

    /// Keeps more answers.
    pub(crate) fn append(&mut self, lines: &str) -> Result<(), Failure> {
        let written = self.file.write_all(lines.as_bytes());
        written.map_err(|error| Failure::at(self.path.display(), error))?;
        self.lines.push_str(lines);
        Ok(())
    }

    /// The results are complete; what was kept is no longer needed.
    pub(crate) fn remove(self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// Has a line the form of the answer to a trial? What was damaged or edited would otherwise stand in the
/// results as the answer to another trial.
fn is_answer(line: &str, trial: usize, columns: usize) -> bool {
    let fields: Vec<&str> = line.split(',').collect();
    let is_of_trial = fields.len() == columns && fields[0] == trial.to_string();
    let is_text = !line.contains(char::is_control);
    is_of_trial && is_text && ["contact", "separated", "undecided"].contains(&fields[1])
}

/// A number that differs for different inputs: the bytes of the files, the meshes as they were read, whatever files those name, and the options that
/// change answers (FNV-1a).
fn fingerprint(arguments: &BatchArguments, pair: &Pair) -> Result<u64, Failure> {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |bytes: &[u8]| {
        for byte in bytes.iter().chain(&[0]) {
            hash = (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    add(format!("{:?} {:?}", arguments.query, arguments.further).as_bytes());
    for input in [Path::new(&arguments.a), Path::new(&arguments.b), &arguments.trials] {
        add(input.as_os_str().as_encoded_bytes());
        if input.is_file() {
            add(&fs::read(input).map_err(|error| Failure::at(input.display(), error))?);
        }
    }
    for mesh in [pair.a.mesh(), pair.b.mesh()] {
        for vertex in mesh.vertices() {
            add(&vertex.to_array().map(f64::to_le_bytes).concat());
        }
        for corners in mesh.triangles() {
            add(&corners.map(u32::to_le_bytes).concat());
        }
    }
    Ok(hash)
}
