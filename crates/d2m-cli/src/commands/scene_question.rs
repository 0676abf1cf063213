//! A scene in place of two meshes, as `d2m clearance` and `d2m spans` take it.

use crate::arguments::{Method, PairArguments};
use crate::engine::options_of;
use crate::failure::Failure;
use crate::scene::Scene;
use crate::sizes::scene_sizes_line;
use crate::travel::Travel;
use d2m::World;
use d2m::bvh::QueryOptions;
use std::path::Path;

/// A scene and its world.
pub(super) struct SceneQuestion {
    pub(super) scene: Scene,
    pub(super) world: World,
    /// Of all pairs that have none of their own.
    pub(super) options: QueryOptions,
}

/// Is a scene given in place of two meshes?
pub(super) fn is_scene(arguments: &PairArguments) -> bool {
    let is_json = Path::new(&arguments.a).extension().is_some_and(|end| end.eq_ignore_ascii_case("json"));
    is_json && arguments.b.is_none()
}

impl SceneQuestion {
    /// Reads the scene. What it says itself is no option.
    pub(super) fn read(arguments: &PairArguments) -> Result<Self, Failure> {
        let query = &arguments.query;
        let given = [
            ("--motion-a", !arguments.motions.motion_a.is_empty()),
            ("--motion-b", !arguments.motions.motion_b.is_empty()),
            ("--window", arguments.motions.window != WINDOW),
            ("--tolerance", query.tolerance.is_some()),
            ("--min-separation", query.min_separation.is_some()),
            ("--solid", query.solid.solid),
            ("--surface", query.solid.surface),
            ("--scale-a", query.sizes.scale_a.is_some()),
            ("--scale-b", query.sizes.scale_b.is_some()),
            ("--unit-a", query.sizes.unit_a.is_some()),
            ("--unit-b", query.sizes.unit_b.is_some()),
            ("--radius-a", query.sizes.radius_a.is_some()),
            ("--radius-b", query.sizes.radius_b.is_some()),
        ];
        if let Some((option, _)) = given.into_iter().find(|(_, given)| *given) {
            return Err(Failure::at(option, "the scene says this itself, in its file"));
        }
        if query.mode != Method::Accurate {
            return Err(Failure::at("--mode", "only accurate answers this question of a scene"));
        }
        let scene = Scene::read(Path::new(&arguments.a))?;
        scene.warn_of_sizes(&arguments.a);
        let world = scene.world(options_of(query)?);
        let options = *world.options();
        Ok(Self { scene, world, options })
    }
}

/// The window if none is given.
const WINDOW: &str = "0,1";

/// The last line of a text about a scene: the smallest and the largest body, and which goes and turns the furthest.
pub(super) fn sizes_line_of(scene: &Scene) -> String {
    let named: Vec<(&str, f64, Travel)> = scene
        .bodies
        .iter()
        .map(|body| (body.name.as_str(), body.size(), Travel::of(&body.motion, scene.window)))
        .collect();
    scene_sizes_line(&named)
}
