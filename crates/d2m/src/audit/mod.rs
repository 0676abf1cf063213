//! Conclusions of the engine, judged one by one by [`d2m_verify`] while they are drawn.
//!
//! An answer is right or wrong, and most faults of a bound do not flip one. The conclusions that it rests on are thousands a query, and
//! a wrong bound makes some of them false: an audit sees those.
mod boxes;

pub use d2m_bvh::audit::*;

use crate::MeshTree;
use d2m_verify::{Body, Claim, Mesh, Query, Reason, Solid, TimeSpan, Verdict, verify};
use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex, PoisonError};

/// How much of what is reported is judged, and how hard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Of each place and case so many conclusions are judged one after the other, then so many of every power of two of them.
    pub each: u64,
    /// Steps of one proof at most.
    pub most_steps: u64,
}

/// What became of the conclusions of one place.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Conclusions.
    pub reported: u64,
    /// Those of them that were judged.
    pub judged: u64,
    /// Proven again.
    pub verified: u64,
    /// Not proven, for each reason.
    pub unproven: BTreeMap<Reason, u64>,
    /// Proven false.
    pub refuted: u64,
}

impl Tally {
    fn add(&mut self, verdict: &Verdict) {
        self.judged += 1;
        match *verdict {
            Verdict::Verified { .. } => self.verified += 1,
            Verdict::Unproven { reason, .. } => *self.unproven.entry(reason).or_default() += 1,
            Verdict::Refuted { .. } => self.refuted += 1,
        }
    }

    /// With what another one counts.
    pub fn merge(&mut self, other: &Self) {
        self.reported += other.reported;
        self.judged += other.judged;
        self.verified += other.verified;
        self.refuted += other.refuted;
        for (reason, count) in &other.unproven {
            *self.unproven.entry(*reason).or_default() += count;
        }
    }
}

/// What an audit found so far.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    /// By place.
    pub places: BTreeMap<Place, Tally>,
    /// The first few conclusions that are false, one line each.
    pub refuted: Vec<String>,
    /// And those that are open for another reason than steps.
    pub open: Vec<String>,
}

/// Lines that are kept.
const MOST_LINES: usize = 64;

impl Findings {
    /// Of all places together.
    pub fn total(&self) -> Tally {
        let mut total = Tally::default();
        for tally in self.places.values() {
            total.merge(tally);
        }
        total
    }
}

/// Listens to the engine and judges what it concludes, on the thread that concludes it.
///
/// ```
/// use d2m::audit::{Auditor, Effort};
/// use d2m::{ConstantTwist, MeshTree, Moving, QueryOptions, TriMesh, Window, time_of_contact};
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = MeshTree::new(mesh);
/// let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(-4.0 * DVec3::Z);
/// let auditor = Auditor::new(Effort { each: 64, most_steps: 1 << 14 });
/// auditor.begin("a fall");
/// let bodies = [Moving::new(&tree, &falling), Moving::new(&tree, &ConstantTwist::REST)];
/// let _ = time_of_contact(bodies[0], bodies[1], Window::UNIT, &QueryOptions::default())?;
/// let total = auditor.findings().total();
/// assert!(total.verified > 0 && total.refuted == 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Auditor {
    findings: Arc<Mutex<Findings>>,
    _listening: Listening,
}

/// What a thread is at.
struct Case {
    label: String,
    /// Conclusions of each place since it began.
    counts: BTreeMap<Place, u64>,
    meshes: HashMap<(u64, Key), Arc<Mesh>>,
}

/// A part of a body whose mesh is kept.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Key {
    Whole,
    Box(u32),
    Triangle(u32),
}

thread_local! {
    static CASE: RefCell<Case> =
        RefCell::new(Case { label: String::new(), counts: BTreeMap::new(), meshes: HashMap::new() });
}

impl Auditor {
    /// Begins to listen. Only one listens at a time: waits for another one to end.
    pub fn new(effort: Effort) -> Self {
        let findings = Arc::new(Mutex::new(Findings::default()));
        let heard = Arc::clone(&findings);
        Self { findings, _listening: listen(move |conclusion| hear(&heard, &effort, conclusion)) }
    }

    /// What this thread concludes from now on belongs to the case of this name.
    pub fn begin(&self, label: &str) {
        CASE.with_borrow_mut(|case| {
            label.clone_into(&mut case.label);
            case.counts.clear();
            case.meshes.clear();
        });
    }

    /// Judges what is promised of the boxes of a tree.
    pub fn check_boxes(&self, tree: &MeshTree) {
        let (tally, lines) = boxes::check(tree);
        let label = CASE.with_borrow(|case| case.label.clone());
        let mut found = self.findings.lock().unwrap_or_else(PoisonError::into_inner);
        found.places.entry(Place::StoredBox).or_default().merge(&tally);
        found.refuted.extend(lines.into_iter().map(|line| format!("{label}: {line}")));
    }

    /// What was found so far.
    pub fn findings(&self) -> Findings {
        self.findings.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Takes what was found so far: the next findings begin anew.
    pub fn take(&self) -> Findings {
        core::mem::take(&mut self.findings.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Conclusion number `count` of a case is judged: all of the first, and as many of every power of two that follows.
fn is_drawn(count: u64, each: u64) -> bool {
    count < each || each > 0 && count.is_multiple_of((count / each + 1).next_power_of_two())
}

fn hear(findings: &Mutex<Findings>, effort: &Effort, conclusion: &Conclusion<'_>) {
    let drawn = CASE.with_borrow_mut(|case| {
        let count = case.counts.entry(conclusion.place).or_default();
        *count += 1;
        is_drawn(*count - 1, effort.each)
    });
    let verdict =
        drawn.then(|| CASE.with_borrow_mut(|case| judge(conclusion, effort.most_steps, &mut case.meshes)));
    let mut found = findings.lock().unwrap_or_else(PoisonError::into_inner);
    let tally = found.places.entry(conclusion.place).or_default();
    tally.reported += 1;
    let Some(verdict) = verdict else { return };
    tally.add(&verdict);
    let is_slow = matches!(verdict, Verdict::Unproven { reason: Reason::Steps, .. });
    let lines = match verdict {
        Verdict::Refuted { .. } => &mut found.refuted,
        Verdict::Unproven { .. } if !is_slow => &mut found.open,
        _ => return,
    };
    if lines.len() < MOST_LINES {
        lines.push(line(conclusion, &verdict));
    }
}

/// Everything that identifies a conclusion, and what became of it.
fn line(conclusion: &Conclusion<'_>, verdict: &Verdict) -> String {
    let Conclusion { place, bodies, from, to, distance, promise } = conclusion;
    let part = |k: usize| match bodies[k].part {
        Part::Boxes(boxes) if boxes.len() > 4 => format!("{} boxes", boxes.len()),
        part => format!("{part:?}"),
    };
    let label = CASE.with_borrow(|case| case.label.clone());
    format!(
        "{label}: {}: {promise:?} {distance:e} over [{from:?}, {to:?}], A {}, B {}: {verdict:?}",
        place.name(),
        part(0),
        part(1)
    )
}

/// Times of a span at which triangles, or bodies, are judged that stay near: as parts of it.
const TIMES: u32 = 8;

/// Proves a conclusion again. That something stays near is judged at a few times of the span only.
fn judge(
    conclusion: &Conclusion<'_>,
    most_steps: u64,
    meshes: &mut HashMap<(u64, Key), Arc<Mesh>>,
) -> Verdict {
    let Conclusion { bodies, from, to, distance, promise, .. } = *conclusion;
    let [Some(a), Some(b)] = [0, 1].map(|k| mesh_of(&bodies[k], meshes)) else {
        return Verdict::Unproven { clear_until: from, reason: Reason::NothingClaimed, pair: None };
    };
    let body = |k: usize, mesh| Body {
        mesh,
        motion: bodies[k].motion,
        solid: match promise {
            Promise::Clear | Promise::Stays if bodies[k].is_filled => Solid::Filled,
            _ => Solid::Surface,
        },
        radius: 0.0,
    };
    let (both, span) = ([body(0, &a), body(1, &b)], TimeSpan { from, to });
    let ask = |window: TimeSpan, claim: &Claim| verify(&Query { bodies: both, window }, claim, most_steps);
    let meets = |span: TimeSpan| ask(span, &Claim::Within { span, distance, triangles: Some([0, 0]) });
    match promise {
        Promise::Apart | Promise::Clear => ask(span, &Claim::Clear { span, distance }),
        Promise::Meets => meets(span),
        Promise::Stays => {
            let time = |k: u32| (from + (to - from) * (f64::from(k) / f64::from(TIMES))).clamp(from, to);
            let verdicts = (0..=TIMES).map(|k| meets(TimeSpan { from: time(k), to: time(k) }));
            let rank = |verdict: &Verdict| match verdict {
                Verdict::Verified { .. } => 0,
                Verdict::Unproven { .. } => 1,
                Verdict::Refuted { .. } => 2,
            };
            verdicts.max_by_key(rank).unwrap_or(Verdict::Verified { steps: 0 })
        }
    }
}

/// The part as a mesh of its own.
fn mesh_of(body: &Audited<'_>, meshes: &mut HashMap<(u64, Key), Arc<Mesh>>) -> Option<Arc<Mesh>> {
    let key = match body.part {
        Part::Whole => Key::Whole,
        Part::Triangle(triangle) => Key::Triangle(triangle),
        Part::Boxes(&[one]) => Key::Box(one),
        Part::Boxes(_) => return submesh(body).map(Arc::new),
    };
    let key = (body.tree_number(), key);
    if let Some(known) = meshes.get(&key) {
        return Some(Arc::clone(known));
    }
    let mesh = Arc::new(submesh(body)?);
    meshes.insert(key, Arc::clone(&mesh));
    Some(mesh)
}

fn submesh(body: &Audited<'_>) -> Option<Mesh> {
    let mesh = body.tree.mesh();
    if matches!(body.part, Part::Whole) {
        return Mesh::try_new(mesh.vertices(), mesh.triangles()).ok();
    }
    let corners: Vec<_> = body.triangles().into_iter().flat_map(|t| mesh.corners(t as usize)).collect();
    let triangles: Vec<[u32; 3]> =
        (0..corners.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    Mesh::try_new(&corners, &triangles).ok()
}
