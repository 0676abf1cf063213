//! Meshes as the bytes of files.

mod glb;
mod obj;
mod ply;
#[cfg(test)]
mod tests;

pub use glb::glb_bytes;
pub use obj::obj_text;
pub use ply::ply_bytes;
