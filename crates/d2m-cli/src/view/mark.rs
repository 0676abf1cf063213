//! Contacts that are marked.

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
