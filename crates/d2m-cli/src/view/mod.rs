//! One page of HTML that shows bodies in motion, without anything that is fetched; and still pictures.

mod base64;
mod display_mesh;
mod flight;
mod mark;
mod pair_spans;
mod path;
mod picture;
mod rounded;
mod run;
mod scene;
mod still;

pub(crate) use d2m_io::{Holds, ProvenSpan as Span};
pub(crate) use flight::{Flight, flights_of, push_thinned};
pub(crate) use mark::Mark;
pub(crate) use path::picture_of_path;
pub(crate) use picture::{DistanceSample, Picture, Up};
pub(crate) use run::picture_of_run;
pub(crate) use scene::picture_of_scene;
pub(crate) use still::{StillSize, still};
