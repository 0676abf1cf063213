//! A scene in place of two meshes, as `d2m clearance` and `d2m spans` take it.

use crate::arguments::{Method, MotionArguments, PairArguments, QueryArguments};
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
        let tolerance = query.tolerance.as_ref().map(|_| "--tolerance");
        let given = said_by_scenes(&arguments.motions, query).into_iter().chain(tolerance);
        given.take(1).try_for_each(|option| Err(Failure::at(option, SAID_BY_THE_SCENE)))?;
        if query.mode != Method::Accurate {
            return Err(Failure::at("--mode", "only accurate answers this question of a scene"));
        }
        let scene = Scene::read(Path::new(&arguments.a))?;
        scene.warn(&arguments.a);
        let world = scene.world(options_of(query)?);
        let options = *world.options();
        Ok(Self { scene, world, options })
    }
}

/// What a message says of an option that a scene has in its file.
pub(super) const SAID_BY_THE_SCENE: &str = "the scene says this itself, in its file";

/// The options that were given and that a scene states in its file, of each of its bodies or of all. Of some of them it may say nothing: a default
/// stands for that.
pub(super) fn said_by_scenes(motions: &MotionArguments, query: &QueryArguments) -> Vec<&'static str> {
    let QueryArguments { min_separation, solid, sizes, .. } = query;
    let given = [
        ("--motion-a", !motions.motion_a.is_empty()),
        ("--motion-b", !motions.motion_b.is_empty()),
        ("--window", motions.window.is_some()),
        ("--min-separation", min_separation.is_some()),
        ("--solid", solid.solid),
        ("--surface", solid.surface),
        ("--scale-a", sizes.scale_a.is_some()),
        ("--scale-b", sizes.scale_b.is_some()),
        ("--unit-a", sizes.unit_a.is_some()),
        ("--unit-b", sizes.unit_b.is_some()),
        ("--radius-a", sizes.radius_a.is_some()),
        ("--radius-b", sizes.radius_b.is_some()),
    ];
    given.into_iter().filter_map(|(option, is_given)| is_given.then_some(option)).collect()
}

/// The last line of a text about a scene: the smallest and the largest body, and which goes and turns the furthest.
pub(super) fn sizes_line_of(scene: &Scene) -> String {
    let named: Vec<(&str, f64, Travel)> = scene
        .bodies
        .iter()
        .map(|body| (body.name.as_str(), body.size(), Travel::of(&body.motion, scene.window)))
        .collect();
    scene_sizes_line(&named)
}
