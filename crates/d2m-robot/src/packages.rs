//! From the names of mesh files to paths.

use crate::{RobotError, RobotOptions};
use std::path::{Path, PathBuf};

/// Reads a text file: UTF-8, or UTF-16 that begins with a byte order mark.
pub(crate) fn read_text(path: &Path) -> Result<String, RobotError> {
    let file = || path.display().to_string();
    let bytes = std::fs::read(path).map_err(|source| RobotError::File { file: file(), source })?;
    let fault = |line: usize, reason: String| RobotError::Xml { file: file(), line: line as u32, reason };
    let wide = |unit: fn([u8; 2]) -> u16| {
        let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
        String::from_utf16(&units.collect::<Vec<u16>>())
            .map_err(|_| fault(1, "it begins as UTF-16 but is not: save it as UTF-8".to_owned()))
    };
    match bytes[..] {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        _ => String::from_utf8(bytes).map_err(|error| {
            let (before, rest) = error.as_bytes().split_at(error.utf8_error().valid_up_to());
            let line = before.split(|&byte| byte == b'\n').count();
            fault(line, format!("the byte {:#04x} is no UTF-8: save it as UTF-8", rest[0]))
        }),
    }
}

/// The path of a file that a URDF names: `package://NAME/rest` (or `model://`), `file://path`, or a path beside the URDF.
pub(crate) fn resolve(name: &str, folder: &Path, options: &RobotOptions) -> Result<PathBuf, String> {
    if let Some(path) = name.strip_prefix("file://") {
        return Ok(folder.join(path));
    }
    let Some(rest) = name.strip_prefix("package://").or_else(|| name.strip_prefix("model://")) else {
        return match name.split_once("://") {
            Some((scheme, _)) => Err(format!("{name:?}: files of {scheme:?} cannot be read")),
            None => Ok(folder.join(name)),
        };
    };
    let (package, rest) = rest.split_once('/').unwrap_or((rest, ""));
    if let Some(at) = options.packages.get(package) {
        return Ok(at.join(rest));
    }
    let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    for around in folder.ancestors() {
        let is_package = around.file_name().is_some_and(|name| name == package);
        let candidates = [is_package.then(|| around.join(rest)), Some(around.join(package).join(rest))];
        if let Some(found) = candidates.into_iter().flatten().find(|path| path.is_file()) {
            return Ok(found);
        }
    }
    Err(format!(
        "{name:?}: the package {package:?} is unknown: it is not beside the robot, and no folder is given for it \
         (--package {package}=DIR)"
    ))
}
