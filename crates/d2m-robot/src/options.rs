//! How a robot is read.

use std::collections::BTreeMap;
use std::path::PathBuf;

/// Where things are that a URDF names.
///
/// ```
/// let options = d2m_robot::RobotOptions::new().with_package("franka_description", "/opt/franka_description");
/// assert_eq!(options.packages.len(), 1);
/// ```
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct RobotOptions {
    /// Folders of packages by name: `package://NAME/rest` is `rest` in that folder. A package that is not here is looked for
    /// beside the URDF: in the folders that hold it, and beside them.
    pub packages: BTreeMap<String, PathBuf>,
}

impl RobotOptions {
    /// No packages.
    pub const fn new() -> Self {
        Self { packages: BTreeMap::new() }
    }

    /// With the folder of a package.
    #[must_use]
    pub fn with_package(mut self, name: impl Into<String>, folder: impl Into<PathBuf>) -> Self {
        self.packages.insert(name.into(), folder.into());
        self
    }
}
