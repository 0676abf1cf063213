//! Edges that cross at small angles and faces that are slivers: what is left at `time_lo` is a few tolerances, and no
//! tolerance has to be raised for it.

use d2m_bvh::{MeshTree, Moving, QueryOptions, Solid, TriMesh, Window, time_of_contact};
use d2m_motion::ConstantTwist;
use d2m_testing::{Draw, KnuthRandom};
use glam::DVec3;

/// Which features meet at the height 0.
#[derive(Clone, Copy, Debug)]
enum Meeting {
    /// Edges of upright triangles that cross at the angle.
    Edges,
    /// Edges of triangles that are flat but for the angle.
    FlatEdges,
    /// A corner above a triangle that is as narrow as the angle.
    Sliver,
}

#[test]
fn small_angles_leave_few_tolerances() {
    let mut random = KnuthRandom(31);
    for meeting in [Meeting::Edges, Meeting::FlatEdges, Meeting::Sliver] {
        for (power, round) in (-16..0).flat_map(|power| (0..60).map(move |round| (power, round))) {
            let angle = 10f64.powf(f64::from(power) + 0.5 * random.signed().abs());
            let tolerance = [1e-10, 1e-12, 1e-14][round % 3];
            let mut next = || random.signed();
            let (along, off) = (DVec3::new(angle.cos(), angle.sin(), 0.0), 0.3 * next());
            let (a, b) = match meeting {
                Meeting::Edges => {
                    let shift = DVec3::X * off;
                    let a = [DVec3::NEG_X, DVec3::X, DVec3::new(0.0, next(), -1.0)];
                    (a, [shift - along * 0.9, shift + along * 0.8, DVec3::new(0.1, next(), 1.0)])
                }
                Meeting::FlatEdges => {
                    let a = [DVec3::NEG_X, DVec3::X, DVec3::new(0.0, 0.7 * next(), -angle * next().abs())];
                    (a, [along * -0.9, along * 0.8, DVec3::new(0.1, -0.4 * next(), angle * next().abs())])
                }
                Meeting::Sliver => {
                    let a = [DVec3::NEG_X, DVec3::X, DVec3::new(off, angle, 0.0)];
                    let mut top = || DVec3::new(next(), next(), 1.0);
                    (a, [DVec3::new(0.5 * off, 0.3 * angle, 0.0), top(), top()])
                }
            };
            let turn = random.moderate_turn().normalize();
            let tree = |corners: [DVec3; 3]| {
                let corners = corners.map(|p| turn * p).to_vec();
                MeshTree::new(TriMesh::try_new(corners, vec![[0, 1, 2]]).unwrap())
            };
            let (a, b) = (tree(a), tree(b));
            let up = turn * DVec3::Z;
            let falls = ConstantTwist::REST.with_position(up * 0.5).with_linear_velocity(-up);
            let options = QueryOptions::default().with_solid(Solid::Surface).with_tolerance(tolerance);
            let (a, b) = (Moving::new(&a, &ConstantTwist::REST), Moving::new(&b, &falls));
            let answer = time_of_contact(a, b, Window::UNIT, &options).unwrap();
            let what = format!("{meeting:?}, angle {angle:e}, tolerance {tolerance:e}: {answer:?}");
            let contact = answer.contact().unwrap_or_else(|| panic!("{what}"));
            // Sizes are below ten, so rounding raises the tolerance to 3e-13 at most.
            assert!(contact.tolerance <= tolerance.max(3e-13), "{what}");
            let left = 0.5 - contact.time_lo;
            assert!(left > 0.0 && left <= 3.3 * contact.tolerance, "{what}");
            assert!(contact.separation <= 3.3 * contact.tolerance, "{what}");
        }
    }
}
