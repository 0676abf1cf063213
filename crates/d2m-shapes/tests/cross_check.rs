//! Default engine, reference method and slow judge on procedural shapes: a screw in its nut, a link in a link.

use d2m_bvh::{QueryOptions, Solid, Window};
use d2m_motion::ConstantTwist;
use d2m_paper::{CrossCheck, cross_check};
use d2m_shapes::mesh;
use glam::{DVec3, dvec3};

fn judge(a: &str, b: &str, motions: &[ConstantTwist; 2], window: Window) -> CrossCheck {
    let meshes = [a, b].map(|text| mesh(text).expect("a shape"));
    let options = QueryOptions::DEFAULT.with_solid(Solid::Filled);
    let report = cross_check(&format!("{a} and {b}"), meshes, *motions, window, &options);
    assert!(report.complaints.is_empty(), "{:#?}", report.complaints);
    assert_eq!(report.undecided, [0, 0]);
    report
}

fn moving(v: DVec3, w: DVec3) -> ConstantTwist {
    ConstantTwist::REST.with_linear_velocity(v).with_angular_velocity(w)
}

/// With a radial play of 1e-4 the threads stay apart at rest, and a push along or across the axis meets them within it.
#[test]
fn a_screw_in_its_nut() {
    let (screw, nut) = ("screw?triangles=2000", "nut?triangles=2000&clearance=1e-4");
    let rest = ConstantTwist::REST;
    assert_eq!(judge(screw, nut, &[rest, rest], Window::UNIT).contacts, 0);
    for push in [dvec3(0.0, 0.0, 1.0), dvec3(1.0, 0.25, 0.0)] {
        assert_eq!(judge(screw, nut, &[moving(push, DVec3::ZERO), rest], Window::UNIT).contacts, 1, "{push}");
    }
    // Turned without advancing, the threads meet after a small angle.
    let turning = moving(DVec3::ZERO, dvec3(0.0, 0.0, 1.0));
    assert_eq!(judge(screw, nut, &[turning, rest], Window::UNIT).contacts, 1);
}
