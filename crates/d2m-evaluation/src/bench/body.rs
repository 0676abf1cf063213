//! Bodies and pairs of bodies of the bench.

use super::peers;
use crate::judge::BoxTree;
use d2m::bvh::{MeshArrays, MeshTree, TriMesh};
use d2m_paper::SphereTree;
use glam::DVec3;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::{Arc, OnceLock};

type Error = Box<dyn std::error::Error>;

/// A mesh with what each method needs of it.
pub(crate) struct Body {
    pub(crate) tree: MeshTree,
    pub(crate) boxes: BoxTree,
    /// Built when first needed: not every run asks the peers.
    parry: OnceLock<peers::Mesh>,
    /// The reference method's tree.
    spheres: OnceLock<SphereTree>,
}

impl Body {
    /// Scaled about the origin so that the farthest vertex is at distance 1, as the trials want it.
    pub(crate) fn unit_mesh(vertices: &[DVec3], triangles: Vec<[u32; 3]>) -> Result<TriMesh, Error> {
        let radius = vertices.iter().map(|v| v.length()).fold(0.0, f64::max);
        // Files are used as they are if they follow the convention already: the judge of others must agree on bits.
        let scale = if (radius - 1.0).abs() < 1e-6 { 1.0 } else { radius.recip() };
        let vertices: Vec<DVec3> = vertices.iter().map(|&v| v * scale).collect();
        Ok(TriMesh::try_new(vertices, triangles)?)
    }

    /// An embedded shape such as `gear` or `torus-knot?triangles=70000`, scaled like that.
    pub(crate) fn unit_shape(spec: &str) -> Result<TriMesh, Error> {
        let mesh = super::built::shape(spec)?;
        Self::unit_mesh(mesh.vertices(), mesh.triangles().to_vec())
    }

    /// A model in an OBJ file, scaled like that.
    pub(crate) fn unit_file(path: &Path) -> Result<TriMesh, Error> {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let MeshArrays { vertices, triangles } =
            parse_obj(&text).map_err(|e| format!("{}:{e}", path.display()))?;
        Self::unit_mesh(&vertices, triangles)
    }

    /// A mesh and the trees of engine and judge.
    pub(crate) fn new(mesh: TriMesh) -> Arc<Self> {
        Self::with_tree(super::built::build(mesh))
    }

    /// The same where the engine's tree is there already.
    pub(crate) fn with_tree(tree: MeshTree) -> Arc<Self> {
        let boxes = BoxTree::build(tree.mesh().vertices(), tree.mesh().triangles());
        Arc::new(Self { tree, boxes, parry: OnceLock::new(), spheres: OnceLock::new() })
    }

    /// The embedded shape with its trees.
    pub(crate) fn embedded(spec: &str) -> Result<Arc<Self>, Error> {
        Ok(Self::new(Self::unit_shape(spec)?))
    }

    pub(crate) fn triangle_count(&self) -> usize {
        self.tree.mesh().triangle_count()
    }

    pub(crate) fn parry(&self) -> &peers::Mesh {
        self.parry.get_or_init(|| peers::mesh(self.tree.mesh()))
    }

    pub(crate) fn spheres(&self) -> &SphereTree {
        self.spheres.get_or_init(|| SphereTree::new(self.tree.mesh().clone()))
    }
}

/// An OBJ file of a mesh, its numbers in full precision.
pub(crate) fn write_obj(path: &Path, mesh: &TriMesh) -> std::io::Result<()> {
    let mut text = String::new();
    for v in mesh.vertices() {
        let _ = writeln!(text, "v {} {} {}", v.x, v.y, v.z);
    }
    for [a, b, c] in mesh.triangles() {
        let _ = writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1);
    }
    std::fs::write(path, text)
}

/// The vertices and faces of an OBJ file in full precision; polygons become fans. An error begins with its line.
fn parse_obj(text: &str) -> Result<MeshArrays, String> {
    let (mut vertices, mut triangles): (Vec<DVec3>, _) = (Vec::new(), Vec::new());
    for (number, line) in text.lines().enumerate() {
        let place = |what: &str| format!("{}: {what}: {line}", number + 1);
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let numbers: Vec<f64> = words.take(3).filter_map(|w| w.parse().ok()).collect();
                vertices.push(DVec3::from_array(numbers.try_into().map_err(|_| place("no three numbers"))?));
            }
            Some("f") => {
                let corner = |word: &str| {
                    let index: i64 = word.split('/').next()?.parse().ok()?;
                    let index = if index < 0 { index + vertices.len() as i64 } else { index - 1 };
                    u32::try_from(index).ok()
                };
                let face = words.map(corner).collect::<Option<Vec<u32>>>().ok_or_else(|| place("no face"))?;
                triangles.extend((2..face.len()).map(|k| [face[0], face[k - 1], face[k]]));
            }
            _ => {}
        }
    }
    Ok(MeshArrays { vertices, triangles })
}

/// Two bodies and the name of their pair in tables.
pub(crate) struct Pair {
    pub(crate) name: String,
    pub(crate) a: Arc<Body>,
    pub(crate) b: Arc<Body>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn obj() {
        let text = "# c\nv 0 0 0\nv 1 0 0 0.5\nv 0 1e0 0\nv 0 0 1\nf 1/2/3 2 3\nf -4 -3 -2 -1\n";
        let MeshArrays { vertices, triangles } = parse_obj(text).unwrap();
        assert_eq!(vertices[1], DVec3::X);
        assert_eq!(triangles, [[0, 1, 2], [0, 1, 2], [0, 2, 3]]);
        let path = std::env::temp_dir().join(format!("d2m-body-{}.obj", std::process::id()));
        let shape = Body::unit_shape("icosphere?triangles=80").unwrap();
        write_obj(&path, &shape).unwrap();
        let back = Body::unit_file(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert!(back.vertices() == shape.vertices() && back.triangles() == shape.triangles());
        assert!(parse_obj("v 0 0\n").unwrap_err().starts_with("1: no three"));
        assert!(parse_obj("v 0 0 0\nf 1 0 1\n").unwrap_err().starts_with("2: no face"));
    }
}
