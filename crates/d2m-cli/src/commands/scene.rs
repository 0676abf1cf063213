//! `d2m scene`: the contacts of many bodies.

use super::scene_question::sizes_line_of;
use crate::arguments::SceneArguments;
use crate::engine::{threads, time_limit};
use crate::failure::Failure;
use crate::let_go::{Beginning, LetGo, at_start, exception};
use crate::load::named;
use crate::outcome::Outcome;
use crate::output::{print_answer, printable, progress_bar, short};
use crate::report::{feature_field, start_in_json, start_word, vector};
use crate::scene::{Scene, SceneBody};
use crate::verification::{Bodies, Proof, joined};
use d2m::bvh::{Contact, QueryOptions, Start, StartState, TimeOfContact, Window};
use d2m::{BodyId, FirstContact, PairContact, WorldError};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde_json::{Value, json};
use std::fmt::Write;

/// A contact of two bodies by number.
struct Row {
    bodies: [usize; 2],
    answer: TimeOfContact,
    /// What counts of a contact at the start.
    start: Start,
    /// Of a pair whose contact at the start is let go: how it stood at the start.
    left_from: Option<StartState>,
}

impl Row {
    fn new(scene: &Scene, bodies: [BodyId; 2], answer: TimeOfContact, options: QueryOptions) -> Self {
        let bodies = bodies.map(BodyId::index);
        let options = scene.pair_options(bodies, options);
        let left_from = match (&answer, options.start) {
            (TimeOfContact::Contact(contact), Start::Leave) => Some(match contact.left {
                None => contact.start,
                Some(left) if left.hi <= scene.window.start() => StartState::Apart,
                Some(_) => at_start(bodies.map(|body| scene.bodies[body].moving()), scene.window, &options),
            }),
            _ => None,
        };
        Self { bodies, answer, start: options.start, left_from }
    }
}

/// Runs the command.
pub(crate) fn run(arguments: &SceneArguments) -> Result<Outcome, Failure> {
    let mut scene = Scene::read(&arguments.scene)?;
    scene.warn(&named(&arguments.scene));
    if let Some(start) = arguments.start {
        scene = scene.with_start(start.into());
    }
    let mut options = QueryOptions::default();
    if let Some(text) = &arguments.time_limit {
        options = options.with_budget(time_limit(text)?);
    }
    let mut world = scene.world(options);
    let named = |error: WorldError| Failure::at(named(&arguments.scene), scene.describe(error));
    let pool = threads(arguments.threads.map_or(0, usize::from))?;
    let bar = progress_bar(0, "pairs");
    let progress = |done: usize, all: usize| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    };
    let row = |pair: PairContact| Row::new(&scene, [pair.a, pair.b], pair.answer, options);
    let rows: Vec<Row> = pool.install(|| {
        if !arguments.first {
            let contacts = world.contacts_with_progress(scene.window, &progress).map_err(named)?;
            return Ok::<_, Failure>(contacts.into_iter().map(row).collect());
        }
        Ok(match world.first_contact_with_progress(scene.window, &progress).map_err(named)? {
            FirstContact::Separated => Vec::new(),
            FirstContact::Undecided { clear_until, a, b, .. } => {
                vec![Row::new(&scene, [a, b], TimeOfContact::Undecided { clear_until }, options)]
            }
            FirstContact::Contact { a, b, contact, overlapping, .. } => {
                let first = Row::new(&scene, [a, b], TimeOfContact::Contact(contact), options);
                std::iter::once(first).chain(overlapping.into_iter().map(row)).collect()
            }
        })
    })?;
    bar.finish_and_clear();
    let names: Vec<&str> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
    let beginnings = pool.install(|| beginnings(&scene, &names, &rows, options));
    let let_go: Vec<&LetGo> = beginnings.iter().filter_map(Beginning::let_go).collect();
    let proof = if arguments.verify { Some(prove(&scene, &rows)?) } else { None };
    print_answer(&if arguments.json {
        let text = json(scene.window, &names, &rows, &let_go);
        proof.map_or(Ok(text.clone()), |proof| proof.put_into(&text))?
    } else {
        let proof = proof.map_or(String::new(), |proof| format!("  verified: {}\n", proof.sentence()));
        text(scene.window, &names, &rows, &beginnings) + &proof + &sizes_line_of(&scene)
    })?;
    let outcome = if rows.iter().any(|row| row.answer.contact().is_some()) {
        Outcome::Contact
    } else if rows.is_empty() {
        Outcome::Separated
    } else {
        Outcome::Undecided
    };
    Ok(outcome.reported(arguments.exit_status))
}

/// From when on it counts that pairs have no contact in the answer.
fn beginnings(scene: &Scene, names: &[&str], rows: &[Row], options: QueryOptions) -> Vec<Beginning> {
    if !scene.lets_go() {
        return Vec::new();
    }
    // Contacts say it themselves.
    let contacts: Vec<&Row> = rows.iter().filter(|row| row.answer.contact().is_some()).collect();
    let is_listed =
        |[a, b]: [usize; 2]| contacts.iter().any(|row| row.bodies == [a, b] || row.bodies == [b, a]);
    let of = |pair: [usize; 2]| {
        let options = scene.pair_options(pair, options);
        let moving = pair.map(|body| scene.bodies[body].moving());
        Beginning::of(pair.map(|body| names[body]), moving, scene.window, &options)
    };
    scene.pairs().into_par_iter().filter(|&pair| !is_listed(pair)).map(of).collect()
}

/// Proves the first contact of all again: each pair that is not in the answer is apart until the first one, also where that is at the end of the
/// window. Of several at the start the search does not find all.
fn prove(scene: &Scene, rows: &[Row]) -> Result<Proof, Failure> {
    let bodies = Bodies::new(scene.bodies.iter().map(SceneBody::moving).collect())?;
    let first = match rows.first().map(|row| &row.answer) {
        Some(TimeOfContact::Contact(contact)) => TimeOfContact::Undecided { clear_until: contact.time_lo },
        None | Some(TimeOfContact::Separated) => TimeOfContact::Separated,
        Some(undecided) => *undecided,
    };
    let mut proofs = Vec::new();
    for pair in scene.pairs() {
        let options = scene.pair_options(pair, QueryOptions::default());
        let [a, b] = pair;
        let reported = rows.iter().find(|row| row.bodies == [a, b] || row.bodies == [b, a]);
        let (pair, answer) = reported.map_or((pair, &first), |row| (row.bodies, &row.answer));
        proofs.push(bodies.prove(pair, scene.window, &options, answer));
    }
    Ok(joined(proofs))
}

/// The answer for a program.
fn json(window: Window, names: &[&str], rows: &[Row], let_go: &[&LetGo]) -> String {
    let contacts: Vec<Value> = rows
        .iter()
        .map(|row| {
            let [a, b] = row.bodies.map(|body| names[body]);
            match &row.answer {
                TimeOfContact::Contact(contact) => with_start(
                    row,
                    contact,
                    json!({
                        "a": a, "b": b, "status": "contact",
                        "toc": contact.time_lo, "toc_hi": contact.time_hi,
                        "separation": contact.separation, "tolerance": contact.tolerance,
                        "evidence": contact.evidence.to_string(),
                        "normal": contact.normal.to_array(), "point": contact.point_a.to_array(),
                        "feature": feature_field(contact.feature),
                        "triangle_a": contact.triangle_a, "triangle_b": contact.triangle_b,
                    }),
                ),
                TimeOfContact::Undecided { clear_until } => {
                    json!({ "a": a, "b": b, "status": "undecided", "toc": clear_until })
                }
                TimeOfContact::Separated => json!({ "a": a, "b": b, "status": "separated" }),
            }
        })
        .collect();
    let mut answer = json!({ "window": [window.start(), window.end()], "contacts": contacts });
    if !let_go.is_empty() {
        answer["left"] = let_go.iter().map(|pair| pair.json()).collect();
    }
    format!("{answer}\n")
}

/// A contact with how the bodies stood at the start and, where that was let go, when they had parted.
fn with_start(row: &Row, contact: &Contact, mut object: Value) -> Value {
    let start = row.left_from.unwrap_or(contact.start);
    object["start"] = json!(start_in_json(start));
    object["start_proven"] = json!(start != StartState::Undecided);
    if row.left_from.is_some() {
        object["left"] = json!(contact.left);
    }
    object
}

fn pairs(count: usize) -> String {
    format!("{count} pair{}", if count == 1 { "" } else { "s" })
}

/// The answer for a person.
fn text(window: Window, names: &[&str], rows: &[Row], beginnings: &[Beginning]) -> String {
    let [start, end] = [window.start(), window.end()].map(short);
    let names: Vec<_> = names.iter().map(|name| printable(name)).collect();
    let contacts = rows.iter().filter(|row| row.answer.contact().is_some()).count();
    let bodies = format!("{} bodies from {start} to {end}{}\n", names.len(), exception(beginnings));
    let mut text = match (contacts, rows.len() - contacts) {
        (0, 0) => format!("SEPARATED: certified, no contact of {bodies}"),
        (_, 0) => format!("CONTACT of {} of {bodies}", pairs(contacts)),
        (0, undecided) => format!("UNDECIDED: {} of {bodies}", pairs(undecided)),
        (_, undecided) => format!("CONTACT of {}, and {undecided} undecided, of {bodies}", pairs(contacts)),
    };
    for row in rows {
        let [a, b] = row.bodies.map(|body| &names[body]);
        let pair = format!("{a} \u{2013} {b}");
        // Writing to a string cannot fail.
        let _ = match &row.answer {
            TimeOfContact::Contact(contact) => writeln!(
                text,
                "  t = {:<22} {pair}: {} at {}, {:.2e} apart then{}",
                short(contact.time_lo),
                contact.evidence,
                vector(contact.point_a),
                contact.separation,
                departure_words(row, contact)
            ),
            TimeOfContact::Undecided { clear_until } => {
                let until = undecided_words(row.start, *clear_until, window);
                writeln!(text, "  t = {:<22} {pair}: {until}", short(*clear_until))
            }
            TimeOfContact::Separated => Ok(()),
        };
    }
    for pair in beginnings.iter().filter_map(Beginning::let_go) {
        let _ = writeln!(text, "  left: {}", pair.words());
    }
    text
}

/// What is proven of an undecided pair until this time. Of one whose contact at the start is let go that is
/// what is said of those.
fn undecided_words(start: Start, clear_until: f64, window: Window) -> &'static str {
    match start {
        _ if clear_until <= window.start() => "undecided from the start",
        Start::Leave => "undecided from then on",
        _ => "undecided, certified free until then",
    }
}

/// What became of a contact at the start.
fn departure_words(row: &Row, contact: &Contact) -> String {
    match (row.left_from, contact.left) {
        (None, _) => String::new(),
        (Some(start), None) => format!("; {} from the start, and never proven apart", start_word(start)),
        (Some(StartState::Apart), Some(_)) => "; apart at the start".to_owned(),
        (Some(start), Some(left)) => {
            format!("; {} at the start, proven apart at {}", start_word(start), short(left.hi))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(name: &str, text: &str) -> Scene {
        let path = std::env::temp_dir().join(format!("d2m-{name}-{}.json", std::process::id()));
        std::fs::write(&path, text).unwrap();
        let scene = Scene::read(&path);
        std::fs::remove_file(&path).unwrap();
        scene.unwrap_or_else(|_| panic!("the scene is read"))
    }

    /// Three boxes in each other at the only time of a window: the first pair is the answer, and nothing is said of the others.
    #[test]
    fn the_first_of_several_at_the_start_is_proven() {
        let body = |name: &str, x: f64| {
            format!(r#"{{"name": "{name}", "mesh": "shape:box", "motion": {{"x": [{x}, 0, 0]}}}}"#)
        };
        let bodies = [body("a", 0.0), body("b", 0.1), body("c", 0.2)].join(", ");
        for end in [0, 1] {
            let scene =
                scene(&format!("start-{end}"), &format!(r#"{{"window": [0, {end}], "bodies": [{bodies}]}}"#));
            let found = scene.world(QueryOptions::default()).first_contact(scene.window).unwrap();
            let FirstContact::Contact { a, b, contact, .. } = found else { panic!("they meet") };
            let row = Row::new(&scene, [a, b], TimeOfContact::Contact(contact), QueryOptions::default());
            assert!(prove(&scene, &[row]).unwrap().is_verified(), "{end}");
        }
    }

    /// Out of the other one and into it again, of which the answer says nothing: it was proven that they part.
    #[test]
    fn what_meets_again_is_not_passed_over() {
        let text = r#"{"start": "leave", "bodies": [{"name": "a", "mesh": "shape:box"}, {"name": "b", "mesh": "shape:box", "motion":
            {"times": [0, 0.5, 1], "poses": [{"x": [0.5, 0, 0]}, {"x": [3, 0, 0]}, {"x": [0.5, 0, 0]}], "join": "linear"}}]}"#;
        let scene = scene("meets-again", text);
        let found = scene.world(QueryOptions::default()).contacts(scene.window).unwrap();
        let rows: Vec<Row> = found
            .iter()
            .map(|pair| Row::new(&scene, [pair.a, pair.b], pair.answer, QueryOptions::default()))
            .collect();
        let is_proven = |rows: &[Row]| prove(&scene, rows).is_ok_and(|proof| proof.is_verified());
        assert!(rows.len() == 1 && is_proven(&rows));
        assert!(!is_proven(&[]));
    }
}
