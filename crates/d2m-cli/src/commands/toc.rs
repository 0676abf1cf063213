//! `d2m toc`: one query.

use crate::arguments::{MotionArguments, PairArguments, TocArguments};
use crate::engine::{Pair, check_size};
use crate::failure::Failure;
use crate::outcome::Outcome;
use crate::output::{Output, print_answer, require_distinct};
use crate::report;
use crate::sizes::{load_both, sizes_line};
use crate::travel::{Travel, warn_of_turn};
use crate::verification::{PairVerifier, Promise, Proof, joined, promises_of};
use d2m::bvh::{TimeOfContact, TriMesh, Window};
use d2m::motion::{AnyMotion, RigidMotion};
use std::fmt::Write;
use std::path::Path;

/// Two bodies with their motions and the window, as `d2m toc`, `d2m clearance` and `d2m spans` take them.
pub(super) struct MovingPair {
    pub(super) pair: Pair,
    pub(super) motion_a: AnyMotion,
    pub(super) motion_b: AnyMotion,
    pub(super) window: Window,
    pub(super) travels: [Travel; 2],
}

/// Reads motions, then meshes.
pub(super) fn read(arguments: &PairArguments) -> Result<MovingPair, Failure> {
    let (window, [motion_a, motion_b]) = arguments.motions.parse()?;
    let Some(b) = arguments.b.as_deref() else {
        return Err(Failure::at(
            &arguments.a,
            "a second mesh is missing, or a scene (.json) in place of both",
        ));
    };
    let [a, b] = load_both(&arguments.a, b, &arguments.query.sizes)?;
    let pair = Pair::new(a, b, &arguments.query)?.on_all_threads();
    check_size("--motion-a", &motion_a, &pair.a)?;
    check_size("--motion-b", &motion_b, &pair.b)?;
    let travels = [&motion_a, &motion_b].map(|motion| Travel::of(motion, window));
    warn_of_turn("--motion-a", travels[0]);
    warn_of_turn("--motion-b", travels[1]);
    Ok(MovingPair { pair, motion_a, motion_b, window, travels })
}

/// Where `--obj` writes to: never over what is read, nor between the answer.
fn posed_file(arguments: &TocArguments) -> Result<Option<Output>, Failure> {
    let MotionArguments { motion_a, motion_b, .. } = &arguments.pair.motions;
    let motion_files = [motion_a, motion_b].map(|motion| motion.strip_prefix('@'));
    let meshes = [Some(arguments.pair.a.as_str()), arguments.pair.b.as_deref()];
    let inputs = motion_files.into_iter().chain(meshes).flatten().map(Path::new);
    let posed = arguments.obj.as_deref().map(|path| {
        let posed = Output::new(path)?.spare(inputs)?.called("--obj", &["obj"])?;
        // Where the answer goes.
        require_distinct([&Output::Stdout, &posed])?;
        Ok(posed)
    });
    posed.transpose()
}

/// Runs the command.
pub(crate) fn run(arguments: &TocArguments) -> Result<Outcome, Failure> {
    let TocArguments { pair: asked, .. } = arguments;
    let posed = posed_file(arguments)?;
    let MovingPair { pair, motion_a, motion_b, window, travels } = read(asked)?;
    posed.as_ref().map_or(Ok(()), Output::spare_inputs)?;
    let answer = pair.answer_with([&motion_a, &motion_b], window, arguments.further)?;
    if let Some(posed) = posed {
        let time = match &answer.verdict {
            TimeOfContact::Contact(contact) => contact.time_lo,
            TimeOfContact::Undecided { clear_until } => *clear_until,
            TimeOfContact::Separated => window.end(),
        };
        let mut text = format!("# d2m toc: {} at t = {time}\n", report::status(&answer.verdict));
        let mut base = 1;
        for (name, body, motion) in [("A", &pair.a, &motion_a), ("B", &pair.b, &motion_b)] {
            let _ = writeln!(text, "o {name}");
            base += write_posed(&mut text, body.mesh(), motion, time, base);
        }
        posed.write(&text)?;
    }
    let proof = prove(asked, &pair, [&motion_a, &motion_b], window, &promises_of(&answer))?;
    print_answer(&if asked.json {
        with_proof(asked, report::json(&pair, window, &answer), proof)?
    } else {
        with_proof(asked, report::text(&pair, window, &answer), proof)?
            + &sizes_line(pair.sizes(), Some(travels))
    })?;
    Ok(Outcome::from(&answer.verdict).reported(asked.exit_status))
}

/// What is promised, proven again if that is wanted.
pub(super) fn prove(
    arguments: &PairArguments,
    pair: &Pair,
    motions: [&dyn RigidMotion; 2],
    window: Window,
    promises: &[Promise],
) -> Result<Option<Proof>, Failure> {
    if !arguments.verify {
        return Ok(None);
    }
    let verifier = PairVerifier::new(pair)?;
    Ok(Some(joined(promises.iter().map(|promise| verifier.prove(motions, window, promise)))))
}

/// The answer with what became of its proof, as it is printed.
pub(super) fn with_proof(
    arguments: &PairArguments,
    text: String,
    proof: Option<Proof>,
) -> Result<String, Failure> {
    Ok(match proof {
        None => text,
        Some(proof) if arguments.json => proof.put_into(&text)?,
        Some(proof) => format!("{text}  verified    {}\n", proof.sentence()),
    })
}

/// Appends the posed mesh and returns its number of vertices.
fn write_posed(text: &mut String, mesh: &TriMesh, motion: &dyn RigidMotion, time: f64, base: usize) -> usize {
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
