//! From the names of mesh files to paths.

use crate::{RobotError, RobotOptions};
use std::path::{Path, PathBuf};

/// Reads a text file.
pub(crate) fn read_text(path: &Path) -> Result<String, RobotError> {
    std::fs::read_to_string(path)
        .map_err(|source| RobotError::File { file: path.display().to_string(), source })
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
