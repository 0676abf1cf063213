//! `d2m robot`: is a planned path of a robot free of contact?

use super::robot_proof::{Proof, prove};
use crate::arguments::RobotArguments;
use crate::engine::{number, threads, time_limit};
use crate::failure::Failure;
use crate::inputs;
use crate::joint_turns::far_turns;
use crate::let_go::{Beginning, LetGo, at_start, exception};
use crate::load::named;
use crate::outcome::Outcome;
use crate::output::{Output, note, print, printable, short};
use crate::report::{clearance_word, clearance_words, evidence_sentence, start_word, vector};
use crate::robot_path::read_path;
use crate::robot_scene::RobotSceneFile;
use crate::unlike_sizes::unlike;
use crate::view::picture_of_path;
use d2m::bvh::{QueryOptions, StartState, Window};
use d2m_robot::{
    LimitWarning, PathAnswer, PathBodies, PathClearance, PathContact, Robot, RobotOptions, RobotScene, Srdf,
};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::PathBuf;

/// Runs the command.
pub(crate) fn run(arguments: &RobotArguments) -> Result<Outcome, Failure> {
    let place = named(&arguments.path);
    // Before the meshes, which take longer.
    let path = read_path(&arguments.path)?;
    let [start, end] = path.times().unwrap_or_default();
    let window = Window::try_new(start, end).map_err(|error| Failure::at(&place, error))?;
    // Before the search, which takes longer.
    let inputs =
        [Some(&arguments.robot), Some(&arguments.path), arguments.srdf.as_ref(), arguments.scene.as_ref()];
    let page = arguments.view.as_ref().map(|page| {
        if page == "-" {
            return Err(Failure::at("--view", "standard output has the answer: a file is needed"));
        }
        let inputs = inputs.into_iter().flatten().map(PathBuf::as_path);
        Output::new(page)?.spare(inputs)?.called("--view", &["html", "htm"])
    });
    let page = page.transpose()?;
    let file = arguments.scene.as_deref().map(RobotSceneFile::read).transpose()?;
    let options = options(arguments, file.as_ref())?;
    let mut robot_options = RobotOptions::new();
    for text in &arguments.package {
        let Some((name, folder)) =
            text.split_once('=').filter(|(name, folder)| !name.is_empty() && !folder.is_empty())
        else {
            return Err(Failure::at("--package", format!("{text:?} is not NAME=DIR")));
        };
        robot_options = robot_options.with_package(name, folder);
    }
    let robot =
        Robot::read(&arguments.robot, &robot_options).map_err(|error| Failure::Input(error.to_string()))?;
    for file in robot.files() {
        inputs::remember(file);
    }
    // Before the scene, which may have to warn: a fault is one line alone.
    robot.link_motions(&path).map_err(|error| Failure::at(&place, error))?;
    let srdf = arguments.srdf.as_ref().map(Srdf::read).transpose();
    let srdf = srdf.map_err(|error| Failure::Input(error.to_string()))?;
    // Said once all is read: a fault is one line alone.
    let mut notes: Vec<String> = robot.remarks().to_vec();
    let is_link = |link: &str| robot.find_link(link).is_some();
    let unknown = srdf.iter().flat_map(|srdf| srdf.find_unknown_links(is_link));
    notes.extend(unknown.map(|text| format!("warning: {text}")));
    if let Some(srdf) = &srdf
        && let Some(other) = srdf.robot().filter(|&name| name != robot.name())
    {
        notes.push(format!(
            "warning: {}: it is of the robot {other:?}, not of {:?}",
            srdf.file(),
            robot.name()
        ));
    }
    let fault = |error: d2m_robot::RobotError| Failure::at(&place, error);
    let mut scene = RobotScene::new(robot.into(), srdf.as_ref(), options).map_err(fault)?;
    if let Some(file) = &file {
        file.add_to(&mut scene, window)?;
    }
    page.as_ref().map_or(Ok(()), Output::spare_inputs)?;
    let warnings = scene.limit_warnings(&path).map_err(fault)?;
    let checked = {
        let bodies = scene.bodies_along(&path).map_err(fault)?;
        notes.extend(unlike_sizes(&bodies, scene.robot()));
        Checked { pairs: bodies.pairs().len(), bodies: bodies.len() }
    };
    if checked.pairs == 0 {
        notes.push(format!(
            "warning: of {} bodies no pair is checked: that a path is free says nothing",
            checked.bodies
        ));
    }
    let turns = far_turns(&path, scene.robot()).map_err(fault)?;
    notes.extend(turns.into_iter().map(|text| format!("warning: {place}: {text}")));
    notes.extend(warnings.iter().map(|warning| format!("warning: {place}: {warning}")));
    let pool = threads(arguments.threads.map_or(0, usize::from))?;
    // Before the search: joints that turn far may be why it takes long.
    for text in &notes {
        note(&format!("d2m: {text}"));
    }
    let answer = pool.install(|| scene.check_path(&path)).map_err(fault)?;
    let clearance = if arguments.clearance && answer.is_free() {
        pool.install(|| scene.clearance(&path)).map_err(fault)?
    } else {
        None
    };
    let bodies = scene.bodies_along(&path).map_err(fault)?;
    let beginnings = pool.install(|| beginnings(&bodies, &answer));
    let let_go: Vec<&LetGo> = beginnings.iter().filter_map(Beginning::let_go).collect();
    let start = answer.contact().map(|found| {
        at_start(found.bodies.map(|body| bodies.moving(body)), window, &bodies.pair_options(found.bodies))
    });
    let proof = if arguments.verify { Some(prove(&bodies, &answer)?) } else { None };
    if let Some(page) = page {
        page.write(&picture_of_path(&bodies, &answer, &beginnings).to_html())?;
    }
    print(&if arguments.json {
        let further = Further { checked, clearance, proof, let_go: &let_go, start };
        json(&answer, window, &warnings, &further)
    } else {
        text(&answer, &bodies, &beginnings)
            + &format!("  checked     {} pairs of {} bodies\n", checked.pairs, checked.bodies)
            + &clearance.as_ref().map_or(String::new(), nearness)
            + &proof.as_ref().map_or(String::new(), |proof| match proof {
                Proof::Verified(steps) => {
                    format!("  verified    yes, by an independent proof of {steps} steps\n")
                }
                Proof::Unverified(why) => format!("  verified    no: {}\n", printable(why)),
            })
    })?;
    let outcome = match &answer {
        PathAnswer::Free { .. } => Outcome::Separated,
        PathAnswer::Contact(_) => Outcome::Contact,
        PathAnswer::Undecided { .. } => Outcome::Undecided,
    };
    Ok(outcome.reported(arguments.exit_status))
}

/// Bodies beside the robot that are probably in another unit: very unlike its largest link.
fn unlike_sizes(bodies: &PathBodies<'_>, robot: &Robot) -> Vec<String> {
    let size = |body: usize| {
        let moving = bodies.moving(body);
        (bodies.name(body), moving.body.mesh().size() + 2.0 * moving.radius)
    };
    let (links, others): (Vec<_>, Vec<_>) =
        (0..bodies.len()).map(size).partition(|(name, _)| robot.find_link(name).is_some());
    let Some(&largest) = links.iter().max_by(|x, y| x.1.total_cmp(&y.1)) else { return Vec::new() };
    let texts = others.into_iter().filter_map(|other| unlike(other, largest));
    texts.map(|text| format!("warning: {text} (\"scale\")")).collect()
}

fn options(arguments: &RobotArguments, file: Option<&RobotSceneFile<'_>>) -> Result<QueryOptions, Failure> {
    let mut options = QueryOptions::default();
    if let Some(distance) = file.and_then(|file| file.terms.min_separation) {
        options = options.with_min_separation(distance);
    }
    if let Some(tolerance) = file.and_then(|file| file.terms.tolerance) {
        options = options.with_tolerance(tolerance);
    }
    if let Some(start) = file.and_then(|file| file.terms.start) {
        options = options.with_start(start);
    }
    if let Some(text) = &arguments.min_separation {
        let distance = number("--min-separation", text, "a distance that is not negative", |d| d >= 0.0)?;
        options = options.with_min_separation(distance);
    }
    if let Some(text) = &arguments.time_limit {
        options = options.with_budget(time_limit(text)?);
    }
    Ok(options)
}

/// How much was checked.
#[derive(Clone, Copy)]
struct Checked {
    pairs: usize,
    /// Collision bodies of the links, obstacles and attached bodies.
    bodies: usize,
}

/// What is said beside the answer.
struct Further<'a> {
    checked: Checked,
    clearance: Option<PathClearance>,
    proof: Option<Proof>,
    let_go: &'a [&'a LetGo],
    /// How the bodies of the contact stood at the start of the path.
    start: Option<StartState>,
}

/// From when on the answer counts, of all pairs that are checked.
fn beginnings(bodies: &PathBodies<'_>, answer: &PathAnswer) -> Vec<Beginning> {
    let of = |&pair: &[usize; 2]| {
        // They never part: that is the answer.
        if answer.contact().is_some_and(|found| found.bodies == pair && found.contact.left.is_none()) {
            return Beginning::Start;
        }
        let moving = pair.map(|body| bodies.moving(body));
        let names = pair.map(|body| bodies.name(body));
        Beginning::of(names, moving, bodies.window(), &bodies.pair_options(pair))
    };
    bodies.pairs().par_iter().map(of).collect()
}

/// What is proven of all pairs at the times that are certified.
fn kept(bodies: &PathBodies<'_>, beginnings: &[Beginning]) -> String {
    let distances = bodies.pairs().iter().map(|&pair| bodies.pair_options(pair).min_separation);
    let (least, most) =
        distances.fold((f64::INFINITY, 0.0_f64), |(least, most), d| (least.min(d), most.max(d)));
    let kept = if most == 0.0 {
        String::new()
    } else if least == most {
        format!(", all pairs further apart than {}", short(most))
    } else {
        let [least, most] = [least, most].map(short);
        format!(", each pair further apart than its own minimum separation (from {least} to {most})")
    };
    kept + exception(beginnings)
}

/// The answer for a program.
fn json(
    answer: &PathAnswer,
    window: Window,
    warnings: &[LimitWarning],
    Further { checked, clearance, proof, let_go, start }: &Further<'_>,
) -> String {
    let mut object = json!({
        "status": status(answer),
        "time": Value::Null,
        "free_until": answer.free_until(),
        "a": Value::Null,
        "b": Value::Null,
        "window": [window.start(), window.end()],
        "pairs_checked": checked.pairs,
        "warnings": warnings.iter().map(LimitWarning::to_string).collect::<Vec<_>>(),
    });
    let mut put = |key: &str, value: Value| object[key] = value;
    match answer {
        PathAnswer::Undecided { a, b, .. } => {
            put("a", json!(a));
            put("b", json!(b));
        }
        PathAnswer::Contact(found) => {
            let PathContact { a, b, contact, .. } = &**found;
            put("time", json!([contact.time_lo, contact.time_hi]));
            put("a", json!(a));
            put("b", json!(b));
            put("separation", json!(contact.separation));
            put("tolerance", json!(contact.tolerance));
            put("point", json!(contact.point_a.to_array()));
            put("normal", json!(contact.normal.to_array()));
            put("evidence", json!(contact.evidence.to_string()));
            put("start", json!(crate::report::start_in_json(start.unwrap_or(contact.start))));
        }
        PathAnswer::Free { .. } => {}
    }
    if let Some(PathClearance { lower, upper, time, a, b, status, .. }) = clearance {
        put("a", json!(a));
        put("b", json!(b));
        put("clearance", json!([lower, upper]));
        put("clearance_time", json!(time));
        put("clearance_status", json!(clearance_word(*status)));
    }
    if !let_go.is_empty() {
        put("left", let_go.iter().map(|pair| pair.json()).collect());
    }
    if let Some(proof) = proof {
        put("verified", json!(matches!(proof, Proof::Verified(_))));
        match proof {
            Proof::Verified(steps) => put("proof_steps", json!(steps)),
            Proof::Unverified(why) => put("why", json!(why)),
        }
    }
    format!("{object}\n")
}

/// How near a free path comes, for a person.
fn nearness(PathClearance { lower, upper, time, a, b, status, .. }: &PathClearance) -> String {
    let (enclosure, time) = (clearance_words([*lower, *upper], *status), short(*time));
    let [a, b] = [a, b].map(|name| printable(name));
    format!("  clearance   {enclosure}, {a} \u{2013} {b} at t = {time}\n")
}

const fn status(answer: &PathAnswer) -> &'static str {
    match answer {
        PathAnswer::Free { .. } => "free",
        PathAnswer::Contact(_) => "contact",
        PathAnswer::Undecided { .. } => "undecided",
    }
}

/// The answer for a person.
fn text(answer: &PathAnswer, bodies: &PathBodies<'_>, beginnings: &[Beginning]) -> String {
    let [start, end] = [bodies.window().start(), bodies.window().end()].map(short);
    let kept = kept(bodies, beginnings);
    let mut text = match answer {
        PathAnswer::Free { .. } => format!("FREE: certified, no contact from {start} to {end}{kept}\n"),
        PathAnswer::Undecided { free_until, a, b, .. } if *free_until <= bodies.window().start() => {
            format!("UNDECIDED from the start: {} \u{2013} {} needs more time\n", printable(a), printable(b))
        }
        PathAnswer::Undecided { free_until, a, b, .. } => format!(
            "UNDECIDED: certified free from {start} until {}{kept}; then {} \u{2013} {} needs more time\n",
            short(*free_until),
            printable(a),
            printable(b)
        ),
        PathAnswer::Contact(found) => {
            let time = short(found.contact.time_lo);
            format!("CONTACT of {} \u{2013} {} at t = {time}\n", printable(&found.a), printable(&found.b))
        }
    };
    if let PathAnswer::Contact(found) = answer {
        let contact = &found.contact;
        let [a, b] = [&found.a, &found.b].map(|name| printable(name));
        let separation = bodies.pair_options(found.bodies).min_separation;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  time        [{}, {}]", short(contact.time_lo), short(contact.time_hi));
        let certified = if contact.time_lo > bodies.window().start() || contact.start == StartState::Apart {
            format!("free from {start} until the first of these times{kept}")
        } else {
            format!("in contact from the start of the path: {}", start_word(contact.start))
        };
        let _ = writeln!(text, "  certified   {certified}");
        let _ = writeln!(text, "  evidence    {}", evidence_sentence(contact, separation));
        let _ = writeln!(text, "  separation  {:.4e} left then", contact.separation);
        let _ = writeln!(text, "  point       {} on {a}", vector(contact.point_a));
        let _ = writeln!(text, "  normal      {} from {a} to {b}", vector(contact.normal));
    }
    for pair in beginnings.iter().filter_map(Beginning::let_go) {
        let _ = writeln!(text, "  left        {}", pair.words());
    }
    text
}
