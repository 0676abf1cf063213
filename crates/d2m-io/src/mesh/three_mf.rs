//! 3MF: a zip archive (read by `zip`) of XML, with doubles. The items of the build are read, with the components of their objects,
//! each in its place; files of the production extension may stand in several parts.

use super::assembly::{Assembly, affine};
use super::{Fault, RawMesh, xml};
use crate::text::excerpt;
use d2m_bvh::TriMesh;
use glam::{DAffine3, DVec3};
use roxmltree::{Document, Node};
use std::collections::BTreeMap;
use std::io::{Cursor, Read};
use std::rc::Rc;
use zip::ZipArchive;

/// Bytes that the parts of an archive may unpack to, or this many times its own: XML of numbers shrinks to a tenth, a forged archive to a thousandth.
const MOST_UNPACKED: u64 = 1 << 28;
const MOST_TIMES: u64 = 64;

/// Objects that a build may place: objects whose components name each other again and again would never end.
const MOST_VISITS: usize = 1 << 20;

/// The extensions whose absence changes no surface, or which are read.
const KNOWN_EXTENSIONS: [&str; 3] = ["/production/", "/material/", "/slice/"];

pub(super) fn parse(bytes: &[u8]) -> Result<RawMesh, Fault> {
    let mut archive = Archive::new(bytes)?;
    let main = archive.main_model()?;
    let mut models = Models { archive, known: BTreeMap::new() };
    let root = models.model(&main)?;
    let mut assembly = Assembly::new(bytes.len());
    let mut visits = 0_usize;
    let mut waiting: Vec<Placed> = Vec::new();
    for item in root.build.iter().rev() {
        waiting.push(Placed {
            reference: item.clone(),
            map: DAffine3::IDENTITY,
            model: main.clone(),
            depth: 0,
        });
    }
    while let Some(Placed { reference, map, model, depth }) = waiting.pop() {
        let path = reference.path.clone().unwrap_or(model);
        let part = models.model(&path)?;
        let id = &reference.object;
        let object = part.objects.get(id).ok_or_else(|| {
            Fault::new(format!("{path}: object {} is referred to and not defined", excerpt(id)))
        })?;
        let map = map * reference.map;
        visits += 1 + object.components.len();
        if depth > MOST_DEPTH || visits > MOST_VISITS {
            let what =
                if depth > MOST_DEPTH { "nest too deep or contain themselves" } else { "are used too often" };
            return Err(Fault::new(format!("{path}: components {what} at object {}", excerpt(id))));
        }
        if let Some(mesh) = &object.mesh {
            assembly.add(mesh, &map)?;
        }
        for component in object.components.iter().rev() {
            waiting.push(Placed { reference: component.clone(), map, model: path.clone(), depth: depth + 1 });
        }
    }
    let mut raw = assembly.finish();
    if raw.triangles.is_empty() {
        return Err(Fault::new(format!("{main}: its build of {} items holds no mesh", root.build.len())));
    }
    raw.report.meters_per_unit = Some(root.meters);
    Ok(raw)
}

/// Levels of components: writers use one or two.
const MOST_DEPTH: usize = 64;

struct Placed {
    reference: Reference,
    map: DAffine3,
    /// The part of the archive in which the reference stands.
    model: String,
    depth: usize,
}

/// A named part of the archive, as text.
struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    left: u64,
}

impl<'a> Archive<'a> {
    fn new(bytes: &'a [u8]) -> Result<Self, Fault> {
        let zip = ZipArchive::new(Cursor::new(bytes))
            .map_err(|error| Fault::new(format!("not a zip archive: {error}")))?;
        Ok(Self { zip, left: MOST_UNPACKED.max(MOST_TIMES.saturating_mul(bytes.len() as u64)) })
    }

    fn text(&mut self, name: &str) -> Result<String, Fault> {
        let fault = |error: &dyn std::fmt::Display| Fault::new(format!("{name}: {error}"));
        let file = self.zip.by_name(name).map_err(|error| fault(&error))?;
        let mut bytes = Vec::new();
        file.take(self.left + 1).read_to_end(&mut bytes).map_err(|error| fault(&error))?;
        self.left = self
            .left
            .checked_sub(bytes.len() as u64)
            .ok_or_else(|| fault(&"it unpacks to more than any model of this size"))?;
        Ok(String::from_utf8_lossy(&bytes).trim_start_matches('\u{feff}').to_owned())
    }

    /// The part that the relationships of the package name, or its usual name.
    fn main_model(&mut self) -> Result<String, Fault> {
        const USUAL: &str = "3D/3dmodel.model";
        if self.zip.index_for_name("_rels/.rels").is_none() {
            return Ok(USUAL.to_owned());
        }
        let text = self.text("_rels/.rels")?;
        let document = xml::document(&text).map_err(|fault| within("_rels/.rels", &fault))?;
        let is_model = |relation: &Node<'_, '_>| {
            relation.attribute("Type").is_some_and(|kind| kind.ends_with("/3dmodel"))
        };
        let target = document.root_element().children().find(is_model).and_then(|r| r.attribute("Target"));
        Ok(target.map_or(USUAL, |target| target.trim_start_matches('/')).to_owned())
    }
}

fn within(part: &str, fault: &Fault) -> Fault {
    let line = fault.line.map(|line| format!(", line {line}")).unwrap_or_default();
    Fault::new(format!("{part}{line}: {}", fault.reason))
}

/// The parts that were read.
struct Models<'a> {
    archive: Archive<'a>,
    known: BTreeMap<String, Rc<Model>>,
}

impl Models<'_> {
    fn model(&mut self, path: &str) -> Result<Rc<Model>, Fault> {
        if let Some(model) = self.known.get(path) {
            return Ok(Rc::clone(model));
        }
        let text = self.archive.text(path)?;
        let read = xml::document(&text).and_then(|document| Model::read(&document));
        let model = Rc::new(read.map_err(|fault| within(path, &fault))?);
        self.known.insert(path.to_owned(), Rc::clone(&model));
        Ok(model)
    }
}

struct Model {
    meters: f64,
    objects: BTreeMap<String, Object>,
    build: Vec<Reference>,
}

struct Object {
    mesh: Option<TriMesh>,
    components: Vec<Reference>,
}

/// An object in a place.
#[derive(Clone)]
struct Reference {
    /// The part in which it is; none: the same one.
    path: Option<String>,
    object: String,
    map: DAffine3,
}

impl Model {
    fn read(document: &Document<'_>) -> Result<Self, Fault> {
        let root = document.root_element();
        if root.tag_name().name() != "model" {
            return Err(xml::fault(root, "the root element of a model is <model>"));
        }
        for prefix in root.attribute("requiredextensions").unwrap_or_default().split_whitespace() {
            let uri = root.lookup_namespace_uri(Some(prefix)).unwrap_or(prefix);
            if !KNOWN_EXTENSIONS.iter().any(|known| uri.contains(known)) {
                let reason = format!("the extension {} is required and not supported", excerpt(uri));
                return Err(xml::fault(root, reason));
            }
        }
        let meters = match root.attribute("unit").unwrap_or("millimeter") {
            "micron" => 1e-6,
            "millimeter" => 1e-3,
            "centimeter" => 1e-2,
            "inch" => 0.0254,
            "foot" => 0.3048,
            "meter" => 1.0,
            other => return Err(xml::fault(root, format!("{} is not a unit of 3MF", excerpt(other)))),
        };
        let mut objects = BTreeMap::new();
        let resources = xml::children(root, "resources");
        for object in resources.flat_map(|resources| xml::children(resources, "object")) {
            let id = xml::attribute(object, "id")?.to_owned();
            let read = Object::read(object)?;
            if objects.insert(id.clone(), read).is_some() {
                return Err(xml::fault(object, format!("the id {} is used twice", excerpt(&id))));
            }
        }
        let items = xml::children(root, "build").flat_map(|build| xml::children(build, "item"));
        let build = items.map(Reference::read).collect::<Result<_, _>>()?;
        Ok(Self { meters, objects, build })
    }
}

impl Reference {
    fn read(node: Node<'_, '_>) -> Result<Self, Fault> {
        let object = xml::attribute(node, "objectid")?.to_owned();
        // In the namespace of the production extension.
        let path = node.attributes().find(|attribute| attribute.name() == "path");
        let path = path.map(|path| path.value().trim_start_matches('/').to_owned());
        let map = match node.attribute("transform") {
            None => DAffine3::IDENTITY,
            Some(text) => {
                // Three rows and the translation: points are rows in front of the matrix.
                let [a, b, c, d, e, f, g, h, i, j, k, l] = xml::numbers(node, text.split_whitespace())?;
                affine([[a, b, c], [d, e, f], [g, h, i], [j, k, l]])
            }
        };
        Ok(Self { path, object, map })
    }
}

impl Object {
    fn read(object: Node<'_, '_>) -> Result<Self, Fault> {
        let lists = xml::children(object, "components");
        let components = lists.flat_map(|list| xml::children(list, "component"));
        let components = components.map(Reference::read).collect::<Result<_, _>>()?;
        let mesh = xml::child(object, "mesh").map(mesh).transpose()?.flatten();
        Ok(Self { mesh, components })
    }
}

/// None: a mesh without triangles.
fn mesh(node: Node<'_, '_>) -> Result<Option<TriMesh>, Fault> {
    let list = |outer: &'static str, inner: &'static str| {
        xml::children(node, outer).flat_map(move |list| xml::children(list, inner))
    };
    let coordinate = |vertex: Node<'_, '_>, axis: &str| xml::number(vertex, xml::attribute(vertex, axis)?);
    let mut vertices = Vec::new();
    for v in list("vertices", "vertex") {
        vertices.push(DVec3::new(coordinate(v, "x")?, coordinate(v, "y")?, coordinate(v, "z")?));
    }
    let mut triangles = Vec::new();
    for triangle in list("triangles", "triangle") {
        let corner = |name: &str| -> Result<u32, Fault> {
            let missing = || xml::fault(triangle, format!("the attribute {name} is missing"));
            let index: u32 = xml::whole(triangle, name)?.ok_or_else(missing)?;
            if index as usize >= vertices.len() {
                let reason =
                    format!("{name} is {index}, out of range: the mesh has {} vertices", vertices.len());
                return Err(xml::fault(triangle, reason));
            }
            Ok(index)
        };
        triangles.push([corner("v1")?, corner("v2")?, corner("v3")?]);
    }
    if triangles.is_empty() {
        return Ok(None);
    }
    TriMesh::try_new(vertices, triangles).map(Some).map_err(|error| xml::fault(node, error.to_string()))
}
