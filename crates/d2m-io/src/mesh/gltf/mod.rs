//! glTF 2.0, as text with buffers beside it (`.gltf`) or in one binary file (`.glb`).
//!
//! The JSON is read by `serde_json` with doubles: transforms of nodes are not rounded to single precision. Positions are stored in
//! single precision or as integers, each of which is a double. Every mesh of the scene is read at rest, in its place.

mod buffers;
mod document;
mod scene;

use super::assembly::Assembly;
use super::{Fault, Precision, RawMesh, Source, UpAxis};
use buffers::Buffers;
use document::Document;

/// The extensions that may be required because they change no surface, or are read.
const KNOWN_EXTENSIONS: [&str; 4] =
    ["KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "EXT_texture_"];

pub(super) fn parse(source: &Source<'_>) -> Result<RawMesh, Fault> {
    let bytes = source.bytes;
    let container =
        if bytes.starts_with(b"glTF") { container(bytes)? } else { Container { json: bytes, binary: None } };
    let json = container.json.strip_prefix("\u{feff}".as_bytes()).unwrap_or(container.json);
    let document: Document = serde_json::from_slice(json).map_err(|error| Fault::new(error.to_string()))?;
    if !document.asset.version.starts_with("2.") {
        return Err(Fault::new(format!(
            "asset.version is {:?}: only glTF 2 is supported",
            document.asset.version
        )));
    }
    for extension in &document.extensions_required {
        if !KNOWN_EXTENSIONS.iter().any(|known| extension.starts_with(known)) {
            return Err(Fault::new(format!("the extension {extension} is required and not supported")));
        }
    }
    let mut assembly = Assembly::new(bytes.len());
    let mut buffers = Buffers::new(&document, container.binary, source.folder);
    scene::place(&document, &mut buffers, &mut assembly)?;
    let mut raw = assembly.finish();
    raw.report.precision = Precision::Single("glTF");
    raw.report.meters_per_unit = Some(1.0);
    raw.report.up_axis = Some(UpAxis::Y);
    raw.report.files = buffers.files;
    Ok(raw)
}

struct Container<'a> {
    json: &'a [u8],
    binary: Option<&'a [u8]>,
}

/// The chunks of a binary file.
fn container(bytes: &[u8]) -> Result<Container<'_>, Fault> {
    let word = |at: usize| -> Option<u32> {
        let four: [u8; 4] = bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
        Some(u32::from_le_bytes(four))
    };
    match word(4) {
        Some(2) => {}
        Some(version) => return Err(Fault::new(format!("the container has version {version}, not 2"))),
        None => return Err(Fault::new("the container ends in its header")),
    }
    let stated = word(8).unwrap_or(0) as usize;
    if stated > bytes.len() {
        return Err(Fault::new(format!(
            "the header states {stated} bytes, but the file has {}",
            bytes.len()
        )));
    }
    let (mut json, mut binary, mut at) = (None, None, 12);
    while let (Some(length), Some(kind)) = (word(at), word(at + 4)) {
        let start = at + 8;
        let chunk = bytes.get(start..start.saturating_add(length as usize)).ok_or_else(|| {
            Fault::new(format!("a chunk of {length} bytes at byte {at} goes beyond the end of the file"))
        })?;
        match kind.to_le_bytes() {
            [b'J', b'S', b'O', b'N'] if json.is_none() => json = Some(chunk),
            [b'B', b'I', b'N', 0] if binary.is_none() => binary = Some(chunk),
            _ => {}
        }
        at = start + length as usize;
    }
    let json = json.ok_or_else(|| Fault::new("the container has no JSON chunk"))?;
    Ok(Container { json, binary })
}
