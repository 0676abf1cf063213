//! The numbers that accessors find in buffers.

use super::document::{Accessor, Document};
use crate::bytes::read_bytes;
use crate::mesh::Fault;
use crate::mesh::assembly::Allowance;
use crate::text::{check_coordinate, excerpt};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// A vertex or a triangle takes twelve bytes at least, with normals twice as many.
const BYTES_OF_AN_ELEMENT: usize = 16;

pub(super) struct Buffers<'a> {
    document: &'a Document,
    binary: Option<&'a [u8]>,
    folder: Option<&'a Path>,
    /// Each buffer once it was read.
    known: Vec<Option<Cow<'a, [u8]>>>,
    /// The files that buffers were read from.
    pub(super) files: Vec<PathBuf>,
}

/// The bytes of the elements of an accessor.
struct Elements<'b> {
    bytes: &'b [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'b> Elements<'b> {
    fn iter(&self) -> impl Iterator<Item = &'b [u8]> {
        let (bytes, stride, size) = (self.bytes, self.stride, self.size);
        (0..self.count).map(move |index| bytes.get(index * stride..index * stride + size).unwrap_or_default())
    }
}

impl<'a> Buffers<'a> {
    pub(super) fn new(document: &'a Document, binary: Option<&'a [u8]>, folder: Option<&'a Path>) -> Self {
        Self { document, binary, folder, known: vec![None; document.buffers.len()], files: Vec::new() }
    }

    /// Three coordinates an element.
    pub(super) fn positions(&mut self, index: usize, allowance: &mut Allowance) -> Result<Vec<DVec3>, Fault> {
        let accessor = self.accessor(index, "VEC3")?;
        let (kind, normalized) = (accessor.component_type, accessor.normalized);
        let read = Component::new(kind)
            .ok_or_else(|| Fault::new(format!("accessor {index}: {kind} is no type of positions")))?;
        let elements = self.elements(index, 3 * read.size(), allowance)?;
        allowance.spend(elements.count)?;
        let mut positions = Vec::with_capacity(elements.count);
        for (number, element) in elements.iter().enumerate() {
            let mut position = [0.0; 3];
            for ((axis, slot), word) in
                ["x", "y", "z"].into_iter().zip(&mut position).zip(element.chunks_exact(read.size()))
            {
                *slot = if normalized { read.part(word) } else { read.value(word) };
                check_coordinate(axis, *slot)
                    .map_err(|reason| Fault::new(format!("accessor {index}, element {number}: {reason}")))?;
            }
            positions.push(DVec3::from_array(position));
        }
        Ok(positions)
    }

    /// Indices of vertices, of which there are `limit`.
    pub(super) fn indices(
        &mut self,
        index: usize,
        limit: usize,
        allowance: &mut Allowance,
    ) -> Result<Vec<u32>, Fault> {
        let kind = self.accessor(index, "SCALAR")?.component_type;
        let size = match kind {
            5121 => 1,
            5123 => 2,
            5125 => 4,
            _ => return Err(Fault::new(format!("accessor {index}: {kind} is no type of indices"))),
        };
        let elements = self.elements(index, size, allowance)?;
        allowance.spend(elements.count)?;
        let mut indices = Vec::with_capacity(elements.count);
        for (number, element) in elements.iter().enumerate() {
            let value = element.iter().rev().fold(0_u32, |value, &byte| value << 8 | u32::from(byte));
            if value as usize >= limit {
                return Err(Fault::new(format!(
                    "accessor {index}, element {number}: vertex index {value} is out of range, the mesh has {limit} vertices"
                )));
            }
            indices.push(value);
        }
        Ok(indices)
    }

    fn accessor(&self, index: usize, kind: &str) -> Result<&'a Accessor, Fault> {
        let fault = |reason: String| Fault::new(format!("accessor {index}: {reason}"));
        let accessors = &self.document.accessors;
        let accessor = accessors.get(index);
        let accessor = accessor.ok_or_else(|| fault(format!("there are only {}", accessors.len())))?;
        if accessor.kind != kind {
            return Err(fault(format!("its type is {}, not {kind}", excerpt(&accessor.kind))));
        }
        if accessor.sparse.is_some() {
            return Err(fault("sparse accessors are not supported".to_owned()));
        }
        Ok(accessor)
    }

    /// Checked: the last element ends within the view, and the view within the buffer.
    fn elements(
        &mut self,
        index: usize,
        size: usize,
        allowance: &mut Allowance,
    ) -> Result<Elements<'_>, Fault> {
        let fault = |reason: String| Fault::new(format!("accessor {index}: {reason}"));
        let document = self.document;
        let accessor = &document.accessors[index];
        let number = accessor.buffer_view.ok_or_else(|| fault("it has no bufferView".to_owned()))?;
        let views = &document.buffer_views;
        let view = views
            .get(number)
            .ok_or_else(|| fault(format!("bufferView {number} of {} does not exist", views.len())))?;
        let stride = if view.byte_stride == 0 { size } else { view.byte_stride };
        let last = accessor.count.saturating_sub(1).checked_mul(stride);
        let needed = last.and_then(|last| last.checked_add(size)?.checked_add(accessor.byte_offset));
        let needed = if accessor.count == 0 { Some(0) } else { needed };
        if stride < size || needed.is_none_or(|needed| needed > view.byte_length) {
            return Err(fault(format!(
                "{} elements of {size} bytes, {stride} apart, do not fit into the {} bytes of bufferView {number}",
                accessor.count, view.byte_length
            )));
        }
        let buffer = self.buffer(view.buffer, allowance)?;
        let bytes = view
            .byte_offset
            .checked_add(view.byte_length)
            .and_then(|end| buffer.get(view.byte_offset..end))
            .ok_or_else(|| {
                let (start, length) = (view.byte_offset, view.byte_length);
                let there = buffer.len();
                Fault::new(format!(
                    "bufferView {number}: {length} bytes from byte {start} go beyond the {there} bytes of its buffer"
                ))
            })?;
        let bytes = bytes.get(accessor.byte_offset..).unwrap_or_default();
        Ok(Elements { bytes, stride, size, count: accessor.count })
    }

    fn buffer(&mut self, index: usize, allowance: &mut Allowance) -> Result<&[u8], Fault> {
        let fault = |reason: String| Fault::new(format!("buffer {index}: {reason}"));
        let buffers = &self.document.buffers;
        let buffer = buffers.get(index).ok_or_else(|| fault(format!("there are only {}", buffers.len())))?;
        if self.known[index].is_none() {
            let bytes: Cow<'a, [u8]> = match (&buffer.uri, self.binary) {
                (None, Some(binary)) if index == 0 => binary.into(),
                (None, _) => return Err(fault("it has no uri, and the file no such part".to_owned())),
                (Some(uri), _) => {
                    let Read { bytes, file } = uri_bytes(uri, self.folder).map_err(fault)?;
                    self.files.extend(file);
                    bytes.into()
                }
            };
            // Many buffers may name one file.
            allowance.spend(bytes.len() / BYTES_OF_AN_ELEMENT)?;
            if bytes.len() < buffer.byte_length {
                let (stated, there) = (buffer.byte_length, bytes.len());
                return Err(fault(format!("{stated} bytes are stated, {there} are there")));
            }
            self.known[index] = Some(bytes);
        }
        Ok(self.known[index].as_deref().unwrap_or_default())
    }
}

/// The bytes of a buffer.
struct Read {
    bytes: Vec<u8>,
    /// None: they are in the text itself.
    file: Option<PathBuf>,
}

/// Bytes in the text itself, or of a file beside it.
fn uri_bytes(uri: &str, folder: Option<&Path>) -> Result<Read, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (_, text) = data.split_once(";base64,").ok_or("a data uri that is not base64")?;
        let bytes = STANDARD.decode(text.trim()).map_err(|error| format!("base64: {error}"))?;
        return Ok(Read { bytes, file: None });
    }
    let path = percent_decoded(uri);
    let shown = excerpt(&path);
    if path.contains(':') || Path::new(&path).is_absolute() || path.starts_with(['/', '\\']) {
        return Err(format!("{shown} is not a file beside this one"));
    }
    let folder = folder.ok_or_else(|| format!("it is in the file {shown}, which bytes alone cannot name"))?;
    let file = folder.join(path);
    let bytes = read_bytes(&file).map_err(|error| error.to_string())?;
    Ok(Read { bytes, file: Some(file) })
}

fn percent_decoded(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while at < bytes.len() {
        let digits = uri.get(at + 1..at + 3).filter(|_| bytes[at] == b'%');
        if let Some(byte) = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            decoded.push(byte);
            at += 3;
        } else {
            decoded.push(bytes[at]);
            at += 1;
        }
    }
    String::from_utf8_lossy(&decoded).into_owned()
}

/// How a coordinate is stored.
#[derive(Clone, Copy)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    F32,
}

impl Component {
    fn new(kind: u32) -> Option<Self> {
        match kind {
            5120 => Some(Self::I8),
            5121 => Some(Self::U8),
            5122 => Some(Self::I16),
            5123 => Some(Self::U16),
            5126 => Some(Self::F32),
            _ => None,
        }
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::F32 => 4,
        }
    }

    /// A normalized integer stands for its part of the greatest one.
    fn part(self, word: &[u8]) -> f64 {
        let greatest = match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32767.0,
            Self::U16 => 65535.0,
            Self::F32 => 1.0,
        };
        let part = self.value(word) / greatest;
        if matches!(self, Self::F32) { part } else { part.max(-1.0) }
    }

    fn value(self, word: &[u8]) -> f64 {
        match (self, word) {
            (Self::I8, &[a]) => f64::from(i8::from_le_bytes([a])),
            (Self::U8, &[a]) => f64::from(a),
            (Self::I16, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
            (Self::U16, &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
            (Self::F32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => f64::NAN, // no such word is cut
        }
    }
}
