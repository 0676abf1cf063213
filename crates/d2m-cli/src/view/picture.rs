//! What a page shows.

use super::base64::base64;
use super::display_mesh::DisplayMesh;
use super::{Flight, Mark, Span};
use d2m::bvh::TriMesh;
use serde_json::{Value, json};

/// The parts of three.js that the page uses; `assets/three/README.md` says how they are made.
const THREE: &str = include_str!("../../assets/three/three.min.js");
const PAGE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/style.css");
/// The page's own script, in the order in which its parts use each other.
const SCRIPT: [&str; 5] = [
    include_str!("page/bodies.js"),
    include_str!("page/marks.js"),
    include_str!("page/timeline.js"),
    include_str!("page/frame.js"),
    include_str!("page/main.js"),
];

/// The axis that points up on the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Up {
    /// As in graphics and in most scenes
    Y,
    /// As robots have it
    Z,
}

/// A body of a picture.
pub(crate) struct PictureBody {
    pub(crate) name: String,
    /// The number of its mesh.
    pub(crate) mesh: usize,
    pub(crate) flights: Vec<Flight>,
}

/// The distance of two bodies at one time: proven to be in [`lower`, `upper`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct DistanceSample {
    pub(crate) time: f64,
    pub(crate) lower: f64,
    pub(crate) upper: f64,
}

/// Bodies that move over a window.
pub(crate) struct Picture {
    pub(crate) headline: String,
    /// Labels and values.
    pub(crate) facts: Vec<[String; 2]>,
    pub(crate) notes: Vec<String>,
    pub(crate) window: [f64; 2],
    /// Seconds are seconds; otherwise the whole window takes a few.
    pub(crate) is_real_time: bool,
    pub(crate) up: Up,
    pub(crate) meshes: Vec<DisplayMesh>,
    pub(crate) bodies: Vec<PictureBody>,
    pub(crate) marks: Vec<Mark>,
    /// What is proven of the window's times, joined.
    pub(crate) spans: Vec<Span>,
    pub(crate) curve: Vec<DistanceSample>,
}

impl Picture {
    pub(crate) fn new(headline: String, window: [f64; 2]) -> Self {
        Self {
            headline,
            facts: Vec::new(),
            notes: Vec::new(),
            window,
            is_real_time: false,
            up: Up::Y,
            meshes: Vec::new(),
            bodies: Vec::new(),
            marks: Vec::new(),
            spans: Vec::new(),
            curve: Vec::new(),
        }
    }

    pub(crate) fn add_fact(&mut self, label: &str, value: impl Into<String>) {
        self.facts.push([label.to_owned(), value.into()]);
    }

    /// Adds a mesh and returns its number. One of very many triangles is shown coarser, and a note says so.
    /// Of a body with a radius everything within it of its mesh is shown.
    pub(crate) fn add_mesh(&mut self, name: &str, mesh: &TriMesh, radius: f64) -> usize {
        let shown = DisplayMesh::new(mesh, radius);
        if shown.triangles.len() < mesh.triangle_count() {
            let (few, all) = (shown.triangles.len(), mesh.triangle_count());
            self.notes.push(format!("{name} is drawn with {few} of its {all} triangles; answers are of all"));
        }
        self.meshes.push(shown);
        self.meshes.len() - 1
    }

    pub(crate) fn add_body(&mut self, name: &str, mesh: usize, flights: Vec<Flight>) {
        self.bodies.push(PictureBody { name: name.to_owned(), mesh, flights });
    }

    /// The page.
    pub(crate) fn to_html(&self) -> String {
        let meshes: Vec<Value> = self.meshes.iter().map(DisplayMesh::to_json).collect();
        let bodies = self.bodies.iter().map(|body| {
            let numbers = body.flights.iter().flat_map(Flight::numbers);
            let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
            json!({ "name": body.name, "mesh": body.mesh, "flights": base64(&bytes) })
        });
        let data = json!({
            "headline": self.headline,
            "facts": self.facts,
            "notes": self.notes,
            "window": self.window,
            "real_time": self.is_real_time,
            "up": if self.up == Up::Z { "z" } else { "y" },
            "meshes": meshes,
            "bodies": bodies.collect::<Vec<_>>(),
            "marks": self.marks.iter().map(Mark::to_json).collect::<Vec<_>>(),
            "spans": self.spans.iter().map(Span::to_json).collect::<Vec<_>>(),
            "curve": self.curve.iter().map(|at| [at.time, at.lower, at.upper]).collect::<Vec<_>>(),
        });
        // No name of a body can end the script that holds it.
        let data = data.to_string().replace('<', "\\u003c");
        let script = SCRIPT.join("\n");
        let script = format!("\"use strict\";\n{script}");
        let mut page = String::with_capacity(PAGE.len() + data.len() + THREE.len() + script.len());
        // Each part is put in once, and never looked through for the places of others.
        let mut rest = PAGE;
        for (place, text) in
            [("{{STYLE}}", STYLE), ("{{DATA}}", &data), ("{{THREE}}", THREE), ("{{SCRIPT}}", &script)]
        {
            let (before, after) = rest.split_once(place).unwrap_or((rest, ""));
            page.push_str(before);
            page.push_str(text);
            rest = after;
        }
        page.push_str(rest);
        page
    }
}
