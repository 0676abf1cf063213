//! What the engine concludes on its way, for a listener that proves it again.
//!
//! Every way to an answer rests on conclusions: this pair of boxes stays apart until then, this plane parts a crowd, this span is
//! skipped. With the feature `audit` each of them is reported as it is relied on, with its bodies, their parts, its span in the
//! bodies' own time, and its distance. Without the feature none of this is compiled.

use crate::MeshTree;
use crate::tree::node::{Below, WIDTH};
use d2m_motion::RigidMotion;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, RwLock};

/// Where in the engine a conclusion is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Place {
    /// A box of a tree and a vertex below it.
    StoredBox,
    /// A pair of boxes is queued with a later key, or not at all.
    NodePair,
    /// A pair of triangles is advanced.
    TrianglePair,
    /// A pair of triangles is apart before a contact that is known.
    Backward,
    /// A pair of boxes is apart over all of a span.
    WholeSpan,
    /// Swept volumes are apart.
    Sweep,
    /// Projections that a common screw leaves unchanged are apart.
    Screw,
    /// A plane parts a crowd, or pairs of it.
    Crowd,
    /// Spheres about the bodies are apart.
    Spheres,
    /// Fitted twists of motions of any kind are apart by more than they deviate.
    FittedTwists,
    /// A plane stays between motions of any kind.
    Plane,
    /// A piece of a motion with a constant twist is searched as it is.
    ExactSpan,
    /// Boxes that the bodies do not leave between two neighboring numbers for times are apart.
    SweptBoxes,
    /// Bodies are further apart than a joint of their motions lets them jump.
    Joint,
    /// A cache knows that the bodies are apart.
    Cache,
    /// Triangles that met before are shown to meet again.
    MeetAgain,
    /// The broad phase of a world leaves a pair out.
    BroadPhase,
    /// What a world keeps of a pair.
    WorldPair,
    /// Bodies of a simulation are proven apart without a query.
    DynamicsClearance,
    /// A flight of a simulation.
    Flight,
    /// A query for proximities leaves a pair of boxes out.
    ProximityDropped,
    /// A query at rest leaves a pair of boxes out, or bounds a distance.
    Resting,
    /// The lower bound of a clearance.
    ClearanceBound,
    /// Triangles stay within a distance of each other.
    Staying,
    /// A clear span of several.
    ClearSpan,
    /// Bodies have left each other.
    Departure,
    /// The answer of a query.
    Answer,
}

impl Place {
    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::StoredBox => "boxes of trees",
            Self::NodePair => "node pairs",
            Self::TrianglePair => "triangle pairs",
            Self::Backward => "backward certificates",
            Self::WholeSpan => "whole spans",
            Self::Sweep => "swept volumes",
            Self::Screw => "screws",
            Self::Crowd => "crowds",
            Self::Spheres => "spheres",
            Self::FittedTwists => "fitted twists",
            Self::Plane => "planes between any motions",
            Self::ExactSpan => "pieces of constant twist",
            Self::SweptBoxes => "swept boxes",
            Self::Joint => "joints",
            Self::Cache => "caches",
            Self::MeetAgain => "warm starts",
            Self::BroadPhase => "broad phases",
            Self::WorldPair => "pairs of worlds",
            Self::DynamicsClearance => "clearances of dynamics",
            Self::Flight => "certified flights",
            Self::ProximityDropped => "proximities dropped",
            Self::Resting => "bodies at rest",
            Self::ClearanceBound => "clearances",
            Self::Staying => "staying in contact",
            Self::ClearSpan => "clear spans",
            Self::Departure => "departures",
            Self::Answer => "answers",
        }
    }
}

/// What is concluded about two parts over a span.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Promise {
    /// The surfaces of the parts are further apart than the distance at every time.
    Apart,
    /// The same, and at the first time neither body holds a part of the other, as far as it is filled.
    Clear,
    /// At some time they are no further apart than the distance.
    Meets,
    /// They are no further apart than the distance at every time.
    Stays,
}

/// The triangles of a body that a conclusion is about.
#[derive(Clone, Copy, Debug)]
pub enum Part<'a> {
    /// All.
    Whole,
    /// Those below these boxes, by number.
    Boxes(&'a [u32]),
    /// One, by number.
    Triangle(u32),
}

/// A body of a conclusion.
#[derive(Clone, Copy)]
pub struct Audited<'a> {
    /// The body.
    pub tree: &'a MeshTree,
    /// How it moves.
    pub motion: &'a dyn RigidMotion,
    /// What of it.
    pub part: Part<'a>,
    /// Is what the mesh encloses part of it?
    pub is_filled: bool,
}

/// A statement about two bodies that the engine relies on.
#[derive(Clone, Copy)]
pub struct Conclusion<'a> {
    /// Who says so.
    pub place: Place,
    /// A and B.
    pub bodies: [Audited<'a>; 2],
    /// First time.
    pub from: f64,
    /// Last time, not before the first.
    pub to: f64,
    /// The distance that the promise is about.
    pub distance: f64,
    /// What is promised.
    pub promise: Promise,
}

impl<'a> Audited<'a> {
    /// A part of a surface.
    pub const fn new(tree: &'a MeshTree, motion: &'a dyn RigidMotion, part: Part<'a>) -> Self {
        Self { tree, motion, part, is_filled: false }
    }

    /// A number that no other tree of the process has; clones share it.
    pub const fn tree_number(&self) -> u64 {
        self.tree.id.number()
    }

    /// Numbers of the triangles of the part, ascending, each once.
    pub fn triangles(&self) -> Vec<u32> {
        let boxes = match self.part {
            Part::Whole => return (0..self.tree.mesh.triangle_count() as u32).collect(),
            Part::Triangle(triangle) => return vec![triangle],
            Part::Boxes(boxes) => boxes,
        };
        let (mut stack, mut found) = (boxes.to_vec(), Vec::new());
        while let Some(index) = stack.pop() {
            match self.tree.nodes[index as usize / WIDTH].below(index as usize % WIDTH) {
                Below::Triangle(triangle) => found.push(triangle),
                Below::Node(node) => {
                    let first = node * WIDTH as u32;
                    stack.extend(first..first + self.tree.nodes[node as usize].used);
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }
}

/// A box of a tree as it is stored. Its points are what is said in [`stored_boxes`].
#[derive(Clone, Debug)]
pub struct StoredBox {
    /// Its number.
    pub number: u32,
    /// Triangles below it.
    pub triangles: Vec<u32>,
    /// Reference point of the centers of its node, and its center from there.
    pub origin: [f32; 3],
    /// See `origin`.
    pub center: [f32; 3],
    /// Its axes.
    pub axes: [[f32; 3]; 3],
    /// Half of its extent along each axis.
    pub half_extent: [f32; 3],
    /// For each of the axes' pairs (0, 1), (0, 2), (1, 2) what is cut off the four edges, in steps of 1/64: the edge between the faces
    /// σxᵢ = hᵢ and τxⱼ = hⱼ is at place (σ < 0) + 2 (τ < 0).
    pub slabs: [[u8; 4]; 3],
    /// Radius of a sphere about the center.
    pub radius: f32,
    /// No less than |center|₁ + radius of any box of its node.
    pub extent: f32,
}

/// All boxes of a tree.
///
/// Promise, in real arithmetic: with p = (vertex − [`MeshTree::center`]) / [`MeshTree::unit`] and x the coordinates of p − origin − center
/// along the axes, every vertex of the triangles below a box has |xᵢ| ≤ hᵢ and |p − origin − center| ≤ radius, and
/// σxᵢ/hᵢ + τxⱼ/hⱼ ≤ 2 − cut/64.
pub fn stored_boxes(tree: &MeshTree) -> Vec<StoredBox> {
    let mut all = Vec::new();
    for (index, node) in tree.nodes.iter().enumerate() {
        for lane in 0..node.used as usize {
            let number = (index * WIDTH + lane) as u32;
            let boxed = node.oriented_box(lane);
            let triangles =
                Audited::new(tree, &d2m_motion::ConstantTwist::REST, Part::Boxes(&[number])).triangles();
            all.push(StoredBox {
                number,
                triangles,
                origin: node.origin,
                center: boxed.center,
                axes: boxed.axes,
                half_extent: boxed.half_extent,
                slabs: boxed.slabs,
                radius: boxed.radius,
                extent: node.extent,
            });
        }
    }
    all
}

type Listener = dyn Fn(&Conclusion<'_>) + Send + Sync;

static LISTENER: RwLock<Option<Arc<Listener>>> = RwLock::new(None);
static ONE: Mutex<()> = Mutex::new(());

/// As long as this lives, every conclusion of every thread is reported. See [`listen`].
#[must_use = "dropped at once it hears nothing"]
pub struct Listening {
    _only_one: MutexGuard<'static, ()>,
}

/// Reports every conclusion of this process, on the thread that draws it, until what is returned is dropped. Waits while another one
/// listens.
pub fn listen(listener: impl Fn(&Conclusion<'_>) + Send + Sync + 'static) -> Listening {
    let only_one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    *LISTENER.write().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(listener));
    Listening { _only_one: only_one }
}

impl Drop for Listening {
    fn drop(&mut self) {
        *LISTENER.write().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

/// Does anybody listen?
pub fn is_heard() -> bool {
    LISTENER.read().unwrap_or_else(PoisonError::into_inner).is_some()
}

/// Tells the listener, if there is one. A span that ends before it begins claims nothing, nor does a distance below zero.
pub fn report(conclusion: &Conclusion<'_>) {
    let listener = LISTENER.read().unwrap_or_else(PoisonError::into_inner).clone();
    let says_something = conclusion.from <= conclusion.to && conclusion.distance >= 0.0;
    if let Some(listener) = listener.filter(|_| says_something) {
        listener(conclusion);
    }
}
