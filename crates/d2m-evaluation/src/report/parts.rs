//! What the parts of the page are written with.
use std::fmt::Write as _;
use std::path::Path;

type Error = Box<dyn std::error::Error>;

/// A figure, if it was drawn.
pub(super) fn figure(page: &mut String, folder: &Path, file: &str, words: &str) -> Result<(), Error> {
    if folder.join(format!("{file}.svg")).exists() {
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        writeln!(page, "![{words}]({name}/{file}.svg)\n")?;
    }
    Ok(())
}

/// Three digits.
pub(super) fn round(value: f64) -> String {
    match value {
        v if v >= 100.0 => format!("{v:.0}"),
        v if v >= 10.0 => format!("{v:.1}"),
        v if v >= 0.1 => format!("{v:.2}"),
        v => format!("{v:.4}"),
    }
}
