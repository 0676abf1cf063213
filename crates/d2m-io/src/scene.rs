//! Scene files: bodies with their meshes and motions.

use crate::json::parse_object;
use crate::scene_fault::{check_distance, fault, keys_of};
use crate::scene_terms::TermsForm;
use crate::{IoError, ReadOptions, ScenePair, SceneTerms, UniqueKeys, read_bytes, read_mesh_with};
use d2m_bvh::{MeshTree, Start, Window};
use d2m_motion::{AnyMotion, ConstantTwist};
use glam::DVec3;
use serde::Deserialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// What a scene file says, checked, with its meshes still as names.
///
/// ```
/// use d2m_io::SceneFile;
/// let scene = SceneFile::parse(br#"{"window": [0, 2], "bodies": [
///     {"name": "gear", "mesh": "shape:gear", "scale": 0.1, "motion": {"w": [0, 0, 1]}},
///     {"name": "wall", "mesh": "shape:box", "group": "fixed"}], "ignore": [["gear", "fixed"]]}"#)?;
/// assert_eq!((scene.window.end(), scene.bodies[0].scale.x), (2.0, 0.1));
/// let gear = scene.bodies[0].load(".".as_ref())?;
/// assert!(gear.is_watertight());
///
/// let fault = SceneFile::parse(br#"{"bodies": [{"name": "a", "mesh": "shape:box", "scale": 0}]}"#).unwrap_err();
/// assert_eq!(fault.to_string(), "body 0 (\"a\"), scale: 0 has to be finite and not zero");
/// # Ok::<(), d2m_io::IoError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SceneFile {
    /// The times that count; from 0 to 1 if left out.
    pub window: Window,
    /// The bodies in the order of the file; no two have the same name.
    pub bodies: Vec<SceneEntry>,
    /// Pairs of names of bodies or groups that are not checked. Each name is one of the scene.
    pub ignore: Vec<[String; 2]>,
    /// Distance at which bodies count as in contact, at least zero.
    pub min_separation: f64,
    /// The tolerance, a positive distance, if it is given.
    pub tolerance: Option<f64>,
    /// What counts of bodies that are in contact at the start.
    pub start: Start,
    /// What single pairs have of their own. No two are of the same pair.
    pub pairs: Vec<ScenePair>,
}

/// One body of a scene file.
///
/// ```
/// use d2m_io::SceneFile;
/// let scene = SceneFile::parse(br#"{"bodies": [{"name": "gear", "mesh": "shape:gear", "scale": 0.1, "group": "fixed"}]}"#)?;
/// let gear = &scene.bodies[0];
/// assert_eq!((gear.name.as_str(), gear.scale.y, gear.group.as_deref()), ("gear", 0.1, Some("fixed")));
/// # Ok::<(), d2m_io::IoError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SceneEntry {
    /// Its name, which is not empty.
    pub name: String,
    /// A file, relative to the scene's folder, or `shape:…`.
    pub mesh: String,
    /// Factors of the mesh's axes, finite and not zero.
    pub scale: DVec3,
    /// How it moves; at rest if left out.
    pub motion: AnyMotion,
    /// The group of bodies to which it belongs.
    pub group: Option<String>,
    /// Does it count as a solid? None: if its mesh is watertight.
    pub solid: Option<bool>,
    /// The body is everything within this distance of its mesh; finite, not negative, zero if left out.
    pub radius: f64,
}

/// The keys of a scene file; what is inside of them is checked one by one, so that messages can say where.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneForm {
    #[serde(default)]
    window: Option<Value>,
    bodies: Vec<UniqueKeys>,
    #[serde(default)]
    ignore: Vec<UniqueKeys>,
    #[serde(default)]
    min_separation: Option<Value>,
    #[serde(default)]
    tolerance: Option<Value>,
    #[serde(default)]
    start: Option<Value>,
    #[serde(default)]
    pairs: Vec<UniqueKeys>,
}

/// The keys of a body.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EntryForm {
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
    #[serde(default)]
    radius: f64,
}

impl SceneFile {
    /// Reads a scene file; its meshes are read by [`SceneEntry::load`].
    ///
    /// # Errors
    /// [`IoError`] with the file, line and column or body, key and value.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, IoError> {
        let path = path.as_ref();
        Self::parse(&read_bytes(path)?).map_err(|error| error.in_file(path.display().to_string()))
    }

    /// Reads the bytes of a scene file.
    ///
    /// # Errors
    /// [`IoError`] with line and column or body, key and value.
    pub fn parse(bytes: &[u8]) -> Result<Self, IoError> {
        let form: SceneForm = parse_object(bytes).map_err(hinted)?;
        let SceneForm { window, min_separation, tolerance, start, .. } = form;
        let terms = SceneTerms::checked(TermsForm { window, min_separation, tolerance, start })?;
        let mut bodies: Vec<SceneEntry> = Vec::with_capacity(form.bodies.len());
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        for (index, UniqueKeys(value)) in form.bodies.into_iter().enumerate() {
            let place = SceneEntry::place(index, &value);
            let body = SceneEntry::parse(value, &place)?;
            if let Some(earlier) = names.insert(body.name.clone(), index) {
                let reason = format!("the name {:?} is that of body {earlier} too", body.name);
                return Err(fault(format!("body {index}"), reason));
            }
            bodies.push(body);
        }
        let is_known = |name: &str| {
            names.contains_key(name) || bodies.iter().any(|body| body.group.as_deref() == Some(name))
        };
        let mut ignore = Vec::with_capacity(form.ignore.len());
        for (index, UniqueKeys(value)) in form.ignore.into_iter().enumerate() {
            let place = format!("ignore {index}");
            let Ok(pair) = serde_json::from_value::<[String; 2]>(value.clone()) else {
                return Err(fault(place, format!("{value} is not a pair of names")));
            };
            if let Some(name) = pair.iter().find(|name| !is_known(name)) {
                return Err(fault(place, format!("{name:?} is the name of no body and of no group")));
            }
            ignore.push(pair);
        }
        let names: BTreeSet<&str> = names.keys().map(String::as_str).collect();
        let pairs = ScenePair::parse_all(form.pairs, &names)?;
        let SceneTerms { window, min_separation, tolerance, start } = terms;
        Ok(Self {
            window: window.unwrap_or(Window::UNIT),
            bodies,
            ignore,
            min_separation: min_separation.unwrap_or_default(),
            tolerance,
            start: start.unwrap_or_default(),
            pairs,
        })
    }
}

impl SceneEntry {
    /// Where a body is in messages: by its number, and its name if it has one.
    pub fn place(index: usize, value: &Value) -> String {
        match value.get("name").and_then(Value::as_str) {
            Some(name) => format!("body {index} ({name:?})"),
            None => format!("body {index}"),
        }
    }

    /// Reads a body's object, which has no other keys than those of this type; `place` names it in messages.
    ///
    /// # Errors
    /// [`IoError::Content`] with the place, key and value.
    pub fn parse(value: Value, place: &str) -> Result<Self, IoError> {
        let form: EntryForm = keys_of(place, value).map_err(hinted)?;
        if form.name.is_empty() {
            return Err(fault(place, "the name is empty"));
        }
        let scale =
            parse_scale(form.scale.as_ref()).map_err(|reason| fault(format!("{place}, scale"), reason))?;
        let motion = match form.motion {
            None => AnyMotion::ConstantTwist(ConstantTwist::REST),
            Some(value) => {
                serde_json::from_value(value).map_err(|error| fault(format!("{place}, motion"), error))?
            }
        };
        check_distance(&format!("{place}, radius"), form.radius)?;
        let EntryForm { name, mesh, group, solid, radius, .. } = form;
        Ok(Self { name, mesh, scale, motion, group, solid, radius })
    }

    /// Reads the mesh and builds its tree; `folder` is that of the scene file.
    ///
    /// # Errors
    /// [`IoError`] with the name of the mesh, line or index, and the value found.
    pub fn load(&self, folder: &Path) -> Result<MeshTree, IoError> {
        let options = ReadOptions::new().with_scale(self.scale);
        if let Some(text) = self.mesh.strip_prefix("shape:") {
            let mesh = d2m_shapes::mesh(text).map_err(|error| fault("mesh", error))?;
            return Ok(MeshTree::new(options.apply(mesh)?));
        }
        let path = folder.join(&self.mesh);
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("d2mtree")) {
            let tree = MeshTree::try_from_bytes(&read_bytes(&path)?);
            let tree = tree.map_err(|error| fault(path.display().to_string(), error))?;
            return Ok(if self.scale == DVec3::ONE {
                tree
            } else {
                MeshTree::new(options.apply(tree.into_mesh())?)
            });
        }
        Ok(MeshTree::new(read_mesh_with(path, &options)?.mesh))
    }
}

/// A fault of a scene that may be a simulation.
fn hinted(error: IoError) -> IoError {
    const OF_SIMULATIONS: [&str; 6] = ["simulation", "kind", "density", "mass", "joints", "velocity"];
    let is_of_one =
        |text: &str| OF_SIMULATIONS.iter().any(|key| text.contains(&format!("unknown field `{key}`")));
    match error {
        IoError::Content { place, reason } if is_of_one(&reason) => {
            let reason = format!("{reason}; a simulation is run by d2m simulate SCENE.json --out RUN.jsonl");
            IoError::Content { place, reason }
        }
        other => other,
    }
}

/// The value of a key `scale`: one number, or one for each axis; negative ones mirror. Without a value it is one.
///
/// ```
/// assert_eq!(d2m_io::parse_scale(Some(&serde_json::json!([1, 2, -3]))).unwrap().z, -3.0);
/// ```
///
/// # Errors
/// A sentence with the value: it is neither form, zero, or not finite.
pub fn parse_scale(value: Option<&Value>) -> Result<DVec3, String> {
    let Some(value) = value else { return Ok(DVec3::ONE) };
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
