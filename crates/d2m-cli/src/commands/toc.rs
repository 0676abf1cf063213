//! `d2m toc`: one query.

use crate::arguments::TocArguments;
use crate::engine::{Answer, Pair};
use crate::failure::Failure;
use crate::load::load;
use crate::motion::{Motion, parse_window};
use crate::output::{Output, print};
use crate::report;
use d2m::bvh::{TimeOfContact, TriMesh, Window};
use d2m::motion::{ConstantTwist, RigidMotion};
use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

/// Runs the command.
pub(crate) fn run(arguments: &TocArguments) -> Result<(), Failure> {
    let window = parse_window(&arguments.window)?;
    let motion_a = Motion::parse("--motion-a", &arguments.motion_a)?;
    let motion_b = Motion::parse("--motion-b", &arguments.motion_b)?;
    motion_a.require_window("--motion-a", window)?;
    motion_b.require_window("--motion-b", window)?;
    let motion_files = [&arguments.motion_a, &arguments.motion_b].map(|motion| motion.strip_prefix('@'));
    let meshes = [&arguments.a, &arguments.b].map(String::as_str);
    let inputs = motion_files.into_iter().flatten().chain(meshes).map(Path::new);
    let scene = match &arguments.obj {
        Some(path) => Some(Output::new(path)?.spare(inputs)?),
        None => None,
    };
    let pair = Pair::new(load(&arguments.a)?, load(&arguments.b)?, &arguments.query)?.on_all_threads();
    let answer = ask(&pair, &motion_a, &motion_b, window)?;
    if let Some(scene) = scene {
        let time = match &answer.verdict {
            TimeOfContact::Contact(contact) => contact.time_lo,
            TimeOfContact::Undecided { clear_until } => *clear_until,
            TimeOfContact::Separated => window.end(),
        };
        let mut text = format!("# d2m toc: {} at t = {time}\n", report::status(&answer.verdict));
        let mut base = 1;
        for (name, body, motion) in [("A", &pair.a, &motion_a), ("B", &pair.b, &motion_b)] {
            if let Some(piece) = motion.piece_until(time) {
                let _ = writeln!(text, "o {name}");
                base += write_posed(&mut text, body.mesh(), piece, time, base);
            }
        }
        scene.write(&text)?;
    }
    print(&if arguments.json {
        report::json(&pair, window, &answer)
    } else {
        report::text(&pair, window, &answer)
    })
}

/// Asks piece by piece where a motion has keyframes; the first contact is the answer.
fn ask(pair: &Pair, a: &Motion, b: &Motion, window: Window) -> Result<Answer, Failure> {
    let mut took = Duration::ZERO;
    let mut start = window.start();
    loop {
        let pieces = a.piece_at(start).zip(b.piece_at(start));
        let Some(((piece_a, end_a), (piece_b, end_b))) = pieces else {
            // Keyframes cover the window, so only its end has no piece after it.
            return Ok(Answer { verdict: TimeOfContact::Separated, took });
        };
        let end = window.end().min(end_a).min(end_b);
        let part = Window::try_new(start, end).map_err(|error| Failure::at("--window", error))?;
        let answer = pair.ask(piece_a, piece_b, part)?;
        took += answer.took;
        if !answer.verdict.is_separated() || end >= window.end() {
            return Ok(Answer { took, ..answer });
        }
        start = end;
    }
}

/// Appends the posed mesh and returns its number of vertices.
fn write_posed(text: &mut String, mesh: &TriMesh, motion: &ConstantTwist, time: f64, base: usize) -> usize {
    let (pose, _) = motion.pose_and_twist(time);
    for &vertex in mesh.vertices() {
        let placed = pose.rotation * (vertex - pose.at) + pose.translation;
        let _ = writeln!(text, "v {} {} {}", placed.x, placed.y, placed.z);
    }
    for corners in mesh.triangles() {
        let [a, b, c] = corners.map(|vertex| vertex as usize + base);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    mesh.vertex_count()
}
