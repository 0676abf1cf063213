//! Contacts that are marked, and what is proven of spans of time.

use d2m::bvh::{Contact, TriMesh};
use glam::DVec3;
use serde_json::{Value, json};

/// A contact that is marked over a span of time.
pub(crate) struct Mark {
    pub(crate) from: f64,
    pub(crate) until: f64,
    /// The point on each body; equal where only one is known.
    pub(crate) points: [DVec3; 2],
    pub(crate) normal: DVec3,
    /// The pair of triangles, where they are known.
    pub(crate) triangles: Option<MarkedTriangles>,
}

/// Two triangles that meet, in the frames of their bodies.
pub(crate) struct MarkedTriangles {
    /// Numbers of the bodies.
    pub(crate) bodies: [usize; 2],
    pub(crate) corners: [[DVec3; 3]; 2],
}

impl Mark {
    /// The contact of two bodies of these numbers and meshes.
    pub(crate) fn of_contact(contact: &Contact, bodies: [usize; 2], meshes: [&TriMesh; 2]) -> Self {
        let corners =
            [meshes[0].corners(contact.triangle_a as usize), meshes[1].corners(contact.triangle_b as usize)];
        Self {
            from: contact.time_lo,
            until: contact.time_hi,
            points: [contact.point_a, contact.point_b],
            normal: contact.normal,
            triangles: Some(MarkedTriangles { bodies, corners }),
        }
    }

    pub(super) fn to_json(&self) -> Value {
        let mut mark = json!({
            "from": self.from,
            "until": self.until,
            "points": self.points.map(|p| p.to_array()),
            "normal": self.normal.to_array(),
        });
        if let Some(MarkedTriangles { bodies, corners }) = &self.triangles {
            mark["bodies"] = json!(bodies);
            mark["triangles"] = json!(corners.map(|triangle| triangle.map(|p| p.to_array())));
        }
        mark
    }
}

/// What is proven of a span of time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Holds {
    /// No two bodies that count are in contact.
    Clear,
    /// The contact is within this span.
    Contact,
    /// The search could not decide.
    Undecided,
    /// Nobody asked.
    Unknown,
}

/// A span of time, with what is proven of it in words.
pub(crate) struct Span {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) holds: Holds,
    pub(crate) text: String,
}

impl Span {
    pub(crate) fn new(from: f64, to: f64, holds: Holds, text: &str) -> Self {
        Self { from, to, holds, text: text.to_owned() }
    }

    pub(super) fn to_json(&self) -> Value {
        let status = match self.holds {
            Holds::Clear => "clear",
            Holds::Contact => "contact",
            Holds::Undecided => "undecided",
            Holds::Unknown => "unknown",
        };
        json!({ "from": self.from, "to": self.to, "status": status, "text": self.text })
    }
}
