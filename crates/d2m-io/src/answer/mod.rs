//! Answers as they are written: in JSON for programs, in words for people.

mod fault;
mod fields;
mod lines;
mod proof;
mod span;
mod words;

pub use fault::query_fault;
pub use fields::{clearance_fields, contact_fields, distance_fields};
pub use lines::{AnswerLines, answer_lines};
pub use proof::{joined_verdict, put_verdict, verdict_sentence};
pub use span::{Holds, ProvenSpan, proven_spans};
pub use words::{
    clearance_word, clearance_words, evidence_sentence, feature_field, feature_sentence, short_number,
    start_in_json, start_word, vector_words, verdict_word,
};
