//! One question of an audit, put in every way that there is.
use d2m::audit::Auditor;
use d2m::bvh::{ClearanceOptions, clearance, contact_spans, departure};
use d2m::{Budget, MeshTree, Moving, QueryOptions, Solid, TriMesh, Window, time_of_contact};
use d2m_testing::{Draw, Random, Surface};

/// One question of a family.
#[derive(Clone, Copy)]
pub(in crate::accuracy) struct Case<'a> {
    pub(in crate::accuracy) auditor: &'a Auditor,
    pub(in crate::accuracy) seed: u64,
    pub(in crate::accuracy) index: u64,
}

/// Node tests of one query: an audit wants many queries rather than long ones.
const MOST_TESTS: u64 = 1 << 15;

impl Case<'_> {
    /// The body of a surface, whose boxes are judged, too.
    pub(super) fn tree(&self, surface: Surface) -> MeshTree {
        let tree = MeshTree::new(surface.into_mesh(TriMesh::try_new));
        self.auditor.check_boxes(&tree);
        tree
    }

    pub(super) fn random(&self) -> Random {
        Random::new(self.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(self.index))
    }

    /// A small body of some kind, without slack, with an edge or round.
    pub(super) fn shape(&self, random: &mut Random) -> MeshTree {
        self.tree(match random.index(4) {
            0 => Surface::cube(random.log_between(0.05, 0.5)),
            1 => Surface::torus(8, 4, random.between(0.05, 0.4)).map(|p| p * 0.7),
            2 => Surface::cone(7, random.log_between(0.05, 0.5), random.signed()),
            _ => {
                let at = random.direction();
                let size = random.log_between(1e-3, 0.1);
                Surface::soup((0..9).map(|_| at + random.vector() * size).collect::<Vec<_>>())
            }
        })
    }
}

pub(super) fn usual() -> QueryOptions {
    QueryOptions::default().with_budget(Budget::UNLIMITED.with_node_tests(MOST_TESTS))
}

/// The question of this number, or when they meet first.
pub(super) fn ask(number: u64, bodies: [Moving<'_>; 2], options: &QueryOptions) {
    match number {
        0 => {
            let asked = ClearanceOptions::default().with_solid(Solid::Surface).with_budget(options.budget);
            let _ = clearance(bodies[0], bodies[1], Window::UNIT, &asked);
        }
        1 => drop(contact_spans(bodies[0], bodies[1], Window::UNIT, options, Some(1e-3))),
        2 => drop(departure(bodies[0], bodies[1], Window::UNIT, options)),
        _ => drop(time_of_contact(bodies[0], bodies[1], Window::UNIT, options)),
    }
}
