//! The d2m command: certified time of contact of two meshes from the command line.
fn main() {}
