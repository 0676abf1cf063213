#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! [`read_mesh`] reads a mesh from a file, by its extension.
//!
//! ## Meshes in
//! - [`read_mesh`], [`read_mesh_with`], [`parse_mesh`]: from a file, or from its bytes in a [`MeshFormat`];
//!   they answer with a [`ReadMesh`].
//! - [`ReadOptions`]: scale, [`Unit`], [`Merging`] of vertices.
//! - [`MeshReport`]: what was found: [`Precision`] of the numbers, [`UpAxis`], [`PolygonCounts`].
//!
//! ## Meshes out
//! [`obj_text`], [`ply_bytes`], [`glb_bytes`].
//!
//! ## Motions and scenes
//! - [`read_motion`]: the motion of a JSON file; [`check_keyframes`]: do its spans meet, for a body of this size?
//!   [`pose_at_rest`]: of a body that does not move.
//! - [`SceneFile`], [`SceneEntry`], [`ScenePair`] and [`SceneTerms`]: scenes; [`parse_scale`]: a key of them.
//!
//! ## Files of any kind
//! [`read_bytes`] and [`read_unsized`]; [`parse_json`] with [`UniqueKeys`], [`json_fault`]; [`excerpt`] and
//! [`short_value`] for messages.
//!
//! ## Answers out
//! What the command prints and a page shows, in one place:
//! - JSON: [`contact_fields`], [`clearance_fields`], [`distance_fields`]; [`feature_field`], [`start_in_json`].
//! - Words: [`verdict_word`], [`clearance_word`], [`clearance_words`], [`start_word`], [`evidence_sentence`], [`feature_sentence`], [`short_number`],
//!   [`vector_words`]; all lines of an answer: [`answer_lines`], [`AnswerLines`]; of an error: [`query_fault`]; of a proof:
//!   [`verdict_sentence`], [`put_verdict`], [`joined_verdict`].
//! - Times: [`proven_spans`], each a [`ProvenSpan`] of which something [`Holds`].
//!
//! ## Errors
//! [`IoError`] with its [`Place`] in the file; [`UnknownUnit`].
#![doc(html_root_url = "https://docs.rs/d2m-io")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod answer;
mod bytes;
mod error;
mod json;
mod mesh;
mod motion;
mod scene;
mod scene_fault;
mod scene_pair;
mod scene_terms;
mod text;
mod write;

pub use answer::{
    AnswerLines, Holds, ProvenSpan, answer_lines, clearance_fields, clearance_word, clearance_words,
    contact_fields, distance_fields, evidence_sentence, feature_field, feature_sentence, joined_verdict,
    proven_spans, put_verdict, query_fault, short_number, start_in_json, start_word, vector_words,
    verdict_sentence, verdict_word,
};
pub use bytes::{read_bytes, read_unsized};
pub use error::{IoError, Place};
pub use json::{UniqueKeys, json_fault, parse_json};
pub use mesh::{
    Merging, MeshFormat, MeshReport, PolygonCounts, Precision, ReadMesh, ReadOptions, Unit, UnknownUnit,
    UpAxis, parse_mesh, read_mesh, read_mesh_with,
};
pub use motion::{check_keyframes, pose_at_rest, read_motion};
pub use scene::{SceneEntry, SceneFile, parse_scale};
pub use scene_pair::ScenePair;
pub use scene_terms::SceneTerms;
pub use text::{excerpt, short_value};
pub use write::{glb_bytes, obj_text, ply_bytes};
