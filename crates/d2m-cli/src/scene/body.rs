//! One body of a scene file.

use crate::failure::Failure;
use crate::mesh_library::MeshLibrary;
use crate::motion::require_window;
use crate::travel::{Travel, warn_of_turn};
use d2m::bvh::{MeshTree, Moving, Solid, Window};
use d2m::motion::AnyMotion;
use d2m_io::{SceneEntry, check_keyframes};
use serde_json::Value;
use std::sync::Arc;

/// A body as every kind of scene has it.
pub(crate) struct SceneBody {
    pub(crate) name: String,
    pub(crate) tree: Arc<MeshTree>,
    pub(crate) motion: AnyMotion,
    pub(crate) group: Option<String>,
    pub(crate) solid: Solid,
    /// The body is everything within this distance of its mesh.
    pub(crate) radius: f64,
}

impl SceneBody {
    /// Reads a body's object, which has no other keys than those above; its motion covers the window.
    pub(crate) fn read(
        value: Value,
        place: &str,
        window: Window,
        library: &mut MeshLibrary,
    ) -> Result<Self, Failure> {
        Self::new(SceneEntry::parse(value, place)?, place, window, library)
    }

    /// The body that an entry of a scene file describes; its motion covers the window.
    pub(crate) fn new(
        entry: SceneEntry,
        place: &str,
        window: Window,
        library: &mut MeshLibrary,
    ) -> Result<Self, Failure> {
        let SceneEntry { name, mesh, scale, motion, group, solid, radius, .. } = entry;
        let tree =
            library.tree(&mesh, scale).map_err(|error| Failure::at(format!("{place}, mesh"), error))?;
        check_keyframes(&motion, tree.mesh())
            .map_err(|error| Failure::at(format!("{place}, motion"), error))?;
        require_window(&format!("{place}, motion"), &motion, window)?;
        warn_of_turn(&format!("{place}, motion"), Travel::of(&motion, window));
        let solid = match (solid, tree.usual_solid()) {
            (Some(true), Solid::Surface) => {
                let reason = format!("true, but the mesh {mesh} is not watertight and bounds no solid");
                return Err(Failure::at(format!("{place}, solid"), reason));
            }
            (Some(false), _) => Solid::Surface,
            (_, usual) => usual,
        };
        Ok(Self { name, tree, motion, group, solid, radius })
    }

    /// The diagonal of the box around the body.
    pub(crate) fn size(&self) -> f64 {
        self.tree.mesh().size() + 2.0 * self.radius
    }

    /// Its name and size.
    pub(crate) fn named_size(&self) -> (&str, f64) {
        (&self.name, self.size())
    }

    /// The form that the pair queries take.
    pub(crate) fn moving(&self) -> Moving<'_> {
        let tree: &MeshTree = &self.tree;
        Moving::new(tree, &self.motion).with_solid(self.solid).with_radius(self.radius)
    }
}
