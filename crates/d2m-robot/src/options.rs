//! How a robot is read.

use d2m_bvh::MeshTree;
use glam::DVec3;
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use std::sync::Arc;

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
    /// Meshes that are not read from files, by name and bits of the scale.
    pub(crate) meshes: HashMap<(String, [u64; 3]), Arc<MeshTree>>,
}

impl RobotOptions {
    /// No packages.
    pub fn new() -> Self {
        Self::default()
    }

    /// With a mesh that is there already: no file is read for what the URDF names so with this scale. The vertices of the tree are
    /// scaled.
    #[must_use]
    pub fn with_mesh(mut self, name: impl Into<String>, scale: DVec3, tree: Arc<MeshTree>) -> Self {
        self.meshes.insert((name.into(), scale.to_array().map(f64::to_bits)), tree);
        self
    }

    /// With the folder of a package.
    #[must_use]
    pub fn with_package(mut self, name: impl Into<String>, folder: impl Into<PathBuf>) -> Self {
        self.packages.insert(name.into(), folder.into());
        self
    }
}
