//! Results to files that are complete or absent, plain or packed by gzip, or to standard output.

use crate::failure::Failure;
use crate::inputs;
use d2m_io::MeshFormat;
pub(crate) use d2m_io::short_number as short;
use flate2::Compression;
use flate2::write::GzEncoder;
use indicatif::{ProgressBar, ProgressStyle};
use std::borrow::Cow;
use std::ffi::OsStr;
use std::fs;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// A name as text shows it: no character of it begins a line or tells the terminal anything.
pub(crate) fn printable(name: &str) -> Cow<'_, str> {
    if !name.contains(char::is_control) {
        return Cow::Borrowed(name);
    }
    let mut shown = String::with_capacity(name.len() + 8);
    for character in name.chars() {
        if character.is_control() {
            shown.extend(character.escape_default());
        } else {
            shown.push(character);
        }
    }
    Cow::Owned(shown)
}

/// Writes a line to standard error; nobody listening is no reason to stop.
pub(crate) fn note(text: &str) {
    let _ = writeln!(io::stderr(), "{}", printable(text));
}

/// A progress bar with the time left. On a terminal only: elsewhere it stays silent.
pub(crate) fn progress_bar(length: usize, of: &str) -> ProgressBar {
    let bar = ProgressBar::new(length as u64);
    match ProgressStyle::with_template(&format!("{{bar:40}} {{pos}}/{{len}} {of}, {{eta}} left {{msg}}")) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// Four digits that count.
pub(crate) fn digits(number: f64) -> String {
    let rounded: f64 = format!("{number:.3e}").parse().unwrap_or(number);
    short(rounded)
}

/// Writes to standard output.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    print_bytes(text.as_bytes())
}

/// Writes an answer to standard output; on a terminal its verdict has a color, unless `NO_COLOR` is set.
pub(crate) fn print_answer(text: &str) -> Result<(), Failure> {
    const COLORS: [(&str, u8); 3] = [("CONTACT", 31), ("SEPARATED", 32), ("UNDECIDED", 33)];
    let is_dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    let is_plain = is_dumb || std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    if is_plain || !io::stdout().is_terminal() {
        return print(text);
    }
    let colored = COLORS.iter().find_map(|(word, color)| {
        text.strip_prefix(word).map(|rest| format!("\x1b[1;{color}m{word}\x1b[0m{rest}"))
    });
    print(colored.as_deref().unwrap_or(text))
}

fn print_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    let written = stdout.write_all(bytes).and_then(|()| stdout.flush());
    written.map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::ClosedPipe,
        _ => Failure::at("standard output", error),
    })
}

/// Where a command's results go: `-` is standard output.
#[derive(Debug)]
pub(crate) enum Output {
    Stdout,
    File(PathBuf),
}

impl Output {
    /// Names the place and refuses early what cannot be written later.
    pub(crate) fn new(path: &str) -> Result<Self, Failure> {
        if path == "-" {
            return Ok(Self::Stdout);
        }
        if path.is_empty() {
            return Err(Failure::Input("the name of the file to write is empty".to_owned()));
        }
        let path = Path::new(path);
        if path.is_dir() {
            return Err(Failure::at(path.display(), "is a folder, not a file"));
        }
        let folder = folder_of(path);
        if !folder.is_dir() {
            return Err(Failure::at(path.display(), format!("there is no folder {}", folder.display())));
        }
        if path.metadata().is_ok_and(|metadata| metadata.permissions().readonly()) {
            return Err(Failure::at(path.display(), "is read-only"));
        }
        // What a link points to is written, and the link stays.
        let target = if path.is_symlink() { path.canonicalize().ok() } else { None };
        Ok(Self::File(target.unwrap_or_else(|| path.to_owned())))
    }

    /// Refuses to replace a file that is about to be read, before anything is done.
    pub(crate) fn spare<'a>(self, inputs: impl IntoIterator<Item = &'a Path>) -> Result<Self, Failure> {
        inputs.into_iter().for_each(inputs::remember);
        self.spare_inputs()?;
        Ok(self)
    }

    /// Refuses to replace any file that was read until now. Each result is held against them before it is written; what takes long asks before that.
    pub(crate) fn spare_inputs(&self) -> Result<(), Failure> {
        match self {
            Self::File(path) if inputs::was_read(path) => {
                Err(Failure::at(path.display(), "is an input and would be overwritten"))
            }
            _ => Ok(()),
        }
    }

    /// Refuses a name that says another kind of file than the one that the option writes: nobody could read it by that name.
    pub(crate) fn called(self, option: &str, extensions: &[&str]) -> Result<Self, Failure> {
        if let Self::File(path) = &self
            && let Some(extension) = path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase)
            && !extensions.contains(&extension.as_str())
            && (MeshFormat::from_path(path).is_some() || KINDS.contains(&extension.as_str()))
        {
            let reason = format!("{option} writes a file of another kind: expected .{}", extensions[0]);
            return Err(Failure::at(path.display(), reason));
        }
        Ok(self)
    }

    /// Where its bytes go, whatever it is called.
    fn target(&self) -> PathBuf {
        match self {
            Self::Stdout => PathBuf::from("-"),
            Self::File(path) => {
                let folder = folder_of(path).canonicalize().unwrap_or_default();
                path.canonicalize().unwrap_or_else(|_| folder.join(path.file_name().unwrap_or_default()))
            }
        }
    }

    /// Writes everything at once: to a temporary file beside the target, which then replaces it.
    pub(crate) fn write(&self, contents: &str) -> Result<(), Failure> {
        self.write_bytes(contents.as_bytes())
    }

    /// Opens the place for results that come bit by bit: what is there already is replaced at once.
    pub(crate) fn stream(&self) -> Result<Stream, Failure> {
        self.spare_inputs()?;
        let (sink, name) = match self {
            Self::Stdout => (Sink::Stdout, "standard output".to_owned()),
            Self::File(path) => {
                let created = fs::File::create(path);
                let file = created
                    .map_err(|error| Failure::at(path.display(), format!("cannot be written: {error}")))?;
                let is_packed =
                    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
                let sink = if is_packed {
                    Sink::Packed(Box::new(GzEncoder::new(file, Compression::default())))
                } else {
                    Sink::Plain(file)
                };
                (sink, path.display().to_string())
            }
        };
        Ok(Stream { sink, name })
    }

    /// As [`Self::write`], for what is no text.
    pub(crate) fn write_bytes(&self, contents: &[u8]) -> Result<(), Failure> {
        let Self::File(path) = self else { return print_bytes(contents) };
        self.spare_inputs()?;
        // A device such as /dev/null must not be replaced.
        let special = path.exists() && !path.is_file();
        let written = if special { fs::write(path, contents) } else { replace(path, contents) };
        written.map_err(|error| Failure::at(path.display(), format!("cannot be written: {error}")))
    }
}

impl core::fmt::Display for Output {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Stdout => f.write_str("standard output"),
            Self::File(path) => write!(f, "{}", path.display()),
        }
    }
}

/// Extensions by which files other than those of meshes are known: one of another kind of file is a slip.
const KINDS: [&str; 6] = ["d2mtree", "html", "htm", "png", "json", "jsonl"];

/// Refuses two results in one file, of which the first would be lost.
pub(crate) fn require_distinct<'a>(outputs: impl IntoIterator<Item = &'a Output>) -> Result<(), Failure> {
    let mut targets = Vec::new();
    for output in outputs {
        let target = output.target();
        if targets.contains(&target) {
            return Err(Failure::at(output, "two results would be written there"));
        }
        targets.push(target);
    }
    Ok(())
}

/// Results as they come: a run that is ended from outside leaves the whole lines written until then.
#[derive(Debug)]
pub(crate) struct Stream {
    sink: Sink,
    name: String,
}

/// Where results go.
#[derive(Debug)]
enum Sink {
    Stdout,
    Plain(fs::File),
    /// Gzip, by the file's name. Its end is written when it is dropped.
    Packed(Box<GzEncoder<fs::File>>),
}

impl Stream {
    /// Appends whole lines in one piece.
    pub(crate) fn lines(&mut self, lines: &str) -> Result<(), Failure> {
        let written = match &mut self.sink {
            Sink::Stdout => return print(lines),
            Sink::Plain(file) => file.write_all(lines.as_bytes()),
            // What was written until then can be unpacked, however the run ends.
            Sink::Packed(file) => file.write_all(lines.as_bytes()).and_then(|()| file.flush()),
        };
        written.map_err(|error| Failure::at(&self.name, format!("cannot be written: {error}")))
    }
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

fn replace(path: &Path, contents: &[u8]) -> io::Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let temporary = folder_of(path).join(format!(".{name}.{}.tmp", std::process::id()));
    let written = fs::File::create(&temporary)
        .and_then(|mut file| file.write_all(contents).and_then(|()| file.sync_all()))
        .and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        let _ = fs::remove_file(&temporary);
    }
    written
}
