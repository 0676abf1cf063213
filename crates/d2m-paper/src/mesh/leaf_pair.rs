//! Brute force over the collision geometry of two leaves (line 3 of Algorithm 6).

use super::budget::{charge, evaluations};
use super::sphere_tree::{Leaf, OwnedEdge, OwnedVertex, SphereTree};
use crate::feature::{
    EdgePair, PaperOptions, PointFace, PointJet, RelativeFrame, RelativeMotion, TriangleFace, boxes_meet,
};
use d2m_bvh::{Exhausted, Meter};
use d2m_interval::{Interval, IntervalVec3};
use d2m_root::RootSearch;
use glam::DVec3;

/// The earliest contact known so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    /// No contact of the pair before `bracket.lo()`.
    pub(crate) bracket: Interval,
    /// A triangle of B at the features that meet.
    pub(crate) triangle_b: u32,
    /// The search of the pair met its budget: nothing is known from `bracket.lo()` on.
    pub(crate) undecided: bool,
}

/// An axis-aligned box.
pub(super) type Box3 = IntervalVec3;

/// A leaf and its tree.
#[derive(Clone, Copy)]
pub(crate) struct TreeLeaf<'a> {
    pub(crate) tree: &'a SphereTree,
    pub(crate) leaf: &'a Leaf,
}

/// The leaves of both bodies and how they move in each other's frames.
pub(crate) struct LeafPair<'a> {
    pub(crate) a: TreeLeaf<'a>,
    pub(crate) b: TreeLeaf<'a>,
    /// A seen from B, B seen from A.
    pub(crate) motion: &'a [RelativeMotion<'a>; 2],
    pub(crate) options: PaperOptions,
}

/// The body whose vertices meet the other's faces.
#[derive(Clone, Copy, Debug)]
enum PointsOf {
    A,
    B,
}

impl LeafPair<'_> {
    /// Lowers `best` by every pair of features that may meet within `span`.
    ///
    /// The motion is enclosed once over `span`, in each body's frame. Swept boxes, the plane's parabolas and Γ then
    /// dispose of nearly all pairs; only what is left is searched by itself.
    pub(crate) fn search(
        &self,
        span: Interval,
        best: &mut Option<Candidate>,
        meter: &mut Meter,
    ) -> Result<(), Exhausted> {
        let frames = self.motion[0].frames(span);
        self.points_and_faces(PointsOf::A, &frames[0], best, meter)?;
        self.points_and_faces(PointsOf::B, &frames[1], best, meter)?;
        self.edges(&frames[0], best, meter)
    }

    /// Vertices of one body against triangles of the other.
    fn points_and_faces(
        &self,
        points_of: PointsOf,
        frame: &RelativeFrame,
        best: &mut Option<Candidate>,
        meter: &mut Meter,
    ) -> Result<(), Exhausted> {
        let (points, faces_of, motion) = match points_of {
            PointsOf::A => (self.a, self.b, &self.motion[0]),
            PointsOf::B => (self.b, self.a, &self.motion[1]),
        };
        let (TreeLeaf { tree, leaf }, TreeLeaf { tree: face_tree, leaf: face_leaf }) = (points, faces_of);
        let boxes: Vec<Box3> = face_leaf.triangles.iter().map(|&f| hull(&face_tree.corners(f))).collect();
        let Some(all) = boxes.iter().copied().reduce(Box3::hull) else { return Ok(()) };
        let mut faces: Vec<Option<TriangleFace>> = vec![None; boxes.len()];
        for &OwnedVertex { vertex, triangle } in &leaf.owned_vertices {
            meter.step()?;
            let point = tree.vertex(vertex);
            let jet = frame.jet(point);
            let swept = swept_box(&jet);
            if !boxes_meet(&swept, &all) {
                continue;
            }
            for (i, &face) in face_leaf.triangles.iter().enumerate() {
                if !boxes_meet(&swept, &boxes[i]) {
                    continue;
                }
                let plane = faces[i].get_or_insert_with(|| TriangleFace::new(face_tree.corners(face))).face();
                let Some(part) = PointFace::try_first_part(&plane, &jet) else { continue };
                let Some(searched) = still_open(Interval::new(part.lo(), jet.span().hi()), best.as_ref())
                else {
                    continue;
                };
                meter.step()?;
                let options = self.options.with_evaluations(evaluations(meter));
                let mut pair = PointFace::new(motion, point, plane, jet, &options);
                let triangle_b = match points_of {
                    PointsOf::A => face,
                    PointsOf::B => triangle,
                };
                lower(best, pair.first_contact(searched), triangle_b);
                charge(meter, pair.evaluated())?;
            }
        }
        Ok(())
    }

    /// Edges of A against edges of B, in B's frame.
    fn edges(
        &self,
        frame: &RelativeFrame,
        best: &mut Option<Candidate>,
        meter: &mut Meter,
    ) -> Result<(), Exhausted> {
        let TreeLeaf { tree: tree_a, leaf: leaf_a } = self.a;
        let TreeLeaf { tree: tree_b, leaf: leaf_b } = self.b;
        let ends = |tree: &SphereTree, e: [u32; 2]| [tree.vertex(e[0]), tree.vertex(e[1])];
        let boxes: Vec<Box3> = leaf_b.owned_edges.iter().map(|e| hull(&ends(tree_b, e.ends))).collect();
        let Some(all) = boxes.iter().copied().reduce(Box3::hull) else { return Ok(()) };
        for &OwnedEdge { ends: edge_a, .. } in &leaf_a.owned_edges {
            meter.step()?;
            let own = ends(tree_a, edge_a);
            let swept = swept_box(&frame.jet(own[0])).hull(swept_box(&frame.jet(own[1])));
            if !boxes_meet(&swept, &all) {
                continue;
            }
            for (i, &OwnedEdge { ends: edge_b, triangle: triangle_b }) in
                leaf_b.owned_edges.iter().enumerate()
            {
                if !boxes_meet(&swept, &boxes[i]) {
                    continue;
                }
                let mut pair =
                    EdgePair::new(&self.motion[0], own, ends(tree_b, edge_b), frame, &self.options);
                let Some(part) = pair.try_first_part() else { continue };
                let Some(searched) = still_open(Interval::new(part.lo(), frame.span().hi()), best.as_ref())
                else {
                    continue;
                };
                meter.step()?;
                pair.set_max_evaluations(evaluations(meter));
                lower(best, pair.first_contact(searched), triangle_b);
                charge(meter, pair.evaluated())?;
            }
        }
        Ok(())
    }
}

/// The part of `searched` before the best contact so far.
pub(crate) fn still_open(searched: Interval, best: Option<&Candidate>) -> Option<Interval> {
    match best {
        Some(known) if searched.lo() >= known.bracket.lo() => None,
        Some(known) => Some(Interval::new(searched.lo(), searched.hi().min(known.bracket.lo()))),
        None => Some(searched),
    }
}

fn lower(best: &mut Option<Candidate>, found: RootSearch, triangle_b: u32) {
    let (bracket, undecided) = match found {
        RootSearch::None => return,
        RootSearch::Bracket(bracket) => (bracket, false),
        RootSearch::Undecided { clear_until } => (Interval::point(clear_until), true),
    };
    if best.as_ref().is_none_or(|known| bracket.lo() < known.bracket.lo()) {
        *best = Some(Candidate { bracket, triangle_b, undecided });
    }
}

fn hull(points: &[DVec3]) -> Box3 {
    let (lo, hi) =
        points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
    Box3::new(Interval::new(lo.x, hi.x), Interval::new(lo.y, hi.y), Interval::new(lo.z, hi.z))
}

/// All places of the point during the jet's span.
fn swept_box(jet: &PointJet) -> Box3 {
    jet.enclose(jet.offsets(jet.span()))
}
