//! Crowds that turn fast against what separates them: accelerations allow no plane for all the time until the contact, and
//! many for parts of it.

use d2m_bvh::{
    Answered, Budget, MeshTree, Moving, QueryOptions, Solid, TriMesh, Window, time_of_contact_counted,
};
use d2m_motion::ConstantTwist;
use d2m_testing::Surface;
use glam::DVec3;

/// Node tests of one query, at most: 81 864 are needed. Pair by pair it were several hundred times as many, and twice as many where the
/// rates of rims count as those of tips.
const MOST_WORK: u64 = 1 << 17;
/// With a small cap a failure is quick.
const BUDGET: u64 = 1 << 21;

/// Triangles that have their lowest vertices (highest ones with a `height` below zero) near the origin.
fn spikes(count: u32, height: f64) -> MeshTree {
    let corners = |k: u32| {
        let angle = 2.399_963 * f64::from(k);
        let tip = DVec3::new(angle.cos(), (2.0 * angle).sin(), angle.sin().abs() * height.signum()) * 1e-9;
        let rim = |angle: f64| DVec3::new(angle.cos(), angle.sin(), height);
        [tip, rim(angle), rim(angle + 0.3)]
    };
    MeshTree::new(Surface::soup((0..count).flat_map(corners)).into_mesh(TriMesh::try_new))
}

/// Bodies turn about their tips, one or both, while these come together at the middle of the window.
#[test]
fn crowds_that_turn_are_advanced_together() {
    let (above, below) = (spikes(400, 0.5), spikes(400, -0.5));
    let (gap, speed) = (5e-3, 0.0107);
    let meet = gap / speed;
    let window = Window::try_new(meet - 0.05, meet + 0.05).unwrap();
    let budget = Budget::UNLIMITED.with_node_tests(BUDGET);
    let options = QueryOptions::default().with_solid(Solid::Surface).with_budget(budget);
    let turning = |spin: DVec3, velocity: DVec3| {
        ConstantTwist::REST
            .with_reference_time(meet)
            .with_angular_velocity(spin)
            .with_linear_velocity(velocity)
    };
    for axis in [DVec3::X, DVec3::new(0.1, 1.0, 0.0), DVec3::Z] {
        for other in [0.0, -1.0, 0.5] {
            let spin = axis.normalize() * 8.0;
            let [moving, against] = [turning(spin, DVec3::Z * -speed), turning(spin * other, DVec3::ZERO)];
            let [a, b] = [Moving::new(&above, &moving), Moving::new(&below, &against)];
            for (a, b) in [(a, b), (b, a)] {
                let Answered { answer, work } = time_of_contact_counted(a, b, window, &options).unwrap();
                let contact = answer.contact().unwrap_or_else(|| panic!("{axis} {other}: {answer:?}"));
                // Tips are within 1e-9 of the points that meet.
                assert!((contact.time_lo - meet).abs() < 1e-8 / speed, "{} {meet}", contact.time_lo);
                let work = work.work();
                assert!(work < MOST_WORK, "{axis} {other}: {work}");
            }
        }
    }
}
