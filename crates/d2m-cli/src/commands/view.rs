//! `d2m view`: a page of HTML that shows moving bodies, or a still image of them.

use super::scene_question::{SAID_BY_THE_SCENE, said_by_scenes};
use crate::arguments::{FurtherArguments, Method, ViewArguments};
use crate::engine::{Pair, check_size, options_of};
use crate::failure::Failure;
use crate::output::{Output, require_distinct};
use crate::report;
use crate::scene::Scene;
use crate::sizes::load_both;
use crate::view::{
    DistanceSample, Mark, Picture, StillSize, Up, flights_of, picture_of_run, picture_of_scene, still,
};
use d2m::bvh::{StartState, TimeOfContact, Window};
use d2m::motion::AnyMotion;
use d2m_io::proven_spans;
use std::path::Path;
use std::time::{Duration, Instant};

/// Times at which the distance is drawn.
const DISTANCES: u32 = 120;
/// What they may take: a page is waited for.
const LONGEST: Duration = Duration::from_secs(3);

/// Runs the command.
pub(crate) fn run(arguments: &ViewArguments) -> Result<(), Failure> {
    let inputs: Vec<&Path> =
        [Some(&arguments.a), arguments.b.as_ref()].into_iter().flatten().map(Path::new).collect();
    let output = |path: &Option<String>, option: &str, extensions: &[&str]| match path {
        Some(path) => Output::new(path)?.spare(inputs.iter().copied())?.called(option, extensions).map(Some),
        None => Ok(None),
    };
    let page = output(&arguments.out, "--out", &["html", "htm"])?;
    let png = output(&arguments.png, "--png", &["png"])?;
    require_distinct([&page, &png].into_iter().flatten())?;
    let size = StillSize::parse(&arguments.size).map_err(|reason| Failure::at("--size", reason))?;
    let packed = Path::new(&arguments.a);
    let is_packed = packed.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
    let name = if is_packed { Path::new(packed.file_stem().unwrap_or_default()) } else { packed };
    let extension = name.extension().unwrap_or_default().to_ascii_lowercase();
    let (is_run, is_scene) = (extension == "jsonl", extension == "json");
    let mut picture = match &arguments.b {
        Some(b) if is_run || is_scene => {
            return Err(Failure::at(b, "a scene or a simulation is viewed alone"));
        }
        Some(b) => pair(arguments, b)?,
        None if is_run => {
            refuse_for_run(arguments)?;
            picture_of_run(Path::new(&arguments.a))?
        }
        None if is_scene => scene(arguments)?,
        None => return Err(Failure::at("B", "the second mesh is missing")),
    };
    [&page, &png].into_iter().flatten().try_for_each(Output::spare_inputs)?;
    if let Some(up) = arguments.up {
        picture.up = up;
    }
    if let Some(page) = page {
        page.write(&picture.to_html())?;
    }
    if let Some(png) = png {
        let time = shown_time(arguments, &picture)?;
        let picture = still(&picture, time, size).map_err(|error| Failure::at("--png", error))?;
        png.write_bytes(&picture)?;
    }
    Ok(())
}

/// The time of a still picture: the one that was wanted, or the first mark, or the start.
fn shown_time(arguments: &ViewArguments, picture: &Picture) -> Result<f64, Failure> {
    let [start, end] = picture.window;
    let Some(text) = &arguments.at else {
        let marked = picture.marks.first().filter(|_| !picture.is_real_time).map(|mark| mark.from);
        return Ok(marked.unwrap_or(if picture.is_real_time { end } else { start }));
    };
    let time: f64 = text.parse().map_err(|_| Failure::at("--at", format!("{text:?} is not a number")))?;
    if (start..=end).contains(&time) {
        return Ok(time);
    }
    Err(Failure::at("--at", format!("{text} is outside of the window [{start:?}, {end:?}]")))
}

/// A scene and its contacts.
fn scene(arguments: &ViewArguments) -> Result<Picture, Failure> {
    let said = said_by_scenes(&arguments.motions, &arguments.query);
    if let Some(option) = said.first() {
        return Err(Failure::at(option, SAID_BY_THE_SCENE));
    }
    if arguments.query.mode == Method::Paper {
        return Err(Failure::at("--mode", "the reference method answers no questions of scenes"));
    }
    let options = options_of(&arguments.query)?;
    let scene = Scene::read(Path::new(&arguments.a))?;
    if options.tolerance.is_some() && scene.states_tolerance() {
        return Err(Failure::at("--tolerance", SAID_BY_THE_SCENE));
    }
    picture_of_scene(&scene, &arguments.a, options)
}

/// A run is shown as it is: no query is made of it.
fn refuse_for_run(arguments: &ViewArguments) -> Result<(), Failure> {
    let query = &arguments.query;
    let asked = [
        ("--tolerance", query.tolerance.is_some()),
        ("--budget", query.budget.is_some()),
        ("--mode", query.mode != Method::Accurate),
    ];
    let asked = asked.into_iter().filter_map(|(option, is_given)| is_given.then_some(option));
    match said_by_scenes(&arguments.motions, query).into_iter().chain(asked).next() {
        Some(option) => Err(Failure::at(option, "a run is shown as its file has it")),
        None => Ok(()),
    }
}

/// Two moving meshes and their first contact.
fn pair(arguments: &ViewArguments, b: &str) -> Result<Picture, Failure> {
    let (window, motions) = arguments.motions.parse()?;
    let [a, b] = load_both(&arguments.a, b, &arguments.query.sizes)?;
    let pair = Pair::new(a, b, &arguments.query)?.on_all_threads();
    check_size("--motion-a", &motions[0], &pair.a)?;
    check_size("--motion-b", &motions[1], &pair.b)?;
    let answer = pair.answer_with([&motions[0], &motions[1]], window, FurtherArguments::default())?;
    let text = report::text(&pair, window, &answer);
    let mut lines = text.lines().map(str::trim);
    let headline = lines.next().unwrap_or_default().to_owned();
    let mut picture = Picture::new(headline, [window.start(), window.end()]);
    for line in lines {
        let (label, value) = line.split_once("  ").unwrap_or(("", line));
        picture.add_fact(label, value.trim());
    }
    let bodies = [("A", &pair.a, &motions[0]), ("B", &pair.b, &motions[1])];
    for ((label, body, motion), radius) in bodies.into_iter().zip(pair.radii) {
        let mesh = picture.add_mesh(&body.name, body.mesh(), radius);
        picture.add_body(&format!("{label}: {}", body.name), mesh, flights_of(motion, window));
    }
    if motions.iter().any(|motion| matches!(motion, AnyMotion::Chain(_))) {
        picture.up = Up::Z;
    }
    if let TimeOfContact::Contact(contact) = &answer.verdict
        && contact.start != StartState::Contained
    {
        picture.marks.push(Mark::of_contact(contact, [0, 1], [pair.a.mesh(), pair.b.mesh()]));
    }
    picture.spans = proven_spans(&answer.verdict, window);
    picture.curve = distances(&pair, [&motions[0], &motions[1]], window);
    Ok(picture)
}

/// Distances at times of the window, as many as a short wait allows.
fn distances(pair: &Pair, motions: [&AnyMotion; 2], window: Window) -> Vec<DistanceSample> {
    let begin = Instant::now();
    let mut samples = Vec::new();
    for k in 0..=DISTANCES {
        let part = f64::from(k) / f64::from(DISTANCES);
        let time = (window.start() + part * window.length()).clamp(window.start(), window.end());
        if let Some([lower, upper]) = pair.distance_at(motions, time) {
            samples.push(DistanceSample { time, lower, upper });
        }
        if begin.elapsed() > LONGEST {
            return Vec::new();
        }
    }
    samples
}
