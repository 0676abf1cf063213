//! Traverse-Tree-Pair, Algorithm 6 of the paper, over a subdivided time domain.

use super::Moving;
use super::leaf_pair::{Box3, Candidate, LeafPair, TreeLeaf, still_open};
use super::sphere_tree::{Leaf, SphereTree};
use super::stretch;
use crate::feature::{
    BodyOverDomain, PaperOptions, PointJet, RelativeMotion, SphereOverDomain, boxes_meet, test_sphere_pair,
};
use d2m_bvh::{Meter, Mode};
use d2m_interval::Interval;

/// The budget ran out: no contact before this time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stopped {
    pub(crate) clear_until: f64,
}

/// What one body's parts do over the current stretch of time, made when it is first needed.
struct Stretch {
    body: BodyOverDomain,
    spheres: Lazy<SphereOverDomain>,
    vertices: Lazy<PointJet>,
    /// Scratch: swept boxes of the vertices and of the triangles of a leaf.
    vertex_boxes: Vec<Box3>,
    triangle_boxes: Vec<Box3>,
}

/// A table that is filled on demand and cleared in constant time.
struct Lazy<T> {
    slot: Vec<u32>,
    filled: Vec<(u32, T)>,
}

impl<T: Copy> Lazy<T> {
    fn new(len: usize) -> Self {
        Self { slot: vec![0; len], filled: vec![] }
    }

    fn get(&mut self, index: u32, make: impl FnOnce() -> T) -> T {
        let slot = self.slot[index as usize] as usize;
        if let Some((owner, value)) = self.filled.get(slot)
            && *owner == index
        {
            return *value;
        }
        let value = make();
        self.slot[index as usize] = self.filled.len() as u32;
        self.filled.push((index, value));
        value
    }
}

impl Stretch {
    fn new(moving: &Moving<'_>) -> Self {
        Self {
            body: BodyOverDomain::new(moving.motion, Interval::ZERO, glam::DVec3::ZERO),
            spheres: Lazy::new(moving.body.node_count()),
            vertices: Lazy::new(moving.body.mesh().vertex_count()),
            vertex_boxes: vec![],
            triangle_boxes: vec![],
        }
    }

    fn begin(&mut self, body: &BodyOverDomain) {
        self.body = *body;
        self.spheres.filled.clear();
        self.vertices.filled.clear();
    }

    fn sphere(&mut self, tree: &SphereTree, node: u32) -> SphereOverDomain {
        let own = tree.node(node).sphere;
        let body = &self.body;
        self.spheres.get(node, || body.sphere(own.center, own.radius))
    }

    /// Fills `triangle_boxes` with the places of the leaf's triangles over `span`, and returns their hull.
    fn sweep(&mut self, tree: &SphereTree, leaf: &Leaf, span: Interval) -> Box3 {
        self.vertex_boxes.clear();
        for &v in &leaf.vertices {
            let body = &self.body;
            let jet = self.vertices.get(v, || body.jet(tree.vertex(v)));
            self.vertex_boxes.push(jet.enclose(jet.offsets(span)));
        }
        let place = |i: u32| self.vertex_boxes[i as usize];
        self.triangle_boxes.clear();
        self.triangle_boxes
            .extend(leaf.local.iter().map(|t| place(t[0]).hull(place(t[1])).hull(place(t[2]))));
        self.triangle_boxes.iter().copied().reduce(Box3::hull).expect("a leaf holds a triangle")
    }
}

/// One search of the first contact.
pub(crate) struct Search<'a> {
    bodies: [Moving<'a>; 2],
    relative: [RelativeMotion<'a>; 2],
    options: PaperOptions,
    mode: Mode,
    epoch: f64,
    stretch: [Stretch; 2],
    pub(crate) best: Option<Candidate>,
    pub(crate) meter: Meter,
}

impl<'a> Search<'a> {
    pub(crate) fn new(bodies: [Moving<'a>; 2], options: PaperOptions, mode: Mode, meter: Meter) -> Self {
        let relative = RelativeMotion::new(bodies[0].motion, bodies[1].motion);
        Self {
            bodies,
            relative: [relative, relative.swapped()],
            options,
            mode,
            epoch: 0.0,
            stretch: [Stretch::new(&bodies[0]), Stretch::new(&bodies[1])],
            best: None,
            meter,
        }
    }

    /// Searches a window, one smooth piece of both motions after the other, and a moment about each joint: where pieces of a motion meet up to
    /// rounding only, what lies between them is enclosed with both.
    pub(crate) fn search(&mut self, window: Interval) -> Result<(), Stopped> {
        let mut now = window.lo();
        while self.best.is_none_or(|best| now < best.bracket.lo()) {
            let ends = self.bodies.iter().filter_map(|body| body.motion.smooth_until(now));
            // An end that is no number ends now.
            let end = ends.map(|end| end.max(now)).fold(window.hi(), f64::min);
            if end <= now && now < window.hi() {
                return Err(Stopped { clear_until: now });
            }
            let piece = Interval::new(now, end);
            self.search_stretch(piece, stretch::longest(&self.bodies, piece))?;
            if end >= window.hi() {
                break;
            }
            self.search_stretch(Interval::new(end.next_down(), end.next_up()), f64::INFINITY)?;
            now = end;
        }
        Ok(())
    }

    /// Searches `stretch`, halving it while it is longer than `longest` and the bodies' spheres may meet in it.
    ///
    /// Epoch rebase and recentering happen at every stretch: the enclosures start at its first instant and positions are
    /// taken from the middle between the bodies.
    fn search_stretch(&mut self, stretch: Interval, longest: f64) -> Result<(), Stopped> {
        let mut open = vec![stretch];
        while let Some(stretch) = open.pop() {
            let Some(stretch) = still_open(stretch, self.best.as_ref()) else { break };
            let stopped = Stopped { clear_until: stretch.lo() };
            self.meter.step().map_err(|_| stopped)?;
            self.begin(stretch);
            let Some(part) = self.test(0, 0, stretch) else { continue };
            let middle = 0.5 * stretch.lo() + 0.5 * stretch.hi();
            if stretch.hi() - stretch.lo() > longest && stretch.lo() < middle && middle < stretch.hi() {
                open.push(Interval::new(middle, stretch.hi()));
                open.push(Interval::new(stretch.lo(), middle));
                continue;
            }
            self.traverse(part, 0, 0)?;
        }
        Ok(())
    }

    /// Starts a new stretch of time with its own epoch and scene center.
    fn begin(&mut self, stretch: Interval) {
        self.epoch = stretch.lo();
        let place = |m: &Moving<'_>| m.motion.pose_and_twist(stretch.lo()).0.translation;
        let center = 0.5 * place(&self.bodies[0]) + 0.5 * place(&self.bodies[1]);
        let center = if center.is_finite() { center } else { glam::DVec3::ZERO };
        for (own, moving) in self.stretch.iter_mut().zip(&self.bodies) {
            own.begin(&BodyOverDomain::new(moving.motion, stretch, center));
        }
    }

    /// Test-Sphere-Pair of two nodes.
    fn test(&mut self, a: u32, b: u32, searched: Interval) -> Option<Interval> {
        let sphere_a = self.stretch[0].sphere(self.bodies[0].body, a);
        let sphere_b = self.stretch[1].sphere(self.bodies[1].body, b);
        test_sphere_pair(&sphere_a, &sphere_b, self.epoch, searched)
    }

    /// Algorithm 6: lowers `self.best` by the contacts of the two subtrees within `span`.
    fn traverse(&mut self, span: Interval, a: u32, b: u32) -> Result<(), Stopped> {
        let (tree_a, tree_b) = (self.bodies[0].body, self.bodies[1].body);
        let (node_a, node_b) = (tree_a.node(a), tree_b.node(b));
        let stopped = Stopped { clear_until: span.lo() };
        if node_a.is_leaf() && node_b.is_leaf() {
            if self.mode == Mode::Capoeira {
                self.offer_leaf_pair(span, b);
                return Ok(());
            }
            if !self.triangles_may_meet(tree_a.leaf(node_a), tree_b.leaf(node_b), span) {
                return Ok(());
            }
            let pair = LeafPair {
                a: TreeLeaf { tree: tree_a, leaf: tree_a.leaf(node_a) },
                b: TreeLeaf { tree: tree_b, leaf: tree_b.leaf(node_b) },
                motion: &self.relative,
                options: self.options,
            };
            return pair.search(span, &mut self.best, &mut self.meter).map_err(|_| stopped);
        }
        // A leaf has one part, itself; an inner node has its children.
        let own =
            |leaf: bool, node: u32, children: [u32; 2]| if leaf { ([node, 0], 1) } else { (children, 2) };
        let (parts_a, count_a) = own(node_a.is_leaf(), a, node_a.children);
        let (parts_b, count_b) = own(node_b.is_leaf(), b, node_b.children);
        let mut pairs = [(Interval::ZERO, 0, 0); 4];
        let mut count = 0;
        for &part_a in &parts_a[..count_a] {
            for &part_b in &parts_b[..count_b] {
                self.meter.step().map_err(|_| stopped)?;
                if let Some(overlap) = self.test(part_a, part_b, span) {
                    pairs[count] = (overlap, part_a, part_b);
                    count += 1;
                }
            }
        }
        let pairs = &mut pairs[..count];
        pairs.sort_by(|p, q| p.0.lo().total_cmp(&q.0.lo()));
        for (i, &(overlap, part_a, part_b)) in pairs.iter().enumerate() {
            let Some(searched) = still_open(overlap, self.best.as_ref()) else { break };
            self.traverse(searched, part_a, part_b).map_err(|stopped| {
                // Nothing is known of the pairs not yet searched, either.
                let next = pairs.get(i + 1).map_or(f64::INFINITY, |p| p.0.lo());
                Stopped { clear_until: stopped.clear_until.min(next) }
            })?;
        }
        Ok(())
    }

    /// Does a swept box of a triangle of one leaf meet one of the other leaf?
    fn triangles_may_meet(&mut self, a: &Leaf, b: &Leaf, span: Interval) -> bool {
        let [of_a, of_b] = &mut self.stretch;
        let all_a = of_a.sweep(self.bodies[0].body, a, span);
        let all_b = of_b.sweep(self.bodies[1].body, b, span);
        boxes_meet(&all_a, &all_b)
            && of_a
                .triangle_boxes
                .iter()
                .any(|x| boxes_meet(x, &all_b) && of_b.triangle_boxes.iter().any(|y| boxes_meet(x, y)))
    }

    /// Capoeira mode: the start of the overlap of two leaves stands for the contact of their content.
    fn offer_leaf_pair(&mut self, span: Interval, b: u32) {
        let tree_b = self.bodies[1].body;
        let triangle_b = tree_b.leaf(tree_b.node(b)).triangles[0];
        if still_open(span, self.best.as_ref()).is_some() {
            self.best = Some(Candidate { bracket: span, triangle_b, undecided: false });
        }
    }
}
