#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod bytes;
mod error;
mod json;
mod mesh;
mod motion;
mod scene;
mod text;
mod write;

pub use bytes::{read_bytes, read_unsized};
pub use error::{IoError, Place};
pub use json::{UniqueKeys, json_fault, parse_json};
pub use mesh::{
    Merging, MeshFormat, MeshReport, PolygonCounts, Precision, ReadMesh, ReadOptions, Unit, UnknownUnit,
    UpAxis, parse_mesh, read_mesh, read_mesh_with,
};
pub use motion::read_motion;
pub use scene::{SceneEntry, SceneFile, parse_scale};
pub use text::excerpt;
pub use write::{glb_bytes, obj_text, ply_bytes};
