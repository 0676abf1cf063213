//! Answers as records of a structured array: words of eight bytes, which `d2m_ccd._records` gives names.

use d2m::Proximity;
use d2m::bvh::{Evidence, StartState, TimeOfContact};
use d2m::feature::FeaturePair;
use d2m_io::feature_field;
use glam::DVec3;

/// Words of an answer about moving bodies.
pub(crate) const ANSWER_WORDS: usize = 24;
/// Words of an answer about an edge of a robot.
pub(crate) const EDGE_WORDS: usize = ANSWER_WORDS + 2;
/// Words of a proximity.
pub(crate) const PROXIMITY_WORDS: usize = 15;

/// Writes words one after another; numbers as their bits.
struct Writer<'a> {
    words: core::slice::IterMut<'a, u64>,
}

impl Writer<'_> {
    fn word(&mut self, word: u64) {
        if let Some(place) = self.words.next() {
            *place = word;
        }
    }

    fn numbers(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|number| self.word(number.to_bits()));
    }

    fn vector(&mut self, vector: DVec3) {
        self.numbers(&vector.to_array());
    }

    fn pair(&mut self, [first, second]: [u32; 2]) {
        let ([a, b, c, d], [e, f, g, h]) = (first.to_ne_bytes(), second.to_ne_bytes());
        self.word(u64::from_ne_bytes([a, b, c, d, e, f, g, h]));
    }
}

/// Kind of features, and their numbers.
fn features(feature: FeaturePair) -> (u8, [u32; 4]) {
    match feature {
        FeaturePair::VertexFace { vertex, face } => (1, [vertex, face, 0, 0]),
        FeaturePair::FaceVertex { face, vertex } => (2, [face, vertex, 0, 0]),
        FeaturePair::EdgeEdge { edge_a: [p, q], edge_b: [r, s] } => (3, [p, q, r, s]),
    }
}

/// Writes an answer; what a verdict does not have stays zero.
pub(crate) fn write_answer(answer: &TimeOfContact, words: &mut [u64]) {
    let mut writer = Writer { words: words.iter_mut() };
    match answer {
        TimeOfContact::Separated => {
            writer.word(u64::from_ne_bytes([0; 8]));
            writer.numbers(&[f64::INFINITY, f64::INFINITY]);
        }
        TimeOfContact::Undecided { clear_until } => {
            writer.word(u64::from_ne_bytes([2, 0, 0, 0, 0, 0, 0, 0]));
            writer.numbers(&[*clear_until, f64::INFINITY]);
        }
        TimeOfContact::Contact(contact) => {
            let evidence = match contact.evidence {
                Evidence::Crossing => 2,
                Evidence::Near => 1,
                _ => 0,
            };
            let start = match contact.start {
                StartState::Apart => 0,
                StartState::Touching => 1,
                StartState::Overlapping => 2,
                StartState::Contained => 3,
                StartState::Undecided => 4,
            };
            let (kind, [p, q, r, s]) = features(contact.feature);
            writer.word(u64::from_ne_bytes([1, evidence, start, kind, 0, 0, 0, 0]));
            writer.numbers(&[contact.time_lo, contact.time_hi, contact.separation, contact.tolerance]);
            writer.numbers(&[contact.closing_speed]);
            [contact.normal, contact.point_a, contact.point_b].into_iter().for_each(|v| writer.vector(v));
            writer.numbers(&contact.barycentric_a);
            writer.numbers(&contact.barycentric_b);
            writer.pair([contact.triangle_a, contact.triangle_b]);
            writer.pair([p, q]);
            writer.pair([r, s]);
        }
    }
}

/// What is known of an edge of a robot.
pub(crate) struct Meeting {
    /// Of the pair that meets first.
    pub(crate) answer: TimeOfContact,
    /// The part of the edge that is proven free.
    pub(crate) free_until: f64,
    /// That pair, by the places of its names.
    pub(crate) bodies: [Option<u32>; 2],
}

/// Writes what is known of an edge.
pub(crate) fn write_edge(meeting: &Meeting, words: &mut [u64]) {
    let (answer, rest) = words.split_at_mut(ANSWER_WORDS.min(words.len()));
    write_answer(&meeting.answer, answer);
    let mut writer = Writer { words: rest.iter_mut() };
    writer.numbers(&[meeting.free_until]);
    // All bits: -1 of a signed number.
    writer.pair(meeting.bodies.map(|place| place.unwrap_or(u32::MAX)));
}

/// Writes a proximity.
pub(crate) fn write_proximity(proximity: &Proximity, words: &mut [u64]) {
    let mut writer = Writer { words: words.iter_mut() };
    let (kind, [p, q, r, s]) = features(proximity.feature);
    writer.word(u64::from_ne_bytes([kind, 0, 0, 0, 0, 0, 0, 0]));
    writer.numbers(&[proximity.distance, proximity.tilt]);
    [proximity.normal, proximity.point_a, proximity.point_b].into_iter().for_each(|v| writer.vector(v));
    writer.pair([proximity.triangle_a, proximity.triangle_b]);
    writer.pair([p, q]);
    writer.pair([r, s]);
}

/// The features of a record as text.
///
/// Takes the kind and the four numbers of a record of a batch, and returns the text that `Contact.feature` is.
///
/// >>> import d2m_ccd
/// >>> d2m_ccd.feature_text(3, [1, 2, 5, 6])
/// 'edge_edge:1-2:5-6'
#[pyo3::pyfunction(name = "feature_text")]
pub(crate) fn feature_text_py(kind: u8, features: [u32; 4]) -> String {
    let [p, q, r, s] = features;
    match kind {
        1 => feature_field(FeaturePair::VertexFace { vertex: p, face: q }),
        2 => feature_field(FeaturePair::FaceVertex { face: p, vertex: q }),
        3 => feature_field(FeaturePair::EdgeEdge { edge_a: [p, q], edge_b: [r, s] }),
        _ => String::new(),
    }
}
