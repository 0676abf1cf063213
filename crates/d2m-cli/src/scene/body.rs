//! One body of a scene file.

use crate::failure::Failure;
use crate::mesh_library::{MeshLibrary, read_scale};
use crate::motion::require_window;
use crate::orientation::warn_of_json;
use d2m::bvh::{MeshTree, Solid, Window};
use d2m::motion::AnyMotion;
use serde::Deserialize;
use serde_json::Value;
use std::sync::Arc;

/// The keys of a body.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BodyForm {
    name: String,
    mesh: String,
    #[serde(default)]
    scale: Option<Value>,
    #[serde(default)]
    motion: Option<Value>,
    #[serde(default)]
    group: Option<String>,
    #[serde(default)]
    solid: Option<bool>,
}

/// A body as every kind of scene has it.
pub(crate) struct SceneBody {
    pub(crate) name: String,
    pub(crate) tree: Arc<MeshTree>,
    pub(crate) motion: AnyMotion,
    pub(crate) group: Option<String>,
    pub(crate) solid: Solid,
}

/// Where a body is in messages: by its number, and its name if it has one.
pub(crate) fn place_of(index: usize, value: &Value) -> String {
    match value.get("name").and_then(Value::as_str) {
        Some(name) => format!("body {index} ({name:?})"),
        None => format!("body {index}"),
    }
}

/// A fault of a scene that may be a simulation.
pub(super) fn hinted(error: &serde_json::Error) -> String {
    const OF_SIMULATIONS: [&str; 4] = ["simulation", "kind", "density", "mass"];
    let text = error.to_string();
    if OF_SIMULATIONS.iter().any(|key| text.contains(&format!("unknown field `{key}`"))) {
        format!("{text}; a simulation is run by d2m simulate SCENE.json --out RUN.jsonl")
    } else {
        text
    }
}

impl SceneBody {
    /// Reads a body's object, which has no other keys than those above; its motion covers the window.
    pub(crate) fn read(
        value: Value,
        place: &str,
        window: Window,
        library: &mut MeshLibrary,
    ) -> Result<Self, Failure> {
        let form: BodyForm =
            serde_json::from_value(value).map_err(|error| Failure::at(place, hinted(&error)))?;
        if form.name.is_empty() {
            return Err(Failure::at(place, "the name is empty"));
        }
        let scale = read_scale(form.scale.as_ref())
            .map_err(|reason| Failure::at(format!("{place}, scale"), reason))?;
        let tree =
            library.tree(&form.mesh, scale).map_err(|error| Failure::at(format!("{place}, mesh"), error))?;
        let motion = match form.motion {
            None => AnyMotion::ConstantTwist(d2m::ConstantTwist::REST),
            Some(value) => {
                let place = format!("{place}, motion");
                warn_of_json(&place, &value);
                serde_json::from_value(value).map_err(|error| Failure::at(place, error))?
            }
        };
        // Twice the radius is a bound on the size that spans of keyframes have to meet by.
        motion
            .check_size(2.0 * tree.radius())
            .map_err(|error| Failure::at(format!("{place}, motion"), error))?;
        require_window(&format!("{place}, motion"), &motion, window)?;
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
