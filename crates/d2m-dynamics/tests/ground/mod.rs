//! What bodies of tests stand on, and how they come to rest.
#![allow(dead_code)] // not every test needs all of it

use d2m_bvh::{MeshTree, Moving, QueryOptions, Window, time_of_contact};
use d2m_dynamics::{Body, BodyId, Kind, Segment, Simulation};
use d2m_motion::{ConstantTwist, Pose};
use glam::{DQuat, DVec3};
use std::sync::Arc;

pub(crate) fn tree(shape: &str) -> Arc<MeshTree> {
    Arc::new(MeshTree::new(d2m_shapes::mesh(shape).unwrap()))
}

pub(crate) fn cube() -> Arc<MeshTree> {
    tree("box?x=0.5&y=0.5&z=0.5")
}

pub(crate) fn floor() -> Body {
    let floor = Body::new("floor", tree("box?x=20&y=0.5&z=20")).with_kind(Kind::Static).with_friction(0.5);
    floor.with_position(DVec3::Y * -0.5)
}

/// Ten times as wide as it is thick, with its top at zero.
pub(crate) fn slab(scale: f64) -> Body {
    let shape = tree(&format!("box?x={}&y={}&z={}", 10.0 * scale, scale, 10.0 * scale));
    Body::new("floor", shape).with_kind(Kind::Static).with_position(DVec3::NEG_Y * scale)
}

/// What some steps came to.
pub(crate) struct Run {
    pub(crate) skipped: f64,
    pub(crate) events: u32,
}

/// Steps until `end`; the skipped time.
pub(crate) fn run(simulation: &mut Simulation, end: f64) -> f64 {
    counted(simulation, end).skipped
}

pub(crate) fn counted(simulation: &mut Simulation, end: f64) -> Run {
    let mut run = Run { skipped: 0.0, events: 0 };
    while simulation.time() < end {
        let report = simulation.step().unwrap();
        assert!(report.events <= 256 * simulation.options().max_events + simulation.len() as u32);
        run.events += report.events;
        run.skipped += report.segments.iter().map(|s| s.skipped).sum::<f64>();
    }
    run.skipped += simulation.finish().iter().map(|s| s.skipped).sum::<f64>();
    run
}

pub(crate) fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(DVec3::new(x, y, z), DQuat::IDENTITY)
}

pub(crate) fn rest(simulation: &mut Simulation, body: BodyId) {
    while !simulation.is_asleep(body) {
        simulation.step().unwrap();
        assert!(simulation.time() < 20.0, "it does not come to rest");
    }
}

/// Flies the reported twists again: they join, and no two bodies meet in any segment.
pub(crate) fn judge(segments: &[Segment], trees: &[Arc<MeshTree>]) {
    judge_from(f64::NEG_INFINITY, segments, trees);
}

/// The same; whether bodies meet is judged in segments from a time on.
pub(crate) fn judge_from(begin: f64, segments: &[Segment], trees: &[Arc<MeshTree>]) {
    let mut flights: Vec<ConstantTwist> = Vec::new();
    for (k, segment) in segments.iter().enumerate() {
        for (id, flight) in &segment.changed {
            if k == 0 {
                assert_eq!(flights.len(), id.index());
                flights.push(*flight);
                continue;
            }
            let before = flights[id.index()].rebase(segment.start);
            let (x, y) = (before.position(), flight.position());
            assert!((x - y).length() <= 1e-12 * (1.0 + x.length()), "segment {k}: {x} {y}");
            assert!(before.orientation().dot(flight.orientation()).abs() > 1.0 - 1e-14);
            flights[id.index()] = *flight;
        }
        if k > 0 {
            assert_eq!(segment.start.to_bits(), segments[k - 1].end.to_bits());
        }
        if segment.start < begin {
            continue;
        }
        let window = Window::try_new(segment.start, segment.end).unwrap();
        for a in 0..trees.len() {
            for b in a + 1..trees.len() {
                let moving = |i: usize| Moving::new(&*trees[i], &flights[i]);
                let answer = time_of_contact(moving(a), moving(b), window, &QueryOptions::default()).unwrap();
                assert!(answer.is_separated(), "segment {k}: {a} and {b} meet: {answer:?}");
            }
        }
    }
}
