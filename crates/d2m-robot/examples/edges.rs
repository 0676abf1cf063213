//! How many edges of a planner are checked in a second: random edges of an arm of seven joints among five obstacles.
//!
//! `cargo run --release -p d2m-robot --example edges [ROBOT.urdf [R.srdf]]`

use d2m_bvh::{MeshTree, QueryOptions, TriMesh};
use d2m_robot::{Obstacle, Robot, RobotOptions, RobotScene, Srdf};
use glam::{DQuat, DVec3};
use std::error::Error;
use std::fmt::Write;
use std::sync::Arc;
use std::time::Instant;

/// An arm of seven joints that turn in turn about z and y, a cylinder and a box a link.
fn arm() -> String {
    let mut urdf = String::from("<robot name=\"seven\"><link name=\"l0\"/>");
    for k in 1..=7 {
        let (axis, parent) = (if k % 2 == 1 { "0 0 1" } else { "0 1 0" }, k - 1);
        // Writing to a string cannot fail.
        let _ = write!(
            urdf,
            "<link name=\"l{k}\"><collision><origin xyz=\"0 0 0.09\"/><geometry><cylinder radius=\"0.05\" length=\"0.14\"/></geometry></collision>\
             <collision><origin xyz=\"0.02 0 0.1\"/><geometry><box size=\"0.11 0.08 0.08\"/></geometry></collision></link>\
             <joint name=\"j{k}\" type=\"revolute\"><parent link=\"l{parent}\"/><child link=\"l{k}\"/>\
             <origin xyz=\"0 0 0.17\"/><axis xyz=\"{axis}\"/><limit lower=\"-2\" upper=\"2\" velocity=\"2\"/></joint>"
        );
    }
    urdf + "</robot>"
}

/// A box about the origin.
fn cuboid(half: DVec3) -> Result<Arc<MeshTree>, Box<dyn Error>> {
    let corners = (0..8).map(|k| {
        let side = |bit: u32| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
        half * DVec3::new(side(0), side(1), side(2))
    });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Ok(Arc::new(MeshTree::new(TriMesh::try_new(corners.collect(), triangles.collect())?)))
}

/// Numbers in [0, 1) that look random (a Weyl sequence of the golden ratio's fractions).
fn unit(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (options, file) = (RobotOptions::new(), arguments.next());
    let robot = match &file {
        Some(file) => Robot::read(file, &options)?,
        None => Robot::parse("seven.urdf", &arm(), &options)?,
    };
    let srdf = arguments.next().map(Srdf::read).transpose()?;
    let mut scene = RobotScene::new(Arc::new(robot), srdf.as_ref(), QueryOptions::default())?;
    let box_of = cuboid(DVec3::new(0.1, 0.15, 0.2))?;
    for (k, at) in [[0.6, 0.1, 0.2], [-0.5, 0.4, 0.6], [0.3, -0.6, 0.8], [0.0, 0.7, 0.3], [0.5, 0.5, 0.9]]
        .into_iter()
        .enumerate()
    {
        let name = format!("obstacle {k}");
        let turn = DQuat::from_xyzw(0.1 * k as f64, 0.2, -0.1, 1.0);
        scene.add_obstacle(Obstacle::at_rest(name, Arc::clone(&box_of), DVec3::from_array(at), turn)?)?;
    }
    let robot = Arc::clone(scene.robot());
    let names: Vec<&str> = robot.joint_names().into_iter().take(7).collect();
    let limits: Vec<[f64; 2]> =
        names.iter().filter_map(|name| robot.limits(robot.find_joint(name)?).position).collect();
    let edges = scene.edges(&names)?;
    for step in [0.1, 0.3, 1.0, 4.0] {
        let mut state = 1;
        let mut random =
            || -> Vec<f64> { limits.iter().map(|[lo, hi]| lo + (hi - lo) * unit(&mut state)).collect() };
        // From anywhere free towards anywhere, each joint by at most the step.
        let mut pairs = Vec::new();
        while pairs.len() < 300 {
            let (from, to) = (random(), random());
            let to: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a + (b - a).clamp(-step, step)).collect();
            if edges.check(&from, &from)?.is_free() {
                pairs.push([from, to]);
            }
        }
        let (start, mut times, mut free) = (Instant::now(), Vec::new(), 0);
        for [from, to] in &pairs {
            let start = Instant::now();
            free += usize::from(edges.check(from, to)?.is_free());
            times.push(start.elapsed().as_secs_f64() * 1e6);
        }
        let rate = pairs.len() as f64 / start.elapsed().as_secs_f64();
        times.sort_by(f64::total_cmp);
        println!(
            "steps of {step}: {free} of {} free, median {:.0} µs, worst {:.0} µs, {rate:.0} a second on one thread",
            pairs.len(),
            times[times.len() / 2],
            times[times.len() - 1]
        );
    }
    Ok(())
}
