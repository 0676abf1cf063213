#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod bytes;
mod error;
mod mesh;
mod text;
mod write;

pub use bytes::{read_bytes, read_unsized};
pub use error::{IoError, Place};
pub use mesh::{
    Merging, MeshFormat, MeshReport, PolygonCounts, Precision, ReadMesh, ReadOptions, Unit, UnknownUnit,
    UpAxis, parse_mesh, read_mesh, read_mesh_with,
};
pub use text::excerpt;
pub use write::{glb_bytes, obj_text, ply_bytes};
