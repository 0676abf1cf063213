//! One body of a scene file.

use crate::failure::Failure;
use crate::load::load;
use d2m::bvh::{MeshTree, Solid, TriMesh};
use d2m::motion::AnyMotion;
use glam::DVec3;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The keys of a body.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BodyForm {
    pub(crate) name: String,
    pub(crate) mesh: String,
    #[serde(default)]
    pub(crate) scale: Option<Value>,
    #[serde(default)]
    pub(crate) motion: Option<Value>,
    #[serde(default)]
    pub(crate) group: Option<String>,
    #[serde(default)]
    pub(crate) solid: Option<bool>,
}

/// A body, ready for a world.
pub(crate) struct SceneBody {
    pub(crate) name: String,
    pub(crate) tree: Arc<MeshTree>,
    pub(crate) motion: AnyMotion,
    pub(crate) group: Option<String>,
    pub(crate) solid: Solid,
}

/// Where a body is in messages: by its number, and its name if it has one.
pub(super) fn place_of(index: usize, value: &Value) -> String {
    match value.get("name").and_then(Value::as_str) {
        Some(name) => format!("body {index} ({name:?})"),
        None => format!("body {index}"),
    }
}

impl SceneBody {
    pub(super) fn new(form: BodyForm, place: &str, library: &mut MeshLibrary) -> Result<Self, Failure> {
        if form.name.is_empty() {
            return Err(Failure::at(place, "the name is empty"));
        }
        let scale = match &form.scale {
            None => DVec3::ONE,
            Some(value) => {
                read_scale(value).map_err(|reason| Failure::at(format!("{place}, scale"), reason))?
            }
        };
        let tree =
            library.tree(&form.mesh, scale).map_err(|error| Failure::at(format!("{place}, mesh"), error))?;
        let motion = match form.motion {
            None => AnyMotion::ConstantTwist(d2m::ConstantTwist::REST),
            Some(value) => serde_json::from_value(value)
                .map_err(|error| Failure::at(format!("{place}, motion"), error))?,
        };
        // Twice the radius is a bound on the size that spans of keyframes have to meet by.
        motion
            .check_size(2.0 * tree.radius())
            .map_err(|error| Failure::at(format!("{place}, motion"), error))?;
        let solid = match form.solid {
            Some(true) if !tree.is_watertight() => {
                let reason =
                    format!("true, but the mesh {} is not watertight and bounds no solid", form.mesh);
                return Err(Failure::at(format!("{place}, solid"), reason));
            }
            Some(false) => Solid::Surface,
            None if !tree.is_watertight() => Solid::Surface,
            Some(true) | None => Solid::Filled,
        };
        Ok(Self { name: form.name, tree, motion, group: form.group, solid })
    }
}

/// One number, or one for each axis; mirrors with negative ones.
fn read_scale(value: &Value) -> Result<DVec3, String> {
    let numbers = match value {
        Value::Number(number) => vec![number.as_f64(); 3],
        Value::Array(list) => list.iter().map(Value::as_f64).collect(),
        _ => Vec::new(),
    };
    let [Some(x), Some(y), Some(z)] = numbers[..] else {
        return Err(format!("{value} is neither a number nor a list of three"));
    };
    let scale = DVec3::new(x, y, z);
    if scale.is_finite() && scale.abs().min_element() > 0.0 {
        Ok(scale)
    } else {
        Err(format!("{value} has to be finite and not zero"))
    }
}

/// Trees by mesh and scale: bodies with the same share one.
pub(crate) struct MeshLibrary {
    folder: PathBuf,
    trees: BTreeMap<(String, [u64; 3]), Arc<MeshTree>>,
}

impl MeshLibrary {
    /// Meshes are named relative to the folder of the scene file.
    pub(crate) fn new(scene: &Path) -> Self {
        Self { folder: scene.parent().unwrap_or(Path::new("")).to_owned(), trees: BTreeMap::new() }
    }

    /// The tree of a file or `shape:…`, scaled.
    pub(crate) fn tree(&mut self, mesh: &str, scale: DVec3) -> Result<Arc<MeshTree>, Failure> {
        let key = (mesh.to_owned(), scale.to_array().map(f64::to_bits));
        if let Some(tree) = self.trees.get(&key) {
            return Ok(Arc::clone(tree));
        }
        let source = if mesh.starts_with("shape:") {
            mesh.to_owned()
        } else {
            self.folder.join(mesh).to_string_lossy().into_owned()
        };
        let loaded = load(&source)?;
        let tree = if scale == DVec3::ONE {
            loaded.into_tree()
        } else {
            let (vertices, triangles) = loaded.into_mesh().into_parts();
            let scaled = vertices.into_iter().map(|vertex| vertex * scale).collect();
            let mesh = TriMesh::try_new(scaled, triangles)
                .map_err(|error| Failure::at(&source, format!("scaled by {scale}: {error}")))?;
            MeshTree::new(mesh)
        };
        let tree = Arc::new(tree);
        self.trees.insert(key, Arc::clone(&tree));
        Ok(tree)
    }
}
