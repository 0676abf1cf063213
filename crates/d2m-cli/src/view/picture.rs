//! What a page shows.

use super::Flight;
use d2m::bvh::TriMesh;
use glam::DVec3;
use serde_json::{Value, json};

/// The parts of three.js that the page uses; `assets/three/README.md` says how they are made.
const THREE: &str = include_str!("../../assets/three/three.min.js");
const PAGE: &str = include_str!("page.html");

/// A contact that is marked over a span of time.
pub(crate) struct Mark {
    pub(crate) from: f64,
    pub(crate) until: f64,
    pub(crate) point: DVec3,
    pub(crate) normal: DVec3,
}

/// Bodies that move over a window.
pub(crate) struct Picture {
    headline: String,
    facts: Vec<String>,
    window: [f64; 2],
    /// Seconds are seconds; otherwise the whole window takes a few.
    is_real_time: bool,
    meshes: Vec<Value>,
    bodies: Vec<Value>,
    marks: Vec<Value>,
}

impl Picture {
    pub(crate) fn new(headline: String, facts: Vec<String>, window: [f64; 2], is_real_time: bool) -> Self {
        let (meshes, bodies, marks) = (Vec::new(), Vec::new(), Vec::new());
        Self { headline, facts, window, is_real_time, meshes, bodies, marks }
    }

    /// Adds a mesh and returns its number.
    pub(crate) fn add_mesh(&mut self, mesh: &TriMesh) -> usize {
        let used = || mesh.triangles().iter().flatten().map(|&i| mesh.vertices()[i as usize]);
        let low = used().fold(DVec3::INFINITY, DVec3::min);
        let high = used().fold(DVec3::NEG_INFINITY, DVec3::max);
        let center = low * 0.5 + high * 0.5;
        // Single precision is enough about the center of the mesh, and all that graphics cards take.
        let vertices = mesh.vertices().iter().flat_map(|&vertex| (vertex - center).as_vec3().to_array());
        let vertices: Vec<u8> = vertices.flat_map(f32::to_le_bytes).collect();
        let triangles: Vec<u8> = mesh.triangles().iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
        self.meshes.push(json!({
            "center": center.to_array(),
            "vertices": base64(&vertices),
            "triangles": base64(&triangles),
        }));
        self.meshes.len() - 1
    }

    /// Adds a body with the number of its mesh.
    pub(crate) fn add_body(&mut self, name: &str, mesh: usize, flights: &[Flight]) {
        let segments: Vec<Value> = flights.iter().map(Flight::to_json).collect();
        self.bodies.push(json!({ "name": name, "mesh": mesh, "segments": segments }));
    }

    pub(crate) fn add_mark(&mut self, mark: &Mark) {
        self.marks.push(json!({
            "from": mark.from,
            "until": mark.until,
            "point": mark.point.to_array(),
            "normal": mark.normal.to_array(),
        }));
    }

    /// The page.
    pub(crate) fn to_html(&self) -> String {
        let data = json!({
            "headline": self.headline,
            "facts": self.facts,
            "window": self.window,
            "real_time": self.is_real_time,
            "meshes": self.meshes,
            "bodies": self.bodies,
            "marks": self.marks,
        });
        // No name of a body can end the script that holds it.
        let data = data.to_string().replace('<', "\\u003c");
        let (before, rest) = PAGE.split_once("{{DATA}}").unwrap_or((PAGE, ""));
        let (between, after) = rest.split_once("{{THREE}}").unwrap_or((rest, ""));
        [before, &data, between, THREE, after].concat()
    }
}

/// RFC 4648, with padding.
fn base64(bytes: &[u8]) -> String {
    const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |index: usize| u32::from(three.get(index).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for place in 0..4 {
            let letter = ALPHABET[(bits >> (18 - 6 * place) & 63) as usize];
            text.push(if place <= three.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_rfc() {
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }
}
