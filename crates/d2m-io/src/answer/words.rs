//! The words of an answer. None states more than what is proven.

use d2m_bvh::{ClearanceStatus, Contact, Evidence, StartState, TimeOfContact};
use d2m_feature::FeaturePair;
use glam::DVec3;

/// One word for a verdict: `separated`, `contact` or `undecided`.
///
/// ```
/// assert_eq!(d2m_io::verdict_word(&d2m_bvh::TimeOfContact::Separated), "separated");
/// ```
pub const fn verdict_word(verdict: &TimeOfContact) -> &'static str {
    match verdict {
        TimeOfContact::Separated => "separated",
        TimeOfContact::Contact(_) => "contact",
        TimeOfContact::Undecided { .. } => "undecided",
    }
}

/// A feature pair without commas: `vertex_face:V:F`, `face_vertex:F:V`, `edge_edge:P-Q:R-S`, A's part first.
///
/// ```
/// let feature = d2m_feature::FeaturePair::EdgeEdge { edge_a: [0, 1], edge_b: [7, 9] };
/// assert_eq!(d2m_io::feature_field(feature), "edge_edge:0-1:7-9");
/// ```
pub fn feature_field(feature: FeaturePair) -> String {
    match feature {
        FeaturePair::VertexFace { vertex, face } => format!("vertex_face:{vertex}:{face}"),
        FeaturePair::FaceVertex { face, vertex } => format!("face_vertex:{face}:{vertex}"),
        FeaturePair::EdgeEdge { edge_a: [p, q], edge_b: [r, s] } => format!("edge_edge:{p}-{q}:{r}-{s}"),
    }
}

/// The same for a person.
///
/// ```
/// let feature = d2m_feature::FeaturePair::VertexFace { vertex: 3, face: 5 };
/// assert_eq!(d2m_io::feature_sentence(feature), "vertex 3 of A against face 5 of B");
/// ```
pub fn feature_sentence(feature: FeaturePair) -> String {
    match feature {
        FeaturePair::VertexFace { vertex, face } => format!("vertex {vertex} of A against face {face} of B"),
        FeaturePair::FaceVertex { face, vertex } => format!("face {face} of A against vertex {vertex} of B"),
        FeaturePair::EdgeEdge { edge_a: [p, q], edge_b: [r, s] } => {
            format!("edge {p}\u{2013}{q} of A against edge {r}\u{2013}{s} of B")
        }
    }
}

/// One word for what is known of a least distance.
///
/// ```
/// assert_eq!(d2m_io::clearance_word(d2m_bvh::ClearanceStatus::Undecided), "undecided");
/// ```
pub const fn clearance_word(status: ClearanceStatus) -> &'static str {
    match status {
        ClearanceStatus::Clear => "clear",
        ClearanceStatus::Contact => "contact",
        ClearanceStatus::Undecided => "undecided",
    }
}

/// A least distance in one line: its enclosure, and that it is wider than it was to be where the search was ended.
///
/// ```
/// use d2m_bvh::ClearanceStatus;
/// assert_eq!(d2m_io::clearance_words([0.5, 0.75], ClearanceStatus::Clear), "[0.5, 0.75]");
/// assert!(d2m_io::clearance_words([0.0, 0.75], ClearanceStatus::Undecided).starts_with("[0, 0.75] (undecided"));
/// ```
pub fn clearance_words([lower, upper]: [f64; 2], status: ClearanceStatus) -> String {
    let [lower, upper] = [lower, upper].map(short_number);
    let ended = match status {
        ClearanceStatus::Clear | ClearanceStatus::Contact => "",
        ClearanceStatus::Undecided => " (undecided: the budget or the time was used up)",
    };
    format!("[{lower}, {upper}]{ended}")
}

/// One word for how bodies stand at a time.
///
/// ```
/// assert_eq!(d2m_io::start_word(d2m_bvh::StartState::Touching), "touching");
/// ```
pub const fn start_word(start: StartState) -> &'static str {
    match start {
        StartState::Apart => "apart",
        StartState::Touching => "touching",
        StartState::Overlapping => "overlapping",
        StartState::Contained => "contained",
        StartState::Undecided => "undecided",
    }
}

/// The same in JSON, which knows four words: bodies that are not proven to touch, with a direction along which they part, are
/// `overlapping`, and `start_proven` says whether that is more than a word.
///
/// ```
/// assert_eq!(d2m_io::start_in_json(d2m_bvh::StartState::Undecided), "overlapping");
/// ```
pub const fn start_in_json(start: StartState) -> &'static str {
    match start {
        StartState::Undecided => start_word(StartState::Overlapping),
        known => start_word(known),
    }
}

/// What is proven of the meeting itself, in a sentence. `min_separation`: the distance at which the bodies count as touching.
///
/// ```
/// use d2m_bvh::{MeshTree, Moving, QueryOptions, Window, time_of_contact};
/// use d2m_motion::ConstantTwist;
/// # use d2m_io::{MeshFormat, ReadOptions, parse_mesh};
/// # let mesh = parse_mesh(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", MeshFormat::Obj, &ReadOptions::new())?.mesh;
/// let plate = MeshTree::new(mesh);
/// let falling: ConstantTwist = "x=0,0,1;v=0,0,-2".parse()?;
/// let surfaces = QueryOptions::default().with_solid(d2m_bvh::Solid::Surface).with_min_separation(0.1);
/// let [a, b] = [Moving::new(&plate, &falling), Moving::new(&plate, &ConstantTwist::REST)];
/// let answer = time_of_contact(a, b, Window::UNIT, &surfaces)?;
/// let sentence = d2m_io::evidence_sentence(answer.contact().expect("they meet"), 0.1);
/// assert!(sentence.starts_with("near: ") && sentence.contains("0.1"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn evidence_sentence(contact: &Contact, min_separation: f64) -> String {
    let distance = short_number(min_separation);
    match contact.evidence {
        Evidence::Crossing => "crossing: the bodies share a point at one of these times".to_owned(),
        Evidence::Near if min_separation > 0.0 => {
            format!("near: at one of these times the distance is at most {distance} + tolerance")
        }
        Evidence::Near => "near: at one of these times the distance is at most the tolerance".to_owned(),
        _ => "early: only that nothing meets before is proven; there may be no contact at all".to_owned(),
    }
}

/// A number as short as can be read back: in powers of ten where zeros would fill the line.
///
/// ```
/// assert_eq!((d2m_io::short_number(0.25), d2m_io::short_number(2e-9)), ("0.25".into(), "2e-9".into()));
/// ```
pub fn short_number(number: f64) -> String {
    /// Sizes whose decimals are no longer than their powers of ten.
    const PLAIN: core::ops::Range<f64> = 1e-5..1e16;
    match number.abs() {
        size if size == 0.0 || PLAIN.contains(&size) => number.to_string(),
        _ => format!("{number:e}"),
    }
}

/// With so many digits after the point, or in powers of ten where that would fill the line or show nothing.
pub(super) fn fixed(number: f64, digits: usize) -> String {
    /// From here on the digits in front of the point would fill the line.
    const LONG: f64 = 1e9;
    /// Below this the digits after the point would show next to nothing.
    const SHORT: f64 = 1e-5;
    match number.abs() {
        size if size >= LONG || (0.0 < size && size < SHORT) => format!("{number:.digits$e}"),
        _ => format!("{number:.digits$}"),
    }
}

/// A point or a direction to nine digits after the point.
///
/// ```
/// assert_eq!(d2m_io::vector_words(glam::DVec3::X), "(1.000000000, 0.000000000, 0.000000000)");
/// ```
pub fn vector_words(v: DVec3) -> String {
    let [x, y, z] = v.to_array().map(|number| fixed(number, 9));
    format!("({x}, {y}, {z})")
}
