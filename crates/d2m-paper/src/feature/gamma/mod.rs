//! Γ: the tests that refuse roots of f which are no contact (Algorithm 4 and section IV-C of the paper).

mod edge_edge;
mod point_triangle;

pub(crate) use edge_edge::{EdgeJet, gamma_edge_edge};
pub(crate) use point_triangle::gamma_point_face;
